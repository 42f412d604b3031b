//! Exact quasi-static motion of a pose: overdamped, in contact, without friction or with Coulomb friction.
//! The reference for all methods.
//!
//! ```text
//!   q̇ = −M⁻¹ · (minimum-norm point of the convex hull of the active contacts' gradients of h)
//! ```
//!
//! in the metric `|v|² + ρ²|ω|²` (v at the COR), with any number of simultaneous contacts, until the half has
//! docked ([`crate::contact::Seat`]), rests elsewhere, or has slid off. It uses no grid and does not sample
//! surfaces. If walls of the halves face each other closely (a peg in its hole), motion proceeds from event
//! to event (`sliding`), in all other pairs by plain steps (`step`).
//!
//! With friction ([`DescentSettings::friction`]) the contact forces lie in friction cones instead of along the
//! normals (`coulomb`), and motion ends if they balance the push; [`sticking()`] gives the friction
//! coefficients at which this is possible.
//!
//! If a half slightly off the mated pose comes to rest below its seat ([`fall()`]), every motion is followed
//! until it rests.
//!
//! Not promised: speed, bounce and mass are neglected; a pose that starts exactly on a ridge, from which the
//! motion could go either way, may be reported as jammed there.

mod coulomb;
mod dependence;
pub(super) mod entry;
mod fall;
mod holding;
mod homing;
mod immobility;
mod motion;
mod projection;
mod rest;
mod rows;
mod sliding;
mod step;
mod sticking;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_of_friction;
#[cfg(test)]
mod tests_of_holding;
#[cfg(test)]
mod tests_of_immobility;
mod trajectory;

pub use dependence::step_dependence;
pub(in crate::method) use entry::default_samples;
pub(in crate::method) use fall::all_count;
pub use fall::fall;
pub use holding::{Guide, Holding, Load, MOST_LOAD, TOUCHING};
pub use immobility::{Immobility, ImmobilityOrder, immobility};
pub use rest::{Rest, settle};
pub use sticking::{FrictionAmbiguity, HARDLY, Sticking, sticking};
pub use trajectory::{Touch, Trajectory, Waypoint};

use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::contact::Pair;
use crate::diagnostic::Warning;
use crate::exec::{Cancelled, Exec};
use crate::method::interface::PoseObserver;
use crate::pose::PoseError;
use motion::{Motion, NoObserver, Until};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sticking::{AmbiguityObserver, HoldingFrictionObserver};

/// Settings of [`run`] that may change its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct DescentSettings {
    /// Longest step in the ρ-metric, in D; twice as long if the motion is straight. Halving it must not
    /// change outcomes; the setting exists for that test.
    pub step: f64,
    /// Largest difference between predicted and true height after a step, as a share of the step; beyond it
    /// the step is halved.
    pub surprise: f64,
    /// Number of steps after which a motion counts as undecided.
    pub max_steps: usize,
    /// Coefficient of friction between the halves, at least 0.
    pub friction: f64,
    /// Motion ends if the height falls by no more than this per length in the ρ-metric: the simple variant of
    /// friction (dissertation, 7.2). For offsets alone on a single facet it equals friction; with rotations
    /// it is a rule of thumb that follows from no coefficient.
    pub slope_threshold: f64,
}

impl Default for DescentSettings {
    fn default() -> Self {
        Self { step: 0.02, surprise: 0.05, max_steps: 20_000, friction: 0.0, slope_threshold: 0.0 }
    }
}

/// More than any dry surface has: rubber on rubber has 1 to 2.
const MOST_FRICTION: f64 = 10.0;

/// A number that is no coefficient of friction.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{friction} is no coefficient of friction: that is a number from 0 to {MOST_FRICTION}, such as 0.2")]
pub struct FrictionOutOfRange {
    /// The given value.
    pub friction: f64,
}

/// A number that is no slope.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{slope} is no slope at which motion ends: that is a finite number from 0 on, such as 0.2")]
pub struct SlopeOutOfRange {
    /// The given value.
    pub slope: f64,
}

impl DescentSettings {
    /// Whether something may hold a half on its way.
    pub(in crate::method) fn may_hold(&self) -> bool {
        self.friction > 0.0 || self.slope_threshold > 0.0
    }

