//! From raw files to tolerances: parts of a modular grid, rebuilt from its published dimensions, and parts drawn at 45°.
//!
//! ```text
//!   ╲                     ╱    the foot of the cup, half widths 17.8, 18.6 (0.8 up), 18.6 (2.6), 20.75 mm (4.75)
//!    │  foot             │
//!   ╲_╲_________________╱_╱    the socket, half widths 18.15, 18.85 (0.7 up), 18.85 (2.5), 21 mm (4.65)
//! ```
//!
//! The single-axis limit of x is 21 − 17.8 = 3.2 mm: there the flat underside of the foot meets the rim.

use crate::prisms::Unbroken;
use crate::{designs, json, run};
use std::fmt::Write;
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

/// With x, y and yaw free: the limits of x, and a nonzero Sum.
#[test]
fn a_grid_cup_docks_within_its_closed_form() {
    let home = placed(&["--free=x,y,yaw"]);
    let result = json(home.path(), &["run", "d.toml", "--json"]);
    let limits = result["tolerances"].as_array().unwrap();
    let x = limits.iter().find(|one| one["axis"] == "x").unwrap();
    for side in ["minus", "plus"] {
        let limit = 41.5 * x[side].as_f64().unwrap();
        assert!((limit - 3.2).abs() < 0.16, "{x}");
    }
    let accepted = &result["acceptance"];
    let [lo, hi] = [0, 1].map(|k| accepted["sum_ci95"][k].as_f64().unwrap());
    assert!((lo..=hi).contains(&accepted["sum_grid"].as_f64().unwrap()) && lo > 0.0, "{accepted}");
    assert!(!result.to_string().contains("too coarse"), "{result}");
}

/// In the error box of five free errors, the region that docks with three is smaller than a cell: the program uses random poses and
/// advises how to resolve more.
#[test]
fn a_too_coarse_grid_is_replaced_by_random_poses() {
    let home = placed(&[]);
    let printed = run(home.path(), &["run", "d.toml", "--free=x,y,yaw", "--samples=400"]);
    assert!(printed.starts_with("exit 0"), "{printed}");
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("motion of 400 random poses"), "{printed}");
    assert!(printed.contains("end early in the error box"), "{printed}");
    assert!(!printed.contains("mated pose itself"), "{printed}");
}

/// A tapered hole of 10.6 to 12 mm in a block, and a tapered plug with a tip of 10 mm, both turned by 45° about x, the plug placed elsewhere and turned by 90° more.
/// The tip enters within (12 − 10)/2 = 1 mm, and at a rotation ψ as long as 5 (cos ψ + sin ψ) ≤ 6.
#[test]
fn parts_drawn_at_45_degrees_dock_within_their_closed_form() {
    const SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let obj = |rings: &[(f64, f64)], faces: &str, degrees: f64, [x, y, z]: [f64; 3]| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut text = String::new();
        for (half, height) in rings {
            for [u, v] in SIGNS.map(|signs| signs.map(|sign| sign * half)) {
                let place = [u + x, cos * v - sin * height + y, sin * v + cos * height + z];
                writeln!(text, "v {} {} {}", place[0], place[1], place[2]).unwrap();
            }
        }
        text + faces
    };
    // Rings of four corners each, from the outside in or from the tip up; the sides connect them.
    let sides = |from: usize, to: usize| -> String {
        let side = |k: usize| {
            let next = (k + 1) % 4;
            format!("f {} {} {} {}\n", from + k, from + next, to + next, to + k)
        };
        (0..4).map(side).collect()
    };
    let socket =
        ["f 4 3 2 1\n".to_owned(), sides(1, 5), sides(5, 13), sides(13, 9), "f 9 10 11 12\n".to_owned()];
    let plug = ["f 4 3 2 1\n".to_owned(), sides(1, 5), sides(5, 9), "f 9 10 11 12\n".to_owned()];
    let home = tempfile::tempdir().unwrap();
    let hole = [(20.0, -20.0), (20.0, 0.0), (5.3, -12.0), (6.0, 0.0)];
    let tip = [(5.0, -12.0), (5.7, 0.0), (5.7, 14.0)];
    fs::write(home.path().join("socket.obj"), obj(&hole, &socket.concat(), 45.0, [0.0; 3])).unwrap();
    fs::write(home.path().join("plug.obj"), obj(&tip, &plug.concat(), 135.0, [70.0, 20.0, -30.0])).unwrap();
    let printed =
        run(home.path(), &["place", "socket.obj", "plug.obj", "--unit=mm", "--free=x,y,yaw", "-o", "d.toml"]);
    assert!(
        printed.starts_with("exit 0")
            && printed.contains(
                "the fixed half's face looks along -y+z, the moving half's along +y+z, each in its file"
            ),
        "{printed}"
    );
    let result = json(home.path(), &["run", "d.toml", "--samples=200", "--json"]);
    let limit = |axis: &str| {
        let all = result["tolerances"].as_array().unwrap();
        all.iter().find(|one| one["axis"] == axis).unwrap()["plus"].as_f64().unwrap()
    };
    // D is 11.4 mm, twice the half width of the plug at the mouth of the hole.
    assert!((limit("x") * 11.4 - 1.0).abs() < 0.01, "{result}");
    assert!((limit("yaw").to_degrees() - 13.05).abs() < 0.1, "{result}");
}

