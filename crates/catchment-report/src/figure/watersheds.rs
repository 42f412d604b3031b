//! From a connector to its area of acceptance by flooding, in four panels: the halves, the heights, the first
//! labels, and the labels after merging.
//!
//! Every first watershed has its own colour, which shows the divisions caused by sampling alone; after
//! merging it has the colour of its outcome.

use super::draw::axis::ShownUnits;
use super::draw::colour::{self, Rgb, mix};
use super::draw::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, TITLE};
use super::map::{Legend, Map};
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
    let (side, top) = (270.0, 96.0);
    let mut svg = Svg::new(1330.0, top + side + 108.0);
    svg.bold([24.0, 32.0], TITLE + 2.0, Anchor::Start, &design.name);
    svg.text([24.0, 53.0], LABEL, Anchor::Start, SOFT, &headline(report));
    let heading =
        |svg: &mut Svg, x: f64, words: &str| svg.text([x, top - 12.0], LABEL, Anchor::Start, INK, words);

    heading(&mut svg, 24.0, "the two halves");
    let apart = MovingHalfPose::mated(design, LIFT);
    solid::panel(&mut svg, Rect { x: 14.0, y: top, w: 260.0, h: side + 30.0 }, design, connector, &apart)?;

    let whole = if map.slice.at.is_empty() { "" } else { " in the whole grid" };
    let rect = |x: f64| Rect { x, y: top, w: side, h: side };
    heading(&mut svg, 340.0, &map.heading("height of first contact", &units, 370.0));
    heights::panel(&mut svg, &map, rect(340.0), &units, height)?;

    let WatershedsReport { counts, moved_share } = WatershedsReport::new(watersheds);
    heading(&mut svg, 720.0, "first labels, before merging");
    let first = map.slice.pick(&watersheds.first);
    let frame = map.frame(rect(720.0), &units);
    map.paint(&mut svg, &frame, &first.iter().map(|label| shade(*label, watersheds)).collect::<Vec<_>>())?;
    frame.draw(&mut svg);
    let dams =
        if counts.dams > 0 { format!(", {} dam cells (dark)", grouped(counts.dams)) } else { String::new() };
    let below = top + side + 58.0;
    let told = format!("{} watersheds{dams}{whole}", grouped(counts.first));
    svg.text([720.0, below], LABEL, Anchor::Start, INK, &told);

    heading(&mut svg, 1040.0, "after merging");
    let frame = map.frame(rect(1040.0), &units);
    let merged: Vec<Rgb> = map.outcomes.iter().map(|outcome| colour::outcome(*outcome)).collect();
    map.paint(&mut svg, &frame, &merged)?;
    svg.path(&map.border(&frame), &format!(r##"fill="none" stroke="#123a5c" stroke-width="1.6" {JOIN}"##));
    frame.draw(&mut svg);
    let told = format!(
        "{} left; {} of all cells changed basin by merging",
        grouped(counts.merged),
        percent(moved_share)
    );
    svg.text([1040.0, below], LABEL, Anchor::Start, INK, &told);
    Legend::of(&map, false).draw(&mut svg, [720.0, below + 26.0]);
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
