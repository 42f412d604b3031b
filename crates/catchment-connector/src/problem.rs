//! Defects of a geometry, with their places and advice.

use super::mesh::MeshProblem;
use super::{HullError, PartGeometryError, SurfaceError, UnionProblem};
use catchment_base::terminal::shown;
use std::fmt;
use std::path::PathBuf;

/// Which half a problem lies in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HalfRole {
    /// The fixed half.
    Fixed,
    /// The moving half.
    Moving,
}

impl fmt::Display for HalfRole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fixed => "fixed half",
            Self::Moving => "moving half",
        })
    }
}

/// Reason why a design's geometry cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryDefect {
    /// A family's parameter makes no solid.
    #[error("{family}: {parameter} = {value}: {advice}")]
    Parameter {
        /// The family's name.
        family: &'static str,
        /// The parameter's name in the design file.
        parameter: &'static str,
        /// Its value, in D or radians.
        value: f64,
        /// The requirement on it.
        advice: String,
    },
    /// Polygons that do not bound a solid.
    #[error("{side}, surface {surface}: {error}")]
    Surface {
        /// Which half.
        side: HalfRole,
        /// Which of its surfaces, from 0.
        surface: usize,
        /// Why not.
        error: SurfaceError,
    },
    /// No convex pieces, or too many.
    #[error("{side}: {count} convex pieces; give between 1 and {most}, or an STL mesh")]
    PieceCount {
        /// Which half.
        side: HalfRole,
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// An invalid convex piece.
    #[error("{side}, piece {piece}: {error}")]
    Piece {
        /// Which half.
        side: HalfRole,
        /// Which piece, from 0.
        piece: usize,
        /// Why not.
        error: HullError,
    },
    /// A mesh file that is no half.
    #[error("{side}, {}: {error}", shown(path))]
    Mesh {
        /// Which half.
        side: HalfRole,
        /// The file.
        path: PathBuf,
        /// Why not.
        error: MeshProblem,
    },
    /// An invalid part.
    #[error("{side}, part {part}: {error}")]
    Part {
        /// Which half.
        side: HalfRole,
        /// Which part, from 0.
        part: usize,
        /// Why not.
        error: PartGeometryError,
    },
    /// Solids that have no union.
    #[error("{side}: {error}")]
    Union {
        /// Which half.
        side: HalfRole,
        /// Why not.
        error: UnionProblem,
    },
    /// Triangles in memory, or of all parts together, that are no half.
    #[error("{side}: {error}")]
    Triangles {
        /// Which half.
        side: HalfRole,
        /// Why not.
        error: MeshProblem,
    },
    /// A design that stores only a description of a half, not its geometry.
    #[error("{side}: it was given in memory, so the design does not hold it: give it again")]
    NotInDesign {
        /// Which half.
        side: HalfRole,
    },
}
