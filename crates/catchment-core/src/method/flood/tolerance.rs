//! Default depth tolerance: between the pits caused by sampling and the true minima.
//!
//! ```text
//!   depths, log    ·   · ··  ·                   ·     ·            ·
//!                 │          └────── widest ─────┘                  ╵ the mated pose's own
//!               δ/8                       gap, τ in its middle
//! ```
//!
//! The exact heights need no tolerance: without friction every minimum is a rest. Merging removes the pits
//! that sampling causes at a crease of the landscape oblique to the grid. Their depth is at most about the
//! height difference between neighbouring cells (δ), or any fraction of it, while a true minimum does not
//! depend on the grid. So the rule is: *the widest gap between depths on a logarithmic scale, which starts no
//! higher than δ*.
//!
//! - Logarithmic, because true depths differ by factors. On a linear scale the widest gap is the last before
//!   the deepest minimum, and jams of a tenth of its depth would be merged.
//! - It starts at δ at most: sampling does not cause deeper minima.
//! - It starts at δ/8 at least: pits can be arbitrarily shallow, and the widest gap in their ratios would lie
//!   among them.
//! - It ends at the latest at the depth at which the mated basin would merge into a lower one.
//!
//! The gap contains no depth, so every tolerance in it gives the same basins; the (geometric) middle is
//! reported. *Not guaranteed:* on a coarse grid δ reaches the depth of true jams; then the gap between them
//! counts.

use super::tree::{MergeTree, ToleranceStep};
use serde::{Deserialize, Serialize};

/// The tolerance that was used, and the reason for it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Choice {
    /// Basins shallower than this were merged, in D.
    pub depth: f64,
    /// Reason for this tolerance.
    pub reason: ToleranceReason,
}

/// Reason for a tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ToleranceReason {
    /// The caller set it.
    Given,
    /// It lies in the widest gap between the depths.
    WidestGap {
        /// No depth lies between these two bounds, in D.
        between: [f64; 2],
        /// Height difference between neighbouring cells, in D: the largest mean along any axis.
        height_step: f64,
    },
}

/// Pits shallower than this share of the height step are always merged.
const NOISE: f64 = 1.0 / 8.0;

/// The tolerance in the widest gap. `staircase` is that of the mated basin, `height_step` as in
/// [`Reason::WidestGap`].
pub(super) fn choose(tree: &MergeTree, staircase: &[ToleranceStep], height_step: f64) -> Choice {
    // The first step at which the mated basin has cells, and the step at which it merges into a lower basin.
    let first = staircase.iter().position(|step| step.cells > 0).unwrap_or(0);
    let holds = staircase.get(first).map_or(0.0, |step| step.above);
    let ends = staircase.iter().skip(first).find(|step| step.cells == 0).map(|step| step.above);
    let finite = || tree.links.iter().map(|link| link.depth).filter(|depth| depth.is_finite());
    let deepest = finite().fold(height_step, f64::max);
    let top = ends.unwrap_or(deepest);
    let noise = NOISE * height_step;
    // A mated basin that is no deeper than noise: whatever keeps it.
    let floor = if noise < top { noise.max(holds) } else { holds };
    let mut from = floor;
    let mut best = [floor, top];
    let wider = |[a, b]: [f64; 2], [c, d]: [f64; 2]| b * c > d * a;
    let mut first = true;
    // The links are sorted by depth.
    for depth in finite().filter(|depth| *depth > floor && *depth < top).chain([top]) {
        let gap = [from, depth];
        if first || from <= height_step && wider(gap, best) {
            best = gap;
        }
        (from, first) = (depth, false);
    }
    let [low, high] = best;
    let depth = if low > 0.0 { (low * high).sqrt() } else { 0.5 * high };
    Choice { depth, reason: ToleranceReason::WidestGap { between: best, height_step } }
}

/// Number of cells sampled for the height step: enough for its first two digits.
const SAMPLED: usize = 1 << 16;

