//! The separate bodies of a file: which triangles hang together.
//!
//! ```text
//!   corners that a triangle joins ──▶ pieces ──▶ a piece whose box lies in another's is of that body ──▶ bodies, the largest box first
//! ```
//!
//! Not guaranteed: that pieces which touch at a corner are told apart, or a body that lies in the box of another.

use super::indexed::weld;
use super::{MeshProblem, Triangle, WELD};
use glam::DVec3;
use std::collections::BTreeMap;

/// The triangles of the body with this number, counted from 1, of all bodies of a file; all of them without a number.
///
/// # Errors
/// A file with fewer bodies.
pub(super) fn chosen(
    bodies: Vec<Vec<Triangle>>,
    number: Option<u16>,
) -> Result<Vec<Vec<Triangle>>, Vec<MeshProblem>> {
    let Some(number) = number else { return Ok(bodies) };
    let mut apart: Vec<Vec<Triangle>> = bodies.into_iter().flat_map(apart).collect();
    let count = apart.len();
    let index = number as usize - 1;
    if index >= count {
        return Err(vec![MeshProblem::NoSuchBody { number, count }]);
    }
    // Of equal boxes the first in the file.
    apart.sort_by(|a, b| size(around(b)).total_cmp(&size(around(a))));
    Ok(vec![apart.swap_remove(index)])
}

type Box = (DVec3, DVec3);

fn around(triangles: &[Triangle]) -> Box {
    let corners = triangles.iter().flat_map(|triangle| triangle.corners);
    corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

fn size((low, high): Box) -> f64 {
    (high - low).element_product()
}

/// The corner that stands for a piece.
fn root(piece: &mut [u32], mut k: u32) -> u32 {
    while piece[k as usize] != k {
        piece[k as usize] = piece[piece[k as usize] as usize];
        k = piece[k as usize];
    }
    k
}

/// Triangles by the body that they bound.
fn apart(triangles: Vec<Triangle>) -> Vec<Vec<Triangle>> {
    let (low, high) = around(&triangles);
    let (vertices, indexed) = weld(&triangles, WELD * low.abs().max(high.abs()).max_element());
    let mut piece: Vec<u32> = (0..vertices.len() as u32).collect();
    for [a, b, c] in &indexed {
        for other in [b, c] {
            let (one, other) = (root(&mut piece, *a), root(&mut piece, *other));
            piece[one.max(other) as usize] = one.min(other);
        }
    }
    let mut pieces: BTreeMap<u32, Vec<Triangle>> = BTreeMap::new();
    for (triangle, [a, ..]) in triangles.into_iter().zip(&indexed) {
        pieces.entry(root(&mut piece, *a)).or_default().push(triangle);
    }
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
    bodies.into_iter().map(|(_, triangles)| triangles).collect()
}
