//! Closed forms of friction. Agreement with independent engines: `tests/trials.rs`, and `tests/mujoco_agrees.py` of the repository.

use super::motion::Motion;
use super::sticking::Touching;
use super::tests::{at, pair};
use super::{DescentSettings, Follower, outcome, run, sticking};
use crate::acceptance::{Domain, Outcome, Stream};
use crate::contact::Pair;
use crate::design::Family;
use crate::exec::Exec;
use crate::pose::{Dof, DofSet, PoseError};
use crate::problem::{Draft, Problem};
use std::f64::consts::{FRAC_PI_4, SQRT_2};

fn of(family: Family, aspect_ratio: f64, free: &[Dof]) -> Pair {
    let free: Vec<String> = free.iter().map(|dof| format!("\"{}\"", dof.name())).collect();
    let text = format!(
        "[connector]\nfamily = \"{}\"\naspect_ratio = {aspect_ratio}\n[alignment]\nfree = [{}]\ncenter_of_rotation = 0.0\nrotation_length = 0.5\n",
        family.name(),
        free.join(", ")
    );
    let source = crate::design::SourceText::new("f.toml", text.as_str());
    let problem: Problem = Draft::read(source).and_then(Draft::build).unwrap();
    problem.pair().clone()
}

/// With rotations locked, a half on a single facet slides while friction is less than the facet's slope, and
/// both thresholds equal that slope.
#[test]
fn on_a_facet_both_thresholds_are_its_slope() {
    let lateral = [Dof::X, Dof::Y];
    let cases = [
        (Family::VFace, 0.7, &lateral[..1], at(0.2, 0.0), 1.4),
        (Family::XFace, 0.7, &lateral[..1], at(0.2, 0.0), 0.7),
        (Family::Pyramid, 0.5, &lateral[..], at(0.2, 0.1), 1.0),
        (Family::Pyramid, 1.0, &lateral[..], at(0.2, -0.1), 2.0),
        // The outer edges, and the range in which the middle edge carries.
        (Family::SFace, 0.4, &lateral[..1], at(0.1, 0.0), 0.6),
        (Family::SFace, 0.4, &lateral[..1], at(-0.1, 0.0), 1.2),
        // Two facets carry if |y| < |x|, as h = AR·max(|x|, |y|); the force has no transverse component.
        (Family::XFace3d, 0.3, &lateral[..], at(0.2, 0.1), 0.3),
    ];
    for (family, aspect_ratio, free, error, slope) in cases {
        let result = sticking(&of(family, aspect_ratio, free), &error).unwrap();
        // Accurate to 1e-9 if a slip of 1e-7 of the push counts as zero.
        assert!((result.holds_from.unwrap() - slope).abs() < 1e-6, "{family:?} {result:?}");
        assert!((result.slips_until.unwrap() - slope).abs() < 1e-6, "{family:?} {result:?}");
    }
}

/// The apex of a pyramid of AR ½ in the valley between two facets of its socket, which both carry.
#[test]
fn in_a_valley_slip_ends_later_than_sticking_begins() {
    let result = sticking(&of(Family::Pyramid, 0.5, &[Dof::X, Dof::Y]), &at(0.2, 0.2)).unwrap();
    assert!((result.holds_from.unwrap() - 3f64.sqrt().recip()).abs() < 2e-6, "{result:?}");
    assert!((result.slips_until.unwrap() - valley_slips_until(0.5)).abs() < 1e-4, "{result:?}");
}

/// Up to which friction a pyramid slips that is turned by ψ in its socket: four ridges lie on the rim, each at φ = 45° − ψ from the middle of its side. The point of a ridge that
/// touches, P = (½, ½ tan φ) from the axis, slips by `v = (−P_y, P_x, ż)` per radian with n·v = 0; without a moment about the axis `(P × (n − μ v/|v|))_z = 0`.
fn turned_slips_until(aspect_ratio: f64, yaw: f64) -> f64 {
    let (sin, cos) = (FRAC_PI_4 - yaw).sin_cos();
    let steep = 1.0 + 2.0 * (aspect_ratio * sin / cos).powi(2);
    aspect_ratio * sin * (steep / (aspect_ratio.powi(2) + 0.5 * cos * cos)).sqrt()
}

/// The apex in the valley between two facets of its socket slips down the edge between them up to this friction.
fn valley_slips_until(aspect_ratio: f64) -> f64 {
    let square = aspect_ratio * aspect_ratio;
    SQRT_2 * aspect_ratio * ((1.0 + 2.0 * square) / (1.0 + 4.0 * square)).sqrt()
}

