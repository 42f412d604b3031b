//! Parts at arbitrary poses, and the design proposed for them: it has the same seat and the same heights as the original design.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::connector::{Half, Surface, convex_hull, stl};
use catchment::design::LengthUnit;
use catchment::pose::CorPose;
use catchment::prelude::*;
use catchment::proposal::{
    PartDetail, PartFile, PartFrames, PartLayout, Proposal, ProposalError, ProposalSettings, propose,
};
use glam::{DAffine3, DMat3, DVec2};
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::Path;

/// D of the parts in their files, in mm.
const WIDTH: f64 = 40.0;

/// As two files, or as one assembly.
const BOTH: [PartFrames; 2] = [PartFrames::Facing, PartFrames::Any];

/// Pseudorandom numbers.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A frame turned by right angles and translated at random, in mm.
    fn frame(&mut self) -> DAffine3 {
        let mut quarters = || f64::from((self.next() * 4.0) as u32) * FRAC_PI_2;
        let turn = DMat3::from_rotation_z(quarters())
            * DMat3::from_rotation_y(quarters())
            * DMat3::from_rotation_x(quarters());
        let turn = DMat3::from_cols_array(&turn.to_cols_array().map(f64::round));
        let mut far = || (self.next() - 0.5) * 300.0;
        DAffine3 { matrix3: turn, translation: DVec3::new(far(), far(), far()) }
    }
}

fn write(folder: &Path, name: &str, half: &Half, frame: &DAffine3) -> PartFile {
    let scaled = |surface: &Surface| {
        let mut surface = surface.clone();
        surface.vertices.iter_mut().for_each(|p| *p *= WIDTH);
        surface
    };
    let scaled = Half::of(half.surfaces.iter().map(scaled).collect());
    let mut bytes = Vec::new();
    stl::write(&scaled.mapped(|p| frame.transform_point3(p)), stl::StlEncoding::Ascii, &mut bytes).unwrap();
    fs::write(folder.join(name), bytes).unwrap();
    PartFile { path: folder.join(name), written: name.to_owned(), body: None }
}

fn problem(text: &str) -> Problem {
    let designs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/d.toml");
    Draft::read(catchment::design::SourceText::new(designs, text)).unwrap().build().unwrap()
}

fn family(name: &str, more: &str) -> Problem {
    problem(&format!("[connector]\nfamily = \"{name}\"\n{more}\n"))
}

/// Largest difference of the heights over lateral offsets, in D of `a`, for the best of four quarter turns.
fn difference(a: &Problem, b: &Problem) -> f64 {
    let rotation = DMat3::IDENTITY;
    let ratio = WIDTH / b.design().width;
    let climb = |problem: &Problem, lateral: DVec2| {
        let height = problem.pair().height(&CorPose { lateral, rotation });
        height.map_or(f64::INFINITY, |height| height - problem.pair().mated_height())
    };
    let offsets: Vec<DVec2> =
        (1..40).map(|k| DVec2::from_angle(2.4 * f64::from(k)) * 0.3 * (f64::from(k) / 40.0).sqrt()).collect();
    let seen = |turn: DVec2| {
        let off = |o: &DVec2| (climb(a, *o) - climb(b, turn.rotate(*o) * ratio) / ratio).abs();
        offsets.iter().map(off).fold(0.0, f64::max)
    };
    [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y].into_iter().map(seen).fold(f64::INFINITY, f64::min)
}

fn settings(frames: PartFrames) -> ProposalSettings {
    ProposalSettings { frames, unit: Some(LengthUnit::Mm), ..ProposalSettings::default() }
}

fn proposed(parts: &[PartFile; 2], folder: &Path, settings: &ProposalSettings) -> Proposal {
    let result = propose(parts, settings, &folder.join("design.toml"), &Exec::new());
    result.unwrap_or_else(|error| panic!("{error}"))
}

