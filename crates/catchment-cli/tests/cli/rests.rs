//! Rests, through the real binary.

use super::{catchment, json, run};
use serde_json::Value;
use std::fs;

/// A cube of 50 mm on a plane, its centre of rotation in its middle, with pitch as the only free error.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let text = "[connector]\nwidth = 50.0\nunit = \"mm\"\n[[connector.fixed.parts]]\nbox = [300, 300, 20]\n\
                [[connector.moving.parts]]\nbox = [50, 50, 50]\n[alignment]\nfree = [\"pitch\"]\ncenter_of_rotation = -0.5\n\
                rotation_length = 0.5\n[errors]\npitch = \"80 deg\"\n";
    fs::write(home.path().join("cube.toml"), text).unwrap();
    home
}

#[test]
fn the_escape_height_of_a_cube_matches_the_closed_form() {
    let home = home();
    let report = json(home.path(), &["rests", "cube.toml", "--motions", "300", "--json"]);
    // (√2 − 1)/2; the search samples the path at every thousandth of its radius.
    let depth = report["rests"][0]["depth_at_most_d"].as_f64().unwrap();
    assert!((depth - 0.5 * (2f64.sqrt() - 1.0)).abs() < 1e-4, "{depth}");
    assert_eq!(report["rests"][0]["examined"]["immobility"]["order"], "first");
    // D/2 per radian, in a metric of D/2 per radian.
    assert!((report["rests"][0]["examined"]["immobility"]["slope"][0].as_f64().unwrap() - 1.0).abs() < 1e-4);
    let printed = run(home.path(), &["rests", "cube.toml", "--motions", "300"]);
    assert!(
        printed.starts_with("exit 0\n")
            && printed
                .contains("escape height at most 10.36 mm: raised by this on the easiest path found, it"),
        "{printed}"
    );
    assert!(printed.contains("first-order immobile: any small displacement raises the COR"), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
}

#[test]
fn threads_change_nothing_and_files_are_whole() {
    let home = home();
    let with = |threads: &str| {
        let args = ["rests", "cube.toml", "--motions", "200", "--json", "--threads", threads];
        let mut report = json(home.path(), &args);
        report["timing"] = Value::Null;
        report
    };
    assert_eq!(with("1"), with("2"));
    assert_eq!(with("1"), with("4"));
    for (file, begins) in [("r.svg", "<svg"), ("r.csv", "rest,count,share,"), ("r.json", "{\n")] {
        let printed = run(home.path(), &["rests", "cube.toml", "--motions", "200", "-o", file]);
        assert!(printed.starts_with("exit 0\n"), "{printed}");
        assert!(fs::read_to_string(home.path().join(file)).unwrap().starts_with(begins));
    }
}

#[test]
fn a_requirement_decides_the_exit_code() {
    let home = home();
    let code = |require: &str| {
        let args = ["rests", "cube.toml", "--motions", "200", "--require", require];
        catchment(home.path()).args(args).output().unwrap().status.code()
    };
    assert_eq!(code("rests.0.depth_at_most_d>=0.2"), Some(0));
    assert_eq!(code("rests.0.depth_at_most_d>=0.21"), Some(1));
}
