//! The part itself: its outline with names, and two of them in the four steps of latching.

use super::super::outline::Polygon;
use super::super::{Geometry, LatchDesign};
use super::LatchDrawings;
use catchment::report::figure::draw::colour::{FIXED, FIXED_EDGE, MOVING, MOVING_EDGE, Rgb, hex};
use catchment::report::figure::draw::layout::{Legend, Panel};
use catchment::report::figure::draw::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, TICK, polyline};
use glam::DVec2;

/// From mm to places in the picture.
struct View {
    scale: f64,
    /// Position of the origin of the part.
    origin: [f64; 2],
}

impl View {
    fn at(&self, p: DVec2) -> [f64; 2] {
        [self.origin[0] + self.scale * p.x, self.origin[1] - self.scale * p.y]
    }

    fn fill(&self, svg: &mut Svg, polygon: &[DVec2], [inside, edge]: [Rgb; 2]) {
        let style = format!(r#"fill="{}" stroke="{}" stroke-width="1" {JOIN}"#, hex(inside), hex(edge));
        svg.path(&polyline(polygon.iter().map(|p| self.at(*p)), true), &style);
    }
}

/// A dotted line.
const DOTTED: &str = r##"stroke="#5f6b7a" stroke-width="0.9" stroke-dasharray="2 3""##;
/// A line with a length on it.
const MEASURE: &str = r##"stroke="#1f2933" stroke-width="0.9""##;

/// Draws a layer with the names of its parts.
pub(super) fn outline(svg: &mut Svg, rect: Rect, latch: &LatchDesign, geometry: &Geometry) {
    let (top, bottom) = (geometry.height(), geometry.bottom);
    // Room for lengths on the right and below.
    let scale = ((rect.w - 70.0) / geometry.width).min((rect.h - 50.0) / (top - bottom));
    let view = View { scale, origin: [rect.x + 8.0, rect.y + scale * top + 8.0] };
    view.fill(svg, &geometry.layer(), [FIXED, FIXED_EDGE]);
    for (middle, diameter) in
        geometry.dowels.iter().flat_map(|(middles, d)| middles.iter().map(move |m| (m, d)))
    {
        let style = format!(r##"fill="#ffffff" stroke="{}""##, hex(FIXED_EDGE));
        svg.circle(view.at(*middle), 0.5 * diameter * scale, &style);
    }
    let face: Vec<[f64; 2]> = geometry.face().iter().map(|p| view.at(geometry.turned(*p))).collect();
    // The partner's face is the same line; the dotted plane shows its hook.
    let style = format!(r#"fill="none" stroke="{}" stroke-width="2.4" {JOIN}"#, hex(MOVING_EDGE));
    svg.path(&polyline(face, false), &style);
    let width = geometry.width;
    svg.line(view.at(DVec2::ZERO), view.at(DVec2::new(width, 0.0)), DOTTED);
    let pivot = view.at(geometry.pivot);
    let x_end = geometry.profile.x_end;
    let direction = DVec2::from_angle(-geometry.profile.end);
    let corner = DVec2::new(x_end, geometry.profile.hook);
    svg.line(
        view.at(corner - direction * 14.0),
        view.at(corner + direction * (geometry.lever().length() + 6.0)),
        DOTTED,
    );
    svg.circle(pivot, 4.0, &format!(r##"fill="{}" stroke="#ffffff" stroke-width="1""##, hex(MOVING_EDGE)));
    let label = |svg: &mut Svg, at: [f64; 2], anchor, text: &str| svg.text(at, LABEL, anchor, INK, text);
    label(svg, [pivot[0] - 10.0, pivot[1] + 36.0], Anchor::End, "P, neck t");
    let middle_cutout = 0.5 * (geometry.cutout[0] + geometry.cutout[1]);
    let cutout = view.at(DVec2::new(0.3 * width, middle_cutout));
    label(svg, [cutout[0], cutout[1] + 4.0], Anchor::Middle, "cut-out");
    let arm = view.at(DVec2::new(0.26 * width, -0.12 * width));
    label(svg, arm, Anchor::Middle, "arm");
    let body = view.at(DVec2::new(0.5 * width, 0.5 * (geometry.slit_end + bottom)));
    label(svg, [body[0], body[1] + 4.0], Anchor::Middle, "body");
    let slit = view.at(DVec2::new(geometry.slit[1], -geometry.profile.height(width - geometry.slit[1])));
    label(svg, [slit[0] + 4.0, slit[1] - 12.0], Anchor::Start, "stop slit");
    let hook = view.at(corner);
    label(svg, [hook[0] + 10.0, hook[1] - 8.0], Anchor::Start, "hook");
    svg.text(
        [hook[0] + 46.0, hook[1] - 8.0],
        TICK,
        Anchor::Start,
        SOFT,
        &format!("tangent {:.1}° → P", geometry.profile.end.to_degrees()),
    );
    // The overhang, above its plane.
    let (left, right) = (view.at(DVec2::new(width - x_end, 0.0)), view.at(DVec2::new(x_end, 0.0)));
    let y = right[1] + 22.0;
    svg.line([left[0], y], [right[0], y], MEASURE);
    for x in [left[0], right[0]] {
        svg.line([x, right[1]], [x, y + 4.0], MEASURE);
    }
    label(svg, [left[0] - 5.0, y + 4.0], Anchor::End, &format!("o {}", latch.overhang));
    // Height and start angle.
    let edge = view.at(DVec2::new(0.0, top));
    label(
        svg,
        [edge[0] + 40.0, edge[1] + 10.0],
        Anchor::Start,
        &format!("f(0) {top:.1}, {:.0}°", latch.spline_start.to_degrees()),
    );
    let lower = view.at(DVec2::new(0.0, bottom));
    let right = view.at(DVec2::new(width, bottom));
    svg.line([lower[0], lower[1] + 12.0], [right[0], right[1] + 12.0], MEASURE);
    for x in [lower[0], right[0]] {
        svg.line([x, lower[1] + 7.0], [x, lower[1] + 17.0], MEASURE);
    }
    label(svg, [0.5 * (lower[0] + right[0]), lower[1] + 28.0], Anchor::Middle, &format!("L {width} mm"));
    let plane = view.at(DVec2::new(width, 0.0));
    svg.text([plane[0] + 6.0, plane[1] + 4.0], TICK, Anchor::Start, SOFT, "y = 0");
}

/// The panel of the four steps.
pub(super) fn steps(size: [f64; 2]) -> Panel {
    Panel::of(size).over(Legend::titled("dashed: faces of the other layer, while its arms are at rest"))
}

/// A half as it stands: body, neck, arm swung by an angle.
fn half(geometry: &Geometry, swing: f64) -> Vec<Polygon> {
    let turn = DVec2::from_angle(swing);
    let swung = |p: DVec2| geometry.pivot + turn.rotate(p - geometry.pivot);
    let (near, [low, high]) = (geometry.slit[0], geometry.cutout);
    let left = near - geometry.neck;
    let neck = vec![
        DVec2::new(left, low),
        DVec2::new(near, low),
        swung(DVec2::new(near, high)),
        swung(DVec2::new(left, high)),
    ];
    vec![geometry.body(), neck, geometry.arm().into_iter().map(swung).collect()]
}

/// Draws approach, contact, arms pushed outward and the latched pair, a layer of each, so many beside each other.
pub(super) fn sequence(svg: &mut Svg, rect: Rect, drawn: &LatchDrawings<'_>, columns: usize) {
    const GAP: f64 = 18.0;
    /// Room for the name over a step.
    const NAME: f64 = 26.0;
    /// Above the first contact when halves approach, in mm.
    const CLEAR: f64 = 5.0;
    let geometry = drawn.geometry;
    let contact = 2.0 * geometry.profile.height(0.5 * geometry.width);
    // Open widest: the hooks' walls just before they pass.
    let held = drawn.record.positions.iter().filter_map(|p| p.layers.first().map(|hold| (p.above, hold)));
    let (open, swing) =
        held.fold(
            (0.0, 0.0),
            |(above, most), (at, hold)| {
                if hold.swing > most { (at, hold.swing) } else { (above, most) }
            },
        );
    let aside = 0.12 * geometry.width;
    // The mirrored layer is off to the other side, and meets its partner earlier.
    let approach = 2.0 * geometry.profile.height(0.5 * (geometry.width - aside)) + CLEAR;
    let steps = [
        ("1  approach", approach, aside, 0.0),
        ("2  aligned: profiles meet", contact, 0.0, 0.0),
        ("3  arms pushed outward", open.max(0.0), 0.0, swing),
        ("4  snapped", 0.0, 0.0, 0.0),
    ];
    let rows = steps.len().div_ceil(columns);
    let wide = (rect.w + GAP) / columns as f64 - GAP;
    let high = (rect.h + GAP) / rows as f64 - GAP;
    // The same scale for all, so that the first, which is the tallest, fits.
    let tall = approach - 2.0 * geometry.bottom;
    let scale = ((high - NAME) / tall).min(wide / (geometry.width + aside));
    for (k, (name, above, offset, swing)) in steps.into_iter().enumerate() {
        let x = rect.x + (k % columns) as f64 * (wide + GAP);
        let y = rect.y + (k / columns) as f64 * (high + GAP);
        svg.bold([x, y + 10.0], LABEL, Anchor::Start, name);
        let height = above - 2.0 * geometry.bottom;
        let top = y + NAME + 0.5 * (high - NAME - scale * height);
        let view = View { scale, origin: [x, top + scale * (above - geometry.bottom)] };
        let middle = DVec2::new(0.5 * (geometry.width + offset), 0.5 * above);
        for polygon in half(geometry, swing) {
            view.fill(svg, &polygon, [FIXED, FIXED]);
            let turned: Polygon = polygon.iter().map(|p| 2.0 * middle - *p).collect();
            view.fill(svg, &turned, [MOVING, MOVING]);
        }
        // Faces on top, without the seams between arm, neck and body.
        let arm = half(geometry, swing).pop().unwrap_or_default();
        // The other layer's faces, dashed, as long as its arms are at rest.
        let behind: Polygon = geometry.face().iter().map(|p| DVec2::new(geometry.width - p.x, p.y)).collect();
        let partner: Polygon = behind.iter().map(|p| 2.0 * middle - *p).collect();
        // Once both faces coincide, two dashed lines would look solid.
        let dashed = [(behind, FIXED_EDGE), (partner, MOVING_EDGE)];
        let shown = if swing > 0.0 { 0 } else { 1 + usize::from(above > 0.0) };
        for (face, colour) in dashed.into_iter().take(shown) {
            let style =
                format!(r#"fill="none" stroke="{}" stroke-width="0.9" stroke-dasharray="4 3""#, hex(colour));
            svg.path(&polyline(face.iter().map(|p| view.at(*p)), false), &style);
        }
        let turned: Polygon = arm.iter().map(|p| 2.0 * middle - *p).collect();
        for (polygon, colour) in [(arm, FIXED_EDGE), (turned, MOVING_EDGE)] {
            let style = format!(r#"fill="none" stroke="{}" stroke-width="1" {JOIN}"#, hex(colour));
            svg.path(&polyline(polygon.iter().map(|p| view.at(*p)), true), &style);
        }
    }
}
