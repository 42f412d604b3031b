//! Lists of nearby pairs of features, kept for a neighbourhood of poses, for halves with many facets.
//!
//! ```text
//!        ╭──────────────────╮  list 0: pairs within 0.3 D at (R₀, c₀), from the trees
//!        │    ╭───────╮     │
//!        │    │ ╭─╮   │     │  list 1: pairs within 0.08 D at (R₁, c₁), from list 0; and so on down to 0.004 D
//!        │    │ ╰─╯ · │     │
//!        │    ╰───────╯     │  moved = |c − c₀| + radius·|R − R₀|     bounds the displacement of each point of the moving half
//!        ╰──────────────────╯
//! ```
//!
//! Every pair has its *clearance*: a lower bound of the distance of the two features at the pose of the list.
//! At another pose two features within `reach` of each other have a clearance of at most `moved` + `reach`.
//! In a list sorted by clearance an initial part therefore answers the query, as long as that sum is at most
//! the reach of the list. Directions are sieved as in [`super::super::candidates`], widened by the rotation
//! for which a list holds.
//!
//! A wider list serves longer and costs more to make, so it is rented before it is bought (ski rental: at
//! most about twice the minimum cost). Lists are made from the trees, and for each of several poses the
//! savings of a wider list there are accumulated. The wider list is made once its savings exceed its price. A
//! list that serves a single query is a waste: the next query uses the trees, and a list is made at the
//! second query near the same pose.
//!
//! Prices are counts of the pairs tested, of parts in the trees and of features in lists, which take about
//! equal time.
//!
//! The results are those of the trees: every pair whose contact lies on both features, with the same numbers.
//! If a list would hold more than [`MOST`] pairs, the next narrower list is the widest.

use super::{DIVIDED, ENLISTED, LISTED, Meets, Number, Turned, meeting};
use crate::contact::candidates::{Candidate, Counts, Sieve, edges_may_touch};
use crate::contact::nearby::chord;
use crate::contact::overlap::Frames;
use crate::contact::shape::Shape;
use crate::contact::tree::{Child, Kind, Leaf};
use glam::{DMat3, DVec3};

/// Pairs of a list, at most.
const MOST: usize = 150_000;
/// Number of lists of the same reach that are kept: a step tries poses on both sides of its end.
const KEPT: usize = 3;
/// Places of each level for which savings are kept.
const RENTED: usize = 16;
/// Estimated price of a list relative to the price of a list of the next narrower level, before one was made.
const WIDER: u64 = 5;
/// Rounding of a clearance and of the distance that a half has moved, in D.
const ROUNDED: f64 = 1e-6;
/// Share of its reach by which a half may have rotated for a list to hold.
const TURNED: f64 = 0.5;

/// Type of the stored pairs: two features that may meet, or an edge and a facet that it may pass through.
pub(in crate::contact) trait Pairs {
    /// Two features.
    type Two: Copy;
    /// Reaches of the lists, in D, the widest first; each serves queries up to half of it.
    const REACHES: &'static [f64];
    /// Whether pairs count only if they face each other.
    const FACE: bool;
    /// Whether parts hold such pairs.
    fn meet(fixed: Child, moving: Child) -> bool;
    /// The pair of two features.
    fn of(fixed: &Leaf, moving: &Leaf) -> Option<Self::Two>;
    /// A lower bound of the distance of two features, if they may count within the sieve's turn; above `most` it may be any.
    fn clearance(turned: &Turned<'_>, two: &Self::Two, sieve: &Sieve, most: f64) -> Option<f64>;
}

/// Poses for which a list holds.
#[derive(Debug, Clone)]
struct Ball {
    rotation: DMat3,
    position: DVec3,
    counts: Counts,
    /// Up to which turn.
    skin: f64,
    reach: f64,
}

impl Ball {
    /// About a pose, for a level of this reach.
    fn about(turned: &Turned<'_>, reach: f64) -> Self {
        let Turned { rotation, position, counts, .. } = *turned;
        Self { rotation, position, counts, skin: TURNED * reach / turned.trees.radius, reach }
    }

