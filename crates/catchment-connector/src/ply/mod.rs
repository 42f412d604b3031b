//! PLY files, text and binary: the faces over the vertices; all other content is skipped.
//!
//! ```text
//! ply, format, element vertex 8, property float x … ──header──▶ elements ──body──▶ corners of vertices, faces; the rest is passed over
//! ```
//!
//! Faces of more than three corners are triangulated, which keeps every corner. The design states the unit,
//! as for STL.
//!
//! The reader is our own because it reports the line or byte of every defect, stores only corners and faces,
//! and uses no more than the bytes that are there: it rejects an element without properties, of which a
//! header could announce any number.

mod body;
mod header;

use super::mesh::{self, MeshProblem, Triangle};
use super::source::{FileBytes, FileContent};
use body::Body;
use catchment_design::design::MeshPreparation;
use glam::DVec3;
use header::{Element, Header};

/// As the table of formats wants it.
pub(super) fn read(file: &FileBytes, treatment: MeshPreparation) -> Result<FileContent, Vec<MeshProblem>> {
    parse(&file.bytes, treatment).map(FileContent::of_triangles)
}

fn refused(message: impl Into<String>) -> Vec<MeshProblem> {
    vec![MeshProblem::NotPly { message: message.into() }]
}

fn parse(bytes: &[u8], treatment: MeshPreparation) -> Result<Vec<Triangle>, Vec<MeshProblem>> {
    let header = Header::read(bytes).map_err(refused)?;
    let mut body = Body::new(bytes, &header);
    let (mut points, mut faces) = (None, None);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => points = Some(vertices(element, &mut body, treatment)?),
            "face" => faces = Some(read_faces(element, &mut body, treatment)?),
            _ => body.pass(element).map_err(refused)?,
        }
    }
    let (points, faces) = (points.unwrap_or_default(), faces.unwrap_or_default());
    let mut triangles = mesh::Triangles::new(treatment);
    let mut corners: Vec<DVec3> = Vec::new();
    let mut rest = faces.corners.as_slice();
    for (number, count) in faces.counts.iter().enumerate() {
        let (face, others) = rest.split_at(*count as usize);
        rest = others;
        corners.clear();
        corners.extend(face.iter().filter_map(|k| points.get(usize::try_from(*k).ok()?)));
        if corners.len() < face.len() || corners.len() < 3 {
            return Err(refused(format!(
                "face {number} has fewer than three corners, or one that is no vertex"
            )));
        }
        triangles.push(&corners, || format!("face {number}"))?;
    }
    Ok(triangles.list)
}

fn vertices(
    element: &Element,
    body: &mut Body<'_>,
    treatment: MeshPreparation,
) -> Result<Vec<DVec3>, Vec<MeshProblem>> {
    let axis = |name: &str| {
        element
            .properties
            .iter()
            .position(|own| own.name == name && own.count.is_none() && own.kind.is_float())
    };
    let (Some(x), Some(y), Some(z)) = (axis("x"), axis("y"), axis("z")) else {
        return Err(refused(format!("line {}: its vertices have no x, y and z", element.line)));
    };
    mesh::vertex_limit(treatment)
        .allows(element.count)
        .map_err(|over| mesh::overspent(format!("line {}", element.line), over))?;
    let mut points = Vec::with_capacity(element.count as usize);
    let mut values = vec![0.0; element.properties.len()];
    for _ in 0..element.count {
        body.next(element, |property, value| values[property] = value).map_err(refused)?;
        points.push(DVec3::new(values[x], values[y], values[z]));
    }
    Ok(points)
}

/// Faces by the numbers of their corners.
#[derive(Default)]
struct Faces {
    counts: Vec<u32>,
    corners: Vec<i64>,
}

