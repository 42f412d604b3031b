//! Exact quasi-static motion of one pose: frictionless, overdamped, contact kept.

mod trajectory;

pub use trajectory::{Touch, Trajectory, Waypoint};
