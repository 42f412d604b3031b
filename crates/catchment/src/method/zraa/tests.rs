//! Closed forms, and the definition by brute descent.

use super::*;
use crate::connector::Connector;
use crate::contact::brute;
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use crate::pose::{CorPose, DofSet, Mount};
use glam::DMat3;

fn pair(spec: FamilySpec) -> Pair {
    let planar = spec.family.is_planar();
    let free = DofSet::EMPTY.with(Dof::X);
    let free = if planar { free } else { free.with(Dof::Y) };
    let alignment = Alignment {
        center_of_rotation: 0.3,
        ..Alignment::new(free, if planar { Mount::Y } else { Mount::X })
    };
    let connector = ConnectorSpec::Family(spec);
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

fn run_family(spec: FamilySpec) -> Zraa {
    run(&pair(spec), &Settings::default(), &Exec::new()).unwrap()
}

fn area(spec: FamilySpec) -> f64 {
    match run_family(spec) {
        Zraa::Region { area, .. } => area,
        other @ Zraa::Interval { .. } => panic!("{other:?}"),
    }
}

#[test]
fn planar_faces_reach_nilssons_bounds() {
    for (family, bound) in [(Family::SFace, 1.0 / 3.0), (Family::VFace, 0.5), (Family::XFace, 1.0)] {
        for aspect_ratio in [0.25, 1.0] {
            for base_thickness in [None, Some(0.5)] {
                let spec = FamilySpec { aspect_ratio, base_thickness, ..FamilySpec::new(family) };
                let Zraa::Interval { axis, from, to } = run_family(spec) else { panic!("{family:?}") };
                assert_eq!(axis, Dof::X);
                assert!((from + bound).abs() < 1e-9 && (to - bound).abs() < 1e-9, "{family:?}: {from} {to}");
            }
        }
    }
}

#[test]
fn the_saddle_accepts_the_diamond() {
    for aspect_ratio in [0.3, 0.577, 1.2] {
        let area = area(FamilySpec { aspect_ratio, ..FamilySpec::new(Family::XFace3d) });
        assert!((area - 2.0).abs() < 1e-9, "{area}");
    }
}

#[test]
fn the_pyramid_accepts_its_socket() {
    for aspect_ratio in [0.3, 1.0] {
        let area = area(FamilySpec { aspect_ratio, ..FamilySpec::new(Family::Pyramid) });
        assert!((area - 1.0).abs() < 1e-9, "{area}");
    }
}

#[test]
fn the_cone_accepts_its_polygon() {
    for chord_error in [0.02, 0.001] {
        let area = area(FamilySpec { chord_error, ..FamilySpec::new(Family::Cone) });
        // The polygon lies inside the circle, within the chord error: it lacks less than its border's length times that.
        let lacking = std::f64::consts::FRAC_PI_4 - area;
        assert!(lacking > 0.0 && lacking < std::f64::consts::PI * chord_error, "{chord_error}: {area}");
    }
}
