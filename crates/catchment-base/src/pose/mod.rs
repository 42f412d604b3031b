//! Frames, axes, units and signs: the only place that defines these conventions.
//!
//! ```text
//!            moving half, mounted face down
//!            ┌───────────┐   ─┬─ back
//!            │     ┬     │    │
//!            └──╲  │  ╱──┘    │          z  approach axis, up
//!                ╲ ▼ ╱        ●─ face centre (mid height of the face)
//!                             │
//!                             ○─ centre of rotation, `cor`·D in front of the face centre
//!            ┌──╲  ▲  ╱──┐    │
//!            │   ╲ │ ╱   │   ─┴─ origin of the world: the fixed face centre
//!            └───────────┘
//! ```
//!
//! - Lengths are in units of the connector's width D, angles in radians.
//! - The world frame is the fixed half's: origin at its face centre, +z against the approach, towards the
//!   moving half. Aligned means: face centres coincide and the rotation is the identity.
//! - The moving half is drawn facing +z like the fixed half and *mounted* by a half turn ([`Mount`]).
//! - A rotation is `R = Rz(yaw) · Ry(pitch) · Rx(roll)`.
//! - The *centre of rotation* (COR) is the body point through which the approach force acts. In the mounted
//!   body's frame the face centre is at `(0, 0, +cor)` from it: positive `cor` puts the COR in front.

mod dof;
mod frame;
mod metric;

pub use dof::{Dof, DofSet, ErrorUnit, UnknownDof};
pub use frame::{CorPose, Mount, PoseError, euler_angles, face_from_cor, rotation, rotation_angle};
pub use metric::{ROTATIONS, angle_between, descent_map, euler_axes, euler_rates, step_length};
