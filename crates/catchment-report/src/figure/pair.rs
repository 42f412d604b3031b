//! The pair as the program reads it: both halves in space, drawn apart, and in section in the mated pose, or
//! at first contact if there is no valid mated pose.

use super::draw::layout::{Layout, Panel};
use super::section::{MovingHalfPose, View};
use super::solid::panel;
use super::{FigureError, Picture};
use catchment_core::contact::face::misdrawn;
use catchment_core::contact::mated::CONTACT_TOLERANCE;
use catchment_core::problem::Problem;

/// Distance at which the halves are drawn apart in space, in D.
const LIFT: f64 = 0.6;

/// Draws the two halves of a problem: a check of the input against the parts.
///
/// # Errors
/// If there is nothing to draw.
pub fn pair(problem: &Problem) -> Result<Picture, FigureError> {
    const HEIGHT: f64 = 400.0;
    let (design, connector) = (problem.design(), problem.connector());
    let mated = MovingHalfPose::mated(design, 0.0);
    // If the mated pose as drawn is not a contact pose, the figure shows the first contact.
    let height = problem.pair().mated_height();
    let meets = (height - mated.height).abs() <= CONTACT_TOLERANCE;
    let is_mated = !height.is_finite() || meets && misdrawn(connector, &design.connector).is_none();
    let (mated, words) = if is_mated {
        (mated, "mated, cut along the approach")
    } else {
        (MovingHalfPose { height, ..mated }, "at first contact, cut along the approach")
    };
    let view = View::new(design, connector, std::slice::from_ref(&mated))?;
    let (width, height) = view.fit(460.0, HEIGHT);
    let (mut svg, frames) = Layout::of(design)
        .row([Panel::of([400.0, HEIGHT]).over("drawn apart"), Panel::with_axes([width, height]).over(words)])
        .open();
    panel(&mut svg, frames[0], design, connector, &MovingHalfPose::mated(design, LIFT))?;
    let frame = view.frame(frames[1]);
    view.halves(&mut svg, &frame, &mated);
    frame.draw(&mut svg);
    Ok(Picture::of(svg))
}
