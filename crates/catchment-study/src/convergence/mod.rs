//! Convergence of all methods as the grid is refined.
//!
//! ```text
//!   Sum ▲   ○                       cells per axis n, n·√2, n·2, … (odd: a cell is centred on the mated pose)
//!       │      ○──○──○  stable      stop when the last two refinements changed the Sum by less than the
//!       │  ●──●──●──●──●            tolerance of itself, and the ONAA edge by less than the tolerance of the box
//!       └──────────────▶ n          or if the next refinement would exceed the permitted time or memory
//! ```
//!
//! Not promised: that a stable result is correct. Flooding becomes stable at a wrong value: each finest Sum
//! is reported together with its correction by exact motions, with the 95 % interval. Two small changes in a
//! row may be luck. If the time limit stops a method, the number of its refinements differs from run to run;
//! the results at each resolution do not.

mod report;

use super::refinement::{GridDecision, Refinement, RefinementError};
use catchment_core::exec::{Bytes, Exec, OutOfBudget};
use catchment_core::landscape::Resolution;
use catchment_core::method::correction::{self, Stop};
use catchment_core::method::{DecisionMethod, Method, descent};
use catchment_core::problem::Problem;
use serde::Serialize;

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ConvergenceSettings {
    /// Largest change that counts as stable: as a share of the Sum, and as a share of the error box's edge
    /// for the ONAA.
    pub tolerance: f64,
    /// Time limit for each method, in seconds.
    pub time_limit_s: f64,
    /// Largest number of cells of a grid, except for the coarsest grid.
    pub most_cells: u64,
    /// Methods to compare.
    #[serde(serialize_with = "names")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<String>"))]
    pub methods: Vec<Method>,
    /// Number of samples, followed exactly, that correct the Sum of each method's finest grid; 0 disables
    /// them. Default: as many as a run with `descent` draws.
    pub descents: Option<usize>,
    /// Seed of the samples.
    pub seed: u64,
}

fn names<S: serde::Serializer>(methods: &[Method], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(methods.iter().map(Method::name))
}

impl Default for ConvergenceSettings {
    fn default() -> Self {
        Self {
            tolerance: 0.01,
            time_limit_s: 60.0,
            most_cells: u64::MAX,
            methods: Method::on_grids(),
            descents: None,
            seed: 1,
        }
    }
}

/// Results of a method over its refinements.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RefinementSequence {
    /// Name of the method.
    pub method: &'static str,
    /// Results from coarse to fine.
    pub trials: Vec<Refinement>,
    /// Reason why the sequence ends.
    pub end: StopReason,
    /// Sum of the finest grid as corrected by exact motions; null without samples.
    pub corrected: Option<CorrectedSum>,
}

/// An unbiased Sum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CorrectedSum {
    /// The estimate, Dᵃ·radᵇ.
    pub sum: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Number of samples behind it.
    pub descents: usize,
}

/// Reason why a sequence ends.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum StopReason {
    /// Two consecutive refinements changed the result by less than the tolerance.
    Stable,
    /// The next refinement would take too long.
    Time {
        /// Its cells per axis.
        resolution: usize,
        /// Estimated seconds, from the time per cell of the last refinement.
        expected_s: f64,
    },
    /// The next refinement would need too much memory.
    Memory {
        /// Its cells per axis.
        resolution: usize,
        /// Description of the shortage.
        message: String,
    },
    /// The next refinement would have too many cells.
    Cells {
        /// Its cells per axis.
        resolution: usize,
    },
}

