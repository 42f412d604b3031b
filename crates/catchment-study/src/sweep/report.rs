//! Text and table form of a sweep.

use super::{DesignResult, Figures, Sweep, SweepDesign};
use catchment_core::design::Design;
use catchment_core::document::{
    Cell, Column, ColumnFormat, Document, Subject, Table, grouped, percent, significant, with_error,
};
use std::collections::BTreeMap;

/// Columns of a matrix for people.
const WIDEST_MATRIX: usize = 6;
/// Rows of a list for people.
const LONGEST_LIST: usize = 40;

impl Subject for Sweep {
    const KIND: &'static str = "sweep";

    fn setup(&self, _: &Design, document: &mut Document) {
        for axis in &self.settings.axes {
            document.row(axis.name(), axis.values.join(", "));
        }
        let count = grouped(self.designs.len());
        document.row("designs", format!("{count}, each by {}", self.settings.run.method.name()));
    }

    fn document(&self, _: &Design) -> Document {
        let mut document = Document::default();
        self.describe_sums(&mut document);
        document.section(None);
        for (what, number) in [("largest Sum ▲", self.largest), ("smallest Sum ▼", self.smallest)] {
            let trial = number.map(|number| &self.designs[number]);
            if let Some((trial, figures)) = trial.and_then(|trial| Some((trial, trial.result.figures()?))) {
                let edge =
                    figures.onaa_edge.map_or_else(String::new, |edge| format!(", ONAA edge {edge:.4}"));
                let value = format!(
                    "{} {}, {} of the error box{edge}",
                    sum(figures),
                    self.unit(),
                    percent(figures.fraction)
                );
                document.row(what, value).more(self.named(trial));
            }
        }
        self.describe_warnings(&mut document);
        document.table(self.data());
        document
    }
}

impl Sweep {
    /// The unit of every Sum.
    pub fn unit(&self) -> &str {
        let figures = self.designs.iter().find_map(|trial| trial.result.figures());
        figures.map_or("", |figures| &figures.unit)
    }

