//! Two parts of a modular grid, rebuilt from its published dimensions: from raw STL files to the errors that they forgive.
//!
//! ```text
//!   ╲                     ╱    the foot of the cup, half widths 17.8, 18.6 (0.8 up), 18.6 (2.6), 20.75 mm (4.75)
//!    │  foot             │
//!   ╲_╲_________________╱_╱    the socket, half widths 18.15, 18.85 (0.7 up), 18.85 (2.5), 21 mm (4.65)
//! ```
//!
//! Alone, x may be off by 21 − 17.8 = 3.2 mm: then the flat underside of the foot meets the rim.

use crate::{designs, json, run};
use std::fs;

/// A folder with both parts, and the design that `place` writes for them.
fn placed(more: &[&str]) -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    for name in ["grid-baseplate.stl", "grid-cup.stl"] {
        fs::copy(designs().join("meshes").join(name), home.path().join(name)).unwrap();
    }
    let place = ["place", "grid-baseplate.stl", "grid-cup.stl", "--unit=mm", "-o", "d.toml"];
    let printed = run(home.path(), &[&place[..], more].concat());
    assert!(printed.starts_with("exit 0") && !printed.contains("in doubt"), "{printed}");
    assert!(printed.contains("docked as drawn, approach -z"), "{printed}");
    home
}

/// With x, y and yaw free: the limits of x, and a Sum that is none of zero.
#[test]
fn a_grid_cup_docks_within_its_closed_form() {
    let home = placed(&["--free=x,y,yaw"]);
    let found = json(home.path(), &["run", "d.toml", "--json"]);
    let limits = found["tolerances"].as_array().unwrap();
    let x = limits.iter().find(|one| one["axis"] == "x").unwrap();
    for side in ["minus", "plus"] {
        let limit = 41.5 * x[side].as_f64().unwrap();
        assert!((limit - 3.2).abs() < 0.16, "{x}");
    }
    let accepted = &found["acceptance"];
    let [lo, hi] = [0, 1].map(|k| accepted["sum_ci95"][k].as_f64().unwrap());
    assert!((lo..=hi).contains(&accepted["sum_grid"].as_f64().unwrap()) && lo > 0.0, "{accepted}");
    assert!(!found.to_string().contains("too coarse"), "{found}");
}

/// In the error box of five free errors what docks with three is smaller than a cell: random poses answer, and it is said how to see more.
#[test]
fn a_grid_that_sees_nothing_is_not_taken() {
    let home = placed(&[]);
    let printed = run(home.path(), &["run", "d.toml", "--free=x,y,yaw", "--samples=400"]);
    assert!(printed.starts_with("exit 0"), "{printed}");
    assert!(printed.contains("descent, 400 poses"), "{printed}");
    assert!(printed.contains("end early in the error box"), "{printed}");
    assert!(!printed.contains("mated pose itself"), "{printed}");
}
