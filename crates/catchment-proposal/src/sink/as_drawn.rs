//! Behaviour of two parts drawn in a common frame: along each of six approaches, near the pose in which they
//! are drawn.
//!
//! ```text
//!   h near offset 0  ──▶ no contact: passes through      h(0) far above or below: blocked, apart
//!                   └──▶ the lowest offset nearby, and the climb from it: holds, or flat
//! ```

use super::height::{NOTHING, PartHeights};
use super::refine::Window;
use super::{Grain, Sunk, Triangles};
use crate::layout::{AxisDirection, PartLayout};
use glam::{DMat3, DVec2, DVec3};

/// Result of an approach, lengths in the unit of the parts.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ApproachResult {
    /// It sinks into a seat.
    Holds(Sunk),
    /// It meets nothing.
    Passes,
    /// It meets something, and slides off it.
    Flat {
        /// Largest climb.
        climb: f64,
    },
    /// It meets an obstacle at this height above the drawn pose.
    Blocked(f64),
    /// It meets an obstacle at this depth below the drawn pose.
    Apart(f64),
}

/// Largest distance of first contact from the drawn pose, along the approach and across it, in small lengths:
/// 6 and 1.2 mm.
const ALONG: f64 = 12.0;
const ACROSS: f64 = 2.4;

/// Factor of the search range for a climb, on a lattice coarser by the same factor.
const WIDER: f64 = 8.0;
/// Search ranges across the approach, the nearest first.
const REACHES: [f64; 3] = [0.4, 1.2, ACROSS];

/// The moving part let down as drawn, along an approach. `any` distance along it may be allowed.
pub(crate) fn drawn(parts: [&Triangles; 2], way: AxisDirection, any: bool, grain: Grain) -> ApproachResult {
    let lie = PartLayout::as_drawn(way);
    let (mut flat, mut off, mut passes) = (None, None, false);
    // A plug exactly as wide as its hole fits after it is eroded by a cell.
    for worn in [0, 1] {
        let window = Window::around(parts, lie.turns(), DVec2::ZERO, worn, grain);
        if window.z[window.z.len() / 2] == NOTHING {
            passes = true;
            continue;
        }
        for reach in REACHES {
            let Some(start) = window.lowest(DVec2::ZERO, reach * grain.small) else { continue };
            let height = f64::from(window.z[start]);
            if !any && height.abs() > ALONG * grain.small {
                let far = if height > 0.0 {
                    ApproachResult::Blocked(height)
                } else {
                    ApproachResult::Apart(-height)
                };
                off = off.or(Some(far));
                continue;
            }
            let mut climb = window.climb(start);
            if climb < grain.least_climb() {
                flat = flat.or(Some(ApproachResult::Flat { climb }));
                continue;
            }
            let floor = window.floor(start, climb, grain);
            let (offset, play, is_loose) = (floor.middle, floor.play, floor.is_loose);
            if offset.length() > ACROSS * grain.small {
                continue;
            }
            // The climb of a wide part continues beyond the window.
            let wide =
                Window::around(parts, lie.turns(), DVec2::ZERO, 0, Grain { small: WIDER * grain.small });
            if let Some(start) = wide.lowest(offset, 0.5 * WIDER * grain.small) {
                climb = climb.max(wide.climb(start));
            }
            let steep = climb / (grain.small + play);
            return ApproachResult::Holds(Sunk {
                lie,
                offset,
                height,
                climb,
                play,
                is_loose,
                steep,
                cell: window.cell,
            });
        }
    }
    if passes { ApproachResult::Passes } else { flat.or(off).unwrap_or(ApproachResult::Passes) }
}

/// Relative position of two parts in a common frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Together {
    /// The volume that both fill, as a share of the smaller part's.
    pub(crate) shared: f64,
    /// Share of the moving part's surface, within the overlap of the boxes, that is near the fixed part's.
    pub(crate) near: f64,
    /// The volume that both boxes share, as a share of the smaller box's.
    pub(crate) inside: f64,
}

/// Largest distance of near surfaces, in small lengths.
const NEAR: f64 = 1.2;

