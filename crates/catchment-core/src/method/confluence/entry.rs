//! Confluence as a method: exact motions over a grid with inherited labels.

use super::{ConfluenceError, ConfluenceSettings, bytes, run};
use crate::acceptance::Domain;
use crate::contact::Pair;
use crate::exec::Exec;
use crate::landscape::{Grid, LandscapeError};
use crate::method::cost::{DESCENT_SECONDS, affordable, affordable_cells};
use crate::method::descent;
use crate::method::interface::{ByProducts, Cost, DecideError, DecisionMethod, Info, MethodOutput, grid_of};
use crate::method::registry::{Method, RegistryEntry};
use crate::problem::Problem;
use serde_json::{Value, json};
use std::time::Duration;

pub(super) const NAME: &str = "confluence";

const INFO: Info = Info {
    name: NAME,
    summary: "exact motion of every cell's centre, until it joins others that are known",
    on_grids: true,
    departs: false,
};

/// Its line in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<ConfluenceSettings>(&INFO);

impl DecisionMethod for ConfluenceSettings {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn settings(&self) -> Value {
        json!(self)
    }

    fn check(&self) -> Result<(), DecideError> {
        if !(self.known > 0.5 && self.known <= 1.0) {
            return Err(DecideError::method(KnownOutOfRange));
        }
        if self.budget_s.is_some_and(|seconds| !(seconds > 0.0 && seconds.is_finite())) {
            return Err(DecideError::method(NoBudget));
        }
        self.descent.check()
    }

    fn motions(&self) -> descent::DescentSettings {
        self.descent.clone()
    }

    fn within(&self, budget: Duration) -> Option<Method> {
        let budget_s = self.budget_s.map_or(budget.as_secs_f64(), |own| own.min(budget.as_secs_f64()));
        Some(Method::new(Self { budget_s: Some(budget_s), ..self.clone() }))
    }

    /// Even, so that no cell lies exactly on a mirror plane, at which two contacts carry the half at once;
    /// fewer for slow motions, but in total about as many as the number of sampled poses.
    fn default_cells(&self, pair: &Pair) -> [usize; 5] {
        const SIMPLE: [usize; 5] = [1000, 200, 32, 24, 24];
        let cells = affordable_cells(pair, SIMPLE, descent::default_samples(pair));
        cells.map(|cells| (cells / 8 * 8).max(4))
    }

    fn default_samples(&self, pair: &Pair) -> usize {
        descent::default_samples(pair)
    }

    fn cost(&self, problem: &Problem, grid: &Grid) -> Cost {
        /// Share of the cells that are followed, times that of its way that a motion is: measured at 20⁵ cells of pyramids and X-Faces.
        const FOLLOWED: f64 = 0.03;
        let cells = grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
        Cost {
            what: "the outcome of every cell",
            bytes_per_cell: bytes(problem.pair(), grid).div_ceil(cells.max(1)),
            seconds: cells as f64 * FOLLOWED * DESCENT_SECONDS / affordable(problem.pair()),
        }
    }

    fn by_products(&self) -> &'static [&'static str] {
        &["inherited"]
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let labels = run(problem.pair(), grid_of(&INFO, domain)?, self, exec)?;
        let by_products = ByProducts { inherited: Some(labels.inherited), ..ByProducts::default() };
        // A clock that ended nothing has no part in the answer.
        let budget_s = self.budget_s.filter(|_| labels.unreached() > 0);
        let settings = Self { budget_s, ..self.clone() }.settings();
        Ok(MethodOutput { by_products, ..MethodOutput::plain(labels.acceptance(exec), settings) })
    }
}

#[derive(Debug, thiserror::Error)]
#[error("known is a share of the centres around a pose, above 0.5 and at most 1")]
struct KnownOutOfRange;

#[derive(Debug, thiserror::Error)]
#[error("budget_s is a positive number of seconds")]
struct NoBudget;

impl From<ConfluenceError> for DecideError {
    fn from(error: ConfluenceError) -> Self {
        match error {
            ConfluenceError::OutOfBudget(error)
            | ConfluenceError::Landscape(LandscapeError::OutOfBudget(error)) => Self::OutOfBudget(error),
            ConfluenceError::Cancelled(error)
            | ConfluenceError::Landscape(LandscapeError::Cancelled(error)) => Self::Cancelled(error),
            error => Self::method(error),
        }
    }
}
