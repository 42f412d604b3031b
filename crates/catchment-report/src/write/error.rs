//! Errors of writing: each a fact with advice, classified by the error of the system.

use super::disk::is_exhausted;
use super::lock::Holder;
use super::manifest::MANIFEST;
use catchment_core::exec::Cancelled;
use catchment_core::terminal::shown;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Why something could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// No room left.
    #[error("cannot write {}: the disk is full", shown(path))]
    DiskFull {
        /// Target of the writing.
        path: PathBuf,
    },
    /// The system does not allow it.
    #[error("cannot write {}: permission denied", shown(path))]
    Denied {
        /// Target of the writing.
        path: PathBuf,
    },
    /// The folder to write into does not exist.
    #[error("cannot write {}: its folder does not exist; create it first", shown(path))]
    NoFolder {
        /// Target of the writing.
        path: PathBuf,
    },
    /// Something without a manifest is there, and it would be lost.
    #[error(
        "cannot write {}: something is there that is not a catchment result (it has no readable {MANIFEST}); \
         move it away or choose another name",
        shown(path)
    )]
    NotAResult {
        /// Target of the writing.
        path: PathBuf,
    },
    /// A result of another kind is there, and it would be lost.
    #[error(
        "cannot write {}: another result is there ({found}, not {kind}); move it away or choose another name",
        shown(path)
    )]
    OtherKind {
        /// Target of the writing.
        path: PathBuf,
        /// The item found there.
        found: String,
        /// Kind of the content to be written.
        kind: String,
    },
    /// Something in the result that is there would be lost.
    #[error(
        "cannot write {}: {} in it was {}; move it away or choose another name",
        shown(path),
        shown(name),
        if *changed { "changed since it was written" } else { "not written by catchment" }
    )]
    Strange {
        /// The folder.
        path: PathBuf,
        /// Its path in the folder.
        name: PathBuf,
        /// It was written with the folder, and changed since.
        changed: bool,
    },
    /// A file is there that is not to be replaced.
    #[error("cannot write {}: it exists", shown(path))]
    Exists {
        /// Target of the writing.
        path: PathBuf,
    },
    /// A folder exists in place of the file.
    #[error("cannot write {}: it is a folder", shown(path))]
    IsFolder {
        /// Target of the writing.
        path: PathBuf,
    },
    /// A device, a pipe or a socket is there.
    #[error("cannot write {}: it is not an ordinary file", shown(path))]
    NotAFile {
        /// Target of the writing.
        path: PathBuf,
    },
    /// The path is a mount point, which cannot be exchanged with items beside it.
    #[error(
        "cannot write {}: it is a mount point, which cannot be replaced; name something inside it",
        shown(path)
    )]
    MountPoint {
        /// Target of the writing.
        path: PathBuf,
    },
    /// The name leaves no room for a temporary name, or is too long for the system.
    #[error("cannot write {}: its name is too long", shown(path))]
    NameTooLong {
        /// Target of the writing.
        path: PathBuf,
    },
    /// Another process keeps the folder locked.
    #[error("cannot write {}: {by} has kept the folder locked for {seconds} s; {}", shown(path), by.remedy())]
    Locked {
        /// The folder.
        path: PathBuf,
        /// The process.
        by: Holder,
        /// How long it was waited for.
        seconds: u64,
    },
    /// A process that started this program keeps the folder locked, and each would wait for the other.
    #[error(
        "cannot write {}: {by}, which started this program, keeps the folder locked and waits for this program to end; \
         lock a file beside the folder, not the folder itself",
        shown(path)
    )]
    LockedAbove {
        /// The folder.
        path: PathBuf,
        /// The process.
        by: Holder,
    },
    /// The system refuses another open file.
    #[error(
        "cannot write {}: too many open files; allow more (ulimit -n), or end programs that hold many",
        shown(path)
    )]
    TooManyOpen {
        /// Target of the writing.
        path: PathBuf,
    },
    /// The computation was cancelled while it waited.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Groups are named in UTF-8.
    #[error("cannot write {}: the path is not UTF-8, which stored grids need", shown(path))]
    NotUtf8 {
        /// Target of the writing.
        path: PathBuf,
    },
    /// The path names no file.
    #[error("cannot write {}: the path does not end with a name", shown(path))]
    NoName {
        /// The path.
        path: PathBuf,
    },
    /// Anything else the system reports.
    #[error("cannot write {}: {source}", shown(path))]
    Io {
        /// Target of the writing.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
}

impl WriteError {
    /// Sorts a system error.
    pub(crate) fn at(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        if is_exhausted(&source) {
            return Self::TooManyOpen { path };
        }
        match source.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Self::DiskFull { path },
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => Self::Denied { path },
            ErrorKind::NotFound | ErrorKind::NotADirectory => Self::NoFolder { path },
            ErrorKind::InvalidFilename => Self::NameTooLong { path },
            ErrorKind::AlreadyExists => Self::Exists { path },
            _ => Self::Io { path, source },
        }
    }
}
