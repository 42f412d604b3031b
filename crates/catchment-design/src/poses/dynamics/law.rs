//! The distribution of a number.

use serde::{Deserialize, Serialize};
use std::f64::consts::{SQRT_2, TAU};

/// Distribution of a number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum ScalarDistribution {
    /// Always the same.
    Constant {
        /// The value.
        value: f64,
    },
    /// Normal.
    Normal {
        /// Its mean.
        mean: f64,
        /// Its standard deviation.
        sigma: f64,
    },
    /// Uniform between two bounds.
    Uniform {
        /// Lower bound.
        from: f64,
        /// Upper bound.
        to: f64,
    },
    /// The logarithm is normal.
    Lognormal {
        /// The median.
        median: f64,
        /// Exponential of the logarithm's standard deviation: two thirds of the values lie within
        /// median/factor and median·factor.
        factor: f64,
    },
    /// One of these values, all equally likely.
    Measured {
        /// The values.
        measured: Vec<f64>,
    },
}

/// At least half of a law lies in its range: once in 10¹⁹ all of these lie outside.
const ATTEMPTS: u64 = 64;

impl ScalarDistribution {
    /// Largest number of random numbers for a value: two for every attempt.
    pub const DRAWN: u64 = 2 * ATTEMPTS;

    /// The number that is always the same.
    pub const fn constant(value: f64) -> Self {
        Self::Constant { value }
    }

    /// Whether it is always the same.
    pub fn is_constant(&self) -> bool {
        match self {
            Self::Constant { .. } => true,
            Self::Normal { sigma, .. } => *sigma == 0.0,
            Self::Uniform { from, to } => from == to,
            Self::Lognormal { factor, .. } => *factor == 1.0,
            Self::Measured { measured } => measured.windows(2).all(|pair| pair[0] == pair[1]),
        }
    }

    /// Its mean, before it is cut to any range.
    pub fn mean(&self) -> f64 {
        match self {
            Self::Constant { value } => *value,
            Self::Normal { mean, .. } => *mean,
            Self::Uniform { from, to } => 0.5 * (from + to),
            Self::Lognormal { median, factor } => {
                let spread = libm::log(*factor);
                median * libm::exp(0.5 * spread * spread)
            }
            Self::Measured { measured } => measured.iter().sum::<f64>() / measured.len().max(1) as f64,
        }
    }

    /// The share of it that lies in a range, in [0, 1].
    pub fn inside(&self, [lo, hi]: [f64; 2]) -> f64 {
        let holds = |value: f64| f64::from(u8::from((lo..=hi).contains(&value)));
        let below = |z: f64| 0.5 * libm::erfc(-z / SQRT_2);
        match self {
            _ if self.is_constant() => holds(self.mean()),
            Self::Constant { value } => holds(*value),
            Self::Normal { mean, sigma } => below((hi - mean) / sigma) - below((lo - mean) / sigma),
            Self::Uniform { from, to } => ((to.min(hi) - from.max(lo)) / (to - from)).max(0.0),
            Self::Lognormal { median, factor } => {
                let z = |value: f64| libm::log(value / median) / libm::log(*factor);
                let low = if lo > 0.0 { below(z(lo)) } else { 0.0 };
                if hi > 0.0 { below(z(hi)) - low } else { 0.0 }
            }
            Self::Measured { measured } => {
                measured.iter().map(|value| holds(*value)).sum::<f64>() / measured.len().max(1) as f64
            }
        }
    }

    /// A value in a range, by numbers uniform in [0, 1) that can be looked up, [`ScalarDistribution::DRAWN`] of them; its mean, put into the range, where none lies there.
    pub fn draw(&self, [lo, hi]: [f64; 2], uniform: impl Fn(u64) -> f64) -> f64 {
        let drawn = (0..ATTEMPTS).map(|k| self.value(uniform(2 * k), uniform(2 * k + 1)));
        let mut inside = drawn.filter(|value| (lo..=hi).contains(value));
        inside.next().unwrap_or_else(|| self.mean().clamp(lo, hi))
    }

    fn value(&self, first: f64, second: f64) -> f64 {
        // Box and Muller, 1958: a logarithm of (0, 1].
        let normal = || (-2.0 * libm::log(1.0 - first)).sqrt() * libm::cos(TAU * second);
        match self {
            Self::Constant { value } => *value,
            Self::Normal { mean, sigma } => mean + sigma * normal(),
            Self::Uniform { from, to } => from + (to - from) * first,
            Self::Lognormal { median, factor } => median * libm::exp(libm::log(*factor) * normal()),
            Self::Measured { measured } => {
                let place = (first * measured.len() as f64) as usize;
                measured.get(place.min(measured.len().saturating_sub(1))).copied().unwrap_or_default()
            }
        }
    }
}
