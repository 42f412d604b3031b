//! Defects that exclude a mesh as half of a connector, with their places: the triangle, its line or byte in
//! the file, and a point in the file's own coordinates.

use super::{MAX_TRIANGLES, MOST_READ, MeshPoint};
use crate::source::UnitProblem;
use crate::step::StepProblem;
use catchment_base::budget::Overspent;
use catchment_base::exec::Bytes;
use catchment_design::design::LengthUnit;
use std::fmt;

/// Largest number of problems reported of each kind.
pub(crate) const MAX_REPORTED: usize = 5;

/// Place of a triangle in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TriangleLocation {
    /// Which triangle, from 0.
    pub triangle: usize,
    /// Its first line (text, from 1) or first byte (binary, from 0).
    pub start: FileOffset,
}

/// Start of an item in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileOffset {
    /// Line of a text, from 1.
    Line(usize),
    /// Byte of a binary file, from 0.
    Byte(usize),
    /// In no file: the triangle was given in memory.
    Memory,
    /// In no file: the triangle was made when the mesh was repaired.
    Made,
}

impl fmt::Display for TriangleLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.start {
            FileOffset::Line(line) => write!(f, "triangle {} (line {line})", self.triangle),
            FileOffset::Byte(byte) => write!(f, "triangle {} (byte {byte})", self.triangle),
            FileOffset::Memory => write!(f, "triangle {}", self.triangle),
            FileOffset::Made => write!(f, "triangle {} of the repaired mesh", self.triangle),
        }
    }
}

