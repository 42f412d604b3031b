//! The overview of a design: its halves, its area of acceptance, its heights, side by side.

use super::draw::axis::ShownUnits;
use super::draw::layout::{Layout, Panel};
use super::map::{self, Map};
use super::section::MovingHalfPose;
use super::{FigureError, Picture, cube, headline, heights, solid};
use crate::Report;
use catchment_core::acceptance::Acceptance;
use catchment_core::connector::Connector;
use catchment_core::pose::{Dof, PoseError};

/// Side of a map, and size of the halves in space, in SVG units.
const SIDE: f64 = 300.0;
const HALVES: [f64; 2] = [SIDE + 10.0, SIDE + 30.0];

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
    let shift = |dof: Dof| if design.alignment.free.contains(dof) { 0.2 } else { 0.0 };
    let error = PoseError { x: shift(Dof::X), pitch: shift(Dof::Pitch), ..PoseError::default() };
    let apart = MovingHalfPose { error, height: 0.9 - design.alignment.center_of_rotation };
    let (mut svg, frames) = Layout::of(design)
        .story(headline(report))
        .legend(map::legend(&map, !cube.is_empty()))
        .row([
            Panel::of(HALVES).over("the two halves"),
            Panel::with_axes([SIDE; 2]).over(map.heading("area of acceptance", &units, SIDE)),
            Panel::with_axes([SIDE; 2]).with_bar().over("height of first contact"),
        ])
        .open();
    solid::panel(&mut svg, frames[0], design, connector, &apart)?;
    map::outcomes(&mut svg, &map, &map.frame(frames[1], &units), &units, cube)?;
    heights::panel(&mut svg, &map, frames[2], &units, height)?;
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
        let text = "Sum 10.5 ± 3.9 D²·rad³  ·  12.50 % of the error box  ·  ONAA edge 0.0000  ·  by flood";
        assert!(picture.svg().contains(text), "{}", picture.svg());
        assert!(picture.svg().contains("of this slice:") && picture.svg().contains("jammed 100 %"));
        assert!(picture.svg().contains("slice beside zero"));
        assert!(report.table().contains("AA (Sum)       10.5 D²·rad³ (95 % CI 6.6 … 14.4)\n"));
    }
}
