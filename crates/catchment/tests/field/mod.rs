//! Docks in the field, rebuilt from the published dimensions: the claim, the geometric prediction, the computed result.
//! `docs/field.md` describes each dock.

#![allow(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

mod jams;
mod solids;

use catchment::prelude::*;
use catchment::run::Residual;
use catchment::study::hold;
use solids::{Pieces, arc, around, body, rectangle, ring, scaled, turned};
use std::f64::consts::{SQRT_2, TAU};

fn problem(
    fixed: Pieces,
    moving: Pieces,
    width: f64,
    free: &[Dof],
    change: impl FnOnce(&mut Alignment),
) -> Problem {
    let mut alignment = Alignment::new(free.iter().copied().collect(), Mount::X);
    change(&mut alignment);
    let [fixed, moving] = [fixed, moving].map(|pieces| HalfSource::Pieces(scaled(pieces, width)));
    Problem::new(fixed, moving, alignment).unwrap_or_else(|error| panic!("{error:#?}"))
}

/// The geometric predictions, from `reference/field/docks.csv`.
fn geometry(dock: &str, quantity: &str) -> f64 {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../reference/field/docks.csv");
    let mut table = csv::Reader::from_path(path).unwrap();
    let mut rows = table.records().map(Result::unwrap);
    let row = rows.find(|row| &row[0] == dock && &row[1] == quantity);
    row.unwrap_or_else(|| panic!("{dock}: {quantity}"))[3].parse().unwrap()
}

const LATERAL: [Dof; 2] = [Dof::X, Dof::Y];

/// Largest error along one axis from which a half docks, in D or radians, to within `step`.
fn reach(problem: &Problem, dof: Dof, most: f64, step: f64) -> f64 {
    let docks = |k: &u32| {
        let mut error = [0.0; 5];
        error[dof.index()] = f64::from(*k) * step;
        problem.follow(&PoseError::from_array(error)).outcome == Outcome::Aligned
    };
    let count = (most / step) as u32;
    f64::from((1..=count).take_while(docks).last().unwrap_or(0)) * step
}

/// Largest error in a direction from which a half docks, by bisection; at `most` it must not dock.
fn edge(problem: &Problem, direction: [f64; 5], most: f64) -> f64 {
    let docks = |far: f64| {
        let error = PoseError::from_array(direction.map(|d| d * far));
        problem.follow(&error).outcome == Outcome::Aligned
    };
    assert!(!docks(most), "docks at {most}");
    let (mut inside, mut outside) = (0.0, most);
    for _ in 0..12 {
        let middle = 0.5 * (inside + outside);
        *(if docks(middle) { &mut inside } else { &mut outside }) = middle;
    }
    inside
}

/// Poses at a given lateral offset (D) with a given tilt and yaw (degrees), in every direction: the limit of a standard.
fn limit(count: u32, lateral: f64, tilt: f64, yaw: f64) -> impl Iterator<Item = PoseError> {
    (0..count).map(move |k| {
        let (a, b) = (TAU * f64::from(k) / f64::from(count), 2.4 * f64::from(k));
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        let [tilt, yaw] = [tilt, sign * yaw].map(f64::to_radians);
        PoseError::from_array([lateral * a.cos(), lateral * a.sin(), tilt * b.cos(), tilt * b.sin(), yaw])
    })
}

fn residual(answer: &Answer) -> Vec<Residual> {
    answer.seating.residual.clone()
}

/// The round peg of 12 mm of `IndustReal`: a peg of radius 5.99 with a tip of 5.492 in a hole of 6.499 with a mouth of 7.5 mm.
fn industreal_peg(width: f64) -> Problem {
    let hole = [(6.499, -20.0), (6.499, -1.001), (7.5, 0.0)].map(|(r, z)| ring(32, [0.0; 2], r, z));
    let mut fixed = around(&hole, &ring(32, [0.0; 2], 12.0, 0.0));
    fixed.push([ring(32, [0.0; 2], 12.0, -21.0), ring(32, [0.0; 2], 12.0, -20.0)].concat());
    let peg = [(5.99, -5.0), (5.99, 19.502), (5.492, 20.0)].map(|(r, z)| ring(32, [0.0; 2], r, z));
    let box_of = |a: &mut Alignment| a.half_ranges = [2.5 / width, 2.5 / width, 1.0, 1.0, 1.0];
    problem(fixed, body(&peg), width, &LATERAL, box_of)
}

