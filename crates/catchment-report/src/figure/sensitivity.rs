//! The Sum against ρ, with its interval.

use super::Picture;
use super::draw::axis::short;
use super::draw::chart::{Chart, ChartLine, ChartPoint, Mark, Spacing};
use super::draw::colour::CURVES;
use super::draw::layout::{Layout, Panel};
use crate::SensitivityReport;

/// Draws the Sum over ρ. The points use the same random poses: their band moves as a whole, and their
/// differences are more accurate than its width.
pub fn sensitivity(report: &SensitivityReport) -> Picture {
    let story = format!(
        "Sum {} … {} {} over ρ, with its 95 % interval, by the same {} random poses",
        short(report.least.sum),
        short(report.greatest.sum),
        report.unit,
        report.settings.poses.unwrap_or_default()
    );
    let point = |p: &catchment_study::sensitivity::AtRho| ChartPoint {
        x: p.rotation_length,
        y: p.sum,
        interval: Some(p.ci95),
    };
    let line = ChartLine {
        name: String::new(),
        colour: CURVES[0],
        points: report.over_rho.iter().map(point).collect(),
    };
    let panel = Panel::with_axes([510.0, 300.0]);
    let (mut svg, frames) = Layout::of(&report.design).story(story).row([panel]).open();
    let chart = Chart {
        rect: frames[0],
        x_label: "ρ, characteristic length [D]",
        spacing: Spacing::Logarithmic,
        y_label: &format!("Sum [{}]", report.unit),
        lines: &[line],
        mark: Some(Mark { x: report.design.alignment.rotation_length, y: None, words: "this design" }),
    };
    chart.draw(&mut svg);
    Picture::of(svg)
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::pose::Dof;
    use catchment_study::sensitivity::{AtRho, Sensitivity, SensitivitySettings};

    #[test]
    fn the_sum_is_drawn_over_rho() {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let settings = SensitivitySettings::default();
        let at = |rho: f64| {
            let sum = 2.0 + 0.4 * (-rho).exp();
            AtRho { rotation_length: rho, sum, ci95: [sum - 0.06, sum + 0.06] }
        };
        let over_rho: Vec<AtRho> = settings.rotation_lengths.iter().map(|rho| at(*rho)).collect();
        let result = Sensitivity {
            unit: "D·rad".to_owned(),
            sum: 2.2,
            sum_ci95: [2.1, 2.3],
            slopes: Vec::new(),
            least: over_rho[12],
            greatest: over_rho[0],
            spread: 0.2,
            spread_ci95: [0.1, 0.3],
            undecided: 0,
            over_rho,
            settings,
        };
        let picture = sensitivity(&SensitivityReport::new(&design, result, Vec::new(), None));
        look("sensitivity", &picture);
        assert_eq!(picture.svg().matches("<circle").count(), 13);
        assert!(picture.svg().contains("this design") && !picture.svg().contains("NaN"));
    }
}
