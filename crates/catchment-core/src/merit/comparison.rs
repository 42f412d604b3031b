//! Comparison of two acceptances of the same errors: their overlap, their confusion matrix, and the distance
//! of the differences from the border of the first.
//!
//! ```text
//!        first ┌───────┐              Jaccard     = ■ / (▒ + ■ + ░)      1 if both are empty
//!              │▒▒┌────┼──┐ second    agreement   = share of the poses that both accept or both reject
//!              │▒▒│■■■■│░░│           sum ratio   = (■ + ░) / (▒ + ■)
//!              └──┼────┘░░│           confusion   = number of poses with outcome i in the first and j in the second
//!                 └───────┘
//! ```
//!
//! Distance: from the centre of a cell with different labels to the centre of the nearest cell that the
//! *first* labels the opposite way. A distance of 1 cell touches the border. In units of the error box each
//! axis is divided by its range, as for ONAA.
//!
//! The grids are equal, or one grid is finer by odd factors along its axes: then every centre of the coarse
//! grid is also a centre of the fine grid, and the two are compared exactly there. Nothing is interpolated;
//! other grids are rejected.
//!
//! Not promised: a statement which of the two is correct.

use super::distance::squared_distances;
use super::onaa::Onaa;
use super::sum::Sum;
use super::{MeritError, grid_of};
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::design::Alignment;
use crate::exec::Exec;
use crate::landscape::{Grid, GridAxis};
use crate::pose::Dof;
use serde::Serialize;
use std::borrow::Cow;

/// Two acceptances over the same poses.
#[derive(Debug, Clone)]
pub struct Paired<'a> {
    /// The first, whose border distances are measured to.
    pub first: Cow<'a, Acceptance>,
    /// The second.
    pub second: Cow<'a, Acceptance>,
}

/// Comparison of two acceptances.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Comparison {
    /// Number of poses compared.
    pub poses: usize,
    /// `confusion[i][j]`: number of poses with outcome i in the first and j in the second, in the order of
    /// [`Outcome::ALL`].
    pub confusion: [[usize; 4]; 4],
    /// Jaccard index: poses accepted by both, divided by poses accepted by either; 1 if neither accepts a
    /// pose.
    pub jaccard: f64,
    /// Share of the poses that both accept or both reject.
    pub agreement: f64,
    /// Number of poses that only the first accepts.
    pub only_first: usize,
    /// Number of poses that only the second accepts.
    pub only_second: usize,
    /// Measure of each accepted set over these poses, Dᵃ·radᵇ.
    pub sums: [f64; 2],
    /// The unit of the measures, like `D²·rad³`.
    pub unit: String,
    /// Sum of the second divided by that of the first; null if the first accepts no pose.
    pub sum_ratio: Option<f64>,
    /// ONAA edges; null for listed poses.
    pub onaa_edges: Option<[f64; 2]>,
    /// ONAA of the second divided by that of the first; null if the first accepts no pose, and for listed
    /// poses.
    pub onaa_ratio: Option<f64>,
    /// Distances of the differing cells from the border of the first set; null if no cell differs, if there
    /// is no border, and for listed poses.
    pub distances: Option<Distances>,
}

/// Distances of the differing cells from the border of the first set.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Distances {
    /// In cells.
    pub cells: Quantiles,
    /// In units of the error box: each axis divided by its range.
    pub error_box: Quantiles,
}

/// Quantiles of a list of distances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Quantiles {
    /// Half of the distances are at most this.
    pub median: f64,
    /// 95 % of the distances are at most this.
    pub p95: f64,
    /// The largest distance.
    pub max: f64,
}

