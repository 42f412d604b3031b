//! Heights and contacts of halves with many facets, by their trees.
//!
//! ```text
//!   height     pairs of parts in the order of their highest possible height; pairs that cannot exceed the best are skipped
//!   contacts   pairs of parts that are near each other
//! ```
//!
//! The results are those of the list of all elements ([`super::turned`]): the same elements are tried
//! wherever they can matter, and among equal elements the first in the order of that list wins. Parts are
//! bounded in single precision and skipped if they are lower, or farther apart, by more than the rounding
//! error ([`super::bounds`]); features are bounded in double precision and skipped if they are lower by more
//! than [`SURE`].

mod lists;
mod near;
mod pass;

pub(super) use lists::{Lists, Passing, Touching};
pub(super) use near::Gaps;

use super::bounds::{BoundsOfFour, Placed, rounding};
use super::candidates::{Candidate, Counts, corner_facet, edge_edge, facet_corner};
use super::element::Element;
use super::shape::Shape;
use super::tree::{Child, Kind, Leaf, MARGIN, Node, SLACKS, Tree};
use super::turned::VERTICAL;
use super::{Pair, brute::SEAM};
use glam::{DMat3, DVec2, DVec3};
use std::cell::Cell;
use wide::f32x4;

/// Largest excess of a height of contact over the bounds of its facets, in D: rounding of planes at the
/// steepness that bounds heights, and the seam on them (2e-12 on a slope of 20). Steeper elements round
/// worse, and are limited by it.
const SURE: f64 = 1e-10;
/// Largest rounding of the steepest elements, in D: 1e-16 on a slope of 10⁹.
const STEEPEST: f64 = 1e-6;
/// Elements whose normal has a larger z-component keep to [`SURE`] by themselves: 1e-16 on a slope of 10⁵.
const GENTLE: f64 = 1e-5;

/// If a corner is over a facet, the height is at least that of their contact, whether they support it or not;
/// facets that count as coplanar may leave it lower by this much, in D.
const LOOSE: f64 = 1e-5;

/// The cost of a search is counted, so that it is the same on every machine: nanoseconds of one core of 2024
/// for a part that is divided, for a pair tested in a list, and for a pair tested to make a list. For grid
/// cups, gears and funnels of 1 000 to 100 000 facets it is accurate within a factor of 1.5.
const DIVIDED: u64 = 38;
const LISTED: u64 = 22;
const ENLISTED: u64 = 100;

/// Which kinds of features meet, in the order of the list of all elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Meets {
    FacetCorner,
    CornerFacet,
    EdgeEdge,
}

/// The place of an element in the list of all.
pub(super) type Number = (Meets, Candidate);

/// The element that two features may be.
fn meeting(fixed: &Leaf, moving: &Leaf) -> Option<Number> {
    let meets = match (fixed.kind, moving.kind) {
        (Kind::Facet, Kind::Corner) => Meets::FacetCorner,
        (Kind::Corner, Kind::Facet) => Meets::CornerFacet,
        (Kind::Ridge, Kind::Ridge) => Meets::EdgeEdge,
        _ => return None,
    };
    let shapes = [fixed.shape, moving.shape];
    Some((meets, Candidate { shapes, fixed: fixed.index, moving: moving.index }))
}

/// The trees of both halves.
#[derive(Debug, Clone)]
pub(super) struct Trees {
    pub(super) fixed: Tree,
    pub(super) moving: Tree,
    /// The largest distance of a feature of the moving half from its COR, in D.
    pub(super) radius: f64,
}

impl Trees {
    pub(super) fn over(fixed: &[Shape], moving: &[Shape]) -> Self {
        let vertices = moving.iter().flat_map(|shape| &shape.vertices);
        // A half that is a single point at the COR does not change with rotation; the radius stays positive.
        let radius = vertices.map(|v| v.length()).fold(f64::MIN_POSITIVE, f64::max);
        Self { fixed: Tree::over(fixed, true), moving: Tree::over(moving, false), radius }
    }
}

/// A query for heights.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeightQuery {
    /// Height from which the half is lowered.
    pub(super) ceiling: f64,
    /// Heights above this need not be distinguished from the greatest.
    pub(super) enough: f64,
    /// Heights below this count as no contact.
    pub(super) floor: f64,
    /// Whether something above the ceiling is known to stop it earlier.
    pub(super) covered: bool,
}

impl HeightQuery {
    /// The greatest height of all.
    pub(super) const WHOLE: Self =
        Self { ceiling: f64::INFINITY, enough: f64::INFINITY, floor: f64::NEG_INFINITY, covered: false };
}

