//! Holding forces of whole faces: closed forms, symmetries, errors.

use super::*;
use catchment_core::design::read;
use std::f64::consts::{FRAC_PI_4, SQRT_2};
use std::path::Path;

/// A load of 10⁻⁷ of the push that is not balanced counts as zero.
const EXACT: f64 = 2e-6;

fn problem(connector: &str, rest: &str) -> Problem {
    let text = format!("[connector]\n{connector}\n[alignment]\nrotation_length = 0.5\n{rest}");
    Problem::of(read(&text, Path::new("")).unwrap().design).unwrap()
}

fn holding_forces(problem: &Problem, settings: &HoldSettings) -> HoldingForces {
    run(problem, settings, &Exec::new()).unwrap()
}

fn guided(of: &LoadLimits) -> f64 {
    of.smooth.unwrap().guided.unwrap()
}

fn free(of: &LoadLimits) -> f64 {
    of.smooth.unwrap().free.unwrap()
}

/// AR times the preload along x and y, AR/√2 at 45° the weakest; a twist AR/2 of it times D.
#[test]
fn the_spatial_x_face_at_thirty_degrees() {
    let ratio = 3f64.sqrt().recip();
    let problem = problem(&format!("family = \"x-face-3d\"\naspect_ratio = {ratio}"), "");
    let found = holding_forces(&problem, &HoldSettings::default());
    for side in &found.sideways {
        // |x| + |y| = AR bounds the holding force, as h = AR·max(|x|, |y|).
        let expected = ratio / (side.direction_rad.cos().abs() + side.direction_rad.sin().abs());
        let slope = ratio * side.direction_rad.cos().abs().max(side.direction_rad.sin().abs());
        assert!((guided(&side.withstood) - slope).abs() < EXACT, "{side:?}");
        assert!(free(&side.withstood) < expected + EXACT, "{side:?}");
    }
    let weakest = found.weakest.smooth_guided.unwrap();
    assert!((guided(&weakest.withstood) - ratio / SQRT_2).abs() < EXACT, "{weakest:?}");
    assert!((weakest.direction_rad.rem_euclid(2.0 * FRAC_PI_4) - FRAC_PI_4).abs() < 1e-3, "{weakest:?}");
    for torque in found.torques.iter().filter(|torque| torque.axis == Dof::Yaw) {
        assert!((guided(&torque.withstood) - ratio / 2.0).abs() < EXACT, "{torque:?}");
    }
}

/// With free tilt the holding force is at most that of guided motion, with friction at least that without,
/// and equal in all directions for a face with four equal sides.
#[test]
fn holding_forces_are_ordered_and_symmetric() {
    let problem = problem("family = \"pyramid\"\naspect_ratio = 0.5", "center_of_rotation = 0.3\n");
    let settings = HoldSettings { friction: 0.2, directions: 24, ..HoldSettings::default() };
    let found = holding_forces(&problem, &settings);
    let all =
        found.sideways.iter().map(|side| side.withstood).chain(found.torques.iter().map(|t| t.withstood));
    for withstood in all {
        let value = |column| withstood.column(column).unwrap_or(f64::INFINITY);
        for (less, more) in [(1, 0), (3, 2), (0, 2), (1, 3)] {
            assert!(value(less) <= value(more) + EXACT, "{less} {more} {withstood:?}");
        }
    }
    for (k, side) in found.sideways.iter().enumerate() {
        let turned = &found.sideways[(k + 6) % 24];
        let mirrored = &found.sideways[(24 - k) % 24];
        for other in [turned, mirrored] {
            for column in 0..2 {
                let [a, b] = [side, other].map(|side| side.withstood.column(column).unwrap());
                assert!((a - b).abs() < EXACT, "{column}: {side:?} {other:?}");
            }
        }
    }
}

