//! Where text goes: stdout, or a file that is there whole or not at all.

use crate::exit::ExitStatus;
use crate::failure::Failure;
use clap::Args;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Where a text goes.
#[derive(Debug, Args)]
pub(crate) struct OutputArgs {
    /// Write to this file instead of stdout
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = "output")]
    force: bool,
}

impl OutputArgs {
    /// Refuses what cannot be written in the end, before anything is computed.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        self.output.as_deref().map_or(Ok(()), |path| check_place(path, self.force))
    }

    /// Writes `text` where it should go.
    pub(crate) fn write(&self, text: &str) -> Result<(), Failure> {
        match &self.output {
            Some(path) => write_file(path, text.as_bytes(), self.force),
            None => to_stdout(text),
        }
    }
}

/// A file beside what is printed; the end of its name says what is in it.
#[derive(Debug, Args)]
pub(crate) struct FileArgs {
    /// Also write this file; the end of its name (such as .svg) says what is in it
    #[arg(short, long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = "output")]
    force: bool,
}

impl FileArgs {
    /// Which of the `known` endings the file has, where one is asked for. Refuses what cannot be written in the
    /// end, before anything is computed.
    pub(crate) fn kind(&self, known: &[&'static str]) -> Result<Option<&'static str>, Failure> {
        let Some(path) = &self.output else { return Ok(None) };
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("");
        let Some(kind) = known.iter().find(|k| k.eq_ignore_ascii_case(ending)) else {
            let help = format!("let its name end in .{}", known.join(", ."));
            return Err(Failure::with_help(
                format!("cannot tell what to write into {}", path.display()),
                Some(help),
            ));
        };
        check_place(path, self.force)?;
        Ok(Some(kind))
    }

    /// Writes the file, if one is asked for.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        self.output.as_deref().map_or(Ok(()), |path| write_file(path, bytes, self.force))
    }
}

/// Whether a file can be written at `path`, as far as can be seen beforehand.
fn check_place(path: &Path, replace: bool) -> Result<(), Failure> {
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (reason, help) = if path.is_dir() {
        ("it is a folder", None)
    } else if !replace && path.symlink_metadata().is_ok() {
        ("it exists", Some("--force replaces it".to_owned()))
    } else if !folder.is_dir() {
        ("its folder does not exist", Some("create it first".to_owned()))
    } else {
        return Ok(());
    };
    Err(Failure::with_help(format!("cannot write {}: {reason}", path.display()), help))
}

/// Prints data. A reader that went away (`| head`) ends the command quietly.
pub(crate) fn to_stdout(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Failure::broken_pipe()),
        Err(error) => Err(Failure::with_help(format!("cannot write to stdout: {error}"), None)),
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
        let _ = writeln!(stderr, "{line}");
    }
}

/// A number with all its digits, as tables for programs have it.
pub(crate) fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), ToOwned::to_owned)
}

/// Writes a file under a temporary name beside its place and moves it there when it is complete.
fn write_file(path: &Path, bytes: &[u8], replace: bool) -> Result<(), Failure> {
    let failed = |error: &io::Error| {
        let help = (error.kind() == io::ErrorKind::AlreadyExists).then(|| "--force replaces it".to_owned());
        Failure::with_help(format!("cannot write {}: {error}", path.display()), help)
    };
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".catchment-");
    // Temporary files are private by default; this one becomes an ordinary file, subject to the umask.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(|error| failed(&error))?;
    file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(|error| failed(&error))?;
    let placed = if replace { file.persist(path) } else { file.persist_noclobber(path) };
    placed.map(drop).map_err(|error| failed(&error.error))
}

#[cfg(test)]
mod tests {
    use super::*;

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
