//! Figures of merit: numbers that describe a set of accepted pose errors. Each has its own file.
//!
//! ```text
//!   pitch ▲            ░ accepted            Sum        measure of ░
//!         │   ░░░░░    □ ONAA                ONAA       edge of the largest cube in ░ (axes scaled to [0,1])
//!         │ ░░┌───┐░   ▪ centred             centred    largest box in ░ with its centre at zero
//!         │ ░░│ ▪ │░░                        tolerance  largest single error, all others zero
//!         │  ░└───┘░   ─▶ x                  success    probability that a given error lies in ░
//! ```
//!
//! All figures are computed from an [`Acceptance`] alone. On a grid a cell represents its whole volume: the
//! accepted set is the union of the accepted cells, and every length is a whole number of cells, accurate to
//! about half a cell. Lengths are in D, angles in radians.
//!
//! *Not* promised: a jam thinner than a cell can hide between centres. [`sum::bracket()`] gives the change of
//! the Sum if the border moves by one cell to either side.

pub mod brute;
pub mod centered;
pub mod comparison;
mod distance;
pub mod estimate;
mod mask;
pub mod onaa;
pub mod slice;
pub mod success;
pub mod sum;
pub mod tolerance;

use crate::acceptance::{Acceptance, Outcome};
use crate::design::Alignment;
use crate::diagnostic::{Diagnostic, Warning};
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Grid, GridAxis};
use crate::pose::{Dof, PoseError};
use rayon::prelude::*;

/// Why a figure of merit cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeritError {
    /// The figure needs a grid, the outcomes are of listed poses.
    #[error("this figure needs outcomes over a grid, but they were computed for listed poses")]
    NotAGrid,
    /// The figure needs an axis that the grid does not have.
    #[error("{} is not an axis of the grid; its axes are {axes}", dof.name())]
    NoAxis {
        /// The requested axis.
        dof: Dof,
        /// Names of the axes there are.
        axes: String,
    },
    /// The same axis was named twice.
    #[error("{} is named twice", dof.name())]
    RepeatedAxis {
        /// The axis.
        dof: Dof,
    },
    /// A value lies outside the error box.
    #[error("{} = {value} lies outside the error box [{lo}, {hi}]", dof.name())]
    OutsideBox {
        /// The axis.
        dof: Dof,
        /// The value, D or radians.
        value: f64,
        /// Lower border of the box.
        lo: f64,
        /// Upper border of the box.
        hi: f64,
    },
    /// A number that must be finite and not negative is not.
    #[error("{what} must be finite and not negative, not {value}")]
    Negative {
        /// Name of the number.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A covariance matrix is not symmetric positive semidefinite.
    #[error("the covariance matrix is not symmetric and positive semidefinite (row {row})")]
    NotACovariance {
        /// The first affected row, from 1.
        row: usize,
    },
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// All figures of merit that follow from the outcomes alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Merits {
    /// Measure of the accepted cells or poses.
    pub sum: sum::Sum,
    /// The same without and with the cells at the border; `None` for listed poses.
    pub bracket: Option<[f64; 2]>,
    /// The largest cube; `None` for listed poses.
    pub onaa: Option<onaa::Onaa>,
    /// The largest cube around zero; `None` for listed poses.
    pub centered: Option<centered::CenteredBox>,
    /// Single-axis limits of each error; empty for listed poses.
    pub tolerances: Vec<tolerance::Tolerance>,
    /// Warnings of the method, and of the accepted set itself.
    pub warnings: Vec<Diagnostic>,
}

impl Merits {
    /// Evaluates an acceptance.
    ///
    /// # Errors
    /// When they do not fit into memory, or are cancelled.
    pub fn of(acceptance: &Acceptance, alignment: &Alignment, exec: &Exec) -> Result<Self, MeritError> {
        const STAGE: &str = "figures of merit";
        let mut merits = Self {
            sum: sum::Sum::of(acceptance, alignment),
            bracket: None,
            onaa: None,
            centered: None,
            tolerances: Vec::new(),
            warnings: acceptance.warnings.clone(),
        };
        if acceptance.grid().is_some() {
            exec.report(0.0, STAGE);
            merits.bracket = Some(sum::bracket(acceptance, exec)?);
            exec.report(0.3, STAGE);
            merits.onaa = Some(onaa::Onaa::of(acceptance, exec)?);
            exec.report(0.8, STAGE);
            merits.centered = Some(centered::centered_cube(acceptance, exec)?);
            merits.tolerances = tolerance::tolerances(acceptance)?;
        }
        let known = |w: &Diagnostic| acceptance.warnings.iter().any(|o| o.code == w.code);
        let own = warnings(acceptance, exec)?;
        merits.warnings.extend(own.into_iter().filter(|w| !known(w)));
        Ok(merits)
    }
}

/// The grid of an acceptance.
fn grid_of(acceptance: &Acceptance) -> Result<&Grid, MeritError> {
    acceptance.grid().ok_or(MeritError::NotAGrid)
}

/// The position of `dof` among the axes of `grid`.
fn axis_number(grid: &Grid, dof: Dof) -> Result<usize, MeritError> {
    grid.axes.iter().position(|a| a.dof == dof).ok_or_else(|| MeritError::NoAxis {
        dof,
        axes: grid.axes.iter().map(|a| a.dof.name()).collect::<Vec<_>>().join(", "),
    })
}

/// Distance from zero to the interior of cell `k`: 0 for a cell that holds zero or has it on its border.
fn gap(axis: &GridAxis, k: usize) -> f64 {
    let step = axis.step();
    let below = axis.lo + k as f64 * step;
    let above = axis.lo + (k as f64 + 1.0) * step;
    // Borders that should be zero are so only to rounding: a millionth of a cell is far above that.
    let distance = below.max(-above);
    if distance <= 1e-6 * step { 0.0 } else { distance }
}

