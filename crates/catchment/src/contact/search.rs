//! Heights and contacts of halves of many facets, by their trees.
//!
//! ```text
//!   height     the pair of nodes that may carry highest first; what cannot rise above the best so far is left out
//!   contacts   pairs of nodes that are near each other
//! ```
//!
//! The answers are those of the list of all elements ([`super::turned`]): the same elements are tried where they may count, and among
//! equals the first in the order of that list counts. Two nodes may tie within rounding: what is [`SURE`] to be lower is left out.

use super::candidates::{Candidate, Counts, corner_facet, edge_edge, facet_corner};
use super::element::Element;
use super::shape::Shape;
use super::tree::{Leaf, Part, Placed, Tree};
use super::turned::VERTICAL;
use super::{Pair, brute::SEAM};
use glam::{DMat3, DVec2, DVec3};

/// How far beyond the bounds of its facets a height of contact may come, in D: rounding of planes as steep as bound heights, and the
/// seam on them (2e-12 on a slope of 20). Steeper elements round worse, and are held to it.
const SURE: f64 = 1e-10;
/// What the steepest elements round to at most, in D: 1e-16 on a slope of 10⁹.
const STEEPEST: f64 = 1e-6;
/// Elements whose normal has a larger z-component keep to [`SURE`] by themselves: 1e-16 on a slope of 10⁵.
const GENTLE: f64 = 1e-5;

/// Where a corner is over a facet, the height is at least that of their touching, whether they support it or not; by as much as this, in
/// D, facets that count as one plane may leave it lower.
const LOOSE: f64 = 1e-5;

/// Which kinds of features meet, in the order of the list of all elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    FacetCorner,
    CornerFacet,
    EdgeEdge,
}

/// The place of an element in the list of all.
pub(super) type Number = (Kind, Candidate);

/// The trees of both halves.
#[derive(Debug, Clone)]
pub(super) struct Trees {
    pub(super) fixed: Tree,
    pub(super) moving: Tree,
}

/// What is asked of heights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked {
    /// From where the half is lowered.
    pub(super) ceiling: f64,
    /// Any height above this one is as good as the greatest.
    pub(super) enough: f64,
}

/// What carries a half lowered from a ceiling.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Carried {
    /// The element, its place in the list, and its height.
    pub(super) by: Option<(Element, Number, f64)>,
    /// Whether something above the ceiling would have stopped it earlier.
    pub(super) covered: bool,
}

impl Carried {
    pub(super) fn height(&self) -> Option<f64> {
        self.by.map(|(_, _, height)| height)
    }
}

/// The pair at one rotation.
struct Turned<'a> {
    pair: &'a Pair,
    trees: &'a Trees,
    rotation: DMat3,
    back: DMat3,
    counts: Counts,
}

impl<'a> Turned<'a> {
    fn new(pair: &'a Pair, trees: &'a Trees, rotation: &DMat3, counts: Counts) -> Self {
        Self { pair, trees, rotation: *rotation, back: rotation.transpose(), counts }
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
            Kind::FacetCorner => {
                let normal = fixed.facets[candidate.fixed as usize].normal;
                let element = || facet_corner(candidate, fixed, moving, self.back * normal, slack);
                (normal.z > lowest).then(element)?
            }
            Kind::CornerFacet => {
                let normal = self.rotation * moving.facets[candidate.moving as usize].normal;
                corner_facet(candidate, fixed, moving, normal, slack, lowest)
            }
            Kind::EdgeEdge => {
                let ridge = &fixed.ridges[candidate.fixed as usize];
                let element = || {
                    let seen = self.back * ridge.along;
                    edge_edge(candidate, fixed, moving, &self.rotation, seen, slack, lowest)
                };
                ridge.normals.iter().any(|n| n.z > lowest).then(element)?
            }
        }
    }

    /// Calls `meet` with every pair of features of two leaves that may be an element.
    fn numbers(&self, fixed: &Leaf, moving: &Leaf, mut meet: impl FnMut(Number)) {
        let shapes = [fixed.shape, moving.shape];
        let Trees { fixed: of_fixed, moving: of_moving } = self.trees;
        let mut meet = |kind, fixed: u32, moving: u32| meet((kind, Candidate { shapes, fixed, moving }));
        of_moving.corners(moving).iter().for_each(|corner| meet(Kind::FacetCorner, fixed.facet, *corner));
        of_fixed.corners(fixed).iter().for_each(|corner| meet(Kind::CornerFacet, *corner, moving.facet));
        for ridge in of_moving.ridges(moving) {
            of_fixed.ridges(fixed).iter().for_each(|other| meet(Kind::EdgeEdge, *other, *ridge));
        }
    }

    /// Whether an element touches its features with the COR at `position`.
    fn is_on(&self, element: &Element, position: DVec3) -> bool {
        let (fixed, moving) = self.shapes(element.meeting.shapes);
        element.foot(fixed, moving, &self.rotation, position, SEAM).is_some()
    }
}

