//! Where a half comes from: a family, convex pieces, the bytes of a mesh file, or triangles in memory.
//!
//! ```text
//! HalfSpec ──of, reading files──▶ Source ──build──▶ Half, and what the mesh held
//!                                   ▲
//!            a program's own triangles, no file
//! ```
//!
//! Files are read by whatever the caller gives as [`Read`]; [`disk`] is the one place of the room that touches a file
//! system. A mesh format is one entry of [`FORMATS`].

mod content;
pub(super) mod disk;
mod foreign;

use super::mesh::{self, MAX_TRIANGLES, MeshProblem, Reading, Ready};
use super::{Half, Problem, Side, Surface, convex_hull, family, obj, ply, stl};
use crate::design::{FamilySpec, HalfSpec, LengthUnit, MeshContent, Treatment};
use glam::DVec3;
use std::io;
use std::path::{Path, PathBuf};

/// Most convex pieces of a half: beyond it a mesh says the same with less.
const MAX_PIECES: usize = 256;

/// A file, or as much of it as may be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileBytes {
    /// Its first bytes.
    pub bytes: Vec<u8>,
    /// Size of the whole file, in bytes.
    pub size: u64,
}

impl FileBytes {
    /// A file that is here as a whole.
    pub const fn whole(bytes: Vec<u8>) -> Self {
        let size = bytes.len() as u64;
        Self { bytes, size }
    }
}

/// Gives the first bytes of a file, at most as many as the second argument says.
pub type Read<'a> = &'a dyn Fn(&Path, u64) -> io::Result<FileBytes>;

/// A format of mesh files.
struct Format {
    /// How its files end, in lower case.
    endings: &'static [&'static str],
    /// From bytes to a closed surface in D.
    read: fn(&FileBytes, &Reading) -> Result<Ready, Vec<MeshProblem>>,
    /// What the first bytes of a file say of it as a whole.
    refuse_early: fn(&FileBytes, &Reading) -> Result<(), Vec<MeshProblem>>,
}

/// The table of mesh formats. A file whose ending none of them has is read as the first.
const FORMATS: [Format; 3] = [
    Format { endings: &["stl"], read: stl::read, refuse_early: stl::refuse_early },
    Format { endings: &["obj"], read: obj::read, refuse_early: |_, _| Ok(()) },
    Format { endings: &["ply"], read: ply::read, refuse_early: |_, _| Ok(()) },
];

/// Bytes beyond which a file cannot be an acceptable mesh: no more are read.
pub(super) const fn most_bytes(reading: &Reading) -> u64 {
    if reading.treatment.simplify.is_some() { stl::MOST_BYTES } else { stl::MAX_BYTES }
}

/// Bytes that are read before a format may refuse a file: a binary STL file of as many triangles as a half may have, which all but few files are below.
const FIRST_BYTES: u64 = 84 + 50 * MAX_TRIANGLES as u64;

impl Format {
    fn of(path: &Path) -> &'static Self {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let has = |format: &&Self| ending.as_ref().is_some_and(|e| format.endings.contains(&e.as_str()));
        FORMATS.iter().find(has).unwrap_or(&FORMATS[0])
    }
}

/// One half, drawn facing +z, before it is built.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// The half that a family has on this side.
    Family(FamilySpec),
    /// Convex pieces whose union is the half, each a list of vertices in D.
    Pieces(Vec<Vec<DVec3>>),
    /// A mesh file.
    Mesh {
        /// What messages call it; its ending tells the format.
        path: PathBuf,
        /// What it holds.
        file: FileBytes,
        /// Multiplies the file's coordinates to give D.
        scale: f64,
        /// Unit of those coordinates, which messages say.
        unit: Option<LengthUnit>,
        /// What may be done to the mesh.
        treatment: Treatment,
    },
    /// Loose triangles that bound the half, corners in D, counter-clockwise seen from outside.
    Triangles(Vec<[DVec3; 3]>),
    /// A closed surface, in D.
    Surface(Surface),
}