/// The carrier of a half lowered from a ceiling.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Carried {
    /// The element, its place in the list, and its height.
    pub(super) by: Option<(Element, Number, f64)>,
    /// Whether something above the ceiling would have stopped it earlier.
    pub(super) covered: bool,
    /// Estimated cost of the search, in nanoseconds.
    pub(super) took: u64,
}

impl Carried {
    pub(super) fn height(&self) -> Option<f64> {
        self.by.map(|(_, _, height)| height)
    }
}

/// Sine and cosine of the angle beyond the horizontal of normals with this lowest z-component.
fn overhang(lowest: f64) -> [f32; 2] {
    let sine = (-lowest).clamp(0.0, 1.0);
    [sine as f32, (1.0 - sine * sine).sqrt() as f32]
}

/// The pair at a given pose.
#[derive(Clone)]
pub(super) struct Turned<'a> {
    pair: &'a Pair,
    trees: &'a Trees,
    rotation: DMat3,
    position: DVec3,
    back: DMat3,
    counts: Counts,
    /// Which cones hold.
    cones: Option<usize>,
    /// Pairs of parts that are tested together.
    pairs: fn(Child, Child) -> bool,
    /// Sine and cosine of the largest angle of normals beyond the horizontal.
    overhang: [f32; 2],
    /// Pose of the moving half, and the possible error of bounds there.
    placed: Placed,
    rounding: f32,
    /// How many parts were divided.
    divided: Cell<u64>,
}

impl<'a> Turned<'a> {
    fn new(pair: &'a Pair, trees: &'a Trees, rotation: &DMat3, position: DVec3, counts: Counts) -> Self {
        let cones = SLACKS.iter().position(|slack| counts.slack <= *slack);
        let overhang = overhang(counts.lowest);
        let extent = trees.fixed.extent + 2.0 * trees.moving.extent + position.abs().max_element();
        let (placed, rounding) = (Placed::new(rotation, position), rounding(extent));
        let (rotation, back) = (*rotation, rotation.transpose());
        let (pairs, divided) = (Child::meets, Cell::new(0));
        Self {
            pair,
            trees,
            rotation,
            position,
            back,
            counts,
            cones,
            pairs,
            overhang,
            placed,
            rounding,
            divided,
        }
    }

    /// Which of two parts is divided first: the larger one, in plan view.
    fn divides_fixed(fixed: &Side<'_>, moving: &Side<'_>) -> bool {
        moving.child.is_leaf || !fixed.child.is_leaf && fixed.size() >= LARGER * moving.size()
    }

    /// Divides one of two parts, at least one of which is a node: `test` receives four pairs of parts and
    /// returns the pairs that may count, as bits, and the bounds of their heights; `look` receives the pairs
    /// that may touch by their orientation, the possibly highest first.
    #[inline]
    fn divide(
        &self,
        fixed: &Side<'_>,
        moving: &Side<'_>,
        test: impl FnOnce(&BoundsOfFour, &BoundsOfFour) -> (u32, [f32; 4], [f32; 4]),
        mut look: impl FnMut(&Side<'_>, &Side<'_>, [f32; 2]),
    ) {
        self.divided.set(self.divided.get() + 1);
        // Two separate branches, so that only the node that is read gets repeated four times.
        if Self::divides_fixed(fixed, moving) {
            let node = self.trees.fixed.node(fixed.child);
            let four = &node.parts;
            let found = self.test(four, &moving.four.repeated(moving.lane), test);
            self.look(node, moving.child, found, |child, lane, heights| {
                look(&Side { child, four, lane }, moving, heights);
            });
        } else {
            let node = self.trees.moving.node(moving.child);
            let four = &self.placed.four(&node.parts);
            let found = self.test(&fixed.four.repeated(fixed.lane), four, test);
            self.look(node, fixed.child, found, |child, lane, heights| {
                look(fixed, &Side { child, four, lane }, heights);
            });
        }
    }

    /// Which of four pairs of parts may count and may touch as they face, and between which heights.
    #[inline]
    fn test(
        &self,
        fixed: &BoundsOfFour,
        moving: &BoundsOfFour,
        test: impl FnOnce(&BoundsOfFour, &BoundsOfFour) -> (u32, [f32; 4], [f32; 4]),
    ) -> (u32, [f32; 4], [f32; 4]) {
        let (mut alive, least, most) = test(fixed, moving);
        if let Some(slack) = self.cones.filter(|_| alive != 0) {
            alive &= fixed.may_touch(moving, slack, self.overhang).to_bitmask();
        }
        (alive, least, most)
    }

