//! Random errors of a robot, accessed by number: the samples do not depend on the caller or the order.
//!
//! ```text
//!   normal     z ~ N(0, 1)ⁿ   y = L·z   eₖ = μₖ + fₖ·σₖ·yₖ      L·Lᵀ the correlations, fₖ the factors by which σ are changed
//!   uniform    z ~ U(−1, 1)ⁿ            eₖ = μₖ + fₖ·hₖ·zₖ
//!   measured   a row r                  eₖ = μₖ + fₖ·(rₖ − μₖ)     the rows in their order, or any of them again and again
//! ```
//!
//! With other factors the same number gives the same z: common random numbers, with which differences are
//! more precise than the values.

use catchment_core::acceptance::Stream;
use catchment_core::method::descent;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::covariance::{Matrix, cholesky, solve_lower, solve_upper};
use catchment_core::poses::{Moments, Spread};
use std::f64::consts::TAU;

/// No σ changed.
pub(crate) const SAME: [f64; 5] = [1.0; 5];

/// Errors of a robot by their numbers.
#[derive(Debug, Clone)]
pub(crate) struct Source<'a> {
    law: Law<'a>,
    mean: [f64; 5],
    /// Standard deviations; half-widths for uniform errors.
    scale: [f64; 5],
    /// L of the correlations of errors in units of `scale`.
    factor: Matrix,
    random: Stream,
    /// How they are followed.
    pub(super) motions: descent::DescentSettings,
}

