//! Studies of published numbers and of the methods themselves.
//!
//! ```text
//!   reproduce    published tables, recomputed                     many designs
//!   claims       statements of the text on its tables, counted    in print, by ours, exactly
//!   resolution   figure 5.13: Sum and time over the resolution    one design, every method
//!   coverage     coverage of stated intervals                     many runs
//!   accuracy     error of each method against the exact Sum       many designs
//! ```

pub mod accuracy;
pub mod claims;
pub mod coverage;
pub mod reproduce;
pub mod resolution;

use crate::recipe::RecipeError;
use crate::tables::TABLES;
use catchment::exec::Exec;
use coverage::{Coverage, CoverageError};
use reproduce::{ReproduceError, TableComparison};

/// Selection of the published results to compute.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Request {
    /// Names of tables.
    pub tables: Vec<&'static str>,
    /// Settings of the tables.
    pub settings: reproduce::ReproduceSettings,
    /// Whether to compute figure 5.13.
    pub figure: bool,
    /// Whether to compute the coverage of stated intervals.
    pub coverage: bool,
}

/// Name of the recomputed figure.
pub const FIGURE: &str = "5.13";

/// Name of the coverage study of this program's own intervals.
pub const COVERAGE: &str = "coverage";

/// The computed results.
#[derive(Debug, Clone, PartialEq)]
pub struct Reproduction {
    /// The tables, in the order of their numbers.
    pub tables: Vec<TableComparison>,
    /// Figure 5.13, if requested.
    pub figure: Option<resolution::ResolutionFigure>,
    /// The coverage of intervals, if requested.
    pub coverage: Option<Coverage>,
}

/// Reasons why the computation fails.
#[derive(Debug, thiserror::Error)]
pub enum RequestError {
    /// A table failed.
    #[error(transparent)]
    Table(#[from] ReproduceError),
    /// The figure failed.
    #[error(transparent)]
    Figure(#[from] RecipeError),
    /// The coverage failed.
    #[error(transparent)]
    Coverage(#[from] CoverageError),
}

impl Request {
    /// The selection for `names`: tables, [`FIGURE`] and [`COVERAGE`]; every table if `names` is empty. Unknown names are
    /// ignored.
    pub fn of(names: &[String], settings: reproduce::ReproduceSettings) -> Self {
        let named = |name: &str| names.iter().any(|n| n == name);
        let tables = TABLES.iter().map(|table| table.name);
        Self {
            tables: tables.filter(|name| names.is_empty() || named(name)).collect(),
            settings,
            figure: named(FIGURE),
            coverage: named(COVERAGE),
        }
    }

    /// Computes the whole selection: seconds to minutes.
    ///
    /// # Errors
    /// See [`RequestError`].
    pub fn run(&self, exec: &Exec) -> Result<Reproduction, RequestError> {
        let mut tables = Vec::new();
        for (k, name) in self.tables.iter().enumerate() {
            exec.report(k as f64 / self.tables.len() as f64, "tables");
            tables.push(reproduce::reproduce(name, &self.settings, exec)?);
        }
        let figure = self
            .figure
            .then(|| resolution::run(&resolution::ResolutionStudySettings::default(), exec))
            .transpose()?;
        let coverage = self
            .coverage
            .then(|| coverage::coverage(&coverage::CoverageSettings::default(), exec))
            .transpose()?;
        Ok(Reproduction { tables, figure, coverage })
    }
}
