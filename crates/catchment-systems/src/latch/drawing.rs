//! Drawings for a laser cutter: DXF and SVG of every sheet, true to scale, in mm.
//!
//! ```text
//!   front, back      the two layers, mirror images          NAME.dxf       the nominal part
//!   separator        the sheet between them                 NAME-cut.dxf   the path of the laser's centre
//!                                                           NAME-cut.svg   the same as SVG
//! ```
//!
//! The cut line lies half a kerf outside the part (holes: inside). Inside the files y points up (SVG: down), and x = 0 is the
//! left edge of the part.

use super::kerf::{KerfError, compensated};
use super::outline::Polygon;
use super::{Geometry, LatchDesign};
use glam::DVec2;
use std::fmt::Write;

/// CAD layer of the part.
pub const PART: &str = "PART";
/// CAD layer of the cut line.
pub const CUT: &str = "CUT";
/// Colours of the two, in `AutoCAD`'s palette: white or black, and red.
const COLOURS: [u8; 2] = [7, 1];
/// The text before the entities of a drawing: `AutoCAD` 2000, in mm, a single layer. `{seed}`, `{layer}` and
/// `{colour}` are replaced by the next free handle in hexadecimal, the layer's name and its colour.
const HEAD: &str = include_str!("head.dxf");
/// And after them.
const FOOT: &str = "  0\nENDSEC\n  0\nSECTION\n  2\nOBJECTS\n  0\nENDSEC\n  0\nEOF\n";
/// Handle of the first entity, after those of the head.
const FIRST_HANDLE: usize = 0x11;
/// Width of the lines of an SVG, in mm: thin, and still seen on a screen. Cutters go by the middle, and by the colour.
const HAIRLINE: f64 = 0.1;
/// Room around the drawing, in mm.
const MARGIN: f64 = 5.0;

/// Curves to cut: a closed outline and round holes.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Its name, and that of its files.
    pub name: &'static str,
    /// Counter-clockwise.
    pub outline: Polygon,
    /// Middles and diameters.
    pub holes: Vec<(DVec2, f64)>,
}

/// Why a drawing cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum DrawingError {
    /// The cut line does not exist.
    #[error(transparent)]
    Kerf(#[from] KerfError),
}

impl Sheet {
    /// The sheets of a latch, as they should come out.
    pub fn all(latch: &LatchDesign, geometry: &Geometry) -> Vec<Self> {
        let holes: Vec<(DVec2, f64)> = geometry
            .dowels
            .map(|(middles, diameter)| middles.map(|middle| (middle, diameter)).to_vec())
            .unwrap_or_default();
        let front = geometry.layer();
        let back = geometry.mirrored(&front);
        let sheet = |name, outline| Self { name, outline, holes: holes.clone() };
        let mut sheets = vec![sheet("front", front)];
        if latch.layers == 2 {
            sheets.push(sheet("back", back));
            sheets.push(sheet("separator", geometry.separator()));
        }
        sheets
    }

    /// Path of the laser's middle.
    ///
    /// # Errors
    /// The kerf is wider than the feature around which it cuts.
    pub fn cut(&self, kerf: f64) -> Result<Self, KerfError> {
        let holes = self.holes.iter().map(|(middle, diameter)| (*middle, diameter - kerf)).collect();
        Ok(Self { name: self.name, outline: compensated(&self.outline, kerf)?, holes })
    }