#[derive(Debug, Clone, Copy)]
enum Law<'a> {
    Normal,
    Uniform,
    /// A face of the uniform box: this error is at either end.
    Face(Dof),
    /// Rows in their order.
    Rows(&'a [PoseError]),
    /// Any rows.
    AnyRows(&'a [PoseError]),
}

/// Random numbers of a pose: five normal numbers, by pairs, and the number of the row.
const NUMBERS: u64 = 6;

impl<'a> Source<'a> {
    /// Errors of a spread; for measured errors every row once if `rows` of them are followed, else random
    /// rows.
    pub(crate) fn of(spread: &'a Spread, rows: usize, seed: u64) -> Self {
        let Moments { mean, sigma, correlation } = spread.moments();
        let mut scale = sigma.to_array();
        let law = match spread {
            Spread::Normal { .. } => Law::Normal,
            Spread::Uniform { half_width, .. } => {
                scale = half_width.to_array();
                Law::Uniform
            }
            Spread::Measured { poses, .. } if poses.len() <= rows => Law::Rows(poses),
            Spread::Measured { poses, .. } => Law::AnyRows(poses),
        };
        // Correlations of rows are semidefinite, but for rounding: without them distances are by each error alone.
        let factor = cholesky(&correlation).unwrap_or(catchment_core::poses::covariance::IDENTITY);
        let motions = descent::DescentSettings::default();
        Self { law, mean: mean.to_array(), scale, factor, random: Stream::new(seed), motions }
    }

    /// The same, followed by these motions.
    pub(super) fn followed_by(self, motions: &descent::DescentSettings) -> Self {
        Self { motions: motions.clone(), ..self }
    }

    /// The faces of the box of a uniform spread across a given error.
    pub(super) fn on_face(&self, axis: Dof) -> Self {
        Self { law: Law::Face(axis), ..self.clone() }
    }

    /// Number of errors, if it is limited.
    pub(super) const fn rows(&self) -> Option<usize> {
        match self.law {
            Law::Rows(rows) => Some(rows.len()),
            _ => None,
        }
    }

    /// How many measurements random rows are drawn from.
    pub(super) const fn measurements(&self) -> Option<usize> {
        match self.law {
            Law::AnyRows(rows) => Some(rows.len()),
            _ => None,
        }
    }

    /// The errors that vary.
    pub(super) fn varying(&self) -> impl Iterator<Item = Dof> {
        let scale = self.scale;
        Dof::ALL.into_iter().filter(move |dof| scale[dof.index()] > 0.0)
    }

    /// The mean error.
    pub(super) const fn mean(&self) -> PoseError {
        PoseError::from_array(self.mean)
    }

    /// Standard deviation, or half-width, of an error.
    pub(super) const fn scale(&self, axis: Dof) -> f64 {
        self.scale[axis.index()]
    }

    /// Standard deviation of an error.
    pub(super) fn sigma(&self, axis: Dof) -> f64 {
        if self.is_uniform() { self.scale(axis) / 3f64.sqrt() } else { self.scale(axis) }
    }

    /// Whether errors are uniform in a box.
    pub(super) const fn is_uniform(&self) -> bool {
        matches!(self.law, Law::Uniform | Law::Face(_))
    }

    /// The range of an error, practically all of it for unbounded errors: the range of the guiding grid.
    pub(super) fn range(&self, axis: Dof) -> [f64; 2] {
        /// Beyond so many σ a normal error lies once in two thousand.
        const NORMAL: f64 = 3.5;
        let k = axis.index();
        match self.law {
            Law::Normal => [self.mean[k] - NORMAL * self.scale[k], self.mean[k] + NORMAL * self.scale[k]],
            Law::Uniform | Law::Face(_) => [self.mean[k] - self.scale[k], self.mean[k] + self.scale[k]],
            Law::Rows(rows) | Law::AnyRows(rows) => {
                let values = rows.iter().map(|row| row.to_array()[k]);
                values.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], v| [lo.min(v), hi.max(v)])
            }
        }
    }

    /// z of error number `number`.
    pub(crate) fn standard(&self, number: u64) -> [f64; 5] {
        let uniform = |k: u64| self.random.uniform(NUMBERS * number + k);
        let even = || std::array::from_fn(|k| 2.0 * uniform(k as u64) - 1.0);
        match self.law {
            Law::Normal => normals(uniform),
            Law::Uniform => even(),
            Law::Face(axis) => {
                let mut z: [f64; 5] = even();
                z[axis.index()] = if z[axis.index()] < 0.0 { -1.0 } else { 1.0 };
                z
            }
            Law::Rows(rows) => self.of_row(&rows[number as usize % rows.len()]),
            Law::AnyRows(rows) => {
                let row = (uniform(0) * rows.len() as f64) as usize;
                self.of_row(&rows[row.min(rows.len() - 1)])
            }
        }
    }

    fn of_row(&self, row: &PoseError) -> [f64; 5] {
        let row = row.to_array();
        std::array::from_fn(
            |k| if self.scale[k] > 0.0 { (row[k] - self.mean[k]) / self.scale[k] } else { 0.0 },
        )
    }

    /// The errors in units of their σ.
    pub(super) fn in_sigmas(&self, z: &[f64; 5]) -> [f64; 5] {
        match self.law {
            Law::Normal => std::array::from_fn(|i| (0..=i).map(|k| self.factor[i][k] * z[k]).sum()),
            _ => *z,
        }
    }

    /// The pose error of z with every σ multiplied by its factor.
    pub(crate) fn pose(&self, z: &[f64; 5], factors: &[f64; 5]) -> PoseError {
        let y = self.in_sigmas(z);
        PoseError::from_array(std::array::from_fn(|k| self.mean[k] + factors[k] * self.scale[k] * y[k]))
    }

    /// Distance from the mean, in σ: Mahalanobis distance; in half-widths for uniform errors.
    pub(super) fn distance(&self, z: &[f64; 5]) -> f64 {
        let length =
            |v: &[f64; 5]| self.varying().map(|dof| v[dof.index()] * v[dof.index()]).sum::<f64>().sqrt();
        match self.law {
            Law::Normal => length(z),
            Law::Uniform | Law::Face(_) => self.varying().map(|dof| z[dof.index()].abs()).fold(0.0, f64::max),
            Law::Rows(_) | Law::AnyRows(_) => length(&solve_lower(&self.factor, z)),
        }
    }

    /// Whether the density has a derivative by every σ: errors are normal and linearly independent.
    pub(super) fn has_scores(&self) -> bool {
        /// Share of its standard deviation below which an error depends on the others: scores grow as its inverse
        /// square.
        const OWN: f64 = 1e-4;
        matches!(self.law, Law::Normal)
            && self.varying().all(|dof| self.factor[dof.index()][dof.index()] > OWN)
    }

    /// d log(density)/d log σₖ at z, of normal errors: yₖ·(C⁻¹y)ₖ − 1.
    pub(super) fn scores(&self, z: &[f64; 5]) -> [f64; 5] {
        let (y, w) = (self.in_sigmas(z), solve_upper(&self.factor, z));
        std::array::from_fn(|k| y[k] * w[k] - 1.0)
    }

    /// Another stream of the same errors, for searches.
    pub(super) const fn random(&self) -> Stream {
        self.random
    }
}

