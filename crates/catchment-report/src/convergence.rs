//! A convergence study as versioned JSON and as a table.

use super::envelope::{Body, Envelope};
use super::schema::Timing;
use super::table::heading;
use super::text::{grouped, line, row, significant, wrapped};
use catchment_core::design::Design;
use catchment_study::convergence::{Convergence, StopReason};
use serde::Serialize;

/// What refinement has to say, with its head.
pub type ConvergenceReport = Envelope<ConvergenceBody>;

/// What refinement has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ConvergenceBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// The sequences. Seconds differ between equal runs, and where time stops a sequence its length does.
    #[serde(flatten)]
    pub found: Convergence,
}

impl Body for ConvergenceBody {
    const KIND: &'static str = "convergence";
}

impl ConvergenceReport {
    /// Of a design.
    pub fn new(design: &Design, found: Convergence, timing: Option<Timing>) -> Self {
        let body = ConvergenceBody { design: design.clone(), found };
        Envelope::of(body, Vec::new(), timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        let settings = &self.found.settings;
        let tolerance = format!("{:.3}", 100.0 * settings.tolerance);
        let tolerance = tolerance.trim_end_matches('0').trim_end_matches('.');
        heading(&mut text, &self.design);
        row(&mut text, "stable means", "two refinements in a row change the Sum by less than");
        row(
            &mut text,
            "",
            &format!("{tolerance} % of itself, the ONAA edge by less than {tolerance} % of the box"),
        );
        text.push('\n');
        let mut undecided = 0;
        let sum = format!("Sum [{}]", self.found.unit);
        line(
            &mut text,
            &format!("  per axis         cells  seconds {sum:>14}  {:<19}  ONAA edge", "one cell of doubt"),
        );
        for sequence in &self.found.sequences {
            line(&mut text, sequence.method);
            for t in &sequence.trials {
                undecided += t.undecided;
                let [lo, hi] = t.bracket.map(significant);
                line(
                    &mut text,
                    &format!(
                        "  {:>8}{:>14}  {:>7.2} {:>14}  {:<19}  {:>9.4}",
                        t.resolution,
                        grouped(t.cells),
                        t.seconds,
                        significant(t.sum),
                        format!("{lo} … {hi}"),
                        t.onaa_edge
                    ),
                );
            }
            let ended = match &sequence.end {
                StopReason::Stable => "stable".to_owned(),
                StopReason::Time { resolution, expected_s } => format!(
                    "stopped, not stable: {resolution} cells per axis would take about {expected_s:.0} s more, and \
                     {:.0} s are allowed for each method",
                    settings.time_limit_s
                ),
                StopReason::Memory { resolution, message } => {
                    format!("stopped, not stable: at {resolution} cells per axis {message}")
                }
                StopReason::Cells { resolution } => format!(
                    "stopped, not stable: {resolution} cells per axis are more than {} cells",
                    grouped(settings.most_cells as usize)
                ),
            };
            wrapped(&mut text, "  ", &ended);
            if let Some(c) = &sequence.corrected {
                let [lo, hi] = c.ci95.map(significant);
                let by = format!("by {} exact descents", grouped(c.descents));
                wrapped(
                    &mut text,
                    "  ",
                    &format!("corrected {by}: {}, 95 % interval {lo} … {hi}", significant(c.sum)),
                );
            }
        }
        if undecided > 0 {
            text.push('\n');
            let words = format!("{} cells undecided: they count as rejected", grouped(undecided));
            wrapped(&mut text, "warning: ", &words);
        }
        text
    }

    /// Every trial as a record for programs, the names of the columns first.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = ["method", "resolution", "cells", "seconds", "sum", "doubt_from", "doubt_to", "onaa_edge"];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        for sequence in &self.found.sequences {
            for t in &sequence.trials {
                let mut record = vec![sequence.method.to_owned()];
                record.extend([t.resolution, t.cells].map(|n| n.to_string()));
                record.extend([t.seconds, t.sum, t.bracket[0], t.bracket[1]].map(|v| v.to_string()));
                record.push(t.onaa_edge.to_string());
                records.push(record);
            }
        }
        records
    }
}
