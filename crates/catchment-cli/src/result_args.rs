//! How a result is printed and stored, alike on every command that has one.
//!
//! ```text
//!   report ──┬─▶ stdout         text; --json, --csv
//!            ├─▶ -o FILE        .json .csv .md .html .txt, pictures .png .svg
//!            │   -o FOLDER      all of them
//!            ├─▶ --figure FILE  the picture beside another file
//!            └─▶ --require      exit code 1 unless it holds
//! ```

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{check_apart, check_place, image, to_stderr, to_stdout, write_file, written};
use catchment::document::Subject;
use catchment::exec::Exec;
use catchment::problem::Problem;
use catchment::report::document::{Printed, Style, html, markdown, text};
use catchment::report::figure::Picture;
use catchment::report::folder::{Files, StudyFolder, encode};
use catchment::report::json_schema;
use catchment::report::schema::{Timing, WarningReport};
use catchment::report::{Envelope, ReportOf, csv};
use catchment::run::{Requirement, RequirementError};
use catchment::terminal::{escaped, shown};
use clap::Args;
use serde::Serialize;
use std::cell::OnceCell;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// How a result is printed and stored.
#[derive(Debug, Args)]
pub(crate) struct ResultArgs {
    /// Print JSON, in D and radians
    #[arg(long, conflicts_with = "csv", help_heading = "Output")]
    json: bool,
    /// Print the table for programs, in D and radians
    #[arg(long, help_heading = "Output")]
    csv: bool,
    /// End with exit code 1 unless this holds of the JSON report; may be repeated
    #[arg(long, value_name = "PATH OP NUMBER", value_parser = requirement, help_heading = "Output")]
    require: Vec<Requirement>,
    /// Also write this: the ending of a file says what (.json, .csv, .md, .html, .txt, .png, .svg), a folder gets all of it
    #[arg(short, long, value_name = "PATH", value_hint = clap::ValueHint::AnyPath, help_heading = "Output")]
    output: Option<PathBuf>,
    /// Also draw it, as .png or .svg
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = "Output")]
    figure: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long, help_heading = "Output")]
    force: bool,
}

/// Reads a requirement.
pub(crate) fn requirement(text: &str) -> Result<Requirement, String> {
    text.parse::<Requirement>().map_err(|error| escaped(&error.to_string()))
}

/// What a path receives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Json,
    Csv,
    Markdown,
    Html,
    Text,
    Png,
    Svg,
    Folder,
}

/// Every ending that a file may have.
const ENDINGS: [(&str, Kind); 7] = [
    ("json", Kind::Json),
    ("csv", Kind::Csv),
    ("md", Kind::Markdown),
    ("html", Kind::Html),
    ("txt", Kind::Text),
    ("png", Kind::Png),
    ("svg", Kind::Svg),
];

impl Kind {
    /// By the ending of a path; one without an ending is a folder.
    fn of(path: &Path, drawable: bool) -> Result<Self, Failure> {
        let Some(ending) = path.extension().and_then(OsStr::to_str) else { return Ok(Self::Folder) };
        let known = ENDINGS.iter().filter(|(_, kind)| drawable || !kind.is_picture());
        match known.clone().find(|(name, _)| name.eq_ignore_ascii_case(ending)) {
            Some((_, kind)) => Ok(*kind),
            None => {
                let names: Vec<&str> = known.map(|(name, _)| *name).collect();
                let help =
                    format!("let its name end in .{}, or give a folder without an ending", names.join(", ."));
                Err(Failure::with_help(format!("cannot tell what to write into {}", shown(path)), Some(help)))
            }
        }
    }

    const fn is_picture(self) -> bool {
        matches!(self, Self::Png | Self::Svg)
    }

    const fn ending(self) -> &'static str {
        if matches!(self, Self::Png) { "png" } else { "svg" }
    }
}

