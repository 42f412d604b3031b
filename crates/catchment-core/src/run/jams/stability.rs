//! Stability of a rest: the rise of the potential energy when the half is displaced.
//!
//! ```text
//!   sharp      ╲  ╱     it rises in proportion to the push           contacts on all sides
//!   rounded    ╰──╯     with the square of the push                  curvature: rotation lifts it
//!   level     ──────    hardly at all                                only friction holds it
//!   ridge      ╱  ╲     it falls                                     the motion ended there by chance
//! ```
//!
//! The smallest rise over all directions is found by search: random directions, then variations of the best.
//! The true minimum may be lower.

use super::PUSH;
use super::rests::RestEnd;
use crate::acceptance::Stream;
use crate::contact::{FLUSH, Nearby, Pair};
use crate::pose::{CorPose, Dof, PoseError, rotation};
use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A slope below this is level: 0.06°, less than any friction.
const LEVEL: f64 = 1e-3;
/// Rise for a tenth of the displacement: a hundredth for a rounded rest, a tenth for a sharp one; the limit
/// between them.
const TENTH: f64 = 0.1;
const ROUNDED: f64 = 0.03;
/// A fall of this much counts, in D: above the rounding of heights.
const FALL: f64 = 1e-7;

/// Random directions that are tried, per free error, and moves about the best.
const TRIES: usize = 16;
const MOVES: u64 = 64;

/// Stability of a rest, by the change of height when it is displaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Stability {
    /// Height rises in proportion to the displacement, in every direction.
    Sharp,
    /// In some direction height rises with the square of the displacement.
    Rounded,
    /// In some direction height hardly rises.
    Level,
    /// In some direction height falls.
    Ridge,
}

impl Stability {
    /// The lower-case name used in files and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sharp => "sharp",
            Self::Rounded => "rounded",
            Self::Level => "level",
            Self::Ridge => "ridge",
        }
    }
}

/// Stability of a rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::run) struct RestStability {
    /// In a word.
    pub(in crate::run) stability: Stability,
    /// Smallest rise found of the COR for a displacement of [`PUSH`], in D; `None` if walls block every
    /// direction.
    pub(in crate::run) rise: Option<f64>,
    /// The direction of that displacement: offset of the COR in D and rotations in radians, per error; 0 if
    /// walls block it.
    pub(in crate::run) weakest: PoseError,
}

/// Change of the height around a rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::run) enum HeightAside {
    /// z of the COR, in D.
    At(f64),
    /// A wall is in the way.
    Blocked,
    /// Nothing carries it.
    Gone,
}

/// Directions in the errors that are free, unit in the metric of the motion.
pub(in crate::run) struct Space {
    free: Vec<Dof>,
    rho: f64,
    cor: f64,
    spherical: bool,
}

impl Space {
    pub(in crate::run) fn of(pair: &Pair) -> Self {
        let alignment = &pair.alignment;
        Self {
            free: alignment.free.iter().collect(),
            rho: alignment.rotation_length,
            cor: alignment.center_of_rotation,
            spherical: alignment.free.rotations() == 3,
        }
    }

    /// The pose of a pose error.
    pub(in crate::run) fn pose(&self, error: &PoseError) -> CorPose {
        CorPose::from_error(error, self.cor, self.free.iter().copied().collect())
    }

    /// The characteristic length, in D.
    pub(in crate::run) const fn rho(&self) -> f64 {
        self.rho
    }

    /// How many errors are free.
    pub(in crate::run) const fn count(&self) -> usize {
        self.free.len()
    }

    /// Along each single error, in both directions.
    pub(in crate::run) fn axes(&self) -> Vec<[f64; 5]> {
        let along = |dof: &Dof| {
            [1.0, -1.0].map(|sign| {
                let mut way = [0.0; 5];
                way[dof.index()] = sign;
                way
            })
        };
        self.free.iter().flat_map(along).collect()
    }

    /// Direction number k of a stream.
    pub(in crate::run) fn random(&self, stream: Stream, k: u64) -> [f64; 5] {
        /// Numbers that a direction takes.
        const EACH: u64 = 10;
        let mut way = [0.0; 5];
        for dof in &self.free {
            let j = EACH * k + 2 * dof.index() as u64;
            way[dof.index()] = normal(stream, j);
        }
        unit(way)
    }

    /// Direction and distance from a rest to another pose error; `None` if they are equal.
    pub(in crate::run) fn towards(&self, rest: &RestEnd, to: &PoseError) -> Option<[f64; 5]> {
        let (from, to) = (rest.error.to_array(), to.to_array());
        let mut way = [0.0; 5];
        for dof in &self.free {
            let scale = if dof.is_rotation() { self.rho } else { 1.0 };
            way[dof.index()] = scale * (to[dof.index()] - from[dof.index()]);
        }
        way.iter().any(|part| part.abs() > FALL).then(|| unit(way))
    }

