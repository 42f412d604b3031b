//! Studies over many designs: reproduction of published tables, and whether stated intervals hold.

pub mod coverage;
pub mod reproduce;