/// Why two acceptances cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ComparisonError {
    /// One acceptance is over a grid, the other over listed poses.
    #[error("one result is over a grid, the other over listed poses; decide both for the same poses")]
    Kinds,
    /// The poses differ.
    #[error(
        "the lists of poses differ{}; decide both for the same list",
        first_difference.map_or_else(|| " in length".to_owned(), |k| format!(" from pose {} on", k + 1))
    )]
    Poses {
        /// The first pose that differs; `None` if one list is the beginning of the other.
        first_difference: Option<usize>,
    },
    /// The grids have different axes.
    #[error(
        "the errors tried differ: the first over {first}, the second over {second}; free the same errors in both"
    )]
    Axes {
        /// Names of the axes of the first.
        first: String,
        /// Names of the axes of the second.
        second: String,
    },
    /// The error boxes differ.
    #[error(
        "the error boxes differ along {}: [{}, {}] and [{}, {}]{}; give both the same [errors]",
        axis.name(), first[0], first[1], second[0], second[1], unit(*axis)
    )]
    Range {
        /// Along which axis.
        axis: Dof,
        /// Borders of the first, D or radians.
        first: [f64; 2],
        /// Borders of the second.
        second: [f64; 2],
    },
    /// The centres of the coarse cells are not centres of the fine cells.
    #[error(
        "the grids differ along {}: {first} and {second} cells do not share their centres; compute both with {first} cells along {}, or \
         one with an odd multiple of the other",
        axis.name(), axis.name()
    )]
    Cells {
        /// Along which axis.
        axis: Dof,
        /// Number of cells of the first.
        first: usize,
        /// Number of cells of the second.
        second: usize,
    },
    /// A figure of merit is not available.
    #[error(transparent)]
    Merit(#[from] MeritError),
}

const fn unit(dof: Dof) -> &'static str {
    if dof.is_rotation() { " rad" } else { " D" }
}

/// Borders that differ by less than this share of the range are the same: a box given in degrees has been rounded.
const SAME_BORDER: f64 = 1e-9;

impl<'a> Paired<'a> {
    /// Restricts two acceptances to their common poses.
    ///
    /// # Errors
    /// If they share no pose, or only some: see [`ComparisonError`].
    pub fn of(first: &'a Acceptance, second: &'a Acceptance) -> Result<Self, ComparisonError> {
        match (&first.domain, &second.domain) {
            (Domain::Grid(a), Domain::Grid(b)) => {
                let common = common_grid(a, b)?;
                Ok(Self { first: on(first, a, &common), second: on(second, b, &common) })
            }
            (Domain::Poses(a), Domain::Poses(b)) => {
                if a == b {
                    return Ok(Self { first: Cow::Borrowed(first), second: Cow::Borrowed(second) });
                }
                let first_difference = a.iter().zip(b).position(|(a, b)| a != b);
                Err(ComparisonError::Poses { first_difference })
            }
            _ => Err(ComparisonError::Kinds),
        }
    }
}

/// The grid of the cells that two grids have in common.
fn common_grid(a: &Grid, b: &Grid) -> Result<Grid, ComparisonError> {
    let names = |grid: &Grid| grid.axes.iter().map(|axis| axis.dof.name()).collect::<Vec<_>>().join(", ");
    if !a.axes.iter().map(|axis| axis.dof).eq(b.axes.iter().map(|axis| axis.dof)) {
        return Err(ComparisonError::Axes { first: names(a), second: names(b) });
    }
    let axis = |(a, b): (&GridAxis, &GridAxis)| {
        let near = |x: f64, y: f64| (x - y).abs() <= SAME_BORDER * (a.hi - a.lo).abs();
        if !near(a.lo, b.lo) || !near(a.hi, b.hi) {
            let [first, second] = [[a.lo, a.hi], [b.lo, b.hi]];
            return Err(ComparisonError::Range { axis: a.dof, first, second });
        }
        let (fine, coarse) = (a.cells.max(b.cells), a.cells.min(b.cells));
        if coarse > 0 && fine.is_multiple_of(coarse) && (fine / coarse) % 2 == 1 {
            Ok(GridAxis { cells: coarse, ..*a })
        } else {
            Err(ComparisonError::Cells { axis: a.dof, first: a.cells, second: b.cells })
        }
    };
    Ok(Grid { axes: a.axes.iter().zip(&b.axes).map(axis).collect::<Result<_, _>>()? })
}

