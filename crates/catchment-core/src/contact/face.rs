//! Default face centre of a design: both halves are moved to first contact with their face centres together.
//!
//! ```text
//!        ┌───────┐  moving                         z   top of the fixed half          ─┐
//!        │  ┌──┐ │                                     ·  face centre                  │ common heights
//!      ──┘╲╱    └┘                                     bottom of the moving half, mated ─┘
//!   ────╲    ╱───── fixed
//! ```
//!
//! Its height is midway between the bottom of the moving half, lowered to first contact at zero error, and
//! the top of the fixed half. If the halves are drawn assembled, its lateral position is the centre of the
//! box around the parts of both halves in that band, in plan view; halves drawn facing have it on their z
//! axis.
//!
//! Not promised: that first contact is a rest; [`mated`](super::mated) checks this.

use super::Pair;
use super::mated::{CONTACT_TOLERANCE, MatedProblem};
use crate::connector::{Connector, Half};
use crate::design::{Alignment, ConnectorSpec, DrawnFrames, OwnSpec};
use crate::pose::{DofSet, Mount};
use glam::{DVec2, DVec3};

/// Largest distance from first contact at which halves count as drawn docked, in D: more than any play or
/// press fit.
pub(crate) const MOST_APART: f64 = 0.05;

/// The error if halves that should be drawn docked are not.
pub fn misdrawn(connector: &Connector, spec: &ConnectorSpec) -> Option<MatedProblem> {
    let ConnectorSpec::Own(OwnSpec { drawn: DrawnFrames::Assembled { .. }, .. }) = spec else { return None };
    let gap = connector.origin.apart?;
    if gap > MOST_APART {
        Some(MatedProblem::DrawnApart { gap })
    } else {
        (gap < -MOST_APART).then_some(MatedProblem::DrawnDeeper { overlap: -gap })
    }
}

/// The halves of `own`, moved to their common face centre if the design does not state it; unchanged if they
/// pass each other by.
pub fn with_derived_face(connector: Connector, own: &OwnSpec) -> Connector {
    if !own.is_face_unknown() {
        return connector;
    }
    // The mated height does not depend on the alignment problem.
    let pair = Pair::new(&connector, &Alignment::new(DofSet::EMPTY, Mount::X));
    let lift = pair.mated_height();
    if !lift.is_finite() {
        return connector;
    }
    let given = matches!(own.drawn, DrawnFrames::Assembled { face_center: Some(_), .. });
    let center = if given { DVec3::ZERO } else { center(&connector, own.drawn, lift) };
    connector.moved(-center, DVec3::new(0.0, 0.0, lift) - center, -lift)
}

/// The face centre with the moving half lifted by `lift`.
fn center(connector: &Connector, drawn: DrawnFrames, lift: f64) -> DVec3 {
    let Connector { fixed, moving, .. } = connector;
    let ([_, top], [bottom, _]) = (fixed.span(), moving.span());
    // Flat on flat they share a plane.
    let (bottom, top) = (bottom + lift - CONTACT_TOLERANCE, top + CONTACT_TOLERANCE);
    let lateral = match drawn {
        DrawnFrames::Facing => DVec2::ZERO,
        DrawnFrames::Assembled { .. } => {
            let within = |half: &Half, lift: f64| {
                let points = half.surfaces.iter().flat_map(|surface| &surface.vertices);
                let shared = points.filter(|p| (bottom..=top).contains(&(p.z + lift)));
                let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
                shared.fold(none, |[low, high], p| [low.min(p.truncate()), high.max(p.truncate())])
            };
            let ([a, b], [c, d]) = (within(fixed, 0.0), within(moving, lift));
            // Halves that touch have something in the band, and share some of it.
            let middle = a.max(c).midpoint(b.min(d));
            if middle.is_finite() { middle } else { DVec2::ZERO }
        }
    };
    lateral.extend(bottom.midpoint(top))
}
