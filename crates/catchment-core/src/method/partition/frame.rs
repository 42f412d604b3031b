//! Conversion from the COR, whose lateral position spans the contact space, to the face centre, whose error
//! is requested.
//!
//! ```text
//!   (x, y) of the face centre = (x, y) of the COR + cor·(R ẑ)      a shear: it moves every rotation as a whole,
//!                                                                  so measures are the same on both sides
//! ```
//!
//! Between slices the offset is interpolated, as the composites are; adjacent parts therefore remain
//! adjacent.

use super::Partition;
use crate::polytope::{Halfspace, MAX_DIMENSION, Polytope, PolytopePoint};
use crate::pose::{PoseError, face_from_cor};

impl Partition {
    /// The sides of the error box, which holds *face centres*, over a part, whose coordinates are of the COR.
    pub(super) fn box_over(&self, cell: usize, region: &Polytope) -> Vec<Halfspace> {
        let shift = self.face_from_cor(cell, &region.centroid());
        let mut sides = Vec::new();
        for (k, dof) in self.alignment.free.iter().enumerate().filter(|(_, dof)| !dof.is_rotation()) {
            let (level, slope) = shift[dof.index()];
            let half = self.alignment.half_range(dof);
            for sign in [1.0, -1.0] {
                let mut normal = slope.map(|s| sign * s);
                normal[k] += sign;
                sides.extend(Halfspace::new(normal, half - sign * level));
            }
        }
        sides
    }

    /// Offset (x, y) of the face centre from the COR as an affine function of the coordinates, interpolated between the
    /// slices around a cell: (value at the origin, slope).
    pub(super) fn face_from_cor(&self, cell: usize, at: &PolytopePoint) -> [(f64, PolytopePoint); 2] {
        let compartment = &self.compartments[self.within[cell] as usize];
        let translations = self.alignment.free.len() - self.alignment.free.rotations();
        let spans = &compartment.spans;
        let shares: Vec<f64> = spans
            .iter()
            .enumerate()
            .map(|(k, (_, [low, high]))| (at[translations + k] - low) / (high - low))
            .collect();
        [0, 1].map(|component| {
            let (mut value, mut slope) = (0.0, [0.0; MAX_DIMENSION]);
            for corner in 0..1usize << spans.len() {
                let mut angles = [0.0; 5];
                let mut weights = Vec::with_capacity(spans.len());
                for (k, (dof, span)) in spans.iter().enumerate() {
                    let upper = corner >> k & 1;
                    angles[dof.index()] = span[upper];
                    weights.push(if upper == 1 { shares[k] } else { 1.0 - shares[k] });
                }
                let face = self.offset(&PoseError::from_array(angles))[component];
                value += face * weights.iter().product::<f64>();
                for (k, (_, [low, high])) in spans.iter().enumerate() {
                    let others: f64 =
                        weights.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, w)| w).product();
                    let sign = if corner >> k & 1 == 1 { 1.0 } else { -1.0 };
                    slope[translations + k] += sign * face * others / (high - low);
                }
            }
            let at_origin = value - slope.iter().zip(at).map(|(s, a)| s * a).sum::<f64>();
            (at_origin, slope)
        })
    }

    /// (x, y) of the face centre from the COR at a rotation, in D.
    pub(super) fn offset(&self, error: &PoseError) -> [f64; 2] {
        let face = face_from_cor(&error.rotation(), self.alignment.center_of_rotation);
        [face.x, face.y]
    }
}