/// An acceptance over `grid` at the centres of a coarser grid.
fn on<'a>(acceptance: &'a Acceptance, grid: &Grid, coarse: &Grid) -> Cow<'a, Acceptance> {
    if grid.shape() == coarse.shape() {
        return Cow::Borrowed(acceptance);
    }
    let finer = |cell: Vec<usize>| -> Vec<usize> {
        let factors = grid.axes.iter().zip(&coarse.axes).map(|(fine, coarse)| fine.cells / coarse.cells);
        cell.into_iter().zip(factors).map(|(k, factor)| k * factor + factor / 2).collect()
    };
    let outcomes =
        (0..coarse.len()).map(|k| acceptance.outcomes[grid.index(&finer(coarse.cell(k)))]).collect();
    Cow::Owned(Acceptance { domain: Domain::Grid(coarse.clone()), outcomes, ..acceptance.clone() })
}

impl Comparison {
    /// Compares two acceptances over the same poses.
    ///
    /// # Errors
    /// If the figures do not fit into memory, or it is cancelled.
    pub fn of(paired: &Paired, alignment: &Alignment, exec: &Exec) -> Result<Self, ComparisonError> {
        let (first, second) = (&*paired.first, &*paired.second);
        let confusion = confusion(first, second, exec)?;
        let sums = [first, second].map(|of| Sum::of(of, alignment));
        let mut onaa_edges = None;
        if first.grid().is_some() {
            onaa_edges = Some([Onaa::of(first, exec)?.edge, Onaa::of(second, exec)?.edge]);
        }
        let overlap = AcceptanceOverlap::of(&confusion);
        Ok(Self {
            poses: first.outcomes.len(),
            jaccard: overlap.jaccard(),
            agreement: overlap.agreement(),
            only_first: overlap.only_first,
            only_second: overlap.only_second,
            confusion,
            unit: sums[0].unit(),
            sum_ratio: ratio(sums.each_ref().map(|s| s.sum)),
            sums: sums.map(|s| s.sum),
            onaa_ratio: onaa_edges.and_then(ratio),
            onaa_edges,
            distances: if first.grid().is_some() { distances(first, second, exec)? } else { None },
        })
    }
}

/// The second divided by the first, if the first is not zero.
fn ratio([first, second]: [f64; 2]) -> Option<f64> {
    (first != 0.0).then(|| second / first)
}

/// How many poses have outcome i by the first and j by the second.
///
/// # Errors
/// When it is cancelled.
pub fn confusion(
    first: &Acceptance,
    second: &Acceptance,
    exec: &Exec,
) -> Result<[[usize; 4]; 4], MeritError> {
    /// Poses between two checks of the cancel flag: about a millisecond.
    const PIECE: usize = 1 << 20;
    let mut counts = [[0; 4]; 4];
    for (first, second) in first.outcomes.chunks(PIECE).zip(second.outcomes.chunks(PIECE)) {
        exec.check()?;
        for (a, b) in first.iter().zip(second) {
            counts[*a as usize - 1][*b as usize - 1] += 1;
        }
    }
    Ok(counts)
}

/// Who accepts how many poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AcceptanceOverlap {
    /// Both.
    pub both: usize,
    /// The first alone.
    pub only_first: usize,
    /// The second alone.
    pub only_second: usize,
    /// Poses that neither accepts.
    pub neither: usize,
}

impl AcceptanceOverlap {
    /// From the table of confusions.
    pub fn of(confusion: &[[usize; 4]; 4]) -> Self {
        let accepted = Outcome::Aligned as usize - 1;
        let both = confusion[accepted][accepted];
        let first: usize = confusion[accepted].iter().sum();
        let second: usize = confusion.iter().map(|row| row[accepted]).sum();
        let all: usize = confusion.iter().flatten().sum();
        Self {
            both,
            only_first: first - both,
            only_second: second - both,
            neither: all + both - first - second,
        }
    }

