//! Systems built on a connector's area of acceptance.
//!
//! The crate `catchment` describes a pair of halves and the errors that their contact corrects. This crate
//! adds systems that engineers build with such a pair:
//!
//! ```text
//!   catalog   published docking systems, their areas of acceptance, and the rank of a design among them
//!   compose   two halves that both move: the region over which they meet
//!   latch     the latching X-Face: geometry, stiffness, forces, drawings for the laser cutter
//!   chain     chains of modules: the pose of their last face, and whether it docks
//!   invert    wanted heights and one half give the other
//! ```
//!
//! Each depends only on `catchment`, which depends on none of them. [`form`] reads their files.

pub mod catalog;
pub mod chain;
pub mod compose;
pub mod form;
pub mod invert;
pub mod latch;
mod points;

/// Adds the JSON schemas of all reports of systems to a generator.
#[cfg(feature = "schema")]
pub fn add_json_schemas(generator: &mut schemars::SchemaGenerator) {
    catchment::report::json_schema::add!(
        generator,
        catalog::report::CatalogReport,
        catalog::report::SystemReport,
        catalog::report::ClassifyReport,
        chain::report::ChainReport,
        compose::ComposeReport,
        invert::InvertReport,
        latch::LatchReport,
        latch::TableReport,
    );
}
