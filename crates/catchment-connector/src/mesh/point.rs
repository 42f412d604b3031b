//! A point in the coordinates of a file, with their unit if it is known.

use catchment_design::design::LengthUnit;
use glam::DVec3;
use std::fmt;

/// Millimetres in a metre.
const MM: f64 = 1e3;

/// A point in the coordinates of its source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshPoint {
    /// Its coordinates.
    pub at: DVec3,
    /// Their unit, if the design has units.
    pub unit: Option<LengthUnit>,
}

impl From<DVec3> for MeshPoint {
    fn from(at: DVec3) -> Self {
        Self { at, unit: None }
    }
}

/// `(1.5, 2, 0)`, `(1.5, 2, 0) mm`, or `(1, 2, 0) in = (25.4, 50.8, 0) mm`.
impl fmt::Display for MeshPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let point = |f: &mut fmt::Formatter<'_>, p: DVec3| {
            let [x, y, z] = (p + 0.0).to_array();
            write!(f, "({}, {}, {})", short(x), short(y), short(z))
        };
        point(f, self.at)?;
        match self.unit {
            None => Ok(()),
            Some(LengthUnit::Mm) => f.write_str(" mm"),
            Some(unit) => {
                write!(f, " {} = ", unit.symbol())?;
                point(f, self.at * (unit.metres() * MM))?;
                f.write_str(" mm")
            }
        }
    }
}

/// A coordinate with seven digits, as many as single precision has.
fn short(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_displays_its_unit_and_millimetres() {
        let at = DVec3::new(1.0, -0.0, f64::from(0.1_f32));
        assert_eq!(MeshPoint::from(at).to_string(), "(1, 0, 0.1)");
        let of = |unit| MeshPoint { at, unit: Some(unit) }.to_string();
        assert_eq!(of(LengthUnit::Mm), "(1, 0, 0.1) mm");
        assert_eq!(of(LengthUnit::In), "(1, 0, 0.1) in = (25.4, 0, 2.54) mm");
    }
}
