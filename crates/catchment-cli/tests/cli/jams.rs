//! Jams, through the real binary.

use super::{catchment, json, run};
use serde_json::Value;
use std::fs;

/// A V-Face of 50 mm whose tip can come to lie on its side in the notch.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let text =
        "[connector]\nfamily = \"v-face\"\nwidth = 50.0\nunit = \"mm\"\n[alignment]\nrotation_length = 1.0\n";
    fs::write(home.path().join("v.toml"), text).unwrap();
    home
}

#[test]
fn two_mirrored_rests_are_one_jam_and_shares_add_up() {
    let home = home();
    let report =
        json(home.path(), &["jams", "v.toml", "--motions", "1000", "--error-sigma", "x=10 mm", "--json"]);
    let share = |report: &Value| report["share"].as_f64().unwrap();
    for outcomes in ["outcomes", "expected"] {
        let outcomes = report[outcomes].as_object().unwrap();
        assert!((outcomes.values().map(share).sum::<f64>() - 1.0).abs() < 1e-12);
    }
    let jams = report["jams"].as_array().unwrap();
    let in_jams: f64 = jams.iter().map(|jam| share(&jam["of_box"])).sum();
    assert!((in_jams - share(&report["outcomes"]["jammed"])).abs() < 1e-12);
    assert_eq!(jams[0]["places"], 2);
    let printed = run(home.path(), &["jams", "v.toml", "--motions", "1000"]);
    assert!(printed.starts_with("exit 0\n") && printed.contains("at 2 symmetric places"), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
}

#[test]
fn threads_change_nothing_and_files_are_whole() {
    let home = home();
    let with = |threads: &str| {
        let args = ["jams", "v.toml", "--motions", "400", "--json", "--threads", threads];
        let mut report = json(home.path(), &args);
        report["timing"] = Value::Null;
        report
    };
    assert_eq!(with("1"), with("2"));
    assert_eq!(with("1"), with("4"));
    for (file, begins) in [("j.svg", "<svg"), ("j.csv", "jam,count,share,"), ("j.json", "{\n")] {
        let printed = run(home.path(), &["jams", "v.toml", "--motions", "200", "-o", file]);
        assert!(printed.starts_with("exit 0\n"), "{printed}");
        assert!(fs::read_to_string(home.path().join(file)).unwrap().starts_with(begins));
    }
    let csv = fs::read_to_string(home.path().join("j.csv")).unwrap();
    let columns = csv.lines().next().unwrap().split(',').count();
    let mut table = csv::Reader::from_reader(csv.as_bytes());
    assert!(table.records().all(|record| record.unwrap().len() == columns));
}

#[test]
fn a_requirement_decides_the_exit_code() {
    let home = home();
    let code = |require: &str| {
        let args = ["jams", "v.toml", "--motions", "300", "--require", require];
        catchment(home.path()).args(args).output().unwrap().status.code()
    };
    assert_eq!(code("outcomes.jammed.share<=0.3"), Some(0));
    assert_eq!(code("outcomes.jammed.share<=0.01"), Some(1));
}

/// `jams` follows each measured error once; one robot in a file represents every way to write them.
#[test]
fn errors_that_were_measured_and_covariances_have_their_shares() {
    let home = home();
    let rows: Vec<String> = (0..40).map(|k| format!("{},{}", 2 * (k % 7) - 6, (k * 13) % 90 - 45)).collect();
    fs::write(home.path().join("m.csv"), format!("x_mm,pitch_deg\n{}\n", rows.join("\n"))).unwrap();
    let jams = |more: &[&str]| {
        json(home.path(), &[&["jams", "v.toml", "--motions", "200", "--json"], more].concat())
    };
    let measured = jams(&["--error-measured", "m.csv"]);
    let counts = |report: &Value| -> u64 {
        report["expected"].as_object().unwrap().values().map(|share| share["count"].as_u64().unwrap()).sum()
    };
    assert_eq!((counts(&measured), &measured["measured"]), (40, &"m.csv".into()));
    let robot = "[[robot]]\nname = \"arm\"\ncovariance = { axes = [\"x\", \"pitch\"], units = [\"mm\", \"deg\"], \
                 matrix = [[225, 120], [120, 100]] }\n";
    fs::write(home.path().join("r.toml"), robot).unwrap();
    let correlated = jams(&["--robots", "r.toml"]);
    assert_eq!((counts(&correlated), &correlated["settings"]["errors"]["kind"]), (200, &"correlated".into()));
    assert_eq!(correlated["outcomes"], measured["outcomes"]);
    fs::write(home.path().join("two.toml"), robot.to_owned() + &robot.replace("arm", "other")).unwrap();
    let refused = run(home.path(), &["jams", "v.toml", "--robots", "two.toml"]);
    assert!(
        refused.starts_with("exit 2") && refused.contains("has 2 robots, and this command takes one"),
        "{refused}"
    );
    let code = catchment(home.path())
        .args(["jams", "v.toml", "--motions", "200", "--error-measured", "m.csv"])
        .args(["--require", "expected.jammed.share<=1"])
        .output()
        .unwrap()
        .status
        .code();
    assert_eq!(code, Some(0));
}

/// The equivalent quarter turns of a pyramid, and the jams that only friction holds.
#[test]
fn friction_jams_and_docking_with_symmetry_are_reported() {
    let home = home();
    fs::copy(super::designs().join("pyramid.toml"), home.path().join("pyramid.toml")).unwrap();
    let args = ["jams", "pyramid.toml", "--friction", "0.5", "--motions", "150", "-o", "jams.json"];
    let printed = run(home.path(), &args);
    assert!(printed.contains("  if displaced   held by friction alone;"), "{printed}");
    assert!(!printed.contains("ridge") && printed.contains("  friction       may stick from"), "{printed}");
    let words: Vec<&str> = printed.split_whitespace().collect();
    assert!(words.join(" ").contains("write symmetry = 4 in the design to count it as docked"), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    let report = fs::read(home.path().join("jams.json")).unwrap();
    let report: Value = serde_json::from_slice(&report).unwrap();
    let jams = report["jams"].as_array().unwrap();
    let turned = jams.iter().find(|jam| jam["docked_with_symmetry"] == 4).unwrap();
    assert!((turned["pose"]["yaw"].as_f64().unwrap().abs() - std::f64::consts::FRAC_PI_2).abs() < 0.01);
    let thresholds = |jam: &Value| {
        let sticks = &jam["examined"]["sticks"];
        Some([sticks["holds_from"].as_f64()?, sticks["slips_until"].as_f64()?])
    };
    let result: Vec<[f64; 2]> = jams.iter().filter_map(thresholds).collect();
    // A quarter turn lies flush, and contacts alone hold it.
    assert_eq!(thresholds(turned), Some([0.0; 2]));
    let on_the_way = result.iter().filter(|[holds, _]| *holds > 0.0);
    assert!(on_the_way.clone().count() >= 3, "{result:?}");
    assert!(on_the_way.clone().all(|[holds, slips]| holds <= slips && *holds <= 0.5), "{result:?}");
}

/// `run` reports the same jams as `jams` does for the same number of poses.
#[test]
fn run_and_jams_report_the_same_jams() {
    let home = home();
    let requested =
        ["run", "v.toml", "--resolution", "9", "--seed", "7", "--error-sigma", "x=10 mm", "--jams"];
    let result = json(home.path(), &[&requested[..], &["--json", "-o", "out"]].concat());
    let alone = json(home.path(), &["jams", "v.toml", "--seed", "7", "--error-sigma", "x=10 mm", "--json"]);
    let printed = result["jams"].as_object().unwrap();
    for (key, value) in printed {
        assert_eq!(*value, alone[key], "{key}");
    }
    assert!(printed["jams"][0]["of_box"]["count"].as_u64().unwrap() > 100);
    assert!(home.path().join("out/jams.png").exists());
    let text = run(home.path(), &requested);
    assert!(text.contains("\n  jam 1 ") && text.contains("of the fixed one"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let code = |require: &str| {
        let args = ["run", "v.toml", "--resolution", "9", "--jams", "--require", require];
        catchment(home.path()).args(args).output().unwrap().status.code()
    };
    assert_eq!(code("jams.outcomes.jammed.share<=0.3"), Some(0));
    assert_eq!(code("jams.outcomes.jammed.share<=0.01"), Some(1));
}
