//! Jam causes of docks with realistic shapes: the features that an engineer would name from the drawing.

use catchment::prelude::*;
use catchment::run::jams::{Jams, JamsSettings, Stability, run};
use std::path::Path;

fn jams(problem: &Problem, motions: usize) -> Jams {
    run(problem, &JamsSettings { motions: Some(motions), ..JamsSettings::default() }, &Exec::new()).unwrap()
}

/// The most frequent pair of contact features in the jams, the moving half's first, and its share of the jams.
fn foremost(found: &Jams) -> (String, f64) {
    let pair = &found.features[0];
    let names = format!("{} on {}", pair.moving.name, pair.fixed.name);
    (names, pair.count as f64 / found.jammed() as f64)
}

fn written(text: &str) -> Problem {
    Problem::of(catchment::design::read(text, Path::new("")).unwrap().design).unwrap()
}

/// A chamfered peg lands with its end on the plate beside the hole: the ground is level everywhere there.
#[test]
fn a_peg_stands_on_the_plate() {
    let text = "[connector]\nfamily = \"pin-hole\"\nwidth = 50.0\nunit = \"mm\"\npins = 1\ncircle_radius = 0\n\
                pin_radius = \"5 mm\"\nclearance = \"0.5 mm\"\nchamfer = \"3 mm\"\n[alignment]\n\
                free = [\"x\", \"y\", \"roll\", \"pitch\"]\n[errors]\nx = \"12 mm\"\ny = \"12 mm\"\nroll = \"20 deg\"\npitch = \"20 deg\"\n";
    let found = jams(&written(text), 200);
    let (names, share) = foremost(&found);
    assert_eq!(names, "top on top");
    assert!(share > 0.8, "{share}");
    assert_eq!(found.jams[0].examined.unwrap().stability, Stability::Level);
}

/// Three balls in three grooves: a ball that misses its groove lies on top of a block.
#[test]
fn a_ball_lies_on_a_block() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/kelvin-balls.toml");
    let problem = Problem::open(path).unwrap();
    let mut design = problem.design().clone();
    design.alignment.free = [Dof::X, Dof::Y].into_iter().collect();
    let problem = problem.with(design).unwrap();
    let found = jams(&problem, 80);
    let (names, share) = foremost(&found);
    assert_eq!(names, "rounded surface on top");
    assert!(share > 0.5, "{share}");
    // Parts are named by their number in the file: a block and a ball.
    let jam = found.jams.iter().find(|jam| jam.contacts[0].moving.name == "rounded surface").unwrap();
    let contact = &jam.contacts[0];
    assert!(contact.fixed.part.is_some_and(|part| (1..=3).contains(&part)), "{contact:?}");
    assert!(contact.moving.part.is_some_and(|part| (1..=3).contains(&part)), "{contact:?}");
    // The block's top is at z = 0 in the drawing; 1 mm is the drawing's smallest length.
    assert!(contact.fixed.drawn_d[2].abs() < 1e-6, "{contact:?}");
}

/// The plate of a tool changer with two pointed pins: in a jam their tips stand on the other plate.
#[test]
fn pointed_pins_stand_on_the_plate() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/pin-hole.toml");
    let problem = Problem::open(path).unwrap();
    let mut design = problem.design().clone();
    design.alignment.free = [Dof::X, Dof::Y, Dof::Yaw].into_iter().collect();
    let problem = problem.with(design).unwrap();
    let found = jams(&problem, 100);
    let named = |fixed: &str, moving: &str| {
        found.features.iter().any(|pair| pair.fixed.name == fixed && pair.moving.name == moving)
    };
    assert!(
        named("flat", "corner of slopes of 45°") || named("corner of slopes of 45°", "flat"),
        "{:#?}",
        found.features
    );
    assert!(found.jams.iter().all(|jam| jam.above_mated_d > 0.0));
}
