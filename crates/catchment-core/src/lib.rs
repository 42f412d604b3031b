//! From the two halves to the area of acceptance: the modules that compute. Programs use the crate
//! `catchment`.
//!
//! ```text
//! design ─▶ xml ─▶ poses ─▶ connector ─▶ contact ─▶ problem ─▶ landscape ─▶ acceptance ─▶ method ─▶ merit ─▶ run
//! ```
//!
//! The modules before `contact` are crates of their own, which change and compile apart. Lengths are in D, the
//! connector's width; angles are in radians. `tests/sealed.rs` lists the modules that use time, threads, memory,
//! files or a process of the system, with the reasons.

pub mod acceptance;
pub mod contact;
pub mod document;
pub mod landscape;
pub mod merit;
pub mod method;
pub mod problem;
pub mod run;

pub use catchment_base::{
    budget, diagnostic, disjoint, exec, polygon, polytope, pose, suggest, terminal, tolerance,
};
pub use catchment_connector as connector;
pub use catchment_design::{design, poses, xml};
