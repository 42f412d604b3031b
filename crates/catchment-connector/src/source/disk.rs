//! Mesh files on disk: only this file of the module uses the file system.

use super::FileBytes;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The first `most` bytes of a file.
pub(crate) fn read(path: &Path, most: u64) -> io::Result<FileBytes> {
    let mut file = File::open(path)?;
    let size = file.metadata()?.len();
    let mut bytes = Vec::new();
    // Not twice as much as needed, which growing step by step may take.
    bytes.try_reserve_exact(size.min(most) as usize)?;
    (&mut file).take(most).read_to_end(&mut bytes)?;
    let size = size.max(bytes.len() as u64);
    Ok(FileBytes { bytes, size })
}
