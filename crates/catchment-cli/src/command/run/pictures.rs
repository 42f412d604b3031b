//! The pictures of a run.

use super::compute::{Computed, Job, descend};
use crate::failure::Failure;
use catchment::acceptance::{Acceptance, Domain};
use catchment::connector::Connector;
use catchment::contact::Pair;
use catchment::exec::Exec;
use catchment::landscape::{Grid, GridAxis};
use catchment::merit::slice;
use catchment::method::Method;
use catchment::pose::{CorPose, Dof, PoseError};
use catchment::report::Report;
use catchment::report::figure::{self, FigureError, Picture, Placement};

/// Names of all pictures there can be, without ending.
pub(super) const NAMES: [&str; 7] =
    ["overview", "slices", "heights", "basins", "partition", "section", "solids"];

/// Cells per axis of the slice in the overview, and of the many in the slices, where the method decides each cell
/// by itself and the grid is coarser.
const OVERVIEW_CELLS: usize = 71;
const SLICE_CELLS: usize = 25;

/// What was drawn, by name, and what was left out, with the reason.
pub(super) type Drawn = (Vec<(&'static str, Picture)>, Vec<String>);

/// Draws all that the job has: maps need two free errors.
pub(super) fn draw(
    job: &Job,
    connector: &Connector,
    computed: &Computed,
    report: &Report,
    exec: &Exec,
) -> Result<Drawn, Failure> {
    let mut drawn = Vec::new();
    let mut left_out = Vec::new();
    let mut keep = |name: &'static str, picture: Result<Picture, FigureError>| match picture {
        Ok(picture) => {
            drawn.push((name, picture));
            Ok(())
        }
        Err(FigureError::Empty { what }) => {
            left_out.push(format!("no picture {name}: {what}"));
            Ok(())
        }
        Err(error) => Err(Failure::from(error)),
    };
    let (design, acceptance) = (job.design, &computed.acceptance);
    if let Some(pair) = main_pair(&job.grid) {
        let finer = finer_slices(job, pair, exec)?;
        let own =
            finer.iter().find(|slice| slice.grid().is_some_and(|g| g.axes.iter().map(|a| a.dof).eq(pair)));
        let map = own.unwrap_or(acceptance);
        let Some(grid) = map.grid() else { return Ok((drawn, left_out)) };
        let landscape = computed.landscape.as_ref().filter(|landscape| landscape.grid == *grid);
        let height = |cell: usize| match landscape {
            Some(landscape) => f64::from(landscape.heights[cell]),
            None => height_of(job.pair, &grid.pose(cell)),
        };
        let zero = PoseError::default();
        keep("overview", figure::overview(report, connector, acceptance, map, &height, pair))?;
        keep("slices", figure::slices(report, acceptance, &finer, &[], &zero))?;
        keep("heights", figure::heights(report, map, &height, pair, &zero))?;
    }
    if let Some(basins) = &computed.basins {
        keep("basins", figure::basins(report, acceptance, basins))?;
    }
    if let Some(partition) = &computed.partition {
        keep("partition", figure::partition(report, partition, acceptance))?;
    }
    exec.check()?;
    let lifted = Placement::mated(design, LIFT);
    keep("section", figure::section(design, connector, &lifted))?;
    keep("solids", figure::solids(design, connector, &lifted))?;
    exec.check()?;
    Ok((drawn, left_out))
}

/// z of the COR at first contact, in D; −∞ without contact.
fn height_of(pair: &Pair, error: &PoseError) -> f64 {
    let pose = CorPose::from_error(error, pair.alignment.center_of_rotation, pair.alignment.free);
    pair.height(&pose).unwrap_or(f64::NEG_INFINITY)
}

/// How far the halves are drawn apart, in D, so that both faces can be seen.
const LIFT: f64 = 0.6;

/// The two errors to show where only two can be: x with the rotation that goes with it.
fn main_pair(grid: &Grid) -> Option<[Dof; 2]> {
    let pairs = slice::pairs(grid);
    let favourites = [[Dof::X, Dof::Pitch], [Dof::X, Dof::Yaw]];
    favourites.into_iter().find(|pair| pairs.contains(pair)).or_else(|| pairs.first().copied())
}

/// Slices through zero, finer than the grid, each pose followed exactly: where neither flooding nor drop tests were asked for, and some other error is free.
fn finer_slices(job: &Job, main: [Dof; 2], exec: &Exec) -> Result<Vec<Acceptance>, Failure> {
    if job.method.rule().is_some() || job.method == Method::Drop || job.grid.axes.len() < 3 {
        return Ok(Vec::new());
    }
    // Where descents are dear, so are their slices.
    let affordable = Method::Descent.default_cells(job.pair)[1];
    let mut slices = Vec::new();
    for pair in slice::pairs(&job.grid) {
        let least = if pair == main { OVERVIEW_CELLS } else { SLICE_CELLS };
        let finer = |axis: &GridAxis| GridAxis { cells: axis.cells.max(least.min(affordable)), ..*axis };
        let axes = job.grid.axes.iter().filter(|a| pair.contains(&a.dof)).map(finer).collect();
        slices.push(descend(job.pair, Domain::Grid(Grid { axes }), exec)?);
    }
    Ok(slices)
}
