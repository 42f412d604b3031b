//! `catchment place`: parts that do not dock, and defects of their files, each reported with its cause.

use crate::prisms::{
    Prism, TWO, Unbroken, flat, obj, on_a_plate, plug, rectangle, scaled, socket, two_parts,
};
use crate::{catchment, run};
use std::fs;

/// An L and its recess, one of them exported mirrored: no rotation makes them fit.
#[test]
fn a_mirrored_part_is_reported_as_one() {
    let l = [rectangle([-8.0, -2.0], [-10.0, 10.0]), rectangle([-2.0, 8.0], [-10.0, -4.0])];
    // The part faces up in its own file and has to be turned over about x to dock.
    let recess = [
        rectangle([-15.0, -9.0], [-15.0, 15.0]),
        rectangle([9.0, 15.0], [-15.0, 15.0]),
        rectangle([-9.0, 9.0], [11.0, 15.0]),
        rectangle([-9.0, 9.0], [-15.0, -11.0]),
        rectangle([-1.0, 9.0], [-11.0, 3.0]),
    ];
    let home = two_parts(&on_a_plate(&l), &on_a_plate(&recess));
    let parts = ["place", "fixed.obj", "moving.obj", "--unit=mm"];
    let printout = run(home.path(), &[&parts[..], &["-o", "d.toml"]].concat());
    assert!(printout.starts_with("exit 0") && !printout.contains("mirror"), "{printout}");
    // With tolerances of a few millimetres, the error box does not reach 30 mm.
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(
        text.contains("About four times the single-axis limits (") && text.contains("\nx = 0.18 # D"),
        "{text}"
    );
    let mirrored = recess.map(|outline| outline.map(|[x, y]| [-x, y])).map(|[a, b, c, d]| [d, c, b, a]);
    fs::write(home.path().join("moving.obj"), on_a_plate(&mirrored)).unwrap();
    let printout = run(home.path(), &[&parts[..], &["-o", "m.toml"]].concat()).replace("\n        ", " ");
    assert!(
        printout.starts_with("exit 5") && printout.contains("a mirror image of the moving part would dock"),
        "{printout}"
    );
    assert!(!home.path().join("m.toml").exists());
}

/// A web across a socket keeps its plug out: the message gives its place, its part and the lost depth.
#[test]
fn a_web_in_the_way_is_pointed_at() {
    let walls = [
        rectangle([-15.0, -11.0], [-15.0, 15.0]),
        rectangle([11.0, 15.0], [-15.0, 15.0]),
        rectangle([-11.0, 11.0], [11.0, 15.0]),
        rectangle([-11.0, 11.0], [-15.0, -11.0]),
    ];
    let web = rectangle([-11.0, 11.0], [-1.0, 1.0]);
    let plug = [rectangle([-10.0, 10.0], [-10.0, 10.0])];
    let home = two_parts(&on_a_plate(&[&walls[..], &[web]].concat()), &on_a_plate(&plug));
    let parts = ["place", "fixed.obj", "moving.obj", "--unit=mm"];
    let printout = run(home.path(), &[&parts[..], &["-o", "d.toml"]].concat()).replace("\n        ", " ");
    for words in
        ["something narrow of the fixed part is in the way", "6) mm of the fixed", "about 6 mm deeper"]
    {
        assert!(printout.starts_with("exit 5") && printout.contains(words), "{words}\n{printout}");
    }
    // A design written by hand gives the same message, on the moving half as well.
    for (fixed, moving, whose) in [("fixed", "moving", "fixed"), ("moving", "fixed", "moving")] {
        let half = |name: &str| format!("{{ mesh = \"{name}.obj\", unit = \"mm\" }}");
        let text = format!(
            "[connector]\nwidth = 22\nunit = \"mm\"\nfixed = {}\nmoving = {}\n[alignment]\nfree = [\"x\", \"y\", \"yaw\"]\n",
            half(fixed),
            half(moving)
        );
        fs::write(home.path().join("d.toml"), text).unwrap();
        let printout = run(home.path(), &["check", "d.toml"]).replace("\n        ", " ");
        let words = format!("something narrow of the {whose} part is in the way");
        assert!(
            printout.starts_with("exit 4")
                && printout.contains(&words)
                && printout.contains("deeper, into a seat"),
            "{printout}"
        );
    }
    // Without the web the plug docks.
    fs::write(home.path().join("fixed.obj"), on_a_plate(&walls)).unwrap();
    let printout = run(home.path(), &[&parts[..], &["-o", "e.toml"]].concat());
    assert!(printout.starts_with("exit 0") && !printout.contains("in the way"), "{printout}");
}

/// Parts that are drawn together and do not hold are refused with the cause; `place` does not search for
/// another pose.
#[test]
fn an_assembly_that_does_not_hold_is_refused_with_its_cause() {
    let ring = socket(10.2);
    let ring: Vec<Prism<'_>> =
        ring.iter().map(|wall| (&wall[..], [0.0, 6.0], flat as fn([f64; 2], f64) -> _)).collect();
    let cases = [
        (on_a_plate(&[]), plug(10.0, [0.0, 8.0]), &["flat: the parts meet", "--with-moving"][..]),
        (
            obj(&ring),
            plug(10.0, [-4.0, 16.0]),
            &["passes through: no stop", "--with-fixed", "--drawn facing"],
        ),
    ];
    for (fixed, moving, words) in cases {
        let home = two_parts(&fixed, &moving);
        let printout = run(home.path(), &TWO).unbroken();
        for words in words {
            assert!(printout.starts_with("exit 5") && printout.contains(words), "{words}\n{printout}");
        }
        assert!(!home.path().join("d.toml").exists());
    }
}