/// Five independent standard normal numbers from six uniform ones (Box and Muller, 1958).
pub(crate) fn normals(uniform: impl Fn(u64) -> f64) -> [f64; 5] {
    let mut z = [0.0; 5];
    for (pair, values) in z.chunks_mut(2).enumerate() {
        // A logarithm of (0, 1].
        let radius = (-2.0 * libm::log(1.0 - uniform(2 * pair as u64))).sqrt();
        let angle = TAU * uniform(2 * pair as u64 + 1);
        for (value, direction) in values.iter_mut().zip([libm::cos(angle), libm::sin(angle)]) {
            *value = radius * direction;
        }
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_core::poses::covariance::IDENTITY;

    fn correlated() -> Spread {
        let mut correlation = IDENTITY;
        (correlation[0][4], correlation[4][0]) = (0.6, 0.6);
        let sigma = PoseError { x: 0.1, yaw: 0.2, ..PoseError::default() };
        let mean = PoseError { x: 0.05, ..PoseError::default() };
        Spread::Normal { mean, sigma, correlation }
    }

    #[test]
    fn poses_have_the_moments_of_their_spread() {
        const COUNT: u64 = 100_000;
        let spread = correlated();
        let source = Source::of(&spread, 0, 1);
        let poses: Vec<PoseError> = (0..COUNT).map(|k| source.pose(&source.standard(k), &SAME)).collect();
        let result = Spread::Measured { source: String::new(), poses }.moments();
        let wanted = spread.moments();
        // Five standard errors: σ/√N of the mean, σ/√2N of σ, (1 − ρ²)/√N of the correlation.
        let root = (COUNT as f64).sqrt();
        assert!((result.mean.x - wanted.mean.x).abs() < 5.0 * 0.1 / root);
        assert!((result.sigma.yaw - wanted.sigma.yaw).abs() < 5.0 * 0.2 / (2f64.sqrt() * root));
        assert!((result.correlation[0][4] - 0.6).abs() < 5.0 * 0.64 / root);
        assert_eq!(result.sigma.y, 0.0);
    }

    #[test]
    fn scores_have_mean_zero_and_the_covariance_of_fisher() {
        // E[score] = 0; E[score·y²] is the derivative of E[y²] by log σ, which is 2.
        const COUNT: u64 = 200_000;
        let spread = correlated();
        let source = Source::of(&spread, 0, 3);
        let (mut mean, mut second) = (0.0, 0.0);
        for k in 0..COUNT {
            let z = source.standard(k);
            let (score, y) = (source.scores(&z)[4], source.in_sigmas(&z)[4]);
            mean += score / COUNT as f64;
            second += score * y * y / COUNT as f64;
        }
        // The variance of the score is 1 + 1/(1 − ρ²) = 2.56; that of its product with y² below 40.
        assert!(mean.abs() < 5.0 * (2.6 / COUNT as f64).sqrt(), "{mean}");
        assert!((second - 2.0).abs() < 5.0 * (40.0 / COUNT as f64).sqrt(), "{second}");
    }

    #[test]
    fn rows_come_in_their_order_and_any_rows_from_among_them() {
        let poses: Vec<PoseError> =
            (0..10).map(|k| PoseError { x: 0.01 * f64::from(k), ..PoseError::default() }).collect();
        let spread = Spread::Measured { source: String::new(), poses: poses.clone() };
        let all = Source::of(&spread, 10, 1);
        assert_eq!((all.rows(), all.measurements()), (Some(10), None));
        for (k, pose) in poses.iter().enumerate() {
            assert!((all.pose(&all.standard(k as u64), &SAME).x - pose.x).abs() < 1e-15);
        }
        let any = Source::of(&spread, 9, 1);
        assert_eq!((any.rows(), any.measurements()), (None, Some(10)));
        assert!((0..100).all(|k| {
            let x = any.pose(&any.standard(k), &SAME).x;
            poses.iter().any(|pose| (pose.x - x).abs() < 1e-15)
        }));
        // Half of the deviations from the mean, 0.045.
        let half = all.pose(&all.standard(9), &[0.5; 5]).x;
        assert!((half - 0.0675).abs() < 1e-15, "{half}");
    }

    #[test]
    fn distances_are_those_of_mahalanobis() {
        let spread = correlated();
        let source = Source::of(&spread, 0, 1);
        // (x, yaw) in σ is (1, 1): d² = 2(1 − ρ)/(1 − ρ²) = 2/1.6.
        let z = solve_lower(&source.factor, &[1.0, 0.0, 0.0, 0.0, 1.0]);
        assert!((source.distance(&z) - (2.0f64 / 1.6).sqrt()).abs() < 1e-12);
        let box_of = Spread::Uniform {
            mean: PoseError::default(),
            half_width: PoseError { x: 0.1, yaw: 0.2, ..PoseError::default() },
        };
        let source = Source::of(&box_of, 0, 1);
        assert_eq!(source.distance(&[0.5, 9.0, 9.0, 9.0, -0.75]), 0.75);
        let face = source.on_face(Dof::Yaw);
        assert!((0..50).all(|k| face.standard(k)[4].abs() == 1.0 && face.standard(k)[0].abs() < 1.0));
    }
}