impl Source {
    /// What a design says of a half, its mesh file read.
    pub(super) fn of(spec: &HalfSpec, side: Side, read: Read<'_>) -> Result<Self, Problem> {
        match spec {
            HalfSpec::Pieces(pieces) => Ok(Self::Pieces(
                pieces.iter().map(|piece| piece.iter().copied().map(DVec3::from_array).collect()).collect(),
            )),
            HalfSpec::Mesh { path, scale, unit, treatment, .. } => {
                let reading = Reading { scale: *scale, treatment: *treatment };
                let refused = |error| Problem::Mesh { side, path: path.clone(), error };
                match file(path, &reading, read) {
                    Ok(file) => Ok(Self::Mesh {
                        path: path.clone(),
                        file,
                        scale: *scale,
                        unit: *unit,
                        treatment: *treatment,
                    }),
                    Err(problem) => Err(refused(problem)),
                }
            }
            HalfSpec::Memory { .. } => Err(Problem::NotInDesign { side }),
        }
    }

    /// The solid, and what the mesh held where it is one.
    pub(super) fn build(&self, side: Side) -> Result<(Half, Option<MeshContent>), Vec<Problem>> {
        match self {
            Self::Family(spec) => {
                let drawn = family::draw(spec)?;
                Ok((if side == Side::Fixed { drawn.fixed } else { drawn.moving }, None))
            }
            Self::Pieces(pieces) => Ok((from_pieces(pieces, side)?, None)),
            Self::Mesh { path, file, scale, unit, treatment } => {
                let refused = |error: MeshProblem| Problem::Mesh {
                    side,
                    path: path.clone(),
                    error: error.in_unit(*unit),
                };
                let reading = Reading { scale: *scale, treatment: *treatment };
                let Ready { surface, repairs } = foreign::refuse(&file.bytes)
                    .and_then(|()| (Format::of(path).read)(file, &reading))
                    .map_err(|problems| problems.into_iter().map(refused).collect::<Vec<_>>())?;
                let content = MeshContent { repairs, ..MeshContent::of(&file.bytes, surface.facets.len()) };
                Ok((Half { surfaces: vec![surface] }, Some(content)))
            }
            Self::Triangles(triangles) => {
                let refused = |error| Problem::Triangles { side, error };
                let surface = mesh::from_triangles(triangles)
                    .map_err(|problems| problems.into_iter().map(refused).collect::<Vec<_>>())?;
                Ok((Half { surfaces: vec![surface] }, Some(content::of_triangles(triangles))))
            }
            Self::Surface(surface) => {
                let content = content::of_surface(surface);
                Ok((Half { surfaces: vec![surface.clone()] }, Some(content)))
            }
        }
    }
}

/// As much of a mesh file as may be read; of a large one the beginning first.
fn file(path: &Path, reading: &Reading, read: Read<'_>) -> Result<FileBytes, MeshProblem> {
    let unreadable = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => MeshProblem::NoFile,
        _ => MeshProblem::Io { message: error.to_string() },
    };
    let first = read(path, FIRST_BYTES).map_err(unreadable)?;
    if first.size <= first.bytes.len() as u64 {
        return Ok(first);
    }
    let refused =
        foreign::refuse(&first.bytes).and_then(|()| (Format::of(path).refuse_early)(&first, reading));
    if let Some(problem) = refused.err().and_then(|problems| problems.into_iter().next()) {
        return Err(problem);
    }
    drop(first);
    read(path, most_bytes(reading)).map_err(unreadable)
}

fn from_pieces(pieces: &[Vec<DVec3>], side: Side) -> Result<Half, Vec<Problem>> {
    if pieces.is_empty() || pieces.len() > MAX_PIECES {
        return Err(vec![Problem::PieceCount { side, count: pieces.len(), most: MAX_PIECES }]);
    }
    let mut half = Half::default();
    let mut problems = Vec::new();
    for (piece, points) in pieces.iter().enumerate() {
        match convex_hull(points) {
            Ok(surface) => half.surfaces.push(surface),
            Err(error) => problems.push(Problem::Piece { side, piece, error }),
        }
    }
    if problems.is_empty() { Ok(half) } else { Err(problems) }
}

#[cfg(test)]
mod tests;
