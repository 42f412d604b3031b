//! Output of the studies for people and programs.
//!
//! ```text
//!   Reproduction ─┬─ text      aligned tables, a summary, the omissions
//!   Accuracy      ├─ records   one line per entry, for CSV
//!                 ├─ json      versioned
//!                 ├─ markdown  the pages of the documentation
//!                 └─ figure    pictures (feature `figure`)
//! ```
//!
//! Numbers in records and JSON have all their digits; texts round them.

mod accuracy;
mod coverage;
#[cfg(feature = "figure")]
pub mod figure;
#[cfg(feature = "figure")]
pub mod folder;
mod markdown;
mod summary;
mod text;

pub use markdown::page;

use crate::study::accuracy::Accuracy;
use crate::study::claims::claims;
use crate::study::reproduce::TableComparison;
use crate::study::{COVERAGE, Reproduction};
use catchment::diagnostic::{Diagnostic, Warning};
use serde_json::{Value, json};

/// Version of the JSON.
pub const JSON_SCHEMA: u32 = 2;

/// The columns of [`Reproduction::records`].
const COLUMNS: [&str; 14] = [
    "table",
    "row",
    "column",
    "unit",
    "published",
    "ours",
    "ratio",
    "as_printed",
    "matches",
    "exact",
    "exact_lo",
    "exact_hi",
    "exact_ratio",
    "known_difference",
];

/// Computing effort of a study, which differs between equal runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Wall-clock time.
    pub seconds: f64,
    /// Threads.
    pub threads: usize,
}

impl Effort {
    /// The line of a page that states the effort; `version` is the program's.
    fn line(&self, version: &str) -> String {
        format!("It took {:.0} s on {} threads, with version {version}.", self.seconds, self.threads)
    }
}

impl Reproduction {
    /// The JSON of the results; `version` is the program's.
    pub fn json(&self, version: &str) -> Value {
        let tables: Vec<Value> = self.tables.iter().map(table).collect();
        let mut report = json!({ "schema": JSON_SCHEMA, "catchment": version, "tables": tables });
        let claims = claims(&self.tables);
        if !claims.is_empty() {
            report["claims"] = json!(claims);
        }
        if let Some(figure) = &self.figure {
            report["figure_5_13"] = json!(figure);
        }
        if let Some(coverage) = &self.coverage {
            report[COVERAGE] = json!(coverage);
        }
        report
    }

    /// Every entry of the tables as a record for programs, after a header record.
    pub fn records(&self) -> Vec<Vec<String>> {
        let known = |value: Option<f64>| value.map_or_else(String::new, number);
        let mut records = vec![COLUMNS.map(str::to_owned).to_vec()];
        for table in &self.tables {
            for (row, entries) in table.rows.iter().zip(&table.entries) {
                for (column, entry) in table.columns.iter().zip(entries) {
                    let ci95 = entry.exact.and_then(|exact| exact.ci95);
                    records.push(vec![
                        table.table.to_owned(),
                        row.clone(),
                        column.clone(),
                        table.unit.to_owned(),
                        number(entry.published),
                        known(entry.ours),
                        known(entry.ratio),
                        entry.as_printed.to_string(),
                        entry.matches.map_or_else(String::new, |matches| matches.to_string()),
                        known(entry.exact.map(|exact| exact.value)),
                        known(ci95.map(|[lo, _]| lo)),
                        known(ci95.map(|[_, hi]| hi)),
                        known(entry.exact_ratio),
                        entry.known_difference.unwrap_or("").to_owned(),
                    ]);
                }
            }
        }
        records
    }

    /// The page of the documentation.
    ///
    /// # Errors
    /// Never fails: it writes to a string.
    pub fn markdown(&self, version: &str, effort: &Effort) -> Result<String, std::fmt::Error> {
        page(&self.tables, self.figure.as_ref(), &effort.line(version))
    }

    /// Warnings to read before using any of these numbers.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        if self.tables.iter().any(is_fitted) {
            vec![Warning::DissertationConventions.into()]
        } else {
            Vec::new()
        }
    }
}

impl Accuracy {
    /// The JSON.
    pub fn json(&self, effort: &Effort) -> Value {
        let timing = json!({ "total_s": effort.seconds, "threads": effort.threads });
        json!({ "schema": JSON_SCHEMA, "accuracy": self, "timing": timing })
    }

    /// The page of the documentation.
    ///
    /// # Errors
    /// Never fails: it writes to a string.
    pub fn page(&self, version: &str, effort: &Effort) -> Result<String, std::fmt::Error> {
        self.markdown(&effort.line(version))
    }
}

/// Whether the dissertation preset computed the table; the kinematic bounds do not need the preset.
fn is_fitted(table: &TableComparison) -> bool {
    table.method.contains("preset")
}

fn table(table: &TableComparison) -> Value {
    let mut value = json!(table);
    let warnings: Vec<Diagnostic> =
        if is_fitted(table) { vec![Warning::DissertationConventions.into()] } else { Vec::new() };
    let with_kind = |warning: &Diagnostic| {
        let mut entry = json!(warning);
        entry["kind"] = warning.code.as_ref().into();
        entry
    };
    value["warnings"] = warnings.iter().map(with_kind).collect();
    value
}

/// A number with all its digits, as in tables for programs.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), ToOwned::to_owned)
}

#[cfg(test)]
mod tests;
