//! Zero-rotation area of acceptance: the lateral offsets that contact corrects while rotations are
//! impossible.
//!
//! ```text
//!   h(x, y)  is piecewise linear at R = 1: the upper envelope of the contact sheets
//!   accepted = { (x, y) : the steepest descent of h from there ends in the seat }       (crate::contact::Seat)
//! ```
//!
//! Nothing is sampled: the envelope is divided into convex cells, every cell into the strips of its flow that
//! leave by different borders, and the accepted strips are polygons whose areas add up. In one dimension (one
//! translation locked) the result is an interval; for the planar families these are Nilsson's bounds, ±D/3
//! for the S-Face, ±D/2 for the V-Face and ±D for the X-Face.
//!
//! Some hundreds of exact motions check the region. If they contradict it, rounding of the drawing has
//! disturbed the flow, and the computation is repeated with a coarser seam; if no seam agrees, the result is
//! an error.
//!
//! Exact up to rounding and [`ZraaSettings::seam`] for the solids as given; a cone is the polygon that
//! approximates it. Sets without area (the ridge of a roof) are not decided. Source: the dissertation,
//! section 2.2 (ZRAA); Nilsson for the bounds of planar faces.

mod cells;
mod circle;
mod flow;
mod heights;
mod line;
mod nilsson;
mod oracle;
mod polygon_index;
mod profile;
mod sheet;
mod square;

pub use cells::clip;
pub use circle::circle_bounds;
pub use heights::{HeightFacet, heights, highest};
pub use nilsson::{Catch, Nilsson};
pub use profile::HeightProfile;
pub use sheet::area;
pub use square::{AcceptedSquare, circle_square};

use crate::contact::mated::{MatedProblem, sinking};
use crate::contact::{Pair, Play, Seat, play};
use crate::design::Alignment;
use crate::exec::{Cancelled, Exec};
use crate::pose::{Dof, DofSet, PoseError};
use flow::Flow;
use glam::DVec2;
use oracle::Oracle;
use serde::{Deserialize, Serialize};

/// Most sheets: minutes of cutting, and 100 MB.
const MAX_SHEETS: usize = 400_000;

/// Seams for drawings that are rounded, up to the tenth part of a thousandth of D that no fit notices.
const SEAMS: [f64; 5] = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5];

/// Settings that change the result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ZraaSettings {
    /// Positions closer than this, in D, count as equal. If exact motions over both translations disagree,
    /// coarser seams are tried.
    pub seam: f64,
}

impl Default for ZraaSettings {
    fn default() -> Self {
        // Above the rounding of a few hundred cuts, far below any length that a design has.
        Self { seam: 1e-11 }
    }
}

/// Translations that are corrected without any rotation.
#[derive(Debug, Clone, PartialEq)]
pub enum Zraa {
    /// A single free translation: offsets from `from` to `to` along `axis`, in D.
    Interval {
        /// x or y.
        axis: Dof,
        /// Lower end, at most 0.
        from: f64,
        /// Upper end, at least 0.
        to: f64,
    },
    /// Both translations.
    Region {
        /// Convex polygons that tile the accepted offsets, counter-clockwise, in D.
        polygons: Vec<Vec<DVec2>>,
        /// Their area, in D².
        area: f64,
        /// The seam with which they were cut, in D: gaps of a few seams between them are due to rounding.
        seam: f64,
    },
}

impl Zraa {
    /// Whether an offset is corrected.
    pub fn holds(&self, at: DVec2) -> bool {
        match self {
            Self::Interval { axis, from, to } => {
                (*from..=*to).contains(if *axis == Dof::X { &at.x } else { &at.y })
            }
            Self::Region { polygons, .. } => polygons.iter().any(|corners| {
                let n = corners.len();
                (0..n).all(|k| (corners[(k + 1) % n] - corners[k]).perp_dot(at - corners[k]) >= 0.0)
            }),
        }
    }
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ZraaError {
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Some rests in the seat exceed the docking tolerance.
    #[error(
        "docked.{name} is less than the play of the seat: which offsets end within it is not decided exactly here; \
         use run --free x,y"
    )]
    Limited {
        /// x or y.
        name: &'static str,
    },
    /// Neither x nor y is free.
    #[error("neither x nor y is free: name at least one of them in [alignment] free")]
    NoTranslation,
    /// The halves do not meet in the aligned pose.
    #[error(
        "in the aligned pose the halves pass each other by: check that both are drawn around the approach axis"
    )]
    NoMatedPose,
    /// An offset lets the aligned half sink deeper: it is not a rest.
    #[error(transparent)]
    NotHeld(MatedProblem),
    /// The geometry is too rich.
    #[error("more than {MAX_SHEETS} ways to touch: give a coarser mesh or a larger chord_error")]
    TooManySheets,
    /// Motions contradict the region, with every seam.
    #[error(
        "exact motions from {differ} of {judged} offsets disagree with the region: which offsets are corrected is not decided \
         exactly here; use run --free x,y"
    )]
    Disputed {
        /// Number of checked offsets.
        judged: usize,
        /// Number of those that contradict the region.
        differ: usize,
    },
    /// The subdivision is not consistent.
    #[error(
        "the motion over {cells} cells does not come to an end: the geometry has details below the seam of {seam:.1e} D"
    )]
    Tangled {
        /// How many cells there are.
        cells: usize,
        /// The seam, in D.
        seam: f64,
    },
}

