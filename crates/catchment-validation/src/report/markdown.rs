//! All comparisons as a page of the documentation.

use super::text::{MARKS, significant};
use crate::study::claims::{Claim, claims};
use crate::study::reproduce::{Places, ReproducedEntry, TableComparison};
use crate::study::resolution;
use crate::tables::HELD;
use std::fmt::{self, Write};

const HEAD: &str = "\
# Reproduction

Does the program reproduce the dissertation? Every published number of it (\"High-Dimensional Design Evaluations for Self-Aligning Connector Geometries\") that
is held in `reference/dissertation/`, beside what this program computes (terms: [glossary](glossary.md)). Numbers whose settings the source does not state may differ. Written by

    catchment reproduce --markdown > docs/reproduction.md

";

const READING: &str = "\
Each cell reads *published / ours (ratio) / exact*: **ours** is computed by the same method, with ours / published in brackets and
a star where the two are known to differ; **exact** is what frictionless quasi-static motion gives from the same rotation point,
with ρ = 0.5 D. A dash: not computed. `catchment reproduce --exact --csv` has every number; `-o DIR` adds pictures.
";

/// The page; `took` states the date and the computing effort.
///
/// # Errors
/// Never fails: it writes to a string.
pub fn page(
    tables: &[TableComparison],
    figure: Option<&resolution::ResolutionFigure>,
    took: &str,
) -> Result<String, fmt::Error> {
    let mut page = HEAD.to_owned();
    writeln!(page, "{took}\n\n{READING}")?;
    page.push_str(
        "| table | by | as printed | within tolerance | mean abs ln ratio | exact: mean abs ln ratio |\n",
    );
    page.push_str("|---|---|---:|---:|---:|---:|\n");
    for table in tables {
        let s = &table.summary;
        let shown = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"));
        let of = |n: usize| if s.computed == 0 { "–".to_owned() } else { format!("{n} of {}", s.computed) };
        let within = if table.tolerance.is_some() { of(s.matching) } else { "no target".to_owned() };
        let (ours, exact) = (shown(s.mean_log_ratio), shown(s.exact_mean_log_ratio));
        writeln!(
            page,
            "| {} {} | {} | {} | {within} | {ours} | {exact} |",
            table.table,
            table.title,
            table.method,
            of(s.as_printed)
        )?;
    }
    page.push_str("\nHeld or known, and not computed:\n\n");
    for held in HELD {
        writeln!(page, "- **{}** {}: {}.", held.name, held.title, held.reason)?;
    }
    for table in tables {
        write_table(&mut page, table)?;
    }
    if let Some(figure) = figure {
        write_figure(&mut page, figure)?;
    }
    write_claims(&mut page, &claims(tables))?;
    Ok(page)
}

fn write_claims(page: &mut String, claims: &[Claim]) -> fmt::Result {
    if claims.is_empty() {
        return Ok(());
    }
    page.push_str(
        "\n## What the text says of these tables\n\n\
         Each sentence as a count: in the printed tables, in ours by the same method, and in the exact ones (a dash: not computed, or said of \
         the method).\n\n\
         | section | the text | counted | printed | ours | exact |\n|---|---|---|---:|---:|---:|\n",
    );
    for claim in claims {
        let [printed, ours, exact] = claim.shown();
        writeln!(
            page,
            "| {} | {} | {} | {printed} | {ours} | {exact} |",
            claim.section, claim.says, claim.counted
        )?;
    }
    Ok(())
}

fn write_table(page: &mut String, table: &TableComparison) -> fmt::Result {
    writeln!(page, "\n## {}: {}\n", table.table, table.title)?;
    writeln!(page, "Values in {}; columns: {}.\n", table.unit, table.column_name)?;
    writeln!(page, "| {} | {} |", table.row_name, table.columns.join(" | "))?;
    writeln!(page, "|---|{}", "---:|".repeat(table.columns.len()))?;
    for (j, (row, entries)) in table.rows.iter().zip(&table.entries).enumerate() {
        let cells: Vec<String> =
            entries.iter().enumerate().map(|(k, entry)| cell(table, entry, [j, k])).collect();
        writeln!(page, "| {row} | {} |", cells.join(" | "))?;
    }
    page.push('\n');
    if table.extremes.is_some() {
        writeln!(page, "- {MARKS}.")?;
    }
    for note in &table.notes {
        writeln!(page, "- {note}")?;
    }
    for (reason, places) in table.reasons() {
        writeln!(page, "- \\* {}: {reason}.", places.join(" "))?;
    }
    Ok(())
}

fn cell(table: &TableComparison, entry: &ReproducedEntry, place: [usize; 2]) -> String {
    let mark = |places: Option<&Places>| {
        places.and_then(|places| places.mark(place)).map_or_else(String::new, String::from)
    };
    let extremes = table.extremes.as_ref();
    let ours = match (entry.ours, entry.ratio) {
        (Some(ours), Some(ratio)) => {
            let star = if entry.matches == Some(false) { "\\*" } else { "" };
            let marked = mark(extremes.and_then(|extremes| extremes.ours.as_ref()));
            format!("{}{marked} ({ratio:.2}{star})", significant(ours))
        }
        _ => "–".to_owned(),
    };
    let marked = mark(extremes.and_then(|extremes| extremes.exact.as_ref()));
    let exact = entry.exact.map_or_else(|| "–".to_owned(), |exact| significant(exact.value));
    let printed = mark(extremes.map(|extremes| &extremes.published));
    format!("{}{printed} / {ours} / {exact}{marked}", significant(entry.published))
}

fn write_figure(page: &mut String, figure: &resolution::ResolutionFigure) -> fmt::Result {
    page.push_str("\n## 5.13: convergence, V-Face, H/D ¼, COR −½\n\n");
    let [lo, hi] = figure.exact_ci95.map(significant);
    writeln!(
        page,
        "No point of the published figure is held; its text says that the area starts larger and slowly decreases, and that \
         the time grows like N². Exact Sum {} D·rad (95 % interval {lo} … {hi}). Sum, and seconds, over N samples or cells \
         per axis; `catchment reproduce 5.13 -o DIR` draws it.\n",
        significant(figure.exact)
    )?;
    let names: Vec<&str> = figure.curves.iter().map(|curve| curve.name).collect();
    writeln!(page, "| N | {} |", names.join(" | "))?;
    writeln!(page, "|---:|{}", "---:|".repeat(names.len()))?;
    for resolution in &figure.settings.resolutions {
        let point = |curve: &resolution::MethodCurve| {
            let result = curve.points.iter().find(|point| point.resolution == *resolution);
            result.map_or_else(|| "–".to_owned(), |p| format!("{} ({:.3} s)", significant(p.sum), p.seconds))
        };
        let cells: Vec<String> = figure.curves.iter().map(point).collect();
        writeln!(page, "| {resolution} | {} |", cells.join(" | "))?;
    }
    Ok(())
}
