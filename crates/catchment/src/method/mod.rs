//! Ways to decide what becomes of a pose error. Every one has the same door, `Settings` + input + `&Exec`,
//! and returns an [`crate::acceptance::Acceptance`].

pub mod descent;
pub mod flood;
pub mod kinematic;
pub mod zraa;
