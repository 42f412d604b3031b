//! Success probability: the probability that a pose error of a given distribution lies in the accepted set.
//!
//! ```text
//!   P = Σ over accepted cells of  P(error in the cell)
//!
//!   independent errors:  P(error in the cell) = Πᵢ (F((bᵢ−μᵢ)/σᵢ) − F((aᵢ−μᵢ)/σᵢ)),  exact for each cell [aᵢ, bᵢ]
//!   correlated errors:   counted in a seeded random sample, with Wilson's interval
//! ```
//!
//! Errors outside the error box count as failures, and their share is reported. The grid resolution adds an
//! uncertainty of its own: [`SuccessProbability::bracket`] counts the border cells as failures, and as successes
//! (including undecided cells). A distribution with errors along axes that were not sampled is rejected.

pub use crate::poses::Distribution;

use super::mask::{Mask, bits};
use super::sum::wilson95;
use super::{MeritError, advance, axis_number, grid_of};
use crate::acceptance::{Acceptance, Outcome};
use crate::exec::{Cancelled, Exec};
use crate::landscape::{Grid, GridAxis};
use crate::pose::{Dof, PoseError};
use crate::poses::covariance::cholesky;
use serde::{Deserialize, Serialize};
use std::f64::consts::{SQRT_2, TAU};

/// Success probability for a distribution of errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SuccessProbability {
    /// Distribution of the errors.
    pub distribution: Distribution,
    /// Probability that an error is accepted, in [0, 1]; errors outside the error box count as failures.
    pub probability: f64,
    /// The probability with border cells of the accepted set counted as failures, and as successes.
    pub bracket: [f64; 2],
    /// Wilson's 95 % interval of `probability`; null for an exact sum over cells.
    pub ci95: Option<[f64; 2]>,
    /// Probability of an error outside the error box.
    pub outside: f64,
}

/// The success probability of an acceptance over a grid.
///
/// # Errors
/// If the outcomes are of listed poses, if the distribution has errors along axes that were not sampled, if its
/// numbers make no distribution, if the cells do not fit into memory as bits, or if it is cancelled.
pub fn success(
    acceptance: &Acceptance,
    distribution: &Distribution,
    exec: &Exec,
) -> Result<SuccessProbability, MeritError> {
    let grid = grid_of(acceptance)?;
    let masks = Masks::of(acceptance, grid, exec)?;
    match distribution {
        Distribution::Normal { mean, sigma } => {
            let cdf = |z: f64| 0.5 * (1.0 + libm::erf(z / SQRT_2));
            let weights = cell_weights(grid, mean, sigma, "a standard deviation", cdf)?;
            Ok(masks.integrate(distribution, &weights, exec)?)
        }
        Distribution::Uniform { mean, half_width } => {
            let cdf = |z: f64| (0.5 * (z + 1.0)).clamp(0.0, 1.0);
            let weights = cell_weights(grid, mean, half_width, "a half-width", cdf)?;
            Ok(masks.integrate(distribution, &weights, exec)?)
        }
        Distribution::Correlated { mean, covariance, samples, seed } => {
            for (dof, row) in Dof::ALL.into_iter().zip(covariance) {
                if mean.to_array()[dof.index()] != 0.0 || row.iter().any(|c| *c != 0.0) {
                    axis_number(grid, dof)?;
                }
            }
            let factor = cholesky(covariance).map_err(|row| MeritError::NotACovariance { row: row + 1 })?;
            let mut random = Random(*seed);
            let draw = || {
                let z = random.normals();
                let mut error = mean.to_array();
                for (value, row) in error.iter_mut().zip(&factor) {
                    *value += row.iter().zip(&z).map(|(l, z)| l * z).sum::<f64>();
                }
                error
            };
            Ok(masks.sample(distribution, grid, draw, *samples, exec)?)
        }
    }
}

/// The cells that count as success: as decided, at least, at most.
struct Masks {
    decided: Mask,
    inner: Mask,
    outer: Mask,
}

