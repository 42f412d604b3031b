//! What a mesh held, so that a stored design says what was computed and not only where it lay.

use super::{ConnectorSpec, Design, HalfSpec, Repairs};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// What a mesh file, or a mesh given in memory, held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshContent {
    /// SHA-256 of its bytes, 64 hexadecimal digits. Of triangles in memory: of their corners in order, as
    /// little-endian doubles, in D.
    pub sha256: String,
    /// How many bytes there are.
    pub bytes: u64,
    /// How many triangles they make.
    pub triangles: usize,
    /// What was done to them.
    #[serde(default, skip_serializing_if = "Repairs::is_none")]
    pub repairs: Repairs,
}

impl MeshContent {
    /// Of these bytes, which make so many triangles.
    pub fn of(bytes: &[u8], triangles: usize) -> Self {
        Self {
            sha256: hex(&Sha256::digest(bytes)),
            bytes: bytes.len() as u64,
            triangles,
            repairs: Repairs::default(),
        }
    }
}

/// Two hexadecimal digits per byte.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// What the meshes of both halves held; `None` for a half that came from no mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contents {
    /// Of the fixed half.
    pub fixed: Option<MeshContent>,
    /// Of the moving half.
    pub moving: Option<MeshContent>,
}

impl Design {
    /// This design with what its meshes held, as known once its halves are built.
    #[must_use]
    pub fn with_contents(mut self, contents: &Contents) -> Self {
        if let ConnectorSpec::Own(own) = &mut self.connector {
            for (half, found) in [(&mut own.fixed, &contents.fixed), (&mut own.moving, &contents.moving)] {
                if let (HalfSpec::Mesh { content, .. }, Some(found)) = (half, found) {
                    *content = Some(found.clone());
                }
            }
        }
        self
    }
}
