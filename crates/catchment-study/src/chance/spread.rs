//! The probability under the expected errors, and its curve over speed.
//!
//! ```text
//!   errors drawn, no trials  ──▶ strata by a quasi-static grid ──▶ one trial each of some of them, most near the border
//!                                ░░░▒▓█  near its border           P = Σ W_s·p_s with the interval of both samplings
//! ```
//!
//! The sampling is that of [`success`](crate::success): the errors with number k, and their trials, are the
//! same at every speed.

use super::ChanceError;
use super::pose_trials::{OF_ERRORS, Trials};
use super::results::{AtSpeed, Overall};
use super::trial::Draw;
use crate::success::estimate::{Sample, sample_by};
use crate::success::source::{SAME, Source};
use crate::success::strata::Strata;
use catchment_core::acceptance::{Outcome, Stream};
use catchment_core::exec::Exec;
use catchment_core::method::descent::Follower;
use catchment_core::poses::Spread;

/// Exact motions for each trial: a motion takes a tenth of a millisecond, a trial some milliseconds.
const MOTIONS_PER_TRIAL: usize = 4;
/// Shares of the time that the grid and the exact motions take.
const PARTS: [f64; 2] = [0.04, 0.1];
const STAGE: &str = "drop tests";

/// The probability with speeds as they are declared, and with each of the factors.
pub(super) fn overall(
    trials: &Trials<'_>,
    errors: &Spread,
    times: &[f64],
    exec: &Exec,
) -> Result<(Option<Overall>, Vec<AtSpeed>), ChanceError> {
    let Trials { problem, settings, .. } = trials;
    let declared = !matches!(errors, Spread::Measured { .. });
    let free = problem.alignment().free;
    if let Some(axis) = errors.occurring().find(|dof| declared && !free.contains(*dof)) {
        return Err(ChanceError::LockedError { axis });
    }
    if errors.moments().sigma == catchment_core::pose::PoseError::default() {
        return Err(ChanceError::Still);
    }
    // Rows are drawn again and again: each trial has circumstances of its own.
    let source = Source::of(errors, 0, settings.seed);
    let part = |from: f64, to: f64| exec.part([from, to], STAGE);
    let strata = Strata::decide(problem, &source, None, &part(0.0, PARTS[0]))?;
    let requested = StratifiedTrials { trials, source: &source, strata: &strata };
    let still = requested.quasi_static(&part(PARTS[0], PARTS[1]))?;
    let mut factors: Vec<f64> = times.to_vec();
    factors.sort_by(f64::total_cmp);
    factors.dedup();
    let count = factors.len() as f64 + 1.0;
    let step = |k: usize| {
        let at = |k: f64| PARTS[1] + (1.0 - PARTS[1]) * k / count;
        part(at(k as f64), at(k as f64 + 1.0))
    };
    let result = requested.sample(1.0, &step(0))?;
    let mut curve = Vec::new();
    for (k, factor) in factors.into_iter().enumerate() {
        let Sample { probability, ci95, motions, .. } = requested.sample(factor, &step(k + 1))?;
        curve.push(AtSpeed { factor, speed: factor * trials.speed(), trials: motions, probability, ci95 });
    }
    let outcomes = Outcome::ALL.map(|outcome| {
        result.poses.iter().filter(|pose| pose.outcome == outcome).map(|pose| pose.weight).sum::<f64>()
    });
    let overall = Overall {
        errors: errors.kind(),
        probability: result.probability,
        ci95: result.ci95,
        trials: result.motions,
        plain_trials: result.plain,
        outcomes,
        strata: result.strata,
        grid_cells: strata.cells(),
        quasi_static: still.probability,
        quasi_static_ci95: still.ci95,
        motions: still.motions + strata.motions(),
    };
    Ok((Some(overall), curve))
}

struct StratifiedTrials<'a> {
    trials: &'a Trials<'a>,
    source: &'a Source<'a>,
    strata: &'a Strata,
}

impl StratifiedTrials<'_> {
    fn draw(&self, number: u64) -> Draw {
        let settings = self.trials.settings;
        Draw::of(&settings.dynamics, Stream::new(settings.seed).branch(OF_ERRORS).branch(number))
    }

    /// Trials with every velocity times `factor`.
    fn sample(&self, factor: f64, exec: &Exec) -> Result<Sample, ChanceError> {
        let (source, wanted) = (self.source, self.trials.settings.overall);
        sample_by(source, &SAME, self.strata, wanted, exec, |numbered, part| {
            each(numbered, part, |number| {
                let error = source.pose(&source.standard(number), &SAME);
                self.trials.fall(&error, &self.draw(number), factor, part)
            })
        })
    }

    /// Exact motions of the same errors, each with the friction that is drawn for it.
    fn quasi_static(&self, exec: &Exec) -> Result<Sample, ChanceError> {
        let (source, trials) = (self.source, self.trials);
        let wanted = MOTIONS_PER_TRIAL * trials.settings.overall;
        sample_by(source, &SAME, self.strata, wanted, exec, |numbered, part| {
            each(numbered, part, |number| {
                let settings = trials.motions(&self.draw(number))?;
                let error = source.pose(&source.standard(number), &SAME);
                Ok(Follower::new(trials.problem.pair(), &settings).follow(&error).outcome)
            })
        })
    }
}

/// Outcomes of errors by their numbers, in parallel, in their order.
fn each(
    numbered: &[(usize, u64)],
    exec: &Exec,
    outcome: impl Fn(u64) -> Result<Outcome, ChanceError> + Sync,
) -> Result<Vec<Outcome>, ChanceError> {
    let tally = exec.tally(numbered.len(), STAGE);
    exec.try_map(numbered.len(), |k| {
        let outcome = outcome(numbered[k].1)?;
        tally.add(1);
        Ok(outcome)
    })
}
