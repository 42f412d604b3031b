//! A tree of boxes: finds overlapping boxes, and the item nearest to a point.
//!
//! Built by halving at the median along the longest extent of the centres. The results do not depend on the
//! tree, except for the choice among equally near items.

use glam::DVec3;

/// A box: lowest and highest corner.
pub(super) type Bounds = (DVec3, DVec3);

/// Most boxes of a leaf: fewer make the tree larger, more make every leaf slower.
const LEAF: usize = 4;

/// A binary tree over boxes.
#[derive(Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    /// For a leaf the first of its boxes in the order, else the node on its right; the node on its left
    /// follows it.
    link: u32,
    /// Boxes of a leaf, 0 of others.
    count: u32,
}

impl Tree {
    pub(super) fn over(boxes: &[Bounds]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect() };
        if !boxes.is_empty() {
            let mut order = std::mem::take(&mut tree.order);
            tree.build(boxes, &mut order, 0);
            tree.order = order;
        }
        tree
    }

    fn build(&mut self, boxes: &[Bounds], order: &mut [u32], first: u32) {
        let around = |order: &[u32]| {
            order
                .iter()
                .map(|k| boxes[*k as usize])
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), (a, b)| (lo.min(a), hi.max(b)))
        };
        let here = self.nodes.len();
        self.nodes.push(Node { bounds: around(order), link: first, count: order.len() as u32 });
        if order.len() <= LEAF {
            return;
        }
        let middle = |k: u32| boxes[k as usize].0.midpoint(boxes[k as usize].1);
        let (lo, hi) = order
            .iter()
            .map(|k| middle(*k))
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
        let axis = (hi - lo).max_position();
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |a, b| {
            middle(*a)[axis].total_cmp(&middle(*b)[axis]).then(a.cmp(b))
        });
        let (left, right) = order.split_at_mut(half);
        self.build(boxes, left, first);
        let link = self.nodes.len() as u32;
        self.build(boxes, right, first + half as u32);
        (self.nodes[here].link, self.nodes[here].count) = (link, 0);
    }

    /// Calls `meet` with every box of a leaf that `is_met` holds for all boxes around.
    pub(super) fn visit(&self, is_met: impl Fn(Bounds) -> bool, mut meet: impl FnMut(usize)) {
        let mut left = Vec::with_capacity(64);
        left.extend((!self.nodes.is_empty()).then_some(0));
        while let Some(k) = left.pop() {
            let node = self.nodes[k];
            if !is_met(node.bounds) {
                continue;
            }
            if node.count == 0 {
                left.extend([node.link as usize, k + 1]);
            } else {
                let first = node.link as usize;
                self.order[first..first + node.count as usize].iter().for_each(|k| meet(*k as usize));
            }
        }
    }

    /// The smallest value of `distance` over all boxes, if less than `most`, with its item; a box must not be
    /// farther from the point than its content.
    pub(super) fn nearest(
        &self,
        point: DVec3,
        most: f64,
        distance: impl Fn(usize) -> f64,
    ) -> Option<(usize, f64)> {
        let mut best = (None, most);
        let mut left = Vec::with_capacity(64);
        left.extend(self.nodes.first().map(|node| (away(point, node.bounds), 0)));
        while let Some((bound, k)) = left.pop() {
            if bound >= best.1 {
                continue;
            }
            let node = self.nodes[k];
            if node.count > 0 {
                let first = node.link as usize;
                for k in &self.order[first..first + node.count as usize] {
                    let result = distance(*k as usize);
                    if result < best.1 {
                        best = (Some(*k as usize), result);
                    }
                }
                continue;
            }
            let mut pair = [k + 1, node.link as usize].map(|k| (away(point, self.nodes[k].bounds), k));
            // The search visits the nearer child first, so it is pushed last.
            if pair[0].0 < pair[1].0 {
                pair.swap(0, 1);
            }
            left.extend(pair);
        }
        best.0.map(|k| (k, best.1))
    }
}

/// Distance of a point from a box.
fn away(point: DVec3, (lo, hi): Bounds) -> f64 {
    (point.clamp(lo, hi) - point).length()
}

/// Whether two boxes have a point in common.
pub(super) fn overlap(a: Bounds, b: Bounds) -> bool {
    a.0.cmple(b.1).all() && b.0.cmple(a.1).all()
}

/// The box around a triangle.
pub(super) fn around([a, b, c]: [DVec3; 3]) -> Bounds {
    (a.min(b).min(c), a.max(b).max(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn answers_as_plain_loops(
            corners in prop::collection::vec((prop::array::uniform3(-1.0..1.0f64), prop::array::uniform3(0.0..0.5f64)), 0..60),
            point in prop::array::uniform3(-2.0..2.0f64),
        ) {
            let boxes: Vec<Bounds> = corners
                .iter()
                .map(|(p, size)| (DVec3::from_array(*p), DVec3::from_array(*p) + DVec3::from_array(*size)))
                .collect();
            let tree = Tree::over(&boxes);
            let point = DVec3::from_array(point);
            let least = boxes.iter().map(|b| away(point, *b)).fold(f64::INFINITY, f64::min);
            let result = tree.nearest(point, f64::INFINITY, |k| away(point, boxes[k]));
            prop_assert_eq!(result.map_or(f64::INFINITY, |f| f.1), least);
            for mine in &boxes {
                let mut met = Vec::new();
                tree.visit(|b| overlap(b, *mine), |k| met.push(k));
                met.retain(|k| overlap(boxes[*k], *mine));
                met.sort_unstable();
                let all: Vec<usize> = (0..boxes.len()).filter(|k| overlap(boxes[*k], *mine)).collect();
                prop_assert_eq!(met, all);
            }
        }
    }
}
