//! What docks against friction, and what sticks first.

use super::Picture;
use super::draw::axis::short;
use super::draw::chart::{Chart, Line, Point, Spacing, legend};
use super::draw::colour::{CURVES, Rgb, hex};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, TITLE, width_of};
use crate::report::{FrictionReport, StickingReport};

/// Colour of the static test.
const STATIC: Rgb = [0x5f, 0x6b, 0x7a];
/// Pairs of features that are drawn.
const SHOWN: usize = 5;

/// Draws the share that docks over friction, and beside it the features on which the first poses stick.
pub fn friction(report: &FrictionReport) -> Picture {
    let (left, top, size) = (78.0, 112.0, [400.0, 300.0]);
    let bars = Rect { x: 540.0, y: top, w: 380.0, h: size[1] };
    let mut svg = Svg::new(bars.x + bars.w + 30.0, top + size[1] + 56.0);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &report.design.name);
    let marked = report.kept.iter().find(|kept| kept.share == MARKED);
    let story = marked.map_or_else(String::new, |kept| {
        let [lo, hi] = kept.ci95.map(|friction| report.up_to(friction));
        let share = short(100.0 * kept.share);
        if kept.is_top {
            format!(
                "{share} % of what docks without friction docks beyond {}, the largest that was tried",
                short(kept.friction)
            )
        } else {
            let friction = kept.friction;
            format!("{share} % of what docks without friction docks up to a friction of {friction:.3} ({lo} … {hi})")
        }
    });
    svg.text([24.0, 50.0], LABEL, Anchor::Start, SOFT, &story);
    let lines = lines(report);
    Chart {
        rect: Rect { x: left, y: top, w: size[0], h: size[1] },
        x_label: "coefficient of friction",
        spacing: Spacing::Even,
        y_label: "share of the error box [%]",
        lines: &lines,
        mark: marked.filter(|kept| !kept.is_top).map(|kept| (kept.friction, "95 %")),
    }
    .draw(&mut svg);
    legend(&mut svg, &lines, [left, top - 18.0]);
    sticking(&mut svg, report, bars);
    Picture::of(svg)
}

/// The share of what docks without friction whose critical friction is marked.
const MARKED: f64 = 0.95;

fn lines(report: &FrictionReport) -> Vec<Line> {
    let percent = |share: f64| 100.0 * share;
    let motions = report.motions.max(1) as f64;
    let docks = report.curve.iter().map(|rung| Point {
        x: rung.friction,
        y: percent(rung.aligned.share),
        interval: Some(rung.aligned.ci95.map(percent)),
    });
    let by_statics = report.curve.iter().map(|rung| Point {
        x: rung.friction,
        y: percent(rung.static_docks as f64 / motions),
        interval: None,
    });
    vec![
        Line { name: "static test".to_owned(), colour: STATIC, points: by_statics.collect() },
        Line { name: "docks, followed".to_owned(), colour: CURVES[0], points: docks.collect() },
    ]
}

/// A bar for each pair of features, and its words above.
fn sticking(svg: &mut Svg, report: &FrictionReport, rect: Rect) {
    let first = &report.sticks_first;
    if first.features.is_empty() {
        return;
    }
    let head = format!("what sticks first, in {} poses", first.poses);
    svg.text([rect.x, rect.y - 18.0], LABEL, Anchor::Start, INK, &head);
    let each = rect.h / SHOWN as f64;
    for (k, pair) in first.features.iter().take(SHOWN).enumerate() {
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

fn words(pair: &StickingReport) -> [String; 2] {
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
    use crate::exec::Exec;
    use crate::pose::Dof;
    use crate::problem::Problem;
    use crate::report::schema::testing::design;
    use crate::study::friction::{Settings, run};

    #[test]
    fn the_curve_and_what_sticks_are_drawn() {
        let problem = Problem::of(design([Dof::X, Dof::Pitch].into_iter().collect())).unwrap();
        let settings = Settings { motions: Some(200), ..Settings::default() };
        let found = run(&problem, &settings, &Exec::new()).unwrap();
        let mut report = FrictionReport::new(problem.design(), &found, Vec::new(), None);
        let picture = friction(&report);
        look("friction", &picture);
        assert!(picture.svg().contains("what sticks first") && picture.svg().contains("static test"));
        assert!(!picture.svg().contains("NaN"));
        let told = report.table();
        assert!(told.lines().all(|line| line.chars().count() <= 80), "{told}");
        assert!(told.contains("from a friction of"), "{told}");
        // An interval that ends at the largest friction that was tried is open there.
        for kept in &mut report.kept {
            (kept.friction, kept.ci95, kept.is_top) = (0.276, [0.044, 0.5], false);
        }
        assert!(friction(&report).svg().contains("a friction of 0.276 (0.044 … beyond 0.5)"));
    }
}
