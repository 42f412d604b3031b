//! Convex hull of a few points, by definition: every plane through three points with all others behind it
//! carries a facet; coplanar facets form a single polygon.
//!
//! O(n⁴) on purpose. Faster algorithms are known to return wrong facets for coplanar points, and designed
//! pieces consist of such points. Here every facet is checked against every point, and the facets must close.

use super::{Surface, SurfaceError};
use catchment_base::tolerance::COINCIDENT;
use glam::DVec3;

/// Largest number of points of a piece: they fit a bit set, and the hull takes milliseconds.
pub const MAX_POINTS: usize = 64;
/// Smallest sine of a triangle's corner whose plane is trusted: a plane through flatter ones could be off by
/// `COINCIDENT` / this over the piece.
const THINNEST: f64 = 1e-4;

/// Why points do not make a convex piece.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HullError {
    /// Too few points for a solid.
    #[error("{count} vertices: a solid needs at least 4")]
    TooFew {
        /// How many there are.
        count: usize,
    },
    /// More points than a piece may have.
    #[error("{count} vertices, more than {MAX_POINTS}: split the piece, or give an STL mesh")]
    TooMany {
        /// How many there are.
        count: usize,
    },
    /// A coordinate that is no number.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// Which, from 0.
        vertex: usize,
    },
    /// All points lie in a plane.
    #[error("all vertices lie in one plane: the piece has no volume")]
    Flat,
    /// A listed vertex that is no corner of the hull: the piece was not meant to be convex.
    #[error(
        "vertex {vertex} at {at} lies inside the hull of the others: split the piece into convex ones, or drop the vertex"
    )]
    Inside {
        /// Which, from 0.
        vertex: usize,
        /// Position, in D.
        at: DVec3,
    },
    /// Points so nearly coplanar that their facets do not close.
    #[error(
        "the facets do not close ({0}): some vertices are too close to a common plane; round or drop them"
    )]
    Unclear(SurfaceError),
}

