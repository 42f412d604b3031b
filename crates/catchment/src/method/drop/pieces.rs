//! The halves as an engine can take them: convex pieces where they are exact, oriented triangles where they are not.
//!
//! ```text
//!      ╱╲      every facet that faces the other half carries a column of       the columns make up the solid
//!     ╱││╲     material down to the flat back of the half                      if nothing else faces back
//!    ╱_││_╲
//! ```
//!
//! A surface is one convex piece if it is convex; else its columns, where every facet turned away from the face lies in the
//! back plane (then their volumes add up to the whole's, and no two overlap). All families are one or the other.
//! What is left, a mesh with undercuts, stays one mesh of triangles. Nothing is ever approximated by a decomposition.

use crate::connector::{Half, Surface};
use glam::DVec3;

/// A part of a half.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Part {
    /// A convex piece.
    Convex(Surface),
    /// A closed surface that is no union of columns.
    Mesh(Surface),
}

/// Facets turned back lie in one plane within this, in D, and facets steeper than this (cosine) are walls: rounding of
/// coordinates near 1.
const FLAT: f64 = 1e-9;

/// The parts of a half, in its own axes.
pub(super) fn parts(half: &Half) -> Vec<Part> {
    half.surfaces
        .iter()
        .flat_map(|surface| {
            if surface.convex {
                return vec![Part::Convex(surface.clone())];
            }
            let turn = |p: DVec3| DVec3::new(p.x, -p.y, -p.z);
            columns(surface)
                .or_else(|| {
                    let turned = columns(&surface.mapped(turn))?;
                    Some(turned.into_iter().map(|column| column.mapped(turn)).collect())
                })
                .map_or_else(
                    || vec![Part::Mesh(surface.clone())],
                    |columns| columns.into_iter().map(Part::Convex).collect(),
                )
        })
        .collect()
}

/// The columns under the facets that face +z; `None` where some facet facing −z is not at the bottom.
fn columns(surface: &Surface) -> Option<Vec<Surface>> {
    let floor = surface.bounds().0.z;
    let at = |i: &u32| surface.vertices[*i as usize];
    let stands = |corners: &[u32]| {
        corners.iter().map(at).all(|p| p.z - floor <= FLAT * p.abs().max_element().max(1.0))
    };
    if surface.facets.iter().any(|f| f.normal.z < -FLAT && !stands(&f.corners)) {
        return None;
    }
    let upward = surface.facets.iter().filter(|f| f.normal.z > FLAT);
    upward.map(|f| column(&f.corners.iter().map(at).collect::<Vec<_>>(), floor)).collect()
}

/// The solid between a polygon, counter-clockwise from above, and the floor.
fn column(top: &[DVec3], floor: f64) -> Option<Surface> {
    let count = top.len() as u32;
    let mut vertices = top.to_vec();
    let bottom: Vec<u32> = (0..count)
        .map(|k| {
            let p = top[k as usize];
            if p.z - floor <= FLAT {
                return k;
            }
            vertices.push(p.with_z(floor));
            vertices.len() as u32 - 1
        })
        .collect();
    let mut polygons = vec![(0..count).collect::<Vec<_>>(), bottom.iter().rev().copied().collect()];
    for k in 0..count {
        let next = (k + 1) % count;
        let mut wall = vec![bottom[k as usize], bottom[next as usize], next, k];
        wall.dedup();
        if wall.first() == wall.last() {
            wall.pop();
        }
        if wall.len() > 2 {
            polygons.push(wall);
        }
    }
    Surface::from_polygons(vertices, &polygons).ok().filter(|column| column.convex)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};

    fn volume(parts: &[Part]) -> f64 {
        parts.iter().map(|(Part::Convex(s) | Part::Mesh(s))| s.volume()).sum()
    }

    #[test]
    fn every_family_is_made_of_convex_pieces() {
        for family in Family::ALL {
            let spec = FamilySpec::new(family).with_chord_error(0.05);
            let alignment = Alignment::default_for(Some(family));
            let connector = ConnectorSpec::Family(spec);
            let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
            let halves = Connector::build(&design).unwrap();
            for half in [&halves.fixed, &halves.moving] {
                let parts = parts(half);
                let whole: f64 = half.surfaces.iter().map(Surface::volume).sum();
                assert!(parts.iter().all(|p| matches!(p, Part::Convex(_))), "{family:?}");
                // Sums of at most some hundred terms below 1.
                assert!((volume(&parts) - whole).abs() < 1e-12, "{family:?}: {} {whole}", volume(&parts));
            }
        }
    }

    #[test]
    fn an_undercut_stays_a_mesh() {
        // A box with a notch cut into its side: a C.
        let outline = [[0., 0.], [1., 0.], [1., 0.3], [0.5, 0.5], [1., 0.7], [1., 1.], [0., 1.]];
        let n = outline.len() as u32;
        let vertices: Vec<DVec3> =
            [0.0, 1.0].iter().flat_map(|y| outline.map(|[x, z]| DVec3::new(x, *y, z))).collect();
        let mut polygons: Vec<Vec<u32>> =
            (0..n).map(|k| vec![k, n + k, n + (k + 1) % n, (k + 1) % n]).collect();
        for cap in [[0, 1, 2], [0, 2, 3], [0, 3, 6], [3, 5, 6], [3, 4, 5]] {
            polygons.push(cap.to_vec());
            polygons.push(cap.iter().rev().map(|k| n + k).collect());
        }
        let surface = Surface::from_polygons(vertices, &polygons).unwrap();
        assert!(!surface.convex);
        assert!(matches!(parts(&Half { surfaces: vec![surface] })[..], [Part::Mesh(_)]));
    }
}
