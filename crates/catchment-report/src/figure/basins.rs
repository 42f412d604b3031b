//! The basins of a landscape: depth and size of every minimum, and the accepted share for each depth
//! tolerance.
//!
//! ```text
//!   accepted │   ┌─────────┐               both frames share a depth scale, logarithmic between the places of 0 and ∞: above, the
//!            │ ┌─┘   │ gap │ └───          staircase of the accepted share; below, one dot per minimum. Minima left of the tolerance
//!            └─┴─────┴──▲──┴───── τ        are merged.
//!   share    │ ◦  ◦◦        ●   ●
//!             ≈0   …            ∞
//! ```

use super::draw::axis::{AxisScale, PlotFrame, ShownUnits, TICK_LINE, short, tick_label};
use super::draw::colour::{self, hex};
use super::draw::layout::{Layout, Legend, Panel};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, n};
use super::{FigureError, Picture, headline};
use crate::Report;
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::method::flood::{Hierarchy, Minimum, ToleranceReason};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Depths this much shallower than the deepest are as good as 0.
const DECADES: f64 = 5.0;
/// Room beyond the shallowest and the deepest, as a factor.
const MARGIN: f64 = 1.6;
/// Maximum number of dots: more dots merge into a blot. The smallest minima are drawn first.
const DOTS: usize = 2000;
/// Maximum number of dots for several minima that are labelled with their number.
const COUNTED: usize = 60;
/// Width of the frames, in SVG units.
const WIDTH: f64 = 548.0;
/// Width of the places for 0 and for ∞, in SVG units.
const PLACE: f64 = 34.0;

/// The common scale of depths, in D: logarithmic, with a place for 0 at the left and a place for ∞ at the
/// right.
struct Depths {
    left: f64,
    width: f64,
    lo: f64,
    hi: f64,
}

impl Depths {
    fn px(&self, depth: f64) -> f64 {
        let share = (depth / self.lo).ln() / (self.hi / self.lo).ln();
        if depth < self.lo {
            self.left + 0.5 * PLACE
        } else if share <= 1.0 {
            self.left + PLACE + (self.width - 2.0 * PLACE) * share
        } else {
            self.right() - 0.5 * PLACE
        }
    }

    fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Ticks at 1, 2 and 5 times powers of ten of the shown unit, fewer if there are many decades.
    fn ticks(&self, factor: f64) -> Vec<(f64, f64)> {
        let [lo, hi] = [self.lo * factor, self.hi * factor];
        let decades = (hi / lo).log10();
        let steps: &[f64] = if decades > 3.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let powers = lo.log10().floor() as i32..=hi.log10().ceil() as i32;
        let all = powers.flat_map(|power| steps.iter().map(move |step| step * 10f64.powi(power)));
        all.filter(|v| (lo..=hi).contains(v)).map(|v| (self.px(v / factor), v)).collect()
    }
}

