//! Bonding ratio over overhang and neck, with the nine measured designs, and the region in which the model
//! extrapolates.

use super::super::LatchDesign;
use super::super::force::{Forces, outside};
use super::super::measured::REJECTED_OVERHANG;
use catchment::report::figure::draw::axis::{AxisScale, PlotFrame};
use catchment::report::figure::draw::colour::{Rgb, hex, mix, sequential};
use catchment::report::figure::draw::layout::{Legend, Panel};
use catchment::report::figure::draw::svg::{Anchor, INK, Rect, SOFT, Svg, TICK, width_of};

/// The chart's overhangs and necks, in mm.
const OVERHANGS: [f64; 2] = [1.0, 6.0];
/// See [`OVERHANGS`].
const NECKS: [f64; 2] = [2.0, 5.0];
/// Cells across and up.
const CELLS: [usize; 2] = [50, 30];
/// Ratios between which colours run, on a logarithmic scale.
const RATIOS: [f64; 2] = [15.0, 110.0];
/// Strength of a colour in the region in which the model extrapolates.
const GUESS: f64 = 0.45;

fn colour(ratio: f64) -> Rgb {
    let [lo, hi] = RATIOS.map(f64::ln);
    sequential((ratio.ln() - lo) / (hi - lo))
}

/// Width of the scale of colours with its numbers.
const SCALE: f64 = 60.0;

/// The panel of the chart; its width includes the scale of colours.
pub(super) fn panel([w, h]: [f64; 2]) -> Panel {
    Panel::with_axes([w - SCALE, h])
        .with_room([0.0, 0.0, SCALE, 0.0])
        .over("bonding ratio: force to break over force to latch")
        .over(Legend::titled("points: measured; colours: model; pale: extrapolated, or an upper bound"))
}

/// Draws the chart into its frame; the scale of colours to the right.
pub(super) fn draw(svg: &mut Svg, rect: Rect, forces: &Forces, latch: Option<&LatchDesign>) {
    let frame = PlotFrame {
        rect,
        x: AxisScale::new("overhang o [mm]".to_owned(), OVERHANGS[0], OVERHANGS[1], false),
        y: AxisScale::new("neck t [mm]".to_owned(), NECKS[0], NECKS[1], false),
    };
    let [across, up] = CELLS;
    let step = [(OVERHANGS[1] - OVERHANGS[0]) / across as f64, (NECKS[1] - NECKS[0]) / up as f64];
    for i in 0..across {
        for j in 0..up {
            let (left, low) = (OVERHANGS[0] + i as f64 * step[0], NECKS[0] + j as f64 * step[1]);
            let (o, t) = (left + 0.5 * step[0], low + 0.5 * step[1]);
            let (force, _, bound) = forces.failure_at(o, t);
            let full = colour(force / forces.latching_at(o, t));
            let guess = bound || !outside(o, t).is_empty();
            let shown = hex(if guess { mix([255; 3], full, GUESS) } else { full });
            let [x, y] = frame.at([left, low + step[1]]);
            let cell = Rect { x, y, w: rect.w / across as f64, h: rect.h / up as f64 };
            svg.rect(cell, &format!(r#"fill="{shown}" stroke="{shown}" stroke-width="0.5""#));
        }
    }
    let x = frame.px(REJECTED_OVERHANG);
    svg.line(
        [x, rect.y],
        [x, rect.y + rect.h],
        r##"stroke="#1f2933" stroke-width="1.2" stroke-dasharray="5 4""##,
    );
    svg.text([x + 5.0, rect.y + 14.0], TICK, Anchor::Start, INK, "1.27 mm: did not latch");
    // The model has its maximum at the smallest values of both, beyond the measurements.
    for (k, words) in ["maximum:", "extrapolated"].into_iter().enumerate() {
        svg.text([x + 5.0, rect.y + rect.h - 20.0 + 13.0 * k as f64], TICK, Anchor::Start, INK, words);
    }
    for row in &forces.rows {
        let [x, y] = frame.at([row.overhang_mm, row.neck_mm]);
        svg.circle(
            [x, y],
            5.5,
            &format!(r##"fill="{}" stroke="#ffffff" stroke-width="1.6""##, hex(colour(row.ratio()))),
        );
        plate(svg, [x + 10.0, y + 4.0], &format!("{:.1}", row.ratio()));
    }
    if let Some(latch) = latch {
        let [x, y] = frame.at([latch.overhang, latch.neck]);
        let inside = |v: f64, [lo, hi]: [f64; 2]| (lo..=hi).contains(&v);
        if inside(latch.overhang, OVERHANGS) && inside(latch.neck, NECKS) {
            svg.circle([x, y], 9.5, r##"fill="none" stroke="#d55e00" stroke-width="2""##);
        }
    }
    frame.draw(svg);
    scale(svg, Rect { x: rect.x + rect.w + 16.0, y: rect.y, w: 12.0, h: rect.h });
}

/// A number on a light ground.
fn plate(svg: &mut Svg, [x, y]: [f64; 2], text: &str) {
    let ground = Rect { x: x - 2.0, y: y - 10.0, w: width_of(text, TICK) + 4.0, h: 13.0 };
    svg.rect(ground, r##"fill="#ffffff" fill-opacity="0.8""##);
    svg.text([x, y], TICK, Anchor::Start, INK, text);
}

/// The scale of colours.
fn scale(svg: &mut Svg, rect: Rect) {
    const BANDS: usize = 40;
    let [lo, hi] = RATIOS.map(f64::ln);
    let high = rect.h / BANDS as f64;
    for k in 0..BANDS {
        let share = (k as f64 + 0.5) / BANDS as f64;
        let fill = hex(colour((lo + share * (hi - lo)).exp()));
        let y = rect.y + rect.h - (k + 1) as f64 * high;
        svg.rect(
            Rect { y, h: high, ..rect },
            &format!(r#"fill="{fill}" stroke="{fill}" stroke-width="0.4""#),
        );
    }
    for ratio in [20.0, 40.0, 80.0] {
        let y = rect.y + rect.h * (1.0 - (f64::ln(ratio) - lo) / (hi - lo));
        svg.text([rect.x + rect.w + 5.0, y + 3.8], TICK, Anchor::Start, SOFT, &format!("{ratio}"));
    }
}
