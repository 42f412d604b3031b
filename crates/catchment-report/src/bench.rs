//! What reports on bench tests share: poses and accuracies in the design's units, and columns of a table that a robot reads.

use super::text;
use catchment_core::design::Design;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::OffsetsAt;

/// Poses of a design, told in its units.
pub(super) struct Told<'a> {
    pub(super) design: &'a Design,
}

impl Told<'_> {
    /// `mm`, or D.
    pub(super) fn unit(&self) -> &'static str {
        self.design.unit.map_or("D", |unit| unit.symbol())
    }

    /// D in that unit.
    pub(super) const fn width(&self) -> f64 {
        if self.design.unit.is_some() { self.design.width } else { 1.0 }
    }

    /// `12.500 mm`.
    pub(super) fn length(&self, value: f64) -> String {
        format!("{} {}", text::length(value * self.width(), self.width()), self.unit())
    }

    /// `x 12.500 mm` or `yaw 6.00°`.
    pub(super) fn size(&self, axis: Dof, value: f64) -> String {
        if axis.is_rotation() {
            // No minus before nothing.
            format!("{} {:.2}°", axis.name(), (value.to_degrees() * 100.0).round() / 100.0 + 0.0)
        } else {
            format!("{} {}", axis.name(), self.length(value))
        }
    }

    /// All free errors.
    pub(super) fn pose(&self, error: &PoseError) -> String {
        let free = self.design.alignment.free.iter();
        free.map(|axis| self.size(axis, error.to_array()[axis.index()])).collect::<Vec<_>>().join(", ")
    }

    /// Errors that have an accuracy.
    pub(super) fn accuracy(&self, accuracy: &PoseError) -> String {
        let of = |axis: &Dof| accuracy.to_array()[axis.index()] > 0.0;
        let free = self.design.alignment.free.iter().filter(of);
        let told: Vec<String> = free
            .map(|axis| {
                let value = accuracy.to_array()[axis.index()];
                let scale = if axis.is_rotation() { 1f64.to_degrees() } else { self.width() };
                let unit = if axis.is_rotation() { "°" } else { &format!(" {}", self.unit()) };
                format!("{} {}{unit}", axis.name(), four_digits(value * scale))
            })
            .collect();
        told.join(", ")
    }

    /// The columns of errors: names, and what gives their values. Locked offsets have one where some pose needs it.
    pub(super) fn columns(&self, errors: &[PoseError], at: OffsetsAt) -> Vec<(String, Dof)> {
        let alignment = &self.design.alignment;
        let occurs = |axis: Dof| {
            errors.iter().any(|error| at.measure(error, alignment).to_array()[axis.index()] != 0.0)
        };
        let wanted = Dof::ALL.into_iter().filter(|axis| alignment.free.contains(*axis) || occurs(*axis));
        let name = |axis: Dof| match (axis.is_rotation(), self.design.unit) {
            (true, _) => format!("{}_deg", axis.name()),
            (false, Some(unit)) => format!("{}_{}", axis.name(), unit.symbol()),
            (false, None) => axis.name().to_owned(),
        };
        wanted.map(|axis| (name(axis), axis)).collect()
    }

    /// The value of a column of [`Told::columns`].
    pub(super) fn cell(&self, error: &PoseError, axis: Dof, at: OffsetsAt) -> String {
        let value = at.measure(error, &self.design.alignment).to_array()[axis.index()];
        let scale = if axis.is_rotation() { 1f64.to_degrees() } else { self.width() };
        format!("{}", nine_digits(value * scale))
    }
}

/// The number rounded to nine digits: far finer than any robot, and 6° is 6. Less than 10⁻¹² is rounding.
pub(super) fn nine_digits(value: f64) -> f64 {
    const NOTHING: f64 = 1e-12;
    if value.abs() < NOTHING { 0.0 } else { format!("{value:.8e}").parse().unwrap_or(value) }
}

/// The number rounded to four digits, for eyes.
fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
