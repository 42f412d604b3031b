//! Causes why parts do not dock, in the user's terms: the result of each approach as drawn, and errors in the
//! files.
//!
//! ```text
//!   no contact               ──▶ passes through: a stop is missing
//!   contact, and slides off  ──▶ flat: magnets or pins are missing
//!   blocked everywhere       ──▶ interlock: a thread of this lead; a snap, an undercut or an interference of so many mm; something else
//! ```
//!
//! Not promised: that the cause is unique.

use super::halves::file_unit;
use super::sink::{self, ApproachResult, Grain, Triangles, together};
use super::{AxisDirection, PartFile, ProposalSettings};
use catchment_core::connector::Half;
use catchment_core::contact::display_unit::{DisplayUnit, number};
use catchment_core::design::LengthUnit;
use catchment_core::diagnostic::Advice;
use catchment_core::disjoint::DisjointSets;
use glam::DVec3;
use std::collections::HashMap;

/// Note about a seat at another place than the drawn place, for parts that may be assembled.
pub(super) const ELSEWHERE: &str = "in doubt: as drawn, one part lies inside the other without overlap, but is not at rest; another seat was chosen";

/// An assembly shares no volume but for rounding and press fits, as a share of the smaller part's.
const MOST_SHARED: f64 = 0.01;
/// Criterion for an assembly: the share of the moving part's surface that is near the fixed part, within the
/// overlap of the boxes, times the share of the boxes that overlaps, is at least this; if it is less, but the
/// boxes overlap by this share, it may be one.
const LEAST_NEAR: f64 = 0.02;
const LEAST_INSIDE: f64 = 0.25;

/// How two parts are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Frame {
    /// Near or inside each other, without overlap.
    Assembly,
    /// Inside each other, without overlap and far from each other's surface.
    Perhaps,
    /// Each in its own frame.
    Own,
}

/// How parts are drawn.
pub(super) fn frame(parts: [&Triangles; 2], grain: Grain) -> Frame {
    let result = together(parts, grain);
    if result.shared >= MOST_SHARED {
        Frame::Own
    } else if result.near * result.inside >= LEAST_NEAR {
        Frame::Assembly
    } else if result.inside >= LEAST_INSIDE {
        Frame::Perhaps
    } else {
        Frame::Own
    }
}

/// The cause, from the results of each approach, with advice.
pub(super) fn of(
    parts: [&Triangles; 2],
    looks: &[(AxisDirection, ApproachResult)],
    grain: Grain,
    display: DisplayUnit,
) -> (String, Option<Advice>) {
    let text = words(parts, looks, grain, display);
    let stops =
        |drawn: &ApproachResult| matches!(drawn, ApproachResult::Flat { .. } | ApproachResult::Passes);
    let holds = |drawn: &ApproachResult| matches!(drawn, ApproachResult::Holds(_));
    let is_part_missing =
        looks.iter().any(|(_, drawn)| stops(drawn)) && !looks.iter().any(|(_, drawn)| holds(drawn));
    (text, is_part_missing.then_some(Advice::MissingPart))
}

/// The cause in words.
fn words(
    parts: [&Triangles; 2],
    looks: &[(AxisDirection, ApproachResult)],
    grain: Grain,
    display: DisplayUnit,
) -> String {
    if let Some((way, _)) = looks.iter().find(|(_, drawn)| matches!(drawn, ApproachResult::Holds(_))) {
        return format!("as drawn, approach {way}: a lattice sees a seat that exact contact does not hold");
    }
    let flat = looks.iter().find_map(|(way, drawn)| match drawn {
        ApproachResult::Flat { climb } => Some((way, *climb)),
        _ => None,
    });
    if let Some((way, climb)) = flat {
        return format!(
            "as drawn, approach {way}: flat: the parts meet and nothing holds them sideways (the moving part climbs {} before it slides off). Are magnets or \
             pins missing?",
            display.length(climb)
        );
    }
    if let Some((way, _)) = looks.iter().find(|(_, drawn)| matches!(drawn, ApproachResult::Passes)) {
        return format!(
            "as drawn, approach {way}: the moving part meets nothing and passes through: no stop. What does it come to rest on?"
        );
    }
    let apart = looks.iter().filter_map(|(way, drawn)| match drawn {
        ApproachResult::Apart(by) => Some((*by, way)),
        _ => None,
    });
    if let Some((by, way)) = apart.min_by(|a, b| a.0.total_cmp(&b.0)) {
        return format!(
            "as drawn, approach {way}: the parts are {} apart, and where the moving part then meets the fixed one nothing holds it",
            display.length(by)
        );
    }
    let blocked = looks.iter().filter_map(|(way, drawn)| match drawn {
        ApproachResult::Blocked(by) => Some((*by, *way)),
        _ => None,
    });
    let blocked: Vec<(f64, AxisDirection)> = blocked.collect();
    let Some((by, way)) = blocked.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return "as drawn the parts do not meet".to_owned();
    };
    let mut lines = AxisDirection::ALL.into_iter().filter(|way| way.vector().max_element() > 0.0);
    if let Some((way, lead)) = lines.find_map(|way| sink::lead(parts, way, grain).map(|lead| (way, lead))) {
        let hand = if lead > 0.0 { "right" } else { "left" };
        return format!(
            "as drawn the parts are screwed together: a {hand}-handed thread along {way} that moves about {} per turn. No straight way along an axis brings them \
             together: what docks is a part without its thread",
            display.length(lead.abs())
        );
    }
    let ways = blocked.iter().map(|(_, way)| *way);
    let snaps = ways.filter_map(|way| sink::undercut(parts, way, grain).map(|undercut| (undercut, way)));
    match snaps.min_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((undercut, way)) => format!(
            "as drawn the parts interlock: along {way} walls would have to give way by {}: a snap, an undercut or an interference. Both halves are rigid here: \
             draw the catch as it is when it is bent, or leave it out",
            display.length(undercut)
        ),
        None if looks.len() == 1 => format!(
            "as drawn, approach {way}: the moving part meets the fixed one {} before it is where it is drawn",
            display.length(by)
        ),
        None => format!(
            "as drawn the parts interlock: no straight way along an axis brings them together. Nearest is approach {way}, {} short",
            display.length(by)
        ),
    }
}