    /// Passes the active parts of a node, paired with another part, the possibly highest first.
    #[inline]
    fn look(
        &self,
        node: &Node,
        other: Child,
        (mut alive, least, most): (u32, [f32; 4], [f32; 4]),
        mut look: impl FnMut(Child, usize, [f32; 2]),
    ) {
        while alive != 0 {
            let mut lane = alive.trailing_zeros() as usize;
            for k in lane + 1..4 {
                if alive & 1 << k != 0 && most[k] > most[lane] {
                    lane = k;
                }
            }
            alive &= !(1 << lane);
            let child = node.child(lane);
            if (self.pairs)(child, other) {
                look(child, lane, [least[lane], most[lane]]);
            }
        }
    }

    /// Both halves, unless one has no features: their roots, and the bounds of each, four times.
    fn roots(&self) -> Option<([Child; 2], [BoundsOfFour; 2])> {
        let ((fixed, f), (moving, m)) = (self.trees.fixed.root()?, self.trees.moving.root()?);
        let bounds =
            [BoundsOfFour::of(&[f; 4]).with_planes(true), self.placed.four(&BoundsOfFour::of(&[m; 4]))];
        Some(([fixed, moving], bounds))
    }

    fn shapes(&self, [fixed, moving]: [u32; 2]) -> (&'a Shape, &'a Shape) {
        (&self.pair.fixed_shapes[fixed as usize], &self.pair.moving_shapes[moving as usize])
    }

    /// The element of a pair of features, if they support each other.
    fn element(&self, number: &Number) -> Option<Element> {
        self.element_within(number, self.counts)
    }

    fn element_within(&self, (kind, candidate): &Number, counts: Counts) -> Option<Element> {
        let (fixed, moving) = self.shapes(candidate.shapes);
        let Counts { slack, lowest } = counts;
        match kind {
            Meets::FacetCorner => {
                let normal = fixed.facets[candidate.fixed as usize].normal;
                let element = || facet_corner(candidate, fixed, moving, self.back * normal, slack);
                (normal.z > lowest).then(element)?
            }
            Meets::CornerFacet => {
                let normal = self.rotation * moving.facets[candidate.moving as usize].normal;
                corner_facet(candidate, fixed, moving, normal, slack, lowest)
            }
            Meets::EdgeEdge => {
                let ridge = &fixed.ridges[candidate.fixed as usize];
                let element = || {
                    let seen = self.back * ridge.along;
                    edge_edge(candidate, fixed, moving, &self.rotation, seen, slack, lowest)
                };
                ridge.normals.iter().any(|n| n.z > lowest).then(element)?
            }
        }
    }

    /// Bounds on the heights of two features, relative to `position`.
    fn heights(&self, fixed: &Leaf, moving: &Leaf, position: DVec3) -> Option<[f64; 2]> {
        let (f, m) = self.shapes([fixed.shape, moving.shape]);
        let fixed = fixed.part(f, |p| p, |n| n);
        fixed.heights(&moving.part(m, |p| self.rotation * p + position, |n| self.rotation * n))
    }

    /// Whether an element touches its features with the COR at `position`.
    fn is_on(&self, element: &Element, position: DVec3) -> bool {
        let (fixed, moving) = self.shapes(element.meeting.shapes);
        element.foot(fixed, moving, &self.rotation, position, SEAM).is_some()
    }
}

/// The search for the carrier of a half.
struct Lowered<'a> {
    turned: &'a Turned<'a>,
    lateral: DVec2,
    query: HeightQuery,
    found: Carried,
    /// Heights below this cannot be the greatest.
    floor: f64,
}

