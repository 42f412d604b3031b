//! The pair at one rotation, as a list of elements: the height at which a lowered half stops, and its
//! contacts there.

use super::brute::SEAM;
use super::candidates::{Candidates, Counts, FLUSH, Sieve, Window};
use super::element::{Element, Meeting};
use super::search::{Carried, Gaps, HeightQuery, Lists, Number, Passing, Touching, Trees};
use super::{Contact, Pair};
use crate::pose::CorPose;
use crate::tolerance::{self, TOUCHING};
use glam::{DMat3, DVec2, DVec3};

/// Below this z-component a normal counts as horizontal: such a facet has no height of its own and is
/// represented by its rim. Slopes beyond 10⁹ are indistinguishable from a wall in double precision.
pub(super) const VERTICAL: f64 = tolerance::PARALLEL;

/// A pair at a rotation, with its possible contacts: a list of elements, or, without a list, the trees of the
/// pair.
#[derive(Debug, Clone)]
pub(super) struct Turned<'a> {
    pub(super) pair: &'a Pair,
    pub(super) rotation: DMat3,
    pub(super) elements: Vec<Element>,
    trees: Option<&'a Trees>,
    /// Which of their elements count.
    counts: Counts,
    /// The last carriers of the half, by the numbers of the trees, from far above and from a ceiling: the
    /// next search starts with them.
    carriers: [Option<Number>; 2],
    /// Results of the trees near a few poses, the most recent last: a step returns to its start, and
    /// continues from poses that were tried.
    near: Vec<Near>,
    /// Features that may touch, and those that may pass, near the current pose.
    touching: Lists<Touching>,
    passing: Lists<Passing>,
    /// Estimated cost of lowering, in nanoseconds.
    lowering: u64,
}

/// Number of poses whose neighbourhoods are stored: those of a step and its trials.
const KEPT: usize = 8;

/// Possible contacts near a pose, by the trees.
#[derive(Debug, Clone)]
struct Near {
    rotation: DMat3,
    position: DVec3,
    counts: Counts,
    gaps: Gaps,
    elements: Vec<(Number, Element)>,
}

impl<'a> Turned<'a> {
    /// Not turned yet: nothing touches.
    pub(super) fn new(pair: &'a Pair) -> Self {
        let (rotation, counts) = (DMat3::IDENTITY, Counts { slack: 0.0, lowest: VERTICAL });
        Self {
            pair,
            rotation,
            elements: Vec::new(),
            trees: None,
            counts,
            carriers: [None; 2],
            near: Vec::new(),
            touching: Lists::default(),
            passing: Lists::default(),
            lowering: 0,
        }
    }

    /// Replaces the elements by those among `candidates` at `rotation`.
    pub(super) fn turn(&mut self, rotation: &DMat3, candidates: &Candidates, counts: Counts) {
        (self.rotation, self.trees) = (*rotation, None);
        candidates.try_at(self.pair, rotation, counts, &mut self.elements);
    }

    /// Uses the trees of the pair for the possible contacts at `rotation`.
    pub(super) fn turn_trees(&mut self, rotation: &DMat3, trees: &'a Trees, counts: Counts) {
        (self.rotation, self.trees, self.counts) = (*rotation, Some(trees), counts);
        self.elements.clear();
    }

    /// The height of first contact at a single pose, in D, without features off to the side in plan view.
    pub(super) fn height_at(pair: &'a Pair, pose: &CorPose) -> Option<f64> {
        let mut turned = Self::new(pair);
        let counts = Counts { slack: FLUSH, lowest: VERTICAL };
        if let Some(trees) = &pair.trees {
            turned.turn_trees(&pose.rotation, trees, counts);
        } else {
            let window = Some(Window { lateral: pose.lateral, reach: 2.0 * SEAM });
            let mut candidates = Candidates::default();
            let sieve = Sieve { slack: counts.slack, lowest: counts.lowest, skin: 0.0, window };
            candidates.collect(pair, &pose.rotation, &sieve);
            turned.turn(&pose.rotation, &candidates, counts);
        }
        turned.height_below(pose.lateral, f64::INFINITY).0
    }

    /// Height at which a half lowered from `ceiling`, not from far above, is stopped; and whether something
    /// above the ceiling would have stopped it earlier. This is the case for a half that has slid under an
    /// overhang, or beside a wall.
    pub(super) fn height_below(&mut self, lateral: DVec2, ceiling: f64) -> (Option<f64>, bool) {
        self.height_about(lateral, ceiling, f64::NEG_INFINITY)
    }

    /// The same, faster if it is above `expected`.
    pub(super) fn height_about(
        &mut self,
        lateral: DVec2,
        ceiling: f64,
        expected: f64,
    ) -> (Option<f64>, bool) {
        if let Some(trees) = self.trees {
            // As a rule nothing is above the ceiling, and the whole is searched faster than a part.
            let mut carried =
                self.carried(trees, lateral, HeightQuery { floor: expected, ..HeightQuery::WHOLE });
            if carried.height().is_none_or(|height| height < expected) {
                carried = self.carried(trees, lateral, HeightQuery::WHOLE);
            }
            if carried.height().is_some_and(|height| height > ceiling) {
                carried = self.carried(
                    trees,
                    lateral,
                    HeightQuery { ceiling, covered: true, ..HeightQuery::WHOLE },
                );
            }
            return (carried.height(), carried.covered);
        }
        let mut highest = f64::NEG_INFINITY;
        let mut covered = false;
        for element in &self.elements {
            if element.normal.z <= VERTICAL {
                continue;
            }
            let z = element.height(lateral);
            let counts = if z > ceiling { !covered } else { z > highest };
            if counts && self.foot(element, lateral.extend(z), SEAM).is_some() {
                if z > ceiling {
                    covered = true;
                } else {
                    highest = z;
                }
            }
        }
        (highest.is_finite().then_some(highest), covered)
    }

