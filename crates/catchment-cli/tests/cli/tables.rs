//! `catchment zraa` and `catchment reproduce` against known numbers.

use super::{catchment, designs, json, run, written};
use std::fs;

/// `zraa` of a committed design as JSON.
fn zraa(design: &str, more: &[&str]) -> serde_json::Value {
    let mut args = vec!["zraa", design, "--json"];
    args.extend(more);
    json(&designs(), &args)
}

#[test]
fn closed_forms_of_the_zero_rotation_area() {
    let area = |design, more: &[&str]| zraa(design, more)["area_d2"].as_f64().unwrap();
    // Sums of a few polygon areas, cut with a seam of 1e-11 D.
    assert!((area("x-face-3d.toml", &[]) - 2.0).abs() < 1e-9);
    for pyramid in ["pyramid.toml", "pyramid-stl.toml", "pyramid-pieces.toml", "pyramid-assembled.toml"] {
        assert!((area(pyramid, &[]) - 1.0).abs() < 1e-9, "{pyramid}");
    }
    let circle = &zraa("cone.toml", &[])["circle_area_d2"];
    let [lower, upper] = [0, 1].map(|k| circle[k].as_f64().unwrap());
    let exact = std::f64::consts::FRAC_PI_4;
    assert!(lower < exact && exact < upper && upper - lower < 0.005, "{circle}");
}

#[test]
fn nilssons_bounds_of_planar_faces() {
    for (design, bound) in [("s-face.toml", 1.0 / 3.0), ("v-face.toml", 0.5), ("x-face.toml", 1.0)] {
        let report = zraa(design, &[]);
        assert_eq!(report["axis"], "x");
        assert!((report["to_d"].as_f64().unwrap() - bound).abs() < 1e-9, "{report}");
        assert!((report["from_d"].as_f64().unwrap() + bound).abs() < 1e-9, "{report}");
    }
}

#[test]
fn zraa_for_people_and_its_files() {
    insta::assert_snapshot!("zraa_pyramid_stl", run(&designs(), &["zraa", "pyramid-stl.toml"]));
    insta::assert_snapshot!("zraa_cone_along_x", run(&designs(), &["zraa", "cone.toml", "--free", "x"]));
    let dir = tempfile::tempdir().unwrap();
    let design = designs().join("pyramid-stl.toml");
    let with = |file: &str| run(dir.path(), &["zraa", design.to_str().unwrap(), "-o", file]);
    for file in ["a.svg", "a.png", "a.csv"] {
        assert!(with(file).starts_with("exit 0\n"));
    }
    assert!(fs::read_to_string(dir.path().join("a.svg")).unwrap().contains("1.000000 D² accepted"));
    assert!(fs::read(dir.path().join("a.png")).unwrap().starts_with(b"\x89PNG"));
    let csv = fs::read_to_string(dir.path().join("a.csv")).unwrap();
    assert!(csv.starts_with("polygon,x,y\n0,") && csv.lines().count() >= 5, "{csv}");
    insta::assert_snapshot!("zraa_over_a_file", with("a.svg"));
    assert!(with("a.jpg").contains("let its name end in .json, .csv, .md, .html, .txt, .png, .svg"));
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 3);
}

#[test]
fn a_published_table_beside_ours() {
    let folder = designs();
    insta::assert_snapshot!("reproduce_5_7", run(&folder, &["reproduce", "5.7"]));
    let report = json(&folder, &["reproduce", "3.3", "5.7", "--json"]);
    let [kinematic, discrete] = [0, 1].map(|k| &report["tables"][k]);
    assert_eq!(
        (&kinematic["summary"]["as_printed"], &kinematic["warnings"]),
        (&121.into(), &serde_json::json!([]))
    );
    assert_eq!(discrete["summary"]["as_printed"], 25);
    assert_eq!(discrete["warnings"][0]["kind"], "dissertation-conventions");
    let output = catchment(&folder).args(["reproduce", "3.3", "--csv"]).output().unwrap();
    let csv = String::from_utf8(output.stdout).unwrap();
    assert_eq!(csv.lines().count(), 1 + 121);
    assert!(
        csv.starts_with("table,row,column,unit,published,ours,ratio,as_printed,matches,exact,")
            && csv.contains("\n3.3,")
    );
    assert!(output.stderr.is_empty());
}

#[test]
fn an_unknown_table_is_recognised() {
    insta::assert_snapshot!("reproduce_unknown", run(&designs(), &["reproduce", "5.77"]));
}

#[test]
fn tables_are_written_with_pictures_and_exact_values() {
    let dir = tempfile::tempdir().unwrap();
    let printed = run(dir.path(), &["reproduce", "2.1", "3.3", "-o", "out"]);
    assert!(printed.contains("wrote out: report.json, tables.csv, 2 pictures as PNG and SVG"), "{printed}");
    assert!(
        printed.contains("Held or known, and not computed") && printed.contains("measured forces of latches"),
        "{printed}"
    );
    let names = written(&dir.path().join("out"));
    assert_eq!(
        names,
        ["report.json", "table-2.1.png", "table-2.1.svg", "table-3.3.png", "table-3.3.svg", "tables.csv"]
    );
    // A reproduction replaces its own folder and refuses any other.
    assert!(run(dir.path(), &["reproduce", "2.1", "-o", "out"]).starts_with("exit 0\n"));
    fs::write(dir.path().join("out/holiday.png"), "").unwrap();
    assert!(run(dir.path(), &["reproduce", "2.1", "-o", "out"]).contains("cannot write"));
}
