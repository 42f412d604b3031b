//! Arrows: directions, and distances between two points.

use super::svg::{JOIN, Svg, polyline};

/// Length of a head, at most.
const HEAD: f64 = 8.0;
/// Of a short arrow the head takes this share.
const SHARE: f64 = 0.4;

/// An arrow that points at `to`.
pub fn arrow(svg: &mut Svg, from: [f64; 2], to: [f64; 2], colour: &str, width: f64) {
    svg.line(from, to, &format!(r#"stroke="{colour}" stroke-width="{width}" {JOIN}"#));
    head(svg, from, to, colour);
}

/// A length: an arrow that points at both ends.
pub fn dimension(svg: &mut Svg, a: [f64; 2], b: [f64; 2], colour: &str) {
    arrow(svg, a, b, colour, 1.1);
    head(svg, b, a, colour);
}

fn head(svg: &mut Svg, from: [f64; 2], to: [f64; 2], colour: &str) {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy);
    if length == 0.0 {
        return;
    }
    let size = HEAD.min(SHARE * length);
    let [ux, uy] = [dx / length * size, dy / length * size];
    // A third as wide, to either side, as it is long.
    let back = |side: f64| [to[0] - ux - side * uy / 3.0, to[1] - uy + side * ux / 3.0];
    svg.path(&polyline([to, back(1.0), back(-1.0)], true), &format!(r#"fill="{colour}""#));
}
