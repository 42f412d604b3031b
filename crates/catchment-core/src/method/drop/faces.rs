//! Coplanar facets are merged before they become bodies: at an edge inside a flat face an engine finds a
//! separate contact normal, at which a sliding body jams.
//!
//! ```text
//!   ╲                        ╲
//!    ╲__ knots on the line    ╲
//!       ╲__            ──▶     ╲       a single facet for several that are coplanar and together convex,
//!          ╲__                  ╲      without the corners on the line between their neighbours
//!             ╲                  ╲
//! ```
//!
//! Facets within [`FLAT`] of a plane are merged, because profiles have rounded coordinates. A surface without
//! such facets is not changed.

use crate::connector::Surface;
use glam::DVec3;
use std::collections::BTreeMap;

/// Largest distance of corners from the plane of their facet, or from the line between their neighbours, in
/// D: a hundredth of the compliance of the engine's contacts.
const FLAT: f64 = 1e-5;

/// A convex surface with coplanar facets merged; unchanged if it has none.
pub(super) fn joined(surface: &Surface) -> Surface {
    let facets: Vec<Vec<u32>> = surface.facets.iter().map(|facet| facet.corners.clone()).collect();
    let count = facets.len();
    let faces = merged(&surface.vertices, facets);
    if faces.len() == count {
        return surface.clone();
    }
    let faces: Vec<Vec<u32>> = faces.into_iter().map(|face| straightened(&surface.vertices, face)).collect();
    let mut numbers = BTreeMap::new();
    let mut vertices = Vec::new();
    let mut number = |corner: u32| {
        *numbers.entry(corner).or_insert_with(|| {
            vertices.push(surface.vertices[corner as usize]);
            vertices.len() as u32 - 1
        })
    };
    let polygons: Vec<Vec<u32>> =
        faces.into_iter().map(|face| face.into_iter().map(&mut number).collect()).collect();
    // If a corner is collinear in one face but not in the next, the surface stays unchanged.
    let result = Surface::from_polygons(vertices, &polygons).ok();
    result.filter(|result| result.convex).unwrap_or_else(|| surface.clone())
}

/// Faces of coplanar neighbours joined as long as the result is convex; corners are numbers of `vertices`.
pub(super) fn merged(vertices: &[DVec3], mut faces: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
    loop {
        let mut owner = BTreeMap::new();
        for (k, face) in faces.iter().enumerate() {
            owner.extend(sides(face).map(|side| (side, k)));
        }
        let mut gone = vec![false; faces.len()];
        let mut next = Vec::with_capacity(faces.len());
        for k in 0..faces.len() {
            if gone[k] {
                continue;
            }
            let partner = sides(&faces[k]).find_map(|[a, b]| {
                let other = *owner.get(&[b, a])?;
                let is_there = other > k && !gone[other];
                Some((other, is_there.then(|| union(vertices, &faces[k], &faces[other], [a, b]))??))
            });
            match partner {
                Some((other, face)) => {
                    gone[other] = true;
                    next.push(face);
                }
                None => next.push(faces[k].clone()),
            }
        }
        if next.len() == faces.len() {
            return next;
        }
        faces = next;
    }
}

/// The directed sides of a face.
fn sides(face: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]])
}

/// Two faces merged along a side of the first; `None` if they are not coplanar or not convex together.
fn union(vertices: &[DVec3], face: &[u32], other: &[u32], [a, b]: [u32; 2]) -> Option<Vec<u32>> {
    let from = |face: &[u32], corner: u32| -> Option<Vec<u32>> {
        let first = face.iter().position(|c| *c == corner)?;
        Some(face[first..].iter().chain(&face[..first]).copied().collect())
    };
    let (mut ring, rest) = (from(face, b)?, from(other, a)?);
    ring.extend_from_slice(&rest[1..rest.len() - 1]);
    let at = |corner: &u32| vertices[*corner as usize];
    let origin = at(&ring[0]);
    let area: DVec3 = ring.windows(2).map(|w| (at(&w[0]) - origin).cross(at(&w[1]) - origin)).sum();
    let normal = area.try_normalize()?;
    if ring.iter().any(|corner| (at(corner) - origin).dot(normal).abs() > FLAT) {
        return None;
    }
    let ring = straightened(vertices, ring);
    let count = ring.len();
    let turns = |k: usize| {
        let [p, q, r] = [k, (k + 1) % count, (k + 2) % count].map(|k| at(&ring[k]));
        (q - p).cross(r - q).dot(normal)
    };
    (count > 2 && (0..count).all(|k| turns(k) > 0.0)).then_some(ring)
}

/// A face without the corners that lie on the line between their neighbours.
fn straightened(vertices: &[DVec3], mut ring: Vec<u32>) -> Vec<u32> {
    let at = |corner: u32| vertices[corner as usize];
    let mut k = 0;
    while k < ring.len() && ring.len() > 3 {
        let count = ring.len();
        let [p, q, r] = [k + count - 1, k, k + 1].map(|k| at(ring[k % count]));
        let along = (r - p).normalize_or_zero();
        let is_between = (q - p).dot(along) > 0.0 && (r - q).dot(along) > 0.0;
        if is_between && (q - p).reject_from(along).length() <= FLAT {
            ring.remove(k);
            k = k.saturating_sub(1);
        } else {
            k += 1;
        }
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block of 1 × 1 × 0.3 whose sides have knots at thirds of their length, rounded to six digits.
    fn block() -> Surface {
        let third = 0.333_333;
        let top = [
            [0.0, 0.0],
            [third, 0.0],
            [2.0 * third, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [1.0 - third, 1.0],
            [0.0, 1.0],
            [0.0, third],
        ];
        let n = top.len() as u32;
        let vertices: Vec<DVec3> =
            [0.0, 0.3].iter().flat_map(|z| top.map(|[x, y]| DVec3::new(x, y, *z))).collect();
        let mut polygons: Vec<Vec<u32>> = vec![(n..2 * n).collect(), (0..n).rev().collect()];
        polygons.extend((0..n).map(|k| vec![k, (k + 1) % n, n + (k + 1) % n, n + k]));
        Surface::from_polygons(vertices, &polygons).unwrap()
    }

    #[test]
    fn knots_on_straight_sides_are_removed() {
        let block = block();
        let joined = joined(&block);
        assert_eq!((block.facets.len(), joined.facets.len()), (10, 6));
        assert_eq!(joined.vertices.len(), 8);
        assert!((joined.volume() - 0.3).abs() < 1e-12, "{}", joined.volume());
    }

    #[test]
    fn knots_on_bent_sides_stay() {
        let bent = |by: f64| {
            let mut vertices = block().vertices;
            for k in [1, 9] {
                vertices[k].y -= by;
            }
            let facets: Vec<Vec<u32>> = block().facets.iter().map(|facet| facet.corners.clone()).collect();
            joined(&Surface::from_polygons(vertices, &facets).unwrap()).facets.len()
        };
        assert_eq!(bent(5e-6), 6);
        // The neighbouring knot lies on the line to the next corner; the bent knot does not.
        assert!(bent(1e-3) > 6, "{}", bent(1e-3));
    }
}
