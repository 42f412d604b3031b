//! `catchment reproduce`: the dissertation's tables beside what this program computes, and how often its own
//! intervals hold.

use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{number, to_stderr, to_stdout};
use catchment::acceptance::Warning;
use catchment::study::accuracy;
use catchment::study::coverage::{Settings, coverage};
use catchment::study::reproduce::{TABLES, TableComparison, reproduce};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use serde_json::json;
use std::fmt::Write;
use std::time::Instant;

/// Compute published tables and set them beside the printed ones
///
/// The kinematic bounds (3.3, 3.4) are exact. The discrete tables (5.4 to 5.9) are computed with conventions
/// that were fitted to these very tables: that they agree shows that the conventions are understood, not that
/// the numbers are right as physics.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment reproduce                     every table, and how well each agrees\n  \
    catchment reproduce 5.7                 one of them\n  \
    catchment reproduce 3.3 3.4 --csv > kinematic.csv\n  \
    catchment reproduce coverage            how often the 95 % intervals of `run` hold (minutes)\n  \
    catchment reproduce accuracy            how far every method is off, on eleven designs (minutes)")]
pub(crate) struct ReproduceArgs {
    /// Numbers of the tables in the dissertation, all of them when none is named; or `coverage`; or `accuracy` alone
    #[arg(value_name = "TABLE", value_parser = tables())]
    tables: Vec<String>,
    /// Print JSON
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print CSV, one line per entry
    #[arg(long)]
    csv: bool,
    /// accuracy: print the page of the documentation
    #[arg(long, conflicts_with_all = ["json", "csv"])]
    markdown: bool,
    #[command(flatten)]
    exec: ExecArgs,
}

/// The study of this program's own intervals: takes minutes, so only when it is named.
const COVERAGE: &str = "coverage";

/// Version of the JSON that `--json` prints.
const JSON_SCHEMA: u32 = 1;

/// The table that no dissertation has printed.
const ACCURACY: &str = "accuracy";

fn tables() -> PossibleValuesParser {
    let published = TABLES.iter().map(|table| PossibleValue::new(table.name).help(table.title));
    let coverage =
        PossibleValue::new(COVERAGE).help("Share of repeated runs whose 95 % interval holds the exact Sum");
    let accuracy = PossibleValue::new(ACCURACY).help("Sum by every method beside the exact one");
    PossibleValuesParser::new(published.chain([coverage, accuracy]))
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
    if args.markdown {
        let message =
            "--markdown is for accuracy; published tables are printed as text, JSON or CSV".to_owned();
        return Err(Failure::with_help(message, None));
    }
    let wanted = |name: &str| args.tables.is_empty() || args.tables.iter().any(|t| t == name);
    let names: Vec<&str> = TABLES.iter().map(|table| table.name).filter(|name| wanted(name)).collect();
    let own = args.tables.iter().any(|t| t == COVERAGE);
    if own && args.csv {
        let help = Some("use --json, or leave --csv out".to_owned());
        return Err(Failure::with_help(format!("{COVERAGE} is no table of published entries"), help));
    }
    let running = args.exec.start()?;
    let mut compared = Vec::new();
    for (k, name) in names.iter().enumerate() {
        running.exec.report(k as f64 / names.len() as f64, "tables");
        compared.push(reproduce(name, &running.exec)?);
    }
    let coverage = own.then(|| coverage(&Settings::default(), &running.exec)).transpose()?;
    drop(running);
    let fitted = compared.iter().any(is_fitted);
    let warning = Warning::DissertationConventions;
    if args.json {
        let tables: Vec<_> = compared.iter().map(|table| json(table, &warning)).collect();
        let mut value = json!({ "schema": JSON_SCHEMA, "tables": tables });
        if let Some(coverage) = coverage {
            value[COVERAGE] = json!(coverage);
        }
        to_stdout(&format!("{value:#}\n"))?;
    } else if args.csv {
        to_stdout(&csv(&compared)?)?;
    } else {
        to_stdout(&(text(&compared)? + &coverage.map_or_else(String::new, |c| c.to_string())))?;
    }
    if fitted {
        to_stderr(&[format!("warning: {warning}")]);
    }
    Ok(ExitStatus::Done)
}

/// How far every method is off.
fn accuracy(args: &ReproduceArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let running = args.exec.start()?;
    let threads = running.exec.threads();
    let table = accuracy::run(&accuracy::CASES, &running.exec)?;
    drop(running);
    let total_s = started.elapsed().as_secs_f64();
    let text = if args.json {
        let timing = json!({ "total_s": total_s, "threads": threads });
        format!("{:#}\n", json!({ "schema": JSON_SCHEMA, "accuracy": table, "timing": timing }))
    } else if args.csv {
        String::from_utf8(crate::result_folder::csv(&table.records())?)?
    } else if args.markdown {
        let version = env!("CARGO_PKG_VERSION");
        table.markdown(&format!("It took {total_s:.0} s on {threads} threads, with version {version}."))?
    } else {
        table.to_string()
    };
    to_stdout(&text)?;
    Ok(ExitStatus::Done)
}

/// Whether the dissertation preset computed the table; the kinematic bounds need none.
fn is_fitted(table: &TableComparison) -> bool {
    table.table.starts_with("5.")
}

fn json(table: &TableComparison, warning: &Warning) -> serde_json::Value {
    let mut value = json!(table);
    let warnings = if is_fitted(table) { vec![warning] } else { Vec::new() };
    value["warnings"] = warnings
        .into_iter()
        .map(|w| {
            let mut doubt = json!(w);
            doubt["message"] = w.to_string().into();
            doubt
        })
        .collect();
    value
}

fn csv(tables: &[TableComparison]) -> Result<String, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let head = "table row column unit published ours ratio exact matches known_difference";
    writer.write_record(head.split(' '))?;
    for table in tables {
        for (row, entries) in table.rows.iter().zip(&table.entries) {
            for (column, entry) in table.columns.iter().zip(entries) {
                writer.write_record([
                    table.table,
                    &number(*row),
                    &number(*column),
                    table.unit,
                    &number(entry.published),
                    &number(entry.ours),
                    &number(entry.ratio),
                    &entry.exact.to_string(),
                    &entry.matches.to_string(),
                    entry.known_difference.unwrap_or(""),
                ])?;
            }
        }
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// The tables, and a line for each at the end where there are several.
fn text(tables: &[TableComparison]) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for table in tables {
        writeln!(text, "{table}")?;
    }
    if tables.len() > 1 {
        writeln!(text, "Summary")?;
        writeln!(text, "  table     exact  matching  median error  mean |ln ratio|  as")?;
        for table in tables {
            let s = &table.summary;
            writeln!(
                text,
                "  {:<5}  {:>8}  {:>8}  {:>10.2} %  {:>15.3}  {}",
                table.table,
                format!("{}/{}", s.exact, s.entries),
                format!("{}/{}", s.matching, s.entries),
                100.0 * s.median_error,
                s.mean_log_ratio,
                if is_fitted(table) { "conventions fitted to the table" } else { "exact bound" },
            )?;
        }
    }
    Ok(text)
}
