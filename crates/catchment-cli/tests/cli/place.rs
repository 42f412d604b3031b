//! `catchment place`: from two part files to a design and its tolerances.

use crate::prisms::{
    Prism, TWO, Unbroken, arc, deep, flat, obj, on_a_plate, plug, rectangle, socket, two_parts,
};
use crate::{catchment, designs, entries, run};
use std::fs;
use std::path::Path;

/// A folder with the two parts of the committed designs.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let meshes = designs().join("meshes");
    fs::create_dir(home.path().join("parts")).unwrap();
    for name in ["socket.stl", "plug.stl", "assembled-socket.obj", "assembled-plug.ply"] {
        fs::copy(meshes.join(name), home.path().join("parts").join(name)).unwrap();
    }
    home
}

const PARTS: [&str; 4] = ["place", "parts/socket.stl", "parts/plug.stl", "--unit=mm"];
/// How they lie, for tests that are not about finding it.
const FACING: [&str; 2] = ["--facing-fixed=+z", "--facing-moving=+z"];

/// The heights of the proposed design, from `outcome` on one list of errors.
fn outcomes(folder: &Path, design: &str) -> String {
    fs::write(folder.join("poses.csv"), "x_mm,y_mm,pitch_deg\n3,1,0\n-5,4,0\n0,0,8\n40,0,0\n").unwrap();
    let printed = run(folder, &["outcome", design, "--poses", "poses.csv"]);
    assert!(printed.starts_with("exit 0"), "{printed}");
    printed
}

