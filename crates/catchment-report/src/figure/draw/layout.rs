//! The layout that all pictures share: a head, panels in rows and columns, legends.
//!
//! ```text
//!   title                    pose errors   bold; on the right the design as computed
//!   story                                  soft, line by line
//!     over the panel      over the panel   headings and legends
//!     ┌──────┐            ┌──────┐ ▐
//!   y │      │          y │      │ ▐ z     frames of a column begin at the same x, frames of a row at the same y
//!     └──────┘            └──────┘ ▐
//!        x                   x
//!     under the panel     under the panel
//!     ■ legend  ● legend
//! ```
//!
//! A column has room for all that stands beside, over and under its panels, and the page for its widest line:
//! nothing overlaps, and nothing is cut off. Widths of text are estimates ([`width_of`]).

use super::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, TITLE, width_of};
use crate::document::seven_digits;
use catchment_core::design::Design;
use catchment_core::pose::Dof;

/// Room around everything.
const MARGIN: f64 = 24.0;
/// Between panels, to the right and downwards.
const GAP: [f64; 2] = [24.0, 20.0];
/// Baseline of the title.
const TITLE_LINE: f64 = 30.0;
/// From baseline to baseline.
const LINE: f64 = 17.0;
/// From the frame of a panel to the line over it.
const OVER: f64 = 10.0;
/// Numbers and label of an axis: beside a frame, and below it.
const AXES: [f64; 2] = [48.0, 38.0];
/// A colour bar with its numbers.
const BAR: f64 = 76.0;
/// Bold letters are wider by this, about.
const BOLD: f64 = 1.14;
/// From the start of a key to its words, and from words to the next key.
const KEY: f64 = 24.0;
const BETWEEN: f64 = 20.0;

/// A line of words, each with a key before it if it explains a mark.
#[derive(Default)]
pub struct Legend {
    entries: Vec<Entry>,
}

struct Entry {
    key: Option<Key>,
    ink: &'static str,
    words: String,
}

/// Draws a mark around a place.
type Key = Box<dyn Fn(&mut Svg, [f64; 2])>;

impl Legend {
    /// Words before the first key.
    pub fn titled(words: &str) -> Self {
        Self::default().entry(None, SOFT, words.to_owned())
    }

    fn entry(mut self, key: Option<Key>, ink: &'static str, words: String) -> Self {
        self.entries.push(Entry { key, ink, words });
        self
    }

    /// A mark that is drawn around a place, no larger than a letter, and its words.
    #[must_use]
    pub fn mark(self, words: impl Into<String>, draw: impl Fn(&mut Svg, [f64; 2]) + 'static) -> Self {
        self.entry(Some(Box::new(draw)), INK, words.into())
    }

    /// A square of this style, which is attributes.
    #[must_use]
    pub fn square(self, style: impl Into<String>, words: impl Into<String>) -> Self {
        const SIDE: f64 = 13.0;
        let style = style.into();
        self.mark(words, move |svg, [x, y]| {
            svg.rect(Rect { x: x - 0.5 * SIDE, y: y - 0.5 * SIDE, w: SIDE, h: SIDE }, &style);
        })
    }

    /// A dot of this style.
    #[must_use]
    pub fn dot(self, style: impl Into<String>, words: impl Into<String>) -> Self {
        let style = style.into();
        self.mark(words, move |svg, at| svg.circle(at, 4.5, &style))
    }

    /// A line of this style.
    #[must_use]
    pub fn line(self, style: impl Into<String>, words: impl Into<String>) -> Self {
        let style = style.into();
        self.mark(words, move |svg, [x, y]| svg.line([x - 9.0, y], [x + 9.0, y], &style))
    }

    fn width(&self) -> f64 {
        self.entries.iter().map(Entry::width).sum::<f64>()
            - if self.entries.is_empty() { 0.0 } else { BETWEEN }
    }

