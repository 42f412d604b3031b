//! Share of the frictionless successes that still docks at each friction coefficient, and the contacts that
//! stick first.
//!
//! ```text
//!   100 % ──●──●           every point is a share of the poses that dock without friction: those that dock still. Poses that dock only
//!    95 % ┄┄┄┄┄╲┄          with friction are in the table and not in the curve, on which the critical friction is read off.
//!           ┊   ●──●
//!           critical
//! ```

use super::Picture;
use super::draw::axis::short;
use super::draw::chart::{self, Chart, ChartLine, ChartPoint, Mark, Spacing};
use super::draw::colour::{CURVES, Rgb, hex};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, width_of};
use crate::FrictionReport;
use catchment_core::document::Share;
use catchment_study::friction::StickingPair;

/// Colour of the static test.
const STATIC: Rgb = [0x5f, 0x6b, 0x7a];
/// Pairs of features that are drawn.
const SHOWN: usize = 5;

/// Draws the share of frictionless successes that still docks, and the features on which the first poses
/// stick.
pub fn friction(report: &FrictionReport) -> Picture {
    let marked = report.kept.iter().find(|kept| kept.share == MARKED);
    let story = marked.map_or_else(String::new, |kept| {
        let [lo, hi] = kept.ci95.map(|friction| report.up_to(friction));
        let share = short(100.0 * kept.share);
        if kept.is_top {
            format!(
                "{share} % of the poses that dock without friction also dock at {}, the largest coefficient tried",
                short(kept.friction)
            )
        } else {
            let friction = kept.friction;
            format!("{share} % of the poses that dock without friction also dock up to a coefficient of {friction:.3} ({lo} … {hi})")
        }
    });
    let (lines, words) = (lines(report), format!("{} %", short(100.0 * MARKED)));
    let first = &report.sticks_first;
    let size = [400.0, 300.0];
    let mut panels = vec![Panel::with_axes(size).over(chart::legend(&lines))];
    if !first.features.is_empty() {
        panels.push(
            Panel::of([380.0, size[1]]).over(format!("contacts that stick first, in {} poses", first.poses)),
        );
    }
    let (mut svg, frames) = Layout::of(&report.design).story(story).row(panels).open();
    Chart {
        rect: frames[0],
        x_label: "friction coefficient μ",
        spacing: Spacing::Even,
        y_label: "share of frictionless successes [%]",
        lines: &lines,
        mark: marked.filter(|kept| !kept.is_top).map(|kept| Mark {
            x: kept.friction,
            y: Some(100.0 * kept.share),
            words: &words,
        }),
    }
    .draw(&mut svg);
    if let Some(rect) = frames.get(1) {
        sticking(&mut svg, &first.features, *rect);
    }
    Picture::of(svg)
}

/// The share of frictionless successes whose critical friction is marked.
const MARKED: f64 = 0.95;

/// The poses that dock without friction and still dock, and those that the static test predicts to dock, as
/// shares of the first.
fn lines(report: &FrictionReport) -> Vec<ChartLine> {
    let percent = |share: f64| 100.0 * share;
    let base = report.curve.first().map_or(0, |rung| rung.aligned.count);
    let rungs = || report.curve.iter().filter(|_| base > 0);
    let still = rungs().map(|rung| {
        let kept = Share::of(base - rung.lost, base);
        ChartPoint { x: rung.friction, y: percent(kept.share), interval: Some(kept.ci95.map(percent)) }
    });
    let by_statics = rungs().map(|rung| ChartPoint {
        x: rung.friction,
        y: percent(rung.static_docks as f64 / base as f64),
        interval: None,
    });
    vec![
        ChartLine { name: "static test".to_owned(), colour: STATIC, points: by_statics.collect() },
        ChartLine { name: "docks (motion followed)".to_owned(), colour: CURVES[0], points: still.collect() },
    ]
}