    /// The defaults, with motion that ends if the slope is at most this.
    ///
    /// # Errors
    /// A slope is finite, and at least 0.
    pub fn with_slope_threshold(slope: f64) -> Result<Self, SlopeOutOfRange> {
        if slope.is_finite() && slope >= 0.0 {
            Ok(Self { slope_threshold: slope, ..Self::default() })
        } else {
            Err(SlopeOutOfRange { slope })
        }
    }

    /// The defaults with friction between the halves.
    ///
    /// # Errors
    /// A coefficient of friction is at least 0, and at most 10.
    pub fn with_friction(friction: f64) -> Result<Self, FrictionOutOfRange> {
        if (0.0..=MOST_FRICTION).contains(&friction) {
            Ok(Self { friction, ..Self::default() })
        } else {
            Err(FrictionOutOfRange { friction })
        }
    }
}

/// End of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct End {
    /// Outcome of the motion.
    pub outcome: Outcome,
    /// The last pose error.
    pub error: PoseError,
    /// z of the COR in the world frame at the end, in D. Under an overhang it lies below first contact at the
    /// same error; `None` if the moving half missed.
    pub height: Option<f64>,
}

impl End {
    /// A moving half that ends in contact with nothing.
    pub const fn missed(error: PoseError) -> Self {
        Self { outcome: Outcome::Missed, error, height: None }
    }
}

/// Follows poses in sequence, keeping its buffers.
pub struct Follower<'a>(Motion<'a>);

impl<'a> Follower<'a> {
    /// For the poses of a pair.
    pub fn new(pair: &'a Pair, settings: &'a DescentSettings) -> Self {
        Self(Motion::new(pair, settings).homing())
    }

    /// Follows a pose until its outcome is known: a half in a seat without docking tolerances on the errors
    /// is docked before it has come to rest.
    pub fn follow(&mut self, error: &PoseError) -> End {
        self.0.follow(error, Until::Known, &mut NoObserver)
    }

    /// The same, with the cases that Coulomb's law leaves open: whether it passed a place at which it slips
    /// although some force could hold it, and whether it wedges in a jam. See [`sticking()`].
    pub fn follow_doubting(&mut self, error: &PoseError) -> (End, FrictionAmbiguity) {
        let mut doubting = AmbiguityObserver::default();
        let end = self.0.follow(error, Until::Known, &mut doubting);
        (end, doubting.doubt(end.outcome, self.0.settings.friction))
    }

    /// The same, with the smallest friction coefficient, up to `most`, at which some force would hold it
    /// somewhere on this motion: `most` if none would.
    ///
    /// With friction the motion is different: this value applies only to the motion without friction (or with
    /// the friction of the settings).
    pub fn follow_holding(&mut self, error: &PoseError, most: f64) -> (End, f64) {
        let mut holding = HoldingFrictionObserver::up_to(most);
        // Simulate the whole motion, also where docking is known earlier.
        let homing = std::mem::take(&mut self.0.homing);
        let end = self.0.follow(error, Until::Known, &mut holding);
        self.0.homing = homing;
        (end, holding.least())
    }

    /// The same, but ends once `known` returns the outcome of a pose error on the motion.
    pub fn follow_until(
        &mut self,
        error: &PoseError,
        mut known: impl FnMut(&PoseError) -> Option<Outcome>,
    ) -> Outcome {
        self.0.follow(error, Until::Known, &mut known).outcome
    }

    /// Estimated cost of all tree searches so far: counted, in nanoseconds; 0 for halves without trees.
    pub(in crate::method) const fn took(&self) -> u64 {
        self.0.nearby.took()
    }

    /// Follows a pose until it has come to rest, even in the seat.
    pub fn rest(&mut self, error: &PoseError) -> End {
        self.0.follow(error, Until::AtRest, &mut NoObserver)
    }
}

/// Follows a pose until its outcome is known.
pub fn outcome(pair: &Pair, error: &PoseError, settings: &DescentSettings) -> End {
    Follower::new(pair, settings).follow(error)
}

/// Follows a pose until it has come to rest, and keeps its trajectory.
pub fn trace(pair: &Pair, error: &PoseError, settings: &DescentSettings) -> Trajectory {
    let mut waypoints = Vec::new();
    let End { outcome, .. } = Motion::new(pair, settings).follow(error, Until::AtRest, &mut waypoints);
    Trajectory { waypoints, outcome }
}

