//! STL files: a closed triangle mesh as half of a connector.
//!
//! ```text
//! bytes ──parse──▶ triangles, each with its place ──weld, check──▶ Surface, in D
//! ```
//!
//! Both dialects are read; which one is decided by the size of the file and not by the word `solid`, which
//! binary exporters write as well. STL has no topology: corners closer than [`WELD`] of the model's size are
//! one. Stored normals are ignored, the winding counts. Nothing is repaired or dropped: a mesh is either
//! closed, wound outward and free of self-intersections, or every reason against it is reported with its
//! place. Coordinates in messages are those of the file.
//!
//! The reader is our own because it has to say *where* a file is broken and must not allocate what a hostile
//! header claims.
//!
//! Not promised: solids that touch each other along an edge are refused (four triangles meet there), and
//! coplanar overlaps of separate shells are not looked for.

mod check;
mod parse;
mod write;

pub use write::{Format, write};

use super::Surface;
use glam::DVec3;
use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Most triangles of a half. The heights of a pair cost the product of the two halves' elements, so beyond
/// this even one pose takes seconds; docking faces need hundreds.
pub const MAX_TRIANGLES: usize = 20_000;
/// Longest ASCII file that can hold that many, generously written.
pub const MAX_BYTES: u64 = 16 << 20;
/// Corners closer than this, relative to the largest coordinate, are one: ten times the rounding of single
/// precision.
pub const WELD: f64 = 1e-6;
/// Most problems reported of one kind.
const MAX_REPORTED: usize = 5;
/// Widths of a half, in D, that can be meant.
const PLAUSIBLE_WIDTH: std::ops::RangeInclusive<f64> = 0.25..=4.0;

/// Where a triangle stands in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Which triangle, from 0.
    pub triangle: usize,
    /// Its first line (ASCII, from 1) or first byte (binary, from 0).
    pub start: Start,
}

/// Where something begins in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Line of an ASCII file, from 1.
    Line(usize),
    /// Byte of a binary file, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.start {
            Start::Line(line) => write!(f, "triangle {} (line {line})", self.triangle),
            Start::Byte(byte) => write!(f, "triangle {} (byte {byte})", self.triangle),
        }
    }
}

