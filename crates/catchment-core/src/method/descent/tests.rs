//! Closed forms and invariants of single motions. Agreement with an independent engine: `tests/trials.rs`.

use super::fall::home;
use super::rest::TOUCHING;
use super::{DescentSettings, Follower, outcome, run, trace};
use crate::acceptance::{Domain, Outcome};
use crate::connector::{Connector, HalfSource};
use crate::contact::{Pair, meshes};
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use crate::diagnostic::Warning;
use crate::exec::{Cancelled, Exec};
use crate::pose::{CorPose, Dof, DofSet, Mount, PoseError, face_from_cor};
use glam::DVec3;
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::sync::atomic::Ordering;

pub(super) fn pair(family: Family, change: impl FnOnce(&mut Alignment)) -> Pair {
    let mut alignment = Alignment::default_for(Some(family));
    change(&mut alignment);
    let connector = ConnectorSpec::Family(FamilySpec::new(family));
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

pub(super) fn at(x: f64, y: f64) -> PoseError {
    PoseError { x, y, ..PoseError::default() }
}

fn lateral(alignment: &mut Alignment) {
    alignment.free = [Dof::X, Dof::Y].into_iter().collect();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Rotations locked, the saddle's acceptance is the diamond |x| + |y| < 1 (spec 2; ZRAA 2).
    #[test]
    fn the_saddle_accepts_its_diamond(x in -1.2..1.2f64, y in -1.2..1.2f64) {
        // Closer to the border than the alignment tolerance either answer is right.
        prop_assume!((x.abs() + y.abs() - 1.0).abs() > 1e-3 && x.abs() > 1e-3 && y.abs() > 1e-3);
        let pair = pair(Family::XFace3d, lateral);
        let end = outcome(&pair, &at(x, y), &DescentSettings::default()).outcome;
        prop_assert_eq!(end == Outcome::Aligned, x.abs() + y.abs() < 1.0, "{:?}", end);
    }

    /// With rotations locked, the pyramid accepts offsets with its apex over the socket: |x|, |y| < ½.
    #[test]
    fn the_pyramid_accepts_its_socket(x in -0.9..0.9f64, y in -0.9..0.9f64) {
        let reach = x.abs().max(y.abs());
        prop_assume!((reach - 0.5).abs() > 1e-3);
        let pair = pair(Family::Pyramid, lateral);
        let end = outcome(&pair, &at(x, y), &DescentSettings::default()).outcome;
        prop_assert_eq!(end == Outcome::Aligned, reach < 0.5, "{:?}", end);
    }

    /// The height never rises along a motion, and every waypoint touches.
    #[test]
    fn motions_fall_in_contact(
        family in proptest::sample::select(vec![Family::Pyramid, Family::XFace3d, Family::VFace, Family::XFace]),
        error in proptest::array::uniform5(-0.7..0.7f64), cor in -0.7..0.7f64,
    ) {
        let pair = pair(family, |a| a.center_of_rotation = cor);
        let free = pair.alignment.free;
        let mut start = error;
        for dof in Dof::ALL.into_iter().filter(|d| !free.contains(*d)) {
            start[dof.index()] = 0.0;
        }
        let path = trace(&pair, &PoseError::from_array(start), &DescentSettings::default());
        for pairs in path.waypoints.windows(2) {
            // At a corner without a known contact, the smallest step, 0.02/4096 D = 5e-6 D, may climb a slope
            // of at most 20 (steeper slopes are walls): 1e-4.
            prop_assert!(pairs[1].height <= pairs[0].height + 1e-4, "{pairs:?}");
            prop_assert!(pairs[1].travelled >= pairs[0].travelled);
        }
        for waypoint in &path.waypoints {
            let pose = CorPose::from_error(&waypoint.error, cor, free);
            // At the height of first contact, or lower if the half has slid beside the other half or under an
            // overhang; it is free of overlap there, too.
            let first = pair.height(&pose).is_some_and(|z| (z - waypoint.height).abs() < 1e-6);
            let mut nearby = pair.nearby(0.0, 0.0);
            nearby.turn(&pose.rotation, pose.lateral, 0.0, 0.0);
            prop_assert!(first || !nearby.overlaps(pose.lateral.extend(waypoint.height)), "{waypoint:?}");
        }
    }

    /// Mirrored poses of a mirrored pair end alike.
    #[test]
    fn a_mirrored_pose_ends_mirrored(x in -0.8..0.8f64, pitch in -1.4..1.4f64) {
        let pair = pair(Family::VFace, |a| a.center_of_rotation = 0.5);
        let settings = DescentSettings::default();
        let a = outcome(&pair, &PoseError { x, pitch, ..PoseError::default() }, &settings);
        let b = outcome(&pair, &PoseError { x: -x, pitch: -pitch, ..PoseError::default() }, &settings);
        prop_assert_eq!(a.outcome, b.outcome);
        prop_assert!((a.error.x + b.error.x).abs() < 1e-6 && (a.error.pitch + b.error.pitch).abs() < 1e-6);
    }
}

/// From a single contact the motion starts along −M⁻¹∇h: in (x, y, ρ·ω) opposite to (∂h/∂x, ∂h/∂y, ∂h/∂ω / ρ).
#[test]
fn the_first_step_is_the_steepest_in_the_metric() {
    let error = PoseError { x: 0.21, y: 0.05, roll: 0.3, pitch: -0.2, yaw: 0.1 };
    for rho in [0.3, 1.0] {
        let pair = pair(Family::Pyramid, |a| {
            a.center_of_rotation = 0.4;
            a.rotation_length = rho;
        });
        let settings = DescentSettings { step: 1e-4, ..DescentSettings::default() };
        let path = trace(&pair, &error, &settings);
        let [first, second] = [&path.waypoints[0], &path.waypoints[1]];
        assert_eq!(first.touches.len(), 1, "one contact to start from");
        let pose = CorPose::from_error(&error, 0.4, DofSet::ALL);
        let cor = pose.lateral.extend(first.height);
        let touch = first.touches[0];
        let contact = crate::contact::Contact { gap: 0.0, normal: touch.normal, point: touch.point };
        let (slope, turn) = contact.gradient(cor);
        let next = CorPose::from_error(&second.error, 0.4, DofSet::ALL);
        let moved = next.lateral - pose.lateral;
        // The rotation vector of a small turn is half the antisymmetric part of R' Rᵀ.
        let r = next.rotation * pose.rotation.transpose();
        let omega =
            DVec3::new(r.y_axis.z - r.z_axis.y, r.z_axis.x - r.x_axis.z, r.x_axis.y - r.y_axis.x) * 0.5;
        let went = [moved.x, moved.y, omega.x * rho, omega.y * rho, omega.z * rho];
        let steepest = [-slope[0], -slope[1], -turn.x / rho, -turn.y / rho, -turn.z / rho];
        let dot = |a: &[f64; 5], b: &[f64; 5]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let cosine = dot(&went, &steepest) / (dot(&went, &went) * dot(&steepest, &steepest)).sqrt();
        // The direction turns by the curvature times the step, 1e-4 here: the cosine by its square.
        assert!(cosine > 1.0 - 1e-6, "ρ = {rho}: {cosine}");
    }
}

#[test]
fn a_passing_pose_is_missed_and_unchanged() {
    let pair = pair(Family::Pyramid, lateral);
    let end = outcome(&pair, &at(1.3, 0.0), &DescentSettings::default());
    assert_eq!(end.outcome, Outcome::Missed);
    assert_eq!(end.error, at(1.3, 0.0));
}

#[test]
fn a_quarter_turn_counts_where_declared() {
    let quarter = PoseError { yaw: FRAC_PI_2, ..PoseError::default() };
    let settings = DescentSettings::default();
    assert_eq!(outcome(&pair(Family::Pyramid, |_| ()), &quarter, &settings).outcome, Outcome::Jammed);
    let fourfold = pair(Family::Pyramid, |a| a.symmetry = 4);
    assert_eq!(outcome(&fourfold, &quarter, &settings).outcome, Outcome::Aligned);
}

#[test]
fn a_locked_translation_stays_at_the_centre_of_rotation() {
    let pair = pair(Family::Pyramid, |a| {
        a.free = [Dof::X, Dof::Pitch].into_iter().collect();
        a.center_of_rotation = 0.5;
    });
    let path =
        trace(&pair, &PoseError { x: 0.1, pitch: 0.3, ..PoseError::default() }, &DescentSettings::default());
    assert!(path.waypoints.len() > 5);
    for waypoint in &path.waypoints {
        let rotation = waypoint.error.rotation();
        assert!((waypoint.error.y - face_from_cor(&rotation, 0.5).y).abs() < 1e-12);
        assert_eq!((waypoint.error.roll, waypoint.error.yaw), (0.0, 0.0));
    }
}

#[test]
fn a_spent_budget_is_undecided_and_reported() {
    let pair = pair(Family::Pyramid, |_| ());
    let settings = DescentSettings { max_steps: 2, ..DescentSettings::default() };
    let domain = Domain::Poses(vec![at(0.3, 0.1), at(0.0, 0.0)]);
    let (acceptance, _) = run(&pair, domain, &settings, &Exec::new()).unwrap();
    assert_eq!(acceptance.outcomes, [Outcome::Undecided, Outcome::Aligned]);
    assert_eq!(acceptance.warnings, [Warning::Undecided { cells: 1 }]);
}

#[test]
fn a_cancelled_run_stops() {
    let pair = pair(Family::Pyramid, |_| ());
    let exec = Exec::new();
    exec.cancel_flag().store(true, Ordering::Relaxed);
    let domain = Domain::Poses(vec![at(0.3, 0.1)]);
    assert_eq!(run(&pair, domain, &DescentSettings::default(), &exec).err(), Some(Cancelled));
}

/// Pins in holes that fit tightly, followed by trees: lengths of a step that overlap, tried before an overlap was seen, count as clear no more. These poses of
/// 310 jammed.
#[test]
fn tight_pins_followed_by_trees_do_not_jam_falsely() {
    let pair = pair(Family::PinHole, |_| ());
    assert!(pair.is_tight() && pair.has_trees());
    let settings = DescentSettings::default();
    let mut follower = Follower::new(&pair, &settings);
    for error in [
        [
            0.043_921_388_408_133_1,
            -0.006_442_891_017_592_19,
            0.015_845_856_933_659_853,
            0.061_152_253_035_769_5,
            -0.028_595_614_480_528_386,
        ],
        [
            -0.034_607_856_466_613_64,
            -0.041_548_531_952_053_6,
            -0.016_023_844_137_092_26,
            -0.063_256_227_468_832_97,
            0.003_693_260_933_569_675_4,
        ],
        [
            -0.041_059_390_140_094_83,
            -0.020_066_364_928_582_537,
            -0.080_490_353_043_861_43,
            -0.065_891_865_330_820_43,
            0.000_284_569_176_817_584,
        ],
        [
            0.044_721_352_245_229_01,
            0.019_006_102_165_110_696,
            -0.006_191_231_685_179_654_5,
            -0.073_533_824_230_724_77,
            0.053_256_247_842_246_12,
        ],
        [
            0.021_438_273_993_677_66,
            0.027_177_964_986_436_52,
            -0.056_671_327_611_004_18,
            -0.091_007_413_912_504_94,
            -0.004_361_367_979_551_156,
        ],
    ] {
        assert_eq!(follower.follow(&PoseError::from_array(error)).outcome, Outcome::Aligned, "{error:?}");
    }
}

/// Lips and pins have vertical walls; a motion must be followed past them to its end.
#[test]
fn walls_are_followed_to_the_end() {
    for family in [Family::XFace3dLocking, Family::PinHole] {
        let pair = pair(family, |_| ());
        for k in 0..12 {
            let a = f64::from(k);
            let error = PoseError {
                x: 0.03 * a.sin(),
                y: 0.03 * (1.7 * a).cos(),
                roll: 0.06 * (2.1 * a).sin(),
                pitch: 0.06 * (0.9 * a).cos(),
                yaw: 0.05 * (1.3 * a).sin(),
            };
            let end = outcome(&pair, &error, &DescentSettings::default());
            assert_eq!(end.outcome, Outcome::Aligned, "{family:?} {error:?} ended at {:?}", end.error);
        }
    }
}

/// Flush on the flank of a flat V the corner of the other half enters its bottom, and the half rests there,
/// at `(0.4, −53.13°)`, from any starting point. Both halves end in the same planes: only the borders of
/// facets show that the corner passes through the other flank.
#[test]
fn a_corner_does_not_pass_through_the_bottom_of_a_v() {
    let mut alignment = Alignment::default_for(Some(Family::VFace));
    (alignment.center_of_rotation, alignment.rotation_length) = (-0.5, 0.5);
    let spec = FamilySpec::new(Family::VFace).with_aspect_ratio(0.25);
    let connector = ConnectorSpec::Family(spec);
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
    for (x, pitch) in
        [(0.43, -0.958_186), (0.43, -0.926_77), (0.4, -0.930_26), (0.45, -0.99), (0.4, -0.923_28)]
    {
        let trajectory =
            trace(&pair, &PoseError { x, pitch, ..PoseError::default() }, &DescentSettings::default());
        for waypoint in &trajectory.waypoints {
            let alignment = &pair.alignment;
            let pose = CorPose::from_error(&waypoint.error, alignment.center_of_rotation, alignment.free);
            let lowest = pair.height(&pose).unwrap();
            assert!(
                waypoint.height > lowest - 1e-6,
                "({x}, {pitch}) passes through at {waypoint:?}: {lowest}"
            );
        }
    }
}

/// Lathe bodies, which yaw does not change.
fn lathed(halves: [meshes::Triangles; 2]) -> Pair {
    let [fixed, moving] = halves.map(HalfSource::Triangles);
    let connector = Connector::from_sources(&fixed, &moving, 0.0, Mount::X).unwrap();
    let mut alignment = Alignment::new(DofSet::ALL.without(Dof::Yaw), Mount::X);
    alignment.center_of_rotation = 0.5;
    Pair::new(&connector, &alignment)
}

/// Halves of many facets that dock end in the mated pose itself, by an ordinary step, and the contacts there
/// are kept.
#[test]
fn a_funnel_ends_in_the_mated_pose() {
    let pair = lathed(meshes::funnel(1000));
    assert!(pair.has_trees() && !pair.is_tight());
    let settings = DescentSettings::default();
    let mut follower = Follower::new(&pair, &settings);
    let mut docked = 0;
    for k in 0..24 {
        let a = f64::from(k);
        let error = PoseError {
            x: 0.3 * a.sin(),
            y: 0.3 * (1.7 * a).cos(),
            roll: 0.5 * (2.1 * a).sin(),
            pitch: 0.5 * (0.9 * a).cos(),
            yaw: 0.0,
        };
        let rest = follower.come_to_rest(&error);
        assert_eq!(rest.outcome, follower.follow(&error).outcome);
        if rest.outcome == Outcome::Aligned {
            docked += 1;
            assert_eq!(rest.error, PoseError::default());
            assert!(rest.contacts.len() > 100, "{} touch", rest.contacts.len());
            let way = trace(&pair, &error, &settings).waypoints;
            let [.., before, last] = &way[..] else { panic!("{way:?}") };
            assert!(last.height == pair.mated_height() && before.height >= last.height);
            assert!(last.travelled - before.travelled <= 2.0 * settings.step + TOUCHING);
        }
    }
    assert!(docked > 6, "{docked}");
}

/// If a flat bottom leaves play, a half near the mated pose stays at its rest, and is not moved to it; if
/// halves taper, it is.
#[test]
fn only_a_tapering_seat_moves_a_rest_to_the_mated_pose() {
    let [socket, plug] = meshes::funnel(1000);
    assert!(home(&lathed([socket.clone(), plug.clone()])) > 1e-3);
    // Both cut off at a depth of 0.2 D, and the plug a little narrower.
    let bottom = |p: DVec3| if p.z > -0.6 { p.with_z(p.z.max(-0.2)) } else { p };
    let top = |p: DVec3| DVec3::new(0.95 * p.x, 0.95 * p.y, p.z.min(0.2));
    let pair = lathed([
        socket.into_iter().map(|corners| corners.map(bottom)).collect(),
        plug.into_iter().map(|corners| corners.map(top)).collect(),
    ]);
    assert!(pair.has_trees() && !pair.is_tight());
    assert_eq!(home(&pair), 0.0);
    let error = PoseError { x: 1.5e-3, ..PoseError::default() };
    let rest = Follower::new(&pair, &DescentSettings::default()).come_to_rest(&error);
    assert!(rest.error.x > 1e-3, "{rest:?}");
}

/// Trees change the features that are tested, not the results; also for slivers that meet in a tip, at which
/// most nearby features do not count.
#[test]
fn trees_change_no_motion() {
    let pair = lathed(meshes::cone(160));
    let judge = pair.without_trees();
    assert!(pair.has_trees() && !judge.has_trees());
    let settings = DescentSettings::default();
    let (mut by_trees, mut by_list) = (Follower::new(&pair, &settings), Follower::new(&judge, &settings));
    let (mut seen, mut differ) = ([0, 0], Vec::new());
    for k in 0..16 {
        let a = f64::from(k);
        let (x, y) = (0.4 * a.sin(), 0.4 * (1.7 * a).cos());
        let (roll, pitch) = (0.9 * (2.1 * a).sin(), 0.9 * (0.9 * a).cos());
        let error = PoseError { x, y, roll, pitch, yaw: 0.0 };
        let (result, expected) = (by_trees.come_to_rest(&error), by_list.come_to_rest(&error));
        // The step lengths differ, so the ends may differ by less than a step; if the half docks, by less
        // than the finest play that counts.
        let moved = result.error.to_array().into_iter().zip(expected.error.to_array());
        let apart = moved.fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        let near = if result.outcome == Outcome::Aligned { 1e-4 } else { settings.step };
        if result.outcome != expected.outcome || apart > near {
            differ.push((error, result.outcome, expected.outcome, apart));
        }
        seen[usize::from(result.outcome == Outcome::Aligned)] += 1;
    }
    assert!(differ.is_empty(), "{differ:#?}");
    assert!(seen.iter().all(|count| *count > 2), "{seen:?}");
}
