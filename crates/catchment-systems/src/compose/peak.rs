//! The largest overlap of two regions, between two bounds.
//!
//! Branch and bound over positions of the second region: the overlap at the centre of a square cell bounds
//! the overlap in all of it ([`super::overlap`]), and so do the areas of the two regions. The cell with the
//! highest bound is divided until that bound is at most [`SLACK`] above the largest value, or the work budget
//! is spent. In both cases the returned bound holds for every position.
//!
//! For regions known between an inner and an outer polygon the bound is that of the outer pair, and the value
//! that of the inner pair at the position found, so the true maximum lies between the two. If a region has no
//! area both are 0.
//!
//! Not promised: that the position is unique. If one region fits into the other with room to spare, every
//! such position has the same overlap, and the first one found is returned.

use super::cell::Cell;
use super::overlap::RegionOverlap;
use super::sweep::Bracket;
use catchment::exec::{Cancelled, Exec};
use glam::DVec2;
use std::collections::BinaryHeap;

/// The search ends if the bound exceeds the largest value by at most this share of it.
const SLACK: f64 = 1e-4;
/// Largest number of positions examined.
const MOST_PLACES: usize = 20_000;
/// Largest number of pairs of convex polygons examined, over all positions.
const MOST_PAIRS: usize = 40_000_000;

/// The largest overlap, in mm² or D².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Place of the second region.
    pub at: DVec2,
    /// Overlap of the inner regions there: the largest overlap is at least this.
    pub value: f64,
    /// No place has a larger overlap.
    pub at_most: f64,
}

/// The largest area of A ∩ (B + d) over all d; `None` if the regions never overlap.
///
/// # Errors
/// The computation was cancelled.
pub fn peak(a: &Bracket, b: &Bracket, exec: &Exec) -> Result<Option<Peak>, Cancelled> {
    let (Some([la, ha]), Some([lb, hb])) = (a.outer.bounds(), b.outer.bounds()) else { return Ok(None) };
    let overlap = RegionOverlap::new(&a.outer, &b.outer);
    let most = a.outer.area().min(b.outer.area());
    // Beyond these places the rectangles around the two do not meet.
    let (low, high) = (la - hb, ha - lb);
    let mut best = Peak { at: 0.5 * (low + high), value: 0.0, at_most: most };
    let mut open = BinaryHeap::new();
    let mut looked = 0;
    let limit = (MOST_PAIRS / overlap.pairs().max(1)).clamp(1, MOST_PLACES);
    let mut look = |best: &mut Peak, open: &mut BinaryHeap<Cell>, center: DVec2, half: f64| {
        let result = overlap.around(center, half);
        if result.value > best.value {
            (best.at, best.value) = (center, result.value);
        }
        looked += 1;
        open.push(Cell { center, half, bound: most.min(result.at_most), number: looked });
        looked
    };
    let middle = best.at;
    look(&mut best, &mut open, middle, 0.5 * (high - low).max_element());
    while let Some(cell) = open.pop() {
        exec.check()?;
        best.at_most = cell.bound.max(best.value);
        if cell.bound <= best.value * (1.0 + SLACK) {
            break;
        }
        let half = 0.5 * cell.half;
        let mut done = 0;
        for (x, y) in [(-half, -half), (half, -half), (-half, half), (half, half)] {
            done = look(&mut best, &mut open, cell.center + DVec2::new(x, y), half);
        }
        if done >= limit {
            let rest = open.peek().map_or(0.0, |cell| cell.bound);
            best.at_most = rest.max(best.value);
            break;
        }
    }
    best.value = RegionOverlap::new(&a.inner, &b.inner).at(best.at);
    Ok(Some(best))
}

#[cfg(test)]
mod tests {
    use super::super::region::Region;
    use super::super::sweep::SweptShape;
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn of(a: &SweptShape, b: &SweptShape) -> Peak {
        let [a, b] = [a, b].map(|shape| shape.bracket(DVec2::ZERO, 0.01));
        peak(&a, &b, &Exec::new()).unwrap().unwrap()
    }

    /// Discs of equal size overlap wholly at a single position only, which is not on any grid of positions.
    #[test]
    fn two_discs_overlap_by_the_area_of_the_smaller() {
        for (first, second) in [(30.0, 30.0), (50.0, 30.0), (10.0, 70.0)] {
            let result = of(&SweptShape::Disc { radius: first }, &SweptShape::Disc { radius: second });
            let smaller: f64 = f64::min(first, second);
            let exact = PI * smaller * smaller;
            assert!(result.value <= exact && exact <= result.at_most, "{result:?} {exact}");
            // Chords and tangents, both 0.01 mm from a circle of 2πr, and the slack of the search.
            assert!(
                result.at_most - result.value < exact * SLACK + 0.04 * PI * smaller,
                "{result:?} {exact}"
            );
            assert!(result.at.length() < (first - second).abs() + 0.1, "{result:?}");
        }
    }

