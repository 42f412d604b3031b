//! Section of a solid just above a plane, or just below it.
//!
//! ```text
//!        ╱╲             corners in the plane do not count as above it. A facet with corners of both kinds
//!       ╱  ╲            rises through the plane at one edge and descends at another; these crossings form closed loops
//!   ───×────×──── plane    around the filled area
//!     ╱______╲
//! ```
//!
//! This is the limit of sections that approach the plane. A face in the plane is filled if its solid is above
//! it, and empty if its solid is below.

use super::planes::Model;
use glam::DVec3;
use std::collections::BTreeMap;

/// An edge by the numbers of its ends, the lower number first.
type Edge = [u32; 2];

/// Solids cut by a plane.
#[derive(Debug)]
pub(super) struct Cutter {
    plane: u32,
    /// The points at which edges pass the plane.
    made: BTreeMap<Edge, u32>,
}

impl Cutter {
    pub(super) const fn new(plane: u32) -> Self {
        Self { plane, made: BTreeMap::new() }
    }

    /// Closed loops, by the numbers of points, around the section of a solid above the plane, or below it.
    /// Creates the points at which edges pass.
    pub(super) fn filled(&mut self, model: &mut Model, solid: u32, is_above: bool) -> Vec<Vec<u32>> {
        let heights = Heights::of(model, self.plane, solid, is_above);
        // Maps the edge at which a facet descends through the plane to the edge at which it rose.
        let mut next: BTreeMap<Edge, Edge> = BTreeMap::new();
        for k in model.of_solid[solid as usize].clone() {
            let corners = &model.facets[k as usize].corners;
            let count = corners.len();
            let is_up = |i: usize| heights.at(&model.points, corners[i % count]) > 0.0;
            let edge = |i: usize| {
                let [a, b] = [corners[i % count], corners[(i + 1) % count]];
                [a.min(b), a.max(b)]
            };
            let Some(start) = (0..count).find(|i| !is_up(*i) && is_up(i + 1)) else { continue };
            let mut came_up = edge(start);
            for i in start + 1..start + count {
                match (is_up(i), is_up(i + 1)) {
                    (false, true) => came_up = edge(i),
                    (true, false) => {
                        next.insert(edge(i), came_up);
                    }
                    _ => {}
                }
            }
        }
        let mut loops = Vec::new();
        while let Some((&first, _)) = next.iter().next() {
            let mut ring: Vec<u32> = Vec::new();
            let mut at = first;
            while let Some(following) = next.remove(&at) {
                let point = self.passing(model, &heights, at);
                if ring.last() != Some(&point) {
                    ring.push(point);
                }
                at = following;
            }
            while ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            if ring.len() > 2 {
                loops.push(ring);
            }
        }
        loops
    }

    /// The point at which an edge passes the plane: an end in the plane, or a new point.
    fn passing(&mut self, model: &mut Model, heights: &Heights, edge: Edge) -> u32 {
        let [from, to] = edge.map(|end| heights.at(&model.points, end));
        if from == 0.0 {
            return edge[0];
        }
        if to == 0.0 {
            return edge[1];
        }
        *self.made.entry(edge).or_insert_with(|| {
            let [p, q] = edge.map(|end| model.points[end as usize]);
            model.points.push(p.lerp(q, from / (from - to)));
            model.points.len() as u32 - 1
        })
    }
}

/// Heights of the corners of a solid above a plane.
struct Heights {
    normal: DVec3,
    level: f64,
    on_plane: f64,
    /// Corners of facets of the plane: they lie in it regardless of rounding.
    level_corners: Vec<u32>,
}

impl Heights {
    fn of(model: &Model, plane: u32, solid: u32, is_above: bool) -> Self {
        let side = if is_above { 1.0 } else { -1.0 };
        let own = &model.of_solid[solid as usize];
        let members = model.members[plane as usize].iter().filter(|k| own.contains(k));
        let mut level_corners: Vec<u32> =
            members.flat_map(|k| model.facets[*k as usize].corners.iter().copied()).collect();
        level_corners.sort_unstable();
        let plane = model.planes[plane as usize];
        Self {
            normal: plane.normal * side,
            level: plane.level * side,
            on_plane: model.on_plane(),
            level_corners,
        }
    }

    /// The height of a corner, 0 in the plane.
    fn at(&self, points: &[DVec3], corner: u32) -> f64 {
        let height = self.normal.dot(points[corner as usize]) - self.level;
        if height.abs() <= self.on_plane || self.level_corners.binary_search(&corner).is_ok() {
            0.0
        } else {
            height
        }
    }
}
