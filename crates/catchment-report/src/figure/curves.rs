//! Curves over a logarithmic scale, in charts side by side.

use super::Picture;
use super::draw::chart::{self, Chart, ChartLine, ChartPoint, Spacing};
use super::draw::colour::{CURVES, Rgb};
use super::draw::layout::{Layout, Panel};

/// A curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// Its points; those whose x is not positive are left out.
    pub points: Vec<CurvePoint>,
    /// Whether it is the reference for the others: drawn in ink, not in a colour.
    pub is_reference: bool,
}

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Place on the logarithmic scale.
    pub x: f64,
    /// Value.
    pub y: f64,
    /// The interval of the value, if any.
    pub interval: Option<[f64; 2]>,
}

/// A chart of curves.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveChart<'a> {
    /// Label of the horizontal axis.
    pub x_label: &'a str,
    /// Label of the vertical axis.
    pub y_label: &'a str,
    /// The curves; the same place in every chart has the same colour.
    pub curves: Vec<Curve>,
}

/// Colour of a reference.
const REFERENCE: Rgb = [0x1f, 0x29, 0x33];

/// Draws charts side by side below a title and a line, with the names of the first chart's curves.
pub fn curves(title: &str, story: &str, charts: &[CurveChart]) -> Picture {
    let drawn: Vec<Vec<ChartLine>> = charts.iter().map(|chart| lines(&chart.curves)).collect();
    let panel = |(k, lines): (usize, &Vec<ChartLine>)| {
        let panel = Panel::with_axes([400.0, 300.0]);
        if k == 0 { panel.over(chart::legend(lines)) } else { panel }
    };
    let panels = drawn.iter().enumerate().map(panel);
    let (mut svg, frames) = Layout::titled(title).story(story).row(panels).open();
    for ((chart, lines), rect) in charts.iter().zip(&drawn).zip(frames) {
        let CurveChart { x_label, y_label, .. } = *chart;
        Chart { rect, x_label, spacing: Spacing::Logarithmic, y_label, lines, mark: None }.draw(&mut svg);
    }
    Picture::of(svg)
}

fn lines(curves: &[Curve]) -> Vec<ChartLine> {
    let line = |(k, curve): (usize, &Curve)| ChartLine {
        name: curve.name.clone(),
        colour: if curve.is_reference { REFERENCE } else { CURVES[k % CURVES.len()] },
        points: curve.points.iter().map(|p| ChartPoint { x: p.x, y: p.y, interval: p.interval }).collect(),
    };
    curves.iter().enumerate().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;

    #[test]
    fn every_curve_is_drawn_in_its_chart() {
        let curve = |name: &str, off: f64, is_reference: bool| Curve {
            name: name.to_owned(),
            points: [25.0, 50.0, 100.0]
                .map(|x| CurvePoint { x, y: 0.5 + off / x, interval: is_reference.then_some([0.49, 0.51]) })
                .to_vec(),
            is_reference,
        };
        let some = vec![curve("transport", 1.0, false), curve("descent", -1.0, false)];
        let mut all = some.clone();
        all.push(curve("exact", 0.0, true));
        let charts = [
            CurveChart { x_label: "cells per axis", y_label: "Sum", curves: all },
            CurveChart { x_label: "cells per axis", y_label: "time", curves: some },
        ];
        let picture = curves("Curves", "of two methods", &charts);
        look("curves", &picture);
        assert_eq!(picture.svg().matches("<circle").count(), 9 + 6);
        assert!(!picture.svg().contains("NaN"));
    }
}
