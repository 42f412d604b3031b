//! `catchment check` on invalid designs.

use super::{designs, json, run};
use std::fs;

/// The report on a file with this content.
fn check(content: &[u8], more: &[&str]) -> String {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("design.toml"), content).unwrap();
    let mut args = vec!["check", "design.toml"];
    args.extend(more);
    run(dir.path(), &args)
}

const SIX_PROBLEMS: &str = "\
schema = 1
name = \"six problems\"

[connector]
family = \"pyramid\"
widht = 50.0
unit = \"furlong\"
aspect_ratio = -0.5
pins = 3

[alignment]
free = [\"x\", \"y\", \"x\"]

[errors]
yaw = 30 deg
";

#[test]
fn six_problems_are_reported_at_once() {
    insta::assert_snapshot!("six_problems", check(SIX_PROBLEMS.as_bytes(), &[]));
    insta::assert_snapshot!("six_problems_json", check(SIX_PROBLEMS.as_bytes(), &["--json"]));
}

#[test]
fn files_that_are_not_designs_are_refused() {
    insta::assert_snapshot!("empty_file", check(b"", &[]));
    insta::assert_snapshot!("binary_file", check(b"\x7fELF\x02\x01\x01\0\xff\xfe\xfd", &[]));
    insta::assert_snapshot!("garbage", check(b"\x01\x02]] = [\n}}\x00", &[]));
    insta::assert_snapshot!("huge_file", check(&vec![b'#'; 5 << 20], &[]));
    let dir = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("missing_file", run(dir.path(), &["check", "design.toml"]));
}

#[test]
fn own_halves_are_checked() {
    let text = "[connector]\nwidth = 50.0\nunit = \"mm\"\nface_height = 10.0\n\
                fixed = { mesh = \"socket.stl\" }\n\
                moving = { pieces = [[[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, \"1 deg\"]], [[1, 2]]] }\n";
    insta::assert_snapshot!("own_halves", check(text.as_bytes(), &[]));
}

/// Two parts drawn docked in one frame, one as OBJ and one as PLY: the interpretation, in their own coordinates, and a picture of it.
#[test]
fn an_assembly_is_shown_as_it_was_understood() {
    insta::assert_snapshot!("assembled", run(&designs(), &["check", "pyramid-assembled.toml"]));
    let report = json(&designs(), &["check", "pyramid-assembled.toml", "--json"]);
    let face = report["drawing"]["fixed"]["face_center"].as_array().unwrap();
    for (result, drawn) in face.iter().zip([120.0, 40.0, 15.0]) {
        assert!((result.as_f64().unwrap() - drawn).abs() < 1e-6, "{report}");
    }
    let dir = tempfile::tempdir().unwrap();
    let design = designs().join("pyramid-assembled.toml");
    for file in ["a.svg", "a.png"] {
        let printout = run(dir.path(), &["check", design.to_str().unwrap(), "-o", file]);
        assert!(printout.starts_with("exit 0\n"), "{printout}");
    }
    let svg = fs::read_to_string(dir.path().join("a.svg")).unwrap();
    assert!(svg.contains("pyramid from an assembly") && svg.contains("mated, cut along the approach"));
    assert!(fs::read(dir.path().join("a.png")).unwrap().starts_with(b"\x89PNG"));
}

/// An unreadable design has no picture.
#[test]
fn a_design_with_problems_has_no_picture() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("design.toml"), SIX_PROBLEMS).unwrap();
    let printout = run(dir.path(), &["check", "design.toml", "-o", "a.svg"]);
    assert!(printout.starts_with("exit 4\n"), "{printout}");
    assert!(!dir.path().join("a.svg").exists());
}

/// Halves that are refused for their contact are drawn at first contact and reported in their own unit.
#[test]
fn halves_that_do_not_mate_are_drawn() {
    let dir = tempfile::tempdir().unwrap();
    let bar = "[[connector.fixed.parts]]\nbox = [40, 40, 10]\n[[connector.moving.parts]]\nbox = [40, 40, 10]\nat = [0, 0, 24]\n";
    let text = format!(
        "[connector]\nunit = \"mm\"\nwidth = 40\ndrawn = \"assembled\"\n{bar}[alignment]\nfree = [\"x\"]\n"
    );
    for (text, printout, words) in [
        (text.clone(), "as drawn the halves are 14 mm apart", "at first contact, cut along the approach"),
        (text.replace("24]", "10]"), "the seat leaves x free: 4 mm off", "mated, cut along the approach"),
    ] {
        fs::write(dir.path().join("design.toml"), text).unwrap();
        let printed = run(dir.path(), &["check", "design.toml", "-o", "a.svg", "--force"]);
        assert!(printed.starts_with("exit 4\n") && printed.contains(printout), "{printed}");
        assert!(fs::read_to_string(dir.path().join("a.svg")).unwrap().contains(words));
    }
}

const BOX: &str = "[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]]";

