//! Why it jams: every other place where motions come to rest, and the features that hold the half there.
//!
//! ```text
//!   follow      N random poses of the error box, each by exact motion            aligned, missed, or a place of rest
//!   gather      rests on the same features, near each other, up to the symmetries of the halves: a jam
//!   rank        by the share of random poses that end there
//!   examine     how firmly it holds, how far it must be lifted to get out, whether it comes back when it is pushed
//! ```
//!
//! A jam is told by one of its rests: the one in its middle. Its contacts are named by the features of both halves
//! ([`crate::contact::Features`]), with their places in the coordinates in which each half was drawn.
//!
//! - **Rise**: how much the COR rises at least when the half is pushed [`PUSH`] aside, in the metric of the motion. Nothing: the rest is *level*, and
//!   friction or chance decides where on it a half stays.
//! - **Order**: how its contacts hold it, to first or second order ([`crate::method::descent::immobility()`]).
//! - **Way out**: by how much it must be lifted, at most, to get to where motion leads lower: the least climb of all ways that were tried, each
//!   straight. A bent way may be lower, so this is a bound from above. One from below is told where it is asked for ([`Settings::certified`]).
//!
//! Not promised: rests that fewer than about one in N random poses meet, and the least of anything that was searched for. Rise is that of the height alone:
//! with friction a half may stay where it would fall. Lengths in D, angles in radians.

pub(super) mod clusters;
pub(super) mod depth;
mod draw;
pub(super) mod escape;
mod firmness;
pub(super) mod images;
pub(super) mod rests;
#[cfg(test)]
mod tests;

pub use depth::DepthError;
pub use escape::WayOut;
pub use firmness::{Firmness, Held};

use crate::acceptance::{Domain, Outcome};
use crate::connector::Side;
use crate::contact::{FeatureKind, Features};
use crate::exec::{Cancelled, Exec};
use crate::landscape::Resolution;
use crate::method::Decide;
use crate::method::descent::{self, FrictionOutOfRange, Immobility, Sticking};
use crate::pose::{Dof, PoseError};
use crate::poses::{Distribution, Spread};
use crate::problem::Problem;
use clusters::Cluster;
use glam::DVec3;
use images::Images;
use rayon::prelude::*;
use rests::{Follow, Rested, Which};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What changes the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Random poses of the error box; 4000 of simple halves where nothing is said, fewer of halves with many facets.
    pub motions: Option<usize>,
    /// Their seed, and that of every search.
    pub seed: u64,
    /// Errors that a robot makes: as many poses are drawn from them, too.
    pub errors: Option<Distribution>,
    /// How many jams are examined, those with most of the poses.
    pub examined: usize,
    /// Coefficient of friction between the halves.
    pub friction: f64,
    /// A grid whose merge tree says depths, too; none where nothing is said.
    pub resolution: Option<Resolution>,
    /// Whether depths are bounded from below, too, by boxes of poses: of simple halves without friction, with one or two free errors as a rule.
    pub certified: bool,
}

impl Default for Settings {
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

/// How far a half is pushed aside to see how much it rises, in the metric of the motion, in D.
pub const PUSH: f64 = 0.01;

/// The jams of a problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Jams {
    /// How it was asked for, everything filled in.
    pub settings: Settings,
    /// Random poses of the error box by their outcomes, in the order of [`Outcome::ALL`].
    pub counts: [usize; 4],
    /// The same of poses drawn from the errors that a robot makes.
    pub expected: Option<[usize; 4]>,
    /// The table that those come from, where they were measured.
    pub measured: Option<String>,
    /// Where they jam, the jam with most of them first.
    pub jams: Vec<Jam>,
    /// Which pairs of features touch in jams, the one that does so most often first.
    pub pairs: Vec<Touching>,
}

