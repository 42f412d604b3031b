//! Two acceptances beside each other, and all methods of a design beside each other: as versioned JSON and as text.

use super::envelope::{Body, Envelope};
use super::schema::{Axis, Report, Timing, axes};
use super::table::heading;
use super::text::{grouped, line, percent, row, significant, wrapped};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::merit::comparison::{Comparison, Overlap, Paired, Quantiles};
use catchment_core::run::Answer;
use serde::Serialize;
use std::fmt::{Display, Write};
use std::time::Duration;

/// Values one after another, each to the right of its column.
fn columns<T: Display>(width: usize, values: impl Iterator<Item = T>) -> String {
    values.fold(String::new(), |mut text, value| {
        // Writing to a String cannot fail.
        let _ = write!(text, "{value:>width$}");
        text
    })
}

/// One of the two.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Compared {
    /// Where it comes from: the path that was given.
    pub source: String,
    /// Everything about it, over its own grid.
    pub report: Report,
}

/// What a comparison has to say, with its head.
pub type ComparisonReport = Envelope<ComparisonBody>;

/// What a comparison has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComparisonBody {
    /// The first.
    pub first: Compared,
    /// The second.
    pub second: Compared,
    /// The axes of the grid on which they are compared; empty for listed poses.
    pub axes: Vec<Axis>,
    /// How they compare.
    pub comparison: Comparison,
}

impl Body for ComparisonBody {
    const KIND: &'static str = "comparison";
}

impl ComparisonReport {
    /// Of two sides, compared over `paired`.
    pub fn new(
        [first, second]: [Compared; 2],
        paired: &Paired,
        comparison: Comparison,
        timing: Option<Timing>,
    ) -> Self {
        let body = ComparisonBody { first, second, axes: axes(&paired.first), comparison };
        Envelope::of(body, Vec::new(), timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        for (name, side) in [("first", &self.first), ("second", &self.second)] {
            let report = &side.report;
            row(&mut text, name, &format!("{}, by {}", report.design.name, report.method));
            row(&mut text, "", &side.source);
        }
        let c = &self.comparison;
        let cells: Vec<String> = self.axes.iter().map(|axis| axis.cells.to_string()).collect();
        let over = if cells.is_empty() { "listed poses".to_owned() } else { cells.join(" × ") };
        row(&mut text, "compared on", &format!("{over} = {} poses", grouped(c.poses)));
        text.push('\n');
        let shown = |ratio: Option<f64>| ratio.map_or_else(|| "–".to_owned(), |r| format!("{r:.4}"));
        line(&mut text, &format!("  {:<15}{:>12}{:>12}{:>17}", "", "first", "second", "second / first"));
        let numbers = |text: &mut String, name: &str, values: [String; 2], ratio: Option<f64>| {
            line(text, &format!("  {name:<15}{:>12}{:>12}{:>17}", values[0], values[1], shown(ratio)));
        };
        numbers(&mut text, &format!("Sum [{}]", c.unit), c.sums.map(significant), c.sum_ratio);
        if let Some(edges) = c.onaa_edges {
            numbers(&mut text, "ONAA edge", edges.map(|edge| format!("{edge:.4}")), c.onaa_ratio);
        }
        text.push('\n');
        row(&mut text, "Jaccard", &format!("{:.4}   accepted by both, of all that one accepts", c.jaccard));
        row(
            &mut text,
            "agreement",
            &format!("{} of the poses: both accept or both reject", percent(c.agreement)),
        );
        let share = |n: usize| percent(n as f64 / c.poses.max(1) as f64);
        row(&mut text, "only first", &format!("{}   {} poses", share(c.only_first), grouped(c.only_first)));
        row(
            &mut text,
            "only second",
            &format!("{}   {} poses", share(c.only_second), grouped(c.only_second)),
        );
        if let Some(d) = &c.distances {
            text.push('\n');
            line(&mut text, "  poses that differ, from the border of the first accepted set");
            line(&mut text, &format!("  {:<15}{:>12}{:>12}{:>17}", "", "median", "95 %", "max"));
            let three = |text: &mut String, name: &str, q: &Quantiles| {
                let [a, b, c] = [q.median, q.p95, q.max].map(significant);
                line(text, &format!("  {name:<15}{a:>12}{b:>12}{c:>17}"));
            };
            three(&mut text, "in cells", &d.cells);
            three(&mut text, "of the box", &d.error_box);
        }
        text.push('\n');
        self.write_confusion(&mut text);
        if self.first.report.design.alignment != self.second.report.design.alignment {
            text.push('\n');
            wrapped(
                &mut text,
                "note: ",
                "the two do not have the same [alignment]: errors in D and rad are compared as they are",
            );
        }
        text
    }

    fn write_confusion(&self, text: &mut String) {
        let confusion = &self.comparison.confusion;
        let occurs =
            |k: &usize| confusion[*k].iter().any(|n| *n > 0) || confusion.iter().any(|row| row[*k] > 0);
        let known: Vec<usize> = (0..Outcome::ALL.len()).filter(occurs).collect();
        let name = |k: usize| Outcome::ALL[k].name();
        let heads = columns(12, known.iter().map(|k| name(*k)));
        line(text, &format!("  {:<15}{heads}   by the second", "by the first"));
        for i in &known {
            let counts = columns(12, known.iter().map(|j| grouped(confusion[*i][*j])));
            line(text, &format!("  {:<15}{counts}", name(*i)));
        }
    }

    /// The confusions as a table for programs, the names of the columns first.
    pub fn records(&self) -> Vec<Vec<String>> {
        let mut records = vec![["first", "second", "poses"].map(str::to_owned).to_vec()];
        for (row, first) in self.comparison.confusion.iter().zip(Outcome::ALL) {
            for (count, second) in row.iter().zip(Outcome::ALL) {
                records.push(vec![first.name().to_owned(), second.name().to_owned(), count.to_string()]);
            }
        }
        records
    }
}

/// One method of many.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Decided {
    /// Its name.
    pub method: &'static str,
    /// What it found.
    pub result: Option<MethodResult>,
    /// Why it found nothing.
    pub left_out: Option<String>,
}

