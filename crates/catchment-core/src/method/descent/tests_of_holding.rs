//! Closed forms of holding forces, and a reference that tries motions.

use super::holding::{self, Guide, Holding, Load};
use crate::acceptance::Stream;
use crate::contact::Pair;
use crate::pose::PoseError;
use crate::problem::Problem;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_4, SQRT_2};
use std::path::Path;

/// A load of 10⁻⁷ of the push that is not balanced counts as zero.
const EXACT: f64 = 2e-6;

fn pair(connector: &str, free: &str) -> Pair {
    let text = format!(
        "[connector]\n{connector}\n[alignment]\nfree = [{free}]\ncenter_of_rotation = 0.0\nrotation_length = 0.5\n"
    );
    Problem::of(crate::design::read(&text, Path::new("")).unwrap().design).unwrap().pair().clone()
}

const ALL: &str = "\"x\", \"y\", \"roll\", \"pitch\", \"yaw\"";
const PLANE: &str = "\"x\", \"pitch\"";

fn mated(pair: &Pair) -> Holding {
    Holding::at(pair, &PoseError::default(), holding::TOUCHING).unwrap()
}

fn sideways(degrees: f64) -> Load {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Load { force: DVec3::new(cos, sin, 0.0), moment: DVec3::ZERO }
}

fn about(moment: DVec3) -> Load {
    Load { force: DVec3::ZERO, moment }
}

/// h = AR·max(|x|, |y|): AR along x and y, AR/√2 at 45°; a twist lifts by AR/2 of D.
#[test]
fn the_holding_force_of_the_spatial_x_face_is_its_aspect_ratio() {
    let ratio = 3f64.sqrt().recip();
    let pair = pair(&format!("family = \"x-face-3d\"\naspect_ratio = {ratio}"), ALL);
    let mut held = mated(&pair);
    let mut most = |load: &Load| held.most(load, Guide::Along, 0.0).unwrap();
    for (degrees, expected) in [(0.0, ratio), (90.0, ratio), (180.0, ratio), (45.0, ratio / SQRT_2)] {
        let result = most(&sideways(degrees));
        assert!((result - expected).abs() < EXACT, "{degrees}: {result} {expected}");
    }
    for side in [1.0, -1.0] {
        let result = most(&about(DVec3::Z * side));
        assert!((result - ratio / 2.0).abs() < EXACT, "{result}");
    }
}

/// A lip with draft δ resists cot δ instead of its aspect ratio, and an upright lip any load.
#[test]
fn the_holding_force_of_a_lip_is_the_cotangent_of_its_draft() {
    for draft in [0.1f64, 0.3] {
        let pair = pair(&format!("family = \"x-face-3d-locking\"\ndraft_angle = {draft}"), ALL);
        let result = mated(&pair).most(&sideways(0.0), Guide::Along, 0.0).unwrap();
        assert!((result * draft.tan() - 1.0).abs() < 1e-5, "{draft}: {result}");
    }
    let upright = pair("family = \"x-face-3d-locking\"", ALL);
    // Its play ends within the clearance: before, it is a plain face.
    let [before, behind] = [1e-4, 0.1].map(|near| {
        let held = Holding::at(&upright, &PoseError::default(), near);
        held.unwrap().most(&sideways(0.0), Guide::Along, 0.0).unwrap()
    });
    assert!(before < 1.0 && behind == f64::INFINITY, "{before} {behind}");
}

/// On a single flank of slope α a force climbs at tan(α + φ), and never if that is a right angle.
#[test]
fn the_holding_force_of_a_flank_is_the_tangent_of_both_angles() {
    let pair = pair("family = \"v-face\"\naspect_ratio = 0.6", "\"x\"");
    let slope = 1.2f64.atan();
    for friction in [0.0f64, 0.1, 0.3, 0.6] {
        let expected = (slope + friction.atan()).tan();
        let result = mated(&pair).most(&sideways(0.0), Guide::Free, friction).unwrap();
        assert!((result - expected).abs() < 1e-5 * expected, "{friction}: {result} {expected}");
    }
    assert_eq!(mated(&pair).most(&sideways(180.0), Guide::Free, 0.9), Some(f64::INFINITY));
}

/// Something flat slides at the coefficient of friction and tips over its edge: D/2 from the middle.
#[test]
fn a_plate_slides_at_its_friction_and_tips_over_its_edge() {
    let text = "[connector]\nwidth = 1.0\n[[connector.fixed.parts]]\nbox = [2.0, 2.0, 0.5]\n[[connector.moving.parts]]\n\
                box = [1.0, 1.0, 0.5]\n[alignment]\nfree = [\"roll\", \"pitch\"]\nrotation_length = 0.5\n\
                center_of_rotation = 0.0\n";
    let design = crate::design::read(text, Path::new("")).unwrap().design;
    let pair = Problem::of(design).unwrap().pair().with_free(crate::pose::DofSet::ALL);
    let mut held = mated(&pair);
    for friction in [0.0, 0.25] {
        let result = held.most(&sideways(30.0), Guide::Along, friction).unwrap();
        assert!((result - friction).abs() < EXACT, "{result}");
    }
    for axis in [DVec3::X, DVec3::NEG_Y] {
        let result = held.most(&about(axis), Guide::Free, 0.0).unwrap();
        assert!((result - 0.5).abs() < EXACT, "{axis}: {result}");
    }
    let across = DVec3::new(FRAC_PI_4.cos(), FRAC_PI_4.sin(), 0.0);
    let result = held.most(&about(across), Guide::Free, 0.0).unwrap();
    assert!((result - 0.5 * SQRT_2).abs() < EXACT, "{result}");
}

/// No motion that the contacts permit lifts by less per displacement along the load than the holding force,
/// and some motions lift hardly more.
#[test]
fn the_holding_force_is_the_least_lift_of_all_motions() {
    const TRIED: u64 = 200_000;
    let pair = pair("family = \"v-face\"\naspect_ratio = 0.5", PLANE);
    let mut held = mated(&pair);
    let rows: Vec<[f64; 3]> = held
        .contacts()
        .iter()
        .map(|(contact, _)| {
            let turn = (contact.point - held.cor()).cross(contact.normal).y / 0.5;
            [contact.normal.x, contact.normal.z, turn]
        })
        .collect();
    let stream = Stream::new(3);
    for (force, moment) in [([1.0, 0.0], 0.0), ([0.0, 0.0], 0.4), ([1.0, 0.0], -0.3)] {
        let load = Load { force: DVec3::new(force[0], 0.0, 0.0), moment: DVec3::Y * moment };
        let most = held.most(&load, Guide::Free, 0.0).unwrap();
        let mut least = f64::INFINITY;
        for k in 0..TRIED {
            let side = |j: u64| 2.0 * stream.uniform(2 * k + j) - 1.0;
            let [x, turn] = [side(0), side(1)];
            let way = force[0] * x + moment / 0.5 * turn;
            if way <= 1e-3 {
                continue;
            }
            let lift =
                rows.iter().map(|[nx, nz, nt]| -(nx * x + nt * turn) / nz).fold(f64::NEG_INFINITY, f64::max);
            least = least.min(lift / way);
        }
        assert!(most <= least + EXACT, "{load:?}: {most} {least}");
        assert!(least < most * 1.02 + 1e-3, "{load:?}: {most} {least}");
    }
}
