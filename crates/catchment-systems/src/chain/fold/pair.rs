//! A pair of faces: its contact, its latches, and the snapping of a layer.

use super::super::kinematics::{ModuleDimensions, PlanarPose, direction, left, swing, wrapped};
use super::super::shape::LatchingPair;
use super::Hooks;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Latched layers of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum LatchedLayers {
    /// No layer.
    None,
    /// One layer; the pair rests `offset` mm across the face from its aligned pose while the other layer
    /// rides beside its trench.
    One {
        /// Offset of the rest.
        offset: f64,
    },
    /// Both.
    Both,
}

/// A pair of faces of a chain.
#[derive(Debug, Clone)]
pub(super) struct Pair {
    pub(super) latch: LatchingPair,
    pub(super) hooks: Hooks,
    pub(super) held: LatchedLayers,
    /// Largest pressing force so far.
    pub(super) most: f64,
}

/// Change of a pair.
pub(super) enum Change {
    /// It is as it was.
    Nothing,
    /// Its riding hook is free: it rests aligned.
    Realigned,
    /// So many layers hold now.
    Snapped(usize),
}

/// A spring: its elongation, the derivative by every joint, and its stiffness.
pub(super) struct Spring {
    pub(super) stretch: f64,
    pub(super) slopes: Vec<f64>,
    pub(super) stiffness: f64,
}

/// Faces closer than this may touch.
const FACING: f64 = 1.0;
/// Layers of a face.
const LAYERS: f64 = 2.0;

impl Pair {
    pub(super) const fn new(latch: LatchingPair, hooks: Hooks) -> Self {
        Self { latch, hooks, held: LatchedLayers::None, most: 0.0 }
    }

    pub(super) const fn layers(&self) -> usize {
        match self.held {
            LatchedLayers::None => 0,
            LatchedLayers::One { .. } => 1,
            LatchedLayers::Both => 2,
        }
    }

    /// Lateral offset, gap and angle of the arriving face, and the axes of the waiting face.
    fn seen([waiting, arriving]: [PlanarPose; 2]) -> ([f64; 3], glam::DVec2, glam::DVec2) {
        let normal = direction(waiting.heading);
        let across = -left(normal);
        let apart = arriving.place() - waiting.place();
        (
            [apart.dot(across), apart.dot(normal), wrapped(arriving.heading - waiting.heading - PI)],
            across,
            normal,
        )
    }

    /// Lateral offset in mm, gap in mm, angle in radians.
    pub(super) fn error(&self, body: &ModuleDimensions, rotors: &[PlanarPose], angles: &[f64]) -> [f64; 3] {
        Self::seen(self.latch.faces(body, rotors, angles)).0
    }

    /// The springs between the two faces.
    pub(super) fn springs(
        &self,
        body: &ModuleDimensions,
        rotors: &[PlanarPose],
        angles: &[f64],
    ) -> Vec<Spring> {
        let faces = self.latch.faces(body, rotors, angles);
        let ([lateral, gap, angle], across, normal) = Self::seen(faces);
        let slopes = |at: glam::DVec2, along: glam::DVec2| {
            let mut slopes = vec![0.0; angles.len()];
            for joint in self.latch.joints() {
                slopes[joint] = swing(rotors[joint].place(), at).dot(along);
            }
            slopes
        };
        let turning = || {
            let mut slopes = vec![0.0; angles.len()];
            slopes[self.latch.joints()].fill(1.0);
            slopes
        };
        let at = faces[1].place();
        match self.held {
            LatchedLayers::None => {
                // Faces that lie behind each other do not touch, such as the two ends of a straight chain.
                if lateral.abs() >= body.face || angle.abs() >= FACING || gap <= -body.overhang {
                    return Vec::new();
                }
                let edge = 0.5 * body.face * left(direction(faces[1].heading));
                [at - edge, at + edge]
                    .into_iter()
                    .filter_map(|at| {
                        let stretch = (at - faces[0].place()).dot(normal);
                        let stiffness = 0.5 * self.hooks.compression;
                        (stretch < 0.0).then(|| Spring { stretch, slopes: slopes(at, normal), stiffness })
                    })
                    .collect()
            }
            LatchedLayers::One { .. } | LatchedLayers::Both => {
                let (offset, layers) = match self.held {
                    LatchedLayers::One { offset } => (offset, 1.0),
                    _ => (0.0, LAYERS),
                };
                let stiffness = self.hooks.extension * layers / LAYERS;
                // Spread evenly over the width of the face.
                let bending = stiffness * body.face * body.face / 12.0;
                vec![
                    Spring { stretch: lateral - offset, slopes: slopes(at, across), stiffness },
                    Spring { stretch: gap, slopes: slopes(at, normal), stiffness },
                    Spring { stretch: angle, slopes: turning(), stiffness: bending },
                ]
            }
        }
    }

    /// How hard the faces press, in N.
    pub(super) fn press(&self, body: &ModuleDimensions, rotors: &[PlanarPose], angles: &[f64]) -> f64 {
        let springs = self.springs(body, rotors, angles);
        let of = |s: &Spring| (-s.stiffness * s.stretch).max(0.0);
        match self.held {
            LatchedLayers::None => springs.iter().map(of).sum(),
            _ => springs.get(1).map_or(0.0, of),
        }
    }

    /// The pressing force that snaps the next layer, or both; `None` if a hook rides or both hold.
    pub(super) fn threshold(&self, lateral: f64) -> Option<f64> {
        let Hooks { force, overhang, .. } = self.hooks;
        match self.held {
            LatchedLayers::None if lateral.abs() > 0.5 * overhang => Some(force),
            LatchedLayers::None => Some(LAYERS * force),
            LatchedLayers::One { offset } if offset != 0.0 => None,
            LatchedLayers::One { .. } => Some(force),
            LatchedLayers::Both => None,
        }
    }

    /// The change caused by a pressing force and an offset; `driven` is true if no joint between the faces is
    /// slack.
    pub(super) fn change(&mut self, press: f64, lateral: f64, driven: bool) -> Change {
        self.most = self.most.max(press);
        let overhang = self.hooks.overhang;
        let Some(needed) = self.threshold(lateral) else {
            let rides = matches!(self.held, LatchedLayers::One { .. });
            if rides && !driven {
                self.held = LatchedLayers::One { offset: 0.0 };
                return Change::Realigned;
            }
            return Change::Nothing;
        };
        if press < needed {
            return Change::Nothing;
        }
        let off_centre = lateral.abs() > 0.5 * overhang;
        self.held = match self.held {
            LatchedLayers::None if off_centre => {
                LatchedLayers::One { offset: lateral.clamp(-overhang, overhang) }
            }
            _ => LatchedLayers::Both,
        };
        Change::Snapped(self.layers())
    }
}
