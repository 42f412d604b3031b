//! `catchment invert`: it recovers a design's own moving half, and the design it writes runs.

use crate::{designs, home, json, run};
use std::fmt::Write;
use std::fs;

const PYRAMID: &str = "[connector]\nfamily = \"pyramid\"\nwidth = 40.0\nunit = \"mm\"\naspect_ratio = 0.5\n[alignment]\nfree = [\"x\", \"y\"]\n";

#[test]
fn an_inverted_pyramid_keeps_its_area_of_acceptance() {
    let home = home();
    fs::write(home.path().join("p.toml"), PYRAMID).unwrap();
    let printed = run(home.path(), &["invert", "p.toml", "-o", "q.toml"]);
    assert!(printed.starts_with("exit 0\n") && printed.contains("reached everywhere"), "{printed}");
    assert!(printed.contains("100.00 % of the plan"), "{printed}");
    let area = |design: &str| json(home.path(), &["zraa", design, "--json"])["area_d2"].as_f64().unwrap();
    assert!((area("p.toml") - area("q.toml")).abs() < 1e-8, "{} {}", area("p.toml"), area("q.toml"));
    let ran = run(home.path(), &["run", "q.toml", "--method", "flood", "--resolution", "12", "--quiet"]);
    assert!(ran.starts_with("exit 0\n"), "{ran}");
    let again = run(home.path(), &["invert", "p.toml", "-o", "q.toml"]);
    assert!(again.starts_with("exit 2\n") && again.contains("--force replaces it"), "{again}");
}

#[test]
fn unattained_heights_are_reported_with_their_polygon() {
    let home = home();
    fs::write(home.path().join("p.toml"), PYRAMID).unwrap();
    fs::copy(designs().join("systems/wanted-bowl.csv"), home.path().join("w.csv")).unwrap();
    let result = json(home.path(), &["invert", "p.toml", "--heights", "w.csv", "-o", "q.toml", "--json"]);
    assert_eq!(result["kind"], "invert");
    let most = result["most_unattained_d"].as_f64().unwrap();
    assert_eq!(result["attained"], most == 0.0);
    // A bowl of slope 0.6 in a socket of slope 1: away from the middle the sides of the socket support more than the
    // target.
    assert!(most > 0.01 && !result["unattained"][0]["polygon"].as_array().unwrap().is_empty(), "{most}");
    let ran = run(home.path(), &["check", "q.toml"]);
    assert!(ran.starts_with("exit "), "{ran}");
}

/// A rounded nose as exported by a CAD program: turned about z by an angle that no grid contains, and every coordinate truncated to a
/// ten-thousandth of a millimetre. One plane becomes many, and upright walls lean.
fn nose() -> String {
    const TURN: f64 = 0.3;
    let arc = |k: u32| -1.1 + 2.2 * f64::from(k) / 6.0;
    let mut profile = vec![[20.0 * arc(0).sin(), -25.0], [20.0 * arc(6).sin(), -25.0]];
    profile.extend((0..=6).rev().map(|k| [20.0 * arc(k).sin(), 20.0 * arc(k).cos() - 20.0]));
    let along = [-15.0, -4.3, 3.1, 15.0];
    let corner = |[x, z]: [f64; 2], y: f64| {
        let (sin, cos) = f64::sin_cos(TURN);
        format!("vertex {:.4} {:.4} {z:.4}", cos * x - sin * y, sin * x + cos * y)
    };
    let mut text = "solid nose\n".to_owned();
    let mut facet = |corners: [String; 3]| {
        write!(text, "facet normal 0 0 0\nouter loop\n{}\nendloop\nendfacet\n", corners.join("\n")).unwrap();
    };
    let n = profile.len();
    for (k, &a) in profile.iter().enumerate() {
        let b = profile[(k + 1) % n];
        for y in along.windows(2) {
            facet([corner(a, y[0]), corner(b, y[1]), corner(b, y[0])]);
            facet([corner(a, y[0]), corner(a, y[1]), corner(b, y[1])]);
        }
    }
    for k in 1..n - 1 {
        let [front, back] = [along[0], along[3]].map(|y| [0, k, k + 1].map(|j| corner(profile[j], y)));
        facet(front);
        let [a, b, c] = back;
        facet([a, c, b]);
    }
    text + "endsolid nose\n"
}

