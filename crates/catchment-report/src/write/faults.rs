//! Faults in the calls that change files, for tests: limited to a folder, so that tests do not interfere.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The fault at the chosen step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    /// The process dies: this and all later steps do nothing.
    Crash,
    /// The system refuses this single step.
    Fail,
}

struct Set {
    home: PathBuf,
    fault: Fault,
    /// Steps that are done before it.
    after: usize,
    reached: usize,
    exchange: bool,
    /// An item that another process creates there at the last moment.
    late: Option<PathBuf>,
}

static SETS: Mutex<Vec<Set>> = Mutex::new(Vec::new());

fn sets() -> MutexGuard<'static, Vec<Set>> {
    SETS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on something happens below `home` when `after` steps are done; without `exchange` the system cannot
/// exchange folders.
pub(crate) fn set(home: &Path, fault: Fault, after: usize, exchange: bool) {
    clear(home);
    sets().push(Set { home: home.to_owned(), fault, after, reached: 0, exchange, late: None });
}

/// Lets somebody put a file there after the last look before the exchange.
pub(crate) fn before_exchange(home: &Path, late: &Path) {
    if let Some(set) = sets().iter_mut().find(|set| set.home == home) {
        set.late = Some(late.to_owned());
    }
}

/// Nothing happens there any more. Returns whether something had happened.
pub(crate) fn clear(home: &Path) -> bool {
    let mut sets = sets();
    let happened = sets.iter().any(|set| set.home == home && set.reached > set.after);
    sets.retain(|set| set.home != home);
    happened
}

pub(super) fn reach(path: &Path) -> io::Result<()> {
    let mut sets = sets();
    let Some(set) = sets.iter_mut().find(|set| path.starts_with(&set.home)) else { return Ok(()) };
    let step = set.reached;
    set.reached += 1;
    let happens = match set.fault {
        Fault::Crash => step >= set.after,
        Fault::Fail => step == set.after,
    };
    if happens { Err(io::Error::other("a fault for a test")) } else { Ok(()) }
}

/// Whether the system cannot exchange folders here; checked right before it would.
pub(super) fn cannot_exchange(path: &Path) -> bool {
    let mut sets = sets();
    let Some(set) = sets.iter_mut().find(|set| path.starts_with(&set.home)) else { return false };
    if let Some(late) = set.late.take() {
        std::fs::write(late, "mine").unwrap();
    }
    !set.exchange
}
