//! Rest of a chain with springs: a minimum of its energy, by damped Newton steps.
//!
//! ```text
//!   V(q) = Σ servo(q_k − command_k) + Σ ½ k stretch²        servo: quadratic, linear beyond the stall torque
//!   (Σ k slope·slopeᵀ + λ 1) Δq = −∇V                       Levenberg, Marquardt
//! ```
//!
//! A slack joint without a load keeps its angle: without a gradient nothing moves. Millimetres, newtons:
//! torques in N·mm.

use super::super::kinematics::{ModuleDimensions, PlanarPose, rotors};
use super::super::shape::LatchingPair;
use super::pair::{Change, Pair};
use super::{Event, FoldSettings, State};

/// N·mm in a N·m.
const MILLI: f64 = 1e3;

/// A chain on its way.
pub(super) struct Chain {
    body: ModuleDimensions,
    settings: FoldSettings,
    pub(super) angles: Vec<f64>,
    /// Commands to all joints; `None` is slack.
    pub(super) commanded: Vec<Option<f64>>,
    pub(super) pairs: Vec<Pair>,
}

impl Chain {
    pub(super) fn new(
        body: ModuleDimensions,
        modules: usize,
        latches: &[LatchingPair],
        settings: &FoldSettings,
    ) -> Self {
        Self {
            body,
            settings: *settings,
            angles: vec![0.0; modules],
            commanded: vec![Some(0.0); modules],
            pairs: latches.iter().map(|latch| Pair::new(*latch, settings.hooks)).collect(),
        }
    }

    pub(super) fn rotors(&self) -> Vec<PlanarPose> {
        rotors(&self.body, &self.angles)
    }

    /// States of all joints.
    pub(super) fn states(&self) -> Vec<State> {
        let servo = self.settings.servo;
        self.commanded
            .iter()
            .zip(&self.angles)
            .map(|(commanded, angle)| match commanded {
                None => State::Slack,
                Some(commanded) if servo.stiffness * (commanded - angle).abs() >= servo.torque => {
                    State::Stalled
                }
                Some(_) => State::Holding,
            })
            .collect()
    }

    /// Changes the first pair that has to change; returns whether there is one, and records latching events
    /// with `time_s`.
    pub(super) fn snap(&mut self, time_s: f64, events: &mut Vec<Event>) -> bool {
        let rotors = self.rotors();
        for pair in &mut self.pairs {
            let force_n = pair.press(&self.body, &rotors, &self.angles);
            let [lateral_mm, _, angle_rad] = pair.error(&self.body, &rotors, &self.angles);
            let driven = self.commanded[pair.latch.joints()].iter().all(Option::is_some);
            match pair.change(force_n, lateral_mm, driven) {
                Change::Nothing => {}
                Change::Realigned => return true,
                Change::Snapped(layers) => {
                    let (from, to) = (pair.latch.from, pair.latch.to);
                    events.push(Event { time_s, from, to, layers, force_n, lateral_mm, angle_rad });
                    return true;
                }
            }
        }
        false
    }

    /// Whether a pair is pressed far beyond the snap force of its next layer.
    pub(super) fn is_overpressed(&self) -> bool {
        /// Share of a force to which events are found.
        const SHARP: f64 = 1.01;
        let rotors = self.rotors();
        self.pairs.iter().any(|pair| {
            let lateral = pair.error(&self.body, &rotors, &self.angles)[0];
            pair.threshold(lateral)
                .is_some_and(|force| pair.press(&self.body, &rotors, &self.angles) > SHARP * force)
        })
    }

    /// Energy in N·mm, its gradient and the curvature of its springs.
    fn energy(&self, angles: &[f64]) -> (f64, Vec<f64>, Vec<Vec<f64>>) {
        let n = angles.len();
        let (stiffness, stall) = (MILLI * self.settings.servo.stiffness, MILLI * self.settings.servo.torque);
        let (mut energy, mut gradient, mut curvature) = (0.0, vec![0.0; n], vec![vec![0.0; n]; n]);
        for (k, (commanded, angle)) in self.commanded.iter().zip(angles).enumerate() {
            let Some(commanded) = commanded else { continue };
            let off = angle - commanded;
            if stiffness * off.abs() < stall {
                energy += 0.5 * stiffness * off * off;
                gradient[k] += stiffness * off;
                curvature[k][k] += stiffness;
            } else {
                energy += stall * (off.abs() - 0.5 * stall / stiffness);
                gradient[k] += stall * off.signum();
            }
        }
        let rotors = rotors(&self.body, angles);
        for pair in &self.pairs {
            for spring in pair.springs(&self.body, &rotors, angles) {
                energy += 0.5 * spring.stiffness * spring.stretch * spring.stretch;
                for i in pair.latch.joints() {
                    gradient[i] += spring.stiffness * spring.stretch * spring.slopes[i];
                    for j in pair.latch.joints() {
                        curvature[i][j] += spring.stiffness * spring.slopes[i] * spring.slopes[j];
                    }
                }
            }
        }
        (energy, gradient, curvature)
    }