/// Height difference between neighbouring cells: the largest, over the axes, of the mean along an axis.
pub(super) fn height_step(shape: &[usize], heights: &[f32]) -> f64 {
    // Odd, so that it does not keep to every other cell of an even axis.
    let every = (heights.len() / SAMPLED) | 1;
    let mut stride = 1;
    let mut largest = 0.0f64;
    for cells in shape {
        let (mut sum, mut count) = (0.0, 0usize);
        for cell in (0..heights.len()).step_by(every).filter(|cell| cell / stride % cells + 1 < *cells) {
            let [a, b] = [cell, cell + stride].map(|cell| f64::from(heights[cell]));
            if a.is_finite() && b.is_finite() {
                sum += (a - b).abs();
                count += 1;
            }
        }
        if count > 0 {
            largest = largest.max(sum / count as f64);
        }
        stride *= cells;
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::flood::Link;

    fn choice(depths: &[f64], staircase: &[(f64, usize)], height_step: f64) -> Choice {
        let link = |depth: &f64| Link { basins: [0, 0], height: 0.0, depth: *depth };
        let links = depths.iter().map(link).collect();
        let tree = MergeTree { minima: Vec::new(), links, joined: Vec::new(), outside: None };
        let steps: Vec<ToleranceStep> =
            staircase.iter().map(|&(above, cells)| ToleranceStep { above, cells }).collect();
        choose(&tree, &steps, height_step)
    }

    fn gap(depths: &[f64], staircase: &[(f64, usize)], height_step: f64) -> [f64; 2] {
        match choice(depths, staircase, height_step).reason {
            ToleranceReason::WidestGap { between, .. } => between,
            ToleranceReason::Given => [f64::NAN; 2],
        }
    }

    #[test]
    fn the_gap_lies_between_pits_and_jams() {
        // Pits up to 0.01 on a grid whose heights differ by 0.02, jams of 0.11, a mated pose of 0.85.
        let depths = [0.0001, 0.002, 0.002, 0.01, 0.11, 0.11, 0.85, f64::INFINITY];
        let mated = [(0.0, 5), (0.01, 6), (0.85, 0)];
        assert_eq!(gap(&depths, &mated, 0.02), [0.01, 0.11]);
        let tolerance = choice(&depths, &mated, 0.02).depth;
        assert!((tolerance - (0.01f64 * 0.11).sqrt()).abs() < 1e-15);
        // The gap below the mated pose is wider, but the jams are more than such a grid can make.
        assert_eq!(gap(&[0.002, 0.01, 0.02, 0.9], &[(0.0, 5)], 0.015), [0.002, 0.01]);
        // On a coarser grid they are not.
        assert_eq!(gap(&[0.01, 0.02, 0.9], &[(0.0, 5)], 0.03), [0.02, 0.9]);
    }

    #[test]
    fn without_pits_it_lies_below_the_shallowest_jam() {
        assert_eq!(gap(&[0.3, 0.4], &[(0.0, 5), (0.4, 0)], 0.16), [0.02, 0.3]);
        assert_eq!(gap(&[], &[(0.0, 5)], 0.16), [0.02, 0.16]);
        assert_eq!(gap(&[0.2], &[(0.0, 5), (0.2, 0)], 0.16), [0.02, 0.2]);
    }

    #[test]
    fn the_mated_pose_is_never_merged_away_if_that_can_be_helped() {
        // It is shallower than the noise of this grid.
        let shallow = choice(&[0.005, 0.5], &[(0.0, 5), (0.005, 0)], 0.16);
        assert!(shallow.depth < 0.005 && shallow.depth > 0.0);
        // The mated basin has cells only from 0.1 on, after it has merged with the neighbouring pit.
        let pit = choice(&[0.05, 0.5], &[(0.0, 0), (0.1, 5), (0.5, 0)], 0.16);
        assert!(pit.depth > 0.1 && pit.depth < 0.5);
    }

    #[test]
    fn a_flat_landscape_has_a_tolerance_too() {
        let depth = choice(&[], &[(0.0, 5)], 0.0).depth;
        assert_eq!(depth, 0.0);
    }

    #[test]
    fn the_height_step_is_the_largest_mean_along_an_axis() {
        let none = f32::NEG_INFINITY;
        // 1 along the first axis, 3 along the second; pairs without contact do not count.
        assert_eq!(height_step(&[3, 2], &[0.0, 1.0, 2.0, 3.0, 4.0, none]), 3.0);
        assert_eq!(height_step(&[2], &[none, none]), 0.0);
    }
}
