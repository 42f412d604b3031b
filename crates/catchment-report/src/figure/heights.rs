//! The height of first contact over two errors, with contours and the border of the accepted set.

use super::draw::axis::{PlotFrame, ShownUnits};
use super::draw::colour::{self, Rgb};
use super::draw::layout::{Layout, Legend, Panel};
use super::draw::svg::{Rect, Svg};
use super::map::{self, Map};
use super::{FigureError, Picture, headline};
use crate::Report;
use catchment_core::acceptance::Acceptance;
use catchment_core::pose::{Dof, PoseError};

/// The style of the border, dark on light.
const BORDER: [&str; 2] = [
    r##"fill="none" stroke="#ffffff" stroke-width="4" stroke-linecap="round" stroke-linejoin="round""##,
    r##"fill="none" stroke="#000000" stroke-width="1.8" stroke-linecap="round" stroke-linejoin="round""##,
];

/// Draws the heights over a pair of errors, the others at the values of `at`, below the numbers of the
/// `report`; `acceptance` has the border, over the grid of the run or a finer grid of the pair alone.
/// `height` returns z of the COR at first contact, in D, for a cell of the grid; not finite if the halves
/// pass each other by.
///
/// # Errors
/// A pair that the grid does not have, listed poses instead of a grid, no contact anywhere in the slice.
pub fn heights(
    report: &Report,
    acceptance: &Acceptance,
    height: &dyn Fn(usize) -> f64,
    pair: [Dof; 2],
    at: &PoseError,
) -> Result<Picture, FigureError> {
    let units = ShownUnits::of(&report.design);
    let map = Map::of(acceptance, pair, at)?;
    let fixed = map.fixed(&units);
    let place = if fixed.is_empty() { String::new() } else { format!(" at {fixed}") };
    let (mut svg, frames) = Layout::of(&report.design)
        .story(headline(report))
        .story(format!("height of first contact{place}"))
        .row([Panel::with_axes([400.0; 2]).with_bar()])
        .legend(Legend::default().line(BORDER[1], "border of the accepted set"))
        .open();
    panel(&mut svg, &map, frames[0], &units, height)?;
    Ok(Picture::of(svg))
}

/// The map itself with its colour bar.
pub(super) fn panel(
    svg: &mut Svg,
    map: &Map,
    rect: Rect,
    units: &ShownUnits,
    height: &dyn Fn(usize) -> f64,
) -> Result<(), FigureError> {
    let field: Vec<f64> = map.slice.cells.iter().map(|i| height(*i) * units.lengths()).collect();
    let finite = || field.iter().copied().filter(|h| h.is_finite());
    let (lo, hi) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), h| (lo.min(h), hi.max(h)));
    if lo > hi {
        return Err(FigureError::Empty { what: "the halves touch nowhere in this slice" });
    }
    let span = (hi - lo).max(1e-9 * units.lengths());
    let paint = |h: &f64| -> Rgb {
        if h.is_finite() { colour::sequential((h - lo) / span) } else { colour::NOTHING }
    };
    let colours: Vec<Rgb> = field.iter().map(paint).collect();
    let frame: PlotFrame = map.frame(rect, units);
    map.paint(svg, &frame, &colours)?;
    let shape = [map.slice.axes[0].cells, map.slice.axes[1].cells];
    let scale = units.length("z", lo / units.lengths(), (lo + span) / units.lengths());
    svg.begin_clip(rect);
    for level in scale.ticks(14) {
        let style = r##"fill="none" stroke="#ffffff" stroke-opacity="0.55" stroke-width="0.8""##;
        svg.path(&map::contour(&frame, shape, &field, level), style);
    }
    let border = map.border(&frame);
    for style in BORDER {
        svg.path(&border, style);
    }
    svg.end();
    frame.draw(svg);
    map::colour_bar(svg, &frame, scale)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, report_of};
    use super::*;
    use crate::schema::testing::{blob, design};

    /// A bowl with a second dip beside it, and no contact in a corner.
    pub(crate) fn bowl(x: f64, pitch: f64) -> f64 {
        if x + pitch > 2.0 {
            return f64::NEG_INFINITY;
        }
        (0.5 * x.abs() + 0.3 * (pitch + 0.4 * x).abs()).min(0.25 + (x - 0.8).hypot(pitch - 1.0))
    }

    #[test]
    fn a_bowl_has_contours_and_a_border() {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let acceptance = blob(&design, 100);
        let grid = acceptance.grid().unwrap();
        let height = |i: usize| bowl(grid.pose(i).x, grid.pose(i).pitch);
        let pair = [Dof::X, Dof::Pitch];
        let report = report_of(&design, &acceptance);
        let picture = heights(&report, &acceptance, &height, pair, &PoseError::default()).unwrap();
        look("heights", &picture);
        assert!(picture.svg().contains("z [mm]"));
        let nothing = heights(&report, &acceptance, &|_| f64::NEG_INFINITY, pair, &PoseError::default());
        assert!(matches!(nothing, Err(FigureError::Empty { .. })));
    }

    #[test]
    fn a_flat_height_is_drawn_too() {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let acceptance = blob(&design, 10);
        let report = report_of(&design, &acceptance);
        let pair = [Dof::X, Dof::Pitch];
        assert!(heights(&report, &acceptance, &|_| 0.25, pair, &PoseError::default()).is_ok());
    }
}
