//! `catchment catalog` and `catchment classify`.

use super::{catchment, designs, home, json, run};
use std::fs;
use std::path::Path;

fn stdout(folder: &Path, args: &[&str]) -> String {
    let output = catchment(folder).args(args).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_printed_tables_are_printed_byte_for_byte() {
    let folder = tempfile::tempdir().unwrap();
    let data = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../catchment-systems/data").join(name);
        fs::read_to_string(path).unwrap()
    };
    assert_eq!(stdout(folder.path(), &["catalog", "--as-printed", "1.1"]), data("table-1.1-connectors.csv"));
    assert_eq!(stdout(folder.path(), &["catalog", "--as-printed", "2.1"]), data("table-2.1-zraa.csv"));
}

#[test]
fn conditions_and_orders_choose_rows() {
    let folder = tempfile::tempdir().unwrap();
    let names = |args: &[&str]| -> Vec<String> {
        let report = json(folder.path(), &[&["catalog", "--json"], args].concat());
        assert_eq!(report["kind"], "catalog");
        let systems = report["systems"].as_array().unwrap();
        systems.iter().map(|system| system["system"].as_str().unwrap().to_owned()).collect()
    };
    let high = ["--where", "gendering=Ungendered", "--where", "degree=High"];
    assert_eq!(names(&high), ["DRAGON", "SINGO", "Vacuubes", "DFA"]);
    assert_eq!(names(&[&high[..], &["--sort", "zraa"]].concat()), ["DRAGON", "SINGO", "Vacuubes", "DFA"]);
    assert_eq!(names(&["--sort", "zraa"])[..3], ["3-D X-Face", "amour", "DRAGON"]);
    assert_eq!(names(&["--sort", "introduced"]).len(), 31);
    insta::assert_snapshot!("catalog_high", run(folder.path(), &[&["catalog"], &high[..]].concat()));
    insta::assert_snapshot!(
        "catalog_unknown_value",
        run(folder.path(), &["catalog", "--where", "degree=Hihg"])
    );
}

#[test]
fn every_form_has_every_row() {
    let folder = tempfile::tempdir().unwrap();
    let table = stdout(folder.path(), &["catalog"]);
    assert!(table.contains("31 systems") && table.lines().all(|line| line.chars().count() <= 80), "{table}");
    let csv = stdout(folder.path(), &["catalog", "--csv"]);
    assert_eq!(csv.lines().count(), 1 + 31);
    assert!(
        csv.contains(",Magnet,Magnetic,") && csv.starts_with("system,source,introduced,introduced_normal,")
    );
    let markdown = stdout(folder.path(), &["catalog", "--markdown"]);
    assert_eq!(markdown.lines().count(), 2 + 31);
}

#[test]
fn one_system_is_shown_with_where_each_number_comes_from() {
    let folder = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("catalog_show_dragon", run(folder.path(), &["catalog", "show", "DRAGON"]));
    let printout = stdout(folder.path(), &["catalog", "show", "PolyBot"]);
    assert!(printout.starts_with("Polybot G3: tables 1.1 and 2.1 (as Polybot)"), "{printout}");
    assert!(
        printout.contains("0.00503 D²")
            && printout.contains("0.005027 D²")
            && printout.contains("[R] 4 pairs"),
        "{printout}"
    );
    let report = json(folder.path(), &["catalog", "show", "x-face", "--json"]);
    assert_eq!((report["kind"].as_str(), report["zraa_d2"].as_f64()), (Some("catalog-system"), Some(2.0)));
    assert!(report["numbers"].as_array().unwrap().iter().any(|n| n["provenance"] == "R"));
    insta::assert_snapshot!("catalog_show_misspelt", run(folder.path(), &["catalog", "show", "Dragn"]));
}

#[test]
fn written_designs_have_the_published_areas() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["cone", "x-face-3d", "polybot"] {
        let file = format!("{name}.toml");
        assert!(run(folder.path(), &["catalog", "design", name, "-o", &file]).starts_with("exit 0\n"));
        assert!(run(folder.path(), &["check", &file]).starts_with("exit 0\n"), "{name}");
        let again = run(folder.path(), &["catalog", "design", name, "-o", &file]);
        assert!(again.starts_with("exit 2\n") && again.contains("--force"), "{again}");
    }
    let zraa = |name: &str| json(folder.path(), &["zraa", name, "--json"]);
    let x_face = zraa("x-face-3d.toml");
    assert!((x_face["area_d2"].as_f64().unwrap() - 2.0).abs() < 1e-9, "{x_face}");
    assert!((x_face["onaa_d"].as_f64().unwrap() - 1.0).abs() < 1e-8, "{x_face}");
    // The cone's face is √2 wide in units of the square that it circumscribes: 1.57 and 1.0.
    let cone = zraa("cone.toml");
    let bounds = |name: &str, factor: f64| [0, 1].map(|k| factor * cone[name][k].as_f64().unwrap());
    let [low, high] = bounds("circle_area_d2", 2.0);
    let around = std::f64::consts::FRAC_PI_2;
    assert!(low < around && around < high && high - low < 0.01, "{low} {high}");
    let [low, high] = bounds("circle_onaa_d", std::f64::consts::SQRT_2);
    assert!(low <= 1.0 && 1.0 <= high && high - low < 0.005, "{low} {high}");
}

