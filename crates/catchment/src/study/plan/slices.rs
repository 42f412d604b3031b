//! Slices of what docks, for the poses of a plan to be seen in.
//!
//! ```text
//!   two errors across a panel, the others as the poses have them:  yaw 0°      yaw 6°      yaw 12°
//!                                                                  ░░░│        ░░░│        ░░│
//!                                                                  ·•·│o       ·•·│o       ·•│o
//! ```
//!
//! The errors across are the first two that vary. Of the others every combination that occurs has its panel; where there are too many of
//! them, panels stand at some values, and a pose is seen in the nearest.

use super::border::Judge;
use super::foretold::for_each;
use crate::exec::{Cancelled, Exec};
use crate::method::descent;
use crate::pose::{Dof, PoseError};
use crate::problem::Problem;

/// A slice.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The errors across and up, and their ranges in D or radians; a planar panel has one of them.
    pub across: Vec<(Dof, [f64; 2])>,
    /// The others that vary, at these values.
    pub at: Vec<(Dof, f64)>,
    /// Whether the poses in it are at these values, or only nearer to them than to those of other panels.
    pub exact: bool,
    /// Whether the centres of its cells dock, row by row from below.
    pub cells: Vec<bool>,
    /// Numbers of the poses that are seen in it.
    pub poses: Vec<usize>,
}

/// Cells along an error of a panel.
pub const CELLS: usize = 96;
/// Most panels.
const MOST: usize = 6;
/// Panels where poses do not lie in planes.
const SOME: usize = 4;
/// Values nearer than this are the same, in D or radians.
const SAME: f64 = 1e-6;
/// Room around the poses of a panel, as a share of their extent.
const ROOM: f64 = 0.25;

/// Slices that show these poses.
///
/// # Errors
/// [`Cancelled`] when asked to stop.
pub fn panels(
    problem: &Problem,
    poses: &[PoseError],
    motions: &descent::Settings,
    exec: &Exec,
) -> Result<Vec<Panel>, Cancelled> {
    let varies = |axis: &Dof| {
        let value = |pose: &PoseError| pose.to_array()[axis.index()];
        poses.iter().any(|pose| (value(pose) - poses.first().map_or(0.0, value)).abs() > SAME)
    };
    let mut axes: Vec<Dof> = problem.alignment().free.iter().filter(varies).collect();
    if axes.is_empty() {
        axes = problem.alignment().free.iter().collect();
    }
    let beside = axes.split_off(axes.len().min(2));
    let across: Vec<(Dof, [f64; 2])> =
        axes.iter().map(|axis| (*axis, range(problem, *axis, poses))).collect();
    let fixed: Vec<Dof> = problem.alignment().free.iter().filter(|axis| !axes.contains(axis)).collect();
    let (values, exact) = values(poses, &beside);
    let mut panels: Vec<Panel> = values
        .into_iter()
        .map(|at| Panel {
            across: across.clone(),
            at: beside.iter().copied().zip(at).collect(),
            exact,
            cells: Vec::new(),
            poses: Vec::new(),
        })
        .collect();
    for (number, pose) in poses.iter().enumerate() {
        let off = |panel: &Panel| {
            panel.at.iter().map(|(axis, value)| (pose.to_array()[axis.index()] - value).abs()).sum::<f64>()
        };
        let nearest = panels.iter_mut().min_by(|a, b| off(a).total_cmp(&off(b)));
        if let Some(panel) = nearest {
            panel.poses.push(number);
        }
    }
    panels.retain(|panel| !panel.poses.is_empty());
    let rows = if across.len() > 1 { CELLS } else { 1 };
    let count = panels.len();
    let cells = for_each(
        rows * count,
        exec,
        || Judge::new(problem, motions),
        |judge, job| {
            let (panel, row) = (&panels[job / rows], job % rows);
            // What neither varies nor lies across is as the first pose has it.
            let first = panel.poses.first().map_or([0.0; 5], |k| poses[*k].to_array());
            let mut pose = [0.0; 5];
            for axis in &fixed {
                pose[axis.index()] = first[axis.index()];
            }
            for (axis, value) in &panel.at {
                pose[axis.index()] = *value;
            }
            let center = |range: &[f64; 2], k: usize| {
                range[0] + (range[1] - range[0]) * (k as f64 + 0.5) / CELLS as f64
            };
            (0..CELLS)
                .map(|column| {
                    for ((axis, range), k) in panel.across.iter().zip([column, row]) {
                        pose[axis.index()] = center(range, k);
                    }
                    judge.docks(&PoseError::from_array(pose))
                })
                .collect::<Vec<bool>>()
        },
    )?;
    for (panel, rows) in panels.iter_mut().zip(cells.chunks(rows)) {
        panel.cells = rows.concat();
    }
    Ok(panels)
}

/// From the least to the largest value, zero, and some room.
fn range(problem: &Problem, axis: Dof, poses: &[PoseError]) -> [f64; 2] {
    let values = poses.iter().map(|pose| pose.to_array()[axis.index()]);
    let [lo, hi] = values.fold([0.0f64, 0.0f64], |[lo, hi], v| [lo.min(v), hi.max(v)]);
    let room = ROOM * (hi - lo);
    if room == 0.0 {
        let half = problem.alignment().half_range(axis);
        return [-half, half];
    }
    // Room on the side of zero is wasted where all poses are on the other.
    let below = if lo < 0.0 { room } else { 0.2 * room };
    let above = if hi > 0.0 { room } else { 0.2 * room };
    [lo - below, hi + above]
}

/// The values of the other errors at which panels stand, and whether all poses have one of them.
fn values(poses: &[PoseError], axes: &[Dof]) -> (Vec<Vec<f64>>, bool) {
    let of =
        |pose: &PoseError| -> Vec<f64> { axes.iter().map(|axis| pose.to_array()[axis.index()]).collect() };
    let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME);
    let mut met: Vec<Vec<f64>> = Vec::new();
    for pose in poses {
        let at = of(pose);
        if !met.iter().any(|known| same(known, &at)) {
            met.push(at);
        }
        if met.len() > MOST {
            break;
        }
    }
    met.sort_by(|a, b| {
        a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    });
    if met.len() <= MOST {
        return (met, true);
    }
    // Along the first of them, the others at 0.
    let mut along: Vec<f64> = poses.iter().map(|pose| pose.to_array()[axes[0].index()]).collect();
    along.sort_by(f64::total_cmp);
    let middle = |k: usize| {
        let at = along[(2 * k + 1) * along.len() / (2 * SOME)];
        std::iter::once(at).chain(std::iter::repeat_n(0.0, axes.len() - 1)).collect::<Vec<f64>>()
    };
    let mut found: Vec<Vec<f64>> = (0..SOME).map(middle).collect();
    found.dedup_by(|a, b| same(a, b));
    (found, false)
}
