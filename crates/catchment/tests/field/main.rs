//! Docks in the field, rebuilt from the dimensions that are public: what is claimed, what geometry says, what the program says.
//! `docs/field.md` tells of each.

#![allow(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

mod solids;

use catchment::prelude::*;
use catchment::run::Residual;
use solids::{Pieces, around, body, rectangle, ring, scaled, turned};
use std::f64::consts::TAU;

fn problem(
    fixed: Pieces,
    moving: Pieces,
    width: f64,
    free: &[Dof],
    change: impl FnOnce(&mut Alignment),
) -> Problem {
    let mut alignment = Alignment::new(free.iter().copied().collect(), Mount::X);
    change(&mut alignment);
    let [fixed, moving] = [fixed, moving].map(|pieces| Source::Pieces(scaled(pieces, width)));
    Problem::new(fixed, moving, alignment).unwrap_or_else(|error| panic!("{error:#?}"))
}

const LATERAL: [Dof; 2] = [Dof::X, Dof::Y];

/// How far along one error a half docks, in D or radians, found to `step`.
fn reach(problem: &Problem, dof: Dof, most: f64, step: f64) -> f64 {
    let docks = |k: &u32| {
        let mut error = [0.0; 5];
        error[dof.index()] = f64::from(*k) * step;
        problem.follow(&PoseError::from_array(error)).outcome == Outcome::Aligned
    };
    let count = (most / step) as u32;
    f64::from((1..=count).take_while(docks).last().unwrap_or(0)) * step
}

fn residual(answer: &Answer) -> Vec<Residual> {
    answer.seating.residual.clone()
}

/// The round peg of 12 mm of `IndustReal`: a peg of radius 5.99 with a tip of 5.492 in a hole of 6.499 with a mouth of 7.5 mm.
#[test]
fn the_industreal_peg_docks_within_its_mouth() {
    const D: f64 = 12.0;
    let hole = [(6.499, -20.0), (6.499, -1.001), (7.5, 0.0)].map(|(r, z)| ring(32, [0.0; 2], r, z));
    let mut fixed = around(&hole, &ring(32, [0.0; 2], 12.0, 0.0));
    fixed.push([ring(32, [0.0; 2], 12.0, -21.0), ring(32, [0.0; 2], 12.0, -20.0)].concat());
    let peg = [(5.99, -5.0), (5.99, 19.502), (5.492, 20.0)].map(|(r, z)| ring(32, [0.0; 2], r, z));
    let problem =
        problem(fixed, body(&peg), D, &LATERAL, |a| a.half_ranges = [2.5 / D, 2.5 / D, 1.0, 1.0, 1.0]);
    let run = Run { over: Over::Grid("60".parse().unwrap()), ..Run::default() };
    let answer = run.on(&problem, &Exec::new()).unwrap();
    let [lo, hi] = answer.sum_ci95().unwrap();
    // The polygon of 32 sides, 0.6 % less than the circle's 0.0880 D².
    let area = 16.0 * (TAU / 32.0).sin() * (2.008 / D).powi(2);
    assert!((0.5 * (lo + hi) - area).abs() <= hi - lo, "{lo} … {hi} for {area}");
    assert!((answer.sum() - 0.0880).abs() < 0.01 * 0.0880 + (hi - lo), "{}", answer.sum());
    // It has 0.509 mm of play, and uses it.
    for off in residual(&answer) {
        assert!(off.most * D > 0.4 && off.most * D < 0.52, "{off:?}");
    }
}

/// Sigyn's charging dock: a funnel of 220 × 180 mm narrowing to 112 × 112 over 80, a block of 100 × 100. ±80 mm is claimed.
#[test]
fn the_sigyn_funnel_takes_sixty_and_forty_millimetres() {
    const D: f64 = 220.0;
    let funnel = [([56.0, 56.0], 0.0), ([56.0, 56.0], 20.0), ([110.0, 90.0], 100.0)];
    let mut fixed = around(&funnel.map(|(half, z)| rectangle(half, z)), &rectangle([130.0, 110.0], 0.0));
    fixed.extend(body(&[rectangle([130.0, 110.0], -10.0), rectangle([130.0, 110.0], 0.0)]));
    let block = body(&[rectangle([50.0, 50.0], -50.0), rectangle([50.0, 50.0], 0.0)]);
    let problem = problem(fixed, block, D, &LATERAL, |_| ());
    let step = 0.5 / D;
    // The edge of the block must be over the mouth: (220 − 100)/2 and (180 − 100)/2, to a step.
    for (dof, expected) in [(Dof::X, 60.0), (Dof::Y, 40.0)] {
        let found = reach(&problem, dof, 85.0 / D, step) * D;
        assert!((found - expected).abs() <= 0.5, "{}: {found} mm", dof.name());
    }
}

