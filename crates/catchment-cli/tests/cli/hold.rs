//! Holding forces of a half, through the real binary.

use super::{catchment, json, run};
use serde_json::Value;
use std::fs;

/// A V-Face of 50 mm with flanks of slope 2.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let text = "[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\nwidth = 50.0\nunit = \"mm\"\n[alignment]\nrotation_length = 1.0\n";
    fs::write(home.path().join("v.toml"), text).unwrap();
    home
}

#[test]
fn the_holding_force_matches_the_closed_form_in_newtons() {
    let home = home();
    let printed =
        run(home.path(), &["hold", "v.toml", "--free", "x", "--preload", "40", "--friction", "0.1"]);
    // 40 N · tan(arctan 2 + arctan 0.1) = 40 · 2.1/0.8.
    assert!(printed.contains("80.00") && printed.contains("105.0"), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    let report = json(home.path(), &["hold", "v.toml", "--free", "x", "--json"]);
    assert!((report["least_force"].as_f64().unwrap() - 2.0).abs() < 1e-5);
    assert_eq!(report["least_torque"], Value::Null);
}

#[test]
fn threads_change_nothing_and_files_are_whole() {
    let home = home();
    let with = |threads: &str| {
        let args = ["hold", "v.toml", "--friction", "0.2", "--json", "--threads", threads];
        let mut report = json(home.path(), &args);
        report["timing"] = Value::Null;
        report
    };
    assert_eq!(with("1"), with("2"));
    assert_eq!(with("1"), with("4"));
    for (file, begins) in [("h.svg", "<svg"), ("h.csv", "load,direction_rad,"), ("h.json", "{\n")] {
        let printed = run(home.path(), &["hold", "v.toml", "-o", file]);
        assert!(printed.starts_with("exit 0\n"), "{printed}");
        assert!(fs::read_to_string(home.path().join(file)).unwrap().starts_with(begins));
    }
    // Two lateral directions and two torques.
    assert_eq!(fs::read_to_string(home.path().join("h.csv")).unwrap().lines().count(), 5);
}

#[test]
fn a_requirement_decides_the_exit_code() {
    let home = home();
    let code = |require: &str| {
        let args = ["hold", "v.toml", "--free", "x", "--require", require];
        catchment(home.path()).args(args).output().unwrap().status.code()
    };
    assert_eq!(code("least_force>=1.99"), Some(0));
    assert_eq!(code("least_force>=2.01"), Some(1));
}
