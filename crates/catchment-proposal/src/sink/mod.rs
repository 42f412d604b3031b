//! Search for places at which a part sinks into the other: all facings and all lateral offsets, on lattices,
//! before exact contact evaluates the best of them.
//!
//! ```text
//!   fixed   F(p)  highest z over p            h(o) = max over p of F(p + o) + M(p)     height of first contact at the lateral offset o
//!   moving  M(p)  −lowest z over p            F eroded by half a cell: h bounds the heights of the whole cell of o from below
//!
//!   6 × 24 views ──▶ h over all offsets ──▶ basins ──▶ again on a fine lattice ──▶ steep = climb / (e + play at half the climb)
//!   as drawn, 6 approaches ──▶ h near the origin ──▶ holds, passes through, flat, blocked or apart
//! ```
//!
//! The climb of a basin is the height that the moving part must rise before it leaves it. Its play is half
//! its extent at half that height, and e ([`Grain::small`]) is half a millimetre for parts of a few
//! centimetres. A deep hole with little play is steep, a lid that lies in a wide tray is not.
//!
//! Diagonal directions are included if both parts have walls along them ([`diagonals`]).
//!
//! Not promised: seats narrower than the fine lattice, rotations other than quarter turns, and that a steep
//! seat is the intended seat.

mod as_drawn;
mod classes;
mod flood;
mod height;
mod interlock;
mod refine;

pub(super) use as_drawn::{ApproachResult, drawn, together};
pub(super) use classes::classes;
pub(super) use interlock::{lead, undercut};

use super::layout::{AxisDirection, PartLayout};
use catchment_core::connector::Half;
use catchment_core::exec::{Cancelled, Exec};
use flood::{Basin, basins};
use glam::{DMat3, DVec2, DVec3};
use height::{Groups, Offsets, PartHeights, Phases, SUB, deciding, deciding_blocks, heights, overlaps};
use std::collections::BTreeMap;

/// A part as triangles.
pub(super) type Triangles = Vec<[DVec3; 3]>;

/// The triangles of a half.
pub(super) fn triangles(half: &Half) -> Triangles {
    let mut all = Vec::new();
    for surface in &half.surfaces {
        for facet in &surface.facets {
            let at = |k: usize| surface.vertices[facet.corners[k] as usize];
            all.extend((2..facet.corners.len()).map(|k| [at(0), at(k - 1), at(k)]));
        }
    }
    all
}

/// Which lengths count as small.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grain {
    /// Half a millimetre, for parts of a few centimetres. Lengths are in the unit of the parts.
    pub(super) small: f64,
}

impl Grain {
    /// Small lengths for parts with a millimetre of this length, in units of the smaller part's width.
    pub(super) fn new(millimetre: f64) -> Self {
        const LEAST: f64 = 0.004;
        const MOST: f64 = 0.06;
        Self { small: (0.5 * millimetre).clamp(LEAST, MOST) }
    }

    /// A basin with a lower climb is flat.
    pub(super) fn least_climb(self) -> f64 {
        0.8 * self.small
    }
}

/// A place at which the moving part sinks in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sunk {
    /// How the parts lie.
    pub(super) lie: PartLayout,
    /// Position of the origin of the rotated moving part, in the rotated frame of the fixed part: in plan
    /// view, and height.
    pub(super) offset: DVec2,
    pub(super) height: f64,
    /// Climb until it leaves.
    pub(super) climb: f64,
    /// Play to each side at half the climb.
    pub(super) play: f64,
    /// Whether it hardly rises within the search range: a part in a tray is loose, a part in a funnel is not.
    pub(super) is_loose: bool,
    /// climb / (e + play), and up to 15 % less for parts that lie side by side.
    pub(super) steep: f64,
    /// Side of a cell of the lattice that found it.
    pub(super) cell: f64,
}

/// Points of the lattice of offsets across both parts, and the length of a cell at most, in small lengths.
const CELLS: f64 = 160.0;
const MOST_CELL: f64 = 1.6;
/// Largest number of points of the moving part.
const MOST_POINTS: usize = 2500;
/// Number of basins of a view that are evaluated with all points.
const MOST_ASKED: usize = 400;
/// Number of basins of a view that are kept, and of all views.
const OF_ONE: usize = 6;
const MOST: usize = 100;

