//! The paths of a picture.

use super::super::region::REACH;
use super::rings::{CORNERS, Ring, region};
use super::{Measure, ParsedRegion, ReadError};
use catchment::budget::{Budget, Overspent};
use catchment::design::{LengthUnit, Quantity, QuantityUnit, SourceText};
use catchment::diagnostic::{Diagnostic, DiagnosticCollector};
use catchment::xml::svg::{self, SvgShape, UnsupportedSvg};
use glam::DVec2;
use kurbo::{BezPath, PathEl};
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};

/// Curves of a path are replaced by chords that leave them by at most this, in mm.
const CHORD_ERROR: f64 = 0.01;

pub(super) fn read(source: SourceText, stem: String) -> Result<ParsedRegion, ReadError> {
    let (mut found, mut rings, mut curved, mut hidden) =
        (DiagnosticCollector::default(), Vec::new(), false, 0);
    let mut measure = Measure::Millimetres;
    let mut corners = Budget::new(CORNERS);
    match svg::head(&source.text) {
        Err(refusal) => found.push(diagnostic(&source.text, refusal)),
        Ok(head) => {
            if head.get("data-unit").is_some_and(|(unit, _)| unit == "D") {
                measure = Measure::Widths;
            }
            let factor = scale(&head, &mut found);
            hidden = svg::shapes(&source.text, |drawn| {
                match drawn {
                    Err(refusal) => found.push(diagnostic(&source.text, refusal)),
                    Ok(shape) => {
                        let read = element(&shape, factor, &mut corners, &mut rings, &mut found);
                        match read {
                            Ok(is_curved) => curved |= is_curved,
                            Err(over) => {
                                found.push(
                                    Diagnostic::error("region", over.to_string(), None)
                                        .at(Some(shape.tag.head())),
                                );
                                return ControlFlow::Break(());
                            }
                        }
                    }
                }
                ControlFlow::Continue(())
            });
            if found.is_empty() && rings.is_empty() {
                let help = "it needs at least one <path d=\"…\"> that is shown".to_owned();
                found.push(Diagnostic::error("region", "the picture has no path", Some(help)));
            }
        }
    }
    let mut notes = Vec::new();
    if curved {
        let unit = measure.symbol();
        notes.push(format!("curves are replaced by chords that leave them by at most {CHORD_ERROR} {unit}"));
    }
    if hidden > 0 {
        notes.push(format!("{hidden} hidden elements of the picture are left out"));
    }
    region(source, stem, measure, rings, found, notes)
}

/// The error about a part of a picture.
fn diagnostic(text: &str, refusal: UnsupportedSvg) -> Diagnostic {
    let UnsupportedSvg { at, message, help } = refusal;
    // A broken document has a place, but nothing there that is to be shown as a whole.
    let inside = |at: usize| (0..=at.min(text.len())).rev().find(|k| text.is_char_boundary(*k)).unwrap_or(0);
    Diagnostic::error("region", message, Some(help.to_owned()))
        .at(Some(inside(at.start)..inside(at.end.max(at.start))))
}

/// Lengths of a user unit: 1 mm, unless the picture states its width.
fn scale(head: &BTreeMap<&'static str, (String, Range<usize>)>, found: &mut DiagnosticCollector) -> f64 {
    let (Some((width, at)), Some((view, _))) = (head.get("width"), head.get("viewBox")) else {
        return 1.0;
    };
    let across: Option<f64> =
        view.split([' ', ',']).filter(|t| !t.is_empty()).nth(2).and_then(|t| t.parse().ok());
    match (width.parse::<Quantity>(), across) {
        (Ok(Quantity { value, unit: QuantityUnit::Length(unit) }), Some(across))
            if value > 0.0 && across > 0.0 =>
        {
            value * (unit.metres() / LengthUnit::Mm.metres()) / across
        }
        (Ok(Quantity { unit: QuantityUnit::Bare, .. }), _) => 1.0,
        _ if width.ends_with("px") || width.ends_with('%') => 1.0,
        _ => {
            let message = format!("the width of the picture, `{width}`, has no meaning here");
            let help = "write it in mm, with a viewBox".to_owned();
            found.push(Diagnostic::error("region", message, Some(help)).at(Some(at.clone())));
            1.0
        }
    }
}