/// Results of the refinements of all methods.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Convergence {
    /// Settings that change the result.
    pub settings: ConvergenceSettings,
    /// Unit of the Sums, like `D²·rad³`.
    pub unit: String,
    /// The sequence of each method.
    pub sequences: Vec<RefinementSequence>,
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub enum ConvergenceError {
    /// No share.
    #[error("a tolerance of {tolerance} cannot be reached; give a share above 0, such as 1%")]
    Tolerance {
        /// The given value.
        tolerance: f64,
    },
    /// Not even the coarsest grid can be computed.
    #[error(transparent)]
    Refinement(#[from] RefinementError),
}

/// Initial cells per axis, for one to five axes: at most some thousand cells.
const FIRST: [usize; 5] = [51, 11, 9, 7, 5];

/// Refines until stable.
///
/// # Errors
/// An invalid tolerance, a coarsest grid that does not fit into memory, or a cancelled run.
pub fn run(
    problem: &Problem,
    settings: &ConvergenceSettings,
    exec: &Exec,
) -> Result<Convergence, ConvergenceError> {
    let tolerance = settings.tolerance;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(ConvergenceError::Tolerance { tolerance });
    }
    let affordable = || descent::DescentSettings::default().default_samples(problem.pair());
    let settings = &ConvergenceSettings {
        descents: Some(settings.descents.unwrap_or_else(affordable)),
        ..settings.clone()
    };
    let total = settings.methods.len() as f64;
    let sequences = settings
        .methods
        .iter()
        .enumerate()
        .map(|(k, method)| {
            let part = exec.part([k as f64 / total, (k + 1) as f64 / total], "convergence");
            sequence(method, problem, settings, &part)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let first = sequences.iter().find_map(|s: &RefinementSequence| s.trials.first());
    let unit = first.map_or_else(String::new, |trial| trial.unit.clone());
    Ok(Convergence { settings: settings.clone(), unit, sequences })
}

fn sequence(
    method: &Method,
    problem: &Problem,
    settings: &ConvergenceSettings,
    exec: &Exec,
) -> Result<RefinementSequence, ConvergenceError> {
    let axes = problem.alignment().free.len().clamp(1, 5);
    let cells = |resolution: usize| (resolution as f64).powf(axes as f64);
    let mut resolution = FIRST[axes - 1];
    let mut trials: Vec<Refinement> = Vec::new();
    let mut finest: Option<GridDecision> = None;
    let mut spent = 0.0;
    let end = loop {
        if let Some(last) = trials.last() {
            if stable(&trials, settings.tolerance) {
                break StopReason::Stable;
            }
            let expected_s = last.seconds * cells(resolution) / cells(last.resolution);
            if spent + expected_s > settings.time_limit_s {
                break StopReason::Time { resolution, expected_s };
            }
        }
        if cells(resolution) > settings.most_cells as f64 && !trials.is_empty() {
            break StopReason::Cells { resolution };
        }
        // Each refinement costs more than all earlier refinements together, so it gets half of the remaining
        // progress.
        let done = 1.0 - 0.5f64.powf(trials.len() as f64);
        let part = exec.part([done, 0.5 + 0.5 * done], "convergence");
        let tried = GridDecision::by(method, problem, resolution, &part)
            .and_then(|sampled| Ok((sampled.refinement(problem, &part)?, sampled)));
        match tried {
            Ok((trial, sampled)) => {
                spent += trial.seconds;
                trials.push(trial);
                finest = Some(sampled);
            }
            Err(RefinementError::OutOfBudget(refusal)) if !trials.is_empty() => {
                break StopReason::Memory { resolution, message: needs(&refusal) };
            }
            Err(error) => return Err(error.into()),
        }
        resolution = finer(resolution);
    };
    let corrected = match finest {
        Some(sampled) if settings.descents != Some(0) => {
            let stop = Stop::Samples(settings.descents.unwrap_or_default());
            let sample = correction::CorrectionSettings { seed: settings.seed, stop };
            let result = sampled.correct(problem, &sample, exec).map_err(RefinementError::from)?;
            Some(CorrectedSum { sum: result.sum, ci95: result.ci95, descents: result.descents })
        }
        _ => None,
    };
    Ok(RefinementSequence { method: method.name(), trials, end, corrected })
}

/// The odd number nearest to √2 times as many cells.
fn finer(resolution: usize) -> usize {
    let finer = std::f64::consts::SQRT_2 * resolution as f64;
    (2 * (0.5 * (finer - 1.0)).round() as usize + 1).clamp(resolution + 2, Resolution::MOST)
}

fn needs(refusal: &OutOfBudget) -> String {
    format!("{} needs {} of the {} allowed", refusal.what, Bytes(refusal.needed), Bytes(refusal.budget))
}

/// Whether the last two refinements changed little enough.
fn stable(trials: &[Refinement], tolerance: f64) -> bool {
    let close = |a: &Refinement, b: &Refinement| {
        (b.sum - a.sum).abs() <= tolerance * b.sum.abs() && (b.onaa_edge - a.onaa_edge).abs() <= tolerance
    };
    matches!(trials, [.., a, b, c] if close(a, b) && close(b, c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::problem;
    use catchment_core::design::Family;
    use catchment_core::pose::Dof;

    fn trial(sum: f64, onaa_edge: f64) -> Refinement {
        let bracket = [sum, sum];
        let unit = String::new();
        Refinement { resolution: 3, cells: 9, seconds: 0.0, sum, unit, bracket, onaa_edge, undecided: 0 }
    }

    #[test]
    fn two_small_changes_in_a_row_are_stable() {
        let sums = |sums: &[f64]| stable(&sums.iter().map(|s| trial(*s, 0.5)).collect::<Vec<_>>(), 0.01);
        assert!(sums(&[3.0, 2.0, 2.01, 2.005]));
        assert!(!sums(&[2.0, 2.01]), "one refinement");
        assert!(!sums(&[1.0, 2.0, 2.01]) && !sums(&[2.0, 2.01, 2.2]));
        assert!(sums(&[0.0, 0.0, 0.0]), "nothing accepted, at every resolution");
        assert!(!stable(&[trial(2.0, 0.5), trial(2.0, 0.52), trial(2.0, 0.52)], 0.01));
    }

    #[test]
    fn resolutions_are_odd_and_grow_by_half_the_cells_again() {
        let mut sequence = vec![5];
        while sequence.len() < 7 {
            sequence.push(finer(sequence[sequence.len() - 1]));
        }
        assert_eq!(sequence, [5, 7, 9, 13, 19, 27, 39]);
        assert_eq!((finer(1), finer(113)), (3, 159));
    }

    #[test]
    fn every_method_is_refined_until_it_is_stable_or_something_stops_it() {
        let problem = problem(Family::VFace, [Dof::X, Dof::Pitch].into_iter().collect());
        let settings = ConvergenceSettings {
            tolerance: 0.1,
            time_limit_s: f64::INFINITY,
            descents: Some(200),
            ..ConvergenceSettings::default()
        };
        let result = run(&problem, &settings, &Exec::new()).unwrap();
        assert_eq!(
            result.sequences.iter().map(|s| s.method).collect::<Vec<_>>(),
            ["confluence", "descent", "flood", "steepest", "transport"]
        );
        assert_eq!(result.unit, "D·rad");
        for sequence in &result.sequences {
            assert_eq!(sequence.end, StopReason::Stable);
            assert!(sequence.trials.len() >= 3 && sequence.trials[0].resolution == 11);
            let corrected = sequence.corrected.unwrap();
            assert!(corrected.ci95[0] < corrected.sum && corrected.sum < corrected.ci95[1]);
            for t in &sequence.trials {
                assert!(t.cells == t.resolution.pow(2) && t.resolution % 2 == 1);
                assert!(t.bracket[0] <= t.sum && t.sum <= t.bracket[1]);
            }
        }
        let few =
            ConvergenceSettings { most_cells: 300, tolerance: 1e-9, descents: Some(0), ..settings.clone() };
        let result = run(&problem, &few, &Exec::new()).unwrap();
        assert!(
            result
                .sequences
                .iter()
                .all(|s| s.end == StopReason::Cells { resolution: 21 } && s.trials.len() == 2)
        );
        let hasty = ConvergenceSettings { time_limit_s: 0.0, tolerance: 1e-9, ..settings.clone() };
        let result = run(&problem, &hasty, &Exec::new()).unwrap();
        let once = |s: &RefinementSequence| {
            s.trials.len() == 1 && matches!(s.end, StopReason::Time { resolution: 15, .. })
        };
        assert!(result.sequences.iter().all(once));
        let small = Exec::new().with_memory_budget(2_000_000);
        let strict = ConvergenceSettings { tolerance: 1e-9, ..settings.clone() };
        let result = run(&problem, &strict, &small).unwrap();
        assert!(result.sequences.iter().all(|s| matches!(s.end, StopReason::Memory { .. })), "{result:?}");
        assert!(matches!(
            run(&problem, &settings, &Exec::new().with_memory_budget(10)),
            Err(ConvergenceError::Refinement(RefinementError::OutOfBudget(_)))
        ));
        let none = ConvergenceSettings { tolerance: 0.0, ..settings };
        assert!(matches!(run(&problem, &none, &Exec::new()), Err(ConvergenceError::Tolerance { .. })));
    }
}
