//! Studies of published numbers and of the methods themselves.
//!
//! ```text
//!   reproduce    published tables, computed again                 many designs
//!   claims       what the text says of its tables, counted        in print, by ours, exactly
//!   resolution   figure 5.13: Sum and time over the resolution    one design, every method
//!   coverage     how often stated intervals hold                  many runs
//!   accuracy     how far each method is off the exact Sum         many designs
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

/// What to compute of everything published.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Request {
    /// Names of tables.
    pub tables: Vec<&'static str>,
    /// How the tables are computed.
    pub settings: reproduce::ReproduceSettings,
    /// Also figure 5.13.
    pub figure: bool,
    /// Also how often stated intervals hold.
    pub coverage: bool,
}

/// Name of the figure that is drawn again.
pub const FIGURE: &str = "5.13";

/// Name of the study of this program's own intervals.
pub const COVERAGE: &str = "coverage";

/// What was computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Reproduction {
    /// The tables, in the order of their numbers.
    pub tables: Vec<TableComparison>,
    /// Figure 5.13, where it was asked for.
    pub figure: Option<resolution::ResolutionFigure>,
    /// The coverage of intervals, where it was asked for.
    pub coverage: Option<Coverage>,
}

/// Why it could not be computed.
#[derive(Debug, thiserror::Error)]
pub enum RequestError {
    /// A table cannot.
    #[error(transparent)]
    Table(#[from] ReproduceError),
    /// The figure cannot.
    #[error(transparent)]
    Figure(#[from] RecipeError),
    /// The coverage cannot.
    #[error(transparent)]
    Coverage(#[from] CoverageError),
}

impl Request {
    /// What `names` ask for: tables, [`FIGURE`] and [`COVERAGE`]; every table where nothing is named. Names that are none of
    /// these ask for nothing.
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

    /// Computes it all: seconds to minutes.
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
