//! What a laser cutter takes: DXF and SVG of every sheet, true to scale, in mm.
//!
//! ```text
//!   front, back      the two layers, mirror images          NAME.dxf       the part as it should come out
//!   separator        the sheet between them                 NAME-cut.dxf   where the laser's middle runs
//!                                                           NAME-cut.svg   the same as SVG
//! ```
//!
//! The cut line lies half a kerf outside the part (holes: inside). Inside the files y points up (SVG: down), and x = 0 is the
//! left edge of the part.

use super::kerf::{KerfError, compensated};
use super::outline::Polygon;
use super::{Geometry, Latch};
use dxf::entities::{Circle, Entity, EntityType, LwPolyline};
use dxf::enums::{AcadVersion, Units};
use dxf::tables::Layer;
use dxf::{Color, Drawing, LwPolylineVertex, Point};
use glam::DVec2;
use std::fmt::Write;

/// CAD layer of the part.
pub const PART: &str = "PART";
/// CAD layer of the cut line.
pub const CUT: &str = "CUT";
/// Colours of the two, in `AutoCAD`'s palette: white or black, and red.
const COLOURS: [u8; 2] = [7, 1];
/// Flag of a closed polyline.
const CLOSED: i32 = 1;
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
    /// The DXF could not be written.
    #[error("cannot write the DXF: {0}")]
    Dxf(#[from] dxf::DxfError),
    /// It is no text.
    #[error("cannot write the DXF: it is no text")]
    Text(#[from] std::string::FromUtf8Error),
}

impl Sheet {
    /// The sheets of a latch, as they should come out.
    pub fn all(latch: &Latch, geometry: &Geometry) -> Vec<Self> {
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

    /// Where the laser's middle runs.
    ///
    /// # Errors
    /// The kerf is wider than what it cuts around.
    pub fn cut(&self, kerf: f64) -> Result<Self, KerfError> {
        let holes = self.holes.iter().map(|(middle, diameter)| (*middle, diameter - kerf)).collect();
        Ok(Self { name: self.name, outline: compensated(&self.outline, kerf)?, holes })
    }

    /// The sheet as DXF (`AutoCAD` 2000), on one CAD layer. The same sheet gives the same bytes: no date, no random numbers.
    ///
    /// # Errors
    /// None that is known: it is written into memory.
    #[expect(clippy::default_trait_access, reason = "only dxf itself depends on the crate of the type")]
    pub fn dxf(&self, layer: &str) -> Result<String, DrawingError> {
        let mut drawing = Drawing::new();
        drawing.header.version = AcadVersion::R2000;
        drawing.header.default_drawing_units = Units::Millimeters;
        drawing.header.fingerprint_guid = Default::default();
        drawing.header.version_guid = Default::default();
        let colour = COLOURS[usize::from(layer == CUT)];
        drawing.add_layer(Layer {
            name: layer.to_owned(),
            color: Color::from_index(colour),
            ..Layer::default()
        });
        let mut add = |specific: EntityType| {
            let mut entity = Entity::new(specific);
            layer.clone_into(&mut entity.common.layer);
            drawing.add_entity(entity);
        };
        let vertex = |p: &DVec2| LwPolylineVertex { x: p.x, y: p.y, ..LwPolylineVertex::default() };
        let vertices = self.outline.iter().map(vertex).collect();
        add(EntityType::LwPolyline(LwPolyline { flags: CLOSED, vertices, ..LwPolyline::default() }));
        for (middle, diameter) in &self.holes {
            add(EntityType::Circle(Circle::new(Point::new(middle.x, middle.y, 0.0), 0.5 * diameter)));
        }
        let mut bytes = Vec::new();
        drawing.save(&mut bytes)?;
        Ok(without_dates(&String::from_utf8(bytes)?))
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
/// The kerf is wider than what it cuts around.
pub fn files(latch: &Latch, geometry: &Geometry) -> Result<Vec<(String, Vec<u8>)>, DrawingError> {
    let mut files = Vec::new();
    for sheet in Sheet::all(latch, geometry) {
        let cut = sheet.cut(latch.kerf)?;
        files.push((format!("{}.dxf", sheet.name), sheet.dxf(PART)?.into_bytes()));
        files.push((format!("{}-cut.dxf", sheet.name), cut.dxf(CUT)?.into_bytes()));
        files.push((format!("{}-cut.svg", sheet.name), cut.svg().into_bytes()));
    }
    Ok(files)
}

/// The DXF without the header's times: variables `$TD…`, each two pairs of lines.
fn without_dates(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mut kept = String::with_capacity(text.len());
    let mut pairs = lines.chunks_exact(2).peekable();
    while let Some(pair) = pairs.next() {
        if pair[1].starts_with("$TD") {
            pairs.next();
            continue;
        }
        for line in pair {
            kept.push_str(line);
            kept.push_str("\r\n");
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn latch() -> Latch {
        Latch { dowel: Some(4.0), ..Latch::default() }
    }

    #[test]
    fn a_dxf_reads_back_as_what_was_drawn() {
        let latch = latch();
        let geometry = Geometry::of(&latch).unwrap();
        for sheet in Sheet::all(&latch, &geometry) {
            let text = sheet.dxf(PART).unwrap();
            assert_eq!(text, sheet.dxf(PART).unwrap(), "the same bytes");
            assert!(!text.contains("$TDCREATE") && text.contains("$INSUNITS"));
            let read = Drawing::load(&mut text.as_bytes()).unwrap();
            let mut holes = 0;
            for entity in read.entities() {
                match &entity.specific {
                    EntityType::LwPolyline(line) => {
                        assert!(line.flags == CLOSED && line.vertices.len() == sheet.outline.len());
                        let off = line.vertices.iter().zip(&sheet.outline);
                        assert!(off.map(|(v, p)| (v.x - p.x).abs().max((v.y - p.y).abs())).all(|d| d < 1e-9));
                    }
                    EntityType::Circle(circle) => {
                        holes += 1;
                        assert!(circle.radius == 2.0);
                    }
                    other => panic!("{other:?}"),
                }
            }
            assert_eq!(holes, 2);
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
        let latch = Latch { layers: 1, ..Latch::default() };
        assert_eq!(files(&latch, &Geometry::of(&latch).unwrap()).unwrap().len(), 3);
    }
}
