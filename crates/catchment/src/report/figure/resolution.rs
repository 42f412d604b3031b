//! Figure 5.13 of the dissertation, drawn again: Sum and time over the resolution.

use super::Picture;
use super::chart::{Chart, Line, Point, legend};
use super::colour::CURVES;
use super::svg::{Anchor, LABEL, Rect, SOFT, Svg, TITLE};
use crate::study::reproduce::resolution::Found;

/// Colour of the exact value.
const EXACT: super::colour::Rgb = [0x1f, 0x29, 0x33];

/// Draws the Sums of every method over N with the exact one and its interval, and beside them the time that each took.
pub fn resolution(found: &Found) -> Picture {
    let (left, right, top, size) = (78.0, 560.0, 96.0, [400.0, 300.0]);
    let mut svg = Svg::new(right + size[0] + 28.0, top + size[1] + 56.0);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, "Figure 5.13: V-Face, H/D 1/4, COR −1/2");
    let [lo, hi] = found.exact_ci95;
    let story = format!(
        "exact {:.4} D·rad, 95 % interval {lo:.4} … {hi:.4}  ·  the published figure is lost; its text: larger at first, slowly \
         decreasing",
        found.exact
    );
    svg.text([24.0, 50.0], LABEL, Anchor::Start, SOFT, &story);
    let curves = |y: fn(f64, f64) -> f64| -> Vec<Line> {
        let line = |(k, curve): (usize, &crate::study::reproduce::resolution::Curve)| Line {
            name: curve.name.to_owned(),
            colour: CURVES[k % CURVES.len()],
            points: curve
                .points
                .iter()
                .map(|p| Point { x: p.resolution as f64, y: y(p.sum, p.seconds), interval: None })
                .collect(),
        };
        found.curves.iter().enumerate().map(line).collect()
    };
    let mut sums = curves(|sum, _| sum);
    let ends = found.settings.resolutions.first().into_iter().chain(found.settings.resolutions.last());
    let exact = |n: &usize| Point { x: *n as f64, y: found.exact, interval: Some(found.exact_ci95) };
    sums.push(Line { name: "exact".to_owned(), colour: EXACT, points: ends.map(exact).collect() });
    let seconds = curves(|_, seconds| seconds.max(1e-6).log10());
    for (x, y_label, lines) in [(left, "Sum [D·rad]", &sums), (right, "log₁₀ of seconds", &seconds)] {
        let rect = Rect { x, y: top, w: size[0], h: size[1] };
        Chart { rect, x_label: "samples or cells per axis", y_label, lines, mark: None }.draw(&mut svg);
    }
    legend(&mut svg, &sums, [left, top - 16.0]);
    Picture { svg: svg.finish() }
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::study::reproduce::resolution::{Curve, Point, Settings};

    #[test]
    fn every_method_is_drawn_in_both_charts_and_the_exact_value_in_one() {
        let settings = Settings { resolutions: vec![25, 50, 100], ..Settings::default() };
        let curve = |name: &'static str, off: f64| Curve {
            name,
            points: settings
                .resolutions
                .iter()
                .map(|n| Point { resolution: *n, sum: 0.5 + off / *n as f64, seconds: 1e-6 * (n * n) as f64 })
                .collect(),
        };
        let curves = vec![curve("dissertation's", 3.0), curve("transport", 1.0), curve("descent", -1.0)];
        let found = Found { exact: 0.5, exact_ci95: [0.49, 0.51], rotation_length: 0.5, curves, settings };
        let picture = resolution(&found);
        look("resolution", &picture);
        assert_eq!(picture.svg().matches("<circle").count(), 2 * 9 + 2);
        assert!(!picture.svg().contains("NaN"));
    }
}