#[test]
fn two_files_give_a_design_with_the_known_outcomes() {
    let home = home();
    let printed = run(home.path(), &[&PARTS[..], &["-o", "design.toml", "--figure", "pair.svg"]].concat());
    insta::assert_snapshot!("place_pyramid", printed);
    insta::assert_snapshot!(
        "place_pyramid_design",
        fs::read_to_string(home.path().join("design.toml")).unwrap()
    );
    assert!(fs::read_to_string(home.path().join("pair.svg")).unwrap().contains("plug on socket"));
    let checked = run(home.path(), &["check", "design.toml"]);
    assert!(checked.starts_with("exit 0") && checked.contains("width D           50 mm"), "{checked}");
    let answered = outcomes(home.path(), "design.toml");
    // The committed design with its centre of rotation at the face centre.
    fs::copy(designs().join("pyramid-stl.toml"), home.path().join("true.toml")).unwrap();
    let text = fs::read_to_string(home.path().join("true.toml")).unwrap();
    let text =
        text.replace("meshes/", "parts/").replace("center_of_rotation = 0.5", "center_of_rotation = 0.0");
    fs::write(home.path().join("true.toml"), text).unwrap();
    let words = |printed: &str| {
        printed
            .lines()
            .flat_map(|line| line.split(','))
            .filter(|word| ["aligned", "jammed", "missed", "undecided"].contains(word))
            .map(ToOwned::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(words(&answered), words(&outcomes(home.path(), "true.toml")));
    assert!(!words(&answered).is_empty(), "{answered}");
}

#[test]
fn an_assembly_is_recognised_and_paths_lead_from_the_design() {
    let home = home();
    fs::create_dir(home.path().join("designs")).unwrap();
    let parts = ["place", "parts/assembled-socket.obj", "parts/assembled-plug.ply", "--unit", "mm"];
    let printed = run(home.path(), &[&parts[..], &["-o", "designs/pair.toml"]].concat());
    insta::assert_snapshot!("place_assembly", printed);
    let text = fs::read_to_string(home.path().join("designs/pair.toml")).unwrap();
    assert!(text.contains("mesh = \"../parts/assembled-socket.obj\""), "{text}");
    assert!(text.contains("approach = \"+y\"") && text.contains("drawn = \"assembled\""), "{text}");
    assert!(run(home.path(), &["check", "designs/pair.toml"]).starts_with("exit 0"));
    // The same parts, each in a frame of its own.
    let apart = run(home.path(), &[&parts[..], &["--drawn", "facing"]].concat());
    assert!(apart.starts_with("exit 0") && apart.contains("facing = \"-y\""), "{apart}");
}

/// A play of 0.05 mm beside a width of 20 mm, without a chamfer: errors of 0.05 mm dock, and the error box is not 20 times as large.
#[test]
fn a_tight_fit_gets_an_error_box_of_its_size() {
    let home = two_parts(&on_a_plate(&socket(10.05)), &plug(10.0, [0.0, 12.0]));
    assert!(run(home.path(), &TWO).starts_with("exit 0"));
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(text.contains("About four times the single-axis limits ("), "{text}");
    let range =
        text.lines().find_map(|line| line.strip_prefix("x = ")?.strip_suffix(" # D")?.parse::<f64>().ok());
    let limit = 0.05 / 20.0;
    assert!(range.is_some_and(|range| range > 2.6 * limit && range <= 4.0 * limit), "{text}");
    // With 0.002 mm the limit is less than a quarter of the smallest range.
    assert!(!text.contains("smallest range"), "{text}");
    let home = two_parts(&on_a_plate(&socket(10.002)), &plug(10.0, [0.0, 12.0]));
    assert!(run(home.path(), &TWO).starts_with("exit 0"));
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(
        text.contains("# The smallest range that is proposed") && text.contains("\nx = 0.00098 # D"),
        "{text}"
    );
}

#[test]
fn a_design_is_replaced_only_with_force() {
    let home = home();
    fs::write(home.path().join("mine.toml"), "precious").unwrap();
    let again = |more: &[&str]| run(home.path(), &[&PARTS[..], &FACING, &["-o", "mine.toml"], more].concat());
    let refused = again(&[]);
    assert!(refused.starts_with("exit 2") && refused.contains("--force replaces it"), "{refused}");
    assert_eq!(fs::read(home.path().join("mine.toml")).unwrap(), b"precious");
    assert!(again(&["--force", "--name", "ours"]).starts_with("exit 0"));
    assert!(fs::read_to_string(home.path().join("mine.toml")).unwrap().contains("name = \"ours\""));
}

#[test]
fn parts_that_do_not_dock_are_reported_and_nothing_is_written() {
    let home = home();
    let parts = ["place", "parts/socket.stl", "parts/socket.stl", "--unit", "mm", "--facing-fixed=-z"];
    let output =
        catchment(home.path()).args(parts).args(["-o", "d.toml", "--figure", "d.png"]).output().unwrap();
    let printed = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(5), "{printed}");
    assert!(
        printed.contains("no docking direction along the axes was found")
            && printed.contains("--facing-moving"),
        "{printed}"
    );
    assert_eq!(entries(home.path()), ["parts"]);
}

const ASSEMBLED: [&str; 8] =
    ["place", "fixed.obj", "moving.obj", "--unit=mm", "--drawn=assembled", "--approach=-z", "-o", "d.toml"];

/// A bar laid level across a V of 54 degrees balances: it has no seat where it may tip, and `place` proposes none in
/// which it tips.
#[test]
fn a_bar_that_balances_is_not_proposed_to_tip() {
    let v = [[-40., 0.], [40., 0.], [40., 60.], [30., 60.], [0., 2.], [-30., 60.], [-40., 60.]];
    let z = 2.0 + 25.0 * 58.0 / 30.0;
    let bar = [[-25.0, z], [25.0, z], [25.0, z + 3.0], [-25.0, z + 3.0]];
    let home = two_parts(&obj(&[(&v, [-10.0, 10.0], deep)]), &obj(&[(&bar, [-5.0, 5.0], deep)]));
    let printed = run(home.path(), &[&ASSEMBLED[..], &["--free", "x,pitch"]].concat());
    assert!(
        printed.starts_with("exit 5") && printed.contains("does not hold") && printed.contains(" mm deeper"),
        "{printed}"
    );
    assert_eq!(entries(home.path()), ["fixed.obj", "moving.obj"]);
    let printed = run(home.path(), &ASSEMBLED);
    if printed.starts_with("exit 0") {
        let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
        assert!(text.contains("\nfree = [\"x\"") && !text.contains("\"pitch\""), "{text}");
        assert!(run(home.path(), &["check", "d.toml"]).starts_with("exit 0"));
    }
}

/// Two keys between two walls can turn by 48 degrees either way but not all round: their yaw is locked and matters.
#[test]
fn a_yaw_with_much_play_matters_where_the_seat_is_not_round() {
    let wall = |from: f64| [arc(16.0, from, from + 60.0, 6), arc(10.3, from + 60.0, from, 6)].concat();
    let plate = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]];
    let fixed: [Prism<'_>; 3] =
        [(&plate, [-5.0, 1.0], flat), (&wall(60.0), [0.0, 10.0], flat), (&wall(240.0), [0.0, 10.0], flat)];
    let keys = [
        arc(10.0, 12.0, 168.0, 13),
        arc(14.0, 170.0, 190.0, 2),
        arc(10.0, 192.0, 348.0, 13),
        arc(14.0, -10.0, 10.0, 2),
    ]
    .concat();
    let home = two_parts(&obj(&fixed), &obj(&[(&keys, [1.0, 12.0], flat)]));
    let printed = run(home.path(), &ASSEMBLED);
    assert!(printed.starts_with("exit 0"), "{printed}");
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(text.contains("\nfree = [\"x\", \"y\", ") && !text.contains("yaw"), "{text}");
    assert!(text.contains("all others are locked at 0."), "{text}");
    // A disc without keys seats at the same depth at every yaw.
    fs::write(home.path().join("moving.obj"), obj(&[(&arc(10.0, 0.0, 350.0, 35), [1.0, 12.0], flat)]))
        .unwrap();
    let printed = run(home.path(), &[&ASSEMBLED[..], &["--force"]].concat());
    assert!(printed.starts_with("exit 0"), "{printed}");
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(text.contains("dont_care = [\"yaw\"]") && text.contains("seated at any angle"), "{text}");
}

