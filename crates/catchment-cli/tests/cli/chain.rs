//! `catchment chain`: the published table, the published sequence, the refused inputs.

use super::{catchment, designs, entries, home, json, run};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn systems() -> PathBuf {
    designs().join("systems")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// A folder with a chain file beside the V-Face.
fn with(text: &str) -> tempfile::TempDir {
    let home = home();
    fs::write(home.path().join("c.toml"), text).unwrap();
    home
}

fn code(folder: &Path, args: &[&str]) -> Option<i32> {
    catchment(folder).args(args).output().unwrap().status.code()
}

#[test]
fn the_p_latches_as_in_table_6_2() {
    let report = json(&systems(), &["chain", "p-sequence.toml", "--json", "--chains", "100"]);
    let names: Vec<&str> = report.as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(
        (&names[..3], &names[names.len() - 2..]),
        (&["schema", "catchment", "kind"][..], &["warnings", "timing"][..])
    );
    assert_eq!((&report["kind"], &report["modules"]), (&"chain".into(), &6.into()));
    let folding = &report["folding"];
    let events: Vec<(f64, u64)> = folding["events"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| (number(&e["time_s"]).floor(), e["layers"].as_u64().unwrap()))
        .collect();
    assert_eq!(events, [(3.0, 1), (5.0, 2)]);
    assert!(folding["latched"] == true && number(&folding["off_lattice_mm"]) < 1.0);
    assert!(number(&folding["off_lattice_rad"]) < 1f64.to_radians());
    // The commanded states of the table, rotor 3 at 190 mm.
    let commanded = |step: usize, module: usize| {
        [0, 1].map(|k| number(&folding["steps"][step]["modules"][module - 1]["commanded_mm"][k]))
    };
    let near = |[x, y]: [f64; 2], [a, b]: [f64; 2]| (x - 190.0 - a).abs() < 0.01 && (y - b).abs() < 0.01;
    assert!(near(commanded(2, 5), [85.59, -94.53]) && near(commanded(2, 6), [-6.01, -69.34]));
    assert!(near(commanded(4, 5), [95.0, -95.0]) && near(commanded(4, 6), [1.36, -79.0]));
    // The chain's centre of rotation replaces the design's, and a message reports it.
    assert!((number(&report["connector"]["center_of_rotation_d"]) + 0.725).abs() < 2e-4);
    assert!(report["warnings"][0]["message"].as_str().unwrap().contains("is not used"));
}

#[test]
fn the_table_over_modules_is_the_published_one() {
    let args = [
        "chain",
        "chain.toml",
        "--modules",
        "2..20",
        "--joint-sigma",
        "0.5deg,1deg,2deg",
        "--chains",
        "40",
        "--json",
    ];
    let report = json(&systems(), &args);
    let rows = report["lengths"].as_array().unwrap();
    assert_eq!(rows.len(), 3 * 19);
    let row = |sigma: usize, modules: usize| &rows[19 * sigma + modules - 2];
    for (sigma, modules, across) in [(0, 2, 0.0200), (1, 8, 0.3301), (1, 12, 0.6070), (2, 20, 2.6136)] {
        assert_eq!(row(sigma, modules)["modules"], modules);
        assert!((number(&row(sigma, modules)["lateral_sigma_d"]) - across).abs() < 0.6e-4);
    }
    // Offsets alone at 1°: 0.998, 0.900, 0.715, 0.556.
    for (modules, alone) in [(8, 0.998), (12, 0.900), (16, 0.715), (20, 0.556)] {
        assert!((number(&row(1, modules)["offset_probability"]) - alone).abs() < 0.6e-3);
    }
    assert_eq!(report["reach"].as_array().unwrap().len(), 3);
    assert!(rows.iter().all(|r| number(&r["docking"]["ci95"][0]) <= number(&r["docking"]["probability"])));
}

#[test]
fn the_ring_closes_and_its_corners_are_ranked() {
    let report = json(&systems(), &["chain", "o-ring.toml", "--chains", "50", "--json"]);
    let folding = &report["folding"];
    assert!(folding["latched"] == true && number(&folding["off_lattice_mm"]) < 1.0);
    assert!(folding["reading"].as_str().unwrap().starts_with("our reading"));
    let latch = &folding["latches"][0];
    assert!((number(&latch["lateral_sigma_mm"]) - 7.23).abs() < 0.006);
    assert!((number(&latch["normal_sigma_mm"]) - 11.25).abs() < 0.006);
    assert!((number(&latch["angle_sigma_rad"]).to_degrees() - 3.46).abs() < 0.006);
    let ranks: Vec<[u64; 2]> = report["corners"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| ["rank_by_error", "rank_by_force"].map(|key| c[key].as_u64().unwrap()))
        .collect();
    assert_eq!(ranks, [[2, 1], [1, 3], [2, 1]]);
}

#[test]
fn both_readings_of_the_block_latch_and_are_named() {
    for (reading, pairs, printout) in
        [("A", [[2, 5], [1, 6]], "reading A"), ("B", [[3, 6], [1, 6]], "reading B")]
    {
        let home = with(&format!("[sequence]\nname = \"Block\"\nreading = \"{reading}\"\n"));
        let report = json(home.path(), &["chain", "c.toml", "--chains", "1", "--json"]);
        let folding = &report["folding"];
        assert!(folding["latched"] == true && number(&folding["off_lattice_mm"]) < 1.0, "{reading}");
        let result: Vec<[u64; 2]> = folding["latches"]
            .as_array()
            .unwrap()
            .iter()
            .map(|l| ["from", "to"].map(|key| l["latch"][key].as_u64().unwrap()))
            .collect();
        assert_eq!(result, pairs);
        let table = run(home.path(), &["chain", "c.toml", "--chains", "1"]);
        assert!(table.contains(printout) && table.contains("our reading"), "{table}");
    }
}

#[test]
fn requirements_decide_the_exit_code() {
    let systems = systems();
    let with = |requirement: &str| {
        code(&systems, &["chain", "chain.toml", "--chains", "200", "--require", requirement])
    };
    // Twelve modules at 1°: 0.80.
    assert_eq!(with("probability>=0.7"), Some(0));
    assert_eq!(with("probability>=0.99"), Some(1));
    assert_eq!(with("probabilty>=0.99"), Some(2));
    let printed =
        run(&systems, &["chain", "chain.toml", "--chains", "200", "--require", "probability>=0.99"]);
    assert!(
        printed.contains("docks") && printed.contains("not met: probability >= 0.99 (it is 0."),
        "{printed}"
    );
    let bare = home();
    fs::write(bare.path().join("c.toml"), "[chain]\nmodules = 4\n").unwrap();
    let printed = run(bare.path(), &["chain", "c.toml", "--require", "probability>=0.99"]);
    assert!(
        printed.starts_with("exit 2\n--- stdout\n--- stderr") && printed.contains("needs a [connector]"),
        "{printed}"
    );
}

#[test]
fn threads_change_nothing() {
    let report = |threads: &str| {
        let args = [
            "chain",
            "p-sequence.toml",
            "--chains",
            "60",
            "--modules",
            "3,9",
            "--json",
            "--threads",
            threads,
        ];
        let output = catchment(&systems()).args(args).output().unwrap();
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stdout).unwrap().split("\"timing\"").next().unwrap().to_owned()
    };
    let one = report("1");
    assert_eq!(report("2"), one);
    assert_eq!(report("4"), one);
}

