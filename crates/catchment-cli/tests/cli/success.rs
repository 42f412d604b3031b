//! The probability that robots dock, through the real binary.

use super::{catchment, designs, json, run};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A V-Face of 50 mm: D/2 = 25 mm to either side where pitch is locked.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let text = "[connector]\nfamily = \"v-face\"\nwidth = 50.0\nunit = \"mm\"\n";
    fs::write(home.path().join("v.toml"), text).unwrap();
    home
}

const QUICK: [&str; 2] = ["--motions", "400"];

fn json_of(folder: &Path, args: &[&str]) -> Value {
    json(folder, &[&["success", "v.toml", "--json"], &QUICK[..], args].concat())
}

#[test]
fn the_success_probability_matches_the_closed_form() {
    let home = home();
    // 25 mm are 2 σ: 95.45 %.
    let report = json_of(home.path(), &["--free", "x", "--error-sigma", "x=12.5 mm"]);
    let ends = [0, 1].map(|k| report["success"]["ci95"][k].as_f64().unwrap());
    assert!(ends[0] < 0.9545 && 0.9545 < ends[1], "{ends:?}");
    assert_eq!(report["robots"][0]["errors"]["sigma"]["x"], 0.25);
    let printed = run(
        home.path(),
        &["success", "v.toml", "--free", "x", "--error-sigma", "x=12.5 mm", "--motions", "400"],
    );
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("errors normal errors, standard deviations σ x 12.500 mm"), "{printed}");
    assert!(printed.contains("nearest failure") && printed.contains("all σ together"), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 1);
}

#[test]
fn each_robot_of_a_file_is_evaluated_and_the_worst_is_reported() {
    let home = home();
    let text = "[[robot]]\nname = \"good\"\nsigma = { x = \"5 mm\", pitch = \"5 deg\" }\n\
        [[robot]]\nname = \"bad\"\ncovariance = { axes = [\"x\", \"pitch\"], units = [\"mm\", \"deg\"], \
        matrix = [[225, 120], [120, 100]] }\n[[robot]]\nname = \"known\"\nmeasured = \"m.csv\"\n";
    fs::write(home.path().join("r.toml"), text).unwrap();
    let rows: Vec<String> = (0..40).map(|k| format!("{},{}", k % 7 - 3, (k * 3) % 11 - 5)).collect();
    fs::write(home.path().join("m.csv"), format!("x_mm,pitch_deg\n{}\n", rows.join("\n"))).unwrap();
    let threads = |n: &str| {
        let mut report = json_of(home.path(), &["--robots", "r.toml", "--threads", n]);
        report["timing"] = Value::Null;
        report
    };
    let report = threads("2");
    assert_eq!(report, threads("1"));
    assert_eq!(report["success"]["robot"], "bad");
    let robots = report["robots"].as_array().unwrap();
    assert_eq!(robots.len(), 3);
    assert!((robots[1]["errors"]["correlation"][0][3].as_f64().unwrap() - 0.8).abs() < 1e-9);
    assert_eq!((&robots[2]["motions"], &robots[2]["grid"]["cells"]), (&40.into(), &0.into()));
    assert!(robots[2]["fit"]["p_value"].is_f64());
}

#[test]
fn a_requirement_decides_the_exit_code_and_files_are_whole() {
    let home = home();
    let with = |require: &str, file: &str| {
        let args = ["success", "v.toml", "--free", "x", "--error-sigma", "x=10 mm", "--require", require];
        catchment(home.path()).args(args).args(QUICK).args(["-o", file]).output().unwrap()
    };
    assert_eq!(with("success.probability>=0.9", "s.csv").status.code(), Some(0));
    let unmet = with("robots.robot.probability>=0.9999", "s.json");
    assert_eq!(unmet.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&unmet.stderr).contains("not met: robots.robot.probability >= 0.9999"));
    assert_eq!(with("robots.0.tolerable.alone.x.sigma>=5 mm", "s.svg").status.code(), Some(0));
    let read = |name: &str| fs::read_to_string(home.path().join(name)).unwrap();
    assert!(
        read("s.csv").starts_with("robot,probability,low,high,axis,") && read("s.csv").lines().count() == 2
    );
    assert_eq!(serde_json::from_str::<Value>(&read("s.json")).unwrap()["kind"], "success");
    assert!(read("s.svg").contains("99 % required"));
}

#[test]
fn the_robots_of_the_designs_are_read() {
    let folder = designs();
    let report = json(
        &folder,
        &["success", "pyramid-stl.toml", "--robots", "robots/robots.toml", "--motions", "100", "--json"],
    );
    assert_eq!(report["robots"].as_array().unwrap().len(), 5);
}
