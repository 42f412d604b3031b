//! Coplanar triangles merged into convex polygons: the same solid with fewer facets, and without edges inside
//! its faces.
//!
//! ```text
//!   ┌────┬───┐        ┌────────┐
//!   │ ╲  │  ╱│        │        │      an edge is removed if both its sides are coplanar and the result
//!   │  ╲ │ ╱ │   ──▶  │        │      is convex at both of its ends, the longest first;
//!   │   ╲│╱  │        │        │      then corners of only two facets are removed, on the line between their neighbours
//!   └────┴───┘        └────────┘
//! ```
//!
//! This is a convex partition by removal of diagonals (Hertel and Mehlhorn, 1983), which has at most four
//! times the minimum number of polygons; here with at most [`MOST_CORNERS`] corners each. Corners inside a
//! face remain if more than two polygons meet at them. A mesh whose triangles are not mirror images of each
//! other, such as the two halves of a square, becomes symmetric if its polygons are symmetric.

use super::indexed::Indexed;
use super::sides::{Side, Sides};
use catchment_base::tolerance;
use glam::DVec3;
use std::collections::HashSet;

/// Largest distance of a polygon's corners from its plane, and from the line between their neighbours,
/// relative to the distance below which two points are merged: the rounding of computed coordinates. Faces
/// that single precision bends, however little, stay bent: on flush faces a common plane that differs
/// slightly from theirs would misguide a half.
pub(super) const FLAT: f64 = tolerance::SINGLE;

/// Largest number of corners of a polygon: the test whether a point is on it checks every side.
const MOST_CORNERS: usize = 16;

/// No half-edge.
const NONE: u32 = u32::MAX;
/// Triangles whose normals differ by more than this cosine are not merged, however thin they are.
const SAME_WAY: f64 = 0.5;

/// The corners and the polygons of a closed mesh; corners without a polygon are removed. `flat` is the
/// largest distance of corners from the plane of their polygon, and from the line between their neighbours,
/// in the coordinates of the mesh.
pub(super) fn of(mesh: &Indexed, flat: f64) -> (Vec<DVec3>, Vec<Vec<u32>>) {
    let mut rings = Rings::of(mesh, flat);
    // A join that is not convex yet may become convex after a neighbouring join.
    let mut edges = rings.inner_edges();
    let mut before = usize::MAX;
    while edges.len() < before {
        before = edges.len();
        edges.retain(|edge| !rings.join(*edge));
    }
    rings.straighten();
    rings.finish()
}

/// Polygons as rings of half-edges; half-edge 3t + k starts at corner k of triangle t.
struct Rings<'a> {
    mesh: &'a Indexed,
    next: Vec<u32>,
    before: Vec<u32>,
    /// The same edge as the neighbour runs along it.
    twin: Vec<u32>,
    /// The corner at which a half-edge starts; none for a removed half-edge.
    from: Vec<u32>,
    /// Leads from a triangle to the largest triangle of its polygon, whose plane is that of the polygon.
    larger: Vec<u32>,
    /// Of each triangle, its normal times twice its area.
    areas: Vec<DVec3>,
    flat: f64,
}

impl<'a> Rings<'a> {
    fn of(mesh: &'a Indexed, flat: f64) -> Self {
        let count = mesh.triangles.len() as u32;
        let turned = |step: u32| (0..3 * count).map(move |h| h - h % 3 + (h + step) % 3);
        let from: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
        let mut twin = vec![NONE; from.len()];
        for sides in Sides::of(&mesh.triangles).edges() {
            let start = |side: &Side| side.edge[usize::from(!side.is_up)];
            let half = |side: &Side| {
                (0..3).map(|k| 3 * side.triangle + k).find(|h| from[*h as usize] == start(side))
            };
            if let [Some(a), Some(b)] = [sides.first(), sides.last()].map(|side| side.and_then(half)) {
                (twin[a as usize], twin[b as usize]) = (b, a);
            }
        }
        let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
        Self {
            next: turned(1).collect(),
            before: turned(2).collect(),
            twin,
            from,
            larger: (0..count).collect(),
            areas: (0..count as usize).map(|t| area(mesh.corners(t))).collect(),
            flat,
            mesh,
        }
    }

    fn next(&self, half: u32) -> u32 {
        self.next[half as usize]
    }

    fn before(&self, half: u32) -> u32 {
        self.before[half as usize]
    }

    fn twin(&self, half: u32) -> u32 {
        self.twin[half as usize]
    }

    /// Start of a half-edge.
    fn start(&self, half: u32) -> DVec3 {
        self.mesh.at(self.from[half as usize])
    }

    fn has_gone(&self, half: u32) -> bool {
        self.from[half as usize] == NONE
    }

    /// Links two successive half-edges.
    fn link(&mut self, half: u32, next: u32) {
        self.next[half as usize] = next;
        self.before[next as usize] = half;
    }

    /// The largest triangle of the polygon that a half-edge borders.
    fn polygon(&mut self, half: u32) -> u32 {
        let mut triangle = half / 3;
        while self.larger[triangle as usize] != triangle {
            let above = self.larger[triangle as usize];
            self.larger[triangle as usize] = self.larger[above as usize];
            triangle = above;
        }
        triangle
    }

    /// Edges whose two triangles may be merged, the longest first.
    fn inner_edges(&self) -> Vec<u32> {
        let mut edges: Vec<(f64, u32)> = (0..self.from.len() as u32)
            .filter(|&half| half < self.twin(half) && self.twin(half) != NONE)
            .filter(|&half| {
                let [a, b] = [half, self.twin(half)].map(|h| self.areas[h as usize / 3].normalize_or_zero());
                a.dot(b) > SAME_WAY
            })
            .map(|half| (self.start(half).distance(self.start(self.next(half))), half))
            .collect();
        edges.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        edges.into_iter().map(|(_, half)| half).collect()
    }

