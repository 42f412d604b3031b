//! A thin writer of SVG with only the elements that the pictures need; numbers have a resolution of a
//! hundredth of a unit.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;

/// A rectangle of the picture, y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left side.
    pub x: f64,
    /// Upper side.
    pub y: f64,
    /// Width.
    pub w: f64,
    /// Height.
    pub h: f64,
}

/// Alignment of a text at its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its start.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// Size of a title, in SVG units.
pub const TITLE: f64 = 15.0;
/// Size of a label.
pub const LABEL: f64 = 12.0;
/// Size of the numbers at ticks.
pub const TICK: f64 = 10.5;

/// The colour of text and lines.
pub const INK: &str = "#1f2933";
/// The colour of secondary elements.
pub const SOFT: &str = "#5f6b7a";

/// Style of lines whose ends and corners are round.
pub const JOIN: &str = r#"stroke-linecap="round" stroke-linejoin="round""#;

/// A picture being drawn.
#[derive(Debug)]
pub struct Svg {
    width: f64,
    height: f64,
    body: String,
    clips: usize,
}

impl Svg {
    /// An empty picture of this size, in SVG units.
    pub const fn new(width: f64, height: f64) -> Self {
        Self { width, height, body: String::new(), clips: 0 }
    }

    fn push(&mut self, element: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.body.write_fmt(element);
        self.body.push('\n');
    }

    /// A rectangle; `style` is attributes.
    pub fn rect(&mut self, r: Rect, style: &str) {
        let [x, y, w, h] = [r.x, r.y, r.w, r.h].map(n);
        self.push(format_args!(r#"<rect x="{x}" y="{y}" width="{w}" height="{h}" {style}/>"#));
    }

    /// A line; `style` is attributes.
    pub fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], style: &str) {
        let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(n);
        self.push(format_args!(r#"<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" {style}/>"#));
    }

    /// A circle; `style` is attributes.
    pub fn circle(&mut self, [x, y]: [f64; 2], radius: f64, style: &str) {
        self.push(format_args!(r#"<circle cx="{}" cy="{}" r="{}" {style}/>"#, n(x), n(y), n(radius)));
    }

    /// A path of the given data; nothing if that is empty.
    pub fn path(&mut self, data: &str, style: &str) {
        if !data.is_empty() {
            self.push(format_args!(r#"<path d="{data}" {style}/>"#));
        }
    }

    /// A text; characters with a meaning in XML or on a terminal are escaped.
    pub fn text(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, fill: &str, content: &str) {
        self.write_text([x, y], size, anchor, &format!(r#"fill="{fill}""#), content);
    }

    /// The same in bold ink.
    pub fn bold(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, content: &str) {
        self.write_text([x, y], size, anchor, &format!(r#"fill="{INK}" font-weight="bold""#), content);
    }

    /// Text that reads upwards.
    pub fn text_up(&mut self, [x, y]: [f64; 2], size: f64, content: &str) {
        let turn = format!(r#"fill="{INK}" transform="rotate(-90 {} {})""#, n(x), n(y));
        self.write_text([x, y], size, Anchor::Middle, &turn, content);
    }

    /// The same with a white border, for words over a drawing.
    pub fn haloed(&mut self, at: [f64; 2], size: f64, anchor: Anchor, fill: &str, content: &str) {
        let border = r##"fill="#ffffff" stroke="#ffffff" stroke-width="3.2" stroke-linejoin="round""##;
        self.write_text(at, size, anchor, border, content);
        self.text(at, size, anchor, fill, content);
    }

    fn write_text(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, style: &str, content: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y, size, content) = (n(x), n(y), n(size), escaped(content));
        self.push(format_args!(
            r#"<text x="{x}" y="{y}" font-size="{size}" text-anchor="{anchor}" {style}>{content}</text>"#
        ));
    }

    /// An embedded PNG. `crisp` keeps its pixels square.
    pub fn image(&mut self, r: Rect, png: &[u8], crisp: bool) {
        let [x, y, w, h] = [r.x, r.y, r.w, r.h].map(n);
        let rendering = if crisp { r#" style="image-rendering:pixelated""# } else { "" };
        let data = STANDARD.encode(png);
        self.push(format_args!(
            r#"<image x="{x}" y="{y}" width="{w}" height="{h}" preserveAspectRatio="none"{rendering} href="data:image/png;base64,{data}"/>"#
        ));
    }

    /// Everything until [`Svg::end`] is cut off at the rectangle.
    pub fn begin_clip(&mut self, r: Rect) {
        self.clips += 1;
        let id = self.clips;
        let [x, y, w, h] = [r.x, r.y, r.w, r.h].map(n);
        self.push(format_args!(
            r#"<clipPath id="c{id}"><rect x="{x}" y="{y}" width="{w}" height="{h}"/></clipPath><g clip-path="url(#c{id})">"#
        ));
    }

    /// Everything until [`Svg::end`] is drawn with this opacity as a whole.
    pub fn begin_opacity(&mut self, opacity: f64) {
        self.push(format_args!(r#"<g opacity="{}">"#, n(opacity)));
    }

    /// Ends the most recently begun element.
    pub fn end(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// The whole file.
    pub fn finish(self) -> String {
        let (w, h) = (n(self.width), n(self.height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"DejaVu Sans, Verdana, sans-serif\">\n<rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n\
             {}</svg>\n",
            self.body
        )
    }
}

/// A number to a hundredth, without trailing zeros.
pub fn n(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Path data of a polyline; closed if `close`.
pub fn polyline(points: impl IntoIterator<Item = [f64; 2]>, close: bool) -> String {
    let mut data = String::new();
    for (k, [x, y]) in points.into_iter().enumerate() {
        data.push(if k == 0 { 'M' } else { 'L' });
        data.push_str(&n(x));
        data.push(' ');
        data.push_str(&n(y));
    }
    if close && !data.is_empty() {
        data.push('Z');
    }
    data
}

fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            // Characters that XML cannot hold, whatever a design is named.
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

/// Width of a text in `DejaVu Sans`, near enough to lay things out: narrow, wide and other characters.
pub fn width_of(text: &str, size: f64) -> f64 {
    let advance = |c: char| match c {
        'i' | 'j' | 'l' | 'I' | '.' | ',' | ' ' | ':' => 0.3,
        'f' | 't' | 'r' | '(' | ')' => 0.4,
        'm' | 'w' | '%' | 'M' | 'W' => 0.93,
        'A'..='Z' => 0.72,
        _ => 0.62,
    };
    size * text.chars().map(advance).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_name_stays_well_formed() {
        let mut svg = Svg::new(10.0, 10.0);
        svg.text([1.0, 2.0], 3.0, Anchor::Start, INK, "\u{1b}[2J<&\u{0}\u{ffff}]]>\"c\"");
        let text = svg.finish();
        let document = resvg::usvg::roxmltree::Document::parse(&text).unwrap();
        assert!(document.descendants().any(|d| d.text() == Some(" [2J<&  ]]>\"c\"")));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([1.0, -0.001, 2.5, 1.234_56].map(n), ["1", "0", "2.5", "1.23"]);
        assert_eq!(polyline([[0.0, 1.0], [2.0, 3.0]], true), "M0 1L2 3Z");
    }
}