fn read_faces(
    element: &Element,
    body: &mut Body<'_>,
    treatment: MeshPreparation,
) -> Result<Faces, Vec<MeshProblem>> {
    let is_corners = |own: &header::Property| {
        own.count.is_some() && ["vertex_indices", "vertex_index"].contains(&own.name.as_str())
    };
    let Some(list) = element.properties.iter().position(is_corners) else {
        return Err(refused(format!("line {}: its faces have no list vertex_indices", element.line)));
    };
    if element.count > mesh::most_read(treatment) as u64 {
        return Err(vec![mesh::too_many(treatment, element.count)]);
    }
    // No more corners than triangles that they could bound have.
    let most = 3 * mesh::most_read(treatment);
    let mut faces = Faces::default();
    for _ in 0..element.count {
        let before = faces.corners.len();
        let mut is_over = false;
        body.next(element, |property, value| {
            if property == list {
                is_over = faces.corners.len() >= most;
                if !is_over {
                    // A fraction is not a vertex number.
                    faces.corners.push(if value.fract() == 0.0 { value as i64 } else { -1 });
                }
            }
        })
        .map_err(refused)?;
        if is_over {
            return Err(vec![mesh::too_many(treatment, (most / 3) as u64 + 1)]);
        }
        faces.counts.push((faces.corners.len() - before) as u32);
    }
    Ok(faces)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: &str = "ply\nformat ascii 1.0\ncomment a cube\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
                        property uchar red\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n\
                        0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n0 0 1 9\n1 0 1 9\n1 1 1 9\n0 1 1 9\n\
                        4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

    fn read(bytes: &[u8]) -> Result<crate::Surface, Vec<MeshProblem>> {
        let as_it_is = MeshPreparation::AS_IT_IS;
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
    fn defects_are_reported() {
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

    /// Elements that take no bytes could have any number: a header of a megabyte requested 29 GB.
    #[test]
    fn a_header_that_announces_too_much_is_refused() {
        let refused = |bytes: &[u8]| read(bytes).unwrap_err()[0].to_string();
        let nothing = (0..400).map(|k| format!("element a{k} 1000000\n")).collect::<Vec<_>>().concat();
        let format = "ply\nformat binary_little_endian 1.0\n";
        let bomb = format!("{format}comment {}\n{nothing}end_header\n", "x".repeat(1_000_000));
        assert!(refused(bomb.as_bytes()).contains("line 4: the 1000000 elements `a0` have no properties"));
        let many = (0..1001).map(|k| format!("element a{k} 0\n")).collect::<Vec<_>>().concat();
        assert!(
            refused(format!("{format}{many}end_header\n").as_bytes())
                .contains("line 1003: more than 1000 elements and properties")
        );
        assert!(
            refused(format!("{format}{}", "\n".repeat(2 << 20)).as_bytes())
                .contains("more than 1048576 bytes in the header")
        );
        let announced = |element: &str| refused(format!("{format}{element}end_header\n12345").as_bytes());
        assert!(
            announced("element face 2\nproperty list uint uint vertex_index\n")
                .contains("announces 2 of `face`")
        );
        assert!(
            announced("element face 18446744073709551615\nproperty list uint uint vertex_index\n")
                .contains("announces")
        );
        assert!(
            announced("element vertex 5\nproperty uchar x\n")
                .contains("line 3: its vertices have no x, y and z")
        );
        assert!(
            announced("element face 5\nproperty uchar x\n")
                .contains("line 3: its faces have no list vertex_indices")
        );
        // A list longer than the rest of the file.
        assert!(announced("element face 1\nproperty list uint uchar vertex_index\n").contains("byte "));
    }

    /// Elements that are passed over take no memory, however many there are, and may stand anywhere.
    #[test]
    fn other_elements_are_skipped() {
        let cube = read(CUBE.as_bytes()).unwrap();
        let (head, body) = CUBE.split_once("end_header\n").unwrap();
        let before = head.replace(
            "element vertex",
            "element crumb 2\nproperty list uchar char c\nproperty double d\nelement vertex",
        );
        assert_eq!(read(format!("{before}end_header\n2 1 -1 0.5\n0 1e3\n{body}").as_bytes()).unwrap(), cube);
        let bytes = binary();
        let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap();
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let head = head.replace("element vertex", "element crumb 5000\nproperty uchar c\nelement vertex");
        let crumbs = [head.as_bytes(), b"end_header\n", &[7; 5000], &bytes[end + 11..]].concat();
        assert_eq!(read(&crumbs).unwrap(), cube);
        // Faces may come before the vertices.
        let (vertices, faces) = body.split_at(body.find("4 3 2").unwrap());
        let swapped = head_of(&[
            "element face 6\nproperty list uchar int vertex_indices\n",
            "element vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n",
        ]);
        assert_eq!(read(format!("{swapped}{faces}{vertices}").as_bytes()).unwrap(), cube);
    }

    fn head_of(elements: &[&str]) -> String {
        format!("ply\nformat ascii 1.0\n{}end_header\n", elements.concat())
    }

    #[test]
    fn numbers_are_of_every_type_and_both_orders() {
        let element = "element vertex 1\nproperty double x\nproperty float y\nproperty double z\nproperty char a\nproperty ushort b\nproperty int c\n";
        for order in ["little", "big"] {
            let head = format!("ply\nformat binary_{order}_endian 1.0\n{element}end_header\n");
            let mut numbers: Vec<Vec<u8>> = vec![
                0.25f64.to_le_bytes().into(),
                (-0.5f32).to_le_bytes().into(),
                1e300f64.to_le_bytes().into(),
                (-2i8).to_le_bytes().into(),
                65535u16.to_le_bytes().into(),
                (-3i32).to_le_bytes().into(),
            ];
            if order == "big" {
                for number in &mut numbers {
                    number.reverse();
                }
            }
            let bytes = [head.into_bytes(), numbers.concat()].concat();
            let header = Header::read(&bytes).unwrap();
            let mut values = Vec::new();
            Body::new(&bytes, &header).next(&header.elements[0], |_, value| values.push(value)).unwrap();
            assert_eq!(values, [0.25, -0.5, 1e300, -2.0, 65535.0, -3.0], "{order}");
        }
    }
}
