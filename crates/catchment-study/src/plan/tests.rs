//! Distances compared with closed forms, and the published tests.

use super::*;
use catchment_core::design::read;
use std::collections::BTreeMap;
use std::path::Path;

fn problem(name: &str) -> Problem {
    Problem::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs").join(name)).unwrap()
}

/// Millimetres as D.
fn mm(problem: &Problem, value: f64) -> f64 {
    let design = problem.design();
    value / 1000.0 / (design.width * design.unit.unwrap().metres())
}

fn offsets(problem: &Problem, value: f64) -> PoseError {
    PoseError { x: mm(problem, value), y: mm(problem, value), ..PoseError::default() }
}

fn planned(problem: &Problem, settings: &TrialPlanSettings) -> TrialPlan {
    run(problem, settings, &Exec::new()).unwrap()
}

fn x_face_lattice(problem: &Problem) -> TrialPlanSettings {
    let step = [Some(mm(problem, 5.0)), Some(mm(problem, 5.0)), None, None, None];
    let pattern = Pattern::Lattice { step, max: [None; 5], along_border: true };
    TrialPlanSettings { symmetric: true, ..TrialPlanSettings::new(pattern, offsets(problem, 1.0)) }
}

/// Sliding alone a 3-D X-Face docks from |x| + |y| < D. Of the lattice of 5 mm in a quadrant, 13 points have x + y = 60 mm (3.89 mm inside), 14 have 65 mm
/// (0.354 mm inside) and 15 have 70 mm (3.18 mm outside).
#[test]
fn the_lattice_of_the_x_face_has_28_points_that_decide_and_14_that_do_not() {
    let problem = problem("bench-x-face.toml");
    let plan = planned(&problem, &x_face_lattice(&problem));
    let mut rows: BTreeMap<i64, usize> = BTreeMap::new();
    for point in &plan.points {
        let sum = (point.error.x + point.error.y) * 65.5;
        *rows.entry(sum.round() as i64).or_default() += 1;
        assert_eq!(point.prediction.docks(), sum < 65.5, "{point:?}");
        assert_eq!(point.prediction.either, sum.round() == 65.0, "{point:?}");
        // The side of the diamond, or its corner if that is nearer than the foot on the side.
        let [x, y] = [point.error.x, point.error.y].map(|v| v * 65.5);
        let foot = [x, y].map(|v| v - 0.5 * (x + y - 65.5));
        let exact = if foot.iter().all(|v| *v >= 0.0) {
            (x + y - 65.5).abs() / 2f64.sqrt()
        } else {
            (x.max(y) - 65.5).hypot(x.min(y))
        };
        let Prediction { margin_in_sigma, distance_to_border, .. } = point.prediction;
        let [sigmas, distance] = [margin_in_sigma, distance_to_border].map(Option::unwrap);
        // At most so much, and hardly more: directions are random, two in the plane.
        assert!(sigmas > exact * (1.0 - 1e-9) && sigmas < 1.02 * exact + 2e-3, "{exact}: {point:?}");
        assert!((distance * 65.5 - sigmas).abs() < 1e-9);
    }
    assert_eq!(rows, BTreeMap::from([(60, 13), (65, 14), (70, 15)]));
    assert_eq!((plan.trials.len(), plan.counts.asymmetric), (42, 0));
}

/// 5 × 5 × 6 poses up to x, y = D/2 and yaw = 30°: 96 dock, and 54 lie on the border.
#[test]
fn the_grid_of_the_pyramid_has_150_points_of_which_96_dock() {
    let problem = problem("bench-pyramid.toml");
    let inch = mm(&problem, 25.4);
    let pattern = Pattern::Grid {
        steps: [Some(5), Some(5), None, None, Some(6)],
        max: [Some(inch), Some(inch), None, None, Some(30f64.to_radians())],
    };
    let accuracy = PoseError { yaw: 0.1f64.to_radians(), ..offsets(&problem, 0.1) };
    let plan = planned(
        &problem,
        &TrialPlanSettings { symmetric: true, ..TrialPlanSettings::new(pattern.clone(), accuracy) },
    );
    assert_eq!(plan.points.len(), 150);
    let on_border = |point: &PlannedPose| point.error.x.max(point.error.y) > 0.5 - 1e-9;
    for point in &plan.points {
        assert_eq!(point.prediction.docks(), !on_border(point), "{point:?}");
        assert_eq!(point.prediction.either, on_border(point), "{point:?}");
        if !on_border(point) {
            // A quarter of an inch inside or more: 63 accuracies of offset, or as far in yaw.
            assert!(point.prediction.margin() > 60.0, "{point:?}");
        }
    }
    assert_eq!(plan.points.iter().filter(|point| point.prediction.docks()).count(), 96);
    // Lines along x end with the first failure: of each yaw 4 rows of 5, and of the row on the border its first pose.
    let stopped = planned(
        &problem,
        &TrialPlanSettings {
            symmetric: true,
            stop_at_first_failure: true,
            ..TrialPlanSettings::new(pattern, accuracy)
        },
    );
    assert_eq!(stopped.points.len(), 6 * (4 * 5 + 1));
}