/// Follows every pose of a domain until its outcome is known, in parallel; the ends are in the order of the
/// domain.
///
/// # Errors
/// [`Cancelled`] if a stop is requested; checked before every pose.
pub fn run(
    pair: &Pair,
    domain: Domain,
    settings: &DescentSettings,
    exec: &Exec,
) -> Result<(Acceptance, Vec<End>), Cancelled> {
    each(pair, domain, Until::Known, settings, exec, &|_, _| {})
}

/// The same until every pose has come to rest: the outcomes of [`run`], and the residual poses of docked
/// halves.
///
/// # Errors
/// [`Cancelled`] if a stop is requested; checked before every pose.
pub fn rests(
    pair: &Pair,
    domain: Domain,
    settings: &DescentSettings,
    exec: &Exec,
) -> Result<(Acceptance, Vec<End>), Cancelled> {
    rests_observed(pair, domain, settings, exec, &|_, _| {})
}

/// The same; `finished` is called for every pose as soon as it has come to rest.
pub(super) fn rests_observed(
    pair: &Pair,
    domain: Domain,
    settings: &DescentSettings,
    exec: &Exec,
    finished: PoseObserver<'_>,
) -> Result<(Acceptance, Vec<End>), Cancelled> {
    each(pair, domain, Until::AtRest, settings, exec, finished)
}

/// Poses in an array, and arrays for their results: row k of all four belongs to pose k. Nothing is copied.
#[derive(Debug)]
pub struct Rows<'a> {
    /// The pose errors, in the order of [`Dof::ALL`](crate::pose::Dof::ALL), in D and radians.
    pub poses: &'a [[f64; 5]],
    /// Receives the last pose errors, likewise.
    pub ends: &'a mut [[f64; 5]],
    /// Receives [`End::height`], NaN if the moving half missed.
    pub heights: &'a mut [f64],
    /// Receives the codes of the outcomes.
    pub outcomes: &'a mut [u8],
}

/// The same as [`rests`] for poses in an array. If the four have different lengths, the shortest counts.
///
/// # Errors
/// [`Cancelled`] if a stop is requested; checked before every pose. The arrays then contain no valid results.
pub fn rests_of_rows(
    pair: &Pair,
    rows: Rows<'_>,
    settings: &DescentSettings,
    exec: &Exec,
) -> Result<(), Cancelled> {
    let Rows { poses, ends, heights, outcomes } = rows;
    let tally = exec.tally(poses.len(), "descents");
    exec.install(|| {
        (poses, ends, heights, outcomes).into_par_iter().try_for_each_init(
            || Motion::new(pair, settings).homing(),
            |motion, (pose, end, height, code)| {
                exec.check()?;
                let pose = PoseError::from_array(*pose);
                let result = motion.follow(&pose, Until::AtRest, &mut NoObserver);
                (*end, *code) = (result.error.to_array(), result.outcome as u8);
                *height = result.height.unwrap_or(f64::NAN);
                tally.add(1);
                Ok(())
            },
        )
    })
}

fn each(
    pair: &Pair,
    domain: Domain,
    until: Until,
    settings: &DescentSettings,
    exec: &Exec,
    finished: PoseObserver<'_>,
) -> Result<(Acceptance, Vec<End>), Cancelled> {
    let count = domain.len();
    let tally = exec.tally(count, "descents");
    let follow = |motion: &mut Motion<'_>, k: usize| {
        let end = motion.follow(&domain.pose(k), until, &mut NoObserver);
        finished(k, end);
        tally.add(1);
        end
    };
    let ends = exec.map_with(count, || Motion::new(pair, settings).homing(), follow)?;
    let outcomes: Vec<Outcome> = ends.iter().map(|e| e.outcome).collect();
    let undecided = outcomes.iter().filter(|o| **o == Outcome::Undecided).count();
    let warnings =
        if undecided > 0 { vec![Warning::Undecided { cells: undecided }.into()] } else { Vec::new() };
    Ok((Acceptance { method: "descent", domain, outcomes, warnings }, ends))
}