    /// Largest difference between a pair's clearance and its distance at another pose, if the list contains
    /// all pairs within `reach` there.
    fn moved(&self, turned: &Turned<'_>, reach: f64, skin: f64) -> Option<f64> {
        let turn = chord(&self.rotation, &turned.rotation);
        let moved = self.position.distance(turned.position) + turned.trees.radius * turn + ROUNDED;
        let holds = turned.counts.slack <= self.counts.slack
            && turned.counts.lowest >= self.counts.lowest
            && turn + skin <= self.skin
            && moved + reach <= self.reach;
        holds.then_some(moved)
    }
}

/// The pairs around a pose, by their clearances.
#[derive(Debug, Clone)]
struct List<T> {
    ball: Ball,
    /// Whether it has served a second query.
    is_worth_it: bool,
    pairs: Vec<(f64, T)>,
}

/// The lists of one reach, and their cost, in pairs tested.
#[derive(Debug, Clone)]
struct Level<T> {
    /// The most recently used list at the end.
    lists: Vec<List<T>>,
    /// The pose of the last query that went to the trees without a list.
    unlisted: Option<Ball>,
    /// Poses at which a list would have saved this much; the most recently used at the end.
    rented: Vec<(Ball, u64)>,
    /// The cost of the last list, of the last list from the trees, and of the last list from a wider list.
    price: Option<u64>,
    from_trees: Option<u64>,
    from_list: Option<u64>,
}

/// Lists within lists.
#[derive(Debug, Clone)]
pub(in crate::contact) struct Lists<P: Pairs> {
    levels: Vec<Level<P::Two>>,
    /// The widest that is not too long.
    widest: usize,
    /// Estimated total cost, in nanoseconds.
    pub(in crate::contact) took: u64,
}

impl<P: Pairs> Default for Lists<P> {
    fn default() -> Self {
        let level = |_: &f64| Level {
            lists: Vec::new(),
            unlisted: None,
            rented: Vec::new(),
            price: None,
            from_trees: None,
            from_list: None,
        };
        Self { levels: P::REACHES.iter().map(level).collect(), widest: 0, took: 0 }
    }
}

impl<T> Level<T> {
    /// Ensures that the last list contains all pairs within `reach` of each other for rotations of `skin`, if
    /// a list can; returns the largest excess of the clearances.
    fn find(&mut self, turned: &Turned<'_>, reach: f64, skin: f64) -> Option<f64> {
        let lists = self.lists.iter().enumerate().rev();
        let (k, moved) =
            lists.into_iter().find_map(|(k, list)| Some((k, list.ball.moved(turned, reach, skin)?)))?;
        self.lists[k..].rotate_left(1);
        Some(moved)
    }

    /// Whether a list should serve a query: an existing list, or a new list that is likely to serve another
    /// query, as the last one did.
    fn is_worth_it(&mut self, turned: &Turned<'_>, own: f64, reach: f64) -> bool {
        let holds = |ball: &Ball| ball.moved(turned, reach, 0.0).is_some();
        if let Some(list) = self.lists.iter_mut().rev().find(|list| holds(&list.ball)) {
            list.is_worth_it = true;
            return true;
        }
        let last = self.lists.last().is_none_or(|list| list.is_worth_it);
        if last || self.unlisted.as_ref().is_some_and(holds) {
            return true;
        }
        self.unlisted = Some(Ball::about(turned, own));
        false
    }

    /// The pairs of the last list that may be within `reach` of each other.
    fn last_within(&self, moved: f64, reach: f64) -> &[(f64, T)] {
        let pairs = self.lists.last().map_or(&[][..], |list| &list.pairs);
        &pairs[..pairs.partition_point(|(clearance, _)| *clearance <= moved + reach)]
    }

