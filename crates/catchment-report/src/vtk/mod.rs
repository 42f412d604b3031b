//! The accepted set, and motions, as files of VTK: ParaView, `pyvista`, the `vtk` package.
//!
//! ```text
//!   acceptance ──▶ View (up to three of the axes, the others at a value) ──▶ image    .vti, every cell with its outcome
//!                                                                       └──▶ border   .vtp, the faces between accepted and rejected cells
//!   trace, halves ──▶ motion   .vtp, the path, the contacts along it, both halves
//! ```
//!
//! Lengths are in D and angles in radians, as in every machine format. An image holds cells, not points: the
//! value of a cell was decided at its centre, and the number of accepted cells times the measure of a cell is
//! the measure of the grid. The border runs along the faces of cells, so that it encloses exactly that
//! measure; it is no smoother than the grid.
//!
//! Not promised: outcomes between two centres. If a grid has more axes than are shown, outcome, border and
//! height are those of a single section, and `share` covers the whole grid.

mod border;
mod image;
mod motion;
#[cfg(test)]
mod tests;
mod xml;

pub use border::border;
pub use image::image;
pub use motion::motion;

use super::document::{Style, lines};
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::document::{Document, grouped, number, significant};
use catchment_core::exec::{Cancelled, OutOfBudget};
use catchment_core::landscape::{Grid, GridAxis};
use catchment_core::pose::{Dof, DofSet, PoseError};

/// Why a set cannot be shown so.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The result has listed poses instead of a grid.
    #[error("the outcomes are over no grid")]
    NotAGrid,
    /// The grid has no such axis.
    #[error("{} is no axis of the grid; it has {}", dof.name(), .axes.join(", "))]
    NoAxis {
        /// Which.
        dof: Dof,
        /// Those that it has.
        axes: Vec<&'static str>,
    },
    /// A picture in space has three axes.
    #[error("{count} axes cannot be shown at once: choose up to three of them")]
    TooMany {
        /// The requested number.
        count: usize,
    },
    /// The border of a set along a single axis is not a surface.
    #[error("a surface needs two axes or three; this grid shows one")]
    OneAxis,
    /// A value was given for an axis that is shown.
    #[error("{} is shown along its whole range: it takes no value", dof.name())]
    Shown {
        /// Which.
        dof: Dof,
    },
    /// A value outside of the error box.
    #[error("{} = {} lies outside of the error box, {} to {}", dof.name(), number(*value), number(*lo), number(*hi))]
    Outside {
        /// Of which axis.
        dof: Dof,
        /// The value, D or rad.
        value: f64,
        /// Lower border.
        lo: f64,
        /// Upper border.
        hi: f64,
    },
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A decided grid along up to three of its axes; along the others a single row of cells.
#[derive(Debug, Clone)]
pub struct View<'a> {
    grid: &'a Grid,
    outcomes: &'a [Outcome],
    /// z of the COR at first contact, in D, of every cell of the grid; not finite without contact.
    heights: Option<&'a [f32]>,
    /// Numbers of the axes that are shown, in the order of the grid.
    shown: Vec<usize>,
    /// The cell along every axis that is not shown; 0 along those that are.
    at: Vec<usize>,
}

impl<'a> View<'a> {
    /// A view of a grid with its heights, if known. Without `axes` the first three are shown; the others are
    /// at the cells that contain the values of `at`.
    ///
    /// # Errors
    /// See [`ViewError`].
    /// See [`ViewError`].
    pub fn new(
        acceptance: &'a Acceptance,
        heights: Option<&'a [f32]>,
        axes: Option<DofSet>,
        at: &PoseError,
    ) -> Result<Self, ViewError> {
        const MOST: usize = 3;
        let grid = acceptance.grid().ok_or(ViewError::NotAGrid)?;
        let shown: Vec<usize> = match axes {
            None => (0..grid.axes.len().min(MOST)).collect(),
            Some(dofs) => dofs.iter().map(|dof| number_of(grid, dof)).collect::<Result<_, _>>()?,
        };
        if shown.len() > MOST {
            return Err(ViewError::TooMany { count: shown.len() });
        }
        let values = at.to_array();
        for (dof, _) in Dof::ALL.into_iter().zip(values).filter(|(_, value)| *value != 0.0) {
            if shown.contains(&number_of(grid, dof)?) {
                return Err(ViewError::Shown { dof });
            }
        }
        let cell = |(k, axis): (usize, &GridAxis)| {
            if shown.contains(&k) {
                return Ok(0);
            }
            let GridAxis { dof, lo, hi, .. } = *axis;
            let value = values[dof.index()];
            axis.cell_of(value).ok_or(ViewError::Outside { dof, value, lo, hi })
        };
        let at = grid.axes.iter().enumerate().map(cell).collect::<Result<_, _>>()?;
        let heights = heights.filter(|heights| heights.len() == grid.len());
        Ok(Self { grid, outcomes: &acceptance.outcomes, heights, shown, at })
    }

