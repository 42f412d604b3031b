//! Planar faces: Nilsson's bounds, faces side by side, lever arms, layers.

use super::{designs, json, run};
use std::fs;

/// The absolute path of a committed design.
fn design(name: &str) -> String {
    designs().join(name).display().to_string()
}

#[test]
fn nilssons_bound_stands_beside_the_exact_answer() {
    for (name, ungendered, bound) in [("v-face.toml", false, 0.5), ("s-face.toml", true, 1.0 / 3.0)] {
        let report = json(&designs(), &["zraa", name, "--json"]);
        let nilsson = &report["nilsson"];
        assert_eq!(nilsson["ungendered"], ungendered, "{nilsson}");
        for field in [&nilsson["bound_d"], &nilsson["both_d"], &report["to_d"], &nilsson["to"]["offset_d"]] {
            assert!((field.as_f64().unwrap() - bound).abs() < 1e-9, "{name}: {report}");
        }
    }
    assert!(json(&designs(), &["zraa", "x-face.toml", "--json"])["nilsson"].is_null());
    // Lines may break anywhere.
    let printed = run(&designs(), &["zraa", "v-face.toml"]).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        printed.contains("nilsson D/2 to both sides is the most for one profile, halves of two kinds"),
        "{printed}"
    );
    assert!(
        printed.contains("to +x the minimum at x = 0 slides home short of the maximum at 0.5"),
        "{printed}"
    );
}

/// A custom profile: a polyline cut into columns, its minimum off the middle.
#[test]
fn an_own_profile_is_measured_by_its_extrema() {
    let dir = tempfile::tempdir().unwrap();
    // z = f(x): (−½, 0.5), (0.1, 0), (½, 0.3); the moving half is its counterpart, turned over.
    let column = |a: [f64; 2], b: [f64; 2]| {
        let ring = [[a[0], -1.0], [b[0], -1.0], b, a];
        let corners = |y: f64| ring.map(|[x, z]| format!("[{x},{y},{z}]")).join(",");
        format!("[{},{}]", corners(-0.5), corners(0.5))
    };
    let fixed = [column([-0.5, 0.5], [0.1, 0.0]), column([0.1, 0.0], [0.5, 0.3])].join(",");
    let moving = [column([-0.5, -0.3], [-0.1, 0.0]), column([-0.1, 0.0], [0.5, -0.5])].join(",");
    let text = format!(
        "name = \"own\"\n[connector]\nface_height = 0\n[connector.fixed]\npieces = [{fixed}]\n\
         [connector.moving]\npieces = [{moving}]\n[alignment]\nfree = [\"x\"]\nmount = \"y\"\n"
    );
    fs::write(dir.path().join("own.toml"), text).unwrap();
    let report = json(dir.path(), &["zraa", "own.toml", "--json"]);
    let at = |field: &serde_json::Value| field.as_f64().unwrap();
    assert!(
        (at(&report["to_d"]) - 0.4).abs() < 1e-9 && (at(&report["from_d"]) + 0.6).abs() < 1e-9,
        "{report}"
    );
    let nilsson = &report["nilsson"];
    assert!((at(&nilsson["both_d"]) - 0.4).abs() < 1e-9 && at(&nilsson["bound_d"]) == 0.5, "{nilsson}");
    assert_eq!((at(&nilsson["to"]["minimum_d"]), at(&nilsson["to"]["maximum_d"])), (0.1, 0.5));
    assert_eq!((at(&nilsson["from"]["minimum_d"]), at(&nilsson["from"]["maximum_d"])), (0.1, -0.5));
}

