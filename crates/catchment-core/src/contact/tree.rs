//! A tree over the features of a half, for halves of many facets.
//!
//! ```text
//!   node ──┬── four parts, each with its bounds: a node, or a feature
//!          ├──                                          two parts, one of each half: no height above `Bounds::most`,
//!          ├──                                          no contact unless `Bounds::is_near` and `Bounds::may_touch`
//!          └──
//! ```
//!
//! Every facet, corner and convex edge is a leaf, so that the pairs of leaves of two trees contain every pair
//! of features once. Queries on two trees descend both of them at once ([`super::search`]).

use super::bounds::{BoundsOfFour, BoundsOfOne};
use super::candidates::FLUSH;
use super::cone::{self, Cone};
use super::shape::Shape;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// A facet, a corner or a convex edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leaf {
    pub(super) shape: u32,
    pub(super) kind: Kind,
    /// Which of the facets, corners or ridges of its shape.
    pub(super) index: u32,
}

/// Kind of a feature; as bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(super) enum Kind {
    Facet = 1,
    Corner = 2,
    Ridge = 4,
}

/// Sines of the angles by which features may fail to support a normal and still count: those of heights, those of the steps of a motion, and those of lists, which hold
/// for some turn as well.
pub(super) const SLACKS: [f64; 3] = [FLUSH, 0.1, 0.35];
/// The content of a node: at most four parts, each another node or a feature.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// Bounds of the parts in their half's frame: of the fixed half, in the world.
    pub(super) parts: BoundsOfFour,
    children: [Child; 4],
}

/// A part of a half.
#[derive(Debug, Clone, Copy)]
pub(super) struct Child {
    /// The number of a node, or of a leaf.
    number: u32,
    /// The kinds of its features, as bits.
    kinds: u8,
    pub(super) is_leaf: bool,
}

/// The tree of a half.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    root: Option<(Child, BoundsOfOne)>,
    /// The largest coordinate, in D.
    pub(super) extent: f64,
}

/// A feature while the tree is built.
struct Built {
    low: DVec3,
    high: DVec3,
    /// Around which it touches, unit or 0, and up to which angles, with each slack.
    axis: DVec3,
    angles: [f64; SLACKS.len()],
    leaf: Leaf,
}

impl Tree {
    /// The tree of a half that was prepared as `shapes`; of the fixed half its planes are prepared, too.
    pub(super) fn over(shapes: &[Shape], is_fixed: bool) -> Self {
        let mut built = Vec::new();
        for (shape, number) in shapes.iter().zip(0..) {
            features(number, shape, &mut built);
        }
        let extent = built.iter().map(|f| f.low.abs().max(f.high.abs()).max_element()).fold(0.0, f64::max);
        let mut tree = Self { nodes: Vec::new(), leaves: Vec::new(), root: None, extent };
        if !built.is_empty() {
            tree.root = Some((tree.build(&mut built, shapes, is_fixed), bounds(&built, shapes)));
        }
        tree
    }

    fn build(&mut self, features: &mut [Built], shapes: &[Shape], is_fixed: bool) -> Child {
        let kinds = features.iter().fold(0, |kinds, f| kinds | f.leaf.kind as u8);
        if let [feature] = features {
            self.leaves.push(feature.leaf);
            return Child { number: self.leaves.len() as u32 - 1, kinds, is_leaf: true };
        }
        let number = self.nodes.len();
        let mut node = Node { parts: BoundsOfFour::of(&[BoundsOfOne::NONE; 4]), children: [Child::NONE; 4] };
        self.nodes.push(node.clone());
        let (left, right) = halves(features);
        let mut parts = [BoundsOfOne::NONE; 4];
        let mut place = 0;
        for half in [left, right] {
            let quarters = if half.len() > 1 { <[_; 2]>::from(halves(half)) } else { [half, &mut []] };
            for quarter in quarters.into_iter().filter(|quarter| !quarter.is_empty()) {
                parts[place] = bounds(quarter, shapes);
                node.children[place] = self.build(quarter, shapes, is_fixed);
                place += 1;
            }
        }
        node.parts = BoundsOfFour::of(&parts);
        if is_fixed {
            node.parts = node.parts.with_planes(true);
        }
        self.nodes[number] = node;
        Child { number: number as u32, kinds, is_leaf: false }
    }

    /// All of it, unless it has no features.
    pub(super) const fn root(&self) -> Option<(Child, BoundsOfOne)> {
        self.root
    }

    pub(super) fn node(&self, child: Child) -> &Node {
        &self.nodes[child.number as usize]
    }

    pub(super) fn leaf(&self, child: Child) -> &Leaf {
        &self.leaves[child.number as usize]
    }
}

