//! The first contact of a planar design as the dissertation draws it: rotation points, lever arms, and the angles between them.
//!
//! ```text
//!        P_M ○            corner's body: lever l from its rotation point to the contact
//!            ┆╲ β_p       edge's body: d from its rotation point to the line of the edge, q₁ along it to the contact
//!            ┆ ╲ l
//!    N  ↖    ┆  ╲         N    normal of the touched edge, out of its body
//!         ╲  ╱ ● P_C      α_e  from the edge's normal to its body's vertical
//!      ────╲─────         β_p  from the corner's body's vertical to the lever
//!        d  ╲ q₁          θ₂   from the edge's normal to the lever;  aligned when θ₂ = β_p + α_e  (3.2)
//!        P_B ○            θ₁   from the lateral direction to the edge's normal
//! ```
//!
//! A body's vertical runs along its approach axis. Angles are positive in the sense of the aligned contact:
//! the sense of all is chosen so that `β_p + α_e` ≥ 0, and θ₂ < 0 is the text's failed mate. θ₂ minus
//! `β_p + α_e` is the signed relative rotation of the halves. In these terms the position of the corner's
//! rotation point relative to the edge's is, across and along N,
//!
//! `e·(P − P') = d cos θ₁ + q₁ sin θ₁ + l cos(θ₁ − θ₂)`,   `q₂ = d + l cos θ₂`,
//!
//! with e = ∓x, the side to which the sense points: the text's constraint x = x₀ and its first equation of
//! (3.1). Both hold exactly here; θ₁, which the text leaves to the figure, was identified by this, and that
//! reading is ours.
//!
//! Rotation points are those of the method ([`super`]): each lies on the axis of its half, −cor behind mid
//! height. If an edge lies flush on an edge, the contact is a corner of the moving half. Lengths in D, angles
//! in radians, positions as (x, z). Source: the dissertation, section 3.1.1, figures 3.3 and 3.4, equations
//! 3.1 and 3.2.
//!
//! Not promised: any later contact, or that the first contact is unique (figure 3.6 has two).

use super::stepping::{self, Faces, Halt};
use super::{KinematicSettings, PlanarFace, UnsuitableDesign};
use crate::acceptance::Outcome;
use crate::connector::{Half, Surface};
use crate::contact::Contact;
use crate::pose::{CorPose, PoseError};
use crate::problem::Problem;
use crate::tolerance::{COINCIDENT, PARALLEL};
use glam::{DMat3, DVec2, DVec3};
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum LeverBody {
    /// The fixed half.
    Base,
    /// The moving half.
    Moving,
}

impl LeverBody {
    /// Name for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Base => "base",
            Self::Moving => "moving",
        }
    }
}

/// A contact of a corner of a body with an edge of the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lever {
    /// Whose corner it is; the edge is the other's.
    pub corner: LeverBody,
    /// Rotation point of the corner's body.
    pub corner_pivot: DVec2,
    /// Rotation point of the edge's body.
    pub edge_pivot: DVec2,
    /// Contact point.
    pub contact: DVec2,
    /// Unit normal of the edge, out of its body.
    pub normal: DVec2,
    /// l, from the corner's rotation point to the contact.
    pub length: f64,
    /// d, from the edge's rotation point to the line of the edge, along the normal.
    pub distance: f64,
    /// q₁, from there to the contact, along the edge.
    pub along: f64,
    /// `β_p`.
    pub beta_p: f64,
    /// `α_e`.
    pub alpha_e: f64,
    /// θ₁.
    pub theta_1: f64,
    /// θ₂.
    pub theta_2: f64,
    /// Which way positive angles turn: 1 counter-clockwise in the x–z plane with x to the right, −1 clockwise.
    pub sense: f64,
}

impl Lever {
    /// θ₂ of aligned halves: `β_p + α_e`, in [0, π].
    pub fn aligned(&self) -> f64 {
        wrapped(self.beta_p + self.alpha_e)
    }

    /// The vertical of the corner's body, from its rotation point to its face.
    pub fn corner_vertical(&self) -> DVec2 {
        let lever = self.contact - self.corner_pivot;
        DVec2::from_angle(-self.sense * self.beta_p).rotate(lever).normalize_or_zero()
    }

