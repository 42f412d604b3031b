//! A sensitivity as versioned JSON and as a table.

use super::envelope::{Body, Envelope};
use super::schema::Timing;
use super::table::heading;
use super::text::{grouped, line, row, significant, wrapped};
use catchment_core::design::Design;
use catchment_study::sensitivity::{AtRho, Parameter, Sensitivity, Slope};
use serde::Serialize;

/// What a sensitivity has to say, with its head.
pub type SensitivityReport = Envelope<SensitivityBody>;

/// What a sensitivity has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SensitivityBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// Slopes and spread.
    #[serde(flatten)]
    pub found: Sensitivity,
}

impl Body for SensitivityBody {
    const KIND: &'static str = "sensitivity";
}

impl SensitivityReport {
    /// Of a design.
    pub fn new(design: &Design, found: Sensitivity, timing: Option<Timing>) -> Self {
        let body = SensitivityBody { design: design.clone(), found };
        Envelope::of(body, Vec::new(), timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        let f = &self.found;
        heading(&mut text, &self.design);
        let poses =
            format!("{} random poses, the same in every run", grouped(f.settings.poses.unwrap_or_default()));
        row(&mut text, "method", &format!("descent, {poses}"));
        text.push('\n');
        row(&mut text, "Sum", &format!("{} {}", significant(f.sum), f.unit));
        row(&mut text, "", &format!("95 % interval {}", interval(f.sum_ci95)));
        text.push('\n');
        line(&mut text, "  parameter           value  between            dSum/dp  95 % interval");
        for slope in &f.slopes {
            let [from, to] = slope.between;
            line(
                &mut text,
                &format!(
                    "  {:<18}{:>7}  {:<17}{:>9}  {}",
                    label(slope),
                    significant(slope.value),
                    format!("{} … {}", significant(from), significant(to)),
                    signed(slope.slope),
                    signed_interval(slope.ci95),
                ),
            );
        }
        let at = |p: &AtRho| format!("{} at ρ = {:.3} D", significant(p.sum), p.rotation_length);
        text.push('\n');
        line(&mut text, "  over ρ              Sum  95 % interval");
        for p in &f.over_rho {
            let numbers = format!("{:>8.3} D{:>13}", p.rotation_length, significant(p.sum));
            line(&mut text, &format!("{numbers}  {}", interval(p.ci95)));
        }
        row(&mut text, "smallest", &at(&f.least));
        row(&mut text, "largest", &at(&f.greatest));
        let share = 100.0 * f.spread / f.sum.max(f64::MIN_POSITIVE);
        let spread = if f.sum > 0.0 { format!(", {share:.1} % of the Sum") } else { String::new() };
        let interval = interval(f.spread_ci95);
        row(&mut text, "spread", &format!("{}{spread}   (95 % {interval})", significant(f.spread)));
        if f.undecided > 0 {
            text.push('\n');
            let words = format!("{} motions undecided: they count as rejected", grouped(f.undecided));
            wrapped(&mut text, "warning: ", &words);
        }
        text
    }

    /// Slopes and Sums as records for programs, the names of the columns first.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = ["quantity", "parameter", "value", "estimate", "ci95_from", "ci95_to"];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        let mut record =
            |quantity: &str, parameter: Parameter, value: f64, estimate: f64, [lo, hi]: [f64; 2]| {
                let mut record = vec![quantity.to_owned(), parameter.name().to_owned()];
                record.extend([value, estimate, lo, hi].map(|number| number.to_string()));
                records.push(record);
            };
        for s in &self.found.slopes {
            record("slope", s.parameter, s.value, s.slope, s.ci95);
        }
        for p in &self.found.over_rho {
            record("sum", Parameter::RotationLength, p.rotation_length, p.sum, p.ci95);
        }
        records
    }
}

fn label(slope: &Slope) -> &'static str {
    match slope.parameter {
        Parameter::RotationLength => "rotation length",
        Parameter::CenterOfRotation => "COR",
        Parameter::AspectRatio => "aspect ratio",
    }
}

fn interval([lo, hi]: [f64; 2]) -> String {
    format!("{} … {}", significant(lo), significant(hi))
}

fn signed(value: f64) -> String {
    let sign = if value > 0.0 { "+" } else { "" };
    format!("{sign}{}", significant(value))
}

fn signed_interval([lo, hi]: [f64; 2]) -> String {
    format!("{} … {}", signed(lo), signed(hi))
}
