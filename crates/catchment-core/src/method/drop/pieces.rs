//! The halves in the form that an engine accepts: convex pieces if they are exact, else oriented triangles.
//!
//! ```text
//!      ╱╲      every facet that faces the other half carries a column of       the columns form the solid
//!     ╱││╲     material down to the flat back of the half                      if no other facet faces back
//!    ╱_││_╲
//! ```
//!
//! A convex surface is a single convex piece. A surface whose facets that face away all lie in the back plane
//! is divided into columns (then their volumes add up to that of the whole, and no two overlap). All families
//! are one or the other. The remaining case, a mesh with undercuts, stays a mesh of triangles. Nothing is
//! ever approximated by a decomposition. Coplanar facets are merged first ([`super::faces`]): columns side by
//! side under one face have edges inside it, on which an engine jams.

use super::faces::{joined, merged};
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

/// Half of the last place of a single-precision number, as meshes are stored in, relative to it.
const SINGLE: f64 = 1.0 / (1 << 24) as f64;

/// Largest displacement of the corners of a surface by rounding, in D.
fn rounding(surface: &Surface) -> f64 {
    // Moving a half to its face centre takes coordinates near 1 to others.
    surface.vertices.iter().fold(1.0, |size: f64, p| size.max(p.abs().max_element())) * SINGLE
}

/// Whether rounding alone may have tilted a facet out of the vertical: moving its corners in plan view by as much changes its area there
/// by up to that times its circumference.
fn is_wall(corners: &[DVec3], rounding: f64) -> bool {
    let next = |k: usize| corners[(k + 1) % corners.len()];
    let around: f64 = corners.iter().enumerate().map(|(k, p)| p.distance(next(k))).sum();
    let area: f64 =
        corners.iter().enumerate().map(|(k, p)| p.truncate().perp_dot(next(k).truncate()) / 2.0).sum();
    area.abs() <= rounding * around
}

/// The parts of a half, in its own axes.
///
/// They are parts of the united surface of all pieces, if that is convex or a set of columns: for stacked
/// pieces, the top of the lower piece would be a step inside the solid, on which sliding bodies jam in an
/// engine.
pub(super) fn parts(half: &Half) -> Vec<Part> {
    let whole: Option<Vec<Vec<Surface>>> = half.surfaces.iter().map(convex_parts).collect();
    if let Some(parts) = whole {
        return parts.into_iter().flatten().map(Part::Convex).collect();
    }
    half.solids()
        .iter()
        .flat_map(|surface| match convex_parts(surface) {
            Some(parts) => parts.into_iter().map(Part::Convex).collect(),
            None => vec![Part::Mesh(surface.clone())],
        })
        .collect()
}

/// A surface as exact convex parts: itself, or its columns in either direction.
fn convex_parts(surface: &Surface) -> Option<Vec<Surface>> {
    if surface.convex {
        return Some(vec![joined(surface)]);
    }
    let turn = |p: DVec3| DVec3::new(p.x, -p.y, -p.z);
    columns(surface).or_else(|| {
        let turned = columns(&surface.mapped(turn))?;
        Some(turned.into_iter().map(|column| column.mapped(turn)).collect())
    })
}

/// The columns under the facets that face +z; `None` if some facet that faces −z is not at the bottom.
fn columns(surface: &Surface) -> Option<Vec<Surface>> {
    let floor = surface.bounds().0.z;
    let rounding = rounding(surface);
    let stands = |corners: &[DVec3]| corners.iter().all(|p| p.z - floor <= rounding);
    let points = |corners: &[u32]| corners.iter().map(|k| surface.vertices[*k as usize]).collect::<Vec<_>>();
    let (up, down): (Vec<_>, Vec<_>) = surface
        .facets
        .iter()
        .filter(|facet| !is_wall(&points(&facet.corners), rounding))
        .partition(|facet| facet.normal.z > 0.0);
    if down.iter().any(|facet| !stands(&points(&facet.corners))) {
        return None;
    }
    let up = up.into_iter().map(|facet| facet.corners.clone()).collect();
    merged(&surface.vertices, up).iter().map(|corners| column(&points(corners), floor, rounding)).collect()
}

/// The solid between a polygon, counter-clockwise from above, and the floor.
fn column(top: &[DVec3], floor: f64, rounding: f64) -> Option<Surface> {
    let count = top.len() as u32;
    let mut vertices = top.to_vec();
    let bottom: Vec<u32> = (0..count)
        .map(|k| {
            let p = top[k as usize];
            if p.z - floor <= rounding {
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
        assert!(matches!(parts(&Half::of(vec![surface]))[..], [Part::Mesh(_)]));
    }
    /// A square boss on a plate, the top of its walls out by `out`.
    fn boss(out: f64) -> Surface {
        let square = |half: f64, z: f64| {
            [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(|[x, y]| DVec3::new(half * x, half * y, z))
        };
        let rings = [square(0.5, 0.0), square(0.5, 0.1), square(0.2, 0.1), square(0.2 + out, 0.11)];
        let mut polygons: Vec<Vec<u32>> = vec![vec![3, 2, 1, 0], vec![12, 13, 14, 15]];
        for ring in 0..3 {
            for k in 0..4 {
                let (a, b) = (4 * ring + k, 4 * ring + (k + 1) % 4);
                polygons.push(vec![a, b, b + 4, a + 4]);
            }
        }
        Surface::from_polygons(rings.concat(), &polygons).unwrap()
    }

    #[test]
    fn walls_rounded_to_single_precision_are_no_undercuts() {
        // Normals with z of 0, −4e-9, −4e-6 and 4e-6.
        for out in [0.0, 4e-11, 4e-8, -4e-8] {
            let surface = boss(out);
            let parts = parts(&Half::of(vec![surface.clone()]));
            assert!(parts.iter().all(|part| matches!(part, Part::Convex(_))), "{out}");
            // Volume lost at the walls: their length times their deviation.
            assert!((volume(&parts) - surface.volume()).abs() < 1e-7, "{out}");
        }
        // A hundred times as much is drawn.
        assert!(matches!(parts(&Half::of(vec![boss(1e-5)]))[..], [Part::Mesh(_)]));
    }
}
