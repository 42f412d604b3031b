//! The zero-rotation area of acceptance in theory and by trials, side by side over the error box: a dot for
//! every trial, ringed if it is on the wrong side.

use super::super::TrialsReport;
use super::Picture;
use super::draw::axis::{AxisScale, PlotFrame, ShownUnits};
use super::draw::colour::{self, hex};
use super::draw::layout::{Layout, Legend, Panel};
use super::draw::svg::{JOIN, Rect, SOFT, Svg, polyline};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::document::{percent, significant};
use catchment_core::method::zraa::Zraa;
use catchment_core::pose::Dof;
use catchment_study::trials::{RoundTrial, Trials};

/// Side of a panel, in SVG units; a panel of a single error is low.
const SIDE: f64 = 360.0;
const LOW: f64 = 60.0;
/// A trial on the wrong side.
const WRONG: &str = "#c62f2f";

/// Draws the exact region and the trials of the last round.
pub fn trials(report: &TrialsReport) -> Picture {
    let (design, found) = (&report.design, &report.result);
    let height = if found.grid.axes.len() == 2 { SIDE } else { LOW };
    let unit = found.unit;
    let round = found.rounds.last();
    let text = round.map_or_else(String::new, |round| {
        let [lo, hi] = round.disagreeing_ci95.map(percent);
        let step = round.timestep.map_or_else(String::new, |step| format!(", time step {step} s"));
        format!(
            "{} trials by {}{step}: {} of the error box on the wrong side (95 %: {lo} … {hi})",
            round.trials,
            found.method,
            percent(round.disagreeing),
        )
    });
    let accepted = round.map_or(0.0, |round| round.accepted);
    let panel = |words: &str, measure: f64| {
        Panel::with_axes([SIDE, height]).over(format!("{words}: {} {unit}", significant(measure)))
    };
    let (mut svg, frames) = Layout::of(design)
        .story("corrected without rotation, in theory and by trials")
        .story(text)
        .row([panel("exact", found.exact), panel("trials", accepted)])
        .legend(legend(found))
        .open();
    region(&mut svg, &frame(design, found, frames[0]), design, &found.zraa, true);
    let of_trials = frame(design, found, frames[1]);
    region(&mut svg, &of_trials, design, &found.zraa, false);
    dots(&mut svg, &of_trials, design, found);
    Picture::of(svg)
}

fn frame(design: &Design, found: &Trials, rect: Rect) -> PlotFrame {
    let units = ShownUnits::of(design);
    let axes = &found.grid.axes;
    let nothing = || AxisScale::new(String::new(), 0.0, 0.0, false);
    let scale = |k: usize| axes.get(k).map_or_else(nothing, |axis| units.axis(axis));
    PlotFrame { rect, x: scale(0), y: scale(1) }
}

