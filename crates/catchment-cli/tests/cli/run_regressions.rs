//! Regression tests of `run`, from the time when the command line implemented it, through the real binary.

use super::{catchment, designs, home, json, run};
use serde_json::json;
use std::fs;

#[test]
fn requirements_on_results_of_the_method_are_judged() {
    let home = home();
    let args =
        ["run", "v.toml", "--method", "partition", "--resolution", "8", "--slices", "4", "--strips", "1"];
    let with = |requirement: &str| {
        let mut args = args.to_vec();
        args.extend(["--require", requirement]);
        run(home.path(), &args)
    };
    assert!(with("partition.sum>=0.1").starts_with("exit 0"), "{}", with("partition.sum>=0.1"));
    assert!(with("partition.sum>=100").contains("not met: partition.sum >= 100"));
    assert!(
        with("basins.minima>=1").contains("`basins.minima`")
            && with("basins.minima>=1").starts_with("exit 2")
    );
}

#[test]
fn the_dissertations_flooding_runs_on_any_design() {
    let home = home();
    let report = json(home.path(), &["run", "v.toml", "--method", "meyer", "--resolution", "31", "--json"]);
    assert_eq!(report["method"], "meyer");
    // A tenth of H, as the text of the dissertation states.
    assert_eq!(report["settings"]["depth_tolerance"], 0.1);
    let cone = designs().join("cone.toml");
    let cone = cone.to_str().unwrap();
    let report = json(
        home.path(),
        &["run", cone, "--method", "meyer", "--free", "x,y", "--resolution", "15", "--json"],
    );
    assert!(report["acceptance"]["outcomes"]["aligned"].as_u64().unwrap() > 0);
    let mesh = designs().join("pyramid-stl.toml");
    let mesh = mesh.to_str().unwrap();
    let args = [
        "run",
        mesh,
        "--method",
        "meyer",
        "--free",
        "x,yaw",
        "--resolution",
        "15",
        "--depth-tolerance",
        "0.05",
    ];
    assert!(run(home.path(), &args).starts_with("exit 0"));
}

#[test]
fn the_picture_of_five_dimensions_shows_the_sum_of_its_table() {
    let home = home();
    let pyramid = designs().join("pyramid.toml");
    let args = ["run", pyramid.to_str().unwrap(), "--resolution", "6", "--samples", "300", "-o", "out"];
    let printout = run(home.path(), &args);
    assert!(printout.starts_with("exit 0"), "{printout}");
    // `  AA (Sum)       12.59 D²·rad³ (95 % CI 12.36 … 12.82)`; the picture shows half of the interval: `12.59 ±
    // 0.23`.
    let line = printout.lines().find(|line| line.trim_start().starts_with("AA (Sum) ")).unwrap();
    let sum = line.trim_start().trim_start_matches("AA (Sum)").trim_start();
    assert!(sum.contains(" (95 % CI "), "{line}");
    let sum = &format!("Sum {} ± ", sum.split(' ').next().unwrap());
    for name in ["overview.svg", "slices.svg"] {
        let picture = fs::read_to_string(home.path().join("out").join(name)).unwrap();
        assert!(picture.contains(sum), "{name} does not say {sum}");
    }
}

#[test]
fn a_report_records_the_size_and_hash_of_a_mesh() {
    let home = home();
    let mesh = designs().join("pyramid-stl.toml");
    let report =
        json(home.path(), &["run", mesh.to_str().unwrap(), "--resolution", "4", "--samples", "0", "--json"]);
    let held = |half: &str| report["design"]["connector"]["own"][half]["mesh"]["content"].clone();
    let bytes = fs::read(designs().join("meshes/plug.stl")).unwrap();
    assert_eq!(held("moving")["bytes"], bytes.len());
    assert_eq!(held("moving")["sha256"].as_str().unwrap().len(), 64);
    assert_ne!(held("moving")["sha256"], held("fixed")["sha256"]);
}

#[test]
fn a_setting_of_another_method_is_named_with_its_owner() {
    let home = home();
    for (args, owner) in [
        (["--method", "transport", "--slices", "4"], "partition"),
        (["--method", "descent", "--depth-tolerance", "0.1"], "flood"),
        (["--method", "flood", "--friction", "0.1"], "confluence"),
    ] {
        let printout = run(home.path(), &[&["run", "v.toml"], &args[..]].concat());
        assert!(
            printout.starts_with("exit 2") && printout.contains(&format!("--method {owner}")),
            "{printout}"
        );
    }
    let printout = run(home.path(), &["outcome", "v.toml", "--poses", "-", "--restitution", "0.1"]);
    assert!(printout.contains("--restitution is a setting of drop; descent has none"), "{printout}");
}

#[test]
fn every_kind_of_report_has_one_head() {
    let home = home();
    fs::write(home.path().join("p.csv"), "x\n0.1\n").unwrap();
    let head = |args: &[&str]| {
        let report = json(home.path(), args);
        let keys: Vec<String> = report.as_object().unwrap().keys().take(3).cloned().collect();
        assert_eq!(keys, ["schema", "catchment", "kind"], "{args:?}");
        assert!(report["warnings"].is_array() && report.get("timing").is_some(), "{args:?}");
        json!([report["schema"], report["kind"]])
    };
    for (kind, args) in [
        ("run", &["run", "v.toml", "--resolution", "4", "--samples", "0", "--json"][..]),
        ("check", &["check", "v.toml", "--json"]),
        ("outcome", &["outcome", "v.toml", "--poses", "p.csv", "--json"]),
        ("trace", &["trace", "v.toml", "--pose", "x=0.1", "--json"]),
        ("zraa", &["zraa", "v.toml", "--json"]),
        ("slices", &["slices", "v.toml", "--resolution", "3", "--json"]),
        ("comparison", &["compare", "v.toml", "--methods", "descent,flood", "--resolution", "4", "--json"]),
        ("methods", &["run", "v.toml", "--free", "x", "--method", "all", "--resolution", "4", "--json"]),
        ("sensitivity", &["run", "v.toml", "--sensitivity", "--samples", "20", "--json"]),
        ("export", &["export", "v.toml", "--pose", "x=0.1", "-o", "trial", "--json"]),
        ("solids", &["solids", "v.toml", "--json"]),
        ("trials", &["zraa", "v.toml", "--beside", "descent", "--resolution", "4", "--json"]),
    ] {
        assert_eq!(head(args), json!([4, kind]));
    }
}

#[test]
fn an_answer_of_a_newer_version_is_refused_and_an_unknown_field_is_not() {
    let home = home();
    let out = home.path().join("a.zarr");
    assert!(
        run(home.path(), &["run", "v.toml", "--resolution", "4", "--samples", "0", "-o", "a.zarr"])
            .starts_with("exit 0")
    );
    let place = out.join("zarr.json");
    let text = fs::read_to_string(&place).unwrap();
    let compared = || {
        let output =
            catchment(home.path()).args(["compare", "a.zarr", "v.toml", "--methods", "descent"]).output();
        let output = output.unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    fs::write(&place, text.replacen("\"kind\": \"run\"", "\"kind\": \"run\", \"invented\": [1]", 1)).unwrap();
    assert_eq!(compared().0, Some(0), "{}", compared().1);
    fs::write(&place, text.replacen("\"schema\": 4", "\"schema\": 5", 1)).unwrap();
    let (code, printout) = compared();
    assert!(code == Some(4) && printout.contains("its schema is 5"), "{printout}");
}
