//! Closed forms, the quasi-static limit, and inputs that must not change a bit.

use super::*;
use crate::testing::problem;
use catchment_core::acceptance::Outcome;
use catchment_core::design::Family;
use catchment_core::exec::Exec;
use catchment_core::method::drop::{Launch, Push};
use catchment_core::pose::DofSet;
use catchment_core::poses::ScalarDistribution;
use catchment_core::problem::Problem;

fn free(dofs: &[Dof]) -> DofSet {
    dofs.iter().copied().collect()
}

/// Without rotations it corrects offsets up to D/2.
fn sliding() -> Problem {
    problem(Family::VFace, free(&[Dof::X]))
}

fn x(x: f64) -> PoseError {
    PoseError { x, ..PoseError::default() }
}

fn speed(speed: f64) -> Dynamics {
    Dynamics::default().with(Circumstance::Speed, ScalarDistribution::constant(speed))
}

fn normal(x: f64, pitch: f64) -> Spread {
    Spread::normal(PoseError { x, pitch, ..PoseError::default() })
}

fn outcomes(problem: &Problem, requested: &Question, settings: &ChanceSettings) -> Chance {
    run(problem, requested, settings, &Exec::new()).unwrap()
}

fn of_poses(problem: &Problem, poses: &[PoseError], settings: &ChanceSettings) -> Vec<PoseChance> {
    outcomes(problem, &Question { poses: poses.to_vec(), ..Question::default() }, settings).poses
}

fn holds([lo, hi]: [f64; 2], value: f64) -> bool {
    lo <= value && value <= hi
}

/// A half that drifts at u at its release has moved by u/γ when it lands, if it falls for much longer than
/// 1/γ (here 50 times): of drifts uniform within 0 and 4 D/s, those below 2 D/s leave an offset of 0.3 D
/// below D/2 at γ = 10/s.
#[test]
fn a_drifting_half_lands_as_in_the_closed_form() {
    let dynamics = speed(0.1)
        .with(Circumstance::DriftX, ScalarDistribution::Uniform { from: 0.0, to: 4.0 })
        .with(Circumstance::Height, ScalarDistribution::constant(0.5));
    let settings = ChanceSettings { dynamics, trials: 200, ..ChanceSettings::default() };
    let pose = of_poses(&sliding(), &[x(0.3)], &settings)[0];
    assert!(holds(pose.ci95, 0.5), "{pose:?}");
    assert_eq!(pose.quasi_static, 1.0);
    // With the drift outwards from the other side it comes nearer: all dock.
    assert_eq!(of_poses(&sliding(), &[x(-0.3)], &settings)[0].probability, 1.0);
}

