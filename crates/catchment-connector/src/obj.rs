//! Wavefront OBJ files: the faces of all objects of a file together, without colours and textures.
//!
//! ```text
//! v 0 0 1          a corner
//! f 1 2/5 -1//3    a face: numbers of corners from 1, or back from the last; textures and normals behind slashes
//! ```
//!
//! Faces of more than three corners are triangulated, which keeps every corner; points and lines bound
//! nothing. The design states the unit, as for STL. The reader is our own because it reports the line of
//! every defect and stores only corners and triangles.

use super::mesh::{self, MeshProblem, Triangle, cut};
use super::source::{FileBytes, FileContent};
use catchment_base::budget::Budget;
use catchment_design::design::MeshPreparation;
use glam::DVec3;

/// As the table of formats wants it.
pub(super) fn read(file: &FileBytes, treatment: MeshPreparation) -> Result<FileContent, Vec<MeshProblem>> {
    parse(&file.bytes, treatment).map(FileContent::of_triangles)
}

fn parse(bytes: &[u8], treatment: MeshPreparation) -> Result<Vec<Triangle>, Vec<MeshProblem>> {
    let mut vertices: Vec<DVec3> = Vec::new();
    let mut budget = Budget::new(mesh::vertex_limit(treatment));
    let mut triangles = mesh::Triangles::new(treatment);
    let mut corners: Vec<DVec3> = Vec::new();
    for (line, text) in (1..).zip(bytes.split(|byte| *byte == b'\n')) {
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let refused = |expected| vec![MeshProblem::Syntax { line, expected, found: shown(text) }];
        match words.next() {
            Some(b"v") => {
                let mut number = || std::str::from_utf8(words.next()?).ok()?.parse::<f64>().ok();
                let (Some(x), Some(y), Some(z)) = (number(), number(), number()) else {
                    return Err(refused("`v` and three numbers"));
                };
                budget.spend(1).map_err(|over| mesh::overspent(format!("line {line}"), over))?;
                vertices.push(DVec3::new(x, y, z));
            }
            Some(b"f") => {
                corners.clear();
                for word in words {
                    let written = word.split(|byte| *byte == b'/').next().unwrap_or_default();
                    let number: Option<i64> =
                        std::str::from_utf8(written).ok().and_then(|word| word.parse().ok());
                    let Some(number) = number else { return Err(refused("`f` and at least three corners")) };
                    let corner = corner(number, vertices.len()).ok_or_else(|| refused(CORNERS))?;
                    // Before they are kept.
                    cut::CORNERS
                        .allows(corners.len() as u64 + 1)
                        .map_err(|over| mesh::overspent(format!("line {line}"), over))?;
                    corners.push(vertices[corner]);
                }
                // A point or a line bounds nothing.
                if corners.len() > 2 {
                    triangles.push(&corners, || format!("line {line}"))?;
                }
            }
            _ => {}
        }
    }
    Ok(triangles.list)
}

/// Requirement on a face.
const CORNERS: &str = "corners of a face that were defined before it";

/// The place of a corner among as many as there are, from its number.
fn corner(number: i64, count: usize) -> Option<usize> {
    let place = if number > 0 { number - 1 } else { number.checked_add(i64::try_from(count).ok()?)? };
    usize::try_from(place).ok().filter(|place| number != 0 && *place < count)
}

