//! The largest box in the accepted set with its centre at zero: the tolerance for a robot with centred
//! errors.
//!
//! ```text
//!        ░░░░░░░
//!      ░░┌───┐░░░          s = min over rejected cells of  maxᵢ (gapᵢ / halfᵢ)
//!      ░░│ 0 │░░░
//!       ░└───┘░            gapᵢ: distance from zero to the cell along axis i
//!          ░░░             halfᵢ: half-width of the wanted box
//! ```
//!
//! The box grows from zero until it meets a rejected cell, or the border of the error box, beyond which
//! outcomes are not known. It ends on cell borders, so its half-width is accurate to half a cell along the
//! axis that limits it. With an even number of cells no centre lies at zero; all cells that meet there count.
//!
//! If poses can be followed singly, a run finds the box by exact motions instead ([`crate::run`]).

use super::onaa::Interval;
use super::{MeritError, advance, axis_number, gap, grid_of};
use crate::acceptance::{Acceptance, Outcome};
use crate::exec::{Cancelled, Exec};
use crate::pose::{Dof, DofSet, PoseError};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The largest box around zero in the accepted set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CenteredBox {
    /// Size relative to the wanted proportions; for the cube, its edge with each axis divided by its range: in
    /// [0, 1].
    pub edge: f64,
    /// Bounds of the box, from −h to h along each axis.
    pub bounds: Vec<Interval>,
    /// Whether the border of the error box limits the box, so that it may be larger.
    pub reaches_border: bool,
    /// Whether exact motions determined the size, independently of the cells; false in reports of older
    /// versions.
    #[serde(default)]
    pub followed: bool,
    /// Number of sampled poses of the final box, all of which dock.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampled: Option<usize>,
    /// Errors that limit the box: with one of them slightly larger and the others inside it a pose fails; absent if the
    /// cells determined the size.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limited_by: Vec<Dof>,
}

impl CenteredBox {
    /// A box of half-widths in D and radians, by as many sampled poses, or by cells.
    pub(crate) fn of(
        edge: f64,
        half_widths: impl IntoIterator<Item = (Dof, f64)>,
        reaches_border: bool,
        sampled: Option<usize>,
        limited_by: DofSet,
    ) -> Self {
        let bounds = half_widths.into_iter().map(|(axis, h)| Interval { axis, lo: -h, hi: h }).collect();
        let limited_by = limited_by.iter().collect();
        Self { edge, bounds, reaches_border, followed: sampled.is_some(), sampled, limited_by }
    }
}

/// The largest centred cube after each axis is divided by its range: `edge` = 1 is the whole error box.
///
/// # Errors
/// If the outcomes are of listed poses, or it is cancelled.
pub fn centered_cube(acceptance: &Acceptance, exec: &Exec) -> Result<CenteredBox, MeritError> {
    let halves: Vec<f64> = grid_of(acceptance)?.axes.iter().map(|a| 0.5 * (a.hi - a.lo)).collect();
    grow_from_zero(acceptance, &halves, exec)
}

/// The largest centred box with the given proportions: half-widths in D and radians (0: no error there).
///
/// # Errors
/// If the outcomes are of listed poses, a proportion is negative or given for an axis that was not sampled,
/// or the computation is cancelled.
pub fn centered_box(
    acceptance: &Acceptance,
    proportions: &PoseError,
    exec: &Exec,
) -> Result<CenteredBox, MeritError> {
    let grid = grid_of(acceptance)?;
    let mut halves = vec![0.0; grid.axes.len()];
    for (dof, value) in Dof::ALL.into_iter().zip(proportions.to_array()) {
        if !value.is_finite() || value < 0.0 {
            return Err(MeritError::Negative { what: "a proportion", value });
        }
        if value > 0.0 {
            halves[axis_number(grid, dof)?] = value;
        }
    }
    grow_from_zero(acceptance, &halves, exec)
}

fn grow_from_zero(acceptance: &Acceptance, halves: &[f64], exec: &Exec) -> Result<CenteredBox, MeritError> {
    let grid = grid_of(acceptance)?;
    // Scale at which the box reaches cell k of axis i: never, if it has no width there and the cell is not at zero.
    let reach = |gap: f64, half: f64| if gap == 0.0 { 0.0 } else { gap / half };
    let table: Vec<Vec<f64>> = grid
        .axes
        .iter()
        .zip(halves)
        .map(|(axis, half)| (0..axis.cells).map(|k| reach(gap(axis, k), *half)).collect())
        .collect();
    let border = grid
        .axes
        .iter()
        .zip(halves)
        .map(|(axis, half)| if *half == 0.0 { f64::INFINITY } else { axis.hi.min(-axis.lo).max(0.0) / half })
        .fold(f64::INFINITY, f64::min);
    let scale = exec.install(|| first_rejected(acceptance, &table, border, exec))?;
    // Without any width the box is a point: there or not.
    let scale = if scale.is_finite() { scale } else { 1.0 };
    let half_widths = grid.axes.iter().zip(halves).map(|(axis, half)| (axis.dof, scale * half));
    Ok(CenteredBox::of(scale, half_widths, scale >= border, None, DofSet::EMPTY))
}

