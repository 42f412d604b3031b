//! Halves in the frames of their files: the problem does not depend on the frame, and a half that contradicts its declaration is refused
//! with the reason.

use catchment::design::{ConnectorSpec, DrawnFrames, HalfSpec, OwnSpec, PartPlacement, SourceText};
use catchment::pose::CorPose;
use catchment::prelude::*;
use catchment::report::{CheckReport, Report};
use catchment::run::{Over, Sample};
use glam::{DAffine3, DMat3, DVec2};
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::fmt::Write;

const HEIGHT: f64 = 0.7;
const COR: f64 = 0.3;

type Pieces = Vec<Vec<[f64; 3]>>;

/// A pyramid socket as four wedges, and its plug; both facing +z, the face centres at half of [`HEIGHT`].
fn drawn() -> [Pieces; 2] {
    let (h, b) = (HEIGHT, -0.25);
    let rim = [[0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]];
    let wedge = |k: usize| {
        let ([px, py], [qx, qy]) = (rim[k], rim[(k + 1) % 4]);
        vec![[0.0, 0.0, 0.0], [0.0, 0.0, b], [px, py, b], [qx, qy, b], [px, py, h], [qx, qy, h]]
    };
    let plug = rim.iter().map(|[x, y]| [*x, *y, 0.0]).chain([[0.0, 0.0, h]]).collect();
    [(0..4).map(wedge).collect(), vec![plug]]
}

fn moved(pieces: &Pieces, by: &DAffine3) -> HalfSpec {
    let map = |p: &[f64; 3]| by.transform_point3(DVec3::from_array(*p)).to_array();
    HalfSpec::Pieces(pieces.iter().map(|piece| piece.iter().map(map).collect()).collect())
}

fn problem(own: OwnSpec) -> Result<Problem, ProblemError> {
    let alignment = Alignment { center_of_rotation: COR, ..Alignment::new(DofSet::ALL, Mount::X) };
    let connector = ConnectorSpec::Own(own);
    Problem::of(Design { name: "pyramid".into(), connector, width: 1.0, unit: None, alignment })
}

/// Both drawn facing +z, the heights of their face centres given.
fn plain() -> OwnSpec {
    let [fixed, moving] = drawn().map(|pieces| moved(&pieces, &DAffine3::IDENTITY));
    OwnSpec::new(HEIGHT / 2.0, fixed, moving)
}

/// Both in one frame, docked, `apart` along the approach; `world` is the pose of that frame.
fn assembled(world: &DAffine3, apart: f64) -> OwnSpec {
    let face = DAffine3::from_translation(DVec3::new(0.0, 0.0, -HEIGHT / 2.0));
    let half_turn = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)));
    let lifted = DAffine3::from_translation(DVec3::new(0.0, 0.0, apart));
    let [fixed, moving] = drawn();
    let approach = world.transform_vector3(DVec3::NEG_Z).to_array();
    OwnSpec {
        face_height: None,
        drawn: DrawnFrames::Assembled { approach, face_center: None },
        ..OwnSpec::new(
            0.0,
            moved(&fixed, &(*world * face)),
            moved(&moving, &(*world * lifted * half_turn * face)),
        )
    }
}

/// Largest difference of the heights over poses spread over the error box; `turned` is the rotation of the second
/// about z.
fn difference(a: &Problem, b: &Problem, turned: f64) -> f64 {
    let spread = |k: u32, step: f64, half: f64| ((f64::from(k) * step).fract() * 2.0 - 1.0) * half;
    let mut largest = 0.0f64;
    let mut met = 0;
    let turn = DMat3::from_rotation_z(turned);
    for k in 1..60 {
        let rotation = catchment::pose::rotation(
            spread(k, 0.581_1, 0.8),
            spread(k, 0.484_9, 0.8),
            spread(k, 0.404_7, 1.2),
        );
        let lateral = DVec2::new(spread(k, 0.834_5, 0.5), spread(k, 0.696_4, 0.5));
        let seen = CorPose {
            lateral: (turn * lateral.extend(0.0)).truncate(),
            rotation: turn * rotation * turn.transpose(),
        };
        match (a.pair().height(&CorPose { lateral, rotation }), b.pair().height(&seen)) {
            (Some(a), Some(b)) => {
                met += 1;
                largest = largest.max((a - b).abs());
            }
            (None, None) => {}
            _ => largest = f64::INFINITY,
        }
    }
    assert!(met > 20, "{met}");
    largest
}

