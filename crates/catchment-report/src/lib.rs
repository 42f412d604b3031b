//! What a person or another program receives.
//!
//! ```text
//!                 ┌─ schema   versioned JSON: everything that changes the answer, and the answer
//!   Acceptance ───┼─ table    the same for eyes, in 80 columns
//!   merit         ├─ page     the same to click: one offline file (feature `page`)
//!   study         ├─ figure   PNG and SVG (feature `figure`), with the numbers of the report
//!                 ├─ zarr     the whole grid, for xarray (feature `zarr`)
//!                 └─ vtk (ParaView), gltf (viewers), cells (a table): for other tools
//!                       └──▶  write: complete or not at all
//!
//!   check · trajectory · chance · jams · rests · hold · friction · plan · validation · lever · zraa · faces · trials · export · solids · slices ·
//!   convergence · sensitivity · sweep · comparison
//!                             one file per subject: its JSON, its text, its table for programs
//!   envelope · text           the head of all JSON; what all text is made with
//! ```
//!
//! The same input gives the same bytes, apart from the field `timing`. Lengths are in D and angles in radians in
//! every machine format; for people the design's own unit and degrees stand beside them.

mod answer;
mod bench;
#[cfg(feature = "zarr")]
mod bounded;
mod cells;
mod check;
#[cfg(all(feature = "figure", feature = "zarr"))]
pub mod compare;
mod comparison;
mod convergence;
pub mod document;
mod envelope;
mod export;
mod faces;
#[cfg(feature = "figure")]
pub mod figure;
pub mod folder;
pub mod gltf;
mod html;
mod jams;
pub mod json_schema;
mod lever;
mod outcomes;
#[cfg(feature = "page")]
pub mod page;
mod plan;
mod resting;
mod rests;
#[cfg(all(feature = "figure", feature = "zarr"))]
mod save;
pub mod schema;
mod sensitivity;
pub mod set;
mod slices;
pub mod solids;
mod sweep;
mod table;
pub mod text;
mod trajectory;
mod trials;
mod validation;
mod version;
pub mod vtk;
mod window;
pub mod write;
#[cfg(feature = "zarr")]
pub mod zarr;
mod zraa;

#[cfg(feature = "drop")]
use catchment_study::chance::Chance;
use catchment_study::friction::Friction;
use catchment_study::hold::Hold;
use catchment_study::success::Success;

pub use answer::{UnanswerableError, check_requirements};
pub use cells::cells;
pub use check::{CheckBody, CheckReport, Place, ProblemReport};
pub use comparison::{
    Agreement, AgreementBody, AgreementReport, Compared, ComparisonBody, ComparisonReport, Decided,
    MethodResult,
};
pub use convergence::{ConvergenceBody, ConvergenceReport};
pub use document::{OfDesign, ReportOf};
pub use envelope::{Body, Envelope, OLDEST, SCHEMA};
pub use export::{ExportBody, ExportReport};
pub use faces::{FacesBody, FacesError, FacesReport};
pub use jams::{
    ContactReport, ExaminedReport, ExtentReport, JamReport, JamsBody, JamsFound, JamsReport, PairReport,
    WayOutReport,
};
pub use lever::{LeverBody, LeverFound, LeverReport};
pub use outcomes::{OutcomeRows, OutcomesReport};
pub use plan::{PlanBody, PlanCounts, PlanPointReport, PlanReport, PlannedReport};
pub use resting::{HeldReport, ThresholdsReport};
pub use rests::{RestReport, RestsBody, RestsReport};
#[cfg(all(feature = "figure", feature = "zarr"))]
pub use save::{Saved, Target, save, save_drawn, save_group, save_pictures, save_set, save_slices};
pub use schema::{Report, RunBody};
pub use sensitivity::{SensitivityBody, SensitivityReport};
pub use slices::{SliceReport, SlicesBody, SlicesReport};
pub use solids::{SolidsBody, SolidsReport};
#[cfg(all(feature = "figure", feature = "zarr"))]
pub use sweep::Parts;
pub use sweep::{SweepBody, SweepReport};
pub use table::{first_look, table, table_with};
pub use text::{csv, number};
pub use trajectory::{TouchReport, TraceBody, TraceReport, WaypointReport};
pub use trials::{TrialReport, TrialsBody, TrialsReport};
pub use validation::{
    AgreedReport, CountReport, EvidenceReport, ExplainingReport, FrictionTried, LineReport, OneSidedReport,
    TriedReport, ValidationBody, ValidationReport,
};
pub use version::{Version, VersionError};
pub use window::{
    CertificateReport, HalfWidths, SideReport, WindowBody, WindowFound, WindowReport, WindowSection,
    WorstReport,
};
pub use zraa::{CatchReport, NilssonReport, ZraaBody, ZraaFound, ZraaReport};

/// The effect of friction, with its head.
pub type FrictionReport = ReportOf<Friction>;
/// What a half withstands, with its head.
pub type HoldReport = ReportOf<Hold>;
/// Whether robots dock, with its head.
pub type SuccessesReport = ReportOf<Success>;
/// How likely drop tests dock, with its head.
#[cfg(feature = "drop")]
pub type ChanceReport = ReportOf<Chance>;