/// Reads a shape that is drawn; whether it has curves.
fn element(
    shape: &SvgShape<'_>,
    factor: f64,
    corners: &mut Budget,
    rings: &mut Vec<Ring>,
    found: &mut DiagnosticCollector,
) -> Result<bool, Overspent> {
    let name = shape.tag.name();
    if name != "path" {
        let help = "turn shapes into paths in the drawing program".to_owned();
        found.push(
            Diagnostic::error("region", format!("<{name}> is not read"), Some(help))
                .at(Some(shape.tag.head())),
        );
        return Ok(false);
    }
    if let Some(at) = shape.moved.clone() {
        let help = "apply the transforms to the paths in the drawing program".to_owned();
        found.push(Diagnostic::error("region", "a transform is not read", Some(help)).at(Some(at)));
    }
    let Some(data) = shape.tag.attribute("d") else { return Ok(false) };
    if has_huge_numbers(&data.value) {
        let message = "the path has a number that is far too large";
        let help = "check the unit of the picture".to_owned();
        found.push(Diagnostic::error("region", message, Some(help)).at(Some(data.span)));
        return Ok(false);
    }
    match BezPath::from_svg(&data.value) {
        Ok(path) if !within_reach(&path, factor) => {
            let message = format!("the path goes farther from the origin than {REACH} mm");
            let help = "check the width and the viewBox of the picture".to_owned();
            found.push(Diagnostic::error("region", message, Some(help)).at(Some(data.span)));
            Ok(false)
        }
        Ok(path) => {
            path_rings(&path, factor, &data.span, corners, rings, found)?;
            Ok(path.elements().iter().any(|e| matches!(e, PathEl::QuadTo(..) | PathEl::CurveTo(..))))
        }
        Err(error) => {
            let message = format!("the path cannot be read: {error}");
            found.push(Diagnostic::error("region", message, None).at(Some(data.span)));
            Ok(false)
        }
    }
}

/// Whether a number of the path is above anything that could be a length: arcs take longer the larger they are.
fn has_huge_numbers(data: &str) -> bool {
    /// Digits before the point, and tens of an exponent.
    const MOST_DIGITS: usize = 9;
    const MOST_TENS: i64 = 6;
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let long =
        data.split(|c: char| !c.is_ascii_digit() && c != '.').any(|number| digits(number) > MOST_DIGITS);
    let tens = |rest: &str| {
        let unsigned = rest.trim_start_matches('+');
        unsigned[..digits(unsigned)].parse::<i64>().unwrap_or(0)
    };
    long || data.split(['e', 'E']).skip(1).any(|rest| tens(rest) > MOST_TENS)
}

/// Whether a path stays within the range of regions: outside of it any number of chords would be needed.
fn within_reach(path: &BezPath, factor: f64) -> bool {
    let near = |p: &kurbo::Point| (p.x.abs().max(p.y.abs()) * factor) <= REACH;
    path.elements().iter().all(|element| match element {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => near(p),
        PathEl::QuadTo(p, q) => near(p) && near(q),
        PathEl::CurveTo(p, q, r) => near(p) && near(q) && near(r),
        PathEl::ClosePath => true,
    })
}

fn path_rings(
    path: &BezPath,
    factor: f64,
    span: &Range<usize>,
    corners: &mut Budget,
    rings: &mut Vec<Ring>,
    found: &mut DiagnosticCollector,
) -> Result<(), Overspent> {
    let mut ring = Ring::default();
    let mut ended = |ring: &mut Ring, closed: bool| {
        let ring = std::mem::take(ring);
        let (Some((first, _)), Some((last, _))) = (ring.corners.first(), ring.corners.last()) else { return };
        if !closed && first != last {
            let message = format!("the ring that begins at ({}, {}) is open", first.x, first.y);
            let help = "end it with Z, or where it begins".to_owned();
            found.push(Diagnostic::error("region", message, Some(help)).at(Some(span.clone())));
        } else {
            rings.push(ring);
        }
    };
    // Up is +y, and down the picture is not.
    let corner = |p: kurbo::Point| (DVec2::new(p.x, 0.0 - p.y) * factor, span.clone());
    let mut spent = Ok(());
    kurbo::flatten(path, CHORD_ERROR / factor, |element| {
        match element {
            PathEl::MoveTo(p) => {
                ended(&mut ring, false);
                spent = spent.and_then(|()| corners.spend(1));
                if spent.is_ok() {
                    ring.corners.push(corner(p));
                }
            }
            PathEl::LineTo(p) => {
                spent = spent.and_then(|()| corners.spend(1));
                // Corners beyond the limit are not stored.
                if spent.is_ok() {
                    ring.corners.push(corner(p));
                }
            }
            PathEl::ClosePath => ended(&mut ring, true),
            // Flattened paths have no curves.
            PathEl::QuadTo(..) | PathEl::CurveTo(..) => {}
        }
    });
    ended(&mut ring, false);
    spent
}
