//! The errors that a person expects, for the success probability.

use crate::failure::Failure;
use catchment::design::Design;
use catchment::poses::Distribution;
use clap::Args;

/// Which errors to expect.
#[derive(Debug, Args)]
#[group(multiple = false)]
pub(crate) struct ErrorArgs {
    /// Add the success probability for normal errors of these standard deviations, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", help_heading = "Errors to expect")]
    error_sigma: Option<String>,
    /// Add the success probability for errors uniform within ± these, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", help_heading = "Errors to expect")]
    error_uniform: Option<String>,
}

impl ErrorArgs {
    /// Whether any errors are asked about.
    pub(crate) const fn is_some(&self) -> bool {
        self.error_sigma.is_some() || self.error_uniform.is_some()
    }

    /// The distribution asked for, in D and radians.
    pub(crate) fn distribution(&self, design: &Design) -> Result<Option<Distribution>, Failure> {
        let (option, text, read) = match (&self.error_sigma, &self.error_uniform) {
            (Some(text), _) => ("--error-sigma", text, Distribution::normal(text, design)),
            (None, Some(text)) => ("--error-uniform", text, Distribution::uniform(text, design)),
            (None, None) => return Ok(None),
        };
        read.map(Some).map_err(|refusal| Failure::of_option(option, text, refusal))
    }
}
