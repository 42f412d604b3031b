//! Wavefront OBJ files: the faces of all objects of a file together, colours and textures left out.
//!
//! Read by `tobj`; faces of more than three corners are cut into triangles, which keep every corner. The unit stands beside the file, as for STL.

use super::mesh::{self, MeshProblem, Triangle};
use super::source::{FileBytes, Held};
use crate::design::Treatment;
use glam::DVec3;
use std::io::{self, BufRead, Read};
use tobj::{LoadError, LoadOptions};

/// As the table of formats wants it.
pub(super) fn read(file: &FileBytes, treatment: Treatment) -> Result<Held, Vec<MeshProblem>> {
    parse(&file.bytes, treatment).map(Held::of_triangles)
}

fn parse(bytes: &[u8], treatment: Treatment) -> Result<Vec<Triangle>, Vec<MeshProblem>> {
    let refused =
        |line: usize, expected| vec![MeshProblem::Syntax { line, expected, found: shown(bytes, line) }];
    let text = plain(bytes).map_err(|line| refused(line, CORNERS))?;
    let mut lines = Lines { rest: text.as_bytes(), line: 0 };
    let no_materials = |_: &std::path::Path| Err(LoadError::OpenFileFailed);
    // Points and lines bound nothing.
    let options = LoadOptions { ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let (models, _) = tobj::load_obj_buf(&mut lines, &options, no_materials)
        .map_err(|error| refused(lines.line, expected(error)))?;
    let mut triangles = mesh::Triangles::new(treatment);
    for mesh in models.iter().map(|model| &model.mesh) {
        let corner = |k: &u32| {
            let at = 3 * *k as usize;
            DVec3::from_slice(&mesh.positions[at..at + 3])
        };
        let mut rest = mesh.indices.as_slice();
        let faces = mesh.indices.len() / 3;
        // Without arities all faces are triangles.
        let arities = (0..faces).map(|_| 3).take(if mesh.face_arities.is_empty() { faces } else { 0 });
        for arity in arities.chain(mesh.face_arities.iter().map(|arity| *arity as usize)) {
            let (face, others) = rest.split_at(arity);
            rest = others;
            let corners: Vec<DVec3> = face.iter().map(corner).collect();
            triangles.push(&corners)?;
        }
    }
    Ok(triangles.list)
}

/// What a face needs.
const CORNERS: &str = "corners of a face that were defined before it";

/// What the format wants where `tobj` gave up.
const fn expected(error: LoadError) -> &'static str {
    match error {
        LoadError::PositionParseError => "`v` and three numbers",
        LoadError::FaceParseError | LoadError::InvalidPolygon => "`f` and at least three corners",
        LoadError::FaceVertexOutOfBounds => CORNERS,
        _ => "a line of an OBJ file",
    }
}

/// The corners and faces of a file, line by line, without the normals, textures and names that `tobj` would follow to places that are none; or
/// the line of the first face with a corner that was not defined before it.
fn plain(bytes: &[u8]) -> Result<String, usize> {
    let mut corners = 0u64;
    let mut text = String::with_capacity(bytes.len());
    for (number, line) in bytes.split(|b| *b == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                corners += 1;
                text.push_str(line.trim_end());
            }
            Some("f") => {
                text.push('f');
                for word in words {
                    let corner = word.split('/').next().unwrap_or_default();
                    if corner.parse::<i64>().is_ok_and(|k| k == 0 || k.unsigned_abs() > corners) {
                        return Err(number + 1);
                    }
                    text.push(' ');
                    text.push_str(corner);
                }
            }
            _ => {}
        }
        text.push('\n');
    }
    Ok(text)
}

/// A line of a file, shortened.
fn shown(bytes: &[u8], line: usize) -> String {
    const MOST: usize = 24;
    let text = bytes.split(|b| *b == b'\n').nth(line.saturating_sub(1)).unwrap_or_default();
    let text = String::from_utf8_lossy(&text[..text.len().min(MOST)]).trim().to_owned();
    if text.is_empty() { "an empty line".to_owned() } else { format!("`{text}`") }
}

/// Bytes that count their lines as they are read: `tobj` does not say where it gave up.
struct Lines<'a> {
    rest: &'a [u8],
    line: usize,
}

impl Read for Lines<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let read = self.rest.len().min(into.len());
        into[..read].copy_from_slice(&self.rest[..read]);
        self.consume(read);
        Ok(read)
    }
}

impl BufRead for Lines<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        Ok(self.rest)
    }

    fn consume(&mut self, count: usize) {
        // Whoever reads lines takes one at a time, because all of them are offered.
        self.line += usize::from(count > 0);
        self.rest = &self.rest[count..];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: &str = "# a cube\nmtllib none.mtl\no cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                        vn 0 0 1\nusemtl red\nf 4 3 2 1\nf 5//1 6//1 7//1 8//1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\ng back\nf -8 -4 -1 -5\n";

    fn read(text: &str) -> Result<crate::connector::Surface, Vec<MeshProblem>> {
        let as_it_is = Treatment::AS_IT_IS;
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
    fn what_is_wrong_has_its_line() {
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

    /// One face of the cube is subdivided and its neighbours are not: their edges are divided too, and it is closed.
    #[test]
    fn edges_that_one_side_divides_are_divided_on_the_other() {
        let top = "v .5 0 1\nv 1 .5 1\nv .5 1 1\nv 0 .5 1\nv .5 .5 1\nf 5 9 13 12\nf 9 6 10 13\nf 13 10 7 11\nf 12 13 11 8\n";
        // Corners counted from the end are others now.
        let text = CUBE.replace("f 5//1 6//1 7//1 8//1\n", top).replace("-8 -4 -1 -5", "1 5 8 4");
        let cube = read(&text).unwrap();
        // And are one facet and one edge again.
        assert_eq!((cube.vertices.len(), cube.facets.len(), cube.edges.len()), (8, 6, 12));
        assert!((cube.volume() - 0.125).abs() < 1e-15, "{}", cube.volume());
        // A hole stays one, also beside a divided edge.
        let problems = read(&text.replace("f 2 3 7 6\n", "")).unwrap_err();
        assert!(problems.iter().all(|p| matches!(p, MeshProblem::Open { .. })), "{problems:?}");
        assert_eq!(problems.len(), 5);
    }
}
