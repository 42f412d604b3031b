//! Poses sampled from the errors of a robot: pose k depends only on the seed and k.

use super::JamsError;
use super::stability::normal;
use crate::acceptance::Stream;
use crate::design::Alignment;
use crate::pose::{Dof, PoseError};
use crate::poses::covariance::{IDENTITY, cholesky};
use crate::poses::{Distribution, Spread};

/// Numbers that a pose takes.
const EACH: u64 = 10;

/// The numbered deviations from the mean.
type Draw<'a> = Box<dyn Fn(u64) -> [f64; 5] + 'a>;

/// So many poses of a distribution.
pub(super) fn poses(
    errors: &Distribution,
    alignment: &Alignment,
    count: usize,
    seed: u64,
) -> Result<Vec<PoseError>, JamsError> {
    let stream = Stream::new(seed);
    let normals = |k: u64| -> [f64; 5] { std::array::from_fn(|j| normal(stream, EACH * k + 2 * j as u64)) };
    let (mean, draw): (&PoseError, Draw<'_>) = match errors {
        Distribution::Normal { mean, sigma } => {
            let sigma = sizes(sigma, alignment)?;
            (mean, Box::new(move |k| std::array::from_fn(|j| sigma[j] * normals(k)[j])))
        }
        Distribution::Uniform { mean, half_width } => {
            let half_width = sizes(half_width, alignment)?;
            let number = move |k: u64, j: usize| 2.0 * stream.uniform(EACH * k + 2 * j as u64) - 1.0;
            (mean, Box::new(move |k| std::array::from_fn(|j| half_width[j] * number(k, j))))
        }
        Distribution::Correlated { mean, covariance, .. } => {
            let variances = PoseError::from_array(std::array::from_fn(|j| covariance[j][j]));
            sizes(&variances, alignment)?;
            let factor = cholesky(covariance).map_err(|_| JamsError::NotACovariance)?;
            let product =
                move |row: &[f64; 5], z: &[f64; 5]| row.iter().zip(z).map(|(l, z)| l * z).sum::<f64>();
            (
                mean,
                Box::new(move |k| {
                    let z = normals(k);
                    std::array::from_fn(|j| product(&factor[j], &z))
                }),
            )
        }
    };
    let mean = mean.to_array();
    check(&mean, alignment, f64::is_finite)?;
    let pose = |k: usize| {
        let off = draw(k as u64);
        PoseError::from_array(std::array::from_fn(|j| mean[j] + off[j]))
    };
    Ok((0..count).map(pose).collect())
}

/// A spread in the form of the settings; `None` for measured errors.
pub(super) fn law(spread: &Spread, samples: u32, seed: u64) -> Option<Distribution> {
    match spread {
        Spread::Normal { mean, sigma, correlation } if *correlation == IDENTITY => {
            Some(Distribution::Normal { mean: *mean, sigma: *sigma })
        }
        Spread::Normal { mean, sigma, correlation } => {
            let sigma = sigma.to_array();
            let entry = |i: usize, j: usize| sigma[i] * sigma[j] * correlation[i][j];
            let covariance = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
            Some(Distribution::Correlated { mean: *mean, covariance, samples, seed })
        }
        Spread::Uniform { mean, half_width } => {
            Some(Distribution::Uniform { mean: *mean, half_width: *half_width })
        }
        Spread::Measured { .. } => None,
    }
}

/// Poses that were measured: each once, or as many as are wanted of more.
pub(super) fn measured(
    rows: &[PoseError],
    alignment: &Alignment,
    count: usize,
    seed: u64,
) -> Result<Vec<PoseError>, JamsError> {
    for row in rows {
        check(&row.to_array(), alignment, f64::is_finite)?;
    }
    if rows.len() <= count {
        return Ok(rows.to_vec());
    }
    let stream = Stream::new(seed);
    let any = |k: usize| (stream.uniform(EACH * k as u64) * rows.len() as f64) as usize;
    Ok((0..count).map(|k| rows[any(k).min(rows.len() - 1)]).collect())
}

/// Sizes of errors, of those alone that occur.
fn sizes(sizes: &PoseError, alignment: &Alignment) -> Result<[f64; 5], JamsError> {
    let sizes = sizes.to_array();
    check(&sizes, alignment, |value| value.is_finite() && value >= 0.0)?;
    Ok(sizes)
}

fn check(values: &[f64; 5], alignment: &Alignment, is_one: impl Fn(f64) -> bool) -> Result<(), JamsError> {
    for axis in Dof::ALL {
        let value = values[axis.index()];
        if !is_one(value) {
            return Err(JamsError::NoSize { axis, value });
        }
        if value != 0.0 && !alignment.free.contains(axis) {
            return Err(JamsError::Locked { axis });
        }
    }
    Ok(())
}
