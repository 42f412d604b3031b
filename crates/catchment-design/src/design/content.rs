//! Content of a file, so that a stored design records its geometry and not only a path.

use super::{ConnectorSpec, Design, Repairs};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// Content of a mesh file, or of a mesh passed in memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeshContent {
    /// SHA-256 of its bytes, 64 hexadecimal digits. For triangles in memory: of their corners in order, as
    /// little-endian doubles, in D.
    pub sha256: String,
    /// Number of bytes.
    pub bytes: u64,
    /// Number of triangles; for a drawing, number of corners of its outlines.
    pub triangles: usize,
    /// Number of closed bodies in the union; separate shells count as one body unless the file distinguishes
    /// them.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub bodies: usize,
    /// For a drawing, number of hidden entities or elements that were skipped, each with its content.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub hidden: usize,
    /// Repairs that were made.
    #[serde(default, skip_serializing_if = "Repairs::is_none")]
    pub repairs: Repairs,
    /// Meshing of its curved faces, if it has any (STEP).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meshed: Option<Box<Meshed>>,
}

/// Meshing of curved faces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Meshed {
    /// Largest allowed distance between curved faces and facets, in D.
    pub deflection: f64,
    /// Largest distance between curved faces and facets as reported by the mesher, in D.
    pub reached: f64,
    /// Mesher and its version.
    pub by: String,
    /// SHA-256 of the mesher's result: for each body the corners, little-endian doubles, and the triangles,
    /// little-endian 32-bit indices of corners.
    pub sha256: String,
}

const fn one() -> usize {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
const fn is_one(count: &usize) -> bool {
    *count == 1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
const fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl MeshContent {
    /// Of these bytes, which make so many triangles.
    pub fn of(bytes: &[u8], triangles: usize) -> Self {
        let (sha256, repairs) = (hex(&Sha256::digest(bytes)), Repairs::default());
        Self { sha256, bytes: bytes.len() as u64, triangles, bodies: 1, hidden: 0, repairs, meshed: None }
    }
}

/// Two hexadecimal digits per byte.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Content of the files of both halves, or description of the triangles given in memory, in order; empty for
/// a half without files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contents {
    /// Of the fixed half.
    pub fixed: Vec<MeshContent>,
    /// Of the moving half.
    pub moving: Vec<MeshContent>,
}

impl Design {
    /// This design with the content of its files, known once its halves are built.
    #[must_use]
    pub fn with_contents(mut self, contents: &Contents) -> Self {
        if let ConnectorSpec::Own(own) = &mut self.connector {
            for (half, result) in [(&mut own.fixed, &contents.fixed), (&mut own.moving, &contents.moving)] {
                for (file, result) in half.files_mut().into_iter().zip(result) {
                    file.content = Some(result.clone());
                }
            }
        }
        self
    }
}
