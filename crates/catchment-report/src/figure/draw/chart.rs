//! Lines over a logarithmic or a linear scale, each with its interval as a band.

use super::axis::{AxisScale, PlotFrame, TICK_LINE, tick_label};
use super::colour::{Rgb, hex};
use super::layout::{Legend, stroked};
use super::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, TICK, polyline, width_of};

/// A line.
pub struct ChartLine {
    /// Its name in the legend.
    pub name: String,
    /// Its colour.
    pub colour: Rgb,
    /// Its points, from left to right.
    pub points: Vec<ChartPoint>,
}

/// A point of a line, with the interval of its value, if any.
#[derive(Debug, Clone, Copy)]
pub struct ChartPoint {
    /// Along the scale.
    pub x: f64,
    /// Its value.
    pub y: f64,
    /// The interval of the value.
    pub interval: Option<[f64; 2]>,
}

/// How a scale is spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// By ratios: points whose x is not positive are left out.
    Logarithmic,
    /// By differences.
    Even,
}

impl Spacing {
    /// Position of a value along the scale.
    fn at(self, x: f64) -> f64 {
        if self == Self::Logarithmic { x.log10() } else { x }
    }

    fn shows(self, x: f64) -> bool {
        self == Self::Even || x > 0.0
    }

    /// Round numbers on a scale of this width.
    fn ticks(self, scale: &AxisScale, width: f64) -> Vec<f64> {
        match self {
            Self::Logarithmic => decades(scale.lo, scale.hi, width),
            Self::Even => scale.ticks((width / 60.0) as usize),
        }
    }
}

/// A chart of lines.
pub struct Chart<'a> {
    /// Its position in the picture.
    pub rect: Rect,
    /// Quantity of the x scale.
    pub x_label: &'a str,
    /// How it is spaced.
    pub spacing: Spacing,
    /// Quantity of the y scale.
    pub y_label: &'a str,
    /// The lines.
    pub lines: &'a [ChartLine],
    /// A value to mark on the x scale.
    pub mark: Option<Mark<'a>>,
}

/// A value of the x scale with its name.
#[derive(Debug, Clone, Copy)]
pub struct Mark<'a> {
    /// The value.
    pub x: f64,
    /// The y at which this value is read off a curve, if it is.
    pub y: Option<f64>,
    /// Its description.
    pub words: &'a str,
}

