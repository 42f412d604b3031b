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
    // Of a tight seat, none of the poses drawn at random may dock.
    let is_followed = !found.residual.is_empty();
    let residual = if is_followed {
        format!(", and residual misalignment of {} docked poses drawn at random", found.poses)
    } else {
        String::new()
    };
    document.row(
        "seat",
        format!("docked: at rest within {depth} of the mated depth; play of the mated pose{residual}:"),
    );
    let names = ["play", "mean residual", "95 % below", "largest"];
    let names = if is_followed { &names[..] } else { &names[..1] };
    let mut table =
        Table::new([Column::new("").left()].into_iter().chain(names.iter().map(|name| Column::new(*name))));
    for play in &found.play {
        let dof = play.axis;
        let amount = |value: f64| amount(dof, value, design);
        let both = if (play.minus - play.plus).abs() < 0.01 * play.most() || play.most() < NONE {
            format!("±{}", amount(play.plus))
        } else {
            format!("−{} / +{}", amount(play.minus), amount(play.plus))
        };
        let mut row: Vec<Cell> = vec![dof.name().into(), both.into()];
        if is_followed {
            let residual = found.residual.iter().find(|residual| residual.axis == dof);
            let values = residual.map_or([None; 3], |r| [r.mean, r.p95, r.most].map(Some));
            row.extend(values.map(|value| Cell::from(value.map(&amount))));
        }
        table.push(row);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::contact::Play;
    use catchment_core::pose::DofSet;
    use catchment_core::run::Residual;

    /// A shell with 0.07 mm of play around a face of 45 mm: none of 4000 poses in its error box docks.
    #[test]
    fn without_docked_poses_there_is_no_residual_column() {
        let play = vec![Play { axis: Dof::X, minus: 0.0016, plus: 0.0015 }];
        let residual = vec![Residual { axis: Dof::X, mean: 0.001, p95: 0.0012, most: 0.0014 }];
        let tight = Seating { depth: 0.002, play, poses: 0, residual: Vec::new(), deeper: None };
        let printed = |found: &Seating| {
            let mut document = Document::default();
            describe(&mut document, found, &design(DofSet::ALL));
            document
        };
        let shown = format!("{:?}", printed(&tight));
        assert!(shown.contains("play of the mated pose:") && !shown.contains("residual"), "{shown}");
        let shown = format!("{:?}", printed(&Seating { poses: 40, residual, ..tight }));
        assert!(shown.contains("of 40 docked poses") && shown.contains("mean residual"), "{shown}");
    }
}
