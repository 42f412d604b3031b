//! The pictures of an answer.

use super::{FigureError, MovingHalfPose, Picture};
use crate::Report;
use crate::folder::SaveError;
use catchment_core::contact::Pair;
use catchment_core::exec::Exec;
use catchment_core::pose::{CorPose, PoseError};
use catchment_core::run::Answer;
use catchment_study::planes;

/// Distance at which the halves are drawn apart, in D, so that both faces are visible.
const LIFT: f64 = 0.6;

/// The pictures drawn, by name, and the omitted ones, with the reason.
#[derive(Debug, Clone, Default)]
pub struct DrawnFigures {
    /// Name, without ending, and picture.
    pub pictures: Vec<(&'static str, Picture)>,
    /// The omitted pictures.
    pub left_out: Vec<String>,
}

impl DrawnFigures {
    /// Draws all parts of the result: maps need two free errors, and slices finer than the grid are followed
    /// exactly.
    ///
    /// # Errors
    /// A picture cannot be drawn, or the computation is cancelled.
    pub fn of(answer: &Answer, exec: &Exec) -> Result<Self, SaveError> {
        super::memory::ensure_domain_fits(&answer.acceptance.domain, exec)?;
        let mut drawn = Self::default();
        let (design, acceptance, report) =
            (answer.problem.design(), &answer.acceptance, Report::of_answer(answer));
        let (connector, pair) = (answer.problem.connector(), answer.problem.pair());
        if let Some(grid) = answer.grid()
            && let Some(main) = planes::main_pair(grid)
        {
            let departs = answer.run.method.info().departs;
            let motions = answer.run.method.motions();
            // Flooding and drop tests show their own cells.
            let (finest, finer) = if departs {
                (None, Vec::new())
            } else {
                let finest = planes::main_through_zero(pair, &motions, grid, exec)?;
                (finest, planes::through_zero(pair, &motions, grid, exec)?)
            };
            let map = finest.as_ref().unwrap_or(acceptance);
            let map_grid = map.grid().unwrap_or(grid);
            let landscape = answer.by_products.landscape.as_ref().filter(|l| l.grid == *map_grid);
            let height = |cell: usize| match landscape {
                Some(landscape) => f64::from(landscape.heights[cell]),
                None => height_of(pair, &map_grid.pose(cell)),
            };
            let zero = PoseError::default();
            drawn.keep("overview", super::overview(&report, connector, acceptance, map, &height, main))?;
            drawn.keep("slices", super::slices(&report, acceptance, &finer, &[], &zero))?;
            drawn.keep("heights", super::heights(&report, map, &height, main, &zero))?;
            if let (Some(watersheds), true) = (&answer.by_products.watersheds, *map_grid == *grid) {
                let stages = super::watersheds(&report, connector, acceptance, watersheds, &height, main);
                drawn.keep("watersheds", stages)?;
            }
        }
        if answer.grid().is_none() {
            drawn.keep("sampled", super::sampled(&report, acceptance))?;
        }
        if let Some(basins) = &answer.by_products.basins {
            drawn.keep("basins", super::basins(&report, acceptance, basins))?;
        }
        if let Some(partition) = &answer.by_products.partition {
            drawn.keep("partition", super::partition(&report, partition, acceptance))?;
        }
        if let Some(result) = &report.jams {
            drawn.keep("jams", super::jams(design, result, connector))?;
        }
        exec.check()?;
        let lifted = MovingHalfPose::mated(design, LIFT);
        drawn.keep("section", super::section(design, connector, &lifted))?;
        drawn.keep("solids", super::solids(design, connector, &lifted))?;
        exec.check()?;
        Ok(drawn)
    }

    fn keep(&mut self, name: &'static str, picture: Result<Picture, FigureError>) -> Result<(), FigureError> {
        match picture {
            Ok(picture) => self.pictures.push((name, picture)),
            Err(FigureError::Empty { what }) => self.left_out.push(format!("no picture {name}: {what}")),
            Err(error) => return Err(error),
        }
        Ok(())
    }
}

/// z of the COR at first contact, in D; −∞ without contact.
fn height_of(pair: &Pair, error: &PoseError) -> f64 {
    let pose = CorPose::from_error(error, pair.alignment.center_of_rotation, pair.alignment.free);
    pair.height(&pose).unwrap_or(f64::NEG_INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::testing::design;
    use base64::Engine;
    use base64::engine::general_purpose::STANDARD;
    use catchment_core::pose::Dof;
    use catchment_core::problem::Problem;
    use catchment_core::run::{Over, Run, Sample};

    /// A slice had 71 cells a side, its neighbours 25.
    #[test]
    fn slices_have_one_resolution() {
        let problem = Problem::of(design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect())).unwrap();
        let run = Run { over: Over::Grid("6".parse().unwrap()), sample: Sample::None, ..Run::default() };
        let drawn = DrawnFigures::of(&run.on(&problem, &Exec::new()).unwrap(), &Exec::new()).unwrap();
        let (_, picture) = drawn.pictures.iter().find(|(name, _)| *name == "slices").unwrap();
        let document = resvg::usvg::roxmltree::Document::parse(picture.svg()).unwrap();
        let sizes: Vec<(u32, u32)> = document
            .descendants()
            .filter_map(|node| node.attribute("href")?.strip_prefix("data:image/png;base64,"))
            .map(|data| {
                let bytes = std::io::Cursor::new(STANDARD.decode(data).unwrap());
                let reader = png::Decoder::new(bytes).read_info().unwrap();
                (reader.info().width, reader.info().height)
            })
            .collect();
        assert_eq!(sizes, [(41, 41); 3]);
    }
}
