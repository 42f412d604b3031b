//! From a job to outcomes: the grid by the method asked for, its Sum corrected by exact descents.

use crate::failure::Failure;
use catchment::acceptance::{Acceptance, Domain, Outcome, Warning};
use catchment::contact::Pair;
use catchment::design::Design;
use catchment::exec::Exec;
use catchment::landscape::{Grid, Landscape, Resolution};
use catchment::method::correction::{self, ByFraction, ByNeighbours, Corrected, CorrectionError};
use catchment::method::flood::{self, Hierarchy};
use catchment::method::partition::{self, Partition};
use catchment::method::transport::{self, Arrival};
use catchment::method::{Method, descent, drop, kinematic};
use serde_json::Value;

/// What to compute.
pub(crate) struct Job<'a> {
    /// The design.
    pub(crate) design: &'a Design,
    /// Its halves, ready for contact.
    pub(crate) pair: &'a Pair,
    /// The error grid.
    pub(crate) grid: Grid,
    /// Decides the cells.
    pub(crate) method: Method,
    /// Flooding's tolerance, if not the default.
    pub(crate) depth_tolerance: Option<f64>,
    /// Slices and strips of the partition.
    pub(crate) partition: partition::Settings,
    /// The settings of drop tests, if they decide.
    pub(crate) drop: Option<drop::Settings>,
    /// Random poses that correct the Sum, if any shall.
    pub(crate) sample: Option<correction::Settings>,
    /// Whether the heights are wanted even where the method needs none.
    pub(crate) heights: bool,
}

/// What came out.
pub(crate) struct Computed {
    /// Outcomes over the grid.
    pub(crate) acceptance: Acceptance,
    /// The settings of the method.
    pub(crate) settings: Value,
    /// The corrected Sum, if random poses were drawn.
    pub(crate) sample: Option<Sample>,
    /// Heights over the grid, if the method needed them or they were wanted.
    pub(crate) landscape: Option<Landscape>,
    /// The basins, if the method knows any.
    pub(crate) basins: Option<Hierarchy>,
    /// The polytopes, if the method made any.
    pub(crate) partition: Option<Partition>,
}

/// The corrected Sum.
pub(crate) struct Sample {
    /// What the poses say.
    pub(crate) corrected: Corrected,
    /// The seed of their poses.
    pub(crate) seed: u64,
    /// The settings of the descents.
    pub(crate) settings: Value,
}

impl Job<'_> {
    fn flood_settings(&self) -> flood::Settings {
        let rule = self.method.rule().unwrap_or_default();
        flood::Settings { depth_tolerance: self.depth_tolerance, rule }
    }

    /// The settings of the method, as they stand in the report.
    pub(super) fn settings(&self) -> Result<Value, Failure> {
        Ok(match self.method {
            Method::Descent => serde_json::to_value(descent::Settings::default())?,
            Method::Transport => serde_json::to_value(transport::Settings::default())?,
            Method::Flood | Method::Steepest => serde_json::to_value(self.flood_settings())?,
            Method::Partition => serde_json::to_value(self.partition)?,
            Method::Kinematic => serde_json::to_value(kinematic::Settings::of(self.design)?)?,
            Method::Drop => serde_json::to_value(&self.drop)?,
        })
    }

    /// The basins over a small grid, if the method knows any.
    pub(super) fn basins_of(&self, grid: &Grid) -> Result<Option<Hierarchy>, Failure> {
        if self.method.rule().is_none() {
            return Ok(None);
        }
        let exec = Exec::new();
        let landscape = Landscape::compute(self.pair, grid, &exec)?;
        let flooding = flood::flood(&landscape, &self.design.alignment, &self.flood_settings(), &exec)?;
        Ok(Some(flooding.hierarchy))
    }

    /// The corrected Sum, if one was asked for, as `correct` finds it.
    pub(super) fn sample_of(
        &self,
        correct: impl FnOnce(&correction::Settings) -> Result<Corrected, CorrectionError>,
    ) -> Result<Option<Sample>, Failure> {
        let Some(settings) = &self.sample else { return Ok(None) };
        let corrected = correct(settings)?;
        // Drop tests are corrected by drop tests: descents would know nothing of friction.
        let settings_of = match &self.drop {
            Some(drop) => serde_json::to_value(drop)?,
            None => serde_json::to_value(descent::Settings::default())?,
        };
        Ok(Some(Sample { corrected, seed: settings.seed, settings: settings_of }))
    }
}

