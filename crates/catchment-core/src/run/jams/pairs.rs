//! Pairs of features in contact in many rests, by name: the features to redesign.

use super::rests::{PoseFollower, RestEnd, RestFilter};
use super::{FeatureContact, NamedFeature};
use crate::contact::Features;
use crate::exec::{Cancelled, Exec};
use crate::method::descent;
use crate::pose::PoseError;
use crate::problem::Problem;
use std::collections::BTreeMap;

/// A pair of features, and in how many rests it touches.
#[derive(Debug, Clone, PartialEq)]
pub struct TouchingPair {
    /// In so many.
    pub count: usize,
    /// The feature of the fixed half, at its first contact; all features with its name are counted together.
    pub fixed: NamedFeature,
    /// The same of the moving half.
    pub moving: NamedFeature,
}

/// A pair of features on which poses stick, and at which frictions.
#[derive(Debug, Clone, PartialEq)]
pub struct Sticks {
    /// The pair, and on how many poses it touches.
    pub touching: TouchingPair,
    /// The critical frictions of these poses, ascending.
    pub critical: Vec<f64>,
}

/// The features in contact at stuck poses, each followed at its own friction coefficient, with these
/// coefficients; and the number of stuck poses.
pub fn stuck_pairs(
    problem: &Problem,
    poses: &[(PoseError, f64)],
    exec: &Exec,
) -> Result<(usize, Vec<Sticks>), Cancelled> {
    let features = Features::of(problem.pair());
    let motions = descent::DescentSettings::default();
    let follow = PoseFollower { problem, features: &features, motions: &motions, which: RestFilter::Jams };
    let rest = |k: usize| {
        let (pose, friction) = poses[k];
        let settings = descent::DescentSettings { friction, ..descent::DescentSettings::default() };
        let rested = follow.rested(&descent::settle(problem.pair(), &pose, &settings));
        rested.map(|rested| (rested, friction))
    };
    let rests = exec.map(poses.len(), rest)?;
    let (rests, frictions): (Vec<RestEnd>, Vec<f64>) = rests.into_iter().flatten().unzip();
    let sticks = touching(problem, &features, &rests).into_iter().map(|(touching, at)| {
        let mut critical: Vec<f64> = at.into_iter().map(|k| frictions[k]).collect();
        critical.sort_by(f64::total_cmp);
        Sticks { touching, critical }
    });
    Ok((rests.len(), sticks.collect()))
}

/// The pairs of features in contact in rests and the numbers of these rests, by name, most frequent first: a
/// designer changes all features with the same name together.
pub(super) fn touching(
    problem: &Problem,
    features: &Features,
    rests: &[RestEnd],
) -> Vec<(TouchingPair, Vec<usize>)> {
    let mut pairs: BTreeMap<[String; 2], (TouchingPair, Vec<usize>)> = BTreeMap::new();
    for (number, rest) in rests.iter().enumerate() {
        for met in &rest.met {
            let touching = || {
                let FeatureContact { fixed, moving, .. } = rest.name(problem, features, met);
                (TouchingPair { count: 0, fixed, moving }, Vec::new())
            };
            let (pair, at) = pairs.entry(RestEnd::names(features, met)).or_insert_with(touching);
            if at.last() != Some(&number) {
                at.push(number);
                pair.count += 1;
            }
        }
    }
    let mut pairs: Vec<(TouchingPair, Vec<usize>)> = pairs.into_values().collect();
    // A stable sort: equal counts stay in the order of their names.
    pairs.sort_by_key(|(pair, _)| std::cmp::Reverse(pair.count));
    pairs
}
