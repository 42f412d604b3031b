//! `catchment latch`: rules, forces, drawings, and the table of measured prototypes.

use crate::{catchment, designs, entries, json, run, written};
use std::fs;
use std::path::Path;

/// A folder with a latch in it.
fn home(text: &str) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("l.toml"), text).unwrap();
    dir
}

#[test]
fn the_defaults_are_the_dissertations_part() {
    let home = home("[latch]\n");
    let report = json(home.path(), &["latch", "l.toml", "--json"]);
    assert_eq!(
        (report["kind"].as_str(), report["warnings"].as_array().map(Vec::len)),
        (Some("latch"), Some(0))
    );
    let near = |pointer: &str, value: f64, by: f64| {
        let result = report.pointer(pointer).and_then(serde_json::Value::as_f64).unwrap();
        assert!((result - value).abs() < by, "{pointer} is {result}, not {value}");
    };
    near("/stiffness_nm_per_rad", 5.0006, 5e-5);
    near("/latching/force_n", 13.35, 0.01);
    near("/failure/force_n", 640.9, 0.1);
    near("/outline/end_deg", 75.7, 0.05);
    assert!(report["rules"].as_array().unwrap().iter().all(|rule| rule["verdict"] == "holds"));
    assert_eq!(entries(home.path()), ["l.toml"]);
    let printout = run(home.path(), &["latch", "l.toml"]);
    assert!(
        printout.starts_with("exit 0")
            && printout.contains("5.0006 N·m/rad")
            && printout.ends_with("--- stderr\n"),
        "{printout}"
    );
}

#[test]
fn a_folder_has_every_sheet_and_picture_and_the_same_bytes_each_time() {
    let home = tempfile::tempdir().unwrap();
    let design = designs().join("systems/latch.toml");
    let args = |out: &'static str| ["latch", design.to_str().unwrap(), "-o", out].map(str::to_owned);
    for out in ["a", "b"] {
        let output = catchment(home.path()).args(args(out)).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let names = written(&home.path().join("a"));
    for sheet in ["front", "back", "separator"] {
        for ending in [".dxf", "-cut.dxf", "-cut.svg"] {
            assert!(names.contains(&format!("{sheet}{ending}")), "{names:?}");
        }
    }
    for name in ["latch.png", "chart.svg", "sequence.png", "press.csv", "connector.toml", "report.json"] {
        assert!(names.contains(&name.to_owned()), "{name}");
    }
    for name in &names {
        let [a, b] = ["a", "b"].map(|out| fs::read(home.path().join(out).join(name)).unwrap());
        assert!(a == b, "{name} differs");
    }
    // The same command replaces its own folder, and no other owner's.
    assert!(catchment(home.path()).args(args("a")).status().unwrap().success());
    fs::write(home.path().join("a/mine.txt"), "mine").unwrap();
    let printout = run(home.path(), &["latch", design.to_str().unwrap(), "-o", "a"]);
    assert!(printout.starts_with("exit 2"), "{printout}");
    assert!(home.path().join("a/mine.txt").exists());
}

/// The aligning part of the face is a design that the other commands read.
#[test]
fn the_connector_that_is_written_slides_into_place_from_a_whole_width() {
    let home = home("[latch]\n");
    assert!(run(home.path(), &["latch", "l.toml", "-o", "out"]).starts_with("exit 0"));
    let zraa = json(home.path(), &["zraa", "out/connector.toml", "--json"]);
    assert!((zraa["length_d"].as_f64().unwrap() - 2.0).abs() < 1e-6, "{zraa}");
}

#[test]
fn the_table_stands_beside_the_model() {
    let home = tempfile::tempdir().unwrap();
    let table = json(home.path(), &["latch", "--table", "--json"]);
    let rows = table["rows"].as_array().unwrap();
    assert_eq!((table["kind"].as_str(), rows.len()), (Some("latch-table"), 9));
    for row in rows {
        let [ratio, printed] = ["ratio", "bonding_ratio"].map(|key| row[key].as_f64().unwrap());
        assert!((ratio - printed).abs() <= 0.0501, "{row}");
    }
    assert!((table["neck_line_n_per_mm"].as_f64().unwrap() - 213.6).abs() < 0.05);
    let printout = run(home.path(), &["latch", "--table", "-o", "t.csv"]);
    assert!(
        printout.contains("213.6 N/mm") && printout.contains("six designs were tested; the table has nine"),
        "{printout}"
    );
    let csv = fs::read_to_string(home.path().join("t.csv")).unwrap();
    assert_eq!(csv.lines().count(), 10);
    assert!(run(home.path(), &["latch", "--table", "-o", "chart.svg"]).starts_with("exit 0"));
    assert!(fs::read_to_string(home.path().join("chart.svg")).unwrap().contains("did not latch"));
}

/// The 1.27 mm latch was made and abandoned: it is computed, with the reason for rejecting it.
#[test]
fn an_overhang_that_failed_is_warned_of() {
    let home = home("[latch]\noverhang = 1.27\n");
    let printout = run(home.path(), &["latch", "l.toml"]);
    let (stdout, stderr) = printout.split_once("--- stderr\n").unwrap();
    let warnings = stderr.strip_prefix("warning: ").unwrap();
    let warnings = warnings.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(printout.starts_with("exit 0") && warnings.contains("less than 1 mm"), "{printout}");
    assert!(!stdout.contains("warning: "), "{printout}");
}

#[test]
fn a_design_may_come_from_a_pipe_but_needs_to_come() {
    let home = tempfile::tempdir().unwrap();
    let printout = run(home.path(), &["latch"]);
    assert!(printout.starts_with("exit 2") && printout.contains("<DESIGN>"), "{printout}");
    let printout = run(home.path(), &["latch", "no.toml"]);
    assert!(printout.starts_with("exit 3") && printout.contains("cannot read no.toml"), "{printout}");
    assert_eq!(entries(home.path()).len(), 0);
    assert!(Path::new(&designs().join("systems/latch.toml")).exists());
}
