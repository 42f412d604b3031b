//! Jams: all rests outside the seat, and the features that hold the half there.
//!
//! ```text
//!   follow      N sampled poses of the error box, each by exact motion           aligned, missed, or a rest
//!   gather      rests on the same features, near each other, up to the symmetries of the halves: a jam
//!   rank        by the share of sampled poses that end there
//!   examine     stability class, escape height, and whether it returns after a push
//! ```
//!
//! A jam is represented by its central rest. Its contacts are named by the features of both halves
//! ([`crate::contact::Features`]), with their positions in the coordinates in which each half was drawn.
//!
//! - **Rise**: smallest rise of the COR when the half is displaced by [`PUSH`] in the metric of the motion.
//!   If it is zero, the rest is *level*, and friction or chance decides the final position on it.
//! - **Order**: first- or second-order immobility by its contacts ([`crate::method::descent::immobility()`]).
//! - **Escape path**: upper bound on the escape height, up to a point from which motion leads lower: the
//!   smallest climb of all straight paths tried. A curved path may be lower. [`JamsSettings::certified`] adds a
//!   lower bound.
//!
//! Not promised: rests with fewer than about one in N sampled poses, and the true minimum of any search. Rise
//! uses the height alone: with friction a half may stay although the height falls. Lengths in D, angles in
//! radians.

pub(super) mod clusters;
pub(super) mod depth;
pub(super) mod descriptions;
pub(super) mod escape;
pub(super) mod images;
mod pairs;
mod report;
pub(super) mod rests;
mod results;
mod sampling;
mod stability;
#[cfg(test)]
mod tests;

pub use depth::DepthError;
pub use descriptions::{contact_in_words, contacts_in_words, escape_height};
pub use escape::EscapePath;
pub use pairs::{Sticks, TouchingPair, stuck_pairs};
pub use results::{Examined, Extent, FeatureContact, Jam, JammingPair, Jams, NamedFeature};
pub use stability::Stability;

use crate::acceptance::{Domain, Outcome};
use crate::contact::Features;
use crate::document::Share;
use crate::exec::{Cancelled, Exec};
use crate::landscape::Resolution;
use crate::method::DecisionMethod;
use crate::method::descent::{self, FrictionOutOfRange};
use crate::pose::{Dof, DofSet, PoseError};
use crate::poses::{Distribution, Spread};
use crate::problem::Problem;
use clusters::Cluster;
use images::Images;
use pairs::touching;
use rests::{PoseFollower, RestEnd, RestFilter};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct JamsSettings {
    /// Number of poses sampled from the error box. Default: 4000 for simple halves, fewer for halves with
    /// many facets.
    pub motions: Option<usize>,
    /// Seed of the samples and of every search.
    pub seed: u64,
    /// Pose-error distribution of a robot: if given, as many poses are also sampled from it.
    pub errors: Option<Distribution>,
    /// Number of jams to examine, those with the largest basins first.
    pub examined: usize,
    /// Coefficient of friction between the halves.
    pub friction: f64,
    /// Grid whose merge tree also gives escape heights; null: no grid.
    pub resolution: Option<Resolution>,
    /// Whether to certify lower bounds on escape heights by boxes of poses: for simple halves without
    /// friction, usually with one or two free errors.
    pub certified: bool,
}

impl Default for JamsSettings {
    fn default() -> Self {
        Self {
            motions: None,
            seed: 1,
            errors: None,
            examined: 6,
            friction: 0.0,
            resolution: None,
            certified: false,
        }
    }
}

/// Displacement of a half in the test of its rise, in the metric of the motion, in D.
pub const PUSH: f64 = 0.01;

/// A group of rests at the same place, or at equivalent places, before shares are computed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RestGroup {
    /// Number of sampled poses of the error box that end here.
    pub(super) count: usize,
    /// Poses drawn from the errors that a robot makes that end here.
    expected: Option<usize>,
    /// The pose error of the rest in its middle.
    pub(super) pose: PoseError,
    /// z of the COR there, in D.
    pub(super) height: f64,
    /// Height above the mated pose, in D.
    pub(super) above: f64,
    /// Per error, in the order of [`Dof::ALL`].
    extent: [[f64; 2]; 5],
    pub(super) places: usize,
    symmetry: Option<u32>,
    pub(super) contacts: Vec<FeatureContact>,
    pub(super) examined: Option<Examined>,
    pub(super) depth_on_grid: Option<f64>,
    pub(super) depth_at_least: Option<f64>,
}

