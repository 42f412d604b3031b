//! Test of measured errors for normality: a fit, and the evidence against it.
//!
//! ```text
//!   each error    Anderson and Darling   A² = −n − (1/n)·Σ (2i − 1)·(ln Φ(yᵢ) + ln(1 − Φ(yₙ₊₁₋ᵢ)))    y standardised and sorted
//!                 with mean and σ from the same rows: A²·(1 + 0.75/n + 2.25/n²), Stephens' case 3
//!   all together  Mardia's kurtosis      b = mean of d⁴, d Mahalanobis' distance: near p(p + 2), variance 8·p(p + 2)/n
//!   sequence      neighbouring rows      their correlation r: near 0, variance 1/n, if rows are independent
//! ```
//!
//! Sources: M. A. Stephens, J. Am. Stat. Assoc. 69 (1974) 730; p-values of D'Agostino and Stephens,
//! Goodness-of-Fit Techniques (1986), table 4.9. K. V. Mardia, Biometrika 57 (1970) 519. The fit is rejected
//! if the smallest of all p-values, times their number, is below 0.05.
//!
//! Not promised: that a fit which is not rejected is correct: a few rows reject no fit.

use super::{AxisFit, NormalFit};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::covariance::{cholesky, solve_lower};
use catchment_core::poses::{Moments, Spread};
use std::f64::consts::SQRT_2;

/// Fewest rows that a test is made for.
pub(super) const FEWEST: usize = 8;
/// Chance that a normal spread is rejected.
const LEVEL: f64 = 0.05;

/// Tests the rows of a measured spread; `None` for other spreads, or too few rows.
pub(super) fn fit(spread: &Spread) -> Option<NormalFit> {
    let Spread::Measured { poses, .. } = spread else { return None };
    if poses.len() < FEWEST {
        return None;
    }
    let moments = spread.moments();
    let varying: Vec<Dof> =
        Dof::ALL.into_iter().filter(|dof| moments.sigma.to_array()[dof.index()] > 0.0).collect();
    let axes: Vec<AxisFit> = varying.iter().map(|axis| of_axis(*axis, poses, &moments)).collect();
    let kurtosis = kurtosis(poses, &moments, &varying);
    let tests = axes.len() + usize::from(kurtosis.is_some());
    let values = axes.iter().map(|axis| axis.p_value).chain(kurtosis.map(|[_, p]| p));
    let p_value = (values.fold(1.0, f64::min) * tests as f64).min(1.0);
    // Two-sided, of as many axes.
    let level = LEVEL / axes.len().max(1) as f64;
    let trending = axes.iter().filter(|axis| both_tails(axis.lag * (poses.len() as f64).sqrt()) < level);
    Some(NormalFit {
        rejected: p_value < LEVEL,
        p_value,
        kurtosis: kurtosis.map(|[b, _]| b),
        kurtosis_p_value: kurtosis.map(|[_, p]| p),
        trending: trending.map(|axis| axis.axis).collect(),
        axes,
        probability: None,
        ci95: None,
    })
}

fn of_axis(axis: Dof, poses: &[PoseError], moments: &Moments) -> AxisFit {
    let k = axis.index();
    let (mean, sigma) = (moments.mean.to_array()[k], moments.sigma.to_array()[k]);
    let mut y: Vec<f64> = poses.iter().map(|pose| (pose.to_array()[k] - mean) / sigma).collect();
    let lag = y.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / y.len() as f64;
    y.sort_by(f64::total_cmp);
    let statistic = anderson_darling(&y);
    AxisFit { axis, anderson_darling: statistic, p_value: anderson_darling_p(statistic), lag }
}

/// The statistic of standardised values in ascending order, corrected for their number.
fn anderson_darling(y: &[f64]) -> f64 {
    /// Smallest probability of a tail: its logarithm is finite.
    const LEAST: f64 = 1e-300;
    let n = y.len() as f64;
    let below = |v: f64| (0.5 * libm::erfc(-v / SQRT_2)).max(LEAST);
    let terms = y.iter().zip(y.iter().rev()).enumerate();
    let sum: f64 = terms
        .map(|(i, (low, high))| (2 * i + 1) as f64 * (libm::log(below(*low)) + libm::log(below(-high))))
        .sum();
    (-n - sum / n) * (1.0 + 0.75 / n + 2.25 / (n * n))
}

