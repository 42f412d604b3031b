//! `catchment compose`: closed forms through the real binary.

use crate::{catchment, designs, entries, home, json, run};
use std::fs;

/// An L of two bars, and a square of half its width.
const CORNER: &str = "x,y\n0,0\n2,0\n2,1\n1,1\n1,2\n0,2\n";
const SQUARE: &str = "x,y\n0,0\n0.5,0\n0.5,0.5\n0,0.5\n";

#[test]
fn closed_forms_come_out_of_the_program() {
    let home = home();
    let put = |name: &str, text: &str| fs::write(home.path().join(name), text).unwrap();
    put("corner.csv", CORNER);
    put("square.csv", SQUARE);
    put("ring.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M0 0h3v3h-3zM1 1h1v1h-1z\"/></svg>");
    let area = |args: &[&str]| json(home.path(), args)["acceptance"]["area"].clone();
    assert_eq!(area(&["compose", "corner.csv", "square.csv", "--json"]), serde_json::json!([5.25, 5.25]));
    let result = json(home.path(), &["compose", "ring.svg", "square.csv", "--json", "--frames", "world"]);
    assert_eq!(result["acceptance"]["area"], serde_json::json!([12.0, 12.0]));
    assert_eq!((&result["acceptance"]["holes"], &result["kind"]), (&1.into(), &"compose".into()));
    // Parts in their own frames need no reflection: the result is the sum of the two as drawn.
    let own = json(home.path(), &["compose", "corner.csv", "square.csv", "--json"]);
    assert_eq!(own["acceptance"]["bounds"], serde_json::json!([[0.0, 0.0], [2.5, 2.5]]));
    let world = json(home.path(), &["compose", "corner.csv", "square.csv", "--json", "--frames", "world"]);
    assert_eq!(world["acceptance"]["bounds"], serde_json::json!([[-0.5, -0.5], [2.0, 2.0]]));
}

/// Two discs of 50 mm: their overlap is largest at a single offset that is not a grid point, and they meet up to 100
/// mm.
#[test]
fn the_bounds_of_two_discs_enclose_the_exact_values() {
    let home = home();
    fs::write(home.path().join("disc.toml"), "[sweep]\nshape = \"disc\"\nradius = 50\n").unwrap();
    let result = json(home.path(), &["compose", "disc.toml", "disc.toml", "--json"]);
    let number = |pointer: &str| result.pointer(pointer).and_then(serde_json::Value::as_f64).unwrap();
    let exact = std::f64::consts::PI * 2500.0;
    let [least, most] = ["/overlap/largest", "/overlap/at_most"].map(number);
    assert!(least <= exact && exact <= most && most - least < 2e-3 * exact, "{least} {exact} {most}");
    for (axis, corner) in [("x", 0), ("y", 1)] {
        for (end, sign) in [(0, -1.0), (1, 1.0)] {
            let at = |name: &str| sign * number(&format!("/acceptance/{name}/{end}/{corner}"));
            let (inner, outer) = (at("bounds"), at("bounds_outer"));
            assert!(
                inner <= 100.0 && outer >= 100.0 - 1e-6 && outer - inner < 0.05,
                "{axis}: {inner} {outer}"
            );
        }
    }
    let printed = run(home.path(), &["compose", "disc.toml", "disc.toml"]);
    assert!(
        printed.contains("overlap         largest 78") && !printed.contains("overlap         at most"),
        "{printed}"
    );
}

#[test]
fn hook_and_loop_are_reported_drawn_and_read_again() {
    let home = home();
    for name in ["hook.toml", "loop.toml", "boat.toml"] {
        fs::copy(designs().join("systems").join(name), home.path().join(name)).unwrap();
    }
    let both = ["compose", "hook.toml", "loop.toml", "--keep-out", "boat.toml,boat.toml"];
    let printed = run(home.path(), &both);
    assert!(
        printed.starts_with("exit 0\n") && printed.contains("hook and loop: approach region"),
        "{printed}"
    );
    assert!(
        printed.contains("largest square") && printed.lines().all(|l| l.chars().count() <= 80),
        "{printed}"
    );
    let with = |more: &[&'static str]| -> Vec<&'static str> { [&both[..], more].concat() };
    let result = json(home.path(), &with(&["--heading", "-20..20 deg", "--headings", "5", "--json"]));
    assert_eq!(result["slices"].as_array().unwrap().len(), 5);
    assert_eq!(result["heading_rad"], 0.0);
    assert!(result["volume"][0].as_f64().unwrap() > 0.0);
    for (name, outline) in [("a.png", false), ("b.csv", true), ("b.svg", true)] {
        let mut args = with(&["-o", name]);
        if outline {
            args.push("--outline");
        }
        assert!(run(home.path(), &args).starts_with("exit 0\n"), "{name}");
        assert!(run(home.path(), &args).contains("--force replaces it"), "{name}");
    }
    let alone = json(home.path(), &with(&["--json"]));
    fs::write(home.path().join("dot.csv"), "x,y\n0,0\n0.001,0\n0,0.001\n").unwrap();
    for name in ["b.csv", "b.svg"] {
        let again = json(home.path(), &["compose", name, "dot.csv", "--json"]);
        let [first, area] =
            [&again["halves"][0], &alone["acceptance"]].map(|region| region["area"][0].as_f64().unwrap());
        assert!((first - area).abs() < 1e-3, "{name}: {first} {area}");
    }
}

#[test]
fn two_connectors_add_up() {
    let home = home();
    let p = "[connector]\nfamily = \"pyramid\"\nwidth = 40.0\nunit = \"mm\"\n[alignment]\nfree = [\"x\", \"y\"]\n";
    fs::write(home.path().join("p.toml"), p).unwrap();
    let alone = json(home.path(), &["zraa", "p.toml", "--json"]);
    let area = alone["area_d2"].as_f64().unwrap() * 1600.0;
    let both = json(home.path(), &["compose", "p.toml", "p.toml", "--json"]);
    // A convex region composed with itself has four times its area.
    let sum = both["acceptance"]["area"][0].as_f64().unwrap();
    assert!((sum - 4.0 * area).abs() < 1e-5, "{sum} {area}");
    // A square of side 1 D and a diamond of half diagonal 1 D: 1 + 2 + 2·(1 + 1).
    for name in ["pyramid.toml", "x-face-3d.toml"] {
        fs::copy(designs().join(name), home.path().join(name)).unwrap();
    }
    let result = json(home.path(), &["compose", "pyramid.toml", "x-face-3d.toml", "--json"]);
    let sum = result["acceptance"]["area"][0].as_f64().unwrap();
    assert!((sum - 7.0).abs() < 1e-7 && result["unit"] == "D", "{sum}");
}

#[test]
fn a_refused_composition_writes_no_files() {
    let home = home();
    fs::write(home.path().join("bow.csv"), "x,y\n0,0\n2,2\n2,0\n0,2\n").unwrap();
    let before = entries(home.path());
    let output =
        catchment(home.path()).args(["compose", "bow.csv", "bow.csv", "-o", "a.svg"]).output().unwrap();
    assert_eq!(output.status.code(), Some(4));
    assert!(output.stdout.is_empty());
    assert_eq!(entries(home.path()), before);
}