/// Why there are no jams.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum JamsError {
    /// No coefficient of friction.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// No motions.
    #[error("no motions, no jams: follow one random pose at least")]
    Nothing,
    /// An invalid size.
    #[error("{}: {value} is no size of an error: finite, 0 or more", axis.name())]
    NoSize {
        /// Which error.
        axis: Dof,
        /// The given value.
        value: f64,
    },
    /// An error that does not vary.
    #[error("{}: the design locks it, so no error occurs there", axis.name())]
    Locked {
        /// Which.
        axis: Dof,
    },
    /// Numbers that are no covariance.
    #[error("the covariance of the errors is none: symmetric, without negative variances")]
    NotACovariance,
    /// Depths cannot be computed.
    #[error(transparent)]
    Depth(#[from] DepthError),
    /// The caller cancelled it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Poses that are drawn of the errors have random numbers of their own, and so have searches.
const BRANCH: u64 = 0x1a3;

/// Finds the jams of a problem.
///
/// # Errors
/// See [`JamsError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment_core::design::read;
/// use catchment_core::exec::Exec;
/// use catchment_core::problem::Problem;
/// use catchment_core::run::jams::{self, JamsSettings};
///
/// let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nrotation_length = 1.0\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let found = jams::run(&problem, &JamsSettings { motions: Some(500), ..JamsSettings::default() }, &Exec::new())?;
/// // The tip lies on its side in the notch, either way.
/// assert_eq!(found.jams[0].places, 2);
/// # Ok(())
/// # }
/// ```
pub fn run(problem: &Problem, settings: &JamsSettings, exec: &Exec) -> Result<Jams, JamsError> {
    by(problem, settings, &descent::DescentSettings::with_friction(settings.friction)?, exec)
}

/// The same; the poses expected of a robot are those of its spread, each measured pose once if there are at
/// most as many as motions.
///
/// # Errors
/// See [`JamsError`].
pub fn run_for(
    problem: &Problem,
    settings: &JamsSettings,
    spread: &Spread,
    exec: &Exec,
) -> Result<Jams, JamsError> {
    let motions = motions_of(problem, settings);
    let samples = u32::try_from(motions).unwrap_or(u32::MAX);
    let errors = sampling::law(spread, samples, settings.seed ^ BRANCH);
    let settings = JamsSettings { errors, ..settings.clone() };
    let followed_by = descent::DescentSettings::with_friction(settings.friction)?;
    let Spread::Measured { source, poses } = spread else {
        return by(problem, &settings, &followed_by, exec);
    };
    let drawn = sampling::measured(poses, problem.alignment(), motions, settings.seed ^ BRANCH)?;
    let found = of(problem, &settings, &followed_by, Some(drawn), exec)?;
    Ok(Jams { measured: Some(source.clone()), ..found })
}

fn motions_of(problem: &Problem, settings: &JamsSettings) -> usize {
    settings.motions.unwrap_or_else(|| descent::DescentSettings::default().default_samples(problem.pair()))
}

/// The same by given motions, whose friction is that of the settings.
pub(super) fn by(
    problem: &Problem,
    settings: &JamsSettings,
    followed_by: &descent::DescentSettings,
    exec: &Exec,
) -> Result<Jams, JamsError> {
    let draw = |errors| {
        sampling::poses(errors, problem.alignment(), motions_of(problem, settings), settings.seed ^ BRANCH)
    };
    let drawn = settings.errors.as_ref().map(draw).transpose()?;
    of(problem, settings, followed_by, drawn, exec)
}

/// The same; with the poses at which a robot is expected to come.
fn of(
    problem: &Problem,
    settings: &JamsSettings,
    followed_by: &descent::DescentSettings,
    drawn: Option<Vec<PoseError>>,
    exec: &Exec,
) -> Result<Jams, JamsError> {
    let motions = motions_of(problem, settings);
    if motions == 0 {
        return Err(JamsError::Nothing);
    }
    depth::check(problem, settings.certified, followed_by.friction)?;
    let settings = JamsSettings { motions: Some(motions), ..settings.clone() };
    let features = Features::of(problem.pair());
    let follow = PoseFollower { problem, features: &features, motions: followed_by, which: RestFilter::Jams };
    let Domain::Poses(poses) = Domain::random(problem.alignment(), motions, settings.seed) else {
        return Err(JamsError::Nothing);
    };
    let of_box = follow.all(&poses, exec)?;
    let of_errors = drawn.map(|poses| follow.all(&poses, exec)).transpose()?;
    let counts = count(&of_box);
    let expected = of_errors.as_deref().map(count);
    let own = of_box.iter().filter_map(|(_, rested)| rested.as_ref()).count();
    let rests: Vec<RestEnd> =
        of_box.into_iter().chain(of_errors.into_iter().flatten()).filter_map(|(_, rested)| rested).collect();
    let images = Images::of(&features, problem.alignment());
    let found = clusters::gather(problem, &rests, &images, settings.seed, exec)?;
    let jam = |cluster: &Cluster| {
        let found = RestGroup::of(problem, &features, &rests, own, expected.is_some(), cluster);
        RestGroup { symmetry: images.symmetry(&rests[cluster.middle].pose, found.above), ..found }
    };
    let mut groups: Vec<RestGroup> = found.iter().map(jam).collect();
    let examine = |k: usize| {
        let (cluster, seed) = (&found[k], settings.seed.wrapping_add(k as u64));
        follow.examine(&rests[cluster.middle], cluster, seed).0
    };
    let seen = exec.map(found.len().min(settings.examined), examine)?;
    for (group, examined) in groups.iter_mut().zip(seen) {
        group.examined = Some(examined);
    }
    let depths = groups.iter_mut().collect();
    depth::report(problem, depths, settings.resolution.as_ref(), settings.certified, exec)?;
    let (jammed, failed) = (groups.iter().map(|group| group.count).sum(), motions - counts[0]);
    let drawn = expected.map_or(0, |counts| counts.iter().sum());
    let free = problem.alignment().free;
    let pair = |(pair, _): (TouchingPair, Vec<usize>)| JammingPair {
        count: pair.count,
        of_jams: Share::of(pair.count, jammed).share,
        of_failures: Share::of(pair.count, failed).share,
        fixed: pair.fixed,
        moving: pair.moving,
    };
    let features = touching(problem, &features, &rests[..own]).into_iter().map(pair).collect();
    let jam = |group: RestGroup| Jam {
        of_box: Share::of(group.count, motions),
        of_jams: Share::of(group.count, jammed).share,
        of_failures: Share::of(group.count, failed).share,
        expected: group.expected.map(|count| Share::of(count, drawn)),
        pose: group.pose,
        extent: group.extent(free),
        places: group.places,
        height_d: group.height,
        above_mated_d: group.above,
        docked_with_symmetry: group.symmetry,
        contacts: group.contacts,
        examined: group.examined,
        depth_on_grid_d: group.depth_on_grid,
        depth_at_least_d: group.depth_at_least,
    };
    Ok(Jams {
        settings,
        motions,
        outcomes: shares(counts),
        expected: expected.map(shares),
        measured: None,
        jams: groups.into_iter().map(jam).collect(),
        features,
    })
}

/// Counts in the order of [`Outcome::ALL`] as shares by outcome.
pub(super) fn shares(counts: [usize; 4]) -> BTreeMap<Outcome, Share> {
    let all = counts.iter().sum();
    Outcome::ALL.into_iter().zip(counts.map(|count| Share::of(count, all))).collect()
}

fn count(ends: &[(Outcome, Option<RestEnd>)]) -> [usize; 4] {
    Outcome::ALL.map(|outcome| ends.iter().filter(|(end, _)| *end == outcome).count())
}

impl RestGroup {
    /// Range of its rests, along free errors.
    pub(super) fn extent(&self, free: DofSet) -> Vec<Extent> {
        let of = |axis: Dof| {
            let [from, to] = self.extent[axis.index()];
            Extent { axis, from, to }
        };
        free.iter().map(of).collect()
    }

    pub(super) fn of(
        problem: &Problem,
        features: &Features,
        rests: &[RestEnd],
        own: usize,
        is_expected: bool,
        cluster: &Cluster,
    ) -> Self {
        let rest = &rests[cluster.middle];
        let count = cluster.members.iter().filter(|member| **member < own).count();
        Self {
            count,
            expected: is_expected.then(|| cluster.members.len() - count),
            pose: rest.error,
            height: rest.height,
            above: rest.height - problem.pair().mated_height(),
            extent: cluster.extent,
            places: cluster.places,
            symmetry: None,
            contacts: rest.touched(problem, features),
            examined: None,
            depth_on_grid: None,
            depth_at_least: None,
        }
    }
}