    /// Accumulates the savings of a list of this level at a pose, if `narrow` had been made from it.
    fn rent(&mut self, turned: &Turned<'_>, reach: f64, narrow: &Ball, saved: u64) {
        let holds = |(ball, _): &(Ball, u64)| ball.moved(turned, narrow.reach, narrow.skin).is_some();
        if let Some(k) = self.rented.iter().position(holds) {
            self.rented[k].1 += saved;
            self.rented[k..].rotate_left(1);
            return;
        }
        if self.rented.len() == RENTED {
            self.rented.remove(0);
        }
        self.rented.push((Ball::about(turned, reach), saved));
    }
}

impl<P: Pairs> Lists<P> {
    /// Passes every pair within `reach` of each other, and some beyond, to `see`; returns whether a list
    /// could serve, and passes nothing if not.
    fn within(&mut self, turned: &Turned<'_>, reach: f64, mut see: impl FnMut(&P::Two) -> bool) -> bool {
        let fits = |level: &usize| reach <= 0.5 * P::REACHES[*level];
        let Some(level) = (self.widest..P::REACHES.len()).rev().find(fits) else { return false };
        if !self.levels[level].is_worth_it(turned, P::REACHES[level], reach) {
            return false;
        }
        let Some(moved) = self.prepare(turned, level, reach, 0.0) else { return false };
        let pairs = self.levels[level].last_within(moved, reach);
        let looked = pairs.iter().position(|(_, two)| see(two)).map_or(pairs.len(), |last| last + 1);
        self.took += LISTED * looked as u64;
        true
    }

    /// Ensures that the last list of a level contains all pairs within `reach` of each other for rotations of
    /// `skin`; returns the largest excess of the clearances.
    fn prepare(&mut self, turned: &Turned<'_>, level: usize, reach: f64, skin: f64) -> Option<f64> {
        if let Some(moved) = self.levels[level].find(turned, reach, skin) {
            return Some(moved);
        }
        let own = P::REACHES[level];
        let ball = Ball::about(turned, own);
        let Counts { slack, lowest } = ball.counts;
        let sieve = Sieve { slack, lowest, skin: ball.skin, window: None };
        let wide = Turned { counts: ball.counts, ..turned.clone() };
        let wider = self.wider(&wide, level, &ball);
        let mut pairs = if self.levels[level].lists.len() < KEPT {
            Vec::new()
        } else {
            let mut oldest = self.levels[level].lists.remove(0).pairs;
            oldest.clear();
            oldest
        };
        let mut tried = 0;
        let mut add = |two: &P::Two| {
            tried += 1;
            let clearance = P::clearance(turned, two, &sieve, own).filter(|clearance| *clearance <= own);
            pairs.extend(clearance.map(|clearance| (clearance, *two)));
            pairs.len() <= MOST
        };
        let price = if let Some((k, moved)) = wider {
            let from = self.levels[k].last_within(moved, own);
            for (_, two) in from {
                add(two);
            }
            let looked = from.len() as u64;
            self.levels[level].from_list = Some(looked);
            looked
        } else if let Some(looked) = turned.near_each_other::<P>(own, &sieve, &mut add) {
            self.levels[level].from_trees = Some(looked);
            if level > self.widest {
                let saved = looked.saturating_sub(self.levels[level].from_list.unwrap_or(looked / 2));
                let above = &mut self.levels[level - 1];
                above.price.get_or_insert(WIDER * looked);
                above.rent(&wide, P::REACHES[level - 1], &ball, saved);
            }
            looked
        } else {
            self.widest = level + 1;
            self.levels[level].lists.clear();
            return None;
        };
        self.took +=
            ENLISTED * tried + if wider.is_some() { 0 } else { DIVIDED * price.saturating_sub(tried) };
        self.levels[level].price = Some(price);
        pairs.sort_unstable_by(|(a, _), (b, _)| a.total_cmp(b));
        let moved = ball.moved(turned, reach, skin);
        let is_worth_it =
            self.levels[level].unlisted.take().is_some_and(|one| one.moved(turned, reach, skin).is_some());
        self.levels[level].lists.push(List { ball, is_worth_it, pairs });
        moved
    }

