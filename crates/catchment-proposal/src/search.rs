//! Search for possible seats of parts from separate files: all relative facings, all lateral offsets.
//!
//! ```text
//!   6 × 6 facings × 4 quarter turns ──▶ heights over all offsets ──▶ hollows: offsets around which the heights rise
//!        the best of them on finer and finer lattices ──▶ places, evaluated by exact heights
//! ```
//!
//! A hollow is scored by the height that the half must climb to leave it, and by the overlap of the parts in
//! plan view. Lengths are in units of the smaller part's middle extent. Not promised: seats finer than a
//! twentieth of that, and rotations other than quarter turns, are not found.

use super::layout::{AxisDirection, PartLayout};
use catchment_core::connector::{Half, HalfRole};
use catchment_core::contact::height_map::{self, HeightMap, HeightMaps, MOST_RISE, Obstruction};
use catchment_core::exec::{Cancelled, Exec};
use glam::{DMat3, DVec2};

/// Side of a first cell, and the work that all offsets may take: points of the moving part times offsets.
const CELL: f64 = height_map::NARROW;
const MOST_WORK: f64 = 4e8;
/// Factor of the cell size if the work would be too large.
const WIDER: f64 = 1.2;
/// Lattices after the first.
const LATTICES: usize = 2;
/// Points of the finest lattice.
const MOST_POINTS: usize = 100_000;
/// How much finer each next lattice is.
const FINER: i32 = 4;
/// Number of places that are refined, and of those with the same orientation.
const PLACES: usize = 10;
const OF_ONE: usize = 2;
/// Heights this near are equal, in D: as near as docked by default.
const LEVEL: f32 = 2e-3;

/// A place at which parts may dock.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeatPlace {
    pub(super) lie: PartLayout,
    /// Position of the origin of the rotated moving half, in plan view, in the frame of the fixed half.
    pub(super) offset: DVec2,
    score: f32,
}

/// The places worth judging, the most likely first; of turns of the moving half that look alike the first.
pub(super) fn places(
    halves: [&Half; 2],
    facing: [&[AxisDirection]; 2],
    exec: &Exec,
) -> Result<Vec<SeatPlace>, Cancelled> {
    let cell = cell(halves, facing);
    let result = scan(halves, facing, None, cell, exec)?;
    let finer = exec.each(result.len(), usize::MAX, "places", |k, _| refined(halves, result[k], cell));
    exec.check()?;
    Ok(finer)
}

/// A narrow feature of one half without which the halves would sink into each other, and their relative pose
/// then.
pub(super) fn obstacle(
    halves: [&Half; 2],
    facing: [&[AxisDirection]; 2],
    exec: &Exec,
) -> Result<Option<(PartLayout, Obstruction)>, Cancelled> {
    let cell = cell(halves, facing);
    for side in [HalfRole::Fixed, HalfRole::Moving] {
        for SeatPlace { lie, offset, .. } in scan(halves, facing, Some(side), cell, exec)? {
            let [top, bottom] = height_maps(halves, lie, cell);
            let moved = ((offset - top.first + bottom.first) / cell).round().as_ivec2().to_array();
            if let Some(result) = height_map::in_the_way(&top, &bottom, moved, cell) {
                return Ok(Some((lie, result)));
            }
        }
    }
    Ok(None)
}

/// Both halves as they face each other.
fn height_maps([fixed, moving]: [&Half; 2], lie: PartLayout, cell: f64) -> [HeightMap; 2] {
    let turns = lie.turns();
    [HeightMap::centered(fixed, &turns[0], 1.0, cell), HeightMap::centered(moving, &turns[1], -1.0, cell)]
}

/// The most likely places on the first lattice, without narrow features of one half.
fn scan(
    [fixed, moving]: [&Half; 2],
    facing: [&[AxisDirection]; 2],
    without_narrow: Option<HalfRole>,
    cell: f64,
    exec: &Exec,
) -> Result<Vec<SeatPlace>, Cancelled> {
    let broad = height_map::broadest(fixed).min(height_map::broadest(moving));
    let seen = |half: &Half, side: HalfRole, turn: &DMat3| {
        let map = HeightMap::centered(half, turn, if side == HalfRole::Fixed { 1.0 } else { -1.0 }, cell);
        if without_narrow == Some(side) { map.without_narrow() } else { map }
    };
    let lies: Vec<[AxisDirection; 2]> =
        facing[0].iter().flat_map(|f| facing[1].iter().map(move |m| [*f, *m])).collect();
    let result = exec.each(lies.len(), usize::MAX, "facings", |number, exec| {
        let [f, m] = lies[number];
        let top =
            seen(fixed, HalfRole::Fixed, &PartLayout::Facing { fixed: f, moving: m, turned: 0 }.turns()[0]);
        let (mut result, mut met): (Vec<SeatPlace>, Vec<HeightMap>) = (Vec::new(), Vec::new());
        for turned in 0..4 {
            if exec.is_cancelled() {
                break;
            }
            let lie = PartLayout::Facing { fixed: f, moving: m, turned };
            let bottom = seen(moving, HalfRole::Moving, &lie.turns()[1]);
            if !met.iter().any(|map| map.is_like(&bottom)) {
                result.extend(height_map::with(&top, &bottom, |both| {
                    hollows(lie, [&top, &bottom], both, cell, broad)
                }));
                met.push(bottom);
            }
        }
        result
    });
    exec.check()?;
    let mut result: Vec<SeatPlace> = result.into_iter().flatten().collect();
    result.sort_by(|a, b| b.score.total_cmp(&a.score));
    result.truncate(PLACES);
    Ok(result)
}