    /// Merges the two polygons along an edge if the result is convex; returns whether nothing is left to do
    /// there.
    fn join(&mut self, edge: u32) -> bool {
        if self.has_gone(edge) {
            return true;
        }
        let [own, other] = [edge, self.twin(edge)].map(|half| self.polygon(half));
        if own == other {
            return true;
        }
        // The whole run of edges that the two polygons share.
        let (mut first, mut last) = (edge, edge);
        while self.twin(self.before(first)) == self.next(self.twin(first)) && self.before(first) != last {
            first = self.before(first);
        }
        while self.twin(self.next(last)) == self.before(self.twin(last)) && self.next(last) != first {
            last = self.next(last);
        }
        let shared = 1 + self.along(first).position(|half| half == last).unwrap_or(0);
        let sides: usize = [first, self.twin(first)].map(|half| self.along(half).count()).iter().sum();
        if sides - 2 * shared > MOST_CORNERS {
            return true;
        }
        let [into, out] = [self.before(first), self.next(self.twin(first))];
        let [back, on] = [self.before(self.twin(last)), self.next(last)];
        let area = |triangle: u32| self.areas[triangle as usize];
        let (plane, joins) = if area(own).length_squared() >= area(other).length_squared() {
            (own, self.twin(edge))
        } else {
            (other, edge)
        };
        let normal = area(plane).normalize_or_zero();
        if !self.is_convex([into, out], normal)
            || !self.is_convex([back, on], normal)
            || !self.lies_in(joins, plane, normal)
        {
            return false;
        }
        self.larger[(own + other - plane) as usize] = plane;
        let gone: Vec<u32> = self.along(first).take(shared).collect();
        for half in gone {
            let twin = self.twin(half);
            self.from[half as usize] = NONE;
            self.from[twin as usize] = NONE;
        }
        self.link(into, out);
        self.link(back, on);
        true
    }

    /// Whether a border that passes from one half-edge to another turns left there, or hardly turns.
    fn is_convex(&self, [into, out]: [u32; 2], normal: DVec3) -> bool {
        let corner = self.start(out);
        let (along, away) = (corner - self.start(into), self.start(self.next(out)) - corner);
        let turn = normal.dot(along.cross(away));
        let straight = self.flat * (along + away).length();
        turn > straight || (turn >= -straight && along.dot(away) > 0.0)
    }

    /// Whether all corners of the ring of a half-edge lie in the plane of a triangle.
    fn lies_in(&self, ring: u32, triangle: u32, normal: DVec3) -> bool {
        let [origin, ..] = self.mesh.corners(triangle as usize);
        self.along(ring).all(|half| normal.dot(self.start(half) - origin).abs() <= self.flat)
    }

    /// The half-edges of a ring, starting from the given half-edge.
    fn along(&self, ring: u32) -> impl Iterator<Item = u32> {
        std::iter::successors(Some(ring), move |half| Some(self.next(*half)).filter(|next| *next != ring))
    }

    /// Removes corners that exactly two polygons share, on the line between their neighbours. If the
    /// neighbours already have an edge, for example because a solid touches itself along it, the corner
    /// stays.
    fn straighten(&mut self) {
        let mut edges: HashSet<[u32; 2]> = (0..self.from.len() as u32)
            .filter(|half| !self.has_gone(*half))
            .map(|half| [half, self.next(half)].map(|half| self.from[half as usize]))
            .collect();
        for half in 0..self.from.len() as u32 {
            if self.has_gone(half) {
                continue;
            }
            let [before, twin] = [self.before(half), self.twin(half)];
            let after = self.next(twin);
            let is_triangle = |h: u32| self.next(self.next(self.next(h))) == h;
            if after != self.twin(before) || is_triangle(half) || is_triangle(twin) {
                continue;
            }
            let corner = self.start(half);
            let (along, away) = (corner - self.start(before), self.start(self.next(half)) - corner);
            let whole = along + away;
            if along.dot(away) <= 0.0 || along.cross(away).length() > self.flat * whole.length() {
                continue;
            }
            let [a, b] = [before, self.next(half)].map(|half| self.from[half as usize]);
            if edges.contains(&[a, b]) || edges.contains(&[b, a]) {
                continue;
            }
            edges.extend([[a, b], [b, a]]);
            self.from[half as usize] = NONE;
            self.from[after as usize] = NONE;
            self.link(before, self.next(half));
            self.link(twin, self.next(after));
            (self.twin[before as usize], self.twin[twin as usize]) = (twin, before);
        }
    }

    /// The rings, with the corners that are left numbered anew in their order.
    fn finish(&self) -> (Vec<DVec3>, Vec<Vec<u32>>) {
        let mut numbers = vec![NONE; self.mesh.vertices.len()];
        for corner in self.from.iter().filter(|corner| **corner != NONE) {
            numbers[*corner as usize] = 0;
        }
        let mut vertices = Vec::new();
        for (number, at) in numbers.iter_mut().zip(&self.mesh.vertices).filter(|(number, _)| **number == 0) {
            *number = vertices.len() as u32;
            vertices.push(*at);
        }
        let mut is_reported = vec![false; self.from.len()];
        let mut polygons = Vec::new();
        for half in 0..self.from.len() as u32 {
            let mut polygon = Vec::new();
            let mut at = half;
            while !self.has_gone(at) && !std::mem::replace(&mut is_reported[at as usize], true) {
                polygon.push(numbers[self.from[at as usize] as usize]);
                at = self.next(at);
            }
            if !polygon.is_empty() {
                polygons.push(polygon);
            }
        }
        (vertices, polygons)
    }
}
