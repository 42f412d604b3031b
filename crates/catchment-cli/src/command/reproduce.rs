//! `catchment reproduce`: the dissertation's tables beside what this program computes, and how often its own
//! intervals hold.

use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{number, to_stderr, to_stdout};
use catchment::report::folder::{REPORT, encode, has_only, is_report, write_all};
use catchment::acceptance::Warning;
use catchment::exec::Exec;
use catchment::report::figure::{self, Picture};
use catchment::report::write;
use catchment::study::accuracy;
use catchment::study::coverage::{Settings, coverage};
use catchment::study::reproduce::resolution::{self, Found};
use catchment::study::reproduce::{self, HELD, TABLES, TableComparison, page};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use serde_json::json;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Compute published tables and set them beside the printed ones
///
/// The kinematic bounds (3.3, 3.4) are exact. The discrete tables (5.4 to 5.9) are computed with conventions
/// that were fitted to these very tables: that they agree shows that the conventions are understood, not that
/// the numbers are right as physics. --exact puts what frictionless motion gives beside both.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment reproduce                     every table, and how well each agrees\n  \
    catchment reproduce 5.7                 one of them\n  \
    catchment reproduce 3.3 3.4 --csv > kinematic.csv\n  \
    catchment reproduce 5.2 5.4 --exact     with the exact value of every entry\n  \
    catchment reproduce 3.2 3.3 3.4 -o out  with pictures in colours, CSV and JSON\n  \
    catchment reproduce 5.13 -o out         the convergence figure, drawn with our methods\n  \
    catchment reproduce --markdown > docs/reproduction.md   the page of the documentation (minutes)\n  \
    catchment reproduce coverage            how often the 95 % intervals of `run` hold (minutes)\n  \
    catchment reproduce accuracy            how far every method is off, on eleven designs (minutes)")]
pub(crate) struct ReproduceArgs {
    /// Numbers of the tables in the dissertation, all of them when none is named; `5.13`, a figure; or `coverage`; or
    /// `accuracy` alone
    #[arg(value_name = "TABLE", value_parser = tables())]
    tables: Vec<String>,
    #[command(flatten)]
    form: FormArgs,
    /// Also the exact value of every entry, by descent (seconds to a minute per table)
    #[arg(long)]
    exact: bool,
    /// Write pictures, tables.csv and report.json into this folder
    #[arg(short, long, value_name = "DIR", value_hint = clap::ValueHint::DirPath, conflicts_with = "markdown")]
    output: Option<PathBuf>,
    #[command(flatten)]
    exec: ExecArgs,
}

/// How the result is printed.
#[derive(Debug, Args)]
struct FormArgs {
    /// Print JSON
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print CSV, one line per entry
    #[arg(long)]
    csv: bool,
    /// Print the page of the documentation: of the tables, with exact values and the figure (minutes), or of accuracy
    #[arg(long, conflicts_with_all = ["json", "csv"])]
    markdown: bool,
}

/// The study of this program's own intervals: takes minutes, so only when it is named.
const COVERAGE: &str = "coverage";

/// Version of the JSON that `--json` prints.
const JSON_SCHEMA: u32 = 2;

/// The figure that is drawn again.
const FIGURE: &str = "5.13";

