//! Error and probability over the number of modules.

use super::super::report::ChainReport;
use super::super::study::Length;
use super::{degrees, headed};
use catchment::report::figure::Picture;
use catchment::report::figure::draw::axis::{AxisScale, PlotFrame, short};
use catchment::report::figure::draw::colour::{CURVES, hex};
use catchment::report::figure::draw::layout::{Legend, Panel, stroked};
use catchment::report::figure::draw::svg::{Anchor, INK, JOIN, Rect, SOFT, Svg, TICK, polyline};

/// Size of a chart beside another; a single one is twice as wide.
const CHART: [f64; 2] = [370.0, 300.0];

pub(super) fn draw(report: &ChainReport) -> Picture {
    let story = match &report.connector {
        Some(connector) => {
            let cor = short(connector.center_of_rotation_d);
            format!("straight chains, {}, centre of rotation {cor} D: the last rotor", connector.name)
        }
        None => "straight chains".to_owned(),
    };
    let rows: Vec<&[Length]> =
        report.lengths.chunk_by(|a, b| a.joint_sigma_rad == b.joint_sigma_rad).collect();
    let legend = rows.iter().enumerate().fold(Legend::default(), |legend, (k, rows)| {
        let name = format!("σ = {} a joint", degrees(rows[0].joint_sigma_rad));
        legend.line(stroked(CURVES[k % CURVES.len()], 2.4), name)
    });
    let has_docking = report.lengths.iter().any(|row| row.docking.is_some());
    let [w, h] = CHART;
    let panels = if has_docking { vec![CHART; 2] } else { vec![[2.0 * w, h]] };
    let (mut svg, frames) =
        headed(report, story).row(panels.into_iter().map(Panel::with_axes)).legend(legend).open();
    let lateral = |row: &Length| Some((row.lateral_sigma_d, None));
    chart(&mut svg, frames[0], "lateral error, σ [D]", &rows, None, lateral);
    if let Some(rect) = frames.get(1) {
        let probability = |row: &Length| row.docking.map(|d| (d.probability, Some(d.ci95)));
        chart(&mut svg, *rect, "probability of docking", &rows, Some(1.0), probability);
    }
    Picture::of(svg)
}

fn chart(
    svg: &mut Svg,
    rect: Rect,
    label: &str,
    rows: &[&[Length]],
    top: Option<f64>,
    value: impl Fn(&Length) -> Option<(f64, Option<[f64; 2]>)>,
) {
    let all = || rows.iter().copied().flatten();
    let (first, last) =
        all().fold((usize::MAX, 0), |(low, high), r| (low.min(r.modules), high.max(r.modules)));
    let highest = all().filter_map(&value).map(|(v, _)| v).fold(1e-9, f64::max);
    let frame = PlotFrame {
        rect,
        x: AxisScale::new("modules".to_owned(), first as f64 - 0.5, last as f64 + 0.5, false),
        y: AxisScale::new(label.to_owned(), 0.0, top.map_or(1.08 * highest, |top| 1.04 * top), false),
    };
    let grid = format!(r#"stroke="{SOFT}" stroke-opacity="0.18" stroke-width="0.8""#);
    for y in frame.y.ticks((rect.h / 40.0) as usize) {
        svg.line([rect.x, frame.py(y)], [rect.x + rect.w, frame.py(y)], &grid);
    }
    svg.begin_clip(rect);
    if top.is_some() {
        let dashed = format!(r#"stroke="{INK}" stroke-width="1" stroke-dasharray="4 3""#);
        svg.line([rect.x, frame.py(0.99)], [rect.x + rect.w, frame.py(0.99)], &dashed);
    }
    for (k, rows) in rows.iter().enumerate() {
        let colour = hex(CURVES[k % CURVES.len()]);
        let points: Vec<([f64; 2], Option<[f64; 2]>)> = rows
            .iter()
            .filter_map(|row| value(row).map(|(v, ends)| (frame.at([row.modules as f64, v]), ends)))
            .collect();
        let style = format!(r#"fill="none" stroke="{colour}" stroke-width="2" {JOIN}"#);
        svg.path(&polyline(points.iter().map(|(at, _)| *at), false), &style);
        for (at, ends) in points {
            if let Some([low, high]) = ends {
                let whisker = format!(r#"stroke="{colour}" stroke-opacity="0.7" stroke-width="1.2""#);
                svg.line([at[0], frame.py(low)], [at[0], frame.py(high)], &whisker);
            }
            svg.circle(at, 3.0, &format!(r##"fill="{colour}" stroke="#ffffff" stroke-width="1""##));
        }
    }
    svg.end();
    if top.is_some() {
        svg.text([rect.x + 6.0, frame.py(0.99) + 13.0], TICK, Anchor::Start, INK, "99 %");
    }
    frame.draw(svg);
}
