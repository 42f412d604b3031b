//! Starts the only child process: an interpreter that reads its input, writes its result, and is ended once
//! its result is no longer needed.
//!
//! It starts in its own empty folder, and relative entries of `PYTHONPATH` are removed: files beside a design
//! or a part are never run.

use super::StepProblem;
use catchment_base::exec::{Exec, Stopwatch};
use std::ffi::OsString;
use std::fs::DirBuilder;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf, absolute};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Names the interpreter.
pub(super) const VARIABLE: &str = "CATCHMENT_PYTHON";
/// The default interpreter, if the variable is not set.
const USUAL: &str = if cfg!(windows) { "python" } else { "python3" };
/// Interval of checks for cancellation.
const LOOK: Duration = Duration::from_millis(20);
/// Last words that are kept.
const MOST_WORDS: u64 = 64 << 10;
/// Characters of them that a message shows.
const SHOWN: usize = 200;

/// The interpreter.
pub(super) fn interpreter() -> OsString {
    std::env::var_os(VARIABLE).filter(|name| !name.is_empty()).unwrap_or_else(|| USUAL.into())
}

/// A program to run.
pub(super) struct Job<'a> {
    pub(super) program: OsString,
    pub(super) arguments: &'a [String],
    /// Bytes of an answer that are read.
    pub(super) most_reply: u64,
    pub(super) most_time: Duration,
}

/// Folders that a Python searches for packages.
const SEARCHED: &str = "PYTHONPATH";
/// Names of folders that are tried: those of processes that were killed may be there.
const TRIES: usize = 1000;
/// Folders that this process has made.
static FOLDERS: AtomicU64 = AtomicU64::new(0);

/// An empty folder that only this user may enter, and that goes when it is no longer needed.
struct PrivateFolder(PathBuf);

impl PrivateFolder {
    fn make() -> io::Result<Self> {
        let home = absolute(std::env::temp_dir())?;
        let mut builder = DirBuilder::new();
        #[cfg(unix)]
        std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
        let mut last = io::Error::from(io::ErrorKind::AlreadyExists);
        for _ in 0..TRIES {
            let number = FOLDERS.fetch_add(1, Ordering::Relaxed);
            let folder = home.join(format!("catchment-{}-{number}", std::process::id()));
            match builder.create(&folder) {
                Ok(()) => return Ok(Self(folder)),
                // Never a folder that is there already: it may hold anything.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => last = error,
                Err(error) => return Err(error),
            }
        }
        Err(last)
    }
}

impl Drop for PrivateFolder {
    fn drop(&mut self) {
        // A failure to remove files of the child is harmless.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The absolute entries of a search path; `None` if there are none.
fn absolute_entries(paths: Option<OsString>) -> Option<OsString> {
    let paths = paths?;
    let kept = std::env::split_paths(&paths).filter(|path| path.is_absolute());
    std::env::join_paths(kept).ok().filter(|kept| !kept.is_empty())
}

/// A child process that ends with its owner.
struct OwnedChild(Child);

impl Drop for OwnedChild {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs a program on `input`, and returns its output on stdout.
pub(super) fn run(
    job: Job<'_>,
    input: Vec<u8>,
    watch: &Stopwatch,
    exec: &Exec,
) -> Result<Vec<u8>, StepProblem> {
    let Job { program, arguments, most_reply, most_time } = job;
    let name = program.to_string_lossy().into_owned();
    let failed =
        |error: io::Error| StepProblem::NoPython { program: name.clone(), message: error.to_string() };
    let nowhere = PrivateFolder::make().map_err(failed)?;
    // A path is relative to the current folder; a bare name is looked up in the search path.
    let is_path = Path::new(&program).components().count() > 1;
    let program = if is_path { absolute(&program).map_err(failed)?.into_os_string() } else { program };
    let mut command = Command::new(&program);
    match absolute_entries(std::env::var_os(SEARCHED)) {
        Some(paths) => command.env(SEARCHED, paths),
        None => command.env_remove(SEARCHED),
    };
    command.current_dir(&nowhere.0);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = OwnedChild(command.spawn().map_err(failed)?);
    if let Some(mut stdin) = child.0.stdin.take() {
        // If the child stops reading early, its reply contains the reason.
        thread::Builder::new().spawn(move || drop(stdin.write_all(&input))).map_err(failed)?;
    }
    let answer = listen(child.0.stdout.take(), most_reply).map_err(failed)?;
    let words = listen(child.0.stderr.take(), MOST_WORDS).map_err(failed)?;
    // A terminated child may leave processes that hold its pipes open; `wait` does not block on them.
    let wait = |from: &Receiver<Vec<u8>>| loop {
        match from.recv_timeout(LOOK) {
            Ok(bytes) => return Ok(bytes),
            Err(RecvTimeoutError::Disconnected) => return Ok(Vec::new()),
            Err(RecvTimeoutError::Timeout) if exec.is_cancelled() => return Err(StepProblem::Cancelled),
            Err(RecvTimeoutError::Timeout) if watch.elapsed() > most_time => {
                return Err(StepProblem::TooLong { seconds: most_time.as_secs() });
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
    };
    let answer = wait(&answer)?;
    if !answer.is_empty() {
        return Ok(answer);
    }
    let words = wait(&words)?;
    let status = child.0.wait().map_err(failed)?;
    let words = String::from_utf8_lossy(&words);
    let last = words.lines().map(str::trim).rfind(|line| !line.is_empty()).unwrap_or("it printed nothing");
    let last: String = last.chars().filter(|c| !c.is_control()).take(SHOWN).collect();
    Err(StepProblem::Died { program: name, message: format!("it ended with {status}; {last}") })
}

/// Everything that comes, up to a limit, once it has ended.
fn listen(from: Option<impl Read + Send + 'static>, most: u64) -> io::Result<Receiver<Vec<u8>>> {
    let (to, received) = channel();
    if let Some(mut from) = from {
        thread::Builder::new().spawn(move || {
            let mut bytes = Vec::new();
            // After a read error, the bytes received so far are used.
            let _ = (&mut from).take(most).read_to_end(&mut bytes);
            // The receiver may have given up already.
            let _ = to.send(bytes);
            // Drain further output, so that the child does not block.
            let _ = io::copy(&mut from, &mut io::sink());
        })?;
    }
    Ok(received)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn entries_that_depend_on_the_folder_are_left_out() {
        let kept = |paths: &str| absolute_entries(Some(paths.into())).map(|kept| kept.into_string().unwrap());
        assert_eq!(kept("/a:b:/c").as_deref(), Some("/a:/c"));
        assert_eq!(kept("/opt/mine:").as_deref(), Some("/opt/mine"));
        assert_eq!((kept(""), kept(":"), kept(".:./x:../y")), (None, None, None));
        assert_eq!(absolute_entries(None), None);
    }

    #[test]
    fn a_child_starts_in_a_folder_of_its_own_which_goes() {
        let arguments = ["-c".to_owned(), "pwd; ls -A; ls -ld . | cut -c 1-10".to_owned()];
        let most_time = Duration::from_mins(1);
        let job = Job { program: "sh".into(), arguments: &arguments, most_reply: 1 << 10, most_time };
        let answer = run(job, Vec::new(), &Stopwatch::start(), &Exec::new()).unwrap();
        let answer = String::from_utf8(answer).unwrap();
        let lines: Vec<&str> = answer.lines().collect();
        assert!(lines.len() == 2 && lines[0].contains("catchment-") && lines[1] == "drwx------", "{answer}");
        assert!(!Path::new(lines[0]).exists());
    }
}
