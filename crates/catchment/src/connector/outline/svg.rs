//! The closed shapes of an SVG picture; y points up here, and down in the picture.
//!
//! Paths, rectangles, circles, ellipses, polygons and polylines, with the transforms of their groups; text, references and pictures are
//! refused, and what is only defined is left out. A picture says its unit by a width such as `50mm` beside its `viewBox`.

use super::{OutlineProblem, Stroke, Within};
use crate::design::{LengthUnit, Quantity, Unit};
use glam::DVec2;
use kurbo::{Affine, Arc, BezPath, Circle, Ellipse, PathEl, Point, Rect, RoundedRect, Shape, SvgArc, Vec2};
use roxmltree::{Document, Node, ParsingOptions};
use std::str::FromStr;
use svgtypes::{PathParser, PathSegment, PointsParser, Transform};

/// Elements whose members are not drawn where they stand.
const NOT_DRAWN: [&str; 10] =
    ["defs", "clipPath", "mask", "marker", "pattern", "symbol", "metadata", "style", "title", "desc"];
/// Elements that draw something that is no outline.
const NOT_READ: [&str; 6] = ["text", "use", "image", "foreignObject", "svg", "switch"];
/// Most elements of a picture.
const MOST_NODES: u32 = 100_000;
/// Most elements within each other.
const DEEPEST: usize = 256;
/// Most attributes of an element.
const MOST_ATTRIBUTES: usize = 200;
/// Most curves of a path: each has a corner at least.
const MOST_CURVES: usize = 2 * super::MOST_CORNERS;
/// Share of the chord error that replacing arcs by cubic curves may take.
const OF_ARCS: f64 = 0.1;
/// Numbers above this are no lengths, whatever the unit: arcs take longer the larger they are.
const LARGEST: f64 = 1e9;

fn parse(text: &str) -> Result<Document<'_>, OutlineProblem> {
    if let Some(at) = crowded_tag(text) {
        let line = text[..at].lines().count();
        return Err(OutlineProblem::Syntax {
            line,
            message: format!("more than {MOST_ATTRIBUTES} attributes"),
        });
    }
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| OutlineProblem::Syntax {
        line: error.pos().row as usize,
        message: format!("this is no SVG picture: {error}"),
    })
}

/// Where a tag has more attributes than any has: each is compared with all before it.
fn crowded_tag(text: &str) -> Option<usize> {
    let (mut quote, mut count) = (None, 0);
    text.bytes().position(|byte| {
        match (quote, byte) {
            (Some(open), byte) if open == byte => quote = None,
            (None, b'"' | b'\'') if count > 0 => quote = Some(byte),
            (None, b'<' | b'>') => count = 0,
            (None, b'=') => count += 1,
            _ => {}
        }
        count > MOST_ATTRIBUTES
    })
}

/// Metres in one of the picture's coordinates, where it says so.
pub(super) fn metres(text: &str) -> Result<Option<f64>, OutlineProblem> {
    let document = parse(text)?;
    let root = document.root_element();
    let (Some(width), Some(view)) = (root.attribute("width"), root.attribute("viewBox")) else {
        return Ok(None);
    };
    let across: Option<f64> =
        view.split([' ', ',']).filter(|t| !t.is_empty()).nth(2).and_then(|t| t.parse().ok());
    match (width.parse::<Quantity>(), across) {
        (Ok(Quantity { value, unit: Unit::Length(unit) }), Some(across)) if value > 0.0 && across > 0.0 => {
            Ok(Some(value * LengthUnit::metres(unit) / across))
        }
        _ => Ok(None),
    }
}

/// The closed shapes of a picture.
pub(super) fn read(text: &str, within: Within) -> Result<Vec<Stroke>, OutlineProblem> {
    let document = parse(text)?;
    let mut loops = Vec::new();
    // Lines are not counted from the start for every element.
    let breaks: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
    // Not by recursion: a hostile picture is deep.
    let mut open = vec![(document.root_element(), Affine::FLIP_Y, 1)];
    let mut corners = 0;
    while let Some((node, outer, depth)) = open.pop() {
        let name = node.tag_name().name();
        let line = 1 + breaks.partition_point(|at| *at < node.range().start);
        let syntax = |message: String| OutlineProblem::Syntax { line, message };
        let is_root = node == document.root_element();
        let is_hidden = node.attribute("display") == Some("none");
        if NOT_DRAWN.contains(&name) || is_hidden {
            continue;
        }
        if NOT_READ.contains(&name) && !is_root {
            let advice = "turn everything into paths in the drawing program";
            return Err(OutlineProblem::Unsupported { line, what: format!("<{name}>"), advice });
        }
        let own = match node.attribute("transform") {
            Some(written) => {
                let t = Transform::from_str(written)
                    .map_err(|error| syntax(format!("its transform cannot be read: {error}")))?;
                Affine::new([t.a, t.b, t.c, t.d, t.e, t.f])
            }
            None => Affine::IDENTITY,
        };
        let frame = outer * own;
        if !frame.as_coeffs().iter().all(|c| c.abs() <= LARGEST) {
            return Err(syntax("its transform moves it far too far".to_owned()));
        }
        if let Some(path) = shape(node, frame, within).map_err(syntax)? {
            let strokes = flattened(&(frame * path), within, line)?;
            corners += strokes.iter().map(|stroke| stroke.corners.len()).sum::<usize>();
            if corners > super::MOST_CORNERS {
                return Err(OutlineProblem::TooMany);
            }
            loops.extend(strokes);
        }
        if depth == DEEPEST && node.has_children() {
            return Err(syntax(format!("more than {DEEPEST} elements within each other: ungroup them")));
        }
        // The last is taken first.
        open.extend(node.children().filter(Node::is_element).rev().map(|child| (child, frame, depth + 1)));
    }
    Ok(loops)
}

