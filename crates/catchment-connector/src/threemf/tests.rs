//! Content of 3MF files, and the errors of broken files.

use super::*;
use std::io::Write;
use zip::write::{SimpleFileOptions, ZipWriter};

const CORE: &str = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";

/// An archive of these parts.
fn package(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts {
        archive.start_file(*name, SimpleFileOptions::default()).unwrap();
        archive.write_all(text.as_bytes()).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// A tetrahedron, wound outward.
const MESH: &str = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>\
                    <vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles>\
                    <triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>\
                    <triangle v1=\"1\" v2=\"2\" v3=\"3\"/><triangle v1=\"2\" v2=\"0\" v3=\"3\"/></triangles></mesh>";

fn model(head: &str, resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<model {head} {CORE}>\n<resources>{resources}</resources>\n<build>{build}</build></model>"
    )
}

fn held(bytes: Vec<u8>) -> Result<FileContent, String> {
    read(&FileBytes::whole(bytes)).map_err(|problems| problems[0].to_string())
}

fn of_model(text: &str) -> Result<FileContent, String> {
    held(package(&[(USUAL_MODEL, text)]))
}

/// Six times the volume of each body.
fn volumes(held: &FileContent) -> Vec<f64> {
    let six = |t: &Triangle| t.corners[0].dot(t.corners[1].cross(t.corners[2]));
    held.bodies.iter().map(|body| (body.iter().map(six).sum::<f64>() * 1e9).round() / 1e9).collect()
}

#[test]
fn items_and_components_are_bodies_where_they_are_moved() {
    let one = format!("<object id=\"1\">{MESH}</object>");
    let two = "<object id=\"2\" type=\"model\"><components><component objectid=\"1\"/>\
               <component objectid=\"1\" transform=\"2 0 0 0 1 0 0 0 1 5 0 0\"/></components></object>";
    let support = format!("<object id=\"3\" type=\"support\">{MESH}</object>");
    let items = "<item objectid=\"2\"/><item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/><item objectid=\"3\"/>";
    let result = of_model(&model("unit=\"inch\"", &format!("{one}{two}{support}"), items)).unwrap();
    assert_eq!(result.metres, Some(0.0254));
    // Moved, stretched and mirrored bodies; none of them is turned inside out.
    assert_eq!(volumes(&result), [1.0, 2.0, 1.0]);
    assert_eq!(result.bodies[1][1].corners[1], DVec3::new(7.0, 0.0, 0.0));
    assert_eq!(result.bodies[2][0].place.triangle, 8);
    assert_eq!(of_model(&model("", &one, "<item objectid=\"1\"/>")).unwrap().metres, Some(1e-3));
}

/// As slicers write them: the model is named by a relationship, and its objects are in parts of their own.
#[test]
fn models_may_be_split() {
    let relations = "<Relationships><Relationship Type=\"http://x/thumbnail\" Target=\"/a.png\"/>\
                     <Relationship Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" Target=\"/3D/Root.Model\"/>\
                     </Relationships>";
    let production = "unit=\"meter\" requiredextensions=\"p\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";
    let object = "<object id=\"9\"><components><component p:path=\"/3D/Objects/a.model\" objectid=\"1\"/></components></object>";
    let root = model(production, object, "<item objectid=\"9\"/>");
    let part = model("", &format!("<object id=\"1\">{MESH}</object>"), "");
    let parts = [("_rels/.rels", relations), ("3d/root.model", &root), ("3D/Objects/a.model", &part)];
    let result = held(package(&parts)).unwrap();
    assert_eq!((volumes(&result), result.metres), (vec![1.0], Some(1.0)));
}

#[test]
fn defects_are_reported_with_their_place() {
    let refused = |text: &str| of_model(text).err().unwrap();
    let object =
        |inner: &str| model("", &format!("<object id=\"1\">{inner}</object>"), "<item objectid=\"1\"/>");
    assert!(refused(&object(&MESH.replace("x=\"1\"", "x=\"one\""))).contains("3D/3dmodel.model: byte "));
    assert!(refused(&object(&MESH.replace("x=\"1\" ", ""))).contains("<vertex> has no x"));
    assert!(
        refused(&object(&MESH.replace("v3=\"1\"", "v3=\"7\"")))
            .contains("triangle 0 of object 1 has a corner that is no vertex")
    );
    assert!(refused(&model("unit=\"furlong\"", "", "")).contains("unknown unit `furlong`"));
    assert!(refused(&model("", "", "<item objectid=\"4\"/>")).contains("there is no object 4"));
    assert!(
        refused(&model("requiredextensions=\"b\" xmlns:b=\"http://x/beamlattice/2017\"", "", ""))
            .contains("beamlattice")
    );
    assert!(refused("<model><resources>").contains("cut off"));
    assert!(refused("<svg/>").contains("no model of a 3MF file"));
    assert!(refused("").contains("no XML"));
    let moved = |t: &str| refused(&model("", "", &format!("<item objectid=\"1\" transform=\"{t}\"/>")));
    assert!(moved("1 0 0").contains("not twelve numbers"));
    assert!(moved("0 0 0 0 1 0 0 0 1 0 0 0").contains("flattens"));
    let text = |bytes: &[u8]| held(bytes.to_vec()).err().unwrap();
    assert_eq!(text(b""), "the file is empty");
    assert!(text(b"solid").contains("it is no ZIP archive"));
    assert!(text(&package(&[("Document.xml", "<a/>")])).contains("FreeCAD"));
    let whole = package(&[(USUAL_MODEL, &object(MESH))]);
    assert!(text(&whole[..whole.len() / 2]).contains("export it again"));
    assert_eq!(of_model(&model("", "", "")).unwrap().bodies.len(), 0);
}

/// Small files that would unpack to large content: unpacking stops at the limit.
#[test]
fn expansion_bombs_are_refused() {
    let refused = |text: &str| of_model(text).err().unwrap();
    // Each object contains the previous object twice.
    let twice = |k: u32| {
        let inner = format!("<component objectid=\"{k}\"/>").repeat(2);
        format!("<object id=\"{}\"><components>{inner}</components></object>", k + 1)
    };
    let doubled: String = (0..14).map(twice).collect();
    let last = "<item objectid=\"14\"/>";
    assert!(
        refused(&model("", &format!("<object id=\"0\"/>{doubled}"), last))
            .contains("more than 10000 items and components")
    );
    let itself = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    assert!(
        refused(&model("", itself, "<item objectid=\"1\"/>"))
            .contains("more than 16 components nested in each other")
    );
    let vertices = "<vertex x=\"0\" y=\"0\" z=\"0\"/>".repeat(model::MOST_VERTICES + 1);
    let mesh = format!("<object id=\"1\"><mesh><vertices>{vertices}</vertices></mesh></object>");
    assert!(refused(&model("", &mesh, "")).contains("export a coarser mesh"));
    assert!(refused(&format!("<model a=\"{}\"/>", " ".repeat(3 << 20))).contains("more than 1048576 bytes"));
    assert!(refused(&"<a>".repeat(100)).contains("no model of a 3MF file"));
    assert!(
        refused(&format!("<model>{}", "<a>".repeat(100))).contains("more than 64 elements within each other")
    );
    let comment = format!("<!--{}-->", " ".repeat(1000));
    let long = format!("<model>{}</model>", comment.repeat(MOST_UNPACKED as usize / 1000));
    assert!(refused(&long).contains("unpacks to more than"));
    let many = format!("<model>{}</model>", "<a/>".repeat(4_000_000));
    assert!(refused(&many).contains("more than 4000000 elements: export the solids alone"));
    let crowd = (0..65).map(|k| format!(" a{k}=\"\"")).collect::<Vec<_>>().concat();
    assert!(refused(&model(&crowd, "", "")).contains("byte 22: more than 64 attributes of an element"));
    // A path that is as long as a tag may be, in every component of an object that holds itself.
    let path = format!("<component objectid=\"1\" path=\"{}3D/3dmodel.model\"/>", "/".repeat(1_000_000));
    let itself = format!("<object id=\"1\"><components>{path}</components></object>");
    assert!(
        refused(&model("", &itself, "<item objectid=\"1\"/>"))
            .contains("more than 1024 bytes in the path of a part")
    );
    let names: Vec<String> = (0..10_001).map(|k| format!("{k}")).collect();
    let entries: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "")).collect();
    assert!(held(package(&entries)).err().unwrap().contains("the archive: more than 10000 entries"));
}

