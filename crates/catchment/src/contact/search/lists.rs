//! Pairs of features that are near each other, kept for a neighbourhood of poses, of halves of many facets.
//!
//! ```text
//!        ╭──────────────────╮  list 0: pairs within 0.3 D at (R₀, c₀), from the trees
//!        │    ╭───────╮     │
//!        │    │ ╭─╮   │     │  list 1: pairs within 0.08 D at (R₁, c₁), from list 0; and so on down to 0.001 D
//!        │    │ ╰─╯ · │     │
//!        │    ╰───────╯     │  moved = |c − c₀| + radius·|R − R₀|     how far any point of the moving half is from where it was
//!        ╰──────────────────╯
//! ```
//!
//! Every pair has its *clearance*: a lower bound of the distance of the two features where the list was made. At another pose two features within `reach` of
//! each other have a clearance of at most `moved` + `reach`, so of a list sorted by clearance the first part answers, as long as that sum is not above the
//! reach of the list. Directions are sieved as in [`super::super::candidates`], widened by the turn for which a list holds.
//!
//! A wider list serves for longer, and takes longer to make. Which of the two is cheaper depends on how far the motion goes on, which nobody knows: the first few
//! lists of a level are made from the trees, and then one of the next wider level (ski rental: at most a few times what knowing it would take).
//!
//! The answers are those of the trees: every pair whose contact lies on both features, with the same numbers. Where a list would hold more than
//! [`MOST`] pairs, the next narrower one is the widest.

use super::{Meets, Number, Turned, meeting};
use crate::contact::candidates::{Candidate, Counts, Sieve, edges_may_touch};
use crate::contact::nearby::chord;
use crate::contact::overlap::Frames;
use crate::contact::shape::Shape;
use crate::contact::tree::{Child, Kind, Leaf, SLACKS};
use glam::{DMat3, DVec3};

/// Pairs of a list, at most.
const MOST: usize = 150_000;
/// Lists of one reach that are kept: a step tries poses on both sides of where it ends.
const KEPT: usize = 3;
/// So many lists of a level are made from the trees before a wider one is made to take them from; none where the last wider one served as many.
const RENTED: usize = 3;
/// What rounding makes of a clearance and of how far a half has moved, in D.
const ROUNDED: f64 = 1e-6;
/// The share of its reach by which a half may have turned where a list holds.
const TURNED: f64 = 0.5;

/// What is kept: two features that may meet, or an edge and a facet that it may pass through.
pub(in crate::contact) trait Pairs {
    /// Two features.
    type Two: Copy;
    /// Reaches of the lists, in D, the widest first; each is asked for up to half of it.
    const REACHES: &'static [f64];
    /// Whether they count only where they face each other.
    const FACE: bool;
    /// Whether parts hold such pairs.
    fn meet(fixed: Child, moving: Child) -> bool;
    /// The pair of two features.
    fn of(fixed: &Leaf, moving: &Leaf) -> Option<Self::Two>;
    /// A lower bound of the distance of two features, if they may count within the sieve's turn; above `most` it may be any.
    fn clearance(turned: &Turned<'_>, two: &Self::Two, sieve: &Sieve, most: f64) -> Option<f64>;
}

/// The pairs about one pose.
#[derive(Debug, Clone)]
struct List<T> {
    rotation: DMat3,
    position: DVec3,
    counts: Counts,
    /// Up to which turn it holds.
    skin: f64,
    reach: f64,
    /// By their clearances.
    pairs: Vec<(f64, T)>,
}

impl<T> List<T> {
    /// By how much at most the clearance of a pair is above its distance at another pose, where the list holds what is within `reach` there.
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

/// Lists within lists.
#[derive(Debug, Clone)]
pub(in crate::contact) struct Lists<P: Pairs> {
    /// Of each reach, the one that was asked last at the end.
    levels: Vec<Vec<List<P::Two>>>,
    /// The widest that is not too long.
    widest: usize,
    /// How many lists of each level were made from the trees since a wider one was, and how many that one has served.
    made: Vec<usize>,
    served: Vec<usize>,
}

impl<P: Pairs> Default for Lists<P> {
    fn default() -> Self {
        let none = || vec![0; P::REACHES.len()];
        Self {
            levels: P::REACHES.iter().map(|_| Vec::new()).collect(),
            widest: 0,
            made: none(),
            served: none(),
        }
    }
}

impl<P: Pairs> Lists<P> {
    /// Shows every pair within `reach` of each other, and some beyond; says whether it could, else nothing was shown.
    fn within(&mut self, turned: &Turned<'_>, reach: f64, mut see: impl FnMut(&P::Two) -> bool) -> bool {
        let fits = |level: &usize| reach <= 0.5 * P::REACHES[*level];
        let Some(level) = (self.widest..P::REACHES.len()).rev().find(fits) else { return false };
        let Some(moved) = self.prepare(turned, level, reach, 0.0) else { return false };
        let Some(list) = self.levels[level].last() else { return false };
        for (_, two) in list.pairs.iter().take_while(|(clearance, _)| *clearance <= moved + reach) {
            if see(two) {
                break;
            }
        }
        true
    }