/// A pyramid turned by ψ in its socket, yaw alone free: four ridges lie on the rim. A force holds from tan(45° − ψ)·√2 AR/√(1 + 2 AR²) on.
#[test]
fn a_turned_pyramid_has_both_thresholds() {
    let pair = of(Family::Pyramid, 1.0, &[Dof::Yaw]);
    for degrees in [20.0f64, 25.0, 30.0, 35.0] {
        let yaw = degrees.to_radians();
        let result = sticking(&pair, &PoseError { yaw, ..PoseError::default() }).unwrap();
        let holds_from = (FRAC_PI_4 - yaw).tan() * (2.0 / 3.0f64).sqrt();
        // Twelve forces for two directions: the planes of the cones nearly depend on each other, which costs some digits.
        assert!((result.holds_from.unwrap() - holds_from).abs() < 5e-5, "{degrees}: {result:?} {holds_from}");
        let slips_until = turned_slips_until(1.0, yaw);
        assert!(
            (result.slips_until.unwrap() / slips_until - 1.0).abs() < 1e-3,
            "{degrees}: {result:?} {slips_until}"
        );
    }
}

/// Motions stick exactly from the threshold on: docked below it, jammed above it, at each of 41 coefficients
/// within 2 % of it.
#[test]
fn motions_stick_from_the_exact_thresholds_on() {
    let yaw = |degrees: f64| PoseError { yaw: degrees.to_radians(), ..PoseError::default() };
    let turned = |degrees: f64| turned_slips_until(1.0, degrees.to_radians());
    let (lateral, flat) = ([Dof::X, Dof::Y], [Dof::X, Dof::Y, Dof::Yaw]);
    let cases = [
        (Family::VFace, 0.7, &lateral[..1], at(0.2, 0.0), 1.4),
        (Family::Pyramid, 0.5, &lateral[..], at(0.2, 0.0), 1.0),
        (Family::Pyramid, 0.5, &lateral[..], at(0.2, 0.2), valley_slips_until(0.5)),
        (Family::Pyramid, 1.0, &lateral[..], at(0.2, 0.2), valley_slips_until(1.0)),
        (Family::XFace3d, 0.3, &lateral[..], at(0.2, 0.0), 0.3),
        (Family::Pyramid, 1.0, &[Dof::Yaw][..], yaw(20.0), turned(20.0)),
        (Family::Pyramid, 1.0, &[Dof::Yaw][..], yaw(30.0), turned(30.0)),
        (Family::Pyramid, 1.0, &flat[..], yaw(25.0), turned(25.0)),
        (Family::Pyramid, 1.0, &flat[..], yaw(30.0), turned(30.0)),
        (Family::Pyramid, 1.0, &flat[..], yaw(35.0), turned(35.0)),
        (Family::Pyramid, 0.5, &flat[..], yaw(30.0), turned_slips_until(0.5, 30f64.to_radians())),
    ];
    for (family, aspect_ratio, free, error, threshold) in cases {
        let pair = of(family, aspect_ratio, free);
        for k in -20i32..=20 {
            // Shares of ±0.05 % to ±2 % of the threshold.
            let share = (f64::from(k) - 0.5) * 1e-3;
            let settings = DescentSettings::with_friction(threshold * (1.0 + share)).unwrap();
            let expected = if share < 0.0 { Outcome::Aligned } else { Outcome::Jammed };
            let result = outcome(&pair, &error, &settings).outcome;
            assert_eq!(result, expected, "{family:?} {aspect_ratio} {free:?} {error:?}: {threshold} {share}");
        }
    }
}

/// Of offsets alone the threshold of the slope is friction on a facet; the diagonal of two facets is steeper than neither.
#[test]
fn a_slope_threshold_ends_motion_on_gentler_slopes() {
    let at_slope = |pair: &Pair, error: &PoseError, slope: f64| {
        outcome(pair, error, &DescentSettings::with_slope_threshold(slope).unwrap()).outcome
    };
    let lateral = [Dof::X, Dof::Y];
    for (family, aspect_ratio, error, slope) in [
        (Family::VFace, 0.7, at(0.2, 0.0), 1.4),
        (Family::Pyramid, 0.5, at(0.2, 0.0), 1.0),
        // Down the valley between two facets, by 1 in √2.
        (Family::Pyramid, 0.5, at(0.2, 0.2), 1.0 / SQRT_2),
        (Family::XFace3d, 0.3, at(0.2, 0.0), 0.3),
    ] {
        let pair = of(family, aspect_ratio, &lateral[..if family == Family::VFace { 1 } else { 2 }]);
        assert_eq!(at_slope(&pair, &error, slope - 1e-6), Outcome::Aligned, "{family:?}");
        assert_eq!(at_slope(&pair, &error, slope + 1e-6), Outcome::Jammed, "{family:?}");
    }
    let refusal = DescentSettings::with_slope_threshold(f64::NAN).unwrap_err().to_string();
    assert!(refusal.contains("NaN is no slope"), "{refusal}");
}