/// The last angle that docks, by the ratio of lever and width, as computed elsewhere; to one step of 0.25°.
#[test]
fn the_arc_of_the_pyramid_ends_where_it_was_computed() {
    let table = [
        (0.5, 30.0, 32.0),
        (0.935, 20.25, 21.75),
        (1.185, 17.25, 18.25),
        (1.435, 14.75, 15.75),
        (1.935, 11.75, 12.5),
    ];
    for (lever, straight, yawed) in table {
        let text = format!(
            "[connector]\nfamily = \"pyramid\"\naspect_ratio = 1.0\n[alignment]\nfree = [\"x\", \"pitch\", \"yaw\"]\n\
             center_of_rotation = {}\nrotation_length = 0.5\nsymmetry = 4\n",
            -lever
        );
        let problem = Problem::of(read(&text, Path::new("")).unwrap().design).unwrap();
        for (yaw, last) in [(0.0, straight), (20.0, yawed)] {
            let pitch = (0..=180).map(|k| (0.25 * f64::from(k)).to_radians()).collect();
            let pattern = Pattern::Arc { lever, pitch, yaw: vec![f64::to_radians(yaw)] };
            let maker = Maker {
                problem: &problem,
                accuracy: PoseError::default(),
                motions: &descent::DescentSettings::default(),
                symmetric: false,
                seed: 1,
            };
            let made = maker.make(&pattern, &Exec::new()).unwrap();
            let motions = descent::DescentSettings::default();
            let mut judge = DockingOracle::new(&problem, &motions);
            let docking = made.poses.iter().take_while(|placed| judge.docks(&placed.error)).count();
            let result = 0.25 * (docking as f64 - 1.0);
            assert!((result - last).abs() <= 0.25, "{lever} D, {yaw}°: {result}° and not {last}°");
        }
    }
}

/// The face centre of an arc lies L·sin(pitch) behind, turned by the yaw.
#[test]
fn an_arc_moves_the_face_with_its_pitch() {
    let problem = problem("bench-pyramid-arc.toml");
    let lever = mm(&problem, 72.9);
    let pitch: Vec<f64> = (0..=20).map(|k| (2.25 * f64::from(k)).to_radians()).collect();
    let yaw = vec![0.0, 20f64.to_radians()];
    let accuracy = PoseError { x: mm(&problem, 1.2), ..PoseError::default() };
    let plan = planned(&problem, &TrialPlanSettings::new(Pattern::Arc { lever, pitch, yaw }, accuracy));
    assert_eq!((plan.points.len(), plan.points.iter().map(|p| p.line).max()), (42, Some(2)));
    for PlannedPose { error, .. } in &plan.points {
        let back = lever * error.pitch.sin();
        assert!(
            (error.x + back * error.yaw.cos()).abs() < 1e-12
                && (error.y + back * error.yaw.sin()).abs() < 1e-12
        );
    }
    let docking = |line: usize| plan.points.iter().filter(|p| p.line == line && p.prediction.docks()).count();
    // 14.75° and 15.75°: steps 0 to 6 of 2.25°, and 15.75° itself is the seventh.
    assert_eq!((docking(1), docking(2)), (7, 8));
    // A joint elsewhere would have to move a locked offset.
    let elsewhere = Pattern::Arc { lever: 0.5 * lever, pitch: vec![0.3], yaw: vec![0.2] };
    let refused = run(&problem, &TrialPlanSettings::new(elsewhere, accuracy), &Exec::new()).unwrap_err();
    assert!(matches!(refused, TrialPlanError::JointElsewhere { axis: Dof::Y, .. }), "{refused}");
}

