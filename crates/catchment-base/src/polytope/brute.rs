//! The slow, obvious reference versions of the fast algorithms.
//!
//! A facet is a plane through `dimension` of the points with all points behind it; a point is inside if it is
//! behind all facets; two vertices are joined if the normals of their common facets span all directions but
//! one; a volume is the share of evenly spread points that are inside.
//!
//! In plain floating point, and slow: n^(dimension + 1) for the facets of n points. Wrong for points closer
//! to a common plane than [`RESOLUTION`] without being in it.

use super::{Halfspace, MAX_DIMENSION, Polytope, PolytopePoint, RESOLUTION, dot};

/// Pivots below this share of their row's first length are rounding: the points lie in something flatter.
const DEPENDENT: f64 = 1e-7;

/// The facets of the hull of points, one for each plane.
pub fn facets(dimension: usize, points: &[PolytopePoint]) -> Vec<Halfspace> {
    let mut result: Vec<Halfspace> = Vec::new();
    let mut chosen = Vec::new();
    each_subset(points.len(), dimension, 0, &mut chosen, &mut |subset| {
        let Some(normal) = normal(dimension, points, subset) else { return };
        let Some(plane) = Halfspace::new(normal, dot(&normal, &points[subset[0]])) else { return };
        for side in [plane, plane.flipped()] {
            let behind = points.iter().all(|point| side.excess(point) <= RESOLUTION);
            let known = |other: &Halfspace| {
                subset.iter().all(|vertex| other.excess(&points[*vertex]).abs() <= RESOLUTION)
            };
            if behind && !result.iter().any(known) {
                result.push(side);
            }
        }
    });
    result
}

/// Is the point behind all of these?
pub fn contains(facets: &[Halfspace], point: &PolytopePoint) -> bool {
    facets.iter().all(|facet| facet.excess(point) <= RESOLUTION)
}

/// The volume of the set for which `inside` is true, by evenly spread points of a box; its error is about (a
/// few / `samples`) of the box for smooth sets in few dimensions.
///
/// Points are the multiples, modulo 1, of powers of 1/φ, with φ the root of φ^(d+1) = φ + 1 (M. Roberts'
/// additive recurrence): no random numbers, and fewer clumps than those have.
pub fn volume(
    dimension: usize,
    low: &PolytopePoint,
    high: &PolytopePoint,
    samples: usize,
    mut inside: impl FnMut(&PolytopePoint) -> bool,
) -> f64 {
    let mut root = 2.0f64;
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (dimension as f64 + 1.0));
    }
    let mut hits = 0usize;
    for sample in 0..samples {
        let mut point = [0.0; MAX_DIMENSION];
        let mut step = 1.0;
        for (axis, c) in point.iter_mut().enumerate().take(dimension) {
            step /= root;
            *c = low[axis] + (0.5 + sample as f64 * step).fract() * (high[axis] - low[axis]);
        }
        hits += usize::from(inside(&point));
    }
    let sides = low.iter().zip(high).take(dimension).map(|(low, high)| high - low);
    sides.product::<f64>() * hits as f64 / samples as f64
}

/// Is there an edge between two vertices of a polytope?
pub fn is_edge(polytope: &Polytope, a: usize, b: usize) -> bool {
    let shared: Vec<PolytopePoint> = polytope
        .vertex_facets(a)
        .filter(|facet| polytope.vertex_facets(b).any(|other| other == *facet))
        .map(|facet| polytope.facets()[facet].normal)
        .collect();
    a != b && rank(&shared) == polytope.dimension() - 1
}

/// Calls with every set of `size` indices from `next` on, in addition to those chosen.
pub(super) fn each_subset(
    count: usize,
    size: usize,
    next: usize,
    chosen: &mut Vec<usize>,
    call: &mut impl FnMut(&[usize]),
) {
    if size == chosen.len() {
        call(chosen);
        return;
    }
    for index in next..count {
        chosen.push(index);
        each_subset(count, size, index + 1, chosen, call);
        chosen.pop();
    }
}

/// A normal of the plane through points; `None` if they lie in a lower-dimensional subspace.
fn normal(dimension: usize, points: &[PolytopePoint], subset: &[usize]) -> Option<PolytopePoint> {
    let origin = &points[subset[0]];
    let span: Vec<PolytopePoint> =
        subset[1..].iter().map(|i| std::array::from_fn(|axis| points[*i][axis] - origin[axis])).collect();
    let basis = orthonormal(&span);
    if basis.len() + 1 != dimension {
        return None;
    }
    // The remainder of the coordinate axis that is farthest from the directions of the plane.
    (0..dimension)
        .map(|axis| {
            let mut unit = [0.0; MAX_DIMENSION];
            unit[axis] = 1.0;
            reduced(reduced(unit, &basis), &basis)
        })
        .max_by(|a, b| dot(a, a).total_cmp(&dot(b, b)))
}

/// How many of the vectors are independent.
fn rank(vectors: &[PolytopePoint]) -> usize {
    orthonormal(vectors).len()
}

/// Orthogonal unit vectors that span the same.
fn orthonormal(vectors: &[PolytopePoint]) -> Vec<PolytopePoint> {
    let mut basis: Vec<PolytopePoint> = Vec::new();
    for vector in vectors {
        let rest = reduced(reduced(*vector, &basis), &basis);
        let length = dot(&rest, &rest).sqrt();
        if length > DEPENDENT * dot(vector, vector).sqrt() {
            basis.push(rest.map(|c| c / length));
        }
    }
    basis
}

/// The component of a vector orthogonal to a basis.
fn reduced(mut vector: PolytopePoint, basis: &[PolytopePoint]) -> PolytopePoint {
    for unit in basis {
        let along = dot(&vector, unit);
        for (c, u) in vector.iter_mut().zip(unit) {
            *c -= along * u;
        }
    }
    vector
}
