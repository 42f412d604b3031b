//! Flooding as a method, by either rule: two lines of the registry, one implementation.

use super::{DrainageRule, FloodError, FloodSettings, bytes, docks, flood};
use crate::acceptance::Domain;
use crate::contact::Pair;
use crate::exec::Exec;
use crate::landscape::{Grid, Landscape, LandscapeError, Resolution};
use crate::method::interface::{ByProducts, Cost, DecideError, DecisionMethod, Info, MethodOutput, grid_of};
use crate::method::registry::{Method, RegistryEntry};
use crate::problem::Problem;
use serde_json::{Value, json};

const LOWEST: Info = Info {
    name: "flood",
    summary: "fast flooding of the heights over the grid; biased, made for comparisons",
    on_grids: true,
    departs: true,
};

const STEEPEST: Info = Info {
    name: "steepest",
    summary: "flooding along the steepest neighbour; biased too, made for comparisons",
    on_grids: true,
    departs: true,
};

/// The line of [`DrainageRule::Lowest`] in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<FloodSettings>(&LOWEST);

/// The registry line of [`Rule::Steepest`], which is the default rule.
pub(in crate::method) const ENTRY_STEEPEST: RegistryEntry = RegistryEntry::by(&STEEPEST, |value| {
    let named = value.get("rule").is_some();
    let settings: FloodSettings = serde_json::from_value(value)?;
    Ok(Method::new(if named { settings } else { FloodSettings { rule: DrainageRule::Steepest, ..settings } }))
});

/// Core-seconds per cell.
const CELL_SECONDS: f64 = 1e-7;

impl DecisionMethod for FloodSettings {
    fn info(&self) -> &'static Info {
        match self.rule {
            DrainageRule::Lowest => &LOWEST,
            DrainageRule::Steepest => &STEEPEST,
        }
    }

    fn settings(&self) -> Value {
        json!(self)
    }

    fn check(&self) -> Result<(), DecideError> {
        match self.depth_tolerance {
            Some(depth) if !(depth >= 0.0 && depth.is_finite()) => {
                Err(DecideError::method(FloodError::Tolerance { depth }))
            }
            _ => Ok(()),
        }
    }

    fn default_cells(&self, _: &Pair) -> [usize; 5] {
        Resolution::DEFAULT_CELLS
    }

    fn cost(&self, _: &Problem, grid: &Grid) -> Cost {
        let cells = grid.axes.iter().map(|axis| axis.cells as f64).product::<f64>();
        Cost { what: "flooding", bytes_per_cell: bytes(1), seconds: cells * CELL_SECONDS }
    }

    fn by_products(&self) -> &'static [&'static str] {
        &["landscape", "basins", "watersheds"]
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let landscape = Landscape::compute(problem.pair(), grid_of(self.info(), domain)?, exec)
            .map_err(FloodError::from)?;
        let flooding =
            flood(&landscape, problem.alignment(), &docks(problem.pair(), &landscape.grid), self, exec)?;
        let used = Self { depth_tolerance: Some(flooding.hierarchy.tolerance.depth), ..*self };
        let by_products = ByProducts {
            landscape: Some(landscape),
            basins: Some(flooding.hierarchy),
            watersheds: Some(flooding.watersheds),
            ..ByProducts::default()
        };
        Ok(MethodOutput { by_products, ..MethodOutput::plain(flooding.acceptance, used.settings()) })
    }
}

impl From<FloodError> for DecideError {
    fn from(error: FloodError) -> Self {
        match error {
            FloodError::OutOfBudget(error) | FloodError::Landscape(LandscapeError::OutOfBudget(error)) => {
                Self::OutOfBudget(error)
            }
            FloodError::Cancelled(error) | FloodError::Landscape(LandscapeError::Cancelled(error)) => {
                Self::Cancelled(error)
            }
            error => Self::method(error),
        }
    }
}
