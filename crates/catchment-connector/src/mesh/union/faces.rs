//! Triangulation of faces: loops from their borders, holes cut open, ears clipped, all in integer arithmetic.
//!
//! ```text
//!   ┌───────────┐      at a point at which borders touch, a loop takes the leftmost path, so that it stays around the
//!   │  ┌──┐     │      same area; the shortest bridge that crosses nothing joins a hole to the outline; an ear is a
//!   ├ ─┤  │     │      corner whose triangle has no other corner in it or near it, the fattest first
//!   │  └──┘     │
//!   └───────────┘
//! ```
//!
//! n² steps for n corners, n³ without fat ears; faces have dozens of corners.

use super::UnionProblem;
use super::planes::Model;
use super::stitch::{Face, SPLIT};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// A point of a plane on the lattice.
type Node = [i64; 2];

/// The triangles of a face, counter-clockwise seen from outside.
pub(super) fn triangles(model: &Model, face: &Face) -> Result<Vec<[u32; 3]>, UnionProblem> {
    let flat = Flat::of(model, face);
    let tangled = |ring: &[u32]| {
        let at = ring.first().map_or_else(Default::default, |k| model.points[*k as usize]);
        UnionProblem::Tangled { at: at.into() }
    };
    let loops = flat.loops(&face.border).ok_or_else(|| tangled(&face.border[0]))?;
    let (mut outlines, holes): (Vec<_>, Vec<_>) = loops.into_iter().partition(|ring| flat.area(ring) > 0);
    // The smallest outline around a hole is its own.
    outlines.sort_by_cached_key(|ring| (flat.area(ring), ring.first().copied()));
    let mut of_outline: Vec<Vec<Vec<u32>>> = vec![Vec::new(); outlines.len()];
    for hole in holes {
        if flat.area(&hole) == 0 {
            continue;
        }
        let around = outlines.iter().position(|outline| flat.has(outline, hole[0]));
        of_outline[around.ok_or_else(|| tangled(&hole))?].push(hole);
    }
    let mut result = Vec::new();
    for (outline, holes) in outlines.into_iter().zip(of_outline) {
        let ring = flat.opened(outline.clone(), holes).ok_or_else(|| tangled(&outline))?;
        result.extend(flat.clipped(ring).ok_or_else(|| tangled(&outline))?);
    }
    Ok(result)
}

/// The points of a face in two coordinates, counter-clockwise as seen from outside.
struct Flat {
    places: BTreeMap<u32, Node>,
    /// Steps of the lattice within which a corner is on a line.
    near: f64,
}

impl Flat {
    fn of(model: &Model, face: &Face) -> Self {
        let normal = model.planes[face.plane as usize].normal;
        let axis = normal.abs().max_position();
        let is_turned = (normal[axis] > 0.0) != face.is_forward;
        let place = |point: u32| {
            let p = model.points[point as usize];
            let [x, y] = [1, 2].map(|k| (p[(axis + k) % 3] * model.scale).round() as i64);
            (point, if is_turned { [y, x] } else { [x, y] })
        };
        let places = face.border.iter().flatten().map(|point| place(*point)).collect();
        Self { places, near: SPLIT * model.w * model.scale }
    }

    fn at(&self, point: u32) -> Node {
        self.places.get(&point).copied().unwrap_or_default()
    }

    /// Twice the signed area of a triangle, positive if it is counter-clockwise.
    fn turn(&self, [a, b, c]: [u32; 3]) -> i128 {
        turn([a, b, c].map(|point| self.at(point)))
    }

    /// Twice the signed area of a ring.
    fn area(&self, ring: &[u32]) -> i128 {
        ring.windows(2).map(|pair| self.turn([ring[0], pair[0], pair[1]])).sum()
    }

