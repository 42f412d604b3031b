//! The overview of a design: its halves, its area of acceptance, its heights, side by side.

use super::draw::axis::ShownUnits;
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TITLE};
use super::map::{self, Legend, Map};
use super::section::MovingHalfPose;
use super::{FigureError, Picture, cube, headline, heights, solid};
use crate::Report;
use catchment_core::acceptance::Acceptance;
use catchment_core::connector::Connector;
use catchment_core::pose::{Dof, PoseError};

/// Distance between maps, in SVG units.
const BETWEEN: f64 = 370.0;

/// Draws an overview over a pair of errors, the others zero. The numbers are those of the `report`; the shares of the
/// outcomes those of the map. The maps show `slice`, which may be the same, or a finer grid over the pair
/// alone. `height` as in [`super::heights()`], for a cell of `slice`.
///
/// # Errors
/// Those of its parts.
pub fn overview(
    report: &Report,
    connector: &Connector,
    acceptance: &Acceptance,
    slice: &Acceptance,
    height: &dyn Fn(usize) -> f64,
    pair: [Dof; 2],
) -> Result<Picture, FigureError> {
    let design = &report.design;
    let units = ShownUnits::of(design);
    let map = Map::of(slice, pair, &PoseError::default())?.within(acceptance, pair)?;
    let cube = cube(report);
    let (side, top) = (300.0, 96.0);
    let (total_width, total_height) = (1130.0, top + side + 84.0);
    let mut svg = Svg::new(total_width, total_height);
    svg.bold([24.0, 32.0], TITLE + 2.0, Anchor::Start, &design.name);
    svg.text([24.0, 53.0], LABEL, Anchor::Start, SOFT, &headline(report));

    let heading =
        |svg: &mut Svg, x: f64, words: &str| svg.text([x, top - 12.0], LABEL, Anchor::Start, INK, words);
    let error = PoseError { x: 0.2, pitch: 0.2, ..PoseError::default() };
    let only_free = |dof: Dof, value: f64| if design.alignment.free.contains(dof) { value } else { 0.0 };
    let error =
        PoseError { x: only_free(Dof::X, error.x), pitch: only_free(Dof::Pitch, error.pitch), ..error };
    let apart = MovingHalfPose { error, height: 0.9 - design.alignment.center_of_rotation };
    heading(&mut svg, 24.0, "the two halves");
    let picture = Rect { x: 14.0, y: top, w: side + 10.0, h: side + 30.0 };
    solid::panel(&mut svg, picture, design, connector, &apart)?;

    let middle = Rect { x: 392.0, y: top, w: side, h: side };
    heading(&mut svg, middle.x, &map.heading("area of acceptance", &units, BETWEEN));
    map::outcomes(&mut svg, &map, &map.frame(middle, &units), &units, cube)?;
    Legend::of(&map, !cube.is_empty()).draw(&mut svg, [middle.x, total_height - 22.0]);

    let right = Rect { x: middle.x + BETWEEN, y: top, w: side, h: side };
    heading(&mut svg, right.x, "height of first contact");
    heights::panel(&mut svg, &map, right, &units, height)?;
    Ok(Picture::of(svg))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{corrected, look, pyramid, report_of};
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::acceptance::Outcome;
    use catchment_core::pose::DofSet;

    #[test]
    fn it_shows_halves_acceptance_and_heights() {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let acceptance = blob(&design, 80);
        let grid = acceptance.grid().unwrap();
        let height = |i: usize| {
            let e = grid.pose(i);
            0.5 * e.x.abs() + 0.3 * (e.pitch + 0.4 * e.x).abs()
        };
        let report = report_of(&design, &acceptance);
        let drawn = || {
            let pair = [Dof::X, Dof::Pitch];
            overview(&report, &pyramid(), &acceptance, &acceptance, &height, pair).unwrap()
        };
        let picture = drawn();
        look("overview", &picture);
        assert!(picture.svg().contains("Sum "));
        assert_eq!(picture, drawn());
    }

    /// A grid too coarse for any accepted cell, and samples with the correct Sum.
    #[test]
    fn five_errors_have_the_corrected_sum_of_their_report() {
        let design = design(DofSet::ALL);
        let mut coarse = blob(&design, 4);
        coarse.outcomes.fill(Outcome::Jammed);
        let report = corrected(report_of(&design, &coarse), 10.5, [6.6, 14.4]);
        let pair = [Dof::X, Dof::Pitch];
        let picture = overview(&report, &pyramid(), &coarse, &coarse, &|_| 0.2, pair).unwrap();
        look("overview-5", &picture);
        let told = "Sum 10.5 ± 3.9 D²·rad³  ·  12.50 % of the error box  ·  ONAA edge 0.0000  ·  by flood";
        assert!(picture.svg().contains(told), "{}", picture.svg());
        assert!(picture.svg().contains("of this slice:") && picture.svg().contains("jammed 100 %"));
        assert!(picture.svg().contains("slice beside zero"));
        assert!(report.table().contains("AA (Sum)       10.5 D²·rad³ (95 % CI 6.6 … 14.4)\n"));
    }
}
