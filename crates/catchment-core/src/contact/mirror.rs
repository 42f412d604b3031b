//! Mirror symmetries of a pair: poses that are mirror images of each other have the same height and the same
//! outcome.
//!
//! ```text
//!   x → −x   (x, y, roll, pitch, yaw) → (−x,  y,  roll, −pitch, −yaw)
//!   y → −y                            → ( x, −y, −roll,  pitch, −yaw)
//!   both, a half turn about z         → (−x, −y, −roll, −pitch,  yaw)
//! ```
//!
//! They are detected, not declared: a pair has a symmetry if each of its halves has the same creases after
//! the reflection, to [`COINCIDENT`], independent of the division of its faces into facets. Symmetries that
//! exchange x and y, or rotate by other angles, do not map a grid over Euler angles onto itself and are not
//! considered.

use super::crease::{self, Crease};
use crate::connector::Half;
use crate::pose::Dof;
use crate::tolerance::COINCIDENT;
use glam::DVec3;

/// One of the three reflections.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mirror {
    /// Whether x changes its sign.
    pub x: bool,
    /// Whether y changes its sign.
    pub y: bool,
}

impl Mirror {
    /// The reflections, without the identity.
    pub const ALL: [Self; 3] =
        [Self { x: true, y: false }, Self { x: false, y: true }, Self { x: true, y: true }];

    /// Whether an error changes its sign.
    pub const fn flips(self, dof: Dof) -> bool {
        match dof {
            Dof::X | Dof::Pitch => self.x,
            Dof::Y | Dof::Roll => self.y,
            Dof::Yaw => self.x != self.y,
        }
    }

    fn apply(self, p: DVec3) -> DVec3 {
        DVec3::new(if self.x { -p.x } else { p.x }, if self.y { -p.y } else { p.y }, p.z)
    }
}

/// The reflections that map both halves onto themselves.
pub(super) fn of(fixed: &Half, moving: &Half) -> Vec<Mirror> {
    let halves = [fixed, moving].map(crease::of);
    let drawn = [0, 1].map(|k| creases(&halves[k], |p| p));
    let keeps = |m: &Mirror| [0, 1].iter().all(|k| creases(&halves[*k], |p| m.apply(p)) == drawn[*k]);
    Mirror::ALL.into_iter().filter(keeps).collect()
}

type Corner = [i64; 3];

/// The half as its sorted creases: equal for equal solids, whatever they were written as.
fn creases(half: &[Crease], place: impl Fn(DVec3) -> DVec3) -> Vec<[Corner; 2]> {
    let corner = |p: DVec3| -> Corner {
        // `as` saturates: points farther than 10⁹ D away differ anyway.
        place(p).to_array().map(|v| (v / COINCIDENT).round() as i64)
    };
    let ends = |crease: &Crease| {
        let mut ends = crease.ends.map(corner);
        ends.sort_unstable();
        ends
    };
    let mut creases: Vec<[Corner; 2]> = half.iter().map(ends).collect();
    creases.sort_unstable();
    creases
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::contact::Pair;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use crate::pose::{CorPose, PoseError};
    use proptest::prelude::*;

    fn pair(family: Family) -> Pair {
        let mut alignment = Alignment::default_for(Some(family));
        alignment.center_of_rotation = 0.3;
        let connector = ConnectorSpec::Family(FamilySpec::new(family));
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
    }

    #[test]
    fn families_have_the_symmetries_they_are_drawn_with() {
        let [x, y, both] = Mirror::ALL;
        assert_eq!(pair(Family::Pyramid).mirrors(), [x, y, both]);
        assert_eq!(pair(Family::VFace).mirrors(), [x, y, both]);
        // A saddle: turned by half a turn it is itself, mirrored it is the other hand.
        assert_eq!(pair(Family::XFace3d).mirrors(), [both]);
        // A zigzag, extruded along y.
        assert_eq!(pair(Family::SFace).mirrors(), [y]);
    }

    proptest! {
        #[test]
        fn mirrored_poses_have_equal_heights(e in proptest::array::uniform5(-0.8..0.8f64)) {
            for family in [Family::Pyramid, Family::VFace, Family::XFace3d, Family::SFace, Family::Cone] {
                let pair = pair(family);
                let height = |e: [f64; 5]| {
                    pair.height(&CorPose::from_error(&PoseError::from_array(e), 0.3, pair.alignment.free))
                };
                for mirror in pair.mirrors() {
                    let mut image = e;
                    for dof in Dof::ALL {
                        if mirror.flips(dof) {
                            image[dof.index()] = -e[dof.index()];
                        }
                    }
                    match (height(e), height(image)) {
                        (Some(a), Some(b)) => prop_assert!((a - b).abs() < 1e-9, "{family:?} {mirror:?}: {a} {b}"),
                        (a, b) => prop_assert_eq!(a.is_some(), b.is_some()),
                    }
                }
            }
        }
    }
}