/// Relative position of two parts in a common frame, by columns along each axis in the overlap of their
/// boxes.
pub(crate) fn together(parts: [&Triangles; 2], grain: Grain) -> Together {
    const COLUMNS: f64 = 100.0;
    let all = parts.map(volume).into_iter().fold(f64::INFINITY, f64::min);
    let boxes = parts.map(|part| PartHeights::bounds(part, &DMat3::IDENTITY));
    let [a, b] = boxes.map(|(low, high)| (high - low).element_product());
    let common_box = (boxes[0].1.min(boxes[1].1) - boxes[0].0.max(boxes[1].0)).max(DVec3::ZERO);
    let inside = common_box.element_product() / a.min(b);
    let (mut shared, mut near, mut count) = (0.0, 0usize, 0usize);
    for axis in 0..3 {
        let turn =
            DMat3::from_cols(DVec3::AXES[axis], DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
        let bounds = parts.map(|part| PartHeights::bounds(part, &turn));
        let slack = DVec3::splat(NEAR * grain.small);
        let (low, high) = (bounds[0].0.max(bounds[1].0) - slack, bounds[0].1.min(bounds[1].1) + slack);
        if high.cmple(low).any() {
            return Together { shared: 0.0, near: 0.0, inside };
        }
        // Off the round numbers at which parts have their corners.
        let cell = ((high - low).truncate().max_element() / COLUMNS).max(0.1 * grain.small);
        let first = low.truncate() + cell * DVec2::new(0.4837, 0.4391);
        let counts = [0, 1].map(|k| ((high[k] - low[k]) / cell).ceil() as usize);
        let [a, b] = parts.map(|part| columns(part, &turn, first, cell, counts));
        for (a, b) in a.iter().zip(&b) {
            shared += common(a, b) * cell * cell / 3.0;
            for z in b.iter().filter(|z| (low.z..=high.z).contains(*z)) {
                count += 1;
                near += usize::from(a.iter().any(|other| (other - z).abs() <= NEAR * grain.small));
            }
        }
    }
    Together { shared: shared / all, near: near as f64 / count.max(1) as f64, inside }
}

fn volume(part: &Triangles) -> f64 {
    part.iter().map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0).sum::<f64>().abs()
}

/// Intersections of each column of a lattice with a part.
pub(super) fn columns(
    part: &Triangles,
    turn: &DMat3,
    first: DVec2,
    cell: f64,
    counts: [usize; 2],
) -> Vec<Vec<f64>> {
    let mut all = vec![Vec::new(); counts[0] * counts[1]];
    for corners in part.iter().map(|corners| corners.map(|p| *turn * p)) {
        let plan = corners.map(|p: DVec3| (p.truncate() - first) / cell);
        let area = (plan[1] - plan[0]).perp_dot(plan[2] - plan[0]);
        if area == 0.0 {
            continue;
        }
        let (low, high) = (plan[0].min(plan[1]).min(plan[2]), plan[0].max(plan[1]).max(plan[2]));
        let range = |k: usize| {
            let last = (counts[k] as f64 - 1.0).min(high[k].floor());
            low[k].ceil().max(0.0) as usize..if last < 0.0 { 0 } else { last as usize + 1 }
        };
        for (i, j) in range(1).flat_map(|j| range(0).map(move |i| (i, j))) {
            let p = DVec2::new(i as f64, j as f64);
            let share = |k: usize| (plan[(k + 1) % 3] - p).perp_dot(plan[(k + 2) % 3] - p) / area;
            let shares = [share(0), share(1), share(2)];
            if shares.iter().all(|share| *share >= 0.0) {
                let z = (0..3).map(|k| shares[k] * corners[k].z).sum();
                all[j * counts[0] + i].push(z);
            }
        }
    }
    for column in &mut all {
        column.sort_by(f64::total_cmp);
    }
    all
}

/// The length that lies in both of two columns: between the first and second crossing, the third and fourth, and so on.
pub(super) fn common(a: &[f64], b: &[f64]) -> f64 {
    let pairs = |column: &[f64]| -> Vec<[f64; 2]> { column.as_chunks::<2>().0.to_vec() };
    let (a, b) = (pairs(a), pairs(b));
    a.iter().flat_map(|a| b.iter().map(|b| (a[1].min(b[1]) - a[0].max(b[0])).max(0.0))).sum()
}