/// What one method found.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MethodResult {
    /// The measure of the accepted cells.
    pub sum_grid: f64,
    /// The Sum: corrected where the method draws random poses.
    pub sum: f64,
    /// Its 95 % interval, if there is one.
    pub sum_ci95: Option<[f64; 2]>,
    /// The ONAA edge.
    pub onaa_edge: Option<f64>,
    /// Wall-clock time, in seconds.
    pub seconds: f64,
}

impl MethodResult {
    /// Of an answer.
    pub fn of(answer: &Answer) -> Self {
        Self {
            sum_grid: answer.merits.sum.sum,
            sum: answer.sum(),
            sum_ci95: answer.sum_ci95(),
            onaa_edge: answer.onaa().map(|onaa| onaa.edge),
            seconds: answer.seconds,
        }
    }
}

/// How two methods agree.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Agreement {
    /// Share of the cells that both accept or both reject.
    pub agreement: f64,
    /// Accepted by both over accepted by any.
    pub jaccard: f64,
}

impl From<Overlap> for Agreement {
    fn from(overlap: Overlap) -> Self {
        Self { agreement: overlap.agreement(), jaccard: overlap.jaccard() }
    }
}

/// Every method of a design on one grid, with its head.
pub type AgreementReport = Envelope<AgreementBody>;

/// Every method of a design on one grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AgreementBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// Cells per axis, by axis.
    pub cells: Vec<usize>,
    /// Seconds that each method could take.
    pub time_limit_s: f64,
    /// Unit of the Sums.
    pub unit: String,
    /// Every method there is. Seconds differ between equal runs, and where time stops a method so does its result.
    pub methods: Vec<Decided>,
    /// Of the methods that came to a result, in their order: how each two agree.
    pub agreement: Vec<Vec<Agreement>>,
}

impl Body for AgreementBody {
    const KIND: &'static str = "methods";
}

