//! Halves made of parts: the same heights as the same solids in other representations, and a kinematic coupling against its
//! closed form.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::connector::{Connector, FileBytes, Half, stl};
use catchment::contact::{Pair, brute};
use catchment::design::{
    ConnectorSpec, FileSpec, FileUnit, HalfSpec, LengthUnit, OutlineSpec, OwnSpec, PartSpec, ShapeSpec,
};
use catchment::method::descent::{DescentSettings, Follower};
use catchment::method::zraa;
use catchment::pose::CorPose;
use catchment::prelude::*;
use catchment::report::CheckReport;
use glam::{DAffine3, DMat3};
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};
use std::path::Path;

const COR: f64 = 0.3;
/// About five facets per turn: coarse, so that the corners fit into a convex piece.
const COARSE: f64 = 0.02;

fn design(fixed: HalfSpec, moving: HalfSpec) -> Design {
    let alignment = Alignment { center_of_rotation: COR, ..Alignment::new(DofSet::ALL, Mount::X) };
    let connector = ConnectorSpec::Own(OwnSpec::new(0.35, fixed, moving));
    Design { name: "parts".into(), connector, width: 1.0, unit: None, alignment }
}

/// Files by their names.
type Files<'a> = &'a [(&'a str, Vec<u8>)];

fn connector(design: &Design, files: Files<'_>) -> Connector {
    let read = |path: &Path, _| {
        let (_, bytes) = files.iter().find(|(name, _)| Path::new(name) == path).unwrap();
        Ok(FileBytes::whole(bytes.clone()))
    };
    Connector::build_with(design, &read).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn pair(fixed: HalfSpec, moving: HalfSpec, files: Files<'_>) -> Pair {
    let design = design(fixed, moving);
    Pair::new(&connector(&design, files), &design.alignment)
}

/// A pyramid socket as four wedges.
fn socket() -> HalfSpec {
    let (h, b) = (0.7, -0.25);
    let rim = [[0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]];
    let wedge = |k: usize| {
        let ([px, py], [qx, qy]) = (rim[k], rim[(k + 1) % 4]);
        vec![[0.0, 0.0, 0.0], [0.0, 0.0, b], [px, py, b], [qx, qy, b], [px, py, h], [qx, qy, h]]
    };
    HalfSpec::Pieces((0..4).map(wedge).collect())
}

/// Poses spread over the error box.
fn poses(count: u32) -> impl Iterator<Item = CorPose> {
    let spread = |k: u32, step: f64, half: f64| ((f64::from(k) * step).fract() * 2.0 - 1.0) * half;
    (1..=count).map(move |k| {
        let error = PoseError {
            x: spread(k, 0.834_5, 0.6),
            y: spread(k, 0.696_4, 0.6),
            roll: spread(k, 0.581_1, 1.0),
            pitch: spread(k, 0.484_9, 1.0),
            yaw: spread(k, 0.404_7, 1.5),
        };
        CorPose::from_error(&error, COR, DofSet::ALL)
    })
}

/// Largest difference of the heights of two pairs.
fn difference(a: &Pair, b: &Pair) -> f64 {
    let mut met = 0;
    let mut apart = |pose: CorPose| match (a.height(&pose), b.height(&pose)) {
        (Some(a), Some(b)) => {
            met += 1;
            (a - b).abs()
        }
        (None, None) => 0.0,
        _ => f64::INFINITY,
    };
    let largest = poses(150).map(&mut apart).fold(0.0, f64::max);
    assert!(met > 50, "{met}");
    largest
}

fn parts(list: impl IntoIterator<Item = PartSpec>) -> HalfSpec {
    HalfSpec::Parts(list.into_iter().collect())
}

fn moved(points: &[DVec3], by: &DAffine3) -> Vec<[f64; 3]> {
    points.iter().map(|p| by.transform_point3(*p).to_array()).collect()
}

/// The corners of the solid that a single part becomes.
fn corners(shape: &ShapeSpec) -> Vec<DVec3> {
    // Wide enough for a half.
    let wide = PartSpec::new(ShapeSpec::Box { size: [1.0, 1.0, 0.1] }, [0.0, 0.0, -5.0]);
    let half = parts([PartSpec::new(shape.clone(), [0.0; 3]), wide]);
    connector(&design(half, socket()), &[]).fixed.surfaces[0]
        .vertices
        .iter()
        .map(|p| *p + DVec3::Z * 0.35)
        .collect()
}

/// Turned, moved and upright: a ball, a cylinder, a cone, a truncated cone, a box and a prism are the convex hulls of their
/// corners.
#[test]
fn primitives_equal_the_hulls_of_their_corners() {
    let hexagon: Vec<[f64; 2]> = (0..6)
        .map(|k| DVec3::from((glam::DVec2::from_angle(f64::from(k) * 1.047) * 0.2, 0.0)))
        .map(|p| [p.x, p.y])
        .collect();
    let shapes = [
        ShapeSpec::Sphere { radius: 0.06, chord_error: COARSE },
        ShapeSpec::Cone { radius: 0.2, top_radius: 0.2, height: 0.5, chord_error: COARSE },
        ShapeSpec::Cone { radius: 0.3, top_radius: 0.1, height: 0.4, chord_error: COARSE },
        ShapeSpec::Cone { radius: 0.3, top_radius: 0.0, height: 0.4, chord_error: COARSE },
        ShapeSpec::Box { size: [0.3, 0.4, 0.5] },
        ShapeSpec::Profile { outline: OutlineSpec::Corners(hexagon), height: 0.6, chord_error: COARSE },
    ];
    let plate = || PartSpec::new(ShapeSpec::Box { size: [0.5, 0.5, 0.1] }, [0.0, 0.0, -0.2]);
    for shape in shapes {
        let own = corners(&shape);
        for (axis, rotate, at) in [
            ([0.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, 0.1]),
            ([1.0, 0.0, 0.0], [0.0; 3], [-0.2, 0.0, 0.1]),
            ([0.6, 0.0, 0.8], [0.1, -0.7, 2.0], [0.1, -0.1, 0.2]),
        ] {
            let place = DAffine3 {
                matrix3: DMat3::from_rotation_z(rotate[2])
                    * DMat3::from_rotation_y(rotate[1])
                    * DMat3::from_rotation_x(rotate[0])
                    * DMat3::from_quat(glam::DQuat::from_rotation_arc(DVec3::Z, DVec3::from_array(axis))),
                translation: DVec3::from_array(at),
            };
            let part = PartSpec { shape: shape.clone(), axis, rotate, at };
            let pieces = vec![
                moved(&own, &place),
                moved(&corners(&plate().shape), &DAffine3::from_translation(DVec3::new(0.0, 0.0, -0.2))),
            ];
            let as_parts = pair(socket(), parts([plate(), part]), &[]);
            let as_pieces = pair(socket(), HalfSpec::Pieces(pieces), &[]);
            // A hull treats points closer than 1e-9 of its size as coplanar.
            let apart = difference(&as_parts, &as_pieces);
            assert!(apart < 1e-8, "{shape:?} {axis:?}: {apart}");
        }
    }
}

fn stl_of(half: &Half) -> Vec<u8> {
    let mut bytes = Vec::new();
    stl::write(half, stl::StlEncoding::Ascii, &mut bytes).unwrap();
    bytes
}

/// The family's halves, drawn facing up.
fn pyramid() -> [Half; 2] {
    let family = Connector::of_family(&FamilySpec::new(Family::Pyramid), Mount::X).unwrap();
    [family.fixed, family.moving.mapped(|p| Mount::X.apply(p))]
}

fn threemf_of(half: &Half, unit: &str) -> Vec<u8> {
    let (mut objects, mut items) = (String::new(), String::new());
    for (k, surface) in half.surfaces.iter().enumerate() {
        write!(objects, "<object id=\"{k}\"><mesh><vertices>").unwrap();
        for DVec3 { x, y, z } in &surface.vertices {
            write!(objects, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>").unwrap();
        }
        objects.push_str("</vertices><triangles>");
        for [a, b, c] in surface.triangles() {
            write!(objects, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>").unwrap();
        }
        objects.push_str("</triangles></mesh></object>");
        write!(items, "<item objectid=\"{k}\"/>").unwrap();
    }
    let space = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
    let model = format!(
        "<model unit=\"{unit}\" xmlns=\"{space}\"><resources>{objects}</resources><build>{items}</build></model>"
    );
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    archive.start_file("3D/3dmodel.model", zip::write::SimpleFileOptions::default()).unwrap();
    archive.write_all(model.as_bytes()).unwrap();
    archive.finish().unwrap().into_inner()
}

/// The same halves, as STL and as 3MF with its own unit.
#[test]
fn a_3mf_is_the_same_half_in_its_own_unit() {
    let [fixed, moving] = pyramid();
    let in_inches = |half: &Half| half.mapped(|p| p * 2.0);
    let files = [
        ("a.stl", stl_of(&fixed)),
        ("b.stl", stl_of(&moving)),
        ("a.3mf", threemf_of(&in_inches(&fixed), "inch")),
        ("b.3mf", threemf_of(&in_inches(&moving), "inch")),
    ];
    let mesh = |name: &str, scale, unit| HalfSpec::Mesh(FileSpec { unit, ..FileSpec::new(name, scale) });
    let plain = pair(mesh("a.stl", 1.0, FileUnit::Beside), mesh("b.stl", 1.0, FileUnit::Beside), &files);
    // D is 2 in; where the file has a unit, the scale is that of a metre.
    let own = |name| mesh(name, 1.0 / (2.0 * 0.0254), FileUnit::InFile);
    let result = pair(own("a.3mf"), own("b.3mf"), &files);
    assert!(difference(&plain, &result) < 1e-12);
    let stated = |name, unit| mesh(name, 0.5, FileUnit::Stated(unit));
    let same = pair(stated("a.3mf", LengthUnit::In), stated("b.3mf", LengthUnit::In), &files);
    assert!(difference(&plain, &same) < 1e-12);
    let wrong = design(stated("a.3mf", LengthUnit::Mm), stated("b.3mf", LengthUnit::Mm));
    let read = |path: &Path, _| {
        Ok(FileBytes::whole(files.iter().find(|(name, _)| Path::new(name) == path).unwrap().1.clone()))
    };
    let problems = Connector::build_with(&wrong, &read).unwrap_err();
    assert!(problems[0].to_string().contains("its unit is in, and the design says mm"), "{}", problems[0]);
    // Without a unit in the design, the scale is that of the file's numbers.
    let bare = pair(mesh("a.3mf", 0.5, FileUnit::Beside), mesh("b.3mf", 0.5, FileUnit::Beside), &files);
    assert!(difference(&plain, &bare) < 1e-12);
}

/// A non-convex mesh, overlapped by a ball and a pin: the part list, the definition and one file with all bodies agree.
#[test]
fn a_mesh_with_primitives_has_the_heights_of_the_definition() {
    let [fixed, moving] = pyramid();
    let ball = |z| PartSpec::new(ShapeSpec::Sphere { radius: 0.1, chord_error: COARSE }, [0.3, 0.1, z]);
    let pin = || {
        let cylinder = ShapeSpec::Cone { radius: 0.05, top_radius: 0.05, height: 0.6, chord_error: 0.005 };
        PartSpec { rotate: [0.3, 0.2, 0.0], ..PartSpec::new(cylinder, [-0.2, -0.3, -0.2]) }
    };
    let files = [("a.stl", stl_of(&fixed)), ("b.stl", stl_of(&moving))];
    let mesh = |name: &str| PartSpec::new(ShapeSpec::Mesh(FileSpec::new(name, 1.0)), [0.0; 3]);
    let fixed_parts = || parts([mesh("a.stl"), ball(0.08), pin()]);
    let moving_parts = || parts([mesh("b.stl"), ball(-0.05)]);
    let own = pair(fixed_parts(), moving_parts(), &files);
    for pose in poses(60) {
        match (own.height(&pose), brute::height(&own, &pose)) {
            // Sums of products of numbers near 1.
            (Some(fast), Some(slow)) => assert!((fast - slow).abs() < 1e-11, "{fast} {slow}"),
            (fast, slow) => assert_eq!(fast.is_some(), slow.is_some()),
        }
    }
    // All bodies of a half in one file: united where they cross.
    let built = connector(&design(fixed_parts(), moving_parts()), &files);
    let up = |p: DVec3| p + DVec3::Z * 0.35;
    let drawn = [built.fixed.mapped(up), built.moving.mapped(|p| up(Mount::X.apply(p)))];
    let [fixed, moving] = drawn.map(|half| stl_of(&Half::of(half.solids().to_vec())));
    let united = [("u.stl", fixed), ("v.stl", moving)];
    let one = |name: &str| HalfSpec::Mesh(FileSpec::new(name, 1.0));
    assert!(difference(&own, &pair(one("u.stl"), one("v.stl"), &united)) < 1e-6);
    let contents = connector(&design(one("u.stl"), one("v.stl")), &united).contents;
    assert!(contents.fixed[0].repairs.united > 0 && contents.moving[0].repairs.united > 0, "{contents:?}");
}

/// Every change of a part changes the digest.
#[test]
fn every_change_of_a_part_changes_the_digest() {
    let files = [("a.svg", b"<svg><circle r='1'/></svg>".to_vec()), ("a.stl", stl_of(&pyramid()[0]))];
    let digest = |part: PartSpec| {
        let design =
            design(socket(), parts([PartSpec::new(ShapeSpec::Box { size: [1.0; 3] }, [0.0; 3]), part]));
        let design = design.clone().with_contents(&connector(&design, &files).contents);
        let text = serde_json::to_string(&design).unwrap();
        assert_eq!(serde_json::from_str::<Design>(&text).unwrap(), design, "a stored design reads back");
        design.digest().unwrap()
    };
    let cone =
        |radius, top_radius, height, chord_error| ShapeSpec::Cone { radius, top_radius, height, chord_error };
    let corners = |x| OutlineSpec::Corners(vec![[0.0, 0.0], [x, 0.0], [0.0, 1.0]]);
    let drawing = |scale| OutlineSpec::File(FileSpec::new("a.svg", scale));
    let profile = |outline, height, chord_error| ShapeSpec::Profile { outline, height, chord_error };
    let mesh = |scale, unit| ShapeSpec::Mesh(FileSpec { unit, ..FileSpec::new("a.stl", scale) });
    let plain = |shape| PartSpec::new(shape, [0.0; 3]);
    let cube = || ShapeSpec::Box { size: [0.5; 3] };
    let all = [
        plain(cube()),
        plain(ShapeSpec::Box { size: [0.5, 0.5, 0.4] }),
        PartSpec::new(cube(), [0.0, 0.1, 0.0]),
        PartSpec { axis: [1.0, 0.0, 0.0], ..plain(cube()) },
        PartSpec { rotate: [1.0, 0.0, 0.0], ..plain(cube()) },
        plain(ShapeSpec::Sphere { radius: 0.3, chord_error: 0.02 }),
        plain(ShapeSpec::Sphere { radius: 0.3, chord_error: 0.01 }),
        plain(ShapeSpec::Sphere { radius: 0.2, chord_error: 0.02 }),
        plain(cone(0.3, 0.2, 0.1, 0.01)),
        plain(cone(0.4, 0.2, 0.1, 0.01)),
        plain(cone(0.3, 0.1, 0.1, 0.01)),
        plain(cone(0.3, 0.2, 0.2, 0.01)),
        plain(cone(0.3, 0.2, 0.1, 0.02)),
        plain(profile(corners(1.0), 1.0, 0.1)),
        plain(profile(corners(0.5), 1.0, 0.1)),
        plain(profile(corners(1.0), 0.5, 0.1)),
        plain(profile(drawing(0.5), 0.5, 0.1)),
        plain(profile(drawing(0.5), 0.5, 0.05)),
        plain(profile(drawing(0.25), 0.5, 0.05)),
        plain(mesh(1.0, FileUnit::Beside)),
        plain(mesh(0.5, FileUnit::Beside)),
        plain(ShapeSpec::Pieces(vec![vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]])),
    ];
    let mut digests: Vec<_> = all.iter().cloned().map(digest).collect();
    digests.sort_unstable();
    digests.dedup();
    assert_eq!(digests.len(), all.len());
}

/// Three balls of radius r in V grooves of 90° and half width h: at rest r √2 above the bottoms of the grooves. Without rotation errors they
/// find their seats while each ball's centre is above its groove, which is a hexagon of area 2 √3 h².
#[test]
fn balls_in_grooves_are_a_kinematic_coupling() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/kelvin-balls.toml");
    let problem = Problem::open(path).unwrap();
    assert_eq!(problem.mated_warnings(), []);
    let drawing = CheckReport::good(&problem).drawing.unwrap();
    let apart = drawing.fixed.face_center[2] + drawing.moving.face_center[2];
    // The bottoms of the grooves are at −5 mm, the centres of the balls at 8 mm; facets lie inside the balls by up to 0.06 mm.
    let expected = 6.0 * 2f64.sqrt() - 5.0 + 8.0;
    assert!(apart < expected + 1e-9 && apart > expected - 0.06 * 2f64.sqrt(), "{apart} {expected}");
    let lateral = problem.design().clone().with_free([Dof::X, Dof::Y].into_iter().collect()).unwrap();
    let lateral = problem.with(lateral).unwrap();
    let zraa = zraa::run(lateral.pair(), &zraa::ZraaSettings::default(), &Exec::new()).unwrap();
    let hexagon = 2.0 * 3f64.sqrt() * (5.0f64 / 60.0).powi(2);
    let zraa::Zraa::Region { area, .. } = zraa else { panic!("both offsets are free") };
    // The lowest corner of each ball is on its axis, so that the facets change nothing.
    assert!((area / hexagon - 1.0).abs() < 1e-6, "{area} {hexagon}");
}

/// Faceted balls in grooves: within a long step, facet planes beside a ball stop it, where shorter steps continue. That made 22 % of these poses jam.
#[test]
fn balls_of_facets_do_not_rest_on_planes_beside_them() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/kelvin-balls.toml");
    let problem = Problem::open(path).unwrap();
    let settings = DescentSettings::default();
    let fine = DescentSettings { step: settings.step / 4.0, ..settings.clone() };
    let (mut followers, mut differ) =
        ([&settings, &fine].map(|settings| Follower::new(problem.pair(), settings)), 0);
    // Halton points of the bases 2, 3, 5, 7 and 11, in ±0.1 D and ±0.2 rad.
    let halton = |base: u32, mut k: u32| {
        let (mut value, mut share) = (0.0, 1.0);
        while k > 0 {
            share /= f64::from(base);
            value += share * f64::from(k % base);
            k /= base;
        }
        2.0 * value - 1.0
    };
    for k in 1..=200 {
        let [x, y, roll, pitch, yaw] = [2, 3, 5, 7, 11].map(|base| halton(base, k));
        let error =
            PoseError { x: 0.1 * x, y: 0.1 * y, roll: 0.2 * roll, pitch: 0.2 * pitch, yaw: 0.2 * yaw };
        let [coarse, fine] = followers.each_mut().map(|follower| follower.follow(&error).outcome);
        differ += usize::from(coarse != fine);
    }
    assert!(differ <= 12, "{differ} of 200 outcomes differ with a quarter of the step");
}
