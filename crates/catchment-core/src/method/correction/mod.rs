//! An unbiased Sum with a 95 % interval: the result of a grid method, corrected by a sample of exact motions.
//!
//! ```text
//!   grid method            strata s, share p_s           poses drawn at random in each stratum, followed exactly
//!   ┌─────────────┐        ┌─────────────┐
//!   │ ░░░████░░░░ │        │ 000122210000│              stratum  share  aligned
//!   │ ░░██████░░░ │  ──▶   │ 001233321000│   ──▶           0      .6      0 / 400       sum = V · Σ p_s·a_s
//!   │ ░░░████░░░░ │        │ 000122210000│                 1      .1     37 / 900
//!   └─────────────┘        └─────────────┘                 …
//! ```
//!
//! The Sum is the measure of the accepted set in the *continuous* error box. In strata with reliable labels
//! hardly any pose is misclassified, and few motions suffice to show it; most motions go to strata along the
//! border. The Sum is unbiased whether the grid is right or wrong ([`UnbiasedSum::ci95`] gives the method): a
//! bad grid only widens the interval.
//!
//! Pose j of stratum s is a function only of the seed, s and j. A cell of the stratum is drawn by its rank,
//! then a pose in the cell. Undecided poses are excluded from the Sum; they widen the interval upwards.
//!
//! Not promised: the interval is for a single result. With [`Stop::Tolerance`] the sampling ends depending on
//! its results, which makes the stated interval miss slightly more often than with a number fixed in advance.

mod interval;
mod schedule;
mod settle;
mod strata;
#[cfg(test)]
mod tests;

pub use interval::{Z95, wilson95};
pub use schedule::{FAINT, Stop};
pub use settle::{ambiguous, settle};
pub use strata::{ByFraction, ByNeighbours, MOST_STRATA, Stratify};

use crate::acceptance::{Domain, Outcome, Stream};
use crate::contact::Pair;
use crate::exec::{Cancelled, Exec, OutOfBudget, Stopwatch};
use crate::landscape::Grid;
use crate::method::{DecideError, descent};
use crate::pose::{Dof, PoseError};
pub use interval::{CombinedShares, StratumCounts};
pub use schedule::{Batch, allot, next};
use serde::{Deserialize, Serialize};
use strata::Strata;

/// Settings that change the result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CorrectionSettings {
    /// Seed of the sampled poses.
    pub seed: u64,
    /// Stopping rule.
    pub stop: Stop,
}

/// Why there is no corrected Sum.
#[derive(Debug, thiserror::Error)]
pub enum CorrectionError {
    /// The tolerance is no share.
    #[error("a tolerance of {share} cannot be reached; give a share of the Sum above 0, such as 0.01")]
    Tolerance {
        /// The given value.
        share: f64,
    },
    /// The method that follows the poses failed.
    #[error(transparent)]
    Follow(Box<DecideError>),
    /// A grid without cells has no poses to draw.
    #[error("the grid has no cells")]
    NoCells,
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<DecideError> for CorrectionError {
    fn from(error: DecideError) -> Self {
        match error {
            DecideError::OutOfBudget(error) => Self::OutOfBudget(error),
            DecideError::Cancelled(error) => Self::Cancelled(error),
            error => Self::Follow(Box::new(error)),
        }
    }
}

/// Results of a stratum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Stratum {
    /// Poses that the stratum contains.
    pub name: String,
    /// Its share of the error box, in [0, 1]; exact.
    pub share: f64,
    /// Number of poses followed in the stratum.
    pub descents: usize,
    /// Number of them that docked.
    pub aligned: usize,
    /// Number of them that could not be followed to their end.
    pub undecided: usize,
    /// Estimated share of the stratum that docks, in [0, 1]: the mean over batches, close to
    /// `aligned / descents`.
    pub accepted: f64,
}

/// An unbiased Sum.
#[derive(Debug, Clone, PartialEq)]
pub struct UnbiasedSum {
    /// Measure of the accepted set, Dᵃ·radᵇ.
    pub sum: f64,
    /// Its 95 % interval; undecided poses widen it upwards.
    pub ci95: [f64; 2],
    /// `sum` as a share of the error box, in [0, 1].
    pub fraction: f64,
    /// Share of the error box that the grid misclassifies, accepted or not, in [0, 1]; and its 95 % interval.
    pub misclassified: f64,
    /// See [`UnbiasedSum::misclassified`].
    pub misclassified_ci95: [f64; 2],
    /// Poses followed.
    pub descents: usize,
    /// Effective sample size: number of poses sampled uniformly over the whole box with the same information;
    /// infinite if no uncertainty was found.
    pub plain_descents: f64,
    /// The strata that have cells.
    pub strata: Vec<Stratum>,
}

