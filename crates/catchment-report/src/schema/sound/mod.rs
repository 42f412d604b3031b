//! Validity of a report that is read back, beyond its form: numbers within their ranges and intervals in
//! order.

mod parts;

use super::RunBody;
use catchment_core::merit::onaa::Interval;
use catchment_core::pose::Dof;
use catchment_core::pose::ErrorUnit;

/// A number in a report that cannot be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{field} {rule}")]
pub struct UnsoundError {
    /// Which, as the JSON has it.
    pub field: String,
    /// The violated rule.
    pub rule: &'static str,
}

fn hold(holds: bool, field: impl Into<String>, rule: &'static str) -> Result<(), UnsoundError> {
    if holds { Ok(()) } else { Err(UnsoundError { field: field.into(), rule }) }
}

fn above_zero(value: f64, field: &str) -> Result<(), UnsoundError> {
    hold(value > 0.0 && value.is_finite(), field, "must be above 0")
}

fn not_negative(value: f64, field: &str) -> Result<(), UnsoundError> {
    hold(value >= 0.0 && value.is_finite(), field, "must not be negative")
}

fn share(value: f64, field: &str) -> Result<(), UnsoundError> {
    hold((0.0..=1.0).contains(&value), field, "must lie between 0 and 1")
}

fn ordered(ends: Option<[f64; 2]>, field: &str) -> Result<(), UnsoundError> {
    hold(ends.is_none_or(|[lo, hi]| lo <= hi), field, "must be in order")
}

fn bounds(of: &[Interval], field: &str) -> Result<(), UnsoundError> {
    hold(of.iter().all(|side| side.lo <= side.hi), field, "must be in order")
}

impl RunBody {
    /// Refuses a report whose numbers cannot be: it was changed, or comes from elsewhere.
    ///
    /// # Errors
    /// The first number out of its range.
    pub fn check(&self) -> Result<(), UnsoundError> {
        self.check_design()?;
        self.check_axes()?;
        self.check_acceptance()?;
        for (edge, sides, name) in [
            self.onaa.as_ref().map(|result| (result.edge, &result.bounds, "onaa")),
            self.centered.as_ref().map(|result| (result.edge, &result.bounds, "centered")),
        ]
        .into_iter()
        .flatten()
        {
            share(edge, &format!("{name}.edge"))?;
            bounds(sides, &format!("{name}.bounds"))?;
        }
        if let Some(upright) = &self.upright {
            not_negative(upright.window.edge, "upright.window.edge")?;
            bounds(&upright.window.bounds, "upright.window.bounds")?;
        }
        let upright = self.upright.iter().flat_map(|result| &result.tolerances);
        for tolerance in self.tolerances.iter().chain(upright) {
            let sound = [tolerance.minus, tolerance.plus, tolerance.half_cell].iter().all(|v| *v >= 0.0);
            hold(sound, format!("tolerances of {}", tolerance.axis.name()), "must not be negative")?;
        }
        if let Some(success) = &self.success {
            share(success.probability, "success.probability")?;
            ordered(Some(success.bracket), "success.bracket")?;
            ordered(success.ci95, "success.ci95")?;
            share(success.outside, "success.outside")?;
        }
        self.check_parts()
    }

    fn check_design(&self) -> Result<(), UnsoundError> {
        let alignment = &self.design.alignment;
        above_zero(self.design.width, "design.width")?;
        above_zero(alignment.rotation_length, "design.alignment.rotation_length")?;
        for dof in alignment.free.iter() {
            above_zero(alignment.half_range(dof), "design.alignment.half_ranges")?;
        }
        hold(!alignment.free.is_empty(), "design.alignment.free", "must name an error")?;
        hold(alignment.symmetry > 0, "design.alignment.symmetry", "must be above 0")
    }

    fn check_axes(&self) -> Result<(), UnsoundError> {
        let sorted = self.axes.is_sorted_by(|a, b| a.axis < b.axis);
        hold(sorted, "axes", "must each be there once, in the order x, y, roll, pitch, yaw")?;
        for axis in &self.axes {
            let name = axis.axis.name();
            let finite = axis.lo.is_finite() && axis.hi.is_finite();
            hold(finite && axis.lo < axis.hi, format!("axes: {name}: lo and hi"), "must be in order")?;
            hold(axis.cells > 0, format!("axes: {name}: cells"), "must be above 0")?;
            hold(
                axis.unit == ErrorUnit::of(axis.axis),
                format!("axes: {name}: unit"),
                "must be that of the error",
            )?;
        }
        let free = self.design.alignment.free;
        let known = |dof: Dof| free.contains(dof);
        hold(self.axes.iter().all(|axis| known(axis.axis)), "axes", "must be free in the design")
    }

    fn check_acceptance(&self) -> Result<(), UnsoundError> {
        let result = &self.acceptance;
        not_negative(result.sum, "acceptance.sum")?;
        not_negative(result.sum_grid, "acceptance.sum_grid")?;
        share(result.fraction, "acceptance.fraction")?;
        ordered(result.sum_bracket, "acceptance.sum_bracket")?;
        ordered(result.sum_ci95, "acceptance.sum_ci95")?;
        let counts = result.outcomes;
        let counts = [counts.aligned, counts.jammed, counts.missed, counts.undecided];
        let all = counts.into_iter().try_fold(0usize, usize::checked_add);
        hold(all == Some(result.cells), "acceptance.outcomes", "must add up to acceptance.cells")
    }
}

#[cfg(test)]
mod tests {
    use crate::schema::testing::{blob, design};
    use crate::schema::{Report, RunBody};
    use catchment_core::exec::Exec;
    use catchment_core::pose::{Dof, ErrorUnit};

    type Spoil = fn(&mut RunBody);

    #[test]
    fn valid_reports_pass_and_invalid_values_are_named() {
        let design = design([Dof::X, Dof::Yaw].into_iter().collect());
        let report =
            Report::new(&design, &blob(&design, 9), serde_json::Value::Null, None, &Exec::new()).unwrap();
        report.check().unwrap();
        let spoils: [(&str, Spoil); 12] = [
            ("design.width must be above 0", |b| b.design.width = -1.0),
            ("design.alignment.rotation_length must be above 0", |b| {
                b.design.alignment.rotation_length = 0.0;
            }),
            ("design.alignment.half_ranges must be above 0", |b| {
                b.design.alignment.half_ranges[0] = f64::NAN;
            }),
            ("axes must each be there once", |b| b.axes.swap(0, 1)),
            ("axes: yaw: lo and hi must be in order", |b| b.axes[1].hi = -9.0),
            ("axes: x: cells must be above 0", |b| b.axes[0].cells = 0),
            ("axes: x: unit must be that of the error", |b| b.axes[0].unit = ErrorUnit::Rad),
            ("acceptance.outcomes must add up", |b| b.acceptance.outcomes.jammed = usize::MAX),
            ("acceptance.sum_bracket must be in order", |b| b.acceptance.sum_bracket = Some([2.0, 1.0])),
            ("onaa.edge must lie between 0 and 1", |b| b.onaa.as_mut().unwrap().edge = 1e300),
            ("centered.bounds must be in order", |b| b.centered.as_mut().unwrap().bounds[0].lo = 9.0),
            ("tolerances of x must not be negative", |b| b.tolerances[0].plus = -0.5),
        ];
        for (message, spoil) in spoils {
            let mut body = report.body.clone();
            spoil(&mut body);
            let text = body.check().unwrap_err().to_string();
            assert!(text.starts_with(message), "{text} instead of {message}");
        }
    }
}
