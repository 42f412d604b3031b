//! Directions in which features can touch: cones of normals.
//!
//! ```text
//!       \  α  |  α  /        all normals by which a corner, an edge or a facet can touch, and those of all features of a part, lie
//!        \    |    /         within α of an axis a; with a slack σ, up to which features that fail to support a normal count, α grows
//!         \   |a  /
//!          \  |  /           two parts can touch only if a and −b, the axis of the other turned round, are within α + β
//! ```
//!
//! A corner's spokes s reach down by h = −a·s beside its axis a. Consider a normal at the angle θ from a,
//! tilted towards the sector between two neighbouring spokes. One of these spokes limits it; the lateral reach
//! of that spoke in this direction is at least w, the distance of the axis from the line between the two
//! tips:
//!
//! ```text
//!   w·sin θ − h·cos θ ≤ σ      so that      θ ≤ φ + asin(σ/r)      with  (w, h) = r·(cos φ, sin φ)
//! ```
//!
//! Not promised: the narrowest cone. Features that would need a cone of 90° or more have [`Cone::WIDE`], and
//! can touch anything.

use super::shape::{Corner, INSIDE, Ridge, Shape};
use crate::tolerance::PARALLEL;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The half-angle of a cone around an axis that its owner knows: below 90°.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cone {
    cosine: f64,
    sine: f64,
}

impl Cone {
    /// All directions. No comparison with its numbers holds.
    pub(super) const WIDE: Self = Self { cosine: f64::NAN, sine: f64::NAN };

    /// Of this half-angle, in radians.
    pub(super) fn of(angle: f64) -> Self {
        if angle < FRAC_PI_2 - PARALLEL {
            let (sine, cosine) = angle.sin_cos();
            Self { cosine, sine }
        } else {
            Self::WIDE
        }
    }

    /// Cosine and sine, in single precision.
    pub(super) const fn single(self) -> [f32; 2] {
        [self.cosine as f32, self.sine as f32]
    }

    /// Rounding of such cosines, with room.
    pub(super) const ROUNDING: f32 = 4e-6;
}

/// The angle from `axis` up to which an edge touches.
pub(super) fn of_ridge(axis: DVec3, ridge: &Ridge, slack: f64) -> f64 {
    ridge.normals.iter().map(|n| n.angle_between(axis)).fold(0.0, f64::max) + slack.asin()
}

/// The angle from `axis` up to which a corner touches.
pub(super) fn of_corner(axis: DVec3, shape: &Shape, corner: &Corner, slack: f64) -> f64 {
    let normals = shape.normals_of(corner);
    let spread = normals.iter().map(|n| n.angle_between(axis)).fold(0.0, f64::max);
    around_spokes(axis, spread, shape.spokes_of(corner), slack).unwrap_or(PI)
}

/// The angle from the axis up to which a corner touches, with its facets within `spread` of the axis; `None`
/// if the spread is too large to determine it.
fn around_spokes(axis: DVec3, spread: f64, spokes: &[DVec3], slack: f64) -> Option<f64> {
    // From here on a normal is against all facets.
    let inside = INSIDE.asin() + FRAC_PI_2 + spread;
    if axis == DVec3::ZERO || inside > PI - PARALLEL {
        return None;
    }
    let (side, across) = axis.any_orthonormal_pair();
    let seen = |s: &DVec3| {
        let lateral = DVec2::new(side.dot(*s), across.dot(*s));
        (lateral.to_angle(), lateral, -axis.dot(*s))
    };
    let mut seen: Vec<(f64, DVec2, f64)> = spokes.iter().map(seen).collect();
    seen.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut widest: f64 = 0.0;
    for (k, (from, p, h)) in seen.iter().enumerate() {
        let (to, q, i) = seen[(k + 1) % seen.len()];
        let gap = to - from + if k + 1 == seen.len() { TAU } else { 0.0 };
        if gap > PI - PARALLEL {
            return None;
        }
        let along = q - *p;
        let share = -p.dot(along) / along.length_squared();
        let w = if share.is_finite() { (*p + along * share.clamp(0.0, 1.0)).length() } else { p.length() };
        // Nor does any hold between a right angle and there.
        let (high, low) = (h.max(i), h.min(i).min(0.0));
        if w <= (2.0 * slack).max((slack - low) / inside.sin()) {
            return None;
        }
        widest = widest.max(high.atan2(w) + (slack / w.hypot(high)).asin());
    }
    Some(widest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::convex_hull;
    use proptest::prelude::*;

    /// Shapes with corners and edges from flat to sharp.
    fn shape(points: &[[f64; 3]], height: f64) -> Option<Shape> {
        let points: Vec<DVec3> =
            points.iter().map(|p| DVec3::from_array(*p) * DVec3::new(1.0, 1.0, height)).collect();
        convex_hull(&points).ok().map(|surface| Shape::new(&surface))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn contact_normals_of_a_corner_lie_in_its_cone(
            points in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 6..20),
            height in prop_oneof![Just(1.0), 0.001..1.0f64], slack in prop_oneof![Just(4e-6), 0.0..0.2f64],
            pushes in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 40),
        ) {
            let Some(shape) = shape(&points, height) else { return Ok(()) };
            for corner in &shape.corners {
                let axis = shape.normals_of(corner).iter().sum::<DVec3>().normalize_or_zero();
                let most = of_corner(axis, &shape, corner, slack);
                for (k, push) in pushes.iter().enumerate() {
                    // Test directions near the facet normals, which bound the supported set, and anywhere
                    // else.
                    let normals = shape.normals_of(corner);
                    let about = normals[k % normals.len()] * [0.0, 1.0, 3.0, 10.0][k % 4];
                    let normal = (about + DVec3::from_array(*push)).normalize_or_zero();
                    if shape.supports(corner, -normal, slack) {
                        prop_assert!(normal.angle_between(axis) <= most + 1e-9, "{normal} from {axis}: {most}");
                    }
                }
            }
        }
    }

    #[test]
    fn cones_enclose_their_normals_tightly() {
        // The tip of a cube: 54.7° from its axis to its facets, whose normals it touches by.
        let corners: Vec<_> = (0..8).map(|k| [0, 1, 2].map(|i| f64::from(k >> i & 1))).collect();
        let cube = shape(&corners, 1.0).unwrap();
        let corner = &cube.corners[0];
        let axis = cube.normals_of(corner).iter().sum::<DVec3>().normalize();
        let angle = of_corner(axis, &cube, corner, 0.0);
        assert!((angle.cos() - 1.0 / 3.0_f64.sqrt()).abs() < 1e-9, "{angle}");
        let ridge = &cube.ridges[0];
        let axis = (ridge.normals[0] + ridge.normals[1]).normalize();
        assert!((of_ridge(axis, ridge, 0.1) - std::f64::consts::FRAC_PI_4 - 0.1_f64.asin()).abs() < 1e-12);
    }
}
