//! Minkowski sums of regions.
//!
//! ```text
//!   A ⊕ B = { a + b },   d ∈ A ⊕ (−B)  ⇔  A meets B + d
//! ```
//!
//! Both regions are divided into convex polygons without new corners; the sum of two convex polygons merges
//! their sides by direction, exactly on the lattice; the union of all of them is the result (`i_triangle`,
//! the crate of `i_overlay` for this). [`super::brute`] is an independent reference without any division.

use super::region::{Node, Region, turn};
use catchment::polytope::planar_hull;
use i_triangle::i_overlay::core::fill_rule::FillRule;
use i_triangle::int::minkowski::{IntMinkowskiOperand, IntMinkowskiSolver};

/// Largest number of pairs of convex polygons of a sum: the time of their union grows faster than their
/// number.
const MOST_PAIRS: usize = 250_000;

/// Why there is no sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SumError {
    /// The outlines are too fine.
    #[error(
        "the two outlines fall into {first} and {second} convex polygons, and more than {MOST_PAIRS} pairs are too many; give the \
         outlines fewer corners, or their arcs a larger chord_error"
    )]
    TooFine {
        /// Convex polygons of the first.
        first: usize,
        /// Of the second.
        second: usize,
    },
    /// The sum would leave the lattice.
    #[error("the sum reaches farther than 1000000 from the origin")]
    TooLarge,
}

/// A region in convex polygons.
pub(super) fn convex_parts(region: &Region) -> Vec<Vec<Node>> {
    operand(region).map_or_else(Vec::new, |operand| operand.convex_polygons().to_vec())
}

fn operand(region: &Region) -> Option<IntMinkowskiOperand<i64>> {
    let outlines: Vec<Vec<Node>> = region.nodes().map(<[Node]>::to_vec).collect();
    IntMinkowskiOperand::with_source(&outlines, FillRule::NonZero)
}

/// The Minkowski sum of two regions. The sum of a region with a point is the region moved there; with an
/// empty region it is empty.
///
/// # Errors
/// If it would take too long, or reach too far.
pub fn minkowski_sum(a: &Region, b: &Region) -> Result<Region, SumError> {
    let (first, second) = (operand(a), operand(b));
    let parts = |operand: &Option<IntMinkowskiOperand<i64>>| -> Vec<Vec<Node>> {
        operand.as_ref().map_or_else(Vec::new, |operand| operand.convex_polygons().to_vec())
    };
    let (of_a, of_b) = (parts(&first), parts(&second));
    if of_a.len() * of_b.len() > MOST_PAIRS {
        return Err(SumError::TooFine { first: of_a.len(), second: of_b.len() });
    }
    let mut sum = Region::default();
    if let (Some(first), Some(second)) = (&first, &second) {
        let outlines = IntMinkowskiSolver::default().sum(first, second).map_err(|_| SumError::TooLarge)?;
        sum = Region::of_parts(outlines);
    }
    if a.thin.is_empty() && b.thin.is_empty() {
        return Ok(sum);
    }
    let mut outlines = Vec::new();
    for (thin, parts) in [(&a.thin, &of_b), (&b.thin, &of_a)] {
        for segment in thin {
            outlines.extend(parts.iter().map(|part| convex_sum(segment, part)));
        }
    }
    let mut thin = Vec::new();
    for first in &a.thin {
        for second in &b.thin {
            let hull = convex_sum(first, second);
            match hull[..] {
                [one] => thin.push([one; 2]),
                [one, other] => thin.push([one, other]),
                _ => outlines.push(hull),
            }
        }
    }
    let mut all = Region::union([&sum, &Region::of_nodes(&outlines)]);
    all.thin = thin;
    Ok(all)
}

/// Corners of the convex hull of all sums, counter-clockwise; one or two if it has no area.
pub(super) fn convex_sum(a: &[Node], b: &[Node]) -> Vec<Node> {
    let mut points: Vec<Node> =
        a.iter().flat_map(|p| b.iter().map(move |q| Node::new(p.x + q.x, p.y + q.y))).collect();
    points.sort_unstable_by_key(|p| (p.x, p.y));
    points.dedup();
    planar_hull(&points, |a, b, c| turn(a, b, c) > 0)
}
