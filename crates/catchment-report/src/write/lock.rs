//! The lock that excludes other processes while a folder is inspected and exchanged.
//!
//! ```text
//!   claim ──try──▶ free: ours until it is dropped
//!           taken ─┬─ by a parent of this process        ──▶ refused at once: each would wait for the other
//!                  ├─ a stop is requested                ──▶ cancelled
//!                  └─ tried again until patience is over  ──▶ refused, with the number of the process that holds it
//! ```
//!
//! It is the system's advisory lock of a whole file (`flock`). Only Linux reports the holder of such a lock,
//! in `/proc/locks`.
//!
//! *Not promised:* that the holder is named if the file system numbers its devices differently from `stat`
//! (btrfs, some overlays), or if it runs on another machine.

use super::WriteError;
use catchment_core::exec::{Exec, Stopwatch};
use catchment_core::terminal::escaped;
use std::fmt;
use std::fs::{self, File, TryLockError};
use std::path::Path;
use std::time::Duration;

/// How long a lock is waited for before anything is computed.
pub(super) const BEFORE: Duration = Duration::from_secs(5);
/// The same if a result would be lost.
pub(super) const AFTER: Duration = Duration::from_mins(1);
/// Between two tries.
const PAUSE: Duration = Duration::from_millis(20);

/// The process that holds a lock, as reported by the system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Holder {
    /// A process.
    Process {
        /// Its number.
        id: u32,
        /// Its name; empty if it cannot be read.
        name: String,
    },
    /// Unknown to the system.
    Unknown,
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Process { id, name } if name.is_empty() => write!(f, "process {id}"),
            Self::Process { id, name } => write!(f, "process {id} ({})", escaped(name)),
            Self::Unknown => f.write_str("another process"),
        }
    }
}

impl Holder {
    /// Advice.
    pub(super) fn remedy(&self) -> String {
        match self {
            Self::Process { id, .. } => {
                format!("wait until it ends, end it (kill {id}), or choose another folder")
            }
            Self::Unknown => "wait until it ends (lslocks names it), or choose another folder".to_owned(),
        }
    }
}

/// A lock that another holds.
struct HeldLock {
    by: Holder,
    /// The holder started this process, or this process was started with the lock: it is not released before this process ends.
    above: bool,
}

/// Takes the lock of the folder at `place`, which is held until the file is dropped; `None` if there is no
/// folder, or if the system has no locks.
///
/// # Errors
/// Another process holds it for longer than `patience`, or a stop was requested.
pub(super) fn claim(place: &Path, patience: Duration, exec: &Exec) -> Result<Option<File>, WriteError> {
    let since = Stopwatch::start();
    let mut first = true;
    loop {
        // Nothing else, such as a pipe, is opened.
        if !fs::symlink_metadata(place).is_ok_and(|meta| meta.is_dir()) {
            return Ok(None);
        }
        let Ok(folder) = File::open(place) else { return Ok(None) };
        match folder.try_lock() {
            Ok(()) if is_at(&folder, place) => return Ok(Some(folder)),
            // Another folder has taken its place.
            Ok(()) => continue,
            Err(TryLockError::Error(_)) => return Ok(None),
            Err(TryLockError::WouldBlock) => {}
        }
        exec.check()?;
        let (path, waited) = (place.to_owned(), since.elapsed());
        let over = waited >= patience;
        // Also at the first attempt: a lock that a parent process holds, or that is inherited, is not
        // released while this process waits.
        if over || std::mem::take(&mut first) {
            let HeldLock { by, above } = held(&folder);
            if above {
                return Err(WriteError::LockedAbove { path, by });
            }
            if over {
                return Err(WriteError::Locked { path, by, seconds: waited.as_secs() });
            }
        }
        exec.report(waited.as_secs_f64() / patience.as_secs_f64(), "waiting for lock");
        std::thread::sleep(PAUSE);
    }
}

/// Whether an opened file or folder is still the item at `path`.
pub(super) fn is_at(file: &File, path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let same = |a: fs::Metadata, b: fs::Metadata| a.dev() == b.dev() && a.ino() == b.ino();
        fs::symlink_metadata(path).is_ok_and(|there| file.metadata().is_ok_and(|here| same(here, there)))
    }
    #[cfg(not(unix))]
    {
        let _ = file;
        fs::symlink_metadata(path).is_ok()
    }
}

