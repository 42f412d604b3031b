//! Solids as files, watersheds before merging, and trials compared with the exact region.

use crate::{catchment, home, json, run, written};
use std::fs;
use std::path::Path;

/// Files are complete or absent: a second run needs `--force` and writes the same bytes.
#[test]
fn shapes_are_written_in_the_format_of_the_extension() {
    let home = home();
    let read = |name: &str| fs::read_to_string(home.path().join(name)).unwrap();
    let to = |name: &str, more: &[&str]| {
        let printed = run(home.path(), &[&["solids", "v.toml", "-o", name], more].concat());
        assert!(printed.starts_with("exit 0\n"), "{printed}");
        printed
    };
    let printed = to("turned.vtp", &["--free", "x,pitch"]);
    // 16 intervals between slices, 2 pieces of the notch, 2 · 3 bodies for the three corners of the tip.
    assert!(printed.contains("2 fixed, 1 moving") && printed.contains("192 convex bodies"), "{printed}");
    assert!(
        printed.contains("15 slices, 1 strips per D") && printed.contains("pitch  -1.571  1.571  rad"),
        "{printed}"
    );
    let vtp = read("turned.vtp");
    assert!(vtp.starts_with("<?xml version=\"1.0\"?>") && vtp.contains("<VTKFile type=\"PolyData\""));
    assert_eq!(vtp.matches("<DataArray").count(), 10);
    to("flat.obj", &["--free", "x"]);
    assert_eq!(read("flat.obj").matches("\ng body").count(), 2);
    to("swept.png", &["--shape", "swept", "--slices", "4"]);
    assert!(fs::read(home.path().join("swept.png")).unwrap().starts_with(b"\x89PNG"));
    to("halves.svg", &["--shape", "halves"]);
    assert!(read("halves.svg").contains("both halves as convex pieces"));
    assert!(run(home.path(), &["solids", "v.toml", "-o", "flat.obj"]).contains("--force replaces it"));
    to("again.vtp", &["--free", "x,pitch"]);
    assert_eq!(read("again.vtp"), vtp);
}

#[test]
fn a_shape_is_reported_as_json() {
    let home = home();
    let report = json(home.path(), &["solids", "v.toml", "--free", "x", "--json"]);
    assert_eq!((&report["kind"], &report["shape"]), (&"solids".into(), &"collision".into()));
    assert_eq!((&report["bodies"], &report["dimension"]), (&2.into(), &2.into()));
    // From the tip beside the notch to its other side, and from below to above: 2 D by 2 H about the mated
    // pose.
    assert_eq!((&report["low"][0], &report["high"][0]), (&(-1.0).into(), &1.0.into()));
    assert_eq!((&report["low"][2], &report["high"][2]), (&(-1.0).into(), &1.0.into()));
}

/// The initial labels of a V-Face at 60 × 60 cells, 7 that become 3 by either kind of flooding: counted in the report, stored, drawn, and used by a requirement.
#[test]
fn watersheds_are_counted_before_merging_and_after() {
    let home = home();
    for method in ["flood", "meyer"] {
        let design = ["run", "v.toml", "--aspect-ratio", "0.5", "--cor=-0.5"];
        let args = [&design[..], &["--method", method, "--resolution", "60", "--samples", "0"]].concat();
        let report = json(home.path(), &[&args[..], &["--json"]].concat());
        let of = |name: &str| report["watersheds"][name].as_f64().unwrap();
        assert_eq!((of("first"), of("merged")), (7.0, 3.0), "{method}");
        assert!(of("moved_share") > 0.0 && of("moved_share") < 1.0, "{method}");
        assert_eq!(of("dams") > 0.0, method == "meyer");
        let required = ["--require", "watersheds.merged<=3", "--require", "watersheds.first>=2"];
        assert!(run(home.path(), &[&args[..], &required].concat()).starts_with("exit 0\n"));
        let printed = run(home.path(), &[&args[..], &["--verbose"]].concat());
        assert!(
            printed.contains("first labels") && printed.contains("of the cells changed basin by merging"),
            "{printed}"
        );
        let out = home.path().join(method);
        let folder = [&args[..], &["-o", out.to_str().unwrap()]].concat();
        assert!(run(home.path(), &folder).starts_with("exit 0\n"));
        let names = written(&out);
        assert!(names.contains(&"watersheds.png".to_owned()) && names.contains(&"watersheds.svg".to_owned()));
        for array in ["watershed", "watershed_merged"] {
            assert!(out.join("result.zarr").join(array).join("zarr.json").is_file(), "{array}");
        }
    }
    let report = json(home.path(), &["run", "v.toml", "--resolution", "8", "--samples", "0", "--json"]);
    assert!(report["watersheds"].is_null());
}

