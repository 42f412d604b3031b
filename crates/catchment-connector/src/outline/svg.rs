//! The closed shapes of an SVG picture; y points up here, and down in the picture.
//!
//! Paths, rectangles, circles, ellipses, polygons and polylines, with the transforms of their groups; [`svg`]
//! determines which of them are drawn. A picture states its unit by a width such as `50mm` together with its
//! `viewBox`.

use super::{OutlineProblem, Stroke, Within, line_of};
use catchment_base::tolerance::COINCIDENT;
use catchment_design::design::{LengthUnit, Quantity, QuantityUnit};
use catchment_design::xml::svg::{self, UnsupportedSvg};
use catchment_design::xml::{Tag, XmlAttribute};
use glam::DVec2;
use kurbo::{Affine, Arc, BezPath, Circle, Ellipse, PathEl, Point, Rect, RoundedRect, Shape, SvgArc, Vec2};
use std::ops::{ControlFlow, Range};
use svgtypes::{PathParser, PathSegment};

/// Most curves of a path: each has a corner at least.
const MOST_CURVES: usize = 2 * super::MOST_CORNERS;
/// Share of the chord error that replacing arcs by cubic curves may take.
const OF_ARCS: f64 = 0.1;
/// Numbers above this are no lengths, whatever the unit: arcs take longer the larger they are.
const LARGEST: f64 = 1e9;
/// Largest relative difference between the horizontal and vertical scale of a picture.
const SAME_SCALE: f64 = 1e-3;

/// The error about a part of a picture, with its line.
fn refused(text: &str, refusal: &UnsupportedSvg) -> OutlineProblem {
    let message = format!("{}: {}", refusal.message, refusal.help);
    OutlineProblem::Syntax { line: line_of(text, refusal.at.start), message }
}

/// Metres per unit of the picture's coordinates, if it states a unit.
pub(super) fn metres(text: &str) -> Result<Option<f64>, OutlineProblem> {
    let head = svg::head(text).map_err(|refusal| refused(text, &refusal))?;
    let view: Vec<f64> = head.get("viewBox").map_or_else(Vec::new, |(view, _)| {
        view.split([' ', ',', '\t', '\n']).filter_map(|number| number.parse().ok()).collect()
    });
    let of = |name: &str, across: Option<&f64>| {
        let (written, at) = head.get(name)?;
        match (written.parse::<Quantity>(), across) {
            (Ok(Quantity { value, unit: QuantityUnit::Length(unit) }), Some(&across))
                if value > 0.0 && across > 0.0 =>
            {
                Some((value * LengthUnit::metres(unit) / across, at.clone()))
            }
            _ => None,
        }
    };
    match (of("width", view.get(2)), of("height", view.get(3))) {
        (Some((across, _)), Some((down, at))) if (across / down - 1.0).abs() > SAME_SCALE => {
            let message = format!(
                "the height of the picture makes a unit {} times as long as its width does",
                down / across
            );
            Err(refused(
                text,
                &UnsupportedSvg {
                    at,
                    message,
                    help: "let width and height have the proportions of the viewBox",
                },
            ))
        }
        (across, _) => Ok(across.map(|(metres, _)| metres)),
    }
}

