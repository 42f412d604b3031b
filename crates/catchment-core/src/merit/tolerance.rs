//! Single-axis limits: the tolerance of each error while all others are zero. The "± 5 mm, ± 8°" of
//! datasheets.
//!
//! ```text
//!   x:  ✕ ✕ ░ ░ ░ ░ │ ░ ░ ░ ✕ ░ ✕       minus = 4 cells, plus = 3 cells
//!                   0
//! ```
//!
//! The contiguous accepted cells from zero outwards count, to the outer border of the last one: the true
//! limit lies between the centres on either side of it, so within half a cell ([`Tolerance::half_cell`]).
//! With an even number of cells no centre lies at zero; then a cell along the axis counts as accepted if it
//! is accepted on every side of zero along the other axes.
//!
//! If poses can be followed singly, no grid is needed ([`followed`]): poses are followed from zero outwards
//! at even steps, and the border before the first failure is found by bisection.

use super::{MeritError, gap, grid_of};
use crate::acceptance::{Acceptance, Outcome};
use crate::landscape::Grid;
use crate::pose::{Dof, ErrorUnit, PoseError};
use serde::{Deserialize, Serialize};

/// Single-axis limits of an error, in D or radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tolerance {
    /// The error.
    pub axis: Dof,
    /// `D` or `rad`.
    pub unit: ErrorUnit,
    /// Limit below zero; not negative.
    pub minus: f64,
    /// Limit above zero; not negative.
    pub plus: f64,
    /// Uncertainty of both: half a cell, or half the distance between a success and a failure.
    pub half_cell: f64,
    /// Whether exact motions along the axis determined the limits, independently of the cells; false in
    /// reports of older versions.
    #[serde(default)]
    pub followed: bool,
    /// Whether `minus` ends at the border of the error box, so that it may be larger.
    pub minus_reaches_border: bool,
    /// Whether `plus` ends at the border of the error box, so that it may be larger.
    pub plus_reaches_border: bool,
}

impl Tolerance {
    /// The smaller side: the limit for both signs.
    pub const fn symmetric(&self) -> f64 {
        self.minus.min(self.plus)
    }
}

/// The tolerance along every axis of the grid, in its order. Empty accepted surroundings of zero give zeros; an
/// axis whose range does not hold zero is left out.
///
/// # Errors
/// If the outcomes are of listed poses.
pub fn tolerances(acceptance: &Acceptance) -> Result<Vec<Tolerance>, MeritError> {
    let grid = grid_of(acceptance)?;
    Ok((0..grid.axes.len()).filter_map(|number| along(acceptance, grid, number)).collect())
}

fn along(acceptance: &Acceptance, grid: &Grid, number: usize) -> Option<Tolerance> {
    let axis = &grid.axes[number];
    let around = around_zero(grid);
    let center = *around.first()?;
    let stride: usize = grid.axes[..number].iter().map(|a| a.cells).product();
    let home = grid.cell(center)[number];
    // Whether cell `k` along the axis is accepted on every side of zero.
    let accepted = |k: usize| {
        around.iter().all(|cell| {
            let first = cell - grid.cell(*cell)[number] * stride;
            acceptance.outcomes[first + k * stride] == Outcome::Aligned
        })
    };
    let at_zero: Vec<usize> = (home..axis.cells).take_while(|k| gap(axis, *k) == 0.0).collect();
    let (lowest, highest) = (home, *at_zero.last()?);
    let step = axis.step();
    // A single cell at zero must be accepted for either side; with two cells at zero, each side has its own.
    let below = (0..=lowest).rev().take_while(|k| accepted(*k)).last();
    let above = (highest..axis.cells).take_while(|k| accepted(*k)).last();
    Some(Tolerance {
        axis: axis.dof,
        unit: ErrorUnit::of(axis.dof),
        minus: below.map_or(0.0, |k| -(axis.lo + k as f64 * step)).max(0.0),
        plus: above.map_or(0.0, |k| axis.lo + (k as f64 + 1.0) * step).max(0.0),
        minus_reaches_border: below == Some(0),
        plus_reaches_border: above == Some(axis.cells - 1),
        half_cell: 0.5 * step,
        followed: false,
    })
}