/// A tilted peg of width d in a hole: its tip on one wall, the rim on its side, `depth` apart along the hole.
/// Whitney's diagram (*Quasi-static assembly of compliantly supported rigid parts*, 1982): pushed `off` its
/// axis it jams from a friction of depth/(2·off) on, and from depth/d on it wedges, for any push.
#[test]
fn a_peg_jams_and_wedges_at_whitneys_thresholds() {
    const WIDTH: f64 = 1.0;
    const CLEARANCE: f64 = 5e-4;
    for off in [0.0, 0.3, 0.75, 1.5] {
        for depth in [0.3, 0.6, 1.0] {
            let (pair, error) = peg(WIDTH, CLEARANCE, -off, depth);
            let result = sticking(&pair, &error).unwrap();
            let expected = depth / f64::max(2.0 * off, WIDTH);
            let holds_from = result.holds_from.unwrap();
            // The peg leans by clearance/depth at most, and the cone of its side with it.
            assert!((holds_from / expected - 1.0).abs() < 0.01, "{off} {depth}: {result:?}, {expected}");
            // Wherever the push goes.
            let wedges_from = result.wedges_from.unwrap();
            assert!((wedges_from * WIDTH / depth - 1.0).abs() < 0.01, "{off} {depth}: {result:?}");
        }
    }
}

/// The whole of Whitney's diagram: pushed in by 1, aside by `aside` and rotated by `turn` about its tip, in
/// radii, a peg of radius r with two contact points jams if turn < −λ − μ (1 + λ) aside, λ = l/(2 r μ), and
/// moves if not; a wedged peg does not move.
#[test]
fn a_peg_jams_by_the_lines_of_whitneys_diagram() {
    let stream = Stream::new(1982);
    let mut requested = 0;
    for (k, (depth, friction)) in (0u64..).zip([
        (0.3, 0.1),
        (0.3, 0.2),
        (0.6, 0.1),
        (0.6, 0.3),
        (1.0, 0.2),
        (1.0, 0.6),
        (0.3, 0.4),
        (0.6, 0.7),
    ]) {
        let (pair, error) = peg(1.0, 5e-4, 0.0, depth);
        let settings = DescentSettings::with_friction(friction).unwrap();
        let mut motion = Motion::new(&pair, &settings);
        let state = motion.lower(&error).unwrap();
        let mut touching = Touching::default();
        touching.see(&motion, &state);
        let lambda = depth / friction;
        for n in 0..100 {
            let number = |j: u64| 2.0 * stream.uniform(1000 * k + 2 * n + j) - 1.0;
            let aside = 0.9 / friction * number(0);
            let (line, off) = (-lambda - friction * (1.0 + lambda) * aside, 2.0 * lambda * number(1));
            if off.abs() < 0.03 * lambda {
                continue;
            }
            // About the centre of rotation, which is as far above the tip as the peg is long; turns about y go from z to x.
            let (sin, cos) = error.pitch.sin_cos();
            let torque = -PEG * cos * aside - PEG * sin - 0.5 * (line + off);
            let push = [aside, 0.0, -1.0, 0.0, torque / pair.alignment.rotation_length, 0.0];
            let wedges = friction > depth;
            assert_eq!(
                touching.holds(&push, friction),
                wedges || off < 0.0,
                "{depth} {friction}: {aside} {line} {off}"
            );
            requested += 1;
        }
    }
    assert!(requested > 700);
}

/// From the collar of a peg, which rests on the rim, to its tip.
const PEG: f64 = 2.0;

