//! A sweep: a design with keys of its file replaced, every combination computed by the same run.
//!
//! ```text
//!   aspect_ratio=0.25,0.5,1  ×  cor=-1..1/5        axes, the last axis fastest
//!        │ one design file per combination
//!        ▼
//!   Problem ──Run──▶ Sum, ONAA, tolerances …       figures, with the slice of the accepted set through zero
//!        │ kept under a digest of all inputs: earlier results are not computed again
//!        ▼
//!   Sweep: the figures of every design, the largest and the smallest Sum
//! ```
//!
//! A combination whose halves do not build, or do not meet, is reported and skipped. Designs are computed
//! side by side, with one thread each, if they all fit into memory; the results do not depend on it.
//!
//! Not promised: that the Sum is smooth between two values, or that the largest Sum tried is the maximum.

mod axis;
mod report;

pub use axis::{SweepAxis, SweepAxisError};

use catchment_core::acceptance::Outcome;
use catchment_core::design::{Design, DesignDefect, DesignParameter, SourceText, with_key};
use catchment_core::exec::{Cancelled, Exec, OutOfBudget};
use catchment_core::merit::slice::GridSlice;
use catchment_core::method::NotApplicable;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::problem::{Draft, Problem, ProblemError};
use catchment_core::run::{Answer, Run, RunError};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io;

/// Largest number of designs of a sweep.
pub const MOST: usize = 100_000;

/// Bytes that the figures of a design take while all are held, without its outline.
const FIGURES_BYTES: u64 = 2048;

/// Definition of a sweep: the keys with their values, and the run for every design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepSettings {
    /// The keys and their values; the last axis changes fastest.
    pub axes: Vec<SweepAxis>,
    /// The run for every design.
    pub run: Run,
}

/// The designs of a sweep, read and not yet built.
#[derive(Debug, Clone)]
pub struct SweepPlan {
    settings: SweepSettings,
    base: Design,
    drafts: Vec<Draft>,
}

/// Single-axis limits of an error, in D or rad.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SingleAxisLimit {
    /// The error.
    pub axis: Dof,
    /// Limit below zero; not negative.
    pub minus: f64,
    /// Limit above zero; not negative.
    pub plus: f64,
}

/// A slice of the outcomes through zero: over the first two free errors, with all others 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Outline {
    /// The two errors of the slice.
    pub axes: [Dof; 2],
    /// Lower borders, D or rad.
    pub lo: [f64; 2],
    /// Upper borders, D or rad.
    pub hi: [f64; 2],
    /// Number of cells along each axis.
    pub cells: [usize; 2],
    /// The other errors, with the centres of the cells that contain zero.
    pub at: Vec<(Dof, f64)>,
    /// A digit per cell, the first axis fastest: 0 no outcome, 1 docked, 2 jammed, 3 missed, 4 undecided.
    pub outcomes: String,
}

/// Figures of merit of a design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Figures {
    /// The Sum, in `unit`: unbiased if poses were sampled.
    pub sum: f64,
    /// Its 95 % interval; null without samples.
    pub sum_ci95: Option<[f64; 2]>,
    /// Unit of the Sum, like `D²·rad`.
    pub unit: String,
    /// The Sum as a share of the error box.
    pub fraction: f64,
    /// Edge of the largest axis-oriented cube, in [0, 1] of the error box.
    pub onaa_edge: Option<f64>,
    /// Edge of the largest cube around zero.
    pub centered_edge: Option<f64>,
    /// Single-axis limits of each error.
    pub tolerances: Vec<SingleAxisLimit>,
    /// Success probability, if expected errors were given.
    pub success: Option<f64>,
    /// Warnings, as sentences.
    pub warnings: Vec<String>,
    /// Outcomes near zero; null with fewer than two free errors.
    pub outline: Option<Outline>,
}

/// Result for a design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum DesignResult {
    /// The figures of merit.
    Figures(Box<Figures>),
    /// The design cannot be computed, for this reason.
    Refused(String),
}

impl DesignResult {
    /// Its figures, if it has any.
    pub fn figures(&self) -> Option<&Figures> {
        match self {
            Self::Figures(figures) => Some(figures),
            Self::Refused(_) => None,
        }
    }
}