    /// The closed loops of a border; `None` if two of its edges lead to the same edge.
    fn loops(&self, border: &[[u32; 2]]) -> Option<Vec<Vec<u32>>> {
        let mut ways: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (k, [from, _]) in border.iter().enumerate() {
            ways.entry(*from).or_default().push(k);
        }
        let next = |k: usize| {
            let [from, at] = border[k];
            let leftmost = |way: &&usize| self.clockwise(from, at, border[**way][1]).to_bits();
            ways.get(&at)?.iter().min_by_key(leftmost).copied()
        };
        let mut is_done = vec![false; border.len()];
        let mut loops = Vec::new();
        for first in 0..border.len() {
            let mut ring = Vec::new();
            let mut at = first;
            while !std::mem::replace(&mut is_done[at], true) {
                ring.push(border[at][0]);
                at = next(at)?;
            }
            if !ring.is_empty() && at != first {
                return None;
            }
            if ring.len() > 2 {
                loops.push(ring);
            }
        }
        Some(loops)
    }

    /// The angle from the way back to the way on, clockwise, in radians above 0.
    fn clockwise(&self, from: u32, at: u32, to: u32) -> f64 {
        let [x, y] = self.at(at);
        let direction = |point: u32| {
            let [px, py] = self.at(point);
            ((py - y) as f64).atan2((px - x) as f64)
        };
        let angle = (direction(from) - direction(to)).rem_euclid(TAU);
        if angle == 0.0 { TAU } else { angle }
    }

    /// Whether a ring goes around a point.
    fn has(&self, ring: &[u32], point: u32) -> bool {
        let p = self.at(point);
        let mut is_in = false;
        for (k, a) in ring.iter().enumerate() {
            let [a, b] = [*a, ring[(k + 1) % ring.len()]].map(|end| self.at(end));
            if (a[1] > p[1]) != (b[1] > p[1]) {
                let side = turn([a, b, p]);
                is_in ^= (side > 0) == (b[1] > a[1]);
            }
        }
        is_in
    }

    /// An outline and its holes as a single ring.
    fn opened(&self, mut ring: Vec<u32>, mut holes: Vec<Vec<u32>>) -> Option<Vec<u32>> {
        while !holes.is_empty() {
            let mut bridges: Vec<(i128, usize, usize, usize)> = Vec::new();
            for (hole, corners) in holes.iter().enumerate() {
                for (inner, p) in corners.iter().enumerate() {
                    bridges.extend(
                        ring.iter()
                            .enumerate()
                            .map(|(outer, q)| (apart(self.at(*p), self.at(*q)), outer, hole, inner)),
                    );
                }
            }
            bridges.sort_unstable();
            let is_clear = |(_, outer, hole, inner): &(i128, usize, usize, usize)| {
                let (p, q) = (ring[*outer], holes[*hole][*inner]);
                self.leads_in(&ring, *outer, q)
                    && self.leads_in(&holes[*hole], *inner, p)
                    && std::iter::once(&ring).chain(&holes).all(|walls| self.is_clear(walls, [p, q]))
            };
            let (_, outer, hole, inner) = bridges.into_iter().find(is_clear)?;
            let hole = holes.remove(hole);
            // In along the bridge, around the hole, and out again.
            let around = (0..=hole.len()).map(|k| hole[(inner + k) % hole.len()]);
            let inserted: Vec<u32> = around.chain([ring[outer]]).collect();
            ring.splice(outer + 1..=outer, inserted);
        }
        Some(ring)
    }

    /// Whether the way from a corner of a ring to a point begins inside.
    fn leads_in(&self, ring: &[u32], corner: usize, to: u32) -> bool {
        let n = ring.len();
        let [before, at, after] = [ring[(corner + n - 1) % n], ring[corner], ring[(corner + 1) % n]];
        let [left, right] = [self.turn([at, after, to]) > 0, self.turn([before, at, to]) > 0];
        if self.turn([before, at, after]) > 0 { left && right } else { left || right }
    }

