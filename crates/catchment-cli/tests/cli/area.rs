//! `catchment run`: printed output, written files, refusals.

use super::{catchment, entries, home, run, written};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Exit code and stdout.
fn json(folder: &Path, args: &[&str]) -> (i32, String) {
    let output = catchment(folder).args(args).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8(output.stdout).unwrap())
}

#[test]
fn the_table_is_printed_and_no_file_written() {
    let home = home();
    insta::assert_snapshot!(
        "flood_table",
        run(home.path(), &["run", "v.toml", "--method", "flood", "--resolution", "21"])
    );
    assert_eq!(entries(home.path()), ["v.toml"]);
}

#[test]
fn json_is_the_same_for_any_number_of_threads() {
    let home = home();
    let report = |threads: &str| {
        let args = ["run", "v.toml", "--resolution", "9", "--samples", "50", "--json", "--threads", threads];
        let (code, text) = json(home.path(), &args);
        assert_eq!(code, 0);
        let mut report: Value = serde_json::from_str(&text).unwrap();
        assert!(report["timing"].take()["total_s"].as_f64().unwrap() > 0.0);
        (report["acceptance"].clone(), text.split("\"timing\"").next().unwrap().to_owned())
    };
    let (acceptance, one) = report("1");
    assert_eq!(report("2").1, one);
    assert_eq!(report("4").1, one);
    assert_eq!(acceptance["cells"], 81);
    assert_eq!(acceptance["sample"]["descents"], 50);
    let [lo, hi] = [0, 1].map(|k| acceptance["sum_ci95"][k].as_f64().unwrap());
    // The exact Sum is 2.39; the interval of fifty poses is wide, and for this seed it contains the exact
    // value.
    assert!(lo < 2.39 && 2.39 < hi && hi - lo > 0.5, "{lo} {hi}");
    let of_strata = |key: &str| {
        let strata = acceptance["sample"]["strata"].as_array().unwrap();
        strata.iter().map(|stratum| stratum[key].as_f64().unwrap()).sum::<f64>()
    };
    assert!((of_strata("share") - 1.0).abs() < 1e-12 && of_strata("descents") == 50.0);
    assert!(acceptance["sum"] != acceptance["sum_grid"] && acceptance["sum_grid"].is_f64());
}

/// A time budget sets only the number of descents, which depends on the machine.
#[test]
fn a_budget_or_tolerance_matches_the_same_sample_count() {
    let home = home();
    let report = |how: [&str; 2], method: &str| {
        let args = [
            "run",
            "v.toml",
            "--resolution",
            "15",
            "--method",
            method,
            "--json",
            how[0],
            how[1],
            "--seed",
            "3",
        ];
        let (code, text) = json(home.path(), &args);
        assert_eq!(code, 0, "{text}");
        let value: Value = serde_json::from_str(&text).unwrap();
        let descents = value["acceptance"]["sample"]["descents"].to_string();
        (descents, text.split("\"timing\"").next().unwrap().to_owned())
    };
    for method in ["descent", "transport", "flood"] {
        for how in [["--budget", "60 ms"], ["--tolerance", "10%"]] {
            let (descents, first) = report(how, method);
            assert!(report(["--samples", &descents], method).1 == first, "{how:?} with {method}: {descents}");
        }
    }
}