fn turn() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-3.0..3.0f64)
}

fn affine([x, y, z]: [f64; 3], translation: [f64; 3]) -> DAffine3 {
    let turn = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    DAffine3 { matrix3: turn, translation: DVec3::from_array(translation) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// `rotate` and `translate` restore a part that its file has turned and moved far away.
    #[test]
    fn a_placed_half_is_where_it_was(a in turn(), s in prop::array::uniform3(-20.0..20.0f64)) {
        let place = affine(a, s);
        let placement = PartPlacement { rotate: a, translate: s, ..PartPlacement::NONE };
        let [fixed, moving] = drawn();
        let away = place.inverse();
        let own = OwnSpec {
            fixed_placement: placement,
            moving_placement: placement,
            ..OwnSpec::new(HEIGHT / 2.0, moved(&fixed, &away), moved(&moving, &away))
        };
        let own = problem(own).unwrap();
        // Coordinates of 20 D are rounded to 4e-15 D, and convex hulls to a lattice that is finer than 1e-9 of their size.
        prop_assert!(difference(&problem(plain()).unwrap(), &own, 0.0) < 1e-7);
        let origin = own.connector().origin;
        let face = away.transform_point3(DVec3::new(0.0, 0.0, HEIGHT / 2.0));
        prop_assert!(origin.fixed.transform_point3(face).length() < 1e-9);
        prop_assert!(origin.moving.transform_point3(face).length() < 1e-9);
    }

    /// An assembly in any frame, drawn slightly apart or overlapping: mated at first contact, with the face centre computed.
    #[test]
    fn an_assembly_is_located_in_any_frame(a in turn(), s in prop::array::uniform3(-20.0..20.0f64), apart in -0.04..0.04f64) {
        let world = affine(a, s);
        let own = problem(assembled(&world, apart)).unwrap();
        let origin = own.connector().origin;
        prop_assert!((origin.apart.unwrap() - apart).abs() < 1e-9);
        // The computed frame may be turned about the approach.
        let seen = origin.fixed * world;
        let turned = seen.transform_vector3(DVec3::X).truncate().to_angle();
        prop_assert!(seen.transform_vector3(DVec3::Z).abs_diff_eq(DVec3::Z, 1e-9));
        prop_assert!(difference(&problem(plain()).unwrap(), &own, turned) < 1e-7);
        prop_assert!(own.pair().mated_height() + COR < 1e-9);
        prop_assert!(origin.fixed.transform_point3(world.translation).truncate().length() < 1e-9);
    }
}

/// Facing +z, the heights of the face centres are computed, also if the two files have them at different heights.
#[test]
fn the_face_height_is_computed() {
    let [fixed, moving] = drawn();
    let up = |z: f64| DAffine3::from_translation(DVec3::new(0.0, 0.0, z));
    let own = OwnSpec {
        face_height: None,
        ..OwnSpec::new(0.0, moved(&fixed, &up(3.0)), moved(&moving, &up(-7.0)))
    };
    let result = problem(own).unwrap();
    let plain = problem(plain()).unwrap();
    assert!(difference(&plain, &result, 0.0) < 1e-12);
    assert_ne!(plain.digest(), result.digest());
    let report = CheckReport::good(&result);
    let drawing = report.drawing.unwrap();
    // The socket has material behind it, which the plug does not reach.
    for (result, true_) in [(drawing.fixed.face_center[2], 3.35), (drawing.moving.face_center[2], -6.65)] {
        assert!((result - true_).abs() < 1e-9, "{result} {true_}");
    }
    // In front of the moving face, inside the fixed half.
    assert!((drawing.fixed.center_of_rotation[2] - (3.35 - COR)).abs() < 1e-9);
    assert!((drawing.moving.center_of_rotation[2] - (-6.65 + COR)).abs() < 1e-9);
}

#[test]
fn an_assembly_that_is_not_docked_is_refused() {
    let refused = |apart: f64| problem(assembled(&DAffine3::IDENTITY, apart)).unwrap_err().to_string();
    assert!(refused(0.3).contains("0.3 D apart along the approach"), "{}", refused(0.3));
    assert!(refused(-0.3).contains("0.3 D deeper than it gets"), "{}", refused(-0.3));
}

/// Exported from an assembly aligned by eye: refused as drawn; the same pair builds with `settle`.
#[test]
fn an_assembly_drawn_askew_settles() {
    let askew = DAffine3::from_mat3_translation(DMat3::from_rotation_x(0.01), DVec3::new(0.012, -0.007, 0.0));
    let own = |settle: bool| {
        let straight = assembled(&DAffine3::IDENTITY, 0.0);
        let HalfSpec::Pieces(pieces) = &straight.moving else { panic!("pieces") };
        let drawn = DrawnFrames::Assembled { approach: [0.0, 0.0, -1.0], face_center: Some([0.0; 3]) };
        OwnSpec { settle, drawn, moving: moved(pieces, &askew), ..straight }
    };
    let refused = problem(own(false)).unwrap().checked().unwrap_err().to_string();
    assert!(refused.contains("settle = true"), "{refused}");
    let settled = problem(own(true)).unwrap().checked().unwrap();
    let plain = problem(plain()).unwrap();
    assert!(difference(&plain, &settled, 0.0) < 1e-4, "{:e}", difference(&plain, &settled, 0.0));
    let error = CheckReport::good(&settled).drawing.unwrap().settled.unwrap();
    assert!((error.x + 0.012).abs() < 5e-3 && (error.y - 0.007).abs() < 5e-3, "{error:?}");
    assert!((error.roll + 0.01).abs() < 1e-4, "{error:?}");
}

/// Point on point has no rest.
#[test]
fn halves_that_run_off_do_not_settle() {
    let tip = || {
        let corners =
            [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0], [0.0, 0.0, 0.5]];
        HalfSpec::Pieces(vec![corners.to_vec()])
    };
    let own = OwnSpec { settle: true, ..OwnSpec::new(0.5, tip(), tip()) };
    let refused = problem(own).unwrap_err().to_string();
    assert!(refused.contains("run off"), "{refused}");
}

