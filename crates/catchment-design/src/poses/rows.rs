//! Pose errors as rows of numbers, as other programs hold them in memory.

use super::written::resolve;
use super::{OffsetsAt, defect};
use crate::design::{Design, Quantity, QuantityUnit};
use catchment_base::diagnostic::{DiagnosticCollector, Diagnostics};

/// Rejects rows that cannot be followed, as for a table: numbers that are NaN, out of range, or nonzero for
/// locked errors. Each row has the five errors in the order of [`Dof::ALL`](catchment_base::pose::Dof::ALL), of the
/// face centre, in D and radians.
///
/// # Errors
/// The first invalid rows, each with its number from 0, and the number of further invalid rows.
pub fn check_rows(rows: &[[f64; 5]], design: &Design) -> Result<(), Diagnostics> {
    let mut result = DiagnosticCollector::default();
    for (number, row) in rows.iter().enumerate() {
        if row.iter().any(|value| !value.is_finite()) {
            result.push(defect(format!("row {number} holds a value that is no number"), "leave it out"));
            continue;
        }
        let written = row.map(|value| Some(Quantity { value, unit: QuantityUnit::Bare }));
        if let Err(faults) = resolve(&written, OffsetsAt::Face, design) {
            for (_, fault) in faults {
                result.push(fault.prefixed(&format!("row {number}")));
            }
        }
    }
    result.refuse()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn rows_are_refused_as_tables_are() {
        let text = "[connector]\nfamily = \"pyramid\"\n[alignment]\nfree = [\"x\", \"pitch\"]\n";
        let design = crate::design::read(text, Path::new("")).unwrap().design;
        assert_eq!(check_rows(&[[0.2, 0.0, 0.0, 0.3, 0.0], [0.0; 5]], &design), Ok(()));
        let wrong = [
            [0.0; 5],
            [f64::NAN, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.1],
            [101.0, 0.0, 0.0, 4.0, 0.0],
        ];
        let stated: Vec<String> = check_rows(&wrong, &design)
            .unwrap_err()
            .list
            .into_iter()
            .map(|diagnostic| diagnostic.message)
            .collect();
        assert!(stated[0].starts_with("row 1 holds a value that is no number"), "{stated:?}");
        assert!(stated[1].starts_with("row 2: yaw = 0.1, but yaw is locked"), "{stated:?}");
        assert!(
            stated[2].contains("x = 101 is out of range") && stated[3].contains("pitch = 4"),
            "{stated:?}"
        );
        // The list ends, the count does not.
        let many = check_rows(&[[200.0, 0.0, 0.0, 0.0, 0.0]; 50], &design).unwrap_err();
        assert_eq!(many.list.len() + many.omitted, 50);
    }
}
