//! Sum and ONAA against resolution and against time, with a line for each method.

use super::Picture;
use super::draw::axis::short;
use super::draw::chart::{self, Chart, ChartLine, ChartPoint, Spacing};
use super::draw::colour::CURVES;
use super::draw::layout::{Layout, Panel};
use crate::ConvergenceReport;
use catchment_study::convergence::RefinementSequence;
use catchment_study::refinement::Refinement;

/// Draws every method's sequence: above the Sums with their intervals, below the ONAA edges; left over cells per axis,
/// right over the time that they took.
pub fn convergence(report: &ConvergenceReport) -> Picture {
    let story = format!(
        "every method refined until two refinements in a row change Sum and ONAA by less than {} %",
        short(100.0 * report.settings.tolerance)
    );
    let lines =
        |x: fn(&Refinement) -> f64, y: fn(&Refinement) -> (f64, Option<[f64; 2]>)| -> Vec<ChartLine> {
            let line = |(k, s): (usize, &RefinementSequence)| ChartLine {
                name: s.method.to_owned(),
                colour: CURVES[k % CURVES.len()],
                points: s
                    .trials
                    .iter()
                    .map(|t| {
                        let (value, interval) = y(t);
                        ChartPoint { x: x(t), y: value, interval }
                    })
                    .collect(),
            };
            report.sequences.iter().enumerate().map(line).collect()
        };
    let sum_label = format!("Sum [{}]", report.unit);
    let chart = || Panel::with_axes([380.0, 240.0]);
    let names = chart::legend(&lines(|t| t.seconds, |t| (t.sum, None)));
    let (mut svg, frames) = Layout::of(&report.design)
        .story(story)
        .row([chart().over(names), chart()])
        .row([chart(), chart()])
        .open();
    for (k, rect) in frames.into_iter().enumerate() {
        let across: fn(&Refinement) -> f64 = if k % 2 == 0 { |t| t.resolution as f64 } else { |t| t.seconds };
        let up: fn(&Refinement) -> (f64, Option<[f64; 2]>) =
            if k < 2 { |t| (t.sum, Some(t.bracket)) } else { |t| (t.onaa_edge, None) };
        let chart = Chart {
            rect,
            x_label: if k % 2 == 0 { "cells per axis" } else { "time [s]" },
            spacing: Spacing::Logarithmic,
            y_label: if k < 2 { &sum_label } else { "ONAA edge" },
            lines: &lines(across, up),
            mark: None,
        };
        chart.draw(&mut svg);
    }
    Picture::of(svg)
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::method::Method;
    use catchment_core::pose::Dof;
    use catchment_study::convergence::{Convergence, ConvergenceSettings, StopReason};

    #[test]
    fn every_method_has_a_line_in_every_chart() {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let trial = |resolution: usize, limit: f64| {
            let off = 1.0 / resolution as f64;
            let sum = limit + off;
            Refinement {
                resolution,
                cells: resolution * resolution,
                seconds: 1e-4 * (resolution * resolution) as f64,
                sum,
                unit: "D·rad".to_owned(),
                bracket: [sum - 3.0 * off, sum + 3.0 * off],
                onaa_edge: 0.3 * limit / 2.4,
                undecided: 0,
            }
        };
        let sequence = |(k, method): (usize, &Method)| RefinementSequence {
            method: method.name(),
            trials: [11, 15, 21, 29, 41].map(|n| trial(n, 2.4 + 0.1 * k as f64)).to_vec(),
            end: StopReason::Stable,
            corrected: None,
        };
        let result = Convergence {
            settings: ConvergenceSettings::default(),
            unit: "D·rad".to_owned(),
            sequences: Method::on_grids().iter().enumerate().map(sequence).collect(),
        };
        let picture = convergence(&ConvergenceReport::new(&design, result, Vec::new(), None));
        look("convergence", &picture);
        assert_eq!(picture.svg().matches("<circle").count(), 4 * 5 * Method::on_grids().len());
        assert!(!picture.svg().contains("NaN"));
    }
}