/// When docked it slides freely in its play; beyond the play a wall of the hole blocks it.
#[test]
fn the_industreal_peg_slides_until_its_play_is_used() {
    const D: f64 = 12.0;
    let problem = industreal_peg(D);
    let least = |play: f64| {
        let settings = hold::HoldSettings { play, ..hold::HoldSettings::default() };
        let result = hold::run(&problem, &settings, &Exec::new()).unwrap();
        result.weakest.smooth_free.and_then(|side| side.withstood.smooth).and_then(|force| force.free)
    };
    assert!(least(hold::HoldSettings::default().play).unwrap() < 1e-6);
    let play = geometry("industreal-peg", "play") / D;
    assert_eq!(least(1.05 * play), None);
}

#[test]
fn the_industreal_peg_docks_within_its_mouth() {
    const D: f64 = 12.0;
    let problem = industreal_peg(D);
    let run = Run { over: Over::Grid("60".parse().unwrap()), ..Run::default() };
    let answer = run.on(&problem, &Exec::new()).unwrap();
    let [lo, hi] = answer.sum_ci95().unwrap();
    // The polygon of 32 sides, 0.6 % less than the circle's 0.0880 D².
    let area = 16.0 * (TAU / 32.0).sin() * (2.008 / D).powi(2);
    assert!((0.5 * (lo + hi) - area).abs() <= hi - lo, "{lo} … {hi} for {area}");
    let round = geometry("industreal-peg", "accepted area in x and y");
    assert!((answer.sum() - round).abs() < 0.01 * round + (hi - lo), "{}", answer.sum());
    // It has 0.509 mm of play, and uses all of it.
    for off in residual(&answer) {
        let play = geometry("industreal-peg", "play");
        assert!(off.most * D > 0.8 * play && off.most * D < 1.02 * play, "{off:?}");
    }
}

/// Sigyn's charging dock: a funnel of 220 × 180 mm narrowing to 112 × 112 over 80, a block of 100 × 100. The claim is ±80
/// mm.
#[test]
fn the_sigyn_funnel_takes_sixty_and_forty_millimetres() {
    const D: f64 = 220.0;
    let funnel = [([56.0, 56.0], 0.0), ([56.0, 56.0], 20.0), ([110.0, 90.0], 100.0)];
    let mut fixed = around(&funnel.map(|(half, z)| rectangle(half, z)), &rectangle([130.0, 110.0], 0.0));
    fixed.extend(body(&[rectangle([130.0, 110.0], -10.0), rectangle([130.0, 110.0], 0.0)]));
    let block = body(&[rectangle([50.0, 50.0], -50.0), rectangle([50.0, 50.0], 0.0)]);
    let problem = problem(fixed, block, D, &LATERAL, |_| ());
    let step = 0.5 / D;
    // The edge of the block must be over the mouth: (220 − 100)/2 and (180 − 100)/2, to one step.
    for dof in LATERAL {
        let expected = geometry("sigyn-funnel", dof.name());
        let result = reach(&problem, dof, 85.0 / D, step) * D;
        assert!((result - expected).abs() <= 0.5, "{}: {result} mm", dof.name());
    }
}

/// A landing pad on four cones: in the drawing the mouths of the funnels are 17.9 mm wider than the tips of the legs.
#[test]
fn four_cones_accept_the_offset_of_one() {
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
    let result = reach(&problem, Dof::X, 0.2, 0.1 / D) * D;
    assert!((result - geometry("landing-pad", "x")).abs() <= 0.15, "{result} mm");
}

/// Three keys in three V grooves at 120° (Maxwell): one rest, which is the outcome of every pose whose keys are over
/// their grooves.
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
    // The tip of a key must be over its groove: up to 4 mm to either side.
    let result = reach(&problem, Dof::Y, 0.12, 0.1 / D) * D;
    assert!((result - geometry("maxwell-coupling", "y")).abs() <= 0.2, "{result} mm");
}

