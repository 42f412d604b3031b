//! The X-Face as a solid: layers of finite thickness with a gap, so that y matters.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::acceptance::{FailureReason, Outcome};
use catchment::contact::mated::MatedProblem;
use catchment::design::family::XFace;
use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use catchment::method::descent::{self, DescentSettings};
use catchment::pose::{Dof, DofSet, PoseError};
use catchment::problem::Problem;
use proptest::prelude::*;

/// Thickness and gap of the layers, in D.
const THICK: f64 = 0.4;
const GAP: f64 = 0.2;

fn problem(free: &[Dof], layers: Option<[f64; 2]>, docked_y: f64) -> Problem {
    let free: DofSet = free.iter().copied().collect();
    let mut alignment = Alignment {
        free,
        center_of_rotation: 0.5,
        rotation_length: 1.0,
        ..Alignment::default_for(Some(Family::XFace))
    };
    if free.contains(Dof::Y) {
        alignment.docked.limits[Dof::Y.index()] = Some(docked_y);
    }
    for dof in [Dof::Roll, Dof::Yaw].into_iter().filter(|dof| free.contains(*dof)) {
        alignment.docked.limits[dof.index()] = Some(0.7);
    }
    let face = XFace {
        aspect_ratio: 1.0,
        layer_thickness: layers.map(|layers| layers[0]),
        layer_gap: layers.map(|layers| layers[1]),
        ..XFace::DEFAULT
    };
    let connector = ConnectorSpec::Family(face.into());
    Problem::of(Design { name: String::new(), connector, width: 1.0, unit: None, alignment }).unwrap()
}

fn fate(problem: &Problem, error: PoseError) -> (Outcome, Option<FailureReason>) {
    let end = descent::outcome(problem.pair(), &error, &DescentSettings::default());
    (end.outcome, FailureReason::of(problem, end.outcome, &end.error))
}

/// The default value, written explicitly, equals the default to the bit.
#[test]
fn the_default_layers_are_unchanged() {
    let halves = |layers| problem(&[Dof::X, Dof::Pitch], layers, 0.0).connector().clone();
    let default = halves(None);
    assert_eq!(default, halves(Some([XFace::DEFAULT_LAYER_THICKNESS, XFace::DEFAULT_LAYER_GAP])));
    let mut places: Vec<u64> = default.fixed.surfaces[0].vertices.iter().map(|v| v.y.to_bits()).collect();
    places.extend(default.fixed.surfaces[1].vertices.iter().map(|v| v.y.to_bits()));
    places.sort_unstable();
    places.dedup();
    assert_eq!(places, [0.05f64, 0.5, -0.05, -0.5].map(f64::to_bits));
    // Defaults stay out of the digest, so that it equals that of all earlier versions.
    let spec = FamilySpec::new(Family::XFace);
    assert!(!spec.has_depth() && spec.is_layered());
}

/// Rotations locked, offset x = s: up to the gap a layer touches only its partner, and slides home from |s| < 1. Beyond it
/// and up to a layer's thickness it also touches the wrong layer, height H(1 − |s|) against H|s|: it jams at |s| = ½. Beyond
/// that it touches only the wrong layer, until both layers are past each other: it slides off.
#[test]
fn the_range_of_y_has_a_closed_form() {
    let flat = problem(&[Dof::X, Dof::Y], Some([THICK, GAP]), GAP);
    for s in [-0.9, -0.3, 0.1, 0.7] {
        for sign in [-1.0, 1.0] {
            let at = |y: f64| fate(&flat, PoseError { x: s, y: sign * y, ..PoseError::default() });
            for y in [0.0, 0.5 * GAP, GAP - 1e-6] {
                assert_eq!(at(y), (Outcome::Aligned, None), "{s} {y}");
            }
            for y in [GAP + 1e-6, 0.3, THICK - 1e-6] {
                assert_eq!(at(y), (Outcome::Jammed, Some(FailureReason::Crossed)), "{s} {y}");
            }
            for y in [THICK + 1e-6, GAP + 2.0 * THICK - 1e-6, GAP + 2.0 * THICK + 1e-6] {
                assert_eq!(at(y), (Outcome::Missed, None), "{s} {y}");
            }
        }
    }
    let end = descent::outcome(
        flat.pair(),
        &PoseError { x: 0.3, y: 0.3, ..PoseError::default() },
        &DescentSettings::default(),
    );
    assert!((end.error.x.abs() - 0.5).abs() < 1e-6 && (end.error.y - 0.3).abs() < 1e-9, "{end:?}");
}

