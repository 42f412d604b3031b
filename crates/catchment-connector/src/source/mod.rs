//! Sources of a half: a family, convex pieces, the bytes of a mesh file, parts, or triangles in memory.
//!
//! ```text
//! HalfSpec ──of, reading files──▶ Source ──build──▶ Half, and the mesh contents
//!                                   ▲
//!            a program's own triangles, no file
//! ```
//!
//! The caller provides a [`Read`] to read files; only [`disk`] uses a file system. Each mesh format is an
//! entry of [`FORMATS`].

mod content;
pub(super) mod disk;
mod foreign;
pub(super) mod unit;

pub(super) use foreign::ZIP;
pub use unit::UnitProblem;
pub(super) use unit::scale;

use super::mesh::{self, MAX_TRIANGLES, MeshProblem, Ready, Triangle};
use super::{
    GeometryDefect, Half, HalfRole, Size, Surface, convex_hull, family, obj, part, ply, step, stl, threemf,
};
use catchment_base::exec::Exec;
use catchment_design::design::{
    FamilySpec, FileSpec, FilesInMemory, HalfSpec, MeshContent, MeshPreparation, Meshed, PartSpec, ShapeSpec,
};
use glam::DVec3;
use std::io;
use std::path::Path;

/// Largest number of convex pieces of a half: beyond it use a mesh.
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

/// Returns the first bytes of a file, at most as many as the second argument.
pub type FileReader<'a> = &'a dyn Fn(&Path, u64) -> io::Result<FileBytes>;

/// Reads files that are in memory, and all others from disk.
pub(super) fn beside(files: &FilesInMemory) -> impl Fn(&Path, u64) -> io::Result<FileBytes> {
    move |path, most| match files.get(path) {
        Some(bytes) => {
            let most = bytes.len().min(usize::try_from(most).unwrap_or(usize::MAX));
            Ok(FileBytes { bytes: bytes[..most].to_vec(), size: bytes.len() as u64 })
        }
        None => disk::read(path, most),
    }
}

/// Content of a mesh file.
#[derive(Debug, Clone)]
pub(super) struct FileContent {
    /// The triangles of every body that the file distinguishes.
    pub(super) bodies: Vec<Vec<Triangle>>,
    /// Metres per unit of its coordinates, if it states a unit.
    pub(super) metres: Option<f64>,
    /// Origin of its triangles, if the file itself contains none.
    pub(super) curves: Option<step::FromCurves>,
}

impl FileContent {
    /// Content of a file without separate bodies and without a unit.
    pub(super) fn of_triangles(triangles: Vec<Triangle>) -> Self {
        Self { bodies: vec![triangles], metres: None, curves: None }
    }
}

/// A format of mesh files.
struct Format {
    /// How its files end, in lower case.
    endings: &'static [&'static str],
    /// Parses the bytes of a file.
    read: fn(&FileBytes, &FileSpec, &Exec) -> Result<FileContent, Vec<MeshProblem>>,
    /// Checks the first bytes of a file before the rest is read.
    refuse_early: fn(&FileBytes, MeshPreparation) -> Result<(), Vec<MeshProblem>>,
}

/// The table of mesh formats. A file with an unknown extension is read as the first.
const FORMATS: [Format; 5] = [
    Format {
        endings: &["stl"],
        read: |file, spec, _| stl::read(file, spec.treatment),
        refuse_early: stl::refuse_early,
    },
    Format {
        endings: &["obj"],
        read: |file, spec, _| obj::read(file, spec.treatment),
        refuse_early: refuse_long,
    },
    Format {
        endings: &["ply"],
        read: |file, spec, _| ply::read(file, spec.treatment),
        refuse_early: refuse_long,
    },
    Format { endings: &["3mf"], read: |file, _, _| threemf::read(file), refuse_early: |_, _| Ok(()) },
    Format { endings: &["step", "stp"], read: step::read, refuse_early: refuse_long },
];

/// Bytes beyond which a file cannot be an acceptable mesh: no more are read.
pub(super) const fn most_bytes(treatment: MeshPreparation) -> u64 {
    if treatment.simplify.is_some() { stl::MOST_BYTES } else { stl::MAX_BYTES }
}