    /// The vertical of the edge's body, from its rotation point to its face.
    pub fn edge_vertical(&self) -> DVec2 {
        DVec2::from_angle(self.sense * self.alpha_e).rotate(self.normal)
    }

    /// The lateral direction that θ₁ is measured from.
    pub const fn lateral(&self) -> DVec2 {
        DVec2::new(-self.sense, 0.0)
    }

    /// Of a contact; `facings` are the approach axes of both bodies, from the rotation point to the face.
    fn new(
        corner: LeverBody,
        contact: DVec2,
        outward: DVec2,
        pivots: [DVec2; 2],
        facings: [DVec2; 2],
    ) -> Self {
        let [base, moving] = [0, 1];
        let (own, other) = if corner == LeverBody::Moving { (moving, base) } else { (base, moving) };
        let (corner_pivot, edge_pivot) = (pivots[own], pivots[other]);
        let lever = contact - corner_pivot;
        // Turns from the normal, to the vertical of its body, to that of the corner's body, to the lever; all point into the edge's body.
        let alpha = turn(-outward, -facings[other]);
        let beta = turn(facings[own], lever);
        let sense = if wrapped(alpha + beta) < 0.0 { -1.0 } else { 1.0 };
        let seen = contact - edge_pivot;
        Self {
            corner,
            corner_pivot,
            edge_pivot,
            contact,
            normal: outward,
            length: lever.length(),
            distance: seen.dot(outward),
            along: sense * outward.perp_dot(seen),
            beta_p: sense * beta,
            alpha_e: sense * alpha,
            theta_1: -sense * turn(DVec2::new(-sense, 0.0), outward),
            theta_2: sense * turn(-outward, lever),
            sense,
        }
    }
}

/// Result of the kinematic method for a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeverPose {
    /// Its settings.
    pub settings: KinematicSettings,
    /// The pose error.
    pub error: PoseError,
    /// z of the rotation point of the moving half at first contact, in D; `None` if the halves pass each
    /// other by.
    pub height: Option<f64>,
    /// The contact; `None` without contact, or if a corner meets a corner.
    pub lever: Option<Lever>,
    /// Its outcome by the bounds, or by the stepping.
    pub outcome: Outcome,
    /// How the stepping of an X-Face halts.
    pub halt: Option<Halt>,
}

impl LeverPose {
    /// Of a pose of a problem.
    ///
    /// # Errors
    /// A design or a pose that the method does not apply to.
    pub fn of(problem: &Problem, error: &PoseError) -> Result<Self, UnsuitableDesign> {
        let settings = KinematicSettings::of(problem.design())?;
        if error.y != 0.0 || error.roll != 0.0 || error.yaw != 0.0 {
            return Err(UnsuitableDesign::Pose);
        }
        let (pair, alignment) = (problem.pair(), problem.alignment());
        let cor = alignment.center_of_rotation;
        let pose = CorPose::from_error(error, cor, alignment.free);
        let mut envelope = pair.at_rotation(pose.rotation);
        let height = envelope.height(pose.lateral);
        let lever = height.and_then(|height| {
            let position = pose.lateral.extend(height);
            let mut contacts = Vec::new();
            envelope.contacts(position, COINCIDENT, &mut contacts);
            let facing = pose.rotation * DVec3::NEG_Z;
            let pivots = [DVec2::new(0.0, cor), flat(position)];
            let facings = [DVec2::Y, flat(facing)];
            let mut levers: Vec<Lever> = contacts
                .iter()
                .filter_map(|contact| {
                    let corner = corner_of(&pair.fixed, &pair.moving, &pose.rotation, position, contact)?;
                    let normal = flat(contact.normal);
                    let outward = if corner == LeverBody::Moving { normal } else { -normal };
                    Some(Lever::new(corner, flat(contact.point), outward, pivots, facings))
                })
                .collect();
            levers.sort_by(|a, b| {
                let key = |lever: &Lever| (lever.corner != LeverBody::Moving, lever.contact.x);
                key(a).0.cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1))
            });
            levers.first().copied()
        });
        let (x0, theta0) = (pose.lateral.x, -error.pitch);
        let halt = (settings.face == PlanarFace::XFace).then(|| {
            Faces::new(settings.aspect_ratio, settings.rotation_point).follow(x0, theta0, stepping::STEP)
        });
        let outcome = settings.starts().outcome(x0, theta0);
        Ok(Self { settings, error: *error, height, lever, outcome, halt })
    }
}

