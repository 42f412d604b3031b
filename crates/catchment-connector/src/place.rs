//! From the coordinates of a part's file to the frames of the contact room.
//!
//! ```text
//!   file ──scale──▶ D ──facing, rotate, translate──▶ facing +z ──face centre to the origin, half turn──▶ frame
//!                    └──rotate, translate──▶ assembled ──approach to −z, face centre to the origin─────▶ frame
//! ```
//!
//! Turns by right angles are exact: an upright wall stays upright.

use catchment_base::pose::Mount;
use catchment_base::tolerance::ROUNDING;
use catchment_design::design::{DrawnFrames, OwnSpec, PartPlacement, PartSpec};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// The frames of both halves, from the coordinates in D in which they are drawn. An unknown face centre is
/// taken as the origin of the drawing.
pub(super) fn frames(own: &OwnSpec, mount: Mount) -> [DAffine3; 2] {
    let [fixed, moving] = [&own.fixed_placement, &own.moving_placement].map(placed);
    match own.drawn {
        DrawnFrames::Facing => {
            let to_face = to_origin(DVec3::new(0.0, 0.0, own.face_height.unwrap_or_default()));
            let turned =
                DMat3::from_cols(mount.apply(DVec3::X), mount.apply(DVec3::Y), mount.apply(DVec3::Z));
            [to_face * fixed, DAffine3::from_mat3(turned) * to_face * moving]
        }
        DrawnFrames::Assembled { approach, face_center } => {
            let down = DAffine3::from_mat3(turn_between(DVec3::from_array(approach), DVec3::NEG_Z));
            let to_face = to_origin(face_center.map_or(DVec3::ZERO, DVec3::from_array));
            [down * to_face * fixed, down * to_face * moving]
        }
    }
}

/// From the coordinates of a part to those of its half.
pub(super) fn part(spec: &PartSpec) -> DAffine3 {
    let turn = turned(spec.rotate) * turn_between(DVec3::Z, DVec3::from_array(spec.axis));
    DAffine3 { matrix3: exact(turn), translation: DVec3::from_array(spec.at) }
}

/// Turns about x, then y, then z.
fn turned([x, y, z]: [f64; 3]) -> DMat3 {
    exact(DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x))
}

fn to_origin(point: DVec3) -> DAffine3 {
    DAffine3::from_translation(-point)
}

fn placed(placement: &PartPlacement) -> DAffine3 {
    let PartPlacement { facing, rotate, translate } = *placement;
    let turn = turned(rotate) * turn_between(DVec3::from_array(facing), DVec3::Z);
    DAffine3 { matrix3: turn, translation: DVec3::from_array(translate) }
}

/// The shortest rotation from a unit vector to another; between opposite vectors about x, or about y if they
/// lie along x.
pub fn turn_between(from: DVec3, to: DVec3) -> DMat3 {
    if from.dot(to) > ROUNDING - 1.0 {
        return exact(DMat3::from_quat(DQuat::from_rotation_arc(from, to)));
    }
    let about = if from.x.abs() < 0.5 { DVec3::X } else { DVec3::Y };
    exact(DMat3::from_axis_angle(about.reject_from_normalized(to).normalize(), std::f64::consts::PI))
}

/// A turn by right angles without its rounding; any other as it is.
fn exact(turn: DMat3) -> DMat3 {
    let rounded = DMat3::from_cols_array(&turn.to_cols_array().map(f64::round));
    if turn.abs_diff_eq(rounded, ROUNDING) { rounded } else { turn }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_design::design::HalfSpec;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    fn own(drawn: DrawnFrames, fixed_placement: PartPlacement, moving_placement: PartPlacement) -> OwnSpec {
        let pieces = || HalfSpec::Pieces(Vec::new());
        OwnSpec { drawn, fixed_placement, moving_placement, ..OwnSpec::new(0.0, pieces(), pieces()) }
    }

    proptest! {
        /// For any facing and rotation of a part: its frame is a rotation, and its facing direction becomes
        /// up.
        #[test]
        fn a_part_faces_up(v in prop::array::uniform3(-1.0..1.0f64), z in -3.0..3.0f64, t in prop::array::uniform3(-2.0..2.0f64)) {
            let facing = DVec3::from_array(v);
            prop_assume!(facing.length() > 0.1);
            let facing = facing.normalize();
            let placement = PartPlacement { facing: facing.to_array(), rotate: [0.0, 0.0, z], translate: t };
            let [fixed, _] = frames(&own(DrawnFrames::Facing, placement, PartPlacement::NONE), Mount::X);
            prop_assert!((fixed.matrix3 * fixed.matrix3.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-12));
            prop_assert!((fixed.matrix3.determinant() - 1.0).abs() < 1e-12);
            prop_assert!(fixed.transform_vector3(facing).abs_diff_eq(DVec3::Z, 1e-12));
            prop_assert!(fixed.transform_point3(DVec3::ZERO).abs_diff_eq(DVec3::from_array(t), 1e-12));
        }

        /// Parts drawn assembled in any frame keep their relative pose, and the approach points down.
        #[test]
        fn an_assembly_may_stand_in_any_frame(v in prop::array::uniform3(-1.0..1.0f64), c in prop::array::uniform3(-50.0..50.0f64)) {
            let approach = DVec3::from_array(v);
            prop_assume!(approach.length() > 0.1);
            let approach = approach.normalize().to_array();
            let drawn = DrawnFrames::Assembled { approach, face_center: Some(c) };
            let [fixed, moving] = frames(&own(drawn, PartPlacement::NONE, PartPlacement::NONE), Mount::Y);
            prop_assert_eq!(fixed, moving);
            prop_assert!(fixed.transform_vector3(DVec3::from_array(approach)).abs_diff_eq(DVec3::NEG_Z, 1e-12));
            prop_assert!(fixed.transform_point3(DVec3::from_array(c)).length() < 1e-12);
        }
    }

    #[test]
    fn right_angles_are_exact() {
        let along = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        for (from, to) in along.iter().flat_map(|from| along.iter().map(move |to| (*from, *to))) {
            let turn = turn_between(from, to);
            assert_eq!(turn * from, to, "{from} {to}");
            assert!(turn.to_cols_array().iter().all(|c| [-1.0, 0.0, 1.0].contains(c)), "{from} {to}");
        }
        let placement = PartPlacement { rotate: [FRAC_PI_2, 0.0, -FRAC_PI_2], ..PartPlacement::NONE };
        let turn = placed(&placement);
        // Turned about x first: y becomes z; then about z.
        assert_eq!(turn.transform_vector3(DVec3::Y), DVec3::Z);
        assert_eq!(turn.transform_vector3(DVec3::X), DVec3::NEG_Y);
    }

    #[test]
    fn facing_down_is_a_half_turn_about_x() {
        let turn = placed(&PartPlacement { facing: [0.0, 0.0, -1.0], ..PartPlacement::NONE });
        assert_eq!(turn.transform_point3(DVec3::new(1.0, 2.0, 3.0)), DVec3::new(1.0, -2.0, -3.0));
    }
}
