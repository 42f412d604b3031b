//! Axes for people: the design's unit or D, degrees, ticks at round numbers.

use super::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, width_of};
use catchment_core::design::Design;
use catchment_core::landscape::GridAxis;
use catchment_core::pose::Dof;

/// How a design's lengths and angles are shown.
#[derive(Debug, Clone, Copy)]
pub struct ShownUnits {
    /// Value of 1 D on an axis.
    width: f64,
    symbol: &'static str,
}

impl ShownUnits {
    /// Those of a design.
    pub fn of(design: &Design) -> Self {
        match design.unit {
            Some(unit) => Self { width: design.width, symbol: unit.symbol() },
            None => Self { width: 1.0, symbol: "D" },
        }
    }

    /// Factor from a library value to the displayed value.
    pub fn factor(&self, dof: Dof) -> f64 {
        if dof.is_rotation() { 1f64.to_degrees() } else { self.width }
    }

    /// `x [mm]`, `pitch [deg]`.
    pub fn label(&self, dof: Dof) -> String {
        format!("{} [{}]", dof.name(), if dof.is_rotation() { "deg" } else { self.symbol })
    }

    /// `x = 12.5 mm`, `pitch = 30°`.
    pub fn value(&self, dof: Dof, value: f64) -> String {
        let shown = short(value * self.factor(dof));
        if dof.is_rotation() {
            format!("{} = {shown}°", dof.name())
        } else {
            format!("{} = {shown} {}", dof.name(), self.symbol)
        }
    }

    /// The scale of an error axis of a grid.
    pub fn axis(&self, axis: &GridAxis) -> AxisScale {
        let factor = self.factor(axis.dof);
        AxisScale::new(self.label(axis.dof), axis.lo * factor, axis.hi * factor, axis.dof.is_rotation())
    }

    /// The scale of an error from −`half` to `half`, in library units.
    pub fn symmetric(&self, dof: Dof, half: f64) -> AxisScale {
        let half = half * self.factor(dof);
        AxisScale::new(self.label(dof), -half, half, dof.is_rotation())
    }

    /// The scale of a length that is no error.
    pub fn length(&self, name: &str, lo: f64, hi: f64) -> AxisScale {
        AxisScale::new(format!("{name} [{}]", self.symbol), lo * self.width, hi * self.width, false)
    }

    /// The unit of lengths.
    pub const fn symbol(&self) -> &'static str {
        self.symbol
    }

    /// Factor from a length in D to the displayed value.
    pub const fn lengths(&self) -> f64 {
        self.width
    }
}

/// A short number without insignificant decimals.
pub fn short(value: f64) -> String {
    let digits = if value.abs() >= 100.0 {
        0
    } else if value.abs() >= 10.0 {
        1
    } else {
        2
    };
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}

/// A labelled range of shown values.
#[derive(Debug, Clone)]
pub struct AxisScale {
    /// The quantity, with its unit.
    pub label: String,
    /// Start of the range.
    pub lo: f64,
    /// End of the range.
    pub hi: f64,
    degrees: bool,
}

impl AxisScale {
    /// A range with its label; `degrees` requests ticks at multiples of 15 if they fit.
    pub const fn new(label: String, lo: f64, hi: f64, degrees: bool) -> Self {
        Self { label, lo, hi, degrees }
    }

    /// Round numbers in the range, about `wanted` of them.
    pub fn ticks(&self, wanted: usize) -> Vec<f64> {
        /// A step may be finer than wanted by this factor before the next rounder step is used.
        const FINER: f64 = 0.8;
        const DEGREES: [f64; 7] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0];
        let span = self.hi - self.lo;
        if !(span > 0.0 && span.is_finite()) {
            return Vec::new();
        }
        let rough = span / wanted.max(1) as f64;
        let decimal = || {
            let magnitude = 10f64.powf(rough.log10().floor());
            [1.0, 2.0, 5.0]
                .into_iter()
                .map(|k| k * magnitude)
                .find(|s| *s >= FINER * rough)
                .unwrap_or(10.0 * magnitude)
        };
        let step = if self.degrees && (0.5..=45.0).contains(&rough) {
            DEGREES.into_iter().find(|s| *s >= rough).unwrap_or(45.0)
        } else {
            decimal()
        };
        let slack = 1e-9 * span;
        let (first, last) =
            (((self.lo - slack) / step).ceil() as i64, ((self.hi + slack) / step).floor() as i64);
        (first..=last).map(|k| k as f64 * step).collect()
    }
}

