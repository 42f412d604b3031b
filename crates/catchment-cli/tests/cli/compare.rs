//! `catchment compare` and `run --method all`: acceptances side by side.

use super::{V_FACE, designs, home, json, run, written};
use std::fs;

#[test]
fn two_methods_of_a_design() {
    let home = home();
    let args = ["compare", "v.toml", "--methods", "descent,flood", "--resolution", "20"];
    insta::assert_snapshot!("compare_methods", run(home.path(), &args));
    let report = json(home.path(), &[&args[..], &["--json"]].concat());
    let c = &report["comparison"];
    assert_eq!((report["kind"].as_str(), c["poses"].as_u64()), (Some("comparison"), Some(400)));
    let rows = c["confusion"].as_array().unwrap();
    let count = |value: &serde_json::Value| value.as_u64().unwrap();
    assert_eq!(rows.iter().flat_map(|row| row.as_array().unwrap()).map(count).sum::<u64>(), 400);
    assert!(
        c["jaccard"].as_f64().unwrap() > 0.8 && c["distances"]["cells"]["median"].as_f64().unwrap() >= 1.0
    );
    let printed = run(home.path(), &[&args[..], &["-o", "out"]].concat());
    assert!(
        printed.contains("wrote out: report.json, difference.csv, difference as PNG and SVG"),
        "{printed}"
    );
    assert_eq!(
        written(&home.path().join("out")),
        ["difference.csv", "difference.png", "difference.svg", "report.json"]
    );
    let same = json(home.path(), &["compare", "v.toml", "v.toml", "--resolution", "12", "--json"]);
    assert_eq!((&same["comparison"]["jaccard"], &same["comparison"]["distances"]), (&1.0.into(), &().into()));
}

#[test]
fn stored_results_are_compared_with_each_other_and_with_designs() {
    let home = home();
    let folder = home.path();
    let store = |name: &str, cells: &str| {
        let args = ["run", "v.toml", "--method", "flood", "--resolution", cells, "-o", name];
        assert!(run(folder, &args).starts_with("exit 0\n"));
    };
    store("coarse.zarr", "9");
    store("fine.zarr", "27");
    store("folder", "9");
    store("other.zarr", "10");
    let jaccard = |args: &[&str]| {
        let report = json(folder, &[&["compare"], args, &["--json"]].concat());
        assert_eq!(report["comparison"]["poses"], 81);
        report["comparison"]["jaccard"].as_f64().unwrap()
    };
    assert_eq!(jaccard(&["coarse.zarr", "folder"]), 1.0);
    assert_eq!(jaccard(&["folder", "v.toml", "--methods", "flood"]), 1.0);
    assert!(jaccard(&["coarse.zarr", "fine.zarr"]) > 0.5);
    insta::assert_snapshot!("compare_other_cells", run(folder, &["compare", "coarse.zarr", "other.zarr"]));
    let refused = |code: &str, args: &[&str]| {
        let printed = run(folder, &[&["compare"], args].concat());
        assert!(printed.starts_with(code), "{printed}");
        printed
    };
    fs::create_dir(folder.join("empty")).unwrap();
    assert!(refused("exit 4\n", &["empty", "v.toml"]).contains("it holds no zarr.json"));
    assert!(refused("exit 2\n", &["v.toml"]).contains("one thing cannot be compared"));
    assert!(
        refused("exit 2\n", &["folder", "folder", "--methods", "flood"])
            .contains("more methods than there are designs")
    );
    assert!(refused("exit 3\n", &["v.toml", "none.toml"]).contains("none.toml"));
    assert!(refused("exit 2\n", &["v.toml", "--methods", "flood,guess"]).contains("guess"));
    fs::write(folder.join("narrow.toml"), V_FACE.to_owned() + "[errors]\nx = 0.5\n").unwrap();
    assert!(
        refused("exit 2\n", &["v.toml", "narrow.toml", "--resolution", "8"])
            .contains("the error boxes differ along x")
    );
}

