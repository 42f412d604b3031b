//! Lateral offsets that contact corrects without rotation: an area with the largest square in it, or an
//! interval of a single axis.

use super::Picture;
use super::draw::axis::{AxisScale, PlotFrame, ShownUnits};
use super::draw::colour::{self, hex};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{INK, JOIN, Rect, SOFT, polyline};
use catchment_core::design::Design;
use catchment_core::document::significant;
use catchment_core::method::zraa::{AcceptedSquare, Zraa};
use catchment_core::pose::Dof;

/// Half-range of the picture, in D, at least: the face itself.
const LEAST: f64 = 0.5;
/// Room around the accepted offsets.
const MARGIN: f64 = 1.15;

/// Draws a zero-rotation area of acceptance over x and y, or over its single axis.
pub fn region(design: &Design, zraa: &Zraa, square: &AcceptedSquare) -> Picture {
    let units = ShownUnits::of(design);
    let ([w, h], measure) = match zraa {
        Zraa::Region { area, .. } => {
            ([420.0, 420.0], format!("{area:.6} D² accepted, ONAA {} D", significant(square.edge)))
        }
        Zraa::Interval { from, to, .. } => ([420.0, 60.0], format!("{:.6} D accepted", to - from)),
    };
    let (mut svg, frames) = Layout::of(design)
        .story(format!("corrected without rotation: {measure}"))
        .row([Panel::with_axes([w, h])])
        .open();
    let rect = frames[0];
    svg.rect(rect, &format!(r#"fill="{}""#, hex(colour::NOTHING)));
    let half = MARGIN * reach(zraa).max(LEAST);
    let scale = |dof: Dof| units.symmetric(dof, half);
    // Neighbouring polygons share borders; a line of their own colour leaves no seam between them.
    let colour = hex(colour::outcome(catchment_core::acceptance::Outcome::Aligned));
    let style = format!(r#"fill="{colour}" stroke="{colour}" stroke-width="0.6" {JOIN}"#);
    let dotted = format!(r#"stroke="{SOFT}" stroke-width="0.9" stroke-dasharray="2 3""#);
    let frame = match zraa {
        Zraa::Region { polygons, .. } => {
            let frame = PlotFrame { rect, x: scale(Dof::X), y: scale(Dof::Y) };
            let factor = units.lengths();
            for polygon in polygons {
                let corners = polygon.iter().map(|p| frame.at([p.x * factor, p.y * factor]));
                svg.path(&polyline(corners, true), &style);
            }
            svg.line([rect.x, frame.py(0.0)], [rect.x + rect.w, frame.py(0.0)], &dotted);
            if square.edge > 0.0 {
                let low = (square.center - square.edge / 2.0) * factor;
                let high = (square.center + square.edge / 2.0) * factor;
                let corners = [[low.x, low.y], [high.x, low.y], [high.x, high.y], [low.x, high.y]];
                let outline =
                    format!(r#"fill="none" stroke="{INK}" stroke-width="1.4" stroke-dasharray="6 3" {JOIN}"#);
                svg.path(&polyline(corners.map(|c| frame.at(c)), true), &outline);
            }
            frame
        }
        Zraa::Interval { axis, from, to } => {
            // A scale without extent has no ticks: there is nothing to read upwards.
            let nothing = AxisScale::new(String::new(), 0.0, 0.0, false);
            let frame = PlotFrame { rect, x: scale(*axis), y: nothing };
            let [from, to] = [from, to].map(|v| frame.px(v * units.factor(*axis)));
            svg.rect(Rect { x: from, w: to - from, ..rect }, &style);
            frame
        }
    };
    svg.line([frame.px(0.0), rect.y], [frame.px(0.0), rect.y + rect.h], &dotted);
    frame.draw(&mut svg);
    Picture::of(svg)
}

/// Largest accepted offset along an axis, in D.
fn reach(zraa: &Zraa) -> f64 {
    match zraa {
        Zraa::Interval { from, to, .. } => to.max(-from),
        Zraa::Region { polygons, .. } => {
            polygons.iter().flatten().map(|p| p.abs().max_element()).fold(0.0, f64::max)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::design;
    use glam::DVec2;

    #[test]
    fn an_area_and_a_stretch_are_drawn_in_the_units_of_the_design() {
        let free = [Dof::X, Dof::Y].into_iter().collect();
        let polygons = vec![vec![
            DVec2::new(-0.5, -0.5),
            DVec2::new(0.5, -0.5),
            DVec2::new(0.5, 0.5),
            DVec2::new(-0.5, 0.5),
        ]];
        let square = AcceptedSquare { edge: 1.0, center: DVec2::ZERO, centered_edge: 1.0 };
        let picture = region(&design(free), &Zraa::Region { polygons, area: 1.0, seam: 0.0 }, &square);
        look("zraa-region", &picture);
        assert!(
            picture.svg().contains("1.000000 D² accepted, ONAA 1.000 D") && picture.svg().contains("y [mm]")
        );
        let zraa = Zraa::Interval { axis: Dof::X, from: -1.0, to: 1.0 };
        let picture = region(&design(free), &zraa, &AcceptedSquare { edge: 2.0, ..square });
        look("zraa-interval", &picture);
        assert!(picture.svg().contains("2.000000 D accepted") && !picture.svg().contains("NaN"));
    }
}