    /// Which list of a level holds what is within `reach` of each other for turns of `skin`, and by how much its clearances may be too large.
    fn find(&self, turned: &Turned<'_>, level: usize, reach: f64, skin: f64) -> Option<(usize, f64)> {
        let lists = self.levels[level].iter().enumerate().rev();
        lists.into_iter().find_map(|(k, list)| Some((k, list.moved(turned, reach, skin)?)))
    }

    /// Sees to it that the last list of a level holds what is within `reach` of each other for turns of `skin`; by how much clearances may be too large.
    fn prepare(&mut self, turned: &Turned<'_>, level: usize, reach: f64, skin: f64) -> Option<f64> {
        if let Some((k, moved)) = self.find(turned, level, reach, skin) {
            self.levels[level][k..].rotate_left(1);
            return Some(moved);
        }
        let own = P::REACHES[level];
        let counts = Counts { slack: turned.counts.slack.max(SLACKS[1]), ..turned.counts };
        let sieve = Sieve {
            slack: counts.slack,
            lowest: counts.lowest,
            skin: TURNED * own / turned.trees.radius,
            window: None,
        };
        let mut pairs = if self.levels[level].len() < KEPT {
            Vec::new()
        } else {
            let mut oldest = self.levels[level].remove(0).pairs;
            oldest.clear();
            oldest
        };
        let mut add = |two: &P::Two| {
            let clearance = P::clearance(turned, two, &sieve, own).filter(|clearance| *clearance <= own);
            pairs.extend(clearance.map(|clearance| (clearance, *two)));
            pairs.len() <= MOST
        };
        // A wider list serves for longer and takes longer: it is made once some of this level were.
        let wide = Turned { counts, ..turned.clone() };
        let has_parent = level > self.widest && {
            let found = self.find(&wide, level - 1, own, sieve.skin).is_some();
            let is_due = self.made[level] >= RENTED || self.served[level] >= RENTED;
            // Another wide list is begun.
            if !found && is_due {
                self.served[level] = 0;
            }
            found || is_due
        };
        let parent = if has_parent { self.prepare(&wide, level - 1, own, sieve.skin) } else { None };
        if let (Some(moved), Some(parent)) =
            (parent, level.checked_sub(1).and_then(|k| self.levels[k].last()))
        {
            for (_, two) in parent.pairs.iter().take_while(|(clearance, _)| *clearance <= moved + own) {
                add(two);
            }
            self.made[level] = 0;
            self.served[level] += 1;
        } else if turned.near_each_other::<P>(own, &sieve, &mut add) {
            self.made[level] += 1;
        } else {
            self.widest = level + 1;
            self.levels[level].clear();
            return None;
        }
        pairs.sort_unstable_by(|(a, _), (b, _)| a.total_cmp(b));
        let (rotation, position) = (turned.rotation, turned.position);
        let list = List { rotation, position, counts, skin: sieve.skin, reach: own, pairs };
        let moved = list.moved(turned, reach, skin);
        self.levels[level].push(list);
        moved
    }
}

/// Features that may touch.
#[derive(Debug, Clone)]
pub(in crate::contact) struct Touching;

impl Pairs for Touching {
    type Two = Number;
    const REACHES: &'static [f64] = &[0.3, 0.08, 0.02, 0.004, 0.001];
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

/// Edges of one half and facets of the other: whether it is the facet that is fixed, and which two.
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
    /// The elements with such gaps, in the order of the list of all; says whether lists could tell.
    pub(super) fn near(
        &mut self,
        turned: &Turned<'_>,
        gaps: super::Gaps,
        out: &mut Vec<(Number, super::Element)>,
    ) -> bool {
        out.clear();
        let told = self.within(turned, gaps.deep.max(gaps.front), |number| {
            let element = turned.element(number).filter(|element| gaps.hold(element.gap(turned.position)));
            out.extend(element.map(|element| (*number, element)));
            false
        });
        out.sort_unstable_by_key(|(number, _)| *number);
        told
    }
}

impl Lists<Passing> {
    /// Whether an edge of one half passes through a facet of the other; `None` where lists cannot tell.
    pub(super) fn pass(&mut self, turned: &Turned<'_>, reach: f64) -> Option<bool> {
        let frames = Frames::new(&turned.rotation, turned.position);
        let mut found = false;
        let told = self.within(turned, reach, |(is_facet, two)| {
            let (fixed, moving) = turned.shapes(two.shapes);
            found = if *is_facet {
                frames.moving_enters(moving, two.moving, fixed, two.fixed)
            } else {
                frames.fixed_enters(fixed, two.fixed, moving, two.moving)
            };
            found
        });
        told.then_some(found)
    }
}

/// A lower bound of the distance of a point from a facet; of its plane alone where that is above `most`.
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
