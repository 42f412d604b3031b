//! Rests of pairs with known rests.

use super::*;
use crate::design::read;
use crate::pose::PoseError;
use std::f64::consts::{FRAC_PI_2, SQRT_2};
use std::fmt::Write;
use std::path::Path;

fn problem(text: &str) -> Problem {
    Problem::of(read(text, Path::new("")).unwrap().design).unwrap()
}

fn rests(problem: &Problem, motions: usize) -> Rests {
    run(problem, &RestsSettings { motions: Some(motions), ..RestsSettings::default() }, &Exec::new()).unwrap()
}

fn depth(place: &RestPlace) -> f64 {
    place.examined.unwrap().escape_path.unwrap().climb
}

/// Its centre of rotation in its middle; `errors` far enough to fall on its sides.
const CUBE: &str = "[connector]\nwidth = 1.0\n[[connector.fixed.parts]]\nbox = [6.0, 6.0, 0.5]\n[[connector.moving.parts]]\n\
                    box = [1.0, 1.0, 1.0]\n[alignment]\nfree = [\"pitch\"]\ncenter_of_rotation = -0.5\nrotation_length = 0.5\n\
                    [errors]\npitch = \"120 deg\"\n";

/// Over an edge a cube is lifted from ½ to √2/2; pushed it rises about an edge, by D/2 per turn.
#[test]
fn the_escape_height_of_a_cube_is_that_over_its_edge() {
    let found = rests(&problem(CUBE), 600);
    assert!(!found.rests.is_empty() && found.outcomes[&Outcome::Missed].count == 0, "{found:?}");
    for place in &found.rests {
        let turn = place.pose.pitch / FRAC_PI_2;
        assert!((turn - turn.round()).abs() < 1e-3, "{place:?}");
        // Motions end within 10⁻⁵ of a turn, over half a width.
        assert!((place.height_d - 0.5).abs() < 1e-5, "{place:?}");
        assert_eq!(place.examined.unwrap().stability, crate::run::jams::Stability::Sharp);
        assert!((depth(place) - 0.5 * (SQRT_2 - 1.0)).abs() < 1e-4, "{place:?}");
        let held = place.examined.unwrap().immobility.unwrap();
        assert_eq!(held.order, descent::ImmobilityOrder::First, "{place:?}");
        assert!(held.slope.iter().all(|slope| (slope - 1.0).abs() < 1e-3), "{place:?}");
    }
    assert_eq!(found.rests.iter().map(|place| place.of_box.count).sum::<usize>(), 600);
}

/// A cube released slightly aside falls back, beyond half a right angle onto its side: as a trial with rigid
/// bodies does.
#[cfg(feature = "drop")]
#[test]
fn a_rigid_body_reaches_the_same_rests() {
    let problem = problem(CUBE);
    let drop = "drop".parse().unwrap();
    let poses = [0.5f64, 1.0].map(|pitch| PoseError { pitch, ..PoseError::default() });
    let (_, ends) = problem.follow_by(&drop, &poses, &Exec::new()).unwrap();
    for (end, expected) in ends.iter().zip([0.0, FRAC_PI_2]) {
        assert!((end.error.pitch - expected).abs() < 0.03, "{end:?}");
        let exact = descent::settle(
            problem.pair(),
            &poses[usize::from(expected > 0.0)],
            &descent::DescentSettings::default(),
        );
        assert!((exact.error.pitch - end.error.pitch).abs() < 0.03, "{exact:?} {end:?}");
    }
}

/// Rests in all five errors, wherever motion came from: first order, by the slope of the mated pose.
#[test]
fn a_flush_seat_has_the_same_slope_from_any_start() {
    for (family, slope) in
        [("pyramid\"\naspect_ratio = 0.5", 0.4549), ("x-face-3d\"\naspect_ratio = 0.57735", 0.2931)]
    {
        let problem = problem(&format!(
            "[connector]\nfamily = \"{family}\n[alignment]\ncenter_of_rotation = 0.5\nrotation_length = 0.5\n"
        ));
        for seed in 1..=3 {
            let settings = RestsSettings { motions: Some(120), seed, ..RestsSettings::default() };
            let found = run(&problem, &settings, &Exec::new()).unwrap();
            let held = found.rests[0].examined.unwrap();
            let immobility = held.immobility.unwrap();
            assert_eq!(immobility.order, descent::ImmobilityOrder::First, "{family} {held:?}");
            assert!((immobility.slope[0] - slope).abs() < 2e-4, "{family} {immobility:?}");
            assert_eq!(held.sticks.unwrap().holds_from, Some(0.0));
        }
    }
}

