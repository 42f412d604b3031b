//! Certified sets as a method: it refines its own boxes, and the grid receives their labels.

use super::{CertifiedError, CertifiedSettings, LEAST_BOXES, certify};
use crate::acceptance::Domain;
use crate::contact::{Pair, Seat};
use crate::design::Design;
use crate::exec::Exec;
use crate::landscape::Grid;
use crate::method::descent;
use crate::method::interface::{
    ByProducts, Cost, DecideError, DecisionMethod, Info, MethodOutput, NotApplicable, grid_of,
};
use crate::method::registry::{Method, RegistryEntry};
use crate::problem::Problem;
use serde_json::{Value, json};
use std::time::Duration;

pub(super) const INFO: Info = Info {
    name: "certified",
    summary: "boxes of poses that certainly dock, or certainly do not; the rest is undecided",
    on_grids: false,
    departs: false,
};

/// Its line in the registry.
pub(in crate::method) const ENTRY: RegistryEntry = RegistryEntry::of::<CertifiedSettings>(&INFO);

/// Core-seconds per box, and bytes.
const BOX_SECONDS: f64 = 1e-4;
const BOX_BYTES: u64 = 256;

impl DecisionMethod for CertifiedSettings {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn settings(&self) -> Value {
        json!(self)
    }

    fn check(&self) -> Result<(), DecideError> {
        if !(0.0..=1.0).contains(&self.gap) {
            return Err(DecideError::method(CertifiedError::Gap { gap: self.gap }));
        }
        if let Some(seconds) = self.budget_s.filter(|seconds| !(*seconds > 0.0 && seconds.is_finite())) {
            return Err(DecideError::method(CertifiedError::Budget { seconds }));
        }
        if self.boxes < LEAST_BOXES {
            return Err(DecideError::method(CertifiedError::Boxes { boxes: self.boxes }));
        }
        Ok(())
    }

    fn applies_to(&self, design: &Design) -> Result<(), NotApplicable> {
        let refused = |reason: &str| Err(NotApplicable { method: INFO.name, reason: reason.to_owned() });
        let alignment = &design.alignment;
        if alignment.free.is_empty() {
            return refused("no error is free");
        }
        Ok(())
    }

    fn within(&self, budget: Duration) -> Option<Method> {
        let budget_s = self.budget_s.map_or(budget.as_secs_f64(), |own| own.min(budget.as_secs_f64()));
        Some(Method::new(Self { budget_s: Some(budget_s), ..*self }))
    }

    /// Powers of two: the boxes are halves of halves.
    fn default_cells(&self, _: &Pair) -> [usize; 5] {
        [1024, 128, 32, 16, 8]
    }

    fn cost(&self, _: &Problem, grid: &Grid) -> Cost {
        let cells = grid.axes.iter().map(|axis| axis.cells as f64).product::<f64>();
        let boxes = self.boxes as u64 * BOX_BYTES;
        let bytes_per_cell = 1 + boxes / (cells.max(1.0) as u64);
        Cost { what: "boxes of poses", bytes_per_cell, seconds: self.boxes as f64 * BOX_SECONDS }
    }

    fn by_products(&self) -> &'static [&'static str] {
        &["certificate"]
    }

    fn decide(&self, problem: &Problem, domain: &Domain, exec: &Exec) -> Result<MethodOutput, DecideError> {
        let grid = grid_of(&INFO, domain)?;
        let pair = problem.pair();
        let refused = |reason: &str| NotApplicable { method: INFO.name, reason: reason.to_owned() };
        if Seat::new(pair).is_limited() {
            return Err(refused("it limits what may rest in the seat, which boxes cannot tell").into());
        }
        if Seat::new(pair).leaks() {
            return Err(refused(
                "the rim of its seat is lower than docked.depth, so that what is seated need not stay: give a smaller depth",
            )
            .into());
        }
        if !descent::all_count(pair) {
            return Err(
                refused("its mated pose does not hold, so that what is seated need not be docked").into()
            );
        }
        let certified = certify(pair, self, exec)?;
        let acceptance = certified.acceptance(grid, exec)?;
        let by_products = ByProducts { certificate: Some(certified.certificate), ..ByProducts::default() };
        Ok(MethodOutput { by_products, ..MethodOutput::plain(acceptance, self.settings()) })
    }
}

impl From<CertifiedError> for DecideError {
    fn from(error: CertifiedError) -> Self {
        match error {
            CertifiedError::Cancelled(error) => Self::Cancelled(error),
            error => Self::method(error),
        }
    }
}
