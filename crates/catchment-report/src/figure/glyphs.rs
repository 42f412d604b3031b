//! Text of pictures as the outlines of its glyphs, so that no text shaping is needed.
//!
//! ```text
//!   <text x= y= font-size= text-anchor=>Sum</text>  ──▶  <path d="M … Z"/>     glyph by glyph: advance of the font, and its kerning of pairs
//! ```
//!
//! Left to right, a single line; no ligatures and no joining scripts. A character that the font lacks is
//! drawn as its empty box.

use super::FigureError;
use resvg::usvg::roxmltree::{Document, Node};
use std::fmt::Write;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// The same picture with paths in the place of texts.
pub(super) fn outlined(svg: &str) -> Result<String, FigureError> {
    let fails = |reason: String| FigureError::Encode { reason };
    let document = Document::parse(svg).map_err(|error| fails(error.to_string()))?;
    let face = |font| Face::parse(font, 0).map_err(|error| fails(error.to_string()));
    let (regular, bold) = (face(dejavu::sans::regular())?, face(dejavu::sans::bold())?);
    let mut outlined = String::with_capacity(2 * svg.len());
    let mut done = 0;
    for text in document.descendants().filter(|node| node.tag_name().name() == "text") {
        let face = if text.attribute("font-weight") == Some("bold") { &bold } else { &regular };
        outlined.push_str(&svg[done..text.range().start]);
        path(&text, face, &mut outlined);
        done = text.range().end;
    }
    outlined.push_str(&svg[done..]);
    Ok(outlined)
}

/// The path of a text, with its other attributes.
fn path(text: &Node<'_, '_>, face: &Face<'_>, to: &mut String) {
    const LAID_OUT: [&str; 5] = ["x", "y", "font-size", "text-anchor", "font-weight"];
    let number = |name: &str| text.attribute(name).and_then(|value| value.parse().ok()).unwrap_or(0.0);
    let [x, y, size]: [f64; 3] = ["x", "y", "font-size"].map(number);
    let scale = size / f64::from(face.units_per_em());
    let (glyphs, width) = laid_out(face, text.text().unwrap_or_default());
    let before = match text.attribute("text-anchor") {
        Some("middle") => 0.5 * width,
        Some("end") => width,
        _ => 0.0,
    };
    to.push_str("<path d=\"");
    for (glyph, at) in glyphs {
        face.outline_glyph(glyph, &mut Outline { to, x: x + scale * (at - before), y, scale });
    }
    to.push('"');
    for attribute in text.attributes().filter(|one| !LAID_OUT.contains(&one.name())) {
        // Writing to a String cannot fail.
        let _ = write!(to, " {}=\"{}\"", attribute.name(), attribute.value());
    }
    to.push_str("/>");
}

/// The glyphs of a text, the start of each, and the total width, in units of the font.
fn laid_out(face: &Face<'_>, text: &str) -> (Vec<(GlyphId, f64)>, f64) {
    let kerning = |left: GlyphId, right: GlyphId| {
        let tables = face.tables().kern.iter().flat_map(|kern| kern.subtables);
        tables
            .filter(|table| table.horizontal)
            .find_map(|table| table.glyphs_kerning(left, right))
            .unwrap_or(0)
    };
    let mut at = 0.0;
    let mut glyphs: Vec<(GlyphId, f64)> = Vec::new();
    for c in text.chars() {
        let glyph = face.glyph_index(c).unwrap_or(GlyphId(0));
        if let Some((last, _)) = glyphs.last() {
            at += f64::from(kerning(*last, glyph));
        }
        glyphs.push((glyph, at));
        at += f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    (glyphs, at)
}

/// Writes the path of a glyph whose origin is at (x, y), y down.
struct Outline<'a> {
    to: &'a mut String,
    x: f64,
    y: f64,
    scale: f64,
}

impl Outline<'_> {
    fn push(&mut self, command: char, points: &[[f32; 2]]) {
        self.to.push(command);
        for [x, y] in points {
            let (x, y) = (self.x + self.scale * f64::from(*x), self.y - self.scale * f64::from(*y));
            // Writing to a String cannot fail.
            let _ = write!(self.to, "{x:.3} {y:.3} ");
        }
    }
}

impl OutlineBuilder for Outline<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.push('M', &[[x, y]]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.push('L', &[[x, y]]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.push('Q', &[[x1, y1], [x, y]]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.push('C', &[[x1, y1], [x2, y2], [x, y]]);
    }

    fn close(&mut self) {
        self.to.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Start and end of the path of a text.
    fn extent(anchor: &str, content: &str) -> [f64; 2] {
        let svg = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg"><text x="100" y="50" font-size="20.48" text-anchor="{anchor}" fill="#123456">{content}</text></svg>"##
        );
        let outlined = outlined(&svg).unwrap();
        assert!(outlined.contains("fill=\"#123456\"") && !outlined.contains("text"), "{outlined}");
        let document = Document::parse(&outlined).unwrap();
        let path = document.descendants().find_map(|node| node.attribute("d")).unwrap();
        let numbers: Vec<f64> = path
            .split(|c: char| !c.is_ascii_digit() && c != '.' && c != '-')
            .filter_map(|number| number.parse().ok())
            .collect();
        let xs = numbers.chunks(2).map(|pair| pair[0]);
        [xs.clone().fold(f64::INFINITY, f64::min), xs.fold(f64::NEG_INFINITY, f64::max)]
    }

    /// H of `DejaVu` Sans: 1540 of 2048 units wide, its stems from 201 to 1339; at 20.48 a unit is a hundredth.
    #[test]
    fn glyph_positions_follow_the_font_metrics() {
        for (anchor, origin) in [("start", 100.0), ("middle", 100.0 - 7.70), ("end", 100.0 - 15.40)] {
            let [left, right] = extent(anchor, "H");
            assert!(
                (left - origin - 2.01).abs() < 2e-3 && (right - origin - 13.39).abs() < 2e-3,
                "{left} {right}"
            );
        }
        // The second glyph starts at the end of the first.
        assert!((extent("start", "HH")[1] - 100.0 - 15.40 - 13.39).abs() < 2e-3);
        // A V goes under the arm of an A.
        assert!(extent("start", "AV")[1] < extent("start", "A")[1] + extent("start", "V")[1] - 100.0);
        // A character missing in the font is a box; a blank is empty.
        assert!(extent("start", "\u{10ffff}")[1] > 105.0);
    }
}
