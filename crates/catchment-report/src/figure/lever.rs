//! The first contact in the kinematic method: rotation points, lever arms and angles on the section of both
//! halves.

use super::draw::arrow::arrow;
use super::draw::axis::PlotFrame;
use super::draw::colour::{self, hex};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, polyline};
use super::section::{MovingHalfPose, View, describe};
use super::{FigureError, Picture};
use catchment_core::connector::Connector;
use catchment_core::design::Design;
use catchment_core::method::kinematic::{Lever, LeverBody, LeverPose};
use glam::DVec2;

/// Length of the drawn normal, in SVG units.
const NORMAL: f64 = 62.0;
/// Smaller angles, in radians, are listed beside the drawing only.
const LEAST: f64 = 0.02;
/// How wide the numbers are, in SVG units.
const NUMBERS: f64 = 284.0;
/// Segments of an arc per radian.
const ARC: f64 = 24.0;

/// Draws the contact of a start; figures 3.3 and 3.4 of the dissertation with the numbers of a given pose.
///
/// # Errors
/// If nothing touches, or if a corner meets a corner.
pub fn lever(design: &Design, connector: &Connector, start: &LeverPose) -> Result<Picture, FigureError> {
    let Some((lever, height)) = start.lever.zip(start.height) else {
        return Err(FigureError::Empty { what: "no corner touches an edge" });
    };
    let placement = MovingHalfPose { error: start.error, height };
    let pivots = [lever.corner_pivot, lever.edge_pivot].map(|p| p.to_array());
    let view = View::new(design, connector, std::slice::from_ref(&placement))?.with(&pivots);
    let (width, height) = view.fit(520.0, 560.0);
    let (width, height) = (width.max(260.0), height.max(200.0));
    let halt = start.halt.map_or_else(String::new, |halt| format!(" ({})", halt.name()));
    let story = format!(
        "first contact at {} → {}{halt} by the kinematic method",
        describe(design, &placement),
        start.outcome.word()
    );
    let (mut svg, frames) = Layout::of(design)
        .story(story)
        .row([Panel::with_axes([width, height]), Panel::of([NUMBERS, 300.0])])
        .open();
    let frame = view.frame(frames[0]);
    svg.begin_clip(frame.rect);
    view.fixed(&mut svg, &frame);
    svg.begin_opacity(0.8);
    view.moving(&mut svg, &frame, &placement);
    svg.end();
    svg.end();
    frame.draw(&mut svg);
    marks(&mut svg, &view, &frame, &lever);
    numbers(&mut svg, &lever, frames[1]);
    Ok(Picture::of(svg))
}

