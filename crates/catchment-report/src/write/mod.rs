//! Writing of files and folders: complete or absent, and never over the files of others.
//!
//! ```text
//!   file      .name.PID.MARK.tmp  ──write, fsync──▶  rename to name
//!   folder    .name.PID.MARK.tmp/ ──fill, manifest, fsync──▶  exchange with name  ──look again──▶  remove the old
//! ```
//!
//! Everything is written beside its place under a temporary name and moved to its place when it is on the
//! disk. A reader sees the old content or the new, and a failed run leaves nothing behind. Remains of a
//! killed run are removed by the next writer to the same place.
//!
//! A folder holds a manifest of its files ([`MANIFEST`]). Only a folder of the same kind is replaced, and
//! only if nothing in it was added or changed since; an empty folder may be used. Links are followed: their
//! target is replaced, and the link stays. The permissions of replaced files stay.
//!
//! *Not promised:* that a folder never vanishes for a moment if the system cannot exchange two folders (some
//! network disks, Windows), and that a file which is added to the old folder between the last check and its
//! removal stays at its place. Such a file is not deleted: it stays in the hidden folder beside it, and the
//! next run reports it.

mod disk;
mod error;
#[cfg(test)]
pub(crate) mod faults;
mod lock;
mod manifest;
#[cfg(test)]
mod stops;
mod temporary;
#[cfg(test)]
mod tests;

pub(crate) use disk::permit;
pub use disk::{abandon, abandon_at_once};
pub use error::WriteError;
pub use lock::Holder;
pub use manifest::MANIFEST;
pub(crate) use temporary::sweep;

use catchment_core::exec::Exec;
use disk::{entries, is_mount_point};
use lock::{AFTER, BEFORE, claim};
use manifest::Manifest;
use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;
use temporary::{ASIDE, Temporary, hidden};

/// Links that lead to links that lead to links: the system's own limit.
const LINKS: usize = 40;

/// The folder in which a path lies.
fn parent(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."))
}

/// Target of a path after following links; it need not exist.
///
/// # Errors
/// The path has no name at its end, or links form a circle.
pub fn place(path: &Path) -> Result<PathBuf, WriteError> {
    // Without the separator or the dot at its end, which would follow a link.
    let mut place: PathBuf = path.components().collect();
    for _ in 0..LINKS {
        if place.file_name().is_none() {
            return Err(WriteError::NoName { path: path.to_owned() });
        }
        match fs::read_link(&place) {
            Ok(to) => place = parent(&place).join(to).components().collect(),
            Err(_) => return Ok(place),
        }
    }
    Err(WriteError::at(path, io::Error::other("its links lead in a circle")))
}

/// Refuses a path that is not UTF-8, for those who store grids.
pub(crate) fn check_utf8(path: &Path) -> Result<(), WriteError> {
    if place(path)?.to_str().is_some() { Ok(()) } else { Err(WriteError::NotUtf8 { path: path.to_owned() }) }
}

/// Makes a rename durable across a power cut, if the system can.
fn sync_parent(path: &Path) {
    // Some systems cannot open folders; the rename itself has already happened.
    let _ = File::open(parent(path)).and_then(|folder| folder.sync_all());
}

/// Target of a file, and the permissions that it takes over.
fn look_for_file(path: &Path, replace: bool) -> Result<(PathBuf, Option<Permissions>), WriteError> {
    let there = fs::metadata(path).ok();
    if let Some(meta) = &there {
        let path = path.to_owned();
        if meta.is_dir() {
            return Err(WriteError::IsFolder { path });
        }
        if !meta.is_file() {
            return Err(WriteError::NotAFile { path });
        }
        if is_mount_point(&path) {
            return Err(WriteError::MountPoint { path });
        }
    }
    // Also a link that leads nowhere.
    if !replace && fs::symlink_metadata(path).is_ok() {
        return Err(WriteError::Exists { path: path.to_owned() });
    }
    Ok((place(path)?, there.map(|meta| meta.permissions())))
}

/// Refuses a place for a file as [`file()`] would, and tries it out.
///
/// # Errors
/// Those of [`file()`].
pub fn check_file(path: &Path, replace: bool) -> Result<(), WriteError> {
    let (place, permissions) = look_for_file(path, replace)?;
    sweep(&place)?;
    Temporary::file(&place, permissions.as_ref()).map(drop)
}

