//! Verdicts on robots that agree with the prediction, and on robots that do not.

use super::*;
use crate::plan::{self, Pattern};
use crate::success::normals;
use catchment_core::acceptance::Stream;
use catchment_core::document::Subject;
use catchment_core::exec::Exec;
use catchment_core::poses::OffsetsAt;
use std::path::Path;

fn problem(name: &str) -> Problem {
    Problem::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs").join(name)).unwrap()
}

/// The arc of the published test: 21 angles at two yaws.
fn arc(problem: &Problem) -> (Vec<PoseError>, PoseError) {
    let width = problem.design().width;
    let pattern = Pattern::Arc {
        lever: 72.9 / width,
        pitch: (0..=20).map(|k| (2.25 * f64::from(k)).to_radians()).collect(),
        yaw: vec![0.0, 20f64.to_radians()],
    };
    let accuracy = PoseError { x: 1.2 / width, pitch: 0.5f64.to_radians(), ..PoseError::default() };
    let plan = plan::run(problem, &plan::TrialPlanSettings::new(pattern, accuracy), &Exec::new()).unwrap();
    (plan.points.iter().map(|point| point.error).collect(), accuracy)
}

/// Observations of a robot that goes to `real` poses with normal errors of this accuracy, on its own bench,
/// and records others.
fn trials(
    bench: &Problem,
    [real, written]: [&[PoseError]; 2],
    accuracy: &PoseError,
    friction: f64,
    seed: u64,
) -> Vec<RobotTrial> {
    let motions = descent::DescentSettings::with_friction(friction).unwrap();
    let mut judge = plan::DockingOracle::new(bench, &motions);
    let random = Stream::new(seed);
    let tried = real.iter().zip(written).enumerate().map(|(k, (real, written))| {
        let z = normals(|n| random.uniform(6 * k as u64 + n));
        let (at, by) = (real.to_array(), accuracy.to_array());
        let error = PoseError::from_array(std::array::from_fn(|k| at[k] + by[k] * z[k]));
        RobotTrial {
            trial: k as u64 + 1,
            line: 1,
            error: *written,
            observed: Some(judge.predict(&error).unwrap_or(ObservedOutcome::Jammed)),
            predicted: None,
        }
    });
    tried.collect()
}

/// Frequencies of each verdict over this many runs. Predictions are made once: they do not depend on the
/// observations.
fn verdicts(
    [predicting, bench]: [&Problem; 2],
    [real, written]: [&[PoseError]; 2],
    accuracy: &PoseError,
    friction: f64,
    runs: u64,
) -> [usize; 3] {
    let settings = ValidationSettings::new(*accuracy);
    let motions = descent::DescentSettings::default();
    let (prediction, _) =
        foretell(predicting, accuracy, &motions, written, settings.seed, &Exec::new()).unwrap();
    let mut counts = [0; 3];
    for seed in 0..runs {
        let made = trials(bench, [real, written], accuracy, friction, seed);
        let docked = |o| matches!(o, ObservedOutcome::Aligned | ObservedOutcome::AlignedElsewhere);
        let judged = made
            .iter()
            .zip(&prediction)
            .map(|(tried, prediction)| PredictedTrial::new(tried, *prediction, tried.observed.map(docked)));
        counts[summary(predicting, judged.collect(), &settings).verdict as usize] += 1;
    }
    counts
}

fn arc_about(cor_d: f64) -> Problem {
    let problem = problem("bench-pyramid-arc.toml");
    let mut design = problem.design().clone();
    design.alignment.center_of_rotation = cor_d;
    problem.with(design).unwrap()
}

/// Angles of the joint in quarters of a degree at two yaws, as face poses of a design: the offsets at its centre of rotation are 0.
fn fine_arc(problem: &Problem) -> Vec<PoseError> {
    let pose = |k: i32, yaw: f64| {
        let measured = PoseError {
            pitch: (0.25 * f64::from(k)).to_radians(),
            yaw: yaw.to_radians(),
            ..PoseError::default()
        };
        OffsetsAt::Cor.to_face(&measured, problem.alignment())
    };
    [0.0, 20.0].into_iter().flat_map(|yaw| (20..=120).map(move |k| pose(k, yaw))).collect()
}

