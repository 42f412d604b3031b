//! Rests of known order: fingers, plates, a wedge between two fingers.

use super::holding::{Holding, TOUCHING};
use super::{Immobility, ImmobilityOrder, immobility};
use crate::connector::Connector;
use crate::contact::Pair;
use crate::design::{Alignment, ConnectorSpec, Design, HalfSpec, OwnSpec};
use crate::pose::{Dof, DofSet, Mount, PoseError};

const RHO: f64 = 0.5;

/// Corners of a profile in x and z, 1 D deep along y.
fn prism(profile: &[[f64; 2]]) -> Vec<[f64; 3]> {
    profile.iter().flat_map(|[x, z]| [[*x, -0.5, *z], [*x, 0.5, *z]]).collect()
}

/// Both halves drawn facing up, their faces at a height of 1.
fn pair(fixed: Vec<Vec<[f64; 3]>>, moving: Vec<Vec<[f64; 3]>>, free: &[Dof], cor: f64) -> Pair {
    let own = OwnSpec::new(1.0, HalfSpec::Pieces(fixed), HalfSpec::Pieces(moving));
    let free: DofSet = free.iter().copied().collect();
    let alignment =
        Alignment { center_of_rotation: cor, rotation_length: RHO, ..Alignment::new(free, Mount::Y) };
    let design =
        Design { name: "test".into(), connector: ConnectorSpec::Own(own), width: 1.0, unit: None, alignment };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

fn mated(pair: &Pair) -> Immobility {
    let held = Holding::at(pair, &PoseError::default(), TOUCHING).unwrap();
    immobility(pair, &held, &PoseError::default(), 1).unwrap()
}

/// A finger: a spike with its tip at a height of 1.
fn finger(x: f64, y: f64) -> Vec<[f64; 3]> {
    let foot = |dx: f64, dy: f64| [x + dx, y + dy, 0.0];
    vec![[x, y, 1.0], foot(0.05, 0.0), foot(-0.03, 0.04), foot(-0.03, -0.04)]
}

fn plate() -> Vec<[f64; 3]> {
    prism(&[[-0.5, 0.5], [0.5, 0.5], [0.5, 1.0], [-0.5, 1.0]])
}

/// Three fingers at r from the middle of a plate: the least slope is that towards the middle of a side of their triangle, r/2 over ρ.
#[test]
fn three_fingers_hold_a_plate_by_their_triangle() {
    let radius = 0.3f64;
    let fingers = [0.0f64, 120.0, 240.0].map(|degrees| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        finger(radius * cos, radius * sin)
    });
    let tilts = [Dof::Roll, Dof::Pitch];
    let result = mated(&pair(fingers.to_vec(), vec![plate()], &tilts, 0.0));
    assert_eq!(result.order, ImmobilityOrder::First);
    assert!(result.slope.iter().all(|slope| (slope - 0.5 * radius / RHO).abs() < 1e-6), "{result:?}");
    // Free to slide and spin it does so, to any order.
    let result = mated(&pair(fingers.to_vec(), vec![plate()], &Dof::ALL, 0.0));
    assert_eq!((result.order, result.free), (ImmobilityOrder::Neutral, 3), "{result:?}");
    assert!(result.curvature.unwrap().abs() < 1e-6, "{result:?}");
}

/// A plate on two fingers in a line, its centre of rotation held above or below them, c in front of its face: tilted by θ its height is −c/cos θ, so that κ = −c/ρ².
#[test]
fn a_plate_on_two_fingers_stands_with_its_weight_above() {
    for (cor, order) in [(-0.4f64, ImmobilityOrder::Second), (0.4, ImmobilityOrder::Unstable)] {
        let fingers = vec![finger(0.0, 0.3), finger(0.0, -0.3)];
        let result = mated(&pair(fingers, vec![plate()], &[Dof::Pitch], cor));
        assert_eq!((result.order, result.free), (order, 1), "{result:?}");
        assert!((result.curvature.unwrap() + cor / RHO.powi(2)).abs() < 1e-5, "{result:?}");
    }
}

/// A wedge of half-angle β, apex down, between two fingers 2a apart: its apex moves on a circle of radius R =
/// a/sin 2β by twice its rotation, so that a weight at L above it is at −R cos 2θ + L cos θ, and rotates
/// about the intersection of both normals, 2R above the apex.
#[test]
fn a_wedge_between_two_fingers_stands_below_four_radii() {
    let (a, beta) = (0.2f64, 50f64.to_radians());
    let (below, radius) = (a / beta.tan(), a / (2.0 * beta).sin());
    let wedge = prism(&[[0.0, 1.0 + below], [beta.tan(), below], [-beta.tan(), below]]);
    let spike = |x: f64| prism(&[[x, 1.0], [x + 0.02, 0.0], [x - 0.02, 0.0]]);
    for (share, order) in [
        (2.0, ImmobilityOrder::Second),
        (3.5, ImmobilityOrder::Second),
        (4.0, ImmobilityOrder::Neutral),
        (5.0, ImmobilityOrder::Unstable),
    ] {
        let weight = share * radius;
        let pair =
            pair(vec![spike(a), spike(-a)], vec![wedge.clone()], &[Dof::X, Dof::Pitch], below - weight);
        let result = mated(&pair);
        let expected = (4.0 * radius - weight) / ((2.0 * radius - weight).powi(2) + RHO * RHO);
        assert_eq!((result.order, result.free), (order, 1), "{share}: {result:?} {expected}");
        assert!((result.curvature.unwrap() - expected).abs() < 1e-5, "{share}: {result:?} {expected}");
    }
}
