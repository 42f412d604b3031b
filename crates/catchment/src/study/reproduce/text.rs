//! A comparison as aligned text.

use super::{Entry, TableComparison};
use std::fmt;

/// How a block shows an entry.
type Show = fn(&Entry) -> String;

impl fmt::Display for TableComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Table {}: {}", self.table, self.title)?;
        writeln!(f, "rows: {}; columns: {}; values in {}", self.row_name, self.column_name, self.unit)?;
        let blocks: [(&str, Show); 3] = [
            ("published", |e| significant(e.published)),
            ("ours", |e| significant(e.ours)),
            ("ours / published", |e| format!("{:.3}{}", e.ratio, if e.matches { " " } else { "*" })),
        ];
        for (name, show) in blocks {
            writeln!(f, "\n{name}")?;
            block(f, self, show)?;
        }
        writeln!(f)?;
        self.write_summary(f)
    }
}

impl TableComparison {
    fn write_summary(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = &self.summary;
        writeln!(f, "exact: {} of {}", s.exact, s.entries)?;
        if self.tolerance > 0.0 {
            writeln!(f, "within {:.0} %: {} of {}", 100.0 * self.tolerance, s.matching, s.entries)?;
        }
        if s.exact < s.entries {
            let median = 100.0 * s.median_error;
            writeln!(f, "median error {median:.2} %, mean |ln ratio| {:.3}", s.mean_log_ratio)?;
        }
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
        for (row, entries) in self.rows.iter().zip(&self.entries) {
            for (column, entry) in self.columns.iter().zip(entries) {
                let Some(reason) = entry.known_difference else { continue };
                let place = format!("({row}, {column})");
                match reasons.iter_mut().find(|(r, _)| *r == reason) {
                    Some((_, places)) => places.push(place),
                    None => reasons.push((reason, vec![place])),
                }
            }
        }
        for (reason, places) in reasons {
            writeln!(f, "* {}: {reason}", places.join(" "))?;
        }
        Ok(())
    }
}

/// One matrix, right-aligned under its column heads.
fn block(f: &mut fmt::Formatter<'_>, table: &TableComparison, show: Show) -> fmt::Result {
    let mut lines = vec![
        std::iter::once(String::new())
            .chain(table.columns.iter().map(ToString::to_string))
            .collect::<Vec<_>>(),
    ];
    for (row, entries) in table.rows.iter().zip(&table.entries) {
        lines.push(std::iter::once(row.to_string()).chain(entries.iter().map(show)).collect());
    }
    let widths: Vec<usize> = (0..=table.columns.len())
        .map(|c| lines.iter().map(|l| l[c].chars().count()).max().unwrap_or(0))
        .collect();
    for line in &lines {
        let cells: Vec<String> = line.iter().zip(&widths).map(|(cell, w)| format!("{cell:>w$}")).collect();
        writeln!(f, "  {}", cells.join("  ").trim_end())?;
    }
    Ok(())
}

/// Four significant digits.
fn significant(value: f64) -> String {
    let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 9.0);
    format!("{value:.*}", decimals as usize)
}
