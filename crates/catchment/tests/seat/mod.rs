//! The definition of docked, against closed forms: pegs in holes with play and chamfers, rests on the rim,
//! flats.

#![allow(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

mod chamfered;
mod peg;

use catchment::acceptance::Domain;
use catchment::contact::mated::MatedProblem;
use catchment::contact::play;
use catchment::diagnostic::{Diagnostic, Warning};
use catchment::method::descent::{self, Follower};
use catchment::method::drop;
use catchment::method::zraa::{self, Zraa};
use catchment::prelude::*;
use chamfered::Chamfered;
use peg::Peg;
use std::f64::consts::TAU;

const LATERAL: [Dof; 2] = [Dof::X, Dof::Y];

fn at(x: f64, y: f64) -> PoseError {
    PoseError { x, y, ..PoseError::default() }
}

/// Accepts any play, which these tests are about.
fn loose(alignment: &mut Alignment) {
    alignment.docked.limits = [Some(0.3), Some(0.3), None, None, Some(0.6)];
}

/// Pegs of some shapes, plays and chamfers, on the floor and through.
fn pegs() -> impl Iterator<Item = Peg> {
    let shapes = [(4, 0.0), (6, 0.05), (8, 0.02), (16, 0.05), (4, 0.1), (16, 0.01)];
    shapes.into_iter().zip([0.05, 0.0, 0.2, 0.1, 0.05, 0.0]).flat_map(|((sides, play), chamfer)| {
        // Coincident walls do not let the peg in: a play of rounding size counts as zero.
        let peg = Peg::new(sides, 0.3, f64::max(play, 1e-6), chamfer);
        [peg, Peg { blind: false, ..peg }]
    })
}

#[test]
fn exact_motion_and_the_exact_region_have_the_area_of_the_mouth() {
    for peg in pegs() {
        let range = 0.05 + 1.2 * (peg.hole + peg.chamfer - peg.body);
        let problem = peg.problem(&LATERAL, range, loose).unwrap_or_else(|e| panic!("{peg:?}: {e}"));
        let Zraa::Region { area, .. } =
            zraa::run(problem.pair(), &zraa::ZraaSettings::default(), &Exec::new()).unwrap()
        else {
            panic!("two translations are free")
        };
        assert!((area - peg.area()).abs() <= 0.01 * peg.area() + 1e-9, "{peg:?}: {area} for {}", peg.area());
        let poses = Domain::random(problem.alignment(), 400, 3);
        let (found, _) =
            descent::run(problem.pair(), poses, &descent::DescentSettings::default(), &Exec::new()).unwrap();
        let share = found.counts()[0] as f64 / 400.0;
        let expected = peg.area() / (4.0 * range * range);
        // Four standard deviations of a share estimated from 400 poses.
        let doubt = 4.0 * (expected * (1.0 - expected) / 400.0).sqrt() + 1e-9;
        assert!((share - expected).abs() <= doubt, "{peg:?}: {share} for {expected} ± {doubt}");
    }
}

#[test]
fn the_corrected_sum_holds_the_area_in_its_interval() {
    for peg in pegs().filter(|peg| peg.area() > 1e-6).step_by(3) {
        let range = 0.05 + 1.2 * (peg.hole + peg.chamfer - peg.body);
        let problem = peg.problem(&LATERAL, range, loose).unwrap();
        let run = Run { over: Over::Grid("60".parse().unwrap()), ..Run::default() };
        let answer = run.on(&problem, &Exec::new()).unwrap();
        let [lo, hi] = answer.sum_ci95().unwrap();
        // 95 % of intervals contain it; twice their width does unless there is a defect.
        let (middle, half) = (0.5 * (lo + hi), hi - lo);
        assert!((peg.area() - middle).abs() <= half, "{peg:?}: {lo} … {hi} for {}", peg.area());
    }
}

