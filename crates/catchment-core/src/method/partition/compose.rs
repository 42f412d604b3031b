//! Corresponding Polytopal Composition: rotation slices of a half, joined into polytopes of one dimension more.
//!
//! ```text
//!   angle                     every polytope of one slice with each vertex of the same polytope in the next,
//!    ▲    ┌───┐  slice i+1    and every polytope of the next with each vertex of the first:
//!    │   ╱│╲  │
//!    │  ╱ │ ╲ │               hull(P_i ∪ v_j(i+1)),   hull(P_i+1 ∪ v_j(i)),   j = 1 … k
//!    │ ┌──┴┐ ╲│
//!    │ └───┘  slice i         2k polytopes for k vertices: their union keeps hollows
//! ```
//!
//! The composition is repeated for roll, pitch and yaw, in the order of `R = Rz(yaw)·Ry(pitch)·Rx(roll)`. The
//! other half is flat in every angle: the sum is taken slice by slice. (Dissertation, section 5.1.2,
//! algorithm 1.)
//!
//! Not promised: between two slices a vertex runs along the chord of its circle, so a composite is too small
//! there by up to `r(1 − cos(Δ/2))`; and an edge rotates by Δ about *each* of its ends, so a composite bulges
//! by up to `L·Δ/4` over an edge of length L, with slopes that are wrong by as much as `L/2` however fine the
//! slices. Cutting the half into strips first makes L small; see [`super::Settings::strips`].

use super::pieces::Piece;
use crate::polytope::PolytopePoint;
use crate::pose::Dof;
use std::array;

/// An interval between neighbouring slices for every free rotation: roll, pitch, yaw if free.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Compartment {
    /// Angle and its lower and upper slice, in radians.
    pub(super) spans: Vec<(Dof, [f64; 2])>,
}

impl Compartment {
    /// All of them, for slices of each free rotation; the first rotation runs fastest.
    pub(super) fn all(slices: &[(Dof, Vec<f64>)]) -> Vec<Self> {
        slices.iter().fold(vec![Self { spans: Vec::new() }], |compartments, (dof, angles)| {
            angles
                .windows(2)
                .flat_map(|span| {
                    compartments.iter().map(|inner| {
                        let mut spans = inner.spans.clone();
                        spans.push((*dof, [span[0], span[1]]));
                        Self { spans }
                    })
                })
                .collect()
        })
    }
}

/// Angles of the slices over ±`half_range`: multiples of `2·half_range/count` and the two ends. The aligned angle is
/// always a slice, because a composite is exact on slices only.
pub(super) fn slices(half_range: f64, count: usize) -> Vec<f64> {
    let step = 2.0 * half_range / count as f64;
    let whole = count / 2;
    let mut angles: Vec<f64> = (0..=2 * whole).map(|k| (k as f64 - whole as f64) * step).collect();
    if count % 2 == 1 {
        angles.insert(0, -half_range);
        angles.push(half_range);
    }
    angles
}

/// Coordinates are rounded to multiples of this, in D: sums of two such numbers are exact, so facets that are parallel
/// in both halves are parallel, to the bit, in their Minkowski sum.
const LATTICE: f64 = 1.0 / (1u64 << 40) as f64;

fn snapped(value: f64) -> f64 {
    (value / LATTICE).round() * LATTICE
}

/// The point reflection of a piece, turned through a compartment: vertex lists over (x, y, z, angles…), or (x, z, angle)
/// of a planar piece.
pub(super) fn compose(piece: &Piece, compartment: &Compartment) -> Vec<Vec<PolytopePoint>> {
    let reflected = piece.vertices.iter().map(|v| array::from_fn(|k| -v[k])).collect();
    let mut composites: Vec<Vec<PolytopePoint>> = vec![reflected];
    for (k, (dof, span)) in compartment.spans.iter().enumerate() {
        let axis = piece.dimension + k;
        composites = composites
            .iter()
            .flat_map(|polytope| {
                let [lower, upper] = span.map(|angle| slice(polytope, piece.dimension, *dof, angle, axis));
                let ends = [(lower.clone(), upper.clone()), (upper, lower)];
                ends.into_iter().flat_map(|(slice, other)| {
                    other.into_iter().map(move |vertex| {
                        let mut joined = slice.clone();
                        joined.push(vertex);
                        joined
                    })
                })
            })
            .collect();
    }
    composites
}

