//! Heights of a part over a lattice in plan view, and of first contact over lateral offsets of two of them.
//!
//! ```text
//!     fixed  F(p) = highest z over p          h(o) = max over p of  F(p) + M(p − o)
//!     moving M(p) = −lowest z over p          where both have something over p; none where they share too little
//! ```
//!
//! Sampled at points, so that a peg that fits its hole meets the rim where it stands between them. Therefore one of the two is worn by a
//! point all around, first the fixed one, then the moving one, and the higher of both heights counts: a pin that wears away altogether still stops
//! where its partner is worn. It finds places to look at, exact heights then judge them.

use crate::connector::{Half, Surface};
use crate::contact::{Lattice, fill_convex};
use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};

/// A facet counts where its normal's z is beyond this.
const LOOKS: f64 = 1e-6;
/// Parts share enough where this share of the points of the smaller one lies over the other.
const SHARED: f64 = 0.3;

/// Heights over a lattice; −∞ where there is nothing.
pub(super) struct Relief {
    pub(super) first: DVec2,
    pub(super) counts: [usize; 2],
    pub(super) z: Vec<f32>,
    /// Points with a height.
    pub(super) filled: usize,
}

impl Relief {
    /// Of a half that a turn brings upright, seen from above (`up` 1) or below (−1, heights negated), over the points
    /// `first + cell·(i, j)`.
    pub(super) fn of(
        half: &Half,
        turn: &DMat3,
        up: f64,
        cell: f64,
        first: DVec2,
        counts: [usize; 2],
    ) -> Self {
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
    pub(super) fn centered(half: &Half, turn: &DMat3, up: f64, cell: f64) -> Self {
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
        let [wide, deep] = self.counts.map(signed);
        let lowest = |i: i32, j: i32| {
            let around = (-1..=1).flat_map(|dj| (-1..=1).map(move |di| [i + di, j + dj]));
            around.map(|at| self.at(at)).fold(f32::INFINITY, f32::min)
        };
        let z = (0..deep).flat_map(|j| (0..wide).map(move |i| (i, j))).map(|(i, j)| lowest(i, j)).collect();
        Self { first: self.first, counts: self.counts, z, filled: 0 }
    }

    /// Whether two say the same.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        const SAME: f32 = 1e-4;
        self.counts == other.counts
            && self.z.iter().zip(&other.z).all(|(a, b)| a == b || (a - b).abs() < SAME)
    }
}

/// A number of points, to reckon with; lattices have few.
pub(super) fn signed(count: usize) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX)
}

/// The box in plan view around a turned half.
pub(super) fn plan_box(half: &Half, turn: &DMat3) -> (DVec2, DVec2) {
    let points = half.surfaces.iter().flat_map(|surface| &surface.vertices).map(|p| (*turn * *p).truncate());
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

/// The area of the largest side of the box around a half: docking faces are broad.
pub(super) fn broadest(half: &Half) -> f64 {
    let (low, high) = half
        .surfaces
        .iter()
        .map(Surface::bounds)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (a, b)| (low.min(a), high.max(b)));
    let size = high - low;
    (size * size.zxy()).max_element()
}

/// Two reliefs of one cell.
pub(super) struct Reliefs<'a> {
    fixed: [&'a Relief; 2],
    /// As it is, beside the worn fixed one; worn.
    moving: [Vec<([i32; 2], f32)>; 2],
    fewest: usize,
}

/// Calls `with` with the reliefs of two halves, and of both as they are worn.
pub(super) fn with<T>(fixed: &Relief, moving: &Relief, with: impl FnOnce(&Reliefs<'_>) -> T) -> T {
    let fewest = (SHARED * fixed.filled.min(moving.filled) as f64).ceil().max(1.0) as usize;
    let worn = fixed.worn();
    with(&Reliefs { fixed: [&worn, fixed], moving: [moving.points(), moving.worn().points()], fewest })
}

impl Reliefs<'_> {
    /// The height of first contact with the moving lattice moved by whole cells, and how many points both have; `None` where they
    /// share too few.
    pub(super) fn height(&self, [dx, dy]: [i32; 2]) -> Option<(f32, usize)> {
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
}