/// Throws the halves of a design, proposes a design in each of these frames, and compares the heights.
fn comes_back(truth: &Problem, width: Option<f64>, tolerance: f64, seed: u64, frames: &[PartFrames]) {
    let wanted = frames;
    let mut dice = Dice(seed);
    let folder = tempfile::tempdir().unwrap();
    let (connector, mount) = (truth.connector(), truth.alignment().mount);
    let upright = connector.moving.mapped(|p| mount.apply(p));
    for round in 0..2 {
        let frames = [dice.frame(), dice.frame()];
        let apart = [
            write(folder.path(), "fixed.stl", &connector.fixed, &frames[0]),
            write(folder.path(), "moving.stl", &upright, &frames[1]),
        ];
        let docked = [
            write(folder.path(), "a.stl", &connector.fixed, &frames[0]),
            write(folder.path(), "b.stl", &connector.moving, &frames[0]),
        ];
        for (parts, frames) in [(apart, PartFrames::Facing), (docked, PartFrames::Any)] {
            if !wanted.contains(&frames) {
                continue;
            }
            let result = proposed(&parts, folder.path(), &settings(frames));
            let name = &truth.design().name;
            assert_eq!(
                matches!(result.candidates[0].lie, PartLayout::Assembled { .. }),
                frames == PartFrames::Any,
                "{name}: {}",
                result.candidates[0].lie
            );
            let off = difference(truth, &result.problem);
            assert!(
                off < tolerance,
                "{name}, round {round}: {off}\n{:?}\n{}",
                result.candidates,
                result.text
            );
            if let Some(width) = width {
                let result = result.problem.design().width;
                assert!((result - width * WIDTH).abs() < 1e-4, "{name}: {result}");
            }
        }
    }
}

#[test]
fn a_pyramid_is_recovered() {
    comes_back(&family("pyramid", ""), Some(1.0), 1e-6, 1, &BOTH);
}

#[test]
fn a_spatial_x_face_is_recovered() {
    comes_back(&family("x-face-3d", ""), Some(1.0), 1e-6, 2, &BOTH);
}

#[test]
fn pins_are_recovered() {
    // The seat has play: the proposal puts the part in its middle, to the accuracy to which the play is
    // known.
    comes_back(&family("pin-hole", "chord_error = 0.01\nclearance = 0.02"), None, 1e-3, 3, &BOTH);
}

#[test]
fn a_cone_is_recovered_and_its_yaw_does_not_matter() {
    let truth = family("cone", "chord_error = 0.01");
    comes_back(&truth, None, 1e-3, 4, &BOTH);
    let folder = tempfile::tempdir().unwrap();
    let mount = truth.alignment().mount;
    let parts = [
        write(folder.path(), "a.stl", &truth.connector().fixed, &DAffine3::IDENTITY),
        write(
            folder.path(),
            "b.stl",
            &truth.connector().moving.mapped(|p| mount.apply(p)),
            &DAffine3::IDENTITY,
        ),
    ];
    let result = proposed(&parts, folder.path(), &settings(PartFrames::Facing));
    assert_eq!(result.problem.alignment().dont_care, DofSet::EMPTY.with(Dof::Yaw));
}

/// As an assembly: from the two files alone the balls could as well hang between the blocks, where they rest more stably.
#[test]
fn balls_in_grooves_are_recovered() {
    let text =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/kelvin-balls.toml"));
    let text =
        text.unwrap().replace("sphere = { radius = 6 }", "sphere = { radius = 6 }\nchord_error = 0.05");
    comes_back(&problem(&text), None, 1e-4, 5, &[PartFrames::Any]);
}