/// A planar peg and its hole, drawn so that the push goes `off` the axis of both, and the pose error at which it stands in two points.
fn peg(width: f64, clearance: f64, off: f64, depth: f64) -> (Pair, PoseError) {
    const LONG: f64 = PEG;
    /// Remaining distance to the wall: less than the contact tolerance.
    const LEFT: f64 = 1e-10;
    let (half, hole) = (0.5 * width, 0.5 * (width + clearance));
    let block = |[x0, x1]: [f64; 2], [z0, z1]: [f64; 2]| {
        format!("{{ box = [{}, 1.0, {}], at = [{}, 0.0, {z0}] }}", x1 - x0, z1 - z0, f64::midpoint(x0, x1))
    };
    let walls = [[off - 3.0, off - hole], [off + hole, off + 3.0]].map(|x| block(x, [-LONG - 0.5, 0.0]));
    let peg = [block([off - half, off + half], [-LONG, 0.25]), block([off - 1.0, off + 1.0], [0.0, 0.5])];
    let text = format!(
        "[connector]\ndrawn = \"assembled\"\nface_center = [0, 0, 0]\nfixed.parts = [{}]\nmoving.parts = [{}]\n\
         [alignment]\nfree = [\"x\", \"pitch\"]\ncenter_of_rotation = 0.0\nrotation_length = 0.5\n",
        walls.join(", "),
        peg.join(", ")
    );
    let source = crate::design::SourceText::new("peg.toml", text.as_str());
    let problem: Problem = Draft::read(source).and_then(Draft::build).unwrap();
    // It leans to the right by this: the rim lies on its right side.
    let across = |lean: f64| (2.0 * hole - LEFT) * lean.cos() - depth * lean.sin() - width;
    let [mut less, mut more] = [0.0, 0.5];
    while more - less > 1e-15 {
        let middle = f64::midpoint(less, more);
        if across(middle) > 0.0 { less = middle } else { more = middle }
    }
    let lean = less;
    let tip = (off - half) * lean.cos() - LONG * lean.sin();
    let error = PoseError { x: off - hole + LEFT - tip, pitch: lean, ..PoseError::default() };
    (problem.pair().clone(), error)
}

/// Between the thresholds of a valley a half slips and might stick; below both it slips, above both it
/// sticks: no open case.
#[test]
fn between_the_thresholds_a_motion_is_in_doubt() {
    let pair = of(Family::Pyramid, 0.5, &[Dof::X, Dof::Y]);
    for (friction, outcome, may_stick) in
        [(0.57, Outcome::Aligned, false), (0.59, Outcome::Aligned, true), (0.62, Outcome::Jammed, false)]
    {
        let settings = DescentSettings::with_friction(friction).unwrap();
        let (end, doubt) = Follower::new(&pair, &settings).follow_doubting(&at(0.2, 0.2));
        assert_eq!((end.outcome, doubt.may_stick, doubt.wedges), (outcome, may_stick, false), "{friction}");
    }
}

/// Two facets that face each other, by 45° each, hold a half against any push if the cones about their
/// normals contain the line between them: from 1 on. A single facet never does.
#[test]
fn facing_facets_wedge_from_their_angle_on() {
    let valley = of(Family::VFace, 0.5, &[Dof::X]);
    let result = sticking(&valley, &PoseError::default()).unwrap();
    assert!((result.wedges_from.unwrap() - 1.0).abs() < 1e-3, "{result:?}");
    assert_eq!(sticking(&valley, &at(0.2, 0.0)).unwrap().wedges_from, None);
}

#[test]
fn a_number_that_is_no_friction_is_refused() {
    for friction in [-0.1, f64::NAN, f64::INFINITY, 11.0] {
        let refusal = DescentSettings::with_friction(friction).unwrap_err().to_string();
        assert!(refusal.contains("from 0 to 10"), "{refusal}");
    }
}

fn random(count: u64) -> Domain {
    let stream = Stream::new(15);
    let half = [0.5, 0.5, FRAC_PI_4, FRAC_PI_4, FRAC_PI_4];
    let pose = |k: u64| {
        let number = |j: usize| half[j] * (2.0 * stream.uniform(5 * k + j as u64) - 1.0);
        PoseError::from_array(std::array::from_fn(number))
    };
    Domain::Poses((0..count).map(pose).collect())
}

/// Half the step changes at most one outcome in a hundred, and the number of threads changes none.
#[test]
fn neither_steps_nor_threads_change_outcomes() {
    let [face, pyramid] = [Family::XFace3d, Family::Pyramid]
        .map(|family| pair(family, |alignment| alignment.free = DofSet::ALL));
    // Flat enough to wedge.
    let flat = of(Family::Pyramid, 0.5, &Dof::ALL);
    for (name, pair, friction) in
        [("X-Face", face, 0.2), ("pyramid", pyramid, 0.1), ("flat", flat.clone(), 0.2), ("flat", flat, 0.3)]
    {
        let settings = DescentSettings::with_friction(friction).unwrap();
        let outcomes = |settings: &DescentSettings, threads: usize| {
            let exec = Exec::new().with_threads(threads).unwrap();
            run(&pair, random(300), settings, &exec).unwrap().0.outcomes
        };
        let result = outcomes(&settings, 1);
        assert_eq!(result, outcomes(&settings, 2));
        let halved = outcomes(&DescentSettings { step: 0.5 * settings.step, ..settings }, 2);
        let differ = result.iter().zip(&halved).filter(|(a, b)| a != b).count();
        assert!(100 * differ <= result.len(), "{name}: {differ} of {}", result.len());
    }
}