/// Number of bisections of the step between a success and a failure.
pub(crate) const BISECTIONS: i32 = 7;

/// A side of an axis during the search.
struct Side {
    dof: Dof,
    /// Border of the error box.
    border: f64,
    /// As far as poses were seen to dock, and the first that does not; in steps.
    between: [f64; 2],
}

/// Single-axis limits along every axis whose range contains zero, in the order of `grid`, of which only the
/// error box is used: `decide` returns the outcomes of `steps` poses on either side and of some bisections. A
/// gap narrower than a step is missed.
///
/// # Errors
/// Those of `decide`.
pub fn followed<E>(
    grid: &Grid,
    steps: usize,
    mut decide: impl FnMut(Vec<PoseError>) -> Result<Vec<Outcome>, E>,
) -> Result<Vec<Tolerance>, E> {
    let whole = steps.max(1) as f64;
    let pose = |dof: Dof, value: f64| {
        let mut error = [0.0; Dof::ALL.len()];
        error[dof.index()] = value;
        PoseError::from_array(error)
    };
    let holds = |lo: f64, hi: f64| lo < 0.0 && hi > 0.0;
    let axes: Vec<_> = grid.axes.iter().filter(|axis| holds(axis.lo, axis.hi)).collect();
    let sides = axes.iter().flat_map(|axis| [(axis.dof, axis.lo), (axis.dof, axis.hi)]);
    let mut sides: Vec<Side> =
        sides.map(|(dof, border)| Side { dof, border, between: [0.0, whole] }).collect();
    let at = |side: &Side, step: f64| pose(side.dof, side.border * (step / whole));
    let scan = sides.iter().flat_map(|side| (1..=steps.max(1)).map(move |k| at(side, k as f64)));
    let docks = |outcome: &Outcome| *outcome == Outcome::Aligned;
    let result = decide([PoseError::default()].into_iter().chain(scan).collect())?;
    let is_home = result.first().is_some_and(docks);
    for (side, result) in sides.iter_mut().zip(result.get(1..).unwrap_or_default().chunks(steps.max(1))) {
        let reached = if is_home { result.iter().take_while(|outcome| docks(outcome)).count() } else { 0 };
        side.between = [reached as f64, (reached + 1) as f64];
    }
    let is_open = |side: &Side| is_home && side.between[0] < whole;
    for _ in 0..BISECTIONS {
        let middle = |side: &Side| 0.5 * (side.between[0] + side.between[1]);
        let poses = sides.iter().filter(|side| is_open(side)).map(|side| at(side, middle(side))).collect();
        let result = decide(poses)?;
        for (side, outcome) in sides.iter_mut().filter(|side| is_open(side)).zip(&result) {
            side.between[usize::from(!docks(outcome))] = middle(side);
        }
    }
    let reach = |side: &Side| side.border.abs() * (side.between[0] / whole);
    let doubt = |side: &Side| {
        if is_open(side) { 0.5f64.powi(BISECTIONS + 1) * side.border.abs() / whole } else { 0.0 }
    };
    Ok(sides
        .chunks_exact(2)
        .map(|sides| Tolerance {
            axis: sides[0].dof,
            unit: ErrorUnit::of(sides[0].dof),
            minus: reach(&sides[0]),
            plus: reach(&sides[1]),
            minus_reaches_border: sides[0].between[0] >= whole,
            plus_reaches_border: sides[1].between[0] >= whole,
            half_cell: doubt(&sides[0]).max(doubt(&sides[1])),
            followed: true,
        })
        .collect())
}

