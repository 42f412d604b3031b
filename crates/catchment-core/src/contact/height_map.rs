//! Height maps of the two halves over a lattice in plan view, and the height of first contact over lateral
//! offsets.
//!
//! ```text
//!     fixed  F(p) = highest z over p          h(o) = max over p of  F(p) + M(p − o)
//!     moving M(p) = −lowest z over p          over common points p; undefined if the common area is too small
//! ```
//!
//! The maps are sampled at points, so a peg that fits its hole collides with the rim if the rim lies between
//! samples. One of the two maps is therefore eroded by one point all around, first the fixed one, then the
//! moving one, and the higher of both heights counts: a pin that erodes away completely still stops where its
//! partner is eroded. The maps only propose positions; exact heights decide.
//!
//! [`HeightMap::without_narrow`] removes features narrower than three points, such as a web or a pin. If a half
//! would sink into a seat without such a feature, [`in_the_way`] gives its position.

use super::Lattice;
use super::display_unit::DisplayUnit;
use super::raster::fill_convex;
use crate::connector::{Half, HalfRole};
use crate::tolerance;
use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};

/// A facet counts if the z-component of its normal is above this.
const LOOKS: f64 = tolerance::SINGLE;
/// The overlap in plan view is sufficient if this share of the points of the smaller part lies over the
/// other.
const SHARED: f64 = 0.3;

/// Heights over a lattice; −∞ at points without material.
pub struct HeightMap {
    /// The first point, in plan view.
    pub first: DVec2,
    /// Points along x and y.
    pub counts: [usize; 2],
    /// Height at each, along x first.
    pub z: Vec<f32>,
    /// Points with a height.
    pub(crate) filled: usize,
}

impl HeightMap {
    /// Of a half that a turn brings upright, seen from above (`up` 1) or below (−1, heights negated), over the points
    /// `first + cell·(i, j)`.
    pub fn of(half: &Half, turn: &DMat3, up: f64, cell: f64, first: DVec2, counts: [usize; 2]) -> Self {
        let lattice = |k: usize| Lattice { first: first[k], step: cell, count: counts[k] };
        let (x, y) = (lattice(0), lattice(1));
        let mut z = vec![f32::NEG_INFINITY; counts[0] * counts[1]];
        for surface in &half.surfaces {
            let points: Vec<_> = surface.vertices.iter().map(|p| *turn * *p).collect();
            for facet in &surface.facets {
                let normal = *turn * facet.normal;
                if normal.z * up <= LOOKS {
                    continue;
                }
                let corners: Vec<_> = facet.corners.iter().map(|k| points[*k as usize]).collect();
                let plan: Vec<DVec2> = corners.iter().map(|p| p.truncate()).collect();
                let (low, high) = corners
                    .iter()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.z), high.max(p.z)));
                fill_convex(&plan, x, y, |row, columns| {
                    for column in columns {
                        let at = DVec2::new(x.at(column), y.at(row)) - plan[0];
                        let level = corners[0].z - normal.truncate().dot(at) / normal.z;
                        let level = (level.clamp(low, high) * up) as f32;
                        let held = &mut z[row * counts[0] + column];
                        *held = held.max(level);
                    }
                });
            }
        }
        let filled = z.iter().filter(|z| **z > f32::NEG_INFINITY).count();
        Self { first, counts, z, filled }
    }

    /// Over a lattice whose points lie evenly about the middle of the box around the half.
    pub fn centered(half: &Half, turn: &DMat3, up: f64, cell: f64) -> Self {
        let (low, high) = plan_box(half, turn);
        // An odd number, so that middles of parts fall on points.
        let counts = [0, 1].map(|k| ((high[k] - low[k]) / cell).ceil() as usize / 2 * 2 + 1);
        let size = DVec2::new(counts[0] as f64 - 1.0, counts[1] as f64 - 1.0) * cell;
        Self::of(half, turn, up, cell, low.midpoint(high) - 0.5 * size, counts)
    }

    /// The points that have a height.
    fn points(&self) -> Vec<([i32; 2], f32)> {
        let [wide, _] = self.counts;
        let at = |(k, z): (usize, &f32)| ([signed(k % wide), signed(k / wide)], *z);
        self.z.iter().enumerate().filter(|(_, z)| **z > f32::NEG_INFINITY).map(at).collect()
    }

    fn at(&self, [i, j]: [i32; 2]) -> f32 {
        let [wide, deep] = self.counts.map(signed);
        if (0..wide).contains(&i) && (0..deep).contains(&j) {
            self.z[(j * wide + i) as usize]
        } else {
            f32::NEG_INFINITY
        }
    }

    /// Every point as low as the lowest of those around it.
    fn worn(&self) -> Self {
        self.around(f32::min)
    }

    /// Every point as `pick` chooses from those around it.
    fn around(&self, pick: impl Fn(f32, f32) -> f32) -> Self {
        let [wide, deep] = self.counts.map(signed);
        let picked = |i: i32, j: i32| {
            let around = (-1..=1).flat_map(|dj| (-1..=1).map(move |di| [i + di, j + dj]));
            around.fold(self.at([i, j]), |picked, at| pick(picked, self.at(at)))
        };
        let z: Vec<f32> =
            (0..deep).flat_map(|j| (0..wide).map(move |i| (i, j))).map(|(i, j)| picked(i, j)).collect();
        let filled = z.iter().filter(|z| **z > f32::NEG_INFINITY).count();
        Self { first: self.first, counts: self.counts, z, filled }
    }

    /// Without features narrower than three points: eroded, then dilated.
    #[must_use]
    pub fn without_narrow(&self) -> Self {
        self.worn().around(f32::max)
    }

    /// Whether two height maps are equal.
    pub fn is_like(&self, other: &Self) -> bool {
        self.counts == other.counts
            && self.z.iter().zip(&other.z).all(|(a, b)| a == b || (a - b).abs() < tolerance::TOUCHING as f32)
    }
}