/// Pushed at the height of the centre of rotation a flat plate slides, far above it tips: D/2 over the lever.
#[test]
fn a_long_lever_tips_the_half() {
    let text = "[connector]\nwidth = 1.0\n[[connector.fixed.parts]]\nbox = [2.0, 2.0, 0.5]\n[[connector.moving.parts]]\n\
                box = [1.0, 1.0, 0.5]\n[alignment]\nrotation_length = 0.5\nfree = [\"x\", \"roll\", \"pitch\"]\n\
                [docked]\nx = 1.0\n[errors]\nx = 0.1\n";
    let problem = Problem::of(read(text, Path::new("")).unwrap().design).unwrap();
    let at = |lever: f64| {
        let settings = HoldSettings { lever, friction: 0.4, ..HoldSettings::default() };
        holding_forces(&problem, &settings).sideways[0].withstood.rough.unwrap().free.unwrap()
    };
    // Slides at the friction, or tips about the edge.
    assert!((at(0.0) - 0.4).abs() < EXACT && (at(1.0) - 0.4).abs() < EXACT, "{} {}", at(0.0), at(1.0));
    assert!((at(5.0) - 0.1).abs() < EXACT, "{}", at(5.0));
}

/// Released at a pose error it comes to rest elsewhere, and is held there.
#[test]
fn a_released_half_is_held_at_its_rest() {
    let problem = problem("family = \"v-face\"\naspect_ratio = 1.0", "");
    let pose = PoseError { x: 0.1, pitch: 0.05, ..PoseError::default() };
    let home = holding_forces(&problem, &HoldSettings { pose: Some(pose), ..HoldSettings::default() });
    assert_eq!(home.outcome, Outcome::Aligned);
    let mated = holding_forces(&problem, &HoldSettings::default());
    for (a, b) in home.sideways.iter().zip(&mated.sideways) {
        assert!((guided(&a.withstood) - guided(&b.withstood)).abs() < 1e-3, "{a:?} {b:?}");
    }
    // In all five errors motion ends short of the last corners.
    for (connector, pose) in [
        ("family = \"x-face-3d\"\naspect_ratio = 0.5773502691896258", [0.1, 0.05, 0.0, 0.0, 0.0]),
        ("family = \"pyramid\"\naspect_ratio = 0.5", [0.05, 0.1, 0.1, 0.1, 0.2]),
    ] {
        let problem = self::problem(connector, "");
        for friction in [0.0, 0.2] {
            let settings = HoldSettings { friction, directions: 8, ..HoldSettings::default() };
            let mated = holding_forces(&problem, &settings);
            let home = holding_forces(
                &problem,
                &HoldSettings { pose: Some(PoseError::from_array(pose)), ..settings },
            );
            for (a, b) in home.sideways.iter().zip(&mated.sideways) {
                let (a, b) = (guided(&a.withstood), guided(&b.withstood));
                assert!((a - b).abs() < 1e-6, "{connector}, friction {friction}: {a} {b}");
            }
        }
    }
    let off = PoseError { x: 3.0, ..PoseError::default() };
    let refused = run(&problem, &HoldSettings { pose: Some(off), ..HoldSettings::default() }, &Exec::new());
    assert_eq!(refused.unwrap_err(), HoldError::NoRest { outcome: Outcome::Missed });
}

#[test]
fn threads_change_nothing_and_invalid_settings_are_refused() {
    let problem = problem("family = \"pyramid\"", "");
    let settings = HoldSettings { friction: 0.1, directions: 12, ..HoldSettings::default() };
    let with = |threads| run(&problem, &settings, &Exec::new().with_threads(threads).unwrap()).unwrap();
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(4));
    let refused = |settings: HoldSettings| run(&problem, &settings, &Exec::new()).unwrap_err();
    let default = HoldSettings::default;
    assert!(matches!(refused(HoldSettings { friction: -0.1, ..default() }), HoldError::Friction(_)));
    assert!(matches!(
        refused(HoldSettings { directions: 3, ..default() }),
        HoldError::Directions { directions: 3 }
    ));
    assert!(matches!(
        refused(HoldSettings { lever: f64::NAN, ..default() }),
        HoldError::Length { what: "lever", .. }
    ));
    assert!(matches!(
        refused(HoldSettings { play: 0.0, ..default() }),
        HoldError::Length { what: "play", .. }
    ));
    let exec = Exec::new();
    exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert!(matches!(run(&problem, &settings, &exec), Err(HoldError::Cancelled(_))));
}