#[test]
fn every_placement_change_changes_the_digest() {
    let digest = |change: &dyn Fn(&mut OwnSpec)| {
        let mut own = plain();
        change(&mut own);
        let alignment = Alignment::new(DofSet::ALL, Mount::X);
        let connector = ConnectorSpec::Own(own);
        let design = Design { name: "d".into(), connector, width: 1.0, unit: None, alignment };
        let text = serde_json::to_string(&design).unwrap();
        assert_eq!(serde_json::from_str::<Design>(&text).unwrap(), design, "a stored design reads back");
        design.digest().unwrap()
    };
    let down = [0.0, 0.0, -1.0];
    let mut digests = vec![
        digest(&|_| ()),
        digest(&|own| own.face_height = None),
        digest(&|own| own.settle = true),
        digest(&|own| own.fixed_placement.facing = down),
        digest(&|own| own.moving_placement.facing = down),
        digest(&|own| own.fixed_placement.rotate[0] = 1.0),
        digest(&|own| own.fixed_placement.translate[0] = 1.0),
        digest(&|own| own.drawn = DrawnFrames::Assembled { approach: down, face_center: None }),
        digest(&|own| own.drawn = DrawnFrames::Assembled { approach: [1.0, 0.0, 0.0], face_center: None }),
        digest(&|own| own.drawn = DrawnFrames::Assembled { approach: down, face_center: Some([0.0; 3]) }),
    ];
    let all = digests.len();
    digests.sort_unstable();
    digests.dedup();
    assert_eq!(digests.len(), all);
}