#[test]
fn more_errors_are_compared_in_slices_and_one_has_no_picture() {
    let home = tempfile::tempdir().unwrap();
    let design = designs().join("pyramid.toml");
    let design = design.to_str().unwrap();
    let args = ["compare", design, "--methods", "transport,flood", "--resolution", "5", "-o", "out"];
    let printed = run(home.path(), &args);
    assert!(
        printed.starts_with("exit 0\n") && printed.contains("5 × 5 × 5 × 5 × 5 = 3 125 poses"),
        "{printed}"
    );
    assert!(written(&home.path().join("out")).contains(&"difference.png".to_owned()));
    fs::write(home.path().join("x.toml"), V_FACE.to_owned() + "free = [\"x\"]\n").unwrap();
    let args = ["compare", "x.toml", "--methods", "flood,descent", "--resolution", "9", "-o", "line"];
    let printed = run(home.path(), &args);
    assert!(printed.contains("no picture: a map needs two free errors"), "{printed}");
    assert_eq!(written(&home.path().join("line")), ["difference.csv", "report.json"]);
}

#[test]
fn every_method_that_applies_stands_beside_the_others() {
    let home = home();
    let args = "run v.toml --method all --resolution 8 --samples 20 --boxes 2000 --time-limit 10min";
    let args: Vec<&str> = args.split(' ').collect();
    let printed = run(home.path(), &[&args[..], &["-o", "out"]].concat());
    let report = fs::read(home.path().join("out/report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    let methods = report["methods"].as_array().unwrap();
    let decided = methods.iter().filter(|m| m["result"].is_object()).count();
    assert!(decided >= 5 && methods.iter().any(|m| m["method"] == "kinematic"), "{report}");
    let matrix = report["agreement"].as_array().unwrap();
    assert_eq!(matrix.len(), decided);
    for (k, row) in matrix.iter().enumerate() {
        assert_eq!((&row[k]["agreement"], &row[k]["jaccard"]), (&1.0.into(), &1.0.into()));
        for (j, other) in matrix.iter().enumerate() {
            assert_eq!(row[j], other[k]);
        }
    }
    assert!(
        printed.contains("Jaccard: accepted by both")
            && printed.contains("wrote out: report.json, methods.csv"),
        "{printed}"
    );
    assert_eq!(
        written(&home.path().join("out")),
        ["methods.csv", "methods.png", "methods.svg", "report.json"]
    );
    // A method that does not apply or takes too long is listed with the reason.
    let hardly = ["run", "v.toml", "--method", "all", "--time-limit", "0.001 ms", "--cor", "0.5"];
    let printed = run(home.path(), &hardly);
    assert!(
        printed.contains("without kinematic: ") && printed.contains("center_of_rotation must not be"),
        "{printed}"
    );
    assert!(
        printed.starts_with("exit 0\n")
            && printed.contains("without descent: it takes longer than the 0.000001 s"),
        "{printed}"
    );
    for option in [["--require", "onaa.edge>0"], ["--depth-tolerance", "0.1"], ["--error-sigma", "x=0.1"]] {
        let printed = run(home.path(), &[&["run", "v.toml", "--method", "all"], &option[..]].concat());
        assert!(
            printed.starts_with("exit 2\n") && printed.contains("about the result of one method"),
            "{printed}"
        );
    }
}

#[test]
fn the_kinematic_method_decides_planar_families_alone() {
    let home = home();
    let printed = run(home.path(), &["run", "v.toml", "--method", "kinematic", "--resolution", "40"]);
    assert!(
        printed.starts_with("exit 0\n") && printed.contains("kinematic, of a grid of 40 × 40"),
        "{printed}"
    );
    let design = designs().join("pyramid.toml");
    fs::copy(design, home.path().join("pyramid.toml")).unwrap();
    insta::assert_snapshot!(
        "kinematic_of_a_pyramid",
        run(home.path(), &["run", "pyramid.toml", "--method", "kinematic"])
    );
    assert!(run(home.path(), &["run", "v.toml", "--time-limit", "1s"]).contains("--budget limits the time"));
}
