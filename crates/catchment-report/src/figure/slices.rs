//! Outcomes over pairs of errors, with all others fixed.

use super::draw::axis::{ShownUnits, short};
use super::draw::layout::{Layout, Legend, Panel};
use super::map::{self, CUBE, Map, pairs_or_all};
use super::{FigureError, Picture, cube, headline};
use crate::Report;
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::merit::MeritError;
use catchment_core::pose::{Dof, PoseError};

/// Draws the outcomes over each pair of errors (all pairs if none is given), the others at the values of
/// `at`, with the border of the accepted set and the largest axis-oriented cube of the `report`, dashed if
/// the slice misses it. Shares are those of the cells of a slice; the headline has those of the error box. A
/// pair that is the axes of an entry of `finer` is drawn from that entry: it must have been computed with the
/// other errors zero.
///
/// # Errors
/// Fewer than two free errors, a pair that the grid does not have, listed poses instead of a grid.
pub fn slices(
    report: &Report,
    acceptance: &Acceptance,
    finer: &[Acceptance],
    pairs: &[[Dof; 2]],
    at: &PoseError,
) -> Result<Picture, FigureError> {
    let grid = acceptance.grid().ok_or(MeritError::NotAGrid)?;
    let pairs = pairs_or_all(grid, pairs)?;
    let own = |pair: &[Dof; 2]| {
        finer.iter().find(|a| a.grid().is_some_and(|g| g.axes.iter().map(|a| a.dof).eq(*pair)))
    };
    let drawn = |pair: &[Dof; 2]| match own(pair) {
        Some(slice) => Map::of(slice, *pair, at)?.within(acceptance, *pair),
        None => Map::of(acceptance, *pair, at),
    };
    let maps = pairs.iter().map(drawn).collect::<Result<Vec<Map>, FigureError>>()?;
    let cube = cube(report);
    let units = ShownUnits::of(&report.design);
    let (columns, side) = match maps.len() {
        1 => (1, 400.0),
        2 | 4 => (2, 280.0),
        3 => (3, 280.0),
        n if n > 6 => (5, 230.0),
        _ => (3, 230.0),
    };
    let (is_sliced, is_central) = (grid.axes.len() > 2, maps.iter().all(Map::is_central));
    let subtitle = match (is_sliced, is_central) {
        (false, _) => "area of acceptance",
        (true, true) => "area of acceptance, slices through zero",
        (true, false) => "area of acceptance, slices",
    };
    let legend = match &maps[..] {
        [map] => map::legend(map, !cube.is_empty()),
        _ => map::outcome_squares(
            Legend::default(),
            |outcome| maps.iter().any(|map| map.outcomes.contains(&outcome)),
            |outcome| outcome.word().to_owned(),
            (!cube.is_empty()).then_some(CUBE),
        ),
    };
    let panel = |map: &Map| {
        let mut panel = Panel::with_axes([side; 2]);
        if !is_central {
            panel = panel.over(map.fixed(&units));
        }
        if maps.len() > 1 {
            let share = short(100.0 * map.share(Outcome::Aligned));
            panel = panel.over(format!("{} {share} % of this slice", Outcome::Aligned.word()));
        }
        panel
    };
    let layout = Layout::of(&report.design).story(headline(report)).story(subtitle).legend(legend);
    let (mut svg, frames) = layout.grid(columns, maps.iter().map(panel)).open();
    for (map, rect) in maps.iter().zip(frames) {
        map::outcomes(&mut svg, map, &map.frame(rect, &units), &units, cube)?;
    }
    Ok(Picture::of(svg))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, report_of};
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::design::Design;
    use catchment_core::pose::DofSet;

    fn drawn(
        design: &Design,
        acceptance: &Acceptance,
        pairs: &[[Dof; 2]],
        at: &PoseError,
    ) -> Result<Picture, FigureError> {
        slices(&report_of(design, acceptance), acceptance, &[], pairs, at)
    }

    #[test]
    fn every_pair_of_errors_has_a_map() {
        for (name, free, cells) in [
            ("slices-2", [Dof::X, Dof::Pitch].into_iter().collect(), 100),
            ("slices-3", [Dof::X, Dof::Y, Dof::Yaw].into_iter().collect(), 40),
            ("slices-5", DofSet::ALL, 12),
        ] {
            let design = design(free);
            let picture = drawn(&design, &blob(&design, cells), &[], &PoseError::default()).unwrap();
            look(name, &picture);
            let pairs = free.len() * (free.len() - 1) / 2;
            assert_eq!(picture.svg().matches("<image").count(), pairs);
            assert!(picture.svg().contains("x [mm]"));
        }
    }

    /// The shares of the whole grid stood under a slice. A ball of radius 0.5 in a cube of side 2 has π/48 of it, and π/16 of its slices.
    #[test]
    fn shares_are_those_of_their_slice() {
        let design = design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect());
        let mut ball = blob(&design, 21);
        let grid = ball.grid().unwrap().clone();
        for (cell, outcome) in ball.outcomes.iter_mut().enumerate() {
            let pose = grid.pose(cell);
            let yaw = pose.yaw / design.alignment.half_range(Dof::Yaw);
            let x = pose.x / design.alignment.half_range(Dof::X);
            let y = pose.y / design.alignment.half_range(Dof::Y);
            let inside = x * x + y * y + yaw * yaw < 0.25;
            *outcome = if inside { Outcome::Aligned } else { Outcome::Missed };
        }
        let zero = PoseError::default();
        let slice = Map::of(&ball, [Dof::X, Dof::Y], &zero).unwrap();
        let of_slice = short(100.0 * slice.share(Outcome::Aligned));
        let of_grid = short(100.0 * ball.counts()[0] as f64 / ball.outcomes.len() as f64);
        assert_ne!(of_slice, of_grid);
        let all = drawn(&design, &ball, &[], &zero).unwrap();
        assert_eq!(all.svg().matches(&format!("docked {of_slice} % of this slice")).count(), 3);
        let one = drawn(&design, &ball, &[[Dof::X, Dof::Y]], &zero).unwrap();
        assert!(one.svg().contains("of this slice:") && one.svg().contains(&format!("docked {of_slice} %<")));
        assert!(!all.svg().contains(&format!("aligned {of_grid} %")));
        assert!(!one.svg().contains(&format!("aligned {of_grid} %")));
    }

    /// The middle cells of an even grid are centred half a cell beside zero.
    #[test]
    fn an_even_grid_has_no_slice_through_zero() {
        let design = design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect());
        let of = |cells: usize| drawn(&design, &blob(&design, cells), &[], &PoseError::default()).unwrap();
        assert!(of(11).svg().contains("slices through zero") && !of(10).svg().contains("through zero"));
        assert!(of(10).svg().contains("yaw = "));
    }

    #[test]
    fn a_slice_off_zero_names_its_position() {
        let design = design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect());
        let at = PoseError { yaw: 0.5, ..PoseError::default() };
        let picture = drawn(&design, &blob(&design, 10), &[[Dof::X, Dof::Y]], &at).unwrap();
        assert!(picture.svg().contains("yaw = 27°"), "the cell of 0.5 rad is centred at 27°");
    }

    #[test]
    fn a_design_without_a_unit_is_shown_in_d() {
        let mut design = design([Dof::X, Dof::Y].into_iter().collect());
        (design.unit, design.width) = (None, 1.0);
        let mut blob = blob(&design, 31);
        blob.outcomes[5] = catchment_core::acceptance::Outcome::Undecided;
        let picture = drawn(&design, &blob, &[], &PoseError::default()).unwrap();
        look("slices-dimensionless", &picture);
        assert!(picture.svg().contains("x [D]") && picture.svg().contains("undecided 0.1 %"));
    }

    #[test]
    fn one_error_has_no_map() {
        let design = design([Dof::X].into_iter().collect());
        let error = drawn(&design, &blob(&design, 10), &[], &PoseError::default()).unwrap_err();
        assert!(matches!(error, FigureError::Empty { .. }));
    }
}
