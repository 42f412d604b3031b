//! A table of robot trials: a table of pose errors with a column of observed outcomes.
//!
//! ```text
//!   trial, line, x_mm, yaw_deg, predicted, …, outcome           aligned, jammed, missed, aligned-elsewhere, or empty if
//!   17,    3,    12.5, 6,       aligned,   …, jammed            the trial was not made
//! ```
//!
//! Every free error of the design needs a column: a missing one would be taken as 0. `trial` numbers the rows
//! uniquely; rows of the same `line` are read as one line outwards. Both columns are optional. The
//! predictions in the table are not used: they are recomputed.

use super::fields::{records, spans};
use super::{OffsetsAt, PoseTable, defect, shortened};
use crate::design::{Design, nearest};
use catchment_base::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment_base::pose::PoseError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Observed result of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ObservedOutcome {
    /// It docked.
    Aligned,
    /// It docked in a pose rotated by a symmetry of the halves.
    AlignedElsewhere,
    /// It came to rest outside the seat.
    Jammed,
    /// It slid off, or the halves never met.
    Missed,
}

impl ObservedOutcome {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Aligned, Self::AlignedElsewhere, Self::Jammed, Self::Missed];

    /// As it is written in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Aligned => "aligned",
            Self::AlignedElsewhere => "aligned-elsewhere",
            Self::Jammed => "jammed",
            Self::Missed => "missed",
        }
    }

    /// The words for people.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Aligned => "docked",
            Self::AlignedElsewhere => "docked elsewhere",
            other => other.name(),
        }
    }
}

/// A row: a trial, made or not.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotTrial {
    /// Its number; the number of the row if the table has no numbers.
    pub trial: u64,
    /// Its line; 0 without a line.
    pub line: u64,
    /// The pose error of the face centre, in D and radians.
    pub error: PoseError,
    /// The observed outcome; `None` if the trial was not made.
    pub observed: Option<ObservedOutcome>,
    /// The prediction of the plan, if known.
    pub predicted: Option<ObservedOutcome>,
}

/// A table of trials that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotTrialTable {
    /// The rows in their order.
    pub rows: Vec<RobotTrial>,
    /// The point at which offsets were measured.
    pub offsets_at: OffsetsAt,
}

/// The columns that are no errors; others are left alone.
const OUTCOME: &str = "outcome";
const TRIAL: &str = "trial";
const LINE: &str = "line";
const PREDICTED: &str = "predicted";

impl RobotTrialTable {
    /// Reads a table whose offsets are measured `at` a point.
    ///
    /// # Errors
    /// All errors of the text, each with its byte range: those of [`PoseTable::parse`], a free error without
    /// a column, a missing column of outcomes, an invalid outcome, an invalid number of a trial or line, and
    /// a repeated trial.
    pub fn parse(text: &str, design: &Design, at: OffsetsAt) -> Result<Self, Diagnostics> {
        let mut found = DiagnosticCollector::default();
        let errors = match PoseTable::parse_beside(text, design, at, &[OUTCOME]) {
            Ok(table) => {
                head(&table, design, text, &mut found);
                table.errors().to_vec()
            }
            Err(diagnostics) => {
                found = diagnostics.into();
                Vec::new()
            }
        };
        let mut all = records(text);
        let Some((top, names)) = all.next() else { return Err(found.sorted()) };
        let place = |name: &str| names.iter().position(|n| n == name);
        let [outcome, trial, line, predicted] = [OUTCOME, TRIAL, LINE, PREDICTED].map(place);
        if outcome.is_none() {
            let help = "write what was seen of every trial into a column `outcome`, and nothing where it was not made";
            found.push_at(defect("no column says what was seen", help), || spans(text, top).first().cloned());
        }
        let mut rows = Vec::new();
        let mut seen: BTreeSet<u64> = BTreeSet::new();
        for (number, (start, record)) in all.enumerate() {
            if record.len() != names.len() {
                continue;
            }
            let mut wrong = |index: usize, fault: Diagnostic| {
                found.push_at(fault, || spans(text, start).get(index).cloned());
            };
            let cell = |index: Option<usize>| index.map_or("", |index| &record[index]);
            let mut count = |index: Option<usize>, or: u64| match (index, cell(index)) {
                (Some(_), "") | (None, _) => or,
                (Some(index), text) => text.parse().unwrap_or_else(|_| {
                    let fault = defect(
                        format!("`{}` is no whole number", shortened(text)),
                        format!("{} numbers rows: 1, 2, 3", &names[index]),
                    );
                    wrong(index, fault);
                    or
                }),
            };
            let trial_number = count(trial, number as u64 + 1);
            let line = count(line, 0);
            if !seen.insert(trial_number)
                && let Some(index) = trial
            {
                let help =
                    "keep one of them, or number them apart; a pose may be tried again under another number";
                wrong(index, defect(format!("trial {trial_number} is there twice"), help));
            }
            let observed = read(cell(outcome)).unwrap_or_else(|fault| {
                if let Some(index) = outcome {
                    wrong(index, fault);
                }
                None
            });
            rows.push(RobotTrial {
                trial: trial_number,
                line,
                error: errors.get(number).copied().unwrap_or_default(),
                observed,
                predicted: read(cell(predicted)).unwrap_or(None),
            });
        }
        found.refuse()?;
        Ok(Self { rows, offsets_at: at })
    }
}