/// The search for what carries a half.
struct Lowered<'a> {
    turned: Turned<'a>,
    placed: Placed,
    lateral: DVec2,
    asked: Asked,
    found: Carried,
    /// No height is the greatest below this one.
    floor: f64,
}

impl Lowered<'_> {
    /// Whether anything between these heights may still count.
    fn may_count(&self, [least, most]: [f64; 2]) -> bool {
        let Asked { ceiling, enough } = self.asked;
        let best = self.found.height().unwrap_or(f64::NEG_INFINITY);
        if best > enough {
            return false;
        }
        if most + SURE <= ceiling {
            most + SURE >= best.max(self.floor)
        } else {
            !self.found.covered || (least <= ceiling + SURE && ceiling >= best)
        }
    }

    /// Tries the features of two leaves, no height of which is above `most`.
    fn try_leaves(&mut self, fixed: &Leaf, moving: &Leaf, most: f64) {
        let Self { turned, lateral, asked, found, floor, .. } = self;
        let any = Counts { slack: f64::INFINITY, lowest: VERTICAL };
        turned.numbers(fixed, moving, |number| {
            // Of the features of these facets, beside which it may be.
            let height = |element: &Element| {
                let z = element.height(*lateral);
                (z <= most + STEEPEST).then(|| z.min(most + SURE))
            };
            if asked.ceiling == f64::INFINITY && number.0 != Kind::EdgeEdge {
                let Some(element) = turned.element_within(&number, any) else { return };
                let on = |z: &f64| *z >= *floor && turned.is_on(&element, lateral.extend(*z));
                let Some(z) = height(&element).filter(on) else { return };
                *floor = floor.max(z - LOOSE);
            }
            let element = turned.element(&number).and_then(|element| Some((element, height(&element)?)));
            if let Some((element, z)) = element {
                found.meet(turned, lateral.extend(z), asked.ceiling, number, element);
            }
        });
    }

    /// Tries two nodes, no height of which is above `most`; `m` is where that of the moving half is.
    fn descend(&mut self, fixed: u32, moving: u32, m: &Part, most: f64) {
        let trees = self.turned.trees;
        match trees.split(fixed, moving) {
            Split::Leaves(fixed, moving) => self.try_leaves(fixed, moving, most),
            Split::Fixed(a, b) => {
                let heights = |k| trees.fixed.node(k).part.heights(m);
                self.both([(a, moving, m, heights(a)), (b, moving, m, heights(b))]);
            }
            Split::Moving(a, b) => {
                let f = &trees.fixed.node(fixed).part;
                let p = self.placed.part(&trees.moving.node(a).part);
                let q = self.placed.part(&trees.moving.node(b).part);
                self.both([(fixed, a, &p, f.heights(&p)), (fixed, b, &q, f.heights(&q))]);
            }
        }
    }

    /// Tries two pairs of nodes, the one that may be higher first.
    fn both(&mut self, pairs: [(u32, u32, &Part, Option<[f64; 2]>); 2]) {
        let higher = |k: usize| pairs[k].3.map_or(f64::NEG_INFINITY, |[_, most]| most);
        let first = usize::from(higher(1) > higher(0));
        for (fixed, moving, m, bounds) in [pairs[first], pairs[1 - first]] {
            if let Some(bounds) = bounds.filter(|bounds| self.may_count(*bounds)) {
                self.descend(fixed, moving, m, bounds[1]);
            }
        }
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

/// The search for what is near.
struct Close<'a> {
    turned: Turned<'a>,
    placed: Placed,
    position: DVec3,
    reach: f64,
    out: &'a mut Vec<(Number, Element)>,
}

