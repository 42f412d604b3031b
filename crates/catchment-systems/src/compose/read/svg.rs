//! The paths of a picture.

use super::super::region::REACH;
use super::rings::{MOST_CORNERS, Ring, region};
use super::{Measure, Read, ReadError};
use catchment::design::{Finding, Found, LengthUnit, Quantity, SourceText, Unit};
use glam::DVec2;
use kurbo::{BezPath, PathEl};
use roxmltree::{Document, Node, ParsingOptions};
use std::ops::Range;

/// Curves of a path are replaced by chords that leave them by at most this, in mm.
const CHORD_ERROR: f64 = 0.01;
/// Most elements of a picture.
const MOST_NODES: u32 = 100_000;
/// Most elements within each other.
const DEEPEST: usize = 256;
/// Elements that hold others and move none of them.
const HOLDERS: [&str; 2] = ["svg", "g"];
/// Elements that draw something that is not read.
const OTHER_SHAPES: [&str; 7] = ["rect", "circle", "ellipse", "polygon", "polyline", "line", "use"];

pub(super) fn read(source: SourceText, stem: String) -> Result<Read, ReadError> {
    let (mut found, mut rings, mut curved) = (Found::default(), Vec::new(), false);
    let mut measure = Measure::Millimetres;
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    match Document::parse_with_options(&source.text, options) {
        Err(error) => {
            let at = error.pos();
            let line = source
                .text
                .split_inclusive('\n')
                .take(at.row.saturating_sub(1) as usize)
                .map(str::len)
                .sum::<usize>();
            let start = (line + at.col.saturating_sub(1) as usize).min(source.text.len());
            let start = (0..=start).rev().find(|k| source.text.is_char_boundary(*k)).unwrap_or(0);
            let end = source.text[start..].find('\n').map_or(source.text.len(), |length| start + length);
            found.push(Finding::new(format!("the picture is no XML: {error}"), None).at(Some(start..end)));
        }
        Ok(document) => {
            let root = document.root_element();
            if root.attribute("data-unit") == Some("D") {
                measure = Measure::Widths;
            }
            let factor = scale(root, &mut found);
            // Not by recursion: a hostile picture is deep.
            let mut open = vec![(root, 1)];
            while let Some((node, depth)) = open.pop() {
                element(node, factor, &mut rings, &mut curved, &mut found);
                if depth == DEEPEST && node.has_children() {
                    let help = "ungroup in the drawing program".to_owned();
                    let start = node.range().start;
                    let message = format!("more than {DEEPEST} elements within each other");
                    found.push(Finding::new(message, Some(help)).at(Some(start..start + 1)));
                    continue;
                }
                // The last is taken first.
                open.extend(node.children().filter(Node::is_element).rev().map(|child| (child, depth + 1)));
            }
            if found.is_empty() && rings.is_empty() {
                let help = "it needs at least one <path d=\"…\">".to_owned();
                found.push(Finding::new("the picture has no path", Some(help)));
            }
        }
    }
    let notes = if curved {
        vec![format!(
            "curves are replaced by chords that leave them by at most {CHORD_ERROR} {}",
            measure.symbol()
        )]
    } else {
        Vec::new()
    };
    region(source, stem, measure, rings, found, notes)
}

/// Lengths of one user unit: a mm, unless the picture says its width.
fn scale(root: Node<'_, '_>, found: &mut Found) -> f64 {
    let (Some(width), Some(view)) = (root.attribute_node("width"), root.attribute("viewBox")) else {
        return 1.0;
    };
    let across: Option<f64> =
        view.split([' ', ',']).filter(|t| !t.is_empty()).nth(2).and_then(|t| t.parse().ok());
    match (width.value().parse::<Quantity>(), across) {
        (Ok(Quantity { value, unit: Unit::Length(unit) }), Some(across)) if value > 0.0 && across > 0.0 => {
            value * (unit.metres() / LengthUnit::Mm.metres()) / across
        }
        (Ok(Quantity { unit: Unit::Bare, .. }), _) => 1.0,
        _ if width.value().ends_with("px") || width.value().ends_with('%') => 1.0,
        _ => {
            let message = format!("the width of the picture, `{}`, has no meaning here", width.value());
            let help = "write it in mm, with a viewBox".to_owned();
            found.push(Finding::new(message, Some(help)).at(Some(width.range_value())));
            1.0
        }
    }
}

