//! The push of a motion: a generalized force and its potential energy.
//!
//! ```text
//!        push(s) = −∇ energy(s)         in coordinates (x, y, z, ρ·roll, ρ·pitch, ρ·yaw) of the COR
//!
//!          │ push                        energy falls along a motion; if no displacement that the contacts admit
//!          ▼                             lowers it, the half rests
//!       ╲  ○  ╱
//!        ╲___╱                           constant push: energy is the height of the COR
//! ```
//!
//! The push is constant, of unit size and along −z through the COR: the force that brings the halves
//! together. Its size cancels in quasi-static motion, so energies are in D. Both functions take the state, so
//! that pose-dependent forces (a weight off the COR, springs, magnets) can be added here.
//!
//! Not promised: that [`super::sliding`] moves along any other push while the halves do not touch; it
//! searches the first contact below.

use super::motion::State;
use super::projection::{MAX_COORDINATES, Vector, dot};

/// The push that brings the halves together.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Push;

/// Along −z.
const DOWN: Vector = {
    let mut down = [0.0; MAX_COORDINATES];
    down[2] = -1.0;
    down
};

impl Push {
    /// The generalized force at a state, of unit size.
    #[expect(clippy::unused_self, reason = "a constant push has no parameters")]
    pub(super) const fn at(self, _: &State) -> Vector {
        DOWN
    }

    /// The potential energy at a state, in D.
    #[expect(clippy::unused_self, reason = "a constant push has no parameters")]
    pub(super) const fn energy(self, state: &State) -> f64 {
        state.cor.z
    }

    /// By how much a displacement from a state lowers the energy, to first order, in D.
    pub(super) fn work(self, state: &State, displacement: &Vector) -> f64 {
        dot(&self.at(state), displacement)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DQuat, DVec3};

    #[test]
    fn the_push_is_the_gradient_of_its_energy() {
        let at =
            |cor: DVec3| State { cor, rotation: DMat3::IDENTITY, spin: DQuat::IDENTITY, angles: [0.0; 3] };
        let (push, state, step) = (Push, at(DVec3::new(0.1, -0.2, 0.3)), 1e-3);
        for (k, axis) in DVec3::AXES.into_iter().enumerate() {
            let ahead = push.energy(&at(state.cor + step * axis));
            let slope = (ahead - push.energy(&state)) / step;
            assert!((push.at(&state)[k] + slope).abs() < 1e-12);
            let mut displacement = [0.0; MAX_COORDINATES];
            displacement[k] = step;
            assert!((push.energy(&state) - ahead - push.work(&state, &displacement)).abs() < 1e-15);
        }
    }
}
