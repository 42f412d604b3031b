//! A half from its parts: meshes, pieces, balls, cones, boxes and extruded profiles, each at its position.
//!
//! ```text
//! PartSpec, file ──shape──▶ closed surfaces ──axis, rotate, at──▶ the solids of the half
//! ```
//!
//! Parts may overlap and touch, as a pin does with its plate: they are united afterwards (`mesh::union`).
//! Round surfaces become facets with their corners on the surface, so that a ball is never too large, and too
//! small by at most its chord error.
//!
//! Not promised: a message about a part that touches no other.

mod prism;
mod round;

use super::mesh::{self, MAX_TRIANGLES, MeshProblem};
use super::outline::{self, OutlineProblem};
use super::source::{self, FileBytes};
use super::{GeometryDefect, Half, HalfRole, HullError, Size, Surface, SurfaceError, convex_hull, place};
use catchment_base::exec::Exec;
use catchment_base::terminal::shown;
use catchment_design::design::{FileSpec, MeshContent, OutlineSpec, PartSpec, ShapeSpec};
use glam::DVec2;
use std::path::PathBuf;

pub(super) use outline::MOST_BYTES as MOST_BYTES_OF_A_DRAWING;
#[cfg(test)]
pub(super) use prism::extruded;

/// Reason why a part is invalid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PartGeometryError {
    /// An invalid mesh file.
    #[error("{}: {error}", shown(path))]
    Mesh {
        /// The file.
        path: PathBuf,
        /// Why not.
        error: MeshProblem,
    },
    /// Outlines that bound nothing.
    #[error("{}{error}", path.as_ref().map_or_else(String::new, |path| format!("{}: ", shown(path))))]
    Outline {
        /// The file, if the mesh comes from a file.
        path: Option<PathBuf>,
        /// Why not.
        error: OutlineProblem,
    },
    /// An invalid convex piece.
    #[error("piece {piece}: {error}")]
    Piece {
        /// Which piece, from 0.
        piece: usize,
        /// Why not.
        error: HullError,
    },
    /// A chord error so small that there would be too many facets, or as large as the part.
    #[error(
        "the chord error {chord_error:.2e} D does not suit a radius of {radius:.2e} D: give one between {least:.2e} D and the radius"
    )]
    Chord {
        /// The chord error, in D.
        chord_error: f64,
        /// The radius, in D.
        radius: f64,
        /// The smallest that is possible, in D.
        least: f64,
    },
    /// Facets that do not close.
    #[error("{0}: it is too thin to be a solid")]
    Surface(#[from] SurfaceError),
}

/// The solids of all parts, and the content of their files.
pub(super) fn half(
    parts: &[(PartSpec, Option<FileBytes>)],
    side: HalfRole,
    size: Size,
    exec: &Exec,
) -> Result<(Half, Vec<MeshContent>), Vec<GeometryDefect>> {
    let (mut half, mut contents, mut problems) = (Half::default(), Vec::new(), Vec::new());
    for (number, (spec, file)) in parts.iter().enumerate() {
        let frame = place::part(spec);
        match shape(&spec.shape, file.as_ref(), exec) {
            Ok((built, content)) => {
                half.surfaces.extend(built.mapped(|p| frame.transform_point3(p)).surfaces);
                contents.extend(content);
            }
            Err(errors) => {
                problems.extend(errors.into_iter().map(|error| GeometryDefect::Part {
                    side,
                    part: number,
                    error,
                }));
            }
        }
    }
    if problems.is_empty() {
        let count = half.surfaces.iter().map(|surface| surface.facets.len()).sum::<usize>() as u64;
        let too_many = (count > MAX_TRIANGLES as u64).then_some(MeshProblem::TooMany { count });
        let corners = half.surfaces.iter().flat_map(|surface| &surface.vertices).copied();
        let implausible = || (size == Size::Plausible).then(|| mesh::implausible_width(corners)).flatten();
        let error = too_many.or_else(implausible);
        problems.extend(error.map(|error| GeometryDefect::Triangles { side, error }));
    }
    if problems.is_empty() { Ok((half, contents)) } else { Err(problems) }
}

/// A part in its own coordinates, and the content of its file.
fn shape(
    shape: &ShapeSpec,
    file: Option<&FileBytes>,
    exec: &Exec,
) -> Result<(Half, Option<MeshContent>), Vec<PartGeometryError>> {
    let alone = |surface: Result<Surface, PartGeometryError>| {
        surface.map(|surface| (Half::of(vec![surface]), None)).map_err(|error| vec![error])
    };
    match shape {
        ShapeSpec::Mesh(spec) => {
            let refused = |error| PartGeometryError::Mesh { path: spec.path.clone(), error };
            let refuse = |errors: Vec<MeshProblem>| errors.into_iter().map(refused).collect::<Vec<_>>();
            let file = file.ok_or_else(|| refuse(vec![MeshProblem::NoFile]))?;
            let (half, content, _) = source::read_mesh(spec, file, mesh::part, exec).map_err(refuse)?;
            Ok((half, Some(content)))
        }
        ShapeSpec::Pieces(pieces) => {
            let hull = |(piece, points): (usize, &Vec<_>)| {
                convex_hull(points).map_err(|error| PartGeometryError::Piece { piece, error })
            };
            let surfaces: Vec<_> = source::points(pieces).iter().enumerate().map(hull).collect();
            let errors: Vec<_> = surfaces.iter().filter_map(|hull| hull.as_ref().err().cloned()).collect();
            if !errors.is_empty() {
                return Err(errors);
            }
            Ok((Half::of(surfaces.into_iter().flatten().collect()), None))
        }
        ShapeSpec::Sphere { radius, chord_error } => alone(round::sphere(*radius, *chord_error)),
        ShapeSpec::Cone { radius, top_radius, height, chord_error } => {
            alone(round::cone([*radius, *top_radius], *height, *chord_error))
        }
        ShapeSpec::Box { size } => alone(prism::cuboid(*size)),
        ShapeSpec::Profile { outline, height, chord_error } => {
            profile(outline, *height, *chord_error, file).map_err(|error| vec![error])
        }
    }
}

fn profile(
    outline: &OutlineSpec,
    height: f64,
    chord_error: f64,
    file: Option<&FileBytes>,
) -> Result<(Half, Option<MeshContent>), PartGeometryError> {
    let path = match outline {
        OutlineSpec::Corners(_) => None,
        OutlineSpec::File(FileSpec { path, .. }) => Some(path.clone()),
    };
    let refused = |error| PartGeometryError::Outline { path: path.clone(), error };
    let (loops, content) = match outline {
        OutlineSpec::Corners(corners) => {
            (vec![corners.iter().copied().map(DVec2::from_array).collect()], None)
        }
        OutlineSpec::File(spec) => {
            let file = file.ok_or_else(|| refused(OutlineProblem::NoFile))?;
            let outline::DrawnLoops { loops, hidden } =
                outline::read(spec, file, chord_error).map_err(refused)?;
            let corners = loops.iter().map(Vec::len).sum();
            (loops, Some(MeshContent { hidden, ..MeshContent::of(&file.bytes, corners) }))
        }
    };
    let regions = outline::regions(loops).map_err(refused)?;
    let extruded = regions.iter().map(|region| prism::extruded(region, height).map_err(&refused));
    let surfaces = extruded.collect::<Result<Vec<_>, _>>()?;
    Ok((Half::of(surfaces), content))
}
