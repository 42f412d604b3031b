//! From a connector to its area of acceptance by flooding, in four panels: the halves, the heights, the first
//! labels, and the labels after merging.
//!
//! Every first watershed has its own colour, which shows the divisions caused by sampling alone; after
//! merging it has the colour of its outcome.

use super::draw::axis::ShownUnits;
use super::draw::colour::{self, Rgb, mix};
use super::draw::layout::{Layout, Panel};
use super::map::{self, Map};
use super::section::MovingHalfPose;
use super::{FigureError, Picture, headline, heights, solid};
use crate::Report;
use crate::schema::WatershedsReport;
use catchment_core::acceptance::Acceptance;
use catchment_core::connector::Connector;
use catchment_core::document::{grouped, percent};
use catchment_core::method::flood::{DAM, Watersheds};
use catchment_core::pose::{Dof, PoseError};

/// Cells between two watersheds.
const BETWEEN: Rgb = [0x22, 0x2b, 0x3a];
/// Side of a map, and size of the halves in space, in SVG units.
const SIDE: f64 = 270.0;
const HALVES: [f64; 2] = [SIDE - 10.0, SIDE + 30.0];

/// Draws the stages of flooding over a pair of errors, the others zero. `height` as in [`super::heights()`].
///
/// # Errors
/// Listed poses, a pair that the grid does not have, no contact anywhere.
pub fn watersheds(
    report: &Report,
    connector: &Connector,
    acceptance: &Acceptance,
    watersheds: &Watersheds,
    height: &dyn Fn(usize) -> f64,
    pair: [Dof; 2],
) -> Result<Picture, FigureError> {
    let design = &report.design;
    let units = ShownUnits::of(design);
    let map = Map::of(acceptance, pair, &PoseError::default())?;
    let whole = if map.slice.at.is_empty() { "" } else { " in the whole grid" };
    let WatershedsReport { counts, moved_share } = WatershedsReport::new(watersheds);
    let dams =
        if counts.dams > 0 { format!(", {} dam cells (dark)", grouped(counts.dams)) } else { String::new() };
    let first = format!("{} watersheds{dams}{whole}", grouped(counts.first));
    let merged = format!(
        "{} left; {} of all cells changed basin by merging",
        grouped(counts.merged),
        percent(moved_share)
    );
    let panel = || Panel::with_axes([SIDE; 2]);
    let (mut svg, frames) = Layout::of(design)
        .story(headline(report))
        .row([
            Panel::of(HALVES).over("the two halves"),
            panel().with_bar().over(map.heading("height of first contact", &units, SIDE)),
            panel().over("first labels, before merging").under(first),
            panel().over("after merging").under(merged).under(map::legend(&map, false)),
        ])
        .open();
    let apart = MovingHalfPose::mated(design, LIFT);
    solid::panel(&mut svg, frames[0], design, connector, &apart)?;
    heights::panel(&mut svg, &map, frames[1], &units, height)?;

    let labels = map.slice.pick(&watersheds.first);
    let frame = map.frame(frames[2], &units);
    map.paint(&mut svg, &frame, &labels.iter().map(|label| shade(*label, watersheds)).collect::<Vec<_>>())?;
    frame.draw(&mut svg);

    let frame = map.frame(frames[3], &units);
    let merged: Vec<Rgb> = map.outcomes.iter().map(|outcome| colour::outcome(*outcome)).collect();
    map.paint(&mut svg, &frame, &merged)?;
    svg.path(&map.border(&frame), map::BORDER);
    frame.draw(&mut svg);
    Ok(Picture::of(svg))
}

/// Distance at which the halves are drawn apart, in D.
const LIFT: f64 = 0.5;

/// A number in [0, 1) that differs most between numbers near each other: multiples of the golden ratio.
fn share(label: u32) -> f64 {
    (0.618_033_988_749_895 * f64::from(label)).fract()
}

/// The colour of a first label.
fn shade(label: u32, watersheds: &Watersheds) -> Rgb {
    /// Two turns around the colours, the second darker.
    const DARKER: f64 = 0.3;
    match label {
        DAM => BETWEEN,
        label if Some(label) == watersheds.outside => colour::NOTHING,
        label => {
            let dark = if label % 2 == 1 { DARKER } else { 0.0 };
            mix(hue(share(label)), [0; 3], dark)
        }
    }
}

/// A pale colour of the rainbow: red, green and blue a third of a turn apart.
fn hue(turn: f64) -> Rgb {
    /// From the palest channel to the fullest.
    const RANGE: [f64; 2] = [110.0, 245.0];
    [0.0, 1.0, 2.0].map(|third| {
        let wave = 0.5 + 0.5 * (std::f64::consts::TAU * (turn - third / 3.0)).cos();
        (RANGE[0] + (RANGE[1] - RANGE[0]) * wave).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, report_of, v_face};
    use super::*;
    use crate::schema::basins::tests::flooded;
    use catchment_core::method::flood::Flooding;

    #[test]
    fn four_stages_side_by_side() {
        let (design, Flooding { acceptance, watersheds: mut labels, .. }) = flooded();
        labels.first[40] = DAM;
        let report = report_of(&design, &acceptance);
        let grid = acceptance.grid().unwrap();
        let height = |cell: usize| grid.pose(cell).x.abs();
        let pair = [Dof::X, Dof::Pitch];
        let drawn = || watersheds(&report, &v_face(), &acceptance, &labels, &height, pair).unwrap();
        let picture = drawn();
        look("watersheds", &picture);
        let counts = labels.counts();
        assert!(picture.svg().contains(&format!("{} watersheds, 1 dam cells", counts.first)));
        assert!(picture.svg().contains(&format!("{} left; ", counts.merged)));
        assert_eq!(picture, drawn());
    }
}