#[test]
fn geometry_errors_are_reported_with_their_place() {
    let flat = format!(
        "[connector]\nface_height = 1\n\n[connector.fixed]\npieces = [\n  {BOX},\n  \
         [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]],\n]\n\n[connector.moving]\npieces = [{BOX}]\n"
    );
    insta::assert_snapshot!("flat_piece", check(flat.as_bytes(), &[]));
    let overlapping = format!(
        "[connector]\nface_height = 0.5\nfixed.pieces = [{BOX}]\nmoving.pieces = [{BOX}]\n\
         [alignment]\nfree = [\"x\"]\n"
    );
    insta::assert_snapshot!("overlapping_halves", check(overlapping.as_bytes(), &[]));
}

#[test]
fn an_empty_mesh_is_refused_and_no_files_are_left() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("half.stl"), b"").unwrap();
    let text = "[connector]\nface_height = 0.5\nfixed.mesh = \"half.stl\"\nmoving.mesh = \"half.stl\"\n";
    fs::write(dir.path().join("design.toml"), text).unwrap();
    insta::assert_snapshot!("empty_mesh", run(dir.path(), &["check", "design.toml"]));
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
}

#[test]
fn options_are_validated_like_the_file() {
    let planar = b"[connector]\nfamily = \"v-face\"\n";
    insta::assert_snapshot!("free_leaves_the_plane", check(planar, &["--free", "x,yaw"]));
    insta::assert_snapshot!("ratio_out_of_range", check(planar, &["--aspect-ratio", "-1"]));
    insta::assert_snapshot!("cor_without_unit", check(planar, &["--cor", "5 mm"]));
    insta::assert_snapshot!("free_misspelt", check(planar, &["--free", "x,pich"]));
}

/// The example of a kinematic coupling against its closed form: a hexagon of area 2 √3 h², h = 5 mm.
#[test]
fn balls_in_grooves_are_checked_and_answered() {
    let printed = run(&designs(), &["check", "kelvin-balls.toml"]);
    assert!(printed.starts_with("exit 0"), "{printed}");
    assert!(printed.contains("fixed half        cylinder, 3 × profile\n"), "{printed}");
    assert!(printed.contains("moving half       cylinder, 3 × ball\n"), "{printed}");
    assert!(printed.contains("made of facets, at most 0.001 D = 0.06 mm inside the surface\n"), "{printed}");
    let printed = run(&designs(), &["zraa", "kelvin-balls.toml"]);
    assert!(printed.contains("= 86.602540 mm²"), "{printed}");
}

/// A drawing, a file of two overlapping bodies, and a primitive: one half.
#[test]
fn a_half_of_files_and_primitives_lists_its_parts() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(dir.path().join(name), text).unwrap();
    let rows = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let cube = |side: f64, shift: f64| -> String {
        let at = |k: u8| {
            let c = |bit: u8| f64::from(k >> bit & 1) * side + shift;
            format!("vertex {} {} {}\n", c(0), c(1), c(2))
        };
        let facet =
            |t: [u8; 3]| format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", t.map(at).concat());
        rows.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).map(facet).collect()
    };
    write(
        "two.stl",
        &format!("solid a\n{}endsolid a\nsolid b\n{}endsolid b\n", cube(20.0, 0.0), cube(10.0, 15.0)),
    );
    write(
        "plate.svg",
        "<svg width='50mm' viewBox='0 0 50 50'><rect width='50' height='50'/><circle cx='40' cy='40' r='5'/></svg>",
    );
    let design = "[connector]\nwidth = 50.0\nunit = \"mm\"\n\
                  [connector.fixed]\nparts = [{ profile = \"plate.svg\", height = 5, at = [-25, 25, -5] }]\n\
                  [[connector.moving.parts]]\nmesh = \"two.stl\"\nunit = \"mm\"\nat = [-12.5, -12.5, 0]\n\
                  [[connector.moving.parts]]\nsphere = { radius = 5 }\n\
                  [[connector.moving.parts]]\nbox = [30, 30, 5]\nat = [0, 0, 21]\n\
                  [alignment]\nfree = [\"roll\"]\n";
    write("d.toml", design);
    let printed = json(dir.path(), &["check", "d.toml", "--json"]);
    let parts = &printed["design"]["connector"]["own"]["moving"]["parts"];
    assert!(parts[0]["shape"]["mesh"]["content"]["repairs"]["united"].as_u64() > Some(0), "{printed:#}");
    assert_eq!(
        printed["design"]["connector"]["own"]["fixed"]["parts"][0]["shape"]["profile"]["outline"]["file"]["unit"],
        "in-file"
    );
    let printed = run(dir.path(), &["check", "d.toml"]);
    assert!(printed.contains("mesh two.stl, ball, box\n") && printed.contains("two.stl: "), "{printed}");
    assert!(
        printed.split_whitespace().collect::<Vec<_>>().join(" ").contains("resolved; its shape is unchanged"),
        "{printed}"
    );
    assert!(printed.contains("fixed half        profile plate.svg\n"), "{printed}");
}