/// Divides features: first by kind, as most pairs of kinds never meet, then such that the boxes of both sides
/// are small (surface area heuristic, Wald, *On fast construction of SAH-based bounding volume hierarchies*,
/// 2007), so that long facets do not widen the boxes of short ones.
fn halves(features: &mut [Built]) -> (&mut [Built], &mut [Built]) {
    for kind in [Kind::Ridge, Kind::Facet] {
        let count = features.iter().filter(|f| f.leaf.kind == kind).count();
        if count > 0 && count < features.len() {
            features.sort_by_key(|f| f.leaf.kind == kind);
            return features.split_at_mut(features.len() - count);
        }
    }
    let place = |f: &Built, axis: usize| f.low[axis] + f.high[axis];
    let number = |f: &Built| (f.leaf.shape, f.leaf.kind, f.leaf.index);
    if let Some((axis, border)) = least_area(features) {
        features.sort_by_key(|f| (place(f, axis) >= border, number(f)));
        let middle = features.partition_point(|f| place(f, axis) < border);
        return features.split_at_mut(middle);
    }
    let low = features.iter().map(|f| f.low).fold(DVec3::INFINITY, DVec3::min);
    let high = features.iter().map(|f| f.high).fold(DVec3::NEG_INFINITY, DVec3::max);
    let longest = (high - low).max_position();
    features.sort_by(|a, b| {
        place(a, longest).total_cmp(&place(b, longest)).then_with(|| number(a).cmp(&number(b)))
    });
    features.split_at_mut(features.len() / 2)
}

