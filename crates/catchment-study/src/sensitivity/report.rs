//! Text and table form of a sensitivity.

use super::{AtRho, Sensitivity, VariedParameter};
use catchment_core::design::Design;
use catchment_core::document::{Column, ColumnFormat, Document, Subject, Table, grouped, significant};

impl Subject for Sensitivity {
    const KIND: &'static str = "sensitivity";

    fn setup(&self, _: &Design, document: &mut Document) {
        let poses = grouped(self.settings.poses.unwrap_or_default());
        document.row("method", format!("descent, {poses} random poses, the same in every run"));
    }

    fn document(&self, _: &Design) -> Document {
        let mut document = Document::default();
        document
            .section(None)
            .row("Sum", format!("{} {}", significant(self.sum), self.unit))
            .more(format!("95 % interval {}", interval(self.sum_ci95)));
        document.section(None).table(self.slopes());
        document.section("over ρ").table(self.sums());
        let at = |p: &AtRho| format!("{} at ρ = {:.3} D", significant(p.sum), p.rotation_length);
        let share = if self.sum > 0.0 {
            format!(", {:.1} % of the Sum", 100.0 * self.spread / self.sum)
        } else {
            String::new()
        };
        let [spread, ci95] = [significant(self.spread), interval(self.spread_ci95)];
        document
            .row("smallest", at(&self.least))
            .row("largest", at(&self.greatest))
            .row("spread", format!("{spread}{share} (95 % {ci95})"));
        if self.undecided > 0 {
            let words = format!("{} motions undecided: they count as rejected", grouped(self.undecided));
            document.section(None).row("warning", words);
        }
        document.table(self.data());
        document
    }
}

impl Sensitivity {
    fn slopes(&self) -> Table {
        let mut table = Table::new([
            Column::new("parameter").left(),
            Column::new("value").format(ColumnFormat::Significant),
            Column::new("between").left(),
            Column::new("dSum/dp"),
            Column::new("95 % interval").left(),
        ]);
        for slope in &self.slopes {
            let [lo, hi] = slope.ci95.map(signed);
            table.push([
                slope.parameter.words().into(),
                slope.value.into(),
                interval(slope.between).into(),
                signed(slope.slope).into(),
                format!("{lo} … {hi}").into(),
            ]);
        }
        table
    }

    fn sums(&self) -> Table {
        let mut table = Table::new([
            Column::new("ρ [D]").format(ColumnFormat::Fixed(3)),
            Column::new("Sum").format(ColumnFormat::Significant),
            Column::new("95 % interval").left(),
        ]);
        for point in &self.over_rho {
            table.push([point.rotation_length.into(), point.sum.into(), interval(point.ci95).into()]);
        }
        table
    }

    /// Slopes and Sums. Its numbers have no exponents.
    fn data(&self) -> Table {
        let mut table = Table::data("quantity parameter value estimate ci95_from ci95_to");
        let mut add = |quantity: &str, parameter: VariedParameter, numbers: [f64; 4]| {
            let names = [quantity, parameter.name()].map(Into::into);
            table.push(names.into_iter().chain(numbers.map(|number| number.to_string().into())));
        };
        for slope in &self.slopes {
            let [lo, hi] = slope.ci95;
            add("slope", slope.parameter, [slope.value, slope.slope, lo, hi]);
        }
        for point in &self.over_rho {
            let [lo, hi] = point.ci95;
            add("sum", VariedParameter::RotationLength, [point.rotation_length, point.sum, lo, hi]);
        }
        table
    }
}

impl VariedParameter {
    const fn words(self) -> &'static str {
        match self {
            Self::RotationLength => "ρ",
            Self::CenterOfRotation => "COR",
            Self::AspectRatio => "aspect ratio",
        }
    }
}

fn interval([lo, hi]: [f64; 2]) -> String {
    format!("{} … {}", significant(lo), significant(hi))
}

fn signed(value: f64) -> String {
    let sign = if value > 0.0 { "+" } else { "" };
    format!("{sign}{}", significant(value))
}
