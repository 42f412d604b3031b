//! All kinds of defects of a file, and the families through both dialects.

use super::*;
use crate::mesh::{FileOffset, MAX_REPORTED, MAX_TRIANGLES, TriangleLocation};
use crate::{Surface, family};
use catchment_design::design::{Family, FamilySpec};
use glam::DVec3;
use proptest::prelude::*;
use std::fmt::Write as _;

fn bytes(half: &Half, format: StlEncoding) -> Vec<u8> {
    let mut out = Vec::new();
    write(half, format, &mut out).unwrap();
    out
}

/// The first surface of a file.
fn parse(bytes: &[u8]) -> Result<Surface, Vec<MeshProblem>> {
    from_bytes(bytes, bytes.len() as u64, 1.0).map(|mut half| half.surfaces.swap_remove(0))
}

fn socket() -> Half {
    family::draw(&FamilySpec::new(Family::Pyramid)).unwrap().fixed
}

/// A unit cube as text, its triangles as lists of corners that tests can spoil.
fn cube() -> Vec<[[f64; 3]; 3]> {
    let corner = |i: u8| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)];
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .iter()
        .flat_map(|q: &[u8; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]])
        .map(|t| t.map(corner))
        .collect()
}

fn text(triangles: &[[[f64; 3]; 3]]) -> String {
    let mut out = String::from("solid cube\n");
    for t in triangles {
        out += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in t {
            writeln!(out, "vertex {x} {y} {z}").unwrap();
        }
        out += "endloop\nendfacet\n";
    }
    out + "endsolid cube\n"
}

fn defects(triangles: &[[[f64; 3]; 3]]) -> Vec<MeshProblem> {
    parse(text(triangles).as_bytes()).unwrap_err()
}

#[test]
fn families_survive_both_dialects() {
    for name in [Family::Pyramid, Family::Cone, Family::XFace, Family::XFace3d, Family::PinHole] {
        let drawn = family::draw(&FamilySpec::new(name)).unwrap();
        for half in [&drawn.fixed, &drawn.moving] {
            let volume: f64 = half.surfaces.iter().map(Surface::volume).sum();
            let text = parse(&bytes(half, StlEncoding::Ascii)).unwrap_or_else(|e| panic!("{name:?}: {e:?}"));
            let binary =
                parse(&bytes(half, StlEncoding::Binary)).unwrap_or_else(|e| panic!("{name:?}: {e:?}"));
            assert!((text.volume() - volume).abs() < 1e-14);
            // Single precision moves the boundary, of area below 5, by less than 6e-8.
            assert!((binary.volume() - volume).abs() < 3e-7);
            // Edges between coplanar triangles do not count: the file has as many edges as the family, or
            // fewer if the family divides edges.
            let edges: usize = half.surfaces.iter().map(|s| s.edges.len()).sum();
            assert!(text.edges.len() <= edges && 2 * text.edges.len() > edges, "{name:?}");
            // Rounding tilts slender triangles: a few coplanar edges may count, but no real edge may be lost.
            assert!((text.edges.len()..edges + 10).contains(&binary.edges.len()), "{name:?}");
        }
    }
}

#[test]
fn scale_turns_file_units_into_d() {
    let half = socket().mapped(|p| p * 50.0);
    let file = bytes(&half, StlEncoding::Binary);
    let surface = &from_bytes(&file, file.len() as u64, 1.0 / 50.0).unwrap().surfaces[0];
    assert!((surface.volume() - socket().surfaces[0].volume()).abs() < 1e-6);
}

#[test]
fn an_empty_file_is_reported() {
    assert_eq!(parse(b"").unwrap_err(), [MeshProblem::Empty]);
    assert_eq!(parse(b"solid\nendsolid\n").unwrap_err(), [MeshProblem::NoTriangles]);
    assert_eq!(parse(b"hello").unwrap_err(), [MeshProblem::NotStl { found: 5 }]);
}

#[test]
fn a_truncated_binary_file_is_reported() {
    let mut file = bytes(&socket(), StlEncoding::Binary);
    let expected = file.len() as u64;
    file.truncate(400);
    let triangles = (expected - 84) / 50;
    assert_eq!(parse(&file).unwrap_err(), [MeshProblem::Length { triangles, expected, found: 400 }]);
}