/// How many composites a piece has in a compartment of so many rotations.
pub(super) fn count(piece: &Piece, rotations: usize) -> u64 {
    let corners = piece.vertices.len() as u64;
    (0..rotations as u64).map(|k| 2 * (corners + k)).product()
}

/// The vertices, turned by an angle that becomes their coordinate `axis`.
fn slice(
    vertices: &[PolytopePoint],
    dimension: usize,
    dof: Dof,
    angle: f64,
    axis: usize,
) -> Vec<PolytopePoint> {
    let (sine, cosine) = angle.sin_cos();
    // The two coordinates that turn: from the first towards the second.
    let (a, b) = match (dof, dimension) {
        (Dof::Roll, _) => (1, 2),
        (Dof::Yaw, _) => (0, 1),
        (_, 2) => (1, 0),
        _ => (2, 0),
    };
    let turn = |v: &PolytopePoint| {
        let mut turned = *v;
        turned[a] = snapped(v[a] * cosine - v[b] * sine);
        turned[b] = snapped(v[a] * sine + v[b] * cosine);
        turned[axis] = angle;
        turned
    };
    vertices.iter().map(turn).collect()
}

#[cfg(test)]
mod tests {
    use super::super::pieces::EVERYWHERE;
    use super::*;
    use crate::polytope::Polytope;
    use crate::pose::PoseError;
    use glam::DVec3;

    fn point(v: &[f64]) -> PolytopePoint {
        array::from_fn(|k| v.get(k).copied().unwrap_or(0.0))
    }

    fn piece<const N: usize>(dimension: usize, corners: &[[f64; N]]) -> Piece {
        let vertices = corners.iter().map(|corner| point(corner)).collect();
        Piece { dimension, vertices, number: 0, slab: EVERYWHERE }
    }

    #[test]
    fn slices_hold_the_aligned_angle_and_both_ends() {
        assert_eq!(slices(1.0, 4), [-1.0, -0.5, 0.0, 0.5, 1.0]);
        let odd = slices(1.5, 3);
        assert_eq!(odd, [-1.5, -1.0, 0.0, 1.0, 1.5]);
    }

    #[test]
    fn compositions_count_two_per_vertex_and_rotation() {
        let simplex = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let piece = piece(3, &simplex);
        let spans = vec![(Dof::Pitch, [0.0, 0.1]), (Dof::Yaw, [0.0, 0.2])];
        let composites = compose(&piece, &Compartment { spans });
        assert_eq!(composites.len(), 8 * 10);
        assert!(composites.iter().all(|c| c.len() == 6));
    }

    #[test]
    fn on_slices_the_composite_is_the_turned_half() {
        let corners = [[0.3, 0.1, -0.2], [1.0, 0.0, 0.4], [0.0, 1.0, 0.1], [0.2, 0.3, 1.0]];
        let piece = piece(3, &corners);
        let (pitch, yaw) = (0.4, -0.7);
        let spans = vec![(Dof::Pitch, [pitch, 0.6]), (Dof::Yaw, [-0.9, yaw])];
        let rotation = PoseError { pitch, yaw, ..PoseError::default() }.rotation();
        let composites = compose(&piece, &Compartment { spans });
        for corner in corners {
            let turned = rotation * -DVec3::from(corner);
            let expected = [turned.x, turned.y, turned.z, pitch, yaw];
            // Rounded twice to the lattice, once per rotation.
            let near = |v: &PolytopePoint| (0..5).all(|k| (v[k] - expected[k]).abs() < 4.0 * LATTICE);
            assert!(composites.iter().flatten().any(near), "{expected:?}");
        }
    }

    #[test]
    fn a_planar_composite_fills_a_thin_wedge() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let piece = piece(2, &square);
        let span = [0.0, 0.01];
        let composites = compose(&piece, &Compartment { spans: vec![(Dof::Pitch, span)] });
        assert_eq!(composites.len(), 8);
        let volumes: f64 = composites.iter().filter_map(|c| Polytope::hull(3, c)).map(|p| p.volume()).sum();
        // Eight cones over squares of area 1, each a third of the span high, overlapping.
        assert!((volumes - 8.0 / 3.0 * 0.01).abs() < 1e-4, "{volumes}");
    }
}
