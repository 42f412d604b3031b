//! How the polyhedral partition grows with its slices: the V-Face on one thread, beside the published times.
//!
//! ```text
//!   cargo bench -p catchment-core --bench partition
//! ```
//!
//! Exponents are fitted to the logarithms by least squares, over all slices from 12 to 100.

#![expect(clippy::print_stdout, reason = "a bench prints its table")]

mod designs;

use catchment_core::acceptance::Outcome;
use catchment_core::exec::Exec;
use catchment_core::method::partition::{self, PartitionSettings};
use designs::pair;
use std::time::Instant;

/// Slices whose published times are known, and more.
const SLICES: [usize; 5] = [12, 21, 35, 60, 100];
/// Hours that the original took, by slices (dissertation, section 5.2.5).
const PUBLISHED: [(usize, f64); 2] = [(12, 48.6 * 60.0), (21, 8.0 * 3600.0)];
/// Times are medians of so many runs.
const RUNS: usize = 3;

fn main() {
    // Under `cargo test` every work runs once, and only the short ones.
    let timed = std::env::args().any(|argument| argument == "--bench");
    let pair = pair("v-face.toml");
    let exec = Exec::new().with_threads(1).expect("one thread");
    for (name, per_strip) in [("1 strip, as published", None), ("one strip per two slices", Some(2))] {
        println!("\nv-face, one thread, {name}");
        println!(
            "{:>8}{:>8}{:>12}{:>10}{:>10}{:>10}{:>14}",
            "slices", "strips", "polytopes", "cells", "parts", "s", "published / s"
        );
        let mut points = Vec::new();
        for slices in SLICES.into_iter().filter(|slices| timed || *slices < 20) {
            let settings = PartitionSettings { slices, strips: per_strip.map_or(1, |n| slices.div_ceil(n)) };
            let mut seconds = Vec::new();
            let mut counts = partition::PartitionCounts::default();
            for _ in 0..if timed { RUNS } else { 1 } {
                let started = Instant::now();
                let result = partition::run(&pair, &settings, &exec).expect("a partition");
                seconds.push(started.elapsed().as_secs_f64());
                counts = result.counts();
                // Loose: a bench guards against computing nothing or everything, the tests hold the numbers.
                assert!((0.05..6.0).contains(&result.measure(Outcome::Aligned)));
            }
            seconds.sort_by(f64::total_cmp);
            let median = seconds[seconds.len() / 2];
            let published = PUBLISHED.iter().find(|(known, _)| *known == slices);
            let ratio = published.map_or_else(String::new, |(_, s)| format!("{:.0} ×", s / median));
            println!(
                "{slices:>8}{:>8}{:>12}{:>10}{:>10}{median:>10.3}{ratio:>14}",
                settings.strips, counts.polytopes, counts.cells, counts.parts
            );
            points.push([slices as f64, median, counts.cells as f64, counts.parts as f64]);
        }
        if timed {
            let [time, cells, parts] = [1, 2, 3].map(|column| exponent(&points, column));
            println!("growth: time slices^{time:.2}, cells slices^{cells:.2}, parts slices^{parts:.2}");
        }
    }
}

/// Slope of log(column) over log(first column), by least squares.
fn exponent(points: &[[f64; 4]], column: usize) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|p| [p[0].ln(), p[column].ln()]).collect();
    let mean = |k: usize| logs.iter().map(|p| p[k]).sum::<f64>() / logs.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let above: f64 = logs.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    let below: f64 = logs.iter().map(|p| (p[0] - x).powi(2)).sum();
    above / below
}
