//! A comparison as aligned text.

use crate::study::reproduce::{Entry, TableComparison};
use std::fmt;

/// How a block shows an entry.
type Show = Box<dyn Fn(&Entry) -> String>;

impl fmt::Display for TableComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Table {}: {}", self.table, self.title)?;
        writeln!(f, "rows: {}; columns: {}; values in {}", self.row_name, self.column_name, self.unit)?;
        let unmarked = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), significant);
        let mut blocks: Vec<(String, Show)> =
            vec![("published".to_owned(), Box::new(|e: &Entry| significant(e.published)))];
        if self.summary.computed > 0 {
            let name = format!("ours, by the same method ({})", self.method);
            blocks.push((name, Box::new(move |e: &Entry| unmarked(e.ours))));
            let ratio = |e: &Entry| {
                let star = if e.matches == Some(false) { "*" } else { " " };
                e.ratio.map_or_else(|| "– ".to_owned(), |ratio| format!("{ratio:.3}{star}"))
            };
            blocks.push(("ours / published".to_owned(), Box::new(ratio)));
        }
        if self.summary.exact_mean_log_ratio.is_some() {
            let exact = move |e: &Entry| unmarked(e.exact.map(|exact| exact.value));
            blocks.push(("exact".to_owned(), Box::new(exact)));
            let ratio =
                |e: &Entry| e.exact_ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.3}"));
            blocks.push(("exact / published".to_owned(), Box::new(ratio)));
        }
        for (name, show) in blocks {
            writeln!(f, "\n{name}")?;
            block(f, self, &*show)?;
        }
        writeln!(f)?;
        self.write_summary(f)
    }
}

impl TableComparison {
    fn write_summary(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = &self.summary;
        if s.computed > 0 {
            writeln!(f, "as printed: {} of {}", s.as_printed, s.computed)?;
        }
        if let Some(tolerance) = self.tolerance.filter(|tolerance| *tolerance > 0.0 && s.computed > 0) {
            writeln!(f, "within {} %: {} of {}", 100.0 * tolerance, s.matching, s.computed)?;
        }
        if let (Some(median), Some(mean)) = (s.median_error, s.mean_log_ratio)
            && s.as_printed < s.computed
        {
            writeln!(f, "median error {:.2} %, mean |ln ratio| {mean:.3}", 100.0 * median)?;
        }
        if let Some(mean) = s.exact_mean_log_ratio {
            writeln!(f, "exact against published: mean |ln ratio| {mean:.3}")?;
        }
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        for (reason, places) in self.reasons() {
            writeln!(f, "* {}: {reason}", places.join(" "))?;
        }
        Ok(())
    }

    /// Why entries are known not to match, each with its entries.
    pub(super) fn reasons(&self) -> Vec<(&'static str, Vec<String>)> {
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
        reasons
    }
}

/// One matrix, right-aligned under its column heads.
fn block(
    f: &mut fmt::Formatter<'_>,
    table: &TableComparison,
    show: &dyn Fn(&Entry) -> String,
) -> fmt::Result {
    let mut lines =
        vec![std::iter::once(String::new()).chain(table.columns.iter().cloned()).collect::<Vec<_>>()];
    for (row, entries) in table.rows.iter().zip(&table.entries) {
        lines.push(std::iter::once(row.clone()).chain(entries.iter().map(show)).collect());
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
pub(super) fn significant(value: f64) -> String {
    let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 9.0);
    format!("{value:.*}", decimals as usize)
}
