//! Accumulation of the errors of a chain at a face.
//!
//! ```text
//!   (lateral, normal, angle) of the arriving face, relative to the waiting face:
//!
//!             n  normal: a gap, which is not in the area of acceptance; the chain must be able to reach
//!             ▲
//!        ─────┼─────▶ e    n × e: e lies to the right of n; lateral along e, angle to the left
//!        waiting face
//!
//!   first order   Σ over terms of gradient · gradientᵀ · variance
//!   exactly       kinematics with the sampled errors
//! ```
//!
//! Joint errors are independent and normal; an encoder's step is uniform; links and the base may have errors
//! as well; a lateral force on the face bends every joint by its compliance, always in the same direction. A
//! pair that is already latched has no error: the joints between its faces yield and take the angles that the
//! latched pair requires, so they no longer contribute.
//!
//! Millimetres, radians. Source: the dissertation gives no formula; these are elementary.

use super::kinematics::{ModuleDimensions, PlanarPose, direction, left, rotors, rotors_with, swing, wrapped};
use super::random::{Draws, Term};
use super::shape::{LatchingPair, ModuleFace};
use catchment::exec::{Cancelled, Exec};
use glam::DVec2;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Sizes of the errors of a chain: the joint's own first, all others optional.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ChainErrors {
    /// Standard deviation of a joint's angle, in radians.
    pub joint_sigma: f64,
    /// Step of the encoders, in radians: a uniform angle error of up to half a step.
    pub encoder_step: f64,
    /// Standard deviation of the length of a link, in mm.
    pub link_sigma: f64,
    /// Standard deviation of the base's heading, in radians.
    pub base_sigma: f64,
    /// Standard deviation of the base's x, and of its y, in mm.
    pub base_offset_sigma: f64,
    /// Compliance of a joint, in radians per newton metre.
    pub compliance: f64,
    /// Force along e on the arriving face, in newtons.
    pub side_force: f64,
}

/// A face that arrives at a waiting face.
#[derive(Debug, Clone, PartialEq)]
pub struct Closing {
    body: ModuleDimensions,
    angles: Vec<f64>,
    waiting: PlanarPose,
    module: usize,
    side: ModuleFace,
    /// Joints and links that may be wrong, counted from 0.
    joints: Vec<usize>,
    links: Vec<usize>,
    with_base: bool,
}

/// Mean and covariance of (lateral mm, normal mm, angle rad).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Covariance {
    /// Mean error.
    pub mean: [f64; 3],
    /// Covariance.
    pub matrix: [[f64; 3]; 3],
}

impl Covariance {
    /// Standard deviations of lateral (mm), normal (mm) and angle (rad).
    pub fn sigmas(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.matrix[k][k].sqrt())
    }

    /// Correlation of lateral offset and angle; 0 if either is constant.
    pub fn correlation(&self) -> f64 {
        /// Rounding of a dozen terms that cancel.
        const NOTHING: f64 = 1e-12;
        let [lateral, _, angle] = self.sigmas();
        let product = lateral * angle;
        if product > 0.0 && (self.matrix[0][2] / product).abs() > NOTHING {
            self.matrix[0][2] / product
        } else {
            0.0
        }
    }

    /// Of a sample; divides by the count.
    pub fn of(errors: &[[f64; 3]]) -> Self {
        let count = errors.len().max(1) as f64;
        let mean = [0, 1, 2].map(|k| errors.iter().map(|e| e[k]).sum::<f64>() / count);
        let about = |e: &[f64; 3], k: usize| e[k] - mean[k];
        let entry = |i, j| errors.iter().map(|e| about(e, i) * about(e, j)).sum::<f64>() / count;
        Self { mean, matrix: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))) }
    }
}

impl Closing {
    /// The last face of a straight chain of `modules`, with its partner at the nominal pose.
    pub fn straight(body: ModuleDimensions, modules: usize) -> Self {
        let angles = vec![0.0; modules];
        let tip = ModuleFace::Front.of(&body, &rotors(&body, &angles), &angles, modules);
        Self {
            body,
            waiting: tip.ahead(PI, 0.0),
            module: modules,
            side: ModuleFace::Front,
            joints: (0..modules).collect(),
            links: (0..modules.saturating_sub(1)).collect(),
            with_base: true,
            angles,
        }
    }

    /// A latch of a folded chain, after those of `earlier` hold.
    pub fn latch(
        body: ModuleDimensions,
        angles: &[f64],
        latch: &LatchingPair,
        earlier: &[LatchingPair],
    ) -> Self {
        let rotors = rotors(&body, angles);
        let held = |joint: usize| earlier.iter().any(|e| e.joints().contains(&joint));
        let spanned = |link: usize| earlier.iter().any(|e| (e.from - 1..e.to - 1).contains(&link));
        let [waiting, _] = latch.faces(&body, &rotors, angles);
        Self {
            body,
            waiting,
            module: latch.to,
            side: latch.to_side,
            joints: latch.joints().filter(|k| !held(*k)).collect(),
            links: (latch.from - 1..latch.to - 1).filter(|k| !spanned(*k)).collect(),
            with_base: false,
            angles: angles.to_vec(),
        }
    }

    /// Joints that may be wrong, numbered from 1.
    pub fn joints(&self) -> Vec<usize> {
        self.joints.iter().map(|k| k + 1).collect()
    }

    /// Lever arms of each joint between the faces relative to the docking face: its distance from the line
    /// through the face along e, which is the lever of a pressing force, and its distance from the face
    /// centre, both in mm.
    pub fn levers(&self) -> Vec<(usize, f64, f64)> {
        let (rotors, at) = self.nominal();
        let normal = direction(self.waiting.heading);
        let of = |k: &usize| {
            let rotor = rotors[*k].place();
            (k + 1, swing(rotor, at).dot(normal).abs(), (at - rotor).length())
        };
        self.joints.iter().map(of).collect()
    }

