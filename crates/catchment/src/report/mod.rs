//! What a person or another program receives.
//!
//! ```text
//!                 ┌─ schema   versioned JSON: everything that changes the answer, and the answer
//!   Acceptance ───┼─ table    the same for eyes, in 80 columns
//!   merit         ├─ figure   PNG and SVG (feature `figure`)
//!                 └─ zarr     the whole grid, for xarray (feature `zarr`)
//!                       └──▶  write: complete or not at all
//! ```
//!
//! The same input gives the same bytes, apart from the field `timing`. Lengths are in D and angles in radians in
//! every machine format; for people the design's own unit and degrees stand beside them.

mod answer;
#[cfg(all(feature = "figure", feature = "zarr"))]
pub mod compare;
mod comparison;
mod convergence;
pub mod folder;
#[cfg(feature = "figure")]
pub mod figure;
pub mod schema;
#[cfg(all(feature = "figure", feature = "zarr"))]
mod save;
mod sensitivity;
mod slices;
mod table;
pub mod write;
#[cfg(feature = "zarr")]
pub mod zarr;

pub use answer::UnanswerableError;
pub use comparison::{Agreement, AgreementReport, Compared, ComparisonReport, Decided, MethodResult};
pub use convergence::ConvergenceReport;
#[cfg(all(feature = "figure", feature = "zarr"))]
pub use save::{Saved, Target};
pub use schema::Report;
pub use sensitivity::SensitivityReport;
pub use slices::SlicesReport;
pub use table::table;
