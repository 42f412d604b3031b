//! Robots and their expected errors: the file format and its meaning.
//!
//! ```toml
//!   [[robot]]
//!   name = "arm A"
//!   sigma = { x = "1 mm", y = "1 mm", yaw = "2 deg" }      # independent normal errors
//!   mean = { x = "0.5 mm" }                                # their centre, 0 by default
//!
//!   [[robot]]
//!   name = "arm B"                                         # correlated ones: either with correlations beside sigma,
//!   sigma = { x = "1 mm", yaw = "2 deg" }
//!   correlation = { axes = ["x", "yaw"], matrix = [[1, 0.6], [0.6, 1]] }
//!
//!   [[robot]]
//!   name = "arm C"                                         # or all at once, units of an entry being those of its row times its column
//!   covariance = { axes = ["x", "yaw"], units = ["mm", "deg"], matrix = [[1, 1.2], [1.2, 4]] }
//!
//!   [[robot]]
//!   name = "conveyor"
//!   uniform = { x = "2 mm" }                               # even within ± these
//!
//!   [[robot]]
//!   name = "arm D"
//!   measured = "errors.csv"                                # a table of poses: header with units, a row per trial
//! ```
//!
//! Errors that are not named do not occur. All errors of a file are reported at once, each with its byte
//! range in the text. This module reads text only: the caller loads the tables.
//!
//! Lengths in D, angles in radians.

mod matrix;
mod read;
#[cfg(test)]
mod tests;

pub use read::{MOST_ROBOTS, read_robots};

use super::Distribution;
use super::covariance::{self, IDENTITY, Matrix};
use crate::design::{Design, SourceText};
use catchment_base::diagnostic::Diagnostics;
use catchment_base::pose::{Dof, PoseError};
use serde::Serialize;

/// A robot, and the errors that are expected of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Its name.
    pub name: String,
    /// How its errors spread.
    pub errors: Spread,
}

/// How the errors of a robot spread. Five numbers are in the order of [`Dof::ALL`], in D and radians; 0 for errors that do not
/// occur.
#[derive(Debug, Clone, PartialEq)]
pub enum Spread {
    /// Normal.
    Normal {
        /// Mean of each error.
        mean: PoseError,
        /// Standard deviation of each error.
        sigma: PoseError,
        /// Their correlations: symmetric, positive semidefinite, 1 on the diagonal.
        correlation: Matrix,
    },
    /// Uniform in a box.
    Uniform {
        /// Centre of the box.
        mean: PoseError,
        /// Half-width of the box along each error.
        half_width: PoseError,
    },
    /// As they were measured: each of these poses as likely as any other.
    Measured {
        /// Their source.
        source: String,
        /// The poses.
        poses: Vec<PoseError>,
    },
}

/// Mean, standard deviations and correlations of a spread.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Moments {
    /// Mean of each error.
    pub mean: PoseError,
    /// Standard deviation of each error.
    pub sigma: PoseError,
    /// Correlation matrix; an error that does not vary is uncorrelated.
    pub correlation: Matrix,
}

/// A distribution whose numbers are not valid.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("row {row} of the covariance keeps it from being symmetric and positive semidefinite")]
pub struct NotACovariance {
    /// The row, from 1.
    pub row: usize,
}

impl Spread {
    /// Independent normal errors around zero.
    pub const fn normal(sigma: PoseError) -> Self {
        let mean = PoseError { x: 0.0, y: 0.0, roll: 0.0, pitch: 0.0, yaw: 0.0 };
        Self::Normal { mean, sigma, correlation: IDENTITY }
    }

    /// The spread of a distribution.
    ///
    /// # Errors
    /// An invalid covariance.
    pub fn of(distribution: &Distribution) -> Result<Self, NotACovariance> {
        Ok(match distribution {
            Distribution::Normal { mean, sigma } => {
                Self::Normal { mean: *mean, sigma: *sigma, correlation: IDENTITY }
            }
            Distribution::Uniform { mean, half_width } => {
                Self::Uniform { mean: *mean, half_width: *half_width }
            }
            Distribution::Correlated { mean, covariance, .. } => {
                covariance::cholesky(covariance).map_err(|row| NotACovariance { row: row + 1 })?;
                let (sigma, correlation) = parted(covariance);
                Self::Normal { mean: *mean, sigma, correlation }
            }
        })
    }

    /// Errors as they were measured: a table of poses for a design, offsets those of the face centre.
    ///
    /// # Errors
    /// Everything that is wrong with the table, each in its place, or that it is too short.
    pub fn measured(table: SourceText, design: &Design) -> Result<Self, Diagnostics> {
        read::measured(table, design)
    }

    /// Its name in reports.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Normal { .. } => "normal",
            Self::Uniform { .. } => "uniform",
            Self::Measured { .. } => "measured",
        }
    }

    /// Its mean, standard deviations and correlations; of measured poses the unbiased estimates.
    pub fn moments(&self) -> Moments {
        match self {
            Self::Normal { mean, sigma, correlation } => {
                Moments { mean: *mean, sigma: *sigma, correlation: *correlation }
            }
            Self::Uniform { mean, half_width } => {
                let sigma = PoseError::from_array(half_width.to_array().map(|h| h / 3f64.sqrt()));
                Moments { mean: *mean, sigma, correlation: IDENTITY }
            }
            Self::Measured { poses, .. } => of_poses(poses),
        }
    }

    /// The errors that occur: those that vary, or whose mean is not 0.
    pub fn occurring(&self) -> impl Iterator<Item = Dof> {
        let Moments { mean, sigma, .. } = self.moments();
        let (mean, sigma) = (mean.to_array(), sigma.to_array());
        Dof::ALL.into_iter().filter(move |dof| mean[dof.index()] != 0.0 || sigma[dof.index()] > 0.0)
    }
}

/// The moments of poses, each as likely as any other.
fn of_poses(poses: &[PoseError]) -> Moments {
    let count = poses.len().max(1) as f64;
    let mut mean = [0.0; 5];
    for pose in poses {
        for (sum, value) in mean.iter_mut().zip(pose.to_array()) {
            *sum += value / count;
        }
    }
    let mut covariance = [[0.0; 5]; 5];
    for pose in poses {
        let pose = pose.to_array();
        let off: [f64; 5] = std::array::from_fn(|k| pose[k] - mean[k]);
        for (row, a) in covariance.iter_mut().zip(off) {
            for (entry, b) in row.iter_mut().zip(off) {
                *entry += a * b / (count - 1.0).max(1.0);
            }
        }
    }
    // An error that is the same in every row varies by rounding alone.
    for k in 0..5 {
        let size = poses.first().map_or(0.0, |pose| pose.to_array()[k].abs());
        if covariance[k][k].sqrt() <= 1e-12 * size {
            covariance[k] = [0.0; 5];
            for row in &mut covariance {
                row[k] = 0.0;
            }
        }
    }
    let (sigma, correlation) = parted(&covariance);
    Moments { mean: PoseError::from_array(mean), sigma, correlation }
}

/// Standard deviations and correlations of a covariance.
fn parted(covariance: &Matrix) -> (PoseError, Matrix) {
    let sigma: [f64; 5] = std::array::from_fn(|k| covariance[k][k].max(0.0).sqrt());
    let entry = |i: usize, j: usize| match sigma[i] * sigma[j] {
        _ if i == j => 1.0,
        0.0 => 0.0,
        product => (covariance[i][j] / product).clamp(-1.0, 1.0),
    };
    (PoseError::from_array(sigma), std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))))
}
