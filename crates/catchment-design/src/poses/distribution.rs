//! Distributions of pose errors.

use super::terms::terms;
use super::{FAMILY, defect};
use crate::design::{Design, Quantity};
use catchment_base::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment_base::pose::{Dof, PoseError};
use serde::{Deserialize, Serialize};

/// Distribution of pose errors. Lists of five numbers are in the order of [`Dof::ALL`], in D and radians; 0
/// for errors that do not occur.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Distribution {
    /// Independent normal errors.
    Normal {
        /// Mean of each error.
        mean: PoseError,
        /// Standard deviation of each error.
        sigma: PoseError,
    },
    /// Correlated normal errors.
    Correlated {
        /// Mean of each error.
        mean: PoseError,
        /// Covariance matrix, in D², D·rad and rad².
        covariance: [[f64; 5]; 5],
        /// Number of sampled poses.
        samples: u32,
        /// Seed of the random numbers: the same seed gives the same result on any machine.
        seed: u64,
    },
    /// Uniform in a box.
    Uniform {
        /// Centre of the box.
        mean: PoseError,
        /// Half-width of the box along each error.
        half_width: PoseError,
    },
}

impl Distribution {
    /// Independent normal errors around zero with standard deviations such as `x=1 mm,yaw=2 deg`; errors that are not named
    /// do not occur.
    ///
    /// # Errors
    /// Everything that is wrong with the text: sizes are not negative, and of errors that the design leaves free.
    pub fn normal(sigmas: &str, design: &Design) -> Result<Self, Diagnostics> {
        Ok(Self::Normal { mean: PoseError::default(), sigma: sizes(sigmas, design)? })
    }

    /// Independent errors, uniform within ± half-widths such as `x=1 mm,yaw=2 deg`; errors that are not named do not occur.
    ///
    /// # Errors
    /// As [`Distribution::normal`].
    pub fn uniform(half_widths: &str, design: &Design) -> Result<Self, Diagnostics> {
        Ok(Self::Uniform { mean: PoseError::default(), half_width: sizes(half_widths, design)? })
    }
}

/// A size of each error, in D and radians; 0 for errors that are not named.
fn sizes(text: &str, design: &Design) -> Result<PoseError, Diagnostics> {
    Ok(PoseError::from_array(parse_sizes(text, design)?.map(Option::unwrap_or_default)))
}

/// Reads sizes of errors such as `x=1 mm,yaw=2 deg`: in the order of [`Dof::ALL`], in D and radians, `None`
/// for errors that are not named.
///
/// # Errors
/// All errors of the text: sizes must not be negative, and must belong to free errors of the design.
pub fn parse_sizes(text: &str, design: &Design) -> Result<[Option<f64>; 5], Diagnostics> {
    let mut result = DiagnosticCollector::default();
    let (written, spans) = terms(text, &mut result);
    let mut values = [None; 5];
    for dof in Dof::ALL {
        let Some(quantity) = written[dof.index()] else { continue };
        match size(dof, quantity, design) {
            Ok(value) => values[dof.index()] = Some(value),
            Err(fault) => result.push_at(fault, || Some(spans[dof.index()].clone())),
        }
    }
    result.refuse()?;
    Ok(values)
}

/// A size of an error, in D or radians.
pub(super) fn size(dof: Dof, quantity: Quantity, design: &Design) -> Result<f64, Diagnostic> {
    let name = dof.name();
    if !design.alignment.free.contains(dof) {
        let free: Vec<&str> = design.alignment.free.iter().map(Dof::name).collect();
        let help = format!("its free errors are {}", free.join(", "));
        return Err(defect(format!("{name}: this design locks it"), help));
    }
    let size = if dof.is_rotation() { quantity.angle_rad() } else { quantity.length_d(&design.scale()) };
    let size = size.map_err(|c| Diagnostic::error(FAMILY, format!("{name}: {c}"), c.help()))?;
    if size < 0.0 {
        return Err(Diagnostic::error(FAMILY, format!("{name}: a size cannot be negative"), None));
    }
    Ok(size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn sizes_are_read_and_mistakes_come_with_their_places() {
        let text = "[connector]\nfamily = \"v-face\"\nwidth = 50\nunit = \"mm\"\n";
        let design = crate::design::read(text, Path::new("")).unwrap().design;
        let normal = Distribution::normal("x=1 mm, pitch = 2 deg", &design).unwrap();
        let Distribution::Normal { mean, sigma } = normal else { panic!("{normal:?}") };
        // A division and a multiplication.
        assert!(mean == PoseError::default() && (sigma.x - 0.02).abs() < 1e-17);
        assert_eq!(sigma.pitch, 2f64.to_radians());
        let text = "x=-1,pitch=1 mmm,yaw=1,z=1,x=2,y";
        let refusal = Distribution::uniform(text, &design).unwrap_err();
        let places: Vec<&str> = refusal.list.iter().map(|o| &text[o.span.clone().unwrap()]).collect();
        assert_eq!(places, ["x=-1", "pitch=1 mmm", "yaw=1", "z=1", "x=2", "y"]);
    }
}
