//! `catchment reproduce`: published tables beside recomputed values, and the coverage of the program's
//! confidence intervals.

use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{file, lines, to_stderr, to_stdout, written};
use catchment::exec::Exec;
use catchment::report::csv;
use catchment_validation::report::{Effort, folder};
use catchment_validation::study::accuracy::{self, CASES, DRAWN, LABELLED};
use catchment_validation::study::reproduce::ReproduceSettings;
use catchment_validation::study::{COVERAGE, FIGURE, Request};
use catchment_validation::tables::TABLES;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Recompute published tables beside the printed values
///
/// The kinematic bounds (3.3, 3.4) are exact. The discrete tables (5.4 to 5.11) use conventions that were fitted to these very tables:
/// agreement shows that the conventions are right, not that the numbers hold as physics. --exact adds the values of frictionless motion.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment reproduce
      every table, and its agreement
  catchment reproduce 5.7
  catchment reproduce 3.3 3.4 --csv > kinematic.csv
  catchment reproduce 5.2 5.4 --exact
      with the exact value of every entry
  catchment reproduce 3.2 3.3 3.4 -o out
      with coloured pictures, CSV and JSON
  catchment reproduce 5.13 -o out
      the convergence figure, with our methods
  catchment reproduce --markdown > docs/reproduction.md
      the page of the documentation (minutes)
  catchment reproduce coverage
      coverage of the 95 % intervals of `run` (minutes)
  catchment reproduce accuracy
      the error of every method on eleven designs (minutes)")]
pub(crate) struct ReproduceArgs {
    /// Numbers of tables in the dissertation; `5.13`, a figure; `coverage`; or `accuracy` alone [default: all tables]
    #[arg(value_name = "TABLE", value_parser = tables())]
    tables: Vec<String>,
    #[command(flatten)]
    form: FormArgs,
    /// Add the exact value of every entry, by descent (seconds to a minute per table)
    #[arg(long)]
    exact: bool,
    /// Also write pictures, tables.csv and report.json into this folder; - is stdout
    #[arg(short, long, value_name = "DIR", value_hint = clap::ValueHint::DirPath, conflicts_with = "markdown")]
    output: Option<PathBuf>,
    #[command(flatten)]
    exec: ExecArgs,
}

impl ReproduceArgs {
    /// The folder to write.
    fn output(&self) -> Option<&Path> {
        file(self.output.as_deref())
    }

    /// The requested tables and figures.
    fn request(&self) -> Request {
        let settings = ReproduceSettings { exact: self.exact || self.form.markdown };
        let mut request = Request::of(&self.tables, settings);
        // The documentation page contains every table and the figure, but not the accuracy study.
        request.figure |= self.tables.is_empty() && self.form.markdown;
        request
    }
}

/// How the result is printed.
#[derive(Debug, Args)]
struct FormArgs {
    /// Print JSON
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print CSV, a line per entry
    #[arg(long)]
    csv: bool,
    /// Print the page of the documentation: tables with exact values and the figure (minutes), or accuracy
    #[arg(long, conflicts_with_all = ["json", "csv"])]
    markdown: bool,
}

/// The accuracy study, which reproduces no published table.
const ACCURACY: &str = "accuracy";

/// The program's version, for JSON and pages.
const VERSION: &str = env!("CARGO_PKG_VERSION");

fn tables() -> PossibleValuesParser {
    let published = TABLES.iter().map(|table| PossibleValue::new(table.name).help(table.title));
    let coverage =
        PossibleValue::new(COVERAGE).help("Share of repeated runs whose 95 % interval holds the exact Sum");
    let accuracy = PossibleValue::new(ACCURACY).help("Sum by every method beside the exact one");
    let figure =
        PossibleValue::new(FIGURE).help("Convergence of the V-Face: Sum and time over the resolution");
    PossibleValuesParser::new(published.chain([figure, coverage, accuracy]))
}

pub(crate) fn run(args: &ReproduceArgs) -> Result<ExitStatus, Failure> {
    if args.tables.iter().any(|table| table == ACCURACY) {
        if args.tables.len() > 1 {
            let message = "accuracy is no published table, and is computed alone".to_owned();
            return Err(Failure::with_help(
                message,
                Some("name the other tables in a second command".to_owned()),
            ));
        }
        return accuracy(args);
    }
    let started = Instant::now();
    let request = args.request();
    if request.coverage && (args.form.csv || args.form.markdown || args.output().is_some()) {
        let help = Some("print it as text or with --json".to_owned());
        return Err(Failure::with_help(format!("{COVERAGE} is no table of published entries"), help));
    }
    if let Some(path) = args.output() {
        folder::check(path, &Exec::new())?;
    }
    let running = args.exec.start()?;
    let result = request.run(&running.exec)?;
    let mut notes = Vec::new();
    if let Some(path) = args.output() {
        notes.push(folder::save(&result, path, VERSION, &running.exec)?);
        written(path);
    }
    let threads = running.exec.threads();
    drop(running);
    if args.form.json {
        to_stdout(&format!("{:#}\n", result.json(VERSION)))?;
    } else if args.form.csv {
        to_stdout(&String::from_utf8(csv(&result.records())?)?)?;
        if let Some(figure) = &result.figure {
            to_stdout(&String::from_utf8(csv(&figure.records())?)?)?;
        }
    } else if args.form.markdown {
        let effort = Effort { seconds: started.elapsed().as_secs_f64(), threads };
        to_stdout(&result.markdown(VERSION, &effort)?)?;
    } else {
        to_stdout(&result.to_string())?;
    }
    notes.extend(lines(&result.warnings()));
    to_stderr(&notes);
    Ok(ExitStatus::Done)
}

/// Computes the error of every method.
fn accuracy(args: &ReproduceArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let running = args.exec.start()?;
    let threads = running.exec.threads();
    let table = accuracy::run(&CASES, &LABELLED, DRAWN, &running.exec)?;
    drop(running);
    let effort = Effort { seconds: started.elapsed().as_secs_f64(), threads };
    let text = if args.form.json {
        format!("{:#}\n", table.json(&effort))
    } else if args.form.csv {
        String::from_utf8(csv(&table.records())?)?
    } else if args.form.markdown {
        table.page(VERSION, &effort)?
    } else {
        table.to_string()
    };
    to_stdout(&text)?;
    Ok(ExitStatus::Done)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::FromArgMatches as _;

    /// Exact values have their own tests: they take half a minute per table.
    #[test]
    fn exact_and_markdown_request_exact_values() {
        let exact = |words: &str| {
            let command = ReproduceArgs::augment_args(clap::Command::new("reproduce"));
            let read = command.try_get_matches_from(words.split(' ')).unwrap();
            ReproduceArgs::from_arg_matches(&read).unwrap().request().settings.exact
        };
        assert!(exact("reproduce 5.2 --exact") && exact("reproduce --markdown"));
        assert!(!exact("reproduce 5.2"));
    }
}
