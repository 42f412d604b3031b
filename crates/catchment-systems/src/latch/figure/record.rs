//! The record of a press: force over the path, with the dips as hooks pass, below the force to latch that is
//! fitted to measurements.

use super::super::press::Record;
use catchment::report::figure::draw::axis::{AxisScale, PlotFrame};
use catchment::report::figure::draw::colour::{CURVES, hex};
use catchment::report::figure::draw::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, TICK, polyline};

/// Draws the record into a rectangle, its title above; `latching` is the fitted force to latch, in N.
pub(super) fn draw(svg: &mut Svg, rect: Rect, record: &Record, latching: f64) {
    svg.bold(
        [rect.x - 46.0, rect.y - 26.0],
        LABEL,
        Anchor::Start,
        "pressed together: springs and friction alone",
    );
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
    // Clear of the line of the fitted force, which lies at the top unless friction lifts the record above it.
    let key = rect.y + 0.42 * rect.h;
    let layers = record.positions.first().map_or(0, |p| p.layers.len());
    for layer in (0..layers).filter(|_| layers > 1) {
        let style = format!(
            r#"fill="none" stroke="{}" stroke-width="1.2" stroke-dasharray="4 3" {JOIN}"#,
            hex(CURVES[layer + 1])
        );
        svg.path(&curve(&|k| record.positions[k].layers[layer].force), &style);
        let x = rect.x + 10.0 + 92.0 * layer as f64;
        svg.line([x, key], [x + 16.0, key], &style);
        svg.text([x + 21.0, key + 4.0], TICK, Anchor::Start, SOFT, &format!("layer {}", layer + 1));
    }
    let style = format!(r#"fill="none" stroke="{}" stroke-width="2" {JOIN}"#, hex(CURVES[0]));
    svg.path(&curve(&|k| record.positions[k].force), &style);
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
