//! The pictures of an answer.

use super::{FigureError, Picture, Placement};
use crate::acceptance::Acceptance;
use crate::contact::Pair;
use crate::exec::Exec;
use crate::landscape::Grid;
use crate::pose::{CorPose, PoseError};
use crate::report::folder::SaveError;
use crate::run::Answer;
use crate::study::planes;

/// How far the halves are drawn apart, in D, so that both faces can be seen.
const LIFT: f64 = 0.6;

/// What was drawn, by name, and what was left out, with the reason.
#[derive(Debug, Clone, Default)]
pub struct Drawn {
    /// Name, without ending, and picture.
    pub pictures: Vec<(&'static str, Picture)>,
    /// What was left out.
    pub left_out: Vec<String>,
}

impl Drawn {
    fn keep(&mut self, name: &'static str, picture: Result<Picture, FigureError>) -> Result<(), FigureError> {
        match picture {
            Ok(picture) => self.pictures.push((name, picture)),
            Err(FigureError::Empty { what }) => self.left_out.push(format!("no picture {name}: {what}")),
            Err(error) => return Err(error),
        }
        Ok(())
    }
}

impl Answer {
    /// Draws all that the answer has: maps need two free errors, and slices finer than the grid are followed exactly.
    ///
    /// # Errors
    /// A picture cannot be drawn, or it was asked to stop.
    pub fn draw(&self, exec: &Exec) -> Result<Drawn, SaveError> {
        super::memory::ensure_domain_fits(&self.acceptance.domain, exec)?;
        let mut drawn = Drawn::default();
        let (design, acceptance, report) = (self.problem.design(), &self.acceptance, self.report());
        let (connector, pair) = (self.problem.connector(), self.problem.pair());
        if let Some(grid) = self.grid()
            && let Some(main) = planes::main_pair(grid)
        {
            let finer = self.planes(grid, exec)?;
            let over = |slice: &&Acceptance| {
                slice.grid().is_some_and(|grid| grid.axes.iter().map(|axis| axis.dof).eq(main))
            };
            let map = finer.iter().find(over).unwrap_or(acceptance);
            let map_grid = map.grid().unwrap_or(grid);
            let landscape = self.by_products.landscape.as_ref().filter(|l| l.grid == *map_grid);
            let height = |cell: usize| match landscape {
                Some(landscape) => f64::from(landscape.heights[cell]),
                None => height_of(pair, &map_grid.pose(cell)),
            };
            let zero = PoseError::default();
            drawn.keep("overview", super::overview(&report, connector, acceptance, map, &height, main))?;
            drawn.keep("slices", super::slices(&report, acceptance, &finer, &[], &zero))?;
            drawn.keep("heights", super::heights(&report, map, &height, main, &zero))?;
            if let (Some(watersheds), true) = (&self.by_products.watersheds, *map_grid == *grid) {
                let stages = super::watersheds(&report, connector, acceptance, watersheds, &height, main);
                drawn.keep("watersheds", stages)?;
            }
        }
        if let Some(basins) = &self.by_products.basins {
            drawn.keep("basins", super::basins(&report, acceptance, basins))?;
        }
        if let Some(partition) = &self.by_products.partition {
            drawn.keep("partition", super::partition(&report, partition, acceptance))?;
        }
        if let Some(found) = &report.jams {
            drawn.keep("jams", super::jams(design, found, connector))?;
        }
        exec.check()?;
        let lifted = Placement::mated(design, LIFT);
        drawn.keep("section", super::section(design, connector, &lifted))?;
        drawn.keep("solids", super::solids(design, connector, &lifted))?;
        exec.check()?;
        Ok(drawn)
    }

    /// Planes through zero by exact motions; none where the method's own cells are to be shown (flooding and drop tests show themselves).
    fn planes(&self, grid: &Grid, exec: &Exec) -> Result<Vec<Acceptance>, SaveError> {
        let method = &self.run.method;
        if method.info().departs {
            return Ok(Vec::new());
        }
        Ok(planes::through_zero(self.problem.pair(), &method.motions(), grid, exec)?)
    }
}

/// z of the COR at first contact, in D; −∞ without contact.
fn height_of(pair: &Pair, error: &PoseError) -> f64 {
    let pose = CorPose::from_error(error, pair.alignment.center_of_rotation, pair.alignment.free);
    pair.height(&pose).unwrap_or(f64::NEG_INFINITY)
}
