//! Docking probability of drop tests: over two errors, with the border of exact motions; and over speed.

use super::draw::axis::{AxisScale, PlotFrame, ShownUnits, short};
use super::draw::chart::{self, Chart, ChartLine, ChartPoint, Mark, Spacing};
use super::draw::colour::{CURVES, Rgb, hex, sequential};
use super::draw::layout::{Layout, Legend, Panel, stroked};
use super::draw::svg::{JOIN, Rect, Svg};
use super::{FigureError, Picture, map};
use crate::ChanceReport;
use catchment_core::poses::Circumstance;
use catchment_study::chance::{ChanceMap, unit_of};
use std::fmt::Write;

/// Colour of exact motions.
const EXACT: Rgb = [0x1f, 0x29, 0x33];
/// Side of a map, and size of a chart, in SVG units.
const SIDE: f64 = 340.0;
const CHART: [f64; 2] = [400.0, 300.0];

/// Draws the map, and the curve, as far as they were requested.
///
/// # Errors
/// If neither was requested.
pub fn chance(report: &ChanceReport) -> Result<Picture, FigureError> {
    let map = report.map.as_ref().filter(|map| map.axes.len() == 2);
    if map.is_none() && report.curve.is_empty() {
        return Err(FigureError::Empty { what: "neither a map nor a curve against speed was requested" });
    }
    let lines = lines(report);
    let mut panels = Vec::new();
    if let Some(map) = map {
        let trials = map.cells.first().map_or(0, |cell| cell.trials);
        let border = "border of the poses that dock by exact quasi-static motion";
        panels.push(
            Panel::with_axes([SIDE; 2])
                .with_bar()
                .over(format!("share of {trials} trials that dock"))
                .under(Legend::default().line(stroked(EXACT, 2.0), border)),
        );
    }
    if !report.curve.is_empty() {
        panels.push(Panel::with_axes(CHART).over(chart::legend(&lines)));
    }
    let layout = story(report).into_iter().fold(Layout::of(&report.design), Layout::story);
    let (mut svg, frames) = layout.row(panels).open();
    if let Some(map) = map {
        cells(&mut svg, report, map, frames[0])?;
    }
    if let (false, Some(rect)) = (report.curve.is_empty(), frames.last()) {
        curve(&mut svg, report, &lines, *rect);
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

fn cells(svg: &mut Svg, report: &ChanceReport, map: &ChanceMap, rect: Rect) -> Result<(), FigureError> {
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
    svg.path(&border, &stroked(EXACT, 2.0));
    svg.end();
    frame.draw(svg);
    map::colour_bar(svg, &frame, AxisScale::new("docks [%]".to_owned(), 0.0, 100.0, false))
}

/// The speeds of the curve, if they are known at each point; if not, its factors.
fn place(report: &ChanceReport, times: f64, speed: f64) -> f64 {
    let (factor, _) = unit_of(&report.design, Circumstance::Speed);
    if has_speed(report) { speed * factor } else { times }
}

fn has_speed(report: &ChanceReport) -> bool {
    report.curve.iter().all(|at| at.speed > 0.0)
}

/// Place of the declared speed.
fn declared(report: &ChanceReport) -> Option<f64> {
    report.curve.first().map(|at| place(report, 1.0, at.speed / at.factor))
}

fn lines(report: &ChanceReport) -> Vec<ChartLine> {
    let percent = |share: f64| 100.0 * share;
    let mut points: Vec<ChartPoint> = report
        .curve
        .iter()
        .map(|at| ChartPoint {
            x: place(report, at.factor, at.speed),
            y: percent(at.probability),
            interval: Some(at.ci95.map(percent)),
        })
        .collect();
    if let (Some(overall), Some(x)) = (&report.overall, declared(report))
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
    lines
}

fn curve(svg: &mut Svg, report: &ChanceReport, lines: &[ChartLine], rect: Rect) {
    let (_, unit) = unit_of(&report.design, Circumstance::Speed);
    let x_label = if has_speed(report) {
        format!("mean approach speed [{unit}]")
    } else {
        "all speeds times".to_owned()
    };
    let mark = declared(report).map(|x| Mark { x, y: None, words: "as declared" });
    Chart { rect, x_label: &x_label, spacing: Spacing::Logarithmic, y_label: "docks [%]", lines, mark }
        .draw(svg);
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
        let requested =
            Question { errors: Some(Spread::normal(sigma)), times: vec![0.1, 4.0], ..Question::default() };
        let requested = requested.with_map(&problem, [Dof::X, Dof::Pitch], 8);
        let result = run(&problem, &requested, &settings, &Exec::new()).unwrap();
        let report = ChanceReport::new(problem.design(), result, Vec::new(), None);
        let picture = chance(&report).unwrap();
        look("chance", &picture);
        assert!(picture.svg().contains("share of 4 trials") && picture.svg().contains("as declared"));
        assert!(!picture.svg().contains("NaN"));
        let table = report.table();
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
        assert_eq!(report.records().len(), 1 + 1 + 2 + 64);
        assert!(report.records().iter().all(|record| record.len() == 13));
        let nothing = Question { poses: vec![PoseError::default()], ..Question::default() };
        let result = run(&problem, &nothing, &settings, &Exec::new()).unwrap();
        let report = ChanceReport::new(problem.design(), result, Vec::new(), None);
        assert!(matches!(chance(&report), Err(FigureError::Empty { .. })));
    }
}
