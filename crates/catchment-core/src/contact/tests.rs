//! Fast paths compared with the brute-force reference, and the exact gradient with finite differences.

use super::{Lattice, Pair, brute};
use crate::connector::Connector;
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec, HalfSpec, OwnSpec};
use crate::pose::{CorPose, Dof, DofSet, Mount, PoseError, rotation};
use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;

/// A pair of a family, with coarse round shapes so that the reference stays affordable.
fn pair(family: Family, aspect_ratio: f64, cor: f64) -> Pair {
    let spec = FamilySpec::new(family).with_aspect_ratio(aspect_ratio).with_chord_error(0.02);
    let mut alignment = Alignment::default_for(Some(family));
    alignment.center_of_rotation = cor;
    alignment.free = DofSet::ALL;
    let design = Design {
        name: family.name().to_owned(),
        connector: ConnectorSpec::Family(spec),
        width: 1.0,
        unit: None,
        alignment,
    };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

fn families() -> impl Strategy<Value = Family> {
    proptest::sample::select(vec![
        Family::VFace,
        Family::SFace,
        Family::XFace,
        Family::Pyramid,
        Family::Cone,
        Family::XFace3d,
        Family::XFace3dLocking,
    ])
}

fn poses() -> impl Strategy<Value = CorPose> {
    (-1.2..1.2f64, -1.2..1.2f64, proptest::array::uniform3(-1.5..1.5f64))
        .prop_map(|(x, y, [r, p, w])| CorPose { lateral: DVec2::new(x, y), rotation: rotation(r, p, w) })
}

/// Equal heights, or no height in both.
fn same(fast: Option<f64>, slow: Option<f64>) -> bool {
    match (fast, slow) {
        // Slopes reach 10 for tilted facets, positions are exact to 1e-16: 1e-11 leaves four digits.
        (Some(a), Some(b)) => (a - b).abs() < 1e-11,
        (None, None) => true,
        _ => false,
    }
}

/// A peg whose chamfer is that of its hole, as convex pieces whose corners are rounded to so many digits.
fn flush(sides: u32, digits: i32) -> Pair {
    let rounded = |x: f64| (x * 10f64.powi(digits)).round() / 10f64.powi(digits);
    let ring = |radius: f64, z: f64| -> Vec<DVec3> {
        let corner = |k| {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            DVec3::new(radius * cosine, radius * sine, z).map(rounded)
        };
        (0..sides).map(corner).collect()
    };
    let hole = [ring(0.30714, -0.31), ring(0.30714, -0.1), ring(0.40714, 0.0)];
    let outer = ring(0.8, 0.0);
    let mut fixed = vec![[ring(0.8, -0.4), ring(0.8, -0.31)].concat()];
    for level in hole.windows(2) {
        for k in 0..sides as usize {
            let next = (k + 1) % sides as usize;
            let corners =
                |inner: &Vec<DVec3>| [k, next].map(|k| [inner[k], outer[k].with_z(inner[k].z)]).concat();
            fixed.push(level.iter().flat_map(corners).collect());
        }
    }
    let moving = vec![[ring(0.27143, -0.1), ring(0.27143, 0.26), ring(0.22143, 0.31)].concat()];
    let alignment = Alignment::new([Dof::X, Dof::Y].into_iter().collect(), Mount::X);
    let spec = |pieces: Vec<Vec<DVec3>>| {
        HalfSpec::Pieces(pieces.iter().map(|p| p.iter().map(DVec3::to_array).collect()).collect())
    };
    let own = OwnSpec::new(0.0, spec(fixed), spec(moving));
    let connector = ConnectorSpec::Own(own);
    let design = Design { name: "flush".into(), connector, width: 1.0, unit: None, alignment };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn one_height_equals_the_judges(
        family in families(), ratio in 0.2..2.0f64, cor in -1.0..1.0f64, pose in poses(),
    ) {
        let pair = pair(family, ratio, cor);
        let (fast, slow) = (pair.height(&pose), brute::height(&pair, &pose));
        prop_assert!(same(fast, slow), "{family:?}: {fast:?} against {slow:?}");
    }

    /// Facets that are parallel up to rounding, on which features of a common plane do not support to the
    /// last digit.
    #[test]
    fn flush_faces_have_heights(
        sides in 3..9u32, digits in 3..10i32, x in -0.2..0.2f64, y in -0.2..0.2f64,
    ) {
        let pair = flush(sides, digits);
        let pose = CorPose { lateral: DVec2::new(x, y), rotation: DMat3::IDENTITY };
        let slow = brute::height(&pair, &pose).unwrap();
        let off = PoseError { x, y, ..PoseError::default() };
        // Features are selected as for a motion step, including those that the step may turn into contact.
        let mut near = pair.nearby(0.04, 0.1);
        near.turn(&pose.rotation, pose.lateral, 0.04, 0.02);
        let met = near.height_below(pose.lateral, f64::INFINITY).0;
        for fast in [pair.height(&pose), pair.about(0.01).height(&off), met] {
            let fast = fast.unwrap();
            // Features that are parallel within 1e-6 count as coplanar.
            prop_assert!((fast - slow).abs() < 1e-6, "{sides} {digits}: {fast} against {slow}");
        }
    }

    #[test]
    fn a_lattice_of_heights_equals_single_ones(
        family in families(), ratio in 0.2..2.0f64, cor in -1.0..1.0f64, pose in poses(),
        x in (-1.5..0.0f64, 0.01..0.3f64, 1..12usize), y in (-1.5..0.0f64, 0.01..0.3f64, 1..12usize),
    ) {
        let pair = pair(family, ratio, cor);
        let mut envelope = pair.at_rotation(pose.rotation);
        let lattice = |(first, step, count)| Lattice { first, step, count };
        let (x, y) = (lattice(x), lattice(y));
        let mut cells = vec![f64::NAN; x.count * y.count];
        envelope.heights(x, y, &mut cells);
        for (k, cell) in cells.iter().enumerate() {
            let at = DVec2::new(x.at(k % x.count), y.at(k / x.count));
            let single = envelope.height(at);
            let cell = cell.is_finite().then_some(*cell);
            prop_assert!(same(cell, single), "{family:?} at {at}: {cell:?} against {single:?}");
        }
    }

    /// Features omitted far from a position change nothing there, nor does a small motion since the
    /// candidates were collected: the results are bit for bit those without omissions at the pose itself.
    #[test]
    fn candidates_of_a_neighbourhood_hide_nothing(
        family in families(), ratio in 0.2..2.0f64, pose in poses(), slack in 0.0..0.1f64, reach in 0.0..0.1f64,
        way in proptest::array::uniform5(-1.0..1.0f64), far in 0.0..3.0f64,
    ) {
        let pair = pair(family, ratio, 0.2);
        let mut near = pair.nearby(0.05, 0.05);
        near.turn(&pose.rotation, pose.lateral, slack, reach);
        // A walk that leaves the neighbourhood now and then.
        for step in 1..=4 {
            let by = far * 0.02 * f64::from(step);
            let lateral = pose.lateral + DVec2::new(way[0], way[1]) * by;
            let rotation = turned(DVec3::new(way[2], way[3], way[4]) * by) * pose.rotation;
            near.turn(&rotation, lateral, slack, reach);
            let mut all = pair.nearby(2.0, 100.0);
            all.turn(&rotation, lateral, slack, reach);
            let height = all.height_below(lateral, f64::INFINITY).0;
            prop_assert_eq!(near.height_below(lateral, f64::INFINITY).0, height);
            let ceiling = height.unwrap_or(0.0) - 0.01;
            prop_assert_eq!(near.height_below(lateral, ceiling), all.height_below(lateral, ceiling));
            let (mut few, mut many) = (Vec::new(), Vec::new());
            near.contacts(lateral.extend(height.unwrap_or(0.0)), reach, &mut few);
            all.contacts(lateral.extend(height.unwrap_or(0.0)), reach, &mut many);
            prop_assert_eq!(few, many);
        }
    }

    /// A contact seen again at its own pose is the same, and its row predicts it after a small motion.
    #[test]
    fn a_contact_is_known_again(family in families(), ratio in 0.2..2.0f64, pose in poses()) {
        let pair = pair(family, ratio, 0.2);
        let Some(z) = pair.height(&pose) else { return Ok(()) };
        let position = pose.lateral.extend(z);
        let mut near = pair.nearby(0.01, 0.01);
        near.turn(&pose.rotation, pose.lateral, 0.01, 0.01);
        let mut contacts = Vec::new();
        near.contacts(position, 0.01, &mut contacts);
        for (contact, meeting) in contacts {
            let again = pair.contact(&contact, &meeting, &pose.rotation, position);
            // Edges that cross at less than 1e-3 leave nine digits.
            prop_assert!((again.gap - contact.gap).abs() < 1e-9 && (again.normal - contact.normal).length() < 1e-9);
            prop_assert!((again.point - contact.point).length() < 1e-6, "{again:?} {contact:?}");
            // Each listed contact is valid: its foot lies on both features, and they support it within the
            // given slack.
            let hold = pair.hold(&contact, &meeting, &pose.rotation, position);
            prop_assert!(hold.foot > -1e-6 && hold.support > -0.01 - 1e-6, "{hold:?} {contact:?}");
        }
    }

    /// Halves at first contact do not overlap.
    #[test]
    fn halves_at_first_contact_do_not_overlap(family in families(), ratio in 0.2..2.0f64, pose in poses()) {
        let pair = pair(family, ratio, 0.2);
        let Some(z) = pair.height(&pose) else { return Ok(()) };
        prop_assert!(!pair.overlaps(&pose.rotation, pose.lateral.extend(z)));
    }

    /// A turned envelope holds nothing of the rotation before.
    #[test]
    fn an_envelope_can_be_turned(family in families(), first in poses(), second in poses()) {
        let pair = pair(family, 0.7, 0.3);
        let mut envelope = pair.at_rotation(first.rotation);
        envelope.turn(&second.rotation);
        prop_assert_eq!(envelope.height(second.lateral), pair.height(&second));
    }

    /// If a single contact carries the body, its gradient is that of the height: differences over ±δ agree to
    /// O(δ).
    #[test]
    fn the_gradient_is_the_slope_of_the_height(
        family in families(), ratio in 0.2..1.5f64, cor in -1.0..1.0f64, pose in poses(),
        way in proptest::array::uniform5(-1.0..1.0f64),
    ) {
        const DELTA: f64 = 1e-5;
        let pair = pair(family, ratio, cor);
        let Some(z) = pair.height(&pose) else { return Ok(()) };
        let position = pose.lateral.extend(z);
        let mut touching = Vec::new();
        let mut near = pair.nearby(1e-3, 20.0 * DELTA);
        near.turn(&pose.rotation, pose.lateral, 1e-3, 20.0 * DELTA);
        near.contacts(position, 20.0 * DELTA, &mut touching);
        // A crease is near when something else could touch within the differences; steep slopes bend faster.
        prop_assume!(touching.len() == 1 && touching[0].0.normal.z > 0.2);
        let (slope, turn_slope) = touching[0].0.gradient(position);
        let turn = DVec3::new(way[2], way[3], way[4]);
        let moved = |k: f64| CorPose {
            lateral: pose.lateral + DVec2::new(way[0], way[1]) * (k * DELTA),
            rotation: turned(turn * (k * DELTA)) * pose.rotation,
        };
        let (Some(ahead), Some(behind)) = (pair.height(&moved(1.0)), pair.height(&moved(-1.0))) else {
            return Ok(());
        };
        let measured = (ahead - behind) / (2.0 * DELTA);
        let exact = slope[0] * way[0] + slope[1] * way[1] + turn_slope.dot(turn);
        // Central differences err by δ²·h'''/6 plus 1e-15/δ rounding; a contact that leaves within ±δ errs by its slope
        // change, which the assumption above keeps out except next to convex edges.
        let bend = (ahead + behind - 2.0 * z).abs() / (2.0 * DELTA);
        prop_assert!((measured - exact).abs() < 1e-6 + 2.0 * bend, "{measured} against {exact}, bend {bend}");
    }
}

fn turned(by: DVec3) -> DMat3 {
    DMat3::from_quat(glam::DQuat::from_scaled_axis(by))
}

#[test]
fn pins_in_their_holes_equal_the_judge() {
    let pair = pair(Family::PinHole, 0.2, 0.0);
    for k in 0..40 {
        let a = f64::from(k) * 0.7;
        let pose = CorPose {
            lateral: DVec2::new(0.03 * a.cos(), 0.03 * a.sin()),
            rotation: rotation(0.02 * (2.0 * a).sin(), 0.02 * (3.0 * a).cos(), 0.05 * a.sin()),
        };
        let (fast, slow) = (pair.height(&pose), brute::height(&pair, &pose));
        assert!(same(fast, slow), "{fast:?} against {slow:?}");
    }
}

#[test]
fn a_pyramid_slides_down_its_socket() {
    // AR ½: the plug's apex on the socket's facet, z rises by 2·H/D = 1 per D of offset; COR ½ in front of the face.
    let pair = pair(Family::Pyramid, 0.5, 0.5);
    for x in [0.0, 0.1, 0.3] {
        let z = pair.height(&CorPose { lateral: DVec2::new(x, 0.0), rotation: DMat3::IDENTITY }).unwrap();
        assert!((z - (x - 0.5)).abs() < 1e-15, "{z}");
    }
    assert_eq!(
        pair.height(&CorPose { lateral: DVec2::new(1.01, 0.0), rotation: DMat3::IDENTITY }),
        None,
        "one width apart the halves pass each other"
    );
}

#[test]
fn a_pyramid_pushed_into_its_socket_overlaps() {
    let pair = pair(Family::Pyramid, 0.5, 0.5);
    // Touching along its facet at z = x − ½; the plug's apex edges pass through it at once when it is pushed on.
    for (push, overlap) in [(0.0, false), (1e-7, false), (1e-4, true)] {
        let position = DVec3::new(0.1, 0.05, 0.1 - 0.5 - push);
        assert_eq!(pair.overlaps(&DMat3::IDENTITY, position), overlap, "{push}");
    }
}

#[test]
fn a_half_turn_about_the_axis_changes_nothing_for_symmetric_halves() {
    let pair = pair(Family::XFace3d, 0.577, 0.2);
    let turn = DMat3::from_rotation_z(std::f64::consts::PI);
    for k in 0..50 {
        let a = f64::from(k);
        let pose = CorPose {
            lateral: DVec2::new(0.4 * a.sin(), 0.3 * (1.3 * a).cos()),
            rotation: rotation(0.5 * (0.7 * a).sin(), 0.4 * (1.9 * a).cos(), 0.6 * (2.3 * a).sin()),
        };
        // The whole scene seen after a half turn about z: both halves map onto themselves.
        let seen = CorPose { lateral: -pose.lateral, rotation: turn * pose.rotation * turn.transpose() };
        let (a, b) = (pair.height(&pose), pair.height(&seen));
        assert!(same(a, b), "{a:?} against {b:?}");
    }
}