/// The exact region, filled or as an outline of its tiles, and the axes.
fn region(svg: &mut Svg, frame: &PlotFrame, design: &Design, zraa: &Zraa, filled: bool) {
    let rect = frame.rect;
    let factor = ShownUnits::of(design).lengths();
    let fill = hex(colour::outcome(Outcome::Aligned));
    svg.rect(rect, &format!(r#"fill="{}""#, hex(colour::NOTHING)));
    svg.begin_clip(rect);
    let opacity = if filled { 1.0 } else { 0.22 };
    // Tiles share borders; semi-transparent strokes would show as lines.
    let line = if filled { format!(r#" stroke="{fill}" stroke-width="0.6""#) } else { String::new() };
    let style = format!(r#"fill="{fill}" fill-opacity="{opacity}"{line} {JOIN}"#);
    match zraa {
        Zraa::Region { polygons, .. } => {
            let tiles: String = polygons
                .iter()
                .map(|tile| polyline(tile.iter().map(|p| frame.at([p.x * factor, p.y * factor])), true))
                .collect();
            svg.path(&tiles, &style);
        }
        Zraa::Interval { from, to, .. } => {
            let [from, to] = [from, to].map(|end| frame.px(end * factor));
            svg.rect(Rect { x: from, w: to - from, ..rect }, &style);
        }
    }
    svg.end();
    frame.draw(svg);
}

fn dots(svg: &mut Svg, frame: &PlotFrame, design: &Design, found: &Trials) {
    let factor = ShownUnits::of(design).lengths();
    let cells = found.grid.axes.iter().map(|axis| axis.cells).max().unwrap_or(1);
    let radius = (0.3 * frame.rect.w / cells as f64).clamp(0.8, 4.0);
    let line = frame.rect.y + 0.5 * frame.rect.h;
    let place = |trial: &RoundTrial| match &found.zraa {
        Zraa::Region { .. } => frame.at([trial.x * factor, trial.y * factor]),
        Zraa::Interval { axis, .. } => {
            let along = if *axis == Dof::X { trial.x } else { trial.y };
            [frame.px(along * factor), line]
        }
    };
    // Wrong trials on top.
    let mut order: Vec<&RoundTrial> = found.trials.iter().collect();
    order.sort_by_key(|trial| is_wrong(trial));
    for trial in order {
        svg.circle(place(trial), radius, &style(trial.outcome, is_wrong(trial)));
    }
}

fn is_wrong(trial: &RoundTrial) -> bool {
    trial.inside != (trial.outcome == Outcome::Aligned)
}

fn style(outcome: Outcome, wrong: bool) -> String {
    let fill = match outcome {
        // On grey ground its own colour would not show.
        Outcome::Missed => "#ffffff".to_owned(),
        other => hex(colour::outcome(other)),
    };
    let (edge, width) = if wrong { (WRONG, 1.6) } else { (SOFT, 0.5) };
    format!(r#"fill="{fill}" stroke="{edge}" stroke-width="{width}""#)
}

fn legend(found: &Trials) -> Legend {
    let met = |outcome: &Outcome| found.trials.iter().any(|trial| trial.outcome == *outcome);
    Outcome::ALL
        .into_iter()
        .filter(met)
        .fold(Legend::default(), |legend, outcome| legend.dot(style(outcome, false), outcome.word()))
        .dot(style(Outcome::Missed, true), "on the wrong side of the exact border")
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::design as design_of;
    use catchment_core::landscape::Grid;
    use catchment_study::trials::Round;
    use serde_json::Value;

    /// Two trials along x, one of them on the wrong side.
    fn line() -> (Design, Trials) {
        let design = design_of([Dof::X].into_iter().collect());
        let round = Round {
            resolution: 2,
            timestep: Some(1e-3),
            trials: 2,
            rejected_inside: 1,
            accepted_outside: 0,
            undecided: 0,
            disagreeing: 0.5,
            disagreeing_ci95: [0.1, 0.9],
            measure: 1.0,
            measure_ci95: [0.2, 1.8],
            accepted: 1.0,
        };
        let trial = |x: f64, outcome| RoundTrial { x, y: 0.0, outcome, inside: true };
        let trials = Trials {
            method: "descent",
            settings: Value::Null,
            seed: 7,
            unit: "D",
            exact: 1.0,
            rounds: vec![round],
            trials: vec![trial(-0.25, Outcome::Aligned), trial(0.25, Outcome::Jammed)],
            zraa: Zraa::Interval { axis: Dof::X, from: -0.5, to: 0.5 },
            grid: Grid::over(&design.alignment, |_| 2),
        };
        (design, trials)
    }

    #[test]
    fn rounds_and_trials_are_reported() {
        let (design, found) = line();
        let report = TrialsReport::new(&design, found, Vec::new(), None);
        let json: Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
        assert_eq!((&json["kind"], &json["unit"], &json["seed"]), (&"trials".into(), &"D".into(), &7.into()));
        assert_eq!(json["rounds"][0]["rejected_inside"], 1);
        assert_eq!(
            (&json["trials"][1]["outcome"], &json["trials"][1]["inside"]),
            (&"jammed".into(), &true.into())
        );
        let table = report.table();
        assert!(table.contains("50.00 % (10.00 % … 90.00 %)") && table.contains("0.001"), "{table}");
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
        assert_eq!(
            report.records(),
            [
                vec!["x", "outcome", "inside"],
                vec!["-0.25", "aligned", "true"],
                vec!["0.25", "jammed", "true"]
            ]
        );
    }

    #[test]
    fn theory_and_trials_are_drawn_side_by_side() {
        let (design, line) = line();
        let picture = trials(&TrialsReport::new(&design, line.clone(), Vec::new(), None));
        look("trials-line", &picture);
        let design = design_of([Dof::X, Dof::Y].into_iter().collect());
        let corner = |x: f64, y: f64| glam::DVec2::new(x, y);
        let polygons = vec![vec![corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)]];
        let grid = Grid::over(&design.alignment, |_| 12);
        let last = (0..144)
            .map(|k| {
                let error = grid.pose(k);
                let inside = error.x.abs().max(error.y.abs()) < 0.5;
                let aligned = inside != (k % 17 == 0);
                let outcome = if aligned { Outcome::Aligned } else { Outcome::Missed };
                RoundTrial { x: error.x, y: error.y, outcome, inside }
            })
            .collect();
        let zraa = Zraa::Region { polygons, area: 1.0, seam: 0.0 };
        let region = Trials { zraa, grid, trials: last, unit: "D²", ..line };
        let picture = trials(&TrialsReport::new(&design, region, Vec::new(), None));
        look("trials-region", &picture);
        assert!(picture.svg().contains("on the wrong side") && !picture.svg().contains("NaN"));
    }
}
