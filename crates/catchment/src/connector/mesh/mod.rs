//! A closed triangle mesh as half of a connector: from loose triangles to a [`Surface`], or to every reason why they are none.
//!
//! ```text
//! triangles, each with its place ──weld──▶ corners shared ──check──▶ [repair] ──▶ [simplify] ──▶ Surface, in D
//! ```
//!
//! Every source of triangles comes through here, the files of the sources as well as triangles in memory. Corners closer
//! than [`WELD`] of the model's size are one, and an edge is divided where a corner of its neighbours lies on it as nearly. The winding counts,
//! counter-clockwise seen from outside. A mesh that is then closed, wound outward and free of self-intersections is taken as it is. Another one is
//! repaired where the [`Treatment`] allows it, and what was done is told; if that leaves anything, every reason
//! against it is reported with its place. Coordinates in messages are those of the source. Triangles in memory are never repaired.
//!
//! Not promised: holes are not closed, and coplanar overlaps of separate shells are not looked for.

mod check;
mod crossing;
pub(in crate::connector) mod cut;
mod deviation;
mod divide;
mod indexed;
mod point;
mod repair;
mod shells;
mod sides;
mod simplify;
mod tree;

pub use point::Point;

use super::source::UnitProblem;
use super::{Half, Surface};
use crate::design::{LengthUnit, Repairs, Treatment};
use crate::exec::{Bytes, Exec};
use glam::DVec3;
use indexed::Indexed;
use std::fmt;

