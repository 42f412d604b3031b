//! Poses followed to their rests, with the features in contact there.

use super::escape::EscapeCriterion;
use super::stability::{Space, Stability};
use super::{Cluster, Examined, FeatureContact, NamedFeature, PUSH, escape, stability};
use crate::acceptance::{Outcome, Stream};
use crate::connector::HalfRole;
use crate::contact::{Contact, Features};
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{self, Follower, Holding, Rest, Sticking, immobility};
use crate::pose::{CorPose, PoseError, angle_between, face_from_cor, step_length};
use crate::problem::Problem;
use crate::tolerance;
use glam::DVec3;
use std::collections::BTreeMap;

/// Contact points closer than this are equal, in D.
const SAME_PLACE: f64 = tolerance::TOUCHING;
/// Displacement of rests in the test whether they come back, in the metric of the motion, in D.
const OFF: f64 = 5e-3;
/// Pushes per free error.
const PUSHES: usize = 4;

/// The ends that count as rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::run) enum RestFilter {
    /// Those that did not dock.
    Jams,
    /// All.
    All,
}

/// Parameters for following poses.
pub(in crate::run) struct PoseFollower<'a> {
    pub(in crate::run) problem: &'a Problem,
    pub(in crate::run) features: &'a Features,
    /// How.
    pub(in crate::run) motions: &'a descent::DescentSettings,
    pub(in crate::run) which: RestFilter,
}

/// The rest at the end of a motion.
#[derive(Debug, Clone)]
pub(in crate::run) struct RestEnd {
    pub(in crate::run) outcome: Outcome,
    pub(in crate::run) error: PoseError,
    pub(in crate::run) pose: CorPose,
    pub(in crate::run) height: f64,
    /// The potential energy there, in D.
    pub(in crate::run) energy: f64,
    /// Gaps up to this touch, in D.
    pub(in crate::run) touching: f64,
    /// The contacts, by pairs of features in their order.
    pub(in crate::run) met: Vec<FeatureMeeting>,
    /// The classes of these pairs, sorted.
    pub(in crate::run) signature: Vec<[u32; 2]>,
}

/// Two features that touch.
#[derive(Debug, Clone)]
pub(in crate::run) struct FeatureMeeting {
    pub(in crate::run) features: [u32; 2],
    pub(in crate::run) contacts: Vec<Contact>,
}

/// The classes of two features.
pub(in crate::run) fn classes(features: &Features, [fixed, moving]: [u32; 2]) -> [u32; 2] {
    [features.class(HalfRole::Fixed, fixed), features.class(HalfRole::Moving, moving)]
}

