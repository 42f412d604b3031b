//! Where text goes: stdout, or a file that is there whole or not at all.

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
    /// Into this file, or to stdout.
    pub(crate) const fn new(output: Option<PathBuf>, force: bool) -> Self {
        Self { output, force }
    }

    /// The file, if there is one.
    fn file(&self) -> Option<&Path> {
        file(self.output.as_deref())
    }

    /// Whether stdout is named.
    pub(crate) fn names_stdout(&self) -> bool {
        self.output.as_deref().is_some_and(is_stream)
    }

    /// Refuses what cannot be written in the end, before anything is computed.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        self.file().map_or(Ok(()), |path| check_place(path, self.force))
    }

    /// Refuses what cannot be written where the command is interrupted.
    pub(crate) fn check_partial(&self) -> Result<(), Failure> {
        self.partial().map_or(Ok(()), |path| check_place(&path, self.force))
    }

    /// Writes what was finished of a text: not where it should go, which would look like the whole, but beside that. Where it went, if
    /// into a file.
    pub(crate) fn write_partial(&self, text: &str) -> Result<Option<PathBuf>, Failure> {
        let path = self.partial();
        match &path {
            Some(path) => write_file(path, text.as_bytes(), self.force)?,
            None => to_stdout(text)?,
        }
        Ok(path)
    }

    /// The file beside the one to write.
    fn partial(&self) -> Option<PathBuf> {
        let mut path = self.file()?.to_owned().into_os_string();
        path.push(".partial");
        Some(path.into())
    }

    /// Whether it is printed, so that parts of it can be told before the whole is there.
    pub(crate) fn is_printed(&self) -> bool {
        self.file().is_none()
    }

    /// Writes `text` where it should go.
    pub(crate) fn write(&self, text: &str) -> Result<(), Failure> {
        match self.file() {
            Some(path) => write_file(path, text.as_bytes(), self.force),
            None => to_stdout(text),
        }
    }
}

/// The file that `-o` names: `-` is stdout.
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

/// Options that name files to write.
const FILES: &str = "files";

impl FileArgs {
    /// Which of the `known` endings the file has, where one is asked for. Refuses what cannot be written in the
    /// end, before anything is computed.
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

    /// Writes a picture of this kind, if a file is asked for.
    pub(crate) fn draw(&self, kind: &str, picture: &Picture) -> Result<(), Failure> {
        self.write(&image(picture, kind)?)
    }

    /// Writes the file, if one is asked for.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        file(self.output.as_deref()).map_or(Ok(()), |path| write_file(path, bytes, self.force))
    }
}

/// Pixels per unit of a picture.
const PNG_SCALE: f32 = 2.0;

/// A picture as a file of this kind: png, else svg.
pub(crate) fn image(picture: &Picture, kind: &str) -> Result<Vec<u8>, Failure> {
    if kind == "png" { Ok(picture.png(PNG_SCALE)?) } else { Ok(picture.svg().as_bytes().to_vec()) }
}

/// Tries out whether a file can be written at `path`.
pub(crate) fn check_place(path: &Path, replace: bool) -> Result<(), Failure> {
    write::check_file(path, replace).map_err(refused)
}

/// Refuses two files of one command that are one and the same, whatever they are called: the second would replace the first, or fail when
/// everything is computed.
pub(crate) fn check_apart(first: Option<&Path>, second: Option<&Path>) -> Result<(), Failure> {
    let Some((first, second)) = first.zip(second) else { return Ok(()) };
    if place(first)? != place(second)? {
        return Ok(());
    }
    let message = format!("{} and {} are the same file", shown(first), shown(second));
    Err(Failure::with_help(message, Some("give two names".to_owned())))
}

/// Where a path leads, whatever way it takes.
fn place(path: &Path) -> Result<PathBuf, Failure> {
    let place = write::place(path)?;
    let parent = place.parent().filter(|parent| !parent.as_os_str().is_empty());
    // A folder that is not there is told where the file is looked at.
    let folder = parent.unwrap_or_else(|| Path::new(".")).canonicalize().unwrap_or_default();
    Ok(folder.join(place.file_name().unwrap_or_default()))
}

/// What cannot be written, with the option that helps.
fn refused(error: WriteError) -> Failure {
    match error {
        WriteError::Exists { .. } => {
            Failure::with_help(error.to_string(), Some("--force replaces it".to_owned()))
        }
        error => error.into(),
    }
}

/// What this process has completed.
static WRITTEN: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// A file or folder is complete, whatever happens from now on.
pub(crate) fn written(path: &Path) {
    kept(&shown(path).to_string());
}

/// Something is complete, whatever happens from now on.
pub(crate) fn kept(what: &str) {
    let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    if !written.iter().any(|known| known == what) {
        written.push(what.to_owned());
    }
}

/// What is there although the command did not come to its end.
pub(crate) fn what_was_written() -> String {
    let written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    if written.is_empty() {
        "nothing was written".to_owned()
    } else {
        escaped(&format!("complete before that: {}", written.join(", ")))
    }
}

/// How text is laid out on stdout: as wide as the terminal, or as `COLUMNS` says, else in 80 columns.
pub(crate) fn style(details: bool) -> Style {
    Style { colour: is_coloured(&io::stdout()), ..layout(details) }
}

/// Diagnostics as lines of stderr, for what no report holds.
pub(crate) fn lines(list: &[Diagnostic]) -> Vec<String> {
    let unwrapped = Style { columns: usize::MAX, ..Style::default() };
    document::diagnostics(list, unwrapped).iter().flat_map(|text| text.lines().map(str::to_owned)).collect()
}

/// The warnings of a report, on stderr.
pub(crate) fn warn(warnings: &[Diagnostic]) {
    let style = Style { colour: is_coloured(&io::stderr()), ..layout(true) };
    let mut stderr = io::stderr().lock();
    for warning in document::diagnostics(warnings, style) {
        // Nobody is left to tell when stderr itself is gone.
        let _ = stderr.write_all(warning.as_bytes());
    }
}

/// The width of a text, without colours.
fn layout(details: bool) -> Style {
    let stated = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let is_terminal = io::stdout().is_terminal();
    let width =
        || terminal_size::terminal_size().filter(|_| is_terminal).map(|(width, _)| usize::from(width.0));
    let default = Style::default();
    let columns = stated.or_else(width).unwrap_or(default.columns);
    Style { columns, details, ..default }
}

/// Prints data. A reader that went away (`| head`) ends the command quietly.
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

/// Prints data, and beside it what else a person should know.
pub(crate) fn tell(data: &str, notes: &[String]) -> Result<ExitStatus, Failure> {
    to_stdout(data)?;
    to_stderr(notes);
    Ok(ExitStatus::Done)
}

/// Tells the person something beside the data, a line each.
pub(crate) fn to_stderr(lines: &[String]) {
    let mut stderr = io::stderr().lock();
    for line in lines {
        // Nobody is left to tell when stderr itself is gone.
        let _ = writeln!(stderr, "{}", escaped(line));
    }
}

/// Writes a file, which is there whole or not at all.
pub(crate) fn write_file(path: &Path, bytes: &[u8], replace: bool) -> Result<(), Failure> {
    write::file(path, bytes, replace).map_err(refused)?;
    written(path);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_file_by_two_names_is_found() {
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
    fn a_file_is_replaced_only_when_asked_and_nothing_is_left_behind() {
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
