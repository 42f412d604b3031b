//! `catchment invert`: a design's own moving half comes back, and what it writes runs.

use crate::{designs, home, json, run};
use std::fs;

const PYRAMID: &str = "[connector]\nfamily = \"pyramid\"\nwidth = 40.0\nunit = \"mm\"\naspect_ratio = 0.5\n[alignment]\nfree = [\"x\", \"y\"]\n";

#[test]
fn a_pyramid_comes_back_and_accepts_what_it_accepted() {
    let home = home();
    fs::write(home.path().join("p.toml"), PYRAMID).unwrap();
    let told = run(home.path(), &["invert", "p.toml", "-o", "q.toml"]);
    assert!(told.starts_with("exit 0\n") && told.contains("reached everywhere"), "{told}");
    assert!(told.contains("100.00 % of the plan"), "{told}");
    let area = |design: &str| json(home.path(), &["zraa", design, "--json"])["area_d2"].as_f64().unwrap();
    assert!((area("p.toml") - area("q.toml")).abs() < 1e-8, "{} {}", area("p.toml"), area("q.toml"));
    let ran = run(home.path(), &["run", "q.toml", "--method", "flood", "--resolution", "12", "--quiet"]);
    assert!(ran.starts_with("exit 0\n"), "{ran}");
    let again = run(home.path(), &["invert", "p.toml", "-o", "q.toml"]);
    assert!(again.starts_with("exit 2\n") && again.contains("--force replaces it"), "{again}");
}

#[test]
fn what_cannot_be_reached_is_said_with_its_place() {
    let home = home();
    fs::write(home.path().join("p.toml"), PYRAMID).unwrap();
    fs::copy(designs().join("systems/wanted-bowl.csv"), home.path().join("w.csv")).unwrap();
    let found = json(home.path(), &["invert", "p.toml", "--heights", "w.csv", "-o", "q.toml", "--json"]);
    assert_eq!(found["kind"], "invert");
    let most = found["most_unattained_d"].as_f64().unwrap();
    assert_eq!(found["attained"], most == 0.0);
    // A bowl of slope 0.6 in a socket of slope 1: away from the middle the sides of the socket carry more than is wanted.
    assert!(most > 0.01 && !found["unattained"][0]["polygon"].as_array().unwrap().is_empty(), "{most}");
    let ran = run(home.path(), &["check", "q.toml"]);
    assert!(ran.starts_with("exit "), "{ran}");
}