/// The least scale, up to `border`, at which the box meets a rejected cell; `table` has the scale at which it
/// reaches each cell of each axis. Slabs of the last axis in parallel; each reads only the cells that its box may
/// still reach.
fn first_rejected(
    acceptance: &Acceptance,
    table: &[Vec<f64>],
    border: f64,
    exec: &Exec,
) -> Result<f64, Cancelled> {
    // A grid without axes has a single cell, at zero.
    let zero = vec![0.0];
    let (first, others) = table.split_first().map_or((&zero, table), |(first, others)| (first, others));
    let (inner, slabs) = others.split_last().map_or((others, &zero), |(last, inner)| (inner, last));
    let shape: Vec<usize> = inner.iter().map(Vec::len).collect();
    let slab = first.len() * shape.iter().product::<usize>();
    if slab == 0 {
        return Ok(border);
    }
    let in_slab = |(outcomes, at): (&[Outcome], &f64)| -> Result<f64, Cancelled> {
        exec.check()?;
        let mut scale = border;
        let mut cell = vec![0; shape.len()];
        for row in outcomes.chunks_exact(first.len()) {
            let others = inner.iter().zip(&cell).map(|(reach, k)| reach[*k]).fold(*at, f64::max);
            if others < scale {
                for (_, along) in row.iter().zip(first).filter(|(outcome, _)| **outcome != Outcome::Aligned) {
                    scale = scale.min(along.max(others));
                }
            }
            advance(&mut cell, &shape);
        }
        Ok(scale)
    };
    let slabs = acceptance.outcomes.par_chunks_exact(slab).zip(slabs);
    slabs.map(in_slab).try_reduce(|| border, |a, b| Ok(a.min(b)))
}

#[cfg(test)]
mod tests {
    use super::super::testing::*;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// For odd and even counts alike: every cell that the box meets is accepted, and no larger box has
        /// this property.
        #[test]
        fn the_box_holds_only_accepted_cells_and_a_larger_one_does_not(
            shape in proptest::collection::vec(1usize..6, 1..4),
            seed in proptest::collection::vec(prop::bool::weighted(0.9), 125),
            widths in proptest::array::uniform3(0.2..2.0f64),
        ) {
            let g = grid(&shape, &vec![1.0; shape.len()]);
            let mut accepted = accept(&g, |_| true);
            for (outcome, keep) in accepted.outcomes.iter_mut().zip(&seed) {
                if !keep { *outcome = crate::acceptance::Outcome::Missed; }
            }
            let mut proportions = [0.0; 5];
            proportions[..shape.len()].copy_from_slice(&widths[..shape.len()]);
            let result = centered_box(&accepted, &PoseError::from_array(proportions), &Exec::new()).unwrap();
            let clean = |scale: f64| (0..g.len()).all(|i| {
                let cell = g.cell(i);
                let meets = g.axes.iter().zip(&cell).zip(&widths).all(|((a, k), w)| {
                    let (lo, hi) = (a.lo + *k as f64 * a.step(), a.lo + (*k as f64 + 1.0) * a.step());
                    lo < scale * w - 1e-9 && hi > -scale * w + 1e-9
                });
                !meets || accepted.outcomes[i] == crate::acceptance::Outcome::Aligned
            });
            prop_assert!(result.edge == 0.0 || clean(result.edge));
            prop_assert!(result.reaches_border || !clean(result.edge + 1e-6));
        }
    }

    #[test]
    fn the_centred_cube_of_a_ball_is_inscribed() {
        // Half edge r/√3; it stops at the border of a cell whose centre is outside the ball: within a cell of 0.04.
        for cells in [50, 51] {
            let cube = centered_cube(&ball(&grid(&[cells; 3], &[1.0; 3]), 0.9), &Exec::new()).unwrap();
            assert!((cube.edge - 0.9 / 3f64.sqrt()).abs() < 0.04, "{cells}: {}", cube.edge);
            assert!(!cube.reaches_border);
        }
    }

    #[test]
    fn proportions_choose_the_axis_that_stops_the_box() {
        let g = grid(&[40, 40], &[1.0, 1.0]);
        let accepted = accept(&g, |e| e[0].abs() < 0.5 && e[1].abs() < 0.25);
        let wide = PoseError { x: 4.0, y: 1.0, ..PoseError::default() };
        let result = centered_box(&accepted, &wide, &Exec::new()).unwrap();
        assert!((result.edge - 0.125).abs() < 1e-12);
        let line = PoseError { x: 1.0, ..PoseError::default() };
        assert!((centered_box(&accepted, &line, &Exec::new()).unwrap().edge - 0.5).abs() < 1e-12);
        let unknown = PoseError { yaw: 1.0, ..PoseError::default() };
        assert!(matches!(
            centered_box(&accepted, &unknown, &Exec::new()),
            Err(MeritError::NoAxis { dof: Dof::Yaw, .. })
        ));
    }

    #[test]
    fn a_box_limited_by_the_error_box_reports_it() {
        let cube = centered_cube(&accept(&grid(&[6, 7], &[1.0, 1.5]), |_| true), &Exec::new()).unwrap();
        assert_eq!((cube.edge, cube.reaches_border), (1.0, true));
    }
}
