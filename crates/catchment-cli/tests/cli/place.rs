//! `catchment place`: from two files to a design, to what it forgives.

use crate::{catchment, designs, entries, run};
use std::fs;
use std::path::Path;

/// A folder with the two parts of the committed designs.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let meshes = designs().join("meshes");
    fs::create_dir(home.path().join("parts")).unwrap();
    for name in ["socket.stl", "plug.stl", "assembled-socket.obj", "assembled-plug.ply"] {
        fs::copy(meshes.join(name), home.path().join("parts").join(name)).unwrap();
    }
    home
}

const PARTS: [&str; 4] = ["place", "parts/socket.stl", "parts/plug.stl", "--unit=mm"];

/// The heights of the proposed design, from the outcomes of one list of errors.
fn outcomes(folder: &Path, design: &str) -> String {
    fs::write(folder.join("poses.csv"), "x_mm,y_mm,pitch_deg\n3,1,0\n-5,4,0\n0,0,8\n40,0,0\n").unwrap();
    let told = run(folder, &["outcome", design, "--poses", "poses.csv"]);
    assert!(told.starts_with("exit 0"), "{told}");
    told
}

#[test]
fn two_files_become_a_design_that_answers() {
    let home = home();
    let told = run(home.path(), &[&PARTS[..], &["-o", "design.toml", "--figure", "pair.svg"]].concat());
    insta::assert_snapshot!("place_pyramid", told);
    insta::assert_snapshot!(
        "place_pyramid_design",
        fs::read_to_string(home.path().join("design.toml")).unwrap()
    );
    assert!(fs::read_to_string(home.path().join("pair.svg")).unwrap().contains("plug on socket"));
    let checked = run(home.path(), &["check", "design.toml"]);
    assert!(checked.starts_with("exit 0") && checked.contains("width D             50 mm"), "{checked}");
    let answered = outcomes(home.path(), "design.toml");
    // The committed design with its centre of rotation in the face centre.
    fs::copy(designs().join("pyramid-stl.toml"), home.path().join("true.toml")).unwrap();
    let text = fs::read_to_string(home.path().join("true.toml")).unwrap();
    let text =
        text.replace("meshes/", "parts/").replace("center_of_rotation = 0.5", "center_of_rotation = 0.0");
    fs::write(home.path().join("true.toml"), text).unwrap();
    let words = |told: &str| {
        told.lines()
            .flat_map(|line| line.split(','))
            .filter(|word| ["aligned", "jammed", "missed", "undecided"].contains(word))
            .map(ToOwned::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(words(&answered), words(&outcomes(home.path(), "true.toml")));
    assert!(!words(&answered).is_empty(), "{answered}");
}

#[test]
fn an_assembly_is_recognised_and_paths_lead_from_the_design() {
    let home = home();
    fs::create_dir(home.path().join("designs")).unwrap();
    let parts = ["place", "parts/assembled-socket.obj", "parts/assembled-plug.ply", "--unit", "mm"];
    let told = run(home.path(), &[&parts[..], &["-o", "designs/pair.toml"]].concat());
    insta::assert_snapshot!("place_assembly", told);
    let text = fs::read_to_string(home.path().join("designs/pair.toml")).unwrap();
    assert!(text.contains("mesh = \"../parts/assembled-socket.obj\""), "{text}");
    assert!(text.contains("approach = \"+y\"") && text.contains("drawn = \"assembled\""), "{text}");
    assert!(run(home.path(), &["check", "designs/pair.toml"]).starts_with("exit 0"));
    // The same parts, as if each were in a frame of its own.
    let apart = run(home.path(), &[&parts[..], &["--drawn", "facing"]].concat());
    assert!(apart.starts_with("exit 0") && apart.contains("facing = \"-y\""), "{apart}");
}

#[test]
fn a_design_is_replaced_only_when_asked() {
    let home = home();
    fs::write(home.path().join("mine.toml"), "precious").unwrap();
    let again = |more: &[&str]| run(home.path(), &[&PARTS[..], &["-o", "mine.toml"], more].concat());
    let refused = again(&[]);
    assert!(refused.starts_with("exit 2") && refused.contains("--force replaces it"), "{refused}");
    assert_eq!(fs::read(home.path().join("mine.toml")).unwrap(), b"precious");
    assert!(again(&["--force", "--name", "ours"]).starts_with("exit 0"));
    assert!(fs::read_to_string(home.path().join("mine.toml")).unwrap().contains("name = \"ours\""));
}

#[test]
fn parts_that_do_not_dock_are_told_and_nothing_is_written() {
    let home = home();
    let parts = ["place", "parts/socket.stl", "parts/socket.stl", "--unit", "mm", "--facing-fixed=-z"];
    let output =
        catchment(home.path()).args(parts).args(["-o", "d.toml", "--figure", "d.png"]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("the parts dock in no direction") && told.contains("--facing-moving"), "{told}");
    assert_eq!(entries(home.path()), ["parts"]);
}
