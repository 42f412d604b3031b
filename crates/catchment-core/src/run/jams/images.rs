//! Symmetric images of poses, by the symmetries of each half.
//!
//! If the fixed half is invariant under a rotation or reflection A about the approach axis, and the moving
//! half under B, then the pose (v, R) of the COR has the image (A v, A R B⁻¹), if both are rotations or both
//! are reflections. Locked errors must keep their values.

use crate::connector::HalfRole;
use crate::contact::Features;
use crate::design::Alignment;
use crate::pose::{CorPose, Dof, DofSet, PoseError, ROTATIONS, angle_between, euler_axes, step_length};
use crate::tolerance::SINGLE;
use glam::{DMat3, DQuat, DVec2, DVec3};
use std::f64::consts::TAU;

/// Largest number of pairs of symmetries that are tested: those of two round halves.
const MOST: usize = 600;

/// A pose within this distance of a mated pose is docked, in D: motions end closer.
const DOCKED: f64 = 0.01;

/// The largest number that divides both.
const fn common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// The symmetries of a pair.
pub(in crate::run) struct Images {
    pairs: Vec<[DMat3; 2]>,
    free: DofSet,
    rho: f64,
}

impl Images {
    pub(in crate::run) fn of(features: &Features, alignment: &Alignment) -> Self {
        let [fixed, moving] = [HalfRole::Fixed, HalfRole::Moving].map(|side| &features.turns(side).0);
        let like = |a: &DMat3, b: &DMat3| (a.determinant() > 0.0) == (b.determinant() > 0.0);
        let pairs =
            fixed.iter().flat_map(|a| moving.iter().filter(move |b| like(a, b)).map(move |b| [*a, *b]));
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

    /// Whether the locked errors are unchanged. Tested by the axes of the half and not by angles, which are
    /// undefined at a pitch of 90°.
    fn keeps_locks(&self, pose: &CorPose) -> bool {
        let DVec2 { x, y } = pose.lateral;
        let DMat3 { x_axis, y_axis, z_axis } = pose.rotation;
        let is = |dof: Dof| self.free.contains(dof);
        let off = match (is(Dof::Roll), is(Dof::Pitch), is(Dof::Yaw)) {
            (true, true, true) => 0.0,
            (false, false, false) => (x_axis - DVec3::X).length().max((y_axis - DVec3::Y).length()),
            (true, false, false) => (x_axis - DVec3::X).length(),
            (false, true, false) => (y_axis - DVec3::Y).length(),
            (false, false, true) => (z_axis - DVec3::Z).length(),
            // R = Ry·Rx has no y in its x-axis, Rz·Rx no z; Rz·Ry no z in its y-axis.
            (true, true, false) => x_axis.y.abs(),
            (true, false, true) => x_axis.z.abs(),
            (false, true, true) => y_axis.z.abs(),
        };
        off < SINGLE && (is(Dof::X) || x.abs() < SINGLE) && (is(Dof::Y) || y.abs() < SINGLE)
    }

    /// Distance of two poses in the metric of the motion, in D.
    pub(in crate::run) fn distance(&self, a: &CorPose, b: &CorPose) -> f64 {
        step_length(a.lateral - b.lateral, angle_between(&a.rotation, &b.rotation), self.rho)
    }

    /// The image of `pose` that is nearest to `to`, and how near that is.
    pub(in crate::run) fn nearest(&self, pose: &CorPose, to: &CorPose) -> (CorPose, f64) {
        let mut best = (*pose, self.distance(pose, to));
        for image in self.each(pose) {
            let distance = self.distance(&image, to);
            if distance < best.1 {
                best = (image, distance);
            }
        }
        best
    }

    /// The order n of the rotations about the approach axis that map the mated pose to its images, if this
    /// pose, at this height above the mated pose, is one of them: it would dock if the design had n-fold
    /// symmetry.
    pub(in crate::run) fn symmetry(&self, pose: &CorPose, above: f64) -> Option<u32> {
        /// Number of parts of a full turn, 15° each: rotations are multiples of a part.
        const PARTS: u32 = 24;
        let mated = CorPose { lateral: DVec2::ZERO, rotation: DMat3::IDENTITY };
        let is_near = |other: &CorPose| self.distance(other, pose) <= DOCKED;
        if above.abs() > DOCKED || is_near(&mated) || !self.each(&mated).any(|image| is_near(&image)) {
            return None;
        }
        let parts = self.each(&mated).map(|image| {
            let angle = image.rotation.x_axis.y.atan2(image.rotation.x_axis.x).rem_euclid(TAU);
            (angle / TAU * f64::from(PARTS)).round() as u32 % PARTS
        });
        Some(PARTS / parts.fold(PARTS, common_divisor))
    }

    /// Difference of a pose from another, whose error is given: lateral offset of the COR, and the rotations
    /// of the Euler angles that lead there to first order, about their own axes; in D and radians. Exact for
    /// a single rotation.
    pub(in crate::run) fn off(&self, pose: &CorPose, from: &CorPose, error: &PoseError) -> [f64; 5] {
        let lateral = pose.lateral - from.lateral;
        let turn = DQuat::from_mat3(&(pose.rotation * from.rotation.transpose())).to_scaled_axis();
        let axes = euler_axes(error.pitch, error.yaw);
        let mut off = [lateral.x, lateral.y, 0.0, 0.0, 0.0];
        for (k, (dof, axis)) in ROTATIONS.into_iter().zip(axes).enumerate() {
            off[2 + k] = if self.free.contains(dof) { turn.dot(axis) } else { 0.0 };
        }
        off
    }

    /// The characteristic length, in D.
    pub(in crate::run) const fn rho(&self) -> f64 {
        self.rho
    }

    /// Whether an image of `pose` may be this close to `to`: compares the invariants of the symmetries.
    pub(in crate::run) fn may_be_near(&self, pose: &CorPose, to: &CorPose, near: f64) -> bool {
        let tilt = |pose: &CorPose| pose.rotation.z_axis.z.clamp(-1.0, 1.0).acos();
        (pose.lateral.length() - to.lateral.length()).abs() <= near
            && (tilt(pose) - tilt(to)).abs() * self.rho <= near
    }
}
