//! Bounds over boxes of poses compared with exact poses and motions.

use super::survey::Survey;
use super::tests::{numbers, pair_of, random_box};
use super::*;
use crate::contact::brute;
use crate::design::Family;
use crate::method::descent;
use crate::pose::{CorPose, PoseError};

/// Heights lie between floor and roof, and the carrying contacts are among the recorded contacts, with
/// height, slope and push within their bounds.
fn assert_bounds_hold(pair: &Pair, boxes: usize, most: f64) {
    let bodies = Bodies::of(pair);
    let all: Vec<u32> = (0..bodies.meetings.len() as u32).collect();
    let (mut number, mut nearby) = (numbers(17), pair.about(REACH));
    let mut touched = 0;
    for _ in 0..boxes {
        let (poses, error) = random_box(pair, most, &mut number);
        let survey = Survey::of(&bodies, &poses, &all, &mut nearby);
        let alignment = &pair.alignment;
        let pose = CorPose::from_error(&error, alignment.center_of_rotation, alignment.free);
        let Some(height) = brute::height(pair, &pose) else {
            assert!(survey.height.is_none() || survey.sudden, "{error:?} passes by in {poses:?}");
            continue;
        };
        touched += 1;
        let bounds = survey.height.expect("something carries");
        assert!(bounds.widened(1e-9).contains(height), "{height} at {error:?} not in {bounds:?}");
        let carries = |touch: &&super::touch::Touch| touch.height.widened(1e-9).contains(height);
        assert!(survey.touches.iter().any(|touch| carries(&touch)), "nothing carries {error:?}");
        // Compare with the gradient of the exact contact, if it is the only contact.
        let mut found = Vec::new();
        let cor = pose.lateral.extend(height);
        pair.at_rotation(pose.rotation).contacts(cor, 1e-9, &mut found);
        let Some(contact) =
            found.first().filter(|c| found.iter().all(|o| o.normal.distance(c.normal) < 1e-9))
        else {
            continue;
        };
        let ([gx, gy], _) = contact.gradient(cor);
        let slopes = |touch: &super::touch::Touch| {
            let within = |dof: Dof, value: f64| {
                !alignment.free.contains(dof)
                    || touch.slope(dof).is_none_or(|slope| slope.widened(1e-6).contains(value))
            };
            within(Dof::X, gx) && within(Dof::Y, gy)
        };
        assert!(
            survey.touches.iter().any(|t| carries(&t) && slopes(t)),
            "no touch slopes by {gx}, {gy} at {error:?}"
        );
    }
    assert!(touched > boxes / 10, "{touched} of {boxes}");
}

#[test]
fn bounds_hold_exact_heights_and_slopes() {
    for family in [Family::VFace, Family::XFace, Family::SFace] {
        for most in [0.2, 0.02, 1e-4] {
            assert_bounds_hold(&pair_of(family, &[], 0.3), 300, most);
        }
    }
    for most in [0.2, 0.02] {
        assert_bounds_hold(&pair_of(Family::Pyramid, &[], -0.4), 150, most);
        assert_bounds_hold(&pair_of(Family::XFace3d, &[], 0.5), 150, most);
    }
}

/// Beyond this distance nothing touches, for any centre of rotation: no motion returns from there.
#[test]
fn halves_have_no_contact_at_the_passing_distance() {
    for cor in [-1.5, -0.5, 0.0, 0.5, 1.5] {
        for family in [Family::Pyramid, Family::XFace3d, Family::SFace] {
            let pair = pair_of(family, &[], cor);
            let passing = tree::passing(&Bodies::of(&pair));
            let mut number = numbers(31);
            for _ in 0..300 {
                let (_, mut error) = random_box(&pair, 1.0, &mut number);
                error.x = passing * if number() < 0.5 { 1.0 } else { -1.0 };
                let pose = CorPose::from_error(&error, cor, pair.alignment.free);
                assert_eq!(brute::height(&pair, &pose), None, "{family:?}, COR {cor}: {error:?}");
            }
        }
    }
}

/// No exact motion goes back along a bearing while it is in a box that excludes it.
#[test]
fn motions_never_go_back_along_a_bearing() {
    // Tolerance per step for the curvature of the path.
    const BENDS: f64 = 1e-5;
    for pair in [
        pair_of(Family::VFace, &[], 0.3),
        pair_of(Family::Pyramid, &[Dof::X, Dof::Y, Dof::Yaw], 0.0),
        pair_of(Family::XFace3d, &[], 0.5),
    ] {
        let bodies = Bodies::of(&pair);
        let tree = Tree::over(&pair.alignment, &bodies);
        let all: Vec<u32> = (0..bodies.meetings.len() as u32).collect();
        let (mut number, mut nearby) = (numbers(23), pair.about(REACH));
        let (mut excluded, mut steps) = (0, 0);
        for _ in 0..150 {
            let (poses, error) = random_box(&pair, 0.1, &mut number);
            let rising = Survey::of(&bodies, &poses, &all, &mut nearby).rising(&tree.bearings);
            excluded += rising.count_ones();
            let settings = descent::DescentSettings { step: 1e-3, ..descent::DescentSettings::default() };
            let way = descent::trace(&pair, &error, &settings).waypoints;
            let inside = |error: &PoseError| (0..5).all(|k| poses[k].contains(error.to_array()[k]));
            for two in way.windows(2).take_while(|two| two.iter().all(|point| inside(&point.error))) {
                steps += 1;
                for bearing in (0..tree.bearings.len()).filter(|bearing| rising >> bearing & 1 == 1) {
                    let along = |point: &descent::Waypoint| {
                        tree.bearings.range(bearing, &point.error.to_array().map(Interval::thin))[0]
                    };
                    assert!(
                        along(&two[1]) >= along(&two[0]) - BENDS,
                        "{two:?} bearing {bearing} in {poses:?}"
                    );
                }
            }
        }
        assert!(excluded > 150 && steps > 300, "{excluded} {steps}");
    }
}