/// Position along an axis (twice the middle of the features' boxes) that divides the features with the
/// smallest area of the boxes on both sides, each weighted by the number of its features; `None` if nearly
/// all have the same position.
fn least_area(features: &[Built]) -> Option<(usize, f64)> {
    /// Number of positions tried along each axis, plus one.
    const BINS: usize = 16;
    /// The smaller side has at least this share, so that trees stay shallow.
    const LEAST_SHARE: f64 = 1.0 / 16.0;
    #[derive(Clone, Copy)]
    struct Bin {
        count: usize,
        low: DVec3,
        high: DVec3,
    }
    impl Bin {
        const EMPTY: Self = Self { count: 0, low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
        fn with(self, other: &Self) -> Self {
            let (low, high) = (self.low.min(other.low), self.high.max(other.high));
            Self { count: self.count + other.count, low, high }
        }
        fn cost(&self) -> f64 {
            let DVec3 { x, y, z } = self.high - self.low;
            self.count as f64 * (x * y + y * z + z * x)
        }
    }
    let least = LEAST_SHARE * features.len() as f64;
    let mut best: Option<(f64, usize, f64)> = None;
    for axis in 0..3 {
        let places = features.iter().map(|f| f.low[axis] + f.high[axis]);
        let (low, high) =
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let borders: [f64; BINS] = std::array::from_fn(|k| low + (high - low) * k as f64 / BINS as f64);
        let mut bins = [Bin::EMPTY; BINS];
        for f in features {
            let place = f.low[axis] + f.high[axis];
            let bin = borders.partition_point(|border| *border <= place).max(1) - 1;
            bins[bin] = bins[bin].with(&Bin { count: 1, low: f.low, high: f.high });
        }
        let mut above = [Bin::EMPTY; BINS];
        let mut sum = Bin::EMPTY;
        for k in (1..BINS).rev() {
            sum = sum.with(&bins[k]);
            above[k] = sum;
        }
        let mut below = Bin::EMPTY;
        for k in 1..BINS {
            below = below.with(&bins[k - 1]);
            if below.count.min(above[k].count) as f64 >= least.max(1.0) {
                let cost = below.cost() + above[k].cost();
                if best.is_none_or(|(least, ..)| cost < least) {
                    best = Some((cost, axis, borders[k]));
                }
            }
        }
    }
    best.map(|(_, axis, border)| (axis, border))
}

/// Bounds of some features.
fn bounds(features: &[Built], shapes: &[Shape]) -> BoundsOfOne {
    let low = features.iter().map(|f| f.low).fold(DVec3::INFINITY, DVec3::min);
    let high = features.iter().map(|f| f.high).fold(DVec3::NEG_INFINITY, DVec3::max);
    let normal = features.iter().map(|f| f.axis).sum::<DVec3>().normalize_or_zero();
    let center = (low + high) / 2.0;
    let (mut level, mut radius, mut angles) = (f64::NEG_INFINITY, 0.0_f64, [0.0_f64; SLACKS.len()]);
    for feature in features {
        feature.leaf.points(&shapes[feature.leaf.shape as usize], |p| {
            level = level.max(normal.dot(p));
            radius = radius.max(center.distance(p));
        });
        // Not a number if the mean normal is undefined.
        let off = feature.axis.angle_between(normal);
        angles =
            std::array::from_fn(|k| if off.is_nan() { PI } else { angles[k].max(off + feature.angles[k]) });
    }
    BoundsOfOne::new([low, high], radius, normal, level, angles.map(Cone::of))
}

/// The features of a shape.
fn features(number: u32, shape: &Shape, out: &mut Vec<Built>) {
    let mut add = |kind, index, axis: DVec3, angle: &dyn Fn(f64) -> f64| {
        let leaf = Leaf { shape: number, kind, index };
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        leaf.points(shape, |p| (low, high) = (low.min(p), high.max(p)));
        out.push(Built { low, high, axis, angles: SLACKS.map(angle), leaf });
    };
    for (facet, index) in shape.facets.iter().zip(0..) {
        add(Kind::Facet, index, facet.normal, &|_| 0.0);
    }
    for (corner, index) in shape.corners.iter().zip(0..) {
        let axis = shape.normals_of(corner).iter().sum::<DVec3>().normalize_or_zero();
        add(Kind::Corner, index, axis, &|slack| cone::of_corner(axis, shape, corner, slack));
    }
    for (ridge, index) in shape.ridges.iter().zip(0..) {
        let axis = ridge.normals.iter().sum::<DVec3>().normalize_or_zero();
        add(Kind::Ridge, index, axis, &|slack| cone::of_ridge(axis, ridge, slack));
    }
}

impl Leaf {
    /// Visits its corners.
    fn points(&self, shape: &Shape, mut see: impl FnMut(DVec3)) {
        let index = self.index as usize;
        match self.kind {
            Kind::Facet => shape.facets[index].corners.iter().for_each(|k| see(shape.at(*k))),
            Kind::Corner => see(shape.at(shape.corners[index].vertex)),
            Kind::Ridge => shape.ridges[index].ends.iter().for_each(|k| see(shape.at(*k))),
        }
    }

    /// Its bounds with the half at `placed`.
    pub(super) fn part(
        &self,
        shape: &Shape,
        placed: impl Fn(DVec3) -> DVec3,
        turned: impl Fn(DVec3) -> DVec3,
    ) -> Part {
        let normal = match self.kind {
            Kind::Facet => turned(shape.facets[self.index as usize].normal),
            Kind::Corner | Kind::Ridge => DVec3::ZERO,
        };
        let (mut low, mut high, mut level) = (DVec3::INFINITY, DVec3::NEG_INFINITY, f64::NEG_INFINITY);
        self.points(shape, |p| {
            let p = placed(p);
            (low, high, level) = (low.min(p), high.max(p), level.max(normal.dot(p)));
        });
        Part::new((low + high) / 2.0, (high - low) / 2.0, normal, level)
    }
}

impl Child {
    const NONE: Self = Self { number: 0, kinds: 0, is_leaf: true };

    /// Whether features of two parts may meet: a facet and a corner, or two edges.
    pub(super) const fn meets(self, other: Self) -> bool {
        const SWAPPED: [u8; 8] = [0, 2, 1, 3, 4, 6, 5, 7];
        self.kinds & SWAPPED[other.kinds as usize] != 0
    }

    /// Whether an edge of one part may pass through a facet of the other.
    pub(super) const fn may_pass(self, other: Self) -> bool {
        const SWAPPED: [u8; 8] = [0, 4, 0, 4, 1, 5, 1, 5];
        self.kinds & SWAPPED[other.kinds as usize] != 0
    }
}

impl Node {
    pub(super) const fn child(&self, lane: usize) -> Child {
        self.children[lane]
    }
}

/// Bounds of a feature: a box around it, and a plane with all of it behind.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    center: DVec3,
    /// Half of the size of the box.
    half: DVec3,
    /// `normal·p ≤ level` for all points, as z = `over` + `slope`·(x, y); 0 without a plane.
    normal: DVec3,
    slope: DVec2,
    over: f64,
}

/// Normals that face up or down by less have steep planes, which bound no height.
const STEEP: f64 = 0.05;
/// Feet may lie outside their features by twice the seam, in D: boxes are this much wider than their content.
pub(super) const MARGIN: f64 = 2.0 * super::brute::SEAM;

impl Part {
    fn new(center: DVec3, half: DVec3, normal: DVec3, level: f64) -> Self {
        let inverse = 1.0 / normal.z;
        Self { center, half, normal, slope: normal.truncate() * -inverse, over: level * inverse }
    }

    /// Bounds on the heights of contact of a part of the fixed half and a part of the moving half: no height
    /// is below the first number or above the second; `None` if they are side by side. Heights are those of
    /// the COR above its current position.
    #[inline]
    pub(super) fn heights(&self, moving: &Self) -> Option<[f64; 2]> {
        // The common rectangle of both boxes in plan view.
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
}