/// A Kelvin coupling on a plate of 60 mm: balls of 8 mm on a circle of 40, in a trihedral and a V of 90°, both 3.6 mm deep, and on a flat.
fn kelvin() -> [Pieces; 2] {
    let (ball, deep, at) = (4.0, 3.6, [20.0, 0.0]);
    let third = |pieces: Pieces, k: f64| turned(&pieces, TAU / 3.0 * k);
    // Height of the ball centres over the plate: 2.06 mm.
    let rise = ball * SQRT_2 - deep;
    let corner = [ring(3, at, 0.3, 0.15 - deep), ring(3, at, 2.0 * deep, 0.0)];
    let mut fixed = around(&corner, &ring(3, at, 12.0, 0.0));
    let side = |sign: f64| -> Vec<DVec3> {
        let corners = [(0.0, -deep), (deep, 0.0), (8.0, 0.0), (8.0, -10.0), (0.0, -10.0)];
        corners.into_iter().flat_map(|(y, z)| [14.0, 26.0].map(|x| DVec3::new(x, sign * y, z))).collect()
    };
    fixed.extend(third(vec![side(1.0), side(-1.0)], 1.0));
    fixed.extend(third(body(&[ring(12, at, 5.5, -10.0), ring(12, at, 5.5, rise - ball)]), 2.0));
    let low = ball / SQRT_2;
    let tip = vec![DVec3::new(at[0], at[1], ball - rise)];
    let sphere = [ring(12, at, ball, -rise), ring(12, at, low, low - rise), tip].concat();
    let mut moving: Pieces = (0..3).flat_map(|k| third(vec![sphere.clone()], f64::from(k))).collect();
    moving.extend(body(&[ring(12, [0.0; 2], 30.0, -rise - 11.6), ring(12, [0.0; 2], 30.0, -rise - 1.6)]));
    [fixed, moving]
}

/// A Kelvin coupling has one rest in all five errors; a ball must stand over its seat, up to 3.6 mm to either side.
#[test]
fn a_kelvin_coupling_accepts_poses_over_its_seats() {
    const D: f64 = 60.0;
    let [fixed, moving] = kelvin();
    let lateral =
        problem(fixed.clone(), moving.clone(), D, &LATERAL, |a| a.half_ranges = [0.1, 0.1, 1.0, 1.0, 1.0]);
    // The facets of the trihedral face 0°, 120° and 240°, the walls of the V 30° and 210°.
    let [straight, slant] = ["-x", "+x"].map(|way| geometry("kelvin-coupling", way));
    for (direction, expected) in [
        ([1.0, 0.0], slant),     // the V
        ([-1.0, 0.0], straight), // a facet
        ([0.0, 1.0], slant),     // two facets
        ([0.0, -1.0], slant),
    ] {
        let [x, y] = direction.map(|d| d / D);
        let result = edge(&lateral, [x, y, 0.0, 0.0, 0.0], 6.0);
        assert!((result - expected).abs() < 0.02, "{direction:?}: {result} mm");
    }
    let problem = problem(fixed, moving, D, &Dof::ALL, |a| a.half_ranges = [0.033, 0.033, 0.05, 0.05, 0.05]);
    let run = Run {
        over: Over::Grid("3".parse().unwrap()),
        sample: Sample::Until(Stop::Samples(300)),
        ..Run::by("descent".parse().unwrap())
    };
    for off in residual(&run.on(&problem, &Exec::new()).unwrap()) {
        assert!(off.most < 1e-3, "{off:?}");
    }
}

