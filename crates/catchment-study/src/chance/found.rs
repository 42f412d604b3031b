//! What was found.

use super::{Question, Settings};
use crate::success::Stratum;
use catchment_core::acceptance::Outcome;
use catchment_core::landscape::{Grid, GridAxis};
use catchment_core::method::correction::wilson95;
use catchment_core::pose::PoseError;

/// How likely a half docks.
#[derive(Debug, Clone, PartialEq)]
pub struct Chance {
    /// How it was asked for.
    pub settings: Settings,
    /// Each pose, in the order in which they were asked.
    pub poses: Vec<PoseChance>,
    /// The cells of a map.
    pub map: Option<Map>,
    /// Under the errors that are expected.
    pub overall: Option<Overall>,
    /// The same with every velocity multiplied, in ascending order.
    pub curve: Vec<AtSpeed>,
    /// Trials in all.
    pub trials: usize,
}

/// How likely one pose docks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseChance {
    /// The pose.
    pub error: PoseError,
    /// Trials.
    pub trials: usize,
    /// How many of them met each outcome, in the order of [`Outcome::ALL`].
    pub counts: [usize; Outcome::ALL.len()],
    /// Share of the draws that dock by exact quasi-static motion: 0 or 1 where friction does not vary.
    pub quasi_static: f64,
}

/// Cells over one error or two.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// The axes; the first runs fastest.
    pub axes: Vec<GridAxis>,
    /// The centre of each cell.
    pub cells: Vec<PoseChance>,
}

/// How likely a half docks under the errors that are expected.
#[derive(Debug, Clone, PartialEq)]
pub struct Overall {
    /// What kind of errors.
    pub kind: &'static str,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Trials that this took.
    pub trials: usize,
    /// Plain trials of random errors whose interval would be as wide.
    pub plain_trials: f64,
    /// Shares of all errors that meet each outcome, in the order of [`Outcome::ALL`].
    pub shares: [f64; Outcome::ALL.len()],
    /// What was seen of each stratum.
    pub strata: Vec<Stratum>,
    /// Cells of the grid that said where to look.
    pub cells: usize,
    /// Probability by exact quasi-static motions under the same errors and draws of friction, and its 95 % interval.
    pub quasi_static: f64,
    /// See [`Overall::quasi_static`].
    pub quasi_static_ci95: [f64; 2],
    /// Motions that this took.
    pub motions: usize,
}

/// The probability with every velocity multiplied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtSpeed {
    /// By what.
    pub factor: f64,
    /// Mean approach speed then, in D/s.
    pub speed: f64,
    /// Trials that this took.
    pub trials: usize,
    /// Probability of docking.
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

impl Chance {
    /// With every place that an answer has, and numbers that mean nothing: what requirements are tried on.
    pub fn form(asked: &Question, settings: &Settings) -> Self {
        let nothing = [0.0, 1.0];
        let pose =
            |error| PoseChance { error, trials: 1, counts: [0; Outcome::ALL.len()], quasi_static: 0.0 };
        let map = (!asked.map.is_empty()).then(|| {
            let grid = Grid { axes: asked.map.clone() };
            let cells = (0..grid.len()).map(|cell| pose(grid.pose(cell))).collect();
            Map { axes: grid.axes, cells }
        });
        let overall = asked.errors.as_ref().map(|errors| Overall {
            kind: errors.kind(),
            probability: 0.0,
            ci95: nothing,
            trials: 0,
            plain_trials: 0.0,
            shares: [0.0; Outcome::ALL.len()],
            strata: Vec::new(),
            cells: 0,
            quasi_static: 0.0,
            quasi_static_ci95: nothing,
            motions: 0,
        });
        let at = |factor: &f64| AtSpeed {
            factor: *factor,
            speed: 0.0,
            trials: 0,
            probability: 0.0,
            ci95: nothing,
        };
        Self {
            settings: settings.clone(),
            poses: asked.poses.iter().copied().map(pose).collect(),
            map,
            overall,
            curve: asked.times.iter().map(at).collect(),
            trials: 0,
        }
    }
}

impl PoseChance {
    /// How many trials met an outcome.
    pub fn count(&self, outcome: Outcome) -> usize {
        Outcome::ALL.iter().position(|of| *of == outcome).map_or(0, |k| self.counts[k])
    }

    /// Share of the trials that aligned.
    pub fn probability(&self) -> f64 {
        self.count(Outcome::Aligned) as f64 / self.trials.max(1) as f64
    }

    /// Wilson's 95 % interval of it; undecided trials widen it upwards.
    pub fn ci95(&self) -> [f64; 2] {
        let (trials, share) = (self.trials as f64, self.probability());
        let open = (self.count(Outcome::Aligned) + self.count(Outcome::Undecided)) as f64 / trials.max(1.0);
        [wilson95(share, trials)[0], wilson95(open, trials)[1]]
    }

    /// Share of the trials that fare otherwise than most of them: of a pose that has one true end, how often a single trial errs.
    pub fn minority(&self) -> f64 {
        let share = self.probability();
        share.min(1.0 - share)
    }
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
