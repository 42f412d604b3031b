//! Bearings: directions in the space of the errors along which motions never go back.
//!
//! ```text
//!      │ ↗ ╲ ↗ │     from q no motion goes below the line ╲ through q while all pushes in its boxes point beyond the line:
//!      ├──┄──╲─┤     ℓ(q) = d·q does not fall
//!      │  seat  ╲    faces alone do not bound how far along them a motion went; a path that they permit
//!      └────────┘    may be excluded by the position that it needs
//! ```
//!
//! d runs through the directions to all neighbours of a pose in a lattice of the free errors, in the
//! ρ-metric; for two errors also halfway between them.

use super::interval::Interval;
use super::placed::PoseBox;
use crate::pose::Dof;

/// Directions of the errors, in D of the ρ-metric; no more than a set of them has room for.
#[derive(Debug, Clone)]
pub(super) struct Bearings(Vec<[f64; 5]>);

/// Which of the bearings nothing in a box goes back along.
pub(super) type Rising = u64;

impl Bearings {
    /// For given free errors; `units` is the length of a unit of each in the ρ-metric, in D.
    pub(super) fn of(axes: &[Dof], units: &[f64; 5]) -> Self {
        let steps: &[f64] = if axes.len() <= 2 { &[0.0, 1.0, -1.0, 0.5, -0.5] } else { &[0.0, 1.0, -1.0] };
        // With more than three axes, combine at most two errors, to limit the number of bearings.
        let most = if axes.len() <= 3 { axes.len() } else { 2 };
        let mut all = vec![[0.0; 5]];
        for dof in axes {
            let k = dof.index();
            all = all
                .iter()
                .flat_map(|so_far| {
                    steps.iter().map(move |step| {
                        let mut bearing = *so_far;
                        bearing[k] = step * units[k];
                        bearing
                    })
                })
                .filter(|bearing| bearing.iter().filter(|part| **part != 0.0).count() <= most)
                .collect();
        }
        // Each once: its longest step is whole.
        all.retain(|bearing| {
            let longest = (0..5).map(|k| (bearing[k] / units[k]).abs()).fold(0.0, f64::max);
            (longest - 1.0).abs() < 1e-9
        });
        all.truncate(Rising::BITS as usize);
        Self(all)
    }

    /// How many.
    pub(super) const fn len(&self) -> usize {
        self.0.len()
    }

    /// The bearings along which no push goes back.
    pub(super) fn rising(&self, pushes: &[PoseBox]) -> Rising {
        let rises = |bearing: &[f64; 5]| {
            pushes.iter().all(|push| {
                (0..5).map(|k| push[k] * bearing[k]).fold(Interval::ZERO, |sum, part| sum + part).lo >= 0.0
            })
        };
        self.0.iter().enumerate().filter(|(_, bearing)| rises(bearing)).fold(0, |set, (k, _)| set | 1 << k)
    }

    /// Extent of a box along a bearing: lower and upper end.
    pub(super) fn range(&self, bearing: usize, poses: &PoseBox) -> [f64; 2] {
        let direction = &self.0[bearing];
        let (mut from, mut to) = (0.0, 0.0);
        for (part, errors) in direction.iter().zip(poses) {
            let ends = [part * errors.lo, part * errors.up];
            from += ends[0].min(ends[1]);
            to += ends[0].max(ends[1]);
        }
        [from, to]
    }
}
