//! Probability of docking under dynamics, through the real binary.

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

fn json_of(folder: &Path, args: &[&str]) -> Value {
    json(folder, &[&["chance", "v.toml", "--free", "x", "--json"], args].concat())
}

/// With drifts uniform in 0 to 200 mm/s, those below 100 mm/s leave 15 mm below 25 mm, if the half falls for long: u/γ at γ = 10/s.
#[test]
fn the_probability_matches_the_closed_form_in_millimetres() {
    let home = home();
    let laws = ["--draw", "speed=5 mm/s", "--draw", "drift_x=0..200 mm/s", "--draw", "height=25 mm"];
    let args = [&laws[..], &["--pose", "x=15 mm", "--pose", "x=-15 mm", "--trials", "200"]].concat();
    let report = json_of(home.path(), &args);
    let ends = [0, 1].map(|k| report["poses"][0]["ci95"][k].as_f64().unwrap());
    assert!(ends[0] < 0.5 && 0.5 < ends[1], "{ends:?}");
    assert_eq!(
        (&report["poses"][1]["probability"], &report["poses"][0]["quasi_static"]),
        (&1.0.into(), &1.0.into())
    );
    assert_eq!(report["declared"][1]["circumstance"], "drift_x");
    assert_eq!(report["declared"][1]["law"]["to"], 4.0);
    let printed = run(home.path(), &[&["chance", "v.toml", "--free", "x"], &args[..]].concat());
    assert!(printed.contains("x 15.000 mm") && printed.contains("0 … 200 mm/s, uniform"), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 1);
}

#[test]
fn options_go_before_the_file_and_threads_change_nothing() {
    let home = home();
    let laws = "[dynamics]\nspeed = \"50 ± 10 mm/s\"\nfriction = { from = 0, to = 0.2 }\n";
    fs::write(home.path().join("l.toml"), laws).unwrap();
    fs::write(home.path().join("p.csv"), "x_mm\n20\n30\n").unwrap();
    let threads = |n: &str| {
        let file = ["--dynamics", "l.toml", "--draw", "friction=0.1", "--poses", "p.csv", "--trials", "8"];
        let more = ["--error-sigma", "x=12.5 mm", "--overall", "100", "--times", "0.02,4", "--threads", n];
        let mut report = json_of(home.path(), &[&file[..], &more].concat());
        report["timing"] = Value::Null;
        report
    };
    let report = threads("2");
    assert_eq!(report, threads("1"));
    assert_eq!(report["declared"][1]["law"]["value"], 0.1);
    let docks = |k: usize| report["poses"][k]["probability"].as_f64().unwrap();
    assert_eq!((docks(0), docks(1)), (1.0, 0.0));
    // 25 mm are 2 σ: 95.45 %.
    let slow = [0, 1].map(|k| report["curve"][0]["ci95"][k].as_f64().unwrap());
    assert!(slow[0] < 0.9545 && 0.9545 < slow[1], "{slow:?}");
    let poses = report["poses"].as_array().unwrap();
    assert_eq!(poses.len(), 2);
}

#[test]
fn every_file_is_written_and_requirements_are_judged() {
    let home = home();
    let base = ["chance", "v.toml", "--draw", "speed=1", "--overall", "100", "--trials", "2"];
    for (name, begins) in
        [("c.png", "\u{fffd}PNG"), ("c.svg", "<svg"), ("c.csv", "what,factor"), ("c.json", "{")]
    {
        let args = [&base[..], &["--map", "x,pitch", "--cells", "3", "--times", "0.1", "-o", name]].concat();
        assert!(run(home.path(), &args).starts_with("exit 0\n"));
        let written = fs::read(home.path().join(name)).unwrap();
        assert!(String::from_utf8_lossy(&written).starts_with(begins), "{name}");
    }
    let required = |what: &str| {
        let args = [&base[..], &["--require", what, "--quiet"]].concat();
        catchment(home.path()).args(args).status().unwrap().code()
    };
    assert_eq!(required("overall.probability>=0.01"), Some(0));
    assert_eq!(required("overall.probability>=0.999"), Some(1));
}

#[test]
fn the_preset_lists_its_unknown_parameters() {
    let home = home();
    let args = ["chance", "v.toml", "--preset", "gazebo-2014", "--pose", "x=0", "--trials", "2"];
    let printed = run(home.path(), &args);
    assert!(
        printed.contains("gazebo-2014 leaves open") && printed.contains("the time step: 1 ms"),
        "{printed}"
    );
    assert!(printed.contains("by gravity of 137"), "{printed}");
}

#[test]
fn the_trajectory_of_a_trial_is_reported_and_drawn() {
    let home = home();
    let args = [
        "trace",
        "v.toml",
        "--pose",
        "x=10 mm,pitch=5 deg",
        "--method",
        "drop",
        "--damping",
        "10",
        "--speed",
        "2",
    ];
    let printed = run(home.path(), &[&args[..], &["-o", "t.svg"]].concat());
    assert!(
        printed.contains("time [s]")
            && printed.contains("  outcome        docked\n")
            && printed.ends_with("--- stderr\nnext: catchment rests v.toml --jams\n"),
        "{printed}"
    );
    assert!(fs::read_to_string(home.path().join("t.svg")).unwrap().contains("docked"));
    let report = json(home.path(), &[&args[..], &["--json"]].concat());
    assert_eq!((&report["method"], &report["settings"]["launch"]["speed"]), (&"drop".into(), &2.0.into()));
    let times: Vec<f64> =
        report["waypoints"].as_array().unwrap().iter().map(|w| w["time_s"].as_f64().unwrap()).collect();
    assert!(times[0] == 0.0 && times.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(run(home.path(), &[&args[..], &["-o", "t.csv"]].concat()).starts_with("exit 0"));
    let table = fs::read_to_string(home.path().join("t.csv")).unwrap();
    assert!(table.starts_with("waypoint,travelled,time,x,"), "{table}");
}

/// The file that ships with the program.
#[test]
fn the_shipped_dynamics_file_is_valid() {
    let report = json(
        &designs(),
        &[
            "chance",
            "pyramid-stl.toml",
            "--dynamics",
            "robots/dynamics.toml",
            "--pose",
            "x=3 mm",
            "--trials",
            "2",
            "--json",
        ],
    );
    assert_eq!(report["declared"].as_array().unwrap().len(), 8);
}