/// A mistake in the files, and its remedy; lengths of the halves times `scale` are in the unit of the design.
pub(super) fn of_files(
    parts: &[PartFile; 2],
    halves: [&Half; 2],
    settings: &ProposalSettings,
    scale: f64,
) -> Option<String> {
    let [fixed, moving] = halves;
    if settings.with.iter().all(Vec::is_empty)
        && parts[0].written == parts[1].written
        && parts[0].body == parts[1].body
    {
        return Some("both halves are the same file: name the file of the other half".to_owned());
    }
    if is_same(fixed, moving) && settings.with.iter().all(Vec::is_empty) {
        return Some("both files hold the same part: name the file of the other half".to_owned());
    }
    for ((whose, half), with) in ["fixed", "moving"].into_iter().zip(halves).zip(&settings.with) {
        let count = bodies(half);
        if with.is_empty() && count > 1 {
            return Some(format!(
                "the file of the {whose} half holds {count} separate bodies: if both halves are in it, give that file alone; of more than two bodies split it \
                 (MeshLab: Split in Connected Components; PrusaSlicer: Split to objects)"
            ));
        }
    }
    unit(halves, settings, scale)
}

/// Bodies whose boxes are compared in pairs, at most.
const MOST_COMPARED: usize = 2000;

/// How many bodies a half has whose boxes do not lie within each other; all of them if there are more than [`MOST_COMPARED`].
fn bodies(half: &Half) -> usize {
    let mut boxes: Vec<(DVec3, DVec3)> = Vec::new();
    for surface in &half.surfaces {
        // Corners that a facet connects belong to the same body.
        let mut body = DisjointSets::new(surface.vertices.len());
        for facet in &surface.facets {
            for corner in &facet.corners {
                body.join(facet.corners[0], *corner);
            }
        }
        let mut result: HashMap<u32, (DVec3, DVec3)> = HashMap::new();
        for (k, p) in (0..).zip(&surface.vertices) {
            let (low, high) = result.entry(body.find(k)).or_insert((*p, *p));
            (*low, *high) = (low.min(*p), high.max(*p));
        }
        boxes.extend(result.into_values());
    }
    if boxes.len() > MOST_COMPARED {
        return boxes.len();
    }
    let within =
        |a: &(DVec3, DVec3), b: &(DVec3, DVec3)| a.0.cmpge(b.0).all() && a.1.cmple(b.1).all() && a != b;
    boxes.iter().filter(|a| !boxes.iter().any(|b| within(a, b))).count()
}

/// Whether two halves have the same corners.
fn is_same(one: &Half, other: &Half) -> bool {
    let same = |a: &DVec3, b: &DVec3| a.abs_diff_eq(*b, 1e-9);
    one.surfaces.len() == other.surfaces.len()
        && one.surfaces.iter().zip(&other.surfaces).all(|(a, b)| {
            a.vertices.len() == b.vertices.len()
                && a.vertices.iter().zip(&b.vertices).all(|(a, b)| same(a, b))
        })
}

/// Parts that are no longer than this, in millimetres, are rather in inches or metres.
const SHORT: f64 = 6.0;

/// That files without a unit, read as millimetres, are probably in inches or, if the parts would still be short, in metres.
pub(super) fn unit(halves: [&Half; 2], settings: &ProposalSettings, scale: f64) -> Option<String> {
    let longest = halves.map(|half| {
        let (low, high) = half.bounds();
        (high - low).max_element() * scale
    });
    let longest = longest[0].max(longest[1]);
    (file_unit(settings) == LengthUnit::Mm && longest < SHORT).then(|| {
        let (unit, larger) = if longest * 25.4 < SHORT { ("m", 1e3) } else { ("inches", 25.4) };
        let [read, would_be] = [longest, longest * larger].map(number);
        format!("the larger part is {read} mm long: is the file in {unit}? Then it is {would_be} mm long")
    })
}
