//! How much misalignment does a docking connector forgive?
//!
//! `catchment` takes the geometry of the two halves of a connector and computes which pose errors
//! (x, y, roll, pitch, yaw) their contact passively corrects: the *area of acceptance*, the catchment
//! basin of the mated pose in configuration space.
//!
//! Data walks through the rooms in one direction; imports run against it:
//!
//! ```text
//! design ─▶ connector ─▶ contact ─▶ landscape ─▶ acceptance ─▶ method ─▶ merit ─▶ study ─▶ report
//! ```

pub mod acceptance;
pub mod connector;
pub mod contact;
pub mod design;
pub mod exec;
pub mod landscape;
pub mod merit;
pub mod method;
pub mod pose;
pub mod report;
pub mod study;
