//! The convex hull of lattice points as simplices, with every decision exact.
//!
//! ```text
//!        p                     Each outer point waits at a facet that it sees. The highest point, p, is processed:
//!      ╱ : ╲                   the facets it sees (dotted) are removed, and each ridge between a visible and a
//!    ╱···:···╲                 hidden facet is joined to p. Points that waited at removed facets wait
//!   ╱_________╲                at new facets, or are inside.
//! ```
//!
//! "Sees" is strict: a facet whose plane contains p stays, and the new simplices beside it are coplanar with
//! it. That is correct for any points (a visible facet cannot be coplanar with a ridge's join, so no join is
//! flat), and [`super::faces`] merges coplanar simplices. The order of the points has no effect: they are
//! sorted.
//!
//! Cost: a normal for each new simplex, and a height for each waiting point of a removed facet and each new
//! facet.
//!
//! Source: Barber, Dobkin, Huhdanpaa, *The Quickhull algorithm for convex hulls*, ACM TOMS 22 (1996), without its
//! tolerances.

use super::exact::{self, Lattice, Plane};
use super::{MAX_DIMENSION, PolytopePoint, RESOLUTION};
use std::cmp::Ordering;

/// No facet.
const NONE: usize = usize::MAX;

/// A facet of the hull: a simplex. Its i-th neighbour is opposite its i-th vertex.
pub(super) struct Simplex {
    pub(super) vertices: [usize; MAX_DIMENSION],
    pub(super) neighbours: [usize; MAX_DIMENSION],
    pub(super) plane: Plane,
    alive: bool,
    /// The last point found not to see it.
    unseen_from: usize,
}

/// The boundary of a hull, a closed surface of simplices.
pub(super) struct Hull {
    pub(super) dimension: usize,
    /// All points, without repetitions.
    pub(super) points: Vec<Lattice>,
    /// Simplices; their vertices and neighbours are indices.
    pub(super) simplices: Vec<Simplex>,
}

/// Data of an incomplete hull besides its simplices.
struct Waiting {
    /// For each point, a facet that it sees, or [`NONE`].
    facet: Vec<usize>,
    /// How high above that facet.
    height: Vec<f64>,
}

impl Hull {
    /// The hull of `points` in dimension 2 or more; `None` if all of them lie in a subspace up to
    /// [`RESOLUTION`].
    pub(super) fn of(dimension: usize, mut points: Vec<Lattice>) -> Option<Self> {
        points.sort_unstable();
        points.dedup();
        let corners = first_simplex(dimension, &points)?;
        let mut simplices = Vec::new();
        for (index, &opposite) in corners.iter().enumerate() {
            let mut vertices = [0; MAX_DIMENSION];
            let mut neighbours = [NONE; MAX_DIMENSION];
            let others = (0..=dimension).filter(|other| *other != index);
            for ((vertex, neighbour), other) in vertices.iter_mut().zip(&mut neighbours).zip(others) {
                *vertex = corners[other];
                *neighbour = other;
            }
            let plane = Plane::new(dimension, &vertices.map(|v| points[v]), &points[opposite])?;
            simplices.push(Simplex { vertices, neighbours, plane, alive: true, unseen_from: NONE });
        }
        let mut hull = Self { dimension, points, simplices };
        let count = hull.points.len();
        let mut waiting = Waiting { facet: vec![NONE; count], height: vec![0.0; count] };
        for point in 0..count {
            hull.wait(point, 0, &mut waiting);
        }
        while let Some(point) = waiting.highest() {
            hull.join(point, &mut waiting)?;
        }
        hull.drop_dead();
        Some(hull)
    }

    /// Assigns a point to the facet, from `first` on, above which it is highest, if it sees any.
    fn wait(&self, point: usize, first: usize, waiting: &mut Waiting) {
        let at = &self.points[point];
        let (mut best, mut above) = (NONE, 0.0);
        for (facet, simplex) in self.simplices.iter().enumerate().skip(first) {
            if !simplex.alive {
                continue;
            }
            let (side, height) = simplex.plane.side_and_height(at);
            if side == Ordering::Greater && (best == NONE || height > above) {
                (best, above) = (facet, height);
            }
        }
        (waiting.facet[point], waiting.height[point]) = (best, above);
    }