impl Masks {
    fn of(acceptance: &Acceptance, grid: &Grid, exec: &Exec) -> Result<Self, MeritError> {
        let mask = |wanted: fn(Outcome) -> bool| Mask::of(&grid.shape(), &acceptance.outcomes, wanted, exec);
        let decided = mask(|o| o == Outcome::Aligned)?;
        let mut inner = decided.clone();
        inner.invert();
        inner.grow(exec)?;
        inner.invert();
        let mut outer = mask(|o| matches!(o, Outcome::Aligned | Outcome::Undecided))?;
        outer.grow(exec)?;
        Ok(Self { decided, inner, outer })
    }

    /// By the exact sum over cells.
    fn integrate(
        &self,
        distribution: &Distribution,
        weights: &[Vec<f64>],
        exec: &Exec,
    ) -> Result<SuccessProbability, Cancelled> {
        let in_box: f64 = weights.iter().map(|w| w.iter().sum::<f64>()).product();
        Ok(SuccessProbability {
            distribution: distribution.clone(),
            probability: weigh(&self.decided, weights, exec)?,
            bracket: [weigh(&self.inner, weights, exec)?, weigh(&self.outer, weights, exec)?],
            ci95: None,
            outside: (1.0 - in_box).max(0.0),
        })
    }

    /// By drawn errors.
    fn sample(
        &self,
        distribution: &Distribution,
        grid: &Grid,
        mut draw: impl FnMut() -> [f64; 5],
        samples: u32,
        exec: &Exec,
    ) -> Result<SuccessProbability, Cancelled> {
        let [mut decided, mut inner, mut outer, mut outside] = [0usize; 4];
        for number in 0..samples {
            if number.is_multiple_of(SAMPLES_BETWEEN_CHECKS) {
                exec.check()?;
            }
            let error = draw();
            let cell: Option<Vec<usize>> =
                grid.axes.iter().map(|a| a.cell_of(error[a.dof.index()])).collect();
            match cell.map(|c| grid.index(&c)) {
                Some(index) => {
                    decided += usize::from(self.decided.holds(index));
                    inner += usize::from(self.inner.holds(index));
                    outer += usize::from(self.outer.holds(index));
                }
                None => outside += 1,
            }
        }
        let trials = samples as usize;
        let share = |n: usize| if trials == 0 { 0.0 } else { n as f64 / trials as f64 };
        Ok(SuccessProbability {
            distribution: distribution.clone(),
            probability: share(decided),
            bracket: [share(inner), share(outer)],
            ci95: Some(wilson95(decided, trials)),
            outside: share(outside),
        })
    }
}

/// Number of samples between two checks for cancellation: well below a millisecond.
const SAMPLES_BETWEEN_CHECKS: u32 = 4096;

/// Sums the product weights of the marked cells: rows first, then slabs of the last axis, then their sums in order, so
/// that rounding does not depend on threads.
fn weigh(mask: &Mask, weights: &[Vec<f64>], exec: &Exec) -> Result<f64, Cancelled> {
    // A grid without axes has a single cell of probability 1.
    let one = vec![1.0];
    let (first, others) = weights.split_first().map_or((&one, weights), |(first, others)| (first, others));
    let (inner, slabs) = others.split_last().map_or((others, &one), |(last, inner)| (inner, last));
    let shape: Vec<usize> = inner.iter().map(Vec::len).collect();
    let rows: usize = shape.iter().product();
    let whole: f64 = first.iter().sum();
    let row = |words: &[u64]| match words.iter().map(|word| word.count_ones() as usize).sum() {
        0 => 0.0,
        marked if marked == first.len() => whole,
        _ => words
            .iter()
            .zip(first.chunks(u64::BITS as usize))
            .flat_map(|(word, weights)| bits(*word).map(|bit| weights[bit]))
            .sum(),
    };
    let in_slab = |number: usize| {
        let mut cell = vec![0; shape.len()];
        let mut sum = 0.0;
        for words in mask.rows().skip(number * rows).take(rows) {
            sum += row(words) * inner.iter().zip(&cell).map(|(w, k)| w[*k]).product::<f64>();
            advance(&mut cell, &shape);
        }
        sum * slabs[number]
    };
    Ok(exec.map(slabs.len(), in_slab)?.iter().sum())
}

