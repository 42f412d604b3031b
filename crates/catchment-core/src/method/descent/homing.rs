//! Test whether all motions near the mated pose dock, so that a motion may end before it reaches the seat.
//!
//! ```text
//!     ╲         ╱      near: face centres within 0.02 D and rotation within 0.02 rad
//!      ╲·     ·╱       poses all over it, each followed into the seat, once per pair:
//!       ╲· · ·╱        all dock → a motion ends as docked when it is near;  if not → no motion ends early
//!        ╲_●_╱
//! ```
//!
//! Sharp seats (faces that end in a point or a ridge) pass; motion into their last corner takes as long as
//! all motion before. With tight fits and with docking tolerances on the errors, motions are always followed
//! into the seat, and so are those of halves with so many facets that these poses would take longer than they
//! save.
//!
//! Not promised: that no pose near it jams, only that fewer than three in a hundred do, with 95 % confidence.

use super::DescentSettings;
use super::fall::all_count;
use super::motion::{Motion, NoObserver, Until};
use crate::acceptance::{Outcome, Stream};
use crate::contact::Pair;
use crate::pose::{Dof, PoseError, face_from_cor};
use glam::{DMat3, DVec3};

/// How near, in D and radians.
const NEAR: f64 = 0.02;
/// Number of poses tried: if none of these jams, fewer than 3 % do (0.97¹⁰⁰ < 5 %).
const POSES: u64 = 100;
/// Their numbers.
const SEED: u64 = 0x40e;

/// Whether a half is near the mated pose, or a declared equivalent.
pub(super) fn is_near(pair: &Pair, rotation: &DMat3, cor: DVec3) -> bool {
    let face = cor + face_from_cor(rotation, pair.alignment.center_of_rotation);
    face.truncate().length() <= NEAR && pair.alignment.turned_by(rotation) <= NEAR
}

/// Whether all tried poses near the mated pose dock. Always with the default settings: the result is stored
/// with the pair, and must not depend on the first caller.
pub(super) fn all_dock(pair: &Pair) -> bool {
    if pair.is_tight() || pair.is_large() || !all_count(pair) {
        return false;
    }
    *pair.motion_cache.homing.get_or_init(|| {
        let stream = Stream::new(SEED);
        let (free, settings) = (pair.alignment.free, DescentSettings::default());
        let mut motion = Motion::new(pair, &settings);
        (0..POSES).all(|k| {
            let mut error = [0.0; Dof::ALL.len()];
            for dof in free.iter() {
                // Of two translations and three rotations together no more than NEAR each.
                let most = NEAR / if dof.is_rotation() { 3f64.sqrt() } else { 2f64.sqrt() };
                let number = stream.uniform(Dof::ALL.len() as u64 * k + dof.index() as u64);
                error[dof.index()] = most * (2.0 * number - 1.0);
            }
            motion.follow(&PoseError::from_array(error), Until::Known, &mut NoObserver).outcome
                == Outcome::Aligned
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use crate::method::descent::outcome;

    #[test]
    fn homing_does_not_depend_on_the_first_query() {
        let alignment = Alignment::default_for(Some(Family::Pyramid));
        let connector = ConnectorSpec::Family(FamilySpec::new(Family::Pyramid));
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
        // A budget in which nothing docks.
        let spent = DescentSettings { max_steps: 1, ..DescentSettings::default() };
        let _ = outcome(&pair, &PoseError { x: 0.3, ..PoseError::default() }, &spent);
        assert!(pair.motion_cache.homing.get() == Some(&true) && all_dock(&pair));
    }
}
