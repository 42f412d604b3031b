//! Closed forms, and the definition by brute descent.

use super::*;
use crate::connector::{Connector, Half, stl};
use crate::design::family::{PinHole, XFace, XFace3dLocking};
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec, HalfSpec, OwnSpec};
use crate::pose::{CorPose, DofSet, Mount};
use glam::DMat3;
use proptest::prelude::*;

pub(super) fn pair(spec: FamilySpec) -> Pair {
    let planar = spec.family().is_planar();
    pair_of(ConnectorSpec::Family(spec), planar)
}

pub(super) fn pair_of(connector: ConnectorSpec, planar: bool) -> Pair {
    let free = DofSet::EMPTY.with(Dof::X);
    let free = if planar { free } else { free.with(Dof::Y) };
    let alignment = Alignment {
        center_of_rotation: 0.3,
        ..Alignment::new(free, if planar { Mount::Y } else { Mount::X })
    };
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

fn sheets_of(pair: &Pair) -> Vec<sheet::Sheet> {
    sheet::sheets(&pair.fixed, &pair.moving, MAX_SHEETS, &Exec::new()).unwrap().unwrap()
}

fn run_family(spec: FamilySpec) -> Zraa {
    run(&pair(spec), &ZraaSettings::default(), &Exec::new()).unwrap()
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
                let spec = FamilySpec::new(family)
                    .with_aspect_ratio(aspect_ratio)
                    .with_base_thickness(base_thickness);
                let Zraa::Interval { axis, from, to } = run_family(spec) else { panic!("{family:?}") };
                assert_eq!(axis, Dof::X);
                assert!((from + bound).abs() < 1e-9 && (to - bound).abs() < 1e-9, "{family:?}: {from} {to}");
            }
        }
    }
}

/// A groove is a seat without area: its bottom is a level line, and all that slides onto it is docked.
#[test]
fn a_groove_accepts_its_length() {
    let mut alignment = Alignment::new(DofSet::EMPTY.with(Dof::X).with(Dof::Y), Mount::Y);
    alignment.docked.limits[Dof::Y.index()] = Some(2.0);
    let design = Design {
        name: String::new(),
        connector: ConnectorSpec::Family(FamilySpec::new(Family::VFace)),
        width: 1.0,
        unit: None,
        alignment,
    };
    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
    let Zraa::Region { area, .. } = run(&pair, &ZraaSettings::default(), &Exec::new()).unwrap() else {
        panic!()
    };
    // |x| < ½, and |y| < 1 while the slabs meet at all.
    assert!((area - 2.0).abs() < 1e-9, "{area}");
}

/// Layers with a gap g: |x| < 1, and |y| < g. Beyond, a layer meets the wrong layer and rests on it.
#[test]
fn layers_accept_their_gap() {
    for (thickness, gap) in [(0.4, 0.2), (0.1, 0.3), (0.6, 0.05)] {
        let face = XFace { layer_thickness: Some(thickness), layer_gap: Some(gap), ..XFace::DEFAULT };
        let mut alignment = Alignment::new(DofSet::EMPTY.with(Dof::X).with(Dof::Y), Mount::Y);
        alignment.docked.limits[Dof::Y.index()] = Some(gap);
        let connector = ConnectorSpec::Family(face.into());
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
        let result = run(&pair, &ZraaSettings::default(), &Exec::new());
        let Ok(Zraa::Region { area, .. }) = result else { panic!("{thickness} {gap}: {result:?}") };
        // If the gap exceeds the thickness of the layers, they pass each other before they meet the wrong
        // layer.
        let reach = f64::min(gap, thickness);
        assert!((area - 2.0 * 2.0 * reach).abs() < 1e-9, "{thickness} {gap}: {area}");
    }
}

#[test]
fn the_saddle_accepts_the_diamond() {
    for aspect_ratio in [0.3, 0.577, 1.2] {
        let area = area(FamilySpec::new(Family::XFace3d).with_aspect_ratio(aspect_ratio));
        assert!((area - 2.0).abs() < 1e-9, "{area}");
    }
}

