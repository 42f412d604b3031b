//! A closed triangle mesh as half of a connector: from loose triangles to a [`Half`], or to every reason why they are none.
//!
//! ```text
//! triangles, each with its place ──weld──▶ corners shared ──check──▶ surfaces, in D
//! ```
//!
//! Every source of triangles comes through here, the files of the sources as well as triangles in memory. Corners closer
//! than [`WELD`] of the model's size are one, and an edge is divided where a corner of its neighbours lies on it as nearly. The winding counts,
//! counter-clockwise seen from outside. Nothing else is repaired, and nothing dropped: a mesh is either closed, wound outward and free of self-intersections, or every reason
//! against it is reported with its place. Coordinates in messages are those of the source.
//!
//! Closed shells that overlap are a surface each (up to 256 of them); otherwise all shells of a source are one.
//!
//! Not promised: solids that touch each other along an edge are refused (four triangles meet there), and
//! coplanar overlaps of separate shells are not looked for.

mod check;
pub(in crate::connector) mod cut;
mod divide;
mod shells;

use super::Half;
use super::source::UnitProblem;
use super::stl::MAX_BYTES;
use glam::DVec3;
use std::fmt;

/// Most triangles of a half: the largest for which a motion was measured to take seconds rather than minutes. Docking faces need
/// hundreds, as CAD exports them ten thousands.
pub const MAX_TRIANGLES: usize = 200_000;
/// Corners closer than this, relative to the largest coordinate, are one: ten times the rounding of single
/// precision.
pub const WELD: f64 = 1e-6;
/// Most problems reported of one kind.
pub(super) const MAX_REPORTED: usize = 5;
/// Widths of a half, in D, that can be meant.
const PLAUSIBLE_WIDTH: std::ops::RangeInclusive<f64> = 0.25..=4.0;

/// A triangle in the coordinates of its source.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    pub(super) corners: [DVec3; 3],
    pub(super) place: Place,
}

/// Where a triangle stands in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Which triangle, from 0.
    pub triangle: usize,
    /// Its first line (text, from 1) or first byte (binary, from 0).
    pub start: Start,
}

/// Where something begins in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Line of a text, from 1.
    Line(usize),
    /// Byte of a binary file, from 0.
    Byte(usize),
    /// In no file: the triangle was given in memory.
    Memory,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.start {
            Start::Line(line) => write!(f, "triangle {} (line {line})", self.triangle),
            Start::Byte(byte) => write!(f, "triangle {} (byte {byte})", self.triangle),
            Start::Memory => write!(f, "triangle {}", self.triangle),
        }
    }
}

