//! Drop tests as a method: every pose is decided separately.

use super::engine::SUNK;
use super::{DropError, DropSettings, run, run_observed};
use crate::acceptance::{Acceptance, Domain};
use crate::contact::Pair;
use crate::exec::Exec;
use crate::landscape::Grid;
use crate::method::cost::POSE_BYTES;
use crate::method::descent::End;
use crate::method::interface::{
    Cost, DecideError, DecisionMethod, Info, MethodOutput, PoseMethod, PoseObserver,
};
use crate::method::registry::RegistryEntry;
use crate::problem::Problem;
use serde_json::{Value, json};

const INFO: Info = Info {
    name: "drop",
    summary: "drop tests of every cell's centre in a rigid-body engine: friction, mass, speed, bounce",
    on_grids: false,
    departs: true,
};

/// Its line in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<DropSettings>(&INFO);

impl DecisionMethod for DropSettings {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn settings(&self) -> Value {
        json!(self)
    }

    fn check(&self) -> Result<(), DecideError> {
        Self::check(self).map_err(DecideError::method)
    }

    /// Half a minute at some 20 ms per pose.
    fn default_cells(&self, _: &Pair) -> [usize; 5] {
        [101, 31, 11, 7, 5]
    }

    fn cost(&self, _: &Problem, grid: &Grid) -> Cost {
        /// Core-seconds per pose with its trials.
        const POSE_SECONDS: f64 = 0.02;
        let cells = grid.axes.iter().map(|axis| axis.cells as f64).product::<f64>();
        Cost { what: "the outcome of every cell", bytes_per_cell: POSE_BYTES, seconds: cells * POSE_SECONDS }
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let (acceptance, _) = run(problem.pair(), domain.clone(), self, exec)?;
        Ok(MethodOutput::plain(acceptance, DecisionMethod::settings(self)))
    }

    fn follows(&self) -> Option<&dyn PoseMethod> {
        Some(self)
    }
}

impl PoseMethod for DropSettings {
    fn follow(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        Ok(run(problem.pair(), domain, self, exec)?)
    }

    fn rest_observed(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
        finished: PoseObserver<'_>,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        Ok(run_observed(problem.pair(), domain, self, exec, finished)?)
    }

    fn give(&self) -> f64 {
        SUNK
    }
}

impl From<DropError> for DecideError {
    fn from(error: DropError) -> Self {
        match error {
            DropError::OutOfBudget(error) => Self::OutOfBudget(error),
            DropError::Cancelled(error) => Self::Cancelled(error),
            error => Self::method(error),
        }
    }
}
