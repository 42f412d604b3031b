//! Rotations: recovered halves, kept bounds, and the error between rotations; the reference is the contact of
//! facets by definition.

use super::super::tests::{FAMILIES, family, inverted, own_heights, problem};
use super::super::{Inverse, lower_surface};
use super::*;
use catchment::contact::{Pair, brute};
use catchment::method::zraa::area;
use catchment::pose::{CorPose, PoseError, face_from_cor};
use catchment::problem::Problem;

/// Height of the face centre at first contact, by definition, with the face centre at x and y.
fn height(pair: &Pair, problem: &Problem, error: PoseError) -> Option<f64> {
    let alignment = problem.alignment();
    let pose = CorPose::from_error(&error, alignment.center_of_rotation, alignment.free);
    let up = face_from_cor(&error.rotation(), alignment.center_of_rotation).z;
    brute::height(pair, &pose).map(|height| height + up)
}

fn turned(at: DVec2, [roll, pitch, yaw]: [f64; 3]) -> PoseError {
    PoseError { x: at.x, y: at.y, roll, pitch, yaw }
}

/// Numbers in [0, 1) that look random, from a counter.
fn scattered(k: u32) -> f64 {
    (f64::from(k) * 0.754_877_666 + 0.1).fract()
}

fn five(most: f64) -> Vec<f64> {
    (-2..=2).map(|k| f64::from(k) * most / 2.0).collect()
}

/// Wanted at every rotation: the heights of a family. Got: its moving half, nowhere higher and nowhere lower.
#[test]
fn heights_at_rotations_give_back_the_moving_half() {
    for name in FAMILIES {
        let problem = family(name);
        let settings = if is_planar(problem.design()) {
            InvertSettings { pitch: five(0.3), ..InvertSettings::default() }
        } else {
            InvertSettings {
                roll: vec![0.2],
                pitch: vec![-0.15, 0.1],
                yaw: vec![0.3],
                ..InvertSettings::default()
            }
        };
        let result = inverted(&problem, own_heights(&problem), &settings);
        let own = lower_surface(&problem.connector().moving, &Exec::new()).unwrap();
        let (mut compared, mut worst) = (0.0, 0.0f64);
        for a in &own.facets {
            for b in &result.moving.facets {
                let Some(polygon) = common(&a.polygon, &b.polygon) else { continue };
                compared += area(&polygon);
                worst = polygon.iter().map(|p| (a.height(*p) - b.height(*p)).abs()).fold(worst, f64::max);
            }
        }
        assert!((compared - own.area()).abs() < 1e-8, "{name}: {compared} of {}", own.area());
        assert!(worst < 1e-9, "{name}: {worst:e}");
        assert_eq!(result.shortfalls, [], "{name}");
        // Its own half is as good between the rotations as at them.
        if let Some(between) = result.between {
            assert!(between.most_d.unwrap() < 1e-8, "{name}: {between:?}");
        }
    }
}

/// A pyramid's socket with the centre of rotation off the face, with heights wanted 0.2 D above its own, but
/// its own heights when tilted.
fn raised(settings: &InvertSettings) -> (Problem, Inverse) {
    let problem = problem(
        "[connector]\nfamily = \"pyramid\"\naspect_ratio = 0.5\n[alignment]\nrotation_length = 0.5\ncenter_of_rotation = 0.3\n",
    );
    let mut wanted = own_heights(&problem);
    for facet in &mut wanted.facets {
        facet.offset += 0.2;
    }
    let result = inverted(&problem, wanted, settings);
    (problem, result)
}

fn tilts() -> InvertSettings {
    InvertSettings { roll: vec![-0.1, 0.1], pitch: vec![-0.2, 0.0, 0.2], ..InvertSettings::default() }
}

