//! Correlations and covariances in a file of robots: axes, units, matrix, and its validity.

use super::super::covariance::{IDENTITY, Matrix, cholesky, least_eigenvalue};
use super::super::distribution::size;
use super::super::{FAMILY, shortened};
use super::read::{Reader, Value};
use crate::design::Quantity;
use catchment_base::diagnostic::Diagnostic;
use catchment_base::pose::{Dof, PoseError};
use std::ops::Range;
use toml::de::DeValue;

/// Largest difference of mirrored entries, relative to the variances: that of rounding to six digits.
const SYMMETRIC_WITHIN: f64 = 1e-6;
/// Eigenvalue of a correlation matrix that rounding to six digits may leave below 0.
const SEMIDEFINITE_WITHIN: f64 = 1e-5;
/// Largest standard deviation, in D or radians: beyond it a text is in the wrong unit.
const LARGEST: f64 = 100.0;

/// A row of a matrix as written, every entry with its place.
type Row = Vec<(f64, Range<usize>)>;

impl Reader<'_> {
    /// The axes of a matrix and the matrix, which has a row and a column for each.
    fn matrix(&mut self, value: &Value<'_>, key: &str, keys: &[&str]) -> Option<(Vec<Dof>, Vec<Row>)> {
        let form = format!("{key} = {{ axes = [\"x\", \"yaw\"], matrix = [[1, 0.5], [0.5, 1]] }}");
        let DeValue::Table(table) = value.get_ref() else {
            self.refuse(value.span(), format!("`{key}` is no table"), &form);
            return None;
        };
        self.unknown(table, keys, key);
        let (Some(axes), Some(matrix)) = (table.get("axes"), table.get("matrix")) else {
            self.refuse(value.span(), format!("`{key}` needs axes and a matrix"), &form);
            return None;
        };
        let (DeValue::Array(names), DeValue::Array(rows)) = (axes.get_ref(), matrix.get_ref()) else {
            self.refuse(value.span(), "axes and matrix are lists", &form);
            return None;
        };
        let mut dofs = Vec::new();
        for name in names {
            let DeValue::String(text) = name.get_ref() else {
                self.refuse(name.span(), "an axis is a name", "one of x, y, roll, pitch, yaw");
                return None;
            };
            let dof = self.dof(text, name.span())?;
            if dofs.contains(&dof) {
                self.refuse(name.span(), format!("{dof} is named twice"), "name each axis once");
                return None;
            }
            dofs.push(dof);
        }
        let count = dofs.len();
        if count == 0 || rows.len() != count {
            let message = format!("the matrix has {} rows for {count} axes", rows.len());
            self.refuse(matrix.span(), message, "it has a row and a column for each axis");
            return None;
        }
        let mut numbers = Vec::new();
        for row in rows {
            let entries = match row.get_ref() {
                DeValue::Array(entries) if entries.len() == count => entries,
                _ => {
                    self.refuse(row.span(), format!("a row has {count} numbers"), "one for each axis");
                    return None;
                }
            };
            let mut read = Vec::new();
            for entry in entries {
                let number = match entry.get_ref() {
                    DeValue::Integer(integer) => integer.as_str().replace('_', "").parse::<f64>().ok(),
                    DeValue::Float(float) => float.as_str().replace('_', "").parse::<f64>().ok(),
                    _ => None,
                };
                let Some(number) = number.filter(|number| number.is_finite()) else {
                    self.refuse(
                        entry.span(),
                        format!("`{}` is no finite number", written(entry.get_ref())),
                        "bare numbers, their units in `units`",
                    );
                    return None;
                };
                read.push((number, entry.span()));
            }
            numbers.push(read);
        }
        Some((dofs, numbers))
    }

    pub(super) fn correlation(&mut self, value: &Value<'_>, sigma: &[f64; 5]) -> Option<Matrix> {
        let (dofs, numbers) = self.matrix(value, "correlation", &["axes", "matrix"])?;
        if let Some(still) = dofs.iter().find(|dof| sigma[dof.index()] == 0.0) {
            let message = format!("{still} has a correlation and no standard deviation");
            self.refuse(value.span(), message, "name it in sigma");
            return None;
        }
        let mut correlation = IDENTITY;
        for (i, row) in numbers.iter().enumerate() {
            for (j, (number, span)) in row.iter().enumerate() {
                if i == j && *number != 1.0 {
                    self.refuse(span.clone(), format!("{0} with {0} is {number}", dofs[i]), "it is 1");
                    return None;
                }
                if number.abs() > 1.0 {
                    let message = format!("the correlation of {} and {} is {number}", dofs[i], dofs[j]);
                    self.refuse(span.clone(), message, "correlations lie from -1 to 1");
                    return None;
                }
                correlation[dofs[i].index()][dofs[j].index()] = *number;
            }
        }
        self.sound(correlation, &dofs, &numbers, value.span())
    }

    pub(super) fn covariance(&mut self, value: &Value<'_>) -> Option<(PoseError, Matrix)> {
        let (dofs, numbers) = self.matrix(value, "covariance", &["axes", "units", "matrix"])?;
        let units = self.units(value, &dofs)?;
        let mut covariance = [[0.0; 5]; 5];
        for (i, row) in numbers.iter().enumerate() {
            if row[i].0 < 0.0 {
                let message = format!("the variance of {} is {}", dofs[i], row[i].0);
                self.refuse(row[i].1.clone(), message, "a variance cannot be negative");
                return None;
            }
            for (j, (number, _)) in row.iter().enumerate() {
                covariance[dofs[i].index()][dofs[j].index()] = number * units[i] * units[j];
            }
        }
        if covariance.iter().flatten().all(|entry| *entry == 0.0) {
            self.refuse(value.span(), "no error occurs", "give at least one variance that is not 0");
            return None;
        }
        let sigma: [f64; 5] = std::array::from_fn(|k| covariance[k][k].sqrt());
        if let Some(dof) = dofs.iter().find(|dof| sigma[dof.index()] > LARGEST) {
            let message = format!("the standard deviation of {dof} is {:.4}", sigma[dof.index()]);
            self.refuse(
                value.span(),
                message,
                "is the unit right? Entries are in the units of their row times their column",
            );
            return None;
        }
        // Test symmetry on the values as written, before the correlations are clamped to ±1.
        let mut correlation = IDENTITY;
        for (i, a) in dofs.iter().enumerate() {
            for b in dofs.iter().take(i) {
                let (a, b) = (a.index(), b.index());
                for (p, q) in [(a, b), (b, a)] {
                    let product = sigma[a] * sigma[b];
                    correlation[p][q] = if product > 0.0 {
                        covariance[p][q] / product
                    } else if covariance[p][q] == 0.0 {
                        0.0
                    } else {
                        f64::INFINITY
                    };
                }
            }
        }
        let correlation = self.sound(correlation, &dofs, &numbers, value.span())?;
        Some((PoseError::from_array(sigma), correlation))
    }

    /// Value of a unit of every axis in D or radians.
    fn units(&mut self, value: &Value<'_>, dofs: &[Dof]) -> Option<Vec<f64>> {
        let DeValue::Table(table) = value.get_ref() else { return None };
        let mut texts: Vec<(String, Range<usize>)> = vec![("1".to_owned(), value.span()); dofs.len()];
        if let Some(units) = table.get("units") {
            const HELP: &str = "a unit for each axis: units = [\"mm\", \"deg\"]";
            let list = match units.get_ref() {
                DeValue::Array(list) if list.len() == dofs.len() => list,
                _ => {
                    self.refuse(units.span(), format!("{} axes have as many units", dofs.len()), HELP);
                    return None;
                }
            };
            for (text, unit) in texts.iter_mut().zip(list) {
                let DeValue::String(name) = unit.get_ref() else {
                    self.refuse(unit.span(), "a unit is a text", HELP);
                    return None;
                };
                *text = (format!("1 {name}"), unit.span());
            }
        }
        let mut factors = Vec::new();
        for (dof, (text, span)) in dofs.iter().zip(texts) {
            let read = text
                .parse::<Quantity>()
                .map_err(|c| Diagnostic::error(FAMILY, c.to_string(), c.help()))
                .and_then(|quantity| size(*dof, quantity, self.design));
            match read {
                Ok(factor) => factors.push(factor),
                Err(fault) => {
                    self.note(span, fault);
                    return None;
                }
            }
        }
        Some(factors)
    }

    /// The correlations, if they are symmetric and positive semidefinite.
    fn sound(
        &mut self,
        mut correlation: Matrix,
        dofs: &[Dof],
        written: &[Row],
        span: Range<usize>,
    ) -> Option<Matrix> {
        for (i, a) in dofs.iter().enumerate() {
            for (j, b) in dofs.iter().enumerate().take(i) {
                let (lower, upper) = (correlation[a.index()][b.index()], correlation[b.index()][a.index()]);
                if !(lower - upper).is_nan() && (lower - upper).abs() > SYMMETRIC_WITHIN {
                    let ((below, at), (above, _)) = (written[i][j].clone(), &written[j][i]);
                    let message =
                        format!("{a} with {b} is {below}, and {b} with {a} is {above}: it is not symmetric");
                    self.refuse(at, message, "both are the same number");
                    return None;
                }
                if !lower.is_finite() {
                    let message = format!("{a} and {b} have a covariance, and one of them has no variance");
                    self.refuse(written[i][j].1.clone(), message, "write 0, or give both a variance");
                    return None;
                }
                let mean = 0.5 * (lower + upper);
                (correlation[a.index()][b.index()], correlation[b.index()][a.index()]) = (mean, mean);
            }
        }
        let (least, along) = least_eigenvalue(&correlation);
        if least < -SEMIDEFINITE_WITHIN {
            let parts = dofs.iter().filter(|dof| along[dof.index()].abs() > 0.05);
            let parts: Vec<String> = parts.map(|dof| format!("{:+.2} {dof}", along[dof.index()])).collect();
            let message = format!(
                "it is not positive semidefinite: of its correlations an eigenvalue is {least:.4}, along {}",
                parts.join(" ")
            );
            self.refuse(
                span,
                message,
                "no errors can spread so; are there correlations beyond what the others leave?",
            );
            return None;
        }
        // Rounding left a slightly negative eigenvalue: all correlations shrink by the same small factor.
        if cholesky(&correlation).is_err() {
            let give = 1.0 / (1.0 + SEMIDEFINITE_WITHIN);
            for (i, row) in correlation.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry *= if i == j { 1.0 } else { give };
                }
            }
        }
        Some(correlation)
    }
}

/// A value as a message repeats it: a number as it is written, the kind of anything else.
fn written(value: &DeValue<'_>) -> String {
    match value {
        DeValue::Integer(number) => shortened(number.as_str()),
        DeValue::Float(number) => shortened(number.as_str()),
        DeValue::String(text) => shortened(text),
        other => other.type_str().to_owned(),
    }
}
