//! Dynamic drop tests in a rigid-body engine: friction, speed, mass and bounce, which quasi-static motion
//! neglects.
//!
//! ```text
//!       │ F      released above first contact, pushed along the approach through the COR (or falling by gravity)
//!     ╲_▼_╱      friction with the surroundings −c·(v, ρ²ω) at the COR, Coulomb friction μ and bounce e in contact
//!     ╲   ╱      aligned   in the seat (crate::contact::Seat), and it stays there
//!      ╲_╱       jammed    at rest in contact elsewhere       missed   the face centres are too far apart
//!                undecided still moving at the end of the time
//! ```
//!
//! Three trials with perturbed starts decide by majority; equal poses receive equal perturbations at any
//! position in the input. The default is heavily damped, without friction and bounce: the motion of
//! [`descent`](super::descent), by an independent algorithm. There friction dissipates c·(|v|² + ρ²|ω|²), v
//! at the COR, and the default inertia mass·ρ² about the COR has the same metric, so that ρ has the same
//! meaning in both.
//!
//! The fixed half may stand on a ground plane (`ground`), on which the moving half can come to rest too
//! (dissertation, figure 4.5).
//!
//! Locked errors are locked as in [`descent`](super::descent): translations at the COR, rotations by nested
//! hinges. Geometry is exact: convex pieces, or the triangles of a mesh; see `pieces`.
//!
//! Not promised: contacts of the engine are springs, so halves overlap by about 10⁻³ D under load, and time
//! is discrete; poses near the border of the accepted set may have either outcome. To the engine, meshes with
//! undercuts are surfaces without an interior: a body that is pushed through one stays there.
//!
//! Units: D, s, kg; see [`DropSettings`]. Engine: rapier, with results that are bit-identical for any threads or
//! machine. Source of the test: the dissertation, section 4.2.

mod engine;
pub(super) mod entry;
pub mod export;
mod faces;
mod mass;
mod path;
mod pieces;
mod settings;
#[cfg(test)]
mod tests;
mod turning;

pub use path::{DropMoment, Path};
pub use settings::{DropSettings, Launch, MassProperties, PRESETS, Preset, Push, SettingError};

use crate::acceptance::{Acceptance, Domain, Outcome, Stream};
use crate::contact::Pair;
use crate::diagnostic::{Advice, Warning};
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::Resolution;
use crate::method::descent::End;
use crate::method::interface::PoseObserver;
use crate::pose::{Dof, PoseError};
use engine::{Engine, Shapes};
use glam::DVec3;
use mass::Mass;

/// Why there are no drop tests.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DropError {
    /// A setting that no trial can be made with.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The engine does not take the geometry.
    #[error("the engine does not take this geometry: {reason}")]
    Shape {
        /// The reason.
        reason: String,
    },
    /// A translation is locked at the COR, but the centre of mass swings about it.
    #[error(
        "the centre of mass lies at {center} D from the centre of rotation, and a translation is locked there while rotations are \
         free: give a mass at the centre of rotation, or free the translation"
    )]
    OffCenter {
        /// The centre of mass, relative to the COR, in D.
        center: DVec3,
    },
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Bytes per pose while they run: the end and the outcome of each, and the ends once more while the parts of the threads
/// are put together.
const POSE_BYTES: u64 = (2 * size_of::<End>() + size_of::<Outcome>()) as u64;

/// Drops every pose of a domain, in parallel; the ends are in the order of the domain. The end of a pose is
/// that of its first trial with the majority outcome.
///
/// # Errors
/// See [`DropError`]. Cancellation is checked every 64 time steps.
pub fn run(
    pair: &Pair,
    domain: Domain,
    settings: &DropSettings,
    exec: &Exec,
) -> Result<(Acceptance, Vec<End>), DropError> {
    run_observed(pair, domain, settings, exec, &|_, _| {})
}