#[test]
fn files_hold_poses_chains_and_pictures() {
    let home = with("[chain]\njoint_sigma = \"1 deg\"\n[sequence]\nname = \"P\"\n");
    let write = |file: &str, more: &[&str]| {
        let args = [&["chain", "c.toml", "--chains", "30", "-o", file], more].concat();
        assert_eq!(code(home.path(), &args), Some(0), "{file}");
        fs::read(home.path().join(file)).unwrap()
    };
    let poses = String::from_utf8(write("poses.csv", &[])).unwrap();
    let mut lines = poses.lines();
    assert_eq!(lines.next(), Some("t,module,x,y,heading,command,state"));
    assert_eq!(lines.clone().count(), 36);
    assert!(lines.any(|line| line.starts_with("3,5,") && line.ends_with(",-1.74,stalled")), "{poses}");
    let table = String::from_utf8(write("lengths.csv", &["--modules", "2..4"])).unwrap();
    assert!(table.starts_with("joint_sigma_rad,modules,lateral_sigma_d,") && table.lines().count() == 4);
    assert!(write("steps.svg", &[]).starts_with(b"<svg"));
    assert!(write("steps.png", &[]).starts_with(b"\x89PNG"));
    assert!(write("lengths.png", &["--modules", "2..4"]).starts_with(b"\x89PNG"));
    let stored: Value = serde_json::from_slice(&write("report.json", &[])).unwrap();
    assert_eq!(stored["kind"], "chain");
    let printed = run(home.path(), &["chain", "c.toml", "-o", "steps.stl"]);
    assert!(
        printed.starts_with("exit 2")
            && printed.contains("let its name end in .json, .csv, .md, .html, .txt, .png, .svg"),
        "{printed}"
    );
    let printed = run(home.path(), &["chain", "c.toml", "-o", "steps.svg"]);
    assert!(printed.starts_with("exit 2") && printed.contains("--force replaces it"), "{printed}");
}

#[test]
fn collisions_are_refused_at_their_step() {
    let step = |time: usize, joint: usize| {
        format!("[[step]]\ntime = {time}\njoint = {joint}\ncommand = \"-90 deg\"\n")
    };
    let steps: String = (2..=5).map(|joint| step(joint - 2, joint)).collect();
    let home = with(&format!("[chain]\nmodules = 6\n{steps}"));
    let printed = run(home.path(), &["chain", "c.toml", "-o", "out.svg"]);
    // The third step, at line 11.
    assert!(printed.starts_with("exit 4\n--- stdout\n--- stderr\n"), "{printed}");
    assert!(
        printed.contains("at 2 s module 5 is sent into the cell of module 1")
            && printed.contains("c.toml:11"),
        "{printed}"
    );
    assert_eq!(entries(home.path()), ["c.toml", "v.toml"]);
    // A fold of 130° lays a module against its neighbour: no cell is shared, the sweep collides.
    let home = with("[chain]\nmodules = 6\n[[step]]\ntime = 1\njoint = 3\ncommand = \"130 deg\"\n");
    let printed = run(home.path(), &["chain", "c.toml"]);
    assert!(printed.starts_with("exit 4\n--- stdout\n--- stderr\n"), "{printed}");
    assert!(printed.contains("at 1 s module 4 hits module 2") && printed.contains("c.toml:3"), "{printed}");
}

#[test]
fn every_example_is_answered() {
    for name in ["chain.toml", "p-sequence.toml", "block.toml", "o-ring.toml"] {
        let printed = run(&systems(), &["chain", name, "--chains", "20"]);
        let (_, stderr) = printed.split_once("--- stderr\n").unwrap();
        let is_warning = |line: &str| line.starts_with("warning: ") || line.starts_with("         ");
        assert!(printed.starts_with("exit 0\n") && stderr.lines().all(is_warning), "{printed}");
        let widest = printed.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(widest <= 80, "{widest}: {printed}");
    }
}