    /// Jaccard index: poses accepted by both, divided by poses accepted by either; 1 if neither accepts a
    /// pose.
    pub fn jaccard(&self) -> f64 {
        let any = self.both + self.only_first + self.only_second;
        if any == 0 { 1.0 } else { self.both as f64 / any as f64 }
    }

    /// Share of the poses that both accept or both reject; 1 without poses.
    pub fn agreement(&self) -> f64 {
        let same = self.both + self.neither;
        let all = same + self.only_first + self.only_second;
        if all == 0 { 1.0 } else { same as f64 / all as f64 }
    }
}

/// Distances of the differing cells from the border of the first set.
fn distances(first: &Acceptance, second: &Acceptance, exec: &Exec) -> Result<Option<Distances>, MeritError> {
    let grid = grid_of(first)?;
    let accepted = |of: &Acceptance, cell: usize| of.outcomes[cell] == Outcome::Aligned;
    let differing: Vec<usize> =
        (0..first.outcomes.len()).filter(|cell| accepted(first, *cell) != accepted(second, *cell)).collect();
    let accepts = first.accepted().filter(|accepted| *accepted).count();
    if differing.is_empty() || accepts == 0 || accepts == first.outcomes.len() {
        return Ok(None);
    }
    let mut result = [Vec::new(), Vec::new()];
    let steps = [vec![1.0; grid.axes.len()], grid.axes.iter().map(|axis| 1.0 / axis.cells as f64).collect()];
    for (result, spacing) in result.iter_mut().zip(&steps) {
        for side in [true, false] {
            if !differing.iter().any(|cell| accepted(first, *cell) == side) {
                continue;
            }
            // The distance of a cell from the border is its distance from the nearest cell of the other kind.
            let squares =
                squared_distances(&grid.shape(), spacing, |cell| accepted(first, cell) != side, exec)?;
            let own = differing.iter().filter(|cell| accepted(first, **cell) == side);
            result.extend(own.map(|cell| f64::from(squares[*cell]).sqrt()));
        }
    }
    let [cells, error_box] = result.map(Quantiles::of);
    Ok(Some(Distances { cells, error_box }))
}

impl Quantiles {
    /// Of a list that is not empty.
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let last = values.len() - 1;
        let at =
            |share: f64| values[((share * values.len() as f64).ceil() as usize).saturating_sub(1).min(last)];
        Self { median: at(0.5), p95: at(0.95), max: values[last] }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{accept, ball, grid};
    use super::*;
    use crate::pose::{DofSet, Mount, PoseError};
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn alignment() -> Alignment {
        Alignment::new(DofSet::ALL, Mount::X)
    }

    fn compared(first: &Acceptance, second: &Acceptance) -> Comparison {
        Comparison::of(&Paired::of(first, second).unwrap(), &alignment(), &Exec::new()).unwrap()
    }

    /// A ball in a larger ball: Jaccard is the ratio of their areas, and a differing cell is at most r₂ − r₁
    /// plus a cell's diagonal from the border.
    #[test]
    fn concentric_balls_have_their_closed_form() {
        let g = grid(&[200, 200], &[1.0, 1.0]);
        let (small, large) = (ball(&g, 0.5), ball(&g, 0.7));
        let result = compared(&small, &large);
        let ratio: f64 = 0.49 / 0.25;
        assert!((result.jaccard * ratio - 1.0).abs() < 0.005, "{}", result.jaccard);
        assert!((result.sum_ratio.unwrap() / ratio - 1.0).abs() < 0.005);
        assert!((result.agreement - (1.0 - PI * 0.24 / 4.0)).abs() < 0.002);
        assert!((result.onaa_ratio.unwrap() - 1.4).abs() < 0.03);
        assert_eq!(
            (result.only_first, result.confusion[0][1], result.confusion[1][0]),
            (0, 0, result.only_second)
        );
        let d = result.distances.unwrap();
        // 0.2 is 20 cells, and 0.1 of the error box. Half of a ring's area lies inside the median radius.
        assert!((d.cells.max - 20.0).abs() < 1.5 && (d.error_box.max - 0.1).abs() < 0.0075, "{d:?}");
        let median = 100.0 * (0.37f64.sqrt() - 0.5);
        assert!((d.cells.median - median).abs() < 1.0 && d.cells.p95 > 18.0, "{d:?}");
    }