#[test]
fn faces_stand_side_by_side() {
    let dir = tempfile::tempdir().unwrap();
    let three = ["s-face.toml", "v-face.toml", "x-face.toml"].map(design);
    let with = |more: &[&str]| {
        let given: Vec<&str> = three.iter().map(String::as_str).collect();
        run(dir.path(), &[&["zraa"], &given[..], more].concat())
    };
    for file in ["a.svg", "a.png", "a.csv"] {
        assert!(with(&["-o", file]).starts_with("exit 0\n"), "{}", with(&["-o", file, "--force"]));
    }
    let svg = fs::read_to_string(dir.path().join("a.svg")).unwrap();
    for printed in ["0.3333 D", "0.5 D", "1 D", "one profile: at most D/3", "one profile: at most D/2"] {
        assert!(svg.contains(printed), "{printed}");
    }
    assert!(fs::read(dir.path().join("a.png")).unwrap().starts_with(b"\x89PNG"));
    let csv = fs::read_to_string(dir.path().join("a.csv")).unwrap();
    assert!(
        csv.starts_with("name,from,to,nilsson_bound,nilsson_both\n") && csv.lines().count() == 4,
        "{csv}"
    );
    assert!(csv.trim_end().ends_with(",,"), "{csv}");
    let report = json(dir.path(), &["zraa", &three[0], &three[2], "--json"]);
    assert_eq!(report["faces"].as_array().unwrap().len(), 2);
    assert!((report["faces"][1]["to_d"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    // A changed setting applies to every design.
    let spatial = [design("pyramid.toml"), design("cone.toml")];
    let along_x = json(dir.path(), &["zraa", &spatial[0], &spatial[1], "--free", "x", "--json"]);
    assert_eq!(along_x["faces"][1]["axis"], "x");
}

#[test]
fn lever_arms_and_angles_of_a_pose() {
    let dir = tempfile::tempdir().unwrap();
    let x_face = design("x-face.toml");
    let args = ["trace", &x_face, "--cor=-1", "--aspect-ratio", "0.5", "--method", "kinematic", "--pose"];
    let with = |more: &[&'static str]| [&args[..], more].concat();
    let aligned = json(dir.path(), &with(&["x=0.4", "--json"]));
    let contact = &aligned["contact"];
    let at = |name: &str| contact[name].as_f64().unwrap();
    // Without rotation: β_p = atan(1/(r_p + H)), α_e = atan H, and the alignment condition holds.
    assert!(
        (at("beta_p") - f64::atan(1.0 / 2.5)).abs() < 1e-12 && (at("alpha_e") - f64::atan(0.5)).abs() < 1e-12
    );
    assert!((at("theta_2") - at("theta_2_aligned")).abs() < 1e-12);
    assert_eq!((&aligned["halt"], &aligned["outcome"]), (&"success".into(), &"aligned".into()));
    for file in ["a.svg", "a.png", "a.csv", "a.json"] {
        let printed = run(dir.path(), &with(&["x=0.2,pitch=10 deg", "-o", file]));
        assert!(
            printed.starts_with("exit 0\n") && printed.contains("alpha_e  normal to vertical"),
            "{printed}"
        );
    }
    let svg = fs::read_to_string(dir.path().join("a.svg")).unwrap();
    for word in ["P_M moving", "P_B base", "P_C", "βₚ", "αₑ", "θ₁", "θ₂"] {
        assert!(svg.contains(word), "{word}");
    }
    assert!(!svg.contains("NaN"));
    let csv = fs::read_to_string(dir.path().join("a.csv")).unwrap();
    assert!(csv.contains("\ntheta_2,") && csv.lines().count() == 17, "{csv}");
}

#[test]
fn a_layer_on_the_wrong_one_is_crossed() {
    let dir = tempfile::tempdir().unwrap();
    let layers = design("x-face-layers.toml");
    fs::write(dir.path().join("p.csv"), "x,y\n0.3,0.1\n0.3,-0.3\n0.3,0.7\n").unwrap();
    let args = ["outcome", &layers, "--poses", "p.csv", "--free", "x,y"];
    let printed = run(dir.path(), &args);
    assert!(
        printed.contains("1 of the jammed is crossed: a layer rests on one that is not its partner"),
        "{printed}"
    );
    let rows: Vec<&str> = printed.lines().filter(|line| line.starts_with("0.3,")).collect();
    assert!(
        printed.contains(",final_yaw,final_height,contacts,reason\n")
            && rows[1].contains("jammed")
            && rows[1].ends_with(",crossed")
    );
    assert!(rows[0].contains("aligned") && rows[0].ends_with(','), "{printed}");
    assert!(rows[2].contains("missed") && rows[2].ends_with(','), "{printed}");
    let report = json(dir.path(), &[&args[..], &["--json"]].concat());
    assert_eq!(report["poses"][1]["reason"], "crossed");
    assert!(report["poses"][0].get("reason").is_none());
    let traced = run(dir.path(), &["trace", &layers, "--free", "x,y", "--pose", "x=0.3,y=0.3"]);
    assert!(traced.contains("outcome        jammed (crossed)"), "{traced}");
    // A design without depth has no such column.
    let flat = run(dir.path(), &["outcome", &design("x-face.toml"), "--poses", "p.csv"]);
    assert!(!flat.contains("reason"), "{flat}");
}
