//! Bounds on the accepted offsets of a circle from the polygon that approximates it.

use super::Zraa;
use crate::design::{ConnectorSpec, Design, FamilySpec};

/// Radius of a cone's face, in D.
const RADIUS: f64 = 0.5;

/// Lower and upper bound of the area (D²) or length (D) that the round cone accepts; `None` for other designs,
/// whose answer is that of the solids as given or has no such bound (`pin-hole`).
///
/// ```text
///   inscribed polygon ⊂ circle ⊂ the same polygon, enlarged by 1/(1 − e/R)     e: chord error, R: radius
/// ```
///
/// The accepted set of a cone over a polygon is that polygon, so its measure bounds the circle's from below, and
/// enlarged (squared for an area) from above.
pub fn circle_bounds(design: &Design, zraa: &Zraa) -> Option<[f64; 2]> {
    let ConnectorSpec::Family(FamilySpec::Cone(cone)) = &design.connector else { return None };
    let enlarged = 1.0 / (1.0 - cone.chord_error / RADIUS);
    Some(match zraa {
        Zraa::Interval { from, to, .. } => [to - from, (to - from) * enlarged],
        Zraa::Region { area, .. } => [*area, area * enlarged * enlarged],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::contact::Pair;
    use crate::design::{Alignment, Family};
    use crate::exec::Exec;
    use crate::method::zraa::{ZraaSettings, run};
    use crate::pose::{Dof, DofSet, Mount};
    use std::f64::consts::FRAC_PI_4;

    #[test]
    fn the_circle_lies_between_the_bounds() {
        for chord_error in [0.02, 0.001] {
            let both = DofSet::EMPTY.with(Dof::X).with(Dof::Y);
            for (free, circle) in [(both, FRAC_PI_4), (both.without(Dof::Y), 1.0)] {
                let spec = FamilySpec::new(Family::Cone).with_chord_error(chord_error);
                let connector = ConnectorSpec::Family(spec);
                let alignment = Alignment::new(free, Mount::X);
                let design = Design { name: "cone".into(), connector, width: 1.0, unit: None, alignment };
                let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
                let zraa = run(&pair, &ZraaSettings::default(), &Exec::new()).unwrap();
                let [lower, upper] = circle_bounds(&design, &zraa).unwrap();
                // The seam of the cells is 1e-11 D; a corner of the polygon lies on the x axis.
                assert!(lower <= circle + 1e-9 && circle <= upper, "{lower} {circle} {upper}");
                assert!(upper - lower < 4.5 * chord_error, "{lower} {upper}");
            }
        }
    }
}