/// A design of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepDesign {
    /// The values of the axes, as written.
    pub values: Vec<String>,
    /// Result for the design.
    #[serde(flatten)]
    pub result: DesignResult,
}

/// Result of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sweep {
    /// Definition of the sweep.
    pub settings: SweepSettings,
    /// Every combination of values, the last axis fastest.
    pub designs: Vec<SweepDesign>,
    /// Number of the design with the largest Sum, the first if several are equal.
    pub largest: Option<usize>,
    /// Number of the design with the smallest Sum, the first if several are equal.
    pub smallest: Option<usize>,
}

/// Storage of finished designs, so that a stopped sweep can be resumed.
pub trait DesignStore: Sync {
    /// The result stored under a key, if it can be read.
    fn find(&self, key: &str) -> Option<DesignResult>;
    /// Stores a result.
    ///
    /// # Errors
    /// The error of the system.
    fn keep(&self, key: &str, found: &DesignResult) -> io::Result<()>;
}

/// Keeps nothing.
#[derive(Debug, Clone, Copy)]
pub struct NoStore;

impl DesignStore for NoStore {
    fn find(&self, _: &str) -> Option<DesignResult> {
        None
    }

    fn keep(&self, _: &str, _: &DesignResult) -> io::Result<()> {
        Ok(())
    }
}