/// Refuses a file that is longer than any acceptable mesh.
fn refuse_long(file: &FileBytes, treatment: MeshPreparation) -> Result<(), Vec<MeshProblem>> {
    let most = most_bytes(treatment);
    if file.size > most { Err(vec![MeshProblem::TooLong { bytes: file.size, most }]) } else { Ok(()) }
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

/// A half that was built, and its origin.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Built {
    /// The solid.
    pub(super) half: Half,
    /// Content of its files, or description of the triangles given in memory.
    pub(super) contents: Vec<MeshContent>,
    /// Factor from the coordinates of its file to D; `None` unless it is a single file.
    pub(super) scale: Option<f64>,
}

impl Built {
    const fn of(half: Half, contents: Vec<MeshContent>) -> Self {
        Self { half, contents, scale: None }
    }
}

/// Builds a half, or a part of a half, from the triangles of every body and their scale.
type BuildMesh = fn(Vec<Vec<Triangle>>, f64, MeshPreparation) -> Result<Ready, Vec<MeshProblem>>;

/// A mesh file as a half or a part of a half, its content, and its scale.
pub(super) fn read_mesh(
    spec: &FileSpec,
    file: &FileBytes,
    build: BuildMesh,
    exec: &Exec,
) -> Result<(Half, MeshContent, f64), Vec<MeshProblem>> {
    let format = Format::of(&spec.path);
    let read = || {
        foreign::refuse(&file.bytes, format.endings)?;
        let held = (format.read)(file, spec, exec)?;
        let scale = scale(spec, held.metres).map_err(|problem| vec![problem.into()])?;
        build(held.bodies, scale, spec.treatment).map(|ready| (ready, scale, held.curves))
    };
    let in_unit = |problem: MeshProblem| problem.in_unit(spec.written);
    let (Ready { half, triangles, repairs }, scale, curves) =
        read().map_err(|problems| problems.into_iter().map(in_unit).collect::<Vec<_>>())?;
    let bodies = half.surfaces.len();
    let meshed = curves.map(|step::FromCurves { deflection, reached, by, sha256 }| {
        Box::new(Meshed { deflection: deflection * scale, reached: reached * scale, by, sha256 })
    });
    Ok((half, MeshContent { bodies, repairs, meshed, ..MeshContent::of(&file.bytes, triangles) }, scale))
}

/// The readable part of a mesh file; of a large file the beginning first.
fn fetch_mesh(spec: &FileSpec, read: FileReader<'_>) -> Result<FileBytes, MeshProblem> {
    let format = Format::of(&spec.path);
    let first = fetch(&spec.path, FIRST_BYTES, read)?;
    if first.size <= first.bytes.len() as u64 {
        return Ok(first);
    }
    let refused = foreign::refuse(&first.bytes, format.endings)
        .and_then(|()| (format.refuse_early)(&first, spec.treatment));
    if let Some(problem) = refused.err().and_then(|problems| problems.into_iter().next()) {
        return Err(problem);
    }
    drop(first);
    fetch(&spec.path, most_bytes(spec.treatment), read)
}

/// The bytes of a file, or the reason why they are not available.
fn fetch(path: &Path, most: u64, read: FileReader<'_>) -> Result<FileBytes, MeshProblem> {
    read(path, most).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => MeshProblem::NoFile,
        _ => MeshProblem::Io { message: error.to_string() },
    })
}

/// A half, drawn facing +z, before it is built.
#[derive(Debug, Clone, PartialEq)]
pub enum HalfSource {
    /// The half that a family has on this side.
    Family(FamilySpec),
    /// Convex pieces whose union is the half, each a list of vertices in D.
    Pieces(Vec<Vec<DVec3>>),
    /// A mesh file.
    Mesh {
        /// Its name in messages, the conversion of its coordinates to D, and its permitted changes; its
        /// extension determines the format.
        spec: FileSpec,
        /// Its content.
        file: FileBytes,
    },
    /// Parts, each with the content of its file if it comes from a file.
    Parts(Vec<(PartSpec, Option<FileBytes>)>),
    /// Loose triangles that bound the half, corners in D, counter-clockwise seen from outside.
    Triangles(Vec<[DVec3; 3]>),
    /// A closed surface, in D.
    Surface(Surface),
}

