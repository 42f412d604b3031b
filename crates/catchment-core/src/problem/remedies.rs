//! Advice for halves that do not mate as drawn: the contact point, in the coordinates of each part, and
//! whether a mirror image would fit.
//!
//! ```text
//!      ┌─────┐            first contact without pose error: a web in the way, a rim beside its hole
//!      │   ┌─┘ ●──┐
//!   ───┘   └─     └───
//! ```
//!
//! If only a narrow feature separates the halves, such as a web or a pin, the advice names that feature
//! instead.
//!
//! Not promised: that this place is the only obstacle, or that halves which fit mirrored were meant to be
//! mirrored.

use crate::connector::{Connector, Half, HalfRole};
use crate::contact::display_unit::{DisplayUnit, number};
use crate::contact::height_map::{self, HeightMap};
use crate::contact::mated::{CONTACT_TOLERANCE, MatedProblem, sinking};
use crate::contact::{Pair, face, settle};
use crate::design::{ConnectorSpec, Design};
use glam::{DMat3, DVec2, DVec3};

/// A mirror image has to lie deeper than the halves as drawn by so much to be worth a word, in D.
const DEEPER: f64 = 0.01;

/// Halves drawn no farther than this from touching, in D, may be meant to rest there.
const NEAR: f64 = 0.01;

/// Largest number of cells across either half of the lattice for the search of narrow features.
const MOST_CELLS: f64 = 400.0;

/// Additional advice for a problem.
pub(super) fn advice(
    connector: &Connector,
    pair: &Pair,
    design: &Design,
    problem: &MatedProblem,
) -> Option<String> {
    if !matches!(design.connector, ConnectorSpec::Own(_)) {
        return None;
    }
    let display = match problem {
        MatedProblem::Collision { overlap } | MatedProblem::DrawnDeeper { overlap } => {
            touching(connector, pair, design, Some(*overlap))
        }
        MatedProblem::Gap { gap } | MatedProblem::DrawnApart { gap } => {
            touching(connector, pair, design, Some(-gap))
        }
        MatedProblem::NotMinimum { .. } | MatedProblem::Free { .. } => {
            narrow(connector, design).or_else(|| touching(connector, pair, design, None))
        }
        MatedProblem::Apart => Some(beside(connector, design)),
        _ => None,
    }?;
    let mirrored = if fits_mirrored(connector, pair, problem) {
        "; a mirror image of the moving part would fit: was one of the two exported mirrored?"
    } else {
        ""
    };
    let settles = settles(pair, design, problem).unwrap_or_default();
    Some(format!("{display}{mirrored}{settles}"))
}

/// Remedy for halves drawn slightly too deep, or not deep enough: the rest that they reach.
fn settles(pair: &Pair, design: &Design, problem: &MatedProblem) -> Option<String> {
    let (MatedProblem::Collision { overlap: off } | MatedProblem::Gap { gap: off }) = problem else {
        return None;
    };
    let ConnectorSpec::Own(own) = &design.connector else { return None };
    if own.settle || *off > NEAR {
        return None;
    }
    let rest = DisplayUnit::of(design).error(&settle::rest(pair)?);
    Some(format!(
        "; released there they come to rest at {rest}: settle = true in [connector] takes that pose as mated"
    ))
}

/// Whether a narrow feature of one part keeps the other from a seat.
fn narrow(connector: &Connector, design: &Design) -> Option<String> {
    let halves = [&connector.fixed, &connector.moving];
    let cell = height_map::NARROW * halves.map(Half::middle_extent).into_iter().fold(f64::INFINITY, f64::min);
    // Beside a plate a pin is narrow by itself.
    let wide = halves.map(Half::bounds).map(|(low, high)| (high - low).truncate().max_element());
    let cell = wide.into_iter().map(|wide| wide / MOST_CELLS).fold(cell, f64::max);
    let top = HeightMap::centered(halves[0], &DMat3::IDENTITY, 1.0, cell);
    let bottom = HeightMap::centered(halves[1], &DMat3::IDENTITY, -1.0, cell);
    let moved = ((bottom.first - top.first) / cell).round().as_ivec2().to_array();
    let result = height_map::in_the_way(&top, &bottom, moved, cell)?;
    // The height map of the moving half has its origin at the face centre.
    let at = [HalfRole::Fixed, HalfRole::Moving]
        .map(|side| place(design, connector.origin.drawn(side, result.at[side as usize])));
    Some(height_map::in_words(&result, &at, DisplayUnit::of(design)))
}

