//! Comparison of two acceptances: as versioned JSON, text and tables.

use super::document::Printed;
use super::envelope::{ReportBody, ReportEnvelope};
use super::schema::{AxisReport, Report};
use catchment_core::acceptance::Outcome;
use catchment_core::document::{Cell, Column, ColumnFormat, Document, Table, grouped, percent, significant};
use catchment_core::merit::comparison::{Comparison, Distances};
use serde::Serialize;
use std::borrow::Cow;

/// One side of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Compared {
    /// Path that was given for it.
    pub source: String,
    /// Its report, over its own grid.
    pub report: Report,
}

/// Result of a comparison, with its head.
pub type ComparisonReport = ReportEnvelope<ComparisonBody>;

/// Result of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComparisonBody {
    /// The first.
    pub first: Compared,
    /// The second.
    pub second: Compared,
    /// The axes of the common grid; empty for listed poses.
    pub axes: Vec<AxisReport>,
    /// The comparison.
    pub comparison: Comparison,
}

impl ReportBody for ComparisonBody {
    const KIND: &'static str = "comparison";
}

impl Printed for ComparisonBody {
    fn title(&self) -> Cow<'_, str> {
        "comparison".into()
    }

    fn document(&self) -> Document {
        let mut document = Document::default();
        for (name, Compared { source, report }) in [("first", &self.first), ("second", &self.second)] {
            document.row(name, format!("{}, by {}", report.design.name, report.method)).more(source);
        }
        let c = &self.comparison;
        let cells: Vec<String> = self.axes.iter().map(|axis| axis.cells.to_string()).collect();
        let over = if cells.is_empty() { "listed poses".to_owned() } else { cells.join(" × ") };
        document.row("compared on", format!("{over} = {} poses", grouped(c.poses)));
        document.section(None).table(self.measures());
        let only = |count: usize| {
            let share = percent(count as f64 / c.poses.max(1) as f64);
            format!("{share}: {} poses", grouped(count))
        };
        document
            .section(None)
            .row("Jaccard", format!("{:.4}: accepted by both, of all that one accepts", c.jaccard))
            .row("agreement", format!("{} of the poses: both accept or both reject", percent(c.agreement)))
            .row("only first", only(c.only_first))
            .row("only second", only(c.only_second));
        if let Some(distances) = &c.distances {
            document
                .section("poses that differ, from the border of the first accepted set")
                .table(table_of(distances));
        }
        document.section("outcomes: rows by the first, columns by the second").table(self.confusion());
        if self.first.report.design.alignment != self.second.report.design.alignment {
            let words =
                "the two do not have the same [alignment]: errors in D and rad are compared as they are";
            document.section(None).row("note", words);
        }
        document.table(self.data());
        document
    }
}

impl ComparisonBody {
    fn measures(&self) -> Table {
        let c = &self.comparison;
        let mut table = Table::new([
            Column::new("").left(),
            Column::new("first"),
            Column::new("second"),
            Column::new("second / first"),
        ]);
        let mut add = |name: String, [first, second]: [String; 2], ratio: Option<f64>| {
            let ratio = ratio.map_or_else(|| "–".to_owned(), |ratio| ColumnFormat::Fixed(4).of(ratio));
            table.push([name, first, second, ratio].map(Cell::from));
        };
        add(format!("Sum [{}]", c.unit), c.sums.map(significant), c.sum_ratio);
        if let Some(edges) = c.onaa_edges {
            add("ONAA edge".to_owned(), edges.map(|edge| ColumnFormat::Fixed(4).of(edge)), c.onaa_ratio);
        }
        table
    }

    /// The outcomes that occur.
    fn confusion(&self) -> Table {
        let confusion = &self.comparison.confusion;
        let occurs =
            |k: &usize| confusion[*k].iter().any(|n| *n > 0) || confusion.iter().any(|row| row[*k] > 0);
        let known: Vec<usize> = (0..Outcome::ALL.len()).filter(occurs).collect();
        let name = |k: &usize| Outcome::ALL[*k].word();
        let columns = known.iter().map(|k| Column::new(name(k)));
        let mut table = Table::new(std::iter::once(Column::new("").left()).chain(columns));
        for i in &known {
            let counts = known.iter().map(|j| confusion[*i][*j].into());
            table.push(std::iter::once(name(i).into()).chain(counts));
        }
        table
    }

    /// All outcomes by both.
    fn data(&self) -> Table {
        let mut table = Table::data("first second poses");
        for (row, first) in self.comparison.confusion.iter().zip(Outcome::ALL) {
            for (count, second) in row.iter().zip(Outcome::ALL) {
                table.push([first.name().into(), second.name().into(), (*count).into()]);
            }
        }
        table
    }
}

fn table_of(distances: &Distances) -> Table {
    let number = |title| Column::new(title).format(ColumnFormat::Significant);
    let mut table = Table::new([Column::new("").left(), number("median"), number("95 %"), number("max")]);
    for (name, q) in [("in cells", distances.cells), ("of the error box", distances.error_box)] {
        table.push([name.into(), q.median.into(), q.p95.into(), q.max.into()]);
    }
    table
}
