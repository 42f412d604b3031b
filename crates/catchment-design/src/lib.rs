//! What a person writes: design files and pose errors, read and checked. Programs use the crate `catchment`.
//!
//! Lengths are in D, the connector's width; angles are in radians.

pub mod design;
pub mod poses;
pub mod xml;
