//! Table 6.1 compared with the model.

use super::fit::{ForceFit, ForceLaw, MeasuredForce, latching};
use super::force::Forces;
use super::measured::{Measured, Mode, THREE_SIDED_FAILURE, THREE_SIDED_LATCHING};
use catchment::document::{Column, ColumnFormat, Document, Table};
use catchment::report::document::Printed;
use catchment::report::{ReportBody, ReportEnvelope};
use serde::Serialize;
use std::borrow::Cow;

/// Table 6.1 beside the model, with its head.
pub type TableReport = ReportEnvelope<TableBody>;

/// Table 6.1 compared with the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TableBody {
    /// The nine designs.
    pub rows: Vec<TableRow>,
    /// Laws of the force to latch; the first is in use.
    pub fits: Vec<ForceFit>,
    /// Force per thickness of a neck that breaks, in N/mm, over both layers.
    pub neck_line_n_per_mm: f64,
    /// The same as a stress, in `MPa`.
    pub neck_strength_mpa: f64,
    /// Law of the spring constant in tension, C·oᵖ·t^q.
    pub k_extension: ForceFit,
    /// Law of the spring constant in compression; its scatter is too large for use.
    pub k_compression: ForceFit,
    /// Contradictions in the dissertation or its numbers.
    pub contradictions: Vec<&'static str>,
}

/// A design, measured and computed.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TableRow {
    /// As printed.
    #[serde(flatten)]
    pub measured: Measured,
    /// How it broke: failure mode.
    pub mode: Mode,
    /// Force to break divided by force to latch, recomputed.
    pub ratio: f64,
    /// Force to latch by the law in use, in N.
    pub latching_model_n: f64,
    /// Force to latch by a fit to the other eight designs, in N.
    pub latching_left_out_n: f64,
    /// Force to break by the model, in N.
    pub failure_model_n: f64,
    /// Ratio of the two model forces.
    pub ratio_model: f64,
}

impl ReportBody for TableBody {
    const KIND: &'static str = "latch-table";
}

/// Contradictions in the source.
const CONTRADICTIONS: [&str; 7] = [
    "the text says six designs were tested; the table has nine",
    "the text names the tip failures once as t = 3.0 or 4.6, once as 3.0 or greater; the force at 3.8 fits the second",
    "that spring constants grow with the neck is false for k_C at o 2.5, t 3.8 and for k_E at o 5.1, t 4.6",
    "that a thicker neck takes more force to break is false at o 2.5, t 4.6, which broke at the tip",
    "the three-sided part: 584 N over 9.61 N is 60.8, the text prints 60.9",
    "the pseudo-rigid body asks for t³; the nine designs show t^1.6 at o 2.5 and t^2.2 at o 5.1",
    "k = 4.99 N·m/rad is stated without the length and width of the neck, so that it can be inverted only: l_eq 6.01 mm for one layer",
];

/// The table with everything computed again.
pub fn report(forces: &Forces) -> TableReport {
    let points = latching(&forces.rows);
    let row = |(k, measured): (usize, &Measured)| {
        let (o, t) = (measured.overhang_mm, measured.neck_mm);
        let others: Vec<MeasuredForce> =
            points.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, p)| *p).collect();
        let law = forces.fit().law;
        let (latching_model_n, (failure_model_n, ..)) = (forces.latching_at(o, t), forces.failure_at(o, t));
        TableRow {
            measured: *measured,
            mode: measured.mode(),
            ratio: measured.ratio(),
            latching_model_n,
            latching_left_out_n: law.at(&law.fit(&others), o, t),
            failure_model_n,
            ratio_model: failure_model_n / latching_model_n,
        }
    };
    let stiffness = |of: fn(&Measured) -> f64| {
        let point = |r: &Measured| MeasuredForce { o: r.overhang_mm, t: r.neck_mm, force: of(r) };
        ForceFit::of(ForceLaw::Power, &forces.rows.iter().map(point).collect::<Vec<_>>())
    };
    let body = TableBody {
        rows: forces.rows.iter().enumerate().map(row).collect(),
        fits: forces.fits.clone(),
        neck_line_n_per_mm: forces.neck_line,
        neck_strength_mpa: forces.neck_stress(),
        k_extension: stiffness(|r| r.k_extension_n_per_mm),
        k_compression: stiffness(|r| r.k_compression_n_per_mm),
        contradictions: CONTRADICTIONS.to_vec(),
    };
    ReportEnvelope::of(body, Vec::new(), None)
}

