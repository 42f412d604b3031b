//! Printing and storage of results, the same for every command that has one.
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
use crate::output::{
    OutputArgs, check_apart, check_place, file, image, style, to_stderr, to_stdout, warn, write_file, written,
};
use catchment::document::Subject;
use catchment::exec::Exec;
use catchment::problem::Problem;
use catchment::report::document::{Described, Printed, Style, body, html, markdown, text};
use catchment::report::figure::Picture;
use catchment::report::folder::{Files, SaveError, StudyFolder, encode};
use catchment::report::json_schema;
use catchment::report::schema::Timing;
use catchment::report::{ReportEnvelope, ReportOf, csv};
use catchment::run::{Requirement, RequirementError};
use catchment::terminal::{escaped, shown};
use clap::Args;
use serde::Serialize;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// How a result is printed.
#[derive(Debug, Default, Args)]
pub(crate) struct PrintArgs {
    /// Print JSON, in D and radians
    #[arg(long, conflicts_with = "csv", help_heading = "Output")]
    pub(crate) json: bool,
    /// Print the table as CSV, in D and radians
    #[arg(long, hide_short_help = true, help_heading = "Output")]
    csv: bool,
    /// Print details as well
    #[arg(short, long, help_heading = "Output")]
    verbose: bool,
    /// Exit with code 1 unless the JSON report meets this, such as "onaa.edge>=0.2"; may be repeated
    #[arg(long, value_name = "CONDITION", value_parser = requirement, hide_short_help = true, help_heading = "Output")]
    pub(crate) require: Vec<Requirement>,
}

/// How a result is printed and stored.
#[derive(Debug, Args)]
pub(crate) struct ResultArgs {
    #[command(flatten)]
    print: PrintArgs,
    /// Also write this file (.json, .csv, .md, .html, .txt, .png, .svg), or a folder with all of them
    ///
    /// `-` is stdout: nothing is written.
    #[arg(short, long, value_name = "PATH", value_hint = clap::ValueHint::AnyPath, help_heading = "Output")]
    output: Option<PathBuf>,
    /// Also draw the result into this .png or .svg file
    #[arg(long, hide_short_help = true, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = "Output")]
    figure: Option<PathBuf>,
    /// Replace files that exist
    ///
    /// A folder that catchment wrote is replaced without it, and no other folder.
    #[arg(long, help_heading = "Output")]
    force: bool,
}

/// Parses a requirement.
fn requirement(text: &str) -> Result<Requirement, String> {
    text.parse::<Requirement>().map_err(|error| escaped(&error.to_string()))
}

/// The content of an output path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Json,
    Csv,
    Markdown,
    Html,
    Text,
    Png,
    Svg,
    Folder,
    /// A file that the command writes itself, by its ending.
    Own(&'static str),
}

/// All supported endings of files.
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
    /// The kind by the ending of a path; a path without an ending is a folder. `own` endings take precedence.
    fn of(path: &Path, drawable: bool, own: &[&'static str]) -> Result<Self, Failure> {
        let Some(ending) = path.extension().and_then(OsStr::to_str) else { return Ok(Self::Folder) };
        let own = own.iter().map(|name| (*name, Self::Own(name)));
        let known = own.chain(ENDINGS.into_iter().filter(|(_, kind)| drawable || !kind.is_picture()));
        if let Some((_, kind)) = known.clone().find(|(name, _)| name.eq_ignore_ascii_case(ending)) {
            return Ok(kind);
        }
        let names: Vec<&str> = known.map(|(name, _)| name).collect();
        let help = format!("let its name end in .{}, or give a folder without an ending", names.join(", ."));
        Err(Failure::with_help(format!("cannot tell what to write into {}", shown(path)), Some(help)))
    }

    /// The kind by the ending of a path that receives the whole report as one text.
    pub(crate) fn of_text(path: &Path) -> Option<Self> {
        Self::of(path, false, &[]).ok().filter(|kind| !matches!(kind, Self::Csv | Self::Folder))
    }

    const fn is_picture(self) -> bool {
        matches!(self, Self::Png | Self::Svg)
    }

    const fn ending(self) -> &'static str {
        if matches!(self, Self::Png) { "png" } else { "svg" }
    }
}