    #[test]
    fn an_acceptance_agrees_with_itself() {
        let g = grid(&[9, 8, 7], &[1.0, 1.0, 1.0]);
        let result = compared(&ball(&g, 0.7), &ball(&g, 0.7));
        assert_eq!((result.jaccard, result.agreement, result.sum_ratio), (1.0, 1.0, Some(1.0)));
        assert_eq!(result.distances, None);
        let nothing = accept(&g, |_| false);
        let result = compared(&nothing, &ball(&g, 0.5));
        assert_eq!((result.jaccard, result.sum_ratio, result.distances), (0.0, None, None));
        assert_eq!(compared(&nothing, &nothing).jaccard, 1.0);
    }

    proptest! {
        #[test]
        fn exchange_transposes_the_confusions(
            codes in proptest::collection::vec((0usize..4, 0usize..4), 30),
        ) {
            let g = grid(&[5, 6], &[1.0, 1.0]);
            let of = |pick: fn(&(usize, usize)) -> usize| {
                let mut acceptance = accept(&g, |_| true);
                acceptance.outcomes = codes.iter().map(|c| Outcome::ALL[pick(c)]).collect();
                acceptance
            };
            let (a, b) = (of(|c| c.0), of(|c| c.1));
            let (there, back) = (compared(&a, &b), compared(&b, &a));
            prop_assert_eq!((there.jaccard, there.agreement), (back.jaccard, back.agreement));
            for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
                prop_assert_eq!(there.confusion[i][j], back.confusion[j][i]);
            }
            prop_assert_eq!(there.confusion.iter().flatten().sum::<usize>(), 30);
        }
    }

    #[test]
    fn a_grid_finer_by_odd_factors_is_compared_at_the_centres_that_both_have() {
        let (coarse, fine) = (grid(&[6, 10], &[1.0, 1.0]), grid(&[18, 10], &[1.0, 1.0]));
        let result = compared(&ball(&coarse, 0.7), &ball(&fine, 0.7));
        assert_eq!((result.poses, result.jaccard), (60, 1.0));
        assert_eq!(compared(&ball(&fine, 0.7), &ball(&coarse, 0.7)).poses, 60);
        let mixed = compared(&ball(&grid(&[18, 10], &[1.0; 2]), 0.7), &ball(&grid(&[6, 50], &[1.0; 2]), 0.7));
        assert_eq!((mixed.poses, mixed.jaccard), (60, 1.0));
    }

    #[test]
    fn results_over_different_errors_are_refused_with_the_axis() {
        let a = ball(&grid(&[10, 10], &[1.0, 1.0]), 0.5);
        let refused = |b: &Acceptance| Paired::of(&a, b).unwrap_err().to_string();
        assert!(
            refused(&ball(&grid(&[20, 10], &[1.0, 1.0]), 0.5))
                .starts_with("the grids differ along x: 10 and 20")
        );
        assert!(
            refused(&ball(&grid(&[10, 10], &[1.0, 2.0]), 0.5))
                .contains("differ along y: [-1, 1] and [-2, 2] D")
        );
        assert!(
            refused(&ball(&grid(&[10], &[1.0]), 0.5)).contains("the first over x, y, the second over x;")
        );
        let listed = |n: usize| Acceptance {
            method: "descent",
            domain: Domain::Poses(vec![PoseError::default(); n]),
            outcomes: vec![Outcome::Aligned; n],
            warnings: Vec::new(),
        };
        assert!(refused(&listed(3)).starts_with("one result is over a grid"));
        let lists = Paired::of(&listed(3), &listed(4)).unwrap_err();
        assert_eq!(lists, ComparisonError::Poses { first_difference: None });
        let three = listed(3);
        let result = compared(&three, &three);
        assert_eq!((result.poses, result.onaa_edges, result.distances), (3, None, None));
    }
}
