//! Text and table form of trials compared with the exact region.

use super::Trials;
use catchment_core::design::Design;
use catchment_core::document::{Cell, Column, ColumnFormat, Document, Subject, Table, significant};
use catchment_core::pose::Dof;

impl Subject for Trials {
    const KIND: &'static str = "trials";

    fn document(&self, design: &Design) -> Document {
        let unit = self.unit;
        let mut document = Document::default();
        document.row("exact region", format!("{} {unit}, without rotation", significant(self.exact)));
        document.row("trials", format!("by {}", self.method));
        let mut rounds = Table::new([
            Column::new("trials"),
            Column::new("step [s]"),
            Column::new(format!("docks [{unit}]")).format(ColumnFormat::Fixed(4)),
            Column::new("inside"),
            Column::new("outside"),
            Column::new("misclassified (95 % CI)").format(ColumnFormat::Percent),
        ]);
        for round in &self.rounds {
            rounds.push([
                round.trials.into(),
                round.timestep.into(),
                round.accepted.into(),
                round.rejected_inside.into(),
                round.accepted_outside.into(),
                Cell::Interval(round.disagreeing, round.disagreeing_ci95),
            ]);
        }
        document.section(None).table(rounds);
        document.paragraph(
            "inside: trials in the exact region that do not dock; outside: trials out of it that dock; misclassified: share of the error box.",
        );
        document.table(self.last(design));
        document
    }
}

impl Trials {
    /// The trials of the last round: free offsets in D.
    fn last(&self, design: &Design) -> Table {
        let free: Vec<Dof> =
            [Dof::X, Dof::Y].into_iter().filter(|axis| design.alignment.free.contains(*axis)).collect();
        let columns = free.iter().map(|axis| Column::data(axis.name()));
        let mut table = Table::new(columns.chain(["outcome", "inside"].map(Column::data)));
        for trial in &self.trials {
            let offsets = free.iter().map(|axis| if *axis == Dof::X { trial.x } else { trial.y }.into());
            table.push(offsets.chain([trial.outcome.name().into(), trial.inside.into()]));
        }
        table
    }
}
