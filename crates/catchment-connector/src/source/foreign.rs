//! Recognises files that are not meshes by their first bytes. A name's extension alone proves little, and a
//! mesh reader's messages about such files do not help.

use crate::mesh::MeshProblem;

/// Description of a ZIP archive that is not a 3MF.
pub(crate) const ZIP: &str = "a ZIP archive, such as a FreeCAD or Fusion file (a 3MF ends in .3mf): export the part as STL, OBJ, PLY or 3MF, or unpack it";

/// Description of a STEP file with another extension.
const STEP: &str =
    "a STEP file, which holds curved faces and no triangles: let its name end in .step or .stp";

/// First bytes of files of other types, and their descriptions.
const KINDS: [(&[u8], &str); 14] = [
    (
        b"version https://git-lfs",
        "a Git LFS pointer, not the file it stands for: fetch that with `git lfs pull`, or download it from the repository's page",
    ),
    (b"ISO-10303-21", STEP),
    (b"PK\x03\x04", ZIP),
    (b"\x1f\x8b", "a file packed by gzip: unpack it"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive: unpack it"),
    (b"glTF", "a glTF file: export the part as STL, OBJ or PLY"),
    (b"\xd0\xcf\x11\xe0", "a document of a CAD or office program: export the part as STL, OBJ or PLY"),
    (
        b"DBRep_DrawableShape",
        "an OpenCASCADE BREP file, which holds curved faces and no triangles: export the part as STL, OBJ or PLY",
    ),
    (b"<!DOCTYPE html", "a web page: what was downloaded is not the file itself"),
    (b"<!doctype html", "a web page: what was downloaded is not the file itself"),
    (b"<html", "a web page: what was downloaded is not the file itself"),
    (b"%PDF", "a PDF: drawings have no solid"),
    (b"\x89PNG", "a picture (PNG): it has no solid"),
    (b"\xff\xd8\xff", "a picture (JPEG): it has no solid"),
];

/// The part of a 3MF that contains its solids, which distinguishes its archive from others.
const MODEL: &[u8] = b"3D/3dmodel.model";

/// Header and count of a binary STL, in bytes: the count of any file that can be read has a byte that no text has.
const HEADER: usize = 84;

/// Whether some bytes begin like text.
fn is_text(bytes: &[u8]) -> bool {
    bytes.len() >= HEADER
        && bytes[..HEADER].iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace())
}

/// Whether a name stands in some bytes.
fn holds(bytes: &[u8], name: &[u8]) -> bool {
    bytes.windows(name.len()).any(|window| window == name)
}

/// Rejects files whose first bytes belong to no mesh; among the formats with such an extension one may be an
/// archive.
pub(super) fn refuse(bytes: &[u8], endings: &[&str]) -> Result<(), Vec<MeshProblem>> {
    let bytes = bytes.trim_ascii_start();
    let may_be =
        |what: &str| what == ZIP && endings.contains(&"3mf") || what == STEP && endings.contains(&"step");
    if bytes.starts_with(b"PK\x03\x04") && !endings.contains(&"3mf") && holds(bytes, MODEL) {
        let what = "a 3MF: let its name end in .3mf";
        return Err(vec![MeshProblem::Foreign { what }]);
    }
    match KINDS.iter().find(|(start, what)| bytes.starts_with(start) && !may_be(what)) {
        Some((_, what)) => Err(vec![MeshProblem::Foreign { what }]),
        None if endings.contains(&"stl") && is_text(bytes) && !bytes[..5].eq_ignore_ascii_case(b"solid") => {
            let what = "text, and no STL: those begin with solid, or are binary";
            Err(vec![MeshProblem::Foreign { what }])
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foreign_file_called_stl_is_reported_by_its_format() {
        let refused = |bytes: &[u8]| refuse(bytes, &["stl"]).unwrap_err()[0].to_string();
        let archive = [b"PK\x03\x04".as_slice(), &[0; 40], MODEL].concat();
        assert!(refused(&archive).contains("a 3MF: let its name end in .3mf"));
        assert!(refused(b"PK\x03\x04 others").contains("ZIP"));
        assert!(refused(b"\x89PNG\r\n\x1a\n").contains("picture"));
        let design = "schema = 1\nname = \"a design that someone has called part.stl, as happens to files\"\nwidth = 1.0\n";
        assert!(refused(design.as_bytes()).contains("text, and no STL"));
        // Files that may be STL, and a 3MF archive in a place that accepts 3MF.
        let binary = [[b'a'; 80].as_slice(), &12u32.to_le_bytes(), &[0; 600]].concat();
        for fine in [
            binary.as_slice(),
            b"solid part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n",
        ] {
            assert_eq!(refuse(fine, &["stl"]), Ok(()));
        }
        assert_eq!(refuse(&archive, &["3mf"]), Ok(()));
    }
}