/// The cells that contain zero or have it on their border: one, or two per axis with an even number of cells.
/// Empty if zero lies outside the grid. In memory order.
pub(super) fn around_zero(grid: &Grid) -> Vec<usize> {
    let mut cells = vec![0usize];
    let mut stride = 1;
    for axis in &grid.axes {
        let near: Vec<usize> = (0..axis.cells).filter(|k| gap(axis, *k) == 0.0).collect();
        cells = near.iter().flat_map(|k| cells.iter().map(move |c| c + k * stride)).collect();
        stride *= axis.cells;
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::super::testing::*;
    use super::*;

    #[test]
    fn followed_tolerances_are_finer_than_the_cells() {
        let g = grid(&[2, 3], &[1.0, 2.0]);
        let inside = |e: &PoseError| (-0.5..0.3).contains(&e.x) && e.y.abs() < 0.25 && e.x + e.y > -0.6;
        let decide = |poses: Vec<PoseError>| {
            let label = |e: &PoseError| if inside(e) { Outcome::Aligned } else { Outcome::Missed };
            Ok::<_, ()>(poses.iter().map(label).collect())
        };
        let result = followed(&g, 40, decide).unwrap();
        for (tolerance, exact) in result.iter().zip([[0.5, 0.3], [0.25, 0.25]]) {
            assert!(tolerance.followed && !tolerance.plus_reaches_border && tolerance.half_cell < 3e-4);
            for (side, exact) in [tolerance.minus, tolerance.plus].into_iter().zip(exact) {
                assert!((exact - side).abs() <= 2.0 * tolerance.half_cell + 1e-12, "{side} for {exact}");
            }
        }
        // To the border, and nothing at all.
        let all = followed(&g, 4, |poses| Ok::<_, ()>(vec![Outcome::Aligned; poses.len()])).unwrap();
        assert_eq!(
            (all[1].minus, all[1].plus, all[1].plus_reaches_border, all[1].half_cell),
            (2.0, 2.0, true, 0.0)
        );
        let none = followed(&g, 4, |poses| Ok::<_, ()>(vec![Outcome::Jammed; poses.len()])).unwrap();
        assert_eq!((none[0].minus, none[0].plus, none[0].plus_reaches_border), (0.0, 0.0, false));
    }

    #[test]
    fn both_limits_of_an_off_centre_box_are_exact() {
        // Borders of the box lie on cell borders for 40 cells over [−1, 1], so the tolerances are exact.
        let g = grid(&[40, 40], &[1.0, 1.0]);
        let t = tolerances(&accept(&g, |e| (-0.5..0.3).contains(&e[0]) && e[1].abs() < 0.25)).unwrap();
        assert_eq!((t[0].axis, t[1].axis), (Dof::X, Dof::Y));
        for (result, exact) in
            [(t[0].minus, 0.5), (t[0].plus, 0.3), (t[1].minus, 0.25), (t[1].symmetric(), 0.25)]
        {
            assert!((result - exact).abs() < 1e-12, "{result} for {exact}");
        }
    }

    #[test]
    fn an_ellipsoid_has_its_half_axes_within_half_a_cell() {
        let half = [0.83, 0.61, 0.37, 0.9, 0.45];
        for cells in [8, 9] {
            let g = grid(&[cells; 5], &[1.0; 5]);
            let inside = |e: [f64; 5]| e.iter().zip(&half).map(|(v, h)| (v / h).powi(2)).sum::<f64>() < 1.0;
            for (t, exact) in tolerances(&accept(&g, inside)).unwrap().iter().zip(half) {
                // An even grid looks half a cell (0.125) beside the axis in four directions: there the half-axis is
                // shorter by the factor √(1 − Σ (0.125/h)²) ≥ √(1 − 0.25).
                let shorter = if cells % 2 == 0 { exact * (1.0 - 0.75f64.sqrt()) } else { 0.0 };
                assert!(
                    t.plus <= exact + t.half_cell && t.plus >= exact - shorter - t.half_cell,
                    "{t:?} {exact}"
                );
                assert!((t.minus - t.plus).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn gaps_end_a_tolerance_and_borders_are_named() {
        let g = grid(&[9], &[0.9]);
        let t = tolerances(&accept(&g, |e| !(0.5..0.7).contains(&e[0]))).unwrap()[0];
        assert!((t.plus - 0.5).abs() < 1e-12 && !t.plus_reaches_border);
        assert!((t.minus - 0.9).abs() < 1e-12 && t.minus_reaches_border);
        let nothing = tolerances(&accept(&g, |e| e[0].abs() > 0.05)).unwrap()[0];
        assert_eq!((nothing.minus, nothing.plus), (0.0, 0.0));
    }
}
