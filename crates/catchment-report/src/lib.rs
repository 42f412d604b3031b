//! Output of results, for people and other programs.
//!
//! ```text
//!                  ┌─ envelope    versioned JSON; json_schema has its schema, derived from the types
//!   result ────────┼─ document    one description: text, CSV, Markdown, HTML
//!   (a Subject)    ├─ figure      PNG and SVG (feature `figure`), with the numbers of the report
//!                  ├─ page        an interactive offline file (feature `page`)
//!                  ├─ zarr        the whole grid, for xarray (feature `zarr`)
//!                  └─ vtk (ParaView), gltf (viewers), cells (a table): for other tools
//!                        └──▶  write: complete or not at all
//!
//!   subjects       the results of a design that are reported, a line each; they describe themselves beside their types
//!   run · check · trajectory · lever · zraa · faces · export · solids · slices · comparison
//!                  results with reports of their own: JSON and document
//! ```
//!
//! The same input gives the same bytes, apart from the field `timing`. Lengths are in D and angles in radians
//! in every machine format; for people they are also given in the design's own unit and degrees.

mod answer;
#[cfg(feature = "zarr")]
mod bounded;
mod cells;
mod check;
#[cfg(all(feature = "figure", feature = "zarr"))]
pub mod compare;
mod comparison;
pub mod document;
mod envelope;
mod export;
mod faces;
#[cfg(feature = "figure")]
pub mod figure;
#[cfg(all(feature = "figure", feature = "zarr"))]
mod finished_designs;
pub mod folder;
pub mod gltf;
mod html;
pub mod json_schema;
mod lever;
mod outcomes;
#[cfg(feature = "page")]
pub mod page;
mod run;
#[cfg(all(feature = "figure", feature = "zarr"))]
mod save;
pub mod schema;
pub mod set;
mod slices;
pub mod solids;
mod subjects;
pub mod text;
mod trajectory;
mod version;
pub mod vtk;
pub mod write;
#[cfg(feature = "zarr")]
pub mod zarr;
mod zraa;

pub use answer::{UnanswerableError, check_requirements};
pub use cells::cells;
pub use check::{CheckBody, CheckReport, FileLocation, LocatedDiagnostic};
pub use comparison::{Compared, ComparisonBody, ComparisonReport};
pub use document::{OfDesign, ReportOf};
pub use envelope::{OLDEST, ReportBody, ReportEnvelope, SCHEMA};
pub use export::{ExportBody, ExportReport};
pub use faces::{FacesBody, FacesError, FacesReport};
#[cfg(all(feature = "figure", feature = "zarr"))]
pub use finished_designs::FinishedDesigns;
pub use lever::{CornerContact, FirstContact};
pub use outcomes::{OutcomeRows, OutcomesReport};
pub use run::first_look;
#[cfg(all(feature = "figure", feature = "zarr"))]
pub use save::{Saved, Target, save, save_drawn, save_group, save_pictures, save_set, save_slices};
pub use schema::{Report, RunBody};
pub use slices::{SliceReport, SlicesResult};
pub use solids::{SolidsBody, SolidsReport};
pub use subjects::*;
pub use text::csv;
pub use trajectory::{TraceBody, TraceReport, WaypointReport};
pub use version::{Version, VersionError};
pub use zraa::{AcceptedOffsets, CatchReport, NilssonReport, ZraaBody};
