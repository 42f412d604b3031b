//! The same solid from every source, and the inputs that each source rejects.

use super::*;
use crate::Connector;
use crate::mesh::{FileOffset, TriangleLocation};
use catchment_base::pose::{DofSet, Mount};
use catchment_design::design::{Alignment, ConnectorSpec, Design, Family, FileSpec, OwnSpec};
use proptest::prelude::*;

fn soup(surface: &Surface) -> Vec<[DVec3; 3]> {
    surface.triangles().into_iter().map(|t| t.map(|k| surface.vertices[k as usize])).collect()
}

fn cube() -> Vec<Vec<DVec3>> {
    let corner = |i: u8| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    vec![(0..8).map(corner).collect()]
}

fn build(source: &HalfSource) -> Result<Half, Vec<GeometryDefect>> {
    source
        .build(HalfRole::Fixed, crate::Size::Plausible, &catchment_base::exec::Exec::new())
        .map(|built| built.half)
}

#[test]
fn a_pair_in_memory_is_the_family_without_any_file() {
    let spec = FamilySpec::new(Family::Pyramid);
    let drawn = family::draw(&spec).unwrap();
    let [fixed, moving] =
        [&drawn.fixed, &drawn.moving].map(|half| HalfSource::Triangles(soup(&half.surfaces[0])));
    let connector = Connector::from_sources(&fixed, &moving, drawn.face_height, Mount::X).unwrap();
    let family = Connector::of_family(&spec, Mount::X).unwrap();
    for (own, drawn) in [(&connector.fixed, &family.fixed), (&connector.moving, &family.moving)] {
        assert!((own.surfaces[0].volume() - drawn.surfaces[0].volume()).abs() < 1e-14);
        assert_eq!(own.surfaces[0].edges.len(), drawn.surfaces[0].edges.len());
    }
    let halves = [HalfSource::Family(spec), HalfSource::Surface(drawn.moving.surfaces[0].clone())];
    let mixed = Connector::from_sources(&halves[0], &halves[1], drawn.face_height, Mount::X).unwrap();
    assert_eq!((&mixed.fixed, &mixed.moving), (&family.fixed, &family.moving));
    assert!(mixed.contents.fixed.is_empty() && mixed.contents.moving == connector.contents.moving);
}

#[test]
fn defects_of_triangles_in_memory_are_reported() {
    let hull = convex_hull(&cube()[0]).unwrap();
    let good = soup(&hull);
    let defect = |triangles: Vec<[DVec3; 3]>| match &build(&HalfSource::Triangles(triangles)).unwrap_err()[0]
    {
        GeometryDefect::Triangles { side: HalfRole::Fixed, error } => error.clone(),
        other => panic!("{other}"),
    };
    let mut bad = good.clone();
    bad[3][1].y = f64::NAN;
    let place = TriangleLocation { triangle: 3, start: FileOffset::Memory };
    let problem = defect(bad);
    assert!(
        matches!(problem, MeshProblem::NotFinite { place: of, at } if of == place && at.at.y.is_nan()),
        "{problem}"
    );
    assert_eq!(place.to_string(), "triangle 3");
    assert_eq!(defect(Vec::new()), MeshProblem::NoTriangles);
    assert!(matches!(defect(good[1..].to_vec()), MeshProblem::Open { .. }));
    let many = vec![good[0]; mesh::MAX_TRIANGLES + 1];
    assert!(matches!(defect(many), MeshProblem::TooMany { .. }));
    let mut inside_out = good.clone();
    for triangle in &mut inside_out {
        triangle.swap(0, 1);
    }
    assert!(matches!(defect(inside_out), MeshProblem::InsideOut { .. }));
    // Triangles in memory are used as they are: overlapping shells are not united.
    let shifted = good.iter().map(|t| t.map(|p| p + DVec3::new(0.3, 0.4, 0.5)));
    let crossing: Vec<_> = good.iter().copied().chain(shifted).collect();
    assert!(matches!(defect(crossing), MeshProblem::SelfIntersection { .. }));
}

