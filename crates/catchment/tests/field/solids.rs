//! Solids of docks as convex pieces, from the makers' dimensions.

use catchment::prelude::DVec3;
use std::f64::consts::TAU;

pub(crate) type Pieces = Vec<Vec<DVec3>>;

/// Corners of a regular polygon about an axis.
pub(crate) fn ring(sides: u32, center: [f64; 2], radius: f64, z: f64) -> Vec<DVec3> {
    let corner = |k| {
        let a = TAU * f64::from(k) / f64::from(sides);
        DVec3::new(center[0] + radius * a.cos(), center[1] + radius * a.sin(), z)
    };
    (0..sides).map(corner).collect()
}

/// Points of an arc about the approach axis, angles in degrees.
pub(crate) fn arc(radius: f64, from: f64, to: f64, steps: u32, z: f64) -> Vec<DVec3> {
    let corner = |k| {
        let a = (from + (to - from) * f64::from(k) / f64::from(steps)).to_radians();
        DVec3::new(radius * a.cos(), radius * a.sin(), z)
    };
    (0..=steps).map(corner).collect()
}

/// Corners of a rectangle about the approach axis, with these half sides.
pub(crate) fn rectangle(half: [f64; 2], z: f64) -> Vec<DVec3> {
    [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
        .map(|[x, y]| DVec3::new(x * half[0], y * half[1], z))
        .into()
}

/// The solid between consecutive outlines: a peg, a block, a cone.
pub(crate) fn body(outlines: &[Vec<DVec3>]) -> Pieces {
    outlines.windows(2).map(<[Vec<DVec3>]>::concat).collect()
}

/// The solid around a hole with these outlines, out to `outer`, side by side.
pub(crate) fn around(outlines: &[Vec<DVec3>], outer: &[DVec3]) -> Pieces {
    let mut pieces = Vec::new();
    for level in outlines.windows(2) {
        for k in 0..outer.len() {
            let next = (k + 1) % outer.len();
            let mut corners = Vec::new();
            for inner in level {
                let z = inner[k].z;
                corners.extend([inner[k], inner[next], outer[k].with_z(z), outer[next].with_z(z)]);
            }
            pieces.push(corners);
        }
    }
    pieces
}

/// The pieces in D.
pub(crate) fn scaled(pieces: Pieces, width: f64) -> Pieces {
    pieces.into_iter().map(|piece| piece.into_iter().map(|p| p / width).collect()).collect()
}

/// The pieces turned about the approach axis.
pub(crate) fn turned(pieces: &Pieces, angle: f64) -> Pieces {
    let turn = glam::DMat3::from_rotation_z(angle);
    pieces.iter().map(|piece| piece.iter().map(|p| turn * *p).collect()).collect()
}