/// A robot with the stated accuracy, and halves as predicted: hardly ever inconsistent.
fn as_predicted(runs: u64) {
    let problem = problem("bench-pyramid-arc.toml");
    let (poses, accuracy) = arc(&problem);
    let fine = fine_arc(&problem);
    for poses in [&poses[..], &fine[..]] {
        let [consistent, ..] = verdicts([&problem; 2], [poses; 2], &accuracy, 0.0, runs);
        println!("as predicted, {} poses: {consistent} of {runs} consistent", poses.len());
        assert!(consistent as f64 >= 0.95 * runs as f64, "{consistent} of {runs}");
    }
}

/// A centre of rotation that is 0.3 D away from that of the design, or friction of 0.5: hardly ever
/// consistent. (Friction of 0.3 changes none of these outcomes: the faces are steeper than it can hold.)
fn assert_rarely_consistent(runs: u64) {
    let problem = problem("bench-pyramid-arc.toml");
    let cor = problem.alignment().center_of_rotation;
    let (poses, accuracy) = arc(&problem);
    let real = fine_arc(&problem);
    for by in [0.3, -0.3] {
        let wrong = arc_about(cor + by);
        let written = fine_arc(&wrong);
        let [_, inconsistent, _] = verdicts([&wrong, &problem], [&real, &written], &accuracy, 0.0, runs);
        println!("COR {by} D off: {inconsistent} of {runs} inconsistent");
        assert!(inconsistent as f64 >= 0.95 * runs as f64, "COR {by} D off: {inconsistent} of {runs}");
    }
    let motions = [0.0, 0.3].map(|mu| descent::DescentSettings::with_friction(mu).unwrap());
    let docking = motions.map(|motions| {
        let mut judge = plan::DockingOracle::new(&problem, &motions);
        poses.iter().map(|pose| judge.docks(pose)).collect::<Vec<bool>>()
    });
    assert_eq!(docking[0], docking[1]);
    let [_, inconsistent, _] = verdicts([&problem; 2], [&poses; 2], &accuracy, 0.5, runs);
    println!("friction 0.5: {inconsistent} of {runs} inconsistent");
    assert!(inconsistent as f64 >= 0.95 * runs as f64, "friction: {inconsistent} of {runs}");
}

#[test]
fn robots_as_predicted_are_consistent() {
    as_predicted(20);
}

#[test]
fn robots_unlike_the_prediction_are_inconsistent() {
    assert_rarely_consistent(10);
}

/// The same, 200 runs each: minutes.
#[test]
#[ignore = "minutes"]
fn verdicts_hold_in_200_runs() {
    as_predicted(200);
    assert_rarely_consistent(200);
}