/// Turns a part over: heights of its underside are heights of its top.
pub(super) const UPSIDE_DOWN: DMat3 = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::NEG_Z);

/// The places at which the moving part sinks into the fixed part, the steepest first.
pub(super) fn sinks(
    [fixed, moving]: [&Triangles; 2],
    facing: [&[AxisDirection]; 2],
    grain: Grain,
    exec: &Exec,
) -> Result<Vec<Sunk>, Cancelled> {
    let extent = |part: &Triangles| {
        let (low, high) = PartHeights::bounds(part, &DMat3::IDENTITY);
        (high - low).max_element()
    };
    let cell = ((extent(fixed) + extent(moving)) / CELLS).min(MOST_CELL * grain.small);
    // Very different parts: no more cells than time allows.
    let cell = cell.max((extent(fixed) + extent(moving)) / (6.0 * CELLS));
    let views = views(moving, facing[1], cell, exec)?;
    let result = exec.each(facing[0].len(), usize::MAX, "facings", |k, exec| {
        let way = facing[0][k];
        let turn = PartLayout::Facing { fixed: way, moving: way, turned: 0 }.turns()[0];
        let mut tops = Tops::of(fixed, &turn, cell);
        let mut result = Vec::new();
        for view in &views {
            if exec.is_cancelled() {
                break;
            }
            result.extend(tops.seen(way, view, cell, grain));
        }
        result
    });
    exec.check()?;
    let mut result: Vec<Sunk> = result.into_iter().flatten().collect();
    result.sort_by(|a, b| b.climb.total_cmp(&a.climb));
    result.truncate(MOST);
    let fine = exec.each(result.len(), usize::MAX, "places", |k, exec| {
        if exec.is_cancelled() { None } else { refine::refined([fixed, moving], result[k], cell, grain) }
    });
    exec.check()?;
    let mut fine: Vec<Sunk> = fine.into_iter().flatten().collect();
    fine.sort_by(|a, b| b.steep.total_cmp(&a.steep));
    Ok(fine)
}

/// The directions half way between two axes along which a part may enter or be entered: it has walls parallel to them, on two sides.
pub(super) fn diagonals(part: &Triangles) -> Vec<AxisDirection> {
    /// Seen from either side, walls cover at least this share of the surface: more than the strip of a cylinder whose axis lies across.
    const SHARE: f64 = 0.03;
    /// Normals of walls are square to the direction up to this sine.
    const SQUARE: f64 = 0.05;
    let normals: Vec<DVec3> = part.iter().map(|[a, b, c]| (b - a).cross(c - a)).collect();
    let all: f64 = normals.iter().map(|normal| normal.length()).sum();
    let has_walls = |way: &AxisDirection| {
        let along = way.vector();
        let flat = DVec3::AXES.into_iter().find(|axis| axis.dot(along) == 0.0).unwrap_or(DVec3::Z);
        let across = flat.cross(along);
        let walls = normals.iter().filter(|normal| normal.dot(along).abs() <= SQUARE * normal.length());
        let seen = walls.map(|normal| normal.dot(across));
        let [front, back] =
            seen.fold([0.0; 2], |[front, back], area| [front + area.max(0.0), back - area.min(0.0)]);
        front.min(back) >= SHARE * all
    };
    AxisDirection::diagonals().filter(has_walls).collect()
}

/// A way in which the moving part may be turned, seen from below.
struct View {
    way: AxisDirection,
    turned: u8,
    bottom: PartHeights,
    points: Groups,
}

/// The ways in which the moving part may be turned; of those that look alike from below the first.
fn views(moving: &Triangles, ways: &[AxisDirection], cell: f64, exec: &Exec) -> Result<Vec<View>, Cancelled> {
    let all: Vec<(AxisDirection, u8)> =
        ways.iter().flat_map(|way| (0..4).map(|turned| (*way, turned))).collect();
    let maps = exec.each(all.len(), usize::MAX, "views", |k, _| {
        let (way, turned) = all[k];
        let turn = PartLayout::Facing { fixed: way, moving: way, turned }.turns()[1];
        PartHeights::whole(moving, &(UPSIDE_DOWN * turn), cell / SUB as f64, SUB)
    });
    exec.check()?;
    let level = (0.5 * cell) as f32;
    let mut views: Vec<View> = Vec::new();
    for ((way, turned), bottom) in all.into_iter().zip(maps) {
        if views.iter().any(|view| view.way == way && view.bottom.is_like(&bottom, level)) {
            continue;
        }
        let points = looked_at(&bottom, level);
        views.push(View { way, turned, bottom, points });
    }
    Ok(views)
}