fn element(node: Node<'_, '_>, factor: f64, rings: &mut Vec<Ring>, curved: &mut bool, found: &mut Found) {
    let name = node.tag_name().name();
    if let Some(transform) =
        node.attribute_node("transform").filter(|_| HOLDERS.contains(&name) || name == "path")
    {
        let help = "apply the transforms to the paths in the drawing program".to_owned();
        let message = "a transform is not read";
        found.push(Finding::new(message, Some(help)).at(Some(transform.range())));
    }
    if OTHER_SHAPES.contains(&name) {
        let message = format!("<{name}> is not read");
        let help = "turn shapes into paths in the drawing program".to_owned();
        let start = node.range().start;
        found.push(Finding::new(message, Some(help)).at(Some(start..start + 1 + name.len())));
    }
    let Some(data) = node.attribute_node("d").filter(|_| name == "path") else { return };
    if has_huge_numbers(data.value()) {
        let message = "the path has a number that is far too large";
        let help = "check the unit of the picture".to_owned();
        found.push(Finding::new(message, Some(help)).at(Some(data.range_value())));
        return;
    }
    match BezPath::from_svg(data.value()) {
        Ok(path) if !within_reach(&path, factor) => {
            let message = format!("the path goes farther from the origin than {REACH} mm");
            let help = "check the width and the viewBox of the picture".to_owned();
            found.push(Finding::new(message, Some(help)).at(Some(data.range_value())));
        }
        Ok(path) => {
            *curved |= path.elements().iter().any(|e| matches!(e, PathEl::QuadTo(..) | PathEl::CurveTo(..)));
            path_rings(&path, factor, &data.range_value(), rings, found);
        }
        Err(error) => {
            let message = format!("the path cannot be read: {error}");
            found.push(Finding::new(message, None).at(Some(data.range_value())));
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

/// Whether everything that a path passes lies where regions may be: what does not would take any number of chords.
fn within_reach(path: &BezPath, factor: f64) -> bool {
    let near = |p: &kurbo::Point| (p.x.abs().max(p.y.abs()) * factor) <= REACH;
    path.elements().iter().all(|element| match element {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => near(p),
        PathEl::QuadTo(p, q) => near(p) && near(q),
        PathEl::CurveTo(p, q, r) => near(p) && near(q) && near(r),
        PathEl::ClosePath => true,
    })
}

fn path_rings(path: &BezPath, factor: f64, span: &Range<usize>, rings: &mut Vec<Ring>, found: &mut Found) {
    let mut ring = Ring::default();
    let mut ended = |ring: &mut Ring, closed: bool| {
        let ring = std::mem::take(ring);
        let (Some((first, _)), Some((last, _))) = (ring.corners.first(), ring.corners.last()) else { return };
        if !closed && first != last {
            let message = format!("the ring that begins at ({}, {}) is open", first.x, first.y);
            let help = "end it with Z, or where it begins".to_owned();
            found.push(Finding::new(message, Some(help)).at(Some(span.clone())));
        } else {
            rings.push(ring);
        }
    };
    // Up is +y, and down the picture is not.
    let corner = |p: kurbo::Point| (DVec2::new(p.x, 0.0 - p.y) * factor, span.clone());
    kurbo::flatten(path, CHORD_ERROR / factor, |element| match element {
        PathEl::MoveTo(p) => {
            ended(&mut ring, false);
            ring.corners.push(corner(p));
        }
        // One too many is refused, and more need not be held.
        PathEl::LineTo(p) if ring.corners.len() <= MOST_CORNERS => ring.corners.push(corner(p)),
        PathEl::ClosePath => ended(&mut ring, true),
        // Flattened paths have no curves.
        PathEl::LineTo(_) | PathEl::QuadTo(..) | PathEl::CurveTo(..) => {}
    });
    ended(&mut ring, false);
}
