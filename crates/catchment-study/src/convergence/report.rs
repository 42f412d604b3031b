//! Text and table form of a convergence study.

use super::{Convergence, CorrectedSum, RefinementSequence, StopReason};
use catchment_core::design::Design;
use catchment_core::document::{Column, ColumnFormat, Document, Subject, Table, grouped, significant};

impl Subject for Convergence {
    const KIND: &'static str = "convergence";

    fn setup(&self, _: &Design, document: &mut Document) {
        let tolerance = format!("{:.3}", 100.0 * self.settings.tolerance);
        let tolerance = tolerance.trim_end_matches('0').trim_end_matches('.');
        document.row(
            "stable means",
            format!(
                "two refinements in a row change the Sum by less than {tolerance} % of itself, the ONAA edge by less than {tolerance} % of the error box"
            ),
        );
    }

    fn document(&self, _: &Design) -> Document {
        let mut document = Document::default();
        for sequence in &self.sequences {
            document.titled(Some(sequence.method.to_owned())).table(self.table(sequence));
            document.paragraph(self.ending(&sequence.end));
            if let Some(CorrectedSum { sum, ci95, descents }) = sequence.corrected {
                let [lo, hi] = ci95.map(significant);
                document.paragraph(format!(
                    "corrected by {} exact descents: {}, 95 % interval {lo} … {hi}",
                    grouped(descents),
                    significant(sum)
                ));
            }
        }
        let trials = self.sequences.iter().flat_map(|sequence| &sequence.trials);
        let undecided: usize = trials.map(|trial| trial.undecided).sum();
        if undecided > 0 {
            let words = format!("{} cells undecided: they count as rejected", grouped(undecided));
            document.section(None).row("warning", words);
        }
        document.table(self.data());
        document
    }
}

impl Convergence {
    fn table(&self, sequence: &RefinementSequence) -> Table {
        let mut table = Table::new([
            Column::new("per axis"),
            Column::new("cells"),
            Column::new("seconds").format(ColumnFormat::Fixed(2)),
            Column::new(format!("Sum [{}]", self.unit)).format(ColumnFormat::Significant),
            Column::new("border ± a cell").left(),
            Column::new("ONAA edge").format(ColumnFormat::Fixed(4)),
        ]);
        for trial in &sequence.trials {
            let [lo, hi] = trial.bracket.map(significant);
            table.push([
                trial.resolution.into(),
                trial.cells.into(),
                trial.seconds.into(),
                trial.sum.into(),
                format!("{lo} … {hi}").into(),
                trial.onaa_edge.into(),
            ]);
        }
        table
    }

    /// The refinements of all methods. Its numbers have no exponents.
    fn data(&self) -> Table {
        let mut table = Table::data("method resolution cells seconds sum doubt_from doubt_to onaa_edge");
        for RefinementSequence { method, trials, .. } in &self.sequences {
            for trial in trials {
                let [from, to] = trial.bracket;
                let counts = [trial.resolution, trial.cells].map(Into::into);
                let numbers = [trial.seconds, trial.sum, from, to, trial.onaa_edge];
                let cells = counts.into_iter().chain(numbers.map(|number| number.to_string().into()));
                table.push(std::iter::once((*method).into()).chain(cells));
            }
        }
        table
    }

    fn ending(&self, end: &StopReason) -> String {
        match end {
            StopReason::Stable => "stable".to_owned(),
            StopReason::Time { resolution, expected_s } => format!(
                "stopped, not stable: {resolution} cells per axis would take about {expected_s:.0} s more, and {:.0} s are allowed for each method",
                self.settings.time_limit_s
            ),
            StopReason::Memory { resolution, message } => {
                format!("stopped, not stable: at {resolution} cells per axis {message}")
            }
            StopReason::Cells { resolution } => format!(
                "stopped, not stable: {resolution} cells per axis are more than {} cells",
                grouped(self.settings.most_cells as usize)
            ),
        }
    }
}