impl Chart<'_> {
    /// Draws the chart, in the room of [`super::layout::Panel::with_axes`].
    pub fn draw(&self, svg: &mut Svg) {
        let Some(frame) = self.frame() else { return };
        let r = self.rect;
        let grid = format!(r#"stroke="{SOFT}" stroke-opacity="0.18" stroke-width="0.8""#);
        for y in frame.y.ticks((r.h / 40.0) as usize) {
            svg.line([r.x, frame.py(y)], [r.x + r.w, frame.py(y)], &grid);
        }
        for x in self.spacing.ticks(&frame.x, r.w) {
            let px = frame.px(self.spacing.at(x));
            svg.line([px, r.y], [px, r.y + r.h], &grid);
            svg.line([px, r.y + r.h], [px, r.y + r.h + 4.0], TICK_LINE);
            svg.text([px, r.y + r.h + 15.5], TICK, Anchor::Middle, SOFT, &tick_label(x));
        }
        svg.text([r.x + 0.5 * r.w, r.y + r.h + 32.0], LABEL, Anchor::Middle, INK, self.x_label);
        svg.begin_clip(r);
        if let Some(Mark { x, y, .. }) = self.mark {
            let px = frame.px(self.spacing.at(x));
            let top = y.map_or(r.y, |y| frame.py(y));
            let dashed = format!(r#"stroke="{INK}" stroke-width="1" stroke-dasharray="4 3""#);
            svg.line([px, top], [px, r.y + r.h], &dashed);
            if y.is_some() {
                svg.line([r.x, top], [px, top], &dashed);
            }
        }
        for line in self.lines {
            line.band(svg, &frame, self.spacing);
        }
        for line in self.lines {
            line.curve(svg, &frame, self.spacing);
        }
        if let Some(Mark { x, y, words }) = self.mark {
            let px = frame.px(self.spacing.at(x));
            let fits = px + 5.0 + width_of(words, TICK) < r.x + r.w;
            let (x, anchor) = if fits { (px + 5.0, Anchor::Start) } else { (px - 5.0, Anchor::End) };
            // Beside the line: above a curve that it is read off there is no room.
            let below = if y.is_some() { r.h - 8.0 } else { 14.0 };
            svg.haloed([x, r.y + below], TICK, anchor, INK, words);
        }
        svg.end();
        frame.beside(svg);
        frame.outline(svg);
    }

    /// The frame around all points, their intervals and the mark; `None` without points.
    fn frame(&self) -> Option<PlotFrame> {
        /// Room beside the outermost points, as a share of the extent.
        const MARGIN: f64 = 0.06;
        let points = || self.lines.iter().flat_map(|line| line.shown(self.spacing));
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
        };
        let (left, right) =
            range(&mut points().map(|p| p.x).chain(self.mark.map(|mark| mark.x)).map(|x| self.spacing.at(x)));
        let heights = points().flat_map(|p| p.interval.into_iter().flatten().chain([p.y]));
        let marked = self.mark.and_then(|mark| mark.y);
        let (low, high) = range(&mut heights.chain(marked).filter(|y| y.is_finite()));
        if !(left <= right && low <= high) {
            return None;
        }
        // A single point still has room around it.
        let wide = |lo: f64, hi: f64, least: f64| {
            let margin = (MARGIN * (hi - lo)).max(least);
            (lo - margin, hi + margin)
        };
        let (left, right) = wide(left, right, 0.02);
        let (low, high) = wide(low, high, 1e-3 * low.abs().max(high.abs()).max(1e-9));
        Some(PlotFrame {
            rect: self.rect,
            x: AxisScale::new(String::new(), left, right, false),
            y: AxisScale::new(self.y_label.to_owned(), low, high, false),
        })
    }
}

impl ChartLine {
    fn shown(&self, spacing: Spacing) -> impl Iterator<Item = &ChartPoint> {
        self.points.iter().filter(move |p| spacing.shows(p.x) && p.y.is_finite())
    }

