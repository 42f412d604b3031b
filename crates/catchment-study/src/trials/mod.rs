//! Trials compared with the exact region: the disagreement of a method that follows single poses with the
//! zero-rotation area of acceptance.
//!
//! ```text
//!   exact (zraa)          trials, one per cell, anywhere in it      disagreeing area = share of trials that
//!      ╱╲                 ○ ○ ○ ● ○ ○                               lie on the wrong side × the error box
//!     ╱  ╲                ○ ○ ● ● ● ○                               95 % interval: Wilson's, conservative for a
//!     ╲  ╱                ○ ○ ○ ● ○ ○                               stratified sample
//!      ╲╱
//! ```
//!
//! Every cell of an n × n grid over the error box has one trial, at a position sampled uniformly in it, so
//! the share is unbiased. Rotations are locked; the dissertation did this by inertia. Finer grids narrow the
//! interval; half the time step changes the disagreement itself: the engine lets halves overlap by their
//! motion within a step.
//!
//! Not promised: that the exact region is correct if the trials agree; both use the same halves and the same
//! seat.
//!
//! Source: dissertation, section 4.2.2 and figure 4.4.

mod report;

use catchment_core::acceptance::{Domain, Outcome, Stream};
use catchment_core::exec::{Cancelled, Exec, OutOfBudget};
use catchment_core::landscape::{Grid, Resolution};
use catchment_core::merit::sum::wilson95;
use catchment_core::method::zraa::{self, Zraa, ZraaError};
use catchment_core::method::{DecideError, Method, MethodError};
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;
use glam::DVec2;
use serde::Serialize;
use serde_json::{Map, Value, json};

/// Settings that change the result.
#[derive(Debug, Clone)]
pub struct TrialsSettings {
    /// Method that decides single poses.
    pub method: Method,
    /// Number of trials along every free translation, for each study.
    pub resolutions: Vec<usize>,
    /// Number of halvings of the time step, for methods with a time step.
    pub halvings: u32,
    /// Seed of the places in the cells.
    pub seed: u64,
}

/// Trials at a resolution and time step.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Round {
    /// Number of trials along every free translation.
    pub resolution: usize,
    /// Time step in s; null for a method without a time step.
    pub timestep: Option<f64>,
    /// Number of trials.
    pub trials: usize,
    /// Number of trials in the exact region that do not dock.
    pub rejected_inside: usize,
    /// Number of trials outside the exact region that dock.
    pub accepted_outside: usize,
    /// Number of trials that still move when the time is up; they count as failures.
    pub undecided: usize,
    /// Share of the error box over which the trials contradict the exact region, in [0, 1].
    pub disagreeing: f64,
    /// Its 95 % confidence interval.
    pub disagreeing_ci95: [f64; 2],
    /// The disagreement as a measure, in `unit`.
    pub measure: f64,
    /// Its 95 % confidence interval.
    pub measure_ci95: [f64; 2],
    /// Measure of the offsets that dock in the trials, in `unit`.
    pub accepted: f64,
}

/// A trial of the last round, with rotations 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RoundTrial {
    /// Offset in x at its start, in D.
    pub x: f64,
    /// Offset in y at its start, in D.
    pub y: f64,
    /// Its outcome.
    pub outcome: Outcome,
    /// Whether it starts in the exact region.
    pub inside: bool,
}

/// Comparison of trials with the exact region.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Trials {
    /// Name of the method that decides the trials.
    pub method: &'static str,
    /// Its settings, with the time step of the first rounds.
    pub settings: Value,
    /// Seed of the positions within the cells.
    pub seed: u64,
    /// `D` or `D²`: the unit of all measures.
    pub unit: &'static str,
    /// Measure of the exact region, in `unit`.
    pub exact: f64,
    /// Rounds by resolution and time step, in this order.
    pub rounds: Vec<Round>,
    /// The trials of the last round, in the order of the cells.
    pub trials: Vec<RoundTrial>,
    /// The exact region.
    #[serde(skip)]
    pub zraa: Zraa,
    /// The grid of the last round.
    #[serde(skip)]
    pub grid: Grid,
}

