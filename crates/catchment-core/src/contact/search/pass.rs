//! Overlap of halves with many facets: edges and facets near each other, by branch and bound.

use super::lists::{Lists, Passing};
use super::{DIVIDED, Side, Trees, Turned};
use crate::contact::Pair;
use crate::contact::bounds::BoundsOfFour;
use crate::contact::candidates::Counts;
use crate::contact::overlap::{Frames, MARGIN};
use crate::contact::tree::{Child, Kind, Leaf};
use glam::{DMat3, DVec3};

/// The search for two features of which something holds.
struct Any<'a, F> {
    turned: &'a Turned<'a>,
    is: F,
    found: bool,
}

impl<F: Fn(&Leaf, &Leaf) -> bool> Any<'_, F> {
    /// Tries two parts.
    fn descend(&mut self, fixed: &Side<'_>, moving: &Side<'_>) {
        if self.found {
            return;
        }
        let turned = self.turned;
        if fixed.child.is_leaf && moving.child.is_leaf {
            self.found =
                (self.is)(turned.trees.fixed.leaf(fixed.child), turned.trees.moving.leaf(moving.child));
            return;
        }
        let test = |f: &BoundsOfFour, m: &BoundsOfFour| {
            let near = f.is_near(m, [MARGIN as f32; 2], None, (&turned.placed, turned.rounding));
            (near.to_bitmask(), [0.0; 4], [0.0; 4])
        };
        turned.divide(fixed, moving, test, |fixed, moving, _| self.descend(fixed, moving));
    }
}

impl Trees {
    /// Whether the halves overlap with the COR at `position`.
    pub(in crate::contact) fn overlap(
        &self,
        pair: &Pair,
        rotation: &DMat3,
        position: DVec3,
        lists: Option<&mut Lists<Passing>>,
    ) -> bool {
        let all = Counts { slack: f64::INFINITY, lowest: f64::NEG_INFINITY };
        let turned = Turned { pairs: Child::may_pass, ..Turned::new(pair, self, rotation, position, all) };
        let Some(lists) = lists else { return turned.passes() };
        lists.pass(&turned, 2.0 * MARGIN).unwrap_or_else(|| {
            let found = turned.passes();
            lists.took += DIVIDED * turned.divided.get();
            found
        })
    }
}

impl Turned<'_> {
    /// Whether an edge of one half passes through a facet of the other.
    fn passes(&self) -> bool {
        let frames = Frames::new(&self.rotation, self.position);
        let is = |f: &Leaf, m: &Leaf| {
            let (fixed, moving) = self.shapes([f.shape, m.shape]);
            match (f.kind, m.kind) {
                (Kind::Facet, Kind::Ridge) => frames.moving_enters(moving, m.index, fixed, f.index),
                (Kind::Ridge, Kind::Facet) => frames.fixed_enters(fixed, f.index, moving, m.index),
                _ => false,
            }
        };
        let mut search = Any { turned: self, is, found: false };
        if let Some(([fixed, moving], [f, m])) = &self.roots() {
            let [fixed, moving] =
                [(fixed, f), (moving, m)].map(|(child, four)| Side { child: *child, four, lane: 0 });
            search.descend(&fixed, &moving);
        }
        search.found
    }
}
