//! The moving half at all poses of a box simultaneously.
//!
//! ```text
//!   lateral(v) = (x, y) + (R v)_xy     v seen from the face centre, which the error moves
//!   turned(v)  = R v                   v seen from the centre of rotation, whose z is the height
//! ```
//!
//! A locked translation stays 0 at the centre of rotation: in that direction v is relative to the centre of
//! rotation. Measuring v from the point that the error moves avoids counting a rotation twice.

use super::body::{Body, Meeting, meetings};
use super::interval::{Interval, Vector, dot, thin};
use crate::contact::Pair;
use crate::pose::{Dof, DofSet, PoseError, ROTATIONS};
use glam::DVec3;

/// All poses whose errors lie in five intervals, in the order of [`Dof::ALL`]: D and radians.
pub(super) type PoseBox = [Interval; 5];

/// The pose in the middle of a box.
pub(super) fn middle(poses: &PoseBox) -> PoseError {
    PoseError::from_array(poses.map(Interval::middle))
}

/// The two halves, with the parts of the alignment problem that determine bounds.
#[derive(Debug, Clone)]
pub(super) struct Bodies {
    pub(super) fixed: Body,
    pub(super) moving: Body,
    pub(super) free: DofSet,
    pub(super) cor: f64,
    pub(super) rho: f64,
    /// All that may meet at all.
    pub(super) meetings: Vec<Meeting>,
    /// Whether sliding under features is impossible: both halves are columns over a flat back, and neither
    /// tilts. A half that meets a wall then stays on h.
    pub(super) upright: bool,
}

impl Bodies {
    pub(super) fn of(pair: &Pair) -> Self {
        let (fixed, moving) = (Body::of(&pair.fixed), Body::of(&pair.moving));
        let alignment = &pair.alignment;
        let planar = alignment.free.iter().all(|dof| matches!(dof, Dof::X | Dof::Pitch));
        let meetings = meetings(&fixed, &moving, planar);
        let (cor, rho) = (alignment.center_of_rotation, alignment.rotation_length);
        let tilts = [Dof::Roll, Dof::Pitch].into_iter().any(|dof| alignment.free.contains(dof));
        let upright = !tilts && fixed.is_over_flat_back(-1.0) && moving.is_over_flat_back(1.0);
        Self { fixed, moving, free: alignment.free, cor, rho, meetings, upright }
    }

    /// Whether x (0) or y (1) of the face centre is free, instead of 0 at the centre of rotation.
    pub(super) fn slides(&self, axis: usize) -> bool {
        self.free.contains([Dof::X, Dof::Y][axis])
    }
}

/// The moving half over a box of poses.
#[derive(Debug, Clone)]
pub(super) struct Placed {
    pub(super) rows: [Vector; 3],
    /// World axes about which roll, pitch and yaw turn.
    pub(super) axes: [Vector; 3],
    /// The face centre seen from the centre of rotation.
    pub(super) face: Vector,
    pub(super) offset: [Interval; 2],
    /// For every vertex: its position in plan view, and its position relative to the centre of rotation.
    pub(super) lateral: Vec<[Interval; 2]>,
    pub(super) turned: Vec<Vector>,
}

impl Placed {
    pub(super) fn new(bodies: &Bodies, poses: &PoseBox) -> Self {
        let [[sr, cr], [sp, cp], [sy, cy]] = [2, 3, 4].map(|k: usize| poses[k].sin_cos());
        // Rz(yaw)·Ry(pitch)·Rx(roll), by rows.
        let rows = [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ];
        let one = Interval::thin(1.0);
        let axes =
            [[cy * cp, sy * cp, -sp], [-sy, cy, Interval::ZERO], [Interval::ZERO, Interval::ZERO, one]];
        let face = rows.map(|row| row[2] * bodies.cor);
        let slides = [0, 1].map(|axis| bodies.slides(axis));
        let offset = [0, 1].map(|axis| if slides[axis] { poses[axis] } else { Interval::ZERO });
        let turn = |v: DVec3| rows.map(|row| dot(&row, &thin(v)));
        let from_face = DVec3::new(0.0, 0.0, bodies.cor);
        let vertices = &bodies.moving.vertices;
        let lateral = vertices.iter().map(|v| {
            // Exact if the centre of rotation is the face centre.
            [0, 1].map(|axis| {
                let arm = if slides[axis] { *v - from_face } else { *v };
                // A vertex given from the centre of rotation was rounded once.
                (offset[axis] + dot(&rows[axis], &thin(arm))).widened(ROUNDING)
            })
        });
        let lateral = lateral.collect();
        let turned = vertices.iter().map(|v| turn(*v)).collect();
        Self { rows, axes, face, offset, lateral, turned }
    }

    /// A direction of the moving half in the world.
    pub(super) fn turn(&self, v: DVec3) -> Vector {
        self.rows.map(|row| dot(&row, &thin(v)))
    }

    /// From the centre of rotation to a point of the world at this height over it, in plan view and above.
    pub(super) fn arm_to(&self, bodies: &Bodies, point: Vector, height: Interval) -> Vector {
        let lateral = [0, 1].map(|axis| {
            let cor = if bodies.slides(axis) { self.offset[axis] - self.face[axis] } else { Interval::ZERO };
            point[axis] - cor
        });
        [lateral[0], lateral[1], point[2] - height]
    }

    /// Rates of roll, pitch and yaw for a rotation of the half by `spin`, about world axes.
    pub(super) fn angle_rates(&self, spin: &Vector) -> [Interval; 3] {
        let [_, [minus_sine, cosine, _], _] = self.axes;
        let sine = -minus_sine;
        let pitch = dot(spin, &self.axes[1]);
        let level = spin[0] * cosine + spin[1] * sine;
        // cos(pitch), of the axis of roll in plan view.
        let slant = self.axes[0][0] * cosine + self.axes[0][1] * sine;
        let roll = level.over(slant).unwrap_or(Interval::EVERYTHING);
        [roll, pitch, spin[2] - roll * self.axes[0][2]]
    }

    /// Change of the gap of a contact per unit of each error, at constant height of the centre of rotation:
    /// `normal` at `arm` from it.
    ///
    /// ```text
    ///   a_x = n_x     a_y = n_y     a_k = axis_k·(arm × n) − (n_x, n_y)·(axis_k × face)
    /// ```
    pub(super) fn gap_rates(&self, bodies: &Bodies, normal: &Vector, torque: &Vector) -> PoseBox {
        let mut rates = [Interval::ZERO; 5];
        for axis in 0..2 {
            if bodies.slides(axis) {
                rates[axis] = normal[axis];
            }
        }
        for (k, dof) in ROTATIONS.into_iter().enumerate() {
            if bodies.free.contains(dof) {
                let swing = super::interval::cross(&self.axes[k], &self.face);
                let swung = (0..2).filter(|axis| bodies.slides(*axis)).map(|axis| normal[axis] * swing[axis]);
                let swung = swung.fold(Interval::ZERO, |sum, part| sum + part);
                rates[dof.index()] = dot(&self.axes[k], torque) - swung;
            }
        }
        rates
    }
}

/// Rounding of vertex coordinates, in D.
pub(super) const ROUNDING: f64 = 1e-14;
