//! `catchment check` on designs that are not.

use super::run;
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
fn files_that_are_no_designs() {
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

#[test]
fn changes_obey_the_rules_of_the_file() {
    let planar = b"[connector]\nfamily = \"v-face\"\n";
    insta::assert_snapshot!("free_leaves_the_plane", check(planar, &["--free", "x,yaw"]));
    insta::assert_snapshot!("ratio_out_of_range", check(planar, &["--aspect-ratio", "-1"]));
    insta::assert_snapshot!("cor_without_unit", check(planar, &["--cor", "5 mm"]));
    insta::assert_snapshot!("free_misspelt", check(planar, &["--free", "x,pich"]));
}
