//! The bytes of a design file, before parsing.

use super::read::LARGEST_FILE;
use catchment_base::terminal::shown;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Why a file cannot be a design file.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The system does not give it.
    #[error("cannot read {}: {source}", shown(path))]
    Io {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
    /// It has no content.
    #[error("{} is empty", shown(path))]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// It is too large.
    #[error(
        "{} is larger than {} MiB; put large geometry into an STL file: mesh = \"half.stl\"",
        shown(path),
        LARGEST_FILE >> 20
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
    /// It is not text.
    #[error("{} is not a text file: byte {offset} is not UTF-8", shown(path))]
    NotText {
        /// The file.
        path: PathBuf,
        /// The first byte that is not UTF-8, from 0.
        offset: usize,
    },
}

/// The text of a design file; reads no more than [`LARGEST_FILE`] bytes.
pub fn load(path: &Path) -> Result<String, LoadError> {
    let path_buf = || path.to_path_buf();
    let io_error = |source| LoadError::Io { path: path_buf(), source };
    let file = std::fs::File::open(path).map_err(io_error)?;
    let mut bytes = Vec::new();
    file.take(LARGEST_FILE as u64 + 1).read_to_end(&mut bytes).map_err(io_error)?;
    if bytes.len() > LARGEST_FILE {
        return Err(LoadError::TooLarge { path: path_buf() });
    }
    let text = String::from_utf8(bytes)
        .map_err(|error| LoadError::NotText { path: path_buf(), offset: error.utf8_error().valid_up_to() })?;
    if text.trim().is_empty() {
        return Err(LoadError::Empty { path: path_buf() });
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_text_of_a_decent_size_is_loaded() {
        let dir = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = dir.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            load(&path)
        };
        assert_eq!(write("text", b"schema = 1").unwrap(), "schema = 1");
        assert!(matches!(write("empty", b""), Err(LoadError::Empty { .. })));
        assert!(matches!(write("blank", b" \n"), Err(LoadError::Empty { .. })));
        assert!(matches!(write("binary", b"ab\xff"), Err(LoadError::NotText { offset: 2, .. })));
        assert!(matches!(write("large", &vec![b'#'; LARGEST_FILE + 1]), Err(LoadError::TooLarge { .. })));
        assert!(matches!(load(&dir.path().join("none")), Err(LoadError::Io { .. })));
        assert!(matches!(load(dir.path()), Err(LoadError::Io { .. })));
    }
}
