//! Temporary files and folders beside their final place, and the remains of killed processes.
//!
//! ```text
//!   .NAME.PID.MARK.tmp   new, not complete; after an exchange: old, to be removed
//!   .NAME.PID.MARK.old   old, moved aside if the system cannot exchange
//! ```
//!
//! MARK is a digest of the text before it, which cannot occur by chance: a name with a valid mark is ours,
//! whatever its content. A similar name without it belongs to others, unless it holds a manifest, or nothing
//! at all.
//!
//! A writer holds a lock on its temporary folder, which ends with the process. The next start can therefore
//! detect abandoned folders, on every machine that shares the disk. On systems without such locks, remains
//! stay.

use super::disk::{Permit, is_exhausted, permit};
use super::lock::is_at;
use super::manifest::Manifest;
use super::{WriteError, parent};
use catchment_core::design::hex;
use sha2::{Digest, Sha256};
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// New, or old and to be removed.
pub(super) const NEW: &str = "tmp";
/// Stepped aside.
pub(super) const ASIDE: &str = "old";

/// Largest number of threads of a process, and of processes with the same number on several machines, that
/// write to the same place simultaneously.
const WRITERS: usize = 64;

/// Something unfinished beside its place: removed when dropped.
#[derive(Debug)]
pub(super) struct Temporary {
    pub(super) path: PathBuf,
    finished: bool,
    /// Released when dropped.
    lock: Option<File>,
}

/// An item created under an unused name.
enum Made<T> {
    /// It can be locked by this.
    Locked(File, T),
    /// Here nothing can be locked.
    Unlocked(T),
    /// Somebody swept it away before it could be opened.
    Swept,
}

impl Temporary {
    /// An empty folder, at most as accessible as the folder that it will replace.
    pub(super) fn folder(place: &Path) -> Result<Self, WriteError> {
        let replaced = fs::symlink_metadata(place).ok().filter(fs::Metadata::is_dir);
        let permissions = replaced.map(|meta| meta.permissions());
        Self::make(place, |permit, path| {
            permit.create_dir(path, permissions.as_ref())?;
            match File::open(path) {
                Ok(folder) => Ok(Made::Locked(folder, ())),
                Err(error) if error.kind() == ErrorKind::NotFound => Ok(Made::Swept),
                Err(error) if cfg!(unix) => {
                    // The folder cannot be recognised later, not even by its lock.
                    let _ = permit.remove_dir(path);
                    Err(error)
                }
                // Some systems cannot open folders.
                Err(_) => Ok(Made::Unlocked(())),
            }
        })
        .map(|(made, ())| made)
    }

    /// An empty file, at most as accessible as the file that it will replace.
    pub(super) fn file(place: &Path, permissions: Option<&Permissions>) -> Result<(Self, File), WriteError> {
        Self::make(place, |permit, path| {
            let file = permit.create(path, permissions)?;
            Ok(match file.try_clone() {
                Ok(lock) => Made::Locked(lock, file),
                Err(_) => Made::Unlocked(file),
            })
        })
    }

    fn make<T>(
        place: &Path,
        create: impl Fn(&Permit, &Path) -> io::Result<Made<T>>,
    ) -> Result<(Self, T), WriteError> {
        for number in 0..WRITERS {
            let path = hidden(place, number, NEW)?;
            let permit = permit();
            let (lock, made) = match create(&permit, &path) {
                Ok(Made::Locked(lock, made)) if !is_held(&lock) && is_at(&lock, &path) => (Some(lock), made),
                Ok(Made::Unlocked(made)) => (None, made),
                // Theirs to remove who found it before it was locked; the name may be another's by now.
                Ok(Made::Locked(..) | Made::Swept) => continue,
                Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
                Err(error) => return Err(WriteError::at(place, error)),
            };
            permit.unfinished(&path, true);
            return Ok((Self { path, finished: false, lock }, made));
        }
        Err(WriteError::at(place, ErrorKind::ResourceBusy.into()))
    }

