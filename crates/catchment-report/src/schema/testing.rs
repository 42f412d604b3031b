//! A design and an acceptance for report tests.

use super::*;
use catchment_core::acceptance::{Domain, Outcome};
use catchment_core::design::{Alignment, ConnectorSpec, Family, FamilySpec, LengthUnit};
use catchment_core::diagnostic::Warning;
use catchment_core::landscape::Grid;
use catchment_core::pose::{DofSet, Mount};

/// A pyramid 50 mm wide, free in `free`.
pub(crate) fn design(free: DofSet) -> Design {
    Design {
        name: "pyramid, AR 1/2".to_owned(),
        connector: ConnectorSpec::Family(FamilySpec::new(Family::Pyramid)),
        width: 50.0,
        unit: Some(LengthUnit::Mm),
        alignment: Alignment::new(free, Mount::X),
    }
}

/// A slanted blob with a jammed fringe, missed beyond.
pub(crate) fn blob(design: &Design, cells: usize) -> Acceptance {
    let grid = Grid::over(&design.alignment, |_| cells);
    let outcome = |i| {
        let e = grid.pose(i).to_array();
        let spread: f64 = e.iter().zip([1.4, 1.4, 1.0, 1.0, 0.6]).map(|(v, k)| (v * k).powi(2)).sum();
        match spread + 0.8 * e[0] * e[3] - 0.8 * e[1] * e[2] {
            s if s < 0.7 => Outcome::Aligned,
            s if s < 1.6 => Outcome::Jammed,
            _ => Outcome::Missed,
        }
    };
    Acceptance {
        method: "flood",
        outcomes: (0..grid.len()).map(outcome).collect(),
        domain: Domain::Grid(grid.clone()),
        warnings: vec![Warning::FloodingBias.into()],
    }
}
