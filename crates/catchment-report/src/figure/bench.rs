//! Trials of a plan over the accepted set: a panel for each combination of the errors off the plane.

use super::super::{PlanReport, ValidationReport};
use super::Picture;
use super::draw::axis::{AxisScale, PlotFrame, ShownUnits, short};
use super::draw::colour::{self, Rgb, hex, mix};
use super::draw::layout::{self, Layout, Legend};
use super::draw::svg::{INK, JOIN, Rect, SOFT, Svg, polyline};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::document::percent;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::ObservedOutcome;
use catchment_study::plan::{BenchSlice, CELLS, PlannedPose};
use catchment_study::validate::PredictedTrial;

/// A trial with another outcome than predicted.
const WRONG: &str = "#c62f2f";
/// Docked, and did not.
const DOCKED: &str = "#123a5c";
const FAILED: &str = "#8a4b00";
/// Size of a panel, in SVG units; a panel of a single error is low.
const SIDE: f64 = 250.0;
const LOW: f64 = 70.0;
/// Panels beside each other.
const PER_ROW: usize = 3;

/// Mark of a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shape {
    Docks,
    Fails,
    Either,
    NotMade,
}

/// A pose to draw.
struct Mark {
    error: PoseError,
    shape: Shape,
    wrong: bool,
}

/// Draws the poses of a plan, with their predictions.
pub fn plan(report: &PlanReport, panels: &[BenchSlice]) -> Picture {
    let of = |point: &PlannedPose| Mark {
        error: point.error,
        shape: match (point.prediction.either, point.prediction.docks()) {
            (true, _) => Shape::Either,
            (false, true) => Shape::Docks,
            (false, false) => Shape::Fails,
        },
        wrong: false,
    };
    let marks: Vec<Mark> = report.points.iter().map(of).collect();
    let counts = &report.counts;
    let story = format!(
        "{} trials at {} poses: {} decide, {} nearer to the border than the robot's accuracy",
        counts.trials, counts.poses, counts.deciding, counts.either
    );
    let words = [
        (Shape::Docks, false, "should dock"),
        (Shape::Fails, false, "should not"),
        (Shape::Either, false, "may go either way"),
    ];
    draw(&report.design, &story, &marks, panels, &words)
}

/// Draws the observed outcomes of trials over the predictions.
pub fn validation(report: &ValidationReport, panels: &[BenchSlice]) -> Picture {
    let of = |trial: &PredictedTrial| Mark {
        error: trial.point.error,
        shape: match trial.observed {
            None => Shape::NotMade,
            Some(ObservedOutcome::Aligned) => Shape::Docks,
            Some(ObservedOutcome::AlignedElsewhere) if report.design.alignment.symmetry > 1 => Shape::Docks,
            Some(_) => Shape::Fails,
        },
        wrong: trial.disagrees,
    };
    let marks: Vec<Mark> = report.trials.iter().map(of).collect();
    let agreement = &report.agreement;
    let agreed = agreement.share.map_or_else(String::new, |share| {
        let [low, high] = agreement.ci95.map(percent);
        format!(
            "; {} of {} as predicted, {} ({low} … {high})",
            agreement.agreed,
            agreement.trials,
            percent(share)
        )
    });
    let story = format!("{}{agreed}", report.verdict.name());
    let words = [
        (Shape::Docks, false, "docked"),
        (Shape::Fails, false, "did not"),
        (Shape::Fails, true, "not as predicted"),
        (Shape::NotMade, false, "not made"),
    ];
    draw(&report.design, &story, &marks, panels, &words)
}

fn draw(
    design: &Design,
    story: &str,
    marks: &[Mark],
    panels: &[BenchSlice],
    words: &[(Shape, bool, &str)],
) -> Picture {
    let units = ShownUnits::of(design);
    let height = if panels.iter().any(|panel| panel.across.len() > 1) { SIDE } else { LOW };
    let panel = |panel: &BenchSlice| layout::Panel::with_axes([SIDE, height]).over(beside(panel, &units));
    let (mut svg, frames) = Layout::of(design)
        .story(story)
        .story(note(panels))
        .grid(PER_ROW, panels.iter().map(panel))
        .legend(legend(marks, words, panels.iter().any(|panel| !panel.is_projection())))
        .open();
    for (panel, rect) in panels.iter().zip(frames) {
        one(&mut svg, panel, marks, &units, rect);
    }
    Picture::of(svg)
}

