//! The success of robots against the factor of their standard deviations, and the gain from halving each of
//! them.

use super::Picture;
use super::draw::axis::{ShownUnits, short};
use super::draw::chart::{self, Chart, ChartLine, ChartPoint, Mark, Spacing};
use super::draw::colour::{CURVES, Rgb, hex};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK};
use crate::SuccessesReport;
use catchment_study::success::{RobotDocking, in_percent};

/// Colour of the required success.
const REQUIRED: Rgb = [0x5f, 0x6b, 0x7a];
/// Factors below this are of little interest: nearly all errors dock.
const LEAST: f64 = 0.25;
/// Left of the bars, and right of them for their numbers, in SVG units.
const GAP: f64 = 40.0;
const POINTS: f64 = 52.0;
/// Curves that are drawn: as many as there are colours.
const MOST: usize = CURVES.len();

/// Draws the success over the factor for each robot (the first five), and the gains of the robot with the
/// lowest success.
pub fn success(report: &SuccessesReport) -> Picture {
    let head = &report.success;
    let [lo, hi] = head.ci95.map(in_percent);
    let of = if report.robots.len() > 1 {
        format!(" of {}, the least of all,", head.robot)
    } else {
        String::new()
    };
    let story =
        format!("success{of} {}, from {lo} to {hi} with 95 % confidence", in_percent(head.probability));
    let lines = lines(report);
    let worst = report.worst();
    let halved = worst.map_or_else(String::new, |robot| match report.robots.len() {
        1 => "halved, one by one".to_owned(),
        _ => format!("halved, one by one: {}", robot.robot),
    });
    let size = [400.0, 300.0];
    let (mut svg, frames) = Layout::of(&report.design)
        .story(story)
        .row([
            Panel::with_axes(size).over(chart::legend(&lines)),
            Panel::of([300.0, size[1]]).with_room([GAP, 0.0, POINTS, 0.0]).over(halved),
        ])
        .open();
    Chart {
        rect: frames[0],
        x_label: "all standard deviations times",
        spacing: Spacing::Logarithmic,
        y_label: "success [%]",
        lines: &lines,
        mark: Some(Mark { x: 1.0, y: None, words: "as they are" }),
    }
    .draw(&mut svg);
    if let Some(robot) = worst {
        gains(&mut svg, report, robot, frames[1]);
    }
    Picture::of(svg)
}

fn lines(report: &SuccessesReport) -> Vec<ChartLine> {
    let percent = |share: f64| 100.0 * share;
    let of = |(k, robot): (usize, &RobotDocking)| ChartLine {
        name: robot.robot.clone(),
        colour: CURVES[k % CURVES.len()],
        points: robot
            .curve
            .iter()
            .filter(|at| at.factor >= LEAST)
            .map(|at| ChartPoint {
                x: at.factor,
                y: percent(at.probability),
                interval: Some(at.ci95.map(percent)),
            })
            .collect(),
    };
    let mut lines: Vec<ChartLine> = report.robots.iter().take(MOST).enumerate().map(of).collect();
    let factors = || lines.iter().flat_map(|line| line.points.iter().map(|point| point.x));
    let ends = [factors().fold(f64::INFINITY, f64::min), factors().fold(0.0, f64::max)];
    let required = percent(report.settings.required);
    lines.push(ChartLine {
        name: format!("{} % required", short(required)),
        colour: REQUIRED,
        points: ends.map(|x| ChartPoint { x, y: required, interval: None }).to_vec(),
    });
    lines
}