/// Whose corner touches an edge of the other; `None` for walls, and for corners on corners.
fn corner_of(
    fixed: &Half,
    moving: &Half,
    rotation: &DMat3,
    position: DVec3,
    contact: &Contact,
) -> Option<LeverBody> {
    if contact.normal.z <= PARALLEL || contact.normal.y.abs() > PARALLEL {
        return None;
    }
    let back = rotation.transpose();
    let seen = back * (contact.point - position);
    let edges = [
        fixed.surfaces.iter().any(|s| has_edge(s, contact.point, contact.normal)),
        moving.surfaces.iter().any(|s| has_edge(s, seen, back * -contact.normal)),
    ];
    match edges {
        [true, false] => Some(LeverBody::Moving),
        [false, true] => Some(LeverBody::Base),
        [false, false] => None,
        // Flush: the corner that ends the contact.
        [true, true] => {
            let at = |p: &DVec3| (p.x - seen.x).abs() <= COINCIDENT && (p.z - seen.z).abs() <= COINCIDENT;
            let ends_here = moving.surfaces.iter().flat_map(|s| &s.vertices).any(at);
            Some(if ends_here { LeverBody::Moving } else { LeverBody::Base })
        }
    }
}

/// Whether a point lies on a facet with this outward normal.
fn has_edge(surface: &Surface, point: DVec3, normal: DVec3) -> bool {
    surface.facets.iter().any(|facet| {
        let corners = || facet.corners.iter().map(|&k| surface.vertices[k as usize]);
        let between = |of: fn(&DVec3) -> f64| {
            let (lo, hi) = corners()
                .map(|p| of(&p))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
            (lo - COINCIDENT..=hi + COINCIDENT).contains(&of(&point))
        };
        facet.normal.dot(normal) > 1.0 - PARALLEL
            && corners().next().is_some_and(|p| normal.dot(point - p).abs() <= COINCIDENT)
            && between(|p| p.x)
            && between(|p| p.y)
            && between(|p| p.z)
    })
}

/// Its place in the x–z plane.
const fn flat(p: DVec3) -> DVec2 {
    DVec2::new(p.x, p.z)
}

/// Counter-clockwise angle from a direction to another, in (−π, π].
fn turn(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}

