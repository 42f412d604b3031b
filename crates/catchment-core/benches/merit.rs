//! Figures of merit of two made-up sets over a five-dimensional grid: time and peak memory per cell.

mod rates;

use catchment_core::acceptance::{Acceptance, Domain, Outcome};
use catchment_core::design::Alignment;
use catchment_core::exec::Exec;
use catchment_core::landscape::Grid;
use catchment_core::merit::centered::centered_cube;
use catchment_core::merit::onaa::Onaa;
use catchment_core::merit::success::{Distribution, success};
use catchment_core::merit::sum::{Sum, bracket};
use catchment_core::merit::tolerance::tolerances;
use catchment_core::merit::{brute, warnings};
use catchment_core::pose::{DofSet, Mount, PoseError};
use peak_alloc::PeakAlloc;
use rates::Rates;
use std::f64::consts::PI;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Cells per axis: 24.3 million cells.
const SIDE: usize = 30;
/// Cells per axis on which the judges are measured.
const SMALL: usize = 10;

/// Half axes of the ellipsoid, as shares of the error box.
const HALF_AXES: [f64; 5] = [0.9, 0.7, 0.8, 0.6, 0.85];

fn main() {
    let mut rates = Rates::of("merit");
    let exec = Exec::new();
    ellipsoid_by_closed_forms(&mut rates, &exec);
    all_figures(&mut rates, &boxes(SIDE), &exec);
    beside_the_judges(&mut rates, &boxes(SMALL), &exec);
    rates.finish();
}

/// Sum and ONAA where they are known.
fn ellipsoid_by_closed_forms(rates: &mut Rates, exec: &Exec) {
    let set = ellipsoid(SIDE);
    let cells = set.outcomes.len();
    let volume = 8.0 / 15.0 * PI.powi(2) * HALF_AXES.iter().product::<f64>() * (PI / 2.0).powi(3);
    rates.measure(
        "Sum of an ellipsoid, 30⁵",
        "cells",
        cells,
        &mut || {
            let sum = Sum::of(&set, &alignment()).sum;
            let [lo, hi] = bracket(&set, exec).expect("a bracket");
            assert!(
                lo < volume && volume < hi && (sum / volume - 1.0).abs() < 0.01,
                "{lo} {sum} {hi}, {volume}"
            );
        },
        None,
    );
    // Half edge h of the inscribed cube: its corner lies on the ellipsoid, h²·Σ 1/aᵢ² = 1.
    let half = HALF_AXES.iter().map(|a| 1.0 / (a * a)).sum::<f64>().sqrt().recip();
    rates.measure(
        "ONAA of an ellipsoid, 30⁵",
        "cells",
        cells,
        &mut || {
            let edge = Onaa::of(&set, exec).expect("an edge").edge;
            // Right to a cell at either end.
            assert!((edge - half).abs() <= 2.0 / SIDE as f64, "{edge} for {half}");
        },
        None,
    );
}

/// What a report computes, and the success probability.
fn all_figures(rates: &mut Rates, set: &Acceptance, exec: &Exec) {
    let mut figure = |what: &str, work: &mut dyn FnMut()| {
        rates.measure(&format!("{what} of boxes, 30⁵"), "cells", set.outcomes.len(), work, None);
    };
    figure("counts", &mut || assert_eq!(set.counts()[0], 3_106_074));
    figure("bracket", &mut || {
        let [lo, hi] = bracket(set, exec).expect("a bracket").map(|m| m / (4.0 * PI.powi(3)));
        assert!((lo - 0.052).abs() < 0.001 && (hi - 0.262).abs() < 0.001, "{lo} {hi}");
    });
    figure("ONAA", &mut || assert_eq!(Onaa::of(set, exec).expect("an edge").edge, 1.0 / 3.0));
    figure("centred cube", &mut || {
        let scale = centered_cube(set, exec).expect("a cube").edge;
        assert!((scale - 4.0 / 15.0).abs() < 1e-12, "{scale}");
    });
    figure("tolerances", &mut || assert_eq!(tolerances(set).expect("tolerances").len(), 5));
    figure("warnings", &mut || assert_eq!(warnings(set, exec).expect("warnings").len(), 1));
    let sigma = PoseError::from_array([0.3, 0.3, 0.5, 0.5, 0.5]);
    let normal = Distribution::Normal { mean: PoseError::default(), sigma };
    figure("success", &mut || {
        let result = success(set, &normal, exec).expect("a probability");
        assert!((result.probability - 0.203_515_464_769_75).abs() < 1e-12, "{}", result.probability);
    });
}

/// Where the judges can follow.
fn beside_the_judges(rates: &mut Rates, set: &Acceptance, exec: &Exec) {
    let Some(grid) = set.grid() else { return };
    let accepted: Vec<bool> = set.accepted().collect();
    let cells = accepted.len();
    rates.measure(
        "bracket of boxes, 10⁵",
        "cells",
        cells,
        &mut || assert!(bracket(set, exec).is_ok()),
        Some(&mut || {
            let share = |count: usize| count as f64 / cells as f64 * grid.measure();
            let defined = brute::inner_and_outer(grid, &accepted).map(share);
            assert_eq!(bracket(set, exec), Ok(defined), "the judge disagrees");
        }),
    );
    rates.measure(
        "ONAA of boxes, 10⁵",
        "cells",
        cells,
        &mut || assert!(Onaa::of(set, exec).is_ok()),
        Some(&mut || {
            let defined = brute::largest_cube(&grid.shape(), &accepted) as f64 / SMALL as f64;
            assert_eq!(Onaa::of(set, exec).map(|onaa| onaa.edge), Ok(defined), "the judge disagrees");
        }),
    );
}

fn alignment() -> Alignment {
    Alignment::new(DofSet::ALL, Mount::X)
}

/// Accepts where `inside` holds of the error as a share of the error box.
fn accept(side: usize, inside: impl Fn([f64; 5]) -> bool) -> Acceptance {
    let grid = Grid::over(&alignment(), |_| side);
    let outcome = |index| {
        let mut share = grid.pose(index).to_array();
        share.iter_mut().zip(&grid.axes).for_each(|(value, axis)| *value /= axis.hi);
        if inside(share) { Outcome::Aligned } else { Outcome::Jammed }
    };
    let outcomes = (0..grid.len()).map(outcome).collect();
    Acceptance { method: "made up", domain: Domain::Grid(grid), outcomes, warnings: Vec::new() }
}

fn ellipsoid(side: usize) -> Acceptance {
    accept(side, |e| e.iter().zip(HALF_AXES).map(|(v, a)| (v / a).powi(2)).sum::<f64>() < 1.0)
}

/// A box around zero and many larger ones at random places.
fn boxes(side: usize) -> Acceptance {
    const BOXES: usize = 40;
    let centers = match Domain::random(&alignment(), BOXES, 1) {
        Domain::Poses(poses) => poses,
        Domain::Grid(_) => Vec::new(),
    };
    let scale = |error: &PoseError| {
        let mut share = error.to_array();
        share[2..].iter_mut().for_each(|angle| *angle /= PI / 2.0);
        share
    };
    let boxes: Vec<([f64; 5], f64)> =
        centers.iter().map(|c| (scale(c), 0.35)).chain([([0.0; 5], 0.3)]).collect();
    accept(side, |e| boxes.iter().any(|(c, half)| e.iter().zip(c).all(|(v, c)| (v - c).abs() < *half)))
}
