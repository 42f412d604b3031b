//! Rests of a half under its load: all equilibria of a pair, their stability, and their escape heights.
//!
//! ```text
//!      h
//!      │ ╲        ╱╲      depth: escape height = energy per unit of weight
//!      │  ╲  ╱╲__╱  ╲ ↕
//!      │   ╲╱        ╲    basin share: share of sampled poses that end there
//!      └──────────────── q
//! ```
//!
//! The search is that of [`crate::run::jams`], with the mated pose as one rest among others: a hand and its
//! object, a fixture and its part, the ground and an object on it. The load acts along −z through the centre
//! of rotation, so that z of that point is the energy per unit of weight; for another direction use another
//! `approach` of the design.
//!
//! - **Immobility**: [`crate::method::descent::immobility()`], to first or second order.
//! - **Escape height**: the climb of the lowest escape path that was found, to a lower rest, to another one,
//!   or off the connector: an upper bound. A half without cover may be lifted straight over an obstacle; a
//!   half beneath an overhang moves only along paths on which it can slide. With a resolution the merge tree
//!   of a grid gives an escape height, too. A rest whose escape height is below the energy of a disturbance
//!   does not hold the half.
//!
//! Not promised: rests with fewer than about one in N sampled poses, and the true minimum of any search.
//! Friction is neglected. Lengths in D, angles in radians.

mod report;
#[cfg(test)]
mod tests;

use super::jams::clusters::{self, Cluster};
use super::jams::images::Images;
use super::jams::rests::{PoseFollower, RestEnd, RestFilter};
use super::jams::{DepthError, EscapePath, Examined, Extent, FeatureContact, RestGroup, depth, shares};
use crate::acceptance::{Domain, Outcome};
use crate::contact::Features;
use crate::document::Share;
use crate::exec::{Cancelled, Exec};
use crate::landscape::Resolution;
use crate::method::DecisionMethod;
use crate::method::descent;
use crate::pose::{CorPose, PoseError};
use crate::problem::Problem;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct RestsSettings {
    /// Number of poses sampled from the error box. Default: 4000 for simple halves, fewer for halves with
    /// many facets.
    pub motions: Option<usize>,
    /// Seed of the samples and of every search.
    pub seed: u64,
    /// Number of rests to examine, those with the largest basins first.
    pub examined: usize,
    /// Grid whose merge tree also gives escape heights; null: no grid.
    pub resolution: Option<Resolution>,
    /// Whether to certify lower bounds on escape heights by boxes of poses: for simple halves, usually with
    /// one or two free errors.
    pub certified: bool,
}

impl Default for RestsSettings {
    fn default() -> Self {
        Self { motions: None, seed: 1, examined: 6, resolution: None, certified: false }
    }
}

/// The rests of a pair.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Rests {
    /// The settings, with all defaults filled in.
    pub settings: RestsSettings,
    /// Number of poses sampled from the error box and followed.
    pub motions: usize,
    /// Outcomes of the sampled poses.
    #[cfg_attr(feature = "schema", schemars(schema_with = "crate::document::shares_by_outcome"))]
    pub outcomes: BTreeMap<Outcome, Share>,
    /// The rests, largest basin first.
    pub rests: Vec<RestPlace>,
}

/// A rest, or several equivalent ones.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RestPlace {
    /// Basin: poses of the error box that end here, number and share.
    pub of_box: Share,
    /// Number of these poses that count as docked.
    pub docked: usize,
    /// Pose error of the central rest.
    pub pose: PoseError,
    /// Range of the rests in each free error, with symmetric images mapped onto each other.
    pub extent: Vec<Extent>,
    /// Number of symmetric images of this place at which rests were observed.
    pub places: usize,
    /// z of the centre of rotation in the world frame, in D: the energy per unit of weight.
    pub height_d: f64,
    /// Height above the mated pose, in D.
    pub above_mated_d: f64,
    /// Upper bound on the escape height, in D; null if no escape path was found, or if the rest was not
    /// examined.
    pub depth_at_most_d: Option<f64>,
    /// Certified lower bound on the escape height to another rest, in D; null without `certified`, or if no
    /// bound is known.
    pub depth_at_least_d: Option<f64>,
    /// Escape height in the merge tree of a grid, in D; neither an upper nor a lower bound; null without
    /// `resolution`, or if the tree does not contain the rest.
    pub depth_on_grid_d: Option<f64>,
    /// Index in this list, from 0, of the rest to which the escape path leads; null if it leads off the
    /// connector or to no rest of the list.
    pub leads_to: Option<usize>,
    /// The contacts.
    pub contacts: Vec<FeatureContact>,
    /// Results of the examination; null for a rest that was not examined.
    pub examined: Option<Examined>,
}