/// The plan view decides which layers touch: y up to the gap, yaw up to 2·atan(gap/D), where the low corner of a layer comes
/// over the high corner of the wrong layer. Turned the other way, high corners come over low ones, and do not touch.
#[test]
fn partners_meet_up_to_the_gap_and_its_angle() {
    let all = problem(&Dof::ALL, Some([THICK, GAP]), GAP);
    let limit = 2.0 * GAP.atan();
    for (share, crosses) in [(0.5, false), (0.999, false), (1.001, true), (1.2, true)] {
        let yaw = PoseError { yaw: share * limit, ..PoseError::default() };
        let off = |y: f64| PoseError { y, ..PoseError::default() };
        for error in [off(share * GAP), off(-share * GAP), yaw] {
            assert_eq!(all.pair().crosses(&error), crosses, "{error:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// No loss while |y| is less than the gap: a pose has the outcome of its planar pose.
    #[test]
    fn y_errors_within_the_gap_change_no_outcome(
        x in -1.0f64..1.0, y in -0.999f64..0.999, pitch in -1.3f64..1.3,
    ) {
        let solid = problem(&[Dof::X, Dof::Y, Dof::Pitch], Some([THICK, GAP]), GAP);
        let plane = problem(&[Dof::X, Dof::Pitch], None, 0.0);
        let error = PoseError { x, pitch, ..PoseError::default() };
        let (flat, reason) = fate(&solid, PoseError { y: y * GAP, ..error });
        prop_assert_eq!(flat, fate(&plane, error).0);
        prop_assert_eq!(reason, None);
    }
}

/// With small errors in roll, pitch, x and y it still docks, and y stays within the gap.
#[test]
fn roll_is_corrected_as_well() {
    let free = [Dof::X, Dof::Y, Dof::Roll, Dof::Pitch];
    let solid = problem(&free, Some([THICK, GAP]), GAP);
    assert_eq!(solid.mated_warnings(), []);
    let error = PoseError { x: 0.2, y: 0.05, roll: 0.05, pitch: 0.1, yaw: 0.0 };
    let end = descent::Follower::new(solid.pair(), &DescentSettings::default()).rest(&error);
    assert_eq!(end.outcome, Outcome::Aligned, "{end:?}");
    assert!(end.error.x.abs() < 0.01 && end.error.y.abs() < GAP, "{end:?}");
    assert!(end.error.roll.abs() < 0.02 && end.error.pitch.abs() < 0.02, "{end:?}");
}

/// Ramps of opposite slope side by side turn the halves: with yaw free the aligned pose is no rest, and the halves turn until the
/// walls of the layers touch, at 2·atan(gap/D).
#[test]
fn free_yaw_turns_until_walls_meet() {
    let all = problem(&Dof::ALL, Some([THICK, GAP]), GAP);
    assert!(
        matches!(all.mated_warnings(), [MatedProblem::NotMinimum { .. }, ..]),
        "{:?}",
        all.mated_warnings()
    );
    let end = descent::Follower::new(all.pair(), &DescentSettings::default()).rest(&PoseError::default());
    // At rest within the step of the motion, about 1e-5.
    assert!((end.error.yaw - 2.0 * GAP.atan()).abs() < 1e-4, "{end:?}");
}
