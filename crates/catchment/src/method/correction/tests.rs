//! Known volumes and wrong grids: is the Sum unbiased, and does its interval hold it as often as it says?

use super::*;
use crate::acceptance::Outcome;
use crate::landscape::GridAxis;
use crate::pose::Dof;
use std::f64::consts::PI;

/// A grid over [−1, 1]ⁿ.
fn grid(cells: &[usize]) -> Grid {
    let axis = |(dof, cells): (Dof, &usize)| GridAxis { dof, lo: -1.0, hi: 1.0, cells: *cells };
    Grid { axes: Dof::ALL.into_iter().zip(cells).map(axis).collect() }
}

fn distance(pose: &PoseError, centre: f64) -> f64 {
    pose.to_array().iter().map(|v| (v - centre).powi(2)).sum::<f64>().sqrt()
}

/// A ball around zero, by its radius, its share of the box, and the answer of a grid.
struct Case {
    name: &'static str,
    grid: Grid,
    radius: f64,
    fraction: f64,
    outcomes: Vec<Outcome>,
}

impl Case {
    /// `guess` is what the grid method believes of a cell's centre.
    fn new(
        name: &'static str,
        cells: &[usize],
        radius: f64,
        guess: impl Fn(usize, &PoseError) -> bool,
    ) -> Self {
        let n = cells.len();
        let ball = [2.0, PI, 4.0 / 3.0 * PI, PI * PI / 2.0, 8.0 / 15.0 * PI * PI][n - 1];
        let grid = grid(cells);
        let outcome = |i| if guess(i, &grid.pose(i)) { Outcome::Aligned } else { Outcome::Jammed };
        let outcomes = (0..grid.len()).map(outcome).collect();
        Self { name, radius, fraction: ball * (radius / 2.0).powi(n as i32), outcomes, grid }
    }

    fn estimate(&self, stop: Stop, seed: u64) -> Corrected {
        let by = ByNeighbours::new(&self.outcomes, self.grid.shape());
        estimate(&self.grid, &by, &Settings { seed, stop }, &Exec::new(), |poses, _| {
            let inside = |p: &PoseError| distance(p, 0.0) < self.radius;
            Ok(poses.iter().map(|p| if inside(p) { Outcome::Aligned } else { Outcome::Jammed }).collect())
        })
        .unwrap()
    }
}

/// Right, shifted, fooled in scattered cells, and useless grids.
fn cases() -> Vec<Case> {
    let inside = |r: f64| move |_: usize, p: &PoseError| distance(p, 0.0) < r;
    vec![
        Case::new("disc, right", &[20, 20], 0.8, inside(0.8)),
        Case::new("disc, shifted", &[20, 20], 0.8, |_, p| distance(p, 0.1) < 0.8),
        Case::new("disc, scattered", &[30, 30], 0.5, |i, p| (distance(p, 0.0) < 0.5) != (i % 37 == 0)),
        Case::new("small disc, unseen", &[20, 20], 0.2, |_, _| false),
        Case::new("ball, too large", &[10, 10, 10], 0.7, inside(0.9)),
        Case::new("5-ball, coarse", &[5, 5, 5, 5, 5], 0.9, inside(0.9)),
        Case::new("5-ball, much too small", &[5, 5, 5, 5, 5], 1.0, inside(0.45)),
    ]
}

/// Share of intervals that hold the truth; bias in standard errors of the mean; mean half-width as a share of the
/// Sum; mean number of descents, and of plain ones that would tell as much.
fn repeated(case: &Case, stop: Stop, repeats: u64) -> [f64; 5] {
    let found: Vec<Corrected> = (0..repeats).into_par_iter().map(|seed| case.estimate(stop, seed)).collect();
    let n = repeats as f64;
    let mean = |f: &dyn Fn(&Corrected) -> f64| found.iter().map(f).sum::<f64>() / n;
    let measure = case.grid.measure();
    let held = mean(&|c| {
        let [lo, hi] = c.ci95.map(|v| v / measure);
        f64::from(u8::from(lo <= case.fraction && case.fraction <= hi))
    });
    let average = mean(&|c| c.fraction);
    let spread = (mean(&|c| (c.fraction - average).powi(2)) / (n - 1.0)).sqrt();
    let width = mean(&|c| (c.ci95[1] - c.ci95[0]) / 2.0 / c.sum.max(1e-9));
    let plain = case.fraction * (1.0 - case.fraction) / (spread * spread * n);
    [held, (average - case.fraction) / spread, width, mean(&|c| c.descents as f64), plain]
}

#[test]
fn explore() {
    for case in cases() {
        for stop in [Stop::Samples(200), Stop::Samples(1000), Stop::Tolerance(0.1)] {
            let [held, bias, width, descents, plain] = repeated(&case, stop, 1000);
            println!(
                "{:24} {stop:?}: held {held:.4} bias {bias:+.1} se, width {width:.4}, {descents:.0} descents worth {plain:.0} gain {:.2}",
                case.name,
                plain / descents
            );
        }
    }
}
