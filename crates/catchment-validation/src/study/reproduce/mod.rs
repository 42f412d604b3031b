//! Published tables compared with the results of this program.
//!
//! ```text
//!   published      ours          ratio = ours / published
//!   ┌────────┐   ┌────────┐    ┌────────┐
//!   │ printed│   │computed│    │ 1.000  │   a known difference has a mark and a reason
//!   └────────┘   └────────┘    └────────┘
//! ```
//!
//! A third value is the exact one, where it exists: the same solids and rotation point, followed exactly
//! ([`ExactValue`]).
//!
//! The kinematic bounds (3.3, 3.4) are exact reproductions. The discrete tables (5.4 to 5.11) are computed with conventions that were
//! fitted to these very tables ([`crate::recipe::dissertation`]): agreement shows that the conventions are
//! understood, not that the numbers are right as physics.

use crate::published::PublishedError;
use crate::recipe::{self, ExactValue, RHO, RecipeError};
use crate::tables::{ReproducibleTable, TABLES};
use catchment::exec::{Cancelled, Exec};
use serde::Serialize;

mod extremes;

pub use extremes::{Extremes, Places};

/// Settings of a reproduction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct ReproduceSettings {
    /// Also the exact value of every entry: seconds to minutes per table.
    pub exact: bool,
}

/// One entry of a table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReproducedEntry {
    /// The printed value.
    pub published: f64,
    /// This program's value by the same method; null if it is not computed.
    pub ours: Option<f64>,
    /// `ours / published`.
    pub ratio: Option<f64>,
    /// Whether the two agree to the printed digits, or as the integer counts that they represent.
    pub as_printed: bool,
    /// Whether the two agree within the table's tolerance; null without a promised agreement or a computed
    /// value.
    pub matches: Option<bool>,
    /// Why the entry is known not to match.
    pub known_difference: Option<&'static str>,
    /// The exact value; null if it does not exist or was not requested.
    pub exact: Option<ExactValue>,
    /// `exact / published`.
    pub exact_ratio: Option<f64>,
}

/// Agreement of a table with its reproduction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summary {
    /// Number of entries.
    pub entries: usize,
    /// Number of entries computed by the same method.
    pub computed: usize,
    /// Number of entries that agree to the printed digits, or as counts.
    pub as_printed: usize,
    /// Number of entries that agree within the table's tolerance.
    pub matching: usize,
    /// Median of |ratio − 1|; null without computed entries.
    pub median_error: Option<f64>,
    /// Mean of |ln ratio|; null without computed entries.
    pub mean_log_ratio: Option<f64>,
    /// Mean of |ln ratio| of the exact values; null without exact values.
    pub exact_mean_log_ratio: Option<f64>,
}

/// A published table and ours.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TableComparison {
    /// Number of the table in the dissertation, such as `5.7`.
    pub table: &'static str,
    /// Its title.
    pub title: &'static str,
    /// The method of the table.
    pub method: &'static str,
    /// Unit of its values.
    pub unit: &'static str,
    /// Relative error within which an entry counts as matching; 0 where integer counts must agree; null without a
    /// promised agreement.
    pub tolerance: Option<f64>,
    /// Meaning of the rows, with their unit.
    pub row_name: &'static str,
    /// Names or values of the rows.
    pub rows: Vec<String>,
    /// Meaning of the columns, with their unit.
    pub column_name: &'static str,
    /// Names or values of the columns.
    pub columns: Vec<String>,
    /// The entries, row by row.
    pub entries: Vec<Vec<ReproducedEntry>>,
    /// The largest and the smallest values, for the tables in which the source highlights them (5.8 to 5.11); null
    /// elsewhere.
    pub extremes: Option<Extremes>,
    /// Measures of agreement.
    pub summary: Summary,
    /// Notes for the reader.
    pub notes: Vec<String>,
}

