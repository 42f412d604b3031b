//! The basins of a flooded landscape: its equilibria, their depths, and the effect of the tolerance.

use super::Report;
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::method::flood::{Choice, Hierarchy};
use catchment_core::pose::PoseError;
use serde::{Deserialize, Serialize};

/// Basins of a flooded landscape. Depths and heights in D.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BasinsReport {
    /// Depth below which basins were merged, and the reason for it.
    pub tolerance: Choice,
    /// Minima before merging.
    pub minima: usize,
    /// Basins after merging.
    pub merged: usize,
    /// The basins after merging with the most cells, largest first, at most [`LISTED`].
    pub largest: Vec<BasinReport>,
    /// The accepted set for every tolerance: each step holds for tolerances above its own, up to that of the
    /// next step. Steps that change the accepted set by less than [`SMALLEST_STEP`] of the error box are left
    /// out.
    pub staircase: Vec<ToleranceStepReport>,
}

/// How many basins are listed.
pub const LISTED: usize = 100;
/// Steps of the staircase below this share of the error box are left out.
pub const SMALLEST_STEP: f64 = 1e-3;

/// A basin after merging.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BasinReport {
    /// Outcome of its poses.
    pub outcome: Outcome,
    /// The pose error of its lowest cell.
    pub minimum: PoseError,
    /// Height of its lowest cell; null without contact.
    pub height: Option<f64>,
    /// Height that the water must rise to reach a lower minimum; null if no minimum is lower.
    pub depth: Option<f64>,
    /// Height that the water must rise to overflow into any other basin; null without contact, or for a
    /// single basin.
    pub escape: Option<f64>,
    /// Cells that drain to it.
    pub cells: usize,
    /// Their share of the error box.
    pub fraction: f64,
}

/// A step of the accepted share as a function of the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ToleranceStepReport {
    /// The step holds for tolerances above this.
    pub above: f64,
    /// Accepted cells.
    pub cells: usize,
    /// Their measure, in the unit of the Sum.
    pub sum: f64,
    /// Their share of the error box.
    pub fraction: f64,
}

impl BasinsReport {
    /// The basins behind an acceptance over a grid; nothing for listed poses.
    pub fn new(acceptance: &Acceptance, hierarchy: &Hierarchy) -> Option<Self> {
        let grid = acceptance.grid()?;
        let cells = grid.len();
        let share = |part: usize| part as f64 / cells as f64;
        let finite = |value: f64| value.is_finite().then_some(value);
        let largest = hierarchy.basins.iter().take(LISTED).map(|basin| BasinReport {
            outcome: basin.outcome,
            minimum: grid.pose(basin.minimum),
            height: finite(basin.height),
            depth: finite(basin.depth),
            escape: finite(basin.escape),
            cells: basin.cells,
            fraction: share(basin.cells),
        });
        let mut staircase: Vec<ToleranceStepReport> = Vec::new();
        for step in &hierarchy.staircase {
            let fraction = share(step.cells);
            // To nothing at all is a step of its own, however small.
            let changes = |last: &ToleranceStepReport| {
                (fraction - last.fraction).abs() >= SMALLEST_STEP || (last.cells == 0) != (step.cells == 0)
            };
            if staircase.last().is_none_or(changes) {
                let sum = step.cells as f64 * grid.cell_measure();
                staircase.push(ToleranceStepReport { above: step.above, cells: step.cells, sum, fraction });
            }
        }
        Some(Self {
            tolerance: hierarchy.tolerance,
            minima: hierarchy.tree.minima.len(),
            merged: hierarchy.basins.len(),
            largest: largest.collect(),
            staircase,
        })
    }
}

impl Report {
    /// Adds the basins behind an acceptance over a grid.
    #[must_use]
    pub fn with_basins(mut self, acceptance: &Acceptance, hierarchy: &Hierarchy) -> Self {
        self.basins = BasinsReport::new(acceptance, hierarchy);
        self
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::super::testing::design;
    use super::*;
    use catchment_core::design::Design;
    use catchment_core::exec::Exec;
    use catchment_core::landscape::{Grid, Landscape};
    use catchment_core::method::flood::{FloodSettings, Flooding, ToleranceReason, flood};
    use catchment_core::pose::Dof;

    /// A mated valley, two jams beside it, one of them shallow, and nothing beyond.
    pub(crate) fn flooded() -> (Design, Flooding) {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let grid = Grid::over(&design.alignment, |_| 61);
        let height = |index: usize| {
            let e = grid.pose(index);
            let valley =
                |x: f64, pitch: f64, floor: f64| floor + (e.x - x).abs() + 0.4 * (e.pitch - pitch).abs();
            let ripple = 0.05 * (40.0 * e.x + 11.0 * e.pitch).sin();
            let lowest = valley(0.0, 0.0, 0.0).min(valley(0.55, -0.9, 0.1)).min(valley(-0.4, 0.9, 0.42));
            if e.x.abs() > 0.9 { f32::NEG_INFINITY } else { (lowest + ripple) as f32 }
        };
        let heights = (0..grid.len()).map(height).collect();
        let landscape = Landscape { grid, heights };
        let flooding =
            flood(&landscape, &design.alignment, &|_| true, &FloodSettings::default(), &Exec::new()).unwrap();
        (design, flooding)
    }

    #[test]
    fn the_report_lists_basins_and_steps_and_reads_back() {
        let (design, Flooding { acceptance, hierarchy, .. }) = flooded();
        let report = Report::new(&design, &acceptance, serde_json::Value::Null, None, &Exec::new()).unwrap();
        assert_eq!(report.basins, None);
        let report = report.with_basins(&acceptance, &hierarchy);
        assert_eq!(Report::from_json(&report.to_json().unwrap()).unwrap(), report);
        let basins = report.basins.clone().unwrap();
        assert!(matches!(basins.tolerance.reason, ToleranceReason::WidestGap { .. }));
        assert_eq!(basins.largest.iter().map(|b| b.cells).sum::<usize>(), acceptance.outcomes.len());
        assert!(basins.minima >= basins.merged);
        let mated = basins.largest.iter().find(|b| b.outcome == Outcome::Aligned).unwrap();
        assert_eq!(mated.cells, acceptance.counts()[0]);
        let used = basins.tolerance.depth;
        let step = basins.staircase.iter().rfind(|s| s.above < used).unwrap();
        assert!((step.fraction - mated.fraction).abs() < SMALLEST_STEP);
        assert!(
            (step.sum - report.acceptance.sum).abs() < SMALLEST_STEP * report.acceptance.sum / mated.fraction
        );
    }
}