/// A peg that rattles in its tray, by more play than a seat may have undeclared. A direction bounded by walls is free, and the play is the docking
/// tolerance.
#[test]
fn a_half_loose_between_walls_docks_within_the_play() {
    let (peg, hole, outside) = (DVec2::new(0.2, 0.17), DVec2::new(0.23, 0.2), 0.6);
    let hull = |points: Vec<DVec3>| convex_hull(&points).unwrap();
    let ring = |size: DVec2, z: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| DVec3::new(x * size.x, y * size.y, z))
    };
    // Four walls around the hole, chamfered at their tops, on a floor.
    let wall = |k: usize| {
        let edge = |size: DVec2, z: f64| [ring(size, z)[k], ring(size, z)[(k + 1) % 4]];
        let (all, rim) = (DVec2::splat(outside), hole + DVec2::splat(0.06));
        hull([edge(hole, 0.0), edge(hole, 0.54), edge(rim, 0.6), edge(all, 0.0), edge(all, 0.6)].concat())
    };
    let floor = hull([ring(DVec2::splat(outside), -0.2), ring(DVec2::splat(outside), 0.0)].concat());
    let fixed = Half::union_of((0..4).map(wall).chain([floor]).collect()).unwrap();
    let moving = Half::of(vec![hull([ring(peg, 0.0), ring(peg, 1.2)].concat())]);
    let folder = tempfile::tempdir().unwrap();
    let frame = DAffine3::IDENTITY;
    let parts =
        [write(folder.path(), "tray.stl", &fixed, &frame), write(folder.path(), "peg.stl", &moving, &frame)];
    let result = proposed(&parts, folder.path(), &settings(PartFrames::Any));
    let alignment = result.problem.alignment();
    assert_eq!(alignment.free, DofSet::ALL, "{}", result.text);
    // Its play in D, to two digits; straight or turned.
    let width = result.problem.design().width / WIDTH;
    let limit = |dof: Dof| alignment.docked.limit(dof).unwrap();
    assert!((0.03..0.034).contains(&(limit(Dof::X) * width)), "{}", result.text);
    assert!((0.03..0.036).contains(&(limit(Dof::Y) * width)), "{}", result.text);
    assert!((5.0..30.0).contains(&limit(Dof::Yaw).to_degrees()), "{}", result.text);
    assert_eq!(alignment.docked.limit(Dof::Pitch), None);
}

/// Ungendered: the same file twice.
#[test]
fn the_same_part_twice_is_a_pair() {
    let truth = family("x-face-3d", "");
    let folder = tempfile::tempdir().unwrap();
    let part = write(folder.path(), "a.stl", &truth.connector().fixed, &Dice(7).frame());
    let result = proposed(&[part.clone(), part], folder.path(), &settings(PartFrames::Facing));
    let off = difference(&truth, &result.problem);
    assert!(off < 1e-6, "{off}\n{}", result.text);
    assert!(result.problem.connector().ungendered(Mount::X));
}

/// The proposal does not search for given values, and refuses wrong ones.
#[test]
fn a_pinned_choice_is_kept() {
    let truth = family("pyramid", "");
    let folder = tempfile::tempdir().unwrap();
    let upright = truth.connector().moving.mapped(|p| Mount::X.apply(p));
    let parts = [
        write(folder.path(), "a.stl", &truth.connector().fixed, &DAffine3::IDENTITY),
        write(folder.path(), "b.stl", &upright, &DAffine3::IDENTITY),
    ];
    let ways = |fixed: &str, moving: &str| ProposalSettings {
        facing: [Some(fixed.parse().unwrap()), Some(moving.parse().unwrap())],
        free: Some(DofSet::EMPTY.with(Dof::X).with(Dof::Y)),
        name: Some("a \"pair\"".to_owned()),
        ..settings(PartFrames::Any)
    };
    let result = proposed(&parts, folder.path(), &ways("+z", "+z"));
    assert_eq!(result.problem.design().name, "a \"pair\"");
    assert_eq!(result.problem.alignment().free.len(), 2);
    assert!(result.text.contains("facing = \"+z\""), "{}", result.text);
    let refused =
        propose(&parts, &ways("-z", "-z"), &folder.path().join("d.toml"), &Exec::new()).unwrap_err();
    assert!(matches!(refused, ProposalError::NoSeat { .. }), "{refused}");
}

