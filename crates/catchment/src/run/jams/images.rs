//! Poses that are images of each other: the halves' own symmetries, each by itself.
//!
//! A fixed half that is itself after a turn or reflection A about the approach axis, and a moving one that is itself after B, make
//! a pose (v, R) of the COR the image of (A v, A R B⁻¹), if both are turns or both are reflections. What is locked must stay where it is.

use crate::connector::Side;
use crate::contact::Features;
use crate::design::Alignment;
use crate::pose::{CorPose, Dof, DofSet, angle_between, euler_angles, step_length};
use glam::{DMat3, DVec2};

/// What is locked may move by less than this, in D or radians: rounding.
const LOCKED: f64 = 1e-6;
/// Pairs of symmetries that are looked at, at most: those of two rounds.
const MOST: usize = 600;

/// The symmetries of a pair.
pub(super) struct Images {
    pairs: Vec<[DMat3; 2]>,
    free: DofSet,
    rho: f64,
}

impl Images {
    pub(super) fn of(features: &Features, alignment: &Alignment) -> Self {
        let [fixed, moving] = [Side::Fixed, Side::Moving].map(|side| &features.turns(side).0);
        let like = |a: &DMat3, b: &DMat3| (a.determinant() > 0.0) == (b.determinant() > 0.0);
        let pairs = fixed.iter().flat_map(|a| moving.iter().filter(move |b| like(a, b)).map(move |b| [*a, *b]));
        Self { pairs: pairs.take(MOST).collect(), free: alignment.free, rho: alignment.rotation_length }
    }

    /// The images of a pose, itself first.
    fn each<'a>(&'a self, pose: &'a CorPose) -> impl Iterator<Item = CorPose> + 'a {
        let image = |[a, b]: &[DMat3; 2]| {
            let lateral = (*a * pose.lateral.extend(0.0)).truncate();
            CorPose { lateral, rotation: *a * pose.rotation * b.transpose() }
        };
        self.pairs.iter().map(image).filter(|image| self.keeps_locks(image))
    }

    fn keeps_locks(&self, pose: &CorPose) -> bool {
        let DVec2 { x, y } = pose.lateral;
        let (roll, pitch, yaw) = euler_angles(&pose.rotation);
        Dof::ALL.into_iter().zip([x, y, roll, pitch, yaw]).all(|(dof, value)| {
            self.free.contains(dof) || value.abs() < LOCKED
        })
    }

    /// Distance of two poses in the metric of the motion, in D.
    pub(super) fn distance(&self, a: &CorPose, b: &CorPose) -> f64 {
        step_length(a.lateral - b.lateral, angle_between(&a.rotation, &b.rotation), self.rho)
    }

    /// The image of `pose` that is nearest to `to`, and how near that is.
    pub(super) fn nearest(&self, pose: &CorPose, to: &CorPose) -> (CorPose, f64) {
        let mut best = (*pose, self.distance(pose, to));
        for image in self.each(pose) {
            let distance = self.distance(&image, to);
            if distance < best.1 {
                best = (image, distance);
            }
        }
        best
    }

    /// The rotation length, in D.
    pub(super) const fn rho(&self) -> f64 {
        self.rho
    }

    /// Whether an image of `pose` may be as near to `to` as this: what no symmetry changes is compared.
    pub(super) fn may_be_near(&self, pose: &CorPose, to: &CorPose, near: f64) -> bool {
        let tilt = |pose: &CorPose| pose.rotation.z_axis.z.clamp(-1.0, 1.0).acos();
        (pose.lateral.length() - to.lateral.length()).abs() <= near
            && (tilt(pose) - tilt(to)).abs() * self.rho <= near
    }

}
