//! `catchment slices`, `run --converge`, `run --sensitivity`: several computations of one design.

use super::{catchment, designs, entries, home, json, run, written};
use serde_json::Value;
use std::fs;

#[test]
fn a_slice_of_a_planar_design_equals_its_run() {
    let home = home();
    insta::assert_snapshot!("slices_planar", run(home.path(), &["slices", "v.toml", "--resolution", "21"]));
    let slices = json(home.path(), &["slices", "v.toml", "--resolution", "21", "--json"]);
    let whole = json(
        home.path(),
        &["run", "v.toml", "--method", "descent", "--resolution", "21", "--samples", "0", "--json"],
    );
    let slice = &slices["slices"][0];
    assert_eq!(slice["acceptance"]["outcomes"], whole["acceptance"]["outcomes"]);
    assert_eq!(slice["axes"], whole["axes"]);
    // The Sum of the slice comes from cells, that of the run from motions.
    assert_eq!((&slice["onaa"]["followed"], &whole["onaa"]["followed"]), (&false.into(), &true.into()));
    let edge = |of: &Value| of["onaa"]["edge"].as_f64().unwrap();
    assert!((edge(slice) - edge(&whole)).abs() < 1.0 / 21.0);
    assert!(slices["onaa_estimate"].is_null() && slices["timing"]["threads"].is_u64());
}

#[test]
fn all_slices_of_five_errors_are_written_and_replaced() {
    let home = tempfile::tempdir().unwrap();
    let design = designs().join("pyramid.toml");
    let slices = |more: &[&str]| {
        let mut args = vec!["slices", design.to_str().unwrap(), "--resolution", "5", "-o", "out"];
        args.extend(more);
        run(home.path(), &args)
    };
    let printed = slices(&[]);
    assert!(
        printed.starts_with("exit 0\n") && printed.contains("estimate") && printed.contains("roll-pitch"),
        "{printed}"
    );
    let out = home.path().join("out");
    let names = written(&out);
    assert_eq!(names.len(), 4 + 10, "{names:?}");
    for name in ["report.json", "slices.csv", "slices.png", "slices.svg", "x-yaw.zarr", "roll-pitch.zarr"] {
        assert!(names.iter().any(|n| n == name), "{name}");
    }
    let report: Value = serde_json::from_slice(&fs::read(out.join("report.json")).unwrap()).unwrap();
    assert_eq!((report["kind"].as_str(), report["slices"].as_array().unwrap().len()), (Some("slices"), 10));
    assert!(report["onaa_estimate"]["optimistic"].is_f64());
    let csv = fs::read_to_string(out.join("slices.csv")).unwrap();
    assert!(csv.starts_with("slice,cells,sum,unit,") && csv.lines().count() == 11, "{csv}");
    assert!(slices(&["--axes", "pitch,x"]).starts_with("exit 0\n"));
    assert_eq!(written(&out), ["report.json", "slices.csv", "slices.png", "slices.svg", "x-pitch.zarr"]);
}

#[test]
fn invalid_slices_are_refused() {
    let home = home();
    let refuse = |args: &[&str]| {
        let mut all = vec!["slices", "v.toml", "-o", "out"];
        all.extend(args);
        let text = run(home.path(), &all);
        assert_eq!(entries(home.path()), ["v.toml"]);
        text
    };
    insta::assert_snapshot!("slices_axis_not_free", refuse(&["--axes", "x,yaw"]));
    insta::assert_snapshot!("slices_too_large", refuse(&["--resolution", "100000", "--memory", "1 MB"]));
    assert!(refuse(&["--axes", "x"]).contains("a slice varies two errors, such as x,pitch"));
    assert!(refuse(&["--axes", "x,z"]).contains("there is no axis `z`"));
    assert!(refuse(&["--axes", "x,x"]).contains("two different errors"));
    assert!(refuse(&["--resolution", "9,yaw=5"]).contains("yaw"));
    assert!(refuse(&["--free", "x"]).contains("a slice needs two free errors"));
}