/// A design of two meshes of the same cube under the given names, read from memory.
fn mesh_design(path: &str, file: &[u8]) -> Design {
    let half = || HalfSpec::Mesh(FileSpec::new(path, 1.0));
    let own = OwnSpec::new(0.5, half(), half());
    let design = Design {
        name: path.to_owned(),
        connector: ConnectorSpec::Own(own),
        width: 1.0,
        unit: None,
        alignment: Alignment::new(DofSet::ALL, Mount::X),
    };
    assert_eq!(design.digest(), None);
    let read = |requested: &Path, _| {
        assert_eq!(requested, Path::new(path));
        Ok(FileBytes::whole(file.to_vec()))
    };
    let connector = Connector::build_with(&design, &read).unwrap();
    design.with_contents(&connector.contents)
}

fn stl_of(half: &Half) -> Vec<u8> {
    let mut file = Vec::new();
    stl::write(half, stl::StlEncoding::Ascii, &mut file).unwrap();
    file
}

#[test]
fn the_digest_depends_on_the_content_and_not_on_the_path() {
    let half = build(&HalfSource::Pieces(cube())).unwrap();
    let design = mesh_design("a.stl", &stl_of(&half));
    let ConnectorSpec::Own(OwnSpec {
        fixed: HalfSpec::Mesh(FileSpec { content: Some(content), .. }), ..
    }) = &design.connector
    else {
        panic!("a content")
    };
    assert_eq!((content.triangles, content.bytes), (12, stl_of(&half).len() as u64));
    assert_eq!(content.sha256.len(), 64);
    let digest = design.digest().unwrap();
    assert_eq!(mesh_design("folder/b.STL", &stl_of(&half)).digest(), Some(digest));
    let mut moved = cube();
    moved[0][7].x += 1e-9;
    let moved = build(&HalfSource::Triangles(soup(&convex_hull(&moved[0]).unwrap()))).unwrap();
    assert_ne!(mesh_design("a.stl", &stl_of(&moved)).digest(), Some(digest));
    let json = serde_json::to_string(&design).unwrap();
    assert_eq!(serde_json::from_str::<Design>(&json).unwrap(), design);
}

#[test]
fn a_missing_file_and_one_that_cannot_be_read_are_distinguished() {
    let half = HalfSpec::Mesh(FileSpec::new("no/such/file.stl", 1.0));
    let error =
        |read: FileReader<'_>| match HalfSource::of(&half, HalfRole::Moving, read).unwrap_err().remove(0) {
            GeometryDefect::Mesh { side: HalfRole::Moving, error, .. } => error,
            other => panic!("{other}"),
        };
    assert_eq!(error(&disk::read), MeshProblem::NoFile);
    let denied = |_: &Path, _| Err(io::Error::from(io::ErrorKind::PermissionDenied));
    assert!(matches!(error(&denied), MeshProblem::Io { .. }));
    let content = MeshContent::of(b"", 0);
    let gone = HalfSource::of(&HalfSpec::Memory { content }, HalfRole::Fixed, &disk::read);
    assert_eq!(gone, Err(vec![GeometryDefect::NotInDesign { side: HalfRole::Fixed }]));
}

proptest! {
    #[test]
    fn triangles_of_a_hull_are_the_piece(
        points in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 4..24)
    ) {
        let sphere: Vec<DVec3> =
            points.into_iter().filter_map(|p| DVec3::from_array(p).try_normalize()).collect();
        let apart = |a: &DVec3, b: &DVec3| a.distance(*b) > 0.05;
        prop_assume!((0..sphere.len()).all(|i| (0..i).all(|j| apart(&sphere[i], &sphere[j]))));
        let Ok(piece) = build(&HalfSource::Pieces(vec![sphere])) else { return Ok(()) };
        let Ok(half) = build(&HalfSource::Triangles(soup(&piece.surfaces[0]))) else { return Ok(()) };
        let (piece, mesh) = (&piece.surfaces[0], &half.surfaces[0]);
        prop_assert!(mesh.convex);
        // Sums of at most a hundred terms below 1.
        prop_assert!((piece.volume() - mesh.volume()).abs() < 1e-13);
        prop_assert_eq!(piece.edges.len(), mesh.edges.len());
        prop_assert!(piece.vertices.iter().all(|v| mesh.vertices.contains(v)));
    }
}
