//! PLY files, text and binary: the faces over the vertices, everything else left out.
//!
//! Read by `ply-rs-bw`; faces of more than three corners are cut into triangles, which keep every corner. The unit stands beside the file, as for
//! STL.

use super::mesh::{self, MeshProblem, Triangle};
use super::source::{FileBytes, Held};
use crate::design::Treatment;
use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// As the table of formats wants it.
pub(super) fn read(file: &FileBytes, treatment: Treatment) -> Result<Held, Vec<MeshProblem>> {
    parse(&file.bytes, treatment).map(Held::of_triangles)
}

fn parse(bytes: &[u8], treatment: Treatment) -> Result<Vec<Triangle>, Vec<MeshProblem>> {
    let unreadable = |error: ParseError| {
        let line = error.line().map_or_else(String::new, |line| format!("line {line}: "));
        let message = error.to_string();
        // Of several lines the first says what is wrong.
        let message = message.lines().next().unwrap_or_default();
        let message = message.split_once(": ").map_or(message, |(_, said)| said);
        vec![MeshProblem::NotPly { message: format!("{line}{message}") }]
    };
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(unreadable)?;
    // Every element takes a byte at least: a header that announces more is not believed.
    for (name, element) in &header.elements {
        if element.count > bytes.len() {
            let message =
                format!("the header announces {} of `{name}`, more than the file has bytes", element.count);
            return Err(vec![MeshProblem::NotPly { message }]);
        }
    }
    let mut payload = parser.read_payload(&mut reader, &header).map_err(unreadable)?;
    let [vertices, faces] = ["vertex", "face"].map(|name| payload.shift_remove(name).unwrap_or_default());
    let points: Option<Vec<DVec3>> = vertices.iter().map(Element::point).collect();
    let Some(points) = points else {
        let message = "its vertices have no x, y and z".to_owned();
        return Err(vec![MeshProblem::NotPly { message }]);
    };
    let mut triangles = mesh::Triangles::new(treatment);
    for (number, face) in faces.iter().enumerate() {
        let corner = |k: &u32| points.get(*k as usize).copied();
        let corners: Option<Vec<DVec3>> = face.corners.iter().map(corner).collect();
        let Some(corners) = corners.filter(|corners| corners.len() > 2) else {
            let message = format!("face {number} has fewer than three corners, or one that is no vertex");
            return Err(vec![MeshProblem::NotPly { message }]);
        };
        triangles.push(&corners)?;
    }
    Ok(triangles.list)
}

/// What of an element counts.
#[derive(Debug, Default)]
struct Element {
    point: [Option<f64>; 3],
    corners: Vec<u32>,
}

impl Element {
    fn point(&self) -> Option<DVec3> {
        let [x, y, z] = self.point;
        Some(DVec3::new(x?, y?, z?))
    }
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let Some(axis) = ["x", "y", "z"].iter().position(|axis| *axis == name) {
            self.point[axis] = match property {
                Property::Float(number) => Some(f64::from(number)),
                Property::Double(number) => Some(number),
                _ => None,
            };
        } else if ["vertex_indices", "vertex_index"].contains(&name) {
            // A negative index stands for no vertex; such a face has no corners.
            self.corners = property.to_u32_list().unwrap_or_default();
        }
        PropertyAccessResult::Set
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: &str = "ply\nformat ascii 1.0\ncomment a cube\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
                        property uchar red\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n\
                        0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n0 0 1 9\n1 0 1 9\n1 1 1 9\n0 1 1 9\n\
                        4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

    fn read(bytes: &[u8]) -> Result<crate::connector::Surface, Vec<MeshProblem>> {
        let as_it_is = Treatment::AS_IT_IS;
        let held = super::read(&FileBytes::whole(bytes.to_vec()), as_it_is)?;
        mesh::half(held.bodies, 0.5, as_it_is).map(|mut ready| ready.half.surfaces.swap_remove(0))
    }

    fn binary() -> Vec<u8> {
        let (head, body) = CUBE.split_once("end_header\n").unwrap();
        let mut bytes = head.replace("ascii", "binary_little_endian").into_bytes();
        bytes.extend(b"end_header\n");
        for line in body.lines() {
            let numbers: Vec<i32> = line.split(' ').map(|n| n.parse().unwrap()).collect();
            if let [x, y, z, 9] = numbers[..] {
                bytes.extend([x, y, z].iter().flat_map(|n| (*n as f32).to_le_bytes()));
                bytes.push(9);
            } else {
                bytes.push(4);
                bytes.extend(numbers[1..].iter().flat_map(|n| n.to_le_bytes()));
            }
        }
        bytes
    }

    #[test]
    fn text_and_bytes_make_the_same_cube() {
        let cube = read(CUBE.as_bytes()).unwrap();
        assert_eq!((cube.vertices.len(), cube.facets.len()), (8, 6));
        assert!(cube.vertices.contains(&DVec3::splat(0.5)), "scaled");
        assert_eq!(read(&binary()).unwrap(), cube);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let refused = |bytes: &[u8]| read(bytes).unwrap_err()[0].to_string();
        let changed = |from: &str, to: &str| refused(CUBE.replace(from, to).as_bytes());
        assert!(
            changed("4 0 1 5 4", "4 0 1 5 40")
                .contains("face 2 has fewer than three corners, or one that is no vertex")
        );
        assert!(changed("4 0 1 5 4", "4 0 1 5 -4").contains("face 2"));
        assert!(changed("0 1 1 9", "0 1 x 9").contains("line "), "{}", changed("0 1 1 9", "0 1 x 9"));
        assert!(changed("property float z", "property float w").contains("no x, y and z"));
        assert!(changed("vertex 8", "vertex 4000000000").contains("announces 4000000000 of `vertex`"));
        assert!(
            changed("format ascii 1.0\n", "").starts_with("cannot be read as PLY"),
            "{}",
            changed("format ascii 1.0\n", "")
        );
        let bytes = binary();
        assert!(refused(&bytes[..bytes.len() - 3]).starts_with("cannot be read as PLY"));
    }
}
