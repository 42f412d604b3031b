//! Heights and descents of committed designs, with the judge beside the fast path in the same run. The brute/fast
//! ratios are printed first: medians of alternating runs, so that a drifting machine cancels out.

mod designs;

use catchment::acceptance::Outcome;
use catchment::contact::{Lattice, Pair, brute};
use catchment::method::descent;
use catchment::pose::{CorPose, PoseError, rotation};
use designs::pair;
use divan::counter::ItemsCount;
use glam::{DMat3, DVec2};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Cells per side of a slice.
const SIDE: usize = 24;

#[expect(clippy::print_stdout, reason = "a bench prints what it measures")]
fn main() {
    for name in ["v-face.toml", "pyramid.toml", "x-face-3d.toml"] {
        let pair = pair(name);
        let ratio = brute_over_fast(&pair);
        println!("{name:16} slice of {SIDE} × {SIDE} heights: brute / fast = {ratio:.0}");
    }
    divan::main();
}

/// A tilted half, so that no edge is parallel to another by accident.
fn tilt(pair: &Pair) -> DMat3 {
    if pair.alignment.free.rotations() == 1 { rotation(0.0, 0.3, 0.0) } else { rotation(0.2, -0.3, 0.4) }
}

fn lattice(half_range: f64) -> Lattice {
    Lattice { first: -half_range, step: 2.0 * half_range / (SIDE - 1) as f64, count: SIDE }
}

fn fast_slice(pair: &Pair, out: &mut [f64]) {
    pair.at_rotation(tilt(pair)).heights(lattice(1.0), lattice(1.0), out);
}

fn brute_slice(pair: &Pair, out: &mut [f64]) {
    let (x, rotation) = (lattice(1.0), tilt(pair));
    for (k, cell) in out.iter_mut().enumerate() {
        let lateral = DVec2::new(x.at(k % SIDE), x.at(k / SIDE));
        *cell = brute::height(pair, &CorPose { lateral, rotation }).unwrap_or(f64::NEG_INFINITY);
    }
}

fn brute_over_fast(pair: &Pair) -> f64 {
    let (mut fast, mut slow) = (vec![0.0; SIDE * SIDE], vec![0.0; SIDE * SIDE]);
    let timed = |work: &mut dyn FnMut()| -> Duration {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    let mut ratios: Vec<f64> = (0..7)
        .map(|_| {
            let brute = timed(&mut || brute_slice(pair, &mut slow));
            let quick = timed(&mut || (0..50).for_each(|_| fast_slice(black_box(pair), &mut fast)));
            brute.as_secs_f64() / (quick.as_secs_f64() / 50.0)
        })
        .collect();
    let agree = |(a, b): (&f64, &f64)| a == b || (a - b).abs() < 1e-11;
    assert!(fast.iter().zip(&slow).all(agree), "the judge disagrees");
    ratios.sort_by(f64::total_cmp);
    ratios[ratios.len() / 2]
}

/// One rotation, all lateral positions: the unit of work of every grid method.
#[divan::bench(args = ["v-face.toml", "pyramid.toml", "x-face-3d.toml", "cone.toml"])]
fn slice(bencher: divan::Bencher, name: &str) {
    let pair = pair(name);
    let mut out = vec![0.0; SIDE * SIDE];
    bencher.counter(ItemsCount::new(SIDE * SIDE)).bench_local(|| fast_slice(&pair, &mut out));
}

/// One pose at a new rotation.
#[divan::bench(args = ["v-face.toml", "pyramid.toml", "x-face-3d.toml", "cone.toml"])]
fn one_height(bencher: divan::Bencher, name: &str) {
    let pair = pair(name);
    let pose = CorPose { lateral: DVec2::new(0.1, 0.0), rotation: tilt(&pair) };
    bencher.bench_local(|| pair.height(black_box(&pose)).expect("they meet"));
}

/// One motion from first contact to its end.
#[divan::bench(args = ["v-face.toml", "pyramid.toml", "x-face-3d.toml"])]
fn descent_of_a_pose(bencher: divan::Bencher, name: &str) {
    let pair = pair(name);
    let planar = pair.alignment.free.rotations() == 1;
    let error = if planar {
        PoseError { x: 0.2, pitch: 0.3, ..PoseError::default() }
    } else {
        PoseError { x: 0.2, y: -0.1, roll: 0.2, pitch: 0.25, yaw: 0.3 }
    };
    let settings = descent::Settings::default();
    bencher.counter(ItemsCount::new(1usize)).bench_local(|| {
        let end = descent::outcome(&pair, black_box(&error), &settings);
        assert_eq!(end.outcome, Outcome::Aligned);
    });
}