    /// Whether a segment between two corners meets no side of a ring, but at its own ends.
    fn is_clear(&self, ring: &[u32], [p, q]: [u32; 2]) -> bool {
        (0..ring.len()).all(|k| {
            let [a, b] = [ring[k], ring[(k + 1) % ring.len()]];
            let is_own = |end: u32| end == p || end == q;
            match (is_own(a), is_own(b)) {
                (true, true) => false,
                (true, false) => !self.is_on([p, q], b),
                (false, true) => !self.is_on([p, q], a),
                (false, false) => !self.meet([a, b], [p, q]),
            }
        })
    }

    /// Whether a point lies on a segment.
    fn is_on(&self, [p, q]: [u32; 2], point: u32) -> bool {
        let [a, b, c] = [p, q, point].map(|end| self.at(end));
        let within = |k: usize| (a[k].min(b[k])..=a[k].max(b[k])).contains(&c[k]);
        turn([a, b, c]) == 0 && within(0) && within(1)
    }

    /// Whether two segments have a point in common.
    fn meet(&self, one: [u32; 2], other: [u32; 2]) -> bool {
        let sides = |[a, b]: [u32; 2], [c, d]: [u32; 2]| [self.turn([a, b, c]), self.turn([a, b, d])];
        let parts = |[x, y]: [i128; 2]| x.signum() * y.signum() < 0;
        (parts(sides(one, other)) && parts(sides(other, one)))
            || other.iter().any(|end| self.is_on(one, *end))
            || one.iter().any(|end| self.is_on(other, *end))
    }

    /// Clips the ears of a ring.
    fn clipped(&self, mut ring: Vec<u32>) -> Option<Vec<[u32; 3]>> {
        let mut result = Vec::with_capacity(ring.len());
        while ring.len() > 3 {
            let n = ring.len();
            let ear = |k: usize| [ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]];
            let mut ears: Vec<(Reverse<u64>, usize)> =
                (0..n).filter_map(|k| Some((Reverse(self.fatness(ear(k))?), k))).collect();
            ears.sort_unstable();
            let is_free = |k: usize, near: f64| {
                let own = ear(k).map(|corner| self.at(corner));
                ring.iter()
                    .map(|corner| self.at(*corner))
                    .all(|p| own.contains(&p) || !is_inside(own, p, near))
            };
            // A corner that the cut passes closely would be left with a triangle of no area.
            let clear = ears.iter().find(|(_, k)| is_free(*k, self.near));
            let (_, k) = *clear.or_else(|| ears.iter().find(|(_, k)| is_free(*k, 0.0)))?;
            result.push(ear(k));
            ring.remove(k);
        }
        let last = [ring[0], ring[1], ring[2]];
        self.fatness(last)?;
        result.push(last);
        Some(result)
    }

    /// Bits of twice the area of a triangle over the square of its longest side, in the order of the numbers; `None` without area.
    fn fatness(&self, corners: [u32; 3]) -> Option<u64> {
        let [a, b, c] = corners.map(|corner| self.at(corner));
        let longest = apart(a, b).max(apart(b, c)).max(apart(c, a));
        let twice = turn([a, b, c]);
        (twice > 0).then(|| (twice as f64 / longest as f64).to_bits())
    }
}

/// Twice the signed area of a triangle.
fn turn([a, b, c]: [Node; 3]) -> i128 {
    let along = |p: Node, k: usize| i128::from(p[k]) - i128::from(a[k]);
    along(b, 0) * along(c, 1) - along(b, 1) * along(c, 0)
}

/// The square of a distance.
fn apart(a: Node, b: Node) -> i128 {
    [0, 1].map(|k| (i128::from(a[k]) - i128::from(b[k])).pow(2)).iter().sum()
}

/// Whether a point lies in a triangle, on its border, or outside of each side by no more than `near`.
fn is_inside([a, b, c]: [Node; 3], p: Node, near: f64) -> bool {
    [[a, b], [b, c], [c, a]].into_iter().all(|[from, to]| {
        let slack = near * (apart(from, to) as f64).sqrt();
        turn([from, to, p]) as f64 >= -slack
    })
}
