//! The plane along the approach axis in which halves are cut: where they touch.
//!
//! ```text
//!   seen from above        ↑ normals of the contacts      the plane holds the main direction of their horizontal parts,
//!        ●─────────●──── u                                or where they carry straight up the way from where the half should touch;
//!                                                         it passes through as many contacts as it can
//! ```

use crate::connector::Connector;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

/// Where halves are cut: one plane, or one through each of two layers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plane {
    /// Angle from x to the direction along the plane, in (−π/2, π/2].
    pub(super) azimuth: f64,
    /// How far beside the axis, from far to near, in D.
    pub(super) offsets: Vec<f64>,
    /// Whether it was laid through contacts.
    pub(super) through_contacts: bool,
}

/// Two halves that touch along a face, an edge or at a point.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    /// Where.
    pub(super) points: Vec<DVec3>,
    /// The normal there.
    pub(super) normal: DVec3,
    /// How far the moving half's first place is from where it is docked, in plan view.
    pub(super) off: DVec2,
}

impl Patch {
    /// Of a moving half with this rotation and face centre.
    pub(super) fn new(points: Vec<DVec3>, normal: DVec3, (rotation, face): (DMat3, DVec3)) -> Self {
        let docked = |point: &DVec3| rotation.transpose() * (*point - face);
        let off = points.first().map_or(DVec2::ZERO, |point| (*point - docked(point)).truncate());
        Self { points, normal, off }
    }
}

/// Nearer than this is in the plane, in D.
const IN_PLANE: f64 = 2e-3;
/// Horizontal parts below this say no direction.
const UPRIGHT: f64 = 0.02;
/// An angle that is none, radians.
const NO_ANGLE: f64 = 1e-3;

impl Plane {
    /// The plane y = 0, or one through each layer.
    pub(super) fn across(connector: &Connector) -> Self {
        Self { azimuth: 0.0, offsets: super::section::cuts(connector), through_contacts: false }
    }

    /// The plane in which most of what touches lies; the usual one where that will do.
    pub(super) fn through(connector: &Connector, patches: &[Patch]) -> Self {
        let usual = Self::across(connector);
        let Some(azimuth) = direction(patches) else { return usual };
        let across = DVec2::from_angle(azimuth).perp();
        let reach = |patch: &Patch| {
            let offsets = patch.points.iter().map(|point| point.truncate().dot(across));
            offsets.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
        };
        let holds = |offset: f64, patch: &Patch| {
            let (lo, hi) = reach(patch);
            (lo - IN_PLANE..=hi + IN_PLANE).contains(&offset)
        };
        let counts = |offset: f64| patches.iter().filter(|patch| holds(offset, patch)).count();
        let is_usual = azimuth.abs() < NO_ANGLE;
        let all = patches.iter().all(|patch| usual.offsets.iter().any(|offset| holds(*offset, patch)));
        if is_usual && (all || usual.offsets.len() > 1) {
            return usual;
        }
        let middle = |patch: &Patch| {
            let (lo, hi) = reach(patch);
            f64::midpoint(lo, hi)
        };
        let best = patches.iter().map(middle).chain(is_usual.then_some(0.0)).max_by(|a, b| {
            // Of as many the one that is nearer to the axis.
            counts(*a).cmp(&counts(*b)).then(b.abs().total_cmp(&a.abs()))
        });
        let Some(offset) = best else { return usual };
        Self { azimuth: if is_usual { 0.0 } else { azimuth }, offsets: vec![offset], through_contacts: true }
    }

    /// Turns the world so that the plane is one of constant y.
    pub(super) fn turn(&self) -> DMat3 {
        if self.azimuth == 0.0 { DMat3::IDENTITY } else { DMat3::from_rotation_z(-self.azimuth) }
    }

    /// How far a point is beside the plane, in D.
    pub(super) fn beside(&self, point: DVec3) -> f64 {
        let y = (self.turn() * point).y;
        self.offsets.iter().map(|offset| (y - offset).abs()).fold(f64::INFINITY, f64::min)
    }

    /// What its direction is called on an axis: `x`, or `along 30°` from x.
    pub(super) fn name(&self) -> String {
        if self.azimuth == 0.0 {
            return "x".to_owned();
        }
        if (self.azimuth.abs() - PI / 2.0).abs() < NO_ANGLE {
            return "y".to_owned();
        }
        format!("along {:.0}° from x", self.azimuth.to_degrees()).replace('-', "−")
    }
}