/// A V-Face of which only x is free: the border is at 0.5.
fn v_face() -> Problem {
    let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nfree = [\"x\"]\n";
    Problem::of(catchment_core::design::read(text, Path::new("")).unwrap().design).unwrap()
}

fn row(trial: u64, x: f64, observed: Option<ObservedOutcome>) -> RobotTrial {
    RobotTrial { trial, line: 1, error: PoseError { x, ..PoseError::default() }, observed, predicted: None }
}

fn judged(rows: &[(f64, Option<ObservedOutcome>)]) -> Validation {
    let tried: Vec<RobotTrial> =
        rows.iter().enumerate().map(|(k, (x, seen))| row(k as u64 + 1, *x, *seen)).collect();
    let accuracy = PoseError { x: 0.02, ..PoseError::default() };
    run(&v_face(), &tried, &ValidationSettings::new(accuracy), &Exec::new()).unwrap()
}

const DOCKED: Option<ObservedOutcome> = Some(ObservedOutcome::Aligned);
const JAMMED: Option<ObservedOutcome> = Some(ObservedOutcome::Jammed);
const MISSED: Option<ObservedOutcome> = Some(ObservedOutcome::Missed);

#[test]
fn counts_margins_and_lines_are_those_of_the_table() {
    // Margins in units of 0.02: 0.1 is 20 from the border, 0.45 is 2.5, 0.49 is 0.5, 0.55 is 2.5.
    let result = judged(&[
        (0.1, DOCKED),
        (0.2, DOCKED),
        (0.3, DOCKED),
        (0.45, DOCKED),
        (0.49, MISSED),
        (0.55, MISSED),
        (0.6, MISSED),
        (0.7, None),
    ]);
    assert_eq!((result.verdict, result.blank, result.evidence.beyond), (PredictionVerdict::Consistent, 1, 0));
    assert_eq!((result.evidence.inside, result.evidence.outside), (4, 2));
    for (judged, margin) in result.trials.iter().zip([20.0, 15.0, 10.0, 2.5, 0.5, 2.5, 5.0, 10.0]) {
        assert!((judged.prediction().margin() / margin - 1.0).abs() < 5e-3, "{judged:?}");
    }
    // The trial that may go either way is counted separately.
    assert_eq!((result.agreement.agreed, result.agreement.trials), (6, 6));
    let either: Vec<&Count> = result.counts.iter().filter(|count| count.either).collect();
    assert_eq!((either.len(), either[0].trials, either[0].observed), (1, 1, ObservedOutcome::Missed));
    assert_eq!(result.counts.iter().map(|count| count.trials).sum::<usize>(), 7);
    let [line] = &result.lines[..] else { panic!("one line") };
    assert_eq!(
        (line.last_success.unwrap().x, line.first_failure.unwrap().x, line.in_order),
        (0.45, 0.49, true)
    );
    assert_eq!((line.predicted_success.unwrap().x, line.predicted_failure.unwrap().x), (0.49, 0.55));
    // 2Φ(−2.5): the others are next to nothing, and that which may go either way does not count.
    assert!((result.early.expected - 0.012_419).abs() < 1e-3 && result.early.disagreeing == 0);
    assert_eq!((result.early.trials, result.late.trials), (4, 2));
}

/// Within one accuracy of the border, and on the border itself, no outcome contradicts the prediction.
#[test]
fn a_trial_within_one_accuracy_of_the_border_is_no_disagreement() {
    let rows = [(0.1, DOCKED), (0.49, MISSED), (0.499_999, JAMMED), (0.51, DOCKED), (0.3, JAMMED)];
    let result = judged(&rows);
    let disagrees: Vec<bool> = result.trials.iter().map(|trial| trial.disagrees).collect();
    assert_eq!(disagrees, [false, false, false, false, true]);
    // The search ends at a thousandth of an accuracy.
    assert!(result.trials[2].prediction().margin() < 5e-3);
}

#[test]
fn one_failure_far_inside_refutes_but_one_near_the_limit_does_not() {
    let inside = |seen| {
        let mut rows = vec![(0.1, seen)];
        rows.extend([0.2, 0.25, 0.3, 0.35].map(|x| (x, DOCKED)));
        judged(&rows)
    };
    assert_eq!(inside(DOCKED).verdict, PredictionVerdict::Consistent);
    let failed = inside(JAMMED);
    assert_eq!((failed.verdict, failed.evidence.beyond), (PredictionVerdict::Inconsistent, 1));
    assert!(failed.evidence.p_value < 1e-10 && failed.early.p_value < 1e-10);
    // At 2.05 accuracies, a failure among ten trials is likely: 1 − (1 − 0.04)¹⁰ = 0.34.
    let near: Vec<_> = (0..10).map(|k| (0.459, if k == 0 { MISSED } else { DOCKED })).collect();
    let near = judged(&near);
    assert_eq!((near.verdict, near.evidence.beyond), (PredictionVerdict::Consistent, 1));
    assert!((near.early.p_value - 0.34).abs() < 0.03 && near.evidence.p_value == 1.0, "{near:?}");
    // Half of them may not.
    let half: Vec<_> = (0..10).map(|k| (0.459, if k % 2 == 0 { MISSED } else { DOCKED })).collect();
    assert_eq!(judged(&half).verdict, PredictionVerdict::Inconsistent);
}

#[test]
fn too_few_trials_decide_nothing() {
    let few =
        judged(&[(0.1, DOCKED), (0.2, DOCKED), (0.49, MISSED), (0.51, DOCKED), (0.6, MISSED), (0.3, None)]);
    assert_eq!(few.verdict, PredictionVerdict::Undecided);
    assert_eq!((few.evidence.inside, few.evidence.outside), (2, 1));
    let settings = ValidationSettings::new(PoseError { x: 0.02, ..PoseError::default() });
    let nothing = run(&v_face(), &[row(1, 0.1, None)], &settings, &Exec::new());
    assert!(matches!(nothing, Err(ValidateError::NothingMade)));
    let limit = ValidationSettings { limit: 0.5, ..settings.clone() };
    assert!(matches!(
        run(&v_face(), &[row(1, 0.1, DOCKED)], &limit, &Exec::new()),
        Err(ValidateError::Limit { .. })
    ));
    let exact = ValidationSettings { accuracy: PoseError::default(), ..settings };
    assert!(matches!(
        run(&v_face(), &[row(1, 0.1, DOCKED)], &exact, &Exec::new()),
        Err(ValidateError::Accuracy(_))
    ));
}

/// Halves with a friction of 0.5, tried without an error: the interval holds 0.5 and not 0.
#[test]
fn the_friction_that_made_the_trials_is_in_the_interval() {
    let problem = problem("bench-x-face.toml");
    let width = problem.design().width;
    let accuracy = PoseError { x: 1.0 / width, y: 1.0 / width, ..PoseError::default() };
    let pattern = Pattern::Grid {
        steps: [Some(8), Some(8), None, None, None],
        max: [Some(1.0), Some(1.0), None, None, None],
    };
    let settings =
        plan::TrialPlanSettings { symmetric: true, ..plan::TrialPlanSettings::new(pattern, accuracy) };
    let planned = plan::run(&problem, &settings, &Exec::new()).unwrap();
    let poses: Vec<PoseError> = planned.points.iter().map(|point| point.error).collect();
    let made = trials(&problem, [&poses; 2], &PoseError::default(), 0.5, 1);
    let settings = ValidationSettings { estimate_friction: true, ..ValidationSettings::new(accuracy) };
    let with =
        |threads| run(&problem, &made, &settings, &Exec::new().with_threads(threads).unwrap()).unwrap();
    let result = with(1);
    let friction = result.friction.clone().unwrap();
    println!("{friction:?}");
    assert_eq!((result.verdict, friction.fewest), (PredictionVerdict::Inconsistent, 0));
    assert!(friction.low > 0.0 && friction.low <= 0.5 && friction.high >= 0.5, "{friction:?}");
    assert!(friction.tried[0].beyond > 0 && friction.high < 0.7, "{friction:?}");
    // With that friction the prediction holds; and threads change nothing.
    let with_friction = ValidationSettings { friction: 0.5, estimate_friction: false, ..settings.clone() };
    let again = run(&problem, &made, &with_friction, &Exec::new()).unwrap();
    assert_eq!(
        (again.verdict, again.agreement.agreed),
        (PredictionVerdict::Consistent, again.agreement.trials)
    );
    assert!(result == with(2) && result == with(4));
}

/// A pyramid that docks rotated by a quarter turn docks if its design declares this symmetry, and fails if
/// not.
#[test]
fn a_symmetric_pose_docks_if_the_design_declares_it() {
    let fourfold = problem("bench-pyramid.toml");
    let accuracy = PoseError { x: 0.002, y: 0.002, ..PoseError::default() };
    let tried: Vec<RobotTrial> =
        (1..=6).map(|k| row(k, 0.02 * k as f64, Some(ObservedOutcome::AlignedElsewhere))).collect();
    let result = run(&fourfold, &tried, &ValidationSettings::new(accuracy), &Exec::new()).unwrap();
    assert_eq!((result.verdict, result.turned), (PredictionVerdict::Consistent, 6));
    let mut design = fourfold.design().clone();
    design.alignment.symmetry = 1;
    let result =
        run(&fourfold.with(design).unwrap(), &tried, &ValidationSettings::new(accuracy), &Exec::new())
            .unwrap();
    assert_eq!(
        (result.verdict, result.evidence.beyond, result.turned),
        (PredictionVerdict::Inconsistent, 6, 0)
    );
    // Turned by nearly a quarter it does dock there, and that is predicted.
    let turned = RobotTrial {
        error: PoseError { yaw: 80f64.to_radians(), ..PoseError::default() },
        ..tried[0].clone()
    };
    let result = run(&fourfold, &[turned], &ValidationSettings::new(accuracy), &Exec::new()).unwrap();
    assert_eq!(
        (result.trials[0].prediction().predicted, result.turned),
        (Some(ObservedOutcome::AlignedElsewhere), 0)
    );
}

/// Trials within one accuracy of the border are counted separately, and are not in the list of disagreements
/// or its column.
#[test]
fn disagreements_leave_out_trials_within_one_accuracy_of_the_border() {
    let result = judged(&[(0.1, DOCKED), (0.49, MISSED), (0.499_999, JAMMED), (0.51, DOCKED), (0.3, JAMMED)]);
    let listed: Vec<u64> = result.disagreements.iter().map(|trial| trial.trial).collect();
    assert_eq!(listed, [5]);
    let document = result.document(v_face().design());
    let records = document.records().unwrap().records();
    let column = |name: &str| records[0].iter().position(|head| head == name).unwrap();
    let both = [column("either"), column("disagrees")];
    let shown: Vec<[&str; 2]> = records[1..].iter().map(|row| both.map(|k| row[k].as_str())).collect();
    assert_eq!(shown[1..4], [["true", "false"]; 3]);
    assert!(!format!("{document:?}").contains("0.00 accuracies"), "{document:?}");
}
