//! Sum: the measure of the accepted set, in Dᵃ·radᵇ for a lengths and b angles; and its share of the error box.
//!
//! ```text
//!   Sum = (accepted cells) · (measure of a cell)
//! ```
//!
//! On a grid, [`bracket()`] encloses it: the lower bound counts the accepted cells without a rejected
//! neighbour, the upper bound these and every cell with an accepted neighbour. For a *convex* set larger than
//! a cell the true measure lies in the bracket; for other sets it does if the grid missed nothing thinner
//! than a cell. It bounds the error of the resolution. It is not a confidence interval, and it does not
//! include errors of the method that decided the cells.
//!
//! For poses sampled uniformly in the error box, [`Sum::ci95`] is Wilson's 95 % interval, widened upwards by
//! the undecided poses.

use super::mask::Mask;
use super::{MeritError, grid_of};
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::design::Alignment;
use crate::exec::Exec;
use crate::method::correction;
use crate::pose::Dof;

/// Measure of the accepted set.
#[derive(Debug, Clone, PartialEq)]
pub struct Sum {
    /// The measure, in [`Sum::unit`].
    pub sum: f64,
    /// Share of the error box, in [0, 1].
    pub fraction: f64,
    /// Number of lengths among the error axes: the a of Dᵃ·radᵇ.
    pub lengths: usize,
    /// Number of angles among the error axes: the b of Dᵃ·radᵇ.
    pub angles: usize,
    /// Cells or poses tried.
    pub tried: usize,
    /// Number of poses or cells with each outcome, in the order of `Outcome::ALL`; undecided ones are not in
    /// `sum`.
    pub counts: [usize; 4],
    /// For sampled poses: the 95 % interval of `sum`.
    pub ci95: Option<[f64; 2]>,
}

impl Sum {
    /// Measures the accepted set. Listed poses are taken as drawn uniformly from the error box of `alignment`.
    pub fn of(acceptance: &Acceptance, alignment: &Alignment) -> Self {
        let counts = acceptance.counts();
        let tried = acceptance.outcomes.len();
        let share = |n: usize| if tried == 0 { 0.0 } else { n as f64 / tried as f64 };
        let (dofs, measure): (Vec<Dof>, f64) = match &acceptance.domain {
            Domain::Grid(grid) => (grid.axes.iter().map(|a| a.dof).collect(), grid.measure()),
            Domain::Poses(_) => (
                alignment.free.iter().collect(),
                alignment.free.iter().map(|d| 2.0 * alignment.half_range(d)).product(),
            ),
        };
        let angles = dofs.iter().filter(|d| d.is_rotation()).count();
        let [aligned, _, _, undecided] = counts;
        let ci95 = match acceptance.domain {
            Domain::Grid(_) => None,
            Domain::Poses(_) => {
                let [lo, _] = wilson95(aligned, tried);
                let [_, hi] = wilson95(aligned + undecided, tried);
                Some([lo * measure, hi * measure])
            }
        };
        let fraction = share(aligned);
        Self { sum: fraction * measure, fraction, lengths: dofs.len() - angles, angles, tried, counts, ci95 }
    }

    /// The unit of the measure, like `D²·rad³`; `1` without axes.
    pub fn unit(&self) -> String {
        let power = |base: &str, n: usize| match n {
            0 => None,
            1 => Some(base.to_owned()),
            n => Some(format!("{base}{}", ["⁰", "¹", "²", "³", "⁴", "⁵"][n.min(5)])),
        };
        let factors: Vec<String> =
            [power("D", self.lengths), power("rad", self.angles)].into_iter().flatten().collect();
        if factors.is_empty() { "1".to_owned() } else { factors.join("·") }
    }

    /// Share of each outcome, in the order of `Outcome::ALL`.
    pub fn shares(&self) -> [f64; 4] {
        self.counts.map(|n| if self.tried == 0 { 0.0 } else { n as f64 / self.tried as f64 })
    }
}

/// Measure of the accepted cells of a grid without a rejected neighbour, and of those that are accepted or have an
/// accepted neighbour, in [`Sum::unit`].
///
/// # Errors
/// If the outcomes are of listed poses, the cells do not fit into memory as bits, or it is cancelled.
pub fn bracket(acceptance: &Acceptance, exec: &Exec) -> Result<[f64; 2], MeritError> {
    let grid = grid_of(acceptance)?;
    // Not in the inner part are the rejected cells and their neighbours.
    let count_grown = |accepted: bool| -> Result<usize, MeritError> {
        let wanted = |outcome| (outcome == Outcome::Aligned) == accepted;
        exec.install(|| {
            let mut mask = Mask::of(&grid.shape(), &acceptance.outcomes, wanted, exec)?;
            mask.grow(exec)?;
            Ok(mask.count(exec))
        })
    };
    let cells = acceptance.outcomes.len();
    let share = |count: usize| if cells == 0 { 0.0 } else { count as f64 / cells as f64 };
    Ok([cells - count_grown(false)?, count_grown(true)?].map(|count| share(count) * grid.measure()))
}

