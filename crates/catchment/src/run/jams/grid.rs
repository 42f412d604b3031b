//! Depths by the merge tree of a grid: how high water must stand above a rest to run over into any other basin.
//!
//! Passes go from centre to centre of neighbouring cells, so that such a depth is a bound from neither side: it comes near as the grid becomes finer, and sees every way,
//! also bent ones.

use crate::exec::Exec;
use crate::landscape::{Landscape, Resolution, ResolutionError};
use crate::method::flood::{self, FloodError, flood};
use crate::pose::PoseError;
use crate::problem::Problem;

/// Why a grid says no depths.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DepthError {
    /// The grid is none.
    #[error(transparent)]
    Resolution(#[from] ResolutionError),
    /// The grid has no merge tree.
    #[error(transparent)]
    Flood(#[from] FloodError),
}

/// Depths of rests at pose errors and heights of the centre of rotation, in D; none outside of the box, in the only basin, and where a cell's basin was merged into that of
/// cells without contact.
pub(in crate::run) fn depths(
    problem: &Problem,
    resolution: &Resolution,
    rests: &[(PoseError, f64)],
    exec: &Exec,
) -> Result<Vec<Option<f64>>, DepthError> {
    let (pair, alignment) = (problem.pair(), problem.alignment());
    let grid = resolution.grid(alignment, &Resolution::DEFAULT_CELLS)?;
    let landscape = Landscape::compute(pair, &grid, exec).map_err(FloodError::from)?;
    let docks = flood::docks(pair, &grid);
    let flooding = flood(&landscape, alignment, &docks, &flood::Settings::default(), exec)?;
    let of = |(error, height): &(PoseError, f64)| {
        let values = error.to_array();
        let cell: Option<Vec<usize>> =
            grid.axes.iter().map(|axis| axis.cell_of(values[axis.dof.index()])).collect();
        let basin = flooding.watersheds.merged(grid.index(&cell?))?;
        let own = flooding
            .hierarchy
            .basins
            .iter()
            .filter(|own| own.height.is_finite())
            .find(|own| flooding.watersheds.merged(own.minimum) == Some(basin))?;
        own.escape.is_finite().then(|| (own.height + own.escape - height).max(0.0))
    };
    Ok(rests.iter().map(of).collect())
}
