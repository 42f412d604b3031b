//! The seat as text: how deep, how much play, how far off docked halves rest.

use super::{length, line, row};
use catchment_core::design::Design;
use catchment_core::pose::Dof;
use catchment_core::run::Seating;

/// Play and residuals below this are none, in D and radians: what rounding and the ends of motions leave.
const NONE: f64 = 5e-4;

/// A sharp seat takes a line, one with play a table.
pub(super) fn lines(text: &mut String, found: &Seating, design: &Design) {
    let depth = match design.unit {
        Some(unit) => format!("{} {}", length(found.depth * design.width, design.width), unit.symbol()),
        None => format!("{} D", found.depth),
    };
    let most = found.residual.iter().map(|residual| residual.most).fold(0.0, f64::max);
    if found.play.iter().all(|play| play.most() < NONE) && most < NONE {
        row(text, "seat", &format!("sharp: no play, docked within {depth} of its depth"));
        return;
    }
    row(
        text,
        "seat",
        &format!("docked within {depth} of its depth; off at rest, of {} docked poses:", found.poses),
    );
    line(text, &format!("  {:<9}{:>22}{:>15}{:>15}{:>15}", "", "play", "mean", "95 %", "most"));
    for play in &found.play {
        let dof = play.axis;
        let both = if (play.minus - play.plus).abs() < 0.01 * play.most() || play.most() < NONE {
            format!("±{}", amount(dof, play.plus, design))
        } else {
            format!("−{} / +{}", amount(dof, play.minus, design), amount(dof, play.plus, design))
        };
        let rest: String = match found.residual.iter().find(|residual| residual.axis == dof) {
            Some(r) => [r.mean, r.p95, r.most].map(|v| format!("{:>15}", amount(dof, v, design))).concat(),
            None => String::new(),
        };
        line(text, &format!("  {:<9}{both:>22}{rest}", dof.name()));
    }
}

/// An amount of an error in the unit of the design, or in degrees.
fn amount(dof: Dof, value: f64, design: &Design) -> String {
    match (dof.is_rotation(), design.unit) {
        (true, _) => format!("{:.3}°", value.to_degrees()),
        (false, Some(unit)) => format!("{} {}", length(value * design.width, design.width), unit.symbol()),
        (false, None) => format!("{value:.4} D"),
    }
}