    /// Whether a half lowered from far above is stopped above `level`.
    pub(super) fn is_stopped_above(&mut self, lateral: DVec2, level: f64) -> bool {
        let height = match self.trees {
            Some(trees) => self
                .carried(trees, lateral, HeightQuery { enough: level, floor: level, ..HeightQuery::WHOLE })
                .height(),
            None => self.height_below(lateral, f64::INFINITY).0,
        };
        height.is_some_and(|height| height > level)
    }

    /// The carrier of a half lowered from far above, by the trees.
    pub(super) fn carried_by(&mut self, lateral: DVec2) -> Option<(Element, Number, f64)> {
        self.trees.and_then(|trees| self.carried(trees, lateral, HeightQuery::WHOLE).by)
    }

    /// Only supporting features count: features that support only within a slack lie above the other half,
    /// and carry nothing.
    fn carried(&mut self, trees: &Trees, lateral: DVec2, query: HeightQuery) -> Carried {
        let counts = Counts { slack: FLUSH, lowest: VERTICAL };
        let carrier = &mut self.carriers[usize::from(query.ceiling.is_finite())];
        let carried = trees.carried(self.pair, &self.rotation, lateral, counts, query, *carrier);
        *carrier = carried.by.map(|(_, number, _)| number).or(*carrier);
        self.lowering += carried.took;
        carried
    }

    /// Estimated cost of all tree searches so far: counted, in nanoseconds.
    pub(super) const fn took(&self) -> u64 {
        self.lowering + self.touching.took + self.passing.took
    }

    /// Everything with such a gap along its normal, with the COR at `position`; a foot may lie beyond the border of its feature by `seam`. Deeper than
    /// that the halves are not near each other along this normal: they passed.
    pub(super) fn contacts(
        &mut self,
        position: DVec3,
        gaps: Gaps,
        seam: f64,
        mut meet: impl FnMut((Contact, Meeting)),
    ) {
        if let Some(trees) = self.trees {
            // Feet may lie beyond both borders.
            self.look_near(trees, position, gaps.widened(2.0 * seam));
        }
        let Self { pair, rotation, counts, .. } = &*self;
        // Elements found for a wider slack are filtered again.
        let near = self.trees.zip(self.near.last()).into_iter().flat_map(|(trees, near)| {
            let is_more = near.counts.slack > counts.slack;
            let does_count =
                move |number| !is_more || trees.element(pair, rotation, *counts, number).is_some();
            near.elements.iter().filter(move |(number, _)| does_count(number)).map(|(_, element)| element)
        });
        for element in self.elements.iter().chain(near) {
            let gap = element.gap(position);
            if !gaps.hold(gap) {
                continue;
            }
            if let Some(point) = self.foot(element, position, seam) {
                meet((Contact { gap, normal: element.normal, point }, element.meeting));
            }
        }
    }

    /// Ensures that the last result contains all features with such gaps here, or more.
    fn look_near(&mut self, trees: &Trees, position: DVec3, gaps: Gaps) {
        let Self { pair, rotation, counts, near, touching, .. } = self;
        let holds = |near: &Near| {
            near.position == position
                && near.rotation == *rotation
                && near.counts.lowest == counts.lowest
                && near.counts.slack >= counts.slack
                && near.gaps.deep >= gaps.deep
                && near.gaps.front >= gaps.front
        };
        if let Some(k) = near.iter().position(holds) {
            near[k..].rotate_left(1);
            return;
        }
        // Keep the mated pose: if halves are in contact everywhere, many motions end there, and the search
        // there takes longest.
        let mated = |near: &Near| near.rotation == DMat3::IDENTITY && near.position.truncate() == DVec2::ZERO;
        let mut elements = if near.len() < KEPT {
            Vec::new()
        } else {
            near.remove(near.iter().position(|near| !mated(near)).unwrap_or(0)).elements
        };
        // A pose that a motion tries is often the start of the next step.
        let least = TOUCHING + 2.0 * SEAM;
        let gaps = Gaps { deep: gaps.deep.max(least), front: gaps.front.max(least) };
        trees.near(pair, (rotation, position), *counts, gaps, touching, &mut elements);
        near.push(Near { rotation: *rotation, position, counts: *counts, gaps, elements });
    }

    /// Whether the halves overlap with the COR at `position` and the moving half at a rotation.
    pub(super) fn overlaps(&mut self, rotation: &DMat3, position: DVec3) -> bool {
        match &self.pair.trees {
            Some(trees) => trees.overlap(self.pair, rotation, position, Some(&mut self.passing)),
            None => self.pair.overlaps(rotation, position),
        }
    }

    fn foot(&self, element: &Element, position: DVec3, seam: f64) -> Option<DVec3> {
        let [f, m] = element.meeting.shapes.map(|s| s as usize);
        element.foot(&self.pair.fixed_shapes[f], &self.pair.moving_shapes[m], &self.rotation, position, seam)
    }
}