/// One reason why triangles are no half of a connector.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshProblem {
    /// There is no such file.
    #[error("there is no such file; a path is relative to the folder of the design file")]
    NoFile,
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
    /// No PLY, or a broken one.
    #[error("cannot be read as PLY: {message}")]
    NotPly {
        /// Where and why.
        message: String,
    },
    /// No 3MF, or a broken one.
    #[error("cannot be read as 3MF: {message}")]
    NotThreeMf {
        /// Where and why.
        message: String,
    },
    /// The unit of its coordinates is not known.
    #[error(transparent)]
    UnitOf(#[from] UnitProblem),
    /// Something else, which the first bytes tell.
    #[error("this is {what}")]
    Foreign {
        /// What it is, and what to do about it.
        what: &'static str,
    },
    /// A face of more than three corners that cannot be cut into triangles.
    #[error(
        "the border of the face that triangle {triangle} begins crosses itself, or has no area: triangulate the mesh when it is exported"
    )]
    NotSimple {
        /// The number that its first triangle would have.
        triangle: usize,
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

/// The triangles of a file of faces, numbered in their order.
#[derive(Debug, Default)]
pub(super) struct Triangles {
    pub(super) list: Vec<Triangle>,
}

impl Triangles {
    /// Appends a face, cut into triangles.
    pub(super) fn push(&mut self, corners: &[DVec3]) -> Result<(), Vec<MeshProblem>> {
        // A triangle is what it is; whether it has an area, and whether all are numbers, is asked of all of them together.
        let cut = if corners.len() == 3 || !corners.iter().all(|corner| corner.is_finite()) {
            Some(vec![[0, 1, 2]])
        } else {
            cut::triangles(corners)
        };
        let first = self.list.len();
        let cut = cut.ok_or_else(|| vec![MeshProblem::NotSimple { triangle: first }])?;
        self.list.extend(cut.into_iter().enumerate().map(|(k, ids)| Triangle {
            corners: ids.map(|id| corners[id]),
            place: Place { triangle: first + k, start: Start::Memory },
        }));
        if self.list.len() > MAX_TRIANGLES {
            return Err(vec![MeshProblem::TooMany { count: self.list.len() as u64 }]);
        }
        Ok(())
    }
}

/// A half from triangles (in D), by the rules of every mesh file.
///
/// # Errors
/// Everything that is wrong with the mesh, at most a few problems of each kind, by the number of the triangle.
pub fn from_triangles(triangles: &[[DVec3; 3]]) -> Result<Half, Vec<MeshProblem>> {
    let placed = |(triangle, &corners)| Triangle { corners, place: Place { triangle, start: Start::Memory } };
    let triangles: Vec<Triangle> = triangles.iter().enumerate().map(placed).collect();
    half(&[triangles], 1.0)
}

/// A half from the triangles of a file, body by body; `scale` turns its coordinates into D.
pub(super) fn half(bodies: &[Vec<Triangle>], scale: f64) -> Result<Half, Vec<MeshProblem>> {
    let mut problems = Vec::new();
    let half = part(bodies, scale).unwrap_or_else(|found| {
        problems = found;
        Half::default()
    });
    // Without numbers there is no width, and without a scale none in D.
    let is_sized = !problems.iter().any(|problem| {
        use MeshProblem::{NoTriangles, NotFinite, Scale, TooMany};
        matches!(problem, NotFinite { .. } | Scale { .. } | NoTriangles | TooMany { .. })
    });
    let corners = bodies.iter().flatten().flat_map(|triangle| triangle.corners);
    problems.extend(if is_sized { implausible_width(corners.map(|c| c * scale)) } else { None });
    if problems.is_empty() { Ok(half) } else { Err(problems) }
}

/// The same of a part of a half, which may have any size.
pub(super) fn part(bodies: &[Vec<Triangle>], scale: f64) -> Result<Half, Vec<MeshProblem>> {
    check_scale(scale)?;
    let count = bodies.iter().map(Vec::len).sum::<usize>() as u64;
    if count > MAX_TRIANGLES as u64 {
        return Err(vec![MeshProblem::TooMany { count }]);
    }
    sound_numbers(bodies)?;
    let mut half = Half::default();
    let mut problems = Vec::new();
    for body in bodies.iter().filter(|body| !body.is_empty()) {
        match check::surfaces(body, scale) {
            Ok(surfaces) => half.surfaces.extend(surfaces),
            Err(found) => problems.extend(found),
        }
        if problems.len() > MAX_REPORTED * MAX_REPORTED {
            break;
        }
    }
    if problems.is_empty() { Ok(half) } else { Err(problems) }
}

/// Complains about a half whose width in D can hardly be meant.
pub(super) fn implausible_width(corners: impl Iterator<Item = DVec3>) -> Option<MeshProblem> {
    let (lo, hi) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let width = (hi - lo).truncate().max_element();
    (!PLAUSIBLE_WIDTH.contains(&width)).then_some(MeshProblem::Unit { width })
}

/// Refuses a scale that is no positive number.
fn check_scale(scale: f64) -> Result<(), Vec<MeshProblem>> {
    if scale.is_finite() && scale > 0.0 { Ok(()) } else { Err(vec![MeshProblem::Scale { scale }]) }
}

/// Refuses a mesh without triangles, and coordinates that are no numbers.
fn sound_numbers(bodies: &[Vec<Triangle>]) -> Result<(), Vec<MeshProblem>> {
    let mut reported = Reported::default();
    if bodies.iter().all(Vec::is_empty) {
        reported.extend([MeshProblem::NoTriangles]);
    }
    reported.extend(
        bodies
            .iter()
            .flatten()
            .filter(|t| !t.corners.iter().all(|c| c.is_finite()))
            .map(|t| MeshProblem::NotFinite { place: t.place }),
    );
    reported.done()
}

/// Collects problems, a few of each kind.
#[derive(Default)]
struct Reported {
    problems: Vec<MeshProblem>,
}

impl Reported {
    /// Appends the problems of one kind, of which only the first few are spelled out.
    fn extend(&mut self, kind: impl IntoIterator<Item = MeshProblem>) {
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

    fn done(self) -> Result<(), Vec<MeshProblem>> {
        if self.problems.is_empty() { Ok(()) } else { Err(self.problems) }
    }
}