    /// Goes to the rest that is near.
    pub(super) fn rest(&mut self) {
        /// Torque that no longer counts, in N·mm: a millionth of a servo's torque.
        const STILL: f64 = 1e-5;
        const MOST: usize = 2000;
        /// A step may turn a joint by this much, in radians: contact must be seen before it is passed.
        const LONGEST: f64 = 0.02;
        let scale = MILLI * self.settings.servo.stiffness;
        let mut damping = 1e-3 * scale;
        let (mut energy, mut gradient, mut curvature) = self.energy(&self.angles);
        for _ in 0..MOST {
            if gradient.iter().all(|g| g.abs() < STILL) {
                break;
            }
            let Some(mut step) = solved(&curvature, damping, &gradient) else { break };
            let longest = step.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
            if longest > LONGEST {
                for turn in &mut step {
                    *turn *= LONGEST / longest;
                }
            }
            let next: Vec<f64> = self.angles.iter().zip(&step).map(|(a, s)| a - s).collect();
            let tried = self.energy(&next);
            if tried.0 < energy {
                self.angles = next;
                (energy, gradient, curvature) = tried;
                damping = (0.2 * damping).max(1e-9 * scale);
            } else {
                damping *= 5.0;
                // The energy is flat to its rounding.
                if damping > 1e12 * scale {
                    break;
                }
            }
        }
    }
}

/// Solves `(m + damping·1) x = b` by Cholesky's factors; `None` if rounding leaves no positive pivot.
fn solved(m: &[Vec<f64>], damping: f64, b: &[f64]) -> Option<Vec<f64>> {
    let n = b.len();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            if i == j {
                let pivot = m[i][i] + damping - dot;
                if pivot <= 0.0 {
                    return None;
                }
                l[i][i] = pivot.sqrt();
            } else {
                l[i][j] = (m[i][j] - dot) / l[j][j];
            }
        }
    }
    let mut x = b.to_vec();
    for i in 0..n {
        let known: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
        x[i] = (x[i] - known) / l[i][i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - known) / l[i][i];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::super::super::shape::{ChainShape, latches};
    use super::super::pair::LatchedLayers;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The gradient is that of the energy, open and latched: central differences, whose rounding is 1e-10 of the energy.
        #[test]
        fn the_gradient_is_that_of_the_energy(off in proptest::collection::vec(-0.2..0.2f64, 6), held in 0usize..4) {
            const STEP: f64 = 1e-6;
            let angles = ChainShape::P.angles();
            let mut chain = Chain::new(ModuleDimensions::default(), 6, &latches(&angles), &FoldSettings::default());
            chain.commanded = vec![Some(0.0), Some(0.01), None, Some(-1.67), Some(-1.74), Some(0.0)];
            chain.pairs[0].held =
                [LatchedLayers::None, LatchedLayers::One { offset: 3.0 }, LatchedLayers::One { offset: 0.0 }, LatchedLayers::Both][held];
            let at: Vec<f64> = angles.iter().zip(&off).map(|(a, o)| a + o).collect();
            let (energy, gradient, _) = chain.energy(&at);
            for k in 0..6 {
                let moved = |step: f64| {
                    let mut angles = at.clone();
                    angles[k] += step;
                    chain.energy(&angles).0
                };
                let slope = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
                let slack = 1e-4 * gradient[k].abs() + 1e-8 * energy + 1.0;
                prop_assert!((slope - gradient[k]).abs() < slack, "{k}: {slope} for {}", gradient[k]);
            }
        }

        #[test]
        fn a_solution_solves(entries in proptest::collection::vec(-1.0..1.0f64, 36), b in proptest::collection::vec(-1.0..1.0f64, 6)) {
            // aᵀa + 1 is positive definite.
            let a: Vec<&[f64]> = entries.chunks(6).collect();
            let m: Vec<Vec<f64>> = (0..6).map(|i| (0..6).map(|j| a.iter().map(|r| r[i] * r[j]).sum()).collect()).collect();
            let x = solved(&m, 1.0, &b).unwrap();
            for i in 0..6 {
                let left = x[i] + m[i].iter().zip(&x).map(|(m, x)| m * x).sum::<f64>();
                prop_assert!((left - b[i]).abs() < 1e-12);
            }
        }
    }
}
