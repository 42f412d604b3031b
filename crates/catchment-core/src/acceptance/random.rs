//! Random numbers with direct access: number k of a sequence depends only on its seed and k, so the order in
//! which threads draw them does not matter.
//!
//! `SplitMix64` (Steele, Lea, Flood, OOPSLA 2014): its state after any number of steps has a closed form.
//! Suitable for sampling, not for cryptography.

/// A sequence of independent numbers, uniform in [0, 1).
#[derive(Debug, Clone, Copy)]
pub struct Stream {
    start: u64,
}

/// The step of the sequence: 2⁶⁴ over the golden ratio, odd.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

const fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Stream {
    /// The sequence of a seed. Mixed, so that neighbouring seeds do not give sequences shifted by a step.
    pub const fn new(seed: u64) -> Self {
        Self { start: mix(seed.wrapping_add(STEP)) }
    }

    /// A separate sequence for part `part` of the task.
    #[must_use]
    pub const fn branch(self, part: u64) -> Self {
        Self::new(self.start ^ mix(part.wrapping_add(STEP)))
    }

    /// Number `index`: a multiple of 2⁻⁵³.
    pub fn uniform(self, index: u64) -> f64 {
        let bits = mix(self.start.wrapping_add(STEP.wrapping_mul(index.wrapping_add(1))));
        (bits >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn branches_are_apart_from_each_other_and_from_their_seed() {
        const COUNT: u64 = 20_000;
        let base = Stream::new(7);
        let others = [base, base.branch(0), base.branch(1), Stream::new(8), Stream::new(8).branch(0)];
        for (a, first) in others.iter().enumerate() {
            for second in &others[..a] {
                // The product of two independent numbers has mean 1/4 and variance 7/144; five standard errors.
                let products = (0..COUNT).map(|k| first.uniform(k) * second.uniform(k)).sum::<f64>();
                let mean = products / COUNT as f64;
                assert!((mean - 0.25).abs() < 5.0 * (7.0 / 144.0 / COUNT as f64).sqrt(), "{mean}");
            }
        }
    }
}
