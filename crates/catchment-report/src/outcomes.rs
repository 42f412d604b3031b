//! Outcomes of listed pose errors: the input table with result columns, or JSON.

use super::envelope::{ReportBody, ReportEnvelope};
use catchment_core::acceptance::{Acceptance, FailureReason, Outcome};
use catchment_core::design::Design;
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::number as number_in_table;
use catchment_core::method::Method;
use catchment_core::method::descent::End;
use catchment_core::pose::PoseError;
use catchment_core::poses::{OffsetsAt, PoseTable};
use catchment_core::problem::Problem;
use catchment_core::run::{EndContact, EndContacts, FollowedPoses};
use catchment_study::friction::MayStick;
use serde::Serialize;
use std::collections::BTreeMap;

/// The outcomes of a table of poses.
#[derive(Debug)]
pub struct OutcomesReport<'a> {
    problem: &'a Problem,
    /// The design.
    pub design: &'a Design,
    /// The poses.
    pub table: &'a PoseTable<'a>,
    method: &'a Method,
    /// Settings of the method.
    pub settings: serde_json::Value,
    /// Result of the method for the poses of the table.
    pub acceptance: &'a Acceptance,
    /// End of each motion.
    pub ends: &'a [End],
    /// Reason for each failure to dock, if it can be determined; `None` if this design has no such reasons.
    pub reasons: Option<Vec<Option<FailureReason>>>,
    /// Which of them could as well have stuck on their way, with friction.
    sticking: Option<&'a MayStick<'a>>,
    /// Warnings about the result.
    pub warnings: Vec<Diagnostic>,
    /// The numbers of the finished rows, if the computation was stopped early.
    pub finished: Option<&'a [usize]>,
}

/// The rows of a table as CSV, as soon as their poses are decided, in whatever order: each comes when all before it have come.
pub struct OutcomeRows<'a> {
    problem: &'a Problem,
    table: &'a PoseTable<'a>,
    rows: Box<dyn Iterator<Item = (usize, Vec<String>)> + Send + 'a>,
    endings: EndContacts<'a>,
    sticking: Option<&'a MayStick<'a>>,
    /// The first row that has not come.
    next: usize,
    /// Decided, but some before them are not.
    waiting: BTreeMap<usize, End>,
}

impl<'a> OutcomeRows<'a> {
    /// Rows of a table whose poses are decided for a problem; with friction, including the cases that
    /// Coulomb's law leaves open.
    pub fn new(
        problem: &'a Problem,
        table: &'a PoseTable<'a>,
        method: &Method,
        sticking: Option<&'a MayStick<'a>>,
    ) -> Self {
        let rows = Box::new(table.rows().enumerate());
        let (endings, waiting) = (EndContacts::new(problem, method), BTreeMap::new());
        Self { problem, table, rows, endings, sticking, next: 0, waiting }
    }

    /// The column names: those of the table, `outcome`, the final errors, z of the COR in the final state in
    /// D, the contacts there in words, `may_stick` with friction, and `reason` if the design has reasons.
    ///
    /// # Errors
    /// As for [`OutcomesReport::to_csv`].
    pub fn header(&self) -> Result<String, csv::Error> {
        let mut header = self.table.header();
        header.push("outcome".to_owned());
        header.extend(self.table.names().map(|name| format!("final_{name}")));
        header.extend(["final_height".to_owned(), "contacts".to_owned()]);
        if self.sticking.is_some() {
            header.push("may_stick".to_owned());
        }
        if self.problem.may_cross() {
            header.push("reason".to_owned());
        }
        record(&header)
    }

    /// A pose is decided: returns the rows that can be written now.
    ///
    /// # Errors
    /// As for [`OutcomesReport::to_csv`].
    pub fn push(&mut self, number: usize, end: End) -> Result<String, csv::Error> {
        self.waiting.insert(number, end);
        let mut text = String::new();
        while let Some(end) = self.waiting.remove(&self.next) {
            text.push_str(&self.row(self.next, &end)?);
        }
        Ok(text)
    }

    /// No more poses will be decided: the rows that waited for others.
    ///
    /// # Errors
    /// As for [`OutcomesReport::to_csv`].
    pub fn rest(mut self) -> Result<String, csv::Error> {
        let waiting = std::mem::take(&mut self.waiting);
        waiting.iter().map(|(number, end)| self.row(*number, end)).collect()
    }