/// What an element draws, in its own coordinates; `None` where it draws nothing.
fn shape(node: Node<'_, '_>, frame: Affine, within: Within) -> Result<Option<BezPath>, String> {
    let number = |name: &str| -> Result<Option<f64>, String> {
        let Some(written) = node.attribute(name) else { return Ok(None) };
        let read = written.trim().trim_end_matches("px").parse::<f64>().ok();
        let read = read.filter(|number| number.abs() <= LARGEST);
        read.map(Some).ok_or_else(|| format!("`{name}` should be a plain number, not `{written}`"))
    };
    let or_zero = |name: &str| number(name).map(Option::unwrap_or_default);
    // What a length is stretched by at most.
    let [a, b, c, d, ..] = frame.as_coeffs();
    let stretch = (a * a + b * b + c * c + d * d).sqrt().max(f64::MIN_POSITIVE);
    let tolerance = within.chord_error * OF_ARCS / stretch;
    let path = match node.tag_name().name() {
        "path" => node.attribute("d").map(|data| path(data, tolerance)).transpose()?.unwrap_or_default(),
        "rect" => {
            let (x, y) = (or_zero("x")?, or_zero("y")?);
            let (width, height) = (or_zero("width")?, or_zero("height")?);
            let (rx, ry) = (number("rx")?, number("ry")?);
            let rect = Rect::new(x, y, x + width, y + height);
            match (rx.or(ry).unwrap_or_default(), ry.or(rx).unwrap_or_default()) {
                (rx, ry) if rx <= 0.0 || ry <= 0.0 => rect.to_path(tolerance),
                (rx, ry) if rx == ry => RoundedRect::from_rect(rect, rx).to_path(tolerance),
                _ => return Err("corners with two radii are not read: turn it into a path".to_owned()),
            }
        }
        "circle" => Circle::new((or_zero("cx")?, or_zero("cy")?), or_zero("r")?).to_path(tolerance),
        "ellipse" => {
            let radii = (or_zero("rx")?, or_zero("ry")?);
            Ellipse::new((or_zero("cx")?, or_zero("cy")?), radii, 0.0).to_path(tolerance)
        }
        name @ ("polygon" | "polyline") => {
            let mut path = BezPath::new();
            let points = PointsParser::from(node.attribute("points").unwrap_or_default());
            for (k, (x, y)) in points.take(MOST_CURVES).enumerate() {
                if k == 0 { path.move_to((x, y)) } else { path.line_to((x, y)) }
            }
            if name == "polygon" && !path.is_empty() {
                path.close_path();
            }
            path
        }
        "line" => {
            let mut path = BezPath::new();
            path.move_to((or_zero("x1")?, or_zero("y1")?));
            path.line_to((or_zero("x2")?, or_zero("y2")?));
            path
        }
        _ => return Ok(None),
    };
    Ok(Some(path))
}

/// Whether a segment is straight.
const fn is_line(segment: &PathSegment) -> bool {
    use PathSegment::{HorizontalLineTo, LineTo, VerticalLineTo};
    matches!(segment, LineTo { .. } | HorizontalLineTo { .. } | VerticalLineTo { .. })
}

