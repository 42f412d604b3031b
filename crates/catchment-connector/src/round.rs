//! Test whether a half is round about the approach axis, within its tessellation.
//!
//! ```text
//!       ●────●         corners in rings: equal height and radius, evenly spread;
//!     ╱    ·   ╲       facets that span at most 2π/16 and face along the radius
//!    ●    axis   ●
//! ```
//!
//! A body with flanks (a spline, a key, a hole beside the axis) has facets that face across the radius, and
//! is not round; a polygon of fewer than 16 sides counts as a polygon.

use super::Half;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Sides of a polygon from which on it stands for a circle.
const FEWEST_SIDES: f64 = 16.0;
/// Largest distance that counts as on the axis, or as the same radius, in D: single precision.
const NEAR: f64 = 1e-5;
/// Largest inclination of a facet across the radius beyond half the angle that it spans: rounding.
const ACROSS: f64 = 1e-3;

impl Half {
    /// Whether the half is round between two heights, in its facets strictly between them: a rotation about
    /// the approach axis only changes the orientation of its polygons. `false` if it has no such facets.
    pub fn is_round(&self, zone: [f64; 2]) -> bool {
        let [low, high] = zone;
        let mut any = false;
        for surface in &self.surfaces {
            for facet in &surface.facets {
                let corners = || facet.corners.iter().map(|&k| surface.vertices[k as usize]);
                let within = corners().any(|p| p.z > low + NEAR) && corners().any(|p| p.z < high - NEAR);
                if within && !faces_along_the_radius(facet.normal, corners) {
                    return false;
                }
                any |= within;
            }
        }
        any
    }

    /// The lowest and the highest z of its corners; an empty interval without any.
    pub fn span(&self) -> [f64; 2] {
        self.surfaces
            .iter()
            .flat_map(|surface| &surface.vertices)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p.z), high.max(p.z)])
    }
}

/// Whether a facet may belong to a body of revolution.
fn faces_along_the_radius<I: Iterator<Item = DVec3>>(normal: DVec3, corners: impl Fn() -> I) -> bool {
    if normal.truncate().length() <= NEAR {
        // A level facet is round if its outline is; the neighbouring facets test the outline.
        return true;
    }
    let outer = || corners().map(DVec3::truncate).filter(|p| p.length() > NEAR);
    let Some(first) = outer().next() else { return false };
    let angle = |p: DVec2| first.angle_to(p);
    let (low, high) =
        outer().map(angle).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(a), h.max(a)));
    let span = high - low;
    if span > TAU / FEWEST_SIDES + NEAR {
        return false;
    }
    let middle = DVec2::from_angle(0.5 * (low + high)).rotate(first.normalize());
    let across = middle.perp_dot(normal.truncate()).abs() / normal.truncate().length();
    across <= (0.5 * span).sin() + ACROSS && has_even_rings(corners)
}

/// Whether the corners of a facet lie on at most two circles about the axis, each at a constant height.
fn has_even_rings<I: Iterator<Item = DVec3>>(corners: impl Fn() -> I) -> bool {
    let ring = |p: DVec3| DVec2::new(p.truncate().length(), p.z);
    let Some(first) = corners().next().map(ring) else { return false };
    let Some(second) = corners().map(ring).find(|r| r.distance(first) > NEAR) else { return false };
    corners().map(ring).all(|r| r.distance(first).min(r.distance(second)) <= NEAR)
}

#[cfg(test)]
mod tests {
    use crate::{Connector, Half, convex_hull};
    use catchment_base::pose::Mount;
    use catchment_design::design::{Family, FamilySpec};
    use glam::DVec3;
    use std::f64::consts::TAU;

    const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    /// A prism over a polygon of `sides` about an axis at x = `center`.
    fn prism(sides: u32, center: f64) -> Half {
        let corners: Vec<DVec3> = (0..2 * sides)
            .map(|k| {
                let a = TAU * f64::from(k / 2) / f64::from(sides);
                DVec3::new(center + 0.3 * a.cos(), 0.3 * a.sin(), f64::from(k % 2))
            })
            .collect();
        Half::of(vec![convex_hull(&corners).unwrap()])
    }

    #[test]
    fn polygons_of_many_sides_about_the_axis_are_round() {
        for (sides, center, round) in
            [(4, 0.0, false), (8, 0.0, false), (16, 0.0, true), (32, 0.0, true), (32, 0.1, false)]
        {
            assert_eq!(prism(sides, center).is_round(ALL), round, "{sides} sides at {center}");
        }
    }

    #[test]
    fn of_the_families_only_the_cone_is() {
        for family in Family::ALL {
            let halves = Connector::of_family(&FamilySpec::new(family), Mount::X).unwrap();
            let expected = family == Family::Cone;
            assert_eq!(halves.moving.is_round(ALL), expected, "{}", family.name());
        }
    }
}