/// A bar for each pair of features, and its words above.
fn sticking(svg: &mut Svg, features: &[StickingPair], rect: Rect) {
    let each = rect.h / SHOWN as f64;
    for (k, pair) in features.iter().take(SHOWN).enumerate() {
        let y = rect.y + each * k as f64;
        for (line, words) in words(pair).iter().enumerate() {
            svg.text(
                [rect.x, y + 12.0 + 14.0 * line as f64],
                TICK,
                Anchor::Start,
                SOFT,
                &fitting(words, rect.w),
            );
        }
        let bar = Rect { x: rect.x, y: y + 33.0, w: (pair.share * (rect.w - 50.0)).max(0.5), h: 12.0 };
        let colour = hex(CURVES[0]);
        svg.rect(bar, &format!(r#"fill="{colour}" fill-opacity="0.75" stroke="none""#));
        let percent = format!("{} %", short(100.0 * pair.share));
        svg.text([bar.x + bar.w + 6.0, bar.y + 10.0], LABEL, Anchor::Start, INK, &percent);
    }
}

fn words(pair: &StickingPair) -> [String; 2] {
    [format!("moving half: {}", pair.moving.name), format!("on the fixed half's {}", pair.fixed.name)]
}

/// As much of the words as fits.
fn fitting(words: &str, width: f64) -> String {
    if width_of(words, TICK) <= width {
        return words.to_owned();
    }
    let mut short: String = words.to_owned();
    while short.pop().is_some() && width_of(&short, TICK) + width_of("…", TICK) > width {}
    short + "…"
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::exec::Exec;
    use catchment_core::pose::Dof;
    use catchment_core::problem::Problem;
    use catchment_study::friction::{FrictionSettings, run};

    /// The curve was that of all poses that dock, those among them that dock only with friction, under a mark that counts the lost alone.
    fn the_curve_is_that_of_the_mark(report: &FrictionReport, picture: &Picture) {
        let document = resvg::usvg::roxmltree::Document::parse(picture.svg()).unwrap();
        let number = |node: &resvg::usvg::roxmltree::Node, name| -> f64 {
            node.attribute(name).unwrap().parse().unwrap()
        };
        let colour = hex(CURVES[0]);
        let dots = document
            .descendants()
            .filter(|node| node.has_tag_name("circle") && node.attribute("fill") == Some(colour.as_str()));
        let heights: Vec<f64> = dots.map(|node| number(&node, "cy")).collect();
        let base = report.curve[0].aligned.count as f64;
        let kept: Vec<f64> = report.curve.iter().map(|rung| (base - rung.lost as f64) / base).collect();
        assert_eq!(heights.len(), kept.len());
        let last = kept.len() - 1;
        assert!(kept[last] < 0.95 && kept[0] == 1.0, "{kept:?}");
        let per_share = (heights[last] - heights[0]) / (kept[0] - kept[last]);
        for (height, share) in heights.iter().zip(&kept) {
            assert!((height - heights[0] - (1.0 - share) * per_share).abs() < 0.02, "{heights:?} {kept:?}");
        }
        // The dashed level is at 95 % of the curve.
        let dashed = document.descendants().filter(|node| node.attribute("stroke-dasharray").is_some());
        let level: Vec<f64> = dashed
            .filter(|node| number(node, "y1") == number(node, "y2"))
            .map(|node| number(&node, "y1") - heights[0])
            .collect();
        assert!(level.len() == 1 && (level[0] - 0.05 * per_share).abs() < 0.02, "{level:?} {per_share}");
    }

    #[test]
    fn the_curve_and_the_sticking_contacts_are_drawn() {
        let problem = Problem::of(design([Dof::X, Dof::Pitch].into_iter().collect())).unwrap();
        let settings = FrictionSettings { motions: Some(200), ..FrictionSettings::default() };
        let result = run(&problem, &settings, &Exec::new()).unwrap();
        let mut report = FrictionReport::new(problem.design(), result, Vec::new(), None);
        let picture = friction(&report);
        look("friction", &picture);
        assert!(picture.svg().contains("contacts that stick first") && picture.svg().contains("static test"));
        assert!(!picture.svg().contains("NaN"));
        the_curve_is_that_of_the_mark(&report, &picture);
        let printout = report.table();
        assert!(printout.lines().all(|line| line.chars().count() <= 80), "{printout}");
        assert!(printout.contains("from μ = "), "{printout}");
        // An interval that ends at the largest friction that was tried is open there.
        for kept in &mut report.kept {
            (kept.friction, kept.ci95, kept.is_top) = (0.276, [0.044, 0.5], false);
        }
        assert!(friction(&report).svg().contains("a coefficient of 0.276 (0.044 … beyond 0.5)"));
    }
}
