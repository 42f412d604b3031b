//! Mass, centre of mass and inertia, and their combination with damping.
//!
//! ```text
//!   implicit step    (M + Δt·C)·u' = M·u + Δt·f        C: force −c·v at the COR, torque −c_ω·ω
//! ```
//!
//! C is itself the mass matrix of a rigid body: a point mass c at the COR with an isotropic inertia. A damped
//! half therefore moves like an undamped half with `M + Δt·C` in place of M, which begins each step with the
//! velocity that has the momentum `M·u`. Contacts see `M + Δt·C` too: if damping dominates, they push in the
//! metric of friction, for any inertia, and every step is stable.

use super::settings::{DropSettings, MassProperties};
use crate::connector::{Half, Surface};
use crate::design::Alignment;
use crate::pose::face_from_cor;
use glam::{DMat3, DVec3};

/// A rigid body, seen from the COR, in its own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mass {
    /// In kg.
    pub(super) weight: f64,
    /// Centre of mass, in D.
    pub(super) center: DVec3,
    /// About the centre of mass, in kg·D².
    pub(super) inertia: DMat3,
}

impl Mass {
    /// Mass properties of the moving half by the settings, relative to the COR.
    pub(super) fn of(moving: &Half, settings: &DropSettings, alignment: &Alignment) -> Self {
        let mass = match settings.body {
            MassProperties::Given { mass, gyration, center } => {
                let radius = gyration.unwrap_or(alignment.rotation_length);
                let face = face_from_cor(&DMat3::IDENTITY, alignment.center_of_rotation);
                let center = center.map_or(DVec3::ZERO, |center| face + DVec3::from_array(center));
                Self { weight: mass, center, inertia: isotropic(mass * radius * radius) }
            }
            MassProperties::Solid { density } => Self::solid(&moving.surfaces, density),
        };
        Self { inertia: mass.inertia * settings.inertia_factor, ..mass }
    }

    /// Volume integrals over the tetrahedra from the origin to the triangles of the surfaces.
    fn solid(surfaces: &[Surface], density: f64) -> Self {
        let (mut mass, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for surface in surfaces {
            let at = |i: u32| surface.vertices[i as usize];
            for facet in &surface.facets {
                for pair in facet.corners[1..].windows(2) {
                    let [a, b, c] = [at(facet.corners[0]), at(pair[0]), at(pair[1])];
                    let (volume, sum) = (density * a.dot(b.cross(c)) / 6.0, a + b + c);
                    mass += volume;
                    first += volume / 4.0 * sum;
                    second += (outer(sum, sum) + outer(a, a) + outer(b, b) + outer(c, c)) * (volume / 20.0);
                }
            }
        }
        let center = first / mass;
        let about = second - outer(center, center) * mass;
        let trace = about.x_axis.x + about.y_axis.y + about.z_axis.z;
        Self { weight: mass, center, inertia: isotropic(trace) - about }
    }

    /// The body that an implicit step of `settings.timestep` moves: this body with its damping.
    pub(super) fn damped(&self, settings: &DropSettings, rotation_length: f64) -> Self {
        let impulse = settings.timestep * self.weight;
        let at_cor = Self {
            weight: impulse * settings.damping,
            center: DVec3::ZERO,
            inertia: isotropic(
                impulse
                    * settings.angular_damping
                    * settings.inertia_factor
                    * rotation_length
                    * rotation_length,
            ),
        };
        let weight = self.weight + at_cor.weight;
        let center = self.center * (self.weight / weight);
        let about = |part: &Self| part.inertia + point(part.center - center, part.weight);
        Self { weight, center, inertia: about(self) + about(&at_cor) }
    }
}

/// The same inertia about every axis.
fn isotropic(inertia: f64) -> DMat3 {
    DMat3::from_diagonal(DVec3::splat(inertia))
}

/// a·bᵀ.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Inertia of a point mass at `r` about the origin.
fn point(r: DVec3, mass: f64) -> DMat3 {
    isotropic(mass * r.length_squared()) - outer(r, r) * mass
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::convex_hull;

    #[test]
    fn a_brick_has_the_inertia_of_a_brick() {
        let (size, center) = (DVec3::new(0.6, 0.8, 1.0), DVec3::new(0.3, -0.2, 0.5));
        let corner = |i: u8| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5;
        let points: Vec<DVec3> = (0..8).map(|i| center + size * corner(i)).collect();
        let brick = Mass::solid(&[convex_hull(&points).unwrap()], 2.0);
        let mass = 2.0 * size.x * size.y * size.z;
        // m (b² + c²)/12 about each axis.
        let squares = size * size;
        let inertia = DMat3::from_diagonal((DVec3::splat(squares.element_sum()) - squares) * mass / 12.0);
        assert!((brick.weight - mass).abs() < 1e-14 && (brick.center - center).length() < 1e-14);
        assert!(brick.inertia.abs_diff_eq(inertia, 1e-14), "{}", brick.inertia);
    }

    #[test]
    fn heavy_damping_leaves_the_metric_of_friction() {
        let settings =
            DropSettings { timestep: 1.0, damping: 1e9, angular_damping: 1e9, ..DropSettings::default() };
        let body = Mass { weight: 2.0, center: DVec3::new(0.1, 0.0, 0.3), inertia: isotropic(7.0) };
        let damped = body.damped(&settings, 0.5);
        assert!((damped.weight / 2e9 - 1.0).abs() < 1e-8 && damped.center.length() < 1e-8);
        assert!((damped.inertia * (1.0 / (damped.weight * 0.25))).abs_diff_eq(DMat3::IDENTITY, 1e-7));
    }
}