impl PoseFollower<'_> {
    /// Follows every pose; to its rest, if requested.
    pub(in crate::run) fn all(
        &self,
        poses: &[PoseError],
        exec: &Exec,
    ) -> Result<Vec<(Outcome, Option<RestEnd>)>, Cancelled> {
        let tally = exec.tally(poses.len(), "motions");
        let follow = |follower: &mut Follower<'_>, k: usize| {
            let rest = self.end(follower, &poses[k]);
            tally.add(1);
            (rest.outcome, self.rested(&rest))
        };
        exec.map_with(poses.len(), || Follower::new(self.problem.pair(), self.motions), follow)
    }

    /// Follows a pose as far as needed.
    fn end(&self, follower: &mut Follower<'_>, pose: &PoseError) -> Rest {
        match self.which {
            RestFilter::Jams => follower.settle(pose),
            RestFilter::All => follower.come_to_rest(pose),
        }
    }

    fn is_rest(&self, outcome: Outcome) -> bool {
        outcome == Outcome::Jammed || self.which == RestFilter::All && outcome == Outcome::Aligned
    }

    pub(super) fn rested(&self, rest: &Rest) -> Option<RestEnd> {
        let height = rest.height.filter(|_| self.is_rest(rest.outcome))?;
        let pose = self.problem.pair().pose(&rest.error);
        let energy = self.problem.pair().energy(&pose, height);
        let mut by_pair: BTreeMap<[u32; 2], Vec<Contact>> = BTreeMap::new();
        for (contact, meeting) in &rest.contacts {
            let pair = self.features.meeting(contact, meeting, &pose.rotation);
            let contacts = by_pair.entry(pair).or_default();
            if contacts.iter().all(|other| other.point.distance(contact.point) > SAME_PLACE) {
                contacts.push(*contact);
            }
        }
        let met: Vec<FeatureMeeting> =
            by_pair.into_iter().map(|(features, contacts)| FeatureMeeting { features, contacts }).collect();
        let mut signature: Vec<[u32; 2]> =
            met.iter().map(|met| classes(self.features, met.features)).collect();
        signature.sort_unstable();
        let Rest { outcome, error, touching, .. } = *rest;
        Some(RestEnd { outcome, error, pose, height, energy, touching, met, signature })
    }

    /// Stability of a rest, its escape path, and whether it comes back after a displacement; with the end of
    /// the motion after the escape.
    pub(in crate::run) fn examine(
        &self,
        rest: &RestEnd,
        cluster: &Cluster,
        seed: u64,
    ) -> (Examined, Option<PoseError>) {
        let pair = self.problem.pair();
        let space = Space::of(pair);
        let held = cluster.held.unwrap_or_else(|| stability::held(pair, rest, seed));
        let mut follower = Follower::new(pair, self.motions);
        let stream = Stream::new(seed).branch(OFF.to_bits());
        let displaced = PUSHES * space.count();
        let rho = pair.alignment.rotation_length;
        let returned = (0..displaced).filter(|k| {
            let way = space.random(stream, *k as u64);
            let end = self.end(&mut follower, &space.error(rest, &way, OFF));
            let pose = pair.pose(&end.error);
            let off = step_length(
                pose.lateral - rest.pose.lateral,
                angle_between(&pose.rotation, &rest.pose.rotation),
                rho,
            );
            self.is_rest(end.outcome) && off <= 2.0 * OFF
        });
        let returned = returned.count();
        let leaving = match self.which {
            RestFilter::Jams => EscapeCriterion::Jam,
            RestFilter::All => EscapeCriterion::Rest { is_level: held.stability == Stability::Level },
        };
        let mut holding = Holding::at_rest(pair, &rest.error, rest.height, rest.touching);
        let immobility = holding.as_ref().and_then(|holding| immobility(pair, holding, &rest.error, seed));
        let sticking = match immobility {
            // Contacts alone hold it: only whether it wedges is open.
            Some(_) => holding.as_mut().map(|holding| Sticking {
                holds_from: Some(0.0),
                slips_until: Some(0.0),
                wedges_from: holding.wedges_from(),
            }),
            None => holding.as_mut().map(Holding::sticking),
        };
        let (escape_path, end) = escape::escape_path(pair, rest, self.motions, leaving, seed).unzip();
        let examined = Examined {
            stability: held.stability,
            push_d: PUSH,
            rise_at_most_d: held.rise,
            weakest: held.weakest,
            immobility,
            sticks: sticking,
            escape_path,
            displaced,
            returned,
        };
        (examined, end)
    }
}

impl RestEnd {
    /// Everything that touches, named.
    pub(in crate::run) fn touched(&self, problem: &Problem, features: &Features) -> Vec<FeatureContact> {
        self.met.iter().map(|met| self.name(problem, features, met)).collect()
    }

    /// The names of two features that touch.
    pub(in crate::run) fn names(features: &Features, met: &FeatureMeeting) -> [String; 2] {
        let [fixed, moving] = met.features;
        [features.get(HalfRole::Fixed, fixed).name(), features.get(HalfRole::Moving, moving).name()]
    }

    /// Two features that touch, named.
    pub(in crate::run) fn name(
        &self,
        problem: &Problem,
        features: &Features,
        met: &FeatureMeeting,
    ) -> FeatureContact {
        let face = {
            let cor = self.pose.lateral.extend(self.height);
            cor + face_from_cor(&self.pose.rotation, problem.alignment().center_of_rotation)
        };
        let first = met.contacts.first().map_or(DVec3::ZERO, |contact| contact.point);
        let named = |side, number: u32, in_frame: DVec3| {
            let feature = features.get(side, number);
            let part = part_of(problem, side, in_frame);
            NamedFeature {
                kind: feature.kind,
                name: feature.name(),
                part,
                drawn_d: problem.drawn(side, in_frame).to_array(),
            }
        };
        let [fixed, moving] = met.features;
        FeatureContact {
            normal: met.contacts.first().map_or(DVec3::Z, |contact| contact.normal).to_array(),
            fixed: named(HalfRole::Fixed, fixed, first),
            moving: named(HalfRole::Moving, moving, self.pose.rotation.transpose() * (first - face)),
            points_d: met.contacts.iter().map(|contact| contact.point.to_array()).collect(),
        }
    }
}

/// The number of the part that contains a point of a half, in its frame; if every part is a single solid.
fn part_of(problem: &Problem, side: HalfRole, point: DVec3) -> Option<usize> {
    use crate::design::{ConnectorSpec, HalfSpec};
    let ConnectorSpec::Own(own) = &problem.design().connector else { return None };
    let (spec, half) = match side {
        HalfRole::Fixed => (&own.fixed, &problem.connector().fixed),
        HalfRole::Moving => (&own.moving, &problem.connector().moving),
    };
    let HalfSpec::Parts(parts) = spec else { return None };
    let nearest = half.solids().iter().map(|solid| solid.distance(point)).enumerate();
    let nearest = nearest.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(part, _)| part);
    nearest.filter(|_| parts.len() == half.solids().len())
}
