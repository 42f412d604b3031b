//! One method at one resolution, with its default settings: what studies of methods are made of.
//!
//! The Sum is the grid's own: the measure of the accepted cells, for transport the mean arrival fraction. Transport's
//! ambiguous cells are not settled by descent. [`Decided::correct`] gives the unbiased Sum that `run` reports.

use super::pose_bytes;
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::advice::Advice;
use crate::contact::Pair;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Grid, LandscapeError, Resolution};
use crate::merit::MeritError;
use crate::merit::onaa::Onaa;
use crate::merit::sum::{Sum, bracket};
use crate::method::correction::{self, ByFraction, ByNeighbours, Corrected, CorrectionError};
use crate::method::flood::{self, FloodError};
use crate::method::partition::{self, PartitionError};
use crate::method::transport::{self, Arrival, TransportError};
use crate::method::{Method, descent};
use serde::Serialize;
use std::time::Instant;

/// What one method says at one resolution.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// Cells per axis.
    pub resolution: usize,
    /// Cells of the grid.
    pub cells: usize,
    /// Wall-clock time, in seconds: the only part that differs between equal runs.
    pub seconds: f64,
    /// The grid's own Sum, Dᵃ·radᵇ.
    pub sum: f64,
    /// Its unit, like `D²·rad³`.
    pub unit: String,
    /// The measure of the accepted cells that touch no rejected one, and of these with all cells that touch an accepted
    /// one: the doubt of resolution alone.
    pub bracket: [f64; 2],
    /// Edge of the largest axis-oriented cube, in [0, 1].
    pub onaa_edge: f64,
    /// Cells that were not decided.
    pub undecided: usize,
}

/// A grid that a method has decided.
#[derive(Debug)]
pub struct Decided {
    grid: Grid,
    acceptance: Acceptance,
    arrival: Option<Arrival>,
    seconds: f64,
}

/// Why a trial came to nothing.
#[derive(Debug, thiserror::Error)]
pub enum TrialError {
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Flooding refuses.
    #[error(transparent)]
    Flood(FloodError),
    /// Transport refuses.
    #[error(transparent)]
    Transport(TransportError),
    /// There is no partition.
    #[error(transparent)]
    Partition(#[from] PartitionError),
    /// Drop tests refuse.
    #[cfg(feature = "drop")]
    #[error(transparent)]
    Drop(#[from] crate::method::drop::DropError),
    /// There is no corrected Sum.
    #[error(transparent)]
    Correction(#[from] CorrectionError),
    /// The method does not decide every design.
    #[error("{} decides some designs only: it has no part in studies of methods", method.name())]
    NotGeneral {
        /// The method.
        method: Method,
    },
    /// A figure of merit is not to be had.
    #[error(transparent)]
    Merit(#[from] MeritError),
}

impl From<FloodError> for TrialError {
    fn from(error: FloodError) -> Self {
        match error {
            FloodError::OutOfBudget(error) | FloodError::Landscape(LandscapeError::OutOfBudget(error)) => {
                Self::OutOfBudget(error)
            }
            FloodError::Cancelled(error) | FloodError::Landscape(LandscapeError::Cancelled(error)) => {
                Self::Cancelled(error)
            }
            error => Self::Flood(error),
        }
    }
}

impl From<TransportError> for TrialError {
    fn from(error: TransportError) -> Self {
        match error {
            TransportError::OutOfBudget(error)
            | TransportError::Landscape(LandscapeError::OutOfBudget(error)) => Self::OutOfBudget(error),
            TransportError::Cancelled(error)
            | TransportError::Landscape(LandscapeError::Cancelled(error)) => Self::Cancelled(error),
            error => Self::Transport(error),
        }
    }
}

impl Decided {
    /// Decides the error box of `pair` with `resolution` cells per axis.
    ///
    /// # Errors
    /// See [`TrialError`].
    pub fn by(method: Method, pair: &Pair, resolution: usize, exec: &Exec) -> Result<Self, TrialError> {
        let grid = Grid::over(&pair.alignment, |_| resolution);
        let started = Instant::now();
        let mut arrival = None;
        let acceptance = match method {
            Method::Descent => {
                let cells = grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
                exec.reserve("the outcome of every cell", cells.saturating_mul(pose_bytes()), |budget| {
                    let fits = Resolution::largest_that_fits(budget, pose_bytes(), grid.axes.len());
                    vec![Advice::AtMostResolution(fits)]
                })?;
                descent::run(pair, Domain::Grid(grid.clone()), &descent::Settings::default(), exec)?.0
            }
            Method::Transport => {
                let found = transport::run(pair, &grid, &transport::Settings::default(), exec)?;
                arrival.insert(found).acceptance(exec)?
            }
            Method::Flood | Method::Steepest => {
                let settings =
                    flood::Settings { rule: method.rule().unwrap_or_default(), ..flood::Settings::default() };
                flood::accept(pair, &grid, &settings, exec)?
            }
            Method::Partition => partition::run(pair, &partition::Settings::default(), exec)?
                .acceptance(Domain::Grid(grid.clone()), exec)?,
            Method::Kinematic => return Err(TrialError::NotGeneral { method }),
            #[cfg(feature = "drop")]
            Method::Drop => {
                let settings = crate::method::drop::Settings::default();
                crate::method::drop::run(pair, Domain::Grid(grid.clone()), &settings, exec)?.0
            }
        };
        Ok(Self { grid, acceptance, arrival, seconds: started.elapsed().as_secs_f64() })
    }

    /// What it says.
    ///
    /// # Errors
    /// A figure of merit that is not to be had.
    pub fn trial(&self, pair: &Pair, exec: &Exec) -> Result<Trial, TrialError> {
        let sum = Sum::of(&self.acceptance, &pair.alignment);
        Ok(Trial {
            resolution: self.grid.axes.first().map_or(0, |axis| axis.cells),
            cells: sum.tried,
            seconds: self.seconds,
            sum: self.arrival.as_ref().map_or(sum.sum, |arrival| arrival.mean() * self.grid.measure()),
            unit: sum.unit(),
            bracket: bracket(&self.acceptance, exec)?,
            onaa_edge: Onaa::of(&self.acceptance, exec)?.edge,
            undecided: sum.counts[Outcome::Undecided as usize - 1],
        })
    }

    /// The unbiased Sum with its 95 % interval: random poses, most of them where the grid is in doubt, followed exactly.
    ///
    /// # Errors
    /// See [`CorrectionError`].
    pub fn correct(
        &self,
        pair: &Pair,
        settings: &correction::Settings,
        exec: &Exec,
    ) -> Result<Corrected, CorrectionError> {
        let (shape, descents) = (self.grid.shape(), descent::Settings::default());
        if let Some(arrival) = &self.arrival {
            let by = ByFraction::new(|cell| arrival.fraction(cell), shape);
            correction::correct(pair, &self.grid, &by, settings, &descents, exec)
        } else {
            let by = ByNeighbours::new(&self.acceptance.outcomes, shape);
            correction::correct(pair, &self.grid, &by, settings, &descents, exec)
        }
    }
}
