//! Nearby features of halves with many facets.
//!
//! ```text
//!        ╲ moving        gap > 0: in front; parts on opposite sides of a plane
//!      ───╳────── fixed                     are apart by at least their distances from it
//!          ╲             gap < 0: overlaps, at most `deep`
//! ```

use super::lists::{Lists, Pairs, Touching};
use super::{DIVIDED, Number, Side, Trees, Turned, meeting, overhang};
use crate::contact::Pair;
use crate::contact::bounds::BoundsOfFour;
use crate::contact::candidates::{Counts, Sieve};
use crate::contact::element::Element;
use crate::contact::tree::SLACKS;
use glam::{DMat3, DVec3};
use std::marker::PhantomData;

/// Which gaps count: down to −`deep`, up to `front`, which is no more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::contact) struct Gaps {
    pub(in crate::contact) deep: f64,
    pub(in crate::contact) front: f64,
}

impl Gaps {
    /// Up to as much either way.
    pub(in crate::contact) const fn within(reach: f64) -> Self {
        Self { deep: reach, front: reach }
    }

    /// More by as much either way.
    pub(in crate::contact) const fn widened(self, by: f64) -> Self {
        Self { deep: self.deep + by, front: self.front + by }
    }

    pub(in crate::contact) fn hold(self, gap: f64) -> bool {
        gap >= -self.deep && gap <= self.front
    }
}

/// The search for nearby features.
struct Close<'a> {
    turned: &'a Turned<'a>,
    position: DVec3,
    gaps: Gaps,
    out: &'a mut Vec<(Number, Element)>,
}

impl Close<'_> {
    /// Tries two parts.
    fn descend(&mut self, fixed: &Side<'_>, moving: &Side<'_>) {
        let Self { turned, position, gaps, out } = self;
        if fixed.child.is_leaf && moving.child.is_leaf {
            let (fixed, moving) =
                (turned.trees.fixed.leaf(fixed.child), turned.trees.moving.leaf(moving.child));
            let Some(number) = meeting(fixed, moving) else { return };
            let element = turned.element(&number);
            let near = element.filter(|element| gaps.hold(element.gap(*position)));
            out.extend(near.map(|element| (number, element)));
            return;
        }
        let turned = *turned;
        let reach = [gaps.front as f32, gaps.deep as f32];
        let test = |f: &BoundsOfFour, m: &BoundsOfFour| {
            let near = f.is_near(m, reach, turned.cones, (&turned.placed, turned.rounding));
            (near.to_bitmask(), [0.0; 4], [0.0; 4])
        };
        turned.divide(fixed, moving, test, |fixed, moving, _| self.descend(fixed, moving));
    }
}

/// The search for pairs that are near each other.
struct Around<'a, P, F> {
    turned: &'a Turned<'a>,
    reach: f32,
    pairs: PhantomData<P>,
    see: F,
    goes_on: bool,
    /// Number of pairs of parts tested.
    looked: u64,
}

impl<P: Pairs, F: FnMut(&P::Two) -> bool> Around<'_, P, F> {
    fn descend(&mut self, fixed: &Side<'_>, moving: &Side<'_>) {
        let turned = self.turned;
        if !self.goes_on {
            return;
        }
        self.looked += 1;
        if fixed.child.is_leaf && moving.child.is_leaf {
            let [fixed, moving] =
                [turned.trees.fixed.leaf(fixed.child), turned.trees.moving.leaf(moving.child)];
            self.goes_on = P::of(fixed, moving).is_none_or(|two| (self.see)(&two));
            return;
        }
        let reach = [self.reach; 2];
        let test = |f: &BoundsOfFour, m: &BoundsOfFour| {
            (f.is_near(m, reach, None, (&turned.placed, turned.rounding)).to_bitmask(), [0.0; 4], [0.0; 4])
        };
        turned.divide(fixed, moving, test, |fixed, moving, _| self.descend(fixed, moving));
    }
}

impl Turned<'_> {
    /// Passes every pair of features within `reach` of each other that may count within the sieve's rotation,
    /// and some beyond, to `see`, until it returns false. Returns the number of pairs of parts tested, if the
    /// search was complete.
    pub(super) fn near_each_other<P: Pairs>(
        &self,
        reach: f64,
        sieve: &Sieve,
        see: impl FnMut(&P::Two) -> bool,
    ) -> Option<u64> {
        let cones = SLACKS.iter().position(|slack| sieve.slack + sieve.skin <= *slack);
        let turned = Turned {
            pairs: P::meet,
            cones: cones.filter(|_| P::FACE),
            overhang: overhang(sieve.lowest - sieve.skin),
            ..self.clone()
        };
        let (reach, pairs) = (reach as f32, PhantomData::<P>);
        let mut search = Around { turned: &turned, reach, pairs, see, goes_on: true, looked: 0 };
        if let Some(([fixed, moving], [f, m])) = &turned.roots() {
            let [fixed, moving] =
                [(fixed, f), (moving, m)].map(|(child, four)| Side { child: *child, four, lane: 0 });
            search.descend(&fixed, &moving);
        }
        search.goes_on.then_some(search.looked)
    }
}

impl Trees {
    /// The elements with such gaps with the COR at `position`, in the order of the list of all.
    pub(in crate::contact) fn near(
        &self,
        pair: &Pair,
        (rotation, position): (&DMat3, DVec3),
        counts: Counts,
        gaps: Gaps,
        lists: &mut Lists<Touching>,
        out: &mut Vec<(Number, Element)>,
    ) {
        let turned = Turned::new(pair, self, rotation, position, counts);
        if lists.near(&turned, gaps, out) {
            return;
        }
        out.clear();
        if let Some(([fixed, moving], [f, m])) = &turned.roots() {
            let [fixed, moving] =
                [(fixed, f), (moving, m)].map(|(child, four)| Side { child: *child, four, lane: 0 });
            Close { turned: &turned, position, gaps, out }.descend(&fixed, &moving);
        }
        lists.took += DIVIDED * turned.divided.get();
        out.sort_unstable_by_key(|(number, _)| *number);
    }
}