/// The same; `finished` is called for every pose as soon as it is decided.
fn run_observed(
    pair: &Pair,
    domain: Domain,
    settings: &DropSettings,
    exec: &Exec,
    finished: PoseObserver<'_>,
) -> Result<(Acceptance, Vec<End>), DropError> {
    let shapes = Shapes::of(pair)?;
    let engine = Engine::new(pair, &shapes, settings)?;
    let count = domain.checked_len();
    let axes = if let Domain::Grid(grid) = &domain { grid.axes.len() } else { 0 };
    let needed = count.map_or(u64::MAX, |count| (count as u64).saturating_mul(POSE_BYTES));
    exec.ensure_fits("the outcome of every pose", needed, |budget| {
        if axes == 0 {
            return vec![Advice::FewerPoses, Advice::MoreMemory];
        }
        let fits = Resolution::largest_that_fits(budget, POSE_BYTES, axes);
        vec![Advice::AtMostResolution(fits), Advice::MoreMemory]
    })?;
    let count = count.unwrap_or_default();
    let tally = exec.tally(count, "drop tests");
    let ends = exec.try_map(count, |k| -> Result<End, Cancelled> {
        let end = decide(&engine, pair, settings, &domain.pose(k), exec)?;
        finished(k, end);
        tally.add(1);
        Ok(end)
    })?;
    let outcomes: Vec<Outcome> = ends.iter().map(|e| e.outcome).collect();
    let undecided = outcomes.iter().filter(|o| **o == Outcome::Undecided).count();
    let warnings =
        if undecided > 0 { vec![Warning::Undecided { cells: undecided }.into()] } else { Vec::new() };
    Ok((Acceptance { method: "drop", domain, outcomes, warnings }, ends))
}

/// Drops a pose until its majority outcome cannot change.
fn decide(
    engine: &Engine,
    pair: &Pair,
    settings: &DropSettings,
    error: &PoseError,
    exec: &Exec,
) -> Result<End, Cancelled> {
    let mut ends: Vec<End> = Vec::new();
    for trial in 0..settings.trials {
        ends.push(engine.fall(&perturbed(pair, settings, error, trial), exec)?);
        let agree = ends.iter().filter(|e| e.outcome == ends[ends.len() - 1].outcome).count();
        if agree > settings.trials as usize / 2 {
            break;
        }
    }
    Ok(verdict(&ends))
}

/// The first end with the outcome of more than half of them, or else with the most frequent outcome among
/// those that failed, the first among equals.
fn verdict(ends: &[End]) -> End {
    let votes = |outcome: Outcome| ends.iter().filter(|e| e.outcome == outcome).count();
    let majority = ends.iter().find(|e| 2 * votes(e.outcome) > ends.len());
    let most = ends.iter().rev().filter(|e| e.outcome != Outcome::Aligned).max_by_key(|e| votes(e.outcome));
    let missing = End { outcome: Outcome::Undecided, error: PoseError::default(), height: None };
    majority.or(most).copied().unwrap_or(missing)
}

/// Halves for trials with any settings: the data for the engine is prepared once.
pub struct Bench<'a> {
    pair: &'a Pair,
    shapes: Shapes,
}

impl<'a> Bench<'a> {
    /// Of a pair.
    ///
    /// # Errors
    /// If the engine does not take the geometry.
    pub fn new(pair: &'a Pair) -> Result<Self, DropError> {
        Ok(Self { pair, shapes: Shapes::of(pair)? })
    }

    /// A trial with these settings, started exactly at `error`, without perturbation.
    ///
    /// # Errors
    /// See [`DropError`]. Cancellation is checked every 64 time steps.
    pub fn fall(&self, error: &PoseError, settings: &DropSettings, exec: &Exec) -> Result<End, DropError> {
        Ok(Engine::new(self.pair, &self.shapes, settings)?.fall(error, exec)?)
    }

    /// The same, with its way.
    ///
    /// # Errors
    /// As [`Bench::fall`].
    pub fn trace(&self, error: &PoseError, settings: &DropSettings, exec: &Exec) -> Result<Path, DropError> {
        Ok(path::trace(&Engine::new(self.pair, &self.shapes, settings)?, error, exec)?)
    }

    /// Mass of the moving half with these settings, in kg.
    pub fn mass(&self, settings: &DropSettings) -> f64 {
        Mass::of(&self.pair.moving, settings, &self.pair.alignment).weight
    }
}

/// Start of a trial: uniform within the perturbation around the pose, and a function only of the seed, the
/// free errors of the pose and the number of the trial. The position of the pose in a list and locked offsets
/// have no effect.
fn perturbed(pair: &Pair, settings: &DropSettings, error: &PoseError, trial: u32) -> PoseError {
    let free = pair.alignment.free;
    let mut start = error.to_array();
    // −0 and 0 are the same error.
    let bits = |dof: Dof| (start[dof.index()] + 0.0).to_bits();
    let stream = free.iter().fold(Stream::new(settings.seed), |stream, dof| stream.branch(bits(dof)));
    let stream = stream.branch(u64::from(trial));
    for dof in free.iter() {
        let unit = if dof.is_rotation() { pair.alignment.rotation_length } else { 1.0 };
        let by = 2.0 * stream.uniform(dof.index() as u64) - 1.0;
        start[dof.index()] += settings.perturbation * by / unit;
    }
    PoseError::from_array(start)
}