/// Corrects the answer over `grid`, parted into strata `by`, with exact descents.
///
/// # Errors
/// See [`CorrectionError`].
pub fn correct(
    pair: &Pair,
    grid: &Grid,
    by: &impl Stratify,
    settings: &CorrectionSettings,
    descents: &descent::DescentSettings,
    exec: &Exec,
) -> Result<UnbiasedSum, CorrectionError> {
    estimate(grid, by, settings, exec, |poses, exec| {
        Ok(descent::run(pair, Domain::Poses(poses), descents, exec)?.0.outcomes)
    })
}

/// The same for any function that decides poses: `decide` returns an outcome for each pose, which must depend
/// on that pose alone.
///
/// # Errors
/// See [`CorrectionError`].
pub fn estimate(
    grid: &Grid,
    by: &impl Stratify,
    settings: &CorrectionSettings,
    exec: &Exec,
    mut decide: impl FnMut(Vec<PoseError>, &Exec) -> Result<Vec<Outcome>, CorrectionError>,
) -> Result<UnbiasedSum, CorrectionError> {
    let CorrectionSettings { seed, stop } = *settings;
    if let Stop::Tolerance(share) = stop
        && (share <= 0.0 || share.is_nan())
    {
        return Err(CorrectionError::Tolerance { share });
    }
    if grid.is_empty() {
        return Err(CorrectionError::NoCells);
    }
    let strata = Strata::count(by, grid.len(), exec)?;
    let present: Vec<usize> = (0..strata.len()).filter(|s| strata.cells(*s) > 0).collect();
    let share = |s: &usize| StratumCounts::new(strata.cells(*s) as f64 / grid.len() as f64);
    let mut seen: Vec<StratumCounts> = present.iter().map(share).collect();
    let started = Stopwatch::start();
    let mut total = 0;
    let mut whole = CombinedShares::of(&seen, total);
    while let Some(batch) = schedule::next(stop, total, present.len(), started.elapsed(), &whole) {
        let given = schedule::allot(batch.poses, &seen);
        let numbered: Vec<(usize, usize)> = (0..present.len())
            .flat_map(|k| (seen[k].descents..seen[k].descents + given[k]).map(move |j| (k, j)))
            .collect();
        let poses = exec.map(numbered.len(), |number| {
            let (k, j) = numbered[number];
            draw(grid, &strata, present[k], seed, j)
        })?;
        let now = schedule::progress(stop, total, started.elapsed(), &whole);
        let share = batch.poses as f64 / (total + batch.poses) as f64;
        let part = exec.part([now, if total == 0 { now } else { now / (1.0 - share) }], "random descents");
        let outcomes = decide(poses, &part)?;
        let mut counts = vec![[0; 2]; present.len()];
        for ((k, _), outcome) in numbered.iter().zip(outcomes) {
            counts[*k][0] += usize::from(outcome == Outcome::Aligned);
            counts[*k][1] += usize::from(outcome == Outcome::Undecided);
        }
        for ((stratum, given), counts) in seen.iter_mut().zip(given).zip(counts) {
            stratum.add(batch.poses, given, counts);
        }
        total += batch.poses;
        whole = CombinedShares::of(&seen, total);
        if batch.last {
            break;
        }
    }
    let measure = grid.measure();
    let against =
        |(s, seen): (&usize, &StratumCounts)| if strata.accepts(*s) { seen.reversed(total) } else { *seen };
    let misclassified =
        CombinedShares::of(&present.iter().zip(&seen).map(against).collect::<Vec<_>>(), total);
    Ok(UnbiasedSum {
        sum: whole.fraction * measure,
        ci95: whole.ci95.map(|share| share * measure),
        fraction: whole.fraction,
        misclassified: misclassified.fraction,
        misclassified_ci95: misclassified.ci95,
        descents: total,
        plain_descents: whole.plain,
        strata: present
            .iter()
            .zip(&seen)
            .map(|(s, seen)| Stratum {
                name: strata.name(*s),
                share: seen.share,
                descents: seen.descents,
                aligned: seen.aligned,
                undecided: seen.undecided,
                accepted: seen.shares(total)[0],
            })
            .collect(),
    })
}

/// Pose `j` of a stratum: a cell of it, each as likely as any other, and a pose in the cell.
fn draw<S: Stratify>(grid: &Grid, strata: &Strata<S>, stratum: usize, seed: u64, j: usize) -> PoseError {
    const NUMBERS: usize = 1 + Dof::ALL.len();
    let stream = Stream::new(seed).branch(stratum as u64);
    let number = |k: usize| stream.uniform((NUMBERS * j + k) as u64);
    let cells = strata.cells(stratum);
    let rank = ((number(0) * cells as f64) as u64).min(cells.saturating_sub(1));
    let cell = grid.cell(strata.cell(stratum, rank));
    let mut error = [0.0; Dof::ALL.len()];
    for (axis, k) in grid.axes.iter().zip(cell) {
        error[axis.dof.index()] = axis.lo + axis.step() * (k as f64 + number(1 + axis.dof.index()));
    }
    PoseError::from_array(error)
}