impl Printed for TableBody {
    fn title(&self) -> Cow<'_, str> {
        "Table 6.1: nine prototypes, measured (± 1 N) beside the model".into()
    }

    fn document(&self) -> Document {
        let mut document = Document::default();
        document
            .table(self.prototypes())
            .paragraph("o: overhang, t: neck, in mm. 1 out: by a fit to the other eight.")
            .section("force to latch, natural-log residuals")
            .table(self.fit_table())
            .section(None)
            .row(
                "necks",
                format!(
                    "{:.1} N/mm · t for the six that broke there, {:.1} MPa over both layers",
                    self.neck_line_n_per_mm, self.neck_strength_mpa
                ),
            );
        if let [c, p, q] = self.k_extension.parameters[..] {
            document.row(
                "k_E",
                format!(
                    "{c:.1}·o^{p:.2}·t^{q:.2} N/mm, rms {:.2}; k_C scatters (rms {:.2}): no model",
                    self.k_extension.rms, self.k_compression.rms
                ),
            );
        }
        document.row(
            "three-sided",
            format!(
                "o 5.1, t 3.0: {THREE_SIDED_LATCHING} N to latch, {THREE_SIDED_FAILURE} N to break; softer by design, not modelled"
            ),
        );
        document.section("where the source does not agree with itself");
        for contradiction in &self.contradictions {
            document.paragraph(format!("- {contradiction}"));
        }
        document
    }
}

impl TableBody {
    fn prototypes(&self) -> Table {
        let column = |title: &str, key: &str, decimals: usize| {
            Column::new(title).key(key).format(ColumnFormat::Fixed(decimals))
        };
        let mut table = Table::new([
            column("o", "overhang_mm", 1),
            column("t", "neck_mm", 1),
            column("to latch [N]", "latching_force_n", 2),
            column("model", "latching_model_n", 1),
            column("1 out", "latching_left_out_n", 1),
            column("to break [N]", "failure_force_n", 2),
            column("model", "failure_model_n", 0),
            Column::new("mode").key("mode").left(),
            column("ratio", "bonding_ratio", 1),
            column("model", "ratio_model", 1),
            Column::data("k_compression_n_per_mm"),
            Column::data("k_extension_n_per_mm"),
        ]);
        for row in &self.rows {
            let m = &row.measured;
            table.push([
                m.overhang_mm.into(),
                m.neck_mm.into(),
                m.latching_force_n.into(),
                row.latching_model_n.into(),
                row.latching_left_out_n.into(),
                m.failure_force_n.into(),
                row.failure_model_n.into(),
                row.mode.name().into(),
                m.bonding_ratio.into(),
                row.ratio_model.into(),
                m.k_compression_n_per_mm.into(),
                m.k_extension_n_per_mm.into(),
            ]);
        }
        table
    }

    fn fit_table(&self) -> Table {
        let column = |title: &str, decimals| Column::new(title).format(ColumnFormat::Fixed(decimals));
        let mut table = Table::new([
            Column::new("law, its parameters").left(),
            column("rms", 3),
            column("rms, 1 out", 3),
            column("max, 1 out", 2),
        ]);
        for fit in &self.fits {
            let parameters: Vec<String> = fit.parameters.iter().map(|p| format!("{p:.4}")).collect();
            let law = format!("{}   {}", fit.formula, parameters.join(", "));
            table.push([law.into(), fit.rms.into(), fit.left_out_rms.into(), fit.left_out_max.into()]);
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_fits_a_terminal_and_states_its_fits() {
        let report = super::report(&Forces::new().unwrap());
        let text = report.table();
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert!(text.contains("213.6 N/mm") && text.contains("38.2·o^0.11·t^0.80") && text.contains("nine"));
        assert_eq!(report.records().len(), 10);
        // The cross-validation error of the fit follows from the left-out predictions.
        let logs =
            report.rows.iter().map(|r| (r.measured.latching_force_n / r.latching_left_out_n).ln().powi(2));
        assert!(((logs.sum::<f64>() / 9.0).sqrt() - report.fits[0].left_out_rms).abs() < 1e-12);
    }
}
