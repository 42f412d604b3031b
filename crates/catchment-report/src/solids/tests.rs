use super::*;
use catchment_core::connector::Connector;
use catchment_core::contact::Pair;
use catchment_core::design::{Alignment, ConnectorSpec, Family, FamilySpec};
use catchment_core::exec::Exec;
use catchment_core::method::partition::shapes;
use catchment_core::pose::Dof;
use roxmltree::Document;

fn shape(family: Family, free: &[Dof], subject: SolidShape) -> (Design, Solids) {
    let mut alignment = Alignment::default_for(Some(family));
    alignment.free = free.iter().copied().collect();
    let connector = ConnectorSpec::Family(FamilySpec::new(family).with_aspect_ratio(0.5));
    let design = Design { name: "shape".to_owned(), connector, width: 1.0, unit: None, alignment };
    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
    let shape = shapes(&pair, subject, &PartitionSettings { slices: 4, strips: 1 }, &Exec::new()).unwrap();
    (design, shape)
}

fn all() -> Vec<(Design, Solids)> {
    vec![
        shape(Family::XFace3d, &[Dof::X, Dof::Y], SolidShape::Collision),
        shape(Family::VFace, &[Dof::X, Dof::Pitch], SolidShape::Swept),
        shape(Family::VFace, &[Dof::X, Dof::Pitch], SolidShape::Collision),
        shape(Family::XFace, &[Dof::X], SolidShape::Collision),
        shape(Family::Pyramid, &[Dof::X, Dof::Y], SolidShape::Halves),
    ]
}

#[test]
fn a_vtp_file_reads_back_to_the_bit() {
    for (_, shape) in all() {
        let text = vtp(&shape);
        let xml = Document::parse(&text).unwrap();
        let array = |name: &str| -> Vec<f64> {
            let node = xml.descendants().find(|node| node.attribute("Name") == Some(name)).unwrap();
            node.text().unwrap().split_whitespace().map(|word| word.parse().unwrap()).collect()
        };
        let piece = xml.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
        let count = |name: &str| piece.attribute(name).unwrap().parse::<usize>().unwrap();
        let places = array("places");
        let corners: Vec<f64> =
            shape.solids.iter().flat_map(|s| &s.vertices).flat_map(DVec3::to_array).collect();
        assert_eq!((places.len(), &places), (3 * count("NumberOfPoints"), &corners));
        let (joins, ends) = (array("connectivity"), array("offsets"));
        assert_eq!(ends.len(), count("NumberOfPolys"));
        assert_eq!(*ends.last().unwrap() as usize, joins.len());
        // Faces in the order of the bodies, by their numbers in the whole file.
        let (mut first, mut face_number, mut begin) = (0, 0, 0);
        let numbers = ["body", "fixed_piece", "moving_piece", "slice", "angle", "height", "up"].map(array);
        assert!(numbers.iter().all(|array| array.len() == ends.len()));
        for (k, solid) in shape.solids.iter().enumerate() {
            let mut upward = 0.0;
            for face in &solid.faces {
                let end = ends[face_number] as usize;
                let read: Vec<usize> = joins[begin..end].iter().map(|k| *k as usize - first).collect();
                assert_eq!(&read, face);
                let of = |number: Option<usize>| number.map_or(-1.0, |n| n as f64);
                assert_eq!(numbers[0][face_number], k as f64);
                assert_eq!(numbers[1][face_number], of(solid.fixed));
                assert_eq!(numbers[2][face_number], of(solid.moving));
                assert_eq!(numbers[3][face_number], of(solid.slice.map(|(slice, _)| slice)));
                assert_eq!(numbers[5][face_number], middle(solid, face).z);
                upward += numbers[6][face_number] * area(solid, face);
                (face_number, begin) = (face_number + 1, end);
            }
            // A closed body has as much above as below.
            assert!(upward.abs() < 1e-9, "{upward}");
            first += solid.vertices.len();
        }
    }
}

fn area(solid: &Solid, face: &[usize]) -> f64 {
    let at = |k: usize| solid.vertices[k];
    face.windows(2).map(|w| (at(w[0]) - at(face[0])).cross(at(w[1]) - at(face[0]))).sum::<DVec3>().length()
        / 2.0
}

#[test]
fn an_obj_file_has_a_group_for_every_body() {
    for (_, shape) in all() {
        let text = obj(&shape);
        let (mut vertices, mut groups) = (Vec::new(), Vec::<(String, Vec<Vec<usize>>)>::new());
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words[0] {
                "#" => {}
                "g" => groups.push((words[1].to_owned(), Vec::new())),
                "v" => vertices.push([1, 2, 3].map(|k| words[k].parse::<f64>().unwrap())),
                "f" => {
                    let face = words[1..].iter().map(|word| word.parse::<usize>().unwrap() - 1).collect();
                    groups.last_mut().unwrap().1.push(face);
                }
                other => panic!("{other}"),
            }
        }
        assert_eq!(groups.len(), shape.solids.len());
        for ((name, faces), (k, solid)) in groups.iter().zip(shape.solids.iter().enumerate()) {
            assert!(name.starts_with(&format!("body{k}_")), "{name}");
            assert_eq!(name.contains("_slice"), solid.slice.is_some(), "{name}");
            assert_eq!(name.contains("_moving"), solid.moving.is_some(), "{name}");
            for (face, of_body) in faces.iter().zip(&solid.faces) {
                let read = face.iter().map(|corner| vertices[*corner]);
                assert!(read.eq(of_body.iter().map(|corner| solid.vertices[*corner].to_array())));
            }
            assert_eq!(faces.len(), solid.faces.len());
        }
    }
}

#[test]
fn the_report_lists_the_axes_and_their_units() {
    let (design, shape) = shape(Family::VFace, &[Dof::X, Dof::Pitch], SolidShape::Collision);
    let report = SolidsReport::new(&design, &shape, Vec::new());
    let json: serde_json::Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
    assert_eq!((&json["kind"], &json["shape"]), (&"solids".into(), &"collision".into()));
    assert_eq!(json["axes"], serde_json::json!(["x", "pitch", "z"]));
    assert_eq!(json["bodies"], shape.solids.len());
    assert_eq!(json["settings"], serde_json::json!({"slices": 4, "strips": 1}));
    let table = report.table();
    assert!(table.contains("2 fixed, 1 moving") && table.contains("pitch   -1.571   1.571  rad"), "{table}");
    let halves = Solids { subject: SolidShape::Halves, ..shape };
    assert_eq!(SolidsReport::new(&design, &halves, Vec::new()).settings, None);
}

#[cfg(feature = "figure")]
#[test]
fn shapes_are_drawn_flat_and_in_space() {
    use crate::figure::testing::look;
    use crate::figure::{FigureError, bodies};
    for (k, (design, shape)) in all().iter().enumerate() {
        let picture = bodies(design, shape).unwrap();
        look(&format!("bodies-{k}"), &picture);
        assert!(picture.svg().contains("convex bodies") && !picture.svg().contains("=\"NaN"));
        assert_eq!(picture, bodies(design, shape).unwrap());
        let empty = Solids { solids: Vec::new(), ..shape.clone() };
        assert!(matches!(bodies(design, &empty), Err(FigureError::Empty { .. })));
    }
}
