//! Slices of the accepted set, as the background of a plan's poses.
//!
//! ```text
//!   two errors across a panel, the others as the poses have them:  yaw 0°      yaw 6°      yaw 12°
//!                                                                  ░░░│        ░░░│        ░░│
//!                                                                  ·•·│o       ·•·│o       ·•│o
//! ```
//!
//! The horizontal and vertical errors are the first two that vary. Poses whose other errors agree within the
//! accuracy of the robot share a slice, which lies at their mean. If that needs too many slices, the poses
//! are projected along their other errors, over every pair of errors that vary, and no region is drawn under
//! them: the region of any slice would be wrong for most of them.

use super::border::DockingOracle;
use super::prediction::for_each;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::problem::Problem;
use catchment_core::tolerance::SINGLE;

/// A slice, or a projection.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchSlice {
    /// The horizontal and vertical errors, and their ranges in D or radians; a planar panel has a single
    /// error.
    pub across: Vec<(Dof, [f64; 2])>,
    /// The others that are not zero in all poses, from the least to the largest value that a pose in it has.
    pub others: Vec<(Dof, [f64; 2])>,
    /// Whether the centres of its cells dock, row by row from below, the others at the middle of their ranges; empty of a projection.
    pub cells: Vec<bool>,
    /// Numbers of the poses that are seen in it.
    pub poses: Vec<usize>,
}

/// Cells along an error of a panel.
pub const CELLS: usize = 96;
/// Most slices.
const MOST: usize = 9;
/// Most projections.
const MOST_PROJECTIONS: usize = 6;
/// Room around the poses of a panel, as a share of their extent.
const ROOM: f64 = 0.25;

impl BenchSlice {
    /// Whether its poses are projected: they have any values of the others, and no region belongs to all of them.
    pub fn is_projection(&self) -> bool {
        self.cells.is_empty()
    }

    /// The value of another error at which a slice lies, and the largest distance of its poses from that
    /// value; `None` if they lie on it.
    pub fn middle([lo, hi]: [f64; 2]) -> (f64, Option<f64>) {
        (f64::midpoint(lo, hi), (hi - lo > SINGLE).then_some(0.5 * (hi - lo)))
    }

    /// With the poses of these numbers in it.
    fn of(problem: &Problem, across: &[Dof], numbers: Vec<usize>, poses: &[PoseError]) -> Self {
        let others = problem.alignment().free.iter().filter(|axis| !across.contains(axis));
        let others = others.map(|axis| {
            let values = numbers.iter().map(|k| poses[*k].to_array()[axis.index()]);
            let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], v| [lo.min(v), hi.max(v)]);
            (axis, ends)
        });
        let is_zero = |axis: Dof| poses.iter().all(|pose| pose.to_array()[axis.index()].abs() <= SINGLE);
        Self {
            across: across.iter().map(|axis| (*axis, range(problem, *axis, poses))).collect(),
            others: others.filter(|(axis, _)| !is_zero(*axis)).collect(),
            cells: Vec::new(),
            poses: numbers,
        }
    }
}

/// Slices that show these poses, for a robot of this `accuracy` (D and radians); projections if there would
/// be too many.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub fn panels(
    problem: &Problem,
    poses: &[PoseError],
    accuracy: &PoseError,
    motions: &descent::DescentSettings,
    exec: &Exec,
) -> Result<Vec<BenchSlice>, Cancelled> {
    let varies = |axis: &Dof| {
        let value = |pose: &PoseError| pose.to_array()[axis.index()];
        poses.iter().any(|pose| (value(pose) - poses.first().map_or(0.0, value)).abs() > SINGLE)
    };
    let mut axes: Vec<Dof> = problem.alignment().free.iter().filter(varies).collect();
    if axes.is_empty() {
        axes = problem.alignment().free.iter().collect();
    }
    let (across, beside) = axes.split_at(axes.len().min(2));
    let Some(groups) = grouped(poses, beside, accuracy) else {
        let pairs = (0..axes.len()).flat_map(|j| (j + 1..axes.len()).map(move |k| [j, k]));
        let all = || (0..poses.len()).collect();
        let projection = |[j, k]: [usize; 2]| BenchSlice::of(problem, &[axes[j], axes[k]], all(), poses);
        return Ok(pairs.take(MOST_PROJECTIONS).map(projection).collect());
    };
    let mut panels: Vec<BenchSlice> =
        groups.into_iter().map(|numbers| BenchSlice::of(problem, across, numbers, poses)).collect();
    let rows = if across.len() > 1 { CELLS } else { 1 };
    let cells = for_each(
        rows * panels.len(),
        exec,
        || DockingOracle::new(problem, motions),
        |judge, job| {
            let (panel, row) = (&panels[job / rows], job % rows);
            let mut pose = [0.0; 5];
            for (axis, ends) in &panel.others {
                pose[axis.index()] = BenchSlice::middle(*ends).0;
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
    // If all poses lie on one side of zero, the other side needs little room.
    let below = if lo < 0.0 { room } else { 0.2 * room };
    let above = if hi > 0.0 { room } else { 0.2 * room };
    [lo - below, hi + above]
}

/// The numbers of the poses whose errors along `axes` agree within the accuracy, ordered by these errors; `None` for too many groups.
fn grouped(poses: &[PoseError], axes: &[Dof], accuracy: &PoseError) -> Option<Vec<Vec<usize>>> {
    let of = |pose: &PoseError, axis: &Dof| pose.to_array()[axis.index()];
    let near = |a: &PoseError, b: &PoseError| {
        axes.iter().all(|axis| (of(a, axis) - of(b, axis)).abs() <= of(accuracy, axis).max(SINGLE))
    };
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (number, pose) in poses.iter().enumerate() {
        match groups.iter().position(|group| near(&poses[group[0]], pose)) {
            Some(k) => groups[k].push(number),
            None if groups.len() == MOST => return None,
            None => groups.push(vec![number]),
        }
    }
    groups.sort_by(|a, b| {
        let [a, b] = [a, b].map(|group| &poses[group[0]]);
        let order = axes.iter().map(|axis| of(a, axis).total_cmp(&of(b, axis)));
        order.into_iter().find(|order| order.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    });
    Some(groups)
}
