//! The pyramid pair as a family, as convex pieces and as STL files: the same heights.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::connector::{Connector, GeometryDefect, Half, HalfRole, stl};
use catchment::contact::{Pair, mated};
use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec, FileSpec, HalfSpec, OwnSpec};
use catchment::pose::{CorPose, DofSet, Mount, PoseError};
use std::fs::File;
use std::path::{Path, PathBuf};

const HEIGHT: f64 = 0.7;
const COR: f64 = 0.3;

fn design(connector: ConnectorSpec) -> Design {
    let alignment = Alignment { center_of_rotation: COR, ..Alignment::new(DofSet::ALL, Mount::X) };
    Design { name: "pyramid".into(), connector, width: 1.0, unit: None, alignment }
}

fn family() -> Design {
    let spec = FamilySpec::new(Family::Pyramid).with_aspect_ratio(HEIGHT);
    design(ConnectorSpec::Family(spec))
}

fn pair(design: &Design) -> Pair {
    let connector = Connector::build(design).unwrap_or_else(|e| panic!("{e:?}"));
    Pair::new(&connector, &design.alignment)
}

fn write(half: &Half, format: stl::StlEncoding, folder: &Path, name: &str, size: f64) -> PathBuf {
    let path = folder.join(name);
    stl::write(&half.mapped(|p| p * size), format, &mut File::create(&path).unwrap()).unwrap();
    path
}

/// Both halves as STL files in units with D equal to `size`.
fn meshes(format: stl::StlEncoding, folder: &Path, size: f64) -> Design {
    let connector = Connector::build(&family()).unwrap();
    let drawn = connector.moving.mapped(|p| Mount::X.apply(p));
    let mesh =
        |half, name| HalfSpec::Mesh(FileSpec::new(write(half, format, folder, name, size), 1.0 / size));
    let own = OwnSpec::new(0.0, mesh(&connector.fixed, "socket.stl"), mesh(&drawn, "plug.stl"));
    design(ConnectorSpec::Own(own))
}

/// The socket as four wedges and the plug as one pyramid.
fn pieces() -> Design {
    let (h, b) = (HEIGHT, -0.25);
    let rim = [[0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]];
    let wedge = |k: usize| {
        let ([px, py], [qx, qy]) = (rim[k], rim[(k + 1) % 4]);
        vec![[0.0, 0.0, 0.0], [0.0, 0.0, b], [px, py, b], [qx, qy, b], [px, py, h], [qx, qy, h]]
    };
    let plug = rim.iter().map(|[x, y]| [*x, *y, 0.0]).chain([[0.0, 0.0, h]]).collect();
    let own =
        OwnSpec::new(h / 2.0, HalfSpec::Pieces((0..4).map(wedge).collect()), HalfSpec::Pieces(vec![plug]));
    design(ConnectorSpec::Own(own))
}

/// Largest difference of the heights over poses spread over the error box.
fn difference(a: &Pair, b: &Pair) -> f64 {
    let spread = |k: u32, step: f64, half: f64| ((f64::from(k) * step).fract() * 2.0 - 1.0) * half;
    let mut largest = 0.0f64;
    let mut met = 0;
    for k in 1..200 {
        let error = PoseError {
            x: spread(k, 0.834_5, 0.8),
            y: spread(k, 0.696_4, 0.8),
            roll: spread(k, 0.581_1, 1.2),
            pitch: spread(k, 0.484_9, 1.2),
            yaw: spread(k, 0.404_7, 1.5),
        };
        let pose = CorPose::from_error(&error, COR, DofSet::ALL);
        match (a.height(&pose), b.height(&pose)) {
            (Some(a), Some(b)) => {
                met += 1;
                largest = largest.max((a - b).abs());
            }
            (None, None) => {}
            _ => largest = f64::INFINITY,
        }
    }
    assert!(met > 100);
    largest
}

#[test]
fn pieces_have_the_familys_heights() {
    // Rotations and a dozen products of numbers near 1.
    assert!(difference(&pair(&family()), &pair(&pieces())) < 1e-12);
}

#[test]
fn stl_files_have_the_familys_heights() {
    for format in [stl::StlEncoding::Ascii, stl::StlEncoding::Binary] {
        for size in [1.0, 50.0] {
            let folder = tempfile::tempdir().unwrap();
            let mesh = pair(&meshes(format, folder.path(), size));
            assert!(difference(&pair(&family()), &mesh) < 1e-6, "{format:?} {size}");
            assert_eq!(mated::problems(&mesh), []);
        }
    }
}

#[test]
fn all_problems_of_both_halves_come_at_once() {
    let own = OwnSpec::new(
        0.0,
        HalfSpec::Pieces(vec![vec![[0.0; 3]; 3], vec![[0.0, f64::NAN, 0.0]; 4]]),
        HalfSpec::Mesh(FileSpec::new("no/such.stl", 1.0)),
    );
    let problems = Connector::build(&design(ConnectorSpec::Own(own))).unwrap_err();
    let places: Vec<_> = problems
        .iter()
        .map(|p| match p {
            GeometryDefect::Piece { side, piece, .. } => (*side, Some(*piece)),
            GeometryDefect::Mesh { side, .. } => (*side, None),
            other => panic!("{other}"),
        })
        .collect();
    assert_eq!(places, [(HalfRole::Fixed, Some(0)), (HalfRole::Fixed, Some(1)), (HalfRole::Moving, None)]);
}

#[test]
fn a_mesh_in_the_wrong_unit_is_reported_with_advice() {
    let folder = tempfile::tempdir().unwrap();
    let mut design = meshes(stl::StlEncoding::Binary, folder.path(), 50.0);
    // 50 mm, read with a width D of 50 m.
    if let ConnectorSpec::Own(own) = &mut design.connector {
        for half in [&mut own.fixed, &mut own.moving] {
            if let HalfSpec::Mesh(file) = half {
                file.scale /= 1000.0;
            }
        }
    }
    let problems = Connector::build(&design).unwrap_err();
    assert_eq!(problems.len(), 2);
    assert!(
        problems[0].to_string().ends_with("check the mesh's unit and the design's width"),
        "{}",
        problems[0]
    );
}
