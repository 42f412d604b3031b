//! Poses and maps: a number of trials of each, and the share that docks.

use super::results::{Chance, ChanceMap, DeclaredCircumstance, PoseChance, PresetOpen};
use super::spread;
use super::trial::{Draw, check, nominal};
use super::{ChanceError, ChanceSettings, FEWEST_OVERALL, MOST_FACTOR, MOST_TRIALS, Question};
use catchment_core::acceptance::{Outcome, Stream};
use catchment_core::exec::Exec;
use catchment_core::landscape::Grid;
use catchment_core::method::descent::{self, Follower};
use catchment_core::method::drop::Bench;
use catchment_core::pose::PoseError;
use catchment_core::poses::Circumstance;
use catchment_core::problem::Problem;

const STAGE: &str = "drop tests";
/// Streams of poses and of errors that are expected.
pub(super) const OF_POSES: u64 = 1;
pub(super) const OF_ERRORS: u64 = 2;

/// Everything that trials are made with.
pub(super) struct Trials<'a> {
    pub(super) problem: &'a Problem,
    pub(super) settings: &'a ChanceSettings,
    pub(super) bench: Bench<'a>,
    pub(super) nominal: f64,
}

/// Runs the trials for a question.
///
/// # Errors
/// See [`ChanceError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment_core::design::read;
/// use catchment_core::exec::Exec;
/// use catchment_core::pose::PoseError;
/// use catchment_core::poses::{Circumstance, Dynamics, ScalarDistribution};
/// use catchment_core::problem::Problem;
/// use catchment_study::chance::{self, Question, ChanceSettings};
///
/// let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nfree = [\"x\"]\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let dynamics = Dynamics::default().with(Circumstance::Speed, ScalarDistribution::Normal { mean: 1.0, sigma: 0.2 });
/// let settings = ChanceSettings { dynamics, trials: 10, ..ChanceSettings::default() };
/// let at = |x: f64| PoseError { x, ..PoseError::default() };
/// let question = Question { poses: vec![at(0.1), at(0.9)], ..Question::default() };
/// let chance = chance::run(&problem, &question, &settings, &Exec::new())?;
/// assert_eq!(chance.poses.iter().map(|pose| pose.probability).collect::<Vec<_>>(), [1.0, 0.0]);
/// # Ok(())
/// # }
/// ```
pub fn run(
    problem: &Problem,
    requested: &Question,
    settings: &ChanceSettings,
    exec: &Exec,
) -> Result<Chance, ChanceError> {
    check(problem, settings)?;
    sound(problem, requested, settings)?;
    let bench = Bench::new(problem.pair())?;
    let nominal = nominal(settings, &bench);
    let trials = Trials { problem, settings, bench, nominal };
    let grid = (!requested.map.is_empty()).then(|| Grid { axes: requested.map.clone() });
    let cells: Vec<PoseError> =
        grid.iter().flat_map(|grid| (0..grid.len()).map(|cell| grid.pose(cell))).collect();
    // By their trials, so that progress is even.
    let all = requested.trials(settings).max(1) as f64;
    let ends = [requested.poses.len(), requested.poses.len() + cells.len()]
        .map(|places| (places * settings.trials) as f64 / all);
    let poses = trials.poses(&requested.poses, &exec.part([0.0, ends[0]], STAGE))?;
    let cells = trials.poses(&cells, &exec.part(ends, STAGE))?;
    let (overall, curve) = match &requested.errors {
        Some(errors) => {
            spread::overall(&trials, errors, &requested.times, &exec.part([ends[1], 1.0], STAGE))?
        }
        None => (None, Vec::new()),
    };
    let map = grid.map(|grid| ChanceMap { axes: grid.axes, cells });
    let counted = overall.as_ref().map_or(0, |overall| overall.trials);
    let places = poses.len() + map.as_ref().map_or(0, |map| map.cells.len());
    let made = places * settings.trials + counted + curve.iter().map(|at| at.trials).sum::<usize>();
    let declared = settings.dynamics.declared().map(|(circumstance, law)| DeclaredCircumstance {
        circumstance,
        unit: circumstance.unit(),
        law: law.clone(),
        cut: 1.0 - law.inside(circumstance.range()),
    });
    let preset = settings.drop.preset();
    Ok(Chance {
        settings: settings.clone(),
        declared: declared.collect(),
        coasting_d: settings.coasting(),
        preset: preset.map(|preset| PresetOpen { name: preset.name, unknown: preset.unknown.to_vec() }),
        overall,
        curve,
        poses,
        map,
        trials: made,
    })
}

