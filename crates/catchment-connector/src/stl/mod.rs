//! STL files: a closed triangle mesh as half of a connector.
//!
//! ```text
//! bytes ──parse──▶ triangles, each with its place ──weld, check──▶ Surface, in D
//! ```
//!
//! Both dialects are read; the size of the file decides between them, not the word `solid`, which binary
//! exporters write as well. Stored normals are ignored; the winding matters. [`super::mesh`] lists the
//! requirements on the triangles.
//!
//! The reader is our own because it must report the place of every defect and must not allocate memory by a
//! hostile header.

mod parse;
mod write;

pub use write::{StlEncoding, write};

use super::Half;
use super::mesh::{self, MOST_READ, MeshProblem};
use super::source::{FileBytes, FileContent};
use catchment_design::design::MeshPreparation;

/// Longest ASCII file that can hold as many triangles as a half may have, generously written.
pub const MAX_BYTES: u64 = 128 << 20;
/// Longest file that is read for simplification: a binary file with the largest number of triangles that are
/// read.
pub const MOST_BYTES: u64 = 84 + 50 * MOST_READ as u64;

/// As the table of formats wants it.
pub(super) fn read(file: &FileBytes, treatment: MeshPreparation) -> Result<FileContent, Vec<MeshProblem>> {
    parse::parse(&file.bytes, file.size, treatment).map(FileContent::of_triangles)
}

/// Checks the first bytes of a file: a binary file with too many triangles is rejected before they are read.
pub(super) fn refuse_early(file: &FileBytes, treatment: MeshPreparation) -> Result<(), Vec<MeshProblem>> {
    parse::refuse_early(&file.bytes, file.size, treatment)
}

/// Reads an STL file from its bytes, which are taken as they are; `scale` turns its coordinates into D. `size` is the size of the whole
/// file, of which `bytes` may be only the first [`MAX_BYTES`].
///
/// # Errors
/// Everything that is wrong with the file, at most a few problems of each kind.
pub fn from_bytes(bytes: &[u8], size: u64, scale: f64) -> Result<Half, Vec<MeshProblem>> {
    let triangles = parse::parse(bytes, size, MeshPreparation::AS_IT_IS)?;
    mesh::half(vec![triangles], scale, MeshPreparation::AS_IT_IS).map(|ready| ready.half)
}

#[cfg(test)]
mod tests;
