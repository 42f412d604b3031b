//! Published tables beside what this program computes.
//!
//! ```text
//!   published      ours          ratio = ours / published
//!   ┌────────┐   ┌────────┐    ┌────────┐
//!   │ printed│   │computed│    │ 1.000  │   an entry that is known not to match says so and why
//!   └────────┘   └────────┘    └────────┘
//! ```
//!
//! The kinematic bounds (3.3, 3.4) are exact. The discrete tables (5.4 to 5.9) are computed with conventions that were
//! fitted to these very tables ([`crate::method::flood::dissertation`]): agreement shows that the conventions are
//! understood, not that the numbers are right as physics.

mod published;
mod tables;
mod text;

pub use tables::{TABLES, Table};

use crate::exec::{Cancelled, Exec};
use crate::method::flood::dissertation::DissertationError;
use rayon::prelude::*;
use serde::Serialize;

/// One entry of a table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Entry {
    /// The printed value.
    pub published: f64,
    /// What this program computes.
    pub ours: f64,
    /// `ours / published`.
    pub ratio: f64,
    /// Whether the two agree to the printed digits, or as the integer counts that they stand for.
    pub exact: bool,
    /// Whether the two agree within the table's tolerance.
    pub matches: bool,
    /// Why the entry is known not to match.
    pub known_difference: Option<&'static str>,
}

/// How well a table is reproduced.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summary {
    /// Number of entries.
    pub entries: usize,
    /// How many are exact.
    pub exact: usize,
    /// How many agree within the table's tolerance.
    pub matching: usize,
    /// Median of |ratio − 1|.
    pub median_error: f64,
    /// Mean of |ln ratio|.
    pub mean_log_ratio: f64,
}

/// A published table beside ours.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TableComparison {
    /// Number of the table in the dissertation, such as `5.7`.
    pub table: &'static str,
    /// What it holds.
    pub title: &'static str,
    /// Unit of its values.
    pub unit: &'static str,
    /// Relative error within which an entry counts as matching; 0 where integer counts must agree.
    pub tolerance: f64,
    /// What the rows are, with their unit.
    pub row_name: &'static str,
    /// Values of the rows.
    pub rows: Vec<f64>,
    /// What the columns are, with their unit.
    pub column_name: &'static str,
    /// Values of the columns.
    pub columns: Vec<f64>,
    /// The entries, row by row.
    pub entries: Vec<Vec<Entry>>,
    /// How well they agree.
    pub summary: Summary,
    /// What a reader must know.
    pub notes: Vec<&'static str>,
}

/// Why a table cannot be reproduced.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReproduceError {
    /// No such table.
    #[error("there is no table `{name}` to reproduce; known are {}", known())]
    Unknown {
        /// What was asked for.
        name: String,
    },
    /// A published table does not read as a table.
    #[error("the published table {table} cannot be read: {reason}")]
    Published {
        /// Which table.
        table: &'static str,
        /// What is wrong.
        reason: String,
    },
    /// An entry cannot be computed.
    #[error(transparent)]
    Entry(#[from] DissertationError),
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn known() -> String {
    TABLES.iter().map(|t| t.name).collect::<Vec<_>>().join(", ")
}

/// Computes a published table and sets it beside the printed one.
///
/// # Errors
/// When there is no such table (the message lists those there are), or the computation is cancelled.
pub fn reproduce(table: &str, exec: &Exec) -> Result<TableComparison, ReproduceError> {
    let unknown = || ReproduceError::Unknown { name: table.to_owned() };
    let table = TABLES.iter().find(|t| t.name == table).ok_or_else(unknown)?;
    let published = published::read(table)?;
    let columns = published.columns.len();
    let places = published.rows.len() * columns;
    let ours: Vec<f64> = exec.install(|| {
        (0..places)
            .into_par_iter()
            .map(|k| table.compute(k / columns, k % columns, exec))
            .collect::<Result<_, _>>()
    })?;
    let entry = |(k, &ours): (usize, &f64)| {
        let (row, column) = (k / columns, k % columns);
        let printed = published.values[row][column];
        let ratio = ours / printed;
        Entry {
            published: printed,
            ours,
            ratio,
            exact: table.exact(printed, ours),
            matches: table.matches(printed, ours),
            known_difference: table.known_difference(row, column),
        }
    };
    let flat: Vec<Entry> = ours.iter().enumerate().map(entry).collect();
    Ok(TableComparison {
        table: table.name,
        title: table.title,
        unit: table.unit,
        tolerance: table.tolerance,
        row_name: "H/D",
        rows: published.rows,
        column_name: table.column_name,
        columns: published.columns,
        summary: summarise(&flat),
        entries: flat.chunks(columns).map(<[Entry]>::to_vec).collect(),
        notes: table.notes.to_vec(),
    })
}

fn summarise(entries: &[Entry]) -> Summary {
    let count = |has: fn(&Entry) -> bool| entries.iter().filter(|e| has(e)).count();
    let mut errors: Vec<f64> = entries.iter().map(|e| (e.ratio - 1.0).abs()).collect();
    errors.sort_by(f64::total_cmp);
    let middle = errors.len() / 2;
    let median_error = if errors.len() % 2 == 1 {
        errors[middle]
    } else {
        f64::midpoint(errors[middle - 1], errors[middle])
    };
    Summary {
        entries: entries.len(),
        exact: count(|e| e.exact),
        matching: count(|e| e.matches),
        median_error,
        mean_log_ratio: entries.iter().map(|e| e.ratio.ln().abs()).sum::<f64>() / entries.len() as f64,
    }
}

#[cfg(test)]
mod tests;
