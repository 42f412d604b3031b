//! Being asked to end: by Ctrl-C, by the system, by a terminal that goes away.
//!
//! ```text
//!   SIGINT            130 ──┐
//!   SIGTERM, SIGHUP   143 ──┴─▶ first: cancel, whole or nothing · again, or after GRACE: remove what is unfinished, end at once
//! ```
//!
//! Most work looks after the cancel flag many times a second. A single step that does not (a hull in six dimensions) is not waited for.
//!
//! A signal that whoever started the program had it ignore (`nohup`, a script's background) stays ignored.

use crate::exit::ExitStatus;
use crate::output::to_stderr;
use catchment::report::write;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::time::Duration;

/// Nothing was received.
const NONE: u8 = 0;

static RECEIVED: AtomicU8 = AtomicU8::new(NONE);

/// How the command ends because of a signal, if there was one.
pub(crate) fn received() -> Option<ExitStatus> {
    [ExitStatus::Interrupted, ExitStatus::Terminated]
        .into_iter()
        .find(|status| status.code() == RECEIVED.load(Ordering::Relaxed))
}

/// As long as a step may take to its end after a signal.
const GRACE: Duration = Duration::from_secs(5);

/// A signal came. Whoever sends two does not want to wait for the end of a step.
fn receive(status: ExitStatus, cancel: &AtomicBool) {
    cancel.store(true, Ordering::Relaxed);
    if RECEIVED.swap(status.code(), Ordering::Relaxed) != NONE {
        leave(status);
    }
    // Where the system gives no thread for it, a second signal does the same.
    let _ = std::thread::Builder::new().name("grace".to_owned()).spawn(move || {
        std::thread::sleep(GRACE);
        to_stderr(&["interrupted; what was unfinished is removed".to_owned()]);
        leave(status);
    });
}

#[expect(clippy::exit, reason = "the computation does not listen, and the person insists")]
fn leave(status: ExitStatus) {
    write::abandon();
    std::process::exit(i32::from(status.code()));
}

/// From now on signals set `cancel`.
#[cfg(unix)]
pub(crate) fn listen(cancel: Arc<AtomicBool>) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let ignored = ignored();
    let heard: Vec<i32> =
        [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0).collect();
    let mut signals = Signals::new(heard)?;
    let hear = move || {
        for signal in signals.forever() {
            let status = if signal == SIGINT { ExitStatus::Interrupted } else { ExitStatus::Terminated };
            receive(status, &cancel);
        }
    };
    std::thread::Builder::new().name("signals".to_owned()).spawn(hear).map(drop)
}

/// A limit on the size of files (`ulimit -f`) makes a write fail, as a full disk does, and does not end the process.
#[cfg(unix)]
pub(crate) fn outlive_file_limits() {
    // Where it cannot be had, the process ends, and the next one removes what it left.
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
pub(crate) fn listen(cancel: Arc<AtomicBool>) -> io::Result<()> {
    ctrlc::set_handler(move || receive(ExitStatus::Interrupted, &cancel)).map_err(io::Error::other)
}