/// Probability of each cell along each axis, for independent errors with the standard distribution function `cdf`.
fn cell_weights(
    grid: &Grid,
    mean: &PoseError,
    scale: &PoseError,
    what: &'static str,
    cdf: impl Fn(f64) -> f64,
) -> Result<Vec<Vec<f64>>, MeritError> {
    for (dof, (mean, scale)) in Dof::ALL.into_iter().zip(mean.to_array().into_iter().zip(scale.to_array())) {
        if !scale.is_finite() || scale < 0.0 {
            return Err(MeritError::Negative { what, value: scale });
        }
        if mean != 0.0 || scale != 0.0 {
            axis_number(grid, dof)?;
        }
    }
    let along = |axis: &GridAxis| {
        let (mean, scale) = (mean.to_array()[axis.dof.index()], scale.to_array()[axis.dof.index()]);
        // A constant error: on a border between two cells, each cell receives half the probability.
        let below = |q: f64| match (scale == 0.0, (q - mean) / axis.step()) {
            (false, _) => cdf((q - mean) / scale),
            (true, d) if d.abs() < 1e-9 => 0.5,
            (true, d) => f64::from(u8::from(d > 0.0)),
        };
        let borders: Vec<f64> = (0..=axis.cells).map(|k| below(axis.lo + k as f64 * axis.step())).collect();
        borders.windows(2).map(|w| w[1] - w[0]).collect()
    };
    Ok(grid.axes.iter().map(along).collect())
}

