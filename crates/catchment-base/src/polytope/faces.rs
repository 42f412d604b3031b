//! From a hull's simplices to a polytope's facets.
//!
//! Coplanar simplices form a single facet, and a point that is not a corner of any face (it lies on no facet
//! that excludes some other vertex) is not a vertex. First, simplices that are coplanar up to rounding count
//! as coplanar: this removes the splinters that rounding leaves on facets with many vertices. If any vertex
//! is uncertain (see [`Gap`]) or the edges do not close, only exactly coplanar simplices are merged; that is
//! always correct, and may keep splinters.

use super::exact::{self, SPACING};
use super::hull::Hull;
use super::incidence::Incidence;
use super::{Gap, Halfspace, Polytope};
use std::cmp::Ordering;

impl Hull {
    /// The polytope with this boundary; `None` if it is thinner than [`super::RESOLUTION`].
    pub(super) fn into_polytope(mut self) -> Option<Polytope> {
        self.simplices.iter_mut().for_each(|simplex| simplex.plane.refine());
        let mut vertices: Vec<usize> =
            self.simplices.iter().flat_map(|s| &s.vertices[..self.dimension]).copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut order: Vec<usize> = (0..self.simplices.len()).collect();
        order.sort_by(|a, b| self.simplices[*b].plane.size.total_cmp(&self.simplices[*a].plane.size));
        self.faces(&vertices, &order, true).or_else(|| self.faces(&vertices, &order, false))
    }

    /// Merges coplanar simplices, the largest first, because its plane is the most accurate. `None` if
    /// `nearly` and uncertain.
    fn faces(&self, vertices: &[usize], order: &[usize], nearly: bool) -> Option<Polytope> {
        let mut taken = vec![false; self.simplices.len()];
        let mut facets: Vec<Halfspace> = Vec::new();
        // Vertex and facet.
        let mut incident: Vec<(usize, usize)> = Vec::new();
        let mut on = vec![false; self.points.len()];
        let mut gap = Gap::NEW;
        for &seed in order {
            if taken[seed] {
                continue;
            }
            let plane = &self.simplices[seed].plane;
            for &vertex in vertices {
                let point = &self.points[vertex];
                on[vertex] = if nearly {
                    gap.is_on(plane.height(point) * SPACING)
                } else {
                    plane.side(point) == Ordering::Equal
                };
                if on[vertex] {
                    incident.push((vertex, facets.len()));
                }
            }
            if !gap.is_clear() {
                return None;
            }
            taken[seed] = true;
            let mut reached = vec![seed];
            while let Some(simplex) = reached.pop() {
                for &next in &self.simplices[simplex].neighbours[..self.dimension] {
                    let beside = &self.simplices[next];
                    // Behind a sharp edge lies another facet, however near.
                    if !taken[next]
                        && beside.vertices[..self.dimension].iter().all(|v| on[*v])
                        && super::dot(&beside.plane.unit, &plane.unit) > 0.0
                    {
                        taken[next] = true;
                        reached.push(next);
                    }
                }
            }
            let offset = super::dot(&plane.unit, &exact::coordinates(plane.through()));
            facets.push(Halfspace { normal: plane.unit, offset });
        }
        incident.sort_unstable();
        let mut all = Incidence::new(vertices.len(), facets.len());
        for group in incident.chunk_by(|a, b| a.0 == b.0) {
            all.push(group.iter().map(|(_, facet)| *facet));
        }
        let is_corner = |vertex: usize| {
            let row = all.row(vertex);
            (0..all.rows()).all(|other| {
                let within = row.iter().zip(all.row(other)).all(|(a, b)| a & !b == 0);
                // Of two vertices in the same place, the first remains.
                !within || other == vertex || (vertex < other && row == all.row(other))
            })
        };
        let corners: Vec<usize> = (0..vertices.len()).filter(|vertex| is_corner(*vertex)).collect();
        let mut incidence = Incidence::new(corners.len(), facets.len());
        for &corner in &corners {
            incidence.push(super::incidence::ones(all.row(corner).iter().copied()));
        }
        // If no facets were merged, the faces are those of the hull, which is closed.
        let simplicial =
            facets.len() == self.simplices.len() && incident.len() == self.dimension * facets.len();
        if nearly && !simplicial && !incidence.is_sound(self.dimension, facets.len()) {
            return None;
        }
        let points = corners.iter().map(|c| exact::coordinates(&self.points[vertices[*c]])).collect();
        Polytope::assembled(self.dimension, facets, points, incidence)
    }
}