/// A funnel of twelve sides with a flat floor and its plug, docked in one frame, in mm on a width of 50; every corner has an error of up to 0.05 mm in x,
/// y and z.
fn noisy_funnel(seed: u64, settle: bool) -> SourceText {
    const SIDES: usize = 12;
    let mut random = seed;
    let mut solid = |rings: &[[f64; 2]]| {
        let mut text = String::new();
        let mut first = vec![];
        let mut count = 0;
        for [radius, z] in rings {
            first.push(count + 1);
            let corners = if *radius > 0.0 { SIDES } else { 1 };
            for k in 0..corners {
                let a = TAU * k as f64 / SIDES as f64;
                let point = [radius * a.cos(), radius * a.sin(), *z].map(|x| {
                    // Knuth's linear congruential generator.
                    random = random
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    x + 0.05 * ((random >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
                });
                let _ = writeln!(text, "v {:.6} {:.6} {:.6}", point[0], point[1], point[2]);
            }
            count += corners;
        }
        for (k, pair) in rings.windows(2).enumerate() {
            for j in 0..SIDES {
                let at =
                    |ring: usize, j: usize| first[ring] + if rings[ring][0] > 0.0 { j % SIDES } else { 0 };
                let [a, b, c, d] = [at(k, j), at(k, j + 1), at(k + 1, j), at(k + 1, j + 1)];
                if pair[0][0] > 0.0 {
                    let _ = writeln!(text, "f {a} {b} {}", if pair[1][0] > 0.0 { d } else { c });
                }
                if pair[1][0] > 0.0 {
                    let _ = writeln!(text, "f {a} {d} {c}");
                }
            }
        }
        text.into_bytes()
    };
    let fixed = solid(&[[0., -10.], [30., -10.], [30., 20.], [25., 20.], [5., 0.], [0., 0.]]);
    let moving = solid(&[[0., 0.], [5., 0.], [25., 20.], [25., 25.], [0., 25.]]);
    let text = format!(
        "[connector]\nunit = \"mm\"\nwidth = 50\ndrawn = \"assembled\"\napproach = \"-z\"\nsettle = {settle}\n\
         fixed = {{ mesh = \"fixed.obj\", unit = \"mm\" }}\nmoving = {{ mesh = \"moving.obj\", unit = \"mm\" }}\n\
         [alignment]\nfree = [\"x\", \"y\", \"roll\", \"pitch\"]\ndont_care = [\"yaw\"]\ncenter_of_rotation = 0.3\n\
         [errors]\nx = \"5 mm\"\ny = \"5 mm\"\nroll = \"10 deg\"\npitch = \"10 deg\"\n"
    );
    SourceText::new("funnel.toml", text)
        .with_files([("fixed.obj".into(), fixed), ("moving.obj".into(), moving)])
}

/// Scanned halves do not rest exactly as drawn: a run returns a result, or refuses with the distance to the rest and the remedy, and never returns a Sum of 0.
/// With the remedy every run returns a result.
#[test]
fn a_noisy_mesh_has_a_result_or_reports_its_rest() {
    let quick =
        Run { over: Over::Grid(Resolution::uniform(3).unwrap()), sample: Sample::None, ..Run::default() };
    let sum = |problem: &Problem| {
        let answer = quick.on(problem, &Exec::new()).map_err(|error| error.to_string())?;
        Ok::<f64, String>(Report::of_answer(&answer).acceptance.sum)
    };
    let mut refused = 0;
    for seed in 0..8 {
        let drawn = Draft::read(noisy_funnel(seed, false)).and_then(Draft::build).unwrap();
        match sum(&drawn) {
            Ok(sum) => assert!(sum > 0.0, "{seed}"),
            Err(message) => {
                refused += 1;
                let says = |text: &str| assert!(message.contains(text), "{seed}: {message}");
                says("Released without an error the half comes to rest ");
                says(" mm and ");
                says(" deg away, ");
                says("settle = true in [connector]");
                assert_eq!(drawn.checked().unwrap_err().to_string(), message);
            }
        }
        let settled = Draft::read(noisy_funnel(seed, true)).and_then(Draft::build).unwrap();
        assert!(sum(&settled).unwrap() > 0.0, "{seed}");
    }
    assert!(refused > 0);
}