/// One reason why an STL file is no half of a connector.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StlProblem {
    /// The file could not be read.
    #[error("cannot be read: {message}")]
    Io {
        /// What the system says.
        message: String,
    },
    /// Nothing in it.
    #[error("the file is empty")]
    Empty,
    /// A binary file shorter or longer than its header claims.
    #[error(
        "the header announces {triangles} triangles, which end at byte {expected}, but the file has {found} bytes: {}",
        if found < expected { "it was cut off; export it again" } else { "it carries something else; export it again" }
    )]
    Length {
        /// Triangles announced.
        triangles: u64,
        /// Bytes needed for them.
        expected: u64,
        /// Bytes there are.
        found: u64,
    },
    /// Too short for a header, and no text either.
    #[error("{found} bytes are neither ASCII STL (which begins with `solid`) nor a binary header (84 bytes)")]
    NotStl {
        /// Bytes there are.
        found: u64,
    },
    /// More triangles than one half may have.
    #[error(
        "{count} triangles, more than the {MAX_TRIANGLES} that a half may have: export the mating faces with a coarser tolerance, or decimate the mesh"
    )]
    TooMany {
        /// How many there are, as far as is known.
        count: u64,
    },
    /// A text file too long to hold an acceptable mesh.
    #[error(
        "{bytes} bytes of text, more than the {MAX_BYTES} that {MAX_TRIANGLES} triangles need: export a coarser mesh"
    )]
    TooLong {
        /// Size of the file.
        bytes: u64,
    },
    /// Text that is no STL.
    #[error("line {line}: expected {expected}, found {found}")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// What the format wants there.
        expected: &'static str,
        /// What stands there, shortened.
        found: String,
    },
    /// A file without triangles.
    #[error("the file holds no triangles")]
    NoTriangles,
    /// A coordinate that is no number.
    #[error("{place} has a corner that is not finite")]
    NotFinite {
        /// Which triangle.
        place: Place,
    },
    /// A triangle without area.
    #[error("{place} at {at} has no area: its corners fall together or lie on a line")]
    ZeroArea {
        /// Which triangle.
        place: Place,
        /// One of its corners.
        at: DVec3,
    },
    /// An edge with a triangle on one side only.
    #[error("the mesh is open along the edge of {place} from {from} to {to}: close the hole")]
    Open {
        /// The triangle on the one side.
        place: Place,
        /// One end.
        from: DVec3,
        /// The other end.
        to: DVec3,
    },
    /// An edge with more than two triangles.
    #[error(
        "{count} triangles meet along the edge from {from} to {to}: separate or join the solids that touch there"
    )]
    NonManifold {
        /// How many.
        count: usize,
        /// One end.
        from: DVec3,
        /// The other end.
        to: DVec3,
    },
    /// Two neighbours wound in opposite senses.
    #[error("{first} and {second} are wound in opposite senses: unify the normals")]
    Winding {
        /// One of them.
        first: Place,
        /// The other.
        second: Place,
    },
    /// The whole mesh is wound inward.
    #[error("the mesh is turned inside out: flip its normals")]
    InsideOut,
    /// Two triangles cross.
    #[error("{first} and {second} cross near {at}: unite the solids before exporting")]
    SelfIntersection {
        /// One of them.
        first: Place,
        /// The other.
        second: Place,
        /// Where.
        at: DVec3,
    },
    /// The size makes no sense beside D.
    #[error(
        "the half is {width:.3e} D wide; a connector's half is about 1 D: check the mesh's unit and the design's width"
    )]
    Unit {
        /// Width in D.
        width: f64,
    },
    /// The scale from the file's coordinates to D is no positive number.
    #[error("the scale {scale} from the file's coordinates to D must be a number above 0")]
    Scale {
        /// The scale.
        scale: f64,
    },
    /// More problems of the kind before it.
    #[error("and {count} more like the last")]
    More {
        /// How many.
        count: usize,
    },
}

/// Reads an STL file; `scale` turns its coordinates into D.
///
/// # Errors
/// Everything that is wrong with the file, at most a few problems of each kind.
pub fn read(path: &Path, scale: f64) -> Result<Surface, Vec<StlProblem>> {
    let io = |e: std::io::Error| vec![StlProblem::Io { message: e.to_string() }];
    let mut file = File::open(path).map_err(io)?;
    let size = file.metadata().map_err(io)?.len();
    let mut bytes = Vec::new();
    (&mut file).take(MAX_BYTES).read_to_end(&mut bytes).map_err(io)?;
    from_bytes(&bytes, size.max(bytes.len() as u64), scale)
}

/// Reads an STL file from its bytes; `scale` turns its coordinates into D. `size` is the size of the whole
/// file, of which `bytes` may be only the first [`MAX_BYTES`].
///
/// # Errors
/// Like [`read`].
pub fn from_bytes(bytes: &[u8], size: u64, scale: f64) -> Result<Surface, Vec<StlProblem>> {
    if !(scale.is_finite() && scale > 0.0) {
        return Err(vec![StlProblem::Scale { scale }]);
    }
    let triangles = parse::parse(bytes, size)?;
    check::surface(&triangles, scale)
}

/// Collects problems, a few of each kind.
#[derive(Default)]
struct Reported {
    problems: Vec<StlProblem>,
}

impl Reported {
    /// Appends the problems of one kind, of which only the first few are spelled out.
    fn extend(&mut self, kind: impl IntoIterator<Item = StlProblem>) {
        let mut rest = 0;
        for (k, problem) in kind.into_iter().enumerate() {
            if k < MAX_REPORTED {
                self.problems.push(problem);
            } else {
                rest += 1;
            }
        }
        if rest > 0 {
            self.problems.push(StlProblem::More { count: rest });
        }
    }

    fn done(self) -> Result<(), Vec<StlProblem>> {
        if self.problems.is_empty() { Ok(()) } else { Err(self.problems) }
    }
}

#[cfg(test)]
mod tests;