/// The angle from x of the main horizontal direction of the normals, or else of the ways home, or of the contacts; none where nothing touches.
fn direction(patches: &[Patch]) -> Option<f64> {
    let normals = patches.iter().map(|patch| patch.normal.truncate());
    let upright = normals.clone().all(|normal| normal.length() < UPRIGHT);
    let points = || patches.iter().flat_map(|patch| patch.points.iter().map(|point| point.truncate()));
    let count = points().count();
    if count == 0 {
        return None;
    }
    let mean = points().sum::<DVec2>() / count as f64;
    let ways: Vec<DVec2> = if !upright {
        normals.collect()
    } else if patches.iter().any(|patch| patch.off.length() > IN_PLANE) {
        patches.iter().map(|patch| patch.off).collect()
    } else if points().any(|point| point.distance(mean) > IN_PLANE) {
        points().map(|point| point - mean).collect()
    } else {
        vec![mean]
    };
    // Twice the angle of the main axis of the second moments.
    let (xx, xy) =
        ways.iter().fold((0.0, 0.0), |(xx, xy), v| (xx + v.x * v.x - v.y * v.y, xy + 2.0 * v.x * v.y));
    if xx.hypot(xy) < IN_PLANE * IN_PLANE {
        return Some(0.0);
    }
    let angle = 0.5 * xy.atan2(xx);
    Some(if angle <= -PI / 2.0 + NO_ANGLE { angle + PI } else { angle })
}

#[cfg(test)]
mod tests {
    use super::super::testing::{pyramid, v_face, x_face};
    use super::*;

    fn patch(points: &[[f64; 3]], normal: [f64; 3]) -> Patch {
        let points = points.iter().copied().map(DVec3::from_array).collect();
        Patch::new(points, DVec3::from_array(normal), (DMat3::IDENTITY, DVec3::ZERO))
    }

    #[test]
    fn it_passes_through_what_touches() {
        let contacts =
            [patch(&[[0.3, 0.1, 0.0]], [-0.7, 0.0, 0.7]), patch(&[[-0.2, 0.1, 0.0]], [0.7, 0.0, 0.7])];
        let plane = Plane::through(&pyramid(), &contacts);
        assert_eq!((plane.azimuth, plane.offsets.as_slice()), (0.0, &[0.1][..]));
        assert!(contacts.iter().all(|contact| plane.beside(contact.points[0]) < 1e-12));
        // The same turned by 50°: what was y = 0.1 is as far beside the axis.
        let by = DMat3::from_rotation_z(50f64.to_radians());
        let turned: Vec<Patch> = contacts
            .iter()
            .map(|c| {
                let points = c.points.iter().map(|p| by * *p).collect();
                Patch::new(points, by * c.normal, (DMat3::IDENTITY, DVec3::ZERO))
            })
            .collect();
        let plane = Plane::through(&pyramid(), &turned);
        assert!((plane.azimuth - 50f64.to_radians()).abs() < 1e-9 && (plane.offsets[0] - 0.1).abs() < 1e-9);
        assert_eq!(plane.name(), "along 50° from x");
    }

    /// What stands beside its hole is cut the way that it is off, turned or not.
    #[test]
    fn what_carries_straight_up_is_cut_towards_where_it_should_be() {
        let beside = |turn: DMat3, off: DVec3| {
            let points = [DVec3::new(0.3, 0.1, 0.0), DVec3::new(0.3, 0.11, 0.0)].map(|p| turn * p + off);
            Patch::new(points.to_vec(), DVec3::Z, (turn, off))
        };
        let plane = Plane::through(&pyramid(), &[beside(DMat3::IDENTITY, DVec3::new(0.1, -0.1, 0.2))]);
        assert_eq!(plane.name(), "along −45° from x");
        // Turned about the axis by a little: what is at x = 0.3 is off along y.
        let plane = Plane::through(&pyramid(), &[beside(DMat3::from_rotation_z(0.02), DVec3::ZERO)]);
        assert!((plane.azimuth.to_degrees() + 71.0).abs() < 2.0, "{plane:?}");
    }

    #[test]
    fn what_the_usual_cut_shows_is_cut_there() {
        // A tip drawn along y touches along its edge: y = 0 will do; and so will the layers.
        let edge = [patch(&[[0.3, -0.25, 0.0], [0.3, 0.25, 0.0]], [-0.7, 0.0, 0.7])];
        assert_eq!(Plane::through(&v_face(), &edge), Plane::across(&v_face()));
        assert_eq!(Plane::through(&x_face(), &edge), Plane::across(&x_face()));
        assert_eq!(Plane::through(&v_face(), &[]), Plane::across(&v_face()));
    }
}
