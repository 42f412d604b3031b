//! Clusters of rests that form a single jam: on the same features, and close to each other up to the
//! symmetries of the halves.
//!
//! Rests on the same classes of features belong to one jam if they are closer than [`NEAR`] to a chain of
//! others. Almost level rests, which may lie anywhere on their supporting features, belong to one jam
//! whatever the random gaps between them; so do rests at more than [`MOST_PLACES`] positions. Rests at the
//! same position belong to one jam even if their contacts are described differently.

use super::images::Images;
use super::rests::RestEnd;
use super::stability::{self, RestStability, Stability};
use crate::disjoint::DisjointSets;
use crate::exec::{Cancelled, Exec};
use crate::pose::CorPose;
use crate::problem::Problem;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// Rests closer than this are at the same place, in the metric of the motion, in D: far above the accuracy of
/// motion ends, far below a part's features.
const SAME: f64 = 0.01;
/// Places nearer than this belong together.
const NEAR: f64 = 0.1;
/// More places on the same features than this lie all over.
const MOST_PLACES: usize = 48;
/// Mean number of level rests per place: with fewer, random gaps would divide a single level place (once in
/// some hundred with this number).
const ENOUGH: usize = 4;
/// Number of rests of a jam that are tested until a level one away from an edge is found.
const LEVEL_TRIES: usize = 16;

/// Rests that form a single jam.
#[derive(Debug, Clone)]
pub(in crate::run) struct Cluster {
    /// Their numbers, ascending.
    pub(in crate::run) members: Vec<usize>,
    /// The central rest, or for level rests one that does not lie at an edge.
    pub(in crate::run) middle: usize,
    /// Range of the rests, with symmetric images mapped onto each other.
    pub(in crate::run) extent: [[f64; 2]; 5],
    /// At how many places that are images of each other they lie.
    pub(in crate::run) places: usize,
    /// Stability of the central rest, if it was tested.
    pub(in crate::run) held: Option<RestStability>,
}

/// Gathers rests into jams, the largest first.
pub(in crate::run) fn gather(
    problem: &Problem,
    rests: &[RestEnd],
    images: &Images,
    seed: u64,
    exec: &Exec,
) -> Result<Vec<Cluster>, Cancelled> {
    let mut alike: BTreeMap<&[[u32; 2]], Vec<usize>> = BTreeMap::new();
    for (k, rest) in rests.iter().enumerate() {
        alike.entry(&rest.signature).or_default().push(k);
    }
    // Groups of rests on the same features, with a leader for each.
    let mut groups: Vec<(usize, Vec<usize>)> = Vec::new();
    for (features, members) in alike.values().enumerate() {
        exec.check()?;
        groups.extend(near(rests, members, images).into_iter().map(|group| (features, group)));
    }
    let leader = |group: &(usize, Vec<usize>)| &rests[group.1[0]];
    // The stability class of each group: level groups on the same features are merged.
    let held: Vec<RestStability> = groups
        .iter()
        .map(|group| {
            exec.check()?;
            let held = stability::held(problem.pair(), leader(group), seed);
            if held.stability != Stability::Ridge {
                return Ok(held);
            }
            let others = group.1[1..].iter().copied();
            Ok(level(problem, rests, others, seed).map_or(held, |(_, held)| held))
        })
        .collect::<Result<_, Cancelled>>()?;
    let mut sets = DisjointSets::new(groups.len());
    for j in 0..groups.len() {
        for k in 0..j {
            let both_level = [j, k].iter().all(|g| held[*g].stability == Stability::Level);
            let (a, b) = (&leader(&groups[j]).pose, &leader(&groups[k]).pose);
            let at_one_place = || images.may_be_near(a, b, SAME) && images.nearest(a, b).1 <= SAME;
            if both_level && groups[j].0 == groups[k].0 || at_one_place() {
                sets.join(j as u32, k as u32);
            }
        }
    }
    let mut joined: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (k, group) in groups.iter().enumerate() {
        joined.entry(sets.find(k as u32)).or_default().extend(&group.1);
    }
    let mut clusters: Vec<Cluster> = Vec::new();
    for (set, mut members) in joined {
        exec.check()?;
        members.sort_unstable();
        clusters.push(Cluster::of(problem, rests, members, &held[set as usize], images, seed));
    }
    clusters.sort_by_key(|cluster| (Reverse(cluster.members.len()), cluster.members[0]));
    Ok(clusters)
}

/// Parts rests on the same features into those that lie near each other.
fn near(rests: &[RestEnd], members: &[usize], images: &Images) -> Vec<Vec<usize>> {
    let mut places: Vec<Vec<usize>> = Vec::new();
    let pose = |k: usize| &rests[k].pose;
    let within = |a: &CorPose, b: &CorPose, most: f64| {
        images.may_be_near(a, b, most) && images.nearest(a, b).1 <= most
    };
    for member in members {
        match places.iter().position(|place| within(pose(*member), pose(place[0]), SAME)) {
            Some(place) => places[place].push(*member),
            None if places.len() == MOST_PLACES => return vec![members.to_vec()],
            None => places.push(vec![*member]),
        }
    }
    let mut sets = DisjointSets::new(places.len());
    for j in 0..places.len() {
        for k in 0..j {
            if within(pose(places[j][0]), pose(places[k][0]), NEAR) {
                sets.join(j as u32, k as u32);
            }
        }
    }
    let mut groups: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (k, place) in places.into_iter().enumerate() {
        groups.entry(sets.find(k as u32)).or_default().extend(place);
    }
    groups.into_values().collect()
}