/// The table that no dissertation has printed.
const ACCURACY: &str = "accuracy";

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
    let named = |name: &str| args.tables.iter().any(|t| t == name);
    let all = args.tables.is_empty();
    let names: Vec<&str> = TABLES.iter().map(|table| table.name).filter(|name| all || named(name)).collect();
    let own = named(COVERAGE);
    if own && (args.form.csv || args.form.markdown || args.output.is_some()) {
        let help = Some("print it as text or with --json".to_owned());
        return Err(Failure::with_help(format!("{COVERAGE} is no table of published entries"), help));
    }
    if let Some(path) = &args.output {
        write::check_folder(path, is_ours)?;
    }
    let running = args.exec.start()?;
    let settings = reproduce::Settings { exact: args.exact || args.form.markdown };
    let mut compared = Vec::new();
    for (k, name) in names.iter().enumerate() {
        running.exec.report(k as f64 / names.len() as f64, "tables");
        compared.push(reproduce::reproduce(name, &settings, &running.exec)?);
    }
    let drawn = named(FIGURE) || all && args.form.markdown;
    let figure =
        drawn.then(|| resolution::run(&resolution::Settings::default(), &running.exec)).transpose()?;
    let coverage = own.then(|| coverage(&Settings::default(), &running.exec)).transpose()?;
    let warning = Warning::DissertationConventions;
    let tables: Vec<_> = compared.iter().map(|table| json(table, &warning)).collect();
    let mut report =
        json!({ "schema": JSON_SCHEMA, "catchment": env!("CARGO_PKG_VERSION"), "tables": tables });
    if let Some(figure) = &figure {
        report["figure_5_13"] = json!(figure);
    }
    if let Some(coverage) = &coverage {
        report[COVERAGE] = json!(coverage);
    }
    let mut notes = Vec::new();
    if let Some(path) = &args.output {
        notes.push(write_folder(path, &compared, figure.as_ref(), &report, &running.exec)?);
    }
    let threads = running.exec.threads();
    drop(running);
    if args.form.json {
        to_stdout(&format!("{report:#}\n"))?;
    } else if args.form.csv {
        to_stdout(&csv(&compared)?)?;
        if let Some(figure) = &figure {
            to_stdout(&String::from_utf8(catchment::report::folder::csv(&figure.records())?)?)?;
        }
    } else if args.form.markdown {
        let (version, seconds) = (env!("CARGO_PKG_VERSION"), started.elapsed().as_secs_f64());
        let took = format!("It took {seconds:.0} s on {threads} threads, with version {version}.");
        to_stdout(&page(&compared, figure.as_ref(), &took)?)?;
    } else {
        let coverage = coverage.map_or_else(String::new, |c| c.to_string());
        to_stdout(&(text(&compared, figure.as_ref())? + &coverage))?;
    }
    if compared.iter().any(is_fitted) {
        notes.push(format!("warning: {warning}"));
    }
    to_stderr(&notes);
    Ok(ExitStatus::Done)
}

/// The names of everything that is written into a folder.
const CSV: &str = "tables.csv";
const FIGURE_FILE: &str = "figure-5.13";

/// Whether a folder was written by this command, or is empty: replacing it loses nothing else.
fn is_ours(path: &Path) -> bool {
    has_only(path, |name| {
        let table = name.strip_prefix("table-").and_then(|rest| rest.rsplit_once('.'));
        let is_table = table.is_some_and(|(table, ending)| {
            TABLES.iter().any(|known| known.name == table) && matches!(ending, "png" | "svg")
        });
        let figure = name.strip_prefix(FIGURE_FILE);
        is_table
            || figure.is_some_and(|ending| matches!(ending, ".png" | ".svg" | ".csv"))
            || name == CSV
            || name == REPORT && is_report(&path.join(REPORT))
    })
}

/// Writes pictures, tables and report, and says what was written.
fn write_folder(
    path: &Path,
    tables: &[TableComparison],
    figure: Option<&Found>,
    report: &serde_json::Value,
    exec: &Exec,
) -> Result<String, Failure> {
    let mut drawn: Vec<(String, Picture)> = Vec::new();
    for table in tables {
        drawn.push((format!("table-{}", table.table), figure::published(table)?));
    }
    let mut files = Vec::new();
    if let Some(found) = figure {
        drawn.push((FIGURE_FILE.to_owned(), figure::resolution(found)));
        files.push((format!("{FIGURE_FILE}.csv"), catchment::report::folder::csv(&found.records())?));
    }
    let pictures = drawn.len();
    files.extend(encode(&drawn, exec)?);
    files.push((CSV.to_owned(), csv(tables)?.into_bytes()));
    files.push((REPORT.to_owned(), format!("{report:#}\n").into_bytes()));
    write::folder(path, is_ours, |folder| write_all(folder, &files, exec))?;
    Ok(format!("wrote {}: {REPORT}, {CSV}, {pictures} pictures as PNG and SVG", path.display()))
}