    /// Draws it from a place on its baseline.
    pub fn draw(&self, svg: &mut Svg, [mut x, y]: [f64; 2]) {
        for entry in &self.entries {
            if let Some(key) = &entry.key {
                key(svg, [x + 0.5 * (KEY - 6.0), y - 4.0]);
            }
            svg.text([x + entry.indent(), y], LABEL, Anchor::Start, entry.ink, &entry.words);
            x += entry.width();
        }
    }
}

impl Entry {
    const fn indent(&self) -> f64 {
        if self.key.is_some() { KEY } else { 0.0 }
    }

    fn width(&self) -> f64 {
        self.indent() + width_of(&self.words, LABEL) + BETWEEN
    }
}

impl<S: Into<String>> From<S> for Legend {
    fn from(words: S) -> Self {
        Self::default().entry(None, INK, words.into())
    }
}

/// A panel: the frame of a drawing, and the room around it.
#[derive(Default)]
pub struct Panel {
    size: [f64; 2],
    left: f64,
    right: f64,
    above: f64,
    below: f64,
    over: Vec<Legend>,
    under: Vec<Legend>,
}

impl Panel {
    /// A drawing of this size, in SVG units.
    pub fn of(size: [f64; 2]) -> Self {
        Self { size, ..Self::default() }
    }

    /// A frame of this size with both axes.
    pub fn with_axes(size: [f64; 2]) -> Self {
        Self::of(size).beside().below()
    }

    /// Room for the axis of the left side.
    #[must_use]
    pub const fn beside(mut self) -> Self {
        self.left = AXES[0];
        self
    }

    /// Room for the axis of the lower side.
    #[must_use]
    pub const fn below(mut self) -> Self {
        self.below = AXES[1];
        self
    }

    /// Room for a colour bar.
    #[must_use]
    pub const fn with_bar(mut self) -> Self {
        self.right = BAR;
        self
    }

    /// More room to the left, above, to the right and below.
    #[must_use]
    pub const fn with_room(mut self, [left, above, right, below]: [f64; 4]) -> Self {
        self.left += left;
        self.above += above;
        self.right += right;
        self.below += below;
        self
    }

    /// A line over the panel, below those before it.
    #[must_use]
    pub fn over(mut self, line: impl Into<Legend>) -> Self {
        self.over.push(line.into());
        self
    }

    /// A line under the panel and its axis.
    #[must_use]
    pub fn under(mut self, line: impl Into<Legend>) -> Self {
        self.under.push(line.into());
        self
    }

    /// From the frame up to the end of its room.
    fn rise(&self) -> f64 {
        let lines = self.over.len() as f64;
        self.above + if self.over.is_empty() { 0.0 } else { OVER + LINE * lines - 4.0 }
    }

    /// From the top of the frame down to the end of its room.
    fn depth(&self) -> f64 {
        self.size[1] + self.below + LINE * self.under.len() as f64
    }

    /// From the left of the frame to the end of its room.
    fn extent(&self) -> f64 {
        let lines = self.over.iter().chain(&self.under).map(Legend::width);
        lines.fold(self.size[0] + self.right, f64::max)
    }

    fn lines(&self, svg: &mut Svg, rect: Rect) {
        for (k, line) in self.over.iter().rev().enumerate() {
            line.draw(svg, [rect.x, rect.y - self.above - OVER - LINE * k as f64]);
        }
        for (k, line) in self.under.iter().enumerate() {
            line.draw(svg, [rect.x, rect.y + self.size[1] + self.below + LINE * (k + 1) as f64 - 2.0]);
        }
    }
}

/// Panels beside each other.
struct Row {
    panels: Vec<Panel>,
    /// Its panel may reach over all columns.
    is_wide: bool,
}

/// A page: its head, its panels and its legend.
#[derive(Default)]
pub struct Layout {
    title: String,
    /// On the right of the title.
    design: String,
    story: Vec<String>,
    rows: Vec<Row>,
    legend: Legend,
}

impl Layout {
    /// A page with a title.
    pub fn titled(title: impl Into<String>) -> Self {
        Self { title: title.into(), ..Self::default() }
    }

