//! Statistics of counted trials.
//!
//! ```text
//!   Clopper and Pearson   [p: P(X ≥ k | p) = 2.5 %,  p: P(X ≤ k | p) = 2.5 %]      X binomial
//!   Poisson's binomial    P(this many or more of these fail), each with its own probability
//!   chance(m)             that a normal error moves a pose m accuracies across a flat border on either side of it: 2·Φ(−m), at most ½
//! ```
//!
//! Sources: C. J. Clopper and E. S. Pearson, Biometrika 26 (1934) 404; L. Le Cam, Pac. J. Math. 10 (1960) 1181 for the sum of unlike trials.

use std::f64::consts::SQRT_2;

/// Clopper and Pearson's interval of a probability that was seen `successes` times in `trials`, wrong at most by a chance of `level` in all;
/// [0, 1] without trials.
pub fn clopper_pearson(successes: usize, trials: usize, level: f64) -> [f64; 2] {
    /// Halvings of [0, 1]: all that double precision has.
    const HALVINGS: usize = 60;
    let solve = |too_large: &dyn Fn(f64) -> bool| {
        let [mut lo, mut hi] = [0.0, 1.0];
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(lo, hi);
            if too_large(middle) {
                hi = middle;
            } else {
                lo = middle;
            }
        }
        f64::midpoint(lo, hi)
    };
    let half = 0.5 * level;
    let low = if successes == 0 { 0.0 } else { solve(&|p| at_least(successes, trials, p) > half) };
    let high =
        if successes >= trials { 1.0 } else { solve(&|p| 1.0 - at_least(successes + 1, trials, p) < half) };
    [low, high]
}

/// P(X ≥ k) of a binomial X, summed from its smaller side.
fn at_least(k: usize, trials: usize, p: f64) -> f64 {
    let n = trials as f64;
    let choose = |j: usize| {
        let j = j as f64;
        libm::lgamma(n + 1.0) - libm::lgamma(j + 1.0) - libm::lgamma(n - j + 1.0)
    };
    let (log_p, log_q) = (p.ln(), libm::log1p(-p));
    let term = |j: usize| libm::exp(choose(j) + j as f64 * log_p + (trials - j) as f64 * log_q);
    if k as f64 > p * n { (k..=trials).map(term).sum() } else { 1.0 - (0..k).map(term).sum::<f64>() }
}

/// The chance that `count` or more of trials happen, each by a chance of its own.
pub(super) fn tail(chances: &[f64], count: usize) -> f64 {
    if count == 0 {
        return 1.0;
    }
    // The chance of every number below `count`; whatever reaches it stays there.
    let mut below = vec![0.0; count];
    below[0] = 1.0;
    let mut reached = 0.0;
    for chance in chances {
        reached += below[count - 1] * chance;
        for k in (1..count).rev() {
            below[k] = below[k] * (1.0 - chance) + below[k - 1] * chance;
        }
        below[0] *= 1.0 - chance;
    }
    reached
}

/// Probability that a robot's own error changes the outcome of a pose, at this distance from the border in
/// standard deviations.
pub(super) fn chance(margin: f64) -> f64 {
    libm::erfc(margin / SQRT_2).min(0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_closed_forms() {
        // All of n: (α/2)^(1/n).
        let [low, high] = clopper_pearson(150, 150, 0.05);
        assert!((low - 0.025f64.powf(1.0 / 150.0)).abs() < 1e-12 && high == 1.0, "{low}");
        assert!((low - 0.976).abs() < 1e-3);
        // One-sided 95 % bounds for 6 of 6 and 18 of 18.
        for (n, printed) in [(6, 0.607), (18, 0.847)] {
            assert!((clopper_pearson(n, n, 0.1)[0] - printed).abs() < 1e-3);
        }
        // Tables: 3 of 10 gives 0.0667 … 0.6525.
        let [low, high] = clopper_pearson(3, 10, 0.05);
        assert!((low - 0.066_739_5).abs() < 1e-6 && (high - 0.652_452_9).abs() < 1e-6, "{low} {high}");
        let mirrored = clopper_pearson(7, 10, 0.05);
        assert!((mirrored[0] + high - 1.0).abs() < 1e-12 && (mirrored[1] + low - 1.0).abs() < 1e-12);
        assert_eq!(clopper_pearson(0, 0, 0.05), [0.0, 1.0]);
        let [low, high] = clopper_pearson(5_000, 10_000, 0.05);
        assert!((low - 0.4902).abs() < 1e-4 && (high - 0.5098).abs() < 1e-4);
    }

    #[test]
    fn tails_are_those_of_all_subsets() {
        let chances = [0.1, 0.5, 0.03, 0.7, 0.25];
        for count in 0..=6 {
            let brute: f64 = (0..1u32 << chances.len())
                .filter(|set| set.count_ones() as usize >= count)
                .map(|set| {
                    let part = |(k, p): (usize, &f64)| if set >> k & 1 == 1 { *p } else { 1.0 - p };
                    chances.iter().enumerate().map(part).product::<f64>()
                })
                .sum();
            assert!((tail(&chances, count) - brute).abs() < 1e-14, "{count}");
        }
        assert!(
            (chance(2.0) - 0.045_500_263_9).abs() < 1e-9
                && chance(0.1) == 0.5
                && chance(f64::INFINITY) == 0.0
        );
    }
}
