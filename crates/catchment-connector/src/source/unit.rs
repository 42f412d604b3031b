//! Conversion to D from the unit that a file or the design states.

use catchment_design::design::{FileSpec, FileUnit, LengthUnit};

/// Largest relative difference between units that count as equal: rounding.
const SAME: f64 = 1e-6;

/// Why the unit of a file is not known.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UnitProblem {
    /// The file states another unit than the design.
    #[error(
        "the file says that its unit is {in_file}, and the design says {}: remove `unit` from the design, or correct it",
        stated.symbol()
    )]
    Other {
        /// Unit stated by the file.
        in_file: String,
        /// Unit stated by the design.
        stated: LengthUnit,
    },
    /// A STEP file, which is read in millimetres whatever it was written in.
    #[error(
        "a STEP file says its unit itself, and its coordinates are read in mm; the design says {}: remove `unit` beside it",
        stated.symbol()
    )]
    NotMm {
        /// Unit stated by the design.
        stated: LengthUnit,
    },
    /// Neither the file nor the design states a unit.
    #[error("the file does not say its unit: write it beside the file, unit = \"mm\"")]
    Unsaid,
}

/// Factor from the coordinates of a file to D; `metres` is the length of a coordinate unit, if the file
/// states it.
pub(crate) fn scale(file: &FileSpec, metres: Option<f64>) -> Result<f64, UnitProblem> {
    match (file.unit, metres) {
        (FileUnit::Stated(stated), Some(metres)) if (metres / stated.metres() - 1.0).abs() > SAME => {
            Err(UnitProblem::Other { in_file: shown(metres), stated })
        }
        (FileUnit::Beside | FileUnit::Stated(_), _) => Ok(file.scale),
        (FileUnit::InFile, Some(metres)) => Ok(file.scale * metres),
        (FileUnit::InFile, None) => Err(UnitProblem::Unsaid),
    }
}

/// A unit by its symbol, or by how many mm it has.
fn shown(metres: f64) -> String {
    let known = LengthUnit::ALL.into_iter().find(|unit| (metres / unit.metres() - 1.0).abs() <= SAME);
    let in_mm = || format!("{} mm", (metres / LengthUnit::Mm.metres() * 1e6).round() / 1e6);
    known.map_or_else(in_mm, |unit| unit.symbol().to_owned())
}