/// Reasons why a table cannot be reproduced.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReproduceError {
    /// No such table.
    #[error("there is no table `{name}` to reproduce; known are {}", known())]
    Unknown {
        /// The requested name.
        name: String,
    },
    /// A published file is not a valid table.
    #[error(transparent)]
    Published(#[from] PublishedError),
    /// The computation of an entry failed.
    #[error(transparent)]
    Entry(#[from] RecipeError),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn known() -> String {
    TABLES.iter().map(|t| t.name).collect::<Vec<_>>().join(", ")
}

/// Computes a published table and compares it with the printed one.
///
/// # Errors
/// When the table does not exist (the message lists the existing ones), or the computation is cancelled.
pub fn reproduce(
    table: &str,
    settings: &ReproduceSettings,
    exec: &Exec,
) -> Result<TableComparison, ReproduceError> {
    let unknown = || ReproduceError::Unknown { name: table.to_owned() };
    beside(ReproducibleTable::of(table).ok_or_else(unknown)?, *settings, exec)
}

/// Our values and the printed values of a table.
fn beside(
    table: &ReproducibleTable,
    settings: ReproduceSettings,
    exec: &Exec,
) -> Result<TableComparison, ReproduceError> {
    let published = table.published()?;
    let columns = published.columns.len();
    let row = |row: usize| table.recipe.row(row, columns, settings.exact, exec);
    let rows = exec.try_map(published.rows.len(), row)?;
    let result: Vec<recipe::RecipeEntry> = rows.into_iter().flatten().collect();
    let entry = |(k, &(ours, exact)): (usize, &recipe::RecipeEntry)| {
        let (row, column) = (k / columns, k % columns);
        let printed = published.values[row][column];
        ReproducedEntry {
            published: printed,
            ours,
            ratio: ours.map(|ours| ours / printed),
            as_printed: ours.is_some_and(|ours| table.recipe.agree(printed, ours)),
            matches: ours.and_then(|ours| table.matches(printed, ours)),
            known_difference: table.known_difference(row, column),
            exact,
            exact_ratio: exact.map(|exact| exact.value / printed),
        }
    };
    let flat: Vec<ReproducedEntry> = result.iter().enumerate().map(entry).collect();
    let entries: Vec<Vec<ReproducedEntry>> = flat.chunks(columns).map(<[ReproducedEntry]>::to_vec).collect();
    let mut notes: Vec<String> = table.notes.iter().map(|note| (*note).to_owned()).collect();
    if table.name == "3.2" {
        notes.extend(mean_ratios(&flat)?);
    }
    if settings.exact && flat.iter().any(|entry| entry.exact.is_some()) {
        notes.push(format!(
            "Exact: frictionless quasi-static motion from the same rotation point, ρ = {RHO} D."
        ));
    }
    Ok(TableComparison {
        table: table.name,
        title: table.title,
        method: table.recipe.method(),
        unit: table.unit,
        tolerance: table.tolerance,
        row_name: table.recipe.row_name(),
        rows: published.rows,
        column_name: table.column_name,
        columns: published.columns,
        summary: summarise(&flat),
        extremes: table.highlights.then(|| Extremes::of(&entries)),
        entries,
        notes,
    })
}

/// Means over all entries of X-Face over V-Face and X-Face over S-Face, of the printed tables and of ours.
fn mean_ratios(x_face: &[ReproducedEntry]) -> Result<Vec<String>, ReproduceError> {
    let mut notes = Vec::new();
    for (face, table, text) in [("V", "3.3", "1.8838"), ("S", "3.4", "2.3846")] {
        let [printed, ours] = mean_ratio(x_face, table)?;
        let follows = if (printed - text.parse().unwrap_or(printed)).abs() < 2e-4 {
            "as the text says to its digits"
        } else {
            "which the text's own tables do not give"
        };
        notes.push(format!(
            "Mean over all entries of X/{face}: {printed:.4} from the printed tables (the text: {text}, {follows}), {ours:.4} \
             from ours."
        ));
    }
    Ok(notes)
}

/// Mean over all entries of the ratio of the X-Face to another face: printed, ours.
fn mean_ratio(x_face: &[ReproducedEntry], other: &str) -> Result<[f64; 2], ReproduceError> {
    let unknown = || ReproduceError::Unknown { name: other.to_owned() };
    let values = ReproducibleTable::of(other).ok_or_else(unknown)?.published()?.values.concat();
    let of = |value: &dyn Fn(&ReproducedEntry) -> f64| {
        x_face.iter().zip(&values).map(|(entry, other)| value(entry) / other).sum::<f64>()
            / values.len() as f64
    };
    // The printed tables of the other two faces equal ours in every entry.
    Ok([of(&|entry| entry.published), of(&|entry| entry.ours.unwrap_or(f64::NAN))])
}

fn summarise(entries: &[ReproducedEntry]) -> Summary {
    let mean_log = |ratios: &mut dyn Iterator<Item = f64>| {
        let logs: Vec<f64> = ratios.map(|ratio| ratio.ln().abs()).collect();
        (!logs.is_empty()).then(|| logs.iter().sum::<f64>() / logs.len() as f64)
    };
    let mut errors: Vec<f64> = entries.iter().filter_map(|e| Some((e.ratio? - 1.0).abs())).collect();
    errors.sort_by(f64::total_cmp);
    let middle = errors.len() / 2;
    let median_error = match errors.len() {
        0 => None,
        n if n % 2 == 1 => Some(errors[middle]),
        _ => Some(f64::midpoint(errors[middle - 1], errors[middle])),
    };
    Summary {
        entries: entries.len(),
        computed: errors.len(),
        as_printed: entries.iter().filter(|e| e.as_printed).count(),
        matching: entries.iter().filter(|e| e.matches == Some(true)).count(),
        median_error,
        mean_log_ratio: mean_log(&mut entries.iter().filter_map(|e| e.ratio)),
        exact_mean_log_ratio: mean_log(&mut entries.iter().filter_map(|e| e.exact_ratio)),
    }
}

#[cfg(test)]
mod tests;
