//! Pictures of a latch.
//!
//! ```text
//!   latch      the outline with its names, the four steps, the record of the press, the chart of bonding ratios
//!   outline    the outline alone
//!   sequence   approach, align, arms pushed outward, snapped
//!   press      force over the travel of a pair
//!   chart      bonding ratio over overhang and neck, with the nine measured designs
//! ```

mod chart;
mod part;
mod record;

use super::force::Forces;
use super::press::Record;
use super::{Geometry, LatchDesign};
use catchment::report::figure::Picture;
use catchment::report::figure::draw::svg::{Anchor, LABEL, Rect, SOFT, Svg, TITLE};

/// All data for the pictures of a latch.
#[derive(Debug, Clone, Copy)]
pub struct LatchDrawings<'a> {
    /// The latch.
    pub latch: &'a LatchDesign,
    /// Its outline.
    pub geometry: &'a Geometry,
    /// A pair of them pressed together.
    pub record: &'a Record,
    /// The measured designs and the fits to them.
    pub forces: &'a Forces,
}

/// Left side of everything.
const LEFT: f64 = 30.0;

impl LatchDrawings<'_> {
    /// Every picture, by the name of its file.
    pub fn all(&self) -> Vec<(&'static str, Picture)> {
        vec![
            ("latch", self.overview()),
            ("outline", self.outline()),
            ("sequence", self.sequence()),
            ("press", self.press()),
            ("chart", chart(self.forces, Some(self.latch))),
        ]
    }

    /// All pictures in one.
    pub fn overview(&self) -> Picture {
        let mut svg = Svg::new(1000.0, 1030.0);
        self.title(&mut svg);
        part::outline(&mut svg, Rect { x: LEFT, y: 70.0, w: 440.0, h: 560.0 }, self.latch, self.geometry);
        chart::draw(&mut svg, Rect { x: 560.0, y: 110.0, w: 330.0, h: 215.0 }, self.forces, Some(self.latch));
        record::draw(&mut svg, Rect { x: 560.0, y: 430.0, w: 400.0, h: 180.0 }, self.record, self.fitted());
        part::sequence(&mut svg, Rect { x: LEFT, y: 690.0, w: 940.0, h: 320.0 }, self);
        Picture::of(svg)
    }

    /// The outline alone.
    pub fn outline(&self) -> Picture {
        let mut svg = Svg::new(620.0, 780.0);
        self.title(&mut svg);
        part::outline(&mut svg, Rect { x: LEFT, y: 70.0, w: 560.0, h: 690.0 }, self.latch, self.geometry);
        Picture::of(svg)
    }

    /// The four steps.
    pub fn sequence(&self) -> Picture {
        let mut svg = Svg::new(1000.0, 420.0);
        self.title(&mut svg);
        part::sequence(&mut svg, Rect { x: LEFT, y: 80.0, w: 940.0, h: 320.0 }, self);
        Picture::of(svg)
    }

    /// The record of the press.
    pub fn press(&self) -> Picture {
        let mut svg = Svg::new(640.0, 380.0);
        self.title(&mut svg);
        record::draw(&mut svg, Rect { x: 76.0, y: 100.0, w: 530.0, h: 220.0 }, self.record, self.fitted());
        Picture::of(svg)
    }

    /// The force to latch, fitted to measurements, in N.
    fn fitted(&self) -> f64 {
        self.forces.latching(self.latch, self.geometry).force_n
    }

    fn title(&self, svg: &mut Svg) {
        let d = self.latch;
        svg.bold([LEFT, 30.0], TITLE, Anchor::Start, &d.name);
        let story = format!(
            "overhang {} mm, neck {} mm, {} mm wide, sheet {} mm",
            d.overhang, d.neck, d.width, d.sheet
        );
        svg.text([LEFT, 49.0], LABEL, Anchor::Start, SOFT, &story);
    }
}

/// Bonding ratio over overhang and neck; a design's own place in it.
pub fn chart(forces: &Forces, latch: Option<&LatchDesign>) -> Picture {
    let mut svg = Svg::new(640.0, 480.0);
    chart::draw(&mut svg, Rect { x: 76.0, y: 80.0, w: 440.0, h: 320.0 }, forces, latch);
    Picture::of(svg)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_is_drawn_without_a_hole_in_its_numbers() {
        let latch = LatchDesign::default();
        let geometry = Geometry::of(&latch).unwrap();
        let record = super::super::press::record(&latch, &geometry).unwrap();
        let forces = Forces::new().unwrap();
        let drawn = LatchDrawings { latch: &latch, geometry: &geometry, record: &record, forces: &forces };
        for (name, picture) in drawn.all() {
            assert!(!picture.svg().contains("NaN") && picture.svg().len() > 4000, "{name}");
            assert!(picture.png(0.5).unwrap().len() > 2000, "{name}");
        }
        assert!(drawn.overview().svg().contains("snapped") && drawn.overview().svg().contains("79.1"));
        // The computed force lies below the measured force, and the figure shows the difference.
        assert!(drawn.press().svg().contains("fitted to measurements: 13.4 N"));
    }
}