/// Slow halves have the outcomes of exact motions; under normal offsets P = erf(1/(2σ√2)), and 20 intervals
/// miss it at most 4 times (one test in 400 would fail with exact 95 % coverage).
#[test]
fn slow_halves_have_the_probability_of_the_closed_form() {
    let exact = libm::erf(0.5 / (0.3 * 2f64.sqrt()));
    let requested = Question { errors: Some(normal(0.3, 0.0)), ..Question::default() };
    let mut held = 0;
    for seed in 0..20 {
        let settings =
            ChanceSettings { dynamics: speed(0.02), overall: 100, seed, ..ChanceSettings::default() };
        let result = outcomes(&sliding(), &requested, &settings).overall.unwrap();
        held += usize::from(holds(result.ci95, exact));
        assert!(holds(result.quasi_static_ci95, exact) || (result.quasi_static - exact).abs() < 0.02);
        assert!((result.outcomes.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }
    assert!(held >= 16, "{held} of 20 hold {exact}");
}

/// As v → 0 the curve converges to exact motion, including rotations and friction; fast halves differ.
#[test]
fn the_curve_meets_exact_motion_where_speed_vanishes() {
    let problem = problem(Family::VFace, free(&[Dof::X, Dof::Pitch]));
    for friction in [0.0, 0.2] {
        let dynamics = Dynamics::default()
            .with(Circumstance::Speed, ScalarDistribution::Lognormal { median: 1.0, factor: 1.3 })
            .with(Circumstance::DriftX, ScalarDistribution::Normal { mean: 0.0, sigma: 1.0 })
            .with(Circumstance::Friction, ScalarDistribution::constant(friction))
            .with(Circumstance::Restitution, ScalarDistribution::constant(0.2));
        let settings = ChanceSettings { dynamics, overall: 300, ..ChanceSettings::default() };
        let errors = Some(normal(0.3, 0.5));
        let requested = Question { errors, times: vec![16.0, 0.01], ..Question::default() };
        let result = outcomes(&problem, &requested, &settings);
        let overall = result.overall.unwrap();
        let [slow, fast] = result.curve[..] else { panic!("{:?}", result.curve) };
        assert!((slow.factor, fast.factor) == (0.01, 16.0));
        // Both values are estimates with intervals of their own.
        let apart = (slow.probability - overall.quasi_static).abs();
        let half = |[lo, hi]: [f64; 2]| 0.5 * (hi - lo);
        let doubt = half(slow.ci95).hypot(half(overall.quasi_static_ci95));
        assert!(apart <= doubt, "μ {friction}: {slow:?} for {}", overall.quasi_static);
        assert!(fast.ci95[1] < overall.quasi_static_ci95[0], "{fast:?}");
    }
}

/// A pushed half is released at the sampled speed, in its own time: the same trial as with explicit settings.
#[test]
fn a_given_push_is_taken_as_it_is() {
    let problem = sliding();
    let drop = drop::DropSettings {
        push: Push::Gravity(100.0),
        damping: 5.0,
        angular_damping: 5.0,
        perturbation: 0.0,
        ..drop::DropSettings::default()
    };
    let dynamics = speed(2.0).with(Circumstance::DriftX, ScalarDistribution::constant(3.0));
    let settings =
        ChanceSettings { drop: drop.clone(), dynamics, held: false, trials: 1, ..ChanceSettings::default() };
    let by_hand =
        drop::DropSettings { launch: Launch { speed: 2.0, drift: [3.0, 0.0], spin: [0.0; 3] }, ..drop };
    let bench = drop::Bench::new(problem.pair()).unwrap();
    let mut met = Vec::new();
    for at in [-0.9, -0.6, -0.3, 0.0, 0.3, 0.45] {
        let end = bench.fall(&x(at), &by_hand, &Exec::new()).unwrap();
        let result = of_poses(&problem, &[x(at)], &settings)[0];
        assert_eq!(result.outcomes[results::place(end.outcome)], 1, "{at}");
        met.push(end.outcome);
    }
    assert!(met.contains(&Outcome::Aligned) && met.contains(&Outcome::Missed), "{met:?}");
}

/// The friction with the surroundings is that of the mean mass: twice the mass coasts as twice the speed does.
#[test]
fn a_heavy_half_coasts_as_a_fast_one() {
    let problem = sliding();
    let at = |mass: f64, speed: f64| {
        let law = ScalarDistribution::Measured { measured: vec![mass, mass] };
        // Its mean is the nominal mass for a constant distribution.
        let nominal = ScalarDistribution::Measured { measured: vec![1.0] };
        let drop = drop::DropSettings { perturbation: 0.0, ..ChanceSettings::default().drop };
        let dynamics = Dynamics::default().with(Circumstance::Mass, nominal);
        let settings = ChanceSettings { drop, dynamics, ..ChanceSettings::default() };
        let dynamics = Dynamics::default()
            .with(Circumstance::Speed, ScalarDistribution::constant(speed))
            .with(Circumstance::DriftX, ScalarDistribution::constant(2.0 * speed))
            .with(Circumstance::Mass, law);
        let draw = trial::Draw::of(&dynamics, catchment_core::acceptance::Stream::new(1));
        draw.settings(&settings, 1.0, 1.0)
    };
    let (heavy, fast) = (at(2.0, 0.5), at(1.0, 1.0));
    assert_eq!(heavy.damping, fast.damping);
    assert_eq!(heavy.launch, fast.launch);
    let (Push::Force(twice), Push::Force(once)) = (heavy.push, fast.push) else { panic!() };
    // F over m.
    assert!((twice / 2.0 - once).abs() < 1e-12 * once);
    let bench = drop::Bench::new(problem.pair()).unwrap();
    for at in [0.1, 0.3, 0.45, 0.6] {
        let [a, b] = [&heavy, &fast].map(|settings| bench.fall(&x(at), settings, &Exec::new()).unwrap());
        assert_eq!(a.outcome, b.outcome, "{at}");
    }
}

#[test]
fn neither_threads_nor_other_poses_change_a_bit() {
    let problem = problem(Family::VFace, free(&[Dof::X, Dof::Pitch]));
    let dynamics = Dynamics::default()
        .with(Circumstance::Speed, ScalarDistribution::Normal { mean: 1.0, sigma: 0.3 })
        .with(Circumstance::Friction, ScalarDistribution::Uniform { from: 0.0, to: 0.3 });
    let settings = ChanceSettings { dynamics, trials: 8, overall: 100, ..ChanceSettings::default() };
    let axis = |dof, cells| GridAxis { dof, lo: -0.6, hi: 0.6, cells };
    let poses = vec![x(0.3), x(0.45), PoseError { pitch: 0.4, ..x(0.2) }];
    let requested = Question {
        poses: poses.clone(),
        map: vec![axis(Dof::X, 3), axis(Dof::Pitch, 2)],
        errors: Some(normal(0.3, 0.3)),
        times: vec![2.0],
    };
    let on = |threads: usize| {
        run(&problem, &requested, &settings, &Exec::new().with_threads(threads).unwrap()).unwrap()
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(4));
    // Strata that run out leave a few.
    assert!(one.trials <= requested.trials(&settings) && one.trials + 10 > requested.trials(&settings));
    let reversed: Vec<PoseError> = poses.into_iter().rev().collect();
    let mut alone = of_poses(&problem, &reversed, &settings);
    alone.reverse();
    assert_eq!(alone, one.poses);
    let map = one.map.unwrap();
    assert_eq!(map.cells.len(), 6);
    assert!((map.cells[0].error.x + 0.4).abs() < 1e-12 && (map.cells[1].error.x).abs() < 1e-12);
    let other = ChanceSettings { seed: 2, ..settings };
    assert_ne!(outcomes(&problem, &requested, &other).overall, one.overall);
}

/// Both sides of a symmetric half are as likely, within both intervals.
#[test]
fn mirror_images_are_as_likely() {
    let problem = problem(Family::VFace, free(&[Dof::X, Dof::Pitch]));
    let dynamics =
        speed(2.0).with(Circumstance::DriftX, ScalarDistribution::Normal { mean: 0.0, sigma: 1.0 });
    let settings = ChanceSettings { dynamics, trials: 60, ..ChanceSettings::default() };
    for [at, pitch] in [[0.4, 0.2], [0.3, -0.5], [0.5, 0.3]] {
        let pose = |side: f64| PoseError { pitch: side * pitch, ..x(side * at) };
        let [one, other] = of_poses(&problem, &[pose(1.0), pose(-1.0)], &settings)[..] else { panic!() };
        let ([a, b], [c, d]) = (one.ci95, other.ci95);
        assert!(a <= d && c <= b, "{at}: {one:?} {other:?}");
    }
}

/// The majority of three is wrong if two or three of them are.
#[test]
fn majority_of_three_has_its_closed_form() {
    for single in [0.0, 0.0008, 0.1, 0.5, 1.0f64] {
        let two_or_three = 3.0 * single * single * (1.0 - single) + single.powi(3);
        assert!((majority_of_three(single) - two_or_three).abs() < 1e-15);
    }
    // The dissertation's engine: 9 of 12 000 near the border.
    let [lo, hi] = catchment_core::method::correction::wilson95(9.0 / 12_000.0, 12_000.0);
    assert!((lo - 0.000_395).abs() < 2e-6 && (hi - 0.001_425).abs() < 2e-6, "{lo} {hi}");
}

#[test]
fn invalid_questions_are_refused() {
    let problem = sliding();
    let pose = || Question { poses: vec![x(0.1)], ..Question::default() };
    let refused = |requested: &Question, settings: &ChanceSettings| {
        run(&problem, requested, settings, &Exec::new()).unwrap_err().to_string()
    };
    let sound = ChanceSettings { dynamics: speed(1.0), ..ChanceSettings::default() };
    assert!(refused(&Question::default(), &sound).starts_with("nothing to compute"));
    assert!(refused(&pose(), &ChanceSettings::default()).contains("approach speed may be 0"));
    let stands = ChanceSettings { dynamics: speed(0.0), ..ChanceSettings::default() };
    assert!(refused(&pose(), &stands).contains("approach speed may be 0"));
    let mut undamped = sound.clone();
    undamped.drop.damping = 0.0;
    assert!(refused(&pose(), &undamped).contains("without damping"));
    let turns = speed(1.0).with(Circumstance::SpinYaw, ScalarDistribution::constant(1.0));
    let turning = ChanceSettings { dynamics: turns, ..ChanceSettings::default() };
    assert!(refused(&pose(), &turning).contains("spin_yaw is declared, and the design locks yaw"));
    assert!(refused(&pose(), &ChanceSettings { trials: 0, ..sound.clone() }).contains("too few"));
    assert!(refused(&pose(), &ChanceSettings { trials: 1 << 40, ..sound.clone() }).contains("days"));
    let errors =
        |errors: Spread, times: Vec<f64>| Question { errors: Some(errors), times, ..Question::default() };
    assert!(refused(&errors(normal(0.1, 0.1), Vec::new()), &sound).contains("pitch does not vary"));
    assert!(refused(&errors(normal(0.0, 0.0), Vec::new()), &sound).contains("none of the expected errors"));
    assert!(refused(&errors(normal(0.1, 0.0), vec![0.0]), &sound).contains("multiplied by 0"));
    assert!(refused(&errors(normal(0.1, 0.0), vec![f64::NAN]), &sound).contains("multiplied by NaN"));
    let few = ChanceSettings { overall: 10, ..sound.clone() };
    assert!(refused(&errors(normal(0.1, 0.0), Vec::new()), &few).contains("10 trials"));
    let yaw = GridAxis { dof: Dof::Yaw, lo: -1.0, hi: 1.0, cells: 3 };
    assert!(
        refused(&Question { map: vec![yaw], ..Question::default() }, &sound).contains("yaw does not vary")
    );
    let stopped = Exec::new();
    stopped.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert!(matches!(run(&problem, &pose(), &sound, &stopped), Err(ChanceError::Cancelled(_))));
}
