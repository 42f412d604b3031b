//! A filleted funnel and its plug, as CAD exports them: lathe bodies, cut into a given number of triangles.
//!
//! ```text
//!     fixed   │╲__                __╱│       rim fillet, cone, round bottom: one smooth profile
//!             │   ╲              ╱   │
//!             │    ╲____    ____╱    │       its plug has the same profile, so that when mated
//!             │         ╲__╱         │       everything touches everywhere
//!             └──────────────────────┘
//! ```
//!
//! Corners are rounded to single precision, as a binary STL holds them.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Radius of the halves, in D.
const RADIUS: f64 = 0.5;
/// Slope of the cone, as an angle from the horizontal.
const SLOPE: f64 = 0.9;
/// Radius of the bottom, and of the fillet at the rim.
const ROUND: f64 = 0.1;
/// Radius at which the fillet ends in the flat rim.
const MOUTH: f64 = 0.45;
/// Thickness of a half behind its face.
const BACK: f64 = 0.2;

/// Triangles of a half.
pub(crate) type Triangles = Vec<[DVec3; 3]>;

/// The profile of the face from the axis to the rim: `count` + 1 points (radius, z), the rim at z = 0.
fn profile(count: usize) -> Vec<DVec2> {
    let (sine, cosine) = SLOPE.sin_cos();
    // From the axis: an arc up to the slope, the cone, an arc back to level.
    let straight = (MOUTH - 2.0 * ROUND * sine) / cosine;
    let (arc, all) = (ROUND * SLOPE, 2.0 * ROUND * SLOPE + straight);
    let depth = 2.0 * ROUND * (1.0 - cosine) + straight * sine;
    let at = |s: f64| {
        if s <= arc {
            let a = s / ROUND;
            DVec2::new(ROUND * a.sin(), ROUND * (1.0 - a.cos()))
        } else if s <= arc + straight {
            DVec2::new(ROUND * sine, ROUND * (1.0 - cosine)) + DVec2::new(cosine, sine) * (s - arc)
        } else {
            let a = (all - s) / ROUND;
            DVec2::new(MOUTH - ROUND * a.sin(), depth - ROUND * (1.0 - a.cos()))
        }
    };
    (0..=count).map(|k| at(all * k as f64 / count as f64) - DVec2::new(0.0, depth)).collect()
}

/// Fixed and moving half of about `count` triangles each, both facing +z, their rims at z = 0.
pub(crate) fn funnel(count: usize) -> [Triangles; 2] {
    // Facets as long as they are wide where the face is half as wide as the half: 2·sides·rings triangles.
    let rings = ((count as f64 / 8.0).sqrt().round() as usize).max(4);
    let sides = (count / (2 * rings + 4)).max(8);
    let mut face = profile(rings);
    let bottom = face[0].y;
    let back = bottom - BACK;
    // From the bottom of the face over the rim down the outside to the middle of the back.
    let socket =
        [&face[..], &[DVec2::new(RADIUS, 0.0), DVec2::new(RADIUS, back), DVec2::new(0.0, back)]].concat();
    // The plug as it faces +z: its tip on top.
    for p in &mut face {
        p.y = -p.y;
    }
    let plug =
        [&face[..], &[DVec2::new(RADIUS, 0.0), DVec2::new(RADIUS, -BACK), DVec2::new(0.0, -BACK)]].concat();
    [lathe(&socket, sides), lathe(&plug, sides)]
}

/// The same halves with a cone for a face: long thin triangles that meet in its tip, as many as it has sides.
pub(crate) fn cone(sides: usize) -> [Triangles; 2] {
    let body = |tip: f64, back: f64| {
        let line = [(0.0, tip), (MOUTH, 0.0), (RADIUS, 0.0), (RADIUS, back), (0.0, back)];
        lathe(&line.map(|(radius, z)| DVec2::new(radius, z)), sides)
    };
    [body(-MOUTH, -MOUTH - BACK), body(MOUTH, -BACK)]
}

/// A profile (radius, z) turned about z.
fn lathe(line: &[DVec2], sides: usize) -> Triangles {
    let single = |p: DVec3| p.as_vec3().as_dvec3();
    let corner = |p: DVec2, k: usize| {
        let (sine, cosine) = (TAU * (k % sides) as f64 / sides as f64).sin_cos();
        single(DVec3::new(p.x * cosine, p.x * sine, p.y))
    };
    let mut triangles = Triangles::new();
    for ends in line.windows(2) {
        for k in 0..sides {
            let [a, b] = [corner(ends[0], k), corner(ends[0], k + 1)];
            let [d, c] = [corner(ends[1], k), corner(ends[1], k + 1)];
            triangles.extend(
                [[a, c, b], [a, d, c]].into_iter().filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]),
            );
        }
    }
    triangles
}
