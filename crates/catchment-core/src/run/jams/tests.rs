//! Jams of pairs with known jams.

use super::*;
use crate::design::read;
use crate::method::descent::Sticking;
use crate::pose::DofSet;
use std::f64::consts::PI;
use std::path::Path;

fn problem(text: &str) -> Problem {
    Problem::of(read(text, Path::new("")).unwrap().design).unwrap()
}

/// Aspect ratio 1, COR 0: the tip's flank is √5/2 D long.
fn v_face() -> Problem {
    problem("[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n")
}

/// Counts in the order of [`Outcome::ALL`].
fn by_outcome(of: &BTreeMap<Outcome, Share>) -> [usize; 4] {
    Outcome::ALL.map(|outcome| of[&outcome].count)
}

fn jams(problem: &Problem, motions: usize) -> Jams {
    run(problem, &JamsSettings { motions: Some(motions), ..JamsSettings::default() }, &Exec::new()).unwrap()
}

#[test]
fn every_pose_is_in_one_outcome_and_every_jammed_one_in_one_jam() {
    let errors = Distribution::Normal {
        mean: PoseError::default(),
        sigma: PoseError { x: 0.3, pitch: 0.6, ..PoseError::default() },
    };
    let settings = JamsSettings { motions: Some(1500), errors: Some(errors), ..JamsSettings::default() };
    let found = run(&v_face(), &settings, &Exec::new()).unwrap();
    assert_eq!(by_outcome(&found.outcomes).iter().sum::<usize>(), 1500);
    assert_eq!(found.jammed(), by_outcome(&found.outcomes)[1]);
    let expected = by_outcome(found.expected.as_ref().unwrap());
    assert_eq!(expected.iter().sum::<usize>(), 1500);
    assert_eq!(found.jams.iter().map(|jam| jam.expected.unwrap().count).sum::<usize>(), expected[1]);
    assert!(
        found
            .jams
            .is_sorted_by_key(|jam| { std::cmp::Reverse(jam.of_box.count + jam.expected.unwrap().count) })
    );
}

/// The tip lies on its side in the notch, to either side: symmetric images, both found, a single jam.
#[test]
fn a_tip_on_its_side_is_one_jam_at_two_places() {
    let problem = v_face();
    let found = jams(&problem, 2000);
    let jam = &found.jams[0];
    assert_eq!(jam.places, 2, "{jam:#?}");
    assert!(jam.of_box.count * 10 > found.jammed() * 9, "{found:#?}");
    // Mirror images count as a single place: pitches of opposite sign do not add up to an extent.
    assert!(jam.extent.iter().all(|side| side.to - side.from < 0.05), "{:?}", jam.extent);
    // Its base lies flush on a flank of slope 2, so its pitch is π/2 + (π/2 − atan 2). The motion ends within
    // a step's rounding.
    assert!((jam.pose.pitch.abs() - (PI - 2f64.atan())).abs() < 1e-3 && jam.above_mated_d > 0.1, "{jam:#?}");
    let examined = jam.examined.unwrap();
    assert_eq!(examined.returned, examined.displaced, "{examined:?}");
    assert!(matches!(examined.stability, Stability::Sharp | Stability::Rounded));
    // Out of a rest it is a climb, and no farther than over the rim of the notch.
    let way = examined.escape_path.unwrap();
    assert!(way.climb > 0.0 && way.climb < 1.0, "{way:?}");
}

/// Mirrored errors end at mirrored rests. Other poses end at each of the two as often, and aligned, missed and at rest, within the intervals; no pose is left over.
#[test]
fn the_two_rests_are_mirror_images() {
    let problem = v_face();
    let settings = descent::DescentSettings::default();
    let mut follower = descent::Follower::new(problem.pair(), &settings);
    let Domain::Poses(poses) = Domain::random(problem.alignment(), 1500, 9) else { panic!() };
    let mut sides = [0; 2];
    let mut counts = [0; 4];
    for pose in &poses {
        let mirrored = PoseError { x: -pose.x, pitch: -pose.pitch, ..*pose };
        let [here, there] = [pose, &mirrored].map(|pose| follower.settle(pose));
        assert_eq!(here.outcome, there.outcome, "{pose:?}");
        counts[Outcome::ALL.iter().position(|outcome| *outcome == here.outcome).unwrap()] += 1;
        if here.outcome == Outcome::Jammed {
            let off = (here.error.x + there.error.x).abs().max((here.error.pitch + there.error.pitch).abs());
            assert!(off < 1e-6, "{pose:?}: {here:?} {there:?}");
            sides[usize::from(here.error.pitch > 0.0)] += 1;
        }
    }
    let within = |count: usize, all: usize, share: f64| {
        let [lo, hi] = crate::merit::sum::wilson95(count, all);
        (lo..=hi).contains(&share)
    };
    assert!(within(sides[0], sides[0] + sides[1], 0.5), "{sides:?}");
    let found = jams(&problem, 3000);
    assert_eq!(
        by_outcome(&found.outcomes)[0] + by_outcome(&found.outcomes)[2] + found.jammed(),
        found.motions
    );
    for (count, other) in counts.iter().zip(by_outcome(&found.outcomes)) {
        assert!(within(*count, 1500, other as f64 / 3000.0), "{counts:?} {:?}", by_outcome(&found.outcomes));
    }
}

