//! The estimate and its interval.
//!
//! ```text
//!   batch b of N_b poses, n_sb of them in stratum s, k_sb aligned; stratum s holds the share p_s of the box
//!
//!   a_s  = Σ_b N_b·(k_sb/n_sb) / Σ_b N_b          aligned share of stratum s
//!   n_s' = (Σ_b N_b)² / Σ_b N_b²/n_sb             equivalent number of poses in a single batch
//!   sum  = Σ_s p_s·a_s
//!   lo   = sum − √Σ_s p_s²(a_s − l_s)²            [l_s, u_s]  Wilson's interval of a_s from n_s' poses
//!   hi   = sum + √Σ_s p_s²(u_s − a_s)²
//! ```
//!
//! The intervals are combined by MOVER (Zou and Donner, Stat. Med. 27 (2008) 1693). With Wilson's intervals
//! it is valid even for nearly pure strata: 0 docked of n poses leaves an uncertainty of 3.8/n of the
//! stratum, not zero.
//!
//! The estimate is unbiased, although later batches go to the strata that earlier batches found uncertain:
//! the numbers `n_sb` are fixed before batch b is drawn, so each batch is unbiased whatever preceded it, and
//! its weight `N_b` is fixed in advance.

/// Two-sided 95 % quantile of the standard normal distribution.
pub const Z95: f64 = 1.959_963_984_540_054;

/// Wilson's 95 % interval of a probability that was seen as `share` of `trials`; [0, 1] without trials.
///
/// Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209. Unlike the textbook interval it holds for shares near
/// 0 and 1.
pub fn wilson95(share: f64, trials: f64) -> [f64; 2] {
    if trials <= 0.0 {
        return [0.0, 1.0];
    }
    let z2 = Z95 * Z95;
    let center = (share + z2 / (2.0 * trials)) / (1.0 + z2 / trials);
    let half = Z95 / (1.0 + z2 / trials)
        * (share * (1.0 - share) / trials + z2 / (4.0 * trials * trials)).max(0.0).sqrt();
    // In exact arithmetic the share lies inside; rounding must not put it out.
    [(center - half).clamp(0.0, share.max(0.0)), (center + half).clamp(share.min(1.0), 1.0)]
}

/// Results of a stratum.
#[derive(Debug, Clone, Copy, Default)]
pub struct StratumCounts {
    /// Share of the box, p.
    pub(crate) share: f64,
    /// Poses followed.
    pub(crate) descents: usize,
    /// How many aligned.
    pub(crate) aligned: usize,
    /// How many could not be followed to their end.
    pub(crate) undecided: usize,
    /// Σ N·k/n over the batches, of the aligned and of the undecided.
    weighted: [f64; 2],
    /// Σ N²/n.
    spread: f64,
}

impl StratumCounts {
    /// A stratum that holds `share` of the box.
    pub fn new(share: f64) -> Self {
        Self { share, ..Self::default() }
    }

    /// Adds a batch of `batch` poses, of which `descents` fell to this stratum.
    pub fn add(&mut self, batch: usize, descents: usize, [aligned, undecided]: [usize; 2]) {
        let (whole, part) = (batch as f64, descents as f64);
        self.descents += descents;
        self.aligned += aligned;
        self.undecided += undecided;
        self.weighted[0] += whole * (aligned as f64 / part);
        self.weighted[1] += whole * (undecided as f64 / part);
        self.spread += whole * whole / part;
    }

    /// The share that aligns, and that which is undecided, after `total` poses in all strata.
    pub fn shares(&self, total: usize) -> [f64; 2] {
        self.weighted.map(|w| if total == 0 { 0.0 } else { w / total as f64 })
    }

    /// The same poses, counting those that neither aligned nor are undecided, after `total` poses in all strata.
    pub(crate) fn reversed(&self, total: usize) -> Self {
        let [aligned, undecided] = self.weighted;
        let decided = self.descents - self.undecided;
        Self {
            aligned: decided - self.aligned,
            weighted: [(total as f64 - aligned - undecided).max(0.0), undecided],
            ..*self
        }
    }

    /// Variance of the estimated share, if `share` were the true value.
    fn variance(&self, share: f64, total: usize) -> f64 {
        share * (1.0 - share) * self.spread / (total as f64 * total as f64)
    }

    /// Information from an additional pose in this stratum: p·√(a(1 − a)), with a shifted towards a half by
    /// two poses of either outcome (Agresti and Coull 1998) so that a stratum which seems pure is sampled
    /// again.
    pub(crate) fn doubt(&self) -> f64 {
        const PRIOR: f64 = 2.0;
        let open = self.aligned.min(self.descents - self.aligned) as f64;
        let a = (open + PRIOR) / (self.descents as f64 + 2.0 * PRIOR);
        self.share * (a * (1.0 - a)).sqrt()
    }
}

/// The combined estimate of all strata, as shares of the box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CombinedShares {
    /// Share of the box that is accepted.
    pub fraction: f64,
    /// Its 95 % confidence interval.
    pub ci95: [f64; 2],
    /// Poses drawn over the whole box that would have the same variance.
    pub(crate) plain: f64,
}

impl CombinedShares {
    /// After `total` poses.
    pub fn of(seen: &[StratumCounts], total: usize) -> Self {
        let (mut fraction, mut open, mut variance) = (0.0, 0.0, 0.0);
        let mut squares = [0.0; 2];
        for s in seen {
            let [aligned, undecided] = s.shares(total);
            let upper = (aligned + undecided).min(1.0);
            let trials = if s.spread > 0.0 { total as f64 * total as f64 / s.spread } else { 0.0 };
            let down = s.share * (aligned - wilson95(aligned, trials)[0]);
            let up = s.share * (wilson95(upper, trials)[1] - upper);
            fraction += s.share * aligned;
            open += s.share * (upper - aligned);
            variance += s.share * s.share * s.variance(aligned, total);
            squares[0] += down * down;
            squares[1] += up * up;
        }
        let [down, up] = squares.map(f64::sqrt);
        Self {
            fraction,
            ci95: [(fraction - down).max(0.0), (fraction + open + up).min(1.0)],
            plain: fraction * (1.0 - fraction) / variance,
        }
    }

    /// Half the width of the interval.
    pub(crate) fn half_width(&self) -> f64 {
        (self.ci95[1] - self.ci95[0]) / 2.0
    }
}