    fn nominal(&self) -> (Vec<PlanarPose>, DVec2) {
        let rotors = rotors(&self.body, &self.angles);
        let at = self.side.of(&self.body, &rotors, &self.angles, self.module).place();
        (rotors, at)
    }

    /// Lateral, normal and angle of an arriving face.
    fn seen(&self, arriving: PlanarPose) -> [f64; 3] {
        let normal = direction(self.waiting.heading);
        let apart = arriving.place() - self.waiting.place();
        let angle = wrapped(arriving.heading - self.waiting.heading - PI);
        [apart.dot(-left(normal)), apart.dot(normal), angle]
    }

    /// Deflection of each joint by the side force, in their order.
    fn bent(&self, errors: &ChainErrors) -> Vec<f64> {
        const METRE: f64 = 1e3;
        let (rotors, at) = self.nominal();
        let across = -left(direction(self.waiting.heading));
        let moment = |k: &usize| errors.side_force * swing(rotors[*k].place(), at).dot(across) / METRE;
        self.joints.iter().map(|k| errors.compliance * moment(k)).collect()
    }

    /// Mean and covariance, to first order in the errors.
    pub fn first_order(&self, errors: &ChainErrors) -> Covariance {
        /// Variance of a uniform error of full width 1.
        const UNIFORM: f64 = 1.0 / 12.0;
        let (rotors, at) = self.nominal();
        let normal = direction(self.waiting.heading);
        let gradient = |moves: DVec2, turns: f64| [moves.dot(-left(normal)), moves.dot(normal), turns];
        let turned = |at_rotor: DVec2| gradient(swing(at_rotor, at), 1.0);
        let joint = errors.joint_sigma.powi(2) + UNIFORM * errors.encoder_step.powi(2);
        let mut terms: Vec<([f64; 3], f64)> =
            self.joints.iter().map(|k| (turned(rotors[*k].place()), joint)).collect();
        let mut mean = [0.0; 3];
        for ((gradient, _), bent) in terms.iter().zip(self.bent(errors)) {
            for (mean, slope) in mean.iter_mut().zip(gradient) {
                *mean += slope * bent;
            }
        }
        let along = |k: &usize| (gradient(rotors[*k].along(), 0.0), errors.link_sigma.powi(2));
        terms.extend(self.links.iter().map(along));
        if self.with_base {
            terms.push((turned(rotors[0].place()), errors.base_sigma.powi(2)));
            terms.extend([DVec2::X, DVec2::Y].map(|a| (gradient(a, 0.0), errors.base_offset_sigma.powi(2))));
        }
        let entry = |i: usize, j: usize| terms.iter().map(|(g, v)| g[i] * g[j] * v).sum::<f64>();
        Covariance { mean, matrix: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))) }
    }

    /// Lateral, normal and angle of a random chain, by exact kinematics.
    pub fn drawn(&self, errors: &ChainErrors, draws: Draws) -> [f64; 3] {
        self.drawn_bent(errors, &self.bent(errors), draws)
    }

    fn drawn_bent(&self, errors: &ChainErrors, bent: &[f64], draws: Draws) -> [f64; 3] {
        let mut angles = self.angles.clone();
        for (k, bent) in self.joints.iter().zip(bent) {
            angles[*k] += errors.joint_sigma * draws.normal(Term::Joint(*k)) + bent;
            if errors.encoder_step > 0.0 {
                angles[*k] += errors.encoder_step * draws.uniform(Term::Encoder(*k));
            }
        }
        let base = if self.with_base {
            let [heading, x, y] = [0, 1, 2].map(|k| draws.normal(Term::Base(k)));
            PlanarPose {
                x: errors.base_offset_sigma * x,
                y: errors.base_offset_sigma * y,
                heading: errors.base_sigma * heading,
            }
        } else {
            PlanarPose::default()
        };
        let link = |k: usize| {
            let off = if errors.link_sigma > 0.0 && self.links.contains(&k) {
                errors.link_sigma * draws.normal(Term::Link(k))
            } else {
                0.0
            };
            self.body.pitch + off
        };
        let rotors = rotors_with(base, &angles, link);
        self.seen(self.side.of(&self.body, &rotors, &angles, self.module))
    }

    /// Lateral, normal and angle of many random chains; chain k does not depend on their number.
    ///
    /// # Errors
    /// The computation was cancelled.
    pub fn cloud(
        &self,
        errors: &ChainErrors,
        seed: u64,
        chains: u64,
        exec: &Exec,
    ) -> Result<Vec<[f64; 3]>, Cancelled> {
        let bent = self.bent(errors);
        exec.map(chains as usize, |k| self.drawn_bent(errors, &bent, Draws::of(seed, k as u64)))
    }
}

/// Standard deviation of the last face's lateral offset, in mm: a straight chain with independent joint errors `sigma`.
///
/// Σ (j a + b)² over j < n; `σ a √(n (4n² − 1) / 12)` for b = ½ a.
pub fn lateral_sigma(body: &ModuleDimensions, modules: usize, sigma: f64) -> f64 {
    let (n, a, b) = (modules as f64, body.pitch, body.overhang);
    let squares = a * a * (n - 1.0) * n * (2.0 * n - 1.0) / 6.0 + a * b * n * (n - 1.0) + n * b * b;
    sigma * squares.sqrt()
}

/// Standard deviation of the last face's heading, in radians.
pub fn heading_sigma(modules: usize, sigma: f64) -> f64 {
    sigma * (modules as f64).sqrt()
}

#[cfg(test)]
mod tests;