/// Relation of the poses to the background, if it is not obvious.
fn note(panels: &[BenchSlice]) -> &'static str {
    let is_near =
        |panel: &BenchSlice| panel.others.iter().any(|(_, ends)| BenchSlice::middle(*ends).1.is_some());
    if panels.iter().any(BenchSlice::is_projection) {
        "projections: the errors that a panel does not show differ from pose to pose, and no region belongs to all of them"
    } else if panels.iter().any(is_near) {
        "a slice lies at the middle of its poses, which are within the robot's accuracy of it"
    } else {
        ""
    }
}

fn legend(marks: &[Mark], words: &[(Shape, bool, &str)], has_region: bool) -> Legend {
    let region =
        has_region.then(|| format!(r#"fill="{}" stroke="{SOFT}" stroke-width="0.5""#, hex(region())));
    let legend =
        region.map_or_else(Legend::default, |style| Legend::default().square(style, "docks, exactly"));
    let occurs = |shape: Shape, wrong: bool| {
        marks.iter().any(|mark| if wrong { mark.wrong } else { mark.shape == shape })
    };
    words.iter().filter(|(shape, wrong, _)| occurs(*shape, *wrong)).fold(
        legend,
        |legend, (shape, wrong, words)| {
            let (shape, wrong) = (*shape, *wrong);
            legend.mark(*words, move |svg, at| mark(svg, at, shape, wrong))
        },
    )
}

/// The errors that a panel does not show: `yaw = 20°`, `yaw = 20° ± 0.3°`, and of a projection `yaw −5 … 12 deg`.
fn beside(panel: &BenchSlice, units: &ShownUnits) -> String {
    let words = |(axis, ends): &(Dof, [f64; 2])| {
        let shown = |value: f64| short(value * units.factor(*axis));
        if panel.is_projection() {
            let unit = if axis.is_rotation() { "deg" } else { units.symbol() };
            return format!("{} {} … {} {unit}", axis.name(), shown(ends[0]), shown(ends[1]));
        }
        let (middle, off) = BenchSlice::middle(*ends);
        let unit = if axis.is_rotation() { "°".to_owned() } else { format!(" {}", units.symbol()) };
        let off = off.map_or_else(String::new, |off| format!(" ± {}{unit}", shown(off)));
        units.value(*axis, middle) + &off
    };
    panel.others.iter().map(words).collect::<Vec<_>>().join(", ")
}

/// The shade of the accepted set: light, so that marks are visible.
fn region() -> Rgb {
    const LIGHT: f64 = 0.62;
    mix(colour::outcome(Outcome::Aligned), [0xff, 0xff, 0xff], LIGHT)
}

fn one(svg: &mut Svg, panel: &BenchSlice, marks: &[Mark], units: &ShownUnits, rect: Rect) {
    let nothing = || AxisScale::new(String::new(), 0.0, 1.0, false);
    let scale = |k: usize| {
        panel.across.get(k).map_or_else(nothing, |(axis, [lo, hi])| {
            let factor = units.factor(*axis);
            AxisScale::new(units.label(*axis), lo * factor, hi * factor, axis.is_rotation())
        })
    };
    let planar = panel.across.len() > 1;
    let frame = PlotFrame { rect, x: scale(0), y: scale(1) };
    if !panel.is_projection() {
        svg.rect(rect, &format!(r#"fill="{}""#, hex(colour::NOTHING)));
    }
    svg.begin_clip(rect);
    cells(svg, panel, rect);
    let value = |error: &PoseError, axis: Dof| error.to_array()[axis.index()] * units.factor(axis);
    // Wrong predictions on top.
    for wrong in [false, true] {
        for result in panel.poses.iter().map(|k| &marks[*k]).filter(|result| result.wrong == wrong) {
            let place = |k: usize| panel.across.get(k).map(|(axis, _)| value(&result.error, *axis));
            let x = frame.px(place(0).unwrap_or(0.0));
            let y = place(1).map_or(rect.y + 0.5 * rect.h, |y| frame.py(y));
            mark(svg, [x, y], result.shape, result.wrong);
        }
    }
    svg.end();
    if planar {
        frame.draw(svg);
    } else {
        frame.below(svg);
        frame.outline(svg);
    }
}

/// The accepted set: runs of cells, row by row.
fn cells(svg: &mut Svg, panel: &BenchSlice, rect: Rect) {
    let rows = panel.cells.len() / CELLS;
    if rows == 0 {
        return;
    }
    let [w, h] = [rect.w / CELLS as f64, rect.h / rows as f64];
    let mut data = String::new();
    for (row, cells) in panel.cells.chunks(CELLS).enumerate() {
        let y = rect.y + rect.h - (row + 1) as f64 * h;
        let mut from = None;
        for column in 0..=CELLS {
            let docks = cells.get(column).copied().unwrap_or(false);
            match (from, docks) {
                (None, true) => from = Some(column),
                (Some(start), false) => {
                    let [x0, x1] = [start, column].map(|k| rect.x + k as f64 * w);
                    let corners = [[x0, y], [x1, y], [x1, y + h], [x0, y + h]];
                    data.push_str(&polyline(corners, true));
                    from = None;
                }
                _ => {}
            }
        }
    }
    let fill = hex(region());
    svg.path(&data, &format!(r#"fill="{fill}" stroke="{fill}" stroke-width="0.5" {JOIN}"#));
}

/// ● docks, × fails, ◇ may do either, ○ not made; ringed if the outcome differs from the prediction.
fn mark(svg: &mut Svg, [x, y]: [f64; 2], shape: Shape, wrong: bool) {
    const SIZE: f64 = 3.6;
    match shape {
        Shape::Docks => {
            svg.circle([x, y], SIZE, &format!(r##"fill="{DOCKED}" stroke="#ffffff" stroke-width="0.7""##));
        }
        Shape::Fails => {
            let style = format!(r#"stroke="{FAILED}" stroke-width="2" {JOIN}"#);
            let s = 0.85 * SIZE;
            svg.line([x - s, y - s], [x + s, y + s], &style);
            svg.line([x - s, y + s], [x + s, y - s], &style);
        }
        Shape::Either => {
            let s = 1.3 * SIZE;
            let [n, e, z, w] = [y - s, x + s, y + s, x - s];
            let data = format!("M{x:.2} {n:.2}L{e:.2} {y:.2}L{x:.2} {z:.2}L{w:.2} {y:.2}Z");
            svg.path(&data, &format!(r##"fill="#ffffff" stroke="{INK}" stroke-width="1.1" {JOIN}"##));
        }
        Shape::NotMade => {
            svg.circle([x, y], SIZE, &format!(r#"fill="none" stroke="{SOFT}" stroke-width="0.9""#));
        }
    }
    if wrong {
        svg.circle([x, y], 1.9 * SIZE, &format!(r#"fill="none" stroke="{WRONG}" stroke-width="1.6""#));
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::exec::Exec;
    use catchment_core::method::descent;
    use catchment_core::poses::RobotTrial;
    use catchment_core::problem::Problem;
    use catchment_study::plan::{Pattern, TrialPlanSettings, panels, run};
    use catchment_study::validate;

    #[test]
    fn plans_and_verdicts_are_drawn() {
        let problem = Problem::of(design([Dof::X, Dof::Pitch].into_iter().collect())).unwrap();
        let accuracy = PoseError { x: 0.03, pitch: 0.06, ..PoseError::default() };
        let pattern = Pattern::Grid { steps: [Some(7), None, None, Some(5), None], max: [None; 5] };
        let result = run(&problem, &TrialPlanSettings::new(pattern, accuracy), &Exec::new()).unwrap();
        let poses: Vec<PoseError> = result.points.iter().map(|point| point.error).collect();
        let motions = descent::DescentSettings::default();
        let slices = panels(&problem, &poses, &accuracy, &motions, &Exec::new()).unwrap();
        assert_eq!((slices.len(), slices[0].poses.len(), slices[0].cells.len()), (1, 35, CELLS * CELLS));
        let report = PlanReport::new(problem.design(), result, Vec::new(), None);
        let picture = plan(&report, &slices);
        look("plan", &picture);
        assert!(picture.svg().contains("35 trials at 35 poses") && !picture.svg().contains("NaN"));
        let observed =
            |k: usize| [Some(ObservedOutcome::Aligned), Some(ObservedOutcome::Jammed), None][k % 3];
        let tried = |(k, error): (usize, &PoseError)| RobotTrial {
            trial: k as u64 + 1,
            line: 1,
            error: *error,
            observed: observed(k),
            predicted: None,
        };
        let tried: Vec<RobotTrial> = poses.iter().enumerate().map(tried).collect();
        let judged =
            validate::run(&problem, &tried, &validate::ValidationSettings::new(accuracy), &Exec::new())
                .unwrap();
        let report = ValidationReport::new(problem.design(), judged, Vec::new(), None);
        let picture = validation(&report, &slices);
        look("validation", &picture);
        assert!(picture.svg().contains("inconsistent; ") && picture.svg().contains("not made"));
        // Every disagreement is ringed once, and once more in the key.
        assert_eq!(picture.svg().matches(WRONG).count(), report.disagreements.len() + 1);
    }

    /// Poses of many yaws were drawn over the slice of the nearest of four: blue under crosses, grey under dots.
    #[test]
    fn poses_are_drawn_only_over_their_own_slice() {
        let free = [Dof::X, Dof::Y, Dof::Yaw].into_iter().collect();
        let problem = Problem::of(design(free)).unwrap();
        let accuracy = PoseError { x: 0.03, y: 0.03, yaw: 0.02, ..PoseError::default() };
        let drawn = |yaws: &[f64]| {
            let pose = |(k, yaw): (usize, &f64)| PoseError {
                x: 0.1 * (k % 5) as f64,
                y: 0.07 * (k % 7) as f64,
                yaw: *yaw,
                ..PoseError::default()
            };
            let poses: Vec<PoseError> = yaws.iter().enumerate().map(pose).collect();
            let motions = descent::DescentSettings::default();
            let result = panels(&problem, &poses, &accuracy, &motions, &Exec::new()).unwrap();
            let marks: Vec<Mark> =
                poses.iter().map(|error| Mark { error: *error, shape: Shape::Docks, wrong: false }).collect();
            let words = [(Shape::Docks, false, "should dock")];
            (draw(problem.design(), "a story", &marks, &result, &words), result)
        };
        let region = format!(r#"fill="{}""#, hex(region()));
        let dots = |picture: &Picture| picture.svg().matches(&format!(r#"fill="{DOCKED}""#)).count();
        // As recorded: about three angles, each within the accuracy of its slice.
        let yaws: Vec<f64> = (0..30).map(|k| 0.3 * f64::from(k % 3) + 0.0005 * f64::from(k)).collect();
        let (picture, result) = drawn(&yaws);
        look("plan-near", &picture);
        assert_eq!(result.iter().map(|panel| panel.poses.len()).collect::<Vec<_>>(), [10, 10, 10]);
        for panel in &result {
            let (middle, off) = BenchSlice::middle(panel.others[0].1);
            let far = |k: &usize| (yaws[*k] - middle).abs() > accuracy.yaw;
            assert!(off.is_some_and(|off| off <= accuracy.yaw) && !panel.poses.iter().any(far));
        }
        assert!(picture.svg().contains("yaw = 0.39° ± 0.39°") && picture.svg().contains(&region));
        assert_eq!(dots(&picture), 30 + 1);
        // Thirty angles: all poses over each pair of errors, and no region.
        let yaws: Vec<f64> = (0..30).map(|k| 0.05 * f64::from(k)).collect();
        let (picture, result) = drawn(&yaws);
        look("plan-projected", &picture);
        assert!(result.len() == 3 && result.iter().all(BenchSlice::is_projection));
        assert!(picture.svg().contains("yaw 0 … 83.1 deg") && picture.svg().contains("projections: "));
        assert!(!picture.svg().contains(&region) && !picture.svg().contains("docks, exactly"));
        assert_eq!(dots(&picture), 3 * 30 + 1);
    }
}