#[test]
fn a_foreign_mesh_gives_a_half_that_the_program_takes() {
    let home = home();
    fs::write(home.path().join("nose.stl"), nose()).unwrap();
    let side = |s: f64| {
        let (near, far) = (s * 20.0, 0.0);
        let corners = [[near, -20.0], [near, 4.1624], [far, -20.0], [far, -2.3376]];
        let corners: Vec<String> =
            corners.iter().flat_map(|[x, z]| [-20, 20].map(|y| format!("[{x}, {y}, {z}]"))).collect();
        format!("[{}]", corners.join(", "))
    };
    let design = format!(
        "[connector]\nwidth = 40\nunit = \"mm\"\nface_height = 0\nfixed.pieces = [{}, {}]\n\
         moving = {{ mesh = \"nose.stl\", unit = \"mm\" }}\n\
         [alignment]\nfree = [\"x\", \"pitch\"]\nmount = \"y\"\n[errors]\nx = \"10 mm\"\npitch = \"10 deg\"\n",
        side(-1.0),
        side(1.0)
    );
    fs::write(home.path().join("d.toml"), design).unwrap();
    let printed = json(home.path(), &["invert", "d.toml", "-o", "new.toml", "--json"]);
    assert_eq!(printed["attained"], true, "{printed}");
    assert!(printed["narrowest_d"].as_f64().unwrap() > 1e-6, "{}", printed["narrowest_d"]);
    let checked = run(home.path(), &["check", "new.toml"]);
    assert!(checked.starts_with("exit 0\n"), "{checked}");
    let ran = run(home.path(), &["run", "new.toml", "--method", "flood", "--resolution", "8", "--quiet"]);
    assert!(ran.starts_with("exit 0\n"), "{ran}");
    let zraa = |design: &str| json(home.path(), &["zraa", design, "--json"])["length_d"].as_f64().unwrap();
    assert!((zraa("d.toml") - zraa("new.toml")).abs() < 1e-8, "{} {}", zraa("d.toml"), zraa("new.toml"));
}

#[test]
fn pitch_and_yaw_accept_ranges_and_lists() {
    let home = home();
    fs::write(home.path().join("p.toml"), PYRAMID).unwrap();
    fs::copy(designs().join("systems/wanted-bowl.csv"), home.path().join("w.csv")).unwrap();
    let requested =
        ["invert", "p.toml", "--heights", "w.csv", "--pitch", "-10..10 deg/3", "--yaw", "0,20 deg", "--json"];
    let result = json(home.path(), &requested);
    assert_eq!(
        (result["turns"].as_u64(), result["settings"]["pitch"].as_array().unwrap().len()),
        (Some(5), 3)
    );
    let between = &result["between"];
    // Half of 10° and half of 20°.
    assert!((between["turn_rad"].as_f64().unwrap() - 15f64.to_radians()).abs() < 1e-9, "{between}");
    assert_eq!(between["midway"], 2);
    let printed = run(home.path(), &["invert", "p.toml", "--pitch", "-10..10 deg/3"]);
    assert!(printed.contains("pitch -10.00°, 0°, 10.00°: 2 rotations"), "{printed}");
    assert!(printed.contains("nowhere higher than wanted at 2 rotations midway"), "{printed}");
    // Each place is reported once.
    let places: Vec<&serde_json::Value> =
        result["unattained"].as_array().unwrap().iter().map(|short| &short["at"]).collect();
    for (k, place) in places.iter().enumerate() {
        assert!(!places[..k].contains(place), "{place} is printed twice");
    }
}