/// The data of a path; arcs become cubic curves within `tolerance`.
fn path(data: &str, tolerance: f64) -> Result<BezPath, String> {
    let mut path = BezPath::new();
    let (mut at, mut start) = (Point::ZERO, Point::ZERO);
    // The last control point of a cubic, and of a quadratic curve.
    let (mut cubic, mut quadratic) = (None, None);
    for segment in PathParser::from(data) {
        if path.elements().len() > MOST_CURVES {
            return Err(format!("the path has more than {MOST_CURVES} curves"));
        }
        let segment = segment.map_err(|error| format!("the path cannot be read: {error}"))?;
        let to = |abs: bool, x: f64, y: f64| if abs { Point::new(x, y) } else { at + Vec2::new(x, y) };
        let mirrored = |control: Option<Point>| control.map_or(at, |control| at + (at - control));
        let (mut new_cubic, mut new_quadratic) = (None, None);
        let end = match segment {
            PathSegment::MoveTo { abs, x, y } => {
                start = to(abs, x, y);
                path.move_to(start);
                start
            }
            PathSegment::LineTo { abs, x, y } => to(abs, x, y),
            PathSegment::HorizontalLineTo { abs, x } => Point::new(if abs { x } else { at.x + x }, at.y),
            PathSegment::VerticalLineTo { abs, y } => Point::new(at.x, if abs { y } else { at.y + y }),
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                let (p, q, end) = (to(abs, x1, y1), to(abs, x2, y2), to(abs, x, y));
                path.curve_to(p, q, end);
                new_cubic = Some(q);
                end
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                let (p, q, end) = (mirrored(cubic), to(abs, x2, y2), to(abs, x, y));
                path.curve_to(p, q, end);
                new_cubic = Some(q);
                end
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                let (p, end) = (to(abs, x1, y1), to(abs, x, y));
                path.quad_to(p, end);
                new_quadratic = Some(p);
                end
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                let (p, end) = (mirrored(quadratic), to(abs, x, y));
                path.quad_to(p, end);
                new_quadratic = Some(p);
                end
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                let end = to(abs, x, y);
                let radii = Vec2::new(rx.abs(), ry.abs());
                if radii.x.max(radii.y).max(end.x.abs()).max(end.y.abs()) > LARGEST {
                    return Err("the path has a number that is far too large".to_owned());
                }
                let x_rotation = x_axis_rotation.to_radians();
                let arc = SvgArc { from: at, to: end, radii, x_rotation, large_arc, sweep };
                match Arc::from_svg_arc(&arc) {
                    Some(arc) => path.extend(arc.append_iter(tolerance)),
                    None => path.line_to(end),
                }
                end
            }
            PathSegment::ClosePath { .. } => {
                path.close_path();
                start
            }
        };
        if is_line(&segment) {
            path.line_to(end);
        }
        (at, cubic, quadratic) = (end, new_cubic, new_quadratic);
    }
    Ok(path)
}

/// The closed lines of a path, curves replaced by chords.
fn flattened(path: &BezPath, within: Within, line: usize) -> Result<Vec<Stroke>, OutlineProblem> {
    let mut found = Vec::new();
    let mut corners: Vec<DVec2> = Vec::new();
    let mut at = Point::ZERO;
    let dvec = |p: Point| DVec2::new(p.x, p.y);
    let mut ended = |corners: &mut Vec<DVec2>, is_closed: bool| {
        let corners = std::mem::take(corners);
        let (Some(&first), Some(&last)) = (corners.first(), corners.last()) else { return Ok(()) };
        if corners.len() == 1 {
            return Ok(());
        }
        let near = super::NEAR * corners.iter().map(|p| p.distance(first)).fold(0.0, f64::max);
        if !is_closed && first.distance(last) > near {
            return Err(OutlineProblem::Open { line, at: first });
        }
        found.push(Stroke { corners, line });
        Ok(())
    };
    for element in path.elements() {
        let points: &[Point] = match element {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => &[*p],
            PathEl::QuadTo(p, q) => &[*p, *q],
            PathEl::CurveTo(p, q, r) => &[*p, *q, *r],
            PathEl::ClosePath => &[],
        };
        within.holds(&points.iter().map(|p| dvec(*p)).collect::<Vec<_>>())?;
        match element {
            PathEl::MoveTo(p) => {
                ended(&mut corners, false)?;
                corners.push(dvec(*p));
            }
            PathEl::ClosePath => {
                let first = corners.first().copied();
                ended(&mut corners, true)?;
                // What follows begins where this one began.
                corners.extend(first);
            }
            _ => {
                // One curve at a time, so that no more is held than is refused.
                let chords = within.chord_error * (1.0 - OF_ARCS);
                kurbo::flatten([PathEl::MoveTo(at), *element], chords, |chord| {
                    if let PathEl::LineTo(p) = chord
                        && corners.len() <= super::MOST_CORNERS
                    {
                        corners.push(dvec(p));
                    }
                });
                within.holds(&corners)?;
            }
        }
        at = match element {
            PathEl::ClosePath => corners.first().map_or(at, |p| Point::new(p.x, p.y)),
            _ => points.last().copied().unwrap_or(at),
        };
    }
    ended(&mut corners, false)?;
    Ok(found)
}
