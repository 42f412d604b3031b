//! The kinematic bounds as a method. Their settings follow from the design.

use super::{KinematicError, accept};
use crate::acceptance::{Domain, Outcome};
use crate::contact::Pair;
use crate::design::Design;
use crate::exec::Exec;
use crate::landscape::Grid;
use crate::method::interface::{
    Cost, DecideError, DecisionMethod, Info, MethodOutput, NotApplicable, grid_of,
};
use crate::method::registry::RegistryEntry;
use crate::problem::Problem;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

const INFO: Info = Info {
    name: "kinematic",
    summary: "planar bounds and stepping of the dissertation; v-face, s-face and x-face",
    on_grids: false,
    departs: false,
};

/// Its line in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<Kinematic>(&INFO);

/// The bounds and the stepping of planar faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(in crate::method) struct Kinematic {}

impl DecisionMethod for Kinematic {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn settings(&self) -> Value {
        json!(self)
    }

    fn settings_for(&self, problem: &Problem) -> Value {
        super::KinematicSettings::of(problem.design()).map_or(Value::Null, |settings| json!(settings))
    }

    fn applies_to(&self, design: &Design) -> Result<(), NotApplicable> {
        super::KinematicSettings::of(design)
            .map(|_| ())
            .map_err(|unfit| NotApplicable { method: INFO.name, reason: unfit.to_string() })
    }

    fn default_cells(&self, _: &Pair) -> [usize; 5] {
        [1000, 200, 48, 32, 24]
    }

    fn cost(&self, _: &Problem, grid: &Grid) -> Cost {
        /// Core-seconds per start.
        const START_SECONDS: f64 = 1e-5;
        let cells = grid.axes.iter().map(|axis| axis.cells as f64).product::<f64>();
        Cost {
            what: "the outcome of every cell",
            bytes_per_cell: size_of::<Outcome>() as u64,
            seconds: cells * START_SECONDS,
        }
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let acceptance = accept(problem.design(), grid_of(&INFO, domain)?, exec)?;
        Ok(MethodOutput::plain(acceptance, self.settings_for(problem)))
    }
}

impl From<KinematicError> for DecideError {
    fn from(error: KinematicError) -> Self {
        match error {
            KinematicError::OutOfBudget(error) => Self::OutOfBudget(error),
            KinematicError::Cancelled(error) => Self::Cancelled(error),
            KinematicError::Unfit(unfit) => {
                Self::NotApplicable(NotApplicable { method: INFO.name, reason: unfit.to_string() })
            }
        }
    }
}