/// Why there is no sweep.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// A design cannot be read with these values.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// An axis cannot be set in the text of the design.
    #[error("{key}: {defect}")]
    Key {
        /// The key.
        key: String,
        /// The error.
        defect: Box<DesignDefect>,
    },
    /// A key has two axes.
    #[error("{key} has two lists of values: write them as one")]
    TwoAxes {
        /// The key.
        key: String,
    },
    /// No axis.
    #[error("a sweep needs a key and its values")]
    NoAxis,
    /// Too many designs.
    #[error("{designs} designs are more than {MOST}: leave out values")]
    TooMany {
        /// How many.
        designs: usize,
    },
    /// The method is not made for a design.
    #[error(transparent)]
    NotApplicable(#[from] NotApplicable),
    /// A run gives no answer, whatever the design.
    #[error(transparent)]
    Run(#[from] RunError),
    /// No design could be computed.
    #[error("none of the {designs} designs can be computed; the first: {reason}")]
    AllRefused {
        /// How many.
        designs: usize,
        /// Why the first of them cannot.
        reason: String,
    },
    /// Results cannot be stored.
    #[error("cannot keep what is finished: {0}")]
    Keep(#[source] io::Error),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SweepPlan {
    /// Reads every design of a sweep: `source` with the keys of the axes replaced. `change` is applied to
    /// each, as with options of a command line.
    ///
    /// # Errors
    /// A value that its key cannot have, shown in the text with that value in it; two axes of the same key;
    /// no axis or too many designs.
    pub fn new(
        source: &SourceText,
        settings: SweepSettings,
        change: impl Fn(Draft) -> Result<Draft, ProblemError>,
    ) -> Result<Self, SweepError> {
        let axes = &settings.axes;
        if axes.is_empty() {
            return Err(SweepError::NoAxis);
        }
        if let Some((_, axis)) =
            axes.iter().enumerate().find(|(k, a)| axes[..*k].iter().any(|b| b.key == a.key))
        {
            return Err(SweepError::TwoAxes { key: axis.key.clone() });
        }
        let designs = axes.iter().fold(1usize, |n, axis| n.saturating_mul(axis.values.len()));
        if designs > MOST {
            return Err(SweepError::TooMany { designs });
        }
        // The file itself must be a valid design; if it is not, errors would concern values that the sweep
        // sets.
        let base = change(Draft::read(source.clone())?)?.design().clone();
        let swept = axes.iter().filter_map(|axis| DesignParameter::of_key(&axis.key));
        let base = swept.fold(base, Design::untitled);
        let drafts = (0..designs).map(|number| {
            let mut text = source.text.clone();
            for (axis, value) in axes.iter().zip(combination(axes, number)) {
                text = with_key(&text, &axis.key, value)
                    .map_err(|defect| SweepError::Key { key: axis.key.clone(), defect: Box::new(defect) })?;
            }
            let values =
                combination(axes, number).zip(axes).map(|(value, axis)| format!("{} = {value}", axis.name()));
            let path = source.path.with_file_name(format!(
                "{} with {}",
                source.path.file_name().unwrap_or_default().display(),
                values.collect::<Vec<_>>().join(", ")
            ));
            Ok(change(Draft::read(SourceText { path, text, files: source.files.clone() })?)?)
        });
        let drafts = drafts.collect::<Result<_, SweepError>>()?;
        Ok(Self { settings, base, drafts })
    }

    /// How many designs there are.
    pub fn len(&self) -> usize {
        self.drafts.len()
    }

    /// Whether the sweep is empty; it never is.
    pub fn is_empty(&self) -> bool {
        self.drafts.is_empty()
    }

    /// The design as in its file, without the swept parameters in its name.
    pub const fn base(&self) -> &Design {
        &self.base
    }

    /// One design, in the order of the combinations, and the key that [`DesignStore`] has it under: a part of [`SweepPlan::run`] that may be computed
    /// elsewhere. `None` where the halves do not build, which takes no time to find out again.
    ///
    /// # Errors
    /// As [`SweepPlan::run`].
    pub fn design(&self, number: usize, exec: &Exec) -> Result<Option<(String, DesignResult)>, SweepError> {
        let Ok(problem) = self.drafts[number].clone().build() else { return Ok(None) };
        let key = key(&problem, &self.settings.run).map_err(SweepError::Keep)?;
        one(&self.drafts[number], &self.settings.run, &NoStore, exec).map(|found| Some((key, found)))
    }

    /// The key that [`DesignStore`] has a design under; `None` where its halves do not build.
    ///
    /// # Errors
    /// Never at present: every run has a JSON form.
    pub fn key(&self, number: usize) -> Result<Option<String>, SweepError> {
        let Ok(problem) = self.drafts[number].clone().build() else { return Ok(None) };
        key(&problem, &self.settings.run).map(Some).map_err(SweepError::Keep)
    }

    /// Computes every design, except for those in `keep`, and stores each as soon as it is finished.
    ///
    /// # Errors
    /// See [`SweepError`]. The designs finished until then are stored.
    pub fn run(self, keep: &dyn DesignStore, exec: &Exec) -> Result<Sweep, SweepError> {
        let Self { settings, drafts, .. } = self;
        let count = drafts.len();
        exec.ensure_fits("the figures of the designs", count as u64 * FIGURES_BYTES, |_| Vec::new())?;
        let one = |number: usize, exec: &Exec| {
            exec.check()?;
            one(&drafts[number], &settings.run, keep, exec)
        };
        // Designs that run in parallel share the memory; a design that needs more runs alone afterwards.
        let lanes = exec.threads();
        let shared = exec.clone().with_memory_budget(exec.memory_budget() / lanes as u64);
        let first = shared.each(count, lanes, "designs", |number, exec| match one(number, exec) {
            Err(SweepError::Run(RunError::OutOfBudget(_))) => Ok(None),
            found => found.map(Some),
        });
        let mut found = first.into_iter().collect::<Result<Vec<Option<DesignResult>>, SweepError>>()?;
        let large: Vec<usize> = (0..count).filter(|&number| found[number].is_none()).collect();
        let alone = exec.each(large.len(), 1, "large designs", |k, exec| one(large[k], exec));
        for (number, design) in large.into_iter().zip(alone) {
            found[number] = Some(design?);
        }
        let found: Vec<DesignResult> = found.into_iter().flatten().collect();
        let sums: Vec<(usize, f64)> =
            found.iter().enumerate().filter_map(|(k, f)| Some((k, f.figures()?.sum))).collect();
        if let (true, Some(DesignResult::Refused(reason))) = (sums.is_empty(), found.first()) {
            return Err(SweepError::AllRefused { designs: count, reason: reason.clone() });
        }
        let best = |better: fn(f64, f64) -> bool| {
            sums.iter()
                .copied()
                .reduce(|best, next| if better(next.1, best.1) { next } else { best })
                .map(|(k, _)| k)
        };
        let (largest, smallest) = (best(|a, b| a > b), best(|a, b| a < b));
        let trial = |(number, result): (usize, DesignResult)| SweepDesign {
            values: combination(&settings.axes, number).map(str::to_owned).collect(),
            result,
        };
        let designs = found.into_iter().enumerate().map(trial).collect();
        Ok(Sweep { settings, designs, largest, smallest })
    }
}

/// The values of a combination, the last axis fastest.
fn combination(axes: &[SweepAxis], number: usize) -> impl Iterator<Item = &str> {
    let mut stride = axes.iter().map(|axis| axis.values.len()).product::<usize>().max(1);
    let mut rest = number;
    axes.iter().map(move |axis| {
        stride /= axis.values.len().max(1);
        let k = rest / stride.max(1);
        rest %= stride.max(1);
        axis.values[k].as_str()
    })
}

/// A design, computed or taken from storage.
fn one(draft: &Draft, run: &Run, keep: &dyn DesignStore, exec: &Exec) -> Result<DesignResult, SweepError> {
    let problem = match draft.clone().build().and_then(Problem::checked) {
        Ok(problem) => problem,
        Err(error) => return Ok(DesignResult::Refused(reason(&error))),
    };
    let key = key(&problem, run).map_err(SweepError::Keep)?;
    if let Some(found) = keep.find(&key) {
        return Ok(found);
    }
    let found = match run.on(&problem, exec) {
        Ok(answer) => DesignResult::Figures(Box::new(figures(&answer)?)),
        // Only a refusal by the method concerns the design; a requested stop may appear as any error.
        Err(RunError::Decide(error)) if !exec.is_cancelled() => DesignResult::Refused(error.to_string()),
        Err(_) if exec.is_cancelled() => return Err(Cancelled.into()),
        Err(error) => return Err(error.into()),
    };
    keep.keep(&key, &found).map_err(SweepError::Keep)?;
    Ok(found)
}

/// The error of a design with advice, in one line.
fn reason(error: &ProblemError) -> String {
    match error {
        ProblemError::Diagnostics(diagnostics) => {
            diagnostics.list.first().map(ToString::to_string).unwrap_or_default()
        }
        ProblemError::Load(error) => error.to_string(),
    }
}

/// A digest of everything that the figures depend on.
fn key(problem: &Problem, run: &Run) -> io::Result<String> {
    let mut digest = Sha256::new();
    digest.update(env!("CARGO_PKG_VERSION"));
    digest.update([LAYOUT]);
    digest.update(problem.digest());
    digest.update(serde_json::to_vec(run)?);
    Ok(catchment_core::design::hex(&digest.finalize()))
}

/// Rises when figures change their meaning.
const LAYOUT: u8 = 1;

/// The figures of an answer.
fn figures(answer: &Answer) -> Result<Figures, SweepError> {
    let merits = &answer.merits;
    let along = |t: &catchment_core::merit::tolerance::Tolerance| SingleAxisLimit {
        axis: t.axis,
        minus: t.minus,
        plus: t.plus,
    };
    Ok(Figures {
        sum: answer.sum(),
        sum_ci95: answer.sum_ci95(),
        unit: answer.unit(),
        fraction: answer
            .corrected
            .as_ref()
            .map_or(merits.sum.fraction, |corrected| corrected.estimate.fraction),
        onaa_edge: merits.onaa.as_ref().map(|onaa| onaa.edge),
        centered_edge: merits.centered.as_ref().map(|centered| centered.edge),
        tolerances: merits.tolerances.iter().map(along).collect(),
        success: answer.success.as_ref().map(|success| success.probability),
        warnings: answer.warnings().into_iter().map(|warning| warning.message).collect(),
        outline: outline(answer).map_err(RunError::from)?,
    })
}

/// The slice of an answer through zero.
fn outline(answer: &Answer) -> Result<Option<Outline>, catchment_core::merit::MeritError> {
    let Some(grid) = answer.grid().filter(|grid| grid.axes.len() >= 2) else { return Ok(None) };
    let pair = [grid.axes[0].dof, grid.axes[1].dof];
    let slice = GridSlice::of(grid, &pair, &PoseError::default())?;
    let digit = |outcome: Outcome| char::from(b'0' + outcome as u8);
    let outcomes = slice.pick(&answer.acceptance.outcomes).into_iter().map(digit).collect();
    let [a, b] = [slice.axes[0], slice.axes[1]];
    Ok(Some(Outline {
        axes: pair,
        lo: [a.lo, b.lo],
        hi: [a.hi, b.hi],
        cells: [a.cells, b.cells],
        at: slice.at,
        outcomes,
    }))
}