/// A grid determines the border along a line to one step; a bracket with points as far apart determines it
/// equally well.
#[test]
fn a_bracket_takes_a_third_of_the_trials_of_a_grid() {
    let problem = problem("bench-x-face.toml");
    let step = mm(&problem, 5.0);
    let half = [Some(0.5 * step), Some(0.5 * step), None, None, None];
    let exact = offsets(&problem, 0.2);
    let grid = Pattern::Grid { steps: [Some(17), Some(17), None, None, None], max: [None; 5] };
    let grid =
        planned(&problem, &TrialPlanSettings { symmetric: true, ..TrialPlanSettings::new(grid, exact) });
    let lines = 13;
    let bracket = Pattern::Bracket { trials: 32, lines: Some(lines), resolution: half };
    let bracket =
        planned(&problem, &TrialPlanSettings { symmetric: true, ..TrialPlanSettings::new(bracket, exact) });
    // Along each line the widest gap between the last pose that docks and the first that does not.
    let uncertainty = |plan: &TrialPlan| {
        let mut widths = Vec::new();
        for line in 1..=plan.points.iter().map(|p| p.line).max().unwrap() {
            let of = |docks: bool| {
                let on = plan.points.iter().filter(move |p| p.line == line && p.prediction.docks() == docks);
                on.map(|p| p.error.x.hypot(p.error.y))
            };
            let (last, first) = (of(true).fold(0.0, f64::max), of(false).fold(f64::INFINITY, f64::min));
            if first.is_finite() && last > 0.0 {
                widths.push(first - last);
            }
        }
        (widths.len(), widths.into_iter().fold(0.0, f64::max))
    };
    let [(grid_lines, wide), (bracket_lines, narrow)] = [uncertainty(&grid), uncertainty(&bracket)];
    assert!(bracket_lines >= lines && grid_lines <= bracket_lines + 1, "{grid_lines} {bracket_lines}");
    assert!(narrow <= step * 1.0001 && narrow <= wide * 1.0001, "{narrow} {wide} {step}");
    assert!(3 * bracket.trials.len() <= grid.trials.len(), "{} {}", bracket.trials.len(), grid.trials.len());
    // No point at the border remains undecided.
    let either = bracket.points.iter().filter(|p| p.prediction.either).count();
    assert_eq!(either, 0);
}

#[test]
fn threads_change_nothing_and_every_pose_is_tried_as_often() {
    let problem = problem("v-face.toml");
    let accuracy = PoseError { x: 0.01, pitch: 0.02, ..PoseError::default() };
    let pattern = Pattern::Bracket { trials: 26, lines: None, resolution: [None; 5] };
    let settings =
        TrialPlanSettings { repeats: 3, blocks: 4, seed: 7, ..TrialPlanSettings::new(pattern, accuracy) };
    let with = |threads| run(&problem, &settings, &Exec::new().with_threads(threads).unwrap()).unwrap();
    let plan = with(1);
    assert!(plan == with(2) && plan == with(4));
    let count = plan.points.len();
    assert_eq!(plan.trials.len(), 3 * count);
    for (k, trial) in plan.trials.iter().enumerate() {
        assert_eq!((trial.number, trial.repeat), (k + 1, k / count + 1));
    }
    for repeat in plan.trials.chunks(count) {
        let mut tried: Vec<usize> = repeat.iter().map(|trial| trial.point).collect();
        assert!(tried.windows(2).any(|pair| pair[0] > pair[1]));
        tried.sort_unstable();
        assert!(tried.into_iter().eq(0..count));
    }
    let block = |number: usize| plan.trials.iter().filter(|trial| trial.block == number).count();
    let sizes: Vec<usize> = (1..=4).map(block).collect();
    assert!(sizes.iter().max().unwrap() - sizes.iter().min().unwrap() <= 1, "{sizes:?}");
    // Every point of a bracket decides, its controls too.
    assert!(plan.points.iter().all(|point| point.prediction.margin() >= 1.9), "{plan:?}");
}