#[test]
fn a_square_peg_that_may_turn_has_the_volume_of_its_mouth() {
    let peg = Peg::new(4, 0.3, 0.04, 0.08);
    let (range, count) = (0.2, 1500);
    let problem = peg.problem(&[Dof::X, Dof::Y, Dof::Yaw], range, loose).unwrap();
    // The tip lies over the mouth: along the diagonals, a square of half side (R + c − r (cos ψ + |sin ψ|))/√2 of offsets.
    let area = |yaw: f64| {
        let side = peg.hole + peg.chamfer - peg.body * (yaw.cos() + yaw.sin().abs());
        2.0 * side.max(0.0).powi(2)
    };
    let steps = 2000;
    let mean = (0..steps).map(|k| area(0.6 * (f64::from(k) + 0.5) / f64::from(steps))).sum::<f64>()
        / f64::from(steps);
    let expected = mean / (4.0 * range * range);
    let poses = Domain::random(problem.alignment(), count, 3);
    let (found, _) =
        descent::run(problem.pair(), poses, &descent::DescentSettings::default(), &Exec::new()).unwrap();
    let share = found.counts()[0] as f64 / count as f64;
    let doubt = 4.0 * (expected * (1.0 - expected) / count as f64).sqrt();
    assert!((share - expected).abs() <= doubt, "{share} for {expected} ± {doubt}");
}

#[test]
fn the_play_is_that_of_the_walls() {
    let peg = Peg::new(4, 0.3, 0.03, 0.05);
    let problem = peg.problem(&LATERAL, 0.2, |_| ()).unwrap();
    for play in play(problem.pair()) {
        // Corners on the axes: the offset along one is the play of the corners.
        assert!((play.minus - 0.03).abs() < 1e-4 && (play.plus - 0.03).abs() < 1e-4, "{play:?}");
    }
}

#[test]
fn a_pose_on_the_rim_jams_and_one_seated_with_play_docks() {
    let peg = Peg { deep: 0.4, ..Peg::new(32, 0.505 / 3.0, 0.005 / 3.0, 0.0) };
    let problem = peg.problem(&LATERAL, 0.1, |_| ()).unwrap();
    // 0.3 mm of error at D = 30 mm, on the rim 12 mm above the seat.
    assert_eq!(problem.follow(&at(0.01, 0.0)).outcome, Outcome::Jammed);
    assert_eq!(problem.follow(&at(0.0016, 0.0)).outcome, Outcome::Aligned);
    // Half a millimetre of play in a blind hole, at rest against its wall.
    let peg = Peg::new(32, 0.3, 0.5 / 12.0, 0.1);
    let problem = peg.problem(&LATERAL, 0.2, |_| ()).unwrap();
    let end = Follower::new(problem.pair(), &descent::DescentSettings::default()).rest(&at(0.1, 0.0));
    assert_eq!(end.outcome, Outcome::Aligned);
    assert!((end.error.x - 0.5 / 12.0).abs() < 1e-3, "{end:?}");
}

#[test]
fn a_hole_beside_the_mated_one_is_not_the_seat() {
    // Two equal slots beside each other: equally deep, and not connected.
    let block = |x: [f64; 2], z: [f64; 2]| -> Vec<DVec3> {
        (0..8).map(|k| DVec3::new(x[k & 1], [-0.5, 0.5][k >> 1 & 1], z[k >> 2])).collect()
    };
    let fixed = [[-0.5, -0.11], [0.11, 0.2], [0.42, 0.9]].map(|x| block(x, [-0.4, 0.0]));
    let fixed = fixed.into_iter().chain([block([-0.5, 0.9], [-0.5, -0.4])]).collect();
    let moving = vec![block([-0.1, 0.1], [-0.2, 0.4])];
    let alignment = Alignment::new([Dof::X].into_iter().collect(), Mount::X);
    let problem = Problem::new(HalfSource::Pieces(fixed), HalfSource::Pieces(moving), alignment).unwrap();
    assert_eq!(problem.follow(&at(0.005, 0.0)).outcome, Outcome::Aligned);
    assert_eq!(problem.follow(&at(0.31, 0.0)).outcome, Outcome::Jammed);
    assert_eq!(problem.follow(&at(0.15, 0.0)).outcome, Outcome::Jammed);
}