    /// The sheet as DXF (`AutoCAD` 2000), on a single CAD layer. The same sheet gives the same bytes: no
    /// date, no random numbers.
    pub fn dxf(&self, layer: &str) -> String {
        let mut entities: Vec<Entity> = vec![Entity::polyline(&self.outline)];
        entities.extend(self.holes.iter().map(|(middle, diameter)| Entity::circle(*middle, 0.5 * diameter)));
        let colour = COLOURS[usize::from(layer == CUT)];
        let seed = format!("{:X}", FIRST_HANDLE + entities.len());
        let mut text = HEAD.replace("{seed}", &seed).replace("{layer}", layer);
        text = text.replace("{colour}", &colour.to_string());
        for (k, entity) in entities.iter().enumerate() {
            let common = [(0, entity.name.to_owned()), (5, format!("{:X}", FIRST_HANDLE + k))];
            let on_layer = [(100, "AcDbEntity".to_owned()), (8, layer.to_owned()), (370, short(0))];
            for (code, value) in common.iter().chain(&on_layer).chain(&entity.pairs) {
                let _ = writeln!(text, "{code:>3}\n{value}");
            }
        }
        (text + FOOT).replace('\n', "\r\n")
    }

    /// The sheet as SVG, a unit to the mm, thin lines in red.
    pub fn svg(&self) -> String {
        let (lo, hi) = self
            .outline
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        let size = hi - lo + DVec2::splat(2.0 * MARGIN);
        let place = |p: DVec2| (p.x - lo.x + MARGIN, hi.y - p.y + MARGIN);
        let mut path = String::new();
        for (k, p) in self.outline.iter().enumerate() {
            let (x, y) = place(*p);
            // Writing to a String cannot fail.
            let _ = write!(path, "{}{x:.4} {y:.4}", if k == 0 { 'M' } else { 'L' });
        }
        let style = format!(r##"fill="none" stroke="#ff0000" stroke-width="{HAIRLINE}""##);
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.4}mm\" height=\"{h:.4}mm\" viewBox=\"0 0 {w:.4} {h:.4}\">\n\
             <path d=\"{path}Z\" {style}/>\n",
            w = size.x,
            h = size.y
        );
        for (middle, diameter) in &self.holes {
            let (x, y) = place(*middle);
            let _ = writeln!(text, r#"<circle cx="{x:.4}" cy="{y:.4}" r="{:.4}" {style}/>"#, 0.5 * diameter);
        }
        text + "</svg>\n"
    }
}

/// All files of a latch: name and bytes.
///
/// # Errors
/// The kerf is wider than the feature around which it cuts.
pub fn files(latch: &LatchDesign, geometry: &Geometry) -> Result<Vec<(String, Vec<u8>)>, DrawingError> {
    let mut files = Vec::new();
    for sheet in Sheet::all(latch, geometry) {
        let cut = sheet.cut(latch.kerf)?;
        files.push((format!("{}.dxf", sheet.name), sheet.dxf(PART).into_bytes()));
        files.push((format!("{}-cut.dxf", sheet.name), cut.dxf(CUT).into_bytes()));
        files.push((format!("{}-cut.svg", sheet.name), cut.svg().into_bytes()));
    }
    Ok(files)
}

/// A DXF entity: its name, and pairs of group code and value.
struct Entity {
    name: &'static str,
    pairs: Vec<(u16, String)>,
}

impl Entity {
    /// A closed polyline.
    fn polyline(corners: &[DVec2]) -> Self {
        const CLOSED: usize = 1;
        let mut pairs =
            vec![(100, "AcDbPolyline".to_owned()), (90, long(corners.len())), (70, short(CLOSED))];
        pairs.extend(corners.iter().flat_map(|p| [(10, real(p.x)), (20, real(p.y))]));
        Self { name: "LWPOLYLINE", pairs }
    }

    fn circle(middle: DVec2, radius: f64) -> Self {
        let numbers = [(10, middle.x), (20, middle.y), (30, 0.0), (40, radius)];
        let pairs = std::iter::once((100, "AcDbCircle".to_owned()));
        Self {
            name: "CIRCLE",
            pairs: pairs.chain(numbers.map(|(code, value)| (code, real(value)))).collect(),
        }
    }
}

/// A two-byte integer in the format of DXF.
fn short(value: usize) -> String {
    format!("{value:>6}")
}

/// The same for four bytes.
fn long(value: usize) -> String {
    format!("{value:>9}")
}

