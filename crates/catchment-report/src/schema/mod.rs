//! The report of a run: a versioned contract. Lengths in D, angles in radians, fields in this order, in the
//! [`ReportEnvelope`] of every report. The same run writes the same bytes except for `timing`.

use super::envelope::{ReportBody, ReportEnvelope};
use catchment_core::acceptance::Acceptance;
use catchment_core::design::Design;
use catchment_core::exec::Exec;
use catchment_core::merit::centered::CenteredBox;
use catchment_core::merit::onaa::Onaa;
use catchment_core::merit::success::{Distribution, SuccessProbability, success};
use catchment_core::merit::sum::Sum;
use catchment_core::merit::tolerance::Tolerance;
use catchment_core::merit::{MeritError, Merits};
use catchment_core::method::certified::BoxCertificate;
use catchment_core::method::confluence::InheritedLabels;
use catchment_core::pose::{Dof, ErrorUnit};
use catchment_core::run::jams::Jams;
use catchment_core::run::window::{HalfWidths, ToleranceWindow, WindowDetails};
use catchment_core::run::{Seating, Upright};
use serde::{Deserialize, Serialize};

/// The complete report of a run, with its head.
pub type Report = ReportEnvelope<RunBody>;

/// Result of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RunBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// Name of the method that decided the outcomes.
    pub method: String,
    /// The settings of the method.
    pub settings: serde_json::Value,
    /// The axes of the error grid, the first one fastest; empty for listed poses.
    pub axes: Vec<AxisReport>,
    /// The accepted set.
    pub acceptance: AcceptanceReport,
    /// The largest axis-oriented cube; null for listed poses.
    pub onaa: Option<Onaa>,
    /// The largest cube around zero; null for listed poses.
    pub centered: Option<CenteredBox>,
    /// Single-axis limits of each error; empty for listed poses.
    pub tolerances: Vec<Tolerance>,
    /// Figures of merit with roll and pitch locked, if all five errors are free and motions were followed;
    /// null if not, and in reports of older versions.
    #[serde(default)]
    pub upright: Option<Upright>,
    /// Success probability for the given errors; null if no errors were given.
    pub success: Option<SuccessProbability>,
    /// The basins behind the outcomes; null for methods without basins.
    pub basins: Option<BasinsReport>,
    /// The watersheds behind the outcomes, before and after merging; null for methods without flooding, and
    /// in reports of older versions.
    #[serde(default)]
    pub watersheds: Option<WatershedsReport>,
    /// The polytopes behind the outcomes; null for all methods but `partition`.
    pub partition: Option<PartitionReport>,
    /// Certified shares of the error box and certified retention; null for all methods but `certified`, and
    /// in reports of older versions.
    #[serde(default)]
    pub certificate: Option<BoxCertificate>,
    /// Number of cells with an inherited label, and how often it was wrong; null for all methods but
    /// `confluence`, and in reports of older versions.
    #[serde(default, alias = "joined")]
    pub inherited: Option<InheritedLabels>,
    /// Rests outside the seat; null if not requested, and in reports of older versions.
    #[serde(default)]
    pub jams: Option<Jams>,
    /// The tolerance window; null if not requested, if there is no window, and in reports of older versions.
    #[serde(default)]
    pub window: Option<WindowSection>,
    /// The seat, and the residual misalignment of accepted poses; null in reports of older versions.
    #[serde(default)]
    pub seat: Option<Seating>,
}

/// A window in the report of a run: its half-widths by name, and its details.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WindowSection {
    /// Half-width of every free error, by its name, in D and radians.
    #[serde(flatten)]
    pub half_widths: HalfWidths,
    /// The settings of the search and all its other results.
    #[serde(flatten)]
    pub details: WindowDetails,
}

impl From<&ToleranceWindow> for WindowSection {
    fn from(window: &ToleranceWindow) -> Self {
        Self { half_widths: window.window.clone(), details: window.details.clone() }
    }
}

impl ReportBody for RunBody {
    const KIND: &'static str = "run";
}

/// One axis of the error grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AxisReport {
    /// The error.
    pub axis: Dof,
    /// `D` or `rad`.
    pub unit: ErrorUnit,
    /// Lower border of the error box.
    pub lo: f64,
    /// Upper border of the error box.
    pub hi: f64,
    /// Number of equal cells, each sampled at its centre.
    pub cells: usize,
}