    /// ▲ the largest Sum, ▼ the smallest.
    pub fn mark(&self, number: usize) -> &'static str {
        match number {
            _ if self.largest == Some(number) => "▲",
            _ if self.smallest == Some(number) => "▼",
            _ => "",
        }
    }

    /// The values of a design: `aspect_ratio 0.5, center_of_rotation 1`.
    pub fn named(&self, trial: &SweepDesign) -> String {
        let pairs = self.settings.axes.iter().zip(&trial.values);
        pairs.map(|(axis, value)| format!("{} {value}", axis.name())).collect::<Vec<_>>().join(", ")
    }

    /// A number with its mark, or with a space in its place: numbers stay below each other.
    fn marked(&self, value: &str, number: usize) -> Cell {
        let mark = self.mark(number);
        format!("{value}{}", if mark.is_empty() { " " } else { mark }).into()
    }

    /// The Sum over two axes, else a row per design.
    fn describe_sums(&self, document: &mut Document) {
        if let [rows, columns] = &self.settings.axes[..]
            && columns.values.len() <= WIDEST_MATRIX
        {
            let title = format!("Sum [{}]; rows {}, columns {}", self.unit(), rows.name(), columns.name());
            document.titled(Some(title)).table(self.matrix(&rows.values, &columns.values));
            return;
        }
        document.section(None).table(self.list());
        let more = self.designs.len().saturating_sub(LONGEST_LIST);
        if more > 0 {
            document.paragraph(format!("… and {} more, in JSON and CSV", grouped(more)));
        }
    }

    fn matrix(&self, rows: &[String], columns: &[String]) -> Table {
        let head = std::iter::once(Column::new("").left()).chain(columns.iter().map(Column::new));
        let mut table = Table::new(head);
        for (j, row) in rows.iter().enumerate() {
            let cell = |k: usize| {
                let number = j * columns.len() + k;
                let figures = self.designs[number].result.figures();
                self.marked(&figures.map_or_else(|| "–".to_owned(), |f| significant(f.sum)), number)
            };
            table.push(std::iter::once(row.as_str().into()).chain((0..columns.len()).map(cell)));
        }
        table
    }

    fn list(&self) -> Table {
        let mut columns: Vec<Column> =
            self.settings.axes.iter().map(|axis| Column::new(axis.name()).left()).collect();
        columns.push(Column::new(format!("Sum [{}]", self.unit())));
        columns.push(Column::new("of the error box").format(ColumnFormat::Percent));
        let mut table = Table::new(columns);
        for (number, trial) in self.designs.iter().enumerate().take(LONGEST_LIST) {
            let figures = trial.result.figures();
            let value = figures.map_or_else(|| "–".to_owned(), sum);
            let share = figures.map(|figures| figures.fraction).into();
            let values = trial.values.iter().map(|value| value.as_str().into());
            table.push(values.chain([self.marked(&value, number), share]));
        }
        table
    }

    /// The designs without figures, and the warnings of the others, each reason once.
    fn describe_warnings(&self, document: &mut Document) {
        let mut reasons: BTreeMap<(bool, &str), Vec<&SweepDesign>> = BTreeMap::new();
        for trial in &self.designs {
            match &trial.result {
                DesignResult::Refused(reason) => reasons.entry((false, reason)).or_default().push(trial),
                DesignResult::Figures(figures) => {
                    for warning in &figures.warnings {
                        reasons.entry((true, warning)).or_default().push(trial);
                    }
                }
            }
        }
        if !reasons.is_empty() {
            document.section(None);
        }
        let mut omitted = 0;
        for (number, ((is_computed, reason), trials)) in reasons.iter().enumerate() {
            if number >= LONGEST_LIST / 4 {
                omitted += trials.len();
                continue;
            }
            let more = match trials.len() {
                1 => String::new(),
                n => format!(" and {} more", n - 1),
            };
            let name = if *is_computed { "warning" } else { "not computed" };
            document.row(name, format!("{}{more}: {reason}", self.named(trials[0])));
        }
        if omitted > 0 {
            document.paragraph(format!("and {} more, in JSON and CSV", grouped(omitted)));
        }
    }

    /// A row per design.
    fn data(&self) -> Table {
        let first = self.designs.iter().find_map(|trial| trial.result.figures());
        let errors: Vec<_> =
            first.iter().flat_map(|figures| figures.tolerances.iter().map(|along| along.axis)).collect();
        let mut keys: Vec<String> = self.settings.axes.iter().map(|axis| axis.key.clone()).collect();
        keys.extend(["sum", "sum_lo", "sum_hi", "fraction", "onaa_edge", "centered_edge"].map(str::to_owned));
        keys.extend(errors.iter().flat_map(|e| ["minus", "plus"].map(|side| format!("{}_{side}", e.name()))));
        keys.extend(["success", "warnings", "refused"].map(str::to_owned));
        let count = keys.len();
        let mut table = Table::new(keys.into_iter().map(Column::data));
        for trial in &self.designs {
            let mut row: Vec<Cell> = trial.values.iter().map(|value| value.as_str().into()).collect();
            match &trial.result {
                DesignResult::Figures(f) => {
                    let [lo, hi] = f.sum_ci95.map_or([None; 2], |ci95| ci95.map(Some));
                    let numbers = [Some(f.sum), lo, hi, Some(f.fraction), f.onaa_edge, f.centered_edge];
                    row.extend(numbers.map(Cell::from));
                    for error in &errors {
                        let along = f.tolerances.iter().find(|along| along.axis == *error);
                        row.extend([along.map(|a| a.minus), along.map(|a| a.plus)].map(Cell::from));
                    }
                    row.extend([f.success.into(), f.warnings.join("; ").into(), Cell::Empty]);
                }
                DesignResult::Refused(reason) => {
                    row.resize(count - 1, Cell::Empty);
                    row.push(reason.as_str().into());
                }
            }
            table.push(row);
        }
        table
    }
}

/// `2.387 ± 0.021`, or without the interval if it is missing.
fn sum(figures: &Figures) -> String {
    figures.sum_ci95.map_or_else(|| significant(figures.sum), |ci95| with_error(figures.sum, ci95))
}