/// The convex hull of `points` (in D) as a closed surface with merged coplanar facets.
///
/// Points on an edge or a facet of the hull are left out; a point strictly inside is an error.
pub fn convex_hull(points: &[DVec3]) -> Result<Surface, HullError> {
    let count = points.len();
    match count {
        0..4 => return Err(HullError::TooFew { count }),
        4..=MAX_POINTS => {}
        _ => return Err(HullError::TooMany { count }),
    }
    if let Some(vertex) = points.iter().position(|p| !p.is_finite()) {
        return Err(HullError::NotFinite { vertex });
    }
    let (lo, hi) = points.iter().fold((points[0], points[0]), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
    let tolerance = COINCIDENT * (hi - lo).length();
    let mut planes: Vec<(DVec3, u64)> = Vec::new();
    let mut spatial = false;
    for i in 0..count {
        for j in i + 1..count {
            for k in j + 1..count {
                let (u, v) = (points[j] - points[i], points[k] - points[i]);
                let cross = u.cross(v);
                if cross.length() <= THINNEST * u.length() * v.length()
                    || u.length().min(v.length()) <= tolerance
                {
                    continue;
                }
                let normal = cross.normalize();
                let (mut on, mut above, mut below) = (0u64, false, false);
                for (bit, p) in points.iter().enumerate() {
                    let distance = normal.dot(*p - points[i]);
                    if distance.abs() <= tolerance {
                        on |= 1 << bit;
                    } else if distance > 0.0 {
                        above = true;
                    } else {
                        below = true;
                    }
                }
                spatial |= above || below;
                if above != below {
                    planes.push((if above { -normal } else { normal }, on));
                }
            }
        }
    }
    if !spatial {
        return Err(HullError::Flat);
    }
    // Several triples find the same facet. Rounding may drop a point from some of them, so the largest set
    // wins.
    planes.sort_by_key(|(_, on)| (std::cmp::Reverse(on.count_ones()), *on));
    let mut facets: Vec<(DVec3, u64)> = Vec::new();
    for (normal, on) in planes {
        if !facets.iter().any(|(_, larger)| on & !larger == 0) {
            facets.push((normal, on));
        }
    }
    let polygons: Vec<Vec<u32>> =
        facets.iter().map(|&(normal, on)| corners(points, normal, on, tolerance)).collect();
    let on_border = facets.iter().fold(0u64, |all, (_, on)| all | on);
    if let Some(vertex) = (0..count).find(|bit| on_border & (1 << bit) == 0) {
        return Err(HullError::Inside { vertex, at: points[vertex] });
    }
    compact(points, &polygons).map_err(HullError::Unclear)
}

/// The corners of a facet, counter-clockwise seen against `normal`: gift wrapping in its plane.
fn corners(points: &[DVec3], normal: DVec3, on: u64, tolerance: f64) -> Vec<u32> {
    let members: Vec<usize> = (0..points.len()).filter(|bit| on & (1 << bit) != 0).collect();
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let flat = |k: usize| glam::DVec2::new(points[k].dot(u), points[k].dot(v));
    // The lowest of the leftmost points is a corner.
    let Some(start) = members.iter().copied().min_by(|&a, &b| {
        let (a, b) = (flat(a), flat(b));
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    }) else {
        return Vec::new();
    };
    let mut polygon = vec![start as u32];
    let mut current = start;
    for _ in 0..members.len() {
        let here = flat(current);
        let mut next: Option<usize> = None;
        for &candidate in &members {
            let to = flat(candidate) - here;
            if to.length() <= tolerance {
                continue;
            }
            let better = next.is_none_or(|best| {
                let along = flat(best) - here;
                let turn = along.perp_dot(to);
                // If the candidates are collinear, the farther point is the corner.
                if turn.abs() <= tolerance * along.length().max(to.length()) {
                    to.length_squared() > along.length_squared()
                } else {
                    turn < 0.0
                }
            });
            if better {
                next = Some(candidate);
            }
        }
        let Some(next) = next else { break };
        if points[next].distance(points[start]) <= tolerance {
            break;
        }
        polygon.push(next as u32);
        current = next;
    }
    polygon
}

/// Keeps only the points that are corners. Points closer than rounding are merged.
fn compact(points: &[DVec3], polygons: &[Vec<u32>]) -> Result<Surface, SurfaceError> {
    let (lo, hi) = points.iter().fold((points[0], points[0]), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
    let tolerance = COINCIDENT * (hi - lo).length();
    let mut vertices: Vec<DVec3> = Vec::new();
    let polygons: Vec<Vec<u32>> = polygons
        .iter()
        .map(|polygon| {
            let mut index = |k: &u32| {
                let p = points[*k as usize];
                vertices.iter().position(|q| q.distance(p) <= tolerance).unwrap_or_else(|| {
                    vertices.push(p);
                    vertices.len() - 1
                }) as u32
            };
            polygon.iter().map(&mut index).collect()
        })
        .filter(|polygon: &Vec<u32>| polygon.len() >= 3)
        .collect();
    Surface::from_polygons(vertices, &polygons)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn corners_of_cube() -> Vec<DVec3> {
        (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect()
    }

    fn is_the_hull(surface: &Surface, points: &[DVec3]) {
        assert!(surface.convex);
        for facet in &surface.facets {
            let on = surface.vertices[facet.corners[0] as usize];
            for p in points {
                assert!(facet.normal.dot(*p - on) < 1e-8, "{p} lies outside");
            }
        }
        // Euler: every convex edge is listed, because coplanar facets are merged.
        assert_eq!(surface.vertices.len() + surface.facets.len(), surface.edges.len() + 2);
    }

    #[test]
    fn a_cube_has_six_squares_whatever_lies_on_its_border() {
        let mut points = corners_of_cube();
        points.push(DVec3::new(0.5, 0.5, 1.0)); // on a facet
        points.push(DVec3::new(0.5, 1.0, 1.0)); // on an edge
        points.push(points[3]); // twice
        let cube = convex_hull(&points).unwrap();
        assert_eq!((cube.vertices.len(), cube.facets.len(), cube.edges.len()), (8, 6, 12));
        assert!((cube.volume() - 1.0).abs() < 1e-14);
        is_the_hull(&cube, &points);
    }

    #[test]
    fn a_vertex_inside_is_named() {
        let mut points = corners_of_cube();
        points.insert(2, DVec3::new(0.5, 0.5, 0.9));
        assert!(matches!(convex_hull(&points), Err(HullError::Inside { vertex: 2, .. })));
    }

    #[test]
    fn points_without_volume_are_refused() {
        let points = corners_of_cube();
        assert_eq!(convex_hull(&points[..3]), Err(HullError::TooFew { count: 3 }));
        assert_eq!(convex_hull(&points[..4]), Err(HullError::Flat));
        assert_eq!(convex_hull(&[DVec3::ONE; 5]), Err(HullError::Flat));
        assert_eq!(convex_hull(&[DVec3::ONE; 65]), Err(HullError::TooMany { count: 65 }));
        let mut points = points;
        points[6].y = f64::NAN;
        assert_eq!(convex_hull(&points), Err(HullError::NotFinite { vertex: 6 }));
    }

    proptest! {
        #[test]
        fn points_on_a_sphere_are_all_corners(
            directions in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 4..24)
        ) {
            let points: Vec<DVec3> = directions.into_iter().map(DVec3::from_array).collect();
            prop_assume!(points.iter().all(|p| p.length() > 0.1));
            let points: Vec<DVec3> = points.into_iter().map(DVec3::normalize).collect();
            let apart = |a: &DVec3, b: &DVec3| a.distance(*b) > 0.02;
            prop_assume!((0..points.len()).all(|i| (0..i).all(|j| apart(&points[i], &points[j]))));
            if let Ok(hull) = convex_hull(&points) {
                prop_assert_eq!(hull.vertices.len(), points.len());
                is_the_hull(&hull, &points);
            } else {
                // Only an almost flat set may fail.
                let spread = points.iter().map(|p| (*p - points[0]).length()).fold(0.0, f64::max);
                prop_assert!(spread < 0.1);
            }
        }

        /// Sums of two squares' corners have many exactly coplanar points: the case on which hulls go wrong.
        #[test]
        fn lattice_points_make_clean_hulls(bits in 1u32..(1 << 27)) {
            let points: Vec<DVec3> = (0..27)
                .filter(|k| bits >> k & 1 == 1)
                .map(|k: i32| DVec3::new(f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)))
                .collect();
            match convex_hull(&points) {
                Ok(hull) => is_the_hull(&hull, &points),
                Err(HullError::Inside { at, .. }) => prop_assert_eq!(at, DVec3::ONE),
                Err(HullError::Flat | HullError::TooFew { .. }) => {
                    let area = |a: DVec3, b: DVec3, c: DVec3| (b - a).cross(c - a);
                    for a in &points { for b in &points { for c in &points { for d in &points {
                        prop_assert!(area(*a, *b, *c).dot(*d - *a) == 0.0);
                    }}}}
                }
                Err(other) => prop_assert!(false, "{}", other),
            }
        }
    }
}