/// First contact of the halves at zero error, and its height above the drawn pose.
fn touching(connector: &Connector, pair: &Pair, design: &Design, above: Option<f64>) -> Option<String> {
    let height = pair.mated_height();
    let mut nearby = pair.about(CONTACT_TOLERANCE);
    nearby.turn(&DMat3::IDENTITY, DVec2::ZERO, 0.0, 0.0);
    let mut contacts = Vec::new();
    nearby.contacts_within(DVec3::new(0.0, 0.0, height), CONTACT_TOLERANCE, CONTACT_TOLERANCE, &mut contacts);
    let (contact, _) = contacts.first()?;
    // Of the moving half from its face centre, which hangs below the centre of rotation or above it.
    let from_face = contact.point - DVec3::new(0.0, 0.0, height + pair.alignment.center_of_rotation);
    let [fixed, moving] = [(HalfRole::Fixed, contact.point), (HalfRole::Moving, from_face)]
        .map(|(side, point)| place(design, connector.origin.drawn(side, point)));
    let display = DisplayUnit::of(design);
    let off = above.map_or_else(String::new, |above| {
        let way = if above > 0.0 { "above" } else { "below" };
        format!(", {} {way} where they are drawn", display.length(above.abs()))
    });
    Some(format!(
        "lowered without any error they first touch at {fixed} of the fixed and {moving} of the moving part as drawn{off}"
    ))
}

/// Extent of each half in plan view.
fn beside(connector: &Connector, design: &Design) -> String {
    let DisplayUnit { scale, unit } = DisplayUnit::of(design);
    let reach = |half: &Half| {
        let (low, high) = half.bounds();
        let [a, b, c, d] = [low.x, high.x, low.y, high.y].map(|x| number(scale * x));
        format!("x {a} … {b}, y {c} … {d} {unit}")
    };
    format!(
        "across the approach the fixed half reaches {}, the moving one {}",
        reach(&connector.fixed),
        reach(&connector.moving)
    )
}

/// Whether the moving half reflected across a plane along the approach has a stable mated pose although the
/// drawn half has none.
fn fits_mirrored(connector: &Connector, pair: &Pair, problem: &MatedProblem) -> bool {
    let deeper = match problem {
        // As deep as drawn.
        MatedProblem::DrawnDeeper { overlap } | MatedProblem::Collision { overlap } => {
            [overlap - face::MOST_APART, overlap + face::MOST_APART]
        }
        MatedProblem::NotMinimum { .. } => [DEEPER, f64::INFINITY],
        _ => return false,
    };
    let (low, high) = connector.moving.bounds();
    let middle = low.midpoint(high);
    [DVec3::X, DVec3::Y].into_iter().any(|across| {
        let image = connector.moving.reflected(|p| p - 2.0 * across * (p - middle).dot(across));
        let mirrored = Pair::new(&Connector::from_halves(connector.fixed.clone(), image), &pair.alignment);
        let sinks = pair.mated_height() - mirrored.mated_height();
        (deeper[0]..=deeper[1]).contains(&sinks) && sinking(&mirrored, pair.alignment.free).is_none()
    })
}

fn place(design: &Design, point: DVec3) -> String {
    let DisplayUnit { scale, unit } = DisplayUnit::of(design);
    let [x, y, z] = (point * scale).to_array().map(number);
    format!("({x}, {y}, {z}) {unit}")
}