/// A rigid body released at a computed jam stays there, and so does one that starts slightly aside, at either
/// of the two images.
#[cfg(feature = "drop")]
#[test]
fn a_rigid_body_stays_where_it_jams() {
    let problem = v_face();
    let found = jams(&problem, 1500);
    let drop = "drop".parse().unwrap();
    for jam in &found.jams {
        // Halves at rest on level ground stay anywhere on their level.
        let is_level = jam.examined.unwrap().stability == Stability::Level;
        let aside = if is_level { 0.0 } else { 0.01 };
        for side in [1.0, -1.0] {
            let rest = PoseError { x: side * jam.pose.x, pitch: side * jam.pose.pitch, ..jam.pose };
            let beside = [[0.0, 0.0], [aside, 0.0], [-aside, 0.0], [0.0, aside], [0.0, -aside]]
                .map(|[x, pitch]| PoseError { x: rest.x + x, pitch: rest.pitch + pitch, ..rest });
            let (_, ends) = problem.follow_by(&drop, &beside, &Exec::new()).unwrap();
            for end in &ends {
                assert_eq!(end.outcome, Outcome::Jammed, "{end:?}");
                // The engine's contacts give way by about a thousandth of D.
                let (a, b) = (end.error, rest);
                assert!((a.x - b.x).abs() < 0.02 && (a.pitch - b.pitch).abs() < 0.04, "{a:?} {b:?}");
            }
        }
    }
}

#[test]
fn a_peg_beside_its_hole_rests_on_level_ground() {
    let text = "[connector]\nfamily = \"pin-hole\"\npins = 1\ncircle_radius = 0\npin_radius = 0.1\nclearance = 0.01\n\
                chamfer = 0.06\n[alignment]\nfree = [\"x\", \"y\"]\n[errors]\nx = 0.3\ny = 0.3\n";
    let found = jams(&problem(text), 300);
    let jam = &found.jams[0];
    assert_eq!((found.jams.len(), jam.of_box.count), (1, by_outcome(&found.outcomes)[1]));
    let [contact] = jam.contacts.as_slice() else { panic!("{jam:#?}") };
    assert_eq!((contact.fixed.name.as_str(), contact.moving.name.as_str()), ("top", "top"));
    let examined = jam.examined.unwrap();
    assert_eq!(examined.stability, Stability::Level);
    // It slides into its hole without being lifted.
    let way = examined.escape_path.unwrap();
    assert!(way.climb < 1e-6, "{way:?}");
    assert_eq!(found.features.len(), 1);
}

#[test]
fn threads_change_nothing() {
    let problem = v_face();
    let settings = JamsSettings { motions: Some(300), ..JamsSettings::default() };
    let with = |threads| run(&problem, &settings, &Exec::new().with_threads(threads).unwrap()).unwrap();
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(4));
}

#[test]
fn invalid_and_cancelled_runs_are_refused() {
    let problem = v_face();
    let refused = |settings: JamsSettings| run(&problem, &settings, &Exec::new()).unwrap_err();
    assert_eq!(refused(JamsSettings { motions: Some(0), ..JamsSettings::default() }), JamsError::Nothing);
    let normal = |sigma: PoseError| {
        let errors = Some(Distribution::Normal { mean: PoseError::default(), sigma });
        refused(JamsSettings { motions: Some(10), errors, ..JamsSettings::default() })
    };
    let sigma = PoseError { yaw: 0.1, ..PoseError::default() };
    assert_eq!(normal(sigma), JamsError::Locked { axis: Dof::Yaw });
    let sigma = PoseError { x: -0.1, ..PoseError::default() };
    assert_eq!(normal(sigma), JamsError::NoSize { axis: Dof::X, value: -0.1 });
    let exec = Exec::new();
    exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert!(matches!(run(&problem, &JamsSettings::default(), &exec), Err(JamsError::Cancelled(_))));
}

#[test]
fn errors_are_drawn_as_they_are_distributed() {
    const COUNT: usize = 4000;
    let problem = problem("[connector]\nfamily = \"pyramid\"\n");
    let drawn = |errors: &Distribution| sampling::poses(errors, problem.alignment(), COUNT, 5).unwrap();
    let sigma = PoseError { x: 0.2, yaw: 0.1, ..PoseError::default() };
    let mean = PoseError { x: 0.05, ..PoseError::default() };
    let poses = drawn(&Distribution::Normal { mean, sigma });
    let average = |of: &dyn Fn(&PoseError) -> f64| poses.iter().map(of).sum::<f64>() / COUNT as f64;
    // Five standard errors of the mean and of the variance.
    assert!((average(&|e| e.x) - 0.05).abs() < 5.0 * 0.2 / (COUNT as f64).sqrt());
    assert!((average(&|e| (e.x - 0.05).powi(2)) - 0.04).abs() < 5.0 * 0.04 * (2.0 / COUNT as f64).sqrt());
    assert!(poses.iter().all(|e| e.y == 0.0 && e.roll == 0.0));
    let half_width = PoseError { y: 0.3, ..PoseError::default() };
    let poses = drawn(&Distribution::Uniform { mean: PoseError::default(), half_width });
    assert!(poses.iter().all(|e| e.y.abs() <= 0.3) && poses.iter().any(|e| e.y > 0.28));
    assert!(problem.alignment().free == DofSet::ALL);
}

