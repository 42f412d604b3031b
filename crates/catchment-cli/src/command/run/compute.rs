//! From a job to outcomes: the grid by the method asked for, the random poses by descent.

use crate::failure::Failure;
use catchment::acceptance::{Acceptance, Domain, Outcome};
use catchment::contact::Pair;
use catchment::design::Design;
use catchment::exec::Exec;
use catchment::landscape::{Grid, Landscape, Resolution};
use catchment::method::{Method, descent, flood};
use serde_json::Value;

/// What to compute.
pub(super) struct Job<'a> {
    /// The design.
    pub(super) design: &'a Design,
    /// Its halves, ready for contact.
    pub(super) pair: &'a Pair,
    /// The error grid.
    pub(super) grid: Grid,
    /// Decides the cells.
    pub(super) method: Method,
    /// Flooding's tolerance, if not the default.
    pub(super) depth_tolerance: Option<f64>,
    /// Random poses beside the grid.
    pub(super) samples: usize,
    /// Their seed.
    pub(super) seed: u64,
    /// Whether the heights are wanted even where the method needs none.
    pub(super) heights: bool,
}

/// What came out.
pub(super) struct Computed {
    /// Outcomes over the grid.
    pub(super) acceptance: Acceptance,
    /// The settings of the method.
    pub(super) settings: Value,
    /// Outcomes of the random poses, if any were drawn.
    pub(super) sample: Option<Sample>,
    /// Heights over the grid, if the method needed them or they were wanted.
    pub(super) landscape: Option<Landscape>,
}

/// Outcomes of random poses.
pub(super) struct Sample {
    /// The outcomes.
    pub(super) acceptance: Acceptance,
    /// The settings of the descents.
    pub(super) settings: Value,
}

impl Job<'_> {
    fn flood_settings(&self) -> flood::Settings {
        let default = flood::Settings::for_pair(self.pair);
        self.depth_tolerance.map_or(default, |depth_tolerance| flood::Settings { depth_tolerance })
    }

    /// The settings of the method, as they stand in the report.
    pub(super) fn settings(&self) -> Result<Value, Failure> {
        Ok(match self.method {
            Method::Descent => serde_json::to_value(descent::Settings::default())?,
            Method::Flood => serde_json::to_value(self.flood_settings())?,
        })
    }

    /// A sample, if one was asked for, with the outcomes that `decide` gives for a number of poses.
    pub(super) fn sample_of(
        &self,
        decide: impl FnOnce(usize) -> Vec<Outcome>,
    ) -> Result<Option<Sample>, Failure> {
        if self.samples == 0 {
            return Ok(None);
        }
        let outcomes = decide(self.samples);
        let acceptance = Acceptance {
            method: Method::Descent.name(),
            domain: Domain::random(&self.design.alignment, outcomes.len(), self.seed),
            outcomes,
            warnings: Vec::new(),
        };
        Ok(Some(Sample { acceptance, settings: serde_json::to_value(descent::Settings::default())? }))
    }
}

/// Computes all that the report and the pictures need.
pub(super) fn compute(job: &Job, exec: &Exec) -> Result<Computed, Failure> {
    let settings = job.settings()?;
    let cells = job.grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
    let axes = job.grid.axes.len();
    let per_cell = match job.method {
        Method::Descent => DESCENT_BYTES + if job.heights { Landscape::bytes(1) } else { 0 },
        Method::Flood => flood::bytes(1),
    };
    let what = match job.method {
        Method::Descent => "the outcome of every cell",
        Method::Flood => "flooding",
    };
    exec.reserve(what, cells.saturating_mul(per_cell), |budget| {
        match Resolution::largest_that_fits(budget, per_cell, axes) {
            fits if fits < Resolution::LEAST => "allow more with --memory".to_owned(),
            fits => format!("use at most --resolution {fits}, or allow more with --memory"),
        }
    })?;
    exec.reserve("a sample of random poses", (job.samples as u64).saturating_mul(SAMPLE_BYTES), |budget| {
        format!("use at most --samples {}", budget / SAMPLE_BYTES)
    })?;
    let (acceptance, landscape) = match job.method {
        Method::Descent => {
            let acceptance = descend(job.pair, Domain::Grid(job.grid.clone()), exec)?;
            let heights = job.heights.then(|| Landscape::compute(job.pair, &job.grid, exec));
            (acceptance, heights.transpose()?)
        }
        Method::Flood => {
            let landscape = Landscape::compute(job.pair, &job.grid, exec)?;
            let flooding = flood::flood(&landscape, &job.design.alignment, &job.flood_settings(), exec)?;
            (flooding.acceptance, Some(landscape))
        }
    };
    let sample = if job.samples == 0 {
        None
    } else {
        let domain = Domain::random(&job.design.alignment, job.samples, job.seed);
        let outcomes = descend(job.pair, domain, exec)?.outcomes;
        job.sample_of(|_| outcomes)?
    };
    Ok(Computed { acceptance, settings, sample, landscape })
}

/// Bytes per descent while they run: the end and the outcome of each, and the ends once more while the parts of
/// the threads are put together.
const DESCENT_BYTES: u64 = (2 * size_of::<descent::End>() + size_of::<Outcome>()) as u64;
/// The same for a random pose, which is stored as well.
const SAMPLE_BYTES: u64 = DESCENT_BYTES + size_of::<catchment::pose::PoseError>() as u64;

/// Follows every pose of a domain exactly.
pub(super) fn descend(pair: &Pair, domain: Domain, exec: &Exec) -> Result<Acceptance, Failure> {
    let (acceptance, _) = descent::run(pair, domain, &descent::Settings::default(), exec)?;
    Ok(acceptance)
}