/// A wedge drawn turned by 2.5 degrees in its groove: the report on settling gives the angle and advises a
/// check.
#[test]
fn the_settling_angle_is_reported() {
    let groove = [[-40., 0.], [40., 0.], [40., 36.], [30., 32.], [0., 2.], [-30., 32.], [-40., 36.]];
    let turn = |[x, z]: [f64; 2]| {
        let (sin, cos) = 2.5f64.to_radians().sin_cos();
        [cos * x - sin * (z - 2.0), 2.0 + sin * x + cos * (z - 2.0)]
    };
    let wedge = [[0., 2.], [25., 27.], [25., 30.], [-25., 30.], [-25., 27.]].map(turn);
    let home = two_parts(&obj(&[(&groove, [-10.0, 10.0], deep)]), &obj(&[(&wedge, [-10.0, 10.0], deep)]));
    let printed = run(home.path(), &ASSEMBLED);
    assert!(printed.starts_with("exit 0") && printed.contains("settles 2.5 deg"), "{printed}");
    assert!(printed.contains("note: the drawn pose is not a rest"), "{printed}");
}

/// An input file is never overwritten, whichever option names it.
#[test]
fn input_files_of_a_half_are_never_overwritten() {
    let home = home();
    let ball = "parts/assembled-plug.ply";
    let bytes = fs::read(home.path().join(ball)).unwrap();
    for with in ["--with-fixed", "--with-moving"] {
        let printed = run(home.path(), &[&PARTS[..], &[with, ball, "-o", ball, "--force"]].concat());
        assert!(printed.starts_with("exit 2") && printed.contains("assembled-plug.ply"), "{printed}");
    }
    assert_eq!(fs::read(home.path().join(ball)).unwrap(), bytes);
    let printed = run(home.path(), &[&PARTS[..], &["--with-moving", "parts/none.stl"]].concat());
    assert!(printed.contains("there is no file parts/none.stl") && printed.contains("help: "), "{printed}");
}