/// The points to evaluate: some of every block of a cell, or of larger blocks if these are too many.
fn looked_at(bottom: &PartHeights, level: f32) -> Groups {
    /// How many times as large level blocks are.
    const LARGE: usize = 4;
    let all = deciding(bottom, SUB, level);
    if all.len() <= MOST_POINTS {
        return Groups::from([(1, all)]);
    }
    let mut side = SUB;
    loop {
        let groups = deciding_blocks(bottom, [side, LARGE * side], level);
        if groups.values().map(Vec::len).sum::<usize>() <= MOST_POINTS || side >= 4 * SUB {
            return groups;
        }
        side += side / 2;
    }
}

/// The fixed part from above.
struct Tops {
    first: DVec2,
    /// Worn, no narrow hole is missed; thickened, no thin wall.
    maps: [PartHeights; 2],
    phases: [Phases; 2],
    /// As high as the highest point of a block of this side.
    dilated: BTreeMap<usize, [Phases; 2]>,
}

impl Tops {
    fn of(fixed: &Triangles, turn: &DMat3, cell: f64) -> Self {
        let top = PartHeights::whole(fixed, turn, cell / SUB as f64, SUB);
        let first = top.first;
        let maps = [top.eroded(SUB / 2), top.thickened(fixed, turn)];
        let phases = maps.each_ref().map(Phases::of);
        Self { first, maps, phases, dilated: BTreeMap::new() }
    }

    /// h over all offsets, of both maps. A point that represents a block meets the highest point under all of
    /// it.
    fn heights(&mut self, view: &View) -> [Offsets; 2] {
        for side in view.points.keys().filter(|side| **side > 1) {
            let dilated = |map: &PartHeights| Phases::of(&map.dilated(side / 2));
            self.dilated.entry(*side).or_insert_with(|| self.maps.each_ref().map(dilated));
        }
        [0, 1].map(|k| {
            let groups = view.points.iter().map(|(side, points)| {
                let phases = self.dilated.get(side).unwrap_or(&self.phases);
                (&phases[k], points.as_slice())
            });
            heights(&groups.collect::<Vec<_>>(), view.bottom.counts)
        })
    }

    /// The basins of a view, on the first lattice.
    fn seen(&mut self, way: AxisDirection, view: &View, cell: f64, grain: Grain) -> Vec<Sunk> {
        let lie = PartLayout::Facing { fixed: way, moving: view.way, turned: view.turned };
        let heights = self.heights(view);
        let mut result: Vec<Sunk> = Vec::new();
        for (map, h) in self.maps.iter().zip(&heights) {
            let mut places = basins(&h.z, h.wide, grain.least_climb() as f32);
            // With few points a rim may be missed, so the basin is checked against all points.
            if view.points.len() > 1 {
                places.truncate(MOST_ASKED);
                let is_one = |basin: &Basin| {
                    let at = [basin.at % h.wide, basin.at / h.wide];
                    let shift = [0, 1].map(|k| (at[k] as f64 - h.before[k]) as isize * SUB.cast_signed());
                    !overlaps(map, &view.bottom, shift, h.z[basin.at] + 0.5 * basin.climb)
                };
                places = places.into_iter().filter(is_one).take(2 * OF_ONE).collect();
            }
            for basin in places.into_iter().take(2 * OF_ONE) {
                let cells = DVec2::new((basin.at % h.wide) as f64, (basin.at / h.wide) as f64) - h.before;
                let offset = self.first - view.bottom.first + cell * cells;
                if result.iter().any(|other| (other.offset - offset).abs().max_element() < 2.0 * cell) {
                    continue;
                }
                let climb = f64::from(basin.climb);
                let height = f64::from(h.z[basin.at]);
                result.push(Sunk {
                    lie,
                    offset,
                    height,
                    climb,
                    play: 0.0,
                    is_loose: false,
                    steep: 0.0,
                    cell,
                });
            }
        }
        result.sort_by(|a, b| b.climb.total_cmp(&a.climb));
        result.truncate(OF_ONE);
        result
    }
}

#[cfg(test)]
mod tests;
