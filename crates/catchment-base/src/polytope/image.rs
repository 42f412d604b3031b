//! Hulls of moved points: Minkowski sums, projections, cross-sections, facets visible from one side.
//!
//! Points are rounded to the lattice of hulls before they are added, so that sums are exact, and coplanar if
//! they should be.

use super::exact::{self, Lattice};
use super::{MAX_DIMENSION, Polytope, PolytopePoint, RESOLUTION};

/// The hull of all sums of a point of the first and a point of the second set: the Minkowski sum of their
/// hulls, either of which may be flat, or a single point. `None` if the sum is thinner than [`RESOLUTION`],
/// or a coordinate of a point is NaN or beyond 1024.
pub fn minkowski_sum_of(
    dimension: usize,
    one: &[PolytopePoint],
    other: &[PolytopePoint],
) -> Option<Polytope> {
    if !(1..=MAX_DIMENSION).contains(&dimension) {
        return None;
    }
    let lattice = |points: &[PolytopePoint]| -> Option<Vec<Lattice>> {
        points.iter().map(|point| exact::snapped(dimension, point)).collect()
    };
    let (one, other) = (lattice(one)?, lattice(other)?);
    let sums = one.iter().flat_map(|a| other.iter().map(|b| std::array::from_fn(|axis| a[axis] + b[axis])));
    Polytope::hull_of_lattice(dimension, sums.collect())
}

impl Polytope {
    /// All sums of a point here and a point there. `None` if dimensions differ or a coordinate is beyond
    /// 1024.
    #[must_use]
    pub fn minkowski_sum(&self, other: &Self) -> Option<Self> {
        if self.dimension == other.dimension {
            minkowski_sum_of(self.dimension, &self.vertices, &other.vertices)
        } else {
            None
        }
    }

    /// The shadow on these axes, in this order. `None` if an axis does not exist.
    #[must_use]
    pub fn project(&self, axes: &[usize]) -> Option<Self> {
        if axes.iter().any(|axis| *axis >= self.dimension) {
            return None;
        }
        let shadow = |vertex: &PolytopePoint| {
            let mut point = [0.0; MAX_DIMENSION];
            for (to, axis) in point.iter_mut().zip(axes) {
                *to = vertex[*axis];
            }
            point
        };
        Self::hull(axes.len(), &self.vertices.iter().map(shadow).collect::<Vec<_>>())
    }

    /// The cross-section at a value of a coordinate, in the other coordinates. `None` if it is empty or
    /// thinner than [`RESOLUTION`], and for an axis that does not exist.
    #[must_use]
    pub fn slice(&self, axis: usize, value: f64) -> Option<Self> {
        if axis >= self.dimension {
            return None;
        }
        let mut points = Vec::new();
        for (a, from) in self.vertices.iter().enumerate() {
            let below = from[axis] - value;
            if below.abs() <= RESOLUTION {
                points.push(without(from, axis));
            } else if below < 0.0 {
                for (b, to) in self.vertices.iter().enumerate() {
                    let above = to[axis] - value;
                    if above > RESOLUTION && self.incidence.joined(a, b, self.dimension) {
                        let share = below / (below - above);
                        let crossing: PolytopePoint =
                            std::array::from_fn(|i| from[i] + share * (to[i] - from[i]));
                        points.push(without(&crossing, axis));
                    }
                }
            }
        }
        Self::hull(self.dimension - 1, &points)
    }

    /// A facet, seen along an axis: the hull of its vertices in the other coordinates. `None` if the facet is
    /// seen edge on, and for a facet or axis that does not exist.
    #[must_use]
    pub fn facet_projected(&self, facet: usize, drop_axis: usize) -> Option<Self> {
        if drop_axis >= self.dimension {
            return None;
        }
        let points: Vec<PolytopePoint> =
            self.facet_vertices(facet).map(|vertex| without(&self.vertices[vertex], drop_axis)).collect();
        Self::hull(self.dimension - 1, &points)
    }
}

/// The point without a given coordinate.
fn without(point: &PolytopePoint, axis: usize) -> PolytopePoint {
    let mut rest = [0.0; MAX_DIMENSION];
    let others = point.iter().enumerate().filter(|(index, _)| *index != axis);
    for (to, (_, from)) in rest.iter_mut().zip(others) {
        *to = *from;
    }
    rest
}
