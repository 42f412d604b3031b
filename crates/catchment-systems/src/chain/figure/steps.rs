//! A chain after every step, its joint angles over time, and the errors at its first docking.

use super::super::fold::State;
use super::super::kinematics::{ModuleDimensions, PlanarPose, direction, left};
use super::super::report::{ChainReport, FoldStepReport, FoldingReport, ModuleReport};
use super::super::shape::ModuleFace;
use super::super::study::Study;
use super::{cloud, degrees, headed};
use catchment::report::figure::Picture;
use catchment::report::figure::draw::axis::{AxisScale, PlotFrame};
use catchment::report::figure::draw::colour::{CURVES, FIXED, FIXED_EDGE, MOVING, MOVING_EDGE, Rgb, hex};
use catchment::report::figure::draw::layout::{Layout, Legend, Panel, stroked};
use catchment::report::figure::draw::svg::{
    Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, TICK, polyline, width_of,
};
use glam::DVec2;

/// Pictures of steps, and charts, in a row.
const ACROSS: usize = 3;
/// Width of a step and of a chart.
const CELL: f64 = 270.0;
/// Room below a step for two lines of text.
const WORDS: f64 = 32.0;
/// Height of the charts.
const CHART: f64 = 230.0;

pub(super) fn draw(report: &ChainReport, study: &Study) -> Picture {
    let Some(folding) = &report.folding else {
        return Picture::of(headed(report, String::new()).open().0);
    };
    let body = &report.body.body;
    let [left, right] = bounds(&folding.steps, body).map(|corner| corner.x);
    let scale = CELL / (right - left);
    let name = folding.shape.map_or("own sequence", |shape| shape.name());
    let mut layout = headed(report, format!("{name}; commands: {}", folding.commands_from)).legend(legend());
    for row in folding.steps.chunks(ACROSS) {
        // The height of a row fits its content.
        let [low, high] = bounds(row, body).map(|corner| corner.y);
        let panel = || Panel::of([CELL, scale * (high - low)]).with_room([0.0, 0.0, 0.0, WORDS]);
        layout = layout.row(row.iter().map(|_| panel()));
    }
    // The joints first, then every docking.
    let clouds = folding.latches.iter().map(|arrival| cloud::panel([CELL, CHART], report, arrival));
    let charts = std::iter::once(track_panel(folding)).chain(clouds).collect();
    let (mut svg, frames) = rows_of(layout, charts).open();
    let (steps, charts) = frames.split_at(folding.steps.len());
    let mut before = None;
    for (row, frames) in folding.steps.chunks(ACROSS).zip(steps.chunks(ACROSS)) {
        let low = bounds(row, body)[0].y;
        for (step, rect) in row.iter().zip(frames) {
            let bottom = rect.y + rect.h;
            let place = |p: DVec2| [rect.x + scale * (p.x - left), bottom - scale * (p.y - low)];
            chain(&mut svg, body, step, folding, scale, &place);
            words(&mut svg, step, before, folding, [rect.x, bottom + 15.0]);
            before = Some(step);
        }
    }
    track(&mut svg, charts[0], folding, study);
    for (rect, arrival) in charts[1..].iter().zip(&folding.latches) {
        cloud::draw(&mut svg, *rect, report, arrival);
    }
    Picture::of(svg)
}

/// Adds panels in rows of their own.
fn rows_of(layout: Layout, mut panels: Vec<Panel>) -> Layout {
    let rest = panels.split_off(panels.len().min(ACROSS));
    let layout = layout.row(panels);
    if rest.is_empty() { layout } else { rows_of(layout, rest) }
}