#[test]
fn drop_trials_stand_beside_the_exact_region() {
    let home = home();
    let args =
        ["zraa", "v.toml", "--beside", "drop", "--trials", "1", "--resolution", "4,9", "--halvings", "1"];
    let report = json(home.path(), &[&args[..], &["--json", "-o", "beside.svg"]].concat());
    assert_eq!((&report["kind"], &report["unit"]), (&"trials".into(), &"D".into()));
    assert!((report["exact"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    let rounds = report["rounds"].as_array().unwrap();
    let shown: Vec<_> =
        rounds.iter().map(|round| (round["trials"].as_u64(), round["timestep"].as_f64())).collect();
    let expected = [(4, 1e-3), (9, 1e-3), (9, 5e-4)];
    assert_eq!(shown, expected.map(|(trials, step)| (Some(trials), Some(step))));
    for round in rounds {
        assert!(round["disagreeing"].as_f64() <= round["disagreeing_ci95"][1].as_f64());
    }
    let picture = fs::read_to_string(home.path().join("beside.svg")).unwrap();
    assert!(picture.contains("in theory and by trials"));
    let printed =
        run(home.path(), &["zraa", "v.toml", "--beside", "descent", "--resolution", "50", "-o", "t.csv"]);
    assert!(printed.starts_with("exit 0\n") && printed.contains("0.00 %"), "{printed}");
    let table = fs::read_to_string(home.path().join("t.csv")).unwrap();
    assert_eq!((table.lines().next(), table.lines().count()), (Some("x,outcome,inside"), 51));
}

/// All settings of the preset, with one of them replaced.
#[test]
fn explicit_options_override_a_preset() {
    let home = home();
    fs::write(home.path().join("p.csv"), "x\n0.02\n").unwrap();
    let settings = |more: &[&str]| {
        let args = ["outcome", "v.toml", "--poses", "p.csv", "--method", "drop", "--preset", "gazebo-2014"];
        json(home.path(), &[&args[..], more, &["--json"]].concat())["settings"].clone()
    };
    let given = settings(&["--friction", "0.1"]);
    assert!((given["push"]["gravity"].as_f64().unwrap() - 9000.0 / 0.0655).abs() < 1e-6);
    assert!((given["damping"].as_f64().unwrap() - 99_000.0).abs() < 1e-6);
    assert_eq!((&given["ground"], &given["friction"]), (&0.0.into(), &0.1.into()));
    let given = settings(&["--gravity", "100", "--ground", "0.5"]);
    assert_eq!((&given["push"]["gravity"], &given["ground"]), (&100.0.into(), &0.5.into()));
    let exported = catchment(home.path())
        .args(["export", "v.toml", "--pose", "x=0.1", "--preset", "gazebo-2014", "-o", "trial"])
        .output()
        .unwrap();
    assert_eq!(exported.status.code(), Some(2));
    assert!(!Path::new(&home.path().join("trial")).exists());
}

/// The run writes the same bytes as `export` does from its folder; a second run needs `--force`.
#[test]
fn a_set_is_the_same_from_the_run_and_from_its_folder() {
    let home = home();
    let read = |name: &str| fs::read(home.path().join(name)).unwrap();
    let grid = ["run", "v.toml", "--resolution", "8", "--samples", "0"];
    let printed = run(home.path(), &[&grid[..], &["-o", "out"]].concat());
    assert!(printed.starts_with("exit 0\n"), "{printed}");
    for ending in ["vti", "vtp", "csv"] {
        let [straight, later] = ["straight", "later"].map(|name| format!("{name}.{ending}"));
        assert!(run(home.path(), &[&grid[..], &["-o", &straight]].concat()).starts_with("exit 0\n"));
        let export = ["export", "out", "-o", &later];
        let printed = run(home.path(), &export);
        assert!(printed.starts_with("exit 0\n"), "{printed}");
        assert_eq!(printed.contains("of 64 cells"), ending != "csv", "{printed}");
        assert_eq!(read(&straight), read(&later), "{ending}");
        assert!(run(home.path(), &export).contains("--force replaces it"));
        assert!(run(home.path(), &[&export[..], &["--force"]].concat()).starts_with("exit 0\n"));
    }
}
