//! Writing: complete or not at all.
//!
//! ```text
//!   .name.PID.tmp  ──write, fsync──▶  rename to name
//! ```
//!
//! Everything is written beside its place under a temporary name and renamed when it is on the disk. Whoever
//! looks at the place sees the old content or the new, and a failed run leaves nothing behind.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Why something could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// No room left.
    #[error("cannot write {}: the disk is full", path.display())]
    DiskFull {
        /// What was to be written.
        path: PathBuf,
    },
    /// The system does not allow it.
    #[error("cannot write {}: permission denied", path.display())]
    Denied {
        /// What was to be written.
        path: PathBuf,
    },
    /// The folder to write into does not exist.
    #[error("cannot write {}: its folder does not exist; create it first", path.display())]
    NoFolder {
        /// What was to be written.
        path: PathBuf,
    },
    /// Something else is there, and it would be lost.
    #[error(
        "cannot write {}: something is there that is not a catchment result; move it away or choose another name",
        path.display()
    )]
    NotAResult {
        /// What was to be written.
        path: PathBuf,
    },
    /// The path names no file.
    #[error("cannot write {}: the path does not end with a name", path.display())]
    NoName {
        /// The path.
        path: PathBuf,
    },
    /// Anything else the system reports.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// What was to be written.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

impl WriteError {
    /// Sorts a system error.
    pub(crate) fn at(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Self::DiskFull { path },
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => Self::Denied { path },
            ErrorKind::NotFound => Self::NoFolder { path },
            _ => Self::Io { path, source },
        }
    }
}

/// A temporary sibling, removed unless it was renamed.
struct Temporary(PathBuf);

impl Temporary {
    fn beside(path: &Path, ending: &str) -> Result<Self, WriteError> {
        let name = path.file_name().ok_or_else(|| WriteError::NoName { path: path.to_owned() })?;
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}.{ending}", std::process::id()));
        let temporary = Self(path.with_file_name(hidden));
        temporary.remove(); // left by a killed process of the same number
        Ok(temporary)
    }

    fn remove(&self) {
        // Whether there was something to remove is of no interest, and Drop has nobody to tell.
        let _ = if self.0.is_dir() { fs::remove_dir_all(&self.0) } else { fs::remove_file(&self.0) };
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        self.remove();
    }
}

/// Makes a rename survive a power cut, where the system can.
fn sync_parent(path: &Path) {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    // Some systems cannot open folders; the rename itself has already happened.
    let _ = File::open(parent).and_then(|folder| folder.sync_all());
}

/// Writes a file, replacing an existing *file*.
///
/// # Errors
/// Whatever the system refuses; a folder in the way.
pub fn file(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    if path.is_dir() {
        return Err(WriteError::NotAResult { path: path.to_owned() });
    }
    let temporary = Temporary::beside(path, "tmp")?;
    let write = || -> io::Result<()> {
        let mut file = OpenOptions::new().write(true).create_new(true).open(&temporary.0)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&temporary.0, path)
    };
    write().map_err(|e| WriteError::at(path, e))?;
    sync_parent(path);
    Ok(())
}

/// Refuses a place for a folder as [`folder`] would, as far as can be seen without writing.
///
/// # Errors
/// Something else is there, the path has no name, or its parent is no folder.
pub fn check_folder(path: &Path, is_ours: impl Fn(&Path) -> bool) -> Result<(), WriteError> {
    if fs::symlink_metadata(path).is_ok() && !is_ours(path) {
        return Err(WriteError::NotAResult { path: path.to_owned() });
    }
    if path.file_name().is_none() {
        return Err(WriteError::NoName { path: path.to_owned() });
    }
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    if !parent.is_dir() {
        return Err(WriteError::NoFolder { path: path.to_owned() });
    }
    Ok(())
}

/// Writes a folder: `fill` fills an empty one, which then takes the place of `path`. What is there already is
/// replaced only if `is_ours` recognises it.
///
/// # Errors
/// Those of `fill`, and whatever the system refuses.
pub fn folder<E: From<WriteError>>(
    path: &Path,
    is_ours: impl Fn(&Path) -> bool,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    let exists = fs::symlink_metadata(path).is_ok();
    if exists && !is_ours(path) {
        return Err(WriteError::NotAResult { path: path.to_owned() }.into());
    }
    let new = Temporary::beside(path, "tmp")?;
    fs::create_dir(&new.0).map_err(|e| WriteError::at(path, e))?;
    fill(&new.0)?;
    let at = |e| WriteError::at(path, e);
    sync_tree(&new.0).map_err(at)?;
    if exists {
        // Folders cannot be exchanged in one step: the old one steps aside, and back if the new one cannot enter.
        let old = Temporary::beside(path, "old")?;
        fs::rename(path, &old.0).map_err(at)?;
        if let Err(error) = fs::rename(&new.0, path) {
            if let Err(stranded) = fs::rename(&old.0, path) {
                let kept = old.0.clone();
                std::mem::forget(old);
                return Err(WriteError::Io { path: kept, source: stranded }.into());
            }
            return Err(at(error).into());
        }
    } else {
        fs::rename(&new.0, path).map_err(at)?;
    }
    sync_parent(path);
    Ok(())
}

fn sync_tree(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            sync_tree(&path)?;
        } else {
            File::open(&path)?.sync_all()?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_replaced_and_nothing_else_appears() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("a.json");
        file(&path, b"one").unwrap();
        file(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(home.path()), ["a.json"]);
    }

    #[test]
    fn refusals_are_typed_and_leave_nothing() {
        let home = tempfile::tempdir().unwrap();
        let nowhere = home.path().join("missing/a.json");
        assert!(matches!(file(&nowhere, b""), Err(WriteError::NoFolder { .. })));
        assert!(matches!(file(home.path(), b""), Err(WriteError::NotAResult { .. })));
        assert!(matches!(
            file(Path::new("/"), b""),
            Err(WriteError::NotAResult { .. } | WriteError::NoName { .. })
        ));
        assert_eq!(names(home.path()), [""; 0]);
        // A device that is always full, where the system has one.
        if Path::new("/dev/full").exists() {
            let full = OpenOptions::new().write(true).open("/dev/full").unwrap().write_all(b"x").unwrap_err();
            assert!(matches!(WriteError::at(home.path(), full), WriteError::DiskFull { .. }));
        }
    }

    #[test]
    fn a_folder_appears_whole_or_not_at_all() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("out.zarr");
        let ours = |p: &Path| p.join("mark").exists();
        let fill = |content: &'static str| {
            move |p: &Path| fs::write(p.join("mark"), content).map_err(|e| WriteError::at(p, e))
        };
        folder(&path, ours, fill("one")).unwrap();
        folder(&path, ours, fill("two")).unwrap();
        let failed = folder(&path, ours, |p| {
            fs::write(p.join("half"), "three").map_err(|e| WriteError::at(p, e))?;
            Err(WriteError::DiskFull { path: p.to_owned() })
        });
        assert!(matches!(failed, Err(WriteError::DiskFull { .. })));
        assert_eq!(fs::read_to_string(path.join("mark")).unwrap(), "two");
        assert_eq!(names(home.path()), ["out.zarr"]);
        assert_eq!(names(&path), ["mark"]);
    }

    #[test]
    fn what_is_not_ours_is_not_replaced() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("thesis");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("chapter.tex"), "years of work").unwrap();
        let refused = folder(&path, |_| false, |_| Ok::<_, WriteError>(()));
        assert!(matches!(refused, Err(WriteError::NotAResult { .. })));
        assert_eq!(names(&path), ["chapter.tex"]);
    }
}