/// Reason why trials are not possible.
#[derive(Debug, thiserror::Error)]
pub enum TrialsError {
    /// Something turns.
    #[error("rotations are free, and the exact region is that of translation alone: free x, y or both")]
    Rotations,
    /// The method cannot decide single poses.
    #[error("{method} does not decide single poses")]
    Method {
        /// Which.
        method: &'static str,
    },
    /// The method has no time step.
    #[error("{method} has no time step to halve")]
    NoTimestep {
        /// Which.
        method: &'static str,
    },
    /// No grid, or too fine a grid.
    #[error("{given} trials along an axis are none of {least} to {most}")]
    Resolution {
        /// The given value.
        given: usize,
        /// The least.
        least: usize,
        /// The most.
        most: usize,
    },
    /// More halvings than a step can take.
    #[error("the time step can be halved {most} times, not {given}")]
    Halvings {
        /// The given value.
        given: u32,
        /// The most.
        most: u32,
    },
    /// There is no exact region.
    #[error(transparent)]
    Zraa(#[from] ZraaError),
    /// The method refuses.
    #[error(transparent)]
    Decide(#[from] DecideError),
    /// A setting of the method.
    #[error(transparent)]
    Setting(#[from] MethodError),
    /// Too many trials for the memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Least and most trials along an axis: hours of an engine.
const RESOLUTION: [usize; 2] = [Resolution::LEAST, 1000];
/// Most halvings: a thousandth of the step, a thousand times the time.
const HALVINGS: u32 = 10;
/// Bytes per trial besides those of the method.
const TRIAL_BYTES: u64 = size_of::<RoundTrial>() as u64 + super::pose_bytes();

/// Computes the exact region and runs the method at every resolution, and at the finest with every time step.
///
/// # Errors
/// See [`TrialsError`].
pub fn run(problem: &Problem, settings: &TrialsSettings, exec: &Exec) -> Result<Trials, TrialsError> {
    let alignment = problem.alignment();
    if alignment.free.rotations() > 0 {
        return Err(TrialsError::Rotations);
    }
    let name = settings.method.name();
    settings.method.follows().ok_or(TrialsError::Method { method: name })?;
    let [least, most] = RESOLUTION;
    if let Some(&given) = settings.resolutions.iter().find(|n| !(least..=most).contains(n)) {
        return Err(TrialsError::Resolution { given, least, most });
    }
    if settings.halvings > HALVINGS {
        return Err(TrialsError::Halvings { given: settings.halvings, most: HALVINGS });
    }
    let step = settings.method.settings().get("timestep").and_then(Value::as_f64);
    if settings.halvings > 0 && step.is_none() {
        return Err(TrialsError::NoTimestep { method: name });
    }
    let finest = settings.resolutions.iter().copied().max().unwrap_or(least);
    let trials = (finest as u64).saturating_pow(alignment.free.len() as u32);
    exec.ensure_fits("the trials", trials.saturating_mul(TRIAL_BYTES), |_| {
        vec![catchment_core::diagnostic::Advice::CoarserGrid]
    })?;
    let zraa = zraa::run(problem.pair(), &zraa::ZraaSettings::default(), exec)?;
    let coarse = settings.resolutions.iter().map(|resolution| (*resolution, 0));
    let rounds: Vec<(usize, u32)> = coarse.chain((1..=settings.halvings).map(|k| (finest, k))).collect();
    let (mut result, mut last) = (Vec::new(), None);
    for (k, &(resolution, halvings)) in rounds.iter().enumerate() {
        let ends = [k, k + 1].map(|k| k as f64 / rounds.len() as f64);
        let part = exec.part(ends, "trials");
        let timestep = step.map(|step| step / f64::from(1u32 << halvings));
        let method = match timestep.filter(|_| halvings > 0) {
            Some(step) => settings.method.with(&changed(step))?,
            None => settings.method.clone(),
        };
        let grid = Grid::over(alignment, |_| resolution);
        let trials = trials_of(problem, &zraa, &method, &grid, settings.seed, &part)?;
        result.push(Round { timestep, ..counted(resolution, &grid, &trials) });
        last = Some((grid, trials));
    }
    let (grid, last) = last.unwrap_or_else(|| (Grid::over(alignment, |_| least), Vec::new()));
    Ok(Trials {
        method: name,
        settings: settings.method.settings(),
        seed: settings.seed,
        unit: if grid.axes.len() == 2 { "D²" } else { "D" },
        exact: measure(&zraa),
        rounds: result,
        trials: last,
        zraa,
        grid,
    })
}

fn changed(step: f64) -> Map<String, Value> {
    Map::from_iter([("timestep".to_owned(), json!(step))])
}

/// D or D² of a region.
fn measure(zraa: &Zraa) -> f64 {
    match zraa {
        Zraa::Interval { from, to, .. } => to - from,
        Zraa::Region { area, .. } => *area,
    }
}

/// A trial at a random position of every cell.
fn trials_of(
    problem: &Problem,
    zraa: &Zraa,
    method: &Method,
    grid: &Grid,
    seed: u64,
    exec: &Exec,
) -> Result<Vec<RoundTrial>, TrialsError> {
    let stream = Stream::new(seed);
    let error = |cell: usize| {
        let mut place = grid.pose(cell).to_array();
        for (k, axis) in grid.axes.iter().enumerate() {
            let aside = stream.branch(k as u64).uniform(cell as u64) - 0.5;
            place[axis.dof.index()] += aside * axis.step();
        }
        PoseError::from_array(place)
    };
    let errors: Vec<PoseError> = (0..grid.len()).map(error).collect();
    let follow = method.follows().ok_or(TrialsError::Method { method: method.name() })?;
    let (acceptance, _) = follow.follow(problem, Domain::Poses(errors.clone()), exec)?;
    let trial = |(error, outcome): (PoseError, &Outcome)| RoundTrial {
        x: error.x,
        y: error.y,
        outcome: *outcome,
        inside: zraa.holds(DVec2::new(error.x, error.y)),
    };
    Ok(errors.into_iter().zip(&acceptance.outcomes).map(trial).collect())
}

/// Results of the trials of a grid.
fn counted(resolution: usize, grid: &Grid, trials: &[RoundTrial]) -> Round {
    let aligned = |trial: &RoundTrial| trial.outcome == Outcome::Aligned;
    let count = |which: &dyn Fn(&RoundTrial) -> bool| trials.iter().filter(|trial| which(trial)).count();
    let rejected_inside = count(&|trial| trial.inside && !aligned(trial));
    let accepted_outside = count(&|trial| !trial.inside && aligned(trial));
    let (wrong, all) = (rejected_inside + accepted_outside, trials.len());
    let (whole, share) = (grid.measure(), |count: usize| count as f64 / all.max(1) as f64);
    let ci95 = wilson95(wrong, all);
    Round {
        resolution,
        timestep: None,
        trials: all,
        rejected_inside,
        accepted_outside,
        undecided: count(&|trial| trial.outcome == Outcome::Undecided),
        disagreeing: share(wrong),
        disagreeing_ci95: ci95,
        measure: share(wrong) * whole,
        measure_ci95: ci95.map(|end| end * whole),
        accepted: share(count(&|trial| aligned(trial))) * whole,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::problem;
    use catchment_core::design::Family;
    use catchment_core::pose::{Dof, DofSet};

    const XY: DofSet = DofSet::EMPTY.with(Dof::X).with(Dof::Y);

    fn settings(method: &str, resolutions: &[usize]) -> TrialsSettings {
        let method = method.parse().unwrap();
        TrialsSettings { method, resolutions: resolutions.to_vec(), halvings: 0, seed: 1 }
    }

    /// Exact motions and the exact region give the same set: |x| + |y| < 1, and an interval of ±½.
    #[test]
    fn exact_motions_agree_with_the_exact_region_everywhere() {
        let result =
            run(&problem(Family::XFace3d, XY), &settings("descent", &[7, 20]), &Exec::new()).unwrap();
        assert!((result.exact - 2.0).abs() < 1e-9);
        assert_eq!(
            result.rounds.iter().map(|r| (r.resolution, r.trials)).collect::<Vec<_>>(),
            [(7, 49), (20, 400)]
        );
        for round in &result.rounds {
            assert_eq!((round.rejected_inside, round.accepted_outside, round.timestep), (0, 0, None));
            assert!(round.disagreeing_ci95[0] == 0.0 && round.disagreeing_ci95[1] < 0.1);
            // The border is 4√2 D long, with a trial for each cell that it crosses.
            assert!((round.accepted - 2.0).abs() < 4.0 / round.resolution as f64, "{round:?}");
        }
        let diamond = |trial: &RoundTrial| trial.inside == (trial.x.abs() + trial.y.abs() < 1.0);
        assert!(result.trials.len() == 400 && result.trials.iter().all(diamond));
        let cells = result.trials.iter().enumerate();
        let in_cell = |(k, trial): (usize, &RoundTrial)| {
            let center = result.grid.pose(k);
            let half = 0.5 * result.grid.axes[0].step();
            (trial.x - center.x).abs() <= half && (trial.y - center.y).abs() <= half
        };
        assert!(cells.clone().all(in_cell));
        let line = problem(Family::VFace, DofSet::EMPTY.with(Dof::X));
        let result = run(&line, &settings("descent", &[50]), &Exec::new()).unwrap();
        assert!((result.exact - 1.0).abs() < 1e-9 && result.rounds[0].disagreeing == 0.0);
    }

    #[test]
    fn disagreements_are_counted_by_side_with_an_interval() {
        let problem = problem(Family::XFace3d, XY);
        let grid = Grid::over(problem.alignment(), |_| 10);
        let trial = |k: usize| {
            let outcome = match k {
                0..3 => Outcome::Undecided,
                3..30 => Outcome::Jammed,
                _ => Outcome::Aligned,
            };
            let PoseError { x, y, .. } = grid.pose(k);
            RoundTrial { x, y, outcome, inside: (20..95).contains(&k) }
        };
        let round = counted(10, &grid, &(0..100).map(trial).collect::<Vec<_>>());
        assert_eq!((round.rejected_inside, round.accepted_outside, round.undecided), (10, 5, 3));
        let [lo, hi] = round.disagreeing_ci95;
        assert!((round.disagreeing - 0.15).abs() < 1e-15 && lo < 0.15 && 0.15 < hi && hi - lo < 0.16);
        // The box is 2 D × 2 D.
        assert!((round.measure - 0.6).abs() < 1e-12 && (round.accepted - 2.8).abs() < 1e-12);
    }

    #[test]
    fn invalid_comparisons_are_refused() {
        let both = problem(Family::XFace3d, XY);
        let refused = |settings: &TrialsSettings| run(&both, settings, &Exec::new()).unwrap_err();
        assert!(matches!(refused(&settings("transport", &[5])), TrialsError::Method { method: "transport" }));
        assert!(matches!(refused(&settings("descent", &[5, 1])), TrialsError::Resolution { given: 1, .. }));
        let halved = |halvings, method| TrialsSettings { halvings, ..settings(method, &[5]) };
        assert!(matches!(refused(&halved(1, "descent")), TrialsError::NoTimestep { .. }));
        assert!(matches!(refused(&halved(11, "descent")), TrialsError::Halvings { given: 11, .. }));
        let turning = problem(Family::XFace3d, XY.with(Dof::Yaw));
        let refused = run(&turning, &settings("descent", &[5]), &Exec::new()).unwrap_err();
        assert!(matches!(refused, TrialsError::Rotations));
    }

    /// Drop trials: 36 places, and as many with half the step; those within a thousandth of the border may fall to either side.
    #[cfg(feature = "drop")]
    #[test]
    fn drop_trials_agree_with_the_exact_region_but_at_its_border() {
        let settings = TrialsSettings { halvings: 1, ..settings("drop", &[6]) };
        let result = run(&problem(Family::XFace3d, XY), &settings, &Exec::new()).unwrap();
        let steps: Vec<_> = result.rounds.iter().map(|round| round.timestep.unwrap()).collect();
        assert_eq!(steps, [1e-3, 5e-4]);
        assert_eq!((result.rounds[1].resolution, result.rounds[1].trials), (6, 36));
        for trial in &result.trials {
            let margin = 1.0 - trial.x.abs() - trial.y.abs();
            let agrees = trial.inside == (trial.outcome == Outcome::Aligned);
            assert!(agrees || margin.abs() < 5e-3, "{trial:?}");
        }
    }
}
