//! The partition over two errors: every part of the contact space in the colour of its outcome, and the exact
//! outline of the accepted set.

use super::draw::axis::{AxisScale, PlotFrame, ShownUnits};
use super::draw::colour::{self, hex};
use super::draw::svg::{Anchor, JOIN, LABEL, Rect, SOFT, Svg, TITLE, polyline, width_of};
use super::map::{Legend, Map, zero_lines};
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
    let rect = Rect { x: 78.0, y: 109.0, w: 520.0, h: 520.0 };
    let numbers = headline(report);
    let width = (rect.x + rect.w + 34.0).max(width_of(&numbers, LABEL) + 48.0);
    let mut svg = Svg::new(width, rect.y + rect.h + 84.0);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &design.name);
    svg.text([24.0, 49.0], LABEL, Anchor::Start, SOFT, &numbers);
    let counts = partition.counts();
    let settings = partition.settings();
    let story = format!(
        "{} slices, {} strips per D: {} polytopes, {} cells, {} parts",
        settings.slices, settings.strips, counts.polytopes, counts.cells, counts.parts
    );
    svg.text([24.0, 66.0], LABEL, Anchor::Start, SOFT, &story);
    let whole: f64 = dofs.iter().map(|dof| 2.0 * design.alignment.half_range(*dof)).product();
    let exact =
        report.partition.as_ref().ok_or(FigureError::Empty { what: "the report has no partition" })?;
    let share = percent(exact.sum / whole);
    let story = format!("{share} of the error box accepted, inside the dark outline");
    svg.text([24.0, 83.0], LABEL, Anchor::Start, SOFT, &story);
    let scale = |dof| {
        let half = design.alignment.half_range(dof) * units.factor(dof);
        AxisScale::new(units.label(dof), -half, half, dof.is_rotation())
    };
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
    svg.path(&outline, &format!(r##"fill="none" stroke="#123a5c" stroke-width="1.6" {JOIN}"##));
    svg.end();
    zero_lines(&mut svg, &frame);
    frame.draw(&mut svg);
    let map = Map::of(acceptance, [first, second], &PoseError::default())?;
    Legend::of(&map, false).draw(&mut svg, [rect.x, rect.y + rect.h + 62.0]);
    Ok(Picture::of(svg))
}
