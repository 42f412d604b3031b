//! The separate bodies of a file: sets of connected triangles.
//!
//! ```text
//!   corners joined by triangles ──▶ pieces ──▶ a piece with its box inside another's belongs to that body ──▶ bodies, largest box first
//! ```
//!
//! Not guaranteed: pieces that touch at a corner are not separated, nor is a body inside the bounding box of
//! another.

use super::indexed::weld;
use super::{MeshProblem, Triangle, WELD, overspent};
use catchment_base::budget::Limit;
use catchment_base::disjoint::DisjointSets;
use glam::DVec3;
use std::collections::BTreeMap;

/// Pieces whose boxes are compared with each other.
const PIECES: Limit =
    Limit { most: 2000, of: "separate pieces", remedy: "unite the solids before exporting" };

/// The triangles of the body with this number, counted from 1, of all bodies of a file; all of them without a number.
///
/// # Errors
/// A file with fewer bodies, or with too many pieces to separate them.
pub(super) fn chosen(
    bodies: Vec<Vec<Triangle>>,
    number: Option<u16>,
) -> Result<Vec<Vec<Triangle>>, Vec<MeshProblem>> {
    let Some(number) = number else { return Ok(bodies) };
    let mut separate = Vec::new();
    for body in bodies {
        separate.extend(apart(body)?);
    }
    let count = separate.len();
    let Some(index) = usize::from(number).checked_sub(1).filter(|index| *index < count) else {
        return Err(vec![MeshProblem::NoSuchBody { number, count }]);
    };
    // Of equal boxes the first in the file.
    separate.sort_by(|a, b| size(around(b)).total_cmp(&size(around(a))));
    Ok(vec![separate.swap_remove(index)])
}

type Box = (DVec3, DVec3);

fn around(triangles: &[Triangle]) -> Box {
    let corners = triangles.iter().flat_map(|triangle| triangle.corners);
    corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

fn size((low, high): Box) -> f64 {
    (high - low).element_product()
}

/// Triangles by the body that they bound.
fn apart(triangles: Vec<Triangle>) -> Result<Vec<Vec<Triangle>>, Vec<MeshProblem>> {
    let (low, high) = around(&triangles);
    let (vertices, indexed) = weld(&triangles, WELD * low.abs().max(high.abs()).max_element());
    let mut piece = DisjointSets::new(vertices.len());
    for [a, b, c] in &indexed {
        for other in [b, c] {
            piece.join(*a, *other);
        }
    }
    let mut pieces: BTreeMap<u32, Vec<Triangle>> = BTreeMap::new();
    for (triangle, [a, ..]) in triangles.into_iter().zip(&indexed) {
        pieces.entry(piece.find(*a)).or_default().push(triangle);
    }
    PIECES.allows(pieces.len() as u64).map_err(|over| overspent("the file", over))?;
    let mut pieces: Vec<(Box, Vec<Triangle>)> = pieces.into_values().map(|one| (around(&one), one)).collect();
    pieces.sort_by(|a, b| size(b.0).total_cmp(&size(a.0)));
    let mut bodies: Vec<(Box, Vec<Triangle>)> = Vec::new();
    for (own, mut triangles) in pieces {
        let holds = |outer: &Box| own.0.cmpge(outer.0).all() && own.1.cmple(outer.1).all();
        match bodies.iter_mut().find(|(outer, _)| holds(outer)) {
            Some((_, body)) => body.append(&mut triangles),
            None => bodies.push((own, triangles)),
        }
    }
    Ok(bodies.into_iter().map(|(_, triangles)| triangles).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{FileOffset, TriangleLocation};

    /// A tetrahedron of this size at a place.
    fn tetrahedron(size: f64, at: [f64; 3]) -> Vec<Triangle> {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| size * p + DVec3::from_array(at));
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        let place = TriangleLocation { triangle: 0, start: FileOffset::Memory };
        faces.map(|face| Triangle { corners: face.map(|k: usize| corners[k]), place }).to_vec()
    }

    #[test]
    fn the_largest_body_is_first_and_includes_bodies_in_its_box() {
        let file = || {
            vec![
                [tetrahedron(1.0, [5.0; 3]), tetrahedron(2.0, [0.0; 3]), tetrahedron(0.2, [0.1; 3])].concat(),
            ]
        };
        let count = |number| chosen(file(), number).map(|bodies| bodies.iter().map(Vec::len).sum::<usize>());
        assert_eq!([None, Some(1), Some(2)].map(|number| count(number).unwrap()), [12, 8, 4]);
        for number in [0, 3] {
            assert_eq!(count(Some(number)).unwrap_err(), [MeshProblem::NoSuchBody { number, count: 2 }]);
        }
        let many = (0..2001).flat_map(|k| tetrahedron(0.1, [f64::from(k), 0.0, 0.0])).collect();
        assert!(matches!(chosen(vec![many], Some(1)).unwrap_err()[..], [MeshProblem::Overspent { .. }]));
    }
}