/// A landing pad on four cones: funnels whose mouths are 17.9 mm wider than the tips of the legs, which is what the drawing gives.
#[test]
fn four_cones_take_what_one_takes() {
    const D: f64 = 140.0;
    let (mouth, tip, places) = (22.4, 4.5, [[50.0, 50.0], [-50.0, 50.0], [-50.0, -50.0], [50.0, -50.0]]);
    let (mut fixed, mut legs) = (Vec::new(), Vec::new());
    for center in places {
        let outer = ring(8, center, 24.0, 0.0);
        fixed.extend(around(&[ring(8, center, tip, -mouth + tip), ring(8, center, mouth, 0.0)], &outer));
        fixed.push([ring(8, center, 24.0, -25.0), ring(8, center, 24.0, -mouth + tip)].concat());
        legs.push(
            [ring(8, center, tip, mouth - tip), ring(8, center, tip + 5.0, mouth - tip - 5.0)].concat(),
        );
        legs.push(
            [ring(8, center, tip + 5.0, mouth - tip - 5.0), ring(8, center, tip + 5.0, -10.0)].concat(),
        );
    }
    legs.extend(body(&[rectangle([62.0, 62.0], -14.0), rectangle([62.0, 62.0], -10.0)]));
    let problem = problem(fixed, legs, D, &LATERAL, |a| a.half_ranges = [0.2, 0.2, 1.0, 1.0, 1.0]);
    let found = reach(&problem, Dof::X, 0.2, 0.1 / D) * D;
    assert!((found - 17.9).abs() <= 0.15, "{found} mm");
}

/// Three keys in three V grooves at 120° (Maxwell): one place of rest, and everything that meets its groove goes there.
#[test]
fn three_grooves_leave_one_place_of_rest() {
    const D: f64 = 50.0;
    // Across a groove that runs along x, from 10 to 24 mm off the axis: 45° walls, 4 mm deep and wide.
    let along =
        |half: f64, z: f64| [10.0, 24.0].map(|x| [DVec3::new(x, half, z), DVec3::new(x, -half, z)]).concat();
    let key = [along(0.0, 4.0), along(4.0, 0.0), along(4.0, -2.0)].concat();
    let side = |sign: f64| -> Vec<DVec3> {
        let corners = [(0.0, -4.0), (4.0, 0.0), (6.0, 0.0), (6.0, -6.0), (0.0, -6.0)];
        corners.into_iter().flat_map(|(y, z)| [10.0, 24.0].map(|x| DVec3::new(x, sign * y, z))).collect()
    };
    let thirds =
        |pieces: Pieces| (0..3).flat_map(|k| turned(&pieces, TAU / 3.0 * f64::from(k))).collect::<Pieces>();
    let (fixed, moving) = (thirds(vec![side(1.0), side(-1.0)]), thirds(vec![key]));
    let problem = problem(fixed, moving, D, &[Dof::X, Dof::Y, Dof::Yaw], |a| {
        a.half_ranges = [0.12, 0.12, 1.0, 1.0, 0.3];
        a.symmetry = 3;
    });
    let answer =
        Run { over: Over::Grid("12".parse().unwrap()), ..Run::default() }.on(&problem, &Exec::new()).unwrap();
    for off in residual(&answer) {
        assert!(off.most < 1e-3, "{off:?}");
    }
    // The tip of a key must be over its groove: 4 mm to either side of it.
    let found = reach(&problem, Dof::Y, 0.12, 0.1 / D) * D;
    assert!((found - 4.0).abs() <= 0.2, "{found} mm");
}
