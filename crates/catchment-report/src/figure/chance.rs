//! Docking probability of drop tests: over two errors, with the border of exact motions; and over speed.

use super::draw::axis::{PlotFrame, ShownUnits, short};
use super::draw::chart::{Chart, ChartLine, ChartPoint, Mark, Spacing, legend};
use super::draw::colour::{CURVES, Rgb, hex, sequential};
use super::draw::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, TICK, TITLE};
use super::{FigureError, Picture};
use crate::ChanceReport;
use catchment_core::poses::Circumstance;
use catchment_study::chance::{ChanceMap, unit_of};
use std::fmt::Write;

/// Colour of exact motions.
const EXACT: Rgb = [0x1f, 0x29, 0x33];
/// Side of a map, and size of a chart, in SVG units.
const SIDE: f64 = 340.0;
const CHART: [f64; 2] = [400.0, 300.0];
/// Steps of the bar of colours.
const STEPS: usize = 50;
/// Shares that are written beside it.
const MARKS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Draws the map, and the curve, as far as they were requested.
///
/// # Errors
/// If neither was requested.
pub fn chance(report: &ChanceReport) -> Result<Picture, FigureError> {
    let map = report.map.as_ref().filter(|map| map.axes.len() == 2);
    if map.is_none() && report.curve.is_empty() {
        return Err(FigureError::Empty { what: "neither a map nor a curve against speed was asked for" });
    }
    let top = 116.0;
    let (mut width, mut height) = (24.0, top);
    if map.is_some() {
        width += 54.0 + SIDE + 92.0;
        height = top + SIDE + 74.0;
    }
    let chart = Rect { x: width + 58.0, y: top, w: CHART[0], h: CHART[1] };
    if !report.curve.is_empty() {
        width = chart.x + chart.w + 28.0;
        height = height.max(top + chart.h + 56.0);
    }
    let mut svg = Svg::new(width.max(620.0), height);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &report.design.name);
    for (k, words) in story(report).iter().enumerate() {
        svg.text([24.0, 50.0 + 16.0 * k as f64], LABEL, Anchor::Start, SOFT, words);
    }
    if let Some(map) = map {
        cells(&mut svg, report, map, Rect { x: 78.0, y: top, w: SIDE, h: SIDE });
    }
    if !report.curve.is_empty() {
        curve(&mut svg, report, chart);
    }
    Ok(Picture::of(svg))
}

fn story(report: &ChanceReport) -> Vec<String> {
    let declared: Vec<String> = report
        .declared
        .iter()
        .filter(|declared| !declared.law.is_constant())
        .map(|declared| declared.circumstance.name().replace('_', " "))
        .collect();
    let drawn = if declared.is_empty() {
        "trials that differ by their starts alone".to_owned()
    } else {
        format!("trials with random {}", declared.join(", "))
    };
    let mut lines = vec![drawn];
    if let Some(overall) = &report.overall {
        let [lo, hi] = overall.ci95.map(|share| short(100.0 * share));
        lines.push(format!(
            "{} % of {} errors dock (95 %: {lo} … {hi} %), by exact quasi-static motions {} %",
            short(100.0 * overall.probability),
            overall.errors,
            short(100.0 * overall.quasi_static)
        ));
    }
    lines
}