/// Computes all that the report and the pictures need.
pub(crate) fn compute(job: &Job, exec: &Exec) -> Result<Computed, Failure> {
    let mut settings = job.settings()?;
    let cells = job.grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
    let axes = job.grid.axes.len();
    let (what, per_cell) = match job.method {
        Method::Descent | Method::Drop => ("the outcome of every cell", DESCENT_BYTES),
        Method::Transport => ("transport", transport::bytes(job.pair, &job.grid).div_ceil(cells.max(1))),
        Method::Flood | Method::Steepest => ("flooding", flood::bytes(1)),
        Method::Partition | Method::Kinematic => ("the outcome of every cell", size_of::<Outcome>() as u64),
    };
    let heights = job.heights && job.method.rule().is_none();
    let per_cell = per_cell + if heights { Landscape::bytes(1) } else { 0 };
    exec.ensure_fits(what, cells.saturating_mul(per_cell), |budget| {
        match Resolution::largest_that_fits(budget, per_cell, axes) {
            fits if fits < Resolution::LEAST => "allow more with --memory".to_owned(),
            fits => format!("use at most --resolution {fits}, or allow more with --memory"),
        }
    })?;
    let (mut arrival, mut basins, mut partition) = (None, None, None);
    let (mut acceptance, flooded) = match job.method {
        Method::Descent => (descend(job.pair, Domain::Grid(job.grid.clone()), exec)?, None),
        Method::Drop => (dropped(job, Domain::Grid(job.grid.clone()), exec)?, None),
        Method::Transport => {
            let found = transport::run(job.pair, &job.grid, &transport::Settings::default(), exec)?;
            (arrival.insert(found).acceptance(exec)?, None)
        }
        Method::Kinematic => (kinematic::accept(job.design, &job.grid, exec)?, None),
        Method::Flood | Method::Steepest => {
            let landscape = Landscape::compute(job.pair, &job.grid, exec)?;
            let flooding = flood::flood(&landscape, &job.design.alignment, &job.flood_settings(), exec)?;
            let used = Some(flooding.hierarchy.tolerance.depth);
            settings =
                serde_json::to_value(flood::Settings { depth_tolerance: used, ..job.flood_settings() })?;
            basins = Some(flooding.hierarchy);
            (flooding.acceptance, Some(landscape))
        }
        Method::Partition => {
            let found = partition.insert(partition::run(job.pair, &job.partition, exec)?);
            (found.acceptance(Domain::Grid(job.grid.clone()), exec)?, None)
        }
    };
    let landscape = match flooded {
        None if heights => Some(Landscape::compute(job.pair, &job.grid, exec)?),
        flooded => flooded,
    };
    let descents = descent::Settings::default();
    let sample = job.sample_of(|settings| {
        let shape = job.grid.shape();
        if let Some(arrival) = &arrival {
            let by = ByFraction::new(|cell| arrival.fraction(cell), shape);
            correction::correct(job.pair, &job.grid, &by, settings, &descents, exec)
        } else {
            let by = ByNeighbours::new(&acceptance.outcomes, shape);
            if job.drop.is_some() {
                return correction::estimate(&job.grid, &by, settings, exec, |poses, exec| {
                    Ok(dropped(job, Domain::Poses(poses), exec)?.outcomes)
                });
            }
            correction::correct(job.pair, &job.grid, &by, settings, &descents, exec)
        }
    })?;
    if let Some(arrival) = &arrival {
        // Which cells are settled depends on the number of descents, not on the time they took.
        let most = sample.as_ref().map_or(0, |sample| sample.corrected.descents);
        settle(job, arrival, &mut acceptance, most, exec)?;
    }
    Ok(Computed { acceptance, settings, sample, landscape, basins, partition })
}

/// Follows the ambiguous cells exactly if they are at most `most`, else warns.
fn settle(
    job: &Job,
    arrival: &Arrival,
    acceptance: &mut Acceptance,
    most: usize,
    exec: &Exec,
) -> Result<(), Failure> {
    let of = acceptance.outcomes.len();
    let (cells, listed) = correction::ambiguous(of, |cell| arrival.is_ambiguous(cell), most, exec)?;
    if cells > most {
        acceptance.warnings.push(Warning::Ambiguous { cells, of });
        return Ok(());
    }
    let settings = descent::Settings::default();
    correction::settle(job.pair, &job.grid, &listed, &mut acceptance.outcomes, &settings, exec)?;
    Ok(())
}

/// Bytes per descent while they run: the end and the outcome of each, and the ends once more while the parts of
/// the threads are put together.
const DESCENT_BYTES: u64 = (2 * size_of::<descent::End>() + size_of::<Outcome>()) as u64;

/// Drops every pose of a domain.
fn dropped(job: &Job, domain: Domain, exec: &Exec) -> Result<Acceptance, drop::DropError> {
    let settings = job.drop.clone().unwrap_or_default();
    Ok(drop::run(job.pair, domain, &settings, exec)?.0)
}

/// Follows every pose of a domain exactly.
pub(super) fn descend(pair: &Pair, domain: Domain, exec: &Exec) -> Result<Acceptance, Failure> {
    let (acceptance, _) = descent::run(pair, domain, &descent::Settings::default(), exec)?;
    Ok(acceptance)
}