/// Every free error has a column.
fn head(table: &PoseTable<'_>, design: &Design, text: &str, found: &mut DiagnosticCollector) {
    for dof in design.alignment.free.iter().filter(|dof| !table.has(*dof)) {
        let name = dof.name();
        let help = format!(
            "add a column of it, 0 where it does not occur, or lock {name} in [alignment] of the design"
        );
        found.push_at(defect(format!("no column is {name}, which the design leaves free"), help), || {
            let all = spans(text, records(text).next().map_or(0, |(start, _)| start));
            Some(all.first()?.start..all.last()?.end)
        });
    }
}

fn read(text: &str) -> Result<Option<ObservedOutcome>, Diagnostic> {
    if text.is_empty() {
        return Ok(None);
    }
    let known = ObservedOutcome::ALL.into_iter().find(|observed| observed.name() == text);
    known.map(Some).ok_or_else(|| {
        let names = ObservedOutcome::ALL.map(ObservedOutcome::name);
        let help = nearest(text, names).map_or_else(
            || format!("one of {}, or nothing", names.join(", ")),
            |meant| format!("did you mean {meant}?"),
        );
        defect(format!("`{}` is no outcome", shortened(text)), help)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn design() -> Design {
        let text = "[connector]\nfamily = \"pyramid\"\nwidth = 50\nunit = \"mm\"\n[alignment]\nfree = [\"x\", \"pitch\"]\ncenter_of_rotation = 0.5\n";
        crate::design::read(text, Path::new("")).unwrap().design
    }

    fn wrong(text: &str) -> Vec<(String, String)> {
        let refusal = RobotTrialTable::parse(text, &design(), OffsetsAt::Face).unwrap_err();
        refusal.list.into_iter().map(|o| (text[o.span.unwrap_or(0..0)].to_owned(), o.message)).collect()
    }

    #[test]
    fn rows_are_read_with_observed_outcomes() {
        let text = "trial,line,x_mm,pitch_deg,predicted,outcome,notes\n7,2,5,0,aligned,aligned,\n3,2,10,-9,jammed,,late\n";
        let table = RobotTrialTable::parse(text, &design(), OffsetsAt::Face).unwrap();
        let seen: Vec<_> = table.rows.iter().map(|row| (row.trial, row.line, row.observed)).collect();
        assert_eq!(seen, [(7, 2, Some(ObservedOutcome::Aligned)), (3, 2, None)]);
        assert_eq!(table.rows[1].predicted, Some(ObservedOutcome::Jammed));
        assert!((table.rows[0].error.x - 0.1).abs() < 1e-15);
        // Without numbers rows are counted.
        let table =
            RobotTrialTable::parse("outcome,x,pitch\nmissed,1,0\n,0,0\n", &design(), OffsetsAt::Cor).unwrap();
        assert_eq!((table.rows[1].trial, table.rows[1].line, table.offsets_at), (2, 0, OffsetsAt::Cor));
    }

    #[test]
    fn everything_wrong_is_reported_in_its_place() {
        let text = "trial,x_mm,y_mm,outcome\n1,0,0,aligned\n1,5,0,alined\nx,nan,3,no\n";
        let found = wrong(text);
        let cells: Vec<&str> = found.iter().map(|(cell, _)| cell.as_str()).collect();
        assert_eq!(cells, ["1", "alined", "x", "nan", "3", "no"], "{found:?}");
        assert_eq!(wrong("x_mm,pitch_deg\n0,0\n")[0].1, "no column says what was seen");
        assert_eq!(
            wrong("x_mm,outcome\n0,\n")[0],
            ("x_mm,outcome".into(), "no column is pitch, which the design leaves free".into())
        );
        assert_eq!(wrong("x_deg,pitch,outcome\n0,0,\n")[0].1, "x_deg: x is a length");
        assert_eq!(wrong("")[0].1, "the table is empty");
    }
}