/// Reason why triangles do not form a half of a connector.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshProblem {
    /// There is no such file.
    #[error("there is no such file; a path is relative to the folder of the design file")]
    NoFile,
    /// The file could not be read.
    #[error("cannot be read: {message}")]
    Io {
        /// Message of the system.
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
    /// More triangles than a half may have.
    #[error(
        "{count} triangles, more than the {MAX_TRIANGLES} that a half may have: write simplify = \"0.01 mm\" beside the file, which says how far the \
         surface may move, or export the mating faces with a coarser tolerance"
    )]
    TooMany {
        /// How many there are, as far as is known.
        count: u64,
    },
    /// More triangles than are read at all.
    #[error(
        "{count} triangles, more than the {MOST_READ} that are simplified: export the mesh with a coarser tolerance"
    )]
    TooManyToSimplify {
        /// How many there are, as far as is known.
        count: u64,
    },
    /// More triangles than a half may have, after simplification.
    #[error(
        "{count} triangles are left, more than the {MAX_TRIANGLES} that a half may have: let simplify move the surface farther"
    )]
    TooManyLeft {
        /// How many are left.
        count: usize,
    },
    /// Fewer triangles do not bound the same solid closely enough.
    #[error(
        "no mesh with fewer triangles keeps to {most:.1e} D of this one: leave simplify out, or let it move the surface farther"
    )]
    NotSimplified {
        /// Largest displacement of the surface, in D.
        most: f64,
    },
    /// It would take more memory than there is.
    #[error(
        "{count} triangles need {needed} of memory, more than the {budget} that are free: export the mesh with a coarser tolerance"
    )]
    Memory {
        /// How many triangles there are.
        count: usize,
        /// Bytes needed.
        needed: Bytes,
        /// Bytes that may be used.
        budget: Bytes,
    },
    /// A text file too long to hold an acceptable mesh.
    #[error("{bytes} bytes, more than the {most} that are read: export a coarser mesh, or a binary STL")]
    TooLong {
        /// Size of the file.
        bytes: u64,
        /// Bytes that are read.
        most: u64,
    },
    /// Text that is no STL.
    #[error("line {line}: expected {expected}, found {found}")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// The content that the format requires there.
        expected: &'static str,
        /// The content found there, shortened.
        found: String,
    },
    /// Not a PLY file, or a broken one.
    #[error("cannot be read as PLY: {message}")]
    NotPly {
        /// Place and reason.
        message: String,
    },
    /// Not a 3MF file, or a broken one.
    #[error("cannot be read as 3MF: {message}")]
    NotThreeMf {
        /// Place and reason.
        message: String,
    },
    /// More of something than a file may have.
    #[error("{place}: {over}")]
    Overspent {
        /// Place in the file.
        place: String,
        /// The exceeded limit, with the remedy.
        over: Overspent,
    },
    /// The unit of its coordinates is not known.
    #[error(transparent)]
    UnitOf(#[from] UnitProblem),
    /// A STEP file that gives no triangles.
    #[error(transparent)]
    Step(#[from] StepProblem),
    /// A file of another type, recognised by its first bytes.
    #[error("this is {what}")]
    Foreign {
        /// Its type, with advice.
        what: &'static str,
    },
    /// A face of more than three corners that cannot be cut into triangles.
    #[error(
        "the border of the face that triangle {triangle} begins, at {at}, crosses itself, or has no area: triangulate the mesh when it is exported"
    )]
    NotSimple {
        /// The number that its first triangle would have.
        triangle: usize,
        /// Its first corner.
        at: MeshPoint,
    },
    /// A file without triangles.
    #[error("the file holds no triangles")]
    NoTriangles,
    /// A body that the file does not have.
    #[error("there is no body {number}: the file holds {count}, numbered from the largest, which is 1")]
    NoSuchBody {
        /// The number of the body that the design takes.
        number: u16,
        /// How many there are.
        count: usize,
    },
    /// A coordinate that is no number.
    #[error("{place} has a corner that is not finite, {at}")]
    NotFinite {
        /// Which triangle.
        place: TriangleLocation,
        /// The corner.
        at: MeshPoint,
    },
    /// A triangle without area.
    #[error("{place} at {at} has no area: its corners fall together or lie on a line")]
    ZeroArea {
        /// Which triangle.
        place: TriangleLocation,
        /// A corner of it.
        at: MeshPoint,
    },
    /// An edge with a single triangle.
    #[error(
        "the mesh is open along the edge of {place} from {from} to {to}: close the hole (MeshLab: Close Holes; Python: pymeshfix)"
    )]
    Open {
        /// The triangle.
        place: TriangleLocation,
        /// Start of the edge.
        from: MeshPoint,
        /// The other end.
        to: MeshPoint,
    },
    /// An edge with more than two triangles.
    #[error(
        "{count} triangles meet along the edge from {from} to {to}: separate or join the solids that touch there"
    )]
    NonManifold {
        /// How many.
        count: usize,
        /// Start of the edge.
        from: MeshPoint,
        /// The other end.
        to: MeshPoint,
    },
    /// Two neighbours wound in opposite senses.
    #[error("{first} and {second} are wound in opposite senses at {at}: unify the normals")]
    Winding {
        /// The first of them.
        first: TriangleLocation,
        /// The other.
        second: TriangleLocation,
        /// The middle of the edge between them.
        at: MeshPoint,
    },
    /// The mesh, or a part of it that lies in no other, is wound inward.
    #[error("the mesh is turned inside out at {at}: flip its normals")]
    InsideOut {
        /// A corner of it.
        at: MeshPoint,
    },
    /// Two triangles cross.
    #[error("{first} and {second} cross near {at}: unite the solids before exporting")]
    SelfIntersection {
        /// The first of them.
        first: TriangleLocation,
        /// The other.
        second: TriangleLocation,
        /// Position.
        at: MeshPoint,
    },
    /// More triangles may cross than those before it.
    #[error("and {count} triangles were not looked at, which may cross others too")]
    NotLookedAt {
        /// How many.
        count: usize,
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

impl MeshProblem {
    /// The same with the unit of its coordinates.
    #[must_use]
    pub fn in_unit(mut self, of: Option<LengthUnit>) -> Self {
        match &mut self {
            Self::NotSimple { at, .. }
            | Self::NotFinite { at, .. }
            | Self::ZeroArea { at, .. }
            | Self::Winding { at, .. }
            | Self::InsideOut { at }
            | Self::SelfIntersection { at, .. } => at.unit = of,
            Self::Open { from, to, .. } | Self::NonManifold { from, to, .. } => {
                (from.unit, to.unit) = (of, of);
            }
            _ => {}
        }
        self
    }
}

/// Collects problems, a few of each kind.
#[derive(Default)]
pub(super) struct Reported {
    pub(super) problems: Vec<MeshProblem>,
}

impl Reported {
    /// Appends the problems of a kind, of which only the first few are given in full.
    pub(super) fn extend(&mut self, kind: impl IntoIterator<Item = MeshProblem>) {
        let mut rest = 0;
        for (k, problem) in kind.into_iter().enumerate() {
            if k < MAX_REPORTED || matches!(problem, MeshProblem::NotLookedAt { .. }) {
                self.problems.push(problem);
            } else {
                rest += 1;
            }
        }
        if rest > 0 {
            self.problems.push(MeshProblem::More { count: rest });
        }
    }

    pub(super) fn done(self) -> Result<(), Vec<MeshProblem>> {
        if self.problems.is_empty() { Ok(()) } else { Err(self.problems) }
    }
}
