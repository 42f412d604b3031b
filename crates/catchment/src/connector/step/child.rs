//! The one place where a process is started: an interpreter that reads its input, writes its answer, and is ended when nobody waits any more.

use super::StepProblem;
use crate::exec::{Exec, Stopwatch};
use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Names the interpreter.
pub(super) const VARIABLE: &str = "CATCHMENT_PYTHON";
/// The interpreter where the variable names none.
const USUAL: &str = if cfg!(windows) { "python" } else { "python3" };
/// How often it is asked whether anybody still waits.
const LOOK: Duration = Duration::from_millis(20);
/// Last words that are kept.
const MOST_WORDS: u64 = 64 << 10;
/// Characters of them that a message shows.
const SHOWN: usize = 200;

/// The interpreter.
pub(super) fn interpreter() -> OsString {
    std::env::var_os(VARIABLE).filter(|name| !name.is_empty()).unwrap_or_else(|| USUAL.into())
}

/// What is started.
pub(super) struct Job<'a> {
    pub(super) program: OsString,
    pub(super) arguments: &'a [String],
    /// Bytes of an answer that are read.
    pub(super) most_reply: u64,
    pub(super) most_time: Duration,
}

/// A child that does not outlive whoever waits for it.
struct Started(Child);

impl Drop for Started {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs a program on `input`, and gives what it wrote to stdout.
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
    let mut command = Command::new(&program);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = Started(command.spawn().map_err(failed)?);
    if let Some(mut stdin) = child.0.stdin.take() {
        // Who does not read it to its end says why in the answer.
        thread::Builder::new().spawn(move || drop(stdin.write_all(&input))).map_err(failed)?;
    }
    let answer = listen(child.0.stdout.take(), most_reply).map_err(failed)?;
    let words = listen(child.0.stderr.take(), MOST_WORDS).map_err(failed)?;
    // Whoever is ended may leave others that hold its pipes: nobody waits for these.
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
    let last = words.lines().map(str::trim).rfind(|line| !line.is_empty()).unwrap_or("it said nothing");
    let last: String = last.chars().filter(|c| !c.is_control()).take(SHOWN).collect();
    Err(StepProblem::Died { program: name, message: format!("it ended with {status}; {last}") })
}

/// Everything that comes, up to a limit, once it has ended.
fn listen(from: Option<impl Read + Send + 'static>, most: u64) -> io::Result<Receiver<Vec<u8>>> {
    let (to, received) = channel();
    if let Some(mut from) = from {
        thread::Builder::new().spawn(move || {
            let mut bytes = Vec::new();
            // What came before an error is what there is.
            let _ = (&mut from).take(most).read_to_end(&mut bytes);
            // Nobody may wait any more.
            let _ = to.send(bytes);
            // Who writes more than that is not held up.
            let _ = io::copy(&mut from, &mut io::sink());
        })?;
    }
    Ok(received)
}