/// A lid exactly as large as its recess has no play, and the message names the lack of play. A tenth of a
/// millimetre of play is sufficient.
#[test]
fn a_lid_as_large_as_its_recess_is_reported() {
    let parts = [
        "place",
        "fixed.obj",
        "moving.obj",
        "--unit=mm",
        "--drawn=facing",
        "--facing-fixed=+z",
        "--facing-moving=-z",
    ];
    let home = two_parts(&on_a_plate(&socket(10.0)), &plug(10.000_01, [40.0, 60.0]));
    // The same holds when no facing is pinned; the message precedes every note about flat faces.
    for args in [&parts[..], &TWO[..]] {
        let printed = run(home.path(), args).unbroken();
        let cause = printed.split("no play: ").nth(1).unwrap_or_default();
        assert!(printed.starts_with("exit 5") && cause.contains("6 mm into the other"), "{printed}");
        assert!(
            !printed.contains("flat: ") || printed.find("no play: ") < printed.find("flat: "),
            "{printed}"
        );
    }
    let home = two_parts(&on_a_plate(&socket(10.1)), &plug(10.0, [40.0, 60.0]));
    let printout = run(home.path(), &parts);
    assert!(printout.starts_with("exit 0"), "{printout}");
}

/// Defects of the files that leave no seat: each is named, with advice.
#[test]
fn mistakes_in_the_files_are_named() {
    let refused = |fixed: &str, moving: &str, more: &[&str]| {
        let home = two_parts(fixed, moving);
        let printout = run(home.path(), &[&TWO[..], more].concat()).unbroken();
        assert!(printout.starts_with("exit 5"), "{printout}");
        printout
    };
    let plate = on_a_plate(&[]);
    // The same part twice, in a file and in its copy.
    let printout = refused(&plate, &plate, &[]);
    assert!(
        printout.contains("both files hold the same part: name the file of the other half"),
        "{printout}"
    );
    let home = two_parts(&plate, &plate);
    let printout = run(home.path(), &["place", "fixed.obj", "fixed.obj", "--unit=mm"]).unbroken();
    assert!(
        printout.starts_with("exit 5") && printout.contains("both halves are the same file"),
        "{printout}"
    );
    // Both halves in one file.
    let two = obj(&[
        (&rectangle([-15.0, 15.0], [-15.0, 15.0]), [-5.0, 0.0], flat),
        (&rectangle([-9.0, 9.0], [-9.0, 9.0]), [30.0, 40.0], flat),
    ]);
    let printout = refused(&two, &plug(7.0, [0.0, 8.0]), &["--drawn=facing"]);
    assert!(
        printout.contains("the file of the fixed half holds 2 separate bodies: if both halves are in it, give that file alone"),
        "{printout}"
    );
    // A single file must contain two bodies.
    let home = two_parts(&plug(7.0, [0.0, 8.0]), "");
    let printout = run(home.path(), &["place", "fixed.obj", "--unit=mm"]).unbroken();
    assert!(
        printout.starts_with("exit 4") && printout.contains("there is no body 2: the file holds 1"),
        "{printout}"
    );
}

/// Files in inches that are read as millimetres give parts of a few millimetres.
#[test]
fn parts_of_a_few_millimetres_may_be_in_inches() {
    let home = two_parts(
        &scaled(&on_a_plate(&socket(10.2)), 1.0 / 25.4),
        &scaled(&plug(10.0, [0.0, 20.0]), 1.0 / 25.4),
    );
    let printout = run(home.path(), &TWO).unbroken();
    assert!(printout.contains("is the file in inches? Then it is "), "{printout}");
}

/// Files in metres that are read as millimetres get one note, which names the metre.
#[test]
fn parts_of_a_few_hundredths_of_a_millimetre_may_be_in_metres() {
    let home = two_parts(&scaled(&on_a_plate(&socket(10.2)), 1e-3), &scaled(&plug(10.0, [0.0, 20.0]), 1e-3));
    let printout = run(home.path(), &TWO).unbroken();
    assert_eq!(printout.matches("Then it is ").count(), 1, "{printout}");
    assert!(printout.contains("in m? Then it is "), "{printout}");
}

/// Lengths of millimetre-sized parts are reported in mm even if their files are in metres.
#[test]
fn metres_are_reported_in_millimetres() {
    let home = two_parts(&scaled(&on_a_plate(&socket(10.2)), 1e-3), &scaled(&plug(10.0, [0.0, 20.0]), 1e-3));
    let printout = run(home.path(), &["place", "fixed.obj", "moving.obj", "--unit=m", "-o", "d.toml"]);
    assert!(
        printout.starts_with("exit 0")
            && printout.contains("6 mm deep along the approach, ±0.")
            && printout.contains(" mm of sideways play at half of that depth"),
        "{printout}"
    );
}

/// A defect that both files share is reported once.
#[test]
fn step_without_a_python_is_reported_once() {
    let home = tempfile::tempdir().unwrap();
    for name in ["a.step", "b.step"] {
        fs::write(
            home.path().join(name),
            "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n",
        )
        .unwrap();
    }
    let output = catchment(home.path())
        .args(["place", "a.step", "b.step"])
        .env("CATCHMENT_PYTHON", home.path().join("no-python"))
        .output()
        .unwrap();
    let printout = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{printout}");
    assert_eq!(printout.matches("CATCHMENT_PYTHON").count(), 1, "{printout}");
}
