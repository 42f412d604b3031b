//! Further bounds on escape heights: from the merge tree of a grid, and certified lower bounds from boxes of
//! poses.
//!
//! On a grid: the height that water must rise above a rest to overflow into any other basin. Passes connect
//! centres of neighbouring cells, so this value is neither an upper nor a lower bound: it improves as the
//! grid is refined, and includes all paths, also curved ones. By boxes ([`crate::method::certified`]): a
//! bound that holds for all paths.

use super::RestGroup;
use crate::exec::Exec;
use crate::landscape::{Landscape, Resolution, ResolutionError};
use crate::method::certified::{self, CertifiedError};
use crate::method::flood::{self, FloodError, flood};
use crate::pose::PoseError;
use crate::problem::Problem;

/// Reason why no escape heights are available.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DepthError {
    /// The resolution is invalid.
    #[error(transparent)]
    Resolution(#[from] ResolutionError),
    /// The grid has no merge tree.
    #[error(transparent)]
    Flood(#[from] FloodError),
    /// Nothing can be certified.
    #[error(transparent)]
    Certified(#[from] CertifiedError),
    /// Certified bounds do not support friction.
    #[error("what is certain of depths is so without friction alone: leave out one of the two")]
    Friction,
}

/// Whether depths can be certified, before anything takes time.
pub(in crate::run) fn check(problem: &Problem, certified: bool, friction: f64) -> Result<(), DepthError> {
    match certified {
        true if friction > 0.0 => Err(DepthError::Friction),
        true => Ok(certified::applies(problem.pair())?),
        false => Ok(()),
    }
}

/// Sets the requested escape heights of rests: of all rests by a grid, and lower bounds for the examined
/// rests.
pub(in crate::run) fn report(
    problem: &Problem,
    mut places: Vec<&mut RestGroup>,
    resolution: Option<&Resolution>,
    certified: bool,
    exec: &Exec,
) -> Result<(), DepthError> {
    if let Some(resolution) = resolution {
        let depths = on_grid(problem, resolution, &at(&places), exec)?;
        places.iter_mut().zip(depths).for_each(|(place, depth)| place.depth_on_grid = depth);
    }
    if certified {
        places.retain(|place| place.examined.is_some());
        let depths = certified::depths(problem.pair(), &at(&places), exec)?;
        places.iter_mut().zip(depths).for_each(|(place, depth)| place.depth_at_least = depth);
    }
    Ok(())
}

/// Pose errors and heights of rests.
fn at(places: &[&mut RestGroup]) -> Vec<(PoseError, f64)> {
    places.iter().map(|place| (place.pose, place.height)).collect()
}

/// Escape heights of rests at pose errors and heights of the centre of rotation, in D; `None` outside of the
/// box, in a single basin, and if a cell's basin was merged into that of cells without contact.
fn on_grid(
    problem: &Problem,
    resolution: &Resolution,
    rests: &[(PoseError, f64)],
    exec: &Exec,
) -> Result<Vec<Option<f64>>, DepthError> {
    let (pair, alignment) = (problem.pair(), problem.alignment());
    let grid = resolution.grid(alignment, &Resolution::DEFAULT_CELLS)?;
    let landscape = Landscape::compute(pair, &grid, exec).map_err(FloodError::from)?;
    let docks = flood::docks(pair, &grid);
    let flooding = flood(&landscape, alignment, &docks, &flood::FloodSettings::default(), exec)?;
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
