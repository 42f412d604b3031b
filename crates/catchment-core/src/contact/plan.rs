//! Bounds in plan view, and a tree over many of them.
//!
//! ```text
//!            whole                a box contains the boxes below it; the features are halved by the middle of their
//!          ╱       ╲              boxes, along the longer side; the features of a leaf are tested singly
//!      left         right
//!     ╱    ╲       ╱     ╲
//! ```

use glam::DVec2;

/// Bounds of a feature in plan view.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan {
    low: DVec2,
    high: DVec2,
}

impl Plan {
    /// Meets everything but [`Plan::NOWHERE`].
    pub(super) const EVERYWHERE: Self = Self { low: DVec2::NEG_INFINITY, high: DVec2::INFINITY };
    const NOWHERE: Self = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };

    pub(super) fn around(points: impl Iterator<Item = DVec2>) -> Self {
        points.fold(Self::NOWHERE, |b, p| Self { low: b.low.min(p), high: b.high.max(p) })
    }

    /// Larger by `by` on all sides.
    pub(super) fn widened(self, by: f64) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    /// Whether the two have a point in common.
    pub(super) fn meets(&self, other: &Self) -> bool {
        // Without branches, which a processor would mostly guess wrong.
        (other.low.cmple(self.high) & other.high.cmpge(self.low)).all()
    }

    fn with(self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// The features of one kind of a shape, by their positions in plan view.
#[derive(Debug, Clone)]
pub(super) struct PlanTree {
    /// Boxes and numbers of the features, ordered so that every node holds a range of them.
    features: Vec<(Plan, u32)>,
    /// Boxes of the nodes: the root is 0, the children of k are 2k + 1 and 2k + 2.
    nodes: Vec<Plan>,
}

/// Features of a leaf: trying a box costs no more than going down a level.
const LEAF: usize = 8;

impl PlanTree {
    /// The tree over boxes, numbered in their order.
    pub(super) fn over(boxes: impl Iterator<Item = Plan>) -> Self {
        let mut tree = Self { features: boxes.zip(0..).collect(), nodes: Vec::new() };
        tree.build(0, 0, tree.features.len());
        tree
    }

    fn build(&mut self, node: usize, start: usize, end: usize) {
        let features = &mut self.features[start..end];
        let bounds = features.iter().fold(Plan::NOWHERE, |b, (plan, _)| b.with(plan));
        if self.nodes.len() <= node {
            self.nodes.resize(node + 1, Plan::NOWHERE);
        }
        self.nodes[node] = bounds;
        if features.len() > LEAF {
            let size = bounds.high - bounds.low;
            let along = if size.x >= size.y { DVec2::X } else { DVec2::Y };
            let place = |(plan, _): &(Plan, u32)| along.dot(plan.low + plan.high);
            let half = features.len() / 2;
            features.select_nth_unstable_by(half, |a, b| place(a).total_cmp(&place(b)).then(a.1.cmp(&b.1)));
            self.build(2 * node + 1, start, start + half);
            self.build(2 * node + 2, start + half, end);
        }
    }

    /// Bounds of all features.
    pub(super) fn bounds(&self) -> &Plan {
        &self.nodes[0]
    }

    /// Calls `meet` with every feature whose box has a point in common with `window`, in no particular order.
    pub(super) fn visit(&self, window: &Plan, mut meet: impl FnMut(u32)) {
        self.any(window, |feature| {
            meet(feature);
            false
        });
    }

    /// Whether `is` is true for any feature whose box intersects `window`.
    pub(super) fn any(&self, window: &Plan, mut is: impl FnMut(u32) -> bool) -> bool {
        self.descend(0, &self.features, window, &mut is)
    }

    fn descend(
        &self,
        node: usize,
        features: &[(Plan, u32)],
        window: &Plan,
        is: &mut impl FnMut(u32) -> bool,
    ) -> bool {
        if features.len() <= LEAF {
            features.iter().filter(|(plan, _)| plan.meets(window)).any(|(_, k)| is(*k))
        } else if self.nodes[node].meets(window) {
            let (left, right) = features.split_at(features.len() / 2);
            self.descend(2 * node + 1, left, window, is) || self.descend(2 * node + 2, right, window, is)
        } else {
            false
        }
    }
}