/// A line of a file, shortened.
fn shown(line: &[u8]) -> String {
    const MOST: usize = 24;
    let text = String::from_utf8_lossy(&line[..line.len().min(MOST)]).trim().to_owned();
    if text.is_empty() { "an empty line".to_owned() } else { format!("`{text}`") }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: &str = "# a cube\nmtllib none.mtl\no cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                        vn 0 0 1\nusemtl red\nf 4 3 2 1\nf 5//1 6//1 7//1 8//1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\ng back\nf -8 -4 -1 -5\n";

    fn read(text: &str) -> Result<crate::Surface, Vec<MeshProblem>> {
        let as_it_is = MeshPreparation::AS_IT_IS;
        let held = super::read(&FileBytes::whole(text.as_bytes().to_vec()), as_it_is)?;
        mesh::half(held.bodies, 0.5, as_it_is).map(|mut ready| ready.half.surfaces.swap_remove(0))
    }

    #[test]
    fn quads_of_several_groups_make_one_cube() {
        let cube = read(CUBE).unwrap();
        assert_eq!((cube.vertices.len(), cube.facets.len()), (8, 6));
        assert!(cube.vertices.contains(&DVec3::splat(0.5)), "scaled");
    }

    #[test]
    fn defects_are_reported_with_their_line() {
        let refused = |from: &str, to: &str| match read(&CUBE.replace(from, to)) {
            Err(problems) => problems[0].to_string(),
            Ok(surface) => panic!("{surface:?}"),
        };
        assert_eq!(refused("v 1 1 0", "v 1 x 0"), "line 6: expected `v` and three numbers, found `v 1 x 0`");
        assert!(
            refused("f 1 2 6 5", "f 1 2 60 5").contains("line 16: expected corners of a face"),
            "{}",
            refused("f 1 2 6 5", "f 1 2 60 5")
        );
        assert!(refused("f 1 2 6 5\n", "").contains("open along the edge"));
        // Normals and textures are not followed, wherever they lead.
        assert!(read(&CUBE.replace("5//1 6//1", "5//0 6//-9")).is_ok());
        assert!(
            refused("v 1 1 0", "v 1 1 nan").contains("not finite"),
            "{}",
            refused("v 1 1 0", "v 1 1 nan")
        );
        assert_eq!(read("# nothing\n").unwrap_err(), [MeshProblem::NoTriangles]);
        let crossed = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1.1 0\nf 1 2 3 4\n";
        assert_eq!(
            read(crossed).unwrap_err(),
            [MeshProblem::NotSimple { triangle: 0, at: DVec3::ZERO.into() }]
        );
    }

    /// A face of the cube is subdivided and its neighbours are not: their edges are divided too, and it is
    /// closed.
    #[test]
    fn edges_that_one_side_divides_are_divided_on_the_other() {
        let top = "v .5 0 1\nv 1 .5 1\nv .5 1 1\nv 0 .5 1\nv .5 .5 1\nf 5 9 13 12\nf 9 6 10 13\nf 13 10 7 11\nf 12 13 11 8\n";
        // Corners counted from the end are others now.
        let text = CUBE.replace("f 5//1 6//1 7//1 8//1\n", top).replace("-8 -4 -1 -5", "1 5 8 4");
        let cube = read(&text).unwrap();
        // The divided facets and edges are merged again.
        assert_eq!((cube.vertices.len(), cube.facets.len(), cube.edges.len()), (8, 6, 12));
        assert!((cube.volume() - 0.125).abs() < 1e-15, "{}", cube.volume());
        // A hole remains a hole, also beside a divided edge.
        let problems = read(&text.replace("f 2 3 7 6\n", "")).unwrap_err();
        assert!(problems.iter().all(|p| matches!(p, MeshProblem::Open { .. })), "{problems:?}");
        assert_eq!(problems.len(), 5);
    }

    /// A face is cut by about half the square of its corners in steps, which are charged before they are taken.
    #[test]
    fn a_face_of_too_many_corners_is_refused_before_it_is_cut() {
        let n = 60_000;
        let corner = |k: usize| {
            let (sine, cosine) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
            let radius = if k.is_multiple_of(2) { 0.3 } else { 1.0 };
            format!("v {:.9} {:.9} 0\n", radius * cosine, radius * sine)
        };
        let vertices: String = (0..n).map(corner).collect();
        let numbers: Vec<String> = (1..=n).map(|k| k.to_string()).collect();
        let message =
            "line 60001: more than 20000 corners of a face: triangulate the mesh when it is exported";
        assert_eq!(
            read(&format!("{vertices}f {}\n", numbers.join(" "))).unwrap_err()[0].to_string(),
            message
        );
        let same = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {}\n", "1 2 3 ".repeat(300_000));
        assert!(read(&same).unwrap_err()[0].to_string().starts_with("line 4: more than 20000 corners"));
        let vertices = "v 0 0 0\n".repeat(600_001);
        assert!(
            read(&vertices).unwrap_err()[0].to_string().starts_with("line 600001: more than 600000 vertices")
        );
    }

    #[test]
    fn points_and_lines_are_ignored_and_crlf_is_read() {
        let text = format!("{CUBE}p 1\nf 1\nl 1 2\nf 1 2\n").replace('\n', "\r\n");
        assert_eq!(read(&text).unwrap(), read(CUBE).unwrap());
        assert!(
            read(&CUBE.replace("-8 -4", "-9 -4")).unwrap_err()[0]
                .to_string()
                .contains("line 20: expected corners")
        );
    }
}
