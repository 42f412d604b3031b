//! The errors that a person expects, for the success probability.

use crate::failure::Failure;
use catchment::design::{Complaint, Design, Quantity};
use catchment::merit::success::Distribution;
use catchment::pose::{Dof, PoseError};
use clap::Args;

/// Which errors to expect.
#[derive(Debug, Args)]
#[group(multiple = false)]
pub(crate) struct ErrorArgs {
    /// Add the success probability for normal errors of these standard deviations, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", value_parser = sizes, help_heading = "Errors to expect")]
    error_sigma: Option<Sizes>,
    /// Add the success probability for errors uniform within ± these, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", value_parser = sizes, help_heading = "Errors to expect")]
    error_uniform: Option<Sizes>,
}

/// A size per error, as written.
#[derive(Debug, Clone)]
struct Sizes(Vec<(Dof, Quantity)>);

impl ErrorArgs {
    /// Whether any errors are asked about.
    pub(super) const fn is_some(&self) -> bool {
        self.error_sigma.is_some() || self.error_uniform.is_some()
    }

    /// The distribution asked for, in D and radians.
    pub(super) fn distribution(&self, design: &Design) -> Result<Option<Distribution>, Failure> {
        let mean = PoseError::default();
        if let Some(sizes) = &self.error_sigma {
            let sigma = sizes.resolved(design, "--error-sigma")?;
            return Ok(Some(Distribution::Normal { mean, sigma }));
        }
        if let Some(sizes) = &self.error_uniform {
            let half_width = sizes.resolved(design, "--error-uniform")?;
            return Ok(Some(Distribution::Uniform { mean, half_width }));
        }
        Ok(None)
    }
}

impl Sizes {
    fn resolved(&self, design: &Design, option: &str) -> Result<PoseError, Failure> {
        let refused = |dof: Dof, why: &str, help: Option<String>| {
            Failure::with_help(format!("{option}: {}: {why}", dof.name()), help)
        };
        let mut error = [0.0; 5];
        for (dof, quantity) in &self.0 {
            if !design.alignment.free.contains(*dof) {
                let free: Vec<&str> = design.alignment.free.iter().map(Dof::name).collect();
                let help = format!("its free errors are {}", free.join(", "));
                return Err(refused(*dof, "this design locks it", Some(help)));
            }
            let size =
                if dof.is_rotation() { quantity.angle_rad() } else { quantity.length_d(&design.scale()) };
            let size = size.map_err(|complaint| refused(*dof, &complaint.to_string(), complaint.help()))?;
            if size < 0.0 {
                return Err(refused(*dof, "a size cannot be negative", None));
            }
            error[dof.index()] = size;
        }
        Ok(PoseError::from_array(error))
    }
}

fn sizes(text: &str) -> Result<Sizes, String> {
    let with_help = |complaint: &Complaint| match complaint.help() {
        Some(help) => format!("{complaint}; {help}"),
        None => complaint.to_string(),
    };
    let mut sizes: Vec<(Dof, Quantity)> = Vec::new();
    for part in text.split(',') {
        let (name, size) = part
            .split_once('=')
            .ok_or_else(|| format!("`{}` is no AXIS=SIZE, such as x=1 mm", part.trim()))?;
        let name = name.trim();
        let dof = Dof::ALL
            .into_iter()
            .find(|dof| dof.name() == name)
            .ok_or_else(|| format!("there is no axis `{name}`; the axes are x, y, roll, pitch and yaw"))?;
        if sizes.iter().any(|(known, _)| *known == dof) {
            return Err(format!("{name} is given twice"));
        }
        let size: Quantity = size.trim().parse().map_err(|complaint| with_help(&complaint))?;
        sizes.push((dof, size));
    }
    Ok(Sizes(sizes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_and_mistakes_named() {
        let read = sizes("x=1 mm, yaw = 2 deg").unwrap();
        assert_eq!(read.0.iter().map(|(dof, _)| *dof).collect::<Vec<_>>(), [Dof::X, Dof::Yaw]);
        assert_eq!(read.0[1].1.to_string(), "2 deg");
        let message = |text: &str| sizes(text).unwrap_err();
        assert_eq!(message("x"), "`x` is no AXIS=SIZE, such as x=1 mm");
        assert_eq!(message("z=1"), "there is no axis `z`; the axes are x, y, roll, pitch and yaw");
        assert_eq!(message("x=1,x=2"), "x is given twice");
        assert!(message("x=1 mmm").contains("mmm"));
    }
}
