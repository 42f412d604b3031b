//! The few calls that change files, behind a common gate; tests can inject a fault into any of them.
//!
//! ```text
//!   permit() ──▶ step, step, …      no step begins after abandon(); steps that have begun end first
//! ```
//!
//! [`abandon`] does not separate several steps under the same permit, such as an exchange and its follow-up.
//! A killed process can stop between any two steps; the next start repairs that.

use std::fs::{self, DirBuilder, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

/// Permissions of the owner of a temporary folder.
#[cfg(unix)]
const OWNER: u32 = 0o700;
/// Permission bits of all users, without the special bits.
#[cfg(unix)]
const EVERYBODY: u32 = 0o777;

/// How long [`abandon`] waits for steps that have begun: a disk that does not answer must not hold the process.
const PATIENCE: Duration = Duration::from_secs(10);

/// Active writers, and the items that would be left behind now.
struct Gate {
    busy: usize,
    shut: bool,
    unfinished: Vec<PathBuf>,
}

static GATE: Mutex<Gate> = Mutex::new(Gate { busy: 0, shut: false, unfinished: Vec::new() });
static CHANGED: Condvar = Condvar::new();

fn gate() -> MutexGuard<'static, Gate> {
    GATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends all writing of this process, for a process that must end at once: waits for steps that have begun,
/// removes unfinished items, and blocks all further writers, forever. Call it right before the end.
///
/// Existing and completed items are unchanged.
pub fn abandon() {
    let mut gate = gate();
    gate.shut = true;
    let (mut gate, waited) = CHANGED
        .wait_timeout_while(gate, PATIENCE, |gate| gate.busy > 0)
        .unwrap_or_else(PoisonError::into_inner);
    if waited.timed_out() {
        return; // the next start removes what is left
    }
    for path in std::mem::take(&mut gate.unfinished) {
        // The process ends; the next start removes the rest.
        let _ = remove(&path);
    }
}

/// Removes a file, or a folder with all that is in it, a descriptor at a time; not through the gate.
fn remove(path: &Path) -> io::Result<()> {
    if !fs::symlink_metadata(path)?.is_dir() {
        return fs::remove_file(path);
    }
    open_up(path);
    entries(path)?.iter().try_for_each(|entry| remove(entry))?;
    fs::remove_dir(path)
}

/// Content of a folder, which is not kept open.
pub(super) fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect()
}

/// Whether the system refuses another open file: nothing is then known about the item to be opened.
pub(super) fn is_exhausted(error: &io::Error) -> bool {
    #[cfg(any(target_os = "linux", target_vendor = "apple"))]
    {
        use rustix::io::Errno;
        let refused = [Errno::MFILE, Errno::NFILE].map(Errno::raw_os_error);
        error.raw_os_error().is_some_and(|code| refused.contains(&code))
    }
    #[cfg(not(any(target_os = "linux", target_vendor = "apple")))]
    {
        let _ = error;
        false
    }
}

/// The same if memory ran out: does not wait, and allocates practically no memory. A folder that is currently
/// being worked on is left to the next start, and so is everything while the list of items is being changed.
pub fn abandon_at_once() {
    let mut gate = match GATE.try_lock() {
        Ok(gate) => gate,
        Err(TryLockError::Poisoned(gate)) => gate.into_inner(),
        Err(TryLockError::WouldBlock) => return,
    };
    gate.shut = true;
    let idle = gate.busy == 0;
    for path in std::mem::take(&mut gate.unfinished) {
        // The process ends; the next start removes the rest.
        let _ = match fs::symlink_metadata(&path) {
            Ok(meta) if !meta.is_dir() => fs::remove_file(&path),
            Ok(_) if idle => fs::remove_dir_all(&path),
            _ => Ok(()),
        };
    }
}

/// Waits until files may be changed. Must not be called by a holder of a permit.
pub(crate) fn permit() -> Permit {
    let mut gate = CHANGED.wait_while(gate(), |gate| gate.shut).unwrap_or_else(PoisonError::into_inner);
    gate.busy += 1;
    Permit(())
}

/// Leave to change files, until it is dropped.
pub(crate) struct Permit(());

impl Drop for Permit {
    fn drop(&mut self) {
        gate().busy -= 1;
        CHANGED.notify_all();
    }
}

impl Permit {
    /// A change of an item at `path`.
    #[expect(clippy::unused_self, reason = "the permit is what allows it")]
    pub(crate) fn step<T, E: From<io::Error>>(
        &self,
        path: &Path,
        change: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        #[cfg(test)]
        super::faults::reach(path)?;
        #[cfg(not(test))]
        let _ = path;
        change()
    }

    /// From now on this is unfinished, or no longer.
    #[expect(clippy::unused_self, reason = "the permit is what allows it")]
    pub(super) fn unfinished(&self, path: &Path, is: bool) {
        let list = &mut gate().unfinished;
        list.retain(|known| known != path);
        if is {
            list.push(path.to_owned());
        }
    }