/// A ball of radius 0.2 in a funnel of slope 1 and rim radius 0.5.
fn ball_in_cone() -> String {
    const SIDES: usize = 12;
    let (slope, rim) = (1.0f64, 0.5f64);
    // Wedges about the axis: each supports a plane through the apex; the rim is lowest in the middle of a
    // side.
    let mut text = String::from("[connector]\nwidth = 1.0\n");
    let corner = rim / (std::f64::consts::PI / SIDES as f64).cos();
    let height = slope * rim;
    for side in 0..SIDES {
        let at = |k: usize, r: f64, z: f64| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / SIDES as f64).sin_cos();
            format!("[{}, {}, {z}]", r * cos, r * sin)
        };
        let (a, b) = (side, side + 1);
        let _ = writeln!(
            text,
            "[[connector.fixed.parts]]\npieces = [[[0, 0, 0], [0, 0, -0.1], {}, {}, {}, {}]]",
            at(a, corner, height),
            at(b, corner, height),
            at(a, corner, -0.1),
            at(b, corner, -0.1)
        );
    }
    text += "[[connector.moving.parts]]\nsphere = { radius = 0.2 }\nchord_error = 0.0005\n[alignment]\nfree = [\"x\", \"y\"]\n\
             center_of_rotation = 0.0\nrotation_length = 0.5\n[errors]\nx = 0.4\ny = 0.4\n";
    text
}

/// A ball of radius r in a funnel of slope s and rim radius R rests with its centre r√(1 + s²) above the apex, and leaves over the rim at R s + r.
#[test]
fn a_ball_in_a_cone_leaves_over_its_rim() {
    let (slope, rim, radius) = (1.0f64, 0.5f64, 0.2f64);
    let found = rests(&problem(&ball_in_cone()), 60);
    let place = &found.rests[0];
    let expected = slope * rim + radius - radius * (1.0 + slope * slope).sqrt();
    // The inscribed ball is smaller by up to the chord error, and its facets shift the contact by as much.
    assert!((depth(place) - expected).abs() < 4e-3, "{expected} {place:?}");
    assert_eq!(place.examined.unwrap().escape_path.unwrap().to, Outcome::Missed);
}

/// A round peg with play in a chamfered hole.
const PEG: &str = "[connector]\nfamily = \"pin-hole\"\npins = 1\ncircle_radius = 0\npin_radius = 0.1\nclearance = 0.01\n\
                   chamfer = 0.06\n[alignment]\nfree = [\"x\", \"y\"]\n[errors]\nx = 0.3\ny = 0.3\n";

/// A plate that lies on three fingers about its middle, free to tilt.
fn plate_on_fingers() -> String {
    let fingers = [0.0f64, 120.0, 240.0].map(|degrees| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let foot = |dx: f64, dy: f64| format!("[{}, {}, 0]", 0.3 * cos + dx, 0.3 * sin + dy);
        let feet = [foot(0.05, 0.0), foot(-0.03, 0.04), foot(-0.03, -0.04)].join(", ");
        format!("[[{}, {}, 1], {feet}]", 0.3 * cos, 0.3 * sin)
    });
    let corners = [0.5, 1.0].map(|z| {
        let corner = |[x, y]: [f64; 2]| format!("[{x}, {y}, {z}]");
        [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(corner).join(", ")
    });
    format!(
        "[connector]\nwidth = 1.0\nface_height = 1.0\nfixed = {{ pieces = [{}] }}\nmoving = {{ pieces = [[{}]] }}\n\
         [alignment]\nfree = [\"roll\", \"pitch\"]\nmount = \"y\"\ncenter_of_rotation = 0.0\nrotation_length = 0.5\n\
         [errors]\nroll = \"10 deg\"\npitch = \"10 deg\"\n",
        fingers.join(", "),
        corners.join(", ")
    )
}

/// A rigid body released at a computed rest stays, and returns after a displacement: a ball in its cone, a
/// peg in its hole, a plate on three fingers.
#[cfg(feature = "drop")]
#[test]
fn a_rigid_body_comes_back_to_every_kind_of_rest() {
    let along = |k: usize, by: f64| {
        let mut error = [0.0; 5];
        error[k] = by;
        error
    };
    let lateral = |by: f64| [along(0, 0.0), along(0, by), along(0, -by), along(1, by), along(1, -by)];
    let tilts = |by: f64| [along(2, 0.0), along(2, by), along(2, -by), along(3, by), along(3, -by)];
    for (name, text, pushes, near) in [
        ("ball", ball_in_cone(), lateral(0.05), 0.01),
        // Wherever in its hole: within the play.
        ("peg", PEG.to_owned(), lateral(0.03), 0.022),
        ("plate", plate_on_fingers(), tilts(0.05), 0.01),
    ] {
        let problem = problem(&text);
        let found = rests(&problem, 60);
        let rest = found.rests.iter().find(|place| place.docked > 0).unwrap().pose.to_array();
        let beside = pushes.map(|push| PoseError::from_array(std::array::from_fn(|k| rest[k] + push[k])));
        let (_, ends) = problem.follow_by(&"drop".parse().unwrap(), &beside, &Exec::new()).unwrap();
        for (end, from) in ends.iter().zip(&beside) {
            let off = end.error.to_array().iter().zip(rest).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            assert!(off < near, "{name}: from {from:?} to {end:?}, {off} off");
        }
    }
}