#[test]
fn the_square_in_a_region_is_reported_and_drawn() {
    let edge = |design: &str, more: &[&str]| {
        json(&designs(), &[&["zraa", design, "--json"], more].concat())["onaa_d"].as_f64().unwrap()
    };
    assert!((edge("x-face-3d.toml", &[]) - 1.0).abs() < 1e-8);
    assert!((edge("pyramid-stl.toml", &[]) - 1.0).abs() < 1e-6);
    for (face, length) in [("s-face.toml", 2.0 / 3.0), ("v-face.toml", 1.0), ("x-face.toml", 2.0)] {
        assert!((edge(face, &[]) - length).abs() < 1e-9, "{face}");
    }
    let folder = tempfile::tempdir().unwrap();
    let design = designs().join("x-face-3d.toml");
    let printout = run(folder.path(), &["zraa", design.to_str().unwrap(), "-o", "region.svg"]);
    assert!(
        printout.contains("  onaa           1.0000000 D\n") && printout.contains("around zero"),
        "{printout}"
    );
    let svg = fs::read_to_string(folder.path().join("region.svg")).unwrap();
    assert!(svg.contains("ONAA 1.000 D") && svg.contains("stroke-dasharray=\"6 3\""));
}

#[test]
fn a_design_is_classified_and_appended() {
    let designs = designs();
    insta::assert_snapshot!("classify_x_face_3d", run(&designs, &["classify", "x-face-3d.toml"]));
    let report = json(&designs, &["classify", "pyramid.toml", "--json"]);
    assert_eq!((report["kind"].as_str(), report["degree"].as_str()), (Some("classify"), Some("High")));
    assert_eq!(report["gendering"], "Gendered");
    assert!((report["longest_d"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{report}");
    let home = home();
    let printout = stdout(home.path(), &["classify", "v.toml"]);
    assert!(printout.contains("length has no ratio") && printout.contains("Gendered"), "{printout}");
    // One translation is locked: the corrected set is an interval, not a square.
    assert!(printout.contains("ONAA           1 D, length of the corrected interval\n"), "{printout}");
    assert!(!printout.contains("square"), "{printout}");
    let appended = json(&designs, &["catalog", "--append", "x-face-3d.toml", "--json"]);
    let rows: Vec<&serde_json::Value> =
        appended["systems"].as_array().unwrap().iter().filter(|row| row["attributes"].is_object()).collect();
    assert_eq!(rows.len(), 28);
    assert_eq!(rows[27]["attributes"]["gendering"]["printed"], "Ungendered");
    assert!((rows[27]["zraa_d2"].as_f64().unwrap() - 2.0).abs() < 1e-9);
    let high = ["catalog", "--append", "x-face-3d.toml", "--where", "degree=High", "--csv"];
    assert_eq!(stdout(&designs, &high).lines().count(), 1 + 9 + 1);
}

#[test]
fn both_figures_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let printout = run(folder.path(), &["catalog", "-o", "a.svg", "--where", "degree=High"]);
    assert!(printout.starts_with("exit 0\n") && printout.contains("9 systems"), "{printout}");
    let svg = fs::read_to_string(folder.path().join("a.svg")).unwrap();
    assert!(svg.contains("All published areas") && svg.contains("SINGO Connector"));
    assert!(run(folder.path(), &["catalog", "--figure", "4.2", "-o", "b.png"]).starts_with("exit 0\n"));
    assert!(fs::read(folder.path().join("b.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn a_name_cannot_steer_the_terminal() {
    let home = home();
    let name = "name = \"a\\u202e|<& and very much longer than a column of a table\"\n";
    fs::write(home.path().join("evil.toml"), name.to_owned() + super::V_FACE).unwrap();
    let append = ["catalog", "--append", "evil.toml"];
    for args in [
        &["classify", "evil.toml"][..],
        &append,
        &[&append[..], &["--csv"]].concat(),
        &[&append[..], &["--json"]].concat(),
        &[&append[..], &["--markdown"]].concat(),
        &[&append[..], &["-o", "evil.svg"]].concat(),
    ] {
        let printout = run(home.path(), args);
        let steers = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
        assert!(printout.starts_with("exit 0\n") && !printout.contains(steers), "{args:?}: {printout:?}");
    }
}