    /// A page about a design: its name, and beside it the width and the free errors it was computed with.
    pub fn of(design: &Design) -> Self {
        Self::titled(design.name.clone()).computed(design)
    }

    /// The width and the free errors of a design on the right of the title.
    #[must_use]
    pub fn computed(mut self, design: &Design) -> Self {
        let free: Vec<&str> = design.alignment.free.iter().map(Dof::name).collect();
        let width = design.unit.map_or_else(String::new, |unit| {
            format!("  ·  D = {} {}", seven_digits(design.width), unit.symbol())
        });
        self.design = format!("pose errors {}{width}", free.join(", "));
        self
    }

    /// A line below the title; none if it is empty.
    #[must_use]
    pub fn story(mut self, line: impl Into<String>) -> Self {
        self.story.extend(Some(line.into()).filter(|line| !line.is_empty()));
        self
    }

    /// Panels beside each other, below those before them.
    #[must_use]
    pub fn row(mut self, panels: impl IntoIterator<Item = Panel>) -> Self {
        self.rows.push(Row { panels: panels.into_iter().collect(), is_wide: false });
        self
    }

    /// A panel below those before it that may reach over all columns.
    #[must_use]
    pub fn wide(mut self, panel: Panel) -> Self {
        self.rows.push(Row { panels: vec![panel], is_wide: true });
        self
    }

    /// Panels in rows of so many.
    #[must_use]
    pub fn grid(mut self, columns: usize, panels: impl IntoIterator<Item = Panel>) -> Self {
        for panel in panels {
            match self.rows.last_mut() {
                Some(row) if row.panels.len() < columns => row.panels.push(panel),
                _ => self.rows.push(Row { panels: vec![panel], is_wide: false }),
            }
        }
        self
    }

    /// The legend below all panels, from the left of the first with an axis.
    #[must_use]
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }

    /// Draws all but the content of the panels, whose frames are returned row by row.
    pub fn open(self) -> (Svg, Vec<Rect>) {
        let columns = self.rows.iter().map(|row| row.panels.len()).max().unwrap_or(0);
        let largest = |k: usize, of: fn(&Row, &Panel) -> f64| {
            let panels = self.rows.iter().filter_map(|row| row.panels.get(k).map(|panel| of(row, panel)));
            panels.fold(0.0, f64::max)
        };
        let left_of = |k| largest(k, |_, panel| panel.left);
        let mut right = MARGIN;
        let left: Vec<f64> = (0..columns)
            .map(|k| {
                let gap = if k == 0 { 0.0 } else { GAP[0] };
                let x = right + gap + left_of(k);
                right = x + largest(k, |row, panel| if row.is_wide { 0.0 } else { panel.extent() });
                x
            })
            .collect();
        let wide = self.rows.iter().filter(|row| row.is_wide).flat_map(|row| &row.panels);
        right = wide.map(|panel| left[0] + panel.extent()).fold(right, f64::max);
        let mut bottom = TITLE_LINE + LINE * self.story.len() as f64;
        let mut frames = Vec::new();
        for row in &self.rows {
            let y = bottom + GAP[1] + row.panels.iter().map(Panel::rise).fold(0.0, f64::max);
            frames.extend(row.panels.iter().zip(&left).map(|(panel, x)| {
                let [w, h] = panel.size;
                Rect { x: *x, y, w, h }
            }));
            bottom = y + row.panels.iter().map(Panel::depth).fold(0.0, f64::max);
        }
        let framed = (0..columns).find(|k| left_of(*k) > 0.0).unwrap_or(0);
        let legend_at = [left.get(framed).copied().unwrap_or(MARGIN), bottom + GAP[1]];
        if !self.legend.entries.is_empty() {
            bottom = legend_at[1];
        }
        let title = width_of(&self.title, BOLD * TITLE);
        let design = width_of(&self.design, LABEL);
        let lines = self.story.iter().map(|line| width_of(line, LABEL));
        let width = lines
            .map(|width| MARGIN + width)
            .chain([right, MARGIN + title + MARGIN + design])
            .fold(legend_at[0] + self.legend.width(), f64::max);
        let mut svg = Svg::new((width + MARGIN).ceil(), (bottom + MARGIN).ceil());
        svg.bold([MARGIN, TITLE_LINE], TITLE, Anchor::Start, &self.title);
        if !self.design.is_empty() {
            svg.text([width.ceil(), TITLE_LINE], LABEL, Anchor::End, SOFT, &self.design);
        }
        for (k, line) in self.story.iter().enumerate() {
            svg.text([MARGIN, TITLE_LINE + 3.0 + LINE * (k + 1) as f64], LABEL, Anchor::Start, SOFT, line);
        }
        for (panel, rect) in self.rows.iter().flat_map(|row| &row.panels).zip(&frames) {
            panel.lines(&mut svg, *rect);
        }
        self.legend.draw(&mut svg, legend_at);
        (svg, frames)
    }
}

