//! Meyer's flooding as a method: the dissertation's basins, with dams, on the error grid of any design.

use super::{MeyerSettings, accept, bytes};
use crate::acceptance::Domain;
use crate::contact::Pair;
use crate::exec::Exec;
use crate::landscape::{Grid, Landscape, Resolution};
use crate::method::flood::{FloodError, docks};
use crate::method::interface::{ByProducts, Cost, DecideError, DecisionMethod, Info, MethodOutput, grid_of};
use crate::method::registry::RegistryEntry;
use crate::problem::Problem;
use serde_json::{Value, json};

const INFO: Info = Info {
    name: "meyer",
    summary: "the dissertation's flooding by a queue, with dams; biased, made for comparisons",
    on_grids: false,
    departs: true,
};

/// Its line in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<MeyerSettings>(&INFO);

impl MeyerSettings {
    /// These settings with the tolerance of the text as the default.
    fn for_problem(&self, problem: &Problem) -> Self {
        let depth_tolerance = self.depth_tolerance.or(Self::of(problem.design()).depth_tolerance);
        Self { depth_tolerance, ..*self }
    }
}

impl DecisionMethod for MeyerSettings {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn settings(&self) -> Value {
        json!(self)
    }

    fn settings_for(&self, problem: &Problem) -> Value {
        self.for_problem(problem).settings()
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
        /// Core-seconds per cell and neighbour: the queue visits all neighbours.
        const NEIGHBOUR_SECONDS: f64 = 5e-8;
        let cells = grid.axes.iter().map(|axis| axis.cells as f64).product::<f64>();
        let neighbours = 3f64.powf(grid.axes.len() as f64);
        Cost { what: "flooding", bytes_per_cell: bytes(1), seconds: cells * neighbours * NEIGHBOUR_SECONDS }
    }

    fn by_products(&self) -> &'static [&'static str] {
        &["landscape", "watersheds"]
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let landscape =
            Landscape::compute(problem.pair(), grid_of(&INFO, domain)?, exec).map_err(FloodError::from)?;
        let flooding = accept(
            &landscape,
            problem.alignment(),
            &docks(problem.pair(), &landscape.grid),
            &self.for_problem(problem),
            exec,
        )?;
        let used = Self { depth_tolerance: Some(flooding.tolerance.depth), ..*self };
        let by_products = ByProducts {
            landscape: Some(landscape),
            watersheds: Some(flooding.watersheds),
            ..ByProducts::default()
        };
        Ok(MethodOutput { by_products, ..MethodOutput::plain(flooding.acceptance, used.settings()) })
    }
}
