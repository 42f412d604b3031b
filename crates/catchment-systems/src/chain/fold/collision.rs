//! Detection of overlapping modules.
//!
//! ```text
//!        ┌───────┬───────┐
//!        │ back  ● front │      a module: two rectangles that meet at its rotor, as wide as the face
//!        └───────┴───────┘
//! ```
//!
//! Halves of the same module may overlap (its joint is there), as may halves joined by a link, and modules
//! that latch with each other: those press. Faces and their brackets are ignored.

use super::super::kinematics::{ModuleDimensions, PlanarPose, direction, left};
use super::super::shape::LatchingPair;
use glam::DVec2;

/// A rectangle: centre and half axes.
struct Block {
    centre: DVec2,
    axes: [DVec2; 2],
}

/// Overlap that rounding makes of touching, in mm.
const TOUCH: f64 = 1e-6;

/// The first two modules that do not latch with each other and whose rotors are nearer than half a pitch.
pub(super) fn in_one_cell(
    body: &ModuleDimensions,
    rotors: &[PlanarPose],
    latches: &[LatchingPair],
) -> Option<(usize, usize)> {
    let mut pairs = (1..rotors.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let near = |(a, b): &(usize, usize)| {
        let pressed = latches.iter().any(|l| (l.from, l.to) == (a + 1, b + 1));
        !pressed && (rotors[*a].place() - rotors[*b].place()).length() < 0.5 * body.pitch
    };
    pairs.find(near).map(|(a, b)| (a + 1, b + 1))
}

/// The first two modules that overlap.
pub(super) fn first(
    body: &ModuleDimensions,
    rotors: &[PlanarPose],
    angles: &[f64],
    latches: &[LatchingPair],
) -> Option<(usize, usize)> {
    let halves: Vec<[Block; 2]> =
        rotors.iter().zip(angles).map(|(r, angle)| halves(body, r, *angle)).collect();
    // No two modules farther apart overlap.
    let reach = body.length.hypot(body.face);
    for b in 1..rotors.len() {
        for a in 0..b {
            let apart = (rotors[a].place() - rotors[b].place()).length();
            if apart > reach || latches.iter().any(|l| (l.from, l.to) == (a + 1, b + 1)) {
                continue;
            }
            let hit = halves[a].iter().enumerate().any(|(i, one)| {
                let joined = |j: usize| b == a + 1 && i == 1 && j == 0;
                halves[b].iter().enumerate().any(|(j, other)| !joined(j) && overlap(one, other))
            });
            if hit {
                return Some((a + 1, b + 1));
            }
        }
    }
    None
}

/// Back and front of a module.
fn halves(body: &ModuleDimensions, rotor: &PlanarPose, angle: f64) -> [Block; 2] {
    let half = |heading: f64| {
        let along = 0.25 * body.length * direction(heading);
        let across = 0.5 * body.face * left(direction(heading));
        Block { centre: rotor.place() + along, axes: [along, across] }
    };
    [half(rotor.heading - angle + std::f64::consts::PI), half(rotor.heading)]
}

/// Whether two rectangles overlap: no side of either parts them.
fn overlap(a: &Block, b: &Block) -> bool {
    let apart = b.centre - a.centre;
    a.axes.iter().chain(&b.axes).all(|axis| {
        let unit = axis.normalize_or_zero();
        let reach: f64 = a.axes.iter().chain(&b.axes).map(|half| half.dot(unit).abs()).sum();
        apart.dot(unit).abs() < reach - TOUCH
    })
}

#[cfg(test)]
mod tests {
    use super::super::super::kinematics::rotors;
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    fn collides(angles: &[f64]) -> Option<(usize, usize)> {
        let body = ModuleDimensions::default();
        first(&body, &rotors(&body, angles), angles, &[])
    }

    #[test]
    fn a_straight_chain_and_a_lattice_are_free_and_a_ring_of_four_bites_its_tail() {
        let q = -FRAC_PI_2;
        assert_eq!(collides(&[0.0; 20]), None);
        assert_eq!(collides(&[0.0, 0.0, 0.0, q, q, 0.0]), None);
        assert_eq!(collides(&[0.0, q, q, q, q]), Some((1, 5)));
        let cell = |angles: &[f64]| {
            in_one_cell(&ModuleDimensions::default(), &rotors(&ModuleDimensions::default(), angles), &[])
        };
        assert_eq!((cell(&[0.0, q, q, q, q]), cell(&[0.0, 0.0, 2.6, 0.0])), (Some((1, 5)), None));
        // A fold of 150° lays a module onto the previous module.
        assert!(collides(&[0.0, 0.0, 2.6, 0.0]).is_some());
    }

    proptest! {
        /// The reference: points of a lattice in one rectangle that lie in the other.
        #[test]
        fn overlap_agrees_with_points(x in -60.0..60.0f64, y in -60.0..60.0f64, turn in -3.0..3.0f64) {
            let block = |centre: DVec2, turn: f64| Block { centre, axes: [20.0 * direction(turn), 10.0 * left(direction(turn))] };
            let (a, b) = (block(DVec2::ZERO, 0.3), block(DVec2::new(x, y), turn));
            let inside = |p: DVec2, r: &Block, slack: f64| r.axes.iter().all(|h| {
                ((p - r.centre).dot(h.normalize())).abs() < h.length() + slack
            });
            let any = |slack: f64| (-40..=40).any(|i| (-40..=40).any(|j| {
                let p = b.centre + f64::from(i) / 40.0 * b.axes[0] + f64::from(j) / 40.0 * b.axes[1];
                inside(p, &a, slack)
            }));
            // The lattice's cells are 1 × ½ mm: a point within the diagonal of a cell of every point of b.
            if any(0.0) { prop_assert!(overlap(&a, &b)); }
            if !any(1.2) { prop_assert!(!overlap(&a, &b)); }
        }
    }
}