/// Draws the depths of the minima and the accepted share over the depth tolerance, under the numbers of the `report`.
///
/// # Errors
/// If the acceptance has no grid, or its landscape a single basin, which nothing can be merged with.
pub fn basins(
    report: &Report,
    acceptance: &Acceptance,
    hierarchy: &Hierarchy,
) -> Result<Picture, FigureError> {
    let total = acceptance.outcomes.len() as f64;
    let depths = hierarchy.tree.links.iter().map(|link| link.depth).filter(|d| d.is_finite() && *d > 0.0);
    let (mut lo, mut hi) = depths.fold((f64::INFINITY, 0.0f64), |(lo, hi), d| (lo.min(d), hi.max(d)));
    if hi == 0.0 {
        return Err(FigureError::Empty { what: "the landscape has a single basin" });
    }
    let tolerance = hierarchy.tolerance.depth;
    if tolerance > 0.0 {
        (lo, hi) = (lo.min(tolerance), hi.max(tolerance));
    }
    let design = &report.design;
    let units = ShownUnits::of(design);
    let unit = units.symbol();
    let shown = |depth: f64| significant(depth * units.lengths());
    let why = match hierarchy.tolerance.reason {
        ToleranceReason::Given => String::new(),
        ToleranceReason::WidestGap { between: [a, b], .. } => {
            format!(", in the gap of the depths from {} to {} {unit}", shown(a), shown(b))
        }
    };
    let accepted = 100.0 * acceptance.counts()[0] as f64 / total;
    let story =
        format!("{} % accepted at a depth tolerance of {} {unit}{why}", short(accepted), shown(tolerance));
    let (minima, merged) = (hierarchy.tree.minima.len(), hierarchy.basins.len());
    let drawn = if minima > DOTS { format!(" (the {DOTS} largest are drawn)") } else { String::new() };
    let counts =
        format!("{minima} minima{drawn}, {merged} basins after merging; minima left of the line are merged");
    let panel = |height: f64| Panel::of([WIDTH, height]).beside().with_room([8.0, 0.0, 0.0, 0.0]);
    let (mut svg, frames) = Layout::of(design)
        .story(headline(report))
        .story(story)
        .story(counts)
        .row([panel(210.0)])
        .row([panel(170.0).below()])
        .legend(legend(acceptance, hierarchy))
        .open();
    let [top, bottom] = [frames[0], frames[1]];
    let (lo, hi) = ((lo / MARGIN).max(hi * 10f64.powf(-DECADES)), hi * MARGIN);
    let scale = Depths { left: top.x, width: WIDTH, lo, hi };

    if let ToleranceReason::WidestGap { between: [a, b], .. } = hierarchy.tolerance.reason {
        let (a, b) = (scale.px(a), scale.px(b));
        for rect in [top, bottom] {
            svg.rect(Rect { x: a, w: b - a, ..rect }, r##"fill="#e9f1f7""##);
        }
    }
    let nothing = || AxisScale::new(String::new(), 0.0, 0.0, false);
    staircase(
        &mut svg,
        hierarchy,
        total,
        &scale,
        &PlotFrame {
            rect: top,
            x: nothing(),
            y: AxisScale::new("accepted [%]".to_owned(), 0.0, highest(hierarchy, total), false),
        },
    );
    dots(&mut svg, acceptance, hierarchy, &scale, bottom);
    for (x, value) in scale.ticks(units.lengths()) {
        for rect in [top, bottom] {
            let y = rect.y + rect.h;
            svg.line([x, y], [x, y + 4.0], TICK_LINE);
        }
        svg.text([x, bottom.y + bottom.h + 15.5], TICK, Anchor::Middle, SOFT, &tick_label(value));
    }
    for (depth, words) in [(0.0, "≈0"), (f64::INFINITY, "∞")] {
        svg.text([scale.px(depth), bottom.y + bottom.h + 15.5], TICK, Anchor::Middle, SOFT, words);
    }
    let label = format!("depth, depth tolerance [{unit}]");
    svg.text([top.x + 0.5 * WIDTH, bottom.y + bottom.h + 33.0], LABEL, Anchor::Middle, INK, &label);
    if tolerance > 0.0 {
        let x = scale.px(tolerance);
        let style = format!(r#"stroke="{INK}" stroke-width="1.2" stroke-dasharray="5 3""#);
        svg.line([x, top.y], [x, bottom.y + bottom.h], &style);
    }
    Ok(Picture::of(svg))
}

/// Two significant digits: depths differ by factors.
fn significant(value: f64) -> String {
    if value <= 0.0 {
        return "0".to_owned();
    }
    let digits = (1.0 - value.log10().floor()).max(0.0) as usize;
    format!("{value:.digits$}")
}

/// Upper end of the scale of the accepted share, in percent.
fn highest(hierarchy: &Hierarchy, total: f64) -> f64 {
    let most = hierarchy.staircase.iter().map(|step| step.cells).max().unwrap_or(0);
    (1.15 * 100.0 * most as f64 / total).clamp(1.0, 100.0)
}

fn staircase(svg: &mut Svg, hierarchy: &Hierarchy, total: f64, scale: &Depths, frame: &PlotFrame) {
    let steps = &hierarchy.staircase;
    let right = scale.right();
    let mut path = String::new();
    let mut area = format!("M{} {}", n(scale.left), n(frame.py(0.0)));
    for (k, step) in steps.iter().enumerate() {
        let from = if k == 0 { scale.left } else { scale.px(step.above) };
        let to = steps.get(k + 1).map_or(right, |next| scale.px(next.above));
        let y = n(frame.py(100.0 * step.cells as f64 / total));
        let start = if k == 0 { 'M' } else { 'L' };
        // Writing to a String cannot fail.
        let _ = write!(path, "{start}{} {y}L{} {y}", n(from), n(to));
        let _ = write!(area, "L{} {y}L{} {y}", n(from), n(to));
    }
    let colour = hex(colour::outcome(Outcome::Aligned));
    if !steps.is_empty() {
        let _ = write!(area, "L{} {}Z", n(right), n(frame.py(0.0)));
        svg.path(&area, &format!(r#"fill="{colour}" fill-opacity="0.25""#));
        svg.path(
            &path,
            &format!(r#"fill="none" stroke="{colour}" stroke-width="2.2" stroke-linejoin="round""#),
        );
    }
    frame.draw(svg);
}

/// A dot for each minimum: its depth, and the share of all cells that drain to it before any merging.
fn dots(svg: &mut Svg, acceptance: &Acceptance, hierarchy: &Hierarchy, scale: &Depths, rect: Rect) {
    let total = acceptance.outcomes.len() as f64;
    // A logarithmic scale from a single cell to all cells.
    let py = |share: f64| {
        rect.y + rect.h * (1.0 - 0.06 - 0.88 * (share * total).max(1.0).ln() / total.ln().max(1.0))
    };
    let mut tick = 1.0;
    while tick * total >= 1.0 {
        let y = py(tick);
        svg.line([rect.x - 4.0, y], [rect.x, y], TICK_LINE);
        svg.text([rect.x - 7.0, y + 3.8], TICK, Anchor::End, SOFT, &tick_label(100.0 * tick));
        tick *= 0.1;
    }
    svg.rect(rect, &format!(r#"fill="none" stroke="{SOFT}" stroke-width="1""#));
    svg.text_up([rect.x - 46.0, rect.y + 0.5 * rect.h], LABEL, "share of the error box [%]");
    let mut minima: Vec<_> = hierarchy.tree.minima.iter().collect();
    minima.sort_by_key(|m| m.cells);
    // Symmetric minima have the same position: a dot with their number.
    let mut dots: BTreeMap<(usize, u64, u8), (Outcome, bool, usize)> = BTreeMap::new();
    for minimum in &minima[minima.len().saturating_sub(DOTS)..] {
        let (outcome, kept) = kind(minimum, acceptance, hierarchy);
        let key = (minimum.cells, scale.px(minimum.depth).to_bits(), outcome as u8);
        dots.entry(key).or_insert((outcome, kept, 0)).2 += 1;
    }
    let is_counted = dots.values().filter(|(.., count)| *count > 1).count() <= COUNTED;
    for ((cells, x, _), (outcome, kept, count)) in dots {
        let place = [f64::from_bits(x), py(cells as f64 / total)];
        svg.circle(place, if kept { 5.0 } else { 3.5 }, &dot(outcome, kept));
        if is_counted && count > 1 {
            svg.text([place[0] + 7.0, place[1] - 4.0], TICK, Anchor::Start, INK, &format!("×{count}"));
        }
    }
}

/// The outcome of a minimum, and whether it is a basin after merging.
fn kind(minimum: &Minimum, acceptance: &Acceptance, hierarchy: &Hierarchy) -> (Outcome, bool) {
    let outcome = acceptance.outcomes.get(minimum.cell).copied().unwrap_or(Outcome::Undecided);
    (outcome, minimum.depth >= hierarchy.tolerance.depth)
}

/// A minimum that is merged is hollow.
fn dot(outcome: Outcome, kept: bool) -> String {
    let colour = colour::outcome(outcome);
    let edge = hex(colour::mix(colour, [0, 0, 0], 0.45));
    let fill = if kept { hex(colour) } else { "#ffffff".to_owned() };
    format!(r#"fill="{fill}" stroke="{edge}" stroke-width="1.1""#)
}

/// The kinds of dots that are drawn.
fn legend(acceptance: &Acceptance, hierarchy: &Hierarchy) -> Legend {
    let has = |wanted: &dyn Fn((Outcome, bool)) -> bool| {
        hierarchy.tree.minima.iter().any(|minimum| wanted(kind(minimum, acceptance, hierarchy)))
    };
    let kept = Outcome::ALL.into_iter().filter(|outcome| has(&|result| result == (*outcome, true)));
    let legend =
        kept.fold(Legend::default(), |legend, outcome| legend.dot(dot(outcome, true), outcome.word()));
    if has(&|(_, kept)| !kept) {
        legend.dot(dot(Outcome::Jammed, false), "merged into another")
    } else {
        legend
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, report_of};
    use super::*;
    use crate::schema::basins::tests::flooded;
    use catchment_core::method::flood::Flooding;

    #[test]
    fn depths_and_staircase_share_a_scale() {
        let (design, flooding) = flooded();
        let Flooding { acceptance, hierarchy, .. } = flooding;
        let report = report_of(&design, &acceptance);
        let picture = basins(&report, &acceptance, &hierarchy).unwrap();
        look("basins", &picture);
        assert!(picture.svg().contains("accepted at a depth tolerance of") && !picture.svg().contains("NaN"));
        assert_eq!(picture, basins(&report, &acceptance, &hierarchy).unwrap());
    }

    /// The frames ended at different places, and minima of depth 0 were counted and not drawn.
    #[test]
    fn the_frames_are_aligned_and_every_minimum_has_its_dot() {
        let (design, flooding) = flooded();
        let Flooding { acceptance, mut hierarchy, .. } = flooding;
        let level = Minimum { depth: 0.0, ..hierarchy.tree.minima[0] };
        hierarchy.tree.minima.extend([level; 2]);
        let picture = basins(&report_of(&design, &acceptance), &acceptance, &hierarchy).unwrap();
        look("basins-level", &picture);
        let document = resvg::usvg::roxmltree::Document::parse(picture.svg()).unwrap();
        let number = |node: &resvg::usvg::roxmltree::Node, name| -> f64 {
            node.attribute(name).unwrap().parse().unwrap()
        };
        let frames: Vec<[f64; 4]> = document
            .descendants()
            .filter(|node| node.has_tag_name("rect") && node.attribute("fill") == Some("none"))
            .map(|node| ["x", "y", "width", "height"].map(|name| number(&node, name)))
            .collect();
        let [top, bottom] = frames[..] else { panic!("{frames:?}") };
        assert_eq!([top[0], top[2]], [bottom[0], bottom[2]]);
        let dots: Vec<[f64; 2]> = document
            .descendants()
            .filter(|node| node.has_tag_name("circle"))
            .map(|node| [number(&node, "cx"), number(&node, "cy")])
            .filter(|[x, y]| {
                (bottom[0]..=bottom[0] + bottom[2]).contains(x)
                    && (bottom[1]..=bottom[1] + bottom[3]).contains(y)
            })
            .collect();
        // A dot with a number stands for as many minima, of which the others lie on it.
        let texts = document.descendants().filter(|node| node.has_tag_name("text"));
        let others = texts.filter_map(|node| node.text()?.strip_prefix('×'));
        let others: usize = others.map(|count| count.parse::<usize>().unwrap() - 1).sum();
        let minima = hierarchy.tree.minima.len();
        assert_eq!(dots.len() + others, minima);
        assert!(others > 0 && picture.svg().contains(&format!("{minima} minima, ")));
        assert_eq!(dots.iter().filter(|[x, _]| *x < bottom[0] + PLACE).count(), 1);
    }

    #[test]
    fn a_single_basin_has_nothing_to_show() {
        let (design, mut flooding) = flooded();
        flooding.hierarchy.tree.links.clear();
        let report = report_of(&design, &flooding.acceptance);
        assert!(matches!(
            basins(&report, &flooding.acceptance, &flooding.hierarchy),
            Err(FigureError::Empty { .. })
        ));
    }
}