    /// The axes that are shown.
    fn axes(&self) -> impl ExactSizeIterator<Item = &GridAxis> {
        self.shown.iter().map(|k| &self.grid.axes[*k])
    }

    /// Cells along three axes; 1 along those that are not there.
    fn shape(&self) -> [usize; 3] {
        std::array::from_fn(|k| self.shown.get(k).map_or(1, |axis| self.grid.axes[*axis].cells))
    }

    /// How many cells are shown.
    fn len(&self) -> usize {
        self.shape().iter().product()
    }

    /// The number in the grid of the shown cell `[i, j, k]`.
    fn index(&self, cell: [usize; 3]) -> usize {
        let mut place = self.at.clone();
        for (axis, k) in self.shown.iter().zip(cell) {
            place[*axis] = k;
        }
        self.grid.index(&place)
    }

    /// Numbers in the grid of all shown cells, the first axis fastest.
    fn cells(&self) -> impl Iterator<Item = usize> {
        let [nx, ny, nz] = self.shape();
        (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| self.index([i, j, k]))))
    }

    /// The lower corner of the first cell, and the size of a cell: 1 along missing axes.
    fn lattice(&self) -> ([f64; 3], [f64; 3]) {
        let axis = |k: usize| self.shown.get(k).map(|axis| &self.grid.axes[*axis]);
        let origin = std::array::from_fn(|k| axis(k).map_or(0.0, |axis| axis.lo));
        let spacing = std::array::from_fn(|k| axis(k).map_or(1.0, GridAxis::step));
        (origin, spacing)
    }

    /// A line on the meaning of the axes of a file.
    fn heading(&self) -> String {
        let shown = ["x", "y", "z"].into_iter().zip(self.axes());
        let mut words: Vec<String> =
            shown.map(|(file, axis)| format!("{file} is {} ({})", axis.dof.name(), unit(axis))).collect();
        words.extend(
            self.fixed()
                .map(|(axis, k)| format!("{} = {} {}", axis.dof.name(), number(axis.center(k)), unit(axis))),
        );
        format!("catchment {}: accepted pose errors; {}", env!("CARGO_PKG_VERSION"), words.join(", "))
    }

    /// The axes that are not shown, each with its cell.
    fn fixed(&self) -> impl Iterator<Item = (&GridAxis, usize)> {
        let all = self.grid.axes.iter().zip(&self.at).enumerate();
        all.filter(|(k, _)| !self.shown.contains(k)).map(|(_, (axis, cell))| (axis, *cell))
    }

    /// Description of the view, and its accepted share, as text.
    pub fn table(&self) -> String {
        let mut document = Document::default();
        let names: Vec<String> =
            self.axes().map(|axis| format!("{} ({})", axis.dof.name(), unit(axis))).collect();
        document.row("axes", names.join(", "));
        let held: Vec<String> = self
            .fixed()
            .map(|(axis, k)| format!("{} {} {}", axis.dof.name(), significant(axis.center(k)), unit(axis)))
            .collect();
        if !held.is_empty() {
            document.row("at", format!("{}, the middle of a cell", held.join(", ")));
        }
        let accepted = self.cells().filter(|cell| self.outcomes[*cell] == Outcome::Aligned).count();
        let measure: f64 = self.axes().map(GridAxis::step).product::<f64>() * accepted as f64;
        let counts = format!("{} of {} cells", grouped(accepted), grouped(self.len()));
        document.row("accepted", format!("{counts}, {}", significant(measure)));
        lines(&document, Style::default()).join("\n") + "\n"
    }
}

/// The number of the axis of an error.
fn number_of(grid: &Grid, dof: Dof) -> Result<usize, ViewError> {
    let known = grid.axes.iter().position(|axis| axis.dof == dof);
    let axes = || grid.axes.iter().map(|axis| axis.dof.name()).collect();
    known.ok_or_else(|| ViewError::NoAxis { dof, axes: axes() })
}

const fn unit(axis: &GridAxis) -> &'static str {
    if axis.dof.is_rotation() { "rad" } else { "D" }
}