/// Writes a file; an existing ordinary *file* stays or is replaced. Links stay, and so do permissions.
///
/// # Errors
/// Whatever the system refuses; something else in the way.
pub fn file(path: &Path, bytes: &[u8], replace: bool) -> Result<(), WriteError> {
    let (place, permissions) = look_for_file(path, replace)?;
    sweep(&place)?;
    let (mut temporary, mut file) = Temporary::file(&place, permissions.as_ref())?;
    let write = || -> io::Result<()> {
        let new = &temporary.path;
        if let Some(permissions) = permissions {
            permit().set_permissions(new, permissions)?;
        }
        permit().write(new, &mut file, bytes)?;
        permit().sync(new, &file)?;
        if replace { permit().rename(new, &place) } else { permit().rename_to_new(new, &place) }
    };
    write().map_err(|error| WriteError::at(path, error))?;
    temporary.keep();
    sync_parent(&place);
    Ok(())
}

/// Writes a file into a folder that is being filled; `name` may contain a folder, which is created.
///
/// # Errors
/// Errors of the system.
pub fn part(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), WriteError> {
    let path = folder.join(name);
    let write = || -> io::Result<()> {
        let permit = permit();
        if !parent(&path).is_dir() {
            permit.create_dir(parent(&path), None)?;
        }
        let mut file = permit.create(&path, None)?;
        permit.write(&path, &mut file, bytes)
    };
    write().map_err(|error| WriteError::at(&path, error))
}

/// State of the place of a folder.
enum There {
    Nothing,
    Empty,
    Ours(Manifest),
}

/// State of a place that may be used for a folder of this kind.
fn look(place: &Path, kind: &str) -> Result<There, WriteError> {
    let path = || place.to_owned();
    match fs::symlink_metadata(place) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(There::Nothing),
        Err(error) => return Err(WriteError::at(place, error)),
        Ok(meta) if !meta.is_dir() => return Err(WriteError::NotAResult { path: path() }),
        Ok(_) if is_mount_point(place) => return Err(WriteError::MountPoint { path: path() }),
        Ok(_) => {}
    }
    let at = |error| WriteError::at(place, error);
    if fs::read_dir(place).map_err(at)?.next().is_none() {
        return Ok(There::Empty);
    }
    let manifest =
        Manifest::read(place).map_err(at)?.ok_or_else(|| WriteError::NotAResult { path: path() })?;
    if manifest.kind != kind {
        return Err(WriteError::OtherKind { path: path(), found: manifest.kind, kind: kind.to_owned() });
    }
    nothing_strange(&manifest, place, place)?;
    Ok(There::Ours(manifest))
}

/// The same while no other process of this program works on it, with a guard that keeps others waiting until
/// it is dropped.
fn look_undisturbed(
    place: &Path,
    kind: &str,
    patience: Duration,
    exec: &Exec,
) -> Result<(Option<File>, There), WriteError> {
    /// Number of attempts; on systems without locks, others cannot be excluded.
    const TRIES: usize = 100;
    for _ in 0..TRIES {
        if let Some(others_wait) = claim(place, patience, exec)? {
            return Ok((Some(others_wait), look(place, kind)?));
        }
        match fs::symlink_metadata(place) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok((None, There::Nothing)),
            // The folder has appeared meanwhile. Try again: without a claim, others may remove its content
            // during the check.
            Ok(meta) if meta.is_dir() => {}
            _ => break,
        }
    }
    Ok((None, look(place, kind)?))
}

/// Refuses a folder with something in it that is not in its manifest; `shown` is its name for people.
fn nothing_strange(manifest: &Manifest, folder: &Path, shown: &Path) -> Result<(), WriteError> {
    match manifest.strange(folder).map_err(|error| WriteError::at(shown, error))? {
        None => Ok(()),
        Some(strange) => {
            Err(WriteError::Strange { path: shown.to_owned(), name: strange.name, changed: strange.changed })
        }
    }
}

/// Rejects a place for a folder as [`folder`] would, and tries it; cleans up the remains of a killed run
/// there.
///
/// # Errors
/// Those of [`folder`]; it waits 5 s for a lock.
pub fn check_folder(path: &Path, kind: &str, exec: &Exec) -> Result<(), WriteError> {
    let place = place(path)?;
    sweep(&place)?;
    look_undisturbed(&place, kind, BEFORE, exec)?;
    Temporary::folder(&place).map(drop)
}

