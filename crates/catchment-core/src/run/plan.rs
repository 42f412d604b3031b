//! Plan of a run, made before poses are decided. If no poses are specified, at most two motions per error
//! test whether the default grid resolves the accepted set.

use super::{Over, Run, RunError, Sample, jams, window};
use crate::acceptance::{Domain, Outcome};
use crate::exec::{Exec, OutOfBudget};
use crate::landscape::{Grid, Landscape, Resolution};
use crate::merit::tolerance::BISECTIONS;
use crate::method::correction::{self, Stop};
use crate::method::{
    Cost, DecisionMethod, Method, affordable, descent, ensure_fits, motions_in, seconds_per_motion,
};
use crate::pose::{DofSet, PoseError};
use crate::problem::Problem;

/// A run on a problem, with everything filled in.
#[derive(Debug, Clone)]
pub struct RunPlan {
    /// Decides the poses.
    pub method: Method,
    /// Which poses.
    pub domain: Domain,
    /// Sampled poses that correct the Sum, if any.
    pub sample: Option<correction::CorrectionSettings>,
    /// Whether the heights are computed even if the method does not need them.
    pub heights: bool,
    /// Cost of the decision.
    pub cost: Cost,
    /// Motions that follow it.
    pub afterwards: Afterwards,
}

/// Motions that follow a decision, if exact motions are possible: their number depends on the halves, and is
/// limited by the time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Afterwards {
    /// Poses along either side of an axis for its limit.
    pub steps: usize,
    /// Number of sampled poses in a box that must contain no failure; as many again, and more, search for
    /// failures.
    pub random: usize,
}

/// Largest part of a time budget for the grid, as a divisor; the samples, which give the Sum, have the rest.
pub(super) const GRID_PART: u32 = 2;

/// Smallest number of cells per axis of a default grid: with an error box four times the tolerance wide two
/// of eight are accepted.
const LEAST_CELLS: usize = 8;
/// Smallest number of cells of a default grid that the accepted set spans on one side of the mated pose,
/// along every axis: with fewer the grid shows almost nothing of it.
const SPANNED: f64 = 1.5;

/// Core-seconds for samples in place of such a grid, and their largest number.
const SAMPLED_SECONDS: f64 = 15.0;
const SAMPLED: usize = 4000;

/// Poses on either side of an axis for the limits of simple halves, of other halves, and if even these would
/// take too long.
const STEPS: f64 = 48.0;
const LEAST_STEPS: f64 = 12.0;
const FEWEST_STEPS: f64 = 4.0;

/// Core-seconds that each of about eight stages may take by default: two minutes on two cores in all. Of a budget each has this share, and no less than some
/// seconds: a budget of seconds on slow halves is exceeded.
const STAGE_SECONDS: f64 = 20.0;
const STAGE_SHARE: f64 = 0.2;
const LEAST_STAGE_SECONDS: f64 = 2.0;

impl Run {
    /// Plan of this run for a problem.
    ///
    /// # Errors
    /// The mated pose is not stable, the method does not apply to the design, its settings are out of range,
    /// or the resolution does not suit the free errors.
    pub fn plan(&self, problem: &Problem) -> Result<RunPlan, RunError> {
        problem.ensure_held()?;
        let pair = problem.pair();
        let within = match self.sample {
            Sample::Until(Stop::Budget(budget)) => self.method.within(budget / GRID_PART),
            _ => None,
        };
        let mut method = within.unwrap_or_else(|| self.method.clone());
        method.check()?;
        method.applies_to(problem.design())?;
        let over = self.resolved(&method, problem)?;
        if over != self.over {
            method = Method::new(method.motions());
        }
        let grid =
            |resolution: &Resolution| resolution.grid(problem.alignment(), &method.default_cells(pair));
        let (domain, cost) = match &over {
            Over::Grid(resolution) => {
                let grid = grid(resolution)?;
                let cost = method.cost(problem, &grid);
                (Domain::Grid(grid), cost)
            }
            Over::Stream(count) => {
                // A pose costs as much as a cell.
                let one = method.cost(problem, &grid(&Resolution::default())?);
                let bytes_per_cell = one.bytes_per_cell + size_of::<PoseError>() as u64;
                let domain = Domain::random(problem.alignment(), *count, self.seed);
                (domain, Cost { bytes_per_cell, ..one })
            }
        };
        let is_grid = matches!(domain, Domain::Grid(_));
        let stop = match self.sample {
            _ if !is_grid => None,
            Sample::None => None,
            Sample::Until(stop) => Some(stop),
            Sample::ByMethod => match method.default_samples(pair) {
                0 => None,
                samples => Some(Stop::Samples(samples)),
            },
        };
        let sample = stop.map(|stop| correction::CorrectionSettings { seed: self.seed, stop });
        let has_heights = method.by_products().contains(&"landscape");
        let heights = self.heights && is_grid && !has_heights;
        let afterwards = self.afterwards(problem, &method, &domain);
        Ok(RunPlan { method, domain, sample, heights, cost, afterwards })
    }

    /// The motions after the decision.
    fn afterwards(&self, problem: &Problem, method: &Method, domain: &Domain) -> Afterwards {
        let pair = problem.pair();
        let seconds = match self.sample {
            Sample::Until(Stop::Budget(budget)) => {
                (STAGE_SHARE * budget.as_secs_f64()).max(LEAST_STAGE_SECONDS)
            }
            _ => STAGE_SECONDS,
        };
        let in_time = motions_in(seconds, pair);
        let sides = 2.0 * problem.alignment().free.len() as f64;
        let steps = (STEPS * affordable(pair).sqrt()).max(LEAST_STEPS);
        let steps_in_time = (in_time as f64 / sides - f64::from(BISECTIONS)).max(FEWEST_STEPS);
        let most = method.motions().default_samples(pair).min(in_time);
        let random = match domain {
            Domain::Poses(poses) => poses.len().min(most),
            Domain::Grid(_) => most,
        };
        Afterwards { steps: steps.min(steps_in_time) as usize, random }
    }

