//! `catchment trace --poses`: the outcome of every pose error in a table. Alias `catchment outcome`.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::method_args::PoseMethodArgs;
use crate::output::{OutputArgs, lines, to_stderr, to_stdout};
use crate::signals;
use crate::source::read_table;
use catchment::diagnostic::Advice;
use catchment::method::Method;
use catchment::method::descent::End;
use catchment::poses::{OffsetsAt, PoseTable};
use catchment::problem::Problem;
use catchment::report::{OutcomeRows, OutcomesReport};
use catchment::study::friction::MayStick;
use catchment::terminal::shown;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

/// Compute the outcome of every pose error in a table: old name of `trace --poses`
///
/// Prints the table with the outcome (aligned, jammed, missed, undecided) and the final pose error of every row. `catchment help trace`
/// describes the table.
#[derive(Debug, Args)]
#[command(after_long_help = "Example:\n  catchment trace design.toml --poses poses.csv -o outcomes.csv")]
pub(crate) struct OutcomeArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// Table of pose errors (CSV); - reads stdin
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    poses: PathBuf,
    #[command(flatten)]
    method: PoseMethodArgs,
    /// Point of the moving half at which x and y are measured
    #[arg(long, value_enum, default_value_t = Point::Face)]
    offsets_at: Point,
    /// Print JSON, in D and radians
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// A table of pose errors, and the destination of its outcomes.
#[derive(Debug)]
pub(super) struct Batch<'a> {
    pub(super) design: &'a DesignArgs,
    pub(super) poses: &'a Path,
    pub(super) method: Method,
    pub(super) offsets_at: Point,
    pub(super) json: bool,
    pub(super) output: &'a OutputArgs,
    pub(super) exec: &'a ExecArgs,
}

/// The point at which offsets are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Point {
    /// The face centre
    Face,
    /// The centre of rotation, where locked offsets stay 0
    Cor,
}

impl From<Point> for OffsetsAt {
    fn from(point: Point) -> Self {
        match point {
            Point::Face => Self::Face,
            Point::Cor => Self::Cor,
        }
    }
}

pub(crate) fn run(args: &OutcomeArgs) -> Result<ExitStatus, Failure> {
    let OutcomeArgs { design, poses, method, offsets_at, json, output, exec } = args;
    let method = method.of()?;
    Batch { design, poses, method, offsets_at: *offsets_at, json: *json, output, exec }.run()
}

impl Batch<'_> {
    /// Follows every pose; prints each row once it and all rows before it are complete.
    pub(super) fn run(&self) -> Result<ExitStatus, Failure> {
        self.output.check()?;
        self.output.check_partial()?;
        let problem = self.design.problem()?;
        let source = read_table(self.poses)?;
        let table = PoseTable::parse(&source.text, problem.design(), self.offsets_at.into())
            .map_err(|diagnostics| diagnostics.of(source.clone()))?;
        let running = self.exec.start()?;
        let needed = OutcomesReport::bytes(&table, self.json);
        running.exec.ensure_fits("the answer for every pose", needed, |_| {
            vec![Advice::FewerPoses, Advice::MoreMemory]
        })?;
        let sticking = MayStick::of(&problem, &self.method, table.errors());
        let printed = Printed::new(&problem, &table, &self.method, sticking.as_ref());
        let streams = self.output.is_printed() && !self.json;
        let stop = running.exec.cancel_flag();
        let print = |number, end| {
            // Computed here to run on all threads.
            let _may_stick = sticking.as_ref().map(|sticking| sticking.may_stick(number));
            if streams && !running.beside_bar(|| printed.push(number, end)) {
                stop.store(true, Ordering::Relaxed);
            }
        };
        let followed = problem.follow_reporting(&self.method, table.errors(), &running.exec, &print)?;
        drop(running);
        let report = OutcomesReport::new(&problem, &table, &self.method, &followed, sticking.as_ref());
        let text = match (streams, self.json) {
            (true, _) => printed.rest()?,
            (false, true) => report.to_json()?,
            (false, false) => report.to_csv()?,
        };
        self.write(&report, &text)
    }

    /// Writes the table, or the finished rows after an interruption.
    fn write(&self, report: &OutcomesReport<'_>, text: &str) -> Result<ExitStatus, Failure> {
        let notes = lines(&report.warnings).into_iter().chain(report.summary());
        if report.partial().is_none() {
            let notes: Vec<String> = notes.collect();
            self.output.write(text)?;
            to_stderr(&notes);
            return Ok(ExitStatus::Done);
        }
        let place = self.output.write_partial(text)?;
        let beside = place.map(|path| format!("they are in {}", shown(&path)));
        let lines = std::iter::once("interrupted".to_owned()).chain(notes).chain(beside);
        to_stderr(&lines.collect::<Vec<_>>());
        Ok(signals::received().unwrap_or(ExitStatus::NotComputed))
    }
}

/// Prints rows to stdout as they complete. The header comes with the first row: without a row there is no
/// output.
struct Printed<'a>(Mutex<Printing<'a>>);

struct Printing<'a> {
    rows: OutcomeRows<'a>,
    has_begun: bool,
    /// The error that stops printing.
    failed: Option<Failure>,
}

impl<'a> Printed<'a> {
    fn new(
        problem: &'a Problem,
        table: &'a PoseTable<'a>,
        method: &Method,
        sticking: Option<&'a MayStick<'a>>,
    ) -> Self {
        let rows = OutcomeRows::new(problem, table, method, sticking);
        Self(Mutex::new(Printing { rows, has_begun: false, failed: None }))
    }

    /// Adds the outcome of a pose; returns false once rows can no longer be printed.
    fn push(&self, number: usize, end: End) -> bool {
        let mut printing = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if printing.failed.is_none()
            && let Err(failure) = printing.push(number, end)
        {
            printing.failed = Some(failure);
        }
        printing.failed.is_none()
    }

    /// The remaining rows to print after the last pose.
    fn rest(self) -> Result<String, Failure> {
        let printing = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        if let Some(failure) = printing.failed {
            return Err(failure);
        }
        let header = if printing.has_begun { String::new() } else { printing.rows.header()? };
        Ok(header + &printing.rows.rest()?)
    }
}

impl Printing<'_> {
    fn push(&mut self, number: usize, end: End) -> Result<(), Failure> {
        let text = self.rows.push(number, end)?;
        if text.is_empty() {
            return Ok(());
        }
        let header = if self.has_begun { String::new() } else { self.rows.header()? };
        self.has_begun = true;
        to_stdout(&(header + &text))
    }
}