/// Wilson's 95 % interval of a probability of which `hits` of `trials` were seen; [0, 1] without trials.
///
/// See [`correction::wilson95`].
pub fn wilson95(hits: usize, trials: usize) -> [f64; 2] {
    correction::wilson95(hits as f64 / trials.max(1) as f64, trials as f64)
}

#[cfg(test)]
mod tests {
    use super::super::brute::inner_and_outer;
    use super::super::testing::*;
    use super::*;
    use crate::pose::{DofSet, Mount, PoseError};
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn alignment() -> Alignment {
        Alignment::new(DofSet::ALL, Mount::X)
    }

    /// Volume of the n-ball lies in the bracket, and the estimate is near it. A cell is counted by its centre, so the
    /// error is that of a lattice-point count: it averages out over the surface, far below the bracket.
    #[test]
    fn balls_have_their_closed_form_volume_within_the_bracket() {
        let (r, volumes) = (0.8f64, [2.0, PI, 4.0 / 3.0 * PI, PI * PI / 2.0, 8.0 / 15.0 * PI * PI]);
        for (n, unit_ball) in (1..=5).zip(volumes) {
            let cells = [200, 100, 60, 28, 16][n - 1];
            let averaged = [0.01, 0.005, 0.005, 0.02, 0.05][n - 1];
            let ball = ball(&grid(&vec![cells; n], &vec![1.0; n]), r);
            let sum = Sum::of(&ball, &alignment());
            let exact = unit_ball * r.powf(n as f64);
            let [lo, hi] = bracket(&ball, &Exec::new()).unwrap();
            assert!(lo < exact && exact < hi, "n = {n}: {lo} < {exact} < {hi}");
            assert!((sum.sum / exact - 1.0).abs() < averaged, "n = {n}: {} for {exact}", sum.sum);
            assert!((sum.fraction - sum.sum / 2f64.powf(n as f64)).abs() < 1e-12);
        }
    }

    proptest! {
        #[test]
        fn the_bracket_is_that_of_the_definition(
            shape in proptest::collection::vec(1usize..6, 1..5),
            seed in proptest::collection::vec(prop::bool::weighted(0.8), 625),
        ) {
            let g = grid(&shape, &vec![1.0; shape.len()]);
            let mut acceptance = accept(&g, |_| true);
            for (outcome, keep) in acceptance.outcomes.iter_mut().zip(&seed) {
                if !keep { *outcome = Outcome::Missed; }
            }
            let accepted: Vec<bool> = acceptance.accepted().collect();
            let defined = inner_and_outer(&g, &accepted).map(|n| n as f64 / g.len() as f64 * g.measure());
            prop_assert_eq!(bracket(&acceptance, &Exec::new()).unwrap(), defined);
        }
    }

    #[test]
    fn units_name_lengths_and_angles() {
        let unit = |n: usize| Sum::of(&ball(&grid(&vec![2; n], &vec![1.0; n]), 1.0), &alignment()).unit();
        assert_eq!([1, 2, 3, 5].map(unit), ["D", "D²", "D²·rad", "D²·rad³"]);
    }

    /// Newcombe (1998), table I: 81 of 263 → 0.2553–0.3662; 0 of 20 → 0–0.1611; 15 of 148 → 0.0624–0.1605.
    #[test]
    fn wilson_intervals_as_published() {
        for (hits, trials, lo, hi) in
            [(81, 263, 0.2553, 0.3662), (0, 20, 0.0, 0.1611), (15, 148, 0.0624, 0.1605)]
        {
            let [a, b] = wilson95(hits, trials);
            assert!((a - lo).abs() < 6e-5 && (b - hi).abs() < 6e-5, "{hits}/{trials}: {a} {b}");
        }
    }

    #[test]
    fn undecided_poses_widen_the_interval_of_a_sample_upwards_only() {
        let sample = |outcomes: Vec<Outcome>| Acceptance {
            method: "sample",
            domain: Domain::Poses(vec![PoseError::default(); outcomes.len()]),
            outcomes,
            warnings: Vec::new(),
        };
        let with = |third: Outcome| {
            let mut outcomes = vec![Outcome::Aligned; 50];
            outcomes.extend(vec![Outcome::Jammed; 40]);
            outcomes.extend(vec![third; 10]);
            Sum::of(&sample(outcomes), &alignment())
        };
        let (decided, open) = (with(Outcome::Jammed), with(Outcome::Undecided));
        let measure = 4.0 * PI.powi(3);
        assert!((decided.sum - 0.5 * measure).abs() < 1e-9);
        assert_eq!(decided.ci95.unwrap()[0], open.ci95.unwrap()[0]);
        assert!(open.ci95.unwrap()[1] > decided.ci95.unwrap()[1]);
        assert_eq!(open.sum, decided.sum);
    }
}