    /// A row that comes after all that came before.
    fn row(&mut self, number: usize, end: &End) -> Result<String, csv::Error> {
        self.next = number + 1;
        let Some((_, mut row)) = self.rows.find(|(k, _)| *k == number) else { return Ok(String::new()) };
        row.push(end.outcome.name().to_owned());
        row.extend(self.table.in_units(&end.error).map(number_in_table));
        row.push(end.height.map_or_else(String::new, number_in_table));
        row.push(words(&self.endings.of(end)));
        if let Some(sticking) = self.sticking {
            row.push(if sticking.may_stick(number) { "yes" } else { "no" }.to_owned());
        }
        if self.problem.may_cross() {
            let reason = FailureReason::of(self.problem, end.outcome, &end.error);
            row.push(reason.map_or("", FailureReason::name).to_owned());
        }
        record(&row)
    }
}

/// A line of CSV.
fn record(cells: &[String]) -> Result<String, csv::Error> {
    let mut bytes = Vec::new();
    let mut writer = csv::Writer::from_writer(&mut bytes);
    writer.write_record(cells)?;
    writer.flush()?;
    std::mem::drop(writer);
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The result for programs; lengths in D, angles in radians.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct Answer<'a> {
    /// The design, resolved: lengths in D, angles in radians.
    design: &'a Design,
    /// Name of the method that decided the outcomes.
    method: &'static str,
    /// The point at which the offsets of errors are measured; absent for the face centre.
    #[serde(skip_serializing_if = "Option::is_none")]
    offsets_at: Option<OffsetsAt>,
    /// The settings of the method.
    settings: &'a serde_json::Value,
    /// Number of poses with each outcome.
    counts: BTreeMap<&'static str, usize>,
    /// Number of poses that were not finished, if the run was stopped early.
    #[serde(skip_serializing_if = "Option::is_none")]
    missing: Option<usize>,
    /// Every pose in the order of the table: its error, outcome, final pose and height, and contacts at the
    /// end.
    poses: Vec<Row>,
}

impl ReportBody for Answer<'_> {
    const KIND: &'static str = "outcome";
}

/// A pose of the table.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct Row {
    /// Its number in the table, from 0; present if other poses are missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    number: Option<usize>,
    error: PoseError,
    outcome: Outcome,
    /// Reason for the failure to dock.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<FailureReason>,
    #[serde(rename = "final")]
    last: PoseError,
    /// z of the COR at the end, in D; null if the moving half missed.
    final_height_d: Option<f64>,
    /// Contacts at the end.
    contacts: Vec<EndContact>,
    /// With friction: whether it passed a place at which Coulomb's law also permits stiction.
    #[serde(skip_serializing_if = "Option::is_none")]
    may_stick: Option<bool>,
    /// Columns that were copied from the input.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    carried: BTreeMap<String, String>,
}

impl<'a> OutcomesReport<'a> {
    /// Report of a method's result for the poses of a table.
    pub fn new(
        problem: &'a Problem,
        table: &'a PoseTable<'a>,
        method: &'a Method,
        followed: &'a FollowedPoses,
        sticking: Option<&'a MayStick<'a>>,
    ) -> Self {
        let FollowedPoses { acceptance, ends, finished } = followed;
        let mut warnings = problem.warnings();
        warnings.extend(acceptance.warnings.iter().cloned());
        let reason = |end: &End| FailureReason::of(problem, end.outcome, &end.error);
        let reasons = problem.may_cross().then(|| ends.iter().map(reason).collect());
        let (design, settings) = (problem.design(), method.settings());
        let finished = finished.as_deref();
        let mut report = Self {
            problem,
            design,
            table,
            method,
            settings,
            acceptance,
            ends,
            reasons,
            sticking,
            warnings,
            finished,
        };
        let partial = report.partial().map(|partial| Diagnostic::warning("partial", partial));
        report.warnings.extend(partial);
        report
    }

    /// Number of rows without an outcome, because the computation was stopped; `None` if all have one.
    pub fn missing(&self) -> Option<usize> {
        self.finished.map(|finished| self.table.errors().len() - finished.len())
    }

    /// A sentence about an incomplete result; `None` for a complete one.
    pub fn partial(&self) -> Option<String> {
        let (missing, all) = (self.missing()?, self.table.errors().len());
        let finished = all - missing;
        Some(format!(
            "partial: {finished} of {all} poses are decided, {missing} are missing, because it was stopped"
        ))
    }

    /// The numbers of the reported rows.
    fn reported(&self) -> impl Iterator<Item = usize> {
        let all = if self.finished.is_some() { 0 } else { self.table.errors().len() };
        self.finished.unwrap_or_default().iter().copied().chain(0..all)
    }

