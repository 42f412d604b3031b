//! Random points of every awkward kind, and invariants of every polytope.

use super::super::{FLAT, MAX_DIMENSION, Polytope, PolytopePoint, RESOLUTION, dot};
use proptest::prelude::*;

/// Points in a dimension from `dimensions`, at least `extra` more than a simplex has and at most `most` in all.
pub(super) fn cloud(
    dimensions: std::ops::RangeInclusive<usize>,
    most: usize,
) -> impl Strategy<Value = (usize, Vec<PolytopePoint>)> {
    (dimensions, 0..6usize).prop_flat_map(move |(dimension, kind)| {
        let least = dimension + 1;
        let count = least..=most.max(least);
        let points = match kind {
            // In general position.
            0 | 1 => prop::collection::vec(real(dimension), count).boxed(),
            // Few coordinates: many coplanar, many repeated.
            2 => prop::collection::vec(whole(dimension, 1), count).boxed(),
            3 => prop::collection::vec(whole(dimension, 3), count).boxed(),
            // A prism: each point at two values of the last coordinate, or leaning.
            4 => (
                prop::collection::vec(real(dimension - 1), least.div_ceil(2)..=(most / 2).max(least)),
                real(dimension),
            )
                .prop_map(move |(base, step)| {
                    base.iter().flat_map(|p| [*p, std::array::from_fn(|i| p[i] + step[i])]).collect()
                })
                .boxed(),
            // A sum: parallelograms that rounding bends.
            _ => (
                prop::collection::vec(real(dimension), 2..=(most / 3).max(3)),
                prop::collection::vec(real(dimension), 3),
            )
                .prop_map(|(a, b)| sums(&a, &b))
                .boxed(),
        };
        (Just(dimension), points)
    })
}

/// Points of which some nearly lie in the span of others: at distances from far below to above the
/// resolution.
pub(super) fn nearly_flat_cloud(
    dimensions: std::ops::RangeInclusive<usize>,
    most: usize,
) -> impl Strategy<Value = (usize, Vec<PolytopePoint>)> {
    let shift = (-15.0..-5.0f64).prop_map(|exponent| 10f64.powf(exponent));
    (
        cloud(dimensions, most),
        prop::collection::vec((0..1000usize, 0..1000usize, 0.0..1.0f64, shift, real(6)), 1..6),
    )
        .prop_map(|((dimension, mut points), moves)| {
            for (a, b, share, shift, direction) in moves {
                let (a, b) = (points[a % points.len()], points[b % points.len()]);
                let mut point = [0.0; MAX_DIMENSION];
                for axis in 0..dimension {
                    point[axis] = a[axis] + share * (b[axis] - a[axis]) + shift * direction[axis];
                }
                points.push(point);
            }
            (dimension, points)
        })
}

/// A point of the box from −1 to 1.
pub(super) fn real(dimension: usize) -> impl Strategy<Value = PolytopePoint> {
    prop::array::uniform6(-1.0..1.0f64).prop_map(move |mut point| {
        point[dimension..].fill(0.0);
        point
    })
}

/// A point with coordinates that are multiples of a half up to `reach` halves.
fn whole(dimension: usize, reach: i32) -> impl Strategy<Value = PolytopePoint> {
    prop::array::uniform6(-reach..=reach).prop_map(move |point| {
        let mut point = point.map(|c| f64::from(c) / 2.0);
        point[dimension..].fill(0.0);
        point
    })
}

pub(super) fn sums(a: &[PolytopePoint], b: &[PolytopePoint]) -> Vec<PolytopePoint> {
    a.iter().flat_map(|a| b.iter().map(|b| std::array::from_fn(|i| a[i] + b[i]))).collect()
}

/// The hull's support function, from the points themselves.
pub(super) fn support(points: &[PolytopePoint], direction: &PolytopePoint) -> f64 {
    points.iter().map(|p| dot(p, direction)).fold(f64::NEG_INFINITY, f64::max)
}

/// Both forms fit, and the faces close and obey Euler's relation.
pub(super) fn check(polytope: &Polytope) -> Result<(), TestCaseError> {
    let (dimension, facets) = (polytope.dimension(), polytope.facets());
    for (index, vertex) in polytope.vertices().iter().enumerate() {
        prop_assert!(polytope.vertex_facets(index).count() >= dimension, "vertex {index}: {polytope:?}");
        for (facet, plane) in facets.iter().enumerate() {
            let excess = plane.excess(vertex);
            // Twice: hulls put points within FLAT on a plane, cuts as well, of vertices that are that far off.
            prop_assert!(excess <= 2.0 * FLAT, "vertex {index} is outside facet {facet} by {excess}");
            if polytope.incidence.has(index, facet) {
                prop_assert!(excess.abs() <= 2.0 * FLAT, "vertex {index} is {excess} off its facet {facet}");
            }
        }
    }
    for (facet, plane) in facets.iter().enumerate() {
        prop_assert!((dot(&plane.normal, &plane.normal) - 1.0).abs() < 1e-14);
        prop_assert!(polytope.facet_vertices(facet).count() >= dimension, "facet {facet}: {polytope:?}");
        prop_assert!(polytope.vertices().iter().any(|v| plane.excess(v) < -RESOLUTION));
    }
    if dimension < 5 {
        // The volume from the faces equals the volume of the hull of the vertices.
        let hull = Polytope::hull(dimension, polytope.vertices());
        let volume = hull.map_or(0.0, |hull| hull.volume());
        prop_assert!(
            (volume - polytope.volume()).abs() < 1e-8,
            "{volume} {} {polytope:?}",
            polytope.volume()
        );
    }
    prop_assert!(dimension == 1 || polytope.incidence.is_sound(dimension, facets.len()), "{polytope:?}");
    Ok(())
}