/// A number of points, to reckon with; lattices have few.
pub fn signed(count: usize) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX)
}

/// The box in plan view around a turned half.
pub fn plan_box(half: &Half, turn: &DMat3) -> (DVec2, DVec2) {
    let points = half.surfaces.iter().flat_map(|surface| &surface.vertices).map(|p| (*turn * *p).truncate());
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

/// The area of the largest side of the box around a half: docking faces are broad.
pub fn broadest(half: &Half) -> f64 {
    let (low, high) = half.bounds();
    let size = high - low;
    (size * size.zxy()).max_element()
}

/// A narrow feature of a half that alone keeps the other half from sinking into a seat.
#[derive(Debug, Clone, Copy)]
pub struct Obstruction {
    /// Whose it is.
    pub(crate) side: HalfRole,
    /// Contact point, in the frame of the fixed half as rotated, and the same point of the moving half in its
    /// own frame.
    pub at: [DVec3; 2],
    /// How much deeper the half would sink without it.
    pub(crate) deeper: f64,
}

/// Side of a cell for [`in_the_way`], as a share of the smaller half's middle extent: features narrower than
/// three cells are narrow.
pub const NARROW: f64 = 0.05;
/// Distances at which a rise is evaluated, in cells.
pub(crate) const REACHES: [i32; 2] = [3, 7];
/// Rises beyond this count as this.
pub const MOST_RISE: f32 = 0.5;
/// Smallest additional depth, in cells, and the smallest climb at an offset, for a feature to count as an
/// obstacle.
const DEEPER: f32 = 1.0;
const CLIMBS: f32 = 0.02;

/// Looks whether something narrow keeps the moving half, moved by whole cells, from a seat.
pub fn in_the_way(top: &HeightMap, bottom: &HeightMap, moved: [i32; 2], cell: f64) -> Option<Obstruction> {
    let (height, _) = with(top, bottom, |both| both.height(moved))?;
    [HalfRole::Fixed, HalfRole::Moving].into_iter().find_map(|side| {
        let opened = match side {
            HalfRole::Fixed => [Some(top.without_narrow()), None],
            HalfRole::Moving => [None, Some(bottom.without_narrow())],
        };
        let [f, m] = [opened[0].as_ref().unwrap_or(top), opened[1].as_ref().unwrap_or(bottom)];
        let (without, (climb, worst)) = with(f, m, |both| Some((both.height(moved)?.0, both.climb(moved)?)))?;
        let deeper = height - without;
        if deeper < DEEPER * cell as f32 || climb < CLIMBS || worst < -0.1 * MOST_RISE {
            return None;
        }
        // Among the cells that `without_narrow` lowered: the cell at which the original halves are closest.
        let narrow = |[i, j]: [i32; 2]| {
            let at = [i + moved[0], j + moved[1]];
            let (a, b) = (top.at(at), bottom.at([i, j]));
            let is_gone = a + b > f.at(at) + m.at([i, j]) + 0.5 * deeper;
            (is_gone && a + b > f32::NEG_INFINITY).then_some((a + b, [i, j], a, b))
        };
        let [wide, deep] = bottom.counts.map(signed);
        let result = (0..deep).flat_map(|j| (0..wide).map(move |i| [i, j])).filter_map(narrow);
        let (_, [i, j], a, b) = result.max_by(|one, other| one.0.total_cmp(&other.0))?;
        let place = |map: &HeightMap, [i, j]: [i32; 2], z: f32| {
            (map.first + cell * DVec2::new(f64::from(i), f64::from(j))).extend(f64::from(z))
        };
        let at = [place(top, [i + moved[0], j + moved[1]], a), place(bottom, [i, j], -b)];
        Some(Obstruction { side, at, deeper: f64::from(deeper) })
    })
}

/// The result in words, with both points as given text.
pub fn in_words(result: &Obstruction, at: &[String; 2], unit: DisplayUnit) -> String {
    let Obstruction { side, deeper, .. } = result;
    let (whose, [fixed, moving]) = (if *side == HalfRole::Fixed { "fixed" } else { "moving" }, at);
    format!(
        "something narrow of the {whose} part is in the way, touched at {fixed} of the fixed and {moving} of the moving part as drawn: without it \
         they would sink about {} deeper, into a seat",
        unit.length(*deeper)
    )
}

/// Two height maps with equal cells.
pub struct HeightMaps<'a> {
    fixed: [&'a HeightMap; 2],
    /// The moving map unchanged, for use with the eroded fixed map; and eroded.
    moving: [Vec<([i32; 2], f32)>; 2],
    fewest: usize,
}

/// Calls `with` with the height maps of two halves, and of both as they are worn.
pub fn with<T>(fixed: &HeightMap, moving: &HeightMap, with: impl FnOnce(&HeightMaps<'_>) -> T) -> T {
    let fewest = (SHARED * fixed.filled.min(moving.filled) as f64).ceil().max(1.0) as usize;
    let worn = fixed.worn();
    with(&HeightMaps { fixed: [&worn, fixed], moving: [moving.points(), moving.worn().points()], fewest })
}

impl HeightMaps<'_> {
    /// The height of first contact with the moving lattice shifted by whole cells, and the number of common
    /// points; `None` if they are too few.
    pub fn height(&self, [dx, dy]: [i32; 2]) -> Option<(f32, usize)> {
        let (mut highest, mut most) = (f32::NEG_INFINITY, 0);
        for (fixed, points) in self.fixed.iter().zip(&self.moving) {
            let mut count = 0;
            for ([i, j], z) in points {
                let height = fixed.at([i + dx, j + dy]) + z;
                if height > f32::NEG_INFINITY {
                    highest = highest.max(height);
                    count += 1;
                }
            }
            most = most.max(count);
        }
        (most >= self.fewest).then_some((highest, most))
    }

    /// How much the height rises around an offset, on average, and at least; beside each other nothing holds the halves.
    pub(crate) fn climb(&self, at: [i32; 2]) -> Option<(f32, f32)> {
        let (height, _) = self.height(at)?;
        Some(climb(at, height, |other| Some(self.height(other)?.0)))
    }
}

/// Rise of the heights around a given height, in eight directions, near and farther off: mean and minimum.
pub fn climb([i, j]: [i32; 2], height: f32, at: impl Fn([i32; 2]) -> Option<f32>) -> (f32, f32) {
    let (mut sum, mut worst, mut ways) = (0.0f32, f32::INFINITY, 0.0f32);
    for reach in REACHES {
        for (dx, dy) in [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)] {
            // Beside each other nothing holds them.
            let rise = at([i + reach * dx, j + reach * dy]).map_or(-MOST_RISE, |other| other - height);
            (sum, worst, ways) = (sum + rise.clamp(-MOST_RISE, MOST_RISE), worst.min(rise), ways + 1.0);
        }
    }
    (sum / ways, worst)
}
