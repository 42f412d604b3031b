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
//!   check · trajectory · chance · jams · rests · hold · lever · zraa · faces · export · solids · slices · comparison
//!                             one file per subject: its JSON, its text, its table for programs
//!   envelope · text           the head of all JSON; what all text is made with
//! ```
//!
//! The same input gives the same bytes, apart from the field `timing`. Lengths are in D and angles in radians in
//! every machine format; for people the design's own unit and degrees stand beside them.

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
pub mod folder;
pub mod gltf;
mod html;
pub mod json_schema;
mod lever;
mod outcomes;
#[cfg(feature = "page")]
pub mod page;
#[cfg(all(feature = "figure", feature = "zarr"))]
mod parts;
mod run;
#[cfg(all(feature = "figure", feature = "zarr"))]
mod save;
pub mod schema;
pub mod set;
mod slices;
pub mod solids;
pub mod text;
mod trajectory;
mod version;
pub mod vtk;
pub mod write;
#[cfg(feature = "zarr")]
pub mod zarr;
mod zraa;

use catchment_core::run::{jams::Jams, rests::Rests, window::Window};
use catchment_study::agreement::Agreement;
#[cfg(feature = "drop")]
use catchment_study::chance::Chance;
use catchment_study::convergence::Convergence;
use catchment_study::friction::Friction;
use catchment_study::hold::Hold;
use catchment_study::plan::Plan;
use catchment_study::sensitivity::Sensitivity;
use catchment_study::success::Success;
use catchment_study::sweep::Sweep;
use catchment_study::trials::Trials;
use catchment_study::validate::Validation;

pub use answer::{UnanswerableError, check_requirements};
pub use cells::cells;
pub use check::{CheckBody, CheckReport, Place, ProblemReport};
pub use comparison::{Compared, ComparisonBody, ComparisonReport};
pub use document::{OfDesign, ReportOf};
pub use envelope::{Body, Envelope, OLDEST, SCHEMA};
pub use export::{ExportBody, ExportReport};
pub use faces::{FacesBody, FacesError, FacesReport};
pub use lever::{CornerContact, FirstContact, LeverReport};
pub use outcomes::{OutcomeRows, OutcomesReport};
#[cfg(all(feature = "figure", feature = "zarr"))]
pub use parts::Parts;
pub use run::first_look;
#[cfg(all(feature = "figure", feature = "zarr"))]
pub use save::{Saved, Target, save, save_drawn, save_group, save_pictures, save_set, save_slices};
pub use schema::{Report, RunBody};
pub use slices::{SliceReport, SlicesFound, SlicesReport};
pub use solids::{SolidsBody, SolidsReport};
pub use text::csv;
pub use trajectory::{TraceBody, TraceReport, WaypointReport};
pub use version::{Version, VersionError};
pub use zraa::{AcceptedOffsets, CatchReport, NilssonReport, ZraaBody, ZraaReport};

/// The effect of friction, with its head.
pub type FrictionReport = ReportOf<Friction>;

/// The places where motions rest that do not dock, with their head.
pub type JamsReport = ReportOf<Jams>;

/// The places where halves come to rest, with their head.
pub type RestsReport = ReportOf<Rests>;

/// The largest box of errors that all dock, with its head.
pub type WindowReport = ReportOf<Window>;

/// Every method of a design on one grid, with its head.
pub type AgreementReport = ReportOf<Agreement>;

/// Refinement of the grid, with every method, with its head.
pub type ConvergenceReport = ReportOf<Convergence>;

/// The Sum against ρ, the centre of rotation and the aspect ratio, with its head.
pub type SensitivityReport = ReportOf<Sensitivity>;

/// Every combination of values of a sweep, with its head.
pub type SweepReport = ReportOf<Sweep>;

/// A plan of trials, with its head.
pub type PlanReport = ReportOf<Plan>;

/// Trials beside the exact region, with their head.
pub type TrialsReport = ReportOf<Trials>;

/// A prediction beside the trials of a robot, with its head.
pub type ValidationReport = ReportOf<Validation>;

/// What a half withstands, with its head.
pub type HoldReport = ReportOf<Hold>;

/// Whether robots dock, with its head.
pub type SuccessesReport = ReportOf<Success>;
/// How likely drop tests dock, with its head.
#[cfg(feature = "drop")]
pub type ChanceReport = ReportOf<Chance>;