impl Cluster {
    fn of(
        problem: &Problem,
        rests: &[RestEnd],
        members: Vec<usize>,
        held: &RestStability,
        images: &Images,
        seed: u64,
    ) -> Self {
        let pose = |k: usize| &rests[k].pose;
        // Deviations of the members' nearest images from a given member.
        let folded = |to: usize| -> Vec<[f64; 5]> {
            let image = |k: &usize| images.nearest(pose(*k), pose(to)).0;
            members.iter().map(image).map(|image| images.off(&image, pose(to), &rests[to].error)).collect()
        };
        let around = folded(members[0]);
        let count = around.len() as f64;
        let mean: [f64; 5] = std::array::from_fn(|axis| around.iter().map(|e| e[axis]).sum::<f64>() / count);
        let off = |errors: &[f64; 5]| -> f64 {
            let parts = errors.iter().zip(mean).enumerate().map(|(axis, (value, mean))| {
                let scale = if axis < 2 { 1.0 } else { images.rho() };
                (scale * (value - mean)).powi(2)
            });
            parts.sum()
        };
        let nearest = (0..members.len()).min_by(|a, b| off(&around[*a]).total_cmp(&off(&around[*b])));
        let middle = members[nearest.unwrap_or_default()];
        // On level ground around a hole the mean lies in the hole, and the member nearest to it at the edge
        // of the hole; a member that lies level represents the cluster.
        let (middle, own_held) = if matches!(held.stability, Stability::Level | Stability::Ridge) {
            let tried = std::iter::once(middle).chain(members.iter().copied());
            level(problem, rests, tried, seed).map_or((middle, None), |(member, held)| (member, Some(held)))
        } else {
            (middle, (middle == members[0]).then_some(*held))
        };
        let stability = own_held.map_or(held.stability, |held| held.stability);
        let own = rests[middle].error.to_array();
        let mut extent = own.map(|value| [value; 2]);
        for errors in folded(middle) {
            for (axis, side) in extent.iter_mut().enumerate() {
                let value = own[axis] + errors[axis];
                *side = [side[0].min(value), side[1].max(value)];
            }
        }
        // Places that are images of each other: members that no other place is near, unfolded.
        let mut places: Vec<usize> = Vec::new();
        for member in &members {
            let far = |place: &usize| images.distance(pose(*place), pose(*member)) > NEAR;
            if places.len() <= MOST_PLACES && places.iter().all(far) {
                places.push(*member);
            }
        }
        let is_image = |place: &usize| images.nearest(pose(*place), pose(middle)).1 <= SAME;
        let places = if stability == Stability::Level {
            if members.len() < ENOUGH * places.len() { 1 } else { levels(rests, &places, images) }
        } else if places.iter().all(is_image) {
            places.len()
        } else {
            1
        };
        Self { members, middle, extent, places, held: own_held }
    }
}

/// The first level rest among the given rests, with its stability, of at most the given number of tests.
fn level(
    problem: &Problem,
    rests: &[RestEnd],
    members: impl Iterator<Item = usize>,
    seed: u64,
) -> Option<(usize, RestStability)> {
    let mut held = members.take(LEVEL_TRIES).map(|k| (k, stability::held(problem.pair(), &rests[k], seed)));
    held.find(|(_, held)| held.stability == Stability::Level)
}

/// Number of symmetric level regions that contain these places, each place within [`NEAR`] of another; 1 if
/// they are not images, or lie all over.
fn levels(rests: &[RestEnd], places: &[usize], images: &Images) -> usize {
    if places.len() > MOST_PLACES {
        return 1;
    }
    let pose = |k: usize| &rests[places[k]].pose;
    let mut sets = DisjointSets::new(places.len());
    for j in 0..places.len() {
        for k in 0..j {
            // Two places up to 2 `NEAR` apart may both be near a third place between them.
            if images.distance(pose(j), pose(k)) <= 2.0 * NEAR {
                sets.join(j as u32, k as u32);
            }
        }
    }
    let level: Vec<u32> = (0..places.len()).map(|k| sets.find(k as u32)).collect();
    let level = level.as_slice();
    let of = |set: u32| (0..places.len()).filter(move |k| level[*k] == set);
    let is_image = |k: usize| of(level[0]).any(|to| images.nearest(pose(k), pose(to)).1 <= NEAR);
    let result: BTreeSet<u32> = level.iter().copied().collect();
    if result.iter().all(|set| of(*set).any(is_image)) { result.len() } else { 1 }
}
