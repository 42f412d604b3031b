//! The window, through the real binary.

use super::{catchment, json, run};
use serde_json::Value;
use std::fs;

/// A V-Face of 50 mm: D/2 = 25 mm to either side where pitch is locked.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let text = "[connector]\nfamily = \"v-face\"\nwidth = 50.0\nunit = \"mm\"\n";
    fs::write(home.path().join("v.toml"), text).unwrap();
    home
}

fn half_width(report: &Value, axis: &str) -> f64 {
    report["window"][axis].as_f64().unwrap()
}

#[test]
fn the_window_matches_the_closed_form_and_writes_no_files() {
    let home = home();
    let printed = run(home.path(), &["window", "v.toml", "--free", "x", "--motions", "2000"]);
    assert!(printed.contains("±24.97"), "{printed}");
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    let certificate =
        "0 failures in 2 000 poses sampled in the window: failure rate below 1 in 666 (95 % confidence)";
    assert!(words.contains(certificate), "{printed}");
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 1);
}

#[test]
fn fixed_half_widths_stay_and_threads_change_nothing() {
    let home = home();
    let given = |threads: &str, x: &str| {
        let fix = format!("x={x}");
        let args = ["window", "v.toml", "--fix", &fix, "--motions", "3000", "--json", "--threads", threads];
        let mut report = json(home.path(), &args);
        report["timing"] = Value::Null;
        report
    };
    let two = given("2", "2 mm");
    assert_eq!(two, given("1", "2 mm"));
    assert!((half_width(&two, "x") - 0.04).abs() < 1e-12);
    assert!(half_width(&two, "pitch") > half_width(&given("2", "12 mm"), "pitch"));
    assert!(
        two["worst"]["outcome"] != "aligned"
            && two["certificate"]["failing_at_most"].as_f64().unwrap() < 0.002
    );
}

#[test]
fn a_requirement_decides_the_exit_code_and_files_are_whole() {
    let home = home();
    let with = |require: &str, more: &[&str]| {
        let args =
            [&["window", "v.toml", "--free", "x", "--motions", "0", "--require", require][..], more].concat();
        catchment(home.path()).args(args).output().unwrap()
    };
    assert_eq!(with("window.x>=24.5 mm", &["-o", "w.csv"]).status.code(), Some(0));
    let unmet = with("window.x>=0.51", &["-o", "w.json"]);
    assert_eq!(unmet.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&unmet.stderr).contains("not met: window.x >= 0.51"));
    let csv = fs::read_to_string(home.path().join("w.csv")).unwrap();
    assert!(csv.starts_with("axis,half_width,given,") && csv.lines().count() == 2);
    let kept: Value = serde_json::from_str(&fs::read_to_string(home.path().join("w.json")).unwrap()).unwrap();
    assert_eq!(kept["kind"], "window");
}

/// `run` and `window` report the same window under the same names.
#[test]
fn run_and_window_report_the_same_window() {
    let home = tempfile::tempdir().unwrap();
    // Round halves have fewer motions.
    let text = "[connector]\nfamily = \"cone\"\nwidth = 50.0\nunit = \"mm\"\n";
    fs::write(home.path().join("c.toml"), text).unwrap();
    let requested = ["run", "c.toml", "--free", "x", "--resolution", "9", "--samples", "50", "--seed", "3"];
    let required = ["--window", "-o", "out", "--require", "window.x>=24 mm", "--require", "window.x>=26 mm"];
    let text = run(home.path(), &[&requested[..], &required].concat());
    assert!(text.starts_with("exit 1\n") && text.contains("±24.97"), "{text}");
    assert!(
        text.contains("not met: window.x >= 26 mm") && !text.contains("not met: window.x >= 24 mm"),
        "{text}"
    );
    assert!(text.contains("0 failures in "), "{text}");
    let result: Value =
        serde_json::from_slice(&fs::read(home.path().join("out/report.json")).unwrap()).unwrap();
    let alone = json(home.path(), &["window", "c.toml", "--free", "x", "--seed", "3", "--json"]);
    let printed = result["window"].as_object().unwrap();
    assert_eq!(result["window"]["x"], alone["window"]["x"]);
    assert!(printed.get("roll").is_none());
    for (key, value) in printed.iter().filter(|(key, _)| *key != "x") {
        assert_eq!(*value, alone[key], "{key}");
    }
    // Reading it back gives the same window.
    assert!(run(home.path(), &["compare", "out", "out"]).starts_with("exit 0\n"));
}
