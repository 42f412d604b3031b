//! Check of a region by exact motions.
//!
//! A drawing is rounded: faces of a single plane become several planes whose intersections depend on the last
//! digits, and a flow through the resulting slivers may stop wrongly. The flow itself cannot detect this.
//! Therefore exact motions are followed independently, from positions of nested boxes around the mated pose,
//! as the region may be any part of the error box:
//!
//! ```text
//!   ┌───────────────┐
//!   │ ·       ·     │     the same number of places in each box; a box has half the width of the box around it
//!   │   ┌───────┐ · │
//!   │ · │·┌───┐ │   │
//!   │   │ │·:·│·│   │
//!   │   │ └───┘ │ · │
//!   │   └───────┘   │
//!   └───────────────┘
//! ```
//!
//! Positions closer to the region's border than [`TOUCHING`] are ignored. Not promised: parts of the region so
//! small that they contain no position are not checked.

use super::Zraa;
use crate::acceptance::{Domain, Outcome, Stream};
use crate::contact::Pair;
use crate::exec::{Cancelled, Exec};
use crate::method::descent;
use crate::pose::{Dof, DofSet, PoseError};
use crate::tolerance::TOUCHING;
use glam::DVec2;

/// Number of boxes, each of half the width of the one before.
const BOXES: i32 = 4;
/// Places in each.
const PLACES: u64 = 150;
/// Of the places.
const SEED: u64 = 1;

/// Outcomes of the motions.
pub(super) struct Oracle(Vec<(DVec2, bool)>);

impl Oracle {
    /// Follows the motions of a pair without rotation.
    pub(super) fn of(pair: &Pair, exec: &Exec) -> Result<Self, Cancelled> {
        let pair = pair.with_free(DofSet::EMPTY.with(Dof::X).with(Dof::Y));
        let stream = Stream::new(SEED);
        let ranges = DVec2::new(pair.alignment.half_ranges[0], pair.alignment.half_ranges[1]);
        let place = |level: i32, k: u64| {
            let unit = |axis: u64| 2.0 * stream.branch(axis).uniform(level as u64 * PLACES + k) - 1.0;
            DVec2::new(unit(0), unit(1)) * ranges * 0.5f64.powi(level)
        };
        let places: Vec<DVec2> = (0..BOXES)
            .flat_map(|level| (0..PLACES).map(move |k| (level, k)))
            .map(|(l, k)| place(l, k))
            .collect();
        let errors = places.iter().map(|at| PoseError { x: at.x, y: at.y, ..PoseError::default() }).collect();
        let (result, _) =
            descent::run(&pair, Domain::Poses(errors), &descent::DescentSettings::default(), exec)?;
        let known =
            places.into_iter().zip(result.outcomes).filter(|(_, outcome)| *outcome != Outcome::Undecided);
        Ok(Self(known.map(|(at, outcome)| (at, outcome == Outcome::Aligned)).collect()))
    }

    /// Number of checked positions, and number of those that contradict the region.
    pub(super) fn against(&self, region: &Zraa) -> [usize; 2] {
        let aside = [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]
            .map(|(x, y)| DVec2::new(x, y) * TOUCHING);
        let (mut judged, mut differ) = (0, 0);
        for (at, docks) in &self.0 {
            let inside = region.holds(*at);
            if aside.iter().all(|by| region.holds(*at + *by) == inside) {
                judged += 1;
                differ += usize::from(inside != *docks);
            }
        }
        [judged, differ]
    }
}