/// Most triangles of a half as it is used: the largest for which a motion was measured to take seconds rather than minutes. Docking faces need
/// hundreds, as CAD exports them ten thousands.
pub const MAX_TRIANGLES: usize = 200_000;
/// Most triangles of a file that is simplified: measured to take a minute and a half and 3.3 GiB.
pub const MOST_READ: usize = 5_000_000;
/// Bytes that reading, repairing and simplifying take for each triangle, as measured.
const BYTES_PER_TRIANGLE: u64 = 900;
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
    /// In no file: the triangle was made when the mesh was repaired.
    Made,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.start {
            Start::Line(line) => write!(f, "triangle {} (line {line})", self.triangle),
            Start::Byte(byte) => write!(f, "triangle {} (byte {byte})", self.triangle),
            Start::Memory => write!(f, "triangle {}", self.triangle),
            Start::Made => write!(f, "triangle {} of the repaired mesh", self.triangle),
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
    /// More triangles than one half may have, although it was simplified.
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
        /// How far the surface may move, in D.
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
        "the border of the face that triangle {triangle} begins, at {at}, crosses itself, or has no area: triangulate the mesh when it is exported"
    )]
    NotSimple {
        /// The number that its first triangle would have.
        triangle: usize,
        /// Its first corner.
        at: Point,
    },
    /// A file without triangles.
    #[error("the file holds no triangles")]
    NoTriangles,
    /// A coordinate that is no number.
    #[error("{place} has a corner that is not finite, {at}")]
    NotFinite {
        /// Which triangle.
        place: Place,
        /// The corner.
        at: Point,
    },
    /// A triangle without area.
    #[error("{place} at {at} has no area: its corners fall together or lie on a line")]
    ZeroArea {
        /// Which triangle.
        place: Place,
        /// One of its corners.
        at: Point,
    },
    /// An edge with a triangle on one side only.
    #[error("the mesh is open along the edge of {place} from {from} to {to}: close the hole")]
    Open {
        /// The triangle on the one side.
        place: Place,
        /// One end.
        from: Point,
        /// The other end.
        to: Point,
    },
    /// An edge with more than two triangles.
    #[error(
        "{count} triangles meet along the edge from {from} to {to}: separate or join the solids that touch there"
    )]
    NonManifold {
        /// How many.
        count: usize,
        /// One end.
        from: Point,
        /// The other end.
        to: Point,
    },
    /// Two neighbours wound in opposite senses.
    #[error("{first} and {second} are wound in opposite senses at {at}: unify the normals")]
    Winding {
        /// One of them.
        first: Place,
        /// The other.
        second: Place,
        /// The middle of the edge between them.
        at: Point,
    },
    /// The mesh, or a part of it that lies in no other, is wound inward.
    #[error("the mesh is turned inside out at {at}: flip its normals")]
    InsideOut {
        /// One of its corners.
        at: Point,
    },
    /// Two triangles cross.
    #[error("{first} and {second} cross near {at}: unite the solids before exporting")]
    SelfIntersection {
        /// One of them.
        first: Place,
        /// The other.
        second: Place,
        /// Where.
        at: Point,
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

/// Most triangles that are read.
pub(super) const fn most_read(treatment: Treatment) -> usize {
    if treatment.simplify.is_some() { MOST_READ } else { MAX_TRIANGLES }
}

/// What there is to say of more.
pub(super) const fn too_many(treatment: Treatment, count: u64) -> MeshProblem {
    if treatment.simplify.is_some() {
        MeshProblem::TooManyToSimplify { count }
    } else {
        MeshProblem::TooMany { count }
    }
}

/// A half, or a part of one, and what was done to its meshes.
#[derive(Debug)]
pub(super) struct Ready {
    pub(super) half: Half,
    pub(super) repairs: Repairs,
}

/// The triangles of a file of faces, numbered in their order.
#[derive(Debug)]
pub(super) struct Triangles {
    pub(super) list: Vec<Triangle>,
    treatment: Treatment,
}

impl Triangles {
    /// None yet.
    pub(super) const fn new(treatment: Treatment) -> Self {
        Self { list: Vec::new(), treatment }
    }

    /// Appends a face, cut into triangles.
    pub(super) fn push(&mut self, corners: &[DVec3]) -> Result<(), Vec<MeshProblem>> {
        // A triangle is what it is; whether it has an area, and whether all are numbers, is asked of all of them together.
        let cut = if corners.len() == 3 || !corners.iter().all(|corner| corner.is_finite()) {
            Some(vec![[0, 1, 2]])
        } else {
            cut::triangles(corners)
        };
        let first = self.list.len();
        let at = corners.first().copied().unwrap_or_default().into();
        let cut = cut.ok_or_else(|| vec![MeshProblem::NotSimple { triangle: first, at }])?;
        self.list.extend(cut.into_iter().enumerate().map(|(k, ids)| Triangle {
            corners: ids.map(|id| corners[id]),
            place: Place { triangle: first + k, start: Start::Memory },
        }));
        if self.list.len() > most_read(self.treatment) {
            return Err(vec![too_many(self.treatment, self.list.len() as u64)]);
        }
        Ok(())
    }
}

/// A half from triangles (in D), by the rules of every mesh file; they are taken as they are.
///
/// # Errors
/// Everything that is wrong with the mesh, at most a few problems of each kind, by the number of the triangle.
pub fn from_triangles(triangles: &[[DVec3; 3]]) -> Result<Half, Vec<MeshProblem>> {
    let placed = |(triangle, &corners)| Triangle { corners, place: Place { triangle, start: Start::Memory } };
    let triangles: Vec<Triangle> = triangles.iter().enumerate().map(placed).collect();
    half(vec![triangles], 1.0, Treatment::AS_IT_IS).map(|ready| ready.half)
}

/// A half from the triangles of a file, body by body, treated as it is said; `scale` turns its coordinates into D.
pub(super) fn half(
    bodies: Vec<Vec<Triangle>>,
    scale: f64,
    treatment: Treatment,
) -> Result<Ready, Vec<MeshProblem>> {
    check_scale(scale)?;
    let corners = bodies.iter().flatten().flat_map(|triangle| triangle.corners);
    let width = implausible_width(corners.map(|c| c * scale));
    let (ready, mut problems) = match part(bodies, scale, treatment) {
        Ok(ready) => (Some(ready), Vec::new()),
        Err(problems) => (None, problems),
    };
    // Without numbers there is no width.
    let is_sized = !problems.iter().any(|problem| {
        use MeshProblem::{NoTriangles, NotFinite, TooMany, TooManyToSimplify};
        matches!(problem, NotFinite { .. } | NoTriangles | TooMany { .. } | TooManyToSimplify { .. })
    });
    problems.extend(width.filter(|_| is_sized));
    ready.filter(|_| problems.is_empty()).ok_or(problems)
}

/// The same of a part of a half, which may have any size.
pub(super) fn part(
    bodies: Vec<Vec<Triangle>>,
    scale: f64,
    treatment: Treatment,
) -> Result<Ready, Vec<MeshProblem>> {
    check_scale(scale)?;
    let count = bodies.iter().map(Vec::len).sum::<usize>();
    if count > most_read(treatment) {
        return Err(vec![too_many(treatment, count as u64)]);
    }
    sound_numbers(&bodies)?;
    let mut ready = Ready { half: Half::default(), repairs: Repairs::default() };
    let mut problems = Vec::new();
    for body in bodies.into_iter().filter(|body| !body.is_empty()) {
        match solid(body, scale, treatment) {
            Ok((surface, repairs)) => {
                ready.half.surfaces.push(surface);
                ready.repairs.add(&repairs);
            }
            Err(found) => problems.extend(found),
        }
        if problems.len() > MAX_REPORTED * MAX_REPORTED {
            break;
        }
    }
    if problems.is_empty() { Ok(ready) } else { Err(problems) }
}

/// Complains about a half whose width in D can hardly be meant.
pub(super) fn implausible_width(corners: impl Iterator<Item = DVec3>) -> Option<MeshProblem> {
    let (lo, hi) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let width = (hi - lo).truncate().max_element();
    (!PLAUSIBLE_WIDTH.contains(&width)).then_some(MeshProblem::Unit { width })
}

/// A closed surface from the triangles of one body, and what was done to it.
fn solid(
    triangles: Vec<Triangle>,
    scale: f64,
    treatment: Treatment,
) -> Result<(Surface, Repairs), Vec<MeshProblem>> {
    fits(triangles.len())?;
    let (mut mesh, sides) = Indexed::of(triangles);
    let mut problems = check::problems(&mesh, &sides);
    drop(sides);
    let mut repairs = Repairs::default();
    if treatment.repair && !problems.is_empty() {
        let mended = repair::mended(&mesh);
        problems = mended.problems;
        if problems.is_empty() {
            (mesh, repairs) = (mended.mesh, mended.repairs);
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    if let Some(most) = treatment.simplify {
        let simplified = simplify::simplified(&mesh, most / scale, scale)?;
        repairs.simplified = Some([mesh.triangles.len(), simplified.mesh.triangles.len()]);
        // Both moved it, one after the other.
        repairs.deviation += simplified.deviation;
        mesh = simplified.mesh;
    }
    repairs.deviation *= scale;
    if mesh.triangles.len() > MAX_TRIANGLES {
        return Err(vec![MeshProblem::TooManyLeft { count: mesh.triangles.len() }]);
    }
    Ok((check::surface(&mesh, scale)?, repairs))
}

/// Refuses a large mesh for which there is too little memory.
fn fits(count: usize) -> Result<(), Vec<MeshProblem>> {
    let (needed, budget) = (BYTES_PER_TRIANGLE * count as u64, Exec::new().memory_budget());
    if count <= MAX_TRIANGLES || needed <= budget {
        return Ok(());
    }
    Err(vec![MeshProblem::Memory { count, needed: Bytes(needed), budget: Bytes(budget) }])
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
            .filter_map(|t| Some((t, t.corners.iter().find(|corner| !corner.is_finite())?)))
            .map(|(t, corner)| MeshProblem::NotFinite { place: t.place, at: (*corner).into() }),
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

#[cfg(test)]
mod tests;