fn sound(problem: &Problem, requested: &Question, settings: &ChanceSettings) -> Result<(), ChanceError> {
    if requested.poses.is_empty() && requested.map.is_empty() && requested.errors.is_none() {
        return Err(ChanceError::Nothing);
    }
    let trials = requested.trials(settings);
    if trials > MOST_TRIALS {
        return Err(ChanceError::TooMany { trials });
    }
    if settings.trials == 0 {
        return Err(ChanceError::TooFew { trials: 0, what: "each pose", least: 1 });
    }
    if requested.errors.is_some() && settings.overall < FEWEST_OVERALL {
        let (trials, what) = (settings.overall, "a probability under errors");
        return Err(ChanceError::TooFew { trials, what, least: FEWEST_OVERALL });
    }
    if let Some(factor) = requested.times.iter().find(|factor| !(**factor > 0.0 && **factor <= MOST_FACTOR)) {
        return Err(ChanceError::Factor { factor: *factor });
    }
    let free = problem.alignment().free;
    if let Some(axis) = requested.map.iter().find(|axis| !free.contains(axis.dof)) {
        return Err(ChanceError::LockedError { axis: axis.dof });
    }
    Ok(())
}

impl Trials<'_> {
    /// Outcome of a pose with a draw, with every velocity multiplied by `factor`.
    pub(super) fn fall(
        &self,
        error: &PoseError,
        draw: &Draw,
        factor: f64,
        exec: &Exec,
    ) -> Result<Outcome, ChanceError> {
        let start = draw.start(self.problem, self.settings, error);
        let settings = draw.settings(self.settings, factor, self.nominal);
        Ok(self.bench.fall(&start, &settings, exec)?.outcome)
    }

    /// Whether friction varies from draw to draw.
    pub(super) fn varies_friction(&self) -> bool {
        self.settings.dynamics.law(Circumstance::Friction).is_some_and(|law| !law.is_constant())
    }

    /// How exact motions follow a draw.
    pub(super) fn motions(&self, draw: &Draw) -> Result<descent::DescentSettings, ChanceError> {
        Ok(descent::DescentSettings::with_friction(draw.friction(self.settings))?)
    }

    /// The draws of a pose: functions of the seed, the pose and their numbers, wherever the pose stands.
    fn draws(&self, error: &PoseError) -> impl Fn(usize) -> Draw {
        // −0 and 0 are the same error.
        let bits = |value: f64| (value + 0.0).to_bits();
        let stream = Stream::new(self.settings.seed).branch(OF_POSES);
        let stream = error.to_array().into_iter().fold(stream, |stream, value| stream.branch(bits(value)));
        let dynamics = &self.settings.dynamics;
        move |trial| Draw::of(dynamics, stream.branch(trial as u64))
    }

    /// Tries each pose as often as set in the settings.
    fn poses(&self, poses: &[PoseError], exec: &Exec) -> Result<Vec<PoseChance>, ChanceError> {
        let trials = self.settings.trials;
        let all = poses.len() * trials;
        let tally = exec.tally(all, STAGE);
        let outcomes = exec.try_map(all, |k| -> Result<Outcome, ChanceError> {
            let error = &poses[k / trials];
            let outcome = self.fall(error, &self.draws(error)(k % trials), 1.0, exec)?;
            tally.add(1);
            Ok(outcome)
        })?;
        let quasi_static = exec.try_map(poses.len(), |k| self.quasi_static(&poses[k], exec))?;
        let of = |(k, error): (usize, &PoseError)| {
            let met = &outcomes[k * trials..(k + 1) * trials];
            let outcomes = Outcome::ALL.map(|outcome| met.iter().filter(|end| **end == outcome).count());
            PoseChance::of(*error, outcomes, quasi_static[k])
        };
        Ok(poses.iter().enumerate().map(of).collect())
    }

    /// Share of the draws of a pose that dock by exact motion.
    fn quasi_static(&self, error: &PoseError, exec: &Exec) -> Result<f64, ChanceError> {
        let count = if self.varies_friction() { self.settings.trials } else { 1 };
        let draws = self.draws(error);
        let mut docks = 0;
        for trial in 0..count {
            exec.check()?;
            let settings = self.motions(&draws(trial))?;
            let end = Follower::new(self.problem.pair(), &settings).follow(error);
            docks += usize::from(end.outcome == Outcome::Aligned);
        }
        Ok(docks as f64 / count as f64)
    }

    /// The mean of an approach speed, in D/s.
    pub(super) fn speed(&self) -> f64 {
        self.settings.dynamics.mean(Circumstance::Speed).unwrap_or(self.settings.drop.launch.speed)
    }
}
