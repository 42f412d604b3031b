//! Results of drop tests.

use super::Settings;
use crate::success::Stratum;
use catchment_core::acceptance::Outcome;
use catchment_core::landscape::GridAxis;
use catchment_core::method::correction::wilson95;
use catchment_core::pose::PoseError;
use catchment_core::poses::{Circumstance, Law};
use serde::{Serialize, Serializer};

/// A number for each outcome, in the order of [`Outcome::ALL`].
pub type ByOutcome<N> = [N; Outcome::ALL.len()];

/// How likely a half docks.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Chance {
    /// The settings.
    pub settings: Settings,
    /// Every declared circumstance with its law.
    pub declared: Vec<Declared>,
    /// How far a half coasts that comes with the mean speed, before damping has taken it, in D; null without speed or damping.
    pub coasting_d: Option<f64>,
    /// The preset that the settings come from, if any.
    pub preset: Option<PresetOpen>,
    /// The probability under the errors that are expected; null where none are.
    pub overall: Option<Overall>,
    /// The same with every velocity multiplied, in ascending order.
    pub curve: Vec<AtSpeed>,
    /// Each pose, in the order of the question.
    pub poses: Vec<PoseChance>,
    /// The cells of a map; null where there is none.
    pub map: Option<Map>,
    /// Trials in all.
    pub trials: usize,
}

/// A circumstance and its law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Declared {
    /// Which.
    pub circumstance: Circumstance,
    /// The unit of its numbers; empty of bare numbers.
    pub unit: &'static str,
    /// Its law.
    pub law: Law,
    /// Share of the law that lies outside of what is possible, and is drawn again, in [0, 1].
    pub cut: f64,
}

/// Settings under a name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PresetOpen {
    /// The name.
    pub name: &'static str,
    /// What its source leaves open.
    pub unknown: Vec<&'static str>,
}

/// How likely one pose docks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PoseChance {
    /// The pose error.
    pub error: PoseError,
    /// Trials.
    pub trials: usize,
    /// Trials by outcome.
    #[serde(serialize_with = "by_outcome")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, usize>"))]
    pub outcomes: ByOutcome<usize>,
    /// Share of the trials that aligned, in [0, 1].
    pub probability: f64,
    /// Wilson's 95 % interval of it; undecided trials widen it upwards.
    pub ci95: [f64; 2],
    /// Share of the draws that dock by exact quasi-static motion: 0 or 1 where friction does not vary.
    pub quasi_static: f64,
    /// Share of the trials that differ from most of them: of a pose that has one true end, how often a single trial errs.
    pub minority: f64,
    /// How often the majority of three such trials would be of the minority: 3E² − 2E³.
    pub majority_of_three: f64,
}

/// Cells over one error or two.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Map {
    /// The axes; the first runs fastest.
    pub axes: Vec<GridAxis>,
    /// The centre of each cell, all other errors 0.
    pub cells: Vec<PoseChance>,
}

/// How likely a half docks under the errors that are expected.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Overall {
    /// `normal`, `uniform` or `measured`.
    pub errors: &'static str,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Trials that this took.
    pub trials: usize,
    /// Plain trials of random errors whose interval would be as wide.
    pub plain_trials: f64,
    /// Share of the errors by outcome, in [0, 1].
    #[serde(serialize_with = "by_outcome")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    pub outcomes: ByOutcome<f64>,
    /// The sample, by stratum.
    pub strata: Vec<Stratum>,
    /// Cells of the quasi-static grid that decided where trials are made most.
    pub grid_cells: usize,
    /// The probability by exact quasi-static motions of the same errors and draws of friction, in [0, 1].
    pub quasi_static: f64,
    /// Its 95 % interval.
    pub quasi_static_ci95: [f64; 2],
    /// Motions that this took, those of the grid included.
    pub motions: usize,
}

/// The probability with every velocity multiplied.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AtSpeed {
    /// By what every velocity is multiplied.
    pub factor: f64,
    /// Mean approach speed then, in D/s.
    pub speed: f64,
    /// Trials that this took.
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
