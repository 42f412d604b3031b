//! The polyhedral partition as a method, sampled at the requested poses.

use super::{PartitionError, PartitionSettings, run};
use crate::acceptance::{Domain, Outcome};
use crate::contact::Pair;
use crate::design::Design;
use crate::exec::Exec;
use crate::landscape::{Grid, Resolution};
use crate::method::interface::{
    ByProducts, Cost, DecideError, DecisionMethod, Info, MethodOutput, NotApplicable,
};
use crate::method::registry::RegistryEntry;
use crate::problem::Problem;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

const INFO: Info = Info {
    name: "partition",
    summary: "watersheds of the contact space as polytopes, without a grid; two or three errors",
    on_grids: false,
    departs: false,
};

/// Its line in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<Partitioned>(&INFO);

/// Settings of the partition; unset values follow from the number of free rotations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub(in crate::method) struct Partitioned {
    /// Rotation slices across the error box of every free rotation.
    pub(in crate::method) slices: Option<usize>,
    /// Strips per D into which the moving half is cut.
    pub(in crate::method) strips: Option<usize>,
}

impl Partitioned {
    fn of(&self, design: &Design) -> PartitionSettings {
        let default = PartitionSettings::for_rotations(design.alignment.free.rotations());
        PartitionSettings {
            slices: self.slices.unwrap_or(default.slices),
            strips: self.strips.unwrap_or(default.strips),
        }
    }
}

impl DecisionMethod for Partitioned {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn settings(&self) -> Value {
        json!(self)
    }

    fn settings_for(&self, problem: &Problem) -> Value {
        json!(self.of(problem.design()))
    }

    fn applies_to(&self, design: &Design) -> Result<(), NotApplicable> {
        if design.alignment.free.len() < 2 || design.alignment.free.rotations() == 0 {
            let reason = "it needs at least two free errors, one of them a rotation".to_owned();
            return Err(NotApplicable { method: INFO.name, reason });
        }
        Ok(())
    }

    fn default_cells(&self, _: &Pair) -> [usize; 5] {
        Resolution::DEFAULT_CELLS
    }

    fn cost(&self, problem: &Problem, _: &Grid) -> Cost {
        /// Core-seconds per square of slices and strips, of the planar faces: see the bench of its growth.
        const STRIP_SECONDS: f64 = 1e-5;
        let PartitionSettings { slices, strips } = self.of(problem.design());
        let rotations = problem.alignment().free.rotations() as f64;
        Cost {
            what: "the outcome of every cell",
            bytes_per_cell: size_of::<Outcome>() as u64,
            seconds: STRIP_SECONDS * (slices as f64).powf(rotations) * (strips as f64).powi(2),
        }
    }

    fn by_products(&self) -> &'static [&'static str] {
        &["partition"]
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let settings = self.of(problem.design());
        let partition = run(problem.pair(), &settings, exec)?;
        let acceptance = partition.acceptance(domain.clone(), exec)?;
        let by_products = ByProducts { partition: Some(partition), ..ByProducts::default() };
        Ok(MethodOutput { by_products, ..MethodOutput::plain(acceptance, json!(settings)) })
    }
}

impl From<PartitionError> for DecideError {
    fn from(error: PartitionError) -> Self {
        match error {
            PartitionError::OutOfBudget(error) => Self::OutOfBudget(error),
            PartitionError::Cancelled(error) => Self::Cancelled(error),
            error => Self::method(error),
        }
    }
}