/// A place, or places alike, where halves come to rest that do not dock.
#[derive(Debug, Clone, PartialEq)]
pub struct Jam {
    /// Random poses of the error box that end here.
    pub count: usize,
    /// Poses drawn from the errors that a robot makes that end here.
    pub expected: Option<usize>,
    /// The rest in its middle: the pose error.
    pub pose: PoseError,
    /// z of the COR there, in D.
    pub height: f64,
    /// How far that is above the mated pose, in D.
    pub above: f64,
    /// From where to where its rests lie, per error, in the order of [`Dof::ALL`]; images by symmetry laid upon each other.
    pub extent: [[f64; 2]; 5],
    /// At how many places that are images of each other rests were seen; 1 where they lie all over.
    pub places: usize,
    /// It is the mated pose turned by a symmetry of the halves, of this order: with that `symmetry` in the design it counts as docked.
    pub symmetry: Option<u32>,
    /// What touches.
    pub contacts: Vec<Touched>,
    /// What was found out about it; none of those beyond those that are examined.
    pub examined: Option<Examined>,
    /// The depth that the merge tree of a grid says, in D; none where none was asked for or none is known.
    pub depth_on_grid: Option<f64>,
    /// How far it must be lifted at least before it may come to rest anywhere else, in D; none where that was not asked for or is not known.
    pub depth_at_least: Option<f64>,
}

/// Two features that touch, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Touched {
    /// Where, in the world frame, in D: the places where it carries.
    pub points: Vec<DVec3>,
    /// Unit normal at the first of them, from the fixed half to the moving one.
    pub normal: DVec3,
    /// The feature of the fixed half.
    pub fixed: NamedFeature,
    /// The feature of the moving half.
    pub moving: NamedFeature,
}

/// A feature of a half that touches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NamedFeature {
    /// `face`, `edge` or `corner`.
    pub kind: FeatureKind,
    /// In words: `edge between top and wall`.
    pub name: String,
    /// The number of its part in the design file, from 0; null where halves are not made up of parts of one surface each.
    pub part: Option<usize>,
    /// Where it touches, in the coordinates in which its half was drawn, in D.
    pub drawn_d: [f64; 3],
}

/// A pair of features, and in how many jams it touches.
#[derive(Debug, Clone, PartialEq)]
pub struct Touching {
    /// Random poses of the error box that end in a jam in which it touches.
    pub count: usize,
    /// The feature of the fixed half, where it was met first; all of its name count as one.
    pub fixed: NamedFeature,
    /// The same of the moving half.
    pub moving: NamedFeature,
}

/// What is known of a jam beyond its rests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Examined {
    /// How firmly it holds.
    pub held: Held,
    /// By which order contacts alone hold it; none where they do not hold the load, as where friction does.
    pub immobility: Option<Immobility>,
    /// From which friction on it may stick, and until which it slips: nothing where contacts alone hold it; none where it touches
    /// nothing.
    pub sticking: Option<Sticking>,
    /// The lowest way out that was found; none where none was.
    pub way_out: Option<WayOut>,
    /// Poses a little off, all around, that were followed.
    pub pushed: usize,
    /// How many of them came back.
    pub back: usize,
}

