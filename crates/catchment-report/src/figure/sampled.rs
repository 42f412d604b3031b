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

use super::draw::axis::{PlotFrame, ShownUnits};
use super::draw::colour::{self, hex};
use super::draw::layout::{Layout, Legend};
use super::draw::svg::{Rect, Svg};
use super::triangle::Triangle;
use super::{FigureError, Picture, headline};
use crate::Report;
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::pose::Dof;

/// Radius of a dot.
const DOT: f64 = 1.6;
/// The outline of the window.
const WINDOW: &str = r##"fill="none" stroke="#1b2430" stroke-width="1.4""##;

/// Draws listed poses over every two free errors.
///
/// # Errors
/// If fewer than two errors are free, or there is no pose.
pub fn sampled(report: &Report, acceptance: &Acceptance) -> Result<Picture, FigureError> {
    let alignment = &report.design.alignment;
    let free: Vec<Dof> = alignment.free.iter().collect();
    let before = |(row, y): (usize, &Dof)| free[..row].iter().map(|x| [*x, *y]).collect::<Vec<_>>();
    let pairs: Vec<[Dof; 2]> = free.iter().enumerate().flat_map(before).collect();
    if pairs.is_empty() || acceptance.outcomes.is_empty() {
        return Err(FigureError::Empty { what: "two free errors and sampled poses are needed" });
    }
    // Docking poses are drawn last.
    let order = [Outcome::Missed, Outcome::Undecided, Outcome::Jammed, Outcome::Aligned];
    let occurring = order.into_iter().rev().filter(|outcome| acceptance.outcomes.contains(outcome));
    let mut legend =
        occurring.fold(Legend::default(), |legend, outcome| legend.dot(style(outcome), outcome.word()));
    if report.centered.is_some() {
        legend = legend.square(WINDOW, "tolerance window");
    }
    let triangle = Triangle::of(pairs.iter().copied());
    let layout = Layout::of(&report.design).story(headline(report)).legend(legend);
    let (mut svg, frames) = triangle.open(layout, 0.0);
    let units = ShownUnits::of(&report.design);
    let scale = |dof: Dof| units.symmetric(dof, alignment.half_range(dof));
    for (pair, rect) in pairs.into_iter().zip(frames) {
        let [x, y] = pair;
        let frame = PlotFrame { rect, x: scale(x), y: scale(y) };
        for outcome in order {
            for (k, _) in acceptance.outcomes.iter().enumerate().filter(|(_, result)| **result == outcome) {
                let error = acceptance.domain.pose(k).to_array();
                let place = pair.map(|dof| error[dof.index()] * units.factor(dof));
                svg.circle(frame.at(place), DOT, &style(outcome));
            }
        }
        window(&mut svg, report, &frame, &units, pair);
        triangle.draw(&mut svg, pair, &frame);
    }
    Ok(Picture::of(svg))
}

fn window(svg: &mut Svg, report: &Report, frame: &PlotFrame, units: &ShownUnits, [x, y]: [Dof; 2]) {
    let Some(result) = &report.centered else { return };
    let half =
        |dof: Dof| result.bounds.iter().find(|side| side.axis == dof).map(|side| side.hi * units.factor(dof));
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
