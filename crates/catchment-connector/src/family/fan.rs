//! Families whose face is a fan of triangles from a point of the axis to a rim: pyramid, cone, saddle.

use super::{Check, Draw, Halves, SOCKET_THICKNESS};
use crate::{Surface, SurfaceError};
use catchment_design::design::family::{Cone, Pyramid, XFace3d};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Radius of the cone's rim, in D.
const CONE_RADIUS: f64 = 0.5;
/// Most corners of a polygon that stands for a circle: beyond it the pair has more elements than it repays.
pub(crate) const MAX_CORNERS: f64 = 512.0;

impl Draw for Pyramid {
    /// Socket: four facets from the apex (0, 0, 0) to the rim square at z = H. Plug: its positive.
    fn halves(&self) -> Halves {
        socket_and_plug(self.aspect_ratio, self.base_thickness, &square())
    }
}

impl Draw for Cone {
    /// Refuses a chord error that would take too many corners.
    fn check(&self, check: &mut Check) {
        let error = self.chord_error;
        let corners = corners_of_circle(CONE_RADIUS, error);
        check.require(
            "chord_error",
            error,
            error > 0.0 && corners <= MAX_CORNERS,
            format!(
                "between {:.1e} ({MAX_CORNERS} corners) and the radius",
                chord_error(CONE_RADIUS, MAX_CORNERS)
            ),
        );
    }

    /// Probe and drogue over the same inscribed polygon.
    fn halves(&self) -> Halves {
        let rim = circle(CONE_RADIUS, corners_of_circle(CONE_RADIUS, self.chord_error) as usize);
        socket_and_plug(self.aspect_ratio, self.base_thickness, &rim)
    }
}

impl Draw for XFace3d {
    /// z = H/2 + H·(|x+y| − |x−y|)/2: corners alternate between H and 0 around the saddle point at H/2.
    fn halves(&self) -> Halves {
        let h = self.aspect_ratio;
        let rim: Vec<DVec3> =
            square().iter().map(|p| p.extend(if p.x * p.y > 0.0 { h } else { 0.0 })).collect();
        let base = self.base_thickness.unwrap_or(SOCKET_THICKNESS);
        let half = vec![fan(DVec3::new(0.0, 0.0, h / 2.0), &rim, base)];
        [half.clone(), half]
    }
}

/// Largest distance between a circle and its inscribed regular polygon.
fn chord_error(radius: f64, corners: f64) -> f64 {
    radius * (1.0 - (PI / corners).cos())
}

/// Corners of the inscribed polygon that stays within `error` of a circle: a multiple of four, at least
/// eight, so that both mounts map the polygon onto itself.
pub(crate) fn corners_of_circle(radius: f64, error: f64) -> f64 {
    let half_angle = (1.0 - error / radius).clamp(-1.0, 1.0).acos();
    // Rounding must not turn the exact error of n corners into n + 4.
    ((PI / half_angle - 1e-9) / 4.0).ceil().max(2.0) * 4.0
}

/// A regular polygon, counter-clockwise; mirror images about both axes are exact.
pub(crate) fn circle(radius: f64, corners: usize) -> Vec<DVec2> {
    let quarter = corners / 4;
    (0..corners)
        .map(|k| {
            let angle = FRAC_PI_2 * (k % quarter) as f64 / quarter as f64;
            // Sines of complementary angles keep the two diagonals exact as well.
            let p = radius * DVec2::new((FRAC_PI_2 - angle).sin(), angle.sin());
            match k / quarter {
                0 => p,
                1 => DVec2::new(-p.y, p.x),
                2 => -p,
                _ => DVec2::new(p.y, -p.x),
            }
        })
        .collect()
}

fn square() -> [DVec2; 4] {
    [DVec2::new(0.5, -0.5), DVec2::new(0.5, 0.5), DVec2::new(-0.5, 0.5), DVec2::new(-0.5, -0.5)]
}

fn socket_and_plug(h: f64, base: Option<f64>, rim: &[DVec2]) -> Halves {
    let ring = |z: f64| rim.iter().map(|p| p.extend(z)).collect::<Vec<_>>();
    let socket = fan(DVec3::ZERO, &ring(h), base.unwrap_or(SOCKET_THICKNESS));
    let plug = fan(DVec3::new(0.0, 0.0, h), &ring(0.0), base.unwrap_or(0.0));
    [vec![socket], vec![plug]]
}

/// The solid under a fan of triangles from `apex` to `rim` (counter-clockwise from above), backed by walls
/// down to z = −`base`. With `base` = 0 the rim must be level at z = 0, and closes the solid itself.
fn fan(apex: DVec3, rim: &[DVec3], base: f64) -> Result<Surface, SurfaceError> {
    let n = rim.len() as u32;
    let next = |k: u32| (k + 1) % n;
    let mut vertices = vec![apex];
    vertices.extend(rim);
    let mut polygons: Vec<Vec<u32>> = (0..n).map(|k| vec![0, 1 + k, 1 + next(k)]).collect();
    let floor = if base > 0.0 {
        vertices.extend(rim.iter().map(|p| p.truncate().extend(-base)));
        polygons.extend((0..n).map(|k| vec![1 + n + k, 1 + n + next(k), 1 + next(k), 1 + k]));
        1 + n
    } else {
        1
    };
    polygons.push((0..n).rev().map(|k| floor + k).collect());
    Surface::from_polygons(vertices, &polygons)
}
