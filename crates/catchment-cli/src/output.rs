//! Output of text: to stdout, or to a file that is written completely or not at all.

use crate::color::is_coloured;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::source::is_stream;
use catchment::diagnostic::Diagnostic;
use catchment::report::document::{self, Style};
use catchment::report::figure::Picture;
use catchment::report::write::{self, WriteError};
use catchment::terminal::{escaped, shown};
use clap::{ArgGroup, Args};
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Where a text goes.
#[derive(Debug, Args)]
pub(crate) struct OutputArgs {
    /// Write to this file instead of stdout; - is stdout
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = "output")]
    force: bool,
}

impl OutputArgs {
    /// Output to this file, or to stdout.
    pub(crate) const fn new(output: Option<PathBuf>, force: bool) -> Self {
        Self { output, force }
    }

    /// The file, if any.
    fn file(&self) -> Option<&Path> {
        file(self.output.as_deref())
    }

    /// Whether the option names stdout.
    pub(crate) fn names_stdout(&self) -> bool {
        self.output.as_deref().is_some_and(is_stream)
    }

    /// Rejects an unwritable output before the computation.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        self.file().map_or(Ok(()), |path| check_place(path, self.force))
    }

    /// Rejects an unwritable file for partial results of an interrupted command.
    pub(crate) fn check_partial(&self) -> Result<(), Failure> {
        self.partial().map_or(Ok(()), |path| check_place(&path, self.force))
    }

    /// Writes the finished part of a text: not to the requested file, which would then look complete, but to
    /// a file beside it. Returns the path of that file, if any.
    pub(crate) fn write_partial(&self, text: &str) -> Result<Option<PathBuf>, Failure> {
        let path = self.partial();
        match &path {
            Some(path) => write_file(path, text.as_bytes(), self.force)?,
            None => to_stdout(text)?,
        }
        Ok(path)
    }

    /// The file for partial results, beside the requested file.
    fn partial(&self) -> Option<PathBuf> {
        let mut path = self.file()?.to_owned().into_os_string();
        path.push(".partial");
        Some(path.into())
    }

    /// Whether the output goes to stdout, so that finished parts can be printed early.
    pub(crate) fn is_printed(&self) -> bool {
        self.file().is_none()
    }

    /// Writes `text` to the output.
    pub(crate) fn write(&self, text: &str) -> Result<(), Failure> {
        match self.file() {
            Some(path) => write_file(path, text.as_bytes(), self.force),
            None => to_stdout(text),
        }
    }
}

/// The file of `-o`; `None` for `-`, which is stdout.
pub(crate) fn file(output: Option<&Path>) -> Option<&Path> {
    output.filter(|path| !is_stream(path))
}

/// A file beside what is printed; the end of its name says what is in it.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new(FILES).multiple(true))]
pub(crate) struct FileArgs {
    /// Also draw a figure into this file (.svg, .png)
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, group = FILES)]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = FILES)]
    force: bool,
}

/// Heading of the options that name output files.
const FILES: &str = "files";