#[test]
fn ambiguous_cells_are_followed_where_they_are_no_more_than_the_samples() {
    let home = home();
    let warnings = |samples: &str| {
        let args =
            ["run", "v.toml", "--resolution", "31", "--method", "transport", "--json", "--samples", samples];
        let report: Value = serde_json::from_str(&json(home.path(), &args).1).unwrap();
        let warnings = report["warnings"].as_array().unwrap().clone();
        warnings.iter().map(|w| w["warning"]["kind"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert!(!warnings("500").contains(&"ambiguous".to_owned()));
    let without = warnings("0");
    assert!(without.contains(&"ambiguous".to_owned()) && without.contains(&"no-interval".to_owned()));
}

#[test]
fn another_seed_gives_another_sample() {
    let home = home();
    let sample = |seed: &str| {
        let args = ["run", "v.toml", "--resolution", "3", "--samples", "300", "--json", "--seed", seed];
        let report: Value = serde_json::from_str(&json(home.path(), &args).1).unwrap();
        report["acceptance"]["sample"]["strata"].clone()
    };
    assert_ne!(sample("1"), sample("2"));
}

#[test]
fn requirements_decide_the_exit_code() {
    let home = home();
    let outcome = |requirements: &[&str]| {
        let mut args = vec!["run", "v.toml", "--method", "flood", "--resolution", "21"];
        args.extend(["--error-uniform", "x=0.1", "--json"]);
        args.extend(requirements.iter().flat_map(|r| ["--require", r]));
        let output = catchment(home.path()).args(args).output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    assert_eq!(outcome(&["onaa.edge>=0.1", "success.probability == 1", "tolerances.x.plus>0.1"]).0, 0);
    let (code, stderr) = outcome(&["onaa.edge>=0.1", "onaa.edge>=0.9", "acceptance.sum<0"]);
    assert_eq!(code, 1);
    assert!(stderr.starts_with("not met: onaa.edge >= 0.9 (it is 0."), "{stderr}");
    assert!(stderr.contains("\nnot met: acceptance.sum < 0 (it is 2."), "{stderr}");
    let (code, stderr) = outcome(&["ona.edge>=0.1"]);
    assert!(code == 2 && stderr.contains("did you mean `onaa`?"), "{stderr}");
    let (code, stderr) = outcome(&["acceptance.sum_ci95.0>=0.1"]);
    assert!(code == 2 && stderr.contains("`acceptance.sum_ci95.0`"), "{stderr}");
    assert_eq!(outcome(&["onaa.edge"]).0, 2);
}

#[test]
fn infeasible_runs_are_refused_and_leave_no_files() {
    let home = home();
    let refuse = |args: &[&str]| {
        let mut all = vec!["run", "v.toml", "-o", "out"];
        all.extend(args);
        let text = run(home.path(), &all);
        assert_eq!(entries(home.path()), ["v.toml"]);
        text
    };
    insta::assert_snapshot!("too_large", refuse(&["--resolution", "100000", "--memory", "1 MB"]));
    insta::assert_snapshot!("two_ends_of_sampling", refuse(&["--samples", "9", "--budget", "20s"]));
    insta::assert_snapshot!("no_such_time", refuse(&["--budget", "20 sec"]));
    insta::assert_snapshot!("no_such_share", refuse(&["--tolerance", "200%"]));
    insta::assert_snapshot!("axis_not_free", refuse(&["--resolution", "9,yaw=5"]));
    insta::assert_snapshot!("error_not_free", refuse(&["--error-sigma", "yaw=2 deg"]));
    insta::assert_snapshot!("tolerance_of_descent", refuse(&["--depth-tolerance", "0.1"]));
    insta::assert_snapshot!("no_such_method", refuse(&["--method", "flod"]));
}

#[test]
fn halves_that_do_not_mate_are_refused_in_their_place() {
    let cube = "[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]]";
    let text = format!(
        "[connector]\nface_height = 0.5\nfixed.pieces = [{cube}]\nmoving.pieces = [{cube}]\n\
         [alignment]\nfree = [\"x\"]\n"
    );
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("cubes.toml"), text).unwrap();
    let report = run(home.path(), &["run", "cubes.toml", "-o", "out"]);
    assert!(report.starts_with("exit 4\n--- stdout\n--- stderr\n"), "{report}");
    assert!(report.contains("nothing but a plane") && report.contains("cubes.toml:1"), "{report}");
    assert_eq!(entries(home.path()), ["cubes.toml"]);
}

#[test]
fn a_folder_holds_report_pictures_and_group() {
    let home = home();
    let args = ["run", "v.toml", "--resolution", "15", "--samples", "20", "-o", "out", "--json"];
    for _ in 0..2 {
        let (code, printed) = json(home.path(), &args);
        assert_eq!(code, 0);
        assert_eq!(fs::read_to_string(home.path().join("out/report.json")).unwrap(), printed);
    }
    assert_eq!(entries(home.path()), ["out", "v.toml"]);
    let out = home.path().join("out");
    let mut expected: Vec<String> = ["heights", "overview", "section", "slices", "solids"]
        .iter()
        .flat_map(|name| [format!("{name}.png"), format!("{name}.svg")])
        .chain(["report.json".to_owned(), "result.zarr".to_owned()])
        .collect();
    expected.sort();
    assert_eq!(written(&out), expected);
    for name in &expected[..] {
        let bytes = || fs::read(out.join(name)).unwrap();
        match name.rsplit_once('.').unwrap().1 {
            "png" => {
                assert!(bytes().starts_with(b"\x89PNG\r\n\x1a\n") && bytes().ends_with(b"IEND\xaeB`\x82"));
            }
            "svg" => assert!(bytes().starts_with(b"<svg") && bytes().trim_ascii_end().ends_with(b"</svg>")),
            _ => {}
        }
    }
    let root: Value = serde_json::from_slice(&fs::read(out.join("result.zarr/zarr.json")).unwrap()).unwrap();
    assert_eq!(root["node_type"], "group");
    assert!(out.join("result.zarr/outcome/zarr.json").exists() && out.join("result.zarr/height").exists());
}

#[test]
fn foreign_files_stay_and_bad_outputs_are_refused_first() {
    let home = home();
    fs::create_dir(home.path().join("thesis")).unwrap();
    fs::write(home.path().join("thesis/chapter.tex"), "years of work").unwrap();
    // A grid that would take hours: the refusal comes first.
    for place in [["-o", "thesis"], ["--figures", "thesis"], ["-o", "no/where"], ["-o", "v.toml"]] {
        let report = run(home.path(), &["run", "v.toml", "--resolution", "9999", place[0], place[1]]);
        assert!(report.starts_with("exit 2\n") && report.contains("cannot write"), "{report}");
    }
    assert_eq!(entries(&home.path().join("thesis")), ["chapter.tex"]);
}

#[test]
fn one_error_has_no_maps_but_the_halves() {
    let home = home();
    let report = run(
        home.path(),
        &["run", "v.toml", "--free", "x", "--resolution", "9", "--samples", "0", "--figures", "pictures"],
    );
    assert!(report.starts_with("exit 0\n"), "{report}");
    assert_eq!(
        written(&home.path().join("pictures")),
        ["section.png", "section.svg", "solids.png", "solids.svg"]
    );
}

/// An interrupt of a run that takes hours; the test holds whenever the signal arrives.
#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_ends_the_run_and_leaves_nothing() {
    use std::process::Stdio;
    let home = home();
    let child = catchment(home.path())
        .args(["run", "v.toml", "--resolution", "3000", "-o", "out", "--threads", "1"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Before the handler is installed, the signal ends the process without a code: SIGINT is the second bit of the mask of
    // caught signals.
    let status = format!("/proc/{}/status", child.id());
    let is_caught = || {
        let text = fs::read_to_string(&status).unwrap();
        let mask = text.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
        u64::from_str_radix(mask.trim(), 16).unwrap() & 0b10 != 0
    };
    while !is_caught() {
        std::thread::yield_now();
    }
    let pid = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert_eq!(stderr, "interrupted; nothing was written\n");
    assert_eq!(entries(home.path()), ["v.toml"]);
}

#[test]
fn a_partition_reports_its_sum_and_draws_its_outline() {
    let home = home();
    let how = ["--method", "partition", "--slices", "8", "--strips", "4", "--json", "-o", "out"];
    let report = super::json(home.path(), &[&["run", "v.toml"], &how[..]].concat());
    let (sum, grid) = (&report["partition"]["sum"], &report["acceptance"]["sum"]);
    let (sum, grid) = (sum.as_f64().unwrap(), grid.as_f64().unwrap());
    assert!((sum / grid - 1.0).abs() < 0.02, "{sum} exactly, {grid} over the grid");
    assert_eq!(report["settings"], serde_json::json!({ "slices": 8, "strips": 4 }));
    let pictures = written(&home.path().join("out"));
    assert!(["partition.png", "partition.svg"].iter().all(|name| pictures.contains(&(*name).to_owned())));
}

#[test]
fn a_certificate_reports_three_error_box_shares_and_the_retention() {
    let home = home();
    let how = ["run", "v.toml", "--method", "certified", "--boxes", "8000", "--resolution", "32"];
    let report = super::json(home.path(), &[&how[..], &["--json"]].concat());
    let part = |name: &str| report["certificate"][name].as_f64().unwrap();
    assert!((part("yes") + part("no") + part("undecided") - 1.0).abs() < 1e-9, "{report}");
    assert!(part("no") > 0.1 && part("retention_at_least") <= part("retention_at_most"), "{report}");
    // Only cells whose poses are all certain are reported; the Sum lies between the docking share and the docking plus the
    // undecided share.
    let (result, measures) = (&report["acceptance"], &report["certificate"]["measures"]);
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!(number(&result["sum_grid"]) <= number(&result["sum"]) + 1e-9, "{result}");
    assert_eq!(result["sum"], measures[0]);
    let most = number(&measures[0]) + number(&measures[2]);
    assert!((number(&result["sum_bracket"][1]) - most).abs() < 1e-12, "{result}");
    let followed =
        super::json(home.path(), &["run", "v.toml", "--samples", "2000", "--resolution", "32", "--json"]);
    let [lo, hi] = [0, 1].map(|k| number(&followed["acceptance"]["sum_ci95"][k]));
    assert!(number(&result["sum"]) < hi && lo < most, "{result} {lo} {hi}");
    let printout = run(home.path(), &how);
    assert!(printout.contains("certified: ") && !printout.contains("border moves by one cell"), "{printout}");
    assert!(!printout.contains("too coarse") && !printout.contains("without an interval"), "{printout}");
    assert!(["all dock", "none docks", "retention"].iter().all(|word| printout.contains(word)), "{printout}");
    let requested = [&how[..], &["--require", "certificate.undecided<=0"]].concat();
    assert!(run(home.path(), &requested).contains("not met: certificate.undecided <= 0"));
}

#[test]
fn slices_and_strips_belong_to_the_partition() {
    let home = home();
    let printout = run(home.path(), &["run", "v.toml", "--slices", "8"]);
    assert!(
        printout.starts_with("exit 2")
            && printout.contains("--slices is a setting of partition; confluence has none"),
        "{printout}"
    );
    let printout = run(home.path(), &["run", "v.toml", "--method", "partition", "--strips", "0"]);
    assert!(printout.starts_with("exit 2") && printout.contains("strips must be at least 1"), "{printout}");
}

/// Halves whose motions take long: random poses instead of a grid, with pictures of them, and the next command.
#[test]
fn a_first_run_on_many_facets_answers_without_a_grid() {
    let home = home();
    fs::write(home.path().join("pins.toml"), "[connector]\nfamily = \"pin-hole\"\n").unwrap();
    let printout = run(home.path(), &["run", "pins.toml", "--samples", "20", "-o", "out"]);
    assert!(printout.starts_with("exit 0"), "{printout}");
    for words in [
        "of 20 random poses",
        "tolerance window",
        "single-axis limit",
        "docked         below 16.11 % of the error box",
        "not docked     above 83.89 %; of the sampled poses jammed 10.0 %",
        "; by 20 poses sampled in the error box",
    ] {
        assert!(printout.contains(words), "{words} is missing in\n{printout}");
    }
    // The window stands above the Sum, and the next command comes last.
    assert!(printout.find("tolerance window") < printout.find("AA (Sum)"), "{printout}");
    assert!(printout.trim_end().ends_with("next: catchment report out -o page.html"), "{printout}");
    let written = entries(&home.path().join("out"));
    assert!(
        written.contains(&"sampled.png".to_owned()) && !written.contains(&"slices.png".to_owned()),
        "{written:?}"
    );
    let page = run(home.path(), &["report", "out", "-o", "page.html"]);
    assert!(page.starts_with("exit 0"), "{page}");
}