/// The probe of Soyuz and Progress: a head in a cone whose mouth is the passage of 800 mm. All other dimensions
/// are assumptions.
#[test]
fn a_probe_finds_its_drogue_from_anywhere_over_the_mouth() {
    const D: f64 = 800.0;
    let circle = |radius: f64, z: f64| ring(16, [0.0; 2], radius, z);
    // A cone of 45° to a socket 90 mm deep, which narrows by 7 mm.
    let cone = [circle(55.0, -428.0), circle(62.0, -338.0), circle(400.0, 0.0)];
    let mut fixed = around(&cone, &circle(550.0, 0.0));
    fixed.extend(body(&[circle(550.0, -448.0), circle(550.0, -428.0)]));
    // The head touches the floor of the socket where the rings meet: a probe at its retracted length.
    let mut moving = body(&[circle(30.0, 0.0), circle(30.0, 368.0)]);
    moving.push([circle(50.0, 368.0), circle(50.0, 408.0), circle(40.0, 428.0)].concat());
    moving.extend(body(&[circle(550.0, -60.0), circle(550.0, 0.0)]));
    let lateral =
        problem(fixed.clone(), moving.clone(), D, &LATERAL, |a| a.half_ranges = [0.5, 0.5, 1.0, 1.0, 1.0]);
    // Mouth minus tip: 360 mm to a corner of the polygon, 353 to its side.
    let half = TAU / 32.0;
    let [corner, side] = ["to a corner", "to a side"].map(|way| geometry("probe-and-drogue", way));
    for (angle, expected) in [(0.0, corner), (half, side), (0.25 * TAU, corner)] {
        let (sin, cos) = f64::sin_cos(angle);
        let result = edge(&lateral, [cos / D, sin / D, 0.0, 0.0, 0.0], 420.0);
        assert!((result - expected).abs() < 0.5, "{angle}: {result} mm");
    }
    let tilted = problem(fixed, moving, D, &[Dof::X, Dof::Y, Dof::Roll, Dof::Pitch], |a| {
        a.dont_care = [Dof::Yaw].into_iter().collect();
        a.half_ranges = [0.2, 0.2, 0.1, 0.1, 1.0];
    });
    // The requirement for ATV: 0.10 m, with 5° of tilt.
    let lateral = geometry("probe-and-drogue", "lateral at 5° of tilt");
    for error in limit(20, lateral / D, 5.0, 0.0) {
        assert_eq!(tilted.follow(&error).outcome, Outcome::Aligned, "{error:?}");
    }
}

/// The Nikon F bayonet: three lugs of 72.21°, 60.78° and 56.39° in slots half a degree wider to either side. `lead`: reduction of the
/// lug ends, degrees to either side.
fn bayonet(lead: f64) -> [Pieces; 2] {
    const CLEAR: f64 = 0.5;
    let (mut fixed, mut moving) = (Vec::new(), Vec::new());
    let mut start = -0.5 * 72.21;
    for (lug, gap) in [(72.21, 53.45), (60.78, 58.65), (56.39, 58.52)] {
        let end = start + lug;
        // Drawn the other way round: the mount reverses y.
        let wedge = |less: f64, z: f64| {
            [arc(23.1, -(start + less), less - end, 6, z), vec![DVec3::new(0.0, 0.0, z)]].concat()
        };
        moving.push([wedge(0.0, 3.2), wedge(0.0, 3.55), wedge(lead, 4.6)].concat());
        let (slot, lip) = ((23.2, start - CLEAR, end + CLEAR, 4), (22.1, end + CLEAR, end + gap - CLEAR, 3));
        for (radius, from, to, steps) in [slot, lip] {
            let part = (to - from) / f64::from(steps);
            // Chords that touch the circle: no material reaches into the hole.
            let inner = radius / (0.5 * part).to_radians().cos();
            for k in 0..steps {
                let from = from + part * f64::from(k);
                let level =
                    |z: f64| [arc(inner, from, from + part, 1, z), arc(30.0, from, from + part, 1, z)];
                fixed.push([level(-3.0), level(0.0)].concat().concat());
            }
        }
        start = end + gap;
    }
    let circle = |radius: f64, z: f64| ring(24, [0.0; 2], radius, z);
    moving.extend(body(&[circle(22.0, 0.0), circle(22.0, 4.6)]));
    moving.extend(body(&[circle(30.0, -3.0), circle(30.0, 0.0)]));
    [fixed, moving]
}

