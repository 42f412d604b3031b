//! A method at a given resolution: the building block of studies of methods.
//!
//! The Sum is that of the grid: the measure of the accepted cells, for transport the mean arrival fraction.
//! Undecided cells are not followed exactly. [`GridDecision::correct`] gives the unbiased Sum that a run reports.

use catchment_core::acceptance::{Domain, Outcome};
use catchment_core::exec::{Cancelled, Exec, OutOfBudget, Stopwatch};
use catchment_core::landscape::Grid;
use catchment_core::merit::MeritError;
use catchment_core::merit::onaa::Onaa;
use catchment_core::merit::sum::{Sum, bracket};
use catchment_core::method::correction::{self, CorrectionError, UnbiasedSum};
use catchment_core::method::{DecideError, Method, MethodOutput, ensure_fits};
use catchment_core::problem::Problem;
use catchment_core::run;
use serde::Serialize;

/// Result of a method at a resolution.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Refinement {
    /// Cells per axis.
    pub resolution: usize,
    /// Cells in all.
    pub cells: usize,
    /// Wall-clock time to decide every cell, in seconds.
    pub seconds: f64,
    /// The Sum, Dᵃ·radᵇ.
    pub sum: f64,
    /// Unit of the Sum, like `D²·rad³`.
    pub unit: String,
    /// Measure of the accepted cells without the border cells, and with the rejected neighbours, in the same
    /// unit.
    pub bracket: [f64; 2],
    /// ONAA edge, in [0, 1].
    pub onaa_edge: f64,
    /// Number of undecided cells.
    pub undecided: usize,
}

/// A method's answer over a grid.
#[derive(Debug)]
pub struct GridDecision {
    method: Method,
    grid: Grid,
    decided: MethodOutput,
    seconds: f64,
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub enum RefinementError {
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The method gave up.
    #[error(transparent)]
    Decide(DecideError),
    /// The Sum could not be corrected.
    #[error(transparent)]
    Correction(#[from] CorrectionError),
    /// A figure of merit could not be computed.
    #[error(transparent)]
    Merit(#[from] MeritError),
}

impl From<DecideError> for RefinementError {
    fn from(error: DecideError) -> Self {
        match error {
            DecideError::OutOfBudget(error) => Self::OutOfBudget(error),
            DecideError::Cancelled(error) => Self::Cancelled(error),
            error => Self::Decide(error),
        }
    }
}

impl GridDecision {
    /// Decides every cell of a grid with `resolution` cells per axis.
    ///
    /// # Errors
    /// See [`RefinementError`].
    pub fn by(
        method: &Method,
        problem: &Problem,
        resolution: usize,
        exec: &Exec,
    ) -> Result<Self, RefinementError> {
        let grid = Grid::over(problem.alignment(), |_| resolution);
        let cost = method.cost(problem, &grid);
        let cells = grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
        let needed = cells.saturating_mul(cost.bytes_per_cell);
        ensure_fits(cost.what, needed, cost.bytes_per_cell, grid.axes.len(), exec)?;
        let started = Stopwatch::start();
        let decided = method.decide(problem, &Domain::Grid(grid.clone()), exec)?;
        let seconds = started.seconds();
        Ok(Self { method: method.clone(), grid, decided, seconds })
    }

    /// Result of the method.
    ///
    /// # Errors
    /// See [`RefinementError`].
    pub fn refinement(&self, problem: &Problem, exec: &Exec) -> Result<Refinement, RefinementError> {
        let acceptance = &self.decided.acceptance;
        let sum = Sum::of(acceptance, problem.alignment());
        Ok(Refinement {
            resolution: self.grid.axes.first().map_or(0, |axis| axis.cells),
            cells: sum.tried,
            seconds: self.seconds,
            sum: self.decided.doubts.as_ref().map_or(sum.sum, |doubts| doubts.mean() * self.grid.measure()),
            unit: sum.unit(),
            bracket: bracket(acceptance, exec)?,
            onaa_edge: Onaa::of(acceptance, exec)?.edge,
            undecided: sum.counts[Outcome::Undecided as usize - 1],
        })
    }

    /// The Sum made unbiased by samples, as in a run.
    ///
    /// # Errors
    /// See [`CorrectionError`].
    pub fn correct(
        &self,
        problem: &Problem,
        settings: &correction::CorrectionSettings,
        exec: &Exec,
    ) -> Result<UnbiasedSum, CorrectionError> {
        let doubts = self.decided.doubts.as_deref();
        let (method, acceptance) = (&self.method, &self.decided.acceptance);
        Ok(run::correct(method, problem, &self.grid, acceptance, doubts, settings, exec)?.estimate)
    }
}