#[test]
fn limits_decide_where_the_seat_leaves_play() {
    let peg = Peg::new(4, 0.3, 0.04, 0.05);
    let limit = |x: f64| peg.problem(&[Dof::X], 0.2, |a| a.docked.limits[0] = Some(x)).unwrap();
    // It rests where it comes down: at an error of 0.03.
    assert_eq!(limit(0.035).follow(&at(0.03, 0.0)).outcome, Outcome::Aligned);
    assert_eq!(limit(0.02).follow(&at(0.03, 0.0)).outcome, Outcome::Jammed);
    assert!(matches!(limit(0.02).mated_warnings(), [MatedProblem::LimitCutsPlay { dof: Dof::X, .. }]));
    assert_eq!(limit(0.05).mated_warnings(), []);
}

/// The error of a problem that does not build, as text.
fn refused(problem: Result<Problem, ProblemError>) -> String {
    match problem {
        Err(ProblemError::Diagnostics(found)) => {
            let printout = |f: &Diagnostic| format!("{} ({})", f.message, f.help().unwrap_or_default());
            found.list.iter().map(printout).collect::<Vec<_>>().join("\n")
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_seat_that_leaves_an_error_free_is_refused_with_advice() {
    let slab = || {
        let corner =
            |k: u8| DVec3::new(f64::from(k & 1) - 0.5, f64::from(k >> 1 & 1) - 0.5, -0.2 * f64::from(k >> 2));
        HalfSource::Pieces(vec![(0..8).map(corner).collect()])
    };
    let flat =
        |free: &[Dof]| Problem::new(slab(), slab(), Alignment::new(free.iter().copied().collect(), Mount::X));
    let text = refused(flat(&[Dof::X]));
    assert!(text.contains("leaves x free") && text.contains("[docked] x = "), "{text}");
    let text = refused(flat(&[Dof::Yaw]));
    assert!(text.contains("leaves yaw free") && text.contains("dont_care"), "{text}");
    // The approximation of a round peg: a polygon of 18 sides in its hole.
    let text = refused(Peg::new(18, 0.3, 0.01, 0.05).problem(&[Dof::X, Dof::Y, Dof::Yaw], 0.2, |_| ()));
    assert!(
        text.contains("rotation about z changes nothing") && text.contains("dont_care = [\"yaw\"]"),
        "{text}"
    );
    // A hexagon can turn by 3.6° in this hole.
    assert!(Peg::new(6, 0.3, 0.01, 0.05).problem(&[Dof::X, Dof::Y, Dof::Yaw], 0.2, |_| ()).is_ok());
}

/// A dimple on a ridge, 0.0015 D deep where seats reach 0.002 D above the mated pose: a pose deep enough may lie beyond its rim, and slides off.
#[test]
fn a_pose_beyond_a_low_rim_is_missed() {
    const RIM: f64 = 0.05;
    let text = "[connector]\nwidth = 1.0\n[[connector.fixed.parts]]\nprofile = [[-0.5, -0.2], [0.5, -0.2], [0.5, 0.0], [0.05, 0.3], [0, 0.2985], [-0.05, 0.3], \
                [-0.5, 0.0]]\nheight = 0.4\naxis = \"-y\"\nat = [0, 0.2, 0]\n[[connector.moving.parts]]\nprofile = [[-0.1, 0.0], [0.1, 0.0], [0.0, 0.3]]\n\
                height = 0.4\naxis = \"-y\"\nat = [0, 0.2, 0]\n[alignment]\nfree = [\"x\"]\ncenter_of_rotation = 0.5\n";
    let source = catchment::design::SourceText::new("f.toml", text);
    let problem: Problem = Draft::read(source).and_then(Draft::build).unwrap();
    let poses: Vec<PoseError> = (-24..=24).map(|k| at(0.0121 * f64::from(k), 0.0)).collect();
    let expected: Vec<Outcome> = poses
        .iter()
        .map(|pose| if pose.x.abs() < RIM { Outcome::Aligned } else { Outcome::Missed })
        .collect();
    let pair = problem.pair();
    for friction in [0.0, 0.01] {
        let settings = descent::DescentSettings::with_friction(friction).unwrap();
        let mut follower = Follower::new(pair, &settings);
        for (pose, expected) in poses.iter().zip(&expected) {
            assert_eq!(follower.follow(pose).outcome, *expected, "{pose:?}, friction {friction}");
            assert_eq!(follower.rest(pose).outcome, *expected, "{pose:?}, friction {friction}");
            assert_eq!(descent::trace(pair, pose, &settings).outcome, *expected, "{pose:?}");
        }
    }
    let near = |pose: &&PoseError| (pose.x.abs() - RIM).abs() > 0.005;
    let away: Vec<PoseError> = poses.iter().filter(near).copied().collect();
    let (dropped, _) =
        drop::run(pair, Domain::Poses(away.clone()), &drop::DropSettings::default(), &Exec::new()).unwrap();
    for (pose, outcome) in away.iter().zip(&dropped.outcomes) {
        assert_eq!(*outcome == Outcome::Aligned, pose.x.abs() < RIM, "{pose:?} ends {outcome:?}");
    }
    let refused = Run { method: "certified".parse().unwrap(), ..Run::default() };
    let refused = refused.on(&problem, &Exec::new()).unwrap_err().to_string();
    assert!(refused.contains("docked.depth"), "{refused}");
}

#[test]
fn drops_agree_with_motions() {
    let mut same = [0, 0];
    for peg in [Peg::new(4, 0.3, 0.02, 0.08), Peg::new(6, 0.3, 0.04, 0.0)] {
        let range = 0.03 + 1.1 * (peg.hole + peg.chamfer - peg.body);
        let problem = peg.problem(&LATERAL, range, |_| ()).unwrap();
        let poses = Domain::random(problem.alignment(), 400, 5);
        let (dropped, _) =
            drop::run(problem.pair(), poses.clone(), &drop::DropSettings::default(), &Exec::new()).unwrap();
        let (moved, _) =
            descent::run(problem.pair(), poses, &descent::DescentSettings::default(), &Exec::new()).unwrap();
        let docks = |o: &Outcome| *o == Outcome::Aligned;
        same[0] += dropped.outcomes.iter().zip(&moved.outcomes).filter(|(a, b)| docks(a) == docks(b)).count();
        same[1] += dropped.outcomes.len();
    }
    assert!(same[0] * 100 >= same[1] * 97, "{same:?}");
}

/// Face slides on face down to the rim, where walls become flush: the outcome there must not depend on the last digit of a
/// drawing.
#[test]
fn equal_chamfers_accept_poses_over_the_mouth() {
    let drawn = [(4, 1.0, 3), (4, 2f64.sqrt(), 9), (6, 1.0, 6), (7, 1.0, 6), (16, 1.0, 9), (32, 1.0, 6)];
    for (sides, slope, digits) in drawn {
        let peg = Chamfered { sides, slope, digits };
        // A piece has at most 64 corners.
        let pieces = (sides < 22).then(|| peg.pieces());
        for problem in pieces.into_iter().chain([peg.triangles()]).map(|source| peg.problem(source)) {
            let poses = Domain::random(problem.alignment(), 150, 5);
            let (found, _) =
                descent::run(problem.pair(), poses, &descent::DescentSettings::default(), &Exec::new())
                    .unwrap();
            for (k, outcome) in found.outcomes.iter().enumerate() {
                let error = found.domain.pose(k);
                let inside = peg.inside(&error);
                // The drawing is rounded.
                if inside.abs() > 1e-3 {
                    let right = if inside > 0.0 { Outcome::Aligned } else { Outcome::Jammed };
                    assert_eq!(*outcome, right, "{peg:?}: {error:?}, {inside} D inside");
                }
            }
            // The rest has an error of 0.02 D along the corners, less across the sides.
            let least = 0.02 * (0.5 * TAU / f64::from(sides)).cos();
            for off in play(problem.pair()) {
                assert!((least - 1e-3..0.02 + 1e-3).contains(&off.most()), "{peg:?}: {off:?}");
            }
        }
    }
}

/// Flush faces of a rounded drawing differ in their last digits: the exact heights must not lose any of their contacts.
#[test]
fn the_envelope_of_flush_faces_has_no_holes() {
    for (sides, slope, digits) in
        [(4, 1.0, 3), (6, 1.0, 6), (7, 1.0, 6), (8, 2f64.sqrt() - 1.0, 9), (16, 1.0, 9)]
    {
        let peg = Chamfered { sides, slope, digits };
        for problem in [peg.pieces(), peg.triangles()].map(|source| peg.problem(source)) {
            let catchment::connector::Connector { fixed, moving, .. } = problem.connector();
            let facets = zraa::heights(fixed, moving, &zraa::ZraaSettings::default(), &Exec::new()).unwrap();
            let mut alignment = problem.alignment().clone();
            alignment.half_ranges[..2].fill(1.0);
            let poses = Domain::random(&alignment, 2000, 7);
            for error in (0..poses.len()).map(|k| poses.pose(k)) {
                let pose = catchment::pose::CorPose::from_error(
                    &error,
                    alignment.center_of_rotation,
                    alignment.free,
                );
                let exact = problem.pair().height(&pose).map(|h| h + alignment.center_of_rotation);
                let holds = |polygon: &[glam::DVec2]| {
                    (0..polygon.len()).all(|k| {
                        let along = polygon[(k + 1) % polygon.len()] - polygon[k];
                        along.perp_dot(pose.lateral - polygon[k]) >= -1e-9 * along.length()
                    })
                };
                let over = facets.iter().filter(|f| holds(&f.polygon)).map(|f| f.height(pose.lateral));
                let found = over.reduce(f64::max);
                let same = match (found, exact) {
                    (Some(found), Some(exact)) => (found - exact).abs() < 1e-5,
                    (found, exact) => found == exact,
                };
                assert!(same, "{peg:?} at {}: {found:?} for {exact:?}", pose.lateral);
            }
        }
    }
}

/// The exact region of the same peg: an n-gon. If rounding leads its flow astray, the method refuses; it never returns a wrong
/// region.
#[test]
fn equal_chamfers_have_an_n_gon_as_exact_region() {
    let drawn = [(4, 1.0, 3), (6, 1.0, 6), (7, 1.0, 6), (8, 2f64.sqrt() - 1.0, 9), (16, 1.0, 9)];
    let mut refused = 0;
    for (sides, slope, digits) in drawn {
        let peg = Chamfered { sides, slope, digits };
        let right = peg.captured();
        for problem in [peg.pieces(), peg.triangles()].map(|source| peg.problem(source)) {
            match zraa::run(problem.pair(), &zraa::ZraaSettings::default(), &Exec::new()) {
                Ok(ref region @ Zraa::Region { area, .. }) => {
                    assert!((area - right).abs() < 1e-4 * right, "{peg:?}: {area} for {right}");
                    // Gaps between tiles do not count as border: a square fits into the circle inside the
                    // n-gon.
                    let square = zraa::AcceptedSquare::of(region, &Exec::new()).unwrap();
                    let inner = peg.inside(&at(0.0, 0.0)) * 2f64.sqrt();
                    assert!(
                        square.edge > inner - 1e-3 && square.edge < right.sqrt(),
                        "{peg:?}: {square:?}, {inner}"
                    );
                    assert!(square.centered_edge > inner - 1e-3, "{peg:?}: {square:?}, {inner}");
                }
                Err(zraa::ZraaError::Disputed { .. }) => refused += 1,
                other => panic!("{peg:?}: {other:?}"),
            }
        }
    }
    assert!(refused <= 3, "{refused} of {}", 2 * drawn.len());
}

/// A bar with two corners over a truncated V: the middle of the bar keeps its distance from the apex, so its height falls
/// either way. At rest one corner is at the end of the floor: cos(45° + p) = 0.4 / (0.42 √2).
#[test]
fn a_mated_pose_that_runs_off_is_reported() {
    let block = |corners: &[(f64, f64)]| -> Vec<DVec3> {
        corners.iter().flat_map(|&(x, z)| [-0.1, 0.1].map(|y| DVec3::new(x, y, z))).collect()
    };
    let side = |s: f64| block(&[(s * 0.4, 0.0), (s * 0.8, 0.4), (s * 0.4, -0.2), (s * 0.8, -0.2)]);
    let floor = block(&[(-0.4, 0.0), (0.4, 0.0), (-0.4, -0.2), (0.4, -0.2)]);
    let bar = block(&[(-0.42, 0.0), (0.42, 0.0), (-0.3, -0.1), (0.3, -0.1)]);
    // The corners touch the walls at the face centre.
    let lifted =
        |piece: Vec<DVec3>, by: f64| piece.into_iter().map(|p| p + DVec3::Z * by).collect::<Vec<_>>();
    let fixed = [floor, side(1.0), side(-1.0)].map(|piece| lifted(piece, -0.01)).into();
    let mut alignment = Alignment::new([Dof::X, Dof::Pitch].into_iter().collect(), Mount::Y);
    alignment.center_of_rotation = 0.01;
    alignment.half_ranges = [0.3, 0.3, 0.35, 0.35, 0.35];
    let problem =
        Problem::new(HalfSource::Pieces(fixed), HalfSource::Pieces(vec![lifted(bar, -0.01)]), alignment)
            .unwrap();
    let run = Run { over: Over::Grid("20".parse().unwrap()), ..Run::default() };
    let answer = run.on(&problem, &Exec::new()).unwrap();
    let tilt = (0.4 / (0.42 * 2f64.sqrt())).acos() - TAU / 8.0;
    let play = answer.seating.play.iter().find(|play| play.axis == Dof::Pitch).unwrap();
    assert!((play.most() - tilt.abs()).abs() < 1e-3, "{play:?} for {tilt}");
    let printout: Vec<String> = answer.warnings().iter().map(ToString::to_string).collect();
    assert!(
        printout.iter().any(|text| text.contains("does not hold: docked halves rest 0.0004")),
        "{printout:?}"
    );
}

/// A plate around a hole is level: flooding drains it, and reports over how many cells.
#[test]
fn flooding_reports_draining_level_ground() {
    let peg = Peg::new(8, 0.3, 0.02, 0.05);
    let problem = peg.problem(&LATERAL, 0.3, loose).unwrap();
    for method in ["flood", "steepest", "meyer"] {
        let over = Over::Grid("60".parse().unwrap());
        let run = Run { over, ..Run::by(method.parse().unwrap()) };
        let answer = run.on(&problem, &Exec::new()).unwrap();
        let level = answer.warnings().iter().find_map(|warning| match warning.facts.as_deref() {
            Some(Warning::LevelGround { cells, of }) => Some((*cells, *of)),
            _ => None,
        });
        // Without the level ground, and half a cell all around, it equals the mouth.
        let (cells, of) = level.unwrap_or_else(|| panic!("{method}: {:?}", answer.warnings()));
        let cell = 0.6 / 60.0;
        let (rest, ring) = ((of - cells) as f64 * cell * cell, 8.0 * cell * 0.1);
        assert!((rest - peg.area()).abs() < ring, "{method}: {rest} for {}", peg.area());
    }
}