/// A frame with two scales: shown values to places in the picture.
#[derive(Debug, Clone)]
pub struct PlotFrame {
    /// Its position in the picture.
    pub rect: Rect,
    /// The scale of its lower side.
    pub x: AxisScale,
    /// The scale of its left side.
    pub y: AxisScale,
}

impl PlotFrame {
    /// Across the picture, of a shown value.
    pub fn px(&self, x: f64) -> f64 {
        self.rect.x + (x - self.x.lo) / (self.x.hi - self.x.lo) * self.rect.w
    }

    /// Down the picture, of a shown value.
    pub fn py(&self, y: f64) -> f64 {
        self.rect.y + self.rect.h - (y - self.y.lo) / (self.y.hi - self.y.lo) * self.rect.h
    }

    /// The place of two shown values.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.px(x), self.py(y)]
    }

    /// Outline, ticks and labels, in the room of [`super::layout::Panel::with_axes`].
    pub fn draw(&self, svg: &mut Svg) {
        self.below(svg);
        self.beside(svg);
        self.outline(svg);
    }

    /// Ticks and label of the lower side.
    pub fn below(&self, svg: &mut Svg) {
        let r = self.rect;
        for x in self.x.ticks((r.w / 46.0) as usize) {
            let px = self.px(x);
            svg.line([px, r.y + r.h], [px, r.y + r.h + 4.0], TICK_LINE);
            svg.text([px, r.y + r.h + 15.5], TICK, Anchor::Middle, SOFT, &tick_label(x));
        }
        svg.text([r.x + 0.5 * r.w, r.y + r.h + 32.0], LABEL, Anchor::Middle, INK, &self.x.label);
    }

    /// Ticks and label of the left side.
    pub fn beside(&self, svg: &mut Svg) {
        let r = self.rect;
        let mut widest: f64 = 0.0;
        for y in self.y.ticks((r.h / 40.0) as usize) {
            let (py, number) = (self.py(y), tick_label(y));
            svg.line([r.x - 4.0, py], [r.x, py], TICK_LINE);
            svg.text([r.x - 7.0, py + 3.8], TICK, Anchor::End, SOFT, &number);
            widest = widest.max(width_of(&number, TICK));
        }
        svg.text_up([r.x - (widest + 13.0).max(38.0), r.y + 0.5 * r.h], LABEL, &self.y.label);
    }

    /// Its outline alone.
    pub fn outline(&self, svg: &mut Svg) {
        svg.rect(self.rect, &format!(r#"fill="none" stroke="{SOFT}" stroke-width="1""#));
    }
}

/// The style of the line of a tick, of the colour [`SOFT`].
pub const TICK_LINE: &str = r##"stroke="#5f6b7a" stroke-width="0.8""##;

/// A tick's number: multiples of a round step need few digits.
pub fn tick_label(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 { "0".to_owned() } else { format!("{rounded}").replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        let ticks = |lo, hi, degrees, wanted| AxisScale::new(String::new(), lo, hi, degrees).ticks(wanted);
        assert_eq!(ticks(-90.0, 90.0, true, 5), [-90.0, -45.0, 0.0, 45.0, 90.0]);
        assert_eq!(ticks(-50.0, 50.0, false, 5), [-40.0, -20.0, 0.0, 20.0, 40.0]);
        assert_eq!(ticks(-1.0, 1.0, false, 4), [-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert_eq!(ticks(1.0, 1.0, false, 4), [0.0; 0]);
    }

    #[test]
    fn labels_have_no_noise() {
        assert_eq!([0.1 + 0.2, -0.0, -15.0].map(tick_label), ["0.3", "0", "−15"]);
        assert_eq!([12.3456, -0.001, 250.0, 100.4].map(short), ["12.3", "0", "250", "100"]);
    }
}