/// The cell with which all offsets are not too much work.
fn cell(halves: [&Half; 2], facing: [&[AxisDirection]; 2]) -> f64 {
    let mut cell = CELL;
    loop {
        let sizes = |side: usize| -> Vec<[f64; 2]> {
            let of = |way: &AxisDirection| {
                let lie = PartLayout::Facing { fixed: *way, moving: *way, turned: 0 };
                let (low, high) = height_map::plan_box(halves[side], &lie.turns()[side]);
                ((high - low) / cell).ceil().to_array()
            };
            facing[side].iter().map(of).collect()
        };
        let work = |[a, b]: [f64; 2], [c, d]: [f64; 2]| 4.0 * (a + c) * (b + d) * c * d;
        let (fixed, moving) = (sizes(0), sizes(1));
        let all: f64 = fixed.iter().flat_map(|f| moving.iter().map(move |m| work(*f, *m))).sum();
        if all <= MOST_WORK {
            return cell;
        }
        cell *= WIDER;
    }
}

/// The hollows of the heights over all offsets.
fn hollows(
    lie: PartLayout,
    [top, bottom]: [&HeightMap; 2],
    both: &HeightMaps<'_>,
    cell: f64,
    broad: f64,
) -> Vec<SeatPlace> {
    let size: [i32; 2] = std::array::from_fn(|k| height_map::signed(top.counts[k] + bottom.counts[k]) - 1);
    let first: [i32; 2] = bottom.counts.map(|count| 1 - height_map::signed(count));
    let mut heights = Vec::with_capacity((size[0] * size[1]) as usize);
    for j in 0..size[1] {
        heights.extend((0..size[0]).map(|i| both.height([first[0] + i, first[1] + j])));
    }
    let at = |i: i32, j: i32| {
        let inside = (0..size[0]).contains(&i) && (0..size[1]).contains(&j);
        if inside { heights[(j * size[0] + i) as usize] } else { None }
    };
    let share = (cell * cell / broad) as f32;
    let mut result: Vec<(f32, [i32; 2])> = Vec::new();
    for (i, j) in (0..size[1]).flat_map(|j| (0..size[0]).map(move |i| (i, j))) {
        let Some((height, count)) = at(i, j) else { continue };
        let (climb, worst) = height_map::climb([i, j], height, |[i, j]| Some(at(i, j)?.0));
        let score = climb * (count as f32 * share).min(1.0);
        if score > 0.0 && worst > -0.1 * MOST_RISE {
            result.push((score, [i, j]));
        }
    }
    result.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut kept: Vec<(f32, [i32; 2])> = Vec::new();
    for (score, [i, j]) in result {
        const APART: i32 = 5;
        if kept.iter().all(|(_, [a, b])| (a - i).abs().max((b - j).abs()) > APART) {
            kept.push((score, [i, j]));
        }
        if kept.len() == OF_ONE {
            break;
        }
    }
    let place = |(score, [i, j]): (f32, [i32; 2])| {
        let cells = DVec2::new(f64::from(first[0] + i), f64::from(first[1] + j));
        SeatPlace { lie, offset: top.first - bottom.first + cell * cells, score }
    };
    kept.into_iter().map(place).collect()
}

/// The place on finer and finer lattices: the middle of the deepest region.
fn refined([fixed, moving]: [&Half; 2], mut place: SeatPlace, cell: f64) -> SeatPlace {
    let turns = place.lie.turns();
    let mut cell = cell;
    for _ in 0..LATTICES {
        // As far as the lattice before may have been off.
        const REACH: i32 = FINER + 2;
        cell /= f64::from(FINER);
        let bottom = HeightMap::centered(moving, &turns[1], -1.0, cell);
        if bottom.z.len() > MOST_POINTS {
            break;
        }
        let reach = cell * f64::from(REACH);
        let counts = bottom.counts.map(|count| count + 2 * REACH as usize);
        let top = HeightMap::of(
            fixed,
            &turns[0],
            1.0,
            cell,
            bottom.first + place.offset - DVec2::splat(reach),
            counts,
        );
        let all = (0..=2 * REACH).flat_map(|j| (0..=2 * REACH).map(move |i| [i, j]));
        let heights: Vec<(f32, DVec2)> = height_map::with(&top, &bottom, |both| {
            let at =
                |[i, j]: [i32; 2]| Some((both.height([i, j])?.0, DVec2::new(f64::from(i), f64::from(j))));
            all.filter_map(at).collect()
        });
        let Some(lowest) = heights.iter().map(|(height, _)| *height).min_by(f32::total_cmp) else { break };
        let level: Vec<DVec2> =
            heights.iter().filter(|(height, _)| *height <= lowest + LEVEL).map(|(_, at)| *at).collect();
        let middle = level.iter().sum::<DVec2>() / level.len() as f64;
        place.offset += cell * (middle - DVec2::splat(f64::from(REACH)));
    }
    place
}
