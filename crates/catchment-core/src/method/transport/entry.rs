//! Transport as a method: cells of a grid, with an arrival fraction for each.

use super::{ArrivalFractions, TransportError, TransportSettings, bytes, run};
use crate::acceptance::Domain;
use crate::contact::Pair;
use crate::exec::Exec;
use crate::landscape::{Grid, LandscapeError};
use crate::method::descent;
use crate::method::interface::{
    CellFractions, Cost, DecideError, DecisionMethod, Info, MethodOutput, grid_of,
};
use crate::method::registry::{MOTIONS, RegistryEntry};
use crate::problem::Problem;
use serde_json::{Value, json};

const INFO: Info = Info {
    name: "transport",
    summary: "arrival fractions over the grid along exact directions; ambiguous cells by descent",
    on_grids: true,
    departs: false,
};

/// Its line in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<TransportSettings>(&INFO);

impl DecisionMethod for TransportSettings {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn settings(&self) -> Value {
        // Along the frictionless direction of descent nothing that holds a half can be set.
        let mut settings = json!(self);
        if let Some(motions) = settings.get_mut(MOTIONS).and_then(Value::as_object_mut) {
            motions.retain(|name, _| name != "friction" && name != "slope_threshold");
        }
        settings
    }

    /// Even, so that no cell lies exactly on a mirror plane, at which two contacts carry the half at once.
    fn default_cells(&self, _: &Pair) -> [usize; 5] {
        [1000, 200, 48, 32, 24]
    }

    fn default_samples(&self, pair: &Pair) -> usize {
        descent::default_samples(pair)
    }

    fn cost(&self, problem: &Problem, grid: &Grid) -> Cost {
        /// Core-seconds per cell: heights, links and arrivals.
        const CELL_SECONDS: f64 = 1e-7;
        let cells = grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
        Cost {
            what: "transport",
            bytes_per_cell: bytes(problem.pair(), grid).div_ceil(cells.max(1)),
            seconds: cells as f64 * CELL_SECONDS,
        }
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let arrival = run(problem.pair(), grid_of(&INFO, domain)?, self, exec)?;
        let acceptance = arrival.acceptance(exec)?;
        Ok(MethodOutput {
            doubts: Some(Box::new(arrival)),
            ..MethodOutput::plain(acceptance, self.settings())
        })
    }
}

impl CellFractions for ArrivalFractions {
    fn fraction(&self, cell: usize) -> f64 {
        Self::fraction(self, cell)
    }

    fn is_ambiguous(&self, cell: usize) -> bool {
        Self::is_ambiguous(self, cell)
    }

    fn mean(&self) -> f64 {
        Self::mean(self)
    }
}

impl From<TransportError> for DecideError {
    fn from(error: TransportError) -> Self {
        match error {
            TransportError::OutOfBudget(error)
            | TransportError::Landscape(LandscapeError::OutOfBudget(error)) => Self::OutOfBudget(error),
            TransportError::Cancelled(error)
            | TransportError::Landscape(LandscapeError::Cancelled(error)) => Self::Cancelled(error),
            error => Self::method(error),
        }
    }
}
