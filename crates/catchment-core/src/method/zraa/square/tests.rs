//! Closed forms, and the definition by trial positions.

use super::*;
use crate::method::zraa::sheet::area;
use proptest::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

fn square(polygons: &[Vec<DVec2>]) -> AcceptedSquare {
    AcceptedSquare::within(polygons, &Exec::new()).unwrap()
}

fn polygon(corners: &[(f64, f64)]) -> Vec<DVec2> {
    corners.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn tile(x: f64, y: f64, w: f64, h: f64) -> Vec<DVec2> {
    polygon(&[(x, y), (x + w, y), (x + w, y + h), (x, y + h)])
}

/// Area of a box within the tiling.
fn held(polygons: &[Vec<DVec2>], middle: DVec2, half: f64) -> f64 {
    let within = |polygon: &Vec<DVec2>| {
        let mut part = polygon.clone();
        for (axis, sign) in [(DVec2::X, 1.0), (DVec2::X, -1.0), (DVec2::Y, 1.0), (DVec2::Y, -1.0)] {
            part = clip(&part, |p| half - sign * axis.dot(p - middle));
        }
        area(&part)
    };
    polygons.iter().map(within).sum()
}

/// Whether a box lies within the tiling, by areas alone.
fn fits(polygons: &[Vec<DVec2>], middle: DVec2, half: f64) -> bool {
    // Corners that stick out by less than this are not seen.
    const UNSEEN: f64 = 1e-10;
    4.0 * half * half - held(polygons, middle, half) < UNSEEN * half
}

/// Half edge of the largest box around a position, by bisection, if it is more than `least`.
fn widest(polygons: &[Vec<DVec2>], middle: DVec2, least: f64) -> Option<f64> {
    let (mut lo, mut hi) = (least, 1.0);
    if !fits(polygons, middle, lo) {
        return None;
    }
    while hi - lo > 1e-8 {
        let half = f64::midpoint(lo, hi);
        if fits(polygons, middle, half) { lo = half } else { hi = half }
    }
    Some(lo)
}

/// The definition by trying places: a grid, then ever smaller steps from its best place.
fn by_trial(polygons: &[Vec<DVec2>]) -> f64 {
    const GRID: i32 = 16;
    let (mut half, mut at) = (1e-3, DVec2::ZERO);
    for (i, j) in (-GRID..=GRID).flat_map(|i| (-GRID..=GRID).map(move |j| (i, j))) {
        let p = DVec2::new(f64::from(i), f64::from(j)) / f64::from(GRID);
        if let Some(wider) = widest(polygons, p, half + 1e-6) {
            (half, at) = (wider, p);
        }
    }
    let mut step = 1.0 / f64::from(GRID);
    while step > 1e-6 {
        let mut next = (0..8).map(|k| at + step * DVec2::from_angle(f64::from(k) * TAU / 8.0));
        match next.find_map(|p| Some((widest(polygons, p, half + 1e-7)?, p))) {
            Some(better) => (half, at) = better,
            None => step /= 2.0,
        }
    }
    2.0 * half
}

/// Fan of triangles from zero to a rim.
fn star(radii: &[f64], turn: f64) -> Vec<Vec<DVec2>> {
    let n = radii.len();
    let rim = |k: usize| radii[k % n] * DVec2::from_angle(turn + (k % n) as f64 * TAU / n as f64);
    (0..n).map(|k| vec![DVec2::ZERO, rim(k), rim(k + 1)]).collect()
}

#[test]
fn closed_forms() {
    let disc = |corners: u32| star(&vec![0.5; corners as usize], 0.0);
    let ring: Vec<_> = [(0, 0), (1, 0), (2, 0), (0, 1), (2, 1), (0, 2), (1, 2), (2, 2)]
        .map(|(x, y)| tile(f64::from(x), f64::from(y), 1.0, 1.0))
        .to_vec();
    let cross = vec![tile(-1.0, -0.1, 0.9, 0.2), tile(0.1, -0.1, 0.9, 0.2), tile(-0.1, -1.0, 0.2, 2.0)];
    let half_turned = TAU / 16.0;
    for (name, region, edge) in [
        ("the diamond of the X-Face", star(&[1.0; 4], 0.0), 1.0),
        (
            "a square of many parts",
            (0..7).map(|k| tile(f64::from(k) / 7.0, 0.0, 1.0 / 7.0, 1.0)).collect(),
            1.0,
        ),
        ("a corridor in which it slides", vec![tile(-1.5, -0.25, 3.0, 0.5)], 0.5),
        ("a right triangle", vec![polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])], 0.5),
        ("a ring of squares around a hole", ring, 1.0),
        ("a cross", cross, 0.2),
        ("two parts, the larger one apart", vec![tile(0.0, 0.0, 0.3, 0.3), tile(1.0, 1.0, 0.4, 0.5)], 0.4),
        // A corner of the polygon on the diagonal, and the middle of a side there.
        ("a polygon of 8 corners", disc(8), FRAC_1_SQRT_2),
        ("a polygon of 12 corners", disc(12), FRAC_1_SQRT_2 * (TAU / 24.0).cos()),
        (
            "a strip askew",
            vec![
                tile(-1.0, -0.1, 2.0, 0.2)
                    .iter()
                    .map(|p| DVec2::from_angle(half_turned).rotate(*p))
                    .collect(),
            ],
            0.2 / (half_turned.sin() + half_turned.cos()),
        ),
        ("nothing", vec![], 0.0),
    ] {
        let result = square(&region);
        assert!((result.edge - edge).abs() < AcceptedSquare::TOLERANCE, "{name}: {result:?}");
        assert!(
            result.edge == 0.0 || fits(&region, result.center, result.edge / 2.0 - 1e-9),
            "{name}: {result:?}"
        );
    }
}