/// Lever arms, normal and angles.
fn marks(svg: &mut Svg, view: &View<'_>, frame: &PlotFrame, lever: &Lever) {
    let at = |p: DVec2| DVec2::from_array(view.place(frame, p.to_array()));
    let [corner, edge, contact] = [lever.corner_pivot, lever.edge_pivot, lever.contact].map(at);
    // Down the picture is up in the world.
    let seen = |direction: DVec2| DVec2::new(direction.x, -direction.y);
    let foot = at(lever.edge_pivot + lever.normal * lever.distance);
    let dashed = |p: DVec2, direction: DVec2, svg: &mut Svg| {
        let style = format!(r#"stroke="{SOFT}" stroke-width="1" stroke-dasharray="6 3""#);
        svg.line(p.to_array(), (p + 74.0 * seen(direction)).to_array(), &style);
    };
    dashed(corner, lever.corner_vertical(), svg);
    dashed(edge, lever.edge_vertical(), svg);
    let dotted = format!(r#"stroke="{SOFT}" stroke-width="0.9" stroke-dasharray="1.5 3""#);
    svg.line(edge.to_array(), (edge + 46.0 * seen(lever.lateral())).to_array(), &dotted);
    let [long, across, turn] = [0, 1, 3].map(|k| hex(colour::CURVES[k]));
    let thick = |colour: &str| format!(r#"stroke="{colour}" stroke-width="2.4" {JOIN}"#);
    svg.line(corner.to_array(), contact.to_array(), &thick(&long));
    svg.line(edge.to_array(), foot.to_array(), &thick(&across));
    svg.line(foot.to_array(), contact.to_array(), &thick(&across));
    arrow(svg, contact.to_array(), (contact + NORMAL * seen(lever.normal)).to_array(), INK, 1.6);
    // From a direction, by an angle with the sense of all of them.
    let mut arc = |at: DVec2, from: DVec2, angle: f64, radius: f64, name: &str| {
        if angle.abs() < LEAST {
            return;
        }
        let steps = (angle.abs() * ARC).ceil().max(2.0);
        let place = |share: f64, radius: f64| {
            let turned = DVec2::from_angle(lever.sense * angle * share).rotate(from);
            (at + radius * seen(turned)).to_array()
        };
        let points = (0..=steps as usize).map(|k| place(k as f64 / steps, radius));
        svg.path(
            &polyline(points, false),
            &format!(r#"fill="none" stroke="{turn}" stroke-width="1.8" {JOIN}"#),
        );
        let [x, y] = place(0.5, radius + 13.0);
        svg.haloed([x, y + 4.0], LABEL + 1.0, Anchor::Middle, &turn, name);
    };
    arc(corner, lever.corner_vertical(), lever.beta_p, 46.0, "βₚ");
    arc(edge, lever.normal, lever.alpha_e, 58.0, "αₑ");
    // θ₁ runs against the sense of the others: from the lateral direction to the normal.
    arc(edge, lever.lateral(), -lever.theta_1, 30.0, "θ₁");
    arc(contact, lever.normal, lever.theta_2, 34.0, "θ₂");
    let mut word = |at: [f64; 2], anchor: Anchor, name: &str, colour: &str| {
        svg.haloed(at, LABEL + 1.0, anchor, colour, name);
    };
    let [moving, base] = ["P_M moving", "P_B base"];
    let [own, other] = if lever.corner == LeverBody::Moving { [moving, base] } else { [base, moving] };
    for (p, name) in [(corner, own), (edge, other)] {
        word([p.x + 9.0, p.y + 4.0], Anchor::Start, name, INK);
    }
    // On the side that the edge does not take.
    let (beside, anchor) = if foot.x > contact.x { (-9.0, Anchor::End) } else { (9.0, Anchor::Start) };
    word([contact.x + beside, contact.y + 4.0], anchor, "P_C", INK);
    for (a, b, name, colour) in [(corner, contact, "l", &long), (edge, foot, "d", &across)] {
        let p = (a + b) / 2.0;
        word([p.x - 10.0, p.y - 4.0], Anchor::Middle, name, colour);
    }
    let within = (foot + contact) / 2.0 - 14.0 * seen(lever.normal);
    word([within.x, within.y + 4.0], Anchor::Middle, "q₁", &across);
    let tip = contact + (NORMAL + 9.0) * seen(lever.normal);
    word([tip.x, tip.y + 4.0], Anchor::Middle, "N", INK);
    for p in [corner, edge, contact] {
        svg.circle(p.to_array(), 4.2, &format!(r##"fill="#ffffff" stroke="{INK}" stroke-width="1.6""##));
    }
}

/// The numbers beside the drawing.
fn numbers(svg: &mut Svg, lever: &Lever, Rect { x, y: top, .. }: Rect) {
    let degrees = |angle: f64| format!("{:.2}°", angle.to_degrees() + 0.0);
    let length = |value: f64| format!("{:.4} D", value + 0.0);
    let rows = [
        ("l", "lever of the corner", length(lever.length)),
        ("d", "rotation point to edge", length(lever.distance)),
        ("q₁", "along the edge", length(lever.along)),
        ("βₚ", "vertical to lever", degrees(lever.beta_p)),
        ("αₑ", "normal to vertical", degrees(lever.alpha_e)),
        ("θ₁", "lateral to normal", degrees(lever.theta_1)),
        ("θ₂", "normal to lever", degrees(lever.theta_2)),
        ("βₚ + αₑ", "θ₂ when docked", degrees(lever.aligned())),
    ];
    let whose = match lever.corner {
        LeverBody::Moving => "a corner of the moving half on an edge",
        LeverBody::Base => "a corner of the base on an edge",
    };
    svg.bold([x, top + 12.0], LABEL, Anchor::Start, whose);
    for (k, (name, meaning, value)) in rows.iter().enumerate() {
        let y = top + 38.0 + 24.0 * k as f64;
        svg.text([x, y], LABEL, Anchor::Start, INK, name);
        svg.text([x + 64.0, y], LABEL - 1.0, Anchor::Start, SOFT, meaning);
        svg.text([x + NUMBERS, y], LABEL, Anchor::End, INK, value);
    }
    let verdict = if lever.theta_2 < 0.0 {
        "θ₂ < 0: it turns away, a failed mate"
    } else if lever.theta_2 < lever.aligned() - 1e-9 {
        "θ₂ is still to grow until docked"
    } else if lever.theta_2 > lever.aligned() + 1e-9 {
        "θ₂ is still to fall until docked"
    } else {
        "θ₂ = βₚ + αₑ: docked"
    };
    svg.text([x, top + 46.0 + 24.0 * rows.len() as f64], LABEL, Anchor::Start, INK, verdict);
}