    /// The pose after a displacement by `length` in a direction from a rest.
    pub(in crate::run) fn displaced(&self, rest: &RestEnd, way: &[f64; 5], length: f64) -> CorPose {
        let lateral = rest.pose.lateral + DVec2::new(way[0], way[1]) * length;
        let turn = [way[2], way[3], way[4]].map(|part| part * length / self.rho);
        let rotation = if self.spherical {
            let by = DVec3::from_array(turn);
            let angle = by.length();
            let by = by.try_normalize().map_or(DMat3::IDENTITY, |axis| DMat3::from_axis_angle(axis, angle));
            by * rest.pose.rotation
        } else {
            let PoseError { roll, pitch, yaw, .. } = rest.error;
            rotation(roll + turn[0], pitch + turn[1], yaw + turn[2])
        };
        CorPose { lateral, rotation }
    }

    /// The pose error of that pose. For angles that are not all free it is their sum, also beyond 90° of
    /// pitch; locked errors stay exactly 0.
    pub(in crate::run) fn error(&self, rest: &RestEnd, way: &[f64; 5], length: f64) -> PoseError {
        let pose = self.displaced(rest, way, length);
        let error = pose.to_error(self.cor);
        if self.spherical {
            return error;
        }
        let PoseError { roll, pitch, yaw, .. } = rest.error;
        let [roll, pitch, yaw] =
            [(roll, 2), (pitch, 3), (yaw, 4)].map(|(angle, k)| angle + way[k] * length / self.rho);
        PoseError { roll, pitch, yaw, ..error }
    }

    /// A direction as errors: D and radians.
    fn as_error(&self, way: &[f64; 5]) -> PoseError {
        let part = |k: usize| if k < 2 { way[k] } else { way[k] / self.rho };
        PoseError::from_array(std::array::from_fn(part))
    }
}

/// A direction moved by another.
pub(in crate::run) fn moved(way: &[f64; 5], by: &[f64; 5], share: f64) -> [f64; 5] {
    unit(std::array::from_fn(|k| way[k] + share * by[k]))
}

fn unit(way: [f64; 5]) -> [f64; 5] {
    let length = way.iter().map(|part| part * part).sum::<f64>().sqrt();
    if length > 0.0 { way.map(|part| part / length) } else { way }
}

/// A standard normal number from two of a stream (Box and Muller, 1958).
pub(in crate::run) fn normal(stream: Stream, j: u64) -> f64 {
    // In (0, 1]: its logarithm is finite.
    let radius = (-2.0 * libm::log(1.0 - stream.uniform(j))).sqrt();
    radius * libm::cos(std::f64::consts::TAU * stream.uniform(j + 1))
}

/// The height at a pose that is reached from no higher than `ceiling`.
pub(in crate::run) fn ground(nearby: &mut Nearby<'_>, pose: &CorPose, ceiling: f64) -> HeightAside {
    nearby.turn(&pose.rotation, pose.lateral, FLUSH, 0.0);
    let (below, covered) = nearby.height_below(pose.lateral, ceiling);
    match below {
        Some(z) if covered && nearby.overlaps(pose.lateral.extend(z)) => HeightAside::Blocked,
        Some(z) => HeightAside::At(z),
        None if covered => HeightAside::Blocked,
        None => HeightAside::Gone,
    }
}

/// Rises that count as climbing and not as a wall, per length: a slope of 87°.
pub(in crate::run) const STEEPEST: f64 = 20.0;

/// Stability of a rest.
pub(in crate::run) fn held(pair: &Pair, rest: &RestEnd, seed: u64) -> RestStability {
    let space = Space::of(pair);
    let mut nearby = pair.about(2.0 * PUSH);
    let mut rise = |way: &[f64; 5], push: f64| {
        let pose = space.displaced(rest, way, push);
        match ground(&mut nearby, &pose, rest.height + STEEPEST * push) {
            HeightAside::At(z) => pair.energy(&pose, z) - rest.energy,
            HeightAside::Blocked => f64::INFINITY,
            HeightAside::Gone => f64::NEG_INFINITY,
        }
    };
    let stream = Stream::new(seed).branch(PUSH.to_bits());
    let tries = (TRIES * space.count()) as u64;
    let ways = space.axes().into_iter().chain((0..tries).map(|k| space.random(stream, k)));
    let mut best = ([0.0; 5], f64::INFINITY);
    for way in ways {
        let result = rise(&way, PUSH);
        if result < best.1 {
            best = (way, result);
        }
    }
    if best.1 == f64::INFINITY {
        return RestStability { stability: Stability::Sharp, rise: None, weakest: PoseError::default() };
    }
    for k in 0..MOVES {
        // Smaller and smaller moves: from a radian to a hundredth.
        let share = 0.01f64.powf(k as f64 / MOVES as f64);
        let way = moved(&best.0, &space.random(stream, tries + k), share);
        if way == [0.0; 5] {
            // With a single free error a move may lead back to the start.
            continue;
        }
        let result = rise(&way, PUSH);
        if result < best.1 {
            best = (way, result);
        }
    }
    let (way, least) = best;
    let stability = if least < -FALL {
        Stability::Ridge
    } else if least < LEVEL * PUSH {
        Stability::Level
    } else if rise(&way, TENTH * PUSH) < ROUNDED * least {
        Stability::Rounded
    } else {
        Stability::Sharp
    };
    RestStability { stability, rise: least.is_finite().then_some(least), weakest: space.as_error(&way) }
}
