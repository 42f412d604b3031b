//! Being asked to end: by Ctrl-C, by the system, by a terminal that goes away.
//!
//! ```text
//!   SIGINT            130 ──┐
//!   SIGTERM, SIGHUP   143 ──┴─▶ first: cancel, whole or nothing · again: remove what is unfinished, end at once
//! ```
//!
//! A computation whose steps take long, and of which nothing is kept before its end, is left after half a second ([`may_leave`]).
//!
//! A signal that whoever started the program had it ignore (`nohup`, a script's background) stays ignored.

use crate::exit::ExitStatus;
use crate::output::what_was_written;
use catchment::report::write;
use std::io::{self, Write};
#[cfg(unix)]
use std::sync::LazyLock;
#[cfg(unix)]
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Nothing was received.
const NONE: u8 = 0;

static RECEIVED: AtomicU8 = AtomicU8::new(NONE);

/// The same where the system gave no thread to listen.
#[cfg(unix)]
static NOTED: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// How the command ends because of a signal, if there was one.
pub(crate) fn received() -> Option<ExitStatus> {
    let received = usize::from(RECEIVED.load(Ordering::Relaxed));
    #[cfg(unix)]
    let received = received.max(NOTED.load(Ordering::Relaxed));
    [ExitStatus::Interrupted, ExitStatus::Terminated]
        .into_iter()
        .find(|status| usize::from(status.code()) == received)
}

/// How long a computation that may be left has to stop by itself, and to end what it started.
const PATIENCE: Duration = Duration::from_millis(500);

/// Tidies the terminal before the process ends in the middle of a computation.
type Tidy = Box<dyn Fn() + Send>;

/// There while a computation may be left.
static MAY_LEAVE: Mutex<Option<Tidy>> = Mutex::new(None);

/// From now on the process may end in the middle of what it computes: nothing of it is kept before its end, and nothing is written.
pub(crate) fn may_leave(tidy: impl Fn() + Send + 'static) {
    *MAY_LEAVE.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(tidy));
}

/// From now on it may not: results are written. Where it is just ending, this does not return.
pub(crate) fn must_stay() {
    *MAY_LEAVE.lock().unwrap_or_else(PoisonError::into_inner) = None;
}

/// A signal came. Whoever sends two does not want to wait for the end of a step.
fn receive(status: ExitStatus, cancel: &AtomicBool) {
    cancel.store(true, Ordering::Relaxed);
    if RECEIVED.swap(status.code(), Ordering::Relaxed) != NONE {
        leave(status);
    }
    let may_leave = || MAY_LEAVE.lock().unwrap_or_else(PoisonError::into_inner);
    if may_leave().is_none() {
        return;
    }
    std::thread::sleep(PATIENCE);
    if let Some(tidy) = &*may_leave() {
        tidy();
        // Nobody is left to tell when stderr itself is gone.
        let _ = writeln!(io::stderr(), "interrupted; {}", what_was_written());
        leave(status);
    }
}

#[expect(clippy::exit, reason = "the computation does not listen, and the person insists")]
fn leave(status: ExitStatus) {
    write::abandon();
    std::process::exit(i32::from(status.code()));
}

/// From now on signals set `cancel`.
#[cfg(unix)]
pub(crate) fn listen(cancel: &Arc<AtomicBool>) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let ignored = ignored();
    let heard: Vec<i32> =
        [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0).collect();
    let status = |signal| if signal == SIGINT { ExitStatus::Interrupted } else { ExitStatus::Terminated };
    let mut signals = Signals::new(&heard)?;
    let flag = Arc::clone(cancel);
    let hear = move || {
        for signal in signals.forever() {
            receive(status(signal), &flag);
        }
    };
    match std::thread::Builder::new().name("signals".to_owned()).spawn(hear) {
        Ok(_) => Ok(()),
        Err(_) => heard.iter().try_for_each(|signal| note(*signal, status(*signal), cancel)),
    }
}

/// The same without a thread: the first signal sets `cancel`, a second one ends the process at once, and what is unfinished then
/// is removed by the next start.
#[cfg(unix)]
fn note(signal: i32, status: ExitStatus, cancel: &Arc<AtomicBool>) -> io::Result<()> {
    use signal_hook::flag;
    flag::register_conditional_shutdown(signal, status.code().into(), Arc::clone(cancel))?;
    flag::register_usize(signal, Arc::clone(&NOTED), status.code().into())?;
    flag::register(signal, Arc::clone(cancel)).map(drop)
}

/// A limit on the size of files (`ulimit -f`) makes a write fail, as a full disk does, and does not end the process.
#[cfg(unix)]
pub(crate) fn outlive_file_limits() {
    // If it is not available, the process ends, and the next one removes what it left.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// There are no such limits.
#[cfg(not(unix))]
pub(crate) fn outlive_file_limits() {}

/// The signals that are ignored from the start, the lowest bit for the first; none where the system does not say.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// From now on Ctrl-C sets `cancel`.
#[cfg(not(unix))]
pub(crate) fn listen(cancel: &Arc<AtomicBool>) -> io::Result<()> {
    let cancel = Arc::clone(cancel);
    ctrlc::set_handler(move || receive(ExitStatus::Interrupted, &cancel)).map_err(io::Error::other)
}