impl Close<'_> {
    /// Tries two nodes; `m` is where that of the moving half is.
    fn descend(&mut self, fixed: u32, moving: u32, m: &Part) {
        let trees = self.turned.trees;
        if !trees.fixed.node(fixed).part.is_near(m, self.reach) {
            return;
        }
        match trees.split(fixed, moving) {
            Split::Leaves(fixed, moving) => {
                let Self { turned, position, reach, out, .. } = self;
                turned.numbers(fixed, moving, |number| {
                    let element = turned.element(&number);
                    let near = element.filter(|element| element.gap(*position).abs() <= *reach);
                    out.extend(near.map(|element| (number, element)));
                });
            }
            Split::Fixed(a, b) => [a, b].iter().for_each(|fixed| self.descend(*fixed, moving, m)),
            Split::Moving(a, b) => {
                for moving in [a, b] {
                    let m = self.placed.part(&trees.moving.node(moving).part);
                    self.descend(fixed, moving, &m);
                }
            }
        }
    }
}

/// How much smaller a node of the fixed half may be and still be split first: where it is, is known.
const SOONER: f64 = 1.5;

/// What is below two nodes.
enum Split<'a> {
    /// Two leaves.
    Leaves(&'a Leaf, &'a Leaf),
    /// The children of the fixed half's node.
    Fixed(u32, u32),
    /// The children of the moving half's node.
    Moving(u32, u32),
}

impl Trees {
    /// What to look at next below two nodes.
    fn split(&self, fixed: u32, moving: u32) -> Split<'_> {
        let (f, m) = (self.fixed.node(fixed), self.moving.node(moving));
        if f.is_leaf && m.is_leaf {
            Split::Leaves(self.fixed.leaf(fixed), self.moving.leaf(moving))
        } else if m.is_leaf || !f.is_leaf && SOONER * f.part.size() >= m.part.size() {
            let [a, b] = self.fixed.children(fixed);
            Split::Fixed(a, b)
        } else {
            let [a, b] = self.moving.children(moving);
            Split::Moving(a, b)
        }
    }

    /// The roots, unless a half has no facets.
    fn roots(&self) -> Option<(u32, u32)> {
        Some((self.fixed.root()?, self.moving.root()?))
    }

    /// What carries a lowered half; `seed` did so nearby, and saves time.
    pub(super) fn carried(
        &self,
        pair: &Pair,
        rotation: &DMat3,
        lateral: DVec2,
        counts: Counts,
        asked: Asked,
        seed: Option<Number>,
    ) -> Carried {
        let turned = Turned::new(pair, self, rotation, counts);
        let mut found = Carried::default();
        let seed = seed.and_then(|number| Some((number, turned.element(&number)?)));
        if let Some((number, element)) = seed.filter(|(_, element)| element.normal.z > GENTLE) {
            let z = element.height(lateral);
            found.meet(&turned, lateral.extend(z), asked.ceiling, number, element);
        }
        let placed = Placed::new(*rotation, lateral.extend(0.0));
        // What is lower than enough is not asked for.
        let floor = if asked.enough < f64::INFINITY { asked.enough } else { f64::NEG_INFINITY };
        let mut search = Lowered { turned, placed, lateral, asked, found, floor };
        if let Some((fixed, moving)) = self.roots() {
            search.descend(fixed, moving, &placed.part(&self.moving.node(moving).part), f64::INFINITY);
        }
        search.found
    }

    /// The elements whose features may be as close as `reach` with the COR at `position`, in the order of the list of all.
    pub(super) fn near(
        &self,
        pair: &Pair,
        rotation: &DMat3,
        position: DVec3,
        counts: Counts,
        reach: f64,
        out: &mut Vec<(Number, Element)>,
    ) {
        out.clear();
        let turned = Turned::new(pair, self, rotation, counts);
        let placed = Placed::new(*rotation, position);
        if let Some((fixed, moving)) = self.roots() {
            let m = placed.part(&self.moving.node(moving).part);
            Close { turned, placed, position, reach, out }.descend(fixed, moving, &m);
        }
        out.sort_unstable_by_key(|(number, _)| *number);
    }
}

#[cfg(test)]
mod tests;