impl HalfSource {
    /// The source for a half of a design, with its files read.
    pub(super) fn of(
        spec: &HalfSpec,
        side: HalfRole,
        read: FileReader<'_>,
    ) -> Result<Self, Vec<GeometryDefect>> {
        match spec {
            HalfSpec::Pieces(pieces) => Ok(Self::Pieces(points(pieces))),
            HalfSpec::Mesh(spec) => match fetch_mesh(spec, read) {
                Ok(file) => Ok(Self::Mesh { spec: spec.clone(), file }),
                Err(error) => Err(vec![GeometryDefect::Mesh { side, path: spec.path.clone(), error }]),
            },
            HalfSpec::Parts(parts) => {
                let (mut read_parts, mut problems) = (Vec::new(), Vec::new());
                for (index, part) in parts.iter().enumerate() {
                    let fetched = |file: &FileSpec| match part.shape {
                        ShapeSpec::Profile { .. } => fetch(&file.path, part::MOST_BYTES_OF_A_DRAWING, read),
                        _ => fetch_mesh(file, read),
                    };
                    let file = part.shape.file().map(|file| {
                        fetched(file).map_err(|error| {
                            let path = file.path.clone();
                            GeometryDefect::Part {
                                side,
                                part: index,
                                error: part::PartGeometryError::Mesh { path, error },
                            }
                        })
                    });
                    match file.transpose() {
                        Ok(file) => read_parts.push((part.clone(), file)),
                        Err(problem) => problems.push(problem),
                    }
                }
                if problems.is_empty() { Ok(Self::Parts(read_parts)) } else { Err(problems) }
            }
            HalfSpec::Memory { .. } => Err(vec![GeometryDefect::NotInDesign { side }]),
        }
    }

    /// The solid, and the content of its files.
    pub(super) fn build(
        &self,
        side: HalfRole,
        size: Size,
        exec: &Exec,
    ) -> Result<Built, Vec<GeometryDefect>> {
        let built = self.solids(side, size, exec)?;
        // Files hold coordinates in single precision as a rule.
        let is_written = built.contents.is_empty();
        let exactness = if is_written { mesh::union::EXACT } else { mesh::union::SINGLE };
        let refused = |error| vec![GeometryDefect::Union { side, error }];
        let half = Half::united(built.half.surfaces, exactness, exec).map_err(refused)?;
        Ok(Built { half, ..built })
    }

    /// The solids as written, not united, and the content of their files.
    fn solids(&self, side: HalfRole, size: Size, exec: &Exec) -> Result<Built, Vec<GeometryDefect>> {
        match self {
            Self::Family(spec) => {
                let drawn = family::draw(spec)?;
                let half = if side == HalfRole::Fixed { drawn.fixed } else { drawn.moving };
                Ok(Built::of(half, Vec::new()))
            }
            Self::Pieces(pieces) => Ok(Built::of(from_pieces(pieces, side)?, Vec::new())),
            Self::Mesh { spec, file } => {
                let refused = |error| GeometryDefect::Mesh { side, path: spec.path.clone(), error };
                let (half, content, scale) =
                    read_mesh(spec, file, if size == Size::Any { mesh::part } else { mesh::half }, exec)
                        .map_err(|problems| problems.into_iter().map(refused).collect::<Vec<_>>())?;
                Ok(Built { half, contents: vec![content], scale: Some(scale) })
            }
            Self::Parts(parts) => {
                let (half, contents) = part::half(parts, side, size, exec)?;
                Ok(Built::of(half, contents))
            }
            Self::Triangles(triangles) => {
                let refused = |error| GeometryDefect::Triangles { side, error };
                let half = mesh::from_triangles(triangles)
                    .map_err(|problems| problems.into_iter().map(refused).collect::<Vec<_>>())?;
                Ok(Built::of(half, vec![content::of_triangles(triangles)]))
            }
            Self::Surface(surface) => {
                let content = content::of_surface(surface);
                Ok(Built::of(Half::of(vec![surface.clone()]), vec![content]))
            }
        }
    }
}

/// Pieces as points.
pub(super) fn points(pieces: &[Vec<[f64; 3]>]) -> Vec<Vec<DVec3>> {
    pieces.iter().map(|piece| piece.iter().copied().map(DVec3::from_array).collect()).collect()
}

fn from_pieces(pieces: &[Vec<DVec3>], side: HalfRole) -> Result<Half, Vec<GeometryDefect>> {
    if pieces.is_empty() || pieces.len() > MAX_PIECES {
        return Err(vec![GeometryDefect::PieceCount { side, count: pieces.len(), most: MAX_PIECES }]);
    }
    let mut half = Half::default();
    let mut problems = Vec::new();
    for (piece, points) in pieces.iter().enumerate() {
        match convex_hull(points) {
            Ok(surface) => half.surfaces.push(surface),
            Err(error) => problems.push(GeometryDefect::Piece { side, piece, error }),
        }
    }
    if problems.is_empty() { Ok(half) } else { Err(problems) }
}

#[cfg(test)]
mod tests;