/// The same mesh in the same place, repeated any number of times, is one solid; in too many places it is
/// rejected.
#[test]
fn coincident_bodies_are_one() {
    let one = format!("<object id=\"1\">{MESH}</object>");
    let twenty = "<component objectid=\"1\"/>".repeat(20);
    let group = format!("<object id=\"2\"><components>{twenty}</components></object>");
    let items = "<item objectid=\"2\"/>".repeat(20);
    let result = of_model(&model("", &format!("{one}{group}"), &items)).unwrap();
    assert_eq!(volumes(&result), [1.0]);
    // A mirrored or moved copy counts as another body.
    let moved = "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0 0.5\"/><item objectid=\"1\"/>";
    assert_eq!(of_model(&model("", &one, moved)).unwrap().bodies.len(), 2);
    let row = |count: usize| -> String {
        (0..count)
            .map(|k| format!("<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 {k} 0 0\"/>"))
            .collect::<Vec<_>>()
            .concat()
    };
    assert_eq!(of_model(&model("", &one, &row(256))).unwrap().bodies.len(), 256);
    let refused = of_model(&model("", &one, &row(257))).err().unwrap();
    assert_eq!(
        refused,
        "3D/3dmodel.model, object 1: more than 256 bodies: unite the solids before exporting"
    );
}