    fn band(&self, svg: &mut Svg, frame: &PlotFrame, spacing: Spacing) {
        let ends = |k: usize| {
            let end = move |p: &ChartPoint| p.interval.map(|i| frame.at([spacing.at(p.x), i[k]]));
            self.shown(spacing).filter_map(end)
        };
        let mut outline: Vec<[f64; 2]> = ends(1).collect();
        let mut lower: Vec<[f64; 2]> = ends(0).collect();
        // A band that turns back, as over times that do not grow, encloses nothing that means anything.
        let forward = lower.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        if lower.len() > 1 && forward {
            lower.reverse();
            outline.extend(lower);
            let style = format!(r#"fill="{}" fill-opacity="0.16" stroke="none""#, hex(self.colour));
            svg.path(&polyline(outline, true), &style);
        }
        // A band is thin at its ends and nothing at a single point: whiskers show every interval.
        let whisker = format!(r#"stroke="{}" stroke-opacity="0.7" stroke-width="1.2""#, hex(self.colour));
        for p in self.shown(spacing) {
            if let Some([lo, hi]) = p.interval {
                let [x, bottom] = frame.at([spacing.at(p.x), lo]);
                svg.line([x, bottom], [x, frame.py(hi)], &whisker);
            }
        }
    }

    fn curve(&self, svg: &mut Svg, frame: &PlotFrame, spacing: Spacing) {
        let colour = hex(self.colour);
        let places: Vec<[f64; 2]> = self.shown(spacing).map(|p| frame.at([spacing.at(p.x), p.y])).collect();
        let style = format!(r#"fill="none" stroke="{colour}" stroke-width="2" {JOIN}"#);
        svg.path(&polyline(places.iter().copied(), false), &style);
        for place in places {
            svg.circle(place, 3.0, &format!(r##"fill="{colour}" stroke="#ffffff" stroke-width="1""##));
        }
    }
}

/// The names of lines, from left to right.
pub fn legend(lines: &[ChartLine]) -> Legend {
    lines.iter().fold(Legend::default(), |legend, line| legend.line(stroked(line.colour, 2.4), &line.name))
}

/// Round numbers between 10^`lo` and 10^`hi`: 1, 2 and 5 of each decade if they fit, else powers of ten.
fn decades(lo: f64, hi: f64, width: f64) -> Vec<f64> {
    /// Units that a tick's number needs.
    const ROOM: f64 = 34.0;
    let of_ten: &[f64] = match width / (hi - lo).max(1e-9) {
        decade if decade * 0.176 > ROOM => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
        decade if decade * 0.301 > ROOM => &[1.0, 2.0, 5.0],
        _ => &[1.0],
    };
    (lo.floor() as i32..=hi.floor() as i32)
        .flat_map(|power| of_ten.iter().map(move |digit| digit * 10f64.powi(power)))
        .filter(|value| (lo..=hi).contains(&value.log10()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scales that end at the interval of the last point cut off wider intervals before it.
    #[test]
    fn every_interval_lies_within_the_frame() {
        let rect = Rect { x: 50.0, y: 20.0, w: 300.0, h: 200.0 };
        let point = |x: f64, half: f64| ChartPoint { x, y: 2.0, interval: Some([2.0 - half, 2.0 + half]) };
        for spacing in [Spacing::Logarithmic, Spacing::Even] {
            let lines = [ChartLine {
                name: String::new(),
                colour: [0; 3],
                points: vec![point(0.1, 1.5), point(1.0, 0.4), point(10.0, 0.1)],
            }];
            let chart = Chart { rect, x_label: "x", spacing, y_label: "y", lines: &lines, mark: None };
            let mut svg = Svg::new(400.0, 260.0);
            chart.draw(&mut svg);
            let text = svg.finish();
            let document = resvg::usvg::roxmltree::Document::parse(&text).unwrap();
            let whiskers = document.descendants().filter(|d| d.attribute("stroke-opacity") == Some("0.7"));
            let ends: Vec<f64> = whiskers
                .flat_map(|d| ["y1", "y2"].map(|end| d.attribute(end).unwrap().parse().unwrap()))
                .collect();
            assert_eq!(ends.len(), 6);
            assert!(ends.iter().all(|y| (rect.y..=rect.y + rect.h).contains(y)), "{spacing:?}: {ends:?}");
        }
    }

    #[test]
    fn a_mark_is_read_off_at_its_height() {
        let points = [[0.0, 100.0], [1.0, 90.0]].map(|[x, y]| ChartPoint { x, y, interval: None }).to_vec();
        let lines = [ChartLine { name: String::new(), colour: [0; 3], points }];
        let rect = Rect { x: 50.0, y: 20.0, w: 300.0, h: 200.0 };
        let mark = Some(Mark { x: 0.5, y: Some(95.0), words: "95 %" });
        let chart = Chart { rect, x_label: "x", spacing: Spacing::Even, y_label: "y", lines: &lines, mark };
        let mut svg = Svg::new(400.0, 260.0);
        chart.draw(&mut svg);
        // The middle of the frame, left and below.
        let text = svg.finish();
        assert!(text.contains(r#"<line x1="200" y1="120" x2="200" y2="220" "#), "{text}");
        assert!(text.contains(r#"<line x1="50" y1="120" x2="200" y2="120" "#), "{text}");
    }

    #[test]
    fn ticks_are_round_and_lie_on_the_scale() {
        assert_eq!(decades(0.0, 2.0, 300.0), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
        assert_eq!(decades(-0.1, 4.1, 200.0), [1.0, 10.0, 100.0, 1000.0, 10_000.0]);
        assert_eq!(decades(0.99, 1.5, 300.0), [10.0, 15.0, 20.0, 30.0]);
    }
}