/// How far every method is off.
fn accuracy(args: &ReproduceArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let running = args.exec.start()?;
    let threads = running.exec.threads();
    let table = accuracy::run(&accuracy::CASES, &running.exec)?;
    drop(running);
    let total_s = started.elapsed().as_secs_f64();
    let text = if args.form.json {
        let timing = json!({ "total_s": total_s, "threads": threads });
        format!("{:#}\n", json!({ "schema": JSON_SCHEMA, "accuracy": table, "timing": timing }))
    } else if args.form.csv {
        String::from_utf8(catchment::report::folder::csv(&table.records())?)?
    } else if args.form.markdown {
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
    table.method.contains("preset")
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
    let head = "table row column unit published ours ratio as_printed matches exact exact_lo exact_hi exact_ratio \
                known_difference";
    writer.write_record(head.split_whitespace())?;
    let known = |value: Option<f64>| value.map_or_else(String::new, number);
    for table in tables {
        for (row, entries) in table.rows.iter().zip(&table.entries) {
            for (column, entry) in table.columns.iter().zip(entries) {
                let ci95 = entry.exact.and_then(|exact| exact.ci95);
                writer.write_record([
                    table.table,
                    row,
                    column,
                    table.unit,
                    &number(entry.published),
                    &known(entry.ours),
                    &known(entry.ratio),
                    &entry.as_printed.to_string(),
                    &entry.matches.map_or_else(String::new, |matches| matches.to_string()),
                    &known(entry.exact.map(|exact| exact.value)),
                    &known(ci95.map(|[lo, _]| lo)),
                    &known(ci95.map(|[_, hi]| hi)),
                    &known(entry.exact_ratio),
                    entry.known_difference.unwrap_or(""),
                ])?;
            }
        }
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// The tables, the figure, and where there are several tables a line for each and what is left out.
fn text(tables: &[TableComparison], figure: Option<&Found>) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for table in tables {
        writeln!(text, "{table}")?;
    }
    if let Some(found) = figure {
        let [lo, hi] = found.exact_ci95;
        writeln!(
            text,
            "Figure {FIGURE}: V-Face, H/D 1/4, COR -1/2: Sum in D·rad (seconds) over the resolution"
        )?;
        writeln!(
            text,
            "exact {:.4}, 95 % interval {lo:.4} … {hi:.4}, ρ = {} D",
            found.exact, found.rotation_length
        )?;
        write!(text, "  {:>4}", "N")?;
        for curve in &found.curves {
            write!(text, "{:>20}", curve.name)?;
        }
        writeln!(text)?;
        for resolution in &found.settings.resolutions {
            write!(text, "  {resolution:>4}")?;
            for curve in &found.curves {
                let point = curve.points.iter().find(|point| point.resolution == *resolution);
                let shown = point.map_or_else(String::new, |p| format!("{:.4} ({:.3} s)", p.sum, p.seconds));
                write!(text, "{shown:>20}")?;
            }
            writeln!(text)?;
        }
        writeln!(
            text,
            "note: no point of the published figure is held; its text says that the area starts larger and slowly\n      \
             decreases, and that the time grows like N²"
        )?;
    }
    if tables.len() > 1 {
        writeln!(text, "Summary")?;
        writeln!(text, "  table   as printed  matching  median error  mean |ln ratio|  by")?;
        for table in tables {
            let s = &table.summary;
            let of =
                |n: usize| if s.computed == 0 { "–".to_owned() } else { format!("{n}/{}", s.computed) };
            let percent =
                |v: Option<f64>| v.map_or_else(|| "–".to_owned(), |v| format!("{:.2} %", 100.0 * v));
            let mean = s.mean_log_ratio.map_or_else(|| "–".to_owned(), |mean| format!("{mean:.3}"));
            writeln!(
                text,
                "  {:<6}  {:>10}  {:>8}  {:>12}  {mean:>15}  {}",
                table.table,
                of(s.as_printed),
                if table.tolerance.is_some() { of(s.matching) } else { "–".to_owned() },
                percent(s.median_error),
                table.method,
            )?;
        }
        writeln!(text, "\nHeld or known, and not computed")?;
        for held in HELD {
            writeln!(text, "  {:<10}  {}: {}", held.name, held.title, held.reason)?;
        }
    }
    Ok(text)
}