/// The closed shapes of a picture, and how many of its elements are hidden.
pub(super) fn read(text: &str, within: Within) -> Result<(Vec<Stroke>, usize), OutlineProblem> {
    let (mut loops, mut problem, mut corners) = (Vec::new(), None, 0);
    // Lines are not counted from the start for every shape.
    let breaks: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
    let hidden = svg::shapes(text, |drawn| {
        let read = drawn.map_err(|refusal| refused(text, &refusal)).and_then(
            |svg::SvgShape { tag, frame, .. }| {
                let frame = Affine::FLIP_Y * frame;
                let path = shape(tag, frame, within).map_err(|wrong| refused(text, &wrong))?;
                let line = 1 + breaks.partition_point(|at| *at < tag.head().start);
                let strokes = flattened(&(frame * path), within, line)?;
                corners += strokes.iter().map(|stroke| stroke.corners.len()).sum::<usize>();
                if corners > super::MOST_CORNERS { Err(OutlineProblem::TooMany) } else { Ok(strokes) }
            },
        );
        match read {
            Ok(strokes) => loops.extend(strokes),
            Err(result) => {
                problem = Some(result);
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    });
    problem.map_or(Ok((loops, hidden)), Err)
}

/// The outline that an element draws, in its own coordinates.
fn shape(tag: &Tag<'_>, frame: Affine, within: Within) -> Result<BezPath, UnsupportedSvg> {
    let number = |name: &str| -> Result<Option<f64>, UnsupportedSvg> {
        let Some(XmlAttribute { value, span }) = tag.attribute(name) else { return Ok(None) };
        let read = value.trim().trim_end_matches("px").parse::<f64>().ok();
        let read = read.filter(|number| number.abs() <= LARGEST);
        let is_size = ["width", "height", "r", "rx", "ry"].contains(&name);
        match read {
            Some(number) if number < 0.0 && is_size => {
                Err(wrong(span, format!("`{name}` is below 0: `{value}`"), "draw it again"))
            }
            Some(number) => Ok(Some(number)),
            None => {
                let message = format!(
                    "`{name}` should be a plain number, not `{}`",
                    catchment_design::design::shortened(&value)
                );
                Err(wrong(span, message, "save the picture in plain user units"))
            }
        }
    };
    let or_zero = |name: &str| number(name).map(Option::unwrap_or_default);
    // Upper bound of the stretch of a length under the transform.
    let [a, b, c, d, ..] = frame.as_coeffs();
    let stretch = (a * a + b * b + c * c + d * d).sqrt().max(f64::MIN_POSITIVE);
    let tolerance = within.chord_error * OF_ARCS / stretch;
    let path = match tag.name() {
        "rect" => {
            let (x, y) = (or_zero("x")?, or_zero("y")?);
            let (width, height) = (or_zero("width")?, or_zero("height")?);
            let (rx, ry) = (number("rx")?, number("ry")?);
            let rect = Rect::new(x, y, x + width, y + height);
            match (rx.or(ry).unwrap_or_default(), ry.or(rx).unwrap_or_default()) {
                (rx, ry) if rx <= 0.0 || ry <= 0.0 => rect.to_path(tolerance),
                (rx, ry) if rx == ry => RoundedRect::from_rect(rect, rx).to_path(tolerance),
                _ => {
                    let message = "corners with two radii are not read".to_owned();
                    return Err(wrong(tag.head(), message, "turn it into a path"));
                }
            }
        }
        "circle" => Circle::new((or_zero("cx")?, or_zero("cy")?), or_zero("r")?).to_path(tolerance),
        "ellipse" => {
            let radii = (or_zero("rx")?, or_zero("ry")?);
            Ellipse::new((or_zero("cx")?, or_zero("cy")?), radii, 0.0).to_path(tolerance)
        }
        "line" => {
            let mut path = BezPath::new();
            path.move_to((or_zero("x1")?, or_zero("y1")?));
            path.line_to((or_zero("x2")?, or_zero("y2")?));
            path
        }
        name @ ("polygon" | "polyline") => match tag.attribute("points") {
            Some(points) => polygon(&points, name == "polygon")?,
            None => BezPath::new(),
        },
        _ => match tag.attribute("d") {
            Some(XmlAttribute { value, span }) => path(&value, tolerance)
                .map_err(|message| wrong(span, message, "save the picture again from the drawing program"))?,
            None => BezPath::new(),
        },
    };
    Ok(path)
}

const fn wrong(at: Range<usize>, message: String, help: &'static str) -> UnsupportedSvg {
    UnsupportedSvg { at, message, help }
}

/// The corners of a polygon: pairs of numbers, all of which count.
fn polygon(points: &XmlAttribute<'_>, is_closed: bool) -> Result<BezPath, UnsupportedSvg> {
    const HELP: &str = "repair the list of points, or save the picture again from the drawing program";
    let mut numbers = svgtypes::NumberListParser::from(points.value.as_ref());
    let mut path = BezPath::new();
    let mut count = 0;
    while let Some(x) = numbers.next() {
        let broken = |error| wrong(points.span.clone(), format!("its points cannot be read: {error}"), HELP);
        let x = x.map_err(broken)?;
        let y = numbers.next().ok_or_else(|| {
            let message = "its points are an odd count of numbers, so that the last has no y".to_owned();
            wrong(points.span.clone(), message, HELP)
        })?;
        let at = (x, y.map_err(broken)?);
        if count == MOST_CURVES {
            let message = format!("it has more than {MOST_CURVES} points");
            return Err(wrong(points.span.clone(), message, "simplify the drawing"));
        }
        if count == 0 {
            path.move_to(at);
        } else {
            path.line_to(at);
        }
        count += 1;
    }
    if is_closed && count > 0 {
        path.close_path();
    }
    Ok(path)
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
    let mut result = Vec::new();
    let mut corners: Vec<DVec2> = Vec::new();
    let mut at = Point::ZERO;
    let dvec = |p: Point| DVec2::new(p.x, p.y);
    let mut ended = |corners: &mut Vec<DVec2>, is_closed: bool| {
        let corners = std::mem::take(corners);
        let (Some(&first), Some(&last)) = (corners.first(), corners.last()) else { return Ok(()) };
        if corners.len() == 1 {
            return Ok(());
        }
        let near = COINCIDENT * corners.iter().map(|p| p.distance(first)).fold(0.0, f64::max);
        if !is_closed && first.distance(last) > near {
            return Err(OutlineProblem::Open { line, at: first });
        }
        result.push(Stroke { corners, line });
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
                // The next subpath starts at the start of this subpath.
                corners.extend(first);
            }
            _ => {
                // Flatten curve by curve, so that memory stays within the limit on corners.
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
    Ok(result)
}
