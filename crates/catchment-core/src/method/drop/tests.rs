//! Closed forms, and changes of input that must not change an outcome.

use super::*;
use crate::connector::Connector;
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use crate::landscape::Grid;
use crate::pose::{Dof, DofSet};

/// A family with its defaults and the COR of the example designs, free in `free`.
pub(super) fn pair(family: Family, free: DofSet) -> Pair {
    let alignment = Alignment { free, center_of_rotation: 0.5, ..Alignment::default_for(Some(family)) };
    let spec = FamilySpec::new(family).with_aspect_ratio(0.5).with_chord_error(0.02);
    let design = Design {
        name: String::new(),
        connector: ConnectorSpec::Family(spec),
        width: 1.0,
        unit: None,
        alignment,
    };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

fn x(x: f64) -> PoseError {
    PoseError { x, ..PoseError::default() }
}

fn outcomes(pair: &Pair, poses: Vec<PoseError>, settings: &DropSettings) -> Vec<Outcome> {
    run(pair, Domain::Poses(poses), settings, &Exec::new()).unwrap().0.outcomes
}

/// Distance of an offset inside the border of the closed form.
type Margin = fn(f64, f64) -> f64;

#[test]
fn without_rotation_a_pyramid_seats_from_half_its_width_and_an_x_face_from_a_diamond() {
    const CELLS: usize = 13;
    let sliding = DofSet::EMPTY.with(Dof::X).with(Dof::Y);
    let settings = DropSettings { trials: 1, ..DropSettings::default() };
    // |x|, |y| < 1/2, and |x| + |y| < 1, of which the area is 2.
    let closed: [(Family, Margin); 2] = [
        (Family::Pyramid, |x, y| 0.5 - x.abs().max(y.abs())),
        (Family::XFace3d, |x, y| 1.0 - x.abs() - y.abs()),
    ];
    for (family, inside) in closed {
        let pair = pair(family, sliding);
        let grid = Grid::over(&pair.alignment, |_| CELLS);
        let (acceptance, _) = run(&pair, Domain::Grid(grid.clone()), &settings, &Exec::new()).unwrap();
        let mut area = 0.0;
        for (cell, accepted) in acceptance.accepted().enumerate() {
            let pose = grid.pose(cell);
            let margin = inside(pose.x, pose.y);
            area += if accepted { grid.cell_measure() } else { 0.0 };
            // Cells that the perturbation does not carry over the border.
            assert!(margin.abs() < 0.01 || accepted == (margin > 0.0), "{family:?} {pose:?}");
        }
        if family == Family::XFace3d {
            // The border is 4√2 D long, and a cell of 2/13 D across it is right to half its width.
            assert!((area - 2.0).abs() < 4.0 * 2f64.sqrt() / CELLS as f64, "{area}");
        }
    }
}

#[test]
fn friction_holds_a_half_on_a_slope_no_steeper_than_its_cone() {
    // Faces of aspect ratio 1/2 are as steep as 1 : 1, so they hold from μ = 1 on; with and without a locked error.
    for (family, free) in [
        (Family::VFace, DofSet::EMPTY.with(Dof::X)),
        (Family::Pyramid, DofSet::EMPTY.with(Dof::X).with(Dof::Y)),
    ] {
        let pair = pair(family, free);
        let poses = || [-0.3, -0.1, 0.2].map(x).to_vec();
        for (friction, expected) in [(0.0, Outcome::Aligned), (0.9, Outcome::Aligned), (1.1, Outcome::Jammed)]
        {
            let settings = DropSettings { friction, ..DropSettings::default() };
            assert_eq!(outcomes(&pair, poses(), &settings), [expected; 3], "{family:?} {friction}");
        }
    }
}

#[test]
fn threads_change_no_bit() {
    let pair = pair(Family::Pyramid, DofSet::ALL);
    let [one, two] = [1, 2].map(|threads| {
        let exec = Exec::new().with_threads(threads).unwrap();
        run(&pair, Domain::random(&pair.alignment, 24, 3), &DropSettings::default(), &exec).unwrap()
    });
    assert_eq!(one, two);
    let other = DropSettings { seed: 2, ..DropSettings::default() };
    let (_, ends) = run(&pair, one.0.domain.clone(), &other, &Exec::new()).unwrap();
    assert_ne!(ends, one.1, "another seed perturbs differently");
}

#[test]
fn locked_errors_stay_zero() {
    // Roll and pitch without yaw: turning to and fro must not add up to a yaw. A locked y stays 0 at the COR.
    let free = DofSet::EMPTY.with(Dof::X).with(Dof::Roll).with(Dof::Pitch);
    let pair = pair(Family::Cone, free);
    let poses: Vec<PoseError> =
        [0.1, 0.2, 0.3].map(|a| PoseError { roll: a, pitch: -a, ..x(a / 2.0) }).to_vec();
    let (_, ends) = run(&pair, Domain::Poses(poses), &DropSettings::default(), &Exec::new()).unwrap();
    for end in ends {
        assert_eq!(end.error.yaw, 0.0);
        let cor = crate::pose::CorPose::from_error(&end.error, 0.5, DofSet::ALL).lateral;
        assert!(cor.y.abs() < 1e-12, "{end:?}");
        assert_eq!(end.outcome, Outcome::Aligned, "{end:?}");
    }
}

#[test]
fn a_solid_falls_by_gravity_like_a_given_mass() {
    let pair = pair(Family::Pyramid, DofSet::ALL);
    let settings = DropSettings {
        body: MassProperties::Solid { density: 2.0 },
        push: Push::Gravity(5000.0),
        ..DropSettings::default()
    };
    let poses = vec![x(0.1), PoseError { yaw: 0.2, ..x(0.0) }, x(0.9)];
    assert_eq!(outcomes(&pair, poses, &settings), [Outcome::Aligned, Outcome::Aligned, Outcome::Missed]);
    // Its centre of mass is not at the COR, so locking y there is not equivalent in the engine.
    let locked = super::tests::pair(Family::Pyramid, DofSet::ALL.without(Dof::Y));
    let refused = run(&locked, Domain::Poses(vec![x(0.1)]), &settings, &Exec::new()).unwrap_err();
    assert!(matches!(refused, DropError::OffCenter { .. }), "{refused}");
}

#[test]
fn a_bouncing_half_is_undecided_when_the_time_is_up() {
    let pair = pair(Family::VFace, DofSet::EMPTY.with(Dof::X));
    let bouncing = DropSettings {
        push: Push::Gravity(10.0),
        damping: 0.0,
        angular_damping: 0.0,
        restitution: 1.0,
        drop_height: 0.5,
        timeout: 1.0,
        ..DropSettings::default()
    };
    let (acceptance, _) = run(&pair, Domain::Poses(vec![x(0.2)]), &bouncing, &Exec::new()).unwrap();
    assert_eq!(acceptance.outcomes, [Outcome::Undecided]);
    assert_eq!(acceptance.warnings, [Warning::Undecided { cells: 1 }]);
    let damped = DropSettings { restitution: 0.0, damping: 20.0, timeout: 20.0, ..bouncing };
    assert_eq!(outcomes(&pair, vec![x(0.2)], &damped), [Outcome::Aligned]);
}

#[test]
fn the_majority_decides() {
    let of = |outcomes: &[Outcome]| {
        let ends: Vec<End> = outcomes
            .iter()
            .enumerate()
            .map(|(k, o)| End { outcome: *o, error: x(k as f64), height: None })
            .collect();
        let end = verdict(&ends);
        (end.outcome, end.error.x)
    };
    assert_eq!(of(&[Outcome::Aligned, Outcome::Jammed, Outcome::Aligned]), (Outcome::Aligned, 0.0));
    assert_eq!(of(&[Outcome::Aligned, Outcome::Jammed, Outcome::Jammed]), (Outcome::Jammed, 1.0));
    assert_eq!(of(&[Outcome::Aligned, Outcome::Missed, Outcome::Jammed]), (Outcome::Missed, 1.0));
    assert_eq!(of(&[Outcome::Undecided, Outcome::Undecided, Outcome::Aligned]), (Outcome::Undecided, 0.0));
}

#[test]
fn invalid_and_unaffordable_runs_are_refused() {
    let pair = pair(Family::Pyramid, DofSet::ALL);
    let refused = |settings: &DropSettings, exec: &Exec| {
        run(&pair, Domain::Poses(vec![x(0.1)]), settings, exec).unwrap_err()
    };
    for settings in [
        DropSettings { trials: 2, ..DropSettings::default() },
        DropSettings { friction: f64::NAN, ..DropSettings::default() },
        DropSettings { restitution: 1.5, ..DropSettings::default() },
        DropSettings { timestep: 1e-9, ..DropSettings::default() },
        DropSettings { push: Push::Force(0.0), ..DropSettings::default() },
        DropSettings { inertia_factor: 0.0, ..DropSettings::default() },
        DropSettings { launch: Launch { speed: -1.0, ..Launch::default() }, ..DropSettings::default() },
        DropSettings {
            launch: Launch { drift: [0.0, f64::NAN], ..Launch::default() },
            ..DropSettings::default()
        },
        DropSettings { body: MassProperties::Solid { density: -1.0 }, ..DropSettings::default() },
    ] {
        assert!(matches!(refused(&settings, &Exec::new()), DropError::Setting(_)));
    }
    let small = Exec::new().with_memory_budget(10);
    assert!(matches!(refused(&DropSettings::default(), &small), DropError::OutOfBudget(_)));
    let stopped = Exec::new();
    stopped.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert_eq!(refused(&DropSettings::default(), &stopped), DropError::Cancelled(Cancelled));
}

#[test]
fn settings_survive_json_and_refuse_unknown_keys() {
    let settings = DropSettings {
        push: Push::Gravity(9.81),
        body: MassProperties::Solid { density: 3.0 },
        ..DropSettings::default()
    };
    let text = serde_json::to_string(&settings).unwrap();
    assert_eq!(serde_json::from_str::<DropSettings>(&text).unwrap(), settings);
    assert!(serde_json::from_str::<DropSettings>("{\"fricton\": 0.1}").is_err());
}

/// A tip beside its notch slides off outwards, until its base clears the peak at x = 1: past the notch into
/// free space, or onto the ground of the notch, on which its apex comes to rest.
#[test]
fn a_half_that_slides_off_rests_on_the_ground() {
    let pair = pair(Family::VFace, DofSet::EMPTY.with(Dof::X));
    let fall = |ground: Option<f64>, at: f64| {
        let settings = DropSettings { ground, trials: 1, ..DropSettings::default() };
        run(&pair, Domain::Poses(vec![x(at)]), &settings, &Exec::new()).unwrap().1[0]
    };
    assert_eq!(fall(None, 0.7).outcome, Outcome::Missed);
    for below in [0.0, 0.2] {
        let end = fall(Some(below), 0.7);
        assert_eq!(end.outcome, Outcome::Jammed, "{below}");
        assert!((end.error.x - 1.0).abs() < 0.01, "{below}: {}", end.error.x);
        // Inside, the ground is of no concern.
        assert_eq!(fall(Some(below), 0.3).outcome, Outcome::Aligned);
    }
}

/// The stated settings: overdamped enough that a step moves the half by some thousandths, and with the verdicts of exact motion well
/// inside and well outside.
#[test]
fn the_preset_of_the_dissertation_docks_and_fails_as_it_should() {
    let settings = DropSettings { trials: 1, ..DropSettings::gazebo_2014() };
    settings.check().unwrap();
    let Push::Gravity(gravity) = settings.push else { panic!("it falls by its weight") };
    // Velocity keeps a hundredth of itself per step.
    let kept = 1.0 / (1.0 + settings.damping * settings.timestep);
    assert!((kept - 0.01).abs() < 1e-12);
    let step = kept * gravity * settings.timestep * settings.timestep;
    assert!(step < 2e-3, "{step}");
    let pair = pair(Family::XFace3d, DofSet::ALL);
    let met = outcomes(&pair, vec![x(0.05), x(0.97)], &settings);
    assert_eq!(met[0], Outcome::Aligned);
    assert_ne!(met[1], Outcome::Aligned);
}

/// Nothing drives it and nothing slows it: it lands after h/v, having drifted and turned at its rates.
#[test]
fn a_half_in_flight_keeps_its_velocities() {
    let pair = pair(Family::Pyramid, DofSet::ALL);
    let settings = DropSettings {
        push: Push::Force(1e-9),
        damping: 0.0,
        angular_damping: 0.0,
        drop_height: 0.4,
        launch: Launch { speed: 0.8, drift: [0.2, -0.1], spin: [0.0, 0.0, 0.3] },
        ..DropSettings::default()
    };
    let start = PoseError { y: 0.05, ..x(-0.1) };
    let path = Bench::new(&pair).unwrap().trace(&start, &settings, &Exec::new()).unwrap();
    let landing = path.moments.iter().find(|moment| !moment.waypoint.touches.is_empty()).unwrap();
    let at = crate::pose::CorPose::from_error(&landing.waypoint.error, 0.5, DofSet::ALL);
    // The contact height matches the contact model, except for the fall within a step and the engine's
    // prediction distance.
    let above = landing.waypoint.height - pair.height(&at).unwrap();
    assert!(above.abs() < 3e-3, "{above}");
    let flown = path.moments.iter().rfind(|moment| moment.time < 0.4).unwrap();
    let (time, error) = (flown.time, flown.waypoint.error);
    // A push of 10⁻⁹ and rounding.
    let near = |value: f64, expected: f64| (value - expected).abs() < 1e-7;
    assert!(near(error.yaw, 0.3 * time), "{error:?} at {time}");
    // Offsets are of the face centre, which stands over the COR while only yaw turns.
    assert!(near(error.x, -0.1 + 0.2 * time) && near(error.y, 0.05 - 0.1 * time), "{error:?} at {time}");
    let times: Vec<f64> = path.moments.iter().map(|moment| moment.time).collect();
    assert!(times[0] == 0.0 && times.windows(2).all(|pair| pair[0] < pair[1]));
    // Of locked errors nothing counts.
    let locked = super::tests::pair(Family::Pyramid, DofSet::EMPTY.with(Dof::X));
    let path = Bench::new(&locked).unwrap().trace(&x(0.1), &settings, &Exec::new()).unwrap();
    assert!(
        path.moments.iter().all(|moment| moment.waypoint.error.y == 0.0 && moment.waypoint.error.yaw == 0.0)
    );
}

/// A force through the COR beside the centre of mass turns a half by F·a/(m·k²); a weight does not turn it.
#[test]
fn a_push_beside_the_centre_of_mass_turns_a_half() {
    let pair = pair(Family::Pyramid, DofSet::ALL);
    let pitch = |push: Push| {
        let center = Some([0.2, 0.0, -0.5]);
        let settings = DropSettings {
            push,
            body: MassProperties::Given { mass: 2.0, gyration: Some(0.4), center },
            damping: 0.0,
            angular_damping: 0.0,
            drop_height: 0.5,
            ..DropSettings::default()
        };
        let path = Bench::new(&pair).unwrap().trace(&x(0.0), &settings, &Exec::new()).unwrap();
        let flown = path.moments.iter().rfind(|moment| moment.time < 0.15).unwrap();
        (flown.time, flown.waypoint.error.pitch)
    };
    let (time, turned) = pitch(Push::Force(20.0));
    let expected = -0.5 * 20.0 * 0.2 / (2.0 * 0.16) * time * time;
    // Steps of 1 ms in the place of an integral: half a step of the way; and the arm shortens as it turns.
    assert!(time > 0.1 && (turned / expected - 1.0).abs() < 0.03, "{turned} for {expected} at {time}");
    let (_, turned) = pitch(Push::Gravity(10.0));
    assert!(turned.abs() < 1e-12, "{turned}");
}

/// Inertia 10⁵ times as large leaves translation alone, as in section 4.2.2: the pyramid seats from D/2, with all errors free.
#[test]
fn a_frozen_rotation_leaves_the_region_of_sliding() {
    let pair = pair(Family::Pyramid, DofSet::ALL);
    let settings = DropSettings { inertia_factor: 1e5, trials: 1, ..DropSettings::gazebo_2014() };
    let turned = |yaw: f64| PoseError { yaw, ..x(0.05) };
    let poses = || {
        vec![
            x(0.45),
            PoseError { y: -0.45, ..x(0.45) },
            x(0.55),
            PoseError { y: 0.55, ..x(0.2) },
            turned(0.3),
        ]
    };
    let frozen = outcomes(&pair, poses(), &settings);
    assert_eq!(frozen[..2], [Outcome::Aligned; 2]);
    assert!(!frozen[2..].contains(&Outcome::Aligned), "{frozen:?}");
    // Free to turn it turns home.
    let free = outcomes(&pair, vec![turned(0.3)], &DropSettings { inertia_factor: 1.0, ..settings });
    assert_eq!(free, [Outcome::Aligned]);
}

/// Figure 4.5: a half that rests on the other half and on the ground on which the other half stands.
#[test]
fn a_half_rests_on_the_other_and_on_the_ground() {
    let alignment = Alignment { center_of_rotation: 0.5, ..Alignment::default_for(Some(Family::XFace3d)) };
    let connector =
        ConnectorSpec::Family(FamilySpec::new(Family::XFace3d).with_aspect_ratio(30f64.to_radians().tan()));
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
    let settings = DropSettings { trials: 1, ..DropSettings::gazebo_2014() };
    let ground = pair.fixed.surfaces.iter().flat_map(|s| &s.vertices).fold(0.0f64, |low, v| low.min(v.z));
    let bench = Bench::new(&pair).unwrap();
    let rests = |x: f64, y: f64, pitch: f64, yaw: f64| {
        let start = PoseError { x, y, roll: 0.0, pitch: pitch.to_radians(), yaw: yaw.to_radians() };
        let path = bench.trace(&start, &settings, &Exec::new()).unwrap();
        let last = path.moments.last().unwrap();
        let on_ground = |touch: &&crate::method::descent::Touch| (touch.point.z - ground).abs() < 5e-3;
        let down = last.waypoint.touches.iter().filter(on_ground).count();
        path.outcome == Outcome::Jammed && down > 0 && down < last.waypoint.touches.len()
    };
    assert!(rests(0.44, 0.61, 26.0, 0.0) || rests(-0.47, 0.08, -21.0, 12.0));
}