#[test]
fn refinement_reports_when_it_is_stable() {
    let home = home();
    let args = ["run", "v.toml", "--converge", "--tolerance", "10%", "--time-limit", "100 h"];
    let report = json(home.path(), &[&args[..], &["--json"]].concat());
    assert_eq!(report["settings"]["tolerance"], 0.1);
    let sequences = report["sequences"].as_array().unwrap();
    assert!(sequences.len() >= 2);
    for sequence in sequences {
        assert_eq!(sequence["end"]["kind"], "stable", "{sequence}");
        let trials = sequence["trials"].as_array().unwrap();
        assert!(trials.len() >= 3 && trials[0]["resolution"] == 11 && trials[0]["cells"] == 121);
    }
    let exact = sequences.iter().find(|s| s["method"] == "descent").unwrap();
    let last = exact["trials"].as_array().unwrap().last().unwrap();
    assert!((last["sum"].as_f64().unwrap() - 2.39).abs() < 0.25, "{last}");
    let printed = run(home.path(), &[&args[..], &["-o", "out"]].concat());
    assert!(
        printed.starts_with("exit 0\n") && printed.contains("\n  flood\n") && printed.contains("stable\n"),
        "{printed}"
    );
    assert_eq!(
        written(&home.path().join("out")),
        ["convergence.csv", "convergence.png", "convergence.svg", "report.json"]
    );
}

#[test]
fn an_early_stop_of_refinement_is_reported() {
    let home = home();
    let args = ["run", "v.toml", "--converge", "--tolerance", "0.00001", "--memory", "1 MB"];
    let printed = run(home.path(), &args);
    assert!(printed.starts_with("exit 0\n") && printed.contains("stopped, not stable: at"), "{printed}");
    let printed = run(home.path(), &["run", "v.toml", "--converge", "--time-limit", "0.001 ms"]);
    assert!(printed.contains("stopped, not stable: 15 cells per axis"), "{printed}");
}

#[test]
fn slopes_and_spread_are_reported_and_written() {
    let home = home();
    let args = ["run", "v.toml", "--sensitivity", "--samples", "200"];
    insta::assert_snapshot!("sensitivity_planar", run(home.path(), &args));
    let with = |threads: &str, seed: &str| {
        let more = ["--json", "--threads", threads, "--seed", seed];
        let mut report = json(home.path(), &[&args[..], &more].concat());
        assert!(report["timing"].take().is_object());
        report
    };
    let report = with("1", "1");
    assert_eq!(report, with("2", "1"));
    assert_ne!(report["sum"], with("1", "2")["sum"]);
    let names: Vec<&str> =
        report["slopes"].as_array().unwrap().iter().map(|s| s["parameter"].as_str().unwrap()).collect();
    assert_eq!(names, ["rotation_length", "center_of_rotation", "aspect_ratio"]);
    let printed = run(home.path(), &[&args[..], &["-o", "out"]].concat());
    assert!(printed.contains("wrote out: report.json, sensitivity.csv"), "{printed}");
    assert_eq!(
        written(&home.path().join("out")),
        ["report.json", "sensitivity.csv", "sensitivity.png", "sensitivity.svg"]
    );
    // A study does not replace the output of a run.
    fs::create_dir(home.path().join("thesis")).unwrap();
    fs::write(home.path().join("thesis/overview.png"), "").unwrap();
    let printed = run(home.path(), &["run", "v.toml", "--sensitivity", "-o", "thesis"]);
    assert!(printed.starts_with("exit 2\n") && printed.contains("cannot write"), "{printed}");
}

#[test]
fn own_halves_have_no_aspect_ratio_to_change() {
    let report =
        json(&designs(), &["run", "pyramid-pieces.toml", "--sensitivity", "--samples", "20", "--json"]);
    assert_eq!(report["slopes"].as_array().unwrap().len(), 2);
}

#[test]
fn a_study_takes_no_options_of_a_run() {
    let home = home();
    for (study, option) in [
        ("--converge", ["--resolution", "9"]),
        ("--converge", ["--method", "flood"]),
        ("--converge", ["--budget", "9s"]),
        ("--converge", ["--error-sigma", "x=0.1"]),
        ("--sensitivity", ["--require", "sum>1"]),
        ("--sensitivity", ["--tolerance", "1%"]),
        ("--converge", ["--tolerance", "0"]),
    ] {
        let output = catchment(home.path()).args(["run", "v.toml", study]).args(option).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{study} {option:?}");
    }
}

#[test]
fn slices_and_runs_report_the_drop_method() {
    let home = home();
    let args = ["--resolution", "5", "--method", "drop", "--trials", "1"];
    let slices = json(home.path(), &[&["slices", "v.toml", "--json"], &args[..]].concat());
    assert_eq!(slices["slices"][0]["method"], "drop");
    assert_eq!(slices["settings"]["drop"]["trials"], 1);
    let whole = json(home.path(), &[&["run", "v.toml", "--json", "--samples", "20"], &args[..]].concat());
    assert_eq!(whole["method"], "drop");
    // The same poses; the random ones are dropped as well.
    assert_eq!(whole["acceptance"]["outcomes"], slices["slices"][0]["acceptance"]["outcomes"]);
    assert_eq!(whole["acceptance"]["sample"]["settings"], whole["settings"]);
}
