//! From a design file to its area of acceptance: the modules that compute. Programs use the crate
//! `catchment`.
//!
//! ```text
//! design ─▶ xml ─▶ poses ─▶ connector ─▶ contact ─▶ problem ─▶ landscape ─▶ acceptance ─▶ method ─▶ merit ─▶ run
//! ```
//!
//! Lengths are in D, the connector's width; angles are in radians. `tests/sealed.rs` lists the modules that
//! use time, threads, memory, files or a process of the system, with the reasons.

pub mod acceptance;
pub mod budget;
pub mod connector;
pub mod contact;
pub mod design;
pub mod diagnostic;
pub mod disjoint;
pub mod document;
pub mod exec;
pub mod landscape;
pub mod merit;
pub mod method;
pub mod polytope;
pub mod pose;
pub mod poses;
pub mod problem;
pub mod run;
pub mod suggest;
pub mod terminal;
pub mod tolerance;
pub mod xml;
