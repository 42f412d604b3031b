//! The partition of two errors as polygons, and the exact outline of the accepted set.
//!
//! ```text
//!    ┌──┬─────╱╲      edges of accepted parts, without edges that two accepted parts share:
//!    │  │   ╱    ╲    the rest is the border of the area of acceptance
//!    └──┴─╱───────
//! ```

use super::Partition;
use super::cells::{facing, lifted};
use crate::acceptance::Outcome;
use crate::polytope::{Polytope, PolytopePoint};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A polygon or a segment over two free errors: of the *face centre*, D and radians, in their order.
pub type Corner = [f64; 2];

impl Partition {
    /// All parts as polygons, counter-clockwise, with their outcomes; empty unless exactly two errors are
    /// free.
    pub fn polygons(&self) -> Vec<(Vec<Corner>, Outcome)> {
        if self.alignment.free.len() != 2 {
            return Vec::new();
        }
        self.labelled()
            .map(|(cell, region, outcome)| {
                let middle = region.centroid();
                let mut corners = region.vertices().to_vec();
                let angle = |p: &PolytopePoint| (p[1] - middle[1]).atan2(p[0] - middle[0]);
                corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
                let corners = corners.iter().map(|corner| self.of_face(cell, corner)).collect();
                (corners, outcome)
            })
            .collect()
    }

    /// The border of the accepted set, as segments; empty unless exactly two errors are free.
    pub fn outline(&self) -> Vec<[Corner; 2]> {
        if self.alignment.free.len() != 2 {
            return Vec::new();
        }
        let accepted: Vec<(usize, Polytope)> = self
            .labelled()
            .filter(|(_, _, outcome)| *outcome == Outcome::Aligned)
            .map(|(cell, region, _)| (cell, region))
            .collect();
        let boxed = |(k, (_, region)): (usize, &(usize, Polytope))| {
            let (low, high) = region.bounds();
            GeomWithData::new(Rectangle::from_corners(low, high), k)
        };
        let index = RTree::bulk_load(accepted.iter().enumerate().map(boxed).collect());
        let mut segments = Vec::new();
        for (k, (cell, region)) in accepted.iter().enumerate() {
            let (low, high) = region.bounds();
            let envelope = AABB::from_corners(low, high);
            let mut near: Vec<usize> =
                index.locate_in_envelope_intersecting(envelope).map(|boxed| boxed.data).collect();
            near.sort_unstable();
            for (facet, plane) in region.facets().iter().enumerate() {
                let dropped = usize::from(plane.normal[1].abs() > plane.normal[0].abs());
                let mut open: Vec<Polytope> = region.facet_projected(facet, dropped).into_iter().collect();
                for (_, other) in near.iter().filter(|other| **other != k).map(|other| &accepted[*other]) {
                    let Some(side) =
                        facing(other, plane).and_then(|back| other.facet_projected(back, dropped))
                    else {
                        continue;
                    };
                    open = open.iter().flat_map(|part| part.difference(&side)).collect();
                }
                for part in open {
                    let (low, high) = part.bounds();
                    segments.push([low, high].map(|y| self.of_face(*cell, &lifted(&y, plane, dropped))));
                }
            }
        }
        segments
    }

    /// Two errors of the face centre from those of the COR.
    fn of_face(&self, cell: usize, q: &PolytopePoint) -> Corner {
        let shift = self.face_from_cor(cell, q);
        let mut corner = [q[0], q[1]];
        for (value, dof) in
            corner.iter_mut().zip(self.alignment.free.iter()).filter(|(_, d)| !d.is_rotation())
        {
            let (level, slope) = shift[dof.index()];
            *value += level + slope.iter().zip(q).map(|(s, q)| s * q).sum::<f64>();
        }
        corner
    }
}
