//! The designs for the comparison of methods.

use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use catchment::pose::Dof;

/// One design and its resolutions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// The connector family.
    pub family: Family,
    /// H/D.
    pub aspect_ratio: f64,
    /// Distance of the COR in front of the face centre, in D.
    pub center_of_rotation: f64,
    /// ρ, in D.
    pub rotation_length: f64,
    /// The free errors.
    pub free: &'static [Dof],
}

const PLANAR: &[Dof] = &[Dof::X, Dof::Pitch];
const X_Y_PITCH: &[Dof] = &[Dof::X, Dof::Y, Dof::Pitch];
const X_Y_YAW: &[Dof] = &[Dof::X, Dof::Y, Dof::Yaw];
const ALL: &[Dof] = &Dof::ALL;

const fn case(family: Family, aspect_ratio: f64, cor: f64, rho: f64, free: &'static [Dof]) -> Case {
    Case { family, aspect_ratio, center_of_rotation: cor, rotation_length: rho, free }
}

/// tan 30°, the dissertation's choice for the 3-D X-Face.
const SADDLE: f64 = FamilySpec::new(Family::XFace3d).aspect_ratio();

/// The aspect ratio of the locking 3-D X-Face.
const LOCKING: f64 = FamilySpec::new(Family::XFace3dLocking).aspect_ratio();

/// Planar and spatial, convex and non-convex, two to five errors, centres of rotation from far behind the face to far
/// before it; the two with thin ravines and shallow jams (V-Face) are included because they are hard.
pub const CASES: [Case; 11] = [
    case(Family::VFace, 1.0, 0.0, 1.0, PLANAR),
    case(Family::VFace, 0.5, -0.5, 1.0, PLANAR),
    case(Family::XFace, 1.0, 0.5, 1.0, PLANAR),
    case(Family::XFace, 0.5, -0.5, 1.0, PLANAR),
    case(Family::XFace, 2.0, 1.0, 1.0, PLANAR),
    case(Family::SFace, 1.0, -1.0, 1.0, PLANAR),
    case(Family::Pyramid, 1.0, 0.0, 0.5, X_Y_PITCH),
    case(Family::Pyramid, 1.0, 0.0, 0.5, X_Y_YAW),
    case(Family::XFace3d, SADDLE, 0.0, 0.5, X_Y_YAW),
    case(Family::Pyramid, 0.5, 0.5, 0.5, ALL),
    case(Family::XFace3d, SADDLE, 0.5, 0.5, ALL),
];

/// The designs with labels checked cell by cell, and cells per axis.
pub const LABELLED: [(Case, usize); 5] = [
    (case(Family::Pyramid, 0.5, 0.5, 0.5, ALL), 20),
    (case(Family::Pyramid, 0.5, 0.0, 0.5, ALL), 20),
    (case(Family::XFace3d, SADDLE, 0.5, 0.5, ALL), 20),
    (case(Family::XFace3d, SADDLE, 0.0, 0.5, ALL), 20),
    (case(Family::XFace3dLocking, LOCKING, 0.5, 0.5, ALL), 13),
];

impl Case {
    /// Cells per axis, coarse to fine.
    pub const fn resolutions(&self) -> [usize; 3] {
        match self.free.len() {
            ..=2 => [50, 100, 200],
            3 => [20, 30, 40],
            _ => [12, 20, 30],
        }
    }

    /// `pyramid, AR 0.5, COR 0.5, ρ 0.5`.
    pub fn name(&self) -> String {
        let (ratio, cor) = (self.aspect_ratio, self.center_of_rotation);
        let ratio = if ratio == SADDLE { "tan 30°".to_owned() } else { ratio.to_string() };
        let cor = cor.to_string().replace('-', "−");
        format!("{}, AR {ratio}, COR {cor}, ρ {}", self.family.name(), self.rotation_length)
    }

    /// The design.
    pub fn design(&self) -> Design {
        let spec = FamilySpec::new(self.family).with_aspect_ratio(self.aspect_ratio);
        let alignment = Alignment {
            free: self.free.iter().copied().collect(),
            center_of_rotation: self.center_of_rotation,
            rotation_length: self.rotation_length,
            ..Alignment::default_for(Some(self.family))
        };
        Design {
            name: self.name(),
            connector: ConnectorSpec::Family(spec),
            width: 1.0,
            unit: None,
            alignment,
        }
    }
}