#[test]
fn the_pyramid_accepts_its_socket() {
    for aspect_ratio in [0.3, 1.0] {
        let area = area(FamilySpec::new(Family::Pyramid).with_aspect_ratio(aspect_ratio));
        assert!((area - 1.0).abs() < 1e-9, "{area}");
    }
}

#[test]
fn the_cone_accepts_its_polygon() {
    for chord_error in [0.02, 0.001] {
        let area = area(FamilySpec::new(Family::Cone).with_chord_error(chord_error));
        // The polygon lies inside the circle, within the chord error: it lacks less than its border's length times that.
        let lacking = std::f64::consts::FRAC_PI_4 - area;
        assert!(lacking > 0.0 && lacking < std::f64::consts::PI * chord_error, "{chord_error}: {area}");
    }
}

/// Radius of the circle that the chamfer of the single hole accepts: the tip must land inside its mouth.
#[test]
fn a_peg_accepts_the_mouth_of_its_hole() {
    let spec = PinHole { pins: 1, circle_radius: 0.0, ..PinHole::DEFAULT };
    let mouth = spec.pin_radius + spec.clearance + spec.chamfer;
    let circle = std::f64::consts::PI * mouth * mouth;
    let lacking = circle - area(spec.into());
    assert!(lacking > 0.0 && lacking < 2.0 * std::f64::consts::PI * mouth * spec.chord_error, "{lacking}");
}