/// The marks of joints and dockings.
fn legend() -> Legend {
    let joint = |fill: &str| format!(r#"fill="{fill}" stroke="{INK}" stroke-width="1""#);
    Legend::titled("joints:")
        .dot(joint(INK), "holds")
        .dot(joint(STALLED), "at full torque")
        .dot(joint("#ffffff"), "slack")
        .mark("first layer latched", |svg, at| diamond(svg, at, false))
        .mark("both layers latched", |svg, at| diamond(svg, at, true))
}

/// Colour of a joint at its stall torque.
const STALLED: &str = "#b3261e";

/// The corners of some steps, in mm.
fn bounds(steps: &[FoldStepReport], body: &ModuleDimensions) -> [DVec2; 2] {
    let reach = DVec2::splat(body.overhang.hypot(0.5 * body.face).max(0.5 * body.length));
    let all = steps.iter().flat_map(|step| &step.modules).map(|m| DVec2::new(m.x_mm, m.y_mm));
    let (low, high) = all
        .fold((DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY)), |(low, high), p| {
            (low.min(p), high.max(p))
        });
    [low - reach, high + reach]
}

fn chain(
    svg: &mut Svg,
    body: &ModuleDimensions,
    step: &FoldStepReport,
    folding: &FoldingReport,
    scale: f64,
    place: &impl Fn(DVec2) -> [f64; 2],
) {
    for m in &step.modules {
        let latching =
            folding.latches.iter().filter_map(|l| l.latch).any(|l| l.from == m.module || l.to == m.module);
        let (fill, edge) = if latching { (MOVING, MOVING_EDGE) } else { (FIXED, FIXED_EDGE) };
        let style = format!(r#"fill="{}" stroke="{}" stroke-width="0.9" {JOIN}"#, hex(fill), hex(edge));
        for heading in [m.heading_rad - m.angle_rad + std::f64::consts::PI, m.heading_rad] {
            let (along, across) =
                (0.5 * body.length * direction(heading), 0.5 * body.face * left(direction(heading)));
            let at = DVec2::new(m.x_mm, m.y_mm);
            let corners = [at - across, at + along - across, at + along + across, at + across].map(place);
            svg.path(&polyline(corners, true), &style);
        }
    }
    for m in &step.modules {
        let at = place(DVec2::new(m.x_mm, m.y_mm));
        let (fill, ink) = match m.state {
            State::Slack => ("#ffffff", INK),
            State::Stalled => (STALLED, "#ffffff"),
            State::Holding => (INK, "#ffffff"),
        };
        let radius = (0.24 * body.face * scale).clamp(4.0, 9.0);
        svg.circle(at, radius, &format!(r#"fill="{fill}" stroke="{INK}" stroke-width="1""#));
        if radius > 5.5 {
            let size = 1.15 * radius;
            svg.text([at[0], at[1] + 0.36 * size], size, Anchor::Middle, ink, &m.module.to_string());
        }
    }
    for (latch, layers) in folding.latches.iter().zip(&step.layers) {
        let Some(pair) = latch.latch else { continue };
        if *layers > 0 {
            let face = |module: usize, side: ModuleFace| face(body, &step.modules[module - 1], side);
            let at = place(0.5 * (face(pair.from, pair.from_side) + face(pair.to, pair.to_side)));
            diamond(svg, at, *layers == 2);
        }
    }
}

/// The centre of a module's face.
fn face(body: &ModuleDimensions, m: &ModuleReport, side: ModuleFace) -> DVec2 {
    let rotor = PlanarPose { x: m.x_mm, y: m.y_mm, heading: m.heading_rad };
    let before = if side == ModuleFace::Back { -m.angle_rad } else { 0.0 };
    rotor.ahead(before + side.turn(), body.overhang).place()
}

fn diamond(svg: &mut Svg, [x, y]: [f64; 2], full: bool) {
    let r = 6.5;
    let fill = if full { "#009e73" } else { "#ffffff" };
    let corners = [[x - r, y], [x, y - r], [x + r, y], [x, y + r]];
    svg.path(
        &polyline(corners, true),
        &format!(r##"fill="{fill}" stroke="#00513b" stroke-width="1.6" {JOIN}"##),
    );
}

/// The changes in a step, in a line of text or two.
fn words(
    svg: &mut Svg,
    step: &FoldStepReport,
    before: Option<&FoldStepReport>,
    folding: &FoldingReport,
    [x, y]: [f64; 2],
) {
    let of = |m: &ModuleReport| match m.command_rad {
        Some(angle) => degrees(angle),
        None => "slack".to_owned(),
    };
    let was = |k: usize| before.map_or(Some(0.0), |b| b.modules[k].command_rad);
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for (_, m) in step.modules.iter().enumerate().filter(|(k, m)| was(*k) != m.command_rad) {
        match groups.iter_mut().find(|(message, _)| *message == of(m)) {
            Some((_, joints)) => joints.push(m.module),
            None => groups.push((of(m), vec![m.module])),
        }
    }
    let message: Vec<String> = groups
        .iter()
        .map(|(message, joints)| {
            let joints = joints.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
            format!("{joints}: {message}")
        })
        .collect();
    let printout = if message.is_empty() { "straight".to_owned() } else { message.join(";  ") };
    let time = format!("t = {} s", catchment::document::rounded(step.time_s));
    svg.bold([x, y], LABEL, Anchor::Start, &time);
    svg.text([x + width_of(&time, LABEL) + 14.0, y], TICK, Anchor::Start, INK, &printout);
    let news: Vec<String> = folding
        .latches
        .iter()
        .enumerate()
        .filter_map(|(k, latch)| {
            let (now, then) = (step.layers[k], before.map_or(0, |b| b.layers[k]));
            let name = latch.latch.map(|l| l.name())?;
            (now > then).then(|| format!("{name} {}", if now == 2 { "latched" } else { "first layer" }))
        })
        .collect();
    svg.text([x, y + 15.0], TICK, Anchor::Start, SOFT, &news.join(";  "));
}

/// The joints that move, as far as there are colours.
fn shown_joints(folding: &FoldingReport) -> impl Iterator<Item = (usize, Rgb)> {
    folding.turned.iter().copied().zip(CURVES)
}

/// The panel of joint angles over time.
fn track_panel(folding: &FoldingReport) -> Panel {
    let names = shown_joints(folding).fold(Legend::default(), |legend, (joint, colour)| {
        legend.line(stroked(colour, 2.4), format!("joint {joint}"))
    });
    Panel::with_axes([CELL, CHART]).over(names)
}

/// Angles of the joints that move, over time.
fn track(svg: &mut Svg, rect: Rect, folding: &FoldingReport, study: &Study) {
    let Some(folded) = &study.folded else { return };
    let angle = |angles: &[f64], joint: usize| angles[joint - 1].to_degrees();
    let angles = || {
        folded
            .track
            .iter()
            .flat_map(|(_, angles)| shown_joints(folding).map(|(joint, _)| angle(angles, joint)))
    };
    let (low, high) = angles().fold((0.0f64, 0.0f64), |(low, high), a| (low.min(a), high.max(a)));
    let last = folded.track.last().map_or(1.0, |(time, _)| *time).max(1.0);
    let margin = 0.06 * (high - low).max(1.0);
    let frame = PlotFrame {
        rect,
        x: AxisScale::new("t [s]".to_owned(), 0.0, last, false),
        y: AxisScale::new("joint angles [deg]".to_owned(), low - margin, high + margin, false),
    };
    let dotted = format!(r#"stroke="{SOFT}" stroke-width="0.9" stroke-dasharray="2 3""#);
    svg.begin_clip(rect);
    svg.line([rect.x, frame.py(-90.0)], [rect.x + rect.w, frame.py(-90.0)], &dotted);
    for (joint, colour) in shown_joints(folding) {
        let points = folded.track.iter().map(|(time, angles)| frame.at([*time, angle(angles, joint)]));
        svg.path(&polyline(points, false), &stroked(colour, 2.0));
    }
    svg.end();
    frame.draw(svg);
}