/// Why no jams can be told.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum JamsError {
    /// No coefficient of friction.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// Nothing was asked.
    #[error("no motions, no jams: follow one random pose at least")]
    Nothing,
    /// A size that is none.
    #[error("{}: {value} is no size of an error: finite, 0 or more", axis.name())]
    NoSize {
        /// Which error.
        axis: Dof,
        /// What was given.
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
    /// No depths can be told.
    #[error(transparent)]
    Depth(#[from] DepthError),
    /// It was asked to stop.
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
/// use catchment_core::run::jams::{self, Settings};
///
/// let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nrotation_length = 1.0\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let found = jams::run(&problem, &Settings { motions: Some(500), ..Settings::default() }, &Exec::new())?;
/// // The tip lies on its side in the notch, either way.
/// assert_eq!(found.jams[0].places, 2);
/// # Ok(())
/// # }
/// ```
pub fn run(problem: &Problem, settings: &Settings, exec: &Exec) -> Result<Jams, JamsError> {
    by(problem, settings, &descent::Settings::with_friction(settings.friction)?, exec)
}

/// The same; and the poses that a robot is expected to come at are those of its spread, each measured one once where there are no more of them than
/// motions.
///
/// # Errors
/// See [`JamsError`].
pub fn run_for(
    problem: &Problem,
    settings: &Settings,
    spread: &Spread,
    exec: &Exec,
) -> Result<Jams, JamsError> {
    let motions = motions_of(problem, settings);
    let samples = u32::try_from(motions).unwrap_or(u32::MAX);
    let errors = draw::law(spread, samples, settings.seed ^ BRANCH);
    let settings = Settings { errors, ..settings.clone() };
    let followed_by = descent::Settings::with_friction(settings.friction)?;
    let Spread::Measured { source, poses } = spread else {
        return by(problem, &settings, &followed_by, exec);
    };
    let drawn = draw::measured(poses, problem.alignment(), motions, settings.seed ^ BRANCH)?;
    let found = of(problem, &settings, &followed_by, Some(drawn), exec)?;
    Ok(Jams { measured: Some(source.clone()), ..found })
}

fn motions_of(problem: &Problem, settings: &Settings) -> usize {
    settings.motions.unwrap_or_else(|| descent::Settings::default().default_samples(problem.pair()))
}

/// The same by motions of one's own, whose friction is that of the settings.
pub(super) fn by(
    problem: &Problem,
    settings: &Settings,
    followed_by: &descent::Settings,
    exec: &Exec,
) -> Result<Jams, JamsError> {
    let draw = |errors| {
        draw::poses(errors, problem.alignment(), motions_of(problem, settings), settings.seed ^ BRANCH)
    };
    let drawn = settings.errors.as_ref().map(draw).transpose()?;
    of(problem, settings, followed_by, drawn, exec)
}

/// The same; with the poses at which a robot is expected to come.
fn of(
    problem: &Problem,
    settings: &Settings,
    followed_by: &descent::Settings,
    drawn: Option<Vec<PoseError>>,
    exec: &Exec,
) -> Result<Jams, JamsError> {
    let motions = motions_of(problem, settings);
    if motions == 0 {
        return Err(JamsError::Nothing);
    }
    depth::check(problem, settings.certified, followed_by.friction)?;
    let settings = Settings { motions: Some(motions), ..settings.clone() };
    let features = Features::of(problem.pair());
    let follow = Follow { problem, features: &features, motions: followed_by, which: Which::Jams };
    let Domain::Poses(poses) = Domain::random(problem.alignment(), motions, settings.seed) else {
        return Err(JamsError::Nothing);
    };
    let of_box = follow.all(&poses, exec)?;
    let of_errors = drawn.map(|poses| follow.all(&poses, exec)).transpose()?;
    let counts = count(&of_box);
    let expected = of_errors.as_deref().map(count);
    let own = of_box.iter().filter_map(|(_, rested)| rested.as_ref()).count();
    let rests: Vec<Rested> =
        of_box.into_iter().chain(of_errors.into_iter().flatten()).filter_map(|(_, rested)| rested).collect();
    let images = Images::of(&features, problem.alignment());
    let found = clusters::gather(problem, &rests, &images, settings.seed, exec)?;
    let jam = |cluster: &Cluster| {
        let found = Jam::of(problem, &features, &rests, own, expected.is_some(), cluster);
        Jam { symmetry: images.symmetry(&rests[cluster.middle].pose, found.above), ..found }
    };
    let mut jams: Vec<Jam> = found.iter().map(jam).collect();
    let seen = exec.install(|| {
        let examine = |(k, cluster): (usize, &Cluster)| {
            exec.check()?;
            let rest = &rests[cluster.middle];
            Ok(follow.examine(rest, cluster, settings.seed.wrapping_add(k as u64)))
        };
        let looked: Vec<(usize, &Cluster)> = found.iter().enumerate().take(settings.examined).collect();
        looked.into_par_iter().map(examine).collect::<Result<Vec<Examined>, Cancelled>>()
    })?;
    for (jam, examined) in jams.iter_mut().zip(seen) {
        jam.examined = Some(examined);
    }
    depth::tell(problem, jams.iter_mut().collect(), settings.resolution.as_ref(), settings.certified, exec)?;
    let pairs = touching(problem, &features, &rests[..own]).into_iter().map(|(pair, _)| pair).collect();
    Ok(Jams { settings, counts, expected, measured: None, jams, pairs })
}

fn count(ends: &[(Outcome, Option<Rested>)]) -> [usize; 4] {
    Outcome::ALL.map(|outcome| ends.iter().filter(|(end, _)| *end == outcome).count())
}

impl Jams {
    /// With every place that the jams of a problem have, and numbers that mean nothing: what requirements are tried on.
    pub fn form(settings: &Settings) -> Self {
        let expected = settings.errors.as_ref().map(|_| [0; 4]);
        let (jams, pairs) = (Vec::new(), Vec::new());
        Self { settings: settings.clone(), counts: [0; 4], expected, measured: None, jams, pairs }
    }

    /// How many random poses of the error box were followed.
    pub fn motions(&self) -> usize {
        self.counts.iter().sum()
    }

    /// How many of them jam.
    pub fn jammed(&self) -> usize {
        self.jams.iter().map(|jam| jam.count).sum()
    }

    /// How many of them do not dock.
    pub fn failed(&self) -> usize {
        self.motions() - self.counts[0]
    }
}

impl Jam {
    pub(super) fn of(
        problem: &Problem,
        features: &Features,
        rests: &[Rested],
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

/// A pair of features on which poses stick, and at which frictions.
#[derive(Debug, Clone, PartialEq)]
pub struct Sticks {
    /// The pair, and on how many poses it touches.
    pub touching: Touching,
    /// The critical frictions of these poses, ascending.
    pub critical: Vec<f64>,
}

/// The features that touch where poses stick, each followed at a friction of its own, with those frictions; how many of them stick there.
pub fn what_sticks(
    problem: &Problem,
    poses: &[(PoseError, f64)],
    exec: &Exec,
) -> Result<(usize, Vec<Sticks>), Cancelled> {
    let features = Features::of(problem.pair());
    let motions = descent::Settings::default();
    let follow = Follow { problem, features: &features, motions: &motions, which: Which::Jams };
    let rest = |(pose, friction): &(PoseError, f64)| {
        exec.check()?;
        let settings = descent::Settings { friction: *friction, ..descent::Settings::default() };
        let rested = follow.rested(&descent::settle(problem.pair(), pose, &settings));
        Ok(rested.map(|rested| (rested, *friction)))
    };
    let rests: Vec<Option<(Rested, f64)>> =
        exec.install(|| poses.par_iter().map(rest).collect::<Result<_, Cancelled>>())?;
    let (rests, frictions): (Vec<Rested>, Vec<f64>) = rests.into_iter().flatten().unzip();
    let sticks = touching(problem, &features, &rests).into_iter().map(|(touching, at)| {
        let mut critical: Vec<f64> = at.into_iter().map(|k| frictions[k]).collect();
        critical.sort_by(f64::total_cmp);
        Sticks { touching, critical }
    });
    Ok((rests.len(), sticks.collect()))
}

/// The pairs of features that touch in rests and the numbers of these rests, by their names, in the order of how many do: a person changes all features of
/// a name, or none.
fn touching(problem: &Problem, features: &Features, rests: &[Rested]) -> Vec<(Touching, Vec<usize>)> {
    let mut pairs: BTreeMap<[String; 2], (Touching, Vec<usize>)> = BTreeMap::new();
    for (number, rest) in rests.iter().enumerate() {
        for met in &rest.met {
            let touching = || {
                let Touched { fixed, moving, .. } = rest.name(problem, features, met);
                (Touching { count: 0, fixed, moving }, Vec::new())
            };
            let (pair, at) = pairs.entry(Rested::names(features, met)).or_insert_with(touching);
            if at.last() != Some(&number) {
                at.push(number);
                pair.count += 1;
            }
        }
    }
    let mut pairs: Vec<(Touching, Vec<usize>)> = pairs.into_values().collect();
    // Stable: of equals the one whose name comes first.
    pairs.sort_by_key(|(pair, _)| std::cmp::Reverse(pair.count));
    pairs
}

/// The number of the part on which a point of a half lies, in its frame; where every part is one solid.
fn part_of(problem: &Problem, side: Side, point: DVec3) -> Option<usize> {
    use crate::design::{ConnectorSpec, HalfSpec};
    let ConnectorSpec::Own(own) = &problem.design().connector else { return None };
    let (spec, half) = match side {
        Side::Fixed => (&own.fixed, &problem.connector().fixed),
        Side::Moving => (&own.moving, &problem.connector().moving),
    };
    let HalfSpec::Parts(parts) = spec else { return None };
    let nearest = half.solids().iter().map(|solid| solid.distance(point)).enumerate();
    let nearest = nearest.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(part, _)| part);
    nearest.filter(|_| parts.len() == half.solids().len())
}