/// Over an edge of a cube, and over the rim of a V: the certified lower bound is hardly less than the climb
/// of an existing path.
#[test]
fn certified_depths_are_close_below_those_of_paths() {
    let settings = RestsSettings { motions: Some(200), certified: true, ..RestsSettings::default() };
    let exec = Exec::new();
    for place in &run(&problem(CUBE), &settings, &exec).unwrap().rests {
        let at_least = place.depth_at_least_d.unwrap();
        assert!(at_least <= depth(place) + 1e-6 && at_least > 0.99 * depth(place), "{at_least} {place:?}");
    }
    let pyramid =
        "[connector]\nfamily = \"pyramid\"\naspect_ratio = 0.5\n[alignment]\nfree = [\"x\", \"y\"]\n";
    for place in &run(&problem(pyramid), &settings, &exec).unwrap().rests {
        let at_least = place.depth_at_least_d.unwrap();
        assert!(at_least <= depth(place) + 1e-6 && at_least >= 0.9 * depth(place), "{at_least} {place:?}");
    }
}

/// Walls all around: it is lifted as high as the level ground beside the hole.
#[test]
fn the_escape_height_of_a_peg_is_the_depth_of_its_hole() {
    let found = rests(&problem(PEG), 300);
    let [home, ground] =
        [true, false].map(|docked| found.rests.iter().find(|place| (place.docked > 0) == docked).unwrap());
    assert!((depth(home) - ground.above_mated_d).abs() < 1e-4, "{home:?} {ground:?}");
    assert!(home.examined.unwrap().escape_path.unwrap().climb > 0.05);
}

/// The merge tree of a fine grid agrees, over an edge of a cube.
#[test]
fn the_merge_tree_gives_the_same_depth() {
    let resolution = Some(Resolution::uniform(801).unwrap());
    let settings = RestsSettings { motions: Some(200), resolution, ..RestsSettings::default() };
    let found = run(&problem(CUBE), &settings, &Exec::new()).unwrap();
    // Heights differ by at most ½ per radian from cell to cell, 0.3° here.
    for place in &found.rests {
        let on_grid = place.depth_on_grid_d.unwrap();
        assert!((on_grid - depth(place)).abs() < 0.003, "{on_grid} {place:?}");
    }
}

/// The second-order result equals the rise for a displacement of a hundredth.
#[test]
fn curvature_predicts_the_rise_of_a_displacement() {
    let text = "[connector]\nwidth = 1.0\nfixed = { pieces = [[[0.2, -0.5, 1], [0.2, 0.5, 1], [0.22, -0.5, 0], [0.22, 0.5, 0], [0.18, -0.5, 0], \
                [0.18, 0.5, 0]], [[-0.2, -0.5, 1], [-0.2, 0.5, 1], [-0.22, -0.5, 0], [-0.22, 0.5, 0], [-0.18, -0.5, 0], [-0.18, 0.5, 0]]] }\n\
                moving = { pieces = [[[0, -0.5, 1.2], [0, 0.5, 1.2], [1, -0.5, 0.2], [1, 0.5, 0.2], [-1, -0.5, 0.2], [-1, 0.5, 0.2]]] }\n\
                face_height = 1.0\n[alignment]\nfree = [\"x\", \"pitch\"]\nmount = \"y\"\ncenter_of_rotation = -0.2\nrotation_length = 0.5\n\
                [errors]\nx = 0.05\npitch = \"10 deg\"\n";
    let found = rests(&problem(text), 100);
    let place = &found.rests[0];
    let examined = place.examined.unwrap();
    let held = examined.immobility.unwrap();
    assert_eq!(held.order, descent::ImmobilityOrder::Second, "{place:?}");
    let expected = 0.5 * held.curvature.unwrap() * crate::run::jams::PUSH.powi(2);
    let rise = examined.rise_at_most_d.unwrap();
    assert!((rise / expected - 1.0).abs() < 0.05, "{rise} {expected} {place:?}");
}

#[test]
fn threads_change_nothing_and_invalid_runs_are_refused() {
    let text = "[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n";
    let problem = problem(text);
    let settings = RestsSettings { motions: Some(200), ..RestsSettings::default() };
    let with = |threads| run(&problem, &settings, &Exec::new().with_threads(threads).unwrap()).unwrap();
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(4));
    // Each pose that comes to rest belongs to exactly one rest.
    assert_eq!(
        one.rests.iter().map(|place| place.of_box.count).sum::<usize>(),
        one.outcomes[&Outcome::Aligned].count + one.outcomes[&Outcome::Jammed].count
    );
    assert_eq!(
        one.rests.iter().map(|place| place.docked).sum::<usize>(),
        one.outcomes[&Outcome::Aligned].count
    );
    let none = RestsSettings { motions: Some(0), ..RestsSettings::default() };
    assert_eq!(run(&problem, &none, &Exec::new()).unwrap_err(), RestsError::Nothing);
    let exec = Exec::new();
    exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert!(matches!(run(&problem, &settings, &exec), Err(RestsError::Cancelled(_))));
}