    /// Bars across and along each other, which overlap equally at many positions, and an L with a square, at
    /// one.
    #[test]
    fn bars_and_corners_overlap_as_drawn() {
        let bar = |width, height| SweptShape::Box { width, height };
        let crossed = of(&bar(10.0, 2.0), &bar(1.0, 30.0));
        assert!(crossed.value == 2.0 && (crossed.at_most - 2.0).abs() < 1e-3, "{crossed:?}");
        let along = of(&bar(10.0, 2.0), &bar(20.3, 2.0));
        assert!(
            along.value <= 20.0 && 20.0 <= along.at_most && along.at_most - along.value < 0.01,
            "{along:?}"
        );
        let corner = [(0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (2.0, 2.0), (2.0, 6.0), (0.0, 6.0)];
        let corner = SweptShape::Polygon(corner.map(|(x, y)| DVec2::new(x, y)).to_vec());
        // A square of 3 in the corner covers all of it but a square of 1.
        let result = of(&corner, &bar(3.0, 3.0));
        assert!(
            result.value <= 8.0 && 8.0 <= result.at_most && result.at_most - result.value < 0.01,
            "{result:?}"
        );
        assert!(result.at.distance(DVec2::splat(1.5)) < 0.01, "{result:?}");
    }

    #[test]
    fn a_region_without_area_has_no_overlap() {
        let line = Bracket::exact(Region::segment(DVec2::ZERO, DVec2::X));
        let disc = SweptShape::Disc { radius: 3.0 }.bracket(DVec2::ZERO, 0.01);
        let result = peak(&line, &disc, &Exec::new()).unwrap().unwrap();
        assert_eq!((result.value, result.at_most), (0.0, 0.0));
        let nothing = Bracket::exact(Region::default());
        assert_eq!(peak(&nothing, &disc, &Exec::new()), Ok(None));
        let stopped = Exec::new();
        stopped.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
        assert!(peak(&disc, &disc, &stopped).is_err());
    }

    /// Slivers spend the work budget before the bounds meet, which still hold.
    #[test]
    fn bounds_of_slivers_hold() {
        let a = [(0.0, 0.0), (3.4107, 4.1967), (0.0, -1.0743)];
        let b = [(-2.2069, -2.3577), (0.434, -2.9091), (3.0947, -3.5099)];
        let [a, b] =
            [a, b].map(|outline| Region::of_outlines(&[outline.map(|(x, y)| DVec2::new(x, y)).to_vec()]));
        let result =
            peak(&Bracket::exact(a.clone()), &Bracket::exact(b.clone()), &Exec::new()).unwrap().unwrap();
        assert!(0.0 < result.value && result.value <= result.at_most, "{result:?}");
        assert!(result.at_most <= a.area().min(b.area()), "{result:?}");
        let open = (result.at_most - result.value) / result.at_most;
        assert!((1e-3..0.25).contains(&open), "{result:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// No place that chance finds has a larger overlap than the bound.
        #[test]
        fn no_place_is_above_the_bound(
            a in proptest::collection::vec((-5.0f64..5.0, -5.0f64..5.0), 3..7),
            b in proptest::collection::vec((-5.0f64..5.0, -5.0f64..5.0), 3..7),
            places in proptest::collection::vec((-10.0f64..10.0, -10.0f64..10.0), 40),
        ) {
            let region = |corners: &[(f64, f64)]| {
                Region::of_outlines(&[corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()])
            };
            let (a, b) = (region(&a), region(&b));
            let result = peak(&Bracket::exact(a.clone()), &Bracket::exact(b.clone()), &Exec::new()).unwrap();
            if let Some(result) = result {
                let overlap = RegionOverlap::new(&a, &b);
                for pair in places.windows(2) {
                    let [d, other] = [pair[0], pair[1]].map(|(x, y)| DVec2::new(x, y));
                    let value = overlap.at(d);
                    prop_assert!(value <= result.at_most * (1.0 + 1e-12) + 1e-12);
                    // The bound around any other place holds, too.
                    let around = overlap.around(other, (d - other).abs().max_element());
                    prop_assert!(value <= around.at_most + 1e-9, "{value} {around:?}");
                }
                prop_assert!(result.value <= result.at_most + 1e-12);
                // Chance draws slivers, too, which spend the budget: bounds within 0.2 % of the square around all outlines.
                let open = result.at_most - result.value;
                prop_assert!(open <= (result.value * SLACK).max(0.002 * 10.0 * 10.0) + 1e-9, "{result:?}");
            }
        }
    }
}