/// Mirrored halves have a mirrored border.
#[test]
fn distances_are_mirrored() {
    let problem = problem("v-face.toml");
    let accuracy = PoseError { x: 0.01, pitch: 0.02, ..PoseError::default() };
    let poses: Vec<PoseError> = [(0.3, 0.2), (0.1, -0.4), (0.45, 0.0), (0.6, 0.3), (0.2, 1.0)]
        .into_iter()
        .flat_map(|(x, pitch)| {
            [1.0, -1.0].map(|s| PoseError { x: s * x, pitch: s * pitch, ..PoseError::default() })
        })
        .collect();
    let motions = descent::DescentSettings::default();
    let (printed, _) = foretell(&problem, &accuracy, &motions, &poses, 1, &Exec::new()).unwrap();
    for pair in printed.chunks(2) {
        assert_eq!(pair[0].predicted, pair[1].predicted);
        let [a, b] = [pair[0].margin(), pair[1].margin()];
        // Directions are random: each is at most so much, and neither by much.
        assert!((a / b - 1.0).abs() < 0.06, "{a} {b}");
    }
}

#[test]
fn invalid_plans_are_refused() {
    let problem = problem("v-face.toml");
    let accuracy = PoseError { x: 0.01, ..PoseError::default() };
    let grid = Pattern::Grid { steps: [Some(3), None, None, None, None], max: [None; 5] };
    let with = |settings: TrialPlanSettings| run(&problem, &settings, &Exec::new()).unwrap_err();
    let none = TrialPlanSettings::new(grid.clone(), PoseError::default());
    assert!(matches!(with(none), TrialPlanError::NoAccuracy));
    let locked = TrialPlanSettings::new(grid.clone(), PoseError { yaw: 0.1, ..accuracy });
    assert!(matches!(with(locked), TrialPlanError::Accuracy { axis: Dof::Yaw, .. }));
    assert!(matches!(
        with(TrialPlanSettings { repeats: 0, ..TrialPlanSettings::new(grid.clone(), accuracy) }),
        TrialPlanError::None { .. }
    ));
    assert!(matches!(
        with(TrialPlanSettings { friction: -1.0, ..TrialPlanSettings::new(grid, accuracy) }),
        TrialPlanError::Friction(_)
    ));
    let pattern = |pattern| with(TrialPlanSettings::new(pattern, accuracy));
    assert!(matches!(pattern(Pattern::Grid { steps: [None; 5], max: [None; 5] }), TrialPlanError::Nothing));
    let many = [Some(5000), None, None, Some(5000), None];
    assert!(matches!(pattern(Pattern::Grid { steps: many, max: [None; 5] }), TrialPlanError::TooMany { .. }));
    let fine = [Some(1e-9), None, None, None, None];
    let lattice = Pattern::Lattice { step: fine, max: [None; 5], along_border: false };
    assert!(matches!(pattern(lattice), TrialPlanError::TooMany { .. }));
    let arc = |lever| Pattern::Arc { lever, pitch: vec![0.1], yaw: vec![0.0] };
    assert!(
        matches!(pattern(arc(0.0)), TrialPlanError::Lever { .. })
            && matches!(pattern(arc(f64::NAN)), TrialPlanError::Lever { .. })
    );
    let turned = Pattern::Arc { lever: 1.0, pitch: vec![0.1], yaw: vec![0.1] };
    assert!(matches!(pattern(turned), TrialPlanError::Locked { axis: Dof::Yaw }));
    let few = Pattern::Bracket { trials: 3, lines: None, resolution: [None; 5] };
    assert!(matches!(pattern(few), TrialPlanError::TooFew { fewest: 4, .. }));
}

/// The requested number of trials, for any distance of the border from zero or the error box; without
/// repeated poses.
#[test]
fn a_bracket_has_the_requested_number_of_trials() {
    let about = |size: f64| PoseError::from_array([size; 5]);
    for (design, accuracy, trials) in [
        ("pyramid.toml", about(0.02), 40),
        ("x-face-3d.toml", about(0.02), 30),
        ("v-face.toml", PoseError { x: 0.08, pitch: 0.1, ..PoseError::default() }, 33),
    ] {
        let problem = problem(design);
        let pattern = Pattern::Bracket { trials, lines: None, resolution: [None; 5] };
        let plan = planned(&problem, &TrialPlanSettings::new(pattern, accuracy));
        assert_eq!(plan.trials.len(), trials, "{design}");
        let mut poses: Vec<_> =
            plan.points.iter().map(|point| point.error.to_array().map(f64::to_bits)).collect();
        poses.sort_unstable();
        poses.dedup();
        assert_eq!(poses.len(), trials, "{design}");
        // Most trials are decisive: lines on which a pair fits on both sides come first.
        let decide = plan.points.iter().filter(|point| point.prediction.margin() >= 1.9).count();
        assert!(10 * decide >= 9 * trials, "{design}: {decide} of {trials}");
    }
}