/// Warnings that follow from the accepted set itself: it reaches the border of the error box, it does not
/// contain the mated pose, some poses are undecided.
///
/// # Errors
/// If the computation is cancelled.
pub fn warnings(acceptance: &Acceptance, exec: &Exec) -> Result<Vec<Diagnostic>, Cancelled> {
    let mut warnings = Vec::new();
    if let Some(grid) = acceptance.grid() {
        let axes = border_axes(acceptance, grid, exec)?;
        if !axes.is_empty() {
            let axes = axes.iter().map(|d| d.name().to_owned()).collect();
            warnings.push(Warning::TouchesBorder { axes }.into());
        }
        let tolerable = tolerance::around_zero(grid);
        // An undecided cell may be accepted.
        let may = [Outcome::Aligned, Outcome::Undecided];
        let holds = |cell: &usize| may.contains(&acceptance.outcomes[*cell]);
        if !tolerable.is_empty() && !tolerable.iter().any(holds) {
            warnings.push(Warning::MatedPoseNotAccepted.into());
        }
    }
    let undecided = acceptance.counts()[Outcome::Undecided as usize - 1];
    let is_reported = |warning: &Diagnostic| {
        matches!(warning.facts.as_deref(), Some(Warning::Undecided { .. } | Warning::Open { .. }))
    };
    if undecided > 0 && !acceptance.warnings.iter().any(is_reported) {
        warnings.push(Warning::Undecided { cells: undecided }.into());
    }
    Ok(warnings)
}

/// The axes at whose border an accepted cell lies.
fn border_axes(acceptance: &Acceptance, grid: &Grid, exec: &Exec) -> Result<Vec<Dof>, Cancelled> {
    let holds = |cells: &[Outcome]| cells.contains(&Outcome::Aligned);
    let mut touched = Vec::new();
    let mut stride = 1;
    for axis in &grid.axes {
        exec.check()?;
        let block = stride * axis.cells;
        // Whole lines along the axis: its first and its last layer.
        let touches = |block: &[Outcome]| holds(&block[..stride]) || holds(&block[block.len() - stride..]);
        let blocks = acceptance.outcomes.par_chunks_exact(block.max(1));
        if block > 0 && exec.install(|| blocks.any(touches)) {
            touched.push(axis.dof);
        }
        stride = block;
    }
    Ok(touched)
}

/// Steps per-axis cell numbers to the next cell in memory order, the first axis fastest.
fn advance(cell: &mut [usize], shape: &[usize]) {
    for (k, n) in cell.iter_mut().zip(shape) {
        *k += 1;
        if *k < *n {
            return;
        }
        *k = 0;
    }
}

/// Five numbers of which only those of the grid's axes count: the others must be zero.
fn require_sampled(grid: &Grid, values: &PoseError) -> Result<(), MeritError> {
    for (dof, value) in Dof::ALL.into_iter().zip(values.to_array()) {
        if value != 0.0 {
            axis_number(grid, dof)?;
        }
    }
    Ok(())
}

#[cfg(test)]
pub(crate) mod testing {
    //! Acceptances with closed forms.

    use super::*;
    use crate::acceptance::Domain;

    /// Axes over the first `shape.len()` errors, each over [−`half`, `half`].
    pub(crate) fn grid(shape: &[usize], half: &[f64]) -> Grid {
        let axis = |((dof, cells), half): ((Dof, &usize), &f64)| GridAxis {
            dof,
            lo: -half,
            hi: *half,
            cells: *cells,
        };
        Grid { axes: Dof::ALL.into_iter().zip(shape).zip(half).map(axis).collect() }
    }

    /// Accepts the cells whose centre satisfies `inside`; the others are jammed.
    pub(crate) fn accept(grid: &Grid, inside: impl Fn([f64; 5]) -> bool) -> Acceptance {
        let outcome = |i| if inside(grid.pose(i).to_array()) { Outcome::Aligned } else { Outcome::Jammed };
        Acceptance {
            method: "closed form",
            outcomes: (0..grid.len()).map(outcome).collect(),
            domain: Domain::Grid(grid.clone()),
            warnings: Vec::new(),
        }
    }

    /// A ball of radius `r` around zero in the coordinates of the error.
    pub(crate) fn ball(grid: &Grid, r: f64) -> Acceptance {
        accept(grid, |e| e.iter().map(|v| v * v).sum::<f64>() < r * r)
    }
}

#[cfg(test)]
mod tests {
    use super::testing::*;
    use super::*;

    #[test]
    fn a_set_cut_off_by_the_box_reports_the_axes() {
        let grid = grid(&[8, 8, 8], &[1.0, 1.0, 1.0]);
        let slab = accept(&grid, |e| e[1].abs() < 0.5);
        let warnings = |acceptance| super::warnings(acceptance, &Exec::new()).unwrap();
        assert_eq!(warnings(&slab), [Warning::TouchesBorder { axes: vec!["x".into(), "roll".into()] }]);
        assert!(warnings(&ball(&grid, 0.5)).is_empty());
    }

    #[test]
    fn a_set_beside_the_mated_pose_has_a_warning() {
        let grid = grid(&[9, 9], &[1.0, 1.0]);
        let beside = accept(&grid, |e| (0.2..0.8).contains(&e[0]) && e[1].abs() < 0.5);
        assert_eq!(warnings(&beside, &Exec::new()).unwrap(), [Warning::MatedPoseNotAccepted]);
    }
}
