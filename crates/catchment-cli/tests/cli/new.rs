//! `catchment new`: the round trip from a template to a design and back.

use super::{catchment, run};

const FAMILIES: [&str; 8] =
    ["v-face", "s-face", "x-face", "pyramid", "cone", "x-face-3d", "x-face-3d-locking", "pin-hole"];

#[test]
fn every_starting_point_is_a_good_design() {
    let dir = tempfile::tempdir().unwrap();
    for family in FAMILIES {
        let file = format!("{family}.toml");
        assert_eq!(run(dir.path(), &["new", family, "-o", &file]), "exit 0\n--- stdout\n--- stderr\n");
        let printed = catchment(dir.path()).args(["new", family]).output().unwrap().stdout;
        assert_eq!(std::fs::read(dir.path().join(&file)).unwrap(), printed);
        let report = run(dir.path(), &["check", &file]);
        assert!(
            report.starts_with(&format!(
                "exit 0\n--- stdout\n{file}\n────────────────────────\n  problems       none\n"
            )),
            "{report}"
        );
        assert!(report.ends_with(&format!("--- stderr\nnext: catchment run {file} -o out\n")), "{report}");
    }
}

#[test]
fn the_new_pyramid_and_its_check_match_snapshots() {
    let dir = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("new_pyramid", run(dir.path(), &["new", "pyramid"]));
    run(dir.path(), &["new", "pyramid", "-o", "design.toml"]);
    insta::assert_snapshot!("check_pyramid", run(dir.path(), &["check", "design.toml"]));
    insta::assert_snapshot!(
        "check_pyramid_changed",
        run(
            dir.path(),
            &["check", "design.toml", "--free", "x,y,yaw", "--cor", "-0.5", "--aspect-ratio", "1", "--json"]
        )
    );
}

#[test]
fn a_file_is_not_replaced_unasked() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("mine.toml"), "precious").unwrap();
    insta::assert_snapshot!("new_over_a_file", run(dir.path(), &["new", "cone", "-o", "mine.toml"]));
    assert_eq!(std::fs::read(dir.path().join("mine.toml")).unwrap(), b"precious");
    run(dir.path(), &["new", "cone", "-o", "mine.toml", "--force"]);
    assert!(std::fs::read_to_string(dir.path().join("mine.toml")).unwrap().contains("\"cone\""));
}

#[test]
fn a_misspelt_family_is_recognised() {
    let dir = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("new_misspelt", run(dir.path(), &["new", "pyramide"]));
}