/// Output destinations, checked before the computation.
#[derive(Debug)]
pub(crate) struct Output<'a> {
    print: &'a PrintArgs,
    force: bool,
    file: Option<(&'a Path, Kind)>,
    figure: Option<(&'a Path, Kind)>,
    /// The name of the table and the picture in a folder.
    name: &'static str,
    drawable: bool,
}

/// Pictures with their file names.
pub(crate) type Pictures = Vec<(&'static str, Picture)>;

impl ResultArgs {
    /// Output of a command that writes one table to the file of -o instead of stdout: whether the table is
    /// JSON, and its destination. `own` are endings of files with other contents.
    pub(crate) fn as_table(&self, own: &[&'static str]) -> Result<(bool, OutputArgs), Failure> {
        let refused =
            |message: &str, help: &str| Err(Failure::with_help(message.to_owned(), Some(help.to_owned())));
        if self.figure.is_some() {
            return refused(
                "a table of poses has no picture",
                "leave --figure out, or follow one pose: --pose",
            );
        }
        if !self.print.require.is_empty() {
            return refused(
                "--require is about one result, not a table",
                "leave it out, or follow one pose: --pose",
            );
        }
        if self.force && self.output().is_none() {
            return refused(NOTHING_TO_REPLACE, "leave it out, or give -o");
        }
        let kind = self.output().and_then(|path| Kind::of(path, true, own).ok());
        if kind.is_some_and(|kind| kind.is_picture() || matches!(kind, Kind::Own(_))) {
            return refused("a table of poses has no picture", "let the name of -o end in .csv or .json");
        }
        let is_json = self.print.json || kind == Some(Kind::Json);
        Ok((is_json, OutputArgs::new(self.output.clone(), self.force)))
    }

    /// Whether JSON is printed.
    pub(crate) const fn is_json(&self) -> bool {
        self.print.json
    }

    /// The file or the folder to write.
    pub(crate) fn output(&self) -> Option<&Path> {
        file(self.output.as_deref())
    }

    /// Rejects, before the computation, unwritable outputs and requirements that no report of this kind can
    /// answer. `drawable`: whether the report has a picture.
    pub(crate) fn check(&self, report: &'static str, drawable: bool) -> Result<Output<'_>, Failure> {
        self.check_all(report, report, drawable, &[])
    }

    /// Like [`Self::check`], with this name for table and picture in a folder instead of the report's name.
    pub(crate) fn check_named(
        &self,
        report: &'static str,
        name: &'static str,
    ) -> Result<Output<'_>, Failure> {
        self.check_all(report, name, true, &[])
    }

    /// Like [`Self::check`] for a command that writes files with some endings itself; [`Output::own`] returns
    /// the ending to write.
    pub(crate) fn check_with(
        &self,
        report: &'static str,
        drawable: bool,
        own: &[&'static str],
    ) -> Result<Output<'_>, Failure> {
        self.check_all(report, report, drawable, own)
    }

    fn check_all(
        &self,
        report: &'static str,
        name: &'static str,
        drawable: bool,
        own: &[&'static str],
    ) -> Result<Output<'_>, Failure> {
        self.print.check(report, &[])?;
        let file = match self.output() {
            Some(path) => Some((path, Kind::of(path, drawable, own)?)),
            None => None,
        };
        let figure = match &self.figure {
            Some(_) if !drawable => {
                return Err(Failure::with_help(NO_PICTURE.to_owned(), Some("leave --figure out".to_owned())));
            }
            Some(path) => match Kind::of(path, true, &[]) {
                Ok(kind) if kind.is_picture() => Some((path.as_path(), kind)),
                _ => {
                    let message = format!("cannot tell what to draw into {}", shown(path));
                    let help = "let its name end in .png or .svg".to_owned();
                    return Err(Failure::with_help(message, Some(help)));
                }
            },
            None => None,
        };
        check_apart(self.figure.as_deref(), self.output())?;
        for (path, kind) in file.iter().chain(&figure) {
            match kind {
                Kind::Folder => StudyFolder { path, name }.check(&Exec::new())?,
                _ => check_place(path, self.force)?,
            }
        }
        if self.force && file.is_none() && figure.is_none() {
            let help = "leave it out, or give -o".to_owned();
            return Err(Failure::with_help(NOTHING_TO_REPLACE.to_owned(), Some(help)));
        }
        Ok(Output { print: &self.print, force: self.force, file, figure, name, drawable })
    }

    /// Rejects requirements that no report of this kind can answer. `absent` are places that are null with
    /// the given options.
    pub(crate) fn check_requirements(&self, report: &str, absent: &[&str]) -> Result<(), Failure> {
        self.print.check(report, absent)
    }

    /// Whether a named file holds a picture.
    pub(crate) fn names_picture(&self) -> bool {
        let of = |path: &Path| Kind::of(path, true, &[]).is_ok_and(Kind::is_picture);
        self.figure.is_some() || self.output().is_some_and(of)
    }

    /// Rejects requirements on items that a list of the report does not have.
    pub(crate) fn check_items(&self, list: &str, names: &[&str]) -> Result<(), Failure> {
        self.print.check_each(|requirement| requirement.check_items(list, names))
    }

    /// The requirements on the report.
    pub(crate) fn requirements(&self) -> &[Requirement] {
        &self.print.require
    }
}

impl<'a> Output<'a> {
    /// The output of a command with its own options for printing and storage.
    pub(crate) fn of(
        print: &'a PrintArgs,
        path: Option<&'a Path>,
        force: bool,
        report: &'static str,
    ) -> Result<Self, Failure> {
        print.check(report, &[])?;
        let file = match path {
            Some(path) => Some((path, Kind::of(path, true, &[])?)),
            None => None,
        };
        match file {
            Some((path, Kind::Folder)) => StudyFolder { path, name: report }.check(&Exec::new())?,
            Some((path, _)) => check_place(path, force)?,
            None => {}
        }
        Ok(Self { print, force, file, figure: None, name: report, drawable: true })
    }

    /// Takes the folder, for a command that fills it itself.
    pub(crate) fn take_folder(&mut self) -> Option<&'a Path> {
        self.file.take_if(|(_, kind)| *kind == Kind::Folder).map(|(path, _)| path)
    }

    /// The ending of the file that the command writes itself, if any.
    pub(crate) fn own(&self) -> Option<&'static str> {
        match self.file {
            Some((_, Kind::Own(ending))) => Some(ending),
            _ => None,
        }
    }

    /// Writes the file of [`Self::own`].
    pub(crate) fn write_own(&self, bytes: &[u8]) -> Result<(), Failure> {
        self.file.map_or(Ok(()), |(path, _)| write_file(path, bytes, self.force))
    }

    /// The same output without pictures, for a report without a drawing.
    pub(crate) fn without_picture(self) -> Self {
        let kept = |place: &(&Path, Kind)| !place.1.is_picture();
        Self { file: self.file.filter(kept), figure: self.figure.filter(kept), drawable: false, ..self }
    }

    /// Writes the pictures alone.
    pub(crate) fn draw(&self, draw: impl Fn() -> Result<Picture, Failure>) -> Result<(), Failure> {
        for (path, kind) in self.file.iter().chain(&self.figure).filter(|(_, kind)| kind.is_picture()) {
            write_file(path, &image(&draw()?, kind.ending())?, self.force)?;
        }
        Ok(())
    }

    /// Whether a picture is to be written.
    pub(crate) fn wants_picture(&self) -> bool {
        let is_drawn = |(_, kind): (&Path, Kind)| kind.is_picture() || kind == Kind::Folder && self.drawable;
        self.figure.is_some() || self.file.is_some_and(is_drawn)
    }

    /// Writes and prints a report, and reports the requirements that it does not meet. `draw` makes its
    /// picture, if any.
    pub(crate) fn finish<B: Printed + Serialize>(
        self,
        report: &ReportEnvelope<B>,
        draw: impl FnOnce() -> Result<Picture, Failure>,
    ) -> Result<ExitStatus, Failure> {
        let pictures = || Ok(vec![(self.name, draw()?)]);
        let notes = self.write(report, pictures, |_| Ok(String::new()), &Exec::new())?;
        self.print(report, &notes)
    }

    /// Writes the files of a report, and reports the files written into a folder. `draw` makes its pictures:
    /// a file gets the first, a folder gets all. `more` adds files to the folder and returns their names.
    pub(crate) fn write<B: Printed + Serialize>(
        &self,
        report: &ReportEnvelope<B>,
        draw: impl FnOnce() -> Result<Pictures, Failure>,
        more: impl Fn(&Path) -> Result<String, SaveError>,
        exec: &Exec,
    ) -> Result<Vec<String>, Failure> {
        let pictures = if self.wants_picture() { draw()? } else { Pictures::new() };
        let document = report.described();
        let mut notes = Vec::new();
        for (path, kind) in self.file.iter().chain(&self.figure) {
            let bytes = match kind {
                Kind::Json | Kind::Markdown | Kind::Html | Kind::Text => rendered(*kind, report, &document)?,
                Kind::Csv => table(report)?,
                Kind::Own(_) => continue,
                Kind::Png | Kind::Svg => match pictures.first() {
                    Some((_, picture)) => image(picture, kind.ending())?,
                    None => return Err(no_picture()),
                },
                Kind::Folder => {
                    let folder = StudyFolder { path, name: self.name };
                    let files = if pictures.is_empty() { Files::new() } else { encode(&pictures, exec)? };
                    let mut added = String::new();
                    let note =
                        folder.write(&report.to_json()?, &report.records(), files, exec, |folder| {
                            added = more(folder)?;
                            Ok(())
                        })?;
                    notes.push(note + &added);
                    written(path);
                    continue;
                }
            };
            write_file(path, &bytes, self.force)?;
        }
        Ok(notes)
    }

    /// Prints a report with notes; reports the requirements that it does not meet.
    pub(crate) fn print<B: Printed + Serialize>(
        &self,
        report: &ReportEnvelope<B>,
        notes: &[String],
    ) -> Result<ExitStatus, Failure> {
        let status = self.print.print(report, &report.described());
        to_stderr(notes);
        status
    }
}

impl PrintArgs {
    /// Rejects requirements that no report of this kind can answer. `absent` are places that are null with
    /// the given options.
    fn check(&self, report: &str, absent: &[&str]) -> Result<(), Failure> {
        // The schema is a large text: read only for `--require`.
        if self.require.is_empty() {
            return Ok(());
        }
        let Some(schema) = json_schema::of_kind(report) else { return Ok(()) };
        self.check_each(|requirement| requirement.check(&schema, absent))
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

    /// Prints a report, and reports the requirements that it does not meet.
    pub(crate) fn print<B: Printed + Serialize>(
        &self,
        report: &ReportEnvelope<B>,
        document: &Described<'_>,
    ) -> Result<ExitStatus, Failure> {
        if self.json {
            to_stdout(&report.to_json()?)?;
        } else if self.csv {
            to_stdout(&String::from_utf8_lossy(&table(report)?))?;
        } else {
            to_stdout(&body(document, style(self.verbose)))?;
            warn(&document.warnings);
        }
        let verdicts = report.verdicts(&self.require)?;
        let unmet: Vec<String> =
            verdicts.iter().filter(|verdict| !verdict.met).map(ToString::to_string).collect();
        to_stderr(&unmet);
        Ok(if unmet.is_empty() { ExitStatus::Done } else { ExitStatus::RequirementNotMet })
    }
}

/// A whole report as one text.
pub(crate) fn rendered<B: Printed + Serialize>(
    kind: Kind,
    report: &ReportEnvelope<B>,
    document: &Described<'_>,
) -> Result<Vec<u8>, Failure> {
    Ok(match kind {
        Kind::Json => report.to_json()?,
        Kind::Markdown => markdown(document),
        Kind::Html => html(document),
        _ => text(document, Style::default()),
    }
    .into_bytes())
}

/// The table of a report for programs.
fn table<B: Printed>(report: &ReportEnvelope<B>) -> Result<Vec<u8>, Failure> {
    let records = report.records();
    if records.is_empty() {
        let help = "--json prints all of it".to_owned();
        return Err(Failure::with_help("this result has no table for programs".to_owned(), Some(help)));
    }
    Ok(csv(&records)?)
}

/// Draws the report of a problem.
pub(crate) type Draw<T> = fn(&ReportOf<T>, &Problem) -> Result<Picture, Failure>;

/// The common sequence of every study: computes a result of a design, prints and stores it.
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
    let results = compute(&problem, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    drop(running);
    let report = ReportOf::new(problem.design(), results, problem.warnings(), Some(timing));
    output.finish(&report, || match draw {
        Some(draw) => draw(&report, &problem),
        None => Err(no_picture()),
    })
}

const NOTHING_TO_REPLACE: &str = "--force replaces files, and none is to be written";

const NO_PICTURE: &str = "there is no picture of this result";

/// The error for a requested picture of a report without one, raised before the computation.
pub(crate) fn no_picture() -> Failure {
    Failure::with_help(NO_PICTURE.to_owned(), None)
}
