//! The person's own halves: convex pieces and STL meshes.

use super::family::Drawn;
use super::{Half, Problem, Side, convex_hull, stl};
use crate::design::{HalfSpec, OwnSpec};
use glam::DVec3;

/// Most convex pieces of a half: beyond it a mesh says the same with less.
const MAX_PIECES: usize = 256;

/// Builds both halves, or says everything that is wrong with either.
pub(super) fn build(spec: &OwnSpec) -> Result<Drawn, Vec<Problem>> {
    match (half(&spec.fixed, Side::Fixed), half(&spec.moving, Side::Moving)) {
        (Ok(fixed), Ok(moving)) => Ok(Drawn { fixed, moving, face_height: spec.face_height }),
        (fixed, moving) => Err([fixed, moving].into_iter().filter_map(Result::err).flatten().collect()),
    }
}

fn half(spec: &HalfSpec, side: Side) -> Result<Half, Vec<Problem>> {
    match spec {
        HalfSpec::Pieces(pieces) => from_pieces(pieces, side),
        HalfSpec::Mesh { path, scale } => match stl::read(path, *scale) {
            Ok(surface) => Ok(Half { surfaces: vec![surface] }),
            Err(problems) => Err(problems
                .into_iter()
                .map(|error| Problem::Stl { side, path: path.clone(), error })
                .collect()),
        },
    }
}

fn from_pieces(pieces: &[Vec<[f64; 3]>], side: Side) -> Result<Half, Vec<Problem>> {
    if pieces.is_empty() || pieces.len() > MAX_PIECES {
        return Err(vec![Problem::PieceCount { side, count: pieces.len(), most: MAX_PIECES }]);
    }
    let mut half = Half::default();
    let mut problems = Vec::new();
    for (piece, points) in pieces.iter().enumerate() {
        let points: Vec<DVec3> = points.iter().copied().map(DVec3::from_array).collect();
        match convex_hull(&points) {
            Ok(surface) => half.surfaces.push(surface),
            Err(error) => problems.push(Problem::Piece { side, piece, error }),
        }
    }
    if problems.is_empty() { Ok(half) } else { Err(problems) }
}
