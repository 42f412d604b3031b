//! The alignment problem: every input besides the geometry that changes the result.

use super::Family;
use super::defect::DesignDefect;
use super::docked::Docked;
use super::family::Freedom;
use catchment_base::pose::{Dof, DofSet, Mount, PoseError, rotation_angle};
use glam::DMat3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The alignment problem of a pair of halves. Stored with every result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Alignment {
    /// Errors that occur and that contact may correct. The others are locked: rotations at 0, translations at
    /// the COR.
    pub free: DofSet,
    /// Rotations that do not count in the outcome (yaw of a round plug); they are locked during motion.
    pub dont_care: DofSet,
    /// Signed distance of the COR in front of the face centre, in D.
    pub center_of_rotation: f64,
    /// Characteristic length ρ: overdamped motion dissipates `|v|² + (ρD)²·|ω|²`, v at the COR. In D.
    pub rotation_length: f64,
    /// The half turn that mounts the moving half.
    pub mount: Mount,
    /// n-fold symmetry about the approach axis: a pair rotated by a multiple of 2π/n also counts as docked.
    pub symmetry: u32,
    /// Half-ranges of the error box in the order of [`Dof::ALL`]: D and radians. Only those of free errors
    /// count.
    pub half_ranges: [f64; 5],
    /// Docking tolerance.
    #[serde(default)]
    pub docked: Docked,
}

impl Alignment {
    /// ±1 D and ±90°.
    pub const DEFAULT_HALF_RANGES: [f64; 5] = [1.0, 1.0, FRAC_PI_2, FRAC_PI_2, FRAC_PI_2];
    /// Default ρ, in D.
    pub const DEFAULT_ROTATION_LENGTH: f64 = 0.5;

    /// All defaults, for the given free degrees of freedom and mount.
    pub const fn new(free: DofSet, mount: Mount) -> Self {
        Self {
            free,
            dont_care: DofSet::EMPTY,
            center_of_rotation: 0.0,
            rotation_length: Self::DEFAULT_ROTATION_LENGTH,
            mount,
            symmetry: 1,
            half_ranges: Self::DEFAULT_HALF_RANGES,
            docked: Docked { depth: Docked::DEFAULT_DEPTH, limits: [None; 5] },
        }
    }

    /// The defaults of a family (`None`: of own halves). Planar families move in x and pitch and are mounted
    /// about y; all others move in all five and are mounted about x. The yaw of a cone does not matter.
    pub fn default_for(family: Option<Family>) -> Self {
        match family.map(Family::freedom) {
            Some(Freedom::Planar) => Self::new(DofSet::EMPTY.with(Dof::X).with(Dof::Pitch), Mount::Y),
            Some(Freedom::Round) => Self {
                dont_care: DofSet::EMPTY.with(Dof::Yaw),
                ..Self::new(DofSet::ALL.without(Dof::Yaw), Mount::X)
            },
            Some(Freedom::Spatial) | None => Self::new(DofSet::ALL, Mount::X),
        }
    }

    /// The error for Euler angles that reach rotations twice, if they do.
    pub(super) fn beyond_the_pole(&self) -> Option<DesignDefect> {
        // "90 deg" may round to one unit in the last place above π/2.
        let beyond = self.half_ranges[Dof::Pitch.index()] > FRAC_PI_2 * (1.0 + 4.0 * f64::EPSILON);
        (self.free.rotations() == 3 && beyond).then_some(DesignDefect::PitchBeyondPole)
    }

    /// The yaw nearest to `yaw` at which the pair is aligned: a multiple of 2π/n for an n-fold symmetry, and
    /// the yaw itself if it is a don't-care rotation. In radians.
    #[inline]
    pub fn nearest_yaw(&self, yaw: f64) -> f64 {
        if self.dont_care.contains(Dof::Yaw) {
            return yaw;
        }
        let turn = TAU / f64::from(self.symmetry.max(1));
        (yaw / turn).round() * turn
    }

    /// The length of a small error in the ρ-metric, in D.
    #[inline]
    pub fn length(&self, error: &PoseError) -> f64 {
        let PoseError { x, y, roll, pitch, yaw } = *error;
        x.hypot(y).hypot(self.rotation_length * roll.hypot(pitch).hypot(yaw))
    }

    /// Angle between a rotation and the nearest rotation that counts as aligned, in radians: the mated
    /// rotation and those of the symmetry; a don't-care yaw is ignored.
    #[inline]
    pub fn turned_by(&self, rotation: &DMat3) -> f64 {
        if self.dont_care.contains(Dof::Yaw) {
            let tilt = rotation.z_axis;
            return tilt.truncate().length().atan2(tilt.z);
        }
        (0..self.symmetry.max(1))
            .map(|k| {
                let turn = DMat3::from_rotation_z(-TAU * f64::from(k) / f64::from(self.symmetry));
                rotation_angle(&(*rotation * turn))
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// Half-range of a degree of freedom: 0 if it is not free.
    #[inline]
    pub const fn half_range(&self, dof: Dof) -> f64 {
        if self.free.contains(dof) { self.half_ranges[dof.index()] } else { 0.0 }
    }

    /// The measure of the error box, in powers of D and radians.
    pub fn error_box_measure(&self) -> f64 {
        self.free.iter().map(|dof| 2.0 * self.half_range(dof)).product()
    }
}
