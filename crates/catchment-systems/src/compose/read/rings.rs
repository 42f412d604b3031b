//! Closed rings of corners: their errors, and the region inside.

use super::super::region::{REACH, Region, node, turn};
use super::super::sweep::Bracket;
use super::{Measure, ParsedRegion, ReadError};
use catchment::budget::Limit;
use catchment::design::SourceText;
use catchment::diagnostic::{Diagnostic, DiagnosticCollector};
use glam::DVec2;
use std::ops::Range;

/// Most corners of a file: every two sides are compared.
pub(super) const MOST_CORNERS: usize = 10_000;
/// The same as a reading limit.
pub(super) const CORNERS: Limit = Limit {
    most: MOST_CORNERS as u64,
    of: "corners of the outline",
    remedy: "leave corners out that a tenth of a mm does not need",
};

/// A ring as written: its corners, each with its place in the text.
#[derive(Debug, Default, Clone)]
pub(super) struct Ring {
    pub(super) corners: Vec<(DVec2, Range<usize>)>,
}

/// The region inside of rings, or everything that is wrong with them.
pub(super) fn region(
    source: SourceText,
    name: String,
    measure: Measure,
    mut rings: Vec<Ring>,
    mut found: DiagnosticCollector,
    notes: Vec<String>,
) -> Result<ParsedRegion, ReadError> {
    if found.is_empty() {
        for ring in &mut rings {
            ring.corners.dedup_by(|a, b| node(a.0) == node(b.0));
            while ring.corners.len() > 1
                && node(ring.corners[0].0) == node(ring.corners[ring.corners.len() - 1].0)
            {
                ring.corners.pop();
            }
        }
        found = wrong(&rings, measure);
    }
    let mut region = Region::default();
    if found.is_empty() {
        let outlines: Vec<Vec<DVec2>> =
            rings.iter().map(|ring| ring.corners.iter().map(|(p, _)| *p).collect()).collect();
        region = Region::of_outlines(&outlines);
        if region.is_empty() {
            let place = rings.first().and_then(|ring| ring.corners.first()).map(|(_, span)| span.clone());
            let help = "give at least one ring around an area".to_owned();
            found.push(Diagnostic::error("region", "the region has no area", Some(help)).at(place));
        }
    }
    if found.is_empty() {
        return Ok(ParsedRegion { name, region: Bracket::exact(region), measure, notes });
    }
    Err(found.of(source).into())
}

fn shown(p: DVec2) -> String {
    format!("({}, {})", p.x, p.y)
}

/// The error for a file with too many corners.
pub(super) fn too_many() -> Diagnostic {
    let message = format!("the outline has more than {MOST_CORNERS} corners");
    Diagnostic::error("region", message, Some(CORNERS.remedy.to_owned()))
}

fn wrong(rings: &[Ring], measure: Measure) -> DiagnosticCollector {
    let mut found = DiagnosticCollector::default();
    let unit = measure.symbol();
    let corners: usize = rings.iter().map(|ring| ring.corners.len()).sum();
    if corners > MOST_CORNERS {
        found.push(too_many());
        return found;
    }
    for ring in rings {
        for (p, span) in &ring.corners {
            if p.abs().max_element() > REACH {
                let message = format!("{} {unit} is farther from the origin than {REACH} {unit}", shown(*p));
                found.push(
                    Diagnostic::error("region", message, Some("check the unit".to_owned()))
                        .at(Some(span.clone())),
                );
            }
        }
        if ring.corners.len() < 3 {
            let place = ring.corners.first().map(|(_, span)| span.clone());
            let message = format!("the ring is open: it has {} different corners", ring.corners.len());
            found.push(
                Diagnostic::error("region", message, Some("a ring has at least three".to_owned())).at(place),
            );
        }
    }
    if found.is_empty() { crossings(rings) } else { found }
}

/// Pairs of sides that pass through each other, or a side that runs back along its predecessor.
fn crossings(rings: &[Ring]) -> DiagnosticCollector {
    let mut found = DiagnosticCollector::default();
    let side = |ring: &Ring, k: usize| {
        let next = (k + 1) % ring.corners.len();
        [ring.corners[k].0, ring.corners[next].0]
    };
    let all: Vec<(usize, usize)> =
        rings.iter().enumerate().flat_map(|(r, ring)| (0..ring.corners.len()).map(move |k| (r, k))).collect();
    for (later, &(r, k)) in all.iter().enumerate() {
        let ends = side(&rings[r], k);
        let [p, q] = ends.map(node);
        let at = Some(rings[r].corners[k].1.clone());
        let before = side(&rings[r], (k + rings[r].corners.len() - 1) % rings[r].corners.len()).map(node);
        let dot = |[a, b]: [_; 2], [c, d]: [_; 2]| {
            let v = |a: super::super::region::Node, b: super::super::region::Node| {
                [i128::from(b.x) - i128::from(a.x), i128::from(b.y) - i128::from(a.y)]
            };
            let ([ax, ay], [bx, by]) = (v(a, b), v(c, d));
            ax * bx + ay * by
        };
        if turn(before[0], p, q) == 0 && dot(before, [p, q]) < 0 {
            let message = format!("the outline runs back along itself at {}", shown(ends[0]));
            found.push(
                Diagnostic::error("region", message, Some("leave the corner out".to_owned())).at(at.clone()),
            );
        }
        for &(s, j) in &all[..later] {
            let others = side(&rings[s], j);
            let [c, d] = others.map(node);
            if p.x.max(q.x) < c.x.min(d.x) || c.x.max(d.x) < p.x.min(q.x) {
                continue;
            }
            let signs = |a, b, c, d| turn(a, b, c).signum() * turn(a, b, d).signum();
            if signs(p, q, c, d) < 0 && signs(c, d, p, q) < 0 {
                let whose = if r == s { "the outline crosses itself" } else { "two rings cross" };
                // In a star every two sides do.
                found.push_with(|| {
                    let message = format!(
                        "{whose}: the side from {} to {} passes through the one from {} to {}",
                        shown(ends[0]),
                        shown(ends[1]),
                        shown(others[0]),
                        shown(others[1])
                    );
                    let help = "rings may touch but not cross; give the parts of a set as rings of their own";
                    Diagnostic::error("region", message, Some(help.to_owned())).at(at.clone())
                });
            }
        }
    }
    found
}