    /// The poses to decide: the requested ones, or random ones if an affordable grid is too coarse to resolve
    /// the accepted set.
    fn resolved(&self, method: &Method, problem: &Problem) -> Result<Over, RunError> {
        let pair = problem.pair();
        let is_sampled =
            method.follows().is_none() && method.default_samples(pair) > 0 && self.sample != Sample::None;
        if self.over != Over::default() || !is_sampled {
            return Ok(self.over);
        }
        let grid = Resolution::default().grid(problem.alignment(), &method.default_cells(pair))?;
        if grid.axes.iter().all(|axis| axis.cells >= LEAST_CELLS) && spans_cells(problem, method, &grid) {
            return Ok(self.over);
        }
        let poses = match self.sample {
            Sample::Until(Stop::Samples(poses)) => return Ok(Over::Stream(poses.max(1))),
            Sample::Until(Stop::Budget(budget)) => motions_in(STAGE_SHARE * budget.as_secs_f64(), pair),
            _ => motions_in(SAMPLED_SECONDS, pair).max(method.default_samples(pair)),
        };
        Ok(Over::Stream(poses.min(SAMPLED)))
    }

    /// Settings of the window: with the proportions of the error box, and the friction of the method.
    pub(crate) fn window_settings(&self) -> window::WindowSettings {
        let friction = self.method.motions().friction;
        window::WindowSettings { seed: self.seed, friction, ..window::WindowSettings::default() }
    }

    /// Settings of the jams: with poses of the same seed and errors, and the friction of the method.
    pub fn jams_settings(&self) -> jams::JamsSettings {
        let friction = self.method.motions().friction;
        jams::JamsSettings {
            seed: self.seed,
            errors: self.errors.clone(),
            friction,
            ..jams::JamsSettings::default()
        }
    }
}

/// Whether the accepted set spans cells enough of a grid along every axis, by exact motions.
fn spans_cells(problem: &Problem, method: &Method, grid: &Grid) -> bool {
    let motions = method.motions();
    let mut follower = descent::Follower::new(problem.pair(), &motions);
    grid.axes.iter().all(|axis| {
        [1.0, -1.0].into_iter().any(|sign| {
            let mut error = [0.0; 5];
            error[axis.dof.index()] = sign * SPANNED * axis.step();
            follower.follow(&PoseError::from_array(error)).outcome == Outcome::Aligned
        })
    })
}

impl RunPlan {
    /// Core-seconds that everything takes, about: the decision and the motions that follow it (Sum, limits, window, seat).
    pub fn seconds(&self, problem: &Problem) -> f64 {
        /// Number of motions of a window, as a multiple of its samples; those of the seat and of the
        /// step-dependence test.
        const WINDOW: f64 = 3.0;
        const OTHERS: f64 = 60.0;
        let pair = problem.pair();
        let samples = self.method.default_samples(pair) as f64;
        let drawn = self.sample.map_or(0.0, |sample| match sample.stop {
            Stop::Samples(samples) => samples as f64,
            _ => samples,
        });
        let decided = match &self.domain {
            Domain::Grid(_) => self.cost.seconds,
            Domain::Poses(poses) => poses.len() as f64 * seconds_per_motion(pair),
        };
        if samples == 0.0 {
            return decided;
        }
        let free = problem.alignment().free;
        // With roll and pitch locked once more.
        let (sides, windows) = if free == DofSet::ALL { (16.0, 2.0) } else { (2.0 * free.len() as f64, 1.0) };
        let Afterwards { steps, random } = self.afterwards;
        let motions = drawn
            + sides * (steps as f64 + f64::from(BISECTIONS))
            + windows * WINDOW * random as f64
            + OTHERS;
        decided + motions * seconds_per_motion(pair)
    }

    /// Rejects a run that does not fit into memory, with sizes that would.
    ///
    /// # Errors
    /// It does not fit.
    pub fn ensure_fits(&self, exec: &Exec) -> Result<(), OutOfBudget> {
        let (cells, axes) = match &self.domain {
            Domain::Grid(grid) => {
                (grid.checked_len().map_or(u64::MAX, |cells| cells as u64), grid.axes.len())
            }
            Domain::Poses(poses) => (poses.len() as u64, 1),
        };
        let per_cell = self.cost.bytes_per_cell + if self.heights { Landscape::bytes(1) } else { 0 };
        ensure_fits(self.cost.what, cells.saturating_mul(per_cell), per_cell, axes, exec)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::SourceText;
    use crate::problem::Draft;
    use serde_json::json;
    use std::time::Duration;

    #[test]
    fn of_a_budget_of_time_a_grid_that_can_end_early_takes_half_at_most() {
        let text =
            "[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n";
        let problem = Draft::read(SourceText::new("v.toml", text)).and_then(Draft::build).unwrap();
        let budget_s = |sample: Sample| {
            let plan = Run { sample, ..Run::default() }.plan(&problem).unwrap();
            plan.method.settings()["budget_s"].clone()
        };
        assert_eq!(budget_s(Sample::Until(Stop::Budget(Duration::from_secs(20)))), json!(10.0));
        assert_eq!(budget_s(Sample::Until(Stop::Samples(20))), json!(null));
        let method: Method = "descent".parse().unwrap();
        let sample = Sample::Until(Stop::Budget(Duration::from_secs(20)));
        let run = Run { method: method.clone(), sample, ..Run::default() };
        assert_eq!(run.plan(&problem).unwrap().method, method);
    }
}
