//! Studies over many designs: reproduction of published tables.

pub mod reproduce;
