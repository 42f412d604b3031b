//! The solids behind the contact space: flat ones as polygons over their axes, others in space, with a colour
//! for every piece.

use super::super::solids::{bounds, in_words, is_angle};
use super::draw::axis::{AxisScale, PlotFrame, ShownUnits};
use super::draw::colour::{self, CURVES, Rgb, hex, mix};
use super::draw::layout::{Layout, Legend, Panel, filled};
use super::draw::svg::{JOIN, Rect, Svg, polyline};
use super::solid::{self, Body};
use super::{FigureError, Picture};
use catchment_core::connector::{Facet, Surface};
use catchment_core::design::Design;
use catchment_core::method::partition::{Solid, SolidShape, Solids};
use glam::{DMat3, DVec3};

/// Draws a shape.
///
/// # Errors
/// If it has no face.
pub fn bodies(design: &Design, shape: &Solids) -> Result<Picture, FigureError> {
    let (lo, hi) = bounds(shape);
    if shape.solids.is_empty() || lo == hi {
        return Err(FigureError::Empty { what: "the shape has no bodies" });
    }
    let is_flat = shape.dimension == 2;
    let size = [520.0, 420.0];
    let panel = if is_flat {
        Panel::with_axes(size)
    } else {
        let [right, back, up] = [0, 1, 2].map(|k| axis(shape, k));
        Panel::of(size).under(format!("to the right {right}, backwards {back}, upwards {up}"))
    };
    let (mut svg, frames) = Layout::of(design)
        .story(in_words(shape.subject))
        .story(made_of(shape))
        .row([panel])
        .legend(legend(shape))
        .open();
    if is_flat {
        flat(&mut svg, frames[0], design, shape, [lo, hi]);
    } else {
        in_space(&mut svg, frames[0], shape)?;
    }
    Ok(Picture::of(svg))
}

/// Its numbers, in words.
fn made_of(shape: &Solids) -> String {
    let [fixed, moving] = shape.pieces;
    let turned = shape.axes.iter().any(|axis| is_angle(axis));
    let slices = if turned { format!(", {} slices", shape.settings.slices) } else { String::new() };
    format!("{fixed} fixed and {moving} moving pieces{slices}: {} convex bodies", shape.solids.len())
}

/// The name of an axis with its unit.
fn axis(shape: &Solids, k: usize) -> String {
    let name = shape.axes[k];
    format!("{name} [{}]", if is_angle(name) { "rad" } else { "D" })
}

/// Colours of a body: by its piece of the half that dominates the solid.
fn colours(shape: &Solids, solid: &Solid) -> [Rgb; 2] {
    /// Share of white in the face of a piece.
    const LIGHT: f64 = 0.45;
    match (shape.subject, solid.fixed) {
        (SolidShape::Halves, Some(_)) => [colour::FIXED, colour::FIXED_EDGE],
        (SolidShape::Halves, None) => [colour::MOVING, colour::MOVING_EDGE],
        (SolidShape::Swept, _) => {
            let odd = solid.slice.is_some_and(|(slice, _)| slice % 2 == 1);
            let fill = if odd { mix(colour::MOVING, [255; 3], 0.35) } else { colour::MOVING };
            [fill, colour::MOVING_EDGE]
        }
        (SolidShape::Collision, fixed) => {
            let piece = CURVES[fixed.unwrap_or_default() % CURVES.len()];
            [mix(piece, [255; 3], LIGHT), mix(piece, [0; 3], LIGHT)]
        }
    }
}

fn flat(svg: &mut Svg, rect: Rect, design: &Design, shape: &Solids, [lo, hi]: [DVec3; 2]) {
    /// Room around the shape, as a share of its extent.
    const MARGIN: f64 = 0.06;
    // The axis, x or y, along which the shape extends.
    let across = usize::from(hi.x == lo.x);
    let units = ShownUnits::of(design);
    let range = |k: usize| {
        let (lo, hi) = (lo[k], hi[k]);
        let margin = MARGIN * (hi - lo).max(f64::MIN_POSITIVE);
        [lo - margin, hi + margin]
    };
    let [[left, right], [low, high]] = [range(across), range(2)];
    let name = shape.axes[across];
    // Lengths are drawn alike in both directions.
    let (rect, x) = if is_angle(name) {
        let degrees = |angle: f64| angle.to_degrees();
        (rect, AxisScale::new(format!("{name} [deg]"), degrees(left), degrees(right), true))
    } else {
        let scale = (rect.w / (right - left)).min(rect.h / (high - low));
        let (w, h) = (scale * (right - left), scale * (high - low));
        let rect = Rect { x: rect.x + 0.5 * (rect.w - w), y: rect.y + 0.5 * (rect.h - h), w, h };
        (rect, units.length(name, left, right))
    };
    let factor = if is_angle(name) { 1f64.to_degrees() } else { units.lengths() };
    let frame = PlotFrame { rect, x, y: units.length("z", low, high) };
    for solid in &shape.solids {
        let [fill, edge] = colours(shape, solid).map(hex);
        let style = format!(r#"fill="{fill}" fill-opacity="0.5" stroke="{edge}" stroke-width="1.2" {JOIN}"#);
        let at = |corner: &usize| {
            let v = solid.vertices[*corner];
            frame.at([v[across] * factor, v.z * units.lengths()])
        };
        for face in &solid.faces {
            svg.path(&polyline(face.iter().map(at), true), &style);
        }
    }
    frame.draw(svg);
}

fn in_space(svg: &mut Svg, rect: Rect, shape: &Solids) -> Result<(), FigureError> {
    let surfaces: Vec<Surface> = shape.solids.iter().map(surface).collect();
    let coloured: Vec<Body> = surfaces
        .iter()
        .zip(&shape.solids)
        .map(|(surface, solid)| Body::new(surface, DMat3::IDENTITY, DVec3::ZERO, colours(shape, solid)))
        .collect();
    solid::bodies(svg, rect, &coloured)
}

/// A body as a surface for display: its edges are those of its facets.
fn surface(solid: &Solid) -> Surface {
    let facet = |face: &Vec<usize>| {
        let at = |k: usize| solid.vertices[face[k]] - solid.vertices[face[0]];
        let area: DVec3 = (2..face.len()).map(|k| at(k - 1).cross(at(k))).sum();
        Facet { corners: face.iter().map(|k| *k as u32).collect(), normal: area.normalize_or_zero() }
    };
    let facets = solid.faces.iter().map(facet).collect();
    Surface { vertices: solid.vertices.clone(), facets, edges: Vec::new(), convex: true }
}

fn legend(shape: &Solids) -> Legend {
    /// Most pieces that have words of their own.
    const MOST: usize = 4;
    let entries: Vec<(Rgb, String)> = match shape.subject {
        SolidShape::Halves => {
            vec![(colour::FIXED, "fixed".to_owned()), (colour::MOVING, "moving".to_owned())]
        }
        SolidShape::Swept => vec![(colour::MOVING, "moving, a shade for every other slice".to_owned())],
        SolidShape::Collision if shape.pieces[0] > MOST => Vec::new(),
        SolidShape::Collision => (0..shape.pieces[0])
            .map(|k| {
                let of_piece = shape.solids.iter().find(|solid| solid.fixed == Some(k));
                let fill = of_piece.map_or(colour::NOTHING, |solid| colours(shape, solid)[0]);
                (fill, format!("with fixed piece {k}"))
            })
            .collect(),
    };
    entries.into_iter().fold(Legend::default(), |legend, (fill, words)| legend.square(filled(fill), words))
}
