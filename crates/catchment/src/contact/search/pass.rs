//! Whether anything of one half passes through the other, of halves of many facets: edges through facets, near by near.

use super::{Side, Trees, Turned};
use crate::contact::Pair;
use crate::contact::bounds::Four;
use crate::contact::candidates::Counts;
use crate::contact::overlap::{Between, passes};
use crate::contact::shape::Shape;
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
        let test = |f: &Four, m: &Four| {
            let near = f.is_near(m, [0.0; 2], None, turned.rounding);
            (near.to_bitmask(), [0.0; 4], [0.0; 4])
        };
        turned.divide(fixed, moving, test, |fixed, moving, _| self.descend(fixed, moving));
    }
}

impl Trees {
    /// Whether an edge of one half passes through a facet of the other with the COR at `position`.
    pub(in crate::contact) fn is_pierced(&self, pair: &Pair, rotation: &DMat3, position: DVec3) -> bool {
        self.any(pair, rotation, position, Child::are_facets, |f, m, [fixed, moving], between| {
            fixed.pierces_at(f.index, moving, m.index, |p| between.seen(p))
                || moving.pierces_at(m.index, fixed, f.index, |p| between.placed(p))
        })
    }

    /// Whether a convex edge of one half passes through a facet of the other by more than touching.
    pub(in crate::contact) fn is_passed(&self, pair: &Pair, rotation: &DMat3, position: DVec3) -> bool {
        self.any(pair, rotation, position, Child::may_pass, |f, m, [fixed, moving], between| {
            match (f.kind, m.kind) {
                (Kind::Facet, Kind::Ridge) => {
                    let (facet, ridge) = (&fixed.facets[f.index as usize], &moving.ridges[m.index as usize]);
                    let ends = ridge.ends.map(|k| between.placed(moving.at(k)));
                    passes(ends, facet.normal, || facet.corners.iter().map(|k| fixed.at(*k)))
                }
                (Kind::Ridge, Kind::Facet) => {
                    let (ridge, facet) = (&fixed.ridges[f.index as usize], &moving.facets[m.index as usize]);
                    let corners = || facet.corners.iter().map(|k| between.placed(moving.at(*k)));
                    passes(ridge.ends.map(|k| fixed.at(k)), *rotation * facet.normal, corners)
                }
                _ => false,
            }
        })
    }

    /// Whether of any two features near each other something holds.
    fn any(
        &self,
        pair: &Pair,
        rotation: &DMat3,
        position: DVec3,
        pairs: fn(Child, Child) -> bool,
        is: impl Fn(&Leaf, &Leaf, [&Shape; 2], &Between) -> bool,
    ) -> bool {
        let all = Counts { slack: f64::INFINITY, lowest: f64::NEG_INFINITY };
        let turned = Turned { pairs, ..Turned::new(pair, self, rotation, position, all) };
        let is = |f: &Leaf, m: &Leaf| {
            let (fixed, moving) = turned.shapes([f.shape, m.shape]);
            is(f, m, [fixed, moving], &Between::new(pair, moving, rotation, position))
        };
        let mut search = Any { turned: &turned, is, found: false };
        if let Some(([fixed, moving], [f, m])) = &turned.roots() {
            let [fixed, moving] =
                [(fixed, f), (moving, m)].map(|(child, four)| Side { child: *child, four, lane: 0 });
            search.descend(&fixed, &moving);
        }
        search.found
    }
}
