//! The push of a pair: a generalized force on the moving half, and its potential energy.
//!
//! ```text
//!        push = −∇ energy               in coordinates (x, y, z, ρ·roll, ρ·pitch, ρ·yaw) of the COR
//!
//!          │ push                        energy falls along a motion; if no displacement that the contacts admit
//!          ▼                             lowers it, the half rests
//!       ╲  ○  ╱
//!        ╲___╱                           constant push: energy is the height of the COR
//! ```
//!
//! The push is constant, of unit size and along −z through the COR: the force that brings the halves
//! together. Its size cancels in quasi-static motion, so energies are in D. Motions, the seat, the order of
//! cells in confluence, and escape paths read these functions, so that pose-dependent forces (a weight off
//! the COR, springs, magnets) can be added here.
//!
//! Not promised: the same of methods that read heights of a grid or of polytopes as energies: `flood`,
//! `meyer`, `transport`, `partition`, `zraa`, `certified`, `kinematic`; nor of motions of tight pairs while
//! the halves do not touch, which search the first contact below.

use super::Pair;
use crate::pose::{CorPose, PoseError};
use glam::{DMat3, DVec2};

impl Pair {
    /// The generalized force at a pose with the COR at this height in D, of unit size.
    pub const fn push(&self, _: &CorPose, _height: f64) -> [f64; 6] {
        [0.0, 0.0, -1.0, 0.0, 0.0, 0.0]
    }

    /// The potential energy at a pose with the COR at this height, both in D. It increases with the height.
    pub const fn energy(&self, _: &CorPose, height: f64) -> f64 {
        height
    }

    /// The height of the COR at which the potential energy at a pose has this value, both in D.
    pub const fn height_at(&self, _: &CorPose, energy: f64) -> f64 {
        energy
    }

    /// The potential energy at a pose error with the COR at this height, both in D.
    pub fn energy_at(&self, error: &PoseError, height: f64) -> f64 {
        self.energy(&self.pose(error), height)
    }

    /// The potential energy of the mated pose, in D; −∞ if the halves pass each other by.
    pub const fn mated_energy(&self) -> f64 {
        self.energy(&CorPose { lateral: DVec2::ZERO, rotation: DMat3::IDENTITY }, self.mated_height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use glam::DVec3;

    #[test]
    fn the_push_is_the_gradient_of_its_energy() {
        let alignment = Alignment::default_for(Some(Family::Pyramid));
        let connector = ConnectorSpec::Family(FamilySpec::new(Family::Pyramid));
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
        let pose = |cor: DVec3| CorPose { lateral: cor.truncate(), rotation: DMat3::IDENTITY };
        let energy = |cor: DVec3| pair.energy(&pose(cor), cor.z);
        let (cor, step) = (DVec3::new(0.1, -0.2, 0.3), 1e-3);
        let push = pair.push(&pose(cor), cor.z);
        for (k, axis) in DVec3::AXES.into_iter().enumerate() {
            let slope = (energy(cor + step * axis) - energy(cor)) / step;
            assert!((push[k] + slope).abs() < 1e-12);
        }
        assert!((pair.height_at(&pose(cor), energy(cor)) - cor.z).abs() < 1e-15);
    }
}