#[test]
fn a_missing_unit_is_requested() {
    let truth = family("pyramid", "");
    let folder = tempfile::tempdir().unwrap();
    let part = write(folder.path(), "a.stl", &truth.connector().fixed, &DAffine3::IDENTITY);
    let parts = [part.clone(), part];
    let refused = propose(&parts, &ProposalSettings::default(), &folder.path().join("d.toml"), &Exec::new())
        .unwrap_err();
    assert!(matches!(&refused, ProposalError::NoUnit { guess: LengthUnit::Mm, .. }), "{refused}");
    assert!(refused.to_string().contains("the part is 40 × 40 × "), "{refused}");
}

/// A plate alone has no seat in a hollow; with the purchased ball it has one.
#[test]
fn a_bought_ball_is_part_of_a_half() {
    let folder = tempfile::tempdir().unwrap();
    let hollow = family("pyramid", "");
    let mut dice = Dice(11);
    let fixed = write(folder.path(), "hollow.stl", &hollow.connector().fixed, &dice.frame());
    let corner = |k: usize| {
        let sign = |bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
        DVec3::new(0.5 * sign(0), 0.5 * sign(1), 0.1 * f64::from(k >> 2 & 1 == 1))
    };
    let plate = Half::of(vec![convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()]);
    // In its file the plate faces +x.
    let frame = DAffine3 {
        matrix3: DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X),
        translation: DVec3::new(30.0, -7.0, 12.0),
    };
    let moving = write(folder.path(), "plate.stl", &plate, &frame);
    let parts = [fixed, moving];
    let alone = propose(&parts, &settings(PartFrames::Facing), &folder.path().join("d.toml"), &Exec::new());
    assert!(matches!(alone, Err(ProposalError::NoSeat { .. })), "{alone:?}");
    let ball = "{ sphere = { radius = 8 }, at = [38, -7, 12] }".to_owned();
    let with = [Vec::new(), vec![PartDetail::Part(ball.clone())]];
    let result = proposed(&parts, folder.path(), &ProposalSettings { with, ..settings(PartFrames::Facing) });
    assert!(result.text.contains("parts = [") && result.text.contains(&ball), "{}", result.text);
    assert!(result.text.contains("facing = \"+x\""), "{}", result.text);
    let free = result.problem.alignment().free;
    assert!(free.contains(Dof::X) && free.contains(Dof::Y), "{free:?}");
    let off = PoseError { x: 0.2, y: -0.1, ..PoseError::default() };
    assert_eq!(result.problem.follow(&off).outcome, Outcome::Aligned);
    // A defect of a part is reported like a defect of a design.
    let with = [vec![PartDetail::Part("{ spere = { radius = 8 } }".to_owned())], Vec::new()];
    let wrong = ProposalSettings { with, ..settings(PartFrames::Facing) };
    let wrong = propose(&parts, &wrong, &folder.path().join("d.toml"), &Exec::new()).unwrap_err();
    assert!(matches!(wrong, ProposalError::Problem(_)) && format!("{wrong}").contains("spere"), "{wrong}");
    // The plate in two files is the same plate; a file without a unit is reported with its own size.
    let half = |shift: f64| {
        let corners: Vec<_> = (0..8).map(corner).map(|p| DVec3::new(0.5 * p.x + shift, p.y, p.z)).collect();
        Half::of(vec![convex_hull(&corners).unwrap()])
    };
    let first = write(folder.path(), "first \"half\".stl", &half(-0.24), &frame);
    let second = write(folder.path(), "second.stl", &half(0.24), &frame);
    let parts = [parts[0].clone(), first];
    let with = [Vec::new(), vec![PartDetail::File(second), PartDetail::Part(ball)]];
    let settings = ProposalSettings { with, ..settings(PartFrames::Facing) };
    let result = proposed(&parts, folder.path(), &settings);
    assert_eq!(result.problem.follow(&off).outcome, Outcome::Aligned);
    let nobody = ProposalSettings { unit: None, ..settings };
    let refused = propose(&parts, &nobody, &folder.path().join("d.toml"), &Exec::new()).unwrap_err();
    assert!(
        matches!(&refused, ProposalError::NoUnit { path, .. } if path.ends_with("hollow.stl")),
        "{refused}"
    );
}