impl FileArgs {
    /// The ending of the requested file among the `known` ones. Rejects an unwritable file before the
    /// computation.
    pub(crate) fn kind(&self, known: &[&'static str]) -> Result<Option<&'static str>, Failure> {
        let Some(path) = file(self.output.as_deref()) else { return Ok(None) };
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("");
        let Some(kind) = known.iter().find(|k| k.eq_ignore_ascii_case(ending)) else {
            let help = format!("let its name end in .{}", known.join(", ."));
            return Err(Failure::with_help(
                format!("cannot tell what to write into {}", shown(path)),
                Some(help),
            ));
        };
        check_place(path, self.force)?;
        Ok(Some(kind))
    }

    /// Writes a picture of this kind, if a file is requested.
    pub(crate) fn draw(&self, kind: &str, picture: &Picture) -> Result<(), Failure> {
        self.write(&image(picture, kind)?)
    }

    /// Writes the file, if one is requested.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        file(self.output.as_deref()).map_or(Ok(()), |path| write_file(path, bytes, self.force))
    }
}

/// Pixels per unit of a picture.
const PNG_SCALE: f32 = 2.0;

/// Encodes a picture as png if `kind` is png, else as svg.
pub(crate) fn image(picture: &Picture, kind: &str) -> Result<Vec<u8>, Failure> {
    if kind == "png" { Ok(picture.png(PNG_SCALE)?) } else { Ok(picture.svg().as_bytes().to_vec()) }
}

/// Checks that a file can be written at `path`.
pub(crate) fn check_place(path: &Path, replace: bool) -> Result<(), Failure> {
    write::check_file(path, replace).map_err(refused)
}

/// Rejects two outputs of one command that are the same file under different names: the second would replace
/// the first, or fail after the computation.
pub(crate) fn check_apart(first: Option<&Path>, second: Option<&Path>) -> Result<(), Failure> {
    let Some((first, second)) = first.zip(second) else { return Ok(()) };
    if place(first)? != place(second)? {
        return Ok(());
    }
    let message = format!("{} and {} are the same file", shown(first), shown(second));
    Err(Failure::with_help(message, Some("give two names".to_owned())))
}

/// The real path, with links resolved.
fn place(path: &Path) -> Result<PathBuf, Failure> {
    let place = write::place(path)?;
    let parent = place.parent().filter(|parent| !parent.as_os_str().is_empty());
    // The check of the file itself reports a missing folder.
    let folder = parent.unwrap_or_else(|| Path::new(".")).canonicalize().unwrap_or_default();
    Ok(folder.join(place.file_name().unwrap_or_default()))
}

/// The error, with the option that resolves it.
fn refused(error: WriteError) -> Failure {
    match error {
        WriteError::Exists { .. } => {
            Failure::with_help(error.to_string(), Some("--force replaces it".to_owned()))
        }
        error => error.into(),
    }
}

/// The files and folders that this process has completed.
static WRITTEN: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Records a completed file or folder.
pub(crate) fn written(path: &Path) {
    kept(&shown(path).to_string());
}

/// Records a completed item.
pub(crate) fn kept(what: &str) {
    let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    if !written.iter().any(|known| known == what) {
        written.push(what.to_owned());
    }
}

/// The completed files and folders, for the message of a command that stopped early.
pub(crate) fn written_items() -> String {
    let written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    if written.is_empty() {
        "nothing was written".to_owned()
    } else {
        escaped(&format!("complete before that: {}", written.join(", ")))
    }
}

/// The text layout on stdout: the width of the terminal or of `COLUMNS`, else 80 columns.
pub(crate) fn style(details: bool) -> Style {
    Style { colour: is_coloured(&io::stdout()), ..layout(details) }
}

/// Diagnostics as lines for stderr, if no report contains them.
pub(crate) fn lines(list: &[Diagnostic]) -> Vec<String> {
    let unwrapped = Style { columns: usize::MAX, ..Style::default() };
    document::diagnostics(list, unwrapped).iter().flat_map(|text| text.lines().map(str::to_owned)).collect()
}

/// Prints the warnings of a report on stderr.
pub(crate) fn warn(warnings: &[Diagnostic]) {
    let style = Style { colour: is_coloured(&io::stderr()), ..layout(true) };
    let mut stderr = io::stderr().lock();
    for warning in document::diagnostics(warnings, style) {
        // If stderr itself is closed, the message is lost.
        let _ = stderr.write_all(warning.as_bytes());
    }
}

/// The text layout without colours.
fn layout(details: bool) -> Style {
    let default = Style::default();
    let columns = stated_columns().or_else(|| terminal_columns(&io::stdout())).unwrap_or(default.columns);
    Style { columns, details, ..default }
}

/// The width that `COLUMNS` states.
fn stated_columns() -> Option<usize> {
    std::env::var("COLUMNS").ok()?.parse().ok()
}

/// The width of a terminal.
fn terminal_columns(stream: &impl IsTerminal) -> Option<usize> {
    let (width, _) = terminal_size::terminal_size().filter(|_| stream.is_terminal())?;
    Some(usize::from(width.0))
}

/// Prints data. A closed pipe (`| head`) ends the command quietly.
pub(crate) fn to_stdout(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Failure::broken_pipe()),
        Err(error) => {
            let failure = Failure::with_help(format!("cannot write to stdout: {error}"), None);
            Err(failure.ends(ExitStatus::NotComputed))
        }
        Ok(()) => Ok(()),
    }
}

/// Prints data on stdout and notes on stderr.
pub(crate) fn print(data: &str, notes: &[String]) -> Result<ExitStatus, Failure> {
    to_stdout(data)?;
    to_stderr(notes);
    Ok(ExitStatus::Done)
}

/// Prints notes on stderr: one line each in a pipe, folded at the width of a terminal or of `COLUMNS`.
pub(crate) fn to_stderr(lines: &[String]) {
    let columns = stated_columns().or_else(|| terminal_columns(&io::stderr()));
    let mut stderr = io::stderr().lock();
    for line in lines {
        let line = escaped(line);
        // A command stays whole, so that it can be copied.
        let columns = columns.filter(|_| !line.starts_with("next: "));
        let text = columns.map_or(line.clone(), |columns| document::folded(&line, columns));
        // If stderr itself is closed, the message is lost.
        let _ = writeln!(stderr, "{text}");
    }
}

/// Writes a file completely or not at all.
pub(crate) fn write_file(path: &Path, bytes: &[u8], replace: bool) -> Result<(), Failure> {
    write::file(path, bytes, replace).map_err(refused)?;
    written(path);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_paths_to_one_file_are_detected() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        std::fs::create_dir(at("in")).unwrap();
        let apart = |a: &str, b: &str| check_apart(Some(&at(a)), Some(&at(b))).is_ok();
        assert!(apart("a.png", "b.png") && apart("a.png", "in/a.png") && apart("no/a.png", "a.png"));
        assert!(!apart("a.png", "./a.png") && !apart("a.png", "in/../a.png"));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("in", at("link")).unwrap();
            std::os::unix::fs::symlink("in/a.png", at("b.png")).unwrap();
            assert!(!apart("link/a.png", "in/a.png") && !apart("b.png", "in/a.png"));
        }
        assert!(check_apart(None, Some(&at("a.png"))).is_ok());
    }

    #[test]
    fn a_file_is_replaced_only_with_force_and_no_leftovers_stay() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("out");
        write_file(&path, b"one", false).unwrap();
        assert!(write_file(&path, b"two", false).is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"one");
        write_file(&path, b"three", true).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"three");
        assert!(write_file(&dir.path().join("no/folder"), b"", false).is_err());
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