impl AgreementReport {
    /// Of all methods of a problem, each of which had `time_limit`.
    pub fn new(
        design: &Design,
        found: &catchment_study::agreement::Agreement,
        time_limit: Duration,
        timing: Option<Timing>,
    ) -> Self {
        let mut unit = String::new();
        let methods = found
            .tried
            .iter()
            .map(|tried| {
                let (result, left_out) = match &tried.answer {
                    Ok(answer) => {
                        unit = answer.unit();
                        (Some(MethodResult::of(answer)), None)
                    }
                    Err(reason) => (None, Some(reason.to_string())),
                };
                Decided { method: tried.method, result, left_out }
            })
            .collect();
        let overlaps = |row: &Vec<Overlap>| row.iter().map(|overlap| Agreement::from(*overlap)).collect();
        let body = AgreementBody {
            design: design.clone(),
            cells: found.cells.clone(),
            time_limit_s: time_limit.as_secs_f64(),
            unit,
            methods,
            agreement: found.overlaps.iter().map(overlaps).collect(),
        };
        Envelope::of(body, Vec::new(), timing)
    }

    /// The methods that came to a result, with it.
    pub fn results(&self) -> impl Iterator<Item = (&'static str, &MethodResult)> {
        self.methods.iter().filter_map(|decided| Some((decided.method, decided.result.as_ref()?)))
    }

    /// The report as text; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        let cells: Vec<String> = self.cells.iter().map(ToString::to_string).collect();
        let total = grouped(self.cells.iter().product());
        row(&mut text, "methods", &format!("all that apply, on {} = {total} cells", cells.join(" × ")));
        text.push('\n');
        let sum = format!("Sum [{}]", self.unit);
        line(
            &mut text,
            &format!(
                "  {:<12}{sum:>14}  {:<22}{:>11}{:>10}",
                "method", "with random poses", "ONAA edge", "seconds"
            ),
        );
        for (name, result) in self.results() {
            let corrected = result
                .sum_ci95
                .map_or_else(String::new, |[lo, hi]| format!("{} … {}", significant(lo), significant(hi)));
            let edge = result.onaa_edge.map_or_else(|| "–".to_owned(), |edge| format!("{edge:.4}"));
            let sum = significant(result.sum_grid);
            line(
                &mut text,
                &format!("  {name:<12}{sum:>14}  {corrected:<22}{edge:>11}{:>10.2}", result.seconds),
            );
        }
        let names: Vec<&str> = self.results().map(|(name, _)| name).collect();
        if names.len() > 1 {
            let mut matrix = |title: &str, value: fn(&Agreement) -> String| {
                text.push('\n');
                line(&mut text, &format!("  {title}"));
                let heads = columns(11, names.iter());
                line(&mut text, &format!("  {:<12}{heads}", ""));
                for (name, row) in names.iter().zip(&self.agreement) {
                    let values = columns(11, row.iter().map(value));
                    line(&mut text, &format!("  {name:<12}{values}"));
                }
            };
            matrix("agreement: share of the cells that both accept or both reject", |a| percent(a.agreement));
            matrix("Jaccard: accepted by both, of all that one accepts", |a| format!("{:.4}", a.jaccard));
        }
        let left_out: Vec<_> =
            self.methods.iter().filter_map(|d| Some((d.method, d.left_out.as_ref()?))).collect();
        if !left_out.is_empty() {
            text.push('\n');
            for (name, reason) in left_out {
                wrapped(&mut text, &format!("  without {name}: "), reason);
            }
        }
        text
    }

    /// Every method as a record for programs, the names of the columns first.
    pub fn records(&self) -> Vec<Vec<String>> {
        let names: Vec<&str> = self.results().map(|(name, _)| name).collect();
        let mut head = ["method", "sum_grid", "sum", "sum_lo", "sum_hi", "onaa_edge", "seconds"]
            .map(str::to_owned)
            .to_vec();
        head.extend(names.iter().map(|name| format!("agreement_{name}")));
        head.extend(names.iter().map(|name| format!("jaccard_{name}")));
        let mut records = vec![head];
        for ((name, result), row) in self.results().zip(&self.agreement) {
            let known = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
            let mut record = vec![name.to_owned(), result.sum_grid.to_string(), result.sum.to_string()];
            record.extend([0, 1].map(|k| known(result.sum_ci95.map(|ci95| ci95[k]))));
            record.extend([known(result.onaa_edge), result.seconds.to_string()]);
            record.extend(row.iter().map(|a| a.agreement.to_string()));
            record.extend(row.iter().map(|a| a.jaccard.to_string()));
            records.push(record);
        }
        records
    }
}