    /// Creates a folder: with `like`, at most as open as these permissions, and open to its owner.
    pub(super) fn create_dir(&self, path: &Path, like: Option<&Permissions>) -> io::Result<()> {
        let mut builder = DirBuilder::new();
        #[cfg(unix)]
        if let Some(like) = like {
            use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
            builder.mode(like.mode() & EVERYBODY | OWNER);
        }
        #[cfg(not(unix))]
        let _ = like;
        self.step(path, || builder.create(path))
    }

    /// Creates a file: with `like`, at most as open as these permissions.
    pub(super) fn create(&self, path: &Path, like: Option<&Permissions>) -> io::Result<File> {
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        if let Some(like) = like {
            use std::os::unix::fs::{OpenOptionsExt, PermissionsExt};
            options.mode(like.mode() & EVERYBODY);
        }
        #[cfg(not(unix))]
        let _ = like;
        self.step(path, || options.open(path))
    }

    pub(super) fn write(&self, path: &Path, file: &mut File, bytes: &[u8]) -> io::Result<()> {
        let written = self.step(path, || file.write_all(bytes));
        // A stop in the middle of a write leaves a part of the data.
        #[cfg(test)]
        if written.is_err() {
            file.write_all(&bytes[..bytes.len() / 2])?;
        }
        written
    }

    pub(super) fn sync(&self, path: &Path, file: &File) -> io::Result<()> {
        self.step(path, || file.sync_all())
    }

    pub(super) fn set_permissions(&self, path: &Path, permissions: Permissions) -> io::Result<()> {
        self.step(path, || fs::set_permissions(path, permissions))
    }

    pub(super) fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.step(to, || fs::rename(from, to))
    }

    /// Renames, unless the target exists. If the system cannot do both in one step, it checks first.
    pub(super) fn rename_to_new(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.step(to, || match renamed(from, to, Manner::NoReplace) {
            Some(done) => done,
            None if fs::symlink_metadata(to).is_ok() => Err(ErrorKind::AlreadyExists.into()),
            None => fs::rename(from, to),
        })
    }

    /// Exchanges two folders in one step; `None` if the system cannot.
    pub(super) fn exchange(&self, a: &Path, b: &Path) -> io::Result<Option<()>> {
        #[cfg(test)]
        if super::faults::cannot_exchange(b) {
            return Ok(None);
        }
        self.step(b, || renamed(a, b, Manner::Exchange).transpose())
    }

    pub(super) fn remove_file(&self, path: &Path) -> io::Result<()> {
        self.step(path, || gone(fs::remove_file(path)))
    }

    pub(super) fn remove_dir(&self, path: &Path) -> io::Result<()> {
        self.step(path, || gone(fs::remove_dir(path)))
    }

    /// Removes a file, or a folder with all that is in it.
    pub(super) fn remove_tree(&self, path: &Path) -> io::Result<()> {
        if !fs::symlink_metadata(path)?.is_dir() {
            return self.remove_file(path);
        }
        open_up(path);
        // Listed first: a folder kept open at every depth is more than some processes may have.
        entries(path)?.iter().try_for_each(|entry| self.remove_tree(entry))?;
        self.remove_dir(path)
    }
}

/// Treats an item that another process has already removed as removed.
fn gone(result: io::Result<()>) -> io::Result<()> {
    result.or_else(|error| if error.kind() == ErrorKind::NotFound { Ok(()) } else { Err(error) })
}

/// Lets the owner remove the content of a folder, which may have the permissions of a read-only folder.
pub(super) fn open_up(folder: &Path) {
    #[cfg(unix)]
    if let Ok(meta) = fs::symlink_metadata(folder) {
        use std::os::unix::fs::PermissionsExt;
        let mode = meta.permissions().mode();
        if mode & OWNER != OWNER {
            // If this fails, the later removal reports the reason.
            let _ = fs::set_permissions(folder, Permissions::from_mode(mode | OWNER));
        }
    }
    #[cfg(not(unix))]
    let _ = folder;
}

/// Whether the path is a mount point. False if the system does not report it.
#[cfg(target_os = "linux")]
pub(super) fn is_mount_point(path: &Path) -> bool {
    use rustix::fs::{AtFlags, CWD, StatxAttributes, StatxFlags, statx};
    statx(CWD, path, AtFlags::empty(), StatxFlags::empty())
        .is_ok_and(|results| results.stx_attributes.contains(StatxAttributes::MOUNT_ROOT))
}

#[cfg(not(target_os = "linux"))]
pub(super) fn is_mount_point(_: &Path) -> bool {
    false
}

/// How to rename.
#[derive(Clone, Copy)]
enum Manner {
    NoReplace,
    Exchange,
}

/// Renames in a manner that is not available on every system; `None` if it is not.
#[cfg(any(target_os = "linux", target_vendor = "apple"))]
fn renamed(from: &Path, to: &Path, manner: Manner) -> Option<io::Result<()>> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;
    let flags = match manner {
        Manner::NoReplace => RenameFlags::NOREPLACE,
        Manner::Exchange => RenameFlags::EXCHANGE,
    };
    match renameat_with(CWD, from, CWD, to, flags) {
        Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP) => None,
        result => Some(result.map_err(io::Error::from)),
    }
}

#[cfg(not(any(target_os = "linux", target_vendor = "apple")))]
fn renamed(_: &Path, _: &Path, _: Manner) -> Option<io::Result<()>> {
    None
}