#[test]
fn the_square_around_zero_is_reported_beside_the_largest() {
    // Zero in the narrow part of an hourglass lying down.
    let wide = tile(0.1, -0.4, 0.9, 0.8);
    let result = square(&[tile(-0.2, -0.05, 0.3, 0.1), wide]);
    assert!((result.edge - 0.8).abs() < 1e-8 && (result.centered_edge - 0.1).abs() < 1e-8, "{result:?}");
    let off = square(&[tile(1.0, 1.0, 1.0, 1.0)]);
    assert!((off.edge - 1.0).abs() < 1e-8 && off.centered_edge == 0.0, "{off:?}");
    let zraa = Zraa::Interval { axis: crate::pose::Dof::X, from: -0.25, to: 0.75 };
    let result = AcceptedSquare::of(&zraa, &Exec::new()).unwrap();
    assert_eq!((result.edge, result.center.x, result.centered_edge), (1.0, 0.25, 0.5));
}

#[test]
fn a_cancelled_search_ends() {
    let exec = Exec::new();
    exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert_eq!(AcceptedSquare::within(&star(&[1.0; 5], 0.0), &exec), Err(Cancelled));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// The square lies within the region, and no box that was tried is larger.
    #[test]
    fn stars_agree_with_trial(radii in proptest::collection::vec(0.15..1.0f64, 5..14), turn in 0.0..TAU) {
        let region = star(&radii, turn);
        let result = square(&region);
        prop_assert!(fits(&region, result.center, result.edge / 2.0 - 1e-8), "{result:?}");
        let tried = by_trial(&region);
        // A corner that sticks out by d covers at least d²/4 if no side of the rim is steeper than 2, so that
        // 1e-10 · r hides less than 2e-5; steeper sides hide more, in proportion to the root.
        prop_assert!(result.edge >= tried - 1e-4, "{result:?} {tried}");
        prop_assert!(result.edge <= tried + 0.1, "{result:?} {tried}");
    }

    /// Of unit cells the edge is whole, and counted by the longest runs.
    #[test]
    fn cells_agree_with_counting(cells in proptest::collection::vec(proptest::bool::weighted(0.75), 49)) {
        let at = |x: usize, y: usize| cells[x + 7 * y];
        let places = (0..7).flat_map(|y| (0..7).map(move |x| (x, y)));
        let region: Vec<_> = places
            .clone()
            .filter(|&(x, y)| at(x, y))
            .map(|(x, y)| tile(x as f64 - 3.3, y as f64 - 3.6, 1.0, 1.0))
            .collect();
        let full = |x: usize, y: usize, n: usize| {
            x + n <= 7 && y + n <= 7 && (x..x + n).all(|i| (y..y + n).all(|j| at(i, j)))
        };
        let counted = places.flat_map(|(x, y)| (0..=7).map(move |n| (x, y, n))).filter(|&(x, y, n)| full(x, y, n));
        let counted = counted.map(|(_, _, n)| n).max().unwrap();
        let result = square(&region);
        prop_assert!((result.edge - counted as f64).abs() < AcceptedSquare::TOLERANCE, "{result:?} {counted}");
    }
}