#[test]
fn a_binary_file_that_begins_with_solid_is_binary() {
    let mut file = bytes(&socket(), StlEncoding::Binary);
    file[..5].copy_from_slice(b"solid");
    parse(&file).unwrap();
}

#[test]
fn a_truncated_text_is_reported_with_its_line() {
    let whole = text(&cube());
    let cut: String = whole.lines().take(11).collect::<Vec<_>>().join("\n");
    let problems = parse(cut.as_bytes()).unwrap_err();
    assert!(
        matches!(problems[..], [MeshProblem::Syntax { line: 11, expected: "vertex", .. }]),
        "{problems:?}"
    );
}

#[test]
fn a_misspelt_number_is_shown() {
    let broken = text(&cube()).replacen("vertex 0 0 0", "vertex 0 o 0", 1);
    let message = parse(broken.as_bytes()).unwrap_err()[0].to_string();
    assert_eq!(message, "line 4: expected three numbers after vertex, found `0 o 0`");
}

#[test]
fn more_triangles_than_the_limit_are_refused_before_they_are_read() {
    let count: u32 = 3_000_000;
    let mut header = vec![0u8; 80];
    header.extend(count.to_le_bytes());
    let problems = from_bytes(&header, 84 + 50 * u64::from(count), 1.0).unwrap_err();
    assert_eq!(problems, [MeshProblem::TooMany { count: 3_000_000 }]);
    let many = vec![cube()[0]; MAX_TRIANGLES + 5];
    assert_eq!(defects(&many), [MeshProblem::TooMany { count: MAX_TRIANGLES as u64 + 5 }]);
    let problems = from_bytes(b"solid x", 1 << 40, 1.0).unwrap_err();
    assert_eq!(problems, [MeshProblem::TooLong { bytes: 1 << 40, most: MAX_BYTES }]);
}

#[test]
fn a_corner_that_is_not_finite_is_located() {
    for bad in [f64::NAN, f64::INFINITY] {
        let mut triangles = cube();
        triangles[3][1][2] = bad;
        let place = TriangleLocation { triangle: 3, start: FileOffset::Line(2 + 3 * 7) };
        let problems = defects(&triangles);
        assert!(
            matches!(problems[..], [MeshProblem::NotFinite { place: of, .. }] if of == place),
            "{problems:?}"
        );
    }
}

#[test]
fn a_hole_is_reported_edge_by_edge() {
    let mut triangles = cube();
    triangles.remove(5);
    let problems = defects(&triangles);
    assert_eq!(problems.len(), 3);
    assert!(problems.iter().all(|p| matches!(p, MeshProblem::Open { .. })), "{problems:?}");
}

#[test]
fn many_problems_of_a_kind_are_counted() {
    let problems = defects(&cube().into_iter().step_by(2).collect::<Vec<_>>());
    assert_eq!(problems.len(), MAX_REPORTED + 1);
    // Six separate triangles are open along 18 sides.
    assert_eq!(problems.last(), Some(&MeshProblem::More { count: 13 }));
}

