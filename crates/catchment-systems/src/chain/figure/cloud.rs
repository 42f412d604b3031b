//! Errors of random chains at a face, with the chains that dock.

use super::super::accumulation::Covariance;
use super::super::report::ChainReport;
use super::super::study::ArrivalErrors;
use catchment::acceptance::Outcome;
use catchment::document::percent;
use catchment::report::figure::draw::axis::{AxisScale, PlotFrame};
use catchment::report::figure::draw::colour::{FIXED_EDGE, hex, outcome};
use catchment::report::figure::draw::layout::Panel;
use catchment::report::figure::draw::svg::{INK, Rect, SOFT, Svg, polyline};

/// Chains that are drawn at most.
const MOST: usize = 2000;

/// The panel of errors at a face, with the share that docks over it.
pub(super) fn panel(size: [f64; 2], report: &ChainReport, arrival: &ArrivalErrors) -> Panel {
    let place =
        arrival.latch.map_or_else(|| "last face".to_owned(), |latch| format!("docking {}", latch.name()));
    let count = match arrival.docking {
        Some(docking) => format!("{} of {} dock", percent(docking.probability), report.chains),
        None => format!("{} chains", report.chains),
    };
    Panel::with_axes(size).over(format!("{place}: {count}; ellipses: 1σ, 2σ"))
}

/// Draws x and pitch of the chains with the ellipses of one and two standard deviations.
pub(super) fn draw(svg: &mut Svg, rect: Rect, report: &ChainReport, arrival: &ArrivalErrors) {
    let face = report.body.body.face;
    let at = |e: &[f64; 3]| [-e[0] / face, e[2].to_degrees()];
    let shown = &arrival.cloud[..arrival.cloud.len().min(MOST)];
    let reach = |k: usize, least: f64| 1.1 * shown.iter().map(|e| at(e)[k].abs()).fold(least, f64::max);
    let (x, pitch) = (reach(0, 1e-3), reach(1, 0.1));
    let frame = PlotFrame {
        rect,
        x: AxisScale::new("x [D]".to_owned(), -x, x, false),
        y: AxisScale::new("pitch [deg]".to_owned(), -pitch, pitch, false),
    };
    let fine = format!(r#"stroke="{SOFT}" stroke-width="0.8" stroke-dasharray="2 3""#);
    svg.line([rect.x, frame.py(0.0)], [rect.x + rect.w, frame.py(0.0)], &fine);
    svg.line([frame.px(0.0), rect.y], [frame.px(0.0), rect.y + rect.h], &fine);
    svg.begin_clip(rect);
    for (k, error) in shown.iter().enumerate() {
        let colour = match arrival.docked.as_ref().map(|docked| docked[k]) {
            Some(true) => hex(outcome(Outcome::Aligned)),
            Some(false) => "#d55e00".to_owned(),
            None => hex(FIXED_EDGE),
        };
        svg.circle(frame.at(at(error)), 1.6, &format!(r#"fill="{colour}" fill-opacity="0.75""#));
    }
    for sigmas in [1.0, 2.0] {
        let points = ellipse(&arrival.first_order, sigmas).into_iter().map(|e| frame.at(at(&e)));
        svg.path(&polyline(points, true), &format!(r#"fill="none" stroke="{INK}" stroke-width="1.3""#));
    }
    svg.end();
    frame.draw(svg);
}

/// Lateral and angle around the ellipse of so many standard deviations.
fn ellipse(errors: &Covariance, sigmas: f64) -> Vec<[f64; 3]> {
    const POINTS: usize = 72;
    // L·Lᵀ is the covariance of lateral and angle.
    let [lateral, _, angle] = errors.sigmas();
    let slope = angle * errors.correlation();
    let rest = (angle * angle - slope * slope).max(0.0).sqrt();
    (0..POINTS)
        .map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / POINTS as f64).sin_cos();
            let (u, v) = (sigmas * cos, sigmas * sin);
            [errors.mean[0] + lateral * u, 0.0, errors.mean[2] + slope * u + rest * v]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of the ellipse lie at the Mahalanobis distance that they are for.
    #[test]
    fn the_ellipse_is_that_of_the_covariance() {
        let matrix = [[4.0, 0.0, 0.3], [0.0, 1.0, 0.0], [0.3, 0.0, 0.09]];
        let errors = Covariance { mean: [1.0, 0.0, 0.2], matrix };
        let determinant = 4.0 * 0.09 - 0.3 * 0.3;
        for [lateral, _, angle] in ellipse(&errors, 2.0) {
            let (a, b) = (lateral - 1.0, angle - 0.2);
            let square = (0.09 * a * a - 2.0 * 0.3 * a * b + 4.0 * b * b) / determinant;
            assert!((square - 4.0).abs() < 1e-9, "{square}");
        }
    }
}
