//! Slices as versioned JSON and as a table.

use super::envelope::{Body, Envelope};
use super::schema::{AcceptanceReport, Axis, OnaaReport, Timing, WarningReport, axes};
use super::table::heading;
use super::text::{grouped, line, percent, row, significant, wrapped};
use catchment_core::acceptance::Warning;
use catchment_core::design::Design;
use catchment_core::merit::estimate::Estimate;
use catchment_study::slices::{Settings, Slice, Slices};
use serde::Serialize;

/// What slices have to say, with its head.
pub type SlicesReport = Envelope<SlicesBody>;

/// What slices have to say; fields as in [`Report`](super::Report).
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SlicesBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// What else changes the answer.
    #[cfg_attr(feature = "schema", schemars(with = "serde_json::Value"))]
    pub settings: Settings,
    /// One per pair of errors.
    pub slices: Vec<SliceReport>,
    /// Estimated edge of the largest cube of the whole, in [0, 1]; null where slices it needs are missing.
    pub onaa_estimate: Option<Estimate>,
}

impl Body for SlicesBody {
    const KIND: &'static str = "slices";
}

/// One slice.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SliceReport {
    /// The two errors that vary.
    pub axes: Vec<Axis>,
    /// Name of the method that decided.
    pub method: String,
    /// The accepted set.
    pub acceptance: AcceptanceReport,
    /// The largest axis-oriented square.
    pub onaa: OnaaReport,
    /// Doubts.
    pub warnings: Vec<WarningReport>,
}

impl SlicesReport {
    /// Evaluates slices of a design.
    pub fn new(design: &Design, found: &Slices, settings: Settings, timing: Option<Timing>) -> Self {
        let slice = |s: &Slice| SliceReport {
            axes: axes(&s.acceptance),
            method: s.acceptance.method.to_owned(),
            acceptance: AcceptanceReport {
                sum_bracket: Some(s.bracket),
                ..AcceptanceReport::from(s.sum.clone())
            },
            onaa: s.onaa.clone().into(),
            warnings: s.warnings.iter().cloned().map(WarningReport::from).collect(),
        };
        let body = SlicesBody {
            design: design.clone(),
            settings,
            slices: found.slices.iter().map(slice).collect(),
            onaa_estimate: found.estimate,
        };
        Envelope::of(body, Vec::new(), timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        let method = self.slices.first().map_or("", |slice| &slice.method);
        row(&mut text, "slices", &format!("through zero, by {method}: two errors vary, all free ones move"));
        text.push('\n');
        let mut columns =
            |slice: &str, cells: &str, sum: &str, share: &str, star: &str, doubt: &str, edge: &str| {
                let left = format!("  {slice:<10}  {cells:<9}  {sum:<12}{share:>9} {star:1}");
                line(&mut text, &format!("{left} {doubt:>17}  {edge:>9}"));
            };
        columns("slice", "cells", "Sum", "share", "", "one cell of doubt", "ONAA edge");
        let (mut open, mut undecided) = (false, 0);
        for slice in &self.slices {
            let a = &slice.acceptance;
            let cells: Vec<String> = slice.axes.iter().map(|axis| axis.cells.to_string()).collect();
            let doubt = a
                .sum_bracket
                .map_or_else(String::new, |[lo, hi]| format!("{} … {}", significant(lo), significant(hi)));
            let cut = slice.reaches_border();
            open |= cut;
            undecided += a.outcomes.undecided;
            columns(
                &slice.name(),
                &cells.join(" × "),
                &format!("{} {}", significant(a.sum), a.unit),
                &percent(a.fraction),
                if cut { "*" } else { "" },
                &doubt,
                &format!("{:.4}", slice.onaa.edge),
            );
        }
        if open {
            line(&mut text, "  * up to the border of the error box, perhaps further");
        }
        if let Some(e) = self.onaa_estimate {
            text.push('\n');
            let words = format!(
                "{:.3} (conservative) … {:.3} (optimistic): what x-y and x with each rotation let one guess of the \
                 ONAA edge of the whole",
                e.conservative, e.optimistic
            );
            wrapped(&mut text, "  estimate       ", &words);
        }
        if undecided > 0 {
            let words = format!("{} cells undecided: they count as rejected", grouped(undecided));
            wrapped(&mut text, "warning: ", &words);
        }
        text
    }

    /// The table as records for programs, the names of the columns first.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = ["slice", "cells", "sum", "unit", "fraction", "doubt_from", "doubt_to", "onaa_edge"];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        for slice in &self.slices {
            let a = &slice.acceptance;
            let [from, to] = a.sum_bracket.unwrap_or([a.sum; 2]);
            records.push(vec![
                slice.name(),
                a.cells.to_string(),
                a.sum.to_string(),
                a.unit.clone(),
                a.fraction.to_string(),
                from.to_string(),
                to.to_string(),
                slice.onaa.edge.to_string(),
            ]);
        }
        records
    }
}

impl SliceReport {
    /// `x-pitch`.
    pub fn name(&self) -> String {
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.axis.name()).collect();
        names.join("-")
    }

    fn reaches_border(&self) -> bool {
        self.warnings.iter().any(|w| matches!(w.warning, Warning::TouchesBorder { .. }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::schema::testing::{blob, design};
    use super::*;
    use catchment_core::exec::Exec;
    use catchment_core::merit::onaa::Onaa;
    use catchment_core::merit::sum::Sum;
    use catchment_core::pose::{Dof, DofSet};

    #[test]
    fn it_fits_in_eighty_columns_and_says_what_it_guesses() {
        let design = design(DofSet::ALL);
        let mut plane = design.clone();
        plane.alignment.free = [Dof::Pitch, Dof::Yaw].into_iter().collect();
        let acceptance = blob(&plane, 201);
        let sum = Sum::of(&acceptance, &plane.alignment);
        let onaa = Onaa::of(&acceptance, &Exec::new()).unwrap();
        let warnings = vec![Warning::TouchesBorder { axes: vec!["yaw".to_owned()] }];
        let bracket = [0.9 * sum.sum, 1.1 * sum.sum];
        let slice = Slice { axes: [Dof::Pitch, Dof::Yaw], acceptance, sum, bracket, onaa, warnings };
        let estimate = Some(Estimate { optimistic: 0.39, conservative: 0.204 });
        let found = Slices { slices: vec![slice], estimate };
        let report = SlicesReport::new(&design, &found, Settings::default(), None);
        let text = report.table();
        for line in text.lines() {
            assert!(line.chars().count() <= 80 && line == line.trim_end(), "{line:?}");
        }
        for word in ["pitch-yaw", "201 × 201", "rad²", "0.204 (conservative)", "perhaps further"] {
            assert!(text.contains(word), "{word} is missing in\n{text}");
        }
        assert_eq!(report.records().len(), 2);
        assert_eq!(serde_json::to_value(&report).unwrap()["settings"]["resolution"], "71");
    }
}
