//! A run: from a problem to its area of acceptance and figures of merit.
//!
//! ```text
//!   Run ──plan──▶ decide ──▶ correct ──▶ settle ──▶ merits ──▶ Answer
//!        grid,     every     sampled     uncertain   Sum, ONAA,   all results; the code that
//!        costs,    cell by   poses,      cells,      tolerances,  prints, draws or stores
//!        refusals  the       followed    followed    success      them decides nothing
//!                  method    exactly     exactly
//! ```
//!
//! A [`Run`] contains all settings that change a result besides the problem: method, resolution, samples,
//! expected errors, requirements. It is data: it can be written as JSON, read back, compared, or sent to
//! another machine. [`Run::on`] computes it; the same run on the same problem gives the same bits for any
//! threads in [`Exec`], except with [`Stop::Budget`], for which the clock decides the number of poses and the
//! progress of the grid.
//!
//! A run over listed poses ([`Over::Stream`]) or by a method that decides each pose separately can be divided
//! over machines: [`part`].
//!
//! Not promised: more than the method promises. Lengths in D, angles in radians.
//!
//! [`Stop::Budget`]: crate::method::correction::Stop::Budget

mod answer;
mod end_contact;
mod follow;
pub mod jams;
pub mod part;
mod plan;
mod report_schema;
mod requirement;
pub mod rests;
mod seat;
mod stages;
mod upright;
pub mod window;
pub use stages::correct;

pub use answer::{Answer, RunCorrection};
pub use end_contact::{EndContact, EndContacts};
pub use follow::FollowedPoses;
pub use part::{PartAnswer, RunPart, RunPartError};
pub use plan::{Afterwards, RunPlan};
pub use report_schema::ReportSchema;
pub use requirement::{Requirement, RequirementCheck, RequirementError};
pub use seat::{Deeper, Residual, Seating};
pub use upright::Upright;

use crate::diagnostic::Diagnostics;
use crate::exec::{Cancelled, Exec, OutOfBudget, Stopwatch};
use crate::landscape::{LandscapeError, Resolution, ResolutionError};
use crate::merit::MeritError;
use crate::merit::success::Distribution;
use crate::method::correction::{CorrectionError, Stop};
use crate::method::{DecideError, Method, NotApplicable};
use crate::problem::Problem;
use jams::JamsError;
use serde::{Deserialize, Serialize};

/// All settings that change a result, besides the problem.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Run {
    /// Method that decides the cells.
    pub method: Method,
    /// Poses that are decided.
    pub over: Over,
    /// Sampled poses that correct the Sum of a grid.
    pub sample: Sample,
    /// Seed of all sampled poses.
    pub seed: u64,
    /// Pose-error distribution of a robot: adds the success probability.
    pub errors: Option<Distribution>,
    /// Requirements that the report must fulfil.
    pub requirements: Vec<Requirement>,
    /// Whether to keep the heights over the grid even if the method does not need them.
    pub heights: bool,
    /// Whether to find the rests outside the seat, by [`jams`].
    pub jams: bool,
    /// Whether to find the tolerance window, by [`window`].
    pub window: bool,
}

/// The poses that are decided.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Over {
    /// The centres of the cells of a grid over the error box.
    Grid(Resolution),
    /// This number of poses, sampled uniformly from the error box; pose k depends only on the seed and k.
    Stream(usize),
}

impl Default for Over {
    fn default() -> Self {
        Self::Grid(Resolution::default())
    }
}

/// Number of sampled poses that correct the Sum of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Sample {
    /// Default of the method.
    #[default]
    ByMethod,
    /// No samples: the Sum is that of the grid.
    None,
    /// Until this stopping rule applies.
    Until(Stop),
}

impl Default for Run {
    fn default() -> Self {
        Self {
            method: Method::default(),
            over: Over::default(),
            sample: Sample::default(),
            seed: 1,
            errors: None,
            requirements: Vec::new(),
            heights: false,
            jams: false,
            window: false,
        }
    }
}

/// Why a run gives no answer.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The mated pose does not hold.
    #[error(transparent)]
    NotHeld(#[from] Diagnostics),
    /// The method is not made for the design.
    #[error(transparent)]
    NotApplicable(#[from] NotApplicable),
    /// The resolution does not suit the free errors.
    #[error(transparent)]
    Resolution(#[from] ResolutionError),
    /// The method gave up.
    #[error(transparent)]
    Decide(DecideError),
    /// The Sum could not be corrected.
    #[error(transparent)]
    Correction(#[from] CorrectionError),
    /// There are no heights.
    #[error(transparent)]
    Landscape(#[from] LandscapeError),
    /// There are no figures of merit.
    #[error(transparent)]
    Merit(#[from] MeritError),
    /// The jams could not be computed.
    #[error(transparent)]
    Jams(#[from] JamsError),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<DecideError> for RunError {
    fn from(error: DecideError) -> Self {
        match error {
            DecideError::NotApplicable(error) => Self::NotApplicable(error),
            DecideError::OutOfBudget(error) => Self::OutOfBudget(error),
            DecideError::Cancelled(error) => Self::Cancelled(error),
            error => Self::Decide(error),
        }
    }
}

impl Run {
    /// A run by a method, with the defaults of everything else.
    pub fn by(method: Method) -> Self {
        Self { method, ..Self::default() }
    }

    /// Computes the run. For many runs use [`Exec::each`] instead of tasks in a common pool of `rayon`, whose
    /// waiting threads start further tasks until the stack is full.
    ///
    /// # Errors
    /// See [`RunError`]; nothing is left behind.
    pub fn on(&self, problem: &Problem, exec: &Exec) -> Result<Answer, RunError> {
        self.on_with(problem, exec, |_| {})
    }

    /// The same; `first` receives the results with roll and pitch locked, which are known long before the
    /// rest.
    ///
    /// # Errors
    /// See [`RunError`]; nothing is left behind.
    pub fn on_with(
        &self,
        problem: &Problem,
        exec: &Exec,
        first: impl FnOnce(&Upright),
    ) -> Result<Answer, RunError> {
        let exec = &exec.anew();
        let plan = self.plan(problem)?;
        plan.ensure_fits(exec)?;
        let started = Stopwatch::start();
        let upright = stages::upright(self, &plan, problem, exec)?;
        if let Some(upright) = &upright {
            first(upright);
        }
        let decided = stages::decide(&plan, problem, exec)?;
        stages::finish(self, &plan, problem, (upright, decided), started, exec)
    }
}
