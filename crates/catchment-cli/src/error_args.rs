//! The expected pose errors, for the success probability.

use crate::failure::Failure;
use crate::source::read_table;
use catchment::design::{Design, SourceText, load};
use catchment::poses::{Distribution, Robot, Spread, TextError, read_robots, read_text};
use catchment::terminal::shown;
use clap::Args;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Heading of the options for expected errors.
pub(crate) const EXPECTED: &str = "Expected pose errors";

/// Which errors to expect.
#[derive(Debug, Args)]
#[group(multiple = false)]
pub(crate) struct ErrorArgs {
    /// Also compute the success probability of normal errors with these standard deviations, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", help_heading = EXPECTED)]
    error_sigma: Option<String>,
    /// Also compute the success probability of uniform errors within ± these bounds, such as "x=1 mm,yaw=2 deg"
    #[arg(long, hide_short_help = true, value_name = "AXIS=SIZE,…", help_heading = EXPECTED)]
    error_uniform: Option<String>,
}

impl ErrorArgs {
    /// Whether any expected errors are given.
    pub(crate) const fn is_some(&self) -> bool {
        self.error_sigma.is_some() || self.error_uniform.is_some()
    }

    /// The requested distribution, in D and radians.
    pub(crate) fn distribution(&self, design: &Design) -> Result<Option<Distribution>, Failure> {
        let (option, text, read) = match (&self.error_sigma, &self.error_uniform) {
            (Some(text), _) => ("--error-sigma", text, Distribution::normal(text, design)),
            (None, Some(text)) => ("--error-uniform", text, Distribution::uniform(text, design)),
            (None, None) => return Ok(None),
        };
        read.map(Some).map_err(|refusal| Failure::of_option(option, text, refusal))
    }
}

/// The same, or errors as a file has them.
#[derive(Debug, Args)]
pub(crate) struct SpreadArgs {
    #[command(flatten)]
    errors: ErrorArgs,
    /// Read measured pose errors from a table (CSV); - reads stdin
    #[arg(long, hide_short_help = true, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = EXPECTED,
          conflicts_with_all = ["error_sigma", "error_uniform"])]
    error_measured: Option<PathBuf>,
    /// Read the pose errors of a single robot from a file (TOML): covariance, sigma, uniform or measured
    #[arg(long, hide_short_help = true, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = EXPECTED,
          conflicts_with_all = ["error_sigma", "error_uniform", "error_measured"])]
    robots: Option<PathBuf>,
}

impl SpreadArgs {
    /// The expected errors: given, measured, or those of a single robot in a file.
    pub(crate) fn spread(&self, design: &Design) -> Result<Option<Spread>, Failure> {
        if let Some(path) = &self.robots {
            let mut robots = robots_of(path, design)?;
            return match (robots.pop(), robots.len()) {
                (Some(robot), 0) => Ok(Some(robot.errors)),
                (_, others) => {
                    let message =
                        format!("{} has {} robots, and this command takes one", shown(path), others + 1);
                    Err(Failure::with_help(message, Some("write that one into a file of its own".to_owned())))
                }
            };
        }
        if let Some(path) = &self.error_measured {
            return Ok(Some(Spread::measured(read_table(path)?, design)?));
        }
        let distribution = self.errors.distribution(design)?;
        Ok(distribution.map(|distribution| Spread::of(&distribution)).transpose()?)
    }
}

/// The robots of a file; paths of its tables are relative to its folder.
pub(crate) fn robots_of(path: &Path, design: &Design) -> Result<Vec<Robot>, Failure> {
    let source = SourceText::new(path, load(path)?);
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut table = |name: &str| {
        let place = folder.join(name);
        let read = File::open(&place).map_err(TextError::from).and_then(read_text);
        let unreadable = |error: TextError| format!("cannot read {}: {error}", shown(&place));
        read.map(|text| SourceText::new(&place, text)).map_err(unreadable)
    };
    Ok(read_robots(&source, design, &mut table)?)
}
