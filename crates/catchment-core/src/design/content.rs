//! What a file held, so that a stored design says what was computed and not only where it lay.

use super::{ConnectorSpec, Design, Repairs};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// What a mesh file, or a mesh given in memory, held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeshContent {
    /// SHA-256 of its bytes, 64 hexadecimal digits. Of triangles in memory: of their corners in order, as
    /// little-endian doubles, in D.
    pub sha256: String,
    /// How many bytes there are.
    pub bytes: u64,
    /// How many triangles they make; of a drawing, how many corners its outlines have.
    pub triangles: usize,
    /// How many closed bodies it is the union of; shells that are apart count as one unless the file tells them apart.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub bodies: usize,
    /// Of a drawing, how many entities or elements are hidden in it and left out, each with all that is in it.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub hidden: usize,
    /// What was done to them.
    #[serde(default, skip_serializing_if = "Repairs::is_none")]
    pub repairs: Repairs,
    /// How its curved faces became triangles, where it has some (STEP).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meshed: Option<Box<Meshed>>,
}

/// How curved faces became triangles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Meshed {
    /// How far the facets may be off, in D.
    pub deflection: f64,
    /// How far they are, as what meshed it measures it, in D.
    pub reached: f64,
    /// What meshed it, and its version.
    pub by: String,
    /// SHA-256 of its answer: for every body the corners, little-endian doubles, and the triangles, little-endian 32-bit numbers of corners.
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

/// What the files of both halves held, or the triangles that were given in memory, in their order; nothing of a half without any.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contents {
    /// Of the fixed half.
    pub fixed: Vec<MeshContent>,
    /// Of the moving half.
    pub moving: Vec<MeshContent>,
}

impl Design {
    /// This design with what its files held, as known once its halves are built.
    #[must_use]
    pub fn with_contents(mut self, contents: &Contents) -> Self {
        if let ConnectorSpec::Own(own) = &mut self.connector {
            for (half, found) in [(&mut own.fixed, &contents.fixed), (&mut own.moving, &contents.moving)] {
                for (file, found) in half.files_mut().into_iter().zip(found) {
                    file.content = Some(found.clone());
                }
            }
        }
        self
    }
}