impl Lowered<'_> {
    /// Whether anything between these heights may still count, which are right to some rounding.
    fn may_count(&self, [least, most]: [f64; 2], sure: f64) -> bool {
        let HeightQuery { ceiling, enough, .. } = self.query;
        let best = self.found.height().unwrap_or(f64::NEG_INFINITY);
        if best > enough {
            return false;
        }
        if most + sure <= ceiling {
            most + sure >= best.max(self.floor)
        } else {
            !self.found.covered || (least <= ceiling + sure && ceiling >= best)
        }
    }

    /// Tries two features.
    fn try_leaves(&mut self, fixed: &Leaf, moving: &Leaf) {
        let Some(number) = meeting(fixed, moving) else { return };
        let bounds = self.turned.heights(fixed, moving, self.lateral.extend(0.0));
        let Some(bounds) = bounds.filter(|bounds| self.may_count(*bounds, SURE)) else { return };
        let [_, most] = bounds;
        let Self { turned, lateral, query, found, floor, .. } = self;
        let any = Counts { slack: f64::INFINITY, lowest: VERTICAL };
        // Above their bounds it may be beside them.
        let height = |element: &Element| {
            let z = element.height(*lateral);
            (z <= most + STEEPEST).then(|| z.min(most + SURE))
        };
        if query.ceiling == f64::INFINITY && number.0 != Meets::EdgeEdge {
            let Some(element) = turned.element_within(&number, any) else { return };
            let on = |z: &f64| *z >= *floor && turned.is_on(&element, lateral.extend(*z));
            let Some(z) = height(&element).filter(on) else { return };
            *floor = floor.max(z - LOOSE);
        }
        let element = turned.element(&number).and_then(|element| Some((element, height(&element)?)));
        if let Some((element, z)) = element {
            found.meet(turned, lateral.extend(z), query.ceiling, number, element);
        }
    }

    /// Tries two parts.
    fn descend(&mut self, fixed: &Side<'_>, moving: &Side<'_>) {
        let trees = self.turned.trees;
        if fixed.child.is_leaf && moving.child.is_leaf {
            return self.try_leaves(trees.fixed.leaf(fixed.child), trees.moving.leaf(moving.child));
        }
        let turned = self.turned;
        let rounding = turned.rounding;
        // Without a ceiling, parts lower than the best height so far do not count.
        let best = self.found.height().unwrap_or(f64::NEG_INFINITY).max(self.floor);
        let low = if self.query.ceiling == f64::INFINITY { best as f32 } else { f32::NEG_INFINITY };
        let test = |f: &BoundsOfFour, m: &BoundsOfFour| {
            let (most, beside) = f.most(m, MARGIN as f32, rounding);
            let counts = beside & most.simd_ge(f32x4::splat(low - 2.0 * rounding));
            (counts.to_bitmask(), f.least(m).to_array(), most.to_array())
        };
        turned.divide(fixed, moving, test, |fixed, moving, heights| {
            if self.may_count(heights.map(f64::from), f64::from(rounding)) {
                self.descend(fixed, moving);
            }
        });
    }
}

impl Carried {
    /// Takes an element that stops the half with its COR at `position`, if it counts.
    fn meet(&mut self, turned: &Turned<'_>, position: DVec3, ceiling: f64, number: Number, element: Element) {
        let z = position.z;
        let counts = element.normal.z > VERTICAL
            && if z > ceiling {
                !self.covered
            } else {
                self.by.is_none_or(|(_, best, height)| z > height || z == height && number < best)
            };
        if counts && turned.is_on(&element, position) {
            if z > ceiling {
                self.covered = true;
            } else {
                self.by = Some((element, number, z));
            }
        }
    }
}

/// How much larger a part of the fixed half is that is divided first. Of a turned part the box is larger than it need be.
const LARGER: f32 = 1.25;

/// A part of a half, and its bounds in the world: one of four.
#[derive(Debug, Clone, Copy)]
struct Side<'a> {
    child: Child,
    four: &'a BoundsOfFour,
    lane: usize,
}

impl Side<'_> {
    fn size(&self) -> f32 {
        self.four.size(self.lane)
    }
}

impl Trees {
    /// The carrier of a lowered half; `seed`, a carrier nearby, saves time.
    pub(super) fn carried(
        &self,
        pair: &Pair,
        rotation: &DMat3,
        lateral: DVec2,
        counts: Counts,
        query: HeightQuery,
        seed: Option<Number>,
    ) -> Carried {
        let turned = Turned::new(pair, self, rotation, lateral.extend(0.0), counts);
        let mut found = Carried { by: None, covered: query.covered, took: 0 };
        let seed = seed.and_then(|number| Some((number, turned.element(&number)?)));
        if let Some((number, element)) = seed.filter(|(_, element)| element.normal.z > GENTLE) {
            let z = element.height(lateral);
            found.meet(&turned, lateral.extend(z), query.ceiling, number, element);
        }
        let mut search = Lowered { turned: &turned, lateral, query, found, floor: query.floor };
        if let Some(([fixed, moving], [f, m])) = &turned.roots() {
            let [fixed, moving] =
                [(fixed, f), (moving, m)].map(|(child, four)| Side { child: *child, four, lane: 0 });
            search.descend(&fixed, &moving);
        }
        Carried { took: DIVIDED * turned.divided.get(), ..search.found }
    }

    /// The element of two features, if it counts.
    pub(super) fn element(
        &self,
        pair: &Pair,
        rotation: &DMat3,
        counts: Counts,
        number: &Number,
    ) -> Option<Element> {
        Turned::new(pair, self, rotation, DVec3::ZERO, counts).element(number)
    }
}

#[cfg(test)]
mod tests;