/// An angle in (−π, π].
fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    fn problem(family: Family, h: f64, r: f64) -> Problem {
        let alignment = Alignment { center_of_rotation: -r / 2.0, ..Alignment::default_for(Some(family)) };
        let connector = ConnectorSpec::Family(FamilySpec::new(family).with_aspect_ratio(h));
        Problem::of(Design { name: String::new(), connector, width: 1.0, unit: None, alignment }).unwrap()
    }

    fn pose(x: f64, pitch: f64) -> PoseError {
        PoseError { x, pitch, ..PoseError::default() }
    }

    fn family() -> impl Strategy<Value = Family> {
        prop::sample::select(vec![Family::VFace, Family::SFace, Family::XFace])
    }

    proptest! {
        /// The equations of the text that have no motion in them hold of every contact, and the angles add up.
        #[test]
        fn the_geometry_satisfies_the_texts_equations(
            family in family(), h in 0.1f64..3.0, r in 0.0f64..6.0, x in -0.9f64..0.9, pitch in -1.2f64..1.2,
        ) {
            let start = LeverPose::of(&problem(family, h, r), &pose(x, pitch)).unwrap();
            let Some(lever) = start.lever else { return Ok(()) };
            let Lever { length: l, distance: d, along: q1, theta_1, theta_2, .. } = lever;
            let apart = lever.corner_pivot - lever.edge_pivot;
            let lateral = d * theta_1.cos() + q1 * theta_1.sin() + l * (theta_1 - theta_2).cos();
            prop_assert!((lever.lateral().dot(apart) - lateral).abs() < 1e-9);
            prop_assert!((lever.normal.dot(apart) - (d + l * theta_2.cos())).abs() < 1e-9);
            // β_p + α_e exceeds θ₂ by the relative rotation of the halves.
            let corner_turns = if lever.corner == LeverBody::Moving { 1.0 } else { -1.0 };
            let lacks = wrapped(lever.aligned() - theta_2 - lever.sense * corner_turns * pitch);
            prop_assert!(lacks.abs() < 1e-9, "{lacks}: {lever:?}");
            prop_assert!(lever.aligned() >= 0.0);
            // The verticals are the axes of the bodies.
            let axis = DVec2::new(pitch.sin(), pitch.cos());
            let (base, moving) = (DVec2::Y, -axis);
            let [own, other] = if lever.corner == LeverBody::Moving { [moving, base] } else { [base, moving] };
            prop_assert!(lever.corner_vertical().distance(own) < 1e-9);
            prop_assert!(lever.edge_vertical().distance(other) < 1e-9);
        }

        /// Of an X-Face it is the contact that the stepping starts from.
        #[test]
        fn stepping_of_an_x_face_starts_at_the_same_contact(
            h in 0.1f64..3.0, r in 0.0f64..6.0, x in -0.9f64..0.9, pitch in -1.2f64..1.2,
        ) {
            let start = LeverPose::of(&problem(Family::XFace, h, r), &pose(x, pitch)).unwrap();
            let x0 = x + r / 2.0 * pitch.sin();
            let stepped = Faces::new(h, r).first(x0, -pitch);
            prop_assert_eq!(start.height.is_some(), stepped.is_some());
            if let (Some(height), Some((stepped_height, theta_2))) = (start.height, stepped) {
                prop_assert!((height + r / 2.0 - stepped_height).abs() < 1e-9);
                if let Some(lever) = start.lever {
                    prop_assert!((lever.theta_2 - theta_2).abs() < 1e-6, "{lever:?} {theta_2}");
                }
            }
        }
    }

    /// Offset without rotation, the tip slides on a flank: θ₂ = `β_p + α_e`, of the V 0 and atan(2H/D).
    #[test]
    fn aligned_faces_meet_the_alignment_condition() {
        for (x, h, r) in [(0.2, 0.5, 2.0), (-0.3, 1.0, 4.0)] {
            let start = LeverPose::of(&problem(Family::VFace, h, r), &pose(x, 0.0)).unwrap();
            let lever = start.lever.unwrap();
            assert_eq!((lever.corner, start.outcome), (LeverBody::Moving, Outcome::Aligned));
            assert!((lever.theta_2 - lever.aligned()).abs() < 1e-12);
            assert!(lever.beta_p.abs() < 1e-12 && (lever.alpha_e - f64::atan(2.0 * h)).abs() < 1e-12);
            assert!((lever.length - f64::midpoint(r, h)).abs() < 1e-12);
        }
        // The X-Face's tip on the opposite ramp.
        let start = LeverPose::of(&problem(Family::XFace, 0.5, 2.0), &pose(0.4, 0.0)).unwrap();
        let aligned = f64::atan(1.0 / 2.5) + f64::atan(0.5);
        assert!((start.lever.unwrap().aligned() - aligned).abs() < 1e-12, "{start:?}");
        assert_eq!(start.halt, Some(Halt::Success));
    }

    #[test]
    fn poses_with_yaw_are_refused() {
        let v = problem(Family::VFace, 0.5, 1.0);
        assert_eq!(LeverPose::of(&v, &PoseError { yaw: 0.1, ..pose(0.0, 0.0) }), Err(UnsuitableDesign::Pose));
        let missed = LeverPose::of(&v, &pose(3.0, 0.1)).unwrap();
        assert_eq!((missed.height, missed.lever, missed.outcome), (None, None, Outcome::Missed));
        let wide = LeverPose::of(&problem(Family::XFace, 0.5, 1.0), &pose(0.0, FRAC_PI_2)).unwrap();
        assert!(wide.outcome != Outcome::Aligned);
    }
}
