//! `catchment sweep`: printed output, written files, and resumption of an interrupted sweep.

use super::{catchment, designs, entries, home, json, run, written};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

#[test]
fn a_table_of_two_axes_and_a_list_of_one() {
    let home = home();
    let over = ["--over", "aspect_ratio=0.5,1,2", "--over", "cor=-1..1/3"];
    let quick = ["--resolution", "15", "--samples", "200"];
    let args = |over: &[&'static str]| [&["sweep", "v.toml"], over, &quick].concat();
    insta::assert_snapshot!("sweep_matrix", run(home.path(), &args(&over)));
    insta::assert_snapshot!("sweep_list", run(home.path(), &args(&over[2..])));
    assert_eq!(entries(home.path()), ["v.toml"]);
}

#[test]
fn every_key_can_be_swept_and_every_figure_is_written() {
    let home = home();
    fs::copy(designs().join("pyramid.toml"), home.path().join("p.toml")).unwrap();
    let args =
        ["sweep", "p.toml", "--over", "family=pyramid,cone", "--over", "errors.x=0.2,0.4 D", "--free", "x,y"];
    let quick = ["--resolution", "9", "--samples", "50", "-o", "out", "--error-sigma", "x=0.1"];
    let printed = run(home.path(), &[&args[..], &quick].concat());
    assert!(
        printed.starts_with("exit 0\n") && printed.contains("wrote out: report.json, sweep.csv"),
        "{printed}"
    );
    let out = home.path().join("out");
    let names =
        ["outlines.png", "outlines.svg", "report.json", "sweep.csv", "sweep.png", "sweep.svg", "sweep.zarr"];
    assert_eq!(written(&out), names);
    assert_eq!(
        entries(home.path()),
        ["out", "p.toml", "v.toml"],
        "nothing is kept of a sweep that is complete"
    );
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let mut lines = table.lines();
    assert!(
        lines.next().unwrap().starts_with("connector.family,errors.x,sum,sum_lo,sum_hi,fraction,onaa_edge")
    );
    assert_eq!(lines.count(), 4);
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("report.json")).unwrap()).unwrap();
    assert_eq!((&report["kind"], &report["designs"][3]["values"][0]), (&"sweep".into(), &"cone".into()));
    assert!(report["designs"][3]["figures"]["success"].as_f64().unwrap() > 0.0);
    let group: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("sweep.zarr/zarr.json")).unwrap()).unwrap();
    let arrays = &group["consolidated_metadata"]["metadata"];
    assert_eq!(arrays["sum"]["dimension_names"], serde_json::json!(["family", "errors_x"]));
    assert_eq!(arrays["family"]["attributes"]["values"], serde_json::json!(["pyramid", "cone"]));
    assert!(arrays.get("outcome").is_none(), "the error boxes differ: there are no common cells");
    // A second run replaces the same folder.
    assert!(run(home.path(), &[&args[..], &quick].concat()).starts_with("exit 0\n"));
}

/// Every file below a folder; reports without their computing time.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let (mut result, mut open) = (BTreeMap::new(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            if path.is_dir() {
                open.push(path);
            } else if name == "report.json" {
                let mut report: serde_json::Value =
                    serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
                assert!(report["timing"].take()["total_s"].is_f64());
                result.insert(path.strip_prefix(folder).unwrap().to_owned(), report.to_string().into_bytes());
            } else if name != ".catchment.json" {
                result.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
            }
        }
    }
    result
}

#[cfg(unix)]
#[test]
fn a_resumed_sweep_writes_the_same_result() {
    let home = home();
    let sweep = |out: &'static str| {
        let axes = ["--over", "aspect_ratio=0.5,1", "--over", "cor=-1..1/8", "--resolution", "12"];
        let mut command = catchment(home.path());
        command.args(
            [&["sweep", "v.toml"], &axes[..], &["--samples", "400", "--threads", "2", "-o", out]].concat(),
        );
        command
    };
    assert_eq!(sweep("whole").output().unwrap().status.code(), Some(0));
    let parts = home.path().join("out.parts");
    let count = || {
        fs::read_dir(&parts).map_or(0, |result| {
            result
                .filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|e| e == "json"))
                .count()
        })
    };
    for (signal, code) in [("-INT", Some(130)), ("-KILL", None)] {
        let had = count();
        let child = sweep("out").stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        while count() < had + 2 {
            std::thread::yield_now();
        }
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), code, "{stderr}");
        assert!(count() >= had + 2 && count() < 16 && !home.path().join("out").exists(), "{} of 16", count());
        if code.is_some() {
            assert!(
                stderr.contains("of 16 designs in out.parts, from where the same command goes on"),
                "{stderr}"
            );
        }
    }
    // A damaged part is computed again.
    let one = fs::read_dir(&parts)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .find(|p| p.extension().is_some())
        .unwrap();
    fs::write(one, "{").unwrap();
    assert_eq!(sweep("out").output().unwrap().status.code(), Some(0));
    let [out, whole] = ["out", "whole"].map(|name| contents(&home.path().join(name)));
    let differing: Vec<_> =
        whole.iter().filter(|(name, bytes)| out.get(*name) != Some(bytes)).map(|(name, _)| name).collect();
    assert!(differing.is_empty() && out.len() == whole.len(), "{differing:?}");
    assert_eq!(entries(home.path()), ["out", "v.toml", "whole"]);
}

#[test]
fn numbers_are_those_of_a_run() {
    let home = home();
    let quick = ["--resolution", "9", "--samples", "100", "--json"];
    let swept = json(home.path(), &[&["sweep", "v.toml", "--over", "cor=0,0.5"], &quick[..]].concat());
    let one = json(home.path(), &[&["run", "v.toml", "--cor", "0.5"], &quick[..]].concat());
    let figures = &swept["designs"][1]["figures"];
    assert_eq!((&figures["sum"], &figures["onaa_edge"]), (&one["acceptance"]["sum"], &one["onaa"]["edge"]));
    assert_eq!(figures["sum_ci95"], one["acceptance"]["sum_ci95"]);
    assert_eq!(figures["fraction"], one["acceptance"]["fraction"]);
}
