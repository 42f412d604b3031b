//! The rest that aligned halves reach if the drawn pose is not a rest, and the connector with that rest as
//! its mated pose.
//!
//! ```text
//!   drawn      ╲  ▁▁▁  ╱          settled   ╲     ╱        the moving half moved there: the same contacts at no error
//!               ╲ ▁▁▁╱                       ╲▁▁▁╱
//! ```
//!
//! A compass search on the potential energy at first contact over the free errors that count: of all combinations of
//! signs the step with the deepest descent is taken, and repeated while it descends. If no step descends, the
//! step is halved, from `FIRST` to `LAST`. The search stays near: a half that sinks farther than `FARTHEST`
//! has run off. Not promised: the end of a ravine between all of these directions; [`mated`](super::mated)
//! checks the result as it checks any pair.

use super::Pair;
use super::play::{directions, unit};
use crate::connector::Connector;
use crate::design::Alignment;
use crate::pose::{Dof, PoseError};
use glam::{DAffine3, DVec3};

/// First and last step, in the ρ-metric.
const FIRST: f64 = 1e-2;
const LAST: f64 = 1e-7;
/// Farthest place that counts as the same seat, in the ρ-metric.
const FARTHEST: f64 = 0.25;
/// A descent by less than this share of a step counts as zero: the largest slope of mated halves is ten times
/// as much.
const SLOPE: f64 = 1e-3;

/// Pose error of the rest that aligned halves reach when released; `None` if they run off.
pub fn rest(pair: &Pair) -> Option<PoseError> {
    let Alignment { free, dont_care, .. } = &pair.alignment;
    let free: Vec<Dof> = free.iter().filter(|dof| !dont_care.contains(*dof)).collect();
    let ways: Vec<[f64; 5]> = directions(free.len())
        .map(|signs| {
            let count = signs.iter().filter(|sign| **sign != 0.0).count() as f64;
            let mut way = [0.0; 5];
            for (dof, sign) in free.iter().zip(&signs) {
                way[dof.index()] = sign / (count.sqrt() * unit(pair, *dof));
            }
            way
        })
        .collect();
    let mut nearby = pair.about(4.0 * FIRST);
    let (mut at, mut energy, mut step) = ([0.0; 5], pair.mated_energy(), FIRST);
    while step >= LAST {
        let mut best: Option<(f64, [f64; 5])> = None;
        for way in &ways {
            let next = going(at, way, step);
            let lowest = best.map_or(energy - SLOPE * step, |(lowest, _)| lowest);
            if nearby.is_above(&PoseError::from_array(next), lowest) {
                continue;
            }
            match nearby.energy(&PoseError::from_array(next)) {
                Some(result) if result < lowest => best = Some((result, *way)),
                Some(_) => {}
                // They pass each other by: nothing holds them.
                None => return None,
            }
        }
        let Some((_, way)) = best else {
            step *= 0.5;
            continue;
        };
        loop {
            let next = going(at, &way, step);
            match nearby.energy(&PoseError::from_array(next)) {
                Some(result) if result < energy - SLOPE * step => (at, energy) = (next, result),
                Some(_) => break,
                None => return None,
            }
            let off: f64 = Dof::ALL.iter().map(|dof| (at[dof.index()] * unit(pair, *dof)).powi(2)).sum();
            if off.sqrt() > FARTHEST {
                return None;
            }
        }
    }
    Some(PoseError::from_array(at))
}

fn going(from: [f64; 5], way: &[f64; 5], step: f64) -> [f64; 5] {
    std::array::from_fn(|k| from[k] + step * way[k])
}

/// The connector whose mated pose is the rest of the given connector; `None` if it runs off.
pub fn settled(connector: Connector, alignment: &Alignment) -> Option<Connector> {
    let pair = Pair::new(&connector, alignment);
    let error = rest(&pair)?;
    let pose = pair.pose(&error);
    let height = pair.height(&pose)?;
    // The moving half as it lies in the world at rest becomes the new moving half; without pose error the
    // face centres coincide.
    let from_cor = DAffine3::from_translation(DVec3::new(0.0, 0.0, alignment.center_of_rotation));
    let at_rest = DAffine3 { matrix3: pose.rotation, translation: pose.lateral.extend(height) };
    Some(connector.settled(at_rest * from_cor, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Half;
    use crate::contact::mated::{MatedProblem, problems};
    use crate::design::{ConnectorSpec, Design, Family, FamilySpec};
    use crate::pose::{DofSet, Mount, rotation};
    use proptest::prelude::*;

    fn pyramid() -> Design {
        let alignment = Alignment { center_of_rotation: 0.3, ..Alignment::new(DofSet::ALL, Mount::X) };
        let connector = ConnectorSpec::Family(FamilySpec::new(Family::Pyramid));
        Design { name: "not at rest as drawn".into(), connector, width: 1.0, unit: None, alignment }
    }

    /// The moving half turned and shifted about its face centre.
    fn askew(connector: &Connector, error: &PoseError) -> Connector {
        let turn = rotation(error.roll, error.pitch, error.yaw);
        let moving: Half = connector.moving.mapped(|p| turn * p + DVec3::new(error.x, error.y, 0.0));
        Connector { moving, ..connector.clone() }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        /// A pyramid drawn at an angle settles, and the halves at rest are the mated ones.
        #[test]
        fn a_tilted_drawing_settles_to_the_mated_pose(e in prop::array::uniform5(-0.03..0.03f64)) {
            let design = pyramid();
            let straight = Connector::build(&design).unwrap();
            let drawn = askew(&straight, &PoseError::from_array(e));
            prop_assume!(!problems(&Pair::new(&drawn, &design.alignment)).is_empty());
            let settled = settled(drawn, &design.alignment).unwrap();
            let result = problems(&Pair::new(&settled, &design.alignment));
            prop_assert!(!result.iter().any(|p| matches!(p, MatedProblem::Collision { .. } | MatedProblem::Gap { .. })), "{:?}", result);
            for (a, b) in settled.moving.surfaces[0].vertices.iter().zip(&straight.moving.surfaces[0].vertices) {
                prop_assert!(a.distance(*b) < 0.02, "{} {}", a, b);
            }
        }
    }

    #[test]
    fn a_mated_drawing_stays_in_place() {
        let design = pyramid();
        let straight = Connector::build(&design).unwrap();
        assert_eq!(rest(&Pair::new(&straight, &design.alignment)), Some(PoseError::default()));
        let settled = settled(straight.clone(), &design.alignment).unwrap();
        assert_eq!(settled.origin.settled, Some(PoseError::default()));
        for (a, b) in settled.moving.surfaces[0].vertices.iter().zip(&straight.moving.surfaces[0].vertices) {
            assert!(a.distance(*b) < 1e-12);
        }
    }
}