/// Places that were tried out before anything is computed.
#[derive(Debug)]
pub(crate) struct Output<'a> {
    args: &'a ResultArgs,
    file: Option<(&'a Path, Kind)>,
    figure: Option<(&'a Path, Kind)>,
    drawable: bool,
}

impl ResultArgs {
    /// Refuses, before anything is computed, what cannot be written and requirements that no report of this kind answers. `drawable`: whether there is a
    /// picture of it.
    pub(crate) fn check(&self, report: &'static str, drawable: bool) -> Result<Output<'_>, Failure> {
        let file = match &self.output {
            Some(path) => Some((path.as_path(), Kind::of(path, drawable)?)),
            None => None,
        };
        let figure = self.figure.as_deref().map(|path| match Kind::of(path, drawable) {
            Ok(kind) if kind.is_picture() => Ok((path, kind)),
            _ if !drawable => Err(Failure::with_help(
                "there is no picture of this result".to_owned(),
                Some("leave --figure out".to_owned()),
            )),
            _ => {
                let message = format!("cannot tell what to draw into {}", shown(path));
                Err(Failure::with_help(message, Some("let its name end in .png or .svg".to_owned())))
            }
        });
        let figure = figure.transpose()?;
        check_apart(self.output.as_deref(), self.figure.as_deref())?;
        for (path, kind) in file.iter().chain(&figure) {
            match kind {
                Kind::Folder => StudyFolder { path, name: report }.check(&Exec::new())?,
                _ => check_place(path, self.force)?,
            }
        }
        if self.force && file.is_none() && figure.is_none() {
            return Err(Failure::with_help(
                "--force replaces files, and none is to be written".to_owned(),
                Some("leave it out, or give -o".to_owned()),
            ));
        }
        self.check_requirements(report, &[])?;
        Ok(Output { args: self, file, figure, drawable })
    }

    /// Whether a file is named that holds a picture.
    pub(crate) fn names_picture(&self) -> bool {
        let of = |path: &PathBuf| Kind::of(path, true).is_ok_and(Kind::is_picture);
        self.figure.is_some() || self.output.as_ref().is_some_and(of)
    }

    /// Refuses requirements that no report of this kind answers, and those on places that are null in this one.
    pub(crate) fn check_requirements(&self, report: &str, absent: &[&str]) -> Result<(), Failure> {
        let Some(schema) = json_schema::of_kind(report) else { return Ok(()) };
        self.check_each(|requirement| requirement.check(&schema, absent))
    }

    /// Refuses requirements on items that a list of the report does not have.
    pub(crate) fn check_items(&self, list: &str, names: &[&str]) -> Result<(), Failure> {
        self.check_each(|requirement| requirement.check_items(list, names))
    }

    fn check_each(
        &self,
        check: impl Fn(&Requirement) -> Result<(), RequirementError>,
    ) -> Result<(), Failure> {
        for requirement in &self.require {
            let refused = |error| Failure::with_help(format!("--require '{requirement}': {error}"), None);
            check(requirement).map_err(refused)?;
        }
        Ok(())
    }
}

impl Output<'_> {
    /// Whether a picture is to be written.
    pub(crate) fn wants_picture(&self) -> bool {
        self.figure.is_some() || self.file.is_some_and(|(_, kind)| kind.is_picture() || kind == Kind::Folder)
    }

    /// Writes and prints a report, and says which requirements it does not meet. `draw` makes its picture, if there is one.
    pub(crate) fn finish<B: Printed + Serialize>(
        self,
        report: &Envelope<B>,
        draw: impl Fn() -> Result<Picture, Failure>,
    ) -> Result<ExitStatus, Failure> {
        let drawn: OnceCell<Picture> = OnceCell::new();
        let picture = || -> Result<&Picture, Failure> {
            if let Some(picture) = drawn.get() {
                return Ok(picture);
            }
            let picture = draw()?;
            Ok(drawn.get_or_init(|| picture))
        };
        let document = report.described();
        for (path, kind) in self.file.iter().chain(&self.figure) {
            let bytes = match kind {
                Kind::Json => report.to_json()?.into_bytes(),
                Kind::Csv => table(report)?,
                Kind::Markdown => markdown(&document).into_bytes(),
                Kind::Html => html(&document).into_bytes(),
                Kind::Text => text(&document, Style::default()).into_bytes(),
                Kind::Png | Kind::Svg => image(picture()?, kind.ending())?,
                Kind::Folder => {
                    let folder = StudyFolder { path, name: B::KIND };
                    let exec = Exec::new();
                    let files = if self.drawable {
                        encode(&[(B::KIND, picture()?.clone())], &exec)?
                    } else {
                        Files::new()
                    };
                    folder.write(&report.to_json()?, &report.records(), files, &exec, |_| Ok(()))?;
                    written(path);
                    continue;
                }
            };
            write_file(path, &bytes, self.args.force)?;
        }
        if self.args.json {
            to_stdout(&report.to_json()?)?;
        } else if self.args.csv {
            to_stdout(&String::from_utf8_lossy(&table(report)?))?;
        } else {
            to_stdout(&text(&document, crate::output::style()))?;
        }
        let verdicts = report.verdicts(&self.args.require)?;
        let unmet: Vec<String> =
            verdicts.iter().filter(|verdict| !verdict.met).map(ToString::to_string).collect();
        to_stderr(&unmet);
        Ok(if unmet.is_empty() { ExitStatus::Done } else { ExitStatus::RequirementNotMet })
    }
}

/// The table of a report for programs.
fn table<B: Printed>(report: &Envelope<B>) -> Result<Vec<u8>, Failure> {
    let records = report.records();
    if records.is_empty() {
        let help = "--json prints all of it".to_owned();
        return Err(Failure::with_help("this result has no table for programs".to_owned(), Some(help)));
    }
    Ok(csv(&records)?)
}

/// A picture of a report of a problem.
pub(crate) type Draw<T> = fn(&ReportOf<T>, &Problem) -> Result<Picture, Failure>;

/// Computes a result of a design, prints and stores it: what every study does.
pub(crate) fn study<T: Subject>(
    design: &DesignArgs,
    result: &ResultArgs,
    exec: &ExecArgs,
    draw: Option<Draw<T>>,
    compute: impl FnOnce(&Problem, &Exec) -> Result<T, Failure>,
) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let output = result.check(T::KIND, draw.is_some())?;
    let problem = design.problem()?;
    let running = exec.start()?;
    running.may_be_left();
    let found = compute(&problem, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    drop(running);
    let report = ReportOf::new(problem.design(), found, warnings(&problem), Some(timing));
    output.finish(&report, || match draw {
        Some(draw) => draw(&report, &problem),
        None => Err(no_picture()),
    })
}

/// What speaks against the numbers of a problem before any is computed.
pub(crate) fn warnings(problem: &Problem) -> Vec<WarningReport> {
    problem.objections().iter().map(WarningReport::note).collect()
}

/// Asked for a picture of something that has none: refused before anything was computed.
pub(crate) fn no_picture() -> Failure {
    Failure::with_help("there is no picture of this result".to_owned(), None)
}