#[test]
fn heights_at_rotations_hold_only_if_requested() {
    let (problem, kept) = raised(&tilts());
    let (_, free) = raised(&InvertSettings::default());
    assert_eq!((kept.turns, free.turns), (6, 0));
    let new = Pair::new(&kept.connector, problem.alignment());
    let careless = Pair::new(&free.connector, problem.alignment());
    let (mut above, mut closest, mut compared) = (f64::NEG_INFINITY, f64::INFINITY, 0);
    for [roll, pitch, yaw] in tilts().turns(problem.design()).unwrap() {
        for k in 0..60 {
            let at = DVec2::new(scattered(k), scattered(7 * k + 3)) * 1.6 - DVec2::splat(0.8);
            let error = turned(at, [roll, pitch, yaw]);
            let limit = height(problem.pair(), &problem, error);
            let (Some(limit), Some(got)) = (limit, height(&new, &problem, error)) else { continue };
            assert!(got <= limit + 1e-9, "{error:?}: {got} above {limit}");
            let high = height(&careless, &problem, error).unwrap();
            (above, closest, compared) = (above.max(high - limit), closest.min(limit - got), compared + 1);
        }
    }
    // Without the rotations the half stops higher. With them it reaches a wanted height at some point, so it
    // cannot be lower.
    assert!(compared > 200 && above > 0.05 && closest < 1e-3, "{compared} {above} {closest}");
}

/// The bound between the rotations, at random rotations of the range.
#[test]
fn between_the_rotations_the_excess_is_bounded() {
    let (problem, result) = raised(&tilts());
    let between = result.between.unwrap();
    assert!((between.turn_rad - 0.2).abs() < 1e-12 && between.midway == 2, "{between:?}");
    let new = Pair::new(&result.connector, problem.alignment());
    let (mut worst, mut compared) = (f64::NEG_INFINITY, 0);
    for k in 0..150 {
        let [roll, pitch] = [0.1 * (2.0 * scattered(11 * k) - 1.0), 0.2 * (2.0 * scattered(5 * k + 1) - 1.0)];
        let at = DVec2::new(scattered(k), scattered(7 * k + 3)) * 0.8 - DVec2::splat(0.4);
        let Some(got) = height(&new, &problem, turned(at, [roll, pitch, 0.0])) else { continue };
        let mut limit = f64::NEG_INFINITY;
        for (i, j) in (-3..=3).flat_map(|i| (-3..=3).map(move |j| (i, j))) {
            let near = at + DVec2::new(f64::from(i), f64::from(j)) * (between.bound_d / 4.3);
            limit = height(problem.pair(), &problem, turned(near, [roll, pitch, 0.0]))
                .map_or(limit, |h| limit.max(h));
        }
        (worst, compared) = (worst.max(got - limit), compared + 1);
    }
    assert!(compared > 100 && worst <= between.bound_d, "{compared} {worst} {between:?}");
    // The bound between the rotations agrees with the definition there.
    let at = DVec2::from_array(between.at_d);
    let pull = |p: DVec2| p * (1.0 - 1e-7);
    let there = turned(pull(at), between.angles_rad);
    let excess = height(&new, &problem, there).unwrap() - height(problem.pair(), &problem, there).unwrap();
    assert!((excess - between.most_d.unwrap()).abs() < 1e-5, "{excess} {between:?}");
}

#[test]
fn invalid_rotations_are_refused() {
    let planar = family("v-face");
    let settings = InvertSettings { roll: vec![0.1], ..InvertSettings::default() };
    assert_eq!(settings.turns(planar.design()), Err(InvertError::Planar));
    let spatial = family("pyramid");
    let many: Vec<f64> = (0..40).map(|k| f64::from(k) * 0.001).collect();
    let settings = InvertSettings { roll: many.clone(), yaw: many, ..InvertSettings::default() };
    assert_eq!(settings.turns(spatial.design()), Err(InvertError::TooManyTurns { count: 1600 }));
    let settings = InvertSettings { pitch: vec![1.5], ..InvertSettings::default() };
    assert!(settings.turns(spatial.design()).unwrap_err().to_string().contains("less than 80°"));
}

#[test]
fn angles_are_lists_and_ranges() {
    let degrees = |text: &str| -> Vec<f64> {
        list_of_angles(text).unwrap().iter().map(|angle| angle.to_degrees()).collect()
    };
    let close =
        |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(close(&degrees("-10..10 deg/5"), &[-10.0, -5.0, 0.0, 5.0, 10.0]));
    assert!(close(&degrees("-20 deg,3 deg"), &[-20.0, 3.0]));
    for wrong in ["", "x", "1..2", "5 mm", "1 deg,1 deg"] {
        assert!(list_of_angles(wrong).is_err(), "{wrong}");
    }
}