    /// Bytes of memory that a printed table takes, as JSON or as CSV, at most. Every row of the JSON repeats the names of the
    /// columns that are carried through.
    pub fn bytes(table: &PoseTable<'_>, json: bool) -> u64 {
        /// A row of CSV: outcome, final errors and contacts, and the same again while the text is checked.
        const CSV_ROW: u64 = 900;
        /// A row of JSON: two poses and contacts before and as text.
        const JSON_ROW: u64 = 2400;
        /// A cell of a carried column: its place in a map, and the quotes and spaces around it.
        const CELL: u64 = 250;
        /// Copies of the name of a column, and of the table's text.
        const COPIES: u64 = 3;
        let rows = table.errors().len() as u64;
        let cells: u64 = table.carried().iter().map(|(_, name)| CELL + COPIES * name.len() as u64).sum();
        let row = if json { JSON_ROW + cells } else { CSV_ROW };
        rows.saturating_mul(row).saturating_add(COPIES * table.text().len() as u64)
    }

    /// Reason for a pose's failure to dock, if it can be determined.
    fn reason(&self, pose: usize) -> Option<FailureReason> {
        self.reasons.as_ref()?.get(pose).copied().flatten()
    }

    /// The input table, with the outcome, the final errors in the units of their columns, height and contacts
    /// there; with a column of reasons if the design has them: the same as [`OutcomeRows`] gives row by row.
    ///
    /// # Errors
    /// If a row cannot be written, which does not occur for text in memory.
    pub fn to_csv(&self) -> Result<String, csv::Error> {
        let mut rows = OutcomeRows::new(self.problem, self.table, self.method, self.sticking);
        let mut text = rows.header()?;
        for (number, end) in self.reported().zip(self.ends) {
            text.push_str(&rows.push(number, *end)?);
        }
        text.push_str(&rows.rest()?);
        Ok(text)
    }

    /// The result for programs: lengths in D, angles in radians, offsets at the point of the table.
    ///
    /// # Errors
    /// If a number has no JSON form.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        let carried = self.table.carried();
        let at = self.table.offsets_at();
        let measured = |error: &PoseError| at.measure(error, &self.design.alignment);
        let mut rows_left = self.reported().peekable();
        let mut endings = EndContacts::new(self.problem, self.method);
        let poses = self.table.rows().zip(self.table.errors()).enumerate();
        let poses = poses.filter(|(number, _)| rows_left.next_if_eq(number).is_some()).zip(self.ends);
        let poses = poses.enumerate().map(|(k, ((number, (row, error)), end))| {
            let contacts = endings.of(end);
            Row {
                number: self.finished.map(|_| number),
                error: measured(error),
                outcome: end.outcome,
                reason: self.reason(k),
                last: measured(&end.error),
                final_height_d: end.height,
                contacts,
                may_stick: self.sticking.map(|sticking| sticking.may_stick(number)),
                carried: carried.iter().map(|(k, name)| (name.clone(), row[*k].clone())).collect(),
            }
        });
        let counts = Outcome::ALL.iter().map(|outcome| outcome.name()).zip(self.acceptance.counts());
        let answer = Answer {
            design: self.design,
            method: self.acceptance.method,
            offsets_at: (at != OffsetsAt::Face).then_some(at),
            settings: &self.settings,
            counts: counts.collect(),
            missing: self.missing(),
            poses: poses.collect(),
        };
        ReportEnvelope::of(answer, self.warnings.clone(), None).to_json()
    }

    /// How many met which outcome, and which columns were carried through: a line each.
    pub fn summary(&self) -> Vec<String> {
        let count = self.acceptance.outcomes.len();
        let counts = Outcome::ALL.iter().zip(self.acceptance.counts());
        let parts: Vec<String> = counts.map(|(o, n)| format!("{n} {}", o.name())).collect();
        let poses = if count == 1 { "pose" } else { "poses" };
        let mut lines = vec![format!("{count} {poses}: {}", parts.join(", "))];
        let shown = |(_, name): (usize, String)| if name.is_empty() { "(no name)".to_owned() } else { name };
        let crossed = self.reasons.iter().flatten().filter(|reason| reason.is_some()).count();
        if crossed > 0 {
            let jammed = format!("{crossed} of the jammed {}", if crossed == 1 { "is" } else { "are" });
            lines.push(format!("{jammed} crossed: a layer rests on one that is not its partner"));
        }
        if let Some(sticking) = self.sticking {
            let may_stick = self.reported().filter(|number| sticking.may_stick(*number)).count();
            lines.push(format!(
                "{may_stick} came by a place where Coulomb's law would let them stick as well"
            ));
        }
        let carried: Vec<String> = self.table.carried().into_iter().map(shown).collect();
        if !carried.is_empty() {
            lines.push(format!("carried through: {}", carried.join(", ")));
        }
        lines
    }
}

/// Contacts in words, each pair of features once: `corner of wall and flat on slope of 45°; …`, the moving half's feature first.
fn words(contacts: &[EndContact]) -> String {
    let mut all: Vec<String> = Vec::new();
    for EndContact { fixed, moving, .. } in contacts {
        let words = format!("{moving} on {fixed}");
        if !all.contains(&words) {
            all.push(words);
        }
    }
    all.join("; ")
}
