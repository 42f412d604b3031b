//! The seat: its depth, its play, and the residual misalignment of docked halves.

use catchment_core::design::Design;
use catchment_core::document::{Cell, Column, DesignUnits, Document, Table};
use catchment_core::pose::Dof;
use catchment_core::run::Seating;

/// Play and residuals below this count as zero, in D and radians: the effect of rounding and of the ends of
/// motions.
const NONE: f64 = 5e-4;

/// A sharp seat takes a row, a seat with play a table.
pub(super) fn describe(document: &mut Document, found: &Seating, design: &Design) {
    let units = DesignUnits::of(design);
    let depth = if design.unit.is_some() { units.length(found.depth) } else { format!("{} D", found.depth) };
    let most = found.residual.iter().map(|residual| residual.most).fold(0.0, f64::max);
    if found.play.iter().all(|play| play.most() < NONE) && most < NONE {
        document.row("seat", format!("docked: at rest within {depth} of the mated depth; no play there"));
        return;
    }
    document.row(
        "seat",
        format!(
            "docked: at rest within {depth} of the mated depth; play of the mated pose, and residual misalignment of {} docked poses drawn at random:",
            found.poses
        ),
    );
    let mut table = Table::new([
        Column::new("").left(),
        Column::new("play"),
        Column::new("mean residual"),
        Column::new("95 % below"),
        Column::new("largest"),
    ]);
    for play in &found.play {
        let dof = play.axis;
        let amount = |value: f64| amount(dof, value, design);
        let both = if (play.minus - play.plus).abs() < 0.01 * play.most() || play.most() < NONE {
            format!("±{}", amount(play.plus))
        } else {
            format!("−{} / +{}", amount(play.minus), amount(play.plus))
        };
        let residual = found.residual.iter().find(|residual| residual.axis == dof);
        let of = |value: Option<f64>| Cell::from(value.map(&amount));
        table.push([
            dof.name().into(),
            both.into(),
            of(residual.map(|r| r.mean)),
            of(residual.map(|r| r.p95)),
            of(residual.map(|r| r.most)),
        ]);
    }
    document.table(table);
}

/// An amount of an error in the unit of the design, or in degrees.
fn amount(dof: Dof, value: f64, design: &Design) -> String {
    match (dof.is_rotation(), design.unit) {
        (true, _) => format!("{:.3}°", value.to_degrees()),
        (false, Some(_)) => DesignUnits::of(design).length(value),
        (false, None) => format!("{value:.4} D"),
    }
}
