//! A comparison as aligned text.

use crate::study::reproduce::{Places, ReproducedEntry, TableComparison};
use std::fmt;

/// How a block shows an entry.
type Show<'a> = Box<dyn Fn(&ReproducedEntry) -> String + 'a>;

/// Legend of the marks of the largest and the smallest value.
pub(super) const MARKS: &str = "▲ largest, ▼ smallest: the source highlights those of the printed values; ours and the exact ones have their own";

/// A block of a table: its name, its display of an entry, its marked places.
struct Block<'a> {
    name: String,
    show: Show<'a>,
    marked: Option<&'a Places>,
}

impl fmt::Display for TableComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Table {}: {}", self.table, self.title)?;
        writeln!(f, "rows: {}; columns: {}; values in {}", self.row_name, self.column_name, self.unit)?;
        let unmarked = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), significant);
        let extremes = self.extremes.as_ref();
        let mut blocks = vec![Block {
            name: "published".to_owned(),
            show: Box::new(|e: &ReproducedEntry| significant(e.published)),
            marked: extremes.map(|extremes| &extremes.published),
        }];
        if self.summary.computed > 0 {
            let name = format!("ours, by the same method ({})", self.method);
            let marked = extremes.and_then(|extremes| extremes.ours.as_ref());
            blocks.push(Block { name, show: Box::new(move |e: &ReproducedEntry| unmarked(e.ours)), marked });
            let ratio = |e: &ReproducedEntry| {
                let star = if e.matches == Some(false) { "*" } else { " " };
                e.ratio.map_or_else(|| "– ".to_owned(), |ratio| format!("{ratio:.3}{star}"))
            };
            blocks.push(Block { name: "ours / published".to_owned(), show: Box::new(ratio), marked: None });
        }
        if self.summary.exact_mean_log_ratio.is_some() {
            let exact = move |e: &ReproducedEntry| unmarked(e.exact.map(|exact| exact.value));
            let marked = extremes.and_then(|extremes| extremes.exact.as_ref());
            blocks.push(Block { name: "exact".to_owned(), show: Box::new(exact), marked });
            let ratio = |e: &ReproducedEntry| {
                e.exact_ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.3}"))
            };
            blocks.push(Block { name: "exact / published".to_owned(), show: Box::new(ratio), marked: None });
        }
        for block in blocks {
            writeln!(f, "\n{}", block.name)?;
            write_block(f, self, &block)?;
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
        if self.extremes.is_some() {
            writeln!(f, "{MARKS}")?;
        }
        for (reason, places) in self.reasons() {
            writeln!(f, "* {}: {reason}", places.join(" "))?;
        }
        Ok(())
    }

    /// The reasons of known differences, each with its entries.
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

/// One matrix, right-aligned under its column headers; if places are marked, every number reserves space for a mark.
fn write_block(f: &mut fmt::Formatter<'_>, table: &TableComparison, block: &Block<'_>) -> fmt::Result {
    let room = if block.marked.is_some() { " " } else { "" };
    let head = table.columns.iter().map(|column| format!("{column}{room}"));
    let mut lines = vec![std::iter::once(String::new()).chain(head).collect::<Vec<_>>()];
    for (j, (row, entries)) in table.rows.iter().zip(&table.entries).enumerate() {
        let shown = entries.iter().enumerate().map(|(k, entry)| {
            let mark = block.marked.map(|places| places.mark([j, k]).unwrap_or(' '));
            format!("{}{}", (block.show)(entry), mark.map_or_else(String::new, String::from))
        });
        lines.push(std::iter::once(row.clone()).chain(shown).collect());
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
