//! Slices as versioned JSON, text and tables.

use super::schema::{AcceptanceReport, AxisReport, axes};
use catchment_core::design::Design;
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::{
    Cell, Column, ColumnFormat, Document, Subject, Table, grouped, percent, significant,
};
use catchment_core::merit::estimate::Estimate;
use catchment_core::merit::onaa::Onaa;
use catchment_study::slices::{Slice, Slices, SlicesSettings};
use serde::Serialize;

/// Slices of a design; fields as in [`Report`](super::Report).
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SlicesResult {
    /// Settings that change the result.
    #[cfg_attr(feature = "schema", schemars(with = "serde_json::Value"))]
    pub settings: SlicesSettings,
    /// A slice for each pair of errors.
    pub slices: Vec<SliceReport>,
    /// Estimated edge of the largest full-dimensional cube, in [0, 1]; null if a required slice is missing.
    pub onaa_estimate: Option<Estimate>,
}

/// One slice.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SliceReport {
    /// The two errors that vary.
    pub axes: Vec<AxisReport>,
    /// Name of the method that decided the outcomes.
    pub method: String,
    /// The accepted set.
    pub acceptance: AcceptanceReport,
    /// The largest axis-oriented square.
    pub onaa: Onaa,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

impl SlicesResult {
    /// Of slices that were computed with these settings.
    pub fn of(result: &Slices, settings: SlicesSettings) -> Self {
        Self {
            settings,
            slices: result.slices.iter().map(SliceReport::from).collect(),
            onaa_estimate: result.estimate,
        }
    }

    /// A row per slice. For programs its numbers have no exponents.
    fn table(&self) -> Table {
        let mut table = Table::new([
            Column::new("slice").left().key("slice"),
            Column::new("cells").left().key("cells"),
            Column::new("Sum").left().key("sum"),
            Column::data("unit"),
            Column::new("of the slice").key("fraction"),
            Column::new(""),
            Column::new("border ± a cell"),
            Column::data("doubt_from"),
            Column::data("doubt_to"),
            Column::new("ONAA edge").key("onaa_edge"),
        ]);
        for slice in &self.slices {
            let a = &slice.acceptance;
            let cells: Vec<String> = slice.axes.iter().map(|axis| axis.cells.to_string()).collect();
            let doubt = a.sum_bracket.map(|[lo, hi]| format!("{} … {}", significant(lo), significant(hi)));
            let [from, to] = a.sum_bracket.unwrap_or([a.sum; 2]);
            let shown = |text: String, value: f64| Cell::shown(text, value.to_string());
            table.push([
                slice.name().into(),
                Cell::shown(cells.join(" × "), a.cells),
                shown(format!("{} {}", significant(a.sum), a.unit), a.sum),
                a.unit.clone().into(),
                shown(percent(a.fraction), a.fraction),
                if slice.reaches_border() { "*" } else { "" }.into(),
                doubt.into(),
                from.to_string().into(),
                to.to_string().into(),
                shown(ColumnFormat::Fixed(4).of(slice.onaa.edge), slice.onaa.edge),
            ]);
        }
        table
    }
}

impl Subject for SlicesResult {
    const KIND: &'static str = "slices";

    fn setup(&self, _: &Design, document: &mut Document) {
        let method = self.slices.first().map_or("", |slice| &slice.method);
        document.row("slices", format!("through zero, by {method}: two errors vary, all free ones move"));
    }

    fn document(&self, _: &Design) -> Document {
        let mut document = Document::default();
        document.table(self.table());
        if self.slices.iter().any(SliceReport::reaches_border) {
            document.paragraph("* up to the border of the error box, perhaps further");
        }
        if let Some(Estimate { conservative, optimistic }) = self.onaa_estimate {
            document.section(None).row(
                "estimate",
                format!(
                    "{conservative:.3} (conservative) … {optimistic:.3} (optimistic): the ONAA edge of the whole, by the slices x-y and x with each rotation"
                ),
            );
        }
        let undecided: usize = self.slices.iter().map(|slice| slice.acceptance.outcomes.undecided).sum();
        if undecided > 0 {
            let words = format!("{} cells undecided: they count as rejected", grouped(undecided));
            document.section(None).row("warning", words);
        }
        document
    }
}

impl From<&Slice> for SliceReport {
    fn from(slice: &Slice) -> Self {
        Self {
            axes: axes(&slice.acceptance),
            method: slice.acceptance.method.to_owned(),
            acceptance: AcceptanceReport {
                sum_bracket: Some(slice.bracket),
                ..AcceptanceReport::from(slice.sum.clone())
            },
            onaa: slice.onaa.clone(),
            warnings: slice.warnings.clone(),
        }
    }
}

impl SliceReport {
    /// `x-pitch`.
    pub fn name(&self) -> String {
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.axis.name()).collect();
        names.join("-")
    }

    fn reaches_border(&self) -> bool {
        self.warnings.iter().any(|w| w.code == "touches-border")
    }
}

#[cfg(test)]
mod tests {
    use super::super::schema::testing::{blob, design};
    use super::*;
    use crate::SlicesReport;
    use catchment_core::diagnostic::Warning;
    use catchment_core::exec::Exec;
    use catchment_core::merit::onaa::Onaa;
    use catchment_core::merit::sum::Sum;
    use catchment_core::pose::{Dof, DofSet};

    #[test]
    fn the_table_fits_eighty_columns_and_marks_its_estimates() {
        let design = design(DofSet::ALL);
        let mut plane = design.clone();
        plane.alignment.free = [Dof::Pitch, Dof::Yaw].into_iter().collect();
        let acceptance = blob(&plane, 201);
        let sum = Sum::of(&acceptance, &plane.alignment);
        let onaa = Onaa::of(&acceptance, &Exec::new()).unwrap();
        let warnings = vec![Warning::TouchesBorder { axes: vec!["yaw".to_owned()] }.into()];
        let bracket = [0.9 * sum.sum, 1.1 * sum.sum];
        let slice = Slice { axes: [Dof::Pitch, Dof::Yaw], acceptance, sum, bracket, onaa, warnings };
        let estimate = Some(Estimate { optimistic: 0.39, conservative: 0.204 });
        let result = Slices { slices: vec![slice], estimate };
        let report = SlicesReport::new(
            &design,
            SlicesResult::of(&result, SlicesSettings::default()),
            Vec::new(),
            None,
        );
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