/// Measures of the accepted set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AcceptanceReport {
    /// The Sum, in `unit`: the unbiased estimate if there is a `sample`, the certified measure if there is a
    /// `certificate`, else `sum_grid`.
    pub sum: f64,
    /// Unit of `sum`, like `D²·rad³`.
    pub unit: String,
    /// 95 % interval of the true measure, from the poses of `sample` or from listed poses sampled at random.
    /// Null without samples.
    pub sum_ci95: Option<[f64; 2]>,
    /// Measure of the accepted cells; for listed poses, their share of the error box.
    pub sum_grid: f64,
    /// With a `certificate`: the certified measure, and that plus the undecided measure. Without: `sum_grid`
    /// minus the accepted cells that touch a rejected cell, and plus the rejected cells that touch an
    /// accepted cell. This is the uncertainty of the resolution, not a confidence interval. Null for listed
    /// poses.
    pub sum_bracket: Option<[f64; 2]>,
    /// `sum` as a share of the error box, in [0, 1].
    pub fraction: f64,
    /// Number of cells or poses decided.
    pub cells: usize,
    /// Number of cells or poses with each outcome.
    pub outcomes: Outcomes,
    /// Sampled poses, followed exactly, that correct the Sum; null without samples.
    pub sample: Option<SampleReport>,
}

/// Poses per outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Outcomes {
    /// Docked: contact brings the halves to the mated pose.
    pub aligned: usize,
    /// The moving half rests in contact outside the seat.
    pub jammed: usize,
    /// The halves never touch, or the moving half slides off.
    pub missed: usize,
    /// The step budget ended before the motion did.
    pub undecided: usize,
}

/// Time of the computation. Only this part of a report differs between equal runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Timing {
    /// Wall-clock time of the computation, in seconds.
    pub total_s: f64,
    /// Worker threads.
    pub threads: usize,
}

impl RunBody {
    /// A number among the settings of the method, or of the motions that it follows.
    pub(super) fn of_motions(&self, name: &str) -> Option<f64> {
        self.settings.get(name).or_else(|| self.settings.get("descent")?.get(name))?.as_f64()
    }

    /// Friction coefficient of the motions that decided; 0 for methods without friction.
    pub fn friction(&self) -> f64 {
        self.of_motions("friction").unwrap_or(0.0)
    }
}

impl Report {
    /// Evaluates an acceptance. `settings` are those of its method. The warnings of the accepted set itself
    /// are added to those of the method.
    ///
    /// # Errors
    /// If the figures of merit do not fit into memory, or are cancelled.
    pub fn new(
        design: &Design,
        acceptance: &Acceptance,
        settings: serde_json::Value,
        timing: Option<Timing>,
        exec: &Exec,
    ) -> Result<Self, MeritError> {
        let merits = Merits::of(acceptance, &design.alignment, exec)?;
        Ok(Self::from_merits(design, acceptance, &merits, settings, timing))
    }

    /// The same of an acceptance that was evaluated.
    pub fn from_merits(
        design: &Design,
        acceptance: &Acceptance,
        merits: &Merits,
        settings: serde_json::Value,
        timing: Option<Timing>,
    ) -> Self {
        let Merits { sum, bracket, onaa, centered, tolerances, warnings } = merits.clone();
        let body = RunBody {
            design: design.clone(),
            method: acceptance.method.to_owned(),
            settings,
            axes: axes(acceptance),
            acceptance: AcceptanceReport { sum_bracket: bracket, ..AcceptanceReport::from(sum) },
            onaa,
            centered,
            tolerances,
            upright: None,
            success: None,
            basins: None,
            watersheds: None,
            partition: None,
            certificate: None,
            inherited: None,
            jams: None,
            window: None,
            seat: None,
        };
        ReportEnvelope::of(body, warnings, timing)
    }

    /// Adds the success probability for a distribution of errors.
    ///
    /// # Errors
    /// Those of [`success()`].
    pub fn with_success(
        mut self,
        acceptance: &Acceptance,
        distribution: &Distribution,
        exec: &Exec,
    ) -> Result<Self, MeritError> {
        self.success = Some(success(acceptance, distribution, exec)?);
        Ok(self)
    }
}

/// The axes of its grid.
pub(super) fn axes(acceptance: &Acceptance) -> Vec<AxisReport> {
    let Some(grid) = acceptance.grid() else { return Vec::new() };
    grid.axes
        .iter()
        .map(|a| AxisReport { axis: a.dof, unit: ErrorUnit::of(a.dof), lo: a.lo, hi: a.hi, cells: a.cells })
        .collect()
}

impl From<Sum> for AcceptanceReport {
    fn from(sum: Sum) -> Self {
        Self {
            sum: sum.sum,
            unit: sum.unit(),
            sum_ci95: sum.ci95,
            sum_grid: sum.sum,
            sum_bracket: None,
            fraction: sum.fraction,
            cells: sum.tried,
            outcomes: Outcomes::new(sum.counts),
            sample: None,
        }
    }
}

impl Outcomes {
    /// From counts in the order of [`Outcome::ALL`].
    const fn new([aligned, jammed, missed, undecided]: [usize; 4]) -> Self {
        Self { aligned, jammed, missed, undecided }
    }
}

pub(crate) mod basins;
mod partition;
mod sample;
mod sound;
#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
mod watersheds;

pub use basins::{BasinReport, BasinsReport, LISTED, SMALLEST_STEP, ToleranceStepReport};
pub use partition::PartitionReport;
pub use sample::SampleReport;
pub use sound::UnsoundError;
pub use watersheds::WatershedsReport;
