//! What serves every step of a computation: poses, execution, diagnostics, tolerances, limits on inputs, convex
//! polygons and polytopes. Programs use the crate `catchment`.
//!
//! Lengths are in D, the connector's width; angles are in radians.

pub mod budget;
pub mod diagnostic;
pub mod disjoint;
pub mod exec;
pub mod polygon;
pub mod polytope;
pub mod pose;
pub mod suggest;
pub mod terminal;
pub mod tolerance;