/// A number to 12 places, without trailing zeros except for one after the point.
fn real(value: f64) -> String {
    let text = format!("{value:.12}");
    let text = text.trim_end_matches('0');
    if text.ends_with('.') { format!("{text}0") } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn latch() -> LatchDesign {
        LatchDesign { dowel: Some(4.0), ..LatchDesign::default() }
    }

    /// Group codes and values of a drawing, entity by entity.
    fn entities(text: &str) -> Vec<Vec<(u16, &str)>> {
        let lines: Vec<&str> = text.lines().collect();
        let pairs =
            lines.as_chunks::<2>().0.iter().map(|[code, value]| (code.trim().parse().unwrap(), *value));
        let all: Vec<(u16, &str)> = pairs.skip_while(|(_, value)| *value != "ENTITIES").skip(1).collect();
        let parts = all.chunk_by(|_, (code, _)| *code != 0).map(<[_]>::to_vec);
        parts.take_while(|entity| entity[0].1 != "ENDSEC").collect()
    }

    #[test]
    fn a_dxf_reads_back_as_drawn() {
        let latch = latch();
        let geometry = Geometry::of(&latch).unwrap();
        for sheet in Sheet::all(&latch, &geometry) {
            let text = sheet.dxf(PART);
            assert!(!text.contains("$TDCREATE") && text.contains("$INSUNITS") && !text.contains('{'));
            assert!(text.lines().count() % 2 == 0 && text.ends_with("EOF\r\n"));
            let result = entities(&text);
            let [line, holes @ ..] = &result[..] else { panic!() };
            let numbers = |entity: &[(u16, &str)], code: u16| -> Vec<f64> {
                let of_code = entity.iter().filter(|(c, _)| *c == code);
                of_code.map(|(_, value)| value.trim().parse().unwrap()).collect()
            };
            assert!(line[0].1 == "LWPOLYLINE" && numbers(line, 70) == [1.0]);
            assert_eq!(numbers(line, 90), [sheet.outline.len() as f64]);
            let corners = numbers(line, 10).into_iter().zip(numbers(line, 20));
            assert_eq!(corners.clone().count(), sheet.outline.len());
            for ((x, y), p) in corners.zip(&sheet.outline) {
                assert!((x - p.x).abs().max((y - p.y).abs()) < 1e-9);
            }
            assert_eq!(holes.len(), 2);
            for (hole, (middle, diameter)) in holes.iter().zip(&sheet.holes) {
                assert!(hole[0].1 == "CIRCLE" && numbers(hole, 40) == [0.5 * diameter]);
                assert!((numbers(hole, 10)[0] - middle.x).abs() < 1e-9);
                assert!(hole.contains(&(8, PART)));
            }
            // Handles are unique, and the header contains the next free handle.
            let handles: Vec<usize> =
                result.iter().map(|one| usize::from_str_radix(one[1].1, 16).unwrap()).collect();
            assert_eq!(handles, [0x11, 0x12, 0x13]);
            assert!(text.contains("$HANDSEED\r\n  5\r\n14\r\n"));
        }
    }

    #[test]
    fn an_svg_is_true_to_scale() {
        let latch = latch();
        let geometry = Geometry::of(&latch).unwrap();
        let cut = Sheet::all(&latch, &geometry)[0].cut(latch.kerf).unwrap();
        let text = cut.svg();
        // 65.5 mm, a kerf, and a margin to both sides.
        assert!(text.contains(r#"width="75.6800mm""#), "{}", &text[..200]);
        assert_eq!(text.matches("<circle").count(), 2);
        assert!(text.contains(r#"r="1.9100""#), "holes are cut inside");
    }

    #[test]
    fn one_layer_is_one_sheet() {
        let latch = LatchDesign { layers: 1, ..LatchDesign::default() };
        assert_eq!(files(&latch, &Geometry::of(&latch).unwrap()).unwrap().len(), 3);
    }
}
