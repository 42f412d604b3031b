//! Termination signals: Ctrl-C, termination by the system, a closed terminal.
//!
//! ```text
//!   SIGINT            130 ──┐
//!   SIGTERM, SIGHUP   143 ──┴─▶ first: cancel, whole or nothing · again: remove unfinished files, end at once
//! ```
//!
//! A computation with long steps that stores nothing before its end is abandoned after half a second
//! ([`may_leave`]).
//!
//! A signal that the parent process set to be ignored (`nohup`, a script's background) stays ignored.

use crate::exit::ExitStatus;
use crate::output::written_items;
use catchment::report::write;
use std::io::{self, Write};
#[cfg(unix)]
use std::sync::LazyLock;
#[cfg(unix)]
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// No signal received.
const NONE: u8 = 0;

static RECEIVED: AtomicU8 = AtomicU8::new(NONE);

/// The signal received, if the system provides no listener thread.
#[cfg(unix)]
static NOTED: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// The exit status of the received signal, if any.
pub(crate) fn received() -> Option<ExitStatus> {
    let received = usize::from(RECEIVED.load(Ordering::Relaxed));
    #[cfg(unix)]
    let received = received.max(NOTED.load(Ordering::Relaxed));
    [ExitStatus::Interrupted, ExitStatus::Terminated]
        .into_iter()
        .find(|status| usize::from(status.code()) == received)
}

/// Time for a computation that may be abandoned to stop by itself and to end what it started.
const PATIENCE: Duration = Duration::from_millis(500);

/// Restores the terminal before the process ends in the middle of a computation.
type Tidy = Box<dyn Fn() + Send>;

/// Set while a computation may be abandoned.
static MAY_LEAVE: Mutex<Option<Tidy>> = Mutex::new(None);

/// Allows the process to end in the middle of a computation that stores nothing before its end and writes
/// nothing.
pub(crate) fn may_leave(tidy: impl Fn() + Send + 'static) {
    *MAY_LEAVE.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(tidy));
}

/// Revokes [`may_leave`] before results are written. Does not return if the process is just ending.
pub(crate) fn must_stay() {
    *MAY_LEAVE.lock().unwrap_or_else(PoisonError::into_inner) = None;
}

/// Handles a signal. A second signal ends the process without waiting for the end of a step.
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
        // If stderr itself is closed, the message is lost.
        let _ = writeln!(io::stderr(), "interrupted; {}", written_items());
        leave(status);
    }
}

#[expect(clippy::exit, reason = "the computation does not listen, and the person insists")]
fn leave(status: ExitStatus) {
    write::abandon();
    std::process::exit(i32::from(status.code()));
}

/// Makes signals set `cancel` from now on.
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

/// Like [`listen`] without a thread: the first signal sets `cancel`, a second one ends the process at once,
/// and the next start removes the unfinished files.
#[cfg(unix)]
fn note(signal: i32, status: ExitStatus, cancel: &Arc<AtomicBool>) -> io::Result<()> {
    use signal_hook::flag;
    flag::register_conditional_shutdown(signal, status.code().into(), Arc::clone(cancel))?;
    flag::register_usize(signal, Arc::clone(&NOTED), status.code().into())?;
    flag::register(signal, Arc::clone(cancel)).map(drop)
}

/// Makes a limit on file sizes (`ulimit -f`) fail the write, like a full disk, instead of ending the process.
#[cfg(unix)]
pub(crate) fn outlive_file_limits() {
    // If the handler is not available, the process ends, and the next start removes the unfinished files.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// This system has no such limits.
#[cfg(not(unix))]
pub(crate) fn outlive_file_limits() {}

/// Bit mask of the signals ignored at the start, the lowest bit for signal 1; 0 if the system does not report
/// them.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Makes Ctrl-C set `cancel` from now on.
#[cfg(not(unix))]
pub(crate) fn listen(cancel: &Arc<AtomicBool>) -> io::Result<()> {
    let cancel = Arc::clone(cancel);
    ctrlc::set_handler(move || receive(ExitStatus::Interrupted, &cancel)).map_err(io::Error::other)
}
