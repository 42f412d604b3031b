//! Detects halves that are mated side by side: they share a vertical plane and no area in plan view.
//!
//! ```text
//!   plan view    ┌─────────┬─────────┐       first contact without pose error is along the plane between them: pushed together
//!                │  fixed  │  moving │       no contact carries, and at the least offset apart they pass each other by
//!                └─────────┴─────────┘
//! ```
//!
//! The test uses the halves themselves, not the contacts: whether points of one plane touch is a matter of
//! rounding. The planes tested are the vertical facets of the fixed half, and those across x and y. Not
//! promised: halves that interlock without a common area are not separated by a single plane, and are missed.

use super::Pair;
use crate::pose::CorPose;
use crate::tolerance;
use glam::{DMat3, DVec2, DVec3};
use std::collections::BTreeSet;

/// Halves that reach over the plane by no more than this lie beside each other, in D.
const OVER: f64 = tolerance::SINGLE;
/// Facets steeper than this (z of their normal) are vertical.
const VERTICAL: f64 = tolerance::SINGLE;
/// Directions closer than this are equal.
const ONE_WAY: f64 = tolerance::SINGLE;

/// How halves lie beside each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideBySide {
    /// Unit normal of their common plane, in plan view, from the fixed half to the moving half.
    pub across: DVec2,
    /// Distance that the moving half must move against it until the middles of both coincide, in D.
    pub apart: f64,
}

/// The arrangement of two halves side by side in the aligned pose; `None` if they are not side by side.
pub(super) fn of(pair: &Pair) -> Option<SideBySide> {
    let passes = |lateral: DVec2| pair.height(&CorPose { lateral, rotation: DMat3::IDENTITY }).is_none();
    let off = 2.0 * OVER;
    let may_pass = pair.mated_height() == f64::NEG_INFINITY
        || [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].into_iter().any(|way| passes(off * way));
    if !may_pass {
        return None;
    }
    let whole = |x: f64| (x / ONE_WAY).round() as i64;
    let mut known = BTreeSet::new();
    let axes = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y];
    let walls = pair
        .fixed
        .surfaces
        .iter()
        .flat_map(|surface| &surface.facets)
        .filter(|facet| facet.normal.z.abs() <= VERTICAL)
        .map(|facet| facet.normal.truncate().normalize_or_zero());
    axes.into_iter().chain(walls).filter(|way| known.insert([whole(way.x), whole(way.y)])).find_map(|way| {
        let reach = |points: &mut dyn Iterator<Item = DVec3>| {
            points.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
                let at = point.truncate().dot(way);
                [low.min(at), high.max(at)]
            })
        };
        let [fixed, moving] = [&pair.fixed, &pair.moving].map(|half| {
            reach(&mut half.surfaces.iter().flat_map(|surface| surface.vertices.iter().copied()))
        });
        let middle = |[low, high]: [f64; 2]| f64::midpoint(low, high);
        ((moving[0] - fixed[1]).abs() <= OVER)
            .then(|| SideBySide { across: way, apart: middle(moving) - middle(fixed) })
    })
}
