//! Exact descent as a method: every pose is followed separately.

use super::{DescentSettings, End, rests, rests_observed, run, step_dependence};
use crate::acceptance::{Acceptance, Domain};
use crate::contact::Pair;
use crate::diagnostic::Warning;
use crate::exec::Exec;
use crate::landscape::Grid;
use crate::method::cost::{DESCENT_SECONDS, POSE_BYTES, affordable, affordable_cells, motions_in};
use crate::method::interface::{
    Cost, DecideError, DecisionMethod, Info, MethodOutput, PoseMethod, PoseObserver,
};
use crate::method::registry::RegistryEntry;
use crate::problem::Problem;
use serde_json::{Value, json};

const INFO: Info =
    Info { name: "descent", summary: "exact motion of every cell's centre", on_grids: true, departs: false };

/// Its line in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<DescentSettings>(&INFO);

impl DecisionMethod for DescentSettings {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn settings(&self) -> Value {
        json!(self)
    }

    /// Odd, so that a cell is centred on the mated pose; fewer for halves with many facets, but in total
    /// about as many as the number of sampled poses.
    fn default_cells(&self, pair: &Pair) -> [usize; 5] {
        const SIMPLE: [usize; 5] = [1001, 101, 23, 11, 7];
        let cells = affordable_cells(pair, SIMPLE, default_samples(pair));
        cells.map(|cells| (cells.saturating_sub(1) / 2 * 2 + 1).max(3))
    }

    fn default_samples(&self, pair: &Pair) -> usize {
        default_samples(pair)
    }

    fn cost(&self, problem: &Problem, grid: &Grid) -> Cost {
        let cells = grid.axes.iter().map(|axis| axis.cells as f64).product::<f64>();
        Cost {
            what: "the outcome of every cell",
            bytes_per_cell: POSE_BYTES,
            seconds: cells * DESCENT_SECONDS / affordable(problem.pair()),
        }
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let (acceptance, _) = run(problem.pair(), domain.clone(), self, exec)?;
        Ok(MethodOutput::plain(acceptance, self.settings()))
    }

    fn check(&self) -> Result<(), DecideError> {
        DescentSettings::with_friction(self.friction).map_err(DecideError::method)?;
        DescentSettings::with_slope_threshold(self.slope_threshold).map(|_| ()).map_err(DecideError::method)
    }

    fn motions(&self) -> Self {
        self.clone()
    }

    fn follows(&self) -> Option<&dyn PoseMethod> {
        Some(self)
    }
}

impl PoseMethod for DescentSettings {
    fn follow(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        Ok(run(problem.pair(), domain, self, exec)?)
    }

    fn rest(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        Ok(rests(problem.pair(), domain, self, exec)?)
    }

    fn rest_observed(
        &self,
        problem: &Problem,
        domain: Domain,
        exec: &Exec,
        finished: PoseObserver<'_>,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        Ok(rests_observed(problem.pair(), domain, self, exec, finished)?)
    }

    fn step_warning(
        &self,
        problem: &Problem,
        seed: u64,
        exec: &Exec,
    ) -> Result<Option<Warning>, DecideError> {
        Ok(step_dependence(problem.pair(), self, seed, exec)?)
    }

    fn is_descent(&self) -> bool {
        true
    }
}

/// Random descents that make the Sum of a pair's grid known to a percent or so, in a second; of large halves fewer.
pub(in crate::method) fn default_samples(pair: &Pair) -> usize {
    const SIMPLE: f64 = 4000.0;
    /// Fewer if these would take longer than this on one core, in seconds.
    const LEAST: usize = 200;
    const LONGEST: f64 = 25.0;
    ((SIMPLE * affordable(pair)) as usize).max(LEAST.min(motions_in(LONGEST, pair)))
}