    /// The level whose last list contains all pairs for a narrower ball, and the largest excess of its
    /// clearances: an existing list that is shorter than a search of the trees, or a list that has paid off.
    fn wider(&mut self, turned: &Turned<'_>, level: usize, narrow: &Ball) -> Option<(usize, f64)> {
        let from_trees = self.levels[level].from_trees.unwrap_or(u64::MAX);
        for k in (self.widest..level).rev() {
            if let Some(moved) = self.levels[k].find(turned, narrow.reach, narrow.skin) {
                let count = self.levels[k].last_within(moved, narrow.reach).len() as u64;
                if count < from_trees {
                    return Some((k, moved));
                }
            }
        }
        let k = level.checked_sub(1).filter(|k| *k >= self.widest)?;
        let Level { rented, price, .. } = &mut self.levels[k];
        let price = (*price)?;
        let holds = |ball: &Ball| ball.moved(turned, narrow.reach, narrow.skin).is_some();
        let paid = rented.iter().position(|(ball, saved)| *saved > price && holds(ball))?;
        rented.remove(paid);
        Some((k, self.prepare(turned, k, narrow.reach, narrow.skin)?))
    }
}

/// Features that may touch.
#[derive(Debug, Clone)]
pub(in crate::contact) struct Touching;

impl Pairs for Touching {
    type Two = Number;
    const REACHES: &'static [f64] = &[0.3, 0.08, 0.02, 0.004];
    const FACE: bool = true;

    fn meet(fixed: Child, moving: Child) -> bool {
        fixed.meets(moving)
    }

    fn of(fixed: &Leaf, moving: &Leaf) -> Option<Number> {
        meeting(fixed, moving)
    }

    fn clearance(turned: &Turned<'_>, (meets, two): &Number, sieve: &Sieve, most: f64) -> Option<f64> {
        let (fixed, moving) = turned.shapes(two.shapes);
        let (f, m) = (two.fixed as usize, two.moving as usize);
        let wide = sieve.slack + sieve.skin;
        match meets {
            Meets::FacetCorner => {
                let (normal, corner) = (fixed.facets[f].normal, &moving.corners[m]);
                let seen = turned.back * normal;
                let counts = normal.z > sieve.lowest
                    && moving.spokes_of(corner).iter().all(|spoke| seen.dot(*spoke) >= -wide);
                let at = || turned.rotation * moving.at(corner.vertex) + turned.position;
                counts.then(|| from_facet(fixed, two.fixed, at(), most))
            }
            Meets::CornerFacet => {
                let normal = turned.rotation * moving.facets[m].normal;
                let corner = &fixed.corners[f];
                let counts = -normal.z > sieve.lowest - sieve.skin
                    && fixed.spokes_of(corner).iter().all(|spoke| normal.dot(*spoke) >= -wide);
                let at = || turned.back * (fixed.at(corner.vertex) - turned.position);
                counts.then(|| from_facet(moving, two.moving, at(), most))
            }
            Meets::EdgeEdge => {
                let (u, w) = (&fixed.ridges[f], &moving.ridges[m]);
                let counts = u.normals.iter().any(|n| n.z > sieve.lowest)
                    && edges_may_touch(u, w, &turned.rotation, turned.back * u.along, sieve);
                let ends = || w.ends.map(|k| turned.rotation * moving.at(k) + turned.position);
                counts.then(|| of_segments(u.ends.map(|k| fixed.at(k)), ends()))
            }
        }
    }
}

/// Edges of one half and facets of the other: whether the facet is fixed, and the two features.
#[derive(Debug, Clone)]
pub(in crate::contact) struct Passing;

impl Pairs for Passing {
    type Two = (bool, Candidate);
    const REACHES: &'static [f64] = &[0.02, 0.003];
    const FACE: bool = false;

    fn meet(fixed: Child, moving: Child) -> bool {
        fixed.may_pass(moving)
    }

    fn of(fixed: &Leaf, moving: &Leaf) -> Option<Self::Two> {
        let is_facet = match (fixed.kind, moving.kind) {
            (Kind::Facet, Kind::Ridge) => true,
            (Kind::Ridge, Kind::Facet) => false,
            _ => return None,
        };
        let shapes = [fixed.shape, moving.shape];
        Some((is_facet, Candidate { shapes, fixed: fixed.index, moving: moving.index }))
    }