    /// It has been moved to its place, or must stay.
    pub(super) fn keep(&mut self) {
        permit().unfinished(&self.path, false);
        self.finished = true;
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.finished {
            let permit = permit();
            let mut removed = permit.remove_tree(&self.path);
            if removed.as_ref().is_err_and(is_exhausted) && self.lock.take().is_some() {
                // The descriptor of the lock itself was the missing descriptor.
                removed = permit.remove_tree(&self.path);
            }
            // A failure cannot be reported here; the next start tries again.
            drop(removed);
            permit.unfinished(&self.path, false);
        }
    }
}

/// The hidden name beside a place.
pub(super) fn hidden(place: &Path, number: usize, ending: &str) -> Result<PathBuf, WriteError> {
    let name = place.file_name().ok_or_else(|| WriteError::NoName { path: place.to_owned() })?;
    let mut hidden = start(name);
    let id = std::process::id();
    let number = if number > 0 { format!("{id}-{number}") } else { id.to_string() };
    let mark = mark(&hidden, &number);
    hidden.push(format!("{number}.{mark}.{ending}"));
    Ok(place.with_file_name(hidden))
}

/// The mark of a hidden name of this program.
pub(super) fn mark(start: &OsStr, number: &str) -> String {
    const DIGITS: usize = 8;
    let digest = Sha256::new().chain_update(start.as_encoded_bytes()).chain_update(number).finalize();
    hex(&digest)[..DIGITS].to_owned()
}

fn start(name: &OsStr) -> OsString {
    let mut start = OsString::from(".");
    start.push(name);
    start.push(".");
    start
}

/// The suffix of a hidden name with this start, if it is one, and whether it has its mark.
fn ending(name: &OsStr, start: &OsStr) -> Option<(&'static str, bool)> {
    let rest = name.as_encoded_bytes().strip_prefix(start.as_encoded_bytes())?;
    let (number, rest) = std::str::from_utf8(rest).ok()?.split_once('.')?;
    let marked = rest.split_once('.').filter(|(result, _)| *result == mark(start, number));
    let ending = marked.map_or(rest, |(_, ending)| ending);
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let is_number = number.split_once('-').map_or_else(|| digits(number), |(a, b)| digits(a) && digits(b));
    let known = [NEW, ASIDE].into_iter().find(|known| is_number && ending == *known)?;
    Some((known, marked.is_some()))
}

/// Whether somebody else holds the lock; if not, it is taken.
fn is_held(file: &File) -> bool {
    matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock))
}

/// Restores and removes the remains of killed processes beside a place.
///
/// # Errors
/// The remains contain something that is not from this program.
pub(crate) fn sweep(place: &Path) -> Result<(), WriteError> {
    let Some(name) = place.file_name() else { return Ok(()) };
    let start = start(name);
    let Ok(entries) = fs::read_dir(parent(place)) else { return Ok(()) };
    let mut left: Vec<(&'static str, bool, PathBuf)> = entries
        .filter_map(Result::ok)
        .filter_map(|entry| {
            let (ending, marked) = ending(&entry.file_name(), &start)?;
            Some((ending, marked, place.with_file_name(entry.file_name())))
        })
        .collect();
    left.sort(); // what stepped aside comes first: it may be all there is
    for (ending, marked, path) in left {
        let Ok(meta) = fs::symlink_metadata(&path) else { continue };
        if !meta.is_file() && !meta.is_dir() {
            continue;
        }
        // Without a lock it is unknown whether the folder is still being written.
        let Ok(lock) = File::open(&path) else { continue };
        if lock.try_lock().is_err() || !is_at(&lock, &path) {
            continue;
        }
        let at = |error| WriteError::at(&path, error);
        let permit = permit();
        let manifest = if meta.is_dir() { Manifest::read(&path).map_err(at)? } else { None };
        if ending == ASIDE && (marked || manifest.is_some()) && fs::symlink_metadata(place).is_err() {
            permit.rename_to_new(&path, place).map_err(at)?;
        } else if let Some(manifest) = manifest {
            match manifest.strange(&path).map_err(at)? {
                None => manifest.remove(&path, &permit).map_err(at)?,
                Some(strange) => {
                    return Err(WriteError::Strange { path, name: strange.name, changed: strange.changed });
                }
            }
        } else if ending == NEW && marked {
            permit.remove_tree(&path).map_err(at)?;
        } else if meta.is_dir() {
            // Its manifest went last; if it is not empty, it is not from here.
            let _ = permit.remove_dir(&path);
        }
    }
    Ok(())
}
