//! Balls and cones as facets, with their corners on the surface.
//!
//! ```text
//!      ___
//!    ╱  |  ╲     a ball of n meridians and n/2 + 1 circles of latitude: each facet bends away
//!   |───┼───|    from it along both, so that the two errors of a chord add up:
//!    ╲__|__╱     r (1 − cos² π/n) ≤ chord error
//! ```

use super::PartGeometryError;
use crate::Surface;
use crate::family::{MAX_CORNERS, circle, corners_of_circle};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Most meridians of a ball: it then has 8064 facets.
const MAX_MERIDIANS: f64 = 128.0;

/// A ball about the origin; both are in D.
pub(super) fn sphere(radius: f64, chord_error: f64) -> Result<Surface, PartGeometryError> {
    let half_angle = (chord_error / radius).min(1.0).sqrt().asin();
    // Rounding must not turn the exact error of n meridians into n + 4.
    let meridians = ((PI / half_angle - 1e-9) / 4.0).ceil().max(2.0) * 4.0;
    let least = radius * (PI / MAX_MERIDIANS).sin().powi(2);
    suits(radius, chord_error, meridians <= MAX_MERIDIANS, least)?;
    let equator = circle(1.0, meridians as usize);
    // From the north pole down: a quarter turn of the same circle, mirrored, so that north and south are alike to the bit.
    let quarter = &equator[..=meridians as usize / 4];
    let rings: Vec<(f64, f64)> = quarter[1..]
        .iter()
        .map(|p| (p.y, p.x))
        .chain(quarter[1..quarter.len() - 1].iter().rev().map(|p| (p.y, -p.x)))
        .map(|(across, up)| (across * radius, up * radius))
        .collect();
    Ok(turned(&equator, Some(radius), &rings, Some(-radius))?)
}

/// A cone that stands on the origin, with these radii of floor and top; all are in D.
pub(super) fn cone(
    [floor, top]: [f64; 2],
    height: f64,
    chord_error: f64,
) -> Result<Surface, PartGeometryError> {
    let radius = floor.max(top);
    let corners = corners_of_circle(radius, chord_error);
    let least = radius * (1.0 - (PI / MAX_CORNERS).cos());
    suits(radius, chord_error, corners <= MAX_CORNERS, least)?;
    let rim = circle(1.0, corners as usize);
    let surface = if top > 0.0 {
        turned(&rim, None, &[(top, height), (floor, 0.0)], None)
    } else {
        turned(&rim, Some(height), &[(floor, 0.0)], None)
    };
    Ok(surface?)
}

fn suits(radius: f64, chord_error: f64, is_coarse: bool, least: f64) -> Result<(), PartGeometryError> {
    if is_coarse && chord_error > 0.0 && chord_error < radius {
        Ok(())
    } else {
        Err(PartGeometryError::Chord { chord_error, radius, least })
    }
}

/// A body of revolution about z over a rim of radius 1: rings (radius, z) from the top down, with an apex above and below them, or a level
/// facet.
fn turned(
    rim: &[DVec2],
    apex: Option<f64>,
    rings: &[(f64, f64)],
    nadir: Option<f64>,
) -> Result<Surface, crate::SurfaceError> {
    let n = rim.len() as u32;
    let corner = |ring: u32, k: u32| ring * n + k % n;
    let mut vertices: Vec<DVec3> =
        rings.iter().flat_map(|(radius, z)| rim.iter().map(move |p| (*p * *radius).extend(*z))).collect();
    let mut polygons = Vec::new();
    for ring in 1..rings.len() as u32 {
        polygons.extend((0..n).map(|k| {
            vec![corner(ring, k), corner(ring, k + 1), corner(ring - 1, k + 1), corner(ring - 1, k)]
        }));
    }
    let mut close = |ring: u32, pole: Option<f64>, is_top: bool| {
        let Some(z) = pole else {
            let level = (0..n).map(|k| corner(ring, k));
            polygons.push(if is_top { level.collect() } else { level.rev().collect() });
            return;
        };
        let pole = vertices.len() as u32;
        vertices.push(DVec3::new(0.0, 0.0, z));
        polygons.extend((0..n).map(|k| {
            let (a, b) = (corner(ring, k), corner(ring, k + 1));
            if is_top { vec![a, b, pole] } else { vec![b, a, pole] }
        }));
    };
    close(0, apex, true);
    close(rings.len() as u32 - 1, nadir, false);
    Surface::from_polygons(vertices, &polygons)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The distances from the origin to the planes of all facets.
    fn planes(surface: &Surface) -> impl Iterator<Item = f64> {
        surface.facets.iter().map(|f| f.normal.dot(surface.vertices[f.corners[0] as usize]))
    }

    proptest! {
        /// Corners on the ball, facets inside it by no more than the chord error; convex, and mirror images of itself.
        #[test]
        fn a_ball_is_within_its_chord_error(radius in 0.01..2.0f64, share in 0.001..0.5f64) {
            let chord_error = radius * share;
            let ball = sphere(radius, chord_error).unwrap();
            prop_assert!(ball.convex);
            prop_assert!(ball.vertices.iter().all(|p| (p.length() - radius).abs() < 1e-12 * radius));
            let nearest = planes(&ball).fold(f64::INFINITY, f64::min);
            prop_assert!(nearest > radius - chord_error * (1.0 + 1e-9), "{}", nearest);
            // Every tenth ball: all corners against all.
            let mirrors = if share > 0.02 { 3 } else { 0 };
            for mirror in [DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, 1.0), DVec3::new(1.0, 1.0, -1.0)].into_iter().take(mirrors) {
                let has = |p: DVec3| ball.vertices.iter().any(|q| q.distance(p) < 1e-15 * radius.max(0.1));
                prop_assert!(ball.vertices.iter().all(|p| has(*p * mirror)));
            }
        }

        #[test]
        fn a_cone_has_the_volume_of_one(floor in 0.1..1.0f64, top in 0.0..1.0f64, height in 0.1..2.0f64) {
            let solid = cone([floor, top], height, 1e-4).unwrap();
            let round = PI * height * (floor * floor + floor * top + top * top) / 3.0;
            // A polygon of n corners lacks (2π/n)²/6 of its circle's area, n from the chord error.
            let lacking = (2.0 * PI / corners_of_circle(floor.max(top), 1e-4)).powi(2) / 6.0;
            prop_assert!(solid.convex && (solid.volume() / round - 1.0 + lacking).abs() < lacking * 0.01);
            let (low, high) = solid.bounds();
            prop_assert!(low.z == 0.0 && high.z == height);
        }
    }

    #[test]
    fn chord_errors_that_suit_nothing_are_refused() {
        for (radius, chord_error) in [(0.5, 1e-6), (0.5, 0.5), (0.5, 0.0), (0.5, f64::NAN)] {
            assert!(
                matches!(sphere(radius, chord_error), Err(PartGeometryError::Chord { .. })),
                "{chord_error}"
            );
            let cone = cone([radius, 0.0], 1.0, chord_error);
            assert!(matches!(cone, Err(PartGeometryError::Chord { .. })), "{chord_error}");
        }
        let least = match sphere(0.5, 1e-6) {
            Err(PartGeometryError::Chord { least, .. }) => least,
            other => panic!("{other:?}"),
        };
        assert_eq!(sphere(0.5, least).unwrap().facets.len(), 128 * 64);
    }
}
