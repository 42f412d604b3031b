//! A tree over the facets of a half, for halves of many facets.
//!
//! ```text
//!        ┌───────────┐        node: the box around its facets, and the plane across their mean normal
//!        │  ╲__      │ ╲      that all of them lie behind
//!        │     ╲__   │  n
//!        └───────────┘        two of them, one of each half: no height above `Part::heights`, no contact unless `Part::is_near`
//! ```
//!
//! Every corner and every convex edge belongs to one facet that it borders on, so that the pairs of leaves of two trees
//! hold every pair of features once. What is asked of two trees walks down both of them at once ([`super::search`]).

use super::shape::Shape;
use crate::connector::{Half, Surface};
use glam::{DMat3, DVec2, DVec3};
use std::ops::Range;

/// A facet and the features that belong to it.
#[derive(Debug, Clone)]
pub(super) struct Leaf {
    pub(super) shape: u32,
    pub(super) facet: u32,
    corners: Range<u32>,
    ridges: Range<u32>,
}

/// A node, and what bounds all that is below it.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// Where it is in its half's frame: of the fixed half, in the world.
    pub(super) part: Part,
    /// The right child of an inner node, whose left one follows it; the number of the leaf of a leaf.
    next: u32,
    pub(super) is_leaf: bool,
}

/// The tree of a half.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    /// In preorder; the root is the first.
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    /// Of all shapes, leaf by leaf: indices into their corners and ridges.
    corners: Vec<u32>,
    ridges: Vec<u32>,
}

/// A facet while the tree is built.
struct Built {
    low: DVec3,
    high: DVec3,
    /// Twice its area along its normal.
    area: DVec3,
    leaf: Leaf,
}

impl Tree {
    /// The tree of a half whose surfaces were prepared as `shapes`.
    pub(super) fn over(half: &Half, shapes: &[Shape]) -> Self {
        let mut tree =
            Self { nodes: Vec::new(), leaves: Vec::new(), corners: Vec::new(), ridges: Vec::new() };
        let mut built = Vec::new();
        for (k, (surface, shape)) in half.surfaces.iter().zip(shapes).enumerate() {
            tree.take(k as u32, surface, shape, &mut built);
        }
        if !built.is_empty() {
            tree.build(&mut built, shapes);
        }
        tree
    }

    /// Deals the features of a shape to its facets.
    fn take(&mut self, number: u32, surface: &Surface, shape: &Shape, out: &mut Vec<Built>) {
        const NOBODY: u32 = u32::MAX;
        let mut corner_of = vec![NOBODY; surface.vertices.len()];
        for (k, corner) in shape.corners.iter().enumerate() {
            corner_of[corner.vertex as usize] = k as u32;
        }
        let mut ridges: Vec<(u32, u32)> =
            surface.edges.iter().zip(0..).map(|(edge, k)| (edge.facets[0], k)).collect();
        ridges.sort_unstable();
        let mut ridges = ridges.into_iter().peekable();
        for (facet, f) in surface.facets.iter().zip(0..) {
            let starts = (self.corners.len() as u32, self.ridges.len() as u32);
            for vertex in &facet.corners {
                let corner = std::mem::replace(&mut corner_of[*vertex as usize], NOBODY);
                self.corners.extend((corner != NOBODY).then_some(corner));
            }
            while let Some((_, ridge)) = ridges.next_if(|(owner, _)| *owner == f) {
                self.ridges.push(ridge);
            }
            let at = |k: &u32| surface.vertices[*k as usize];
            let origin = at(&facet.corners[0]);
            out.push(Built {
                low: facet.corners.iter().map(at).fold(DVec3::INFINITY, DVec3::min),
                high: facet.corners.iter().map(at).fold(DVec3::NEG_INFINITY, DVec3::max),
                area: facet.corners.windows(2).map(|w| (at(&w[0]) - origin).cross(at(&w[1]) - origin)).sum(),
                leaf: Leaf {
                    shape: number,
                    facet: f,
                    corners: starts.0..self.corners.len() as u32,
                    ridges: starts.1..self.ridges.len() as u32,
                },
            });
        }
    }