/// Who holds the lock of a file.
#[cfg(target_os = "linux")]
fn held(file: &File) -> HeldLock {
    use rustix::fs::{major, minor};
    use std::os::unix::fs::MetadataExt;
    let unknown = HeldLock { by: Holder::Unknown, above: false };
    let Ok(meta) = file.metadata() else { return unknown };
    let inode = format!("{:02x}:{:02x}:{}", major(meta.dev()), minor(meta.dev()), meta.ino());
    // As this /proc numbers processes, which may be seen from another name space.
    let Some(own) = fs::read_link("/proc/self").ok().and_then(|me| me.to_str()?.parse().ok()) else {
        return unknown;
    };
    let mut descriptors = fs::read_dir("/proc/self/fdinfo").into_iter().flatten().filter_map(Result::ok);
    let handed_down = descriptors.any(|entry| {
        let text = fs::read_to_string(entry.path()).unwrap_or_default();
        holder_in(&text, &inode).is_some_and(|id| id != own)
    });
    let locks = fs::read_to_string("/proc/locks").unwrap_or_default();
    let Some(id) = holder_in(&locks, &inode).filter(|id| *id != 0) else {
        return HeldLock { above: handed_down, ..unknown };
    };
    let name = fs::read_to_string(format!("/proc/{id}/comm")).unwrap_or_default();
    let above = handed_down || std::iter::successors(Some(own), |id| parent(*id)).skip(1).any(|up| up == id);
    HeldLock { by: Holder::Process { id, name: name.trim_end().to_owned() }, above }
}

#[cfg(not(target_os = "linux"))]
fn held(_: &File) -> HeldLock {
    HeldLock { by: Holder::Unknown, above: false }
}

/// The process that holds the `flock` lock of an inode, such as `08:01:42`, from lines of `/proc/locks`:
/// `1: FLOCK  ADVISORY  WRITE 4711 08:01:42 0 EOF`. 0 stands for a process that is not visible from here.
#[cfg(target_os = "linux")]
fn holder_in(locks: &str, inode: &str) -> Option<u32> {
    // `->` stands before those who wait.
    let held = |line: &&str| !line.contains("->") && line.contains("FLOCK");
    locks.lines().filter(held).find_map(|line| {
        let mut words = line.split_whitespace().skip_while(|word| *word != "FLOCK").skip(3);
        let (id, place) = (words.next()?, words.next()?);
        (place == inode).then(|| id.parse().unwrap_or(0))
    })
}

/// The parent of a process; `None` for the first process.
#[cfg(target_os = "linux")]
fn parent(id: u32) -> Option<u32> {
    let status = fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let parent = status.lines().find_map(|line| line.strip_prefix("PPid:"))?.trim().parse().ok();
    parent.filter(|id| *id != 0)
}

#[cfg(test)]
mod tests {
    use super::super::tests::home;
    use super::*;
    use std::sync::atomic::Ordering;

    /// Locked by another descriptor of this process, which counts as another.
    fn locked() -> (tempfile::TempDir, File) {
        let home = home();
        let lock = File::open(home.path()).unwrap();
        lock.try_lock().unwrap();
        (home, lock)
    }

    #[test]
    fn a_lock_is_refused_after_the_timeout() {
        let (home, lock) = locked();
        let refused = claim(home.path(), Duration::ZERO, &Exec::new()).unwrap_err();
        let WriteError::Locked { by, seconds, .. } = &refused else { panic!("{refused}") };
        assert_eq!(*seconds, 0);
        if cfg!(target_os = "linux") {
            let Holder::Process { id, .. } = by else { panic!("{refused}") };
            assert_eq!(*id, std::process::id());
            assert!(refused.to_string().contains(&format!("(kill {id})")), "{refused}");
        }
        drop(lock);
        assert!(claim(home.path(), Duration::ZERO, &Exec::new()).unwrap().is_some());
    }

    #[test]
    fn a_stop_ends_the_wait() {
        let (home, _lock) = locked();
        let exec = Exec::new();
        exec.cancel_flag().store(true, Ordering::Relaxed);
        assert!(matches!(claim(home.path(), AFTER, &exec), Err(WriteError::Cancelled(_))));
    }

    #[test]
    fn a_missing_folder_has_no_lock() {
        let home = home();
        assert!(claim(&home.path().join("none"), AFTER, &Exec::new()).unwrap().is_none());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_holder_is_read_from_the_lists_of_the_system() {
        let locks = "1: POSIX  ADVISORY  WRITE 1 08:01:42 0 EOF\n\
                     2: -> FLOCK  ADVISORY  WRITE 2 08:01:42 0 EOF\n\
                     3: FLOCK  ADVISORY  READ  3 08:01:42 0 EOF\n\
                     4: FLOCK  ADVISORY  WRITE 4 08:01:43 0 EOF\n";
        assert_eq!([holder_in(locks, "08:01:42"), holder_in(locks, "08:01:44")], [Some(3), None]);
        let descriptor = "pos:\t0\nflags:\t02\nlock:\t1: FLOCK  ADVISORY  WRITE 7 00:2b:9 0 EOF\n";
        assert_eq!(holder_in(descriptor, "00:2b:9"), Some(7));
        assert_eq!(parent(std::process::id()), Some(std::os::unix::process::parent_id()));
    }

    #[test]
    fn control_characters_in_the_name_of_a_holder_are_escaped() {
        let by = Holder::Process { id: 7, name: "a\nb\u{1b}[2J".to_owned() };
        assert_eq!(by.to_string(), "process 7 (a\\nb\\u{1b}[2J)");
        assert_eq!(Holder::Unknown.to_string(), "another process");
    }
}
