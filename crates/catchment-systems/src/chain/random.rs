//! Counter-based random numbers: the number of a chain and the name of an error determine the draw, so that
//! threads, the order of chains and their length do not change a bit.
//!
//! ```text
//!   word = mix(mix(seed + γ·chain) + γ·term)          mix is the finaliser of SplitMix64, γ its odd constant
//! ```
//!
//! Source: Steele, Lea, Flood, OOPSLA 2014 (the finaliser); Box and Muller, 1958 (normal numbers).

use std::f64::consts::TAU;

/// The golden ratio's constant of `SplitMix64`.
const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// Errors of a chain that are drawn, each with numbers of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Term {
    /// Of joint k, counted from 0.
    Joint(usize),
    /// Rounding error of joint k's encoder.
    Encoder(usize),
    /// Of the length of link k.
    Link(usize),
    /// Of the base: heading, x, y.
    Base(usize),
}

impl Term {
    const fn counter(self) -> u64 {
        let (kind, number) = match self {
            Self::Joint(k) => (0, k),
            Self::Encoder(k) => (1, k),
            Self::Link(k) => (2, k),
            Self::Base(k) => (3, k),
        };
        // Two words a number, and room for the kinds beside each other.
        ((number as u64) * 4 + kind) * 2
    }
}

/// The draws of a chain.
#[derive(Debug, Clone, Copy)]
pub struct Draws(u64);

impl Draws {
    /// Of a chain by its number.
    pub const fn of(seed: u64, chain: u64) -> Self {
        Self(mix(seed.wrapping_add(GAMMA.wrapping_mul(chain.wrapping_add(1)))))
    }

    const fn word(self, counter: u64) -> u64 {
        mix(self.0.wrapping_add(GAMMA.wrapping_mul(counter.wrapping_add(1))))
    }

    /// Uniform in (0, 1].
    fn unit(self, counter: u64) -> f64 {
        ((self.word(counter) >> 11) + 1) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in (−½, ½].
    pub fn uniform(self, term: Term) -> f64 {
        self.unit(term.counter()) - 0.5
    }

    /// Standard normal.
    pub fn normal(self, term: Term) -> f64 {
        let counter = term.counter();
        let radius = (-2.0 * libm::log(self.unit(counter))).sqrt();
        radius * libm::cos(TAU * self.unit(counter + 1))
    }
}

const fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean 0, variance 1, kurtosis 3, no correlation between neighbours: each to five of its standard errors.
    #[test]
    fn the_draws_are_standard_and_independent() {
        const COUNT: u64 = 100_000;
        let n = COUNT as f64;
        let pairs = || (0..COUNT).map(|k| Draws::of(1, k)).map(|d| [0, 1].map(|j| d.normal(Term::Joint(j))));
        let mean = |f: &dyn Fn([f64; 2]) -> f64| pairs().map(f).sum::<f64>() / n;
        assert!(mean(&|[a, _]| a).abs() < 5.0 / n.sqrt());
        assert!((mean(&|[a, _]| a * a) - 1.0).abs() < 5.0 * (2.0 / n).sqrt());
        assert!((mean(&|[a, _]| a.powi(4)) - 3.0).abs() < 5.0 * (96.0 / n).sqrt());
        assert!(mean(&|[a, b]| a * b).abs() < 5.0 / n.sqrt());
        let chains = (0..COUNT)
            .map(|k| Draws::of(1, k).normal(Term::Joint(0)) * Draws::of(1, k + 1).normal(Term::Joint(0)));
        assert!((chains.sum::<f64>() / n).abs() < 5.0 / n.sqrt());
        let flat = (0..COUNT).map(|k| Draws::of(1, k).uniform(Term::Encoder(3)).powi(2)).sum::<f64>() / n;
        assert!((flat - 1.0 / 12.0).abs() < 5.0 / (180.0 * n).sqrt());
    }

    #[test]
    fn every_term_and_chain_and_seed_has_numbers_of_its_own() {
        let terms = [Term::Joint(0), Term::Joint(1), Term::Encoder(0), Term::Link(0), Term::Base(0)];
        let mut seen: Vec<u64> = Vec::new();
        for (seed, chain) in [(0, 0), (0, 1), (1, 0)] {
            seen.extend(terms.iter().map(|t| Draws::of(seed, chain).normal(*t).to_bits()));
        }
        let count = seen.len();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), count);
    }
}
