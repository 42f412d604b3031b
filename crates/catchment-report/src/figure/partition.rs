//! The partition over two errors: every part of the contact space in the colour of its outcome, and the exact
//! outline of the accepted set.

use super::draw::axis::{PlotFrame, ShownUnits};
use super::draw::colour::{self, hex};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{JOIN, polyline};
use super::map::{self, Map};
use super::{FigureError, Picture, headline};
use crate::Report;
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::document::percent;
use catchment_core::method::partition::Partition;
use catchment_core::pose::PoseError;

/// Draws a partition of two errors under the numbers of its `report`; `acceptance` is its sample over a grid, for the legend's shares.
///
/// # Errors
/// If other than two errors are free.
pub fn partition(
    report: &Report,
    partition: &Partition,
    acceptance: &Acceptance,
) -> Result<Picture, FigureError> {
    let design = &report.design;
    let polygons = partition.polygons();
    let dofs: Vec<_> = design.alignment.free.iter().collect();
    let [first, second] = dofs[..] else {
        return Err(FigureError::Empty { what: "a partition is drawn over two errors" });
    };
    let units = ShownUnits::of(design);
    let counts = partition.counts();
    let settings = partition.settings();
    let story = format!(
        "{} slices, {} strips per D: {} polytopes, {} cells, {} parts",
        settings.slices, settings.strips, counts.polytopes, counts.cells, counts.parts
    );
    let whole: f64 = dofs.iter().map(|dof| 2.0 * design.alignment.half_range(*dof)).product();
    let exact =
        report.partition.as_ref().ok_or(FigureError::Empty { what: "the report has no partition" })?;
    let share = percent(exact.sum / whole);
    let map = Map::of(acceptance, [first, second], &PoseError::default())?;
    let (mut svg, frames) = Layout::of(design)
        .story(headline(report))
        .story(story)
        .story(format!("{share} of the error box accepted, inside the dark outline"))
        .row([Panel::with_axes([520.0; 2])])
        .legend(map::legend(&map, false))
        .open();
    let rect = frames[0];
    let scale = |dof| units.symmetric(dof, design.alignment.half_range(dof));
    let frame = PlotFrame { rect, x: scale(first), y: scale(second) };
    let at =
        |corner: &[f64; 2]| frame.at([corner[0] * units.factor(first), corner[1] * units.factor(second)]);
    svg.rect(rect, &format!(r#"fill="{}""#, hex(colour::outcome(Outcome::Missed))));
    svg.begin_clip(rect);
    for (corners, outcome) in &polygons {
        let fill = hex(colour::outcome(*outcome));
        let style =
            format!(r##"fill="{fill}" stroke="#ffffff" stroke-opacity="0.55" stroke-width="0.4" {JOIN}"##);
        svg.path(&polyline(corners.iter().map(at), true), &style);
    }
    let outline: String =
        partition.outline().iter().map(|ends| polyline(ends.iter().map(at), false)).collect();
    svg.path(&outline, map::BORDER);
    svg.end();
    map::zero_lines(&mut svg, &frame);
    frame.draw(&mut svg);
    Ok(Picture::of(svg))
}
