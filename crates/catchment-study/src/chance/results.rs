//! Results of drop tests.

use super::ChanceSettings;
use crate::success::ErrorStratum;
use catchment_core::acceptance::Outcome;
use catchment_core::landscape::GridAxis;
use catchment_core::method::correction::wilson95;
use catchment_core::pose::PoseError;
use catchment_core::poses::{Circumstance, ScalarDistribution};
use serde::{Serialize, Serializer};

/// A number for each outcome, in the order of [`Outcome::ALL`].
pub type ByOutcome<N> = [N; Outcome::ALL.len()];

/// Docking probability under dynamics.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Chance {
    /// The settings.
    pub settings: ChanceSettings,
    /// Every declared parameter with its distribution.
    pub declared: Vec<DeclaredCircumstance>,
    /// Distance that a half with the mean speed coasts until damping stops it, in D; null without speed or
    /// damping.
    pub coasting_d: Option<f64>,
    /// The preset that the settings come from, if any.
    pub preset: Option<PresetOpen>,
    /// Docking probability under the expected errors; null if no errors were given.
    pub overall: Option<Overall>,
    /// Docking probability with every velocity multiplied by a factor, in ascending order of the factor.
    pub curve: Vec<AtSpeed>,
    /// Results for each pose, in the order of the input.
    pub poses: Vec<PoseChance>,
    /// The cells of a map; null without a map.
    pub map: Option<ChanceMap>,
    /// Number of trials in total.
    pub trials: usize,
}

/// A dynamic parameter and its distribution.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DeclaredCircumstance {
    /// The parameter.
    pub circumstance: Circumstance,
    /// Unit of its values; empty if they have no unit.
    pub unit: &'static str,
    /// Its distribution.
    pub law: ScalarDistribution,
    /// Share of the distribution outside the possible range, in [0, 1]; such values are drawn again.
    pub cut: f64,
}

/// A named set of settings.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PresetOpen {
    /// The name.
    pub name: &'static str,
    /// Values that its source leaves open.
    pub unknown: Vec<&'static str>,
}

/// Docking probability of a pose.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PoseChance {
    /// The pose error.
    pub error: PoseError,
    /// Number of trials.
    pub trials: usize,
    /// Number of trials by outcome.
    #[serde(serialize_with = "by_outcome")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, usize>"))]
    pub outcomes: ByOutcome<usize>,
    /// Share of the trials that docked, in [0, 1].
    pub probability: f64,
    /// Wilson's 95 % interval of that share; undecided trials widen it upwards.
    pub ci95: [f64; 2],
    /// Share of the draws that dock by exact quasi-static motion: 0 or 1 if friction does not vary.
    pub quasi_static: f64,
    /// Share of the trials whose outcome differs from the most frequent outcome; the error rate of a single
    /// trial for a pose with a single true outcome.
    pub minority: f64,
    /// Error rate of the majority of three such trials: 3E² − 2E³ for an error rate E.
    pub majority_of_three: f64,
}

/// Cells over one or two errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ChanceMap {
    /// The axes; the first runs fastest.
    pub axes: Vec<GridAxis>,
    /// Results at the centre of each cell, with all other errors 0.
    pub cells: Vec<PoseChance>,
}

/// Docking probability under the expected errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Overall {
    /// `normal`, `uniform` or `measured`.
    pub errors: &'static str,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Number of trials behind it.
    pub trials: usize,
    /// Effective sample size: number of plain trials of random errors whose interval would be as wide.
    pub plain_trials: f64,
    /// Share of the errors by outcome, in [0, 1].
    #[serde(serialize_with = "by_outcome")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    pub outcomes: ByOutcome<f64>,
    /// The sample, by stratum.
    pub strata: Vec<ErrorStratum>,
    /// Cells of the quasi-static grid that allocates the trials to strata.
    pub grid_cells: usize,
    /// Probability by exact quasi-static motions of the same errors and friction draws, in [0, 1].
    pub quasi_static: f64,
    /// Its 95 % interval.
    pub quasi_static_ci95: [f64; 2],
    /// Number of motions behind it, including those of the grid.
    pub motions: usize,
}

/// Docking probability with every velocity multiplied by a factor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AtSpeed {
    /// Factor on every velocity.
    pub factor: f64,
    /// Mean approach speed with this factor, in D/s.
    pub speed: f64,
    /// Number of trials behind it.
    pub trials: usize,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

impl PoseChance {
    /// The trials of a pose by their outcomes, beside the share that docks by exact motion.
    pub(super) fn of(error: PoseError, outcomes: ByOutcome<usize>, quasi_static: f64) -> Self {
        let trials: usize = outcomes.iter().sum();
        let [aligned, undecided] = [Outcome::Aligned, Outcome::Undecided].map(|of| outcomes[place(of)]);
        let all = trials.max(1) as f64;
        let probability = aligned as f64 / all;
        let open = (aligned + undecided) as f64 / all;
        let minority = probability.min(1.0 - probability);
        Self {
            error,
            trials,
            outcomes,
            probability,
            ci95: [wilson95(probability, trials as f64)[0], wilson95(open, trials as f64)[1]],
            quasi_static,
            minority,
            majority_of_three: majority_of_three(minority),
        }
    }
}

/// The place of an outcome in [`Outcome::ALL`].
pub(super) fn place(outcome: Outcome) -> usize {
    Outcome::ALL.iter().position(|of| *of == outcome).unwrap_or_default()
}

/// The numbers under the names of the outcomes.
fn by_outcome<N: Serialize, S: Serializer>(values: &ByOutcome<N>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(Outcome::ALL.iter().map(|outcome| outcome.name()).zip(values))
}

/// How often the majority of three independent trials errs, each of which errs with probability `single`: 3E² − 2E³. The dissertation
/// repeats every trial for it, because its engine erred in 0.08 % near the border.
///
/// # Examples
/// ```
/// # use catchment_study::chance::majority_of_three;
/// assert!((majority_of_three(0.0008) - 1.92e-6).abs() < 2e-9);
/// ```
pub fn majority_of_three(single: f64) -> f64 {
    single * single * (3.0 - 2.0 * single)
}