/// Writes a folder: `fill` fills an empty folder, which then takes the place of `path`. An existing folder is
/// replaced only if it is of the same kind and nothing in it was added or changed.
///
/// # Errors
/// Those of `fill`, and errors of the system; it waits 60 s for a lock. The previous content is then
/// restored.
pub fn folder<E: From<WriteError>>(
    path: &Path,
    kind: &str,
    exec: &Exec,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    let place = place(path)?;
    sweep(&place)?;
    look_undisturbed(&place, kind, AFTER, exec)?;
    let mut new = Temporary::folder(&place)?;
    fill(&new.path)?;
    let complete = || -> io::Result<()> {
        let manifest = Manifest::of(&new.path, kind)?.to_json()?;
        sync_tree(&new.path)?;
        let path = new.path.join(MANIFEST);
        let permit = permit();
        let mut file = permit.create(&path, None)?;
        permit.write(&path, &mut file, &manifest)?;
        permit.sync(&path, &file)?;
        // Its entry, which some systems do not let be synced.
        let _ = File::open(&new.path).and_then(|folder| folder.sync_all());
        Ok(())
    };
    complete().map_err(|error| WriteError::at(path, error))?;
    while !put(&mut new, &place, kind, exec)? {}
    sync_parent(&place);
    Ok(())
}

/// Moves a complete folder to its place; returns `false` if another process was faster and it must be
/// retried.
fn put(new: &mut Temporary, place: &Path, kind: &str, exec: &Exec) -> Result<bool, WriteError> {
    let at = |error| WriteError::at(place, error);
    let (others_wait, there) = look_undisturbed(place, kind, AFTER, exec)?;
    if let (There::Empty | There::Ours(_), Ok(meta)) = (&there, fs::symlink_metadata(place)) {
        permit().set_permissions(&new.path, meta.permissions()).map_err(at)?;
    }
    match there {
        There::Nothing | There::Empty => {
            #[cfg(not(unix))]
            if matches!(there, There::Empty) {
                permit().remove_dir(place).map_err(at)?;
            }
            // An empty folder at the place is replaced; the rename fails for any other folder.
            let renamed = permit().rename(&new.path, place);
            match renamed {
                Err(error) if error.kind() == ErrorKind::DirectoryNotEmpty => return Ok(false),
                renamed => renamed.map_err(at)?,
            }
            new.keep();
        }
        There::Ours(old) => replace(new, place, &old)?,
    }
    drop(others_wait);
    Ok(true)
}

/// Exchanges, looks again, and removes the old folder, or puts it back.
fn replace(new: &mut Temporary, place: &Path, old: &Manifest) -> Result<(), WriteError> {
    let at = |error| WriteError::at(place, error);
    let permit = permit();
    let exchanged = permit.exchange(&new.path, place).map_err(at)?.is_some();
    let aside = if exchanged { new.path.clone() } else { hidden(place, 0, ASIDE)? };
    if !exchanged {
        permit.rename(place, &aside).map_err(at)?;
    }
    // Somebody may have put something into it until now.
    let undisturbed = nothing_strange(old, &aside, place);
    let stepped = match undisturbed {
        Ok(()) if exchanged => Ok(()),
        Ok(()) => permit.rename(&new.path, place).map_err(at),
        Err(refused) => Err(refused),
    };
    let back = match (&stepped, exchanged) {
        (Ok(()), _) => Ok(()),
        (Err(_), true) => permit.exchange(&new.path, place).map(drop),
        (Err(_), false) => permit.rename(&aside, place),
    };
    permit.unfinished(&new.path, stepped.is_err() && back.is_ok());
    if stepped.is_ok() {
        // A file added at this moment is not listed, and stops the removal; the next start cleans up the
        // rest.
        let _ = old.remove(&aside, &permit);
    }
    drop(permit);
    if stepped.is_ok() || back.is_err() {
        new.keep();
    }
    back.map_err(|error| WriteError::at(&aside, error))?;
    stepped
}

fn sync_tree(folder: &Path) -> io::Result<()> {
    for path in entries(folder)? {
        if path.is_dir() {
            sync_tree(&path)?;
            // Its entries, which some systems do not let be synced.
            let _ = File::open(&path).and_then(|folder| folder.sync_all());
        } else {
            File::open(&path)?.sync_all()?;
        }
    }
    Ok(())
}