/// A rectangle cut into so many of equal height, with a gap between them.
pub fn stacked(rect: Rect, count: usize, gap: f64) -> impl Iterator<Item = Rect> {
    let h = (rect.h + gap) / count.max(1) as f64 - gap;
    (0..count).map(move |k| Rect { y: rect.y + k as f64 * (h + gap), h, ..rect })
}

/// The style of the square of a colour in a legend.
pub fn filled(fill: super::colour::Rgb) -> String {
    let fill = super::colour::hex(fill);
    format!(r#"fill="{fill}" stroke="{INK}" stroke-opacity="0.35" stroke-width="0.7""#)
}

/// The style of a line of a colour.
pub fn stroked(colour: super::colour::Rgb, width: f64) -> String {
    format!(r#"fill="none" stroke="{}" stroke-width="{width}" {JOIN}"#, super::colour::hex(colour))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of two panels over one of a single: frames of a column begin at the same x, of a row at the same y.
    #[test]
    fn frames_are_aligned_and_the_page_holds_every_line() {
        let long = "a line that is much longer than the panel over which it stands";
        let (svg, frames) = Layout::titled("t")
            .story("s")
            .row([Panel::with_axes([50.0, 40.0]).over(long), Panel::of([30.0, 60.0])])
            .row([Panel::of([20.0, 20.0])])
            .open();
        let text = svg.finish();
        let [first, second, third] = frames[..] else { panic!("{frames:?}") };
        assert_eq!((first.y, first.x), (second.y, third.x));
        assert!(second.x > first.x + width_of(long, LABEL) && third.y > second.y + second.h);
        let number = |name: &str| -> f64 {
            let (_, after) = text.split_once(&format!(" {name}=\"")).unwrap();
            after.split('"').next().unwrap().parse().unwrap()
        };
        assert!(number("width") >= second.x + second.w + MARGIN);
        assert!(number("height") >= third.y + third.h + MARGIN);
    }

    #[test]
    fn a_wide_panel_reaches_over_all_columns() {
        let columns = || [Panel::of([50.0, 40.0]), Panel::of([30.0, 40.0])];
        let (_, narrow) = Layout::titled("t").row(columns()).open();
        let (svg, frames) = Layout::titled("t").row(columns()).wide(Panel::of([300.0, 20.0])).open();
        assert_eq!(
            frames[..2].iter().map(|r| r.x).collect::<Vec<_>>(),
            narrow.iter().map(|r| r.x).collect::<Vec<_>>()
        );
        let end = (frames[2].x + 300.0 + MARGIN).ceil();
        assert!(svg.finish().contains(&format!("width=\"{end}\"")));
    }

    #[test]
    fn a_rectangle_is_cut_into_equal_parts() {
        let rect = Rect { x: 1.0, y: 2.0, w: 3.0, h: 50.0 };
        let parts: Vec<[f64; 2]> = stacked(rect, 2, 10.0).map(|part| [part.y, part.h]).collect();
        assert_eq!(parts, [[2.0, 20.0], [32.0, 20.0]]);
    }
}