/// `SplitMix64` (Steele, Lea, Flood, OOPSLA 2014): small, fast, the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in (0, 1].
    fn unit(&mut self) -> f64 {
        ((self.next() >> 11) + 1) as f64 / (1u64 << 53) as f64
    }

    /// Five independent standard normal numbers (Box and Muller, 1958).
    fn normals(&mut self) -> [f64; 5] {
        let mut z = [0.0; 5];
        for pair in z.chunks_mut(2) {
            let radius = (-2.0 * libm::log(self.unit())).sqrt();
            let angle = TAU * self.unit();
            for (value, direction) in pair.iter_mut().zip([libm::cos(angle), libm::sin(angle)]) {
                *value = radius * direction;
            }
        }
        z
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::*;
    use super::*;

    const SIGMA: PoseError = PoseError { x: 0.3, y: 0.2, roll: 0.5, pitch: 0.0, yaw: 0.0 };
    const ZERO: PoseError = PoseError { x: 0.0, y: 0.0, roll: 0.0, pitch: 0.0, yaw: 0.0 };

    fn success(
        acceptance: &Acceptance,
        distribution: &Distribution,
    ) -> Result<SuccessProbability, MeritError> {
        super::success(acceptance, distribution, &Exec::new())
    }

    fn boxed() -> Acceptance {
        // Borders on cell borders: the union of the accepted cells is the box itself.
        let g = grid(&[20, 40, 30], &[1.0, 1.0, 1.5]);
        accept(&g, |e| e[0].abs() < 0.3 && e[1].abs() < 0.4 && e[2].abs() < 0.9)
    }

    /// P(|e| < a) for a normal error: erf(a / (σ√2)).
    fn within(a: f64, sigma: f64) -> f64 {
        libm::erf(a / (sigma * SQRT_2))
    }

    #[test]
    fn a_box_succeeds_with_the_product_of_error_functions() {
        let result = success(&boxed(), &Distribution::Normal { mean: ZERO, sigma: SIGMA }).unwrap();
        let exact = within(0.3, 0.3) * within(0.4, 0.2) * within(0.9, 0.5);
        let inside = within(1.0, 0.3) * within(1.0, 0.2) * within(1.5, 0.5);
        assert!((result.probability - exact).abs() < 1e-13, "{} for {exact}", result.probability);
        assert!((result.outside - (1.0 - inside)).abs() < 1e-13);
        assert!(result.bracket[0] < exact && exact < result.bracket[1]);
        assert_eq!(result.ci95, None);
    }

    #[test]
    fn uniform_errors_count_overlapping_volume() {
        let half_width = PoseError { x: 0.6, y: 2.0, roll: 0.45, ..ZERO };
        let mean = PoseError { x: 0.3, ..ZERO };
        let result = success(&boxed(), &Distribution::Uniform { mean, half_width }).unwrap();
        // x: [−0.3, 0.9] ∩ [−0.3, 0.3] is half; y: 0.8 of 4; roll: all. Outside: half of y.
        assert!((result.probability - 0.5 * 0.2).abs() < 1e-13, "{}", result.probability);
        assert!((result.outside - 0.5).abs() < 1e-13);
    }

    #[test]
    fn an_error_without_variance_is_a_point() {
        let sigma = PoseError { x: 0.3, ..ZERO };
        let result = success(&boxed(), &Distribution::Normal { mean: ZERO, sigma }).unwrap();
        assert!((result.probability - within(0.3, 0.3)).abs() < 1e-13, "{}", result.probability);
    }

    /// The sample agrees with the exact sum to four standard errors (one in 16 000 seeds would fail; this
    /// seed does not), and a rotated covariance with the closed form of the disc.
    #[test]
    fn samples_agree_with_exact_sums() {
        let mut covariance = [[0.0; 5]; 5];
        for (i, s) in SIGMA.to_array().into_iter().enumerate() {
            covariance[i][i] = s * s;
        }
        let samples = 100_000;
        let sampled = Distribution::Correlated { mean: ZERO, covariance, samples, seed: 1 };
        let exact = success(&boxed(), &Distribution::Normal { mean: ZERO, sigma: SIGMA }).unwrap();
        let result = success(&boxed(), &sampled).unwrap();
        let standard_error = (exact.probability * (1.0 - exact.probability) / f64::from(samples)).sqrt();
        assert!((result.probability - exact.probability).abs() < 4.0 * standard_error);
        assert!((result.outside - exact.outside).abs() < 0.002);
        let [lo, hi] = result.ci95.unwrap();
        assert!(lo < result.probability && result.probability < hi);
        assert_eq!(success(&boxed(), &sampled).unwrap(), result);
    }

    #[test]
    fn fully_correlated_errors_stay_on_their_line() {
        // x = y: the pair lies in the strip |x − y| < 0.1 always, and in |x + y| < 0.3 when |x| < 0.15.
        let g = grid(&[200, 200], &[1.0, 1.0]);
        let mut covariance = [[0.0; 5]; 5];
        for row in &mut covariance[..2] {
            row[..2].fill(0.04);
        }
        let line = Distribution::Correlated { mean: ZERO, covariance, samples: 20_000, seed: 7 };
        let strip = success(&accept(&g, |e| (e[0] - e[1]).abs() < 0.1), &line).unwrap();
        assert!((strip.probability + strip.outside - 1.0).abs() < 1e-12);
        let near = success(&accept(&g, |e| (e[0] + e[1]).abs() < 0.3), &line).unwrap();
        // Four standard errors of 20 000 trials are 0.014; the cells add at most half a cell (0.005) of x.
        assert!((near.probability - within(0.15, 0.2)).abs() < 0.014 + 0.02, "{}", near.probability);
    }

    #[test]
    fn invalid_distributions_are_refused() {
        let refused = |d: Distribution| success(&boxed(), &d).unwrap_err();
        let sigma = PoseError { x: -0.1, ..ZERO };
        assert!(matches!(refused(Distribution::Normal { mean: ZERO, sigma }), MeritError::Negative { .. }));
        let sigma = PoseError { yaw: 0.1, ..ZERO };
        let error = refused(Distribution::Normal { mean: ZERO, sigma });
        assert_eq!(error.to_string(), "yaw is not an axis of the grid; its axes are x, y, roll");
        let mut covariance = [[0.0; 5]; 5];
        covariance[0][..2].copy_from_slice(&[1.0, 2.0]);
        covariance[1][..2].copy_from_slice(&[2.0, 1.0]);
        let correlated = Distribution::Correlated { mean: ZERO, covariance, samples: 1, seed: 0 };
        assert_eq!(refused(correlated), MeritError::NotACovariance { row: 2 });
    }
}
