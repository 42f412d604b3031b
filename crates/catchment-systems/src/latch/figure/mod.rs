//! Pictures of a latch.
//!
//! ```text
//!   latch      the outline with its names, the four steps, the chart of bonding ratios, the record of the press
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
use catchment::report::figure::draw::layout::{Layout, Panel};

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
        const PART: [f64; 2] = [440.0, 560.0];
        const CHART: [f64; 2] = [440.0, 240.0];
        let charts = [chart::panel(CHART), record::panel(CHART, self.record)];
        let (mut svg, frames) = self.page().row([Panel::of(PART), part::steps(PART)]).row(charts).open();
        let [outline, steps, ratios, press] = frames[..] else { return Picture::of(svg) };
        part::outline(&mut svg, outline, self.latch, self.geometry);
        part::sequence(&mut svg, steps, self, 2);
        chart::draw(&mut svg, ratios, self.forces, Some(self.latch));
        record::draw(&mut svg, press, self.record, self.fitted());
        Picture::of(svg)
    }

    /// The outline alone.
    pub fn outline(&self) -> Picture {
        let (mut svg, frames) = self.page().row([Panel::of([560.0, 690.0])]).open();
        part::outline(&mut svg, frames[0], self.latch, self.geometry);
        Picture::of(svg)
    }

    /// The four steps.
    pub fn sequence(&self) -> Picture {
        let (mut svg, frames) = self.page().row([part::steps([940.0, 330.0])]).open();
        part::sequence(&mut svg, frames[0], self, 4);
        Picture::of(svg)
    }

    /// The record of the press.
    pub fn press(&self) -> Picture {
        let (mut svg, frames) = self.page().row([record::panel([530.0, 220.0], self.record)]).open();
        record::draw(&mut svg, frames[0], self.record, self.fitted());
        Picture::of(svg)
    }

    /// The force to latch, fitted to measurements, in N.
    fn fitted(&self) -> f64 {
        self.forces.latching(self.latch, self.geometry).force_n
    }

    fn page(&self) -> Layout {
        let d = self.latch;
        let [o, t, width, sheet] = [d.overhang, d.neck, d.width, d.sheet];
        Layout::titled(&d.name)
            .story(format!("overhang {o} mm, neck {t} mm, {width} mm wide, sheet {sheet} mm"))
    }
}

/// Bonding ratio over overhang and neck; a design's own place in it.
pub fn chart(forces: &Forces, latch: Option<&LatchDesign>) -> Picture {
    let layout = Layout::titled("Bonding ratio of latching X-Faces").row([chart::panel([516.0, 320.0])]);
    let (mut svg, frames) = layout.open();
    chart::draw(&mut svg, frames[0], forces, latch);
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
