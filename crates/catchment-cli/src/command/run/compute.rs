//! From a job to outcomes: the grid by the method asked for, its Sum corrected by exact descents.

use crate::failure::Failure;
use catchment::acceptance::{Acceptance, Domain, Outcome};
use catchment::contact::Pair;
use catchment::design::Design;
use catchment::exec::Exec;
use catchment::landscape::{Grid, Landscape, Resolution};
use catchment::method::correction::{self, ByNeighbours, Corrected, CorrectionError};
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
    /// Random poses that correct the Sum, if any shall.
    pub(super) sample: Option<correction::Settings>,
    /// Whether the heights are wanted even where the method needs none.
    pub(super) heights: bool,
}

/// What came out.
pub(super) struct Computed {
    /// Outcomes over the grid.
    pub(super) acceptance: Acceptance,
    /// The settings of the method.
    pub(super) settings: Value,
    /// The corrected Sum, if random poses were drawn.
    pub(super) sample: Option<Sample>,
    /// Heights over the grid, if the method needed them or they were wanted.
    pub(super) landscape: Option<Landscape>,
}

/// The corrected Sum.
pub(super) struct Sample {
    /// What the poses say.
    pub(super) corrected: Corrected,
    /// The seed of their poses.
    pub(super) seed: u64,
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

    /// The corrected Sum, if one was asked for, as `correct` finds it for the strata of an answer over the grid.
    pub(super) fn sample_of(
        &self,
        acceptance: &Acceptance,
        correct: impl FnOnce(&ByNeighbours, &correction::Settings) -> Result<Corrected, CorrectionError>,
    ) -> Result<Option<Sample>, Failure> {
        let (Some(settings), Some(grid)) = (&self.sample, acceptance.grid()) else { return Ok(None) };
        let corrected = correct(&ByNeighbours::new(&acceptance.outcomes, grid.shape()), settings)?;
        let descents = serde_json::to_value(descent::Settings::default())?;
        Ok(Some(Sample { corrected, seed: settings.seed, settings: descents }))
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
    let sample = job.sample_of(&acceptance, |by, settings| {
        correction::correct(job.pair, &job.grid, by, settings, &descent::Settings::default(), exec)
    })?;
    Ok(Computed { acceptance, settings, sample, landscape })
}

/// Bytes per descent while they run: the end and the outcome of each, and the ends once more while the parts of
/// the threads are put together.
const DESCENT_BYTES: u64 = (2 * size_of::<descent::End>() + size_of::<Outcome>()) as u64;
/// Follows every pose of a domain exactly.
pub(super) fn descend(pair: &Pair, domain: Domain, exec: &Exec) -> Result<Acceptance, Failure> {
    let (acceptance, _) = descent::run(pair, domain, &descent::Settings::default(), exec)?;
    Ok(acceptance)
}
