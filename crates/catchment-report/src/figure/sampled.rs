//! Sampled poses by their outcomes: a triangle of scatter plots for all pairs of errors, with the tolerance
//! window.
//!
//! ```text
//!      y │· ┌┐ ·│            · missed or jammed     ● docked
//!   roll │·•└┘ ·│• ┌┐·│      ┌┐ tolerance window: every sampled pose within it, in all errors at once, docks
//!          x       y
//! ```
//!
//! A plot shows all poses, whatever their other errors: dots of different outcomes may lie next to each
//! other.

use super::draw::axis::{AxisScale, PlotFrame, ShownUnits};
use super::draw::colour::{self, hex};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TITLE, width_of};
use super::matrix::{BELOW, GAP, LEFT, TOP};
use super::{FigureError, Picture, headline};
use crate::Report;
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::pose::Dof;

/// Radius of a dot.
const DOT: f64 = 1.6;

/// Draws listed poses over every two free errors.
///
/// # Errors
/// If fewer than two errors are free, or there is no pose.
pub fn sampled(report: &Report, acceptance: &Acceptance) -> Result<Picture, FigureError> {
    let alignment = &report.design.alignment;
    let free: Vec<Dof> = alignment.free.iter().collect();
    let plots = free.len().saturating_sub(1);
    if plots == 0 || acceptance.outcomes.is_empty() {
        return Err(FigureError::Empty { what: "two free errors and sampled poses are needed" });
    }
    let side = [400.0, 280.0, 230.0, 196.0][plots.min(4) - 1];
    let extent = |gap: f64| plots as f64 * (side + gap) - gap;
    let story = headline(report);
    let width = (LEFT + extent(GAP[0]) + 28.0).max(48.0 + width_of(&story, LABEL));
    let height = TOP + extent(GAP[1]) + BELOW;
    let mut svg = Svg::new(width, height);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &report.design.name);
    svg.text([24.0, 50.0], LABEL, Anchor::Start, SOFT, &story);
    let units = ShownUnits::of(&report.design);
    let scale = |dof: Dof| {
        let half = alignment.half_range(dof) * units.factor(dof);
        AxisScale::new(units.label(dof), -half, half, dof.is_rotation())
    };
    // Docking poses are drawn last.
    let order = [Outcome::Missed, Outcome::Undecided, Outcome::Jammed, Outcome::Aligned];
    for row in 1..free.len() {
        for column in 0..row {
            let (x, y) = (free[column], free[row]);
            let at = [column as f64 * (side + GAP[0]), (row - 1) as f64 * (side + GAP[1])];
            let rect = Rect { x: LEFT + at[0], y: TOP + at[1], w: side, h: side };
            let frame = PlotFrame { rect, x: scale(x), y: scale(y) };
            for outcome in order {
                for (k, _) in acceptance.outcomes.iter().enumerate().filter(|(_, found)| **found == outcome) {
                    let error = acceptance.domain.pose(k).to_array();
                    let place = [x, y].map(|dof| error[dof.index()] * units.factor(dof));
                    svg.circle(frame.at(place), DOT, &style(outcome));
                }
            }
            window(&mut svg, report, &frame, &units, [x, y]);
            frame.outline(&mut svg);
            if row + 1 == free.len() {
                frame.below(&mut svg);
            }
            if column == 0 {
                frame.beside(&mut svg);
            }
        }
    }
    let mut x = LEFT;
    for outcome in order.into_iter().rev().filter(|outcome| acceptance.outcomes.contains(outcome)) {
        let y = height - 24.0;
        svg.circle([x + 5.0, y - 4.0], 4.5, &style(outcome));
        svg.text([x + 16.0, y], LABEL, Anchor::Start, INK, outcome.word());
        x += 38.0 + width_of(outcome.word(), LABEL);
    }
    if report.centered.is_some() {
        let y = height - 24.0;
        svg.rect(Rect { x, y: y - 9.0, w: 10.0, h: 10.0 }, WINDOW);
        svg.text([x + 16.0, y], LABEL, Anchor::Start, INK, "tolerance window");
    }
    Ok(Picture::of(svg))
}

/// The outline of the window.
const WINDOW: &str = r##"fill="none" stroke="#1b2430" stroke-width="1.4""##;

fn window(svg: &mut Svg, report: &Report, frame: &PlotFrame, units: &ShownUnits, [x, y]: [Dof; 2]) {
    let Some(found) = &report.centered else { return };
    let half =
        |dof: Dof| found.bounds.iter().find(|side| side.axis == dof).map(|side| side.hi * units.factor(dof));
    let (Some(w), Some(h)) = (half(x), half(y)) else { return };
    let ([left, top], [right, bottom]) = (frame.at([-w, h]), frame.at([w, -h]));
    svg.rect(Rect { x: left, y: top, w: right - left, h: bottom - top }, WINDOW);
}

fn style(outcome: Outcome) -> String {
    format!(r#"fill="{}""#, hex(colour::outcome(outcome)))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, report_of};
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::acceptance::Domain;
    use catchment_core::pose::DofSet;

    #[test]
    fn every_pose_is_a_dot_in_every_plot() {
        let free: DofSet = [Dof::X, Dof::Y, Dof::Yaw].into_iter().collect();
        let design = design(free);
        let cells = blob(&design, 6);
        let poses = (0..cells.outcomes.len()).map(|k| cells.domain.pose(k)).collect();
        let listed = Acceptance { domain: Domain::Poses(poses), ..cells.clone() };
        let mut report = report_of(&design, &listed);
        report.centered = report_of(&design, &cells).centered.clone();
        let picture = sampled(&report, &listed).unwrap();
        look("sampled", &picture);
        let outcomes: std::collections::BTreeSet<_> = listed.outcomes.iter().map(|o| o.name()).collect();
        let dots = picture.svg().matches("<circle").count();
        assert_eq!(dots, 3 * listed.outcomes.len() + outcomes.len());
        assert!(picture.svg().contains("tolerance window"));
        let one = crate::schema::testing::design([Dof::X].into_iter().collect());
        assert!(sampled(&report_of(&one, &blob(&one, 9)), &blob(&one, 9)).is_err());
    }
}