/// A bar for each error, with the interval of its gain; if all gains are zero, a line.
fn gains(svg: &mut Svg, report: &SuccessesReport, robot: &RobotDocking, rect: Rect) {
    let units = ShownUnits::of(&report.design);
    let (low, high) = robot.improve.iter().fold((0.0f64, 0.0f64), |(low, high), improve| {
        let [lo, hi] = improve.gain_ci95;
        (low.min(lo.min(improve.gain)), high.max(hi.max(improve.gain)))
    });
    let span = (high - low).max(1e-6);
    let px = |gain: f64| rect.x + (gain - low) / span * rect.w;
    let count = robot.improve.len().max(1) as f64;
    let each = (rect.h / count).min(64.0);
    for (k, improve) in robot.improve.iter().enumerate() {
        let top = rect.y + each * k as f64;
        let middle = top + 0.62 * each;
        let name = format!(
            "{} {} {}",
            improve.axis.name(),
            short(improve.sigma * units.factor(improve.axis)),
            if improve.axis.is_rotation() { "deg" } else { units.symbol() }
        );
        svg.text([rect.x, top + 0.3 * each], TICK, Anchor::Start, SOFT, &name);
        let (from, to) = (px(0.0).min(px(improve.gain)), px(0.0).max(px(improve.gain)));
        let bar = Rect { x: from, y: middle - 0.16 * each, w: (to - from).max(0.5), h: 0.32 * each };
        let colour = hex(CURVES[improve.axis.index() % CURVES.len()]);
        svg.rect(bar, &format!(r#"fill="{colour}" fill-opacity="0.75" stroke="none""#));
        let whisker = format!(r#"stroke="{INK}" stroke-width="1.2""#);
        let [lo, hi] = improve.gain_ci95.map(px);
        svg.line([lo, middle], [hi, middle], &whisker);
        for end in [lo, hi] {
            svg.line([end, middle - 3.5], [end, middle + 3.5], &whisker);
        }
        let points = format!("{:+.2}", 100.0 * improve.gain).replace('-', "−");
        svg.text([rect.x + rect.w + 10.0, middle + 4.0], LABEL, Anchor::Start, INK, &points);
    }
    let bottom = rect.y + each * count;
    svg.line([px(0.0), rect.y], [px(0.0), bottom], &format!(r#"stroke="{SOFT}" stroke-width="1""#));
    svg.text(
        [rect.x, bottom + 22.0],
        TICK,
        Anchor::Start,
        SOFT,
        "gain of success, in percentage points, with its 95 % interval",
    );
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::exec::Exec;
    use catchment_core::pose::{Dof, PoseError};
    use catchment_core::poses::{Robot, Spread};
    use catchment_core::problem::Problem;
    use catchment_study::success::{Factor, SuccessSettings, run};

    #[test]
    fn curves_and_gains_are_drawn() {
        let problem = Problem::of(design([Dof::X, Dof::Pitch].into_iter().collect())).unwrap();
        let robot = |name: &str, sigma: f64| Robot {
            name: name.to_owned(),
            errors: Spread::normal(PoseError { x: sigma, pitch: 2.0 * sigma, ..PoseError::default() }),
        };
        let settings = SuccessSettings { motions: Some(400), required: 0.9, ..SuccessSettings::default() };
        let result = run(&problem, &[robot("arm A", 0.15), robot("arm B", 0.1)], &settings, &Exec::new());
        let report = SuccessesReport::new(problem.design(), result.unwrap(), Vec::new(), None);
        let picture = success(&report);
        look("success", &picture);
        assert!(picture.svg().contains("90 % required") && picture.svg().contains("arm B"));
        let head = in_percent(report.success.probability);
        assert!(
            picture.svg().contains(&format!("success of {}, the least of all, {head}", report.success.robot))
        );
        assert!(!picture.svg().contains("NaN"));
    }

    /// An interval that begins at 0 has only an upper end.
    #[test]
    fn a_factor_that_is_known_from_above_alone_is_shown_so() {
        let problem = Problem::of(design([Dof::X].into_iter().collect())).unwrap();
        let errors = Spread::normal(PoseError { x: 0.2, ..PoseError::default() });
        let robots = [Robot { name: "robot".to_owned(), errors }];
        let settings = SuccessSettings { motions: Some(100), ..SuccessSettings::default() };
        let result = run(&problem, &robots, &settings, &Exec::new()).unwrap();
        let mut report = SuccessesReport::new(problem.design(), result, Vec::new(), None);
        let all = &mut report.robots[0].tolerable.all;
        *all = Factor { factor: 1.08, ci95: [0.0, 1.12], is_more: false, is_less: false };
        let text = report.table();
        assert!(text.contains("times 1.08 (95 % CI: at most"), "{text}");
        assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
        report.robots[0].tolerable.all.ci95[0] = 0.9;
        let text = report.table();
        assert!(text.contains("(95 % CI 0.90 … 1.12)") && !text.contains("lower end"), "{text}");
    }
}
