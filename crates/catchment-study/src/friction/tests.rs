use super::*;
use crate::testing::problem;
use catchment_core::design::Family;
use catchment_core::pose::{Dof, DofSet};

/// Rotations locked, the critical friction of a facet is its slope: of every pose, and so of every share of them.
#[test]
fn on_facets_the_critical_friction_is_the_slope() {
    for (family, ratio, slope) in [(Family::VFace, 0.1, 0.2), (Family::XFace, 0.3, 0.3)] {
        let text = format!(
            "[connector]\nfamily = \"{}\"\naspect_ratio = {ratio}\n[alignment]\nfree = [\"x\"]\n",
            family.name()
        );
        let problem = Problem::of(catchment_core::design::read(&text, ".".as_ref()).unwrap().design).unwrap();
        let settings =
            FrictionSettings { frictions: vec![0.1, 0.15, 1.05 * slope, 0.4], motions: Some(200), seed: 2 };
        let result = run(&problem, &settings, &Exec::new()).unwrap();
        let docked = result.curve[0].aligned.count;
        assert!(docked > 50);
        for kept in &result.kept {
            assert!((kept.friction - slope).abs() <= EXACT, "{family:?} {kept:?}");
            assert!(kept.ci95[0] <= kept.friction && kept.friction <= kept.ci95[1]);
            assert!(!kept.is_top);
        }
        // The paths are straight, so more friction never helps.
        assert!(result.curve.windows(2).all(|two| two[1].aligned.count <= two[0].aligned.count));
        // All poses fail at the slope of the face: within a tenth above it, all lost poses hold weakly.
        for tally in &result.curve {
            let friction = &tally.friction;
            let is_near = *friction > slope && *friction < HARDLY * slope;
            assert_eq!(tally.barely_stuck, if is_near { tally.lost } else { 0 }, "{family:?} {friction}");
        }
        let last = result.curve[4];
        // Poses that start within the depth of the seat dock without motion.
        assert_eq!((last.lost + last.aligned.count, last.gained, result.come_back), (docked, 0, 0));
        assert!(last.aligned.count < docked / 10, "{last:?}");
        // The paths are straight here, so the static test is right, except for starts within a step of the
        // seat.
        assert!(result.curve.iter().all(|rung| rung.static_wrong <= 2), "{:?}", result.curve);
        assert_eq!(result.sticks_first.poses, AT_LEAST);
        let pair = &result.sticks_first.features[0];
        assert_eq!(pair.count, AT_LEAST);
        for friction in [pair.critical_least, pair.critical_median] {
            assert!((friction - slope).abs() <= EXACT, "{family:?} {pair:?}");
        }
    }
}

#[test]
fn tallies_add_up_and_threads_change_nothing() {
    let problem = problem(Family::XFace3d, DofSet::ALL);
    let settings = FrictionSettings { frictions: vec![0.3, 0.1, 0.3, 0.0], motions: Some(120), seed: 3 };
    let with = |threads| run(&problem, &settings, &Exec::new().with_threads(threads).unwrap()).unwrap();
    let result = with(1);
    assert_eq!(result, with(2));
    assert_eq!(result.settings.frictions, [0.1, 0.3]);
    let docked = result.curve[0].aligned.count;
    for tally in &result.curve {
        let friction = tally.friction;
        assert_eq!(
            [tally.aligned, tally.jammed, tally.missed, tally.undecided]
                .map(|of| of.count)
                .iter()
                .sum::<usize>(),
            120
        );
        assert_eq!(tally.aligned.count + tally.lost, docked + tally.gained, "{friction}");
        assert!(tally.may_stick <= tally.aligned.count && tally.static_docks <= docked);
        assert!(tally.wedged <= tally.jammed.count && tally.barely_stuck <= tally.lost);
    }
    // Up to less friction more of them dock still.
    assert!(
        result.kept.windows(2).all(|two| two[0].share > two[1].share && two[0].friction <= two[1].friction)
    );
    let direct = |friction: f64| {
        let Domain::Poses(poses) = Domain::random(problem.alignment(), 120, 3) else { unreachable!() };
        let settings = descent::DescentSettings::with_friction(friction).unwrap();
        poses
            .iter()
            .filter(|pose| descent::outcome(problem.pair(), pose, &settings).outcome == Outcome::Aligned)
            .count()
    };
    assert_eq!(
        result.curve.iter().map(|rung| rung.aligned.count).collect::<Vec<_>>(),
        [0.0, 0.1, 0.3].map(direct)
    );
}

#[test]
fn the_interval_of_a_quantile_holds_it() {
    let way = |critical: f64| PoseByFriction {
        without: Outcome::Aligned,
        at: Vec::new(),
        holds: 0.0,
        critical: (critical < 0.5).then_some([critical, critical + EXACT]),
    };
    // Critical frictions all over [0, 1), of which the ladder sees those below 0.5: 90 % are kept up to 0.1.
    let of = |seed: u64| {
        let stream = catchment_core::acceptance::Stream::new(seed);
        let ways: Vec<PoseByFriction> = (0..400).map(|k| way(stream.uniform(k))).collect();
        kept(&ways, 0.5)
    };
    let hold = |share: usize, truth: f64| {
        (0..400).filter(|seed| (of(*seed)[share].ci95[0]..=of(*seed)[share].ci95[1]).contains(&truth)).count()
    };
    assert!(hold(2, 0.1) >= 376 && hold(1, 0.05) >= 376, "{} {}", hold(2, 0.1), hold(1, 0.05));
    let half = of(1)[3];
    assert!(half.friction > 0.44 && half.ci95[1] == 0.5, "{half:?}");
}

#[test]
fn invalid_settings_are_refused() {
    let problem = problem(Family::VFace, [Dof::X].into_iter().collect());
    let refused = |settings: FrictionSettings| run(&problem, &settings, &Exec::new()).unwrap_err();
    let base = FrictionSettings { motions: Some(10), ..FrictionSettings::default() };
    assert_eq!(refused(FrictionSettings { motions: Some(0), ..base.clone() }), FrictionError::NoMotions);
    assert_eq!(
        refused(FrictionSettings { frictions: vec![0.0], ..base.clone() }),
        FrictionError::NoFrictions
    );
    assert!(matches!(
        refused(FrictionSettings { frictions: vec![-0.1], ..base }),
        FrictionError::Friction(_)
    ));
}