fn cells(svg: &mut Svg, report: &ChanceReport, map: &ChanceMap, rect: Rect) {
    let units = ShownUnits::of(&report.design);
    let [first, second] = [&map.axes[0], &map.axes[1]];
    let frame = PlotFrame { rect, x: units.axis(first), y: units.axis(second) };
    let (w, h) = (rect.w / first.cells as f64, rect.h / second.cells as f64);
    let corner = |i: usize, j: usize| [rect.x + w * i as f64, rect.y + rect.h - h * j as f64];
    svg.begin_clip(rect);
    for (k, cell) in map.cells.iter().enumerate() {
        let [x, y] = corner(k % first.cells, k / first.cells + 1);
        let fill = hex(sequential(cell.probability));
        // Neighbours overlap by a hair: no line shows between them.
        svg.rect(Rect { x, y, w: w + 0.4, h: h + 0.4 }, &format!(r#"fill="{fill}" stroke="none""#));
    }
    let docks = |i: usize, j: usize| map.cells[j * first.cells + i].quasi_static > 0.5;
    // Writing into a string does not fail.
    let mut border = String::new();
    for j in 0..second.cells {
        for i in 0..first.cells {
            let [x, y] = corner(i + 1, j + 1);
            if i + 1 < first.cells && docks(i, j) != docks(i + 1, j) {
                let _ = write!(border, "M{x:.2} {y:.2}v{h:.2}");
            }
            if j + 1 < second.cells && docks(i, j) != docks(i, j + 1) {
                let _ = write!(border, "M{x:.2} {y:.2}h{:.2}", -w);
            }
        }
    }
    svg.path(&border, &format!(r##"fill="none" stroke="#ffffff" stroke-width="4.2" {JOIN}"##));
    svg.path(&border, &format!(r#"fill="none" stroke="{}" stroke-width="2" {JOIN}"#, hex(EXACT)));
    svg.end();
    frame.draw(svg);
    let trials = map.cells.first().map_or(0, |cell| cell.trials);
    let words = format!("share of {trials} trials that dock");
    svg.text([rect.x, rect.y - 10.0], LABEL, Anchor::Start, INK, &words);
    bar(svg, Rect { x: rect.x + rect.w + 18.0, y: rect.y, w: 14.0, h: rect.h });
    let y = rect.y + rect.h + 58.0;
    svg.line(
        [rect.x, y - 4.0],
        [rect.x + 20.0, y - 4.0],
        &format!(r#"stroke="{}" stroke-width="2""#, hex(EXACT)),
    );
    svg.text(
        [rect.x + 27.0, y],
        LABEL,
        Anchor::Start,
        INK,
        "border of what docks by exact quasi-static motion",
    );
}

/// The legend of the colours.
fn bar(svg: &mut Svg, rect: Rect) {
    let each = rect.h / STEPS as f64;
    for k in 0..STEPS {
        let share = (k as f64 + 0.5) / STEPS as f64;
        let y = rect.y + rect.h - each * (k as f64 + 1.0);
        let fill = hex(sequential(share));
        svg.rect(Rect { y, h: each + 0.4, ..rect }, &format!(r#"fill="{fill}" stroke="none""#));
    }
    for mark in MARKS {
        let y = rect.y + rect.h * (1.0 - mark);
        svg.line(
            [rect.x + rect.w, y],
            [rect.x + rect.w + 4.0, y],
            &format!(r#"stroke="{SOFT}" stroke-width="0.8""#),
        );
        let words = format!("{} %", short(100.0 * mark));
        svg.text([rect.x + rect.w + 8.0, y + 3.8], TICK, Anchor::Start, SOFT, &words);
    }
}

fn curve(svg: &mut Svg, report: &ChanceReport, rect: Rect) {
    let percent = |share: f64| 100.0 * share;
    let (factor, unit) = unit_of(&report.design, Circumstance::Speed);
    // Plot the speed if it is known at each point; if not, the factor.
    let has_speed = report.curve.iter().all(|at| at.speed > 0.0);
    let place = |times: f64, speed: f64| if has_speed { speed * factor } else { times };
    let mut points: Vec<ChartPoint> = report
        .curve
        .iter()
        .map(|at| ChartPoint {
            x: place(at.factor, at.speed),
            y: percent(at.probability),
            interval: Some(at.ci95.map(percent)),
        })
        .collect();
    let declared = report.curve.first().map(|at| place(1.0, at.speed / at.factor));
    if let (Some(overall), Some(x)) = (&report.overall, declared)
        && report.curve.iter().all(|at| (at.factor - 1.0).abs() > 1e-9)
    {
        points.push(ChartPoint {
            x,
            y: percent(overall.probability),
            interval: Some(overall.ci95.map(percent)),
        });
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
    }
    let ends = [points.first(), points.last()].map(|point| point.map_or(1.0, |point| point.x));
    let mut lines = vec![ChartLine { name: "trials".to_owned(), colour: CURVES[0], points }];
    if let Some(overall) = &report.overall {
        let interval = Some(overall.quasi_static_ci95.map(percent));
        let points = ends.map(|x| ChartPoint { x, y: percent(overall.quasi_static), interval }).to_vec();
        let name =
            if report.settings.held { "exact motions, the limit of no speed" } else { "exact motions" };
        lines.push(ChartLine { name: name.to_owned(), colour: EXACT, points });
    }
    let x_label =
        if has_speed { format!("mean approach speed [{unit}]") } else { "all speeds times".to_owned() };
    let mark = declared.map(|x| Mark { x, y: None, words: "as declared" });
    Chart {
        rect,
        x_label: &x_label,
        spacing: Spacing::Logarithmic,
        y_label: "docks [%]",
        lines: &lines,
        mark,
    }
    .draw(svg);
    legend(svg, &lines, [rect.x, rect.y - 16.0]);
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::exec::Exec;
    use catchment_core::pose::{Dof, PoseError};
    use catchment_core::poses::{Dynamics, ScalarDistribution, Spread};
    use catchment_core::problem::Problem;
    use catchment_study::chance::{ChanceSettings, Question, run};

    #[test]
    fn maps_and_curves_are_drawn() {
        let problem = Problem::of(design([Dof::X, Dof::Pitch].into_iter().collect())).unwrap();
        let dynamics = Dynamics::default()
            .with(Circumstance::Speed, ScalarDistribution::Normal { mean: 1.0, sigma: 0.2 })
            .with(Circumstance::DriftX, ScalarDistribution::Normal { mean: 0.0, sigma: 1.5 });
        let settings = ChanceSettings { dynamics, trials: 4, overall: 100, ..ChanceSettings::default() };
        let sigma = PoseError { x: 0.2, pitch: 0.4, ..PoseError::default() };
        let asked =
            Question { errors: Some(Spread::normal(sigma)), times: vec![0.1, 4.0], ..Question::default() };
        let asked = asked.with_map(&problem, [Dof::X, Dof::Pitch], 8);
        let found = run(&problem, &asked, &settings, &Exec::new()).unwrap();
        let report = ChanceReport::new(problem.design(), found, Vec::new(), None);
        let picture = chance(&report).unwrap();
        look("chance", &picture);
        assert!(picture.svg().contains("share of 4 trials") && picture.svg().contains("as declared"));
        assert!(!picture.svg().contains("NaN"));
        let table = report.table();
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
        assert_eq!(report.records().len(), 1 + 1 + 2 + 64);
        assert!(report.records().iter().all(|record| record.len() == 13));
        let nothing = Question { poses: vec![PoseError::default()], ..Question::default() };
        let found = run(&problem, &nothing, &settings, &Exec::new()).unwrap();
        let report = ChanceReport::new(problem.design(), found, Vec::new(), None);
        assert!(matches!(chance(&report), Err(FigureError::Empty { .. })));
    }
}
