//! `catchment outcome`: what becomes of listed pose errors.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::method_args::PoseMethodArgs;
use crate::output::{OutputArgs, to_stderr, to_stdout};
use crate::signals;
use crate::source::read_table;
use catchment::advice::Advice;
use catchment::design::Diagnostics;
use catchment::method::Method;
use catchment::method::descent::End;
use catchment::poses::{OffsetsAt, PoseTable};
use catchment::problem::Problem;
use catchment::report::schema::WarningReport;
use catchment::report::{OutcomeRows, OutcomesReport};
use catchment::study::friction::MayStick;
use catchment::terminal::shown;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

/// Compute the outcome of every pose error in a table
///
/// Reads a CSV table with a header and prints it again with the outcome (aligned, jammed, missed, undecided)
/// and the last pose error of every row, with friction also whether it may have stuck on its way, each row as soon as it and all before it are decided. How many met which outcome goes to
/// stderr. Where it is interrupted (Ctrl-C) the rows that are finished are printed; instead of the file of -o they go into
/// FILE.partial. Exit code 130 then.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment outcome design.toml --poses poses.csv -o outcomes.csv\n  \
    printf 'x_mm,pitch_deg\\n5,10\\n20,-30\\n' | catchment outcome design.toml --poses -\n  \
    catchment outcome design.toml --poses poses.csv --json | jq .counts\n  \
    catchment outcome design.toml --poses poses.csv --method drop --friction 0.2\n  \
    catchment outcome design.toml --poses robot.csv --offsets-at cor\n\n\
    Columns: x, y, roll, pitch, yaw in any order, in D and radians; missing ones are 0. A unit \
    changes that: x_mm, y_in, x_D, pitch_deg, yaw [rad], x (mm). Other columns are carried through, and named on stderr; a \
    name that is nearly an error (dx, X_mm) is refused. Final errors come in the units of their columns. At most 64 MiB and 1000000 poses.")]
pub(crate) struct OutcomeArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// The table of pose errors (CSV); - reads stdin
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    poses: PathBuf,
    #[command(flatten)]
    method: PoseMethodArgs,
    /// The point of the moving half where x and y are measured, of given poses and of final ones
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

/// Where offsets are measured.
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
    args.output.check()?;
    args.output.check_partial()?;
    let method = args.method.of()?;
    let problem = args.design.problem()?;
    let source = read_table(&args.poses)?;
    let table = PoseTable::parse(&source.text, problem.design(), args.offsets_at.into())
        .map_err(|diagnostics| Diagnostics { source: Some(source.clone()), ..diagnostics })?;
    let running = args.exec.start()?;
    let needed = OutcomesReport::bytes(&table, args.json);
    running
        .exec
        .ensure_fits("the answer for every pose", needed, |_| vec![Advice::FewerPoses, Advice::MoreMemory])?;
    let doubts = MayStick::of(&problem, &method, table.errors());
    let printed = Printed::new(&problem, &table, &method, doubts.as_ref());
    let streams = args.output.is_printed() && !args.json;
    let stop = running.exec.cancel_flag();
    let tell = |number, end| {
        // Here, where each is decided: on all threads.
        let _may_stick = doubts.as_ref().map(|doubts| doubts.may_stick(number));
        if streams && !running.beside_bar(|| printed.push(number, end)) {
            stop.store(true, Ordering::Relaxed);
        }
    };
    let followed = problem.follow_telling(&method, table.errors(), &running.exec, &tell)?;
    drop(running);
    let report = OutcomesReport::new(&problem, &table, &method, &followed, doubts.as_ref());
    let text = match (streams, args.json) {
        (true, _) => printed.rest()?,
        (false, true) => report.to_json()?,
        (false, false) => report.to_csv()?,
    };
    if report.partial().is_some() {
        let place = args.output.write_partial(&text)?;
        let beside = place.map(|path| format!("they are in {}", shown(&path)));
        let lines = report.warnings.iter().map(WarningReport::line).chain(report.summary()).chain(beside);
        to_stderr(&std::iter::once("interrupted".to_owned()).chain(lines).collect::<Vec<_>>());
        return Ok(signals::received().unwrap_or(ExitStatus::Failed));
    }
    args.output.write(&text)?;
    let mut said = report.warnings.iter().map(WarningReport::line).collect::<Vec<_>>();
    said.extend(report.summary());
    to_stderr(&said);
    Ok(ExitStatus::Done)
}

/// Rows on stdout as they are decided. The names of the columns come with the first row: where nothing is decided nothing is printed.
struct Printed<'a>(Mutex<Printing<'a>>);

struct Printing<'a> {
    rows: OutcomeRows<'a>,
    has_begun: bool,
    /// Why it cannot go on.
    failed: Option<Failure>,
}

impl<'a> Printed<'a> {
    fn new(
        problem: &'a Problem,
        table: &'a PoseTable<'a>,
        method: &Method,
        doubts: Option<&'a MayStick<'a>>,
    ) -> Self {
        let rows = OutcomeRows::new(problem, table, method, doubts);
        Self(Mutex::new(Printing { rows, has_begun: false, failed: None }))
    }

    /// A pose is decided; false where rows cannot be printed any more.
    fn push(&self, number: usize, end: End) -> bool {
        let mut printing = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if printing.failed.is_none()
            && let Err(failure) = printing.push(number, end)
        {
            printing.failed = Some(failure);
        }
        printing.failed.is_none()
    }

    /// What is left to print when no more poses will be decided.
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