    fn clearance(turned: &Turned<'_>, (is_facet, two): &Self::Two, _: &Sieve, most: f64) -> Option<f64> {
        let (fixed, moving) = turned.shapes(two.shapes);
        let (f, m) = (two.fixed as usize, two.moving as usize);
        Some(if *is_facet {
            let ends = moving.ridges[m].ends.map(|k| turned.rotation * moving.at(k) + turned.position);
            of_segment_and_facet(ends, fixed, two.fixed, most)
        } else {
            let ends = fixed.ridges[f].ends.map(|k| turned.back * (fixed.at(k) - turned.position));
            of_segment_and_facet(ends, moving, two.moving, most)
        })
    }
}

impl Lists<Touching> {
    /// The elements with such gaps, in the order of the list of all elements; returns whether lists could
    /// serve.
    pub(super) fn near(
        &mut self,
        turned: &Turned<'_>,
        gaps: super::Gaps,
        out: &mut Vec<(Number, super::Element)>,
    ) -> bool {
        out.clear();
        let is_complete = self.within(turned, gaps.deep.max(gaps.front), |number| {
            let element = turned.element(number).filter(|element| gaps.hold(element.gap(turned.position)));
            out.extend(element.map(|element| (*number, element)));
            false
        });
        out.sort_unstable_by_key(|(number, _)| *number);
        is_complete
    }
}

impl Lists<Passing> {
    /// Whether an edge of one half passes through a facet of the other; `None` if lists cannot decide.
    pub(super) fn pass(&mut self, turned: &Turned<'_>, reach: f64) -> Option<bool> {
        let frames = Frames::new(&turned.rotation, turned.position);
        let mut result = false;
        let is_complete = self.within(turned, reach, |(is_facet, two)| {
            let (fixed, moving) = turned.shapes(two.shapes);
            result = if *is_facet {
                frames.moving_enters(moving, two.moving, fixed, two.fixed)
            } else {
                frames.fixed_enters(fixed, two.fixed, moving, two.moving)
            };
            result
        });
        is_complete.then_some(result)
    }
}

/// A lower bound of the distance of a point from a facet; only of its plane if that is above `most`.
fn from_facet(shape: &Shape, facet: u32, point: DVec3, most: f64) -> f64 {
    let normal = shape.facets[facet as usize].normal;
    let above = normal.dot(point) - shape.levels[facet as usize];
    if above.abs() > most {
        return above.abs();
    }
    let mut beyond = 0.0f64;
    for side in shape.sides_of(facet) {
        beyond = beyond.max(side.along.cross(normal).dot(point - side.from));
    }
    above.hypot(beyond)
}

/// The same of a segment: some plane of the facet's own or along its border lies between them.
fn of_segment_and_facet(ends: [DVec3; 2], shape: &Shape, facet: u32, most: f64) -> f64 {
    let normal = shape.facets[facet as usize].normal;
    let heights = ends.map(|p| normal.dot(p) - shape.levels[facet as usize]);
    let above = if heights[0] * heights[1] > 0.0 { heights[0].abs().min(heights[1].abs()) } else { 0.0 };
    if above > most {
        return above;
    }
    let mut least = above;
    for side in shape.sides_of(facet) {
        let out = side.along.cross(normal);
        let [start, end] = ends.map(|p| out.dot(p - side.from));
        least = least.max(start.min(end));
    }
    least
}

/// The distance of two segments (Ericson, *Real-Time Collision Detection*, 2005, 5.1.9).
fn of_segments([a, b]: [DVec3; 2], [p, q]: [DVec3; 2]) -> f64 {
    let (u, w, r) = (b - a, q - p, a - p);
    let (uu, ww, uw) = (u.length_squared(), w.length_squared(), u.dot(w));
    let (ur, wr) = (u.dot(r), w.dot(r));
    let across = uu * ww - uw * uw;
    let s = if across > 0.0 { ((uw * wr - ur * ww) / across).clamp(0.0, 1.0) } else { 0.0 };
    let t = if ww > 0.0 { ((uw * s + wr) / ww).clamp(0.0, 1.0) } else { 0.0 };
    let s = if uu > 0.0 { ((uw * t - ur) / uu).clamp(0.0, 1.0) } else { 0.0 };
    (r + u * s - w * t).length()
}