/// A file with more triangles than the limit of a half is placed with fewer, and the design records the
/// reduction.
#[test]
fn files_are_placed_with_fewer_triangles() {
    let home = home();
    let printed =
        run(home.path(), &[&PARTS[..], &FACING, &["-o", "d.toml", "--simplify", "0.02 mm"]].concat());
    assert!(printed.starts_with("exit 0"), "{printed}");
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert_eq!(text.matches("\nsimplify = \"0.02 mm\"").count(), 2, "{text}");
    assert!(run(home.path(), &["check", "d.toml"]).starts_with("exit 0"));
    for (wrong, words) in
        [("0.1 D", "D is not known yet"), ("0", "no distance"), ("3 deg", "3 deg"), ("x", "x")]
    {
        let printed = run(home.path(), &[&PARTS[..], &["-o", "e.toml", "--simplify", wrong]].concat());
        assert!(
            printed.starts_with("exit 2") && printed.contains("--simplify") && printed.contains(words),
            "{printed}"
        );
    }
    // For too many triangles the message names the command-line option, not a key of a design that the user
    // did not write.
    let mut many = vec![0; 84 + 50 * 200_001];
    many[80..84].copy_from_slice(&200_001u32.to_le_bytes());
    fs::write(home.path().join("many.stl"), many).unwrap();
    let printed = run(home.path(), &["place", "many.stl", "parts/plug.stl", "--unit=mm"]);
    assert!(
        printed.starts_with("exit 4")
            && printed.contains("--simplify")
            && !printed.contains("beside the file"),
        "{printed}"
    );
    let printed =
        run(home.path(), &[&PARTS[..], &["--simplify=0.1 mm", "--with-fixed", "parts/plug.stl"]].concat());
    assert!(printed.starts_with("exit 2") && printed.contains("--with-fixed"), "{printed}");
}

/// A part drawn on its axis but above its seat slides along the approach; a few millimetres cause no
/// diagnostic, more do.
#[test]
fn parts_drawn_apart_slide_to_first_contact() {
    let fixed = on_a_plate(&socket(10.2));
    for (apart, doubt) in [(0.0, false), (3.8, false), (5.5, false)] {
        let home = two_parts(&fixed, &plug(10.0, [apart, 20.0 + apart]));
        let printed = run(home.path(), &TWO).unbroken();
        assert!(printed.starts_with("exit 0") && printed.contains("in doubt") == doubt, "{apart}\n{printed}");
        let off = format!("docked as drawn, approach -z, but for {apart} mm along it");
        assert_eq!(printed.contains(&off), apart > 0.0, "{apart}\n{printed}");
        let checked = run(home.path(), &["check", "d.toml"]);
        assert!(checked.starts_with("exit 0"), "{checked}");
    }
}

/// A plug of half width 10 mm drawn 0.5 mm off the axis of its hole, 0.3 mm into the wall: it docks in the middle of its play.
#[test]
fn the_distance_from_the_drawn_pose_is_reported() {
    let plug = obj(&[(&rectangle([-9.5, 10.5], [-10.0, 10.0]), [0.0, 20.0], flat)]);
    let home = two_parts(&on_a_plate(&socket(10.2)), &plug);
    let printed = run(home.path(), &TWO).unbroken();
    assert!(printed.contains("docked as drawn, approach -z, but for 0.5 mm across it; sits"), "{printed}");
}

/// The message on a blocked approach gives the overlap in the unit of the parts.
#[test]
fn a_blocked_approach_is_reported_in_millimetres() {
    let home = home();
    let parts = ["place", "parts/assembled-socket.obj", "parts/assembled-plug.ply", "--unit", "mm"];
    let printed =
        run(home.path(), &[&parts[..], &["--drawn=assembled", "--approach=+x"]].concat()).unbroken();
    assert!(
        printed.starts_with("exit 5") && printed.contains("blocked: ") && printed.contains(" mm above"),
        "{printed}"
    );
}