/// Offsets alone on facets of a slope of 0.2: below it friction changes nothing, above it all jam on the slopes.
#[test]
fn friction_above_the_slope_jams_all_over_it() {
    let text = "[connector]\nfamily = \"v-face\"\naspect_ratio = 0.1\n[alignment]\nfree = [\"x\"]\n";
    let problem = Problem::of(crate::design::read(text, ".".as_ref()).unwrap().design).unwrap();
    let with = |friction: f64| {
        let settings = JamsSettings { motions: Some(300), friction, ..JamsSettings::default() };
        run(&problem, &settings, &Exec::new()).unwrap()
    };
    assert_eq!(with(0.1).outcomes, with(0.0).outcomes);
    let stuck = with(0.3);
    assert!(
        by_outcome(&stuck.outcomes)[0] < 15 && by_outcome(&stuck.outcomes)[1] > 130,
        "{:?}",
        stuck.outcomes
    );
    assert!(
        stuck.features.iter().any(|pair| pair.fixed.name.contains("slope of 11")),
        "{:?}",
        stuck.features
    );
}

/// A V-Face of AR ½ on its side, one slope flush on another: held by contacts alone, with an escape height on
/// a grid equal to the climb of its escape path, to a cell.
#[test]
fn a_jam_has_an_order_and_a_depth_on_a_grid() {
    let wide = problem(
        "[connector]\nfamily = \"v-face\"\n[alignment]\nrotation_length = 1.0\n[errors]\npitch = \"170 deg\"\n",
    );
    let resolution = Some("120".parse().unwrap());
    let settings = JamsSettings { motions: Some(400), resolution, ..JamsSettings::default() };
    let found = run(&wide, &settings, &Exec::new()).unwrap();
    let jam = found.jams.iter().find(|jam| (jam.pose.pitch.abs() - 0.5 * PI).abs() < 1e-3).unwrap();
    let examined = jam.examined.unwrap();
    let held = examined.immobility.unwrap();
    assert_eq!(held.order, crate::method::descent::ImmobilityOrder::First);
    assert!(held.slope[0] > 0.1);
    let (climb, on_grid) = (examined.escape_path.unwrap().climb, jam.depth_on_grid_d.unwrap());
    assert!((on_grid - climb).abs() < 0.02, "{on_grid} {climb}");
}

/// The escape height lies between the certified bound and the climb of a path; it is almost zero for an
/// almost level rest. With friction nothing is certified.
#[test]
fn the_certified_depth_is_at_most_the_climb() {
    let problem = v_face();
    let settings = JamsSettings { motions: Some(600), certified: true, ..JamsSettings::default() };
    let found = run(&problem, &settings, &Exec::new()).unwrap();
    for jam in &found.jams {
        let (at_least, examined) = (jam.depth_at_least_d.unwrap(), jam.examined.unwrap());
        let climb = examined.escape_path.unwrap().climb;
        assert!(at_least <= climb + 1e-6, "{at_least} {climb}");
        if examined.stability == Stability::Level {
            assert!(at_least < 0.01, "{at_least}");
        } else {
            assert!(at_least > 0.5 * climb, "{at_least} {climb}");
        }
    }
    let rough = JamsSettings { friction: 0.1, ..settings };
    assert_eq!(run(&problem, &rough, &Exec::new()).unwrap_err(), JamsError::Depth(DepthError::Friction));
}

/// On a single facet both thresholds of a rest held by friction equal its slope.
#[test]
fn friction_thresholds_of_a_rest_on_a_facet_equal_its_slope() {
    let text = "[connector]\nfamily = \"v-face\"\naspect_ratio = 0.1\n[alignment]\nfree = [\"x\"]\n";
    let problem = problem(text);
    let settings = JamsSettings { motions: Some(50), friction: 0.3, ..JamsSettings::default() };
    let found = run(&problem, &settings, &Exec::new()).unwrap();
    assert!(!found.jams.is_empty());
    for examined in found.jams.iter().filter_map(|jam| jam.examined) {
        let Sticking { holds_from, slips_until, wedges_from } = examined.sticks.unwrap();
        assert!((holds_from.unwrap() - 0.2).abs() < 1e-6, "{holds_from:?}");
        assert!((slips_until.unwrap() - 0.2).abs() < 1e-3, "{slips_until:?}");
        assert_eq!(wedges_from, None);
        assert!(examined.immobility.is_none());
    }
}