#[test]
fn a_triangle_without_area_is_located_not_dropped() {
    let mut triangles = cube();
    triangles.push([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let problems = defects(&triangles);
    let place = TriangleLocation { triangle: 12, start: FileOffset::Line(2 + 12 * 7) };
    assert!(problems.contains(&MeshProblem::ZeroArea { place, at: DVec3::ZERO.into() }), "{problems:?}");
}

#[test]
fn solids_that_touch_along_an_edge_are_non_manifold() {
    let shifted = cube().into_iter().map(|t| t.map(|[x, y, z]| [x + 1.0, y + 1.0, z]));
    let problems = defects(&cube().into_iter().chain(shifted).collect::<Vec<_>>());
    assert!(matches!(problems[..], [MeshProblem::NonManifold { count: 4, .. }]), "{problems:?}");
}

#[test]
fn inside_out_and_mixed_windings_are_distinguished() {
    let mut triangles = cube();
    triangles[7].swap(0, 1);
    let problems = defects(&triangles);
    assert_eq!(problems.len(), 3);
    assert!(problems.iter().all(|p| matches!(p, MeshProblem::Winding { .. })), "{problems:?}");
    for t in &mut triangles {
        t.swap(0, 1);
    }
    triangles[7].swap(0, 1);
    assert!(matches!(defects(&triangles)[..], [MeshProblem::InsideOut { .. }]));
}

/// A tall box on a square of half the side of a cube's.
fn post(low: f64, high: f64, up: impl Fn(f64) -> f64) -> Vec<[[f64; 3]; 3]> {
    let stretched = |[x, y, z]: [f64; 3]| {
        let across = |c: f64| low + (high - low) * c;
        [across(x), across(y), up(z)]
    };
    cube().into_iter().map(|t| t.map(stretched)).collect()
}

fn inward(triangles: Vec<[[f64; 3]; 3]>) -> Vec<[[f64; 3]; 3]> {
    triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}

#[test]
fn shells_of_one_file_are_one_surface_and_cavities_go_with_theirs() {
    let volumes = |shells: &[Vec<[[f64; 3]; 3]>]| -> Result<Vec<f64>, Vec<MeshProblem>> {
        let file = text(&shells.concat());
        let half = from_bytes(file.as_bytes(), file.len() as u64, 1.0)?;
        Ok(half.surfaces.iter().map(|surface| (surface.volume() * 1e6).round() / 1e6).collect())
    };
    let through = || post(0.6, 0.8, |z| 3.0 * z - 1.0);
    let cavity = || inward(post(0.1, 0.3, |z| 0.1 + 0.2 * z));
    let apart = || post(2.0, 2.5, |z| z);
    // Crossing shells are rejected if repair is off.
    assert!(matches!(volumes(&[cube(), through()]).unwrap_err()[0], MeshProblem::SelfIntersection { .. }));
    // Shells that do not cross form a single surface; a body inside another body changes nothing.
    assert_eq!(volumes(&[cube(), apart(), cavity()]), Ok(vec![1.242]));
    assert_eq!(volumes(&[cube(), inward(cavity())]), Ok(vec![1.008]));
    assert!(matches!(volumes(&[cube(), inward(apart())]).unwrap_err()[..], [MeshProblem::InsideOut { .. }]));
}

#[test]
fn a_shell_that_crosses_itself_is_located() {
    // A box with a spike that leads from its lid down through its floor.
    let mut box_ = post(0.0, 1.0, |z| z);
    let tip = [0.5, 0.5, -1.0];
    let lid: Vec<_> = box_.iter().filter(|t| t.iter().all(|p| p[2] == 1.0)).copied().collect();
    box_.retain(|t| !lid.contains(t));
    let rim = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];
    box_.extend((0..4).map(|k| [rim[k], rim[(k + 1) % 4], tip]));
    let problems = defects(&box_);
    assert!(problems.iter().any(|p| matches!(p, MeshProblem::SelfIntersection { .. })), "{problems:?}");
}

#[test]
fn a_wrong_unit_is_suspected_from_the_size() {
    let file = text(&cube());
    for (scale, width) in [(50.0, 50.0), (0.001, 0.001)] {
        let problems = from_bytes(file.as_bytes(), file.len() as u64, scale).unwrap_err();
        assert_eq!(problems, [MeshProblem::Unit { width }]);
    }
    let problems = from_bytes(file.as_bytes(), file.len() as u64, f64::NAN).unwrap_err();
    assert!(matches!(problems[..], [MeshProblem::Scale { .. }]));
}

proptest! {
    #[test]
    fn spoilt_files_never_panic(
        at in 0usize..2000, value in any::<u8>(), cut in 0usize..2000, ascii in any::<bool>()
    ) {
        let mut file = bytes(&socket(), if ascii { StlEncoding::Ascii } else { StlEncoding::Binary });
        let n = file.len();
        file[at % n] = value;
        file.truncate(n - cut % n);
        let _ = parse(&file);
    }

    #[test]
    fn reading_does_not_depend_on_where_the_part_lies(shift in proptest::array::uniform3(-3.0..3.0f64)) {
        let half = socket();
        let moved = half.mapped(|p| p + DVec3::from_array(shift));
        let back = parse(&bytes(&moved, StlEncoding::Binary)).unwrap();
        // Coordinates below 4 round by 2.4e-7 in single precision.
        for v in &half.surfaces[0].vertices {
            let v = *v + DVec3::from_array(shift);
            prop_assert!(back.vertices.iter().any(|w| w.distance(v) < 5e-7));
        }
        prop_assert_eq!(back.edges.len(), half.surfaces[0].edges.len());
    }
}
