//! The record of a press: force over the path, with the dips as hooks pass, below the force to latch that is
//! fitted to measurements.

use super::super::press::Record;
use catchment::report::figure::draw::axis::{AxisScale, PlotFrame};
use catchment::report::figure::draw::colour::{CURVES, hex};
use catchment::report::figure::draw::layout::{Legend, Panel, stroked};
use catchment::report::figure::draw::svg::{Anchor, INK, Rect, SOFT, Svg, TICK, polyline};

/// The panel of the record.
pub(super) fn panel(size: [f64; 2], record: &Record) -> Panel {
    /// Above the frame, for the name of the seat.
    const SEAT: f64 = 8.0;
    let layers = layers(record)
        .fold(Legend::titled("both layers:").line(stroked(CURVES[0], 2.0), "sum"), |legend, layer| {
            legend.line(of_layer(layer), format!("layer {}", layer + 1))
        });
    let panel = Panel::with_axes(size).with_room([0.0, SEAT, 0.0, 0.0]);
    panel.over("pressed together: springs and friction alone").over(layers)
}

/// The layers that are drawn beside their sum.
fn layers(record: &Record) -> impl Iterator<Item = usize> {
    let count = record.positions.first().map_or(0, |p| p.layers.len());
    (0..count).filter(move |_| count > 1)
}

fn of_layer(layer: usize) -> String {
    format!(r#"{} stroke-dasharray="4 3""#, stroked(CURVES[layer + 1], 1.2))
}

/// Draws the record into its frame; `latching` is the fitted force to latch, in N.
pub(super) fn draw(svg: &mut Svg, rect: Rect, record: &Record, latching: f64) {
    let way = |above: f64| record.first_contact - above;
    let (first, last) = match &record.positions[..] {
        [first, .., last] => (way(first.above), way(last.above)),
        _ => return,
    };
    let frame = PlotFrame {
        rect,
        x: AxisScale::new("way after first contact [mm]".to_owned(), first, last, false),
        y: AxisScale::new("force [N]".to_owned(), 0.0, 1.15 * record.peak.max(latching), false),
    };
    let curve = |of: &dyn Fn(usize) -> f64| {
        polyline(
            (0..record.positions.len()).map(|k| frame.at([way(record.positions[k].above), of(k)])),
            false,
        )
    };
    for layer in layers(record) {
        svg.path(&curve(&|k| record.positions[k].layers[layer].force), &of_layer(layer));
    }
    svg.path(&curve(&|k| record.positions[k].force), &stroked(CURVES[0], 2.0));
    for (k, dip) in record.dips.iter().enumerate() {
        let [x, y] = frame.at([way(dip.above), dip.from]);
        svg.circle([x, y], 3.0, &format!(r##"fill="{}" stroke="#ffffff" stroke-width="1""##, hex(CURVES[0])));
        // Above the curve for the first snap, below it for the next, clear of the drop.
        let level = if k == 0 { y - 10.0 } else { y + 18.0 };
        svg.text([x - 24.0, level], TICK, Anchor::End, INK, &format!("layer {} snaps", dip.layer));
    }
    let [start, level] = frame.at([first, latching]);
    svg.line(
        [start, level],
        [rect.x + rect.w, level],
        &format!(r#"stroke="{}" stroke-width="1.4" stroke-dasharray="7 4""#, hex(CURVES[3])),
    );
    let fitted = format!("force to latch, fitted to measurements: {latching:.1} N");
    svg.text([rect.x + 10.0, level - 6.0], TICK, Anchor::Start, INK, &fitted);
    let seat = frame.px(way(0.0));
    svg.line(
        [seat, rect.y],
        [seat, rect.y + rect.h],
        r##"stroke="#5f6b7a" stroke-width="0.9" stroke-dasharray="2 3""##,
    );
    svg.text([seat, rect.y - 5.0], TICK, Anchor::Middle, SOFT, "seat");
    frame.draw(svg);
}