/// Why there are no rests.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RestsError {
    /// No motions.
    #[error("no motions, no rests: follow one random pose at least")]
    Nothing,
    /// Depths cannot be computed.
    #[error(transparent)]
    Depth(#[from] DepthError),
    /// The caller cancelled it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A way that ends nearer than this to a rest, in the metric of the motion, in D, leads there.
const THERE: f64 = 0.1;

/// Finds the rests of a problem.
///
/// # Errors
/// See [`RestsError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment_core::design::read;
/// use catchment_core::exec::Exec;
/// use catchment_core::problem::Problem;
/// use catchment_core::run::rests::{self, RestsSettings};
///
/// let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nrotation_length = 1.0\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let found = rests::run(&problem, &RestsSettings { motions: Some(500), ..RestsSettings::default() }, &Exec::new())?;
/// // Docked, and with the tip on its side in the notch.
/// assert!(found.rests.len() >= 2 && found.rests[0].docked > 0);
/// # Ok(())
/// # }
/// ```
pub fn run(problem: &Problem, settings: &RestsSettings, exec: &Exec) -> Result<Rests, RestsError> {
    let motions = settings
        .motions
        .unwrap_or_else(|| descent::DescentSettings::default().default_samples(problem.pair()));
    if motions == 0 {
        return Err(RestsError::Nothing);
    }
    depth::check(problem, settings.certified, 0.0)?;
    let settings = RestsSettings { motions: Some(motions), ..settings.clone() };
    let features = Features::of(problem.pair());
    let motions_of = descent::DescentSettings::default();
    let follow = PoseFollower { problem, features: &features, motions: &motions_of, which: RestFilter::All };
    let Domain::Poses(poses) = Domain::random(problem.alignment(), motions, settings.seed) else {
        return Err(RestsError::Nothing);
    };
    let ends = follow.all(&poses, exec)?;
    let counts = Outcome::ALL.map(|outcome| ends.iter().filter(|(end, _)| *end == outcome).count());
    let rests: Vec<RestEnd> = ends.into_iter().filter_map(|(_, rested)| rested).collect();
    let images = Images::of(&features, problem.alignment());
    let clusters = clusters::gather(problem, &rests, &images, settings.seed, exec)?;
    let mut groups: Vec<RestGroup> = clusters
        .iter()
        .map(|cluster| RestGroup::of(problem, &features, &rests, rests.len(), false, cluster))
        .collect();
    let examine = |k: usize| {
        let (cluster, seed) = (&clusters[k], settings.seed.wrapping_add(k as u64));
        follow.examine(&rests[cluster.middle], cluster, seed)
    };
    let seen = exec.map(clusters.len().min(settings.examined), examine)?;
    let middles: Vec<CorPose> = clusters.iter().map(|cluster| rests[cluster.middle].pose).collect();
    let ends: Vec<Option<PoseError>> = seen.iter().map(|(_, end)| *end).collect();
    for (group, (examined, _)) in groups.iter_mut().zip(seen) {
        group.examined = Some(examined);
    }
    let depths = groups.iter_mut().collect();
    depth::report(problem, depths, settings.resolution.as_ref(), settings.certified, exec)?;
    let free = problem.alignment().free;
    let ends = ends.into_iter().chain(std::iter::repeat(None));
    let place = |((group, cluster), end): ((RestGroup, &Cluster), Option<PoseError>)| {
        let is_docked = |member: &&usize| rests[**member].outcome == Outcome::Aligned;
        let way = group.examined.and_then(|examined| examined.escape_path);
        RestPlace {
            of_box: Share::of(group.count, motions),
            docked: cluster.members.iter().filter(is_docked).count(),
            pose: group.pose,
            extent: group.extent(free),
            places: group.places,
            height_d: group.height,
            above_mated_d: group.above,
            depth_at_most_d: way.map(|way| way.climb),
            depth_at_least_d: group.depth_at_least,
            depth_on_grid_d: group.depth_on_grid,
            leads_to: way.zip(end).and_then(|(way, end)| leads_to(problem, &images, &middles, &way, &end)),
            contacts: group.contacts,
            examined: group.examined,
        }
    };
    let rests = groups.into_iter().zip(&clusters).zip(ends).map(place).collect();
    Ok(Rests { settings, motions, outcomes: shares(counts), rests })
}

/// The rest nearest to the end of an escape path.
fn leads_to(
    problem: &Problem,
    images: &Images,
    middles: &[CorPose],
    way: &EscapePath,
    end: &PoseError,
) -> Option<usize> {
    if way.to == Outcome::Missed {
        return None;
    }
    let alignment = problem.alignment();
    let end = CorPose::from_error(end, alignment.center_of_rotation, alignment.free);
    let far = middles.iter().map(|middle| images.nearest(&end, middle).1).enumerate();
    far.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, distance)| *distance <= THERE).map(|(k, _)| k)
}

impl RestPlace {
    /// Whether most of its poses count as docked.
    pub const fn is_docked(&self) -> bool {
        2 * self.docked > self.of_box.count
    }
}