/// Probability of this or a larger statistic for a normal spread.
fn anderson_darling_p(a: f64) -> f64 {
    /// Beyond it the formula turns back.
    const LARGEST: f64 = 13.0;
    let a = a.min(LARGEST);
    let p = if a < 0.2 {
        1.0 - libm::exp(-13.436 + 101.14 * a - 223.73 * a * a)
    } else if a < 0.34 {
        1.0 - libm::exp(-8.318 + 42.796 * a - 59.938 * a * a)
    } else if a < 0.6 {
        libm::exp(0.9177 - 4.279 * a - 1.38 * a * a)
    } else {
        libm::exp(1.2937 - 5.709 * a + 0.0186 * a * a)
    };
    p.clamp(0.0, 1.0)
}

/// Mardia's kurtosis and its p-value; `None` if errors are linearly dependent.
fn kurtosis(poses: &[PoseError], moments: &Moments, varying: &[Dof]) -> Option<[f64; 2]> {
    /// Share of its standard deviation below which an error depends on the others: rounding of the correlation.
    const OWN: f64 = 1e-6;
    let factor = cholesky(&moments.correlation).ok()?;
    if varying.is_empty() || varying.iter().any(|dof| factor[dof.index()][dof.index()] < OWN) {
        return None;
    }
    let (mean, sigma) = (moments.mean.to_array(), moments.sigma.to_array());
    let n = poses.len() as f64;
    // The estimate that divides by n, which the test is made for.
    let biased = (n - 1.0) / n;
    let fourth = |pose: &PoseError| {
        let pose = pose.to_array();
        let y = std::array::from_fn(|k| if sigma[k] > 0.0 { (pose[k] - mean[k]) / sigma[k] } else { 0.0 });
        let z = solve_lower(&factor, &y);
        let square = varying.iter().map(|dof| z[dof.index()] * z[dof.index()]).sum::<f64>() / biased;
        square * square
    };
    let b = poses.iter().map(fourth).sum::<f64>() / n;
    let p = varying.len() as f64;
    let expected = p * (p + 2.0) * (n - 1.0) / (n + 1.0);
    let z = (b - expected) / (8.0 * p * (p + 2.0) / n).sqrt();
    Some([b, both_tails(z)])
}

/// Chance of a standard normal number to be as far from 0 or farther.
fn both_tails(z: f64) -> f64 {
    libm::erfc(z.abs() / SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::super::source::{SAME, Source};
    use super::*;

    fn rows(count: u64, seed: u64, shape: impl Fn(f64) -> f64) -> Spread {
        let normal = Spread::normal(PoseError { x: 1.0, yaw: 0.5, ..PoseError::default() });
        let source = Source::of(&normal, 0, seed);
        let pose = |k: u64| {
            let drawn = source.pose(&source.standard(k), &SAME);
            PoseError { x: shape(drawn.x), ..drawn }
        };
        Spread::Measured { source: String::new(), poses: (0..count).map(pose).collect() }
    }

    /// Stephens' percentage points of case 3: 10, 5, 2.5 and 1 %.
    #[test]
    fn p_values_are_those_of_the_published_points() {
        for (a, p) in [(0.631, 0.1), (0.752, 0.05), (0.873, 0.025), (1.035, 0.01)] {
            assert!((anderson_darling_p(a) / p - 1.0).abs() < 0.03, "{a}: {}", anderson_darling_p(a));
        }
    }

    /// About one in twenty of this many normal samples may be rejected: 5 ± 5 standard errors of 1.5 % of
    /// 200.
    #[test]
    fn normal_rows_are_rejected_as_seldom_as_promised() {
        let rejected = (0..200).filter(|seed| fit(&rows(100, *seed, |x| x)).unwrap().rejected).count();
        assert!(rejected <= 25, "{rejected} of 200");
    }

    #[test]
    fn other_spreads_are_rejected() {
        let two = fit(&rows(200, 1, |x| x.signum() + 0.2 * x)).unwrap();
        assert!(two.rejected && two.axes[0].p_value < 1e-6 && two.axes[1].p_value > 0.01, "{two:?}");
        let heavy = fit(&rows(500, 2, |x| x * x * x)).unwrap();
        assert!(heavy.rejected && heavy.kurtosis.unwrap() > 8.0);
        assert!(fit(&rows(7, 1, |x| x)).is_none());
    }

    #[test]
    fn rows_that_drift_are_noticed() {
        let drift = |k: u64| PoseError { x: 0.01 * (k as f64 / 10.0).sin(), ..PoseError::default() };
        let spread = Spread::Measured { source: String::new(), poses: (0..200).map(drift).collect() };
        assert_eq!(fit(&spread).unwrap().trending, [Dof::X]);
        assert_eq!(fit(&rows(200, 3, |x| x)).unwrap().trending, []);
    }
}