    /// Adds a waiting point to the hull. `None` only if the surface were not closed, which exact signs
    /// exclude.
    fn join(&mut self, point: usize, waiting: &mut Waiting) -> Option<()> {
        let dimension = self.dimension;
        let at = self.points[point];
        let fresh = self.simplices.len();
        let mut seen = vec![waiting.facet[point]];
        let mut horizon = Vec::new();
        self.simplices[seen[0]].alive = false;
        let mut next = 0;
        while let Some(&facet) = seen.get(next) {
            next += 1;
            for slot in 0..dimension {
                let beyond = self.simplices[facet].neighbours[slot];
                if !self.simplices[beyond].alive {
                    continue;
                }
                if self.simplices[beyond].unseen_from != point {
                    if self.simplices[beyond].plane.side(&at) == Ordering::Greater {
                        self.simplices[beyond].alive = false;
                        seen.push(beyond);
                        continue;
                    }
                    self.simplices[beyond].unseen_from = point;
                }
                horizon.push((facet, slot, beyond));
            }
        }
        for (made, &(facet, slot, beyond)) in horizon.iter().enumerate() {
            let old = &self.simplices[facet];
            let (mut vertices, mut neighbours) = (old.vertices, [NONE; MAX_DIMENSION]);
            // The vertex of the removed facet behind the ridge lies inside, strictly below the new facet.
            let below = self.points[vertices[slot]];
            vertices[slot] = point;
            neighbours[slot] = beyond;
            let plane = Plane::new(dimension, &vertices.map(|v| self.points[v]), &below)?;
            let back = self.slot_of(beyond, facet)?;
            self.simplices[beyond].neighbours[back] = fresh + made;
            self.simplices[facet].neighbours[slot] = fresh + made;
            self.simplices.push(Simplex { vertices, neighbours, plane, alive: true, unseen_from: NONE });
        }
        for (made, &(facet, slot, _)) in horizon.iter().enumerate() {
            for other in (0..dimension).filter(|other| *other != slot) {
                let result = self.around(facet, slot, other, fresh, seen.len())?;
                self.simplices[fresh + made].neighbours[other] = result;
            }
        }
        waiting.facet[point] = NONE;
        for point in 0..self.points.len() {
            if waiting.facet[point] != NONE && !self.simplices[waiting.facet[point]].alive {
                self.wait(point, fresh, waiting);
            }
        }
        Some(())
    }

    /// Position of the ridge to `neighbour` in `simplex`.
    fn slot_of(&self, simplex: usize, neighbour: usize) -> Option<usize> {
        self.simplices[simplex].neighbours[..self.dimension].iter().position(|n| *n == neighbour)
    }

    /// The new facet beside the facet that replaced `facet` at `slot`, across the ridge opposite vertex
    /// `other`: found by going around their common ridge through removed facets, to the first new facet.
    fn around(
        &self,
        mut facet: usize,
        slot: usize,
        mut other: usize,
        fresh: usize,
        limit: usize,
    ) -> Option<usize> {
        let mut left = self.simplices[facet].vertices[slot];
        for _ in 0..=limit {
            let next = self.simplices[facet].neighbours[other];
            if next >= fresh {
                return Some(next);
            }
            let entered = self.slot_of(next, facet)?;
            let vertices = &self.simplices[next].vertices[..self.dimension];
            other = vertices.iter().position(|v| *v == left)?;
            left = vertices[entered];
            facet = next;
        }
        None
    }

    /// Forgets the facets that went.
    fn drop_dead(&mut self) {
        let mut kept = 0;
        let places: Vec<usize> = self
            .simplices
            .iter()
            .map(|simplex| {
                kept += usize::from(simplex.alive);
                if simplex.alive { kept - 1 } else { NONE }
            })
            .collect();
        self.simplices.retain(|simplex| simplex.alive);
        for simplex in &mut self.simplices {
            for neighbour in simplex.neighbours.iter_mut().take(self.dimension) {
                *neighbour = places[*neighbour];
            }
        }
    }
}

impl Waiting {
    /// The highest point that waits.
    fn highest(&self) -> Option<usize> {
        let mut best: Option<usize> = None;
        for (point, facet) in self.facet.iter().enumerate() {
            if *facet != NONE && best.is_none_or(|best| self.height[point] > self.height[best]) {
                best = Some(point);
            }
        }
        best
    }
}

/// Points that span the space: the first point, and then always the point farthest from the span so far.
/// `None` if that is closer than [`RESOLUTION`].
fn first_simplex(dimension: usize, points: &[Lattice]) -> Option<Vec<usize>> {
    let first = points.first()?;
    let mut rest: Vec<PolytopePoint> = points.iter().map(|point| exact::difference(point, first)).collect();
    let mut corners = vec![0];
    while corners.len() <= dimension {
        let (mut farthest, mut distance) = (0, 0.0);
        for (index, point) in rest.iter().enumerate() {
            let square = super::dot(point, point);
            if square > distance {
                (farthest, distance) = (index, square);
            }
        }
        let length = distance.sqrt();
        if length * exact::SPACING < RESOLUTION {
            return None;
        }
        corners.push(farthest);
        let direction = rest[farthest].map(|c| c / length);
        for point in &mut rest {
            let along = super::dot(point, &direction);
            for (c, d) in point.iter_mut().zip(&direction) {
                *c -= along * d;
            }
        }
    }
    Some(corners)
}
