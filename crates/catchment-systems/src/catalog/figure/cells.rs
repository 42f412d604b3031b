//! Content of the figure's cells: regions in D, and a face seen along the approach.

use super::super::facts::AcceptanceShape;
use catchment::connector::Half;
use catchment::report::figure::Picture;
use catchment::report::figure::draw::axis::{AxisScale, PlotFrame};
use catchment::report::figure::draw::colour::{self, hex, mix};
use catchment::report::figure::draw::layout::{Layout, Legend, Panel};
use catchment::report::figure::draw::svg::{INK, JOIN, Rect, SOFT, Svg, polyline};
use catchment::tolerance::SINGLE;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Corners of the polygon that is drawn for a circle.
const ROUND: u32 = 180;
/// Fill of an accepted region.
pub(super) const ACCEPTED: colour::Rgb = [0x4b, 0x95, 0xc9];

/// Places of a cell: D to the picture, y up.
pub(super) struct View {
    middle: [f64; 2],
    scale: f64,
}

impl View {
    /// A square cell that shows offsets up to `reach`.
    pub(super) fn new(rect: Rect, reach: f64) -> Self {
        let middle = [rect.x + rect.w / 2.0, rect.y + rect.h / 2.0];
        Self { middle, scale: rect.w.min(rect.h) / 2.0 / reach }
    }

    pub(super) fn at(&self, p: DVec2) -> [f64; 2] {
        [self.middle[0] + p.x * self.scale, self.middle[1] - p.y * self.scale]
    }

    pub(super) fn path(&self, svg: &mut Svg, corners: &[DVec2], style: &str) {
        svg.path(&polyline(corners.iter().map(|p| self.at(*p)), true), style);
    }

    /// A square around a place.
    pub(super) fn square(&self, svg: &mut Svg, middle: DVec2, edge: f64, style: &str) {
        let corner = |x: f64, y: f64| middle + edge / 2.0 * DVec2::new(x, y);
        self.path(svg, &[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], style);
    }
}

/// Style of the largest square inside a region.
pub(super) fn dashed() -> String {
    format!(r#"fill="none" stroke="{INK}" stroke-width="1.3" stroke-dasharray="5 3" {JOIN}"#)
}

/// Style of the unit square.
pub(super) fn dotted() -> String {
    format!(r#"fill="none" stroke="{SOFT}" stroke-width="0.9" stroke-dasharray="1.5 2.5""#)
}

/// Style of a region.
pub(super) fn filled(fill: colour::Rgb) -> String {
    let fill = hex(fill);
    format!(r#"fill="{fill}" stroke="{fill}" stroke-width="0.6" {JOIN}"#)
}

/// The corners that are drawn for a shape.
pub(super) fn corners(shape: AcceptanceShape) -> Vec<DVec2> {
    match shape {
        AcceptanceShape::Disc(radius) => {
            (0..ROUND).map(|k| radius * DVec2::from_angle(f64::from(k) * TAU / f64::from(ROUND))).collect()
        }
        AcceptanceShape::Square(edge) => {
            let half = edge / 2.0;
            [(-half, -half), (half, -half), (half, half), (-half, half)].map(DVec2::from).to_vec()
        }
        AcceptanceShape::Diamond(reach) => {
            [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y].map(|p| reach * p).to_vec()
        }
    }
}

/// The mating surface of a half as seen along the approach: the facets that face the viewer, the lower parts
/// first, and the visible edges.
pub(super) fn face(svg: &mut Svg, view: &View, half: &Half, factor: f64) {
    /// Cosine of 20°: facets of a rounding meet at less.
    const BEND: f64 = 0.94;
    let light = DVec3::new(-0.45, 0.55, 0.7).normalize_or_zero();
    let place = |p: DVec3| factor * p.truncate();
    let mut seen: Vec<(f64, DVec3, Vec<DVec2>)> = Vec::new();
    for surface in &half.surfaces {
        for facet in surface.facets.iter().filter(|facet| facet.normal.z > SINGLE) {
            let at = |k: &u32| surface.vertices[*k as usize];
            let top = facet.corners.iter().map(|k| at(k).z).fold(f64::NEG_INFINITY, f64::max);
            seen.push((top, facet.normal, facet.corners.iter().map(|k| place(at(k))).collect()));
        }
    }
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, normal, corners) in seen {
        view.path(
            svg,
            &corners,
            &filled(mix(colour::FIXED, [255; 3], 0.85 * normal.dot(light).clamp(0.0, 1.0))),
        );
    }
    let line = format!(r#"stroke="{}" stroke-width="0.7" {JOIN}"#, hex(colour::FIXED_EDGE));
    for surface in &half.surfaces {
        for edge in &surface.edges {
            let [a, b] = edge.facets.map(|k| surface.facets[k as usize].normal);
            let [from, to] = edge.ends.map(|k| place(surface.vertices[k as usize]));
            if a.z.max(b.z) > SINGLE && a.dot(b) < BEND && from.distance(to) > SINGLE {
                svg.line(view.at(from), view.at(to), &line);
            }
        }
    }
}

/// Figure 4.2: the cone's area of acceptance, around and inside the unit square, over that of the 3-D X-Face.
pub fn cone_over_x_face() -> Picture {
    /// Offsets shown, in D.
    const REACH: f64 = 1.15;
    let cone = mix(colour::FIXED, colour::FIXED_EDGE, 0.5);
    let (around, inside) = (AcceptanceShape::Disc(FRAC_1_SQRT_2), AcceptanceShape::Disc(0.5));
    let styles = [
        (AcceptanceShape::Diamond(1.0), filled(mix(ACCEPTED, [255; 3], 0.45))),
        (around, format!(r#"fill="{0}" fill-opacity="0.35" stroke="{0}" stroke-width="1.6""#, hex(cone))),
        (inside, format!(r#"fill="{0}" fill-opacity="0.45" stroke="{0}" stroke-width="1.6""#, hex(cone))),
    ];
    let words = [
        "3-D X-Face: |x| + |y| < D, 2.0 D², ONAA 1.0 D",
        "cone around the unit square: π/2 = 1.5708 D², ONAA 1.0 D (X-Face: + 27.3 %)",
        "cone inside it: π/4 = 0.7854 D², ONAA 0.7071 D",
    ];
    let square = "largest axis-parallel square of the first two, edge D";
    let panel = styles.iter().zip(words).fold(Panel::with_axes([420.0; 2]), |panel, ((_, style), words)| {
        panel.under(Legend::default().square(style, words))
    });
    let (mut svg, frames) = Layout::titled("Cone and 3-D X-Face, offsets corrected without rotation")
        .story("faces compared by the unit square; either scaling of the cone")
        .row([panel.under(Legend::default().line(dashed(), square))])
        .open();
    let rect = frames[0];
    let view = View::new(rect, REACH);
    for (shape, style) in &styles {
        view.path(&mut svg, &corners(*shape), style);
    }
    view.square(&mut svg, DVec2::ZERO, 1.0, &dashed());
    let scale = |name: &str| AxisScale::new(format!("{name} [D]"), -REACH, REACH, false);
    PlotFrame { rect, x: scale("x"), y: scale("y") }.draw(&mut svg);
    Picture::of(svg)
}