/// The lugs of a bayonet enter their slots up to a yaw error equal to their clearance plus their lead-in.
#[test]
fn a_bayonet_enters_by_its_clearance_and_its_lead_in() {
    for (lead, quantity) in [(0.0, "yaw without a lead-in"), (3.0, "yaw with a lead-in of 3°")] {
        let expected = geometry("bayonet-nikon-f", quantity);
        let [fixed, moving] = bayonet(lead);
        let problem =
            problem(fixed, moving, 60.0, &[Dof::Yaw], |a| a.half_ranges = [1.0, 1.0, 1.0, 1.0, 0.2]);
        for sign in [1.0, -1.0_f64] {
            let result = edge(&problem, [0.0, 0.0, 0.0, 0.0, sign.to_radians()], 8.0);
            assert!((result - expected).abs() < 0.02, "{lead}°: {result}°");
            // The widest lug fits only its own slot.
            let other = PoseError { yaw: sign * TAU / 3.0, ..PoseError::default() };
            assert_eq!(problem.follow(&other).outcome, Outcome::Jammed);
        }
    }
}

/// A ring of three petals that mates with itself: petals at 90°, 210° and 330°, 160 mm inwards and 160 mm high at 45°, on a bore of 1200.
fn petals() -> Pieces {
    let mut half = around(
        &[ring(12, [0.0; 2], 600.0, -60.0), ring(12, [0.0; 2], 600.0, 0.0)],
        &ring(12, [0.0; 2], 680.0, 0.0),
    );
    // Along a side of the 12-gon, at an angle from its corner.
    let eighth = TAU / 24.0;
    let side = |radius: f64, off: f64| radius * eighth.cos() / (eighth - off).cos();
    for (middle, sign) in [90.0, 210.0, 330.0_f64].into_iter().flat_map(|m| [(m, -1.0), (m, 1.0)]) {
        let mut corners = Vec::new();
        // The foot leaves 2 mm of play and half a degree to either side; the tip is 36° wide.
        for (z, radius, wide) in [(0.0, 598.0, 29.5), (160.0, 440.0, 18.0_f64)] {
            for off in [0.0, wide] {
                for radius in [radius, radius - 15.0] {
                    let [off, middle] = [off, middle].map(f64::to_radians);
                    let (sin, cos) = (middle + sign * off).sin_cos();
                    let r = side(radius, off);
                    corners.push(DVec3::new(r * cos, r * sin, z));
                }
            }
        }
        half.push(corners);
    }
    half
}

/// Three petals between three others: the gap between the tips limits the yaw. All initial conditions that IDSS
/// requires dock.
#[test]
fn three_petals_accept_the_gap_between_their_tips() {
    const D: f64 = 1200.0;
    let flat = problem(petals(), petals(), D, &[Dof::X, Dof::Y, Dof::Yaw], |a| {
        a.half_ranges = [0.15, 0.15, 1.0, 1.0, 0.5];
        a.symmetry = 3;
    });
    // Tips of 36° on 60°: 24° of yaw to either side, about each of the three mated poses.
    for sign in [1.0, -1.0_f64] {
        let result = edge(&flat, [0.0, 0.0, 0.0, 0.0, sign.to_radians()], 40.0);
        assert!((result - geometry("three-petals", "yaw")).abs() < 0.05, "{result}°");
    }
    let third = PoseError { yaw: 143.0_f64.to_radians(), ..PoseError::default() };
    assert_eq!(flat.follow(&third).outcome, Outcome::Aligned);
    // Straight along the gap between two tips, whose inner corners are nearest: 2·411 mm·sin 12°.
    let expected = geometry("three-petals", "-y");
    let result = edge(&flat, [0.0, -1.0 / D, 0.0, 0.0, 0.0], 200.0);
    assert!((result - expected).abs() < 0.2, "{result} mm for {expected}");
    // The initial contact of IDSS: 0.10 m, 4° of tilt, 4° about the axis, all at once.
    let free = problem(petals(), petals(), D, &Dof::ALL, |a| {
        a.half_ranges = [0.084, 0.084, 0.07, 0.07, 0.07];
        a.symmetry = 3;
    });
    let lateral = geometry("three-petals", "lateral at 4° of tilt and 4° of yaw");
    for error in limit(24, lateral / D, 4.0, 4.0) {
        assert_eq!(free.follow(&error).outcome, Outcome::Aligned, "{error:?}");
    }
}
