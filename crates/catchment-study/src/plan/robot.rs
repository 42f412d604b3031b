//! Parts common to bench tests: the accuracy of a robot in words, and the columns of a table for a robot.

use super::Prediction;
use catchment_core::design::Design;
use catchment_core::document::{Cell, Column, DesignUnits};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::OffsetsAt;

/// The row of an accuracy: `x 1 mm, yaw 0.5° (one standard deviation)`. Errors without a standard deviation
/// are skipped.
pub(crate) fn accuracy_words(design: &Design, accuracy: &PoseError) -> String {
    let units = DesignUnits::of(design);
    let value = |axis: Dof| accuracy.to_array()[axis.index()] * scale(units, axis);
    let words = |axis: Dof| {
        let unit = if axis.is_rotation() { "°" } else { &format!(" {}", units.unit()) };
        format!("{} {}{unit}", axis.name(), four_digits(value(axis)))
    };
    let errors: Vec<String> =
        design.alignment.free.iter().filter(|axis| value(*axis) > 0.0).map(words).collect();
    format!("{} (one standard deviation)", errors.join(", "))
}

/// The columns of pose errors and margins in a table for a robot: units of the design, degrees, nine digits.
pub(crate) struct PoseColumns<'a> {
    design: &'a Design,
    units: DesignUnits<'a>,
    at: OffsetsAt,
    axes: Vec<Dof>,
}

impl<'a> PoseColumns<'a> {
    /// Of free errors, and of locked offsets that some pose needs.
    pub(crate) fn new(design: &'a Design, errors: &[PoseError], at: OffsetsAt) -> Self {
        let alignment = &design.alignment;
        let occurs = |axis: Dof| {
            errors.iter().any(|error| at.measure(error, alignment).to_array()[axis.index()] != 0.0)
        };
        let wanted = |axis: &Dof| alignment.free.contains(*axis) || occurs(*axis);
        let axes = Dof::ALL.into_iter().filter(wanted).collect();
        Self { design, units: DesignUnits::of(design), at, axes }
    }

    /// The columns of the errors.
    pub(crate) fn errors(&self) -> impl Iterator<Item = Column> {
        self.axes.iter().map(|axis| {
            let name = axis.name();
            Column::data(if axis.is_rotation() {
                format!("{name}_deg")
            } else {
                name.to_owned() + &self.unit()
            })
        })
    }

    /// Their values for a pose.
    pub(crate) fn values(&self, error: &PoseError) -> impl Iterator<Item = Cell> {
        let values = self.at.measure(error, &self.design.alignment).to_array();
        self.axes.iter().map(move |axis| {
            let value = values[axis.index()] * scale(self.units, *axis);
            Cell::Text(nine_digits(value).to_string())
        })
    }

    /// The columns of the distance to the border.
    pub(crate) fn margins(&self) -> [Column; 2] {
        [Column::data(format!("distance_to_border{}", self.unit())), Column::data("margin_in_sigma")]
    }

    /// Their values for a pose.
    pub(crate) fn margin(&self, prediction: &Prediction) -> [Cell; 2] {
        let short = |value: Option<f64>| value.map(|value| format!("{value:.4}")).into();
        let distance = prediction.distance_to_border.map(|distance| distance * self.units.scale());
        [short(distance), short(prediction.margin_in_sigma)]
    }

    fn unit(&self) -> String {
        self.design.unit.map_or_else(String::new, |unit| format!("_{}", unit.symbol()))
    }
}

fn scale(units: DesignUnits<'_>, axis: Dof) -> f64 {
    if axis.is_rotation() { 1f64.to_degrees() } else { units.scale() }
}

/// The number rounded to nine digits: far finer than any robot, and 6° is 6. Less than 10⁻¹² is rounding.
fn nine_digits(value: f64) -> f64 {
    // In the unit of the number.
    const NOTHING: f64 = 1e-12;
    if value.abs() < NOTHING { 0.0 } else { format!("{value:.8e}").parse().unwrap_or(value) }
}

/// The number rounded to four digits, for people.
fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
