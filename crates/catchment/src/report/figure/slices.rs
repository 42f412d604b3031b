//! Outcomes over pairs of errors, all others fixed.

use super::draw::axis::Units;
use super::draw::svg::{Anchor, LABEL, Rect, SOFT, Svg, TITLE, width_of};
use super::map::{self, Map, pairs_or_all};
use super::{FigureError, Picture, cube, headline};
use crate::acceptance::Acceptance;
use crate::merit::MeritError;
use crate::pose::{Dof, PoseError};
use crate::report::Report;

/// Draws the outcomes over each pair of errors (all pairs if none is named), the others at the values of `at`, with the
/// border of the accepted set and the largest axis-oriented cube of the `report`, dashed where the slice misses it. A pair that one of
/// `finer` has for its only axes is drawn from that one: it must have been computed with the other errors zero.
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
    let (design, cube, story) = (&report.design, cube(report), headline(report));
    let units = Units::of(design);
    let columns = match pairs.len() {
        1 => 1,
        2 | 4 => 2,
        n if n > 6 => 5,
        _ => 3,
    };
    let side = match pairs.len() {
        1 => 400.0,
        2..=4 => 280.0,
        _ => 230.0,
    };
    let (left, top, cell) = (62.0, 92.0, [side + 76.0, side + 62.0]);
    let legend = map::legend_width(acceptance, !cube.is_empty());
    let rows = pairs.len().div_ceil(columns);
    let width =
        (left + columns as f64 * cell[0] - 50.0).max(legend + 48.0).max(width_of(&story, LABEL) + 48.0);
    let height = top + rows as f64 * cell[1] + 28.0;
    let indent = left + 0.5 * (width - left - 26.0 - (columns as f64 * cell[0] - 76.0)).max(0.0);
    let mut svg = Svg::new(width, height);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &design.name);
    svg.text([24.0, 49.0], LABEL, Anchor::Start, SOFT, &story);
    let mut subtitle = "area of acceptance".to_owned();
    if grid.axes.len() > 2 {
        let zero = *at == PoseError::default();
        subtitle += if zero { ", slices through zero" } else { ", slices" };
    }
    svg.text([24.0, 66.0], LABEL, Anchor::Start, SOFT, &subtitle);
    for (k, pair) in pairs.iter().enumerate() {
        let (column, row) = (k % columns, k / columns);
        let rect = Rect {
            x: if columns == 1 { indent } else { left } + column as f64 * cell[0],
            y: top + row as f64 * cell[1],
            w: side,
            h: side,
        };
        let own = |a: &&Acceptance| a.grid().is_some_and(|g| g.axes.iter().map(|a| a.dof).eq(*pair));
        let map = match finer.iter().find(own) {
            Some(slice) => Map::of(slice, *pair, at)?.within(acceptance, *pair)?,
            None => Map::of(acceptance, *pair, at)?,
        };
        let frame = map.frame(rect, &units);
        map::outcomes(&mut svg, &map, &frame, &units, cube)?;
        if *at != PoseError::default() {
            svg.text([rect.x + rect.w, rect.y - 6.0], LABEL - 1.5, Anchor::End, SOFT, &map.fixed(&units));
        }
    }
    map::legend(&mut svg, acceptance, !cube.is_empty(), [24.0, height - 20.0]);
    Ok(Picture::of(svg))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, report_of};
    use super::*;
    use crate::design::Design;
    use crate::pose::DofSet;
    use crate::report::schema::testing::{blob, design};

    fn drawn(
        design: &Design,
        acceptance: &Acceptance,
        pairs: &[[Dof; 2]],
        at: &PoseError,
    ) -> Result<Picture, FigureError> {
        slices(&report_of(design, acceptance), acceptance, &[], pairs, at)
    }

    #[test]
    fn one_pair_three_pairs_and_ten() {
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

    #[test]
    fn a_slice_elsewhere_says_where() {
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
        blob.outcomes[5] = crate::acceptance::Outcome::Undecided;
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