/// Files in metres: the design and every result are in millimetres. The grid cup again, a thousandth as large in its files.
#[test]
fn files_in_metres_give_results_in_millimetres() {
    let home = tempfile::tempdir().unwrap();
    for (from, to) in [("grid-baseplate.stl", "plate.obj"), ("grid-cup.stl", "cup.obj")] {
        let bytes = fs::read(designs().join("meshes").join(from)).unwrap();
        let mut text = String::new();
        for triangle in bytes[84..].chunks_exact(50) {
            for corner in triangle[12..48].chunks_exact(12) {
                let number = |k: usize| f32::from_le_bytes(corner[4 * k..4 * k + 4].try_into().unwrap());
                let [x, y, z] = [0, 1, 2].map(|k| f64::from(number(k)) / 1000.0);
                writeln!(text, "v {x} {y} {z}").unwrap();
            }
            text.push_str("f -3 -2 -1\n");
        }
        fs::write(home.path().join(to), text).unwrap();
    }
    let place = ["place", "plate.obj", "cup.obj", "--unit=m", "--free=x,y,yaw", "-o", "d.toml"];
    let printed = run(home.path(), &place);
    assert!(printed.starts_with("exit 0") && printed.contains("width D 41.5 mm"), "{printed}");
    let design = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(design.contains("width = 41.5") && design.contains("unit = \"mm\""), "{design}");
    assert!(design.contains("unit = \"m\" # the file itself states no unit"), "{design}");
    let printout = run(home.path(), &["check", "d.toml"]);
    assert!(printout.contains("41.5 mm"), "{printout}");
}

/// Both halves in one file, as exported from an assembly: the body with the larger box is the fixed half, and the design selects each by its
/// number.
#[test]
fn one_file_may_hold_both_halves() {
    let home = tempfile::tempdir().unwrap();
    let [plate, cup] = ["grid-baseplate.stl", "grid-cup.stl"]
        .map(|name| fs::read(designs().join("meshes").join(name)).unwrap()[84..].to_vec());
    let count = u32::try_from((plate.len() + cup.len()) / 50).unwrap();
    let both = [vec![0; 80], count.to_le_bytes().to_vec(), plate, cup].concat();
    fs::write(home.path().join("both.stl"), both).unwrap();
    let printed =
        run(home.path(), &["place", "both.stl", "--unit=mm", "--free=x,y,yaw", "-o", "d.toml"]).unbroken();
    assert!(printed.starts_with("exit 0") && printed.contains("moving the smaller body"), "{printed}");
    assert!(printed.contains("at rest when mated") && !printed.contains("more than two"), "{printed}");
    let design = fs::read_to_string(home.path().join("d.toml")).unwrap();
    let halves: Vec<&str> = design.split("\n[connector.").collect();
    assert!(halves[1].contains("\nbody = 1\n") && halves[2].contains("\nbody = 2\n"), "{design}");
    // The baseplate is the smaller one: it approaches the cup as the cup approaches it.
    let two = ["place", "cup.stl", "plate.stl", "--unit=mm", "--free=x,y,yaw", "-o", "two.toml"];
    for (from, to) in [("grid-cup.stl", "cup.stl"), ("grid-baseplate.stl", "plate.stl")] {
        fs::copy(designs().join("meshes").join(from), home.path().join(to)).unwrap();
    }
    assert!(run(home.path(), &two).starts_with("exit 0"));
    fs::write(home.path().join("poses.csv"), "x_mm,yaw_deg\n1,0\n-2,3\n6,0\n").unwrap();
    let ends = |design: &str| run(home.path(), &["outcome", design, "--poses", "poses.csv"]);
    let of_two = ends("two.toml");
    assert!(of_two.starts_with("exit 0") && of_two.contains("aligned"), "{of_two}");
    assert_eq!(ends("d.toml"), of_two);
    // The file has no third body.
    let third = design.replace("body = 2", "body = 3");
    fs::write(home.path().join("third.toml"), third).unwrap();
    let refused = run(home.path(), &["check", "third.toml"]).unbroken();
    assert!(
        refused.starts_with("exit 4") && refused.contains("there is no body 3: the file holds 2"),
        "{refused}"
    );
}