    fn build(&mut self, facets: &mut [Built], shapes: &[Shape]) {
        let low = facets.iter().map(|f| f.low).fold(DVec3::INFINITY, DVec3::min);
        let high = facets.iter().map(|f| f.high).fold(DVec3::NEG_INFINITY, DVec3::max);
        let normal = facets.iter().map(|f| f.area).sum::<DVec3>().normalize_or_zero();
        let points = facets.iter().flat_map(|f| {
            let shape = &shapes[f.leaf.shape as usize];
            shape.facets[f.leaf.facet as usize].corners.iter().map(|k| shape.at(*k))
        });
        let level = points.map(|p| normal.dot(p)).fold(f64::NEG_INFINITY, f64::max);
        let node = self.nodes.len();
        let (center, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let is_leaf = facets.len() == 1;
        let part = Part::new(center, half, normal, level);
        self.nodes.push(Node { part, next: self.leaves.len() as u32, is_leaf });
        if is_leaf {
            self.leaves.push(facets[0].leaf.clone());
            return;
        }
        let along = if half.x >= half.y.max(half.z) {
            DVec3::X
        } else if half.y >= half.z {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let place = |f: &Built| along.dot(f.low + f.high);
        let number = |f: &Built| (f.leaf.shape, f.leaf.facet);
        let middle = facets.len() / 2;
        facets.select_nth_unstable_by(middle, |a, b| {
            place(a).total_cmp(&place(b)).then_with(|| number(a).cmp(&number(b)))
        });
        let (left, right) = facets.split_at_mut(middle);
        self.build(left, shapes);
        self.nodes[node].next = self.nodes.len() as u32;
        self.build(right, shapes);
    }

    pub(super) fn root(&self) -> Option<u32> {
        (!self.nodes.is_empty()).then_some(0)
    }

    pub(super) fn node(&self, node: u32) -> &Node {
        &self.nodes[node as usize]
    }

    pub(super) fn children(&self, node: u32) -> [u32; 2] {
        [node + 1, self.node(node).next]
    }

    pub(super) fn leaf(&self, node: u32) -> &Leaf {
        &self.leaves[self.node(node).next as usize]
    }

    /// The corners that belong to a leaf, as indices into those of its shape.
    pub(super) fn corners(&self, leaf: &Leaf) -> &[u32] {
        &self.corners[leaf.corners.start as usize..leaf.corners.end as usize]
    }

    /// The ridges that belong to a leaf, as indices into those of its shape.
    pub(super) fn ridges(&self, leaf: &Leaf) -> &[u32] {
        &self.ridges[leaf.ridges.start as usize..leaf.ridges.end as usize]
    }
}

/// Where the moving half is, as its nodes need it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    rotation: DMat3,
    /// Its entries without their signs: how boxes grow.
    grows: DMat3,
    position: DVec3,
}

/// A part of a half: a box around it, and a plane that all of it lies behind.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    center: DVec3,
    /// Half of the size of the box.
    half: DVec3,
    /// `normal·p ≤ level` for all points: the mean normal of the facets, unit, or 0 where they cancel.
    normal: DVec3,
    level: f64,
    /// The same plane as z = `over` + `slope`·(x, y), where it is not [`STEEP`].
    slope: DVec2,
    over: f64,
}

/// Normals that face up or down by less have steep planes, which bound no height.
const STEEP: f64 = 0.05;
/// Feet may lie outside their features by twice the seam, in D: how much wider boxes are than what they hold.
const MARGIN: f64 = 2.0 * super::brute::SEAM;

impl Part {
    fn new(center: DVec3, half: DVec3, normal: DVec3, level: f64) -> Self {
        let inverse = 1.0 / normal.z;
        Self { center, half, normal, level, slope: normal.truncate() * -inverse, over: level * inverse }
    }

    /// Half of the largest side of its box.
    pub(super) fn size(&self) -> f64 {
        self.half.max_element()
    }

    /// Where heights of contact of a part of the fixed half and one of the moving half may lie: none is below the first number nor above
    /// the second; `None` where they are beside each other. Heights are those of the COR above where it is.
    #[inline]
    pub(super) fn heights(&self, moving: &Self) -> Option<[f64; 2]> {
        // What both boxes have in common in plan view.
        let reach = self.half.truncate() + MARGIN;
        let low = (self.center.truncate() - reach).max(moving.center.truncate() - moving.half.truncate());
        let high = (self.center.truncate() + reach).min(moving.center.truncate() + moving.half.truncate());
        if low.x > high.x || low.y > high.y {
            return None;
        }
        let (middle, reach) = ((low + high) * 0.5, (high - low) * 0.5);
        let (top, bottom) = (self.center.z + self.half.z, moving.center.z - moving.half.z);
        let mut most = top - bottom;
        let (above, below) = (self.normal.z > STEEP, moving.normal.z < -STEEP);
        let z = |plane: &Self| plane.over + plane.slope.dot(middle);
        let spread = |slope: DVec2| slope.abs().dot(reach);
        if above {
            most = most.min(z(self) + spread(self.slope) - bottom);
        }
        if below {
            most = most.min(top - z(moving) + spread(moving.slope));
        }
        if above && below {
            most = most.min(z(self) - z(moving) + spread(self.slope - moving.slope));
        }
        let least = self.center.z - self.half.z - (moving.center.z + moving.half.z);
        Some([least, most])
    }

    /// Whether anything of the two parts may be as close as `reach`.
    pub(super) fn is_near(&self, moving: &Self, reach: f64) -> bool {
        let apart = moving.center - self.center;
        let most = self.half + moving.half + reach;
        // Else in front of the plane that all of the other part lies behind.
        apart.abs().cmple(most).all()
            && self.normal.dot(moving.center) - self.normal.abs().dot(moving.half) <= self.level + reach
            && moving.normal.dot(self.center) - moving.normal.abs().dot(self.half) <= moving.level + reach
    }
}

impl Placed {
    pub(super) fn new(rotation: DMat3, position: DVec3) -> Self {
        let grows = DMat3::from_cols(rotation.x_axis.abs(), rotation.y_axis.abs(), rotation.z_axis.abs());
        Self { rotation, grows, position }
    }

    /// A part of the moving half in the world.
    #[inline]
    pub(super) fn part(&self, own: &Part) -> Part {
        let normal = self.rotation * own.normal;
        let level = own.level + normal.dot(self.position);
        Part::new(self.rotation * own.center + self.position, self.grows * own.half, normal, level)
    }
}