/// The zero-rotation area of acceptance of a pair, over those of x and y that are free.
pub fn run(pair: &Pair, settings: &ZraaSettings, exec: &Exec) -> Result<Zraa, ZraaError> {
    let Alignment { free, docked, .. } = &pair.alignment;
    let cut =
        play(pair).into_iter().find(|play| docked.limit(play.axis).is_some_and(|limit| play.most() > limit));
    if let Some(Play { axis, .. }) = cut.filter(|play| !play.axis.is_rotation()) {
        return Err(ZraaError::Limited { name: axis.name() });
    }
    if pair.mated_height() == f64::NEG_INFINITY {
        return Err(ZraaError::NoMatedPose);
    }
    if let Some(sinks) = sinking(pair, DofSet::EMPTY.with(Dof::X).with(Dof::Y)) {
        return Err(ZraaError::NotHeld(sinks));
    }
    let sheets =
        sheet::sheets(&pair.fixed, &pair.moving, MAX_SHEETS, exec)?.ok_or(ZraaError::TooManySheets)?;
    let (axis, direction) = match (free.contains(Dof::X), free.contains(Dof::Y)) {
        (true, true) => return judged(pair, &sheets, settings.seam, exec),
        (true, false) => (Dof::X, DVec2::X),
        (false, true) => (Dof::Y, DVec2::Y),
        (false, false) => return Err(ZraaError::NoTranslation),
    };
    let [from, to] = line::interval(&sheets, direction, docked.depth, settings.seam);
    Ok(Zraa::Interval { axis, from, to })
}

/// The region of the first seam that exact motions agree with.
fn judged(pair: &Pair, sheets: &[sheet::Sheet], seam: f64, exec: &Exec) -> Result<Zraa, ZraaError> {
    let judge = Oracle::of(pair, exec)?;
    let mut refused = None;
    for seam in std::iter::once(seam).chain(SEAMS.into_iter().filter(|coarser| *coarser > seam)) {
        match region(pair, sheets, seam, exec) {
            Ok(region) => match judge.against(&region) {
                [_, 0] => return Ok(region),
                [judged, differ] => refused = Some(ZraaError::Disputed { judged, differ }),
            },
            Err(error @ ZraaError::Tangled { .. }) => refused = refused.or(Some(error)),
            Err(error) => return Err(error),
        }
    }
    Err(refused.unwrap_or(ZraaError::Tangled { cells: 0, seam }))
}

fn region(pair: &Pair, sheets: &[sheet::Sheet], seam: f64, exec: &Exec) -> Result<Zraa, ZraaError> {
    let cells = cells::upper_envelope(sheets, seam, exec)?;
    let borders = cells::borders(&cells, seam, exec)?;
    let mut seat = Seat::new(pair);
    let docked = |at: DVec2, height: f64| {
        seat.holds(&PoseError { x: at.x, y: at.y, ..PoseError::default() }, height - 20.0 * seam)
    };
    let mut flow = Flow::new(sheets, &cells, &borders, seam, docked);
    let mut polygons = Vec::new();
    for (k, cell) in cells.iter().enumerate() {
        exec.check()?;
        for strip in flow.strips(k).into_iter().filter(|s| s.accepted) {
            let mut part = cell.polygon.clone();
            if strip.from.is_finite() {
                part = cells::clip(&part, |p| flow.across(k, p) - strip.from);
                part = cells::clip(&part, |p| strip.to - flow.across(k, p));
            }
            // Cuts through a corner leave it twice.
            part.dedup_by(|a, b| a.distance(*b) <= seam);
            while part.len() > 1 && part[0].distance(part[part.len() - 1]) <= seam {
                part.pop();
            }
            if part.len() >= 3 {
                polygons.push(part);
            }
        }
    }
    if flow.tangled {
        return Err(ZraaError::Tangled { cells: cells.len(), seam });
    }
    let area = polygons.iter().map(|p| sheet::area(p)).sum();
    Ok(Zraa::Region { polygons, area, seam })
}

#[cfg(test)]
mod tests;