/// The height as the sheets have it.
fn height(sheets: &[sheet::Sheet], at: DVec2) -> f64 {
    let over = |p: &&sheet::Sheet| {
        let n = p.footprint.len();
        (0..n).all(|k| {
            let (a, b) = (p.footprint[k], p.footprint[(k + 1) % n]);
            (b - a).perp_dot(at - a) >= -1e-12
        })
    };
    sheets.iter().filter(over).map(|p| p.height(at)).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn sheets_have_the_brute_height() {
    for family in [Family::Pyramid, Family::Cone, Family::XFace3d, Family::XFace3dLocking, Family::PinHole] {
        let pair = pair(FamilySpec::new(family).with_chord_error(0.05));
        let sheets = sheets_of(&pair);
        for k in 0..60u32 {
            let lateral = offset(k);
            let brute = pair.height(&CorPose { lateral, rotation: DMat3::IDENTITY });
            let ours = height(&sheets, lateral);
            // A few products of numbers below 1, divided by normals not flatter than 0.1.
            assert!(
                (brute.unwrap_or(f64::NEG_INFINITY) - ours).abs() < 1e-12 || (brute.is_none() && ours < -1e9)
            );
        }
    }
}

/// Offsets spread evenly over the box, by multiples of an irrational pair.
fn offset(k: u32) -> DVec2 {
    let k = f64::from(k);
    DVec2::new((k * 0.754_877_666).fract() * 2.0 - 1.0, (k * 0.569_840_291).fract() * 2.0 - 1.0)
}

/// Steepest descent by small steps.
fn descends(sheets: &[sheet::Sheet], mut at: DVec2) -> bool {
    let mut step = 0.01;
    let mut here = height(sheets, at);
    while step > 1e-4 && here.is_finite() {
        let lowest = (0..32)
            .map(|k| at + step * DVec2::from_angle(f64::from(k) * std::f64::consts::PI / 16.0))
            .map(|p| (height(sheets, p), p))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap();
        if lowest.0 < here - 1e-9 {
            (here, at) = lowest;
        } else {
            step /= 2.0;
        }
    }
    at.length() < 0.01
}

fn contains(zraa: &Zraa, at: DVec2) -> bool {
    let Zraa::Region { polygons, .. } = zraa else { return false };
    polygons.iter().any(|p| (0..p.len()).all(|k| (p[(k + 1) % p.len()] - p[k]).perp_dot(at - p[k]) >= -1e-12))
}

/// The region agrees with small steps downhill, but for offsets near its border.
#[test]
fn regions_agree_with_small_steps_downhill() {
    let coarse = |family| FamilySpec::new(family).with_chord_error(0.05);
    let specs = [
        coarse(Family::Pyramid),
        coarse(Family::XFace3d),
        XFace3dLocking { draft_angle: 0.3, ..XFace3dLocking::DEFAULT }.into(),
        XFace3dLocking { clearance: 0.05, ..XFace3dLocking::DEFAULT }.into(),
        coarse(Family::Cone).with_base_thickness(Some(0.1)),
    ];
    for spec in specs {
        let pair = pair(spec);
        let zraa = run(&pair, &ZraaSettings::default(), &Exec::new()).unwrap();
        let sheets = sheets_of(&pair);
        let mut wrong = 0;
        for k in 0..200u32 {
            let at = offset(k);
            let near =
                (0..8).map(|a| at + 0.03 * DVec2::from_angle(f64::from(a) * std::f64::consts::FRAC_PI_4));
            let inside = contains(&zraa, at);
            if near.into_iter().all(|p| contains(&zraa, p) == inside) && descends(&sheets, at) != inside {
                wrong += 1;
            }
        }
        assert_eq!(wrong, 0, "{spec:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A skew pyramid in its socket accepts exactly the socket's rim, seen from the apex: every facet leads
    /// away from its own side of the rim, and every valley to the apex.
    #[test]
    fn skew_pyramids_accept_their_rim(
        jitter in proptest::collection::vec(0.0..0.6f64, 3..8), apex in proptest::array::uniform2(-0.15..0.15f64),
        height in 0.1..1.5f64
    ) {
        let n = jitter.len();
        let rim: Vec<DVec2> = jitter
            .iter()
            .enumerate()
            .map(|(k, j)| 0.5 * DVec2::from_angle((k as f64 + j) * std::f64::consts::TAU / n as f64))
            .map(|p| p - DVec2::from_array(apex))
            .collect();
        // The rim runs around the apex; if not, the apex lies beside it.
        prop_assume!((0..n).all(|k| rim[k].perp_dot(rim[(k + 1) % n]) > 0.01));
        let at = |p: DVec2, z: f64| [p.x, p.y, z];
        let wedge = |k: usize| {
            let (p, q) = (rim[k], rim[(k + 1) % n]);
            let o = DVec2::ZERO;
            vec![at(o, 0.0), at(o, -0.2), at(p, -0.2), at(q, -0.2), at(p, height), at(q, height)]
        };
        // The plug is mounted by a half turn about x.
        let flipped = |p: &DVec2| DVec2::new(p.x, -p.y);
        let plug = rim.iter().map(|p| at(flipped(p), 0.0)).chain([at(DVec2::ZERO, height)]).collect();
        let own = OwnSpec::new(height / 2.0, HalfSpec::Pieces((0..n).map(wedge).collect()), HalfSpec::Pieces(vec![plug]));
        let Zraa::Region { area, .. } =
            run(&pair_of(ConnectorSpec::Own(own), false), &ZraaSettings::default(), &Exec::new()).unwrap()
        else { panic!() };
        prop_assert!((area - sheet::area(&rim)).abs() < 1e-9, "{} {}", area, sheet::area(&rim));
    }

    #[test]
    fn a_shifted_seam_changes_nothing(seam in 1e-13..1e-9f64, aspect_ratio in 0.2..1.5f64) {
        let pair = pair(FamilySpec::new(Family::XFace3d).with_aspect_ratio(aspect_ratio));
        let Zraa::Region { area, .. } = run(&pair, &ZraaSettings { seam }, &Exec::new()).unwrap() else { panic!() };
        prop_assert!((area - 2.0).abs() < 1e-9);
    }
}

/// A family's halves written to STL and read back as a mesh each.
fn through_stl(pair: &Pair, format: stl::StlEncoding) -> Pair {
    let read = |half: &Half| {
        let mut file = Vec::new();
        stl::write(half, format, &mut file).unwrap();
        stl::from_bytes(&file, file.len() as u64, 1.0).unwrap()
    };
    let face = glam::DVec3::new(0.0, 0.0, pair.alignment.center_of_rotation);
    let moving = pair.moving.mapped(|p| p - face);
    let connector = Connector::from_halves(read(&pair.fixed), read(&moving));
    Pair::new(&connector, &pair.alignment)
}

#[test]
fn meshes_give_the_familys_region() {
    for (family, exact) in [(Family::Pyramid, 1.0), (Family::XFace3d, 2.0)] {
        let pair = pair(FamilySpec::new(family).with_aspect_ratio(0.7));
        for (format, tolerance) in [(stl::StlEncoding::Ascii, 1e-9), (stl::StlEncoding::Binary, 1e-6)] {
            let mesh = through_stl(&pair, format);
            let Zraa::Region { area, .. } = run(&mesh, &ZraaSettings::default(), &Exec::new()).unwrap()
            else {
                panic!()
            };
            assert!((area - exact).abs() < tolerance, "{family:?} {format:?}: {area}");
        }
    }
}

#[test]
fn locking_lips_and_pins_have_closed_forms_too() {
    let c = 0.005;
    let locking = XFace3dLocking { clearance: c, ..XFace3dLocking::DEFAULT };
    // The lip takes corners from the diamond: 2c² with play c, 8w² with faces of half width w.
    let w = locking.lip_height / 2.0 / (1.0 / 0.1f64.tan() - locking.aspect_ratio);
    assert!((area(locking.into()) - (2.0 - 2.0 * c * c)).abs() < 1e-9);
    assert!((area(XFace3dLocking { draft_angle: 0.1, ..locking }.into()) - (2.0 - 8.0 * w * w)).abs() < 1e-9);
    let pins = PinHole { chord_error: 0.01, ..PinHole::DEFAULT };
    for spec in [
        pins,
        PinHole { pins: 3, chamfer: 0.06, ..pins },
        PinHole { hermaphroditic: true, chamfer: 0.05, ..pins },
    ] {
        // The polygon of n corners that stands for the mouth of a hole; neighbours' holes hold no mated pose.
        let mouth = spec.pin_radius + spec.clearance + spec.chamfer;
        let half_angle = (1.0 - spec.chord_error / mouth).acos();
        let n = 4.0 * (std::f64::consts::PI / half_angle / 4.0).ceil();
        let exact = n / 2.0 * (2.0 * std::f64::consts::PI / n).sin() * mouth * mouth;
        let area = area(spec.into());
        assert!((area - exact).abs() < 1e-9, "{spec:?}: {area} {exact}");
    }
}

/// Four pins and four holes in turn on either half: each pin meets each hole, pin and the plate between, at another offset. Pins of 4 mm on
/// a face of 50 mm, with points: their tips must land inside the mouths.
#[test]
fn a_ring_of_four_pins_and_four_holes() {
    let ring = PinHole { pins: 4, hermaphroditic: true, pin_radius: 0.04, chamfer: 0.04, ..PinHole::DEFAULT };
    let spec = PinHole { clearance: 0.002, chord_error: 0.008, ..ring };
    assert!(sheets_of(&pair(spec.into())).len() > 10_000);
    let mouth = spec.pin_radius + spec.clearance + spec.chamfer;
    let half_angle = (1.0 - spec.chord_error / mouth).acos();
    let n = 4.0 * (std::f64::consts::PI / half_angle / 4.0).ceil();
    let exact = n / 2.0 * (2.0 * std::f64::consts::PI / n).sin() * mouth * mouth;
    let area = area(spec.into());
    assert!((area - exact).abs() < 1e-9, "{area} {exact}");
}

#[test]
fn too_many_ways_to_touch_are_refused_before_they_are_made() {
    let pair = pair(FamilySpec::new(Family::PinHole));
    let most = 100;
    assert!(sheets_of(&pair).len() > 2 * most);
    assert_eq!(
        sheet::sheets(&pair.fixed, &pair.moving, most, &Exec::new()).map(|result| result.is_none()),
        Ok(true)
    );
}
