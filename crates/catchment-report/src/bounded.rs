//! Bounded reading of foreign files: within a size limit, and only from regular files.
//!
//! A FIFO would block forever, a device never ends, and a file of gigabytes could be mistaken for a report.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Most bytes of a report or of a group's metadata. Those of this program take some 10 kB, and 1 MB with the vertices of large
/// halves.
pub(super) const REPORT_BYTES: u64 = 64 << 20;

/// The whole content of a regular file of at most `most` bytes.
///
/// # Errors
/// The error of the system; `InvalidInput` if it is not a regular file, `FileTooLarge` if it is longer.
pub(super) fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    // Before it is opened: opening a FIFO waits for somebody who writes into it.
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is no regular file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let reason = format!("it is longer than {most} bytes");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, reason));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_are_read_and_only_short_ones() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("file");
        std::fs::write(&path, "four").unwrap();
        assert_eq!(read(&path, 4).unwrap(), b"four");
        assert_eq!(read(&path, 3).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
        assert_eq!(read(home.path(), 4).unwrap_err().kind(), io::ErrorKind::InvalidInput);
        assert_eq!(read(&home.path().join("none"), 4).unwrap_err().kind(), io::ErrorKind::NotFound);
        if cfg!(target_os = "linux") {
            assert_eq!(read(Path::new("/dev/zero"), 4).unwrap_err().kind(), io::ErrorKind::InvalidInput);
        }
    }
}
