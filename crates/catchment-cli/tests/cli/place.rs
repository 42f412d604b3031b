//! `catchment place`: from two files to a design, to what it forgives.

use crate::{catchment, designs, entries, run};
use std::fmt::Write;
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

/// The heights of the proposed design, from the outcomes of one list of errors.
fn outcomes(folder: &Path, design: &str) -> String {
    fs::write(folder.join("poses.csv"), "x_mm,y_mm,pitch_deg\n3,1,0\n-5,4,0\n0,0,8\n40,0,0\n").unwrap();
    let told = run(folder, &["outcome", design, "--poses", "poses.csv"]);
    assert!(told.starts_with("exit 0"), "{told}");
    told
}

#[test]
fn two_files_become_a_design_that_answers() {
    let home = home();
    let told = run(home.path(), &[&PARTS[..], &["-o", "design.toml", "--figure", "pair.svg"]].concat());
    insta::assert_snapshot!("place_pyramid", told);
    insta::assert_snapshot!(
        "place_pyramid_design",
        fs::read_to_string(home.path().join("design.toml")).unwrap()
    );
    assert!(fs::read_to_string(home.path().join("pair.svg")).unwrap().contains("plug on socket"));
    let checked = run(home.path(), &["check", "design.toml"]);
    assert!(checked.starts_with("exit 0") && checked.contains("width D             50 mm"), "{checked}");
    let answered = outcomes(home.path(), "design.toml");
    // The committed design with its centre of rotation in the face centre.
    fs::copy(designs().join("pyramid-stl.toml"), home.path().join("true.toml")).unwrap();
    let text = fs::read_to_string(home.path().join("true.toml")).unwrap();
    let text =
        text.replace("meshes/", "parts/").replace("center_of_rotation = 0.5", "center_of_rotation = 0.0");
    fs::write(home.path().join("true.toml"), text).unwrap();
    let words = |told: &str| {
        told.lines()
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
    let told = run(home.path(), &[&parts[..], &["-o", "designs/pair.toml"]].concat());
    insta::assert_snapshot!("place_assembly", told);
    let text = fs::read_to_string(home.path().join("designs/pair.toml")).unwrap();
    assert!(text.contains("mesh = \"../parts/assembled-socket.obj\""), "{text}");
    assert!(text.contains("approach = \"+y\"") && text.contains("drawn = \"assembled\""), "{text}");
    assert!(run(home.path(), &["check", "designs/pair.toml"]).starts_with("exit 0"));
    // The same parts, as if each were in a frame of its own.
    let apart = run(home.path(), &[&parts[..], &["--drawn", "facing"]].concat());
    assert!(apart.starts_with("exit 0") && apart.contains("facing = \"-y\""), "{apart}");
}

#[test]
fn a_design_is_replaced_only_when_asked() {
    let home = home();
    fs::write(home.path().join("mine.toml"), "precious").unwrap();
    let again = |more: &[&str]| run(home.path(), &[&PARTS[..], &["-o", "mine.toml"], more].concat());
    let refused = again(&[]);
    assert!(refused.starts_with("exit 2") && refused.contains("--force replaces it"), "{refused}");
    assert_eq!(fs::read(home.path().join("mine.toml")).unwrap(), b"precious");
    assert!(again(&["--force", "--name", "ours"]).starts_with("exit 0"));
    assert!(fs::read_to_string(home.path().join("mine.toml")).unwrap().contains("name = \"ours\""));
}

#[test]
fn parts_that_do_not_dock_are_told_and_nothing_is_written() {
    let home = home();
    let parts = ["place", "parts/socket.stl", "parts/socket.stl", "--unit", "mm", "--facing-fixed=-z"];
    let output =
        catchment(home.path()).args(parts).args(["-o", "d.toml", "--figure", "d.png"]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("the parts dock in no direction") && told.contains("--facing-moving"), "{told}");
    assert_eq!(entries(home.path()), ["parts"]);
}

/// An OBJ of prisms: their outlines, from where to where they reach, and where a corner is put.
type Prism<'a> = (&'a [[f64; 2]], [f64; 2], fn([f64; 2], f64) -> [f64; 3]);

fn obj(prisms: &[Prism<'_>]) -> String {
    let (mut corners, mut faces, mut first) = (String::new(), String::new(), 1);
    for (outline, ends, put) in prisms {
        for corner in ends.iter().flat_map(|end| outline.iter().map(|p| put(*p, *end))) {
            let _ = writeln!(corners, "v {:.9} {:.9} {:.9}", corner[0], corner[1], corner[2]);
        }
        let count = outline.len();
        let mut face = |list: Vec<usize>| {
            let list: Vec<String> = list.iter().map(|k| (first + k).to_string()).collect();
            let _ = writeln!(faces, "f {}", list.join(" "));
        };
        face((0..count).rev().collect());
        face((count..2 * count).collect());
        for (k, next) in (0..count).map(|k| (k, (k + 1) % count)) {
            face(vec![k, next, count + next, count + k]);
        }
        first += 2 * count;
    }
    corners + &faces
}

/// Drawn in the plane of x and z, extruded along −y.
fn deep([x, z]: [f64; 2], y: f64) -> [f64; 3] {
    [x, -y, z]
}

/// Drawn in the plane of x and y, extruded along z.
fn flat([x, y]: [f64; 2], z: f64) -> [f64; 3] {
    [x, y, z]
}

fn two_parts(fixed: &str, moving: &str) -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("fixed.obj"), fixed).unwrap();
    fs::write(home.path().join("moving.obj"), moving).unwrap();
    home
}

const ASSEMBLED: [&str; 8] =
    ["place", "fixed.obj", "moving.obj", "--unit=mm", "--drawn=assembled", "--approach=-z", "-o", "d.toml"];

/// A bar laid level across a V of 54 degrees balances: no seat where it may tip, and none is proposed in which it does.
#[test]
fn a_bar_that_balances_is_not_proposed_to_tip() {
    let v = [[-40., 0.], [40., 0.], [40., 60.], [30., 60.], [0., 2.], [-30., 60.], [-40., 60.]];
    let z = 2.0 + 25.0 * 58.0 / 30.0;
    let bar = [[-25.0, z], [25.0, z], [25.0, z + 3.0], [-25.0, z + 3.0]];
    let home = two_parts(&obj(&[(&v, [-10.0, 10.0], deep)]), &obj(&[(&bar, [-5.0, 5.0], deep)]));
    let told = run(home.path(), &[&ASSEMBLED[..], &["--free", "x,pitch"]].concat());
    assert!(
        told.starts_with("exit 2") && told.contains("does not hold") && told.contains(" mm deeper"),
        "{told}"
    );
    assert_eq!(entries(home.path()), ["fixed.obj", "moving.obj"]);
    let told = run(home.path(), &ASSEMBLED);
    if told.starts_with("exit 0") {
        let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
        assert!(text.contains("\nfree = [\"x\"") && !text.contains("\"pitch\""), "{text}");
        assert!(run(home.path(), &["check", "d.toml"]).starts_with("exit 0"));
    }
}

fn arc(radius: f64, from: f64, to: f64, count: u32) -> Vec<[f64; 2]> {
    let at = |k: u32| (from + (to - from) * f64::from(k) / f64::from(count)).to_radians();
    (0..=count).map(|k| [radius * at(k).cos(), radius * at(k).sin()]).collect()
}

/// Two keys between two walls turn by 48 degrees either way, and not all round: their yaw is locked, and does matter.
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
    let told = run(home.path(), &ASSEMBLED);
    assert!(told.starts_with("exit 0"), "{told}");
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(text.contains("\nfree = [\"x\", \"y\", ") && !text.contains("yaw"), "{text}");
    assert!(text.contains("The others are locked."), "{text}");
    // A disc without keys lies as deep all round.
    fs::write(home.path().join("moving.obj"), obj(&[(&arc(10.0, 0.0, 350.0, 35), [1.0, 12.0], flat)]))
        .unwrap();
    let told = run(home.path(), &[&ASSEMBLED[..], &["--force"]].concat());
    assert!(told.starts_with("exit 0"), "{told}");
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(text.contains("dont_care = [\"yaw\"]") && text.contains("as deep all round"), "{text}");
}

/// A wedge that was drawn turned by 2.5 degrees in its groove: what settles says how far, and to look.
#[test]
fn what_settles_says_how_far() {
    let groove = [[-40., 0.], [40., 0.], [40., 36.], [30., 32.], [0., 2.], [-30., 32.], [-40., 36.]];
    let turn = |[x, z]: [f64; 2]| {
        let (sin, cos) = 2.5f64.to_radians().sin_cos();
        [cos * x - sin * (z - 2.0), 2.0 + sin * x + cos * (z - 2.0)]
    };
    let wedge = [[0., 2.], [25., 27.], [25., 30.], [-25., 30.], [-25., 27.]].map(turn);
    let home = two_parts(&obj(&[(&groove, [-10.0, 10.0], deep)]), &obj(&[(&wedge, [-10.0, 10.0], deep)]));
    let told = run(home.path(), &ASSEMBLED);
    assert!(told.starts_with("exit 0") && told.contains("settles, 2.5 deg"), "{told}");
    assert!(told.contains("note: as drawn the parts do not hold"), "{told}");
}

/// Ways of approach that are blocked say by how much in the unit of the parts.
#[test]
fn a_blocked_approach_is_told_in_millimetres() {
    let home = home();
    let parts = ["place", "parts/assembled-socket.obj", "parts/assembled-plug.ply", "--unit", "mm"];
    let told = run(home.path(), &[&parts[..], &["--drawn=assembled", "--approach=+x"]].concat());
    assert!(told.starts_with("exit 2") && told.contains("blocked: ") && told.contains(" mm above"), "{told}");
}

/// What is read is not written over, by whatever option it was named.
#[test]
fn what_belongs_to_a_half_is_not_written_over() {
    let home = home();
    let ball = "parts/assembled-plug.ply";
    let bytes = fs::read(home.path().join(ball)).unwrap();
    for with in ["--with-fixed", "--with-moving"] {
        let told = run(home.path(), &[&PARTS[..], &[with, ball, "-o", ball, "--force"]].concat());
        assert!(told.starts_with("exit 2") && told.contains("assembled-plug.ply"), "{told}");
    }
    assert_eq!(fs::read(home.path().join(ball)).unwrap(), bytes);
    let told = run(home.path(), &[&PARTS[..], &["--with-moving", "parts/none.stl"]].concat());
    assert!(told.contains("there is no file parts/none.stl") && told.contains("help: "), "{told}");
}

/// A box from where to where along x and y, z.
fn rectangle([x0, x1]: [f64; 2], [y0, y1]: [f64; 2]) -> [[f64; 2]; 4] {
    [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
}

/// A plate of 30 mm with these rectangles on it, 6 mm high.
fn on_a_plate(raised: &[[[f64; 2]; 4]]) -> String {
    let plate = rectangle([-15.0, 15.0], [-15.0, 15.0]);
    let mut prisms: Vec<Prism<'_>> = vec![(&plate, [-5.0, 0.0], flat)];
    prisms.extend(raised.iter().map(|outline| (&outline[..], [0.0, 6.0], flat as fn([f64; 2], f64) -> _)));
    obj(&prisms)
}

/// An L and its recess, one of them exported mirrored: no turn brings them together.
#[test]
fn a_mirrored_part_is_told_as_one() {
    let l = [rectangle([-8.0, -2.0], [-10.0, 10.0]), rectangle([-2.0, 8.0], [-10.0, -4.0])];
    // Faces up in its own file, so that it is turned over about x to dock.
    let recess = [
        rectangle([-15.0, -9.0], [-15.0, 15.0]),
        rectangle([9.0, 15.0], [-15.0, 15.0]),
        rectangle([-9.0, 9.0], [11.0, 15.0]),
        rectangle([-9.0, 9.0], [-15.0, -11.0]),
        rectangle([-1.0, 9.0], [-11.0, 3.0]),
    ];
    let home = two_parts(&on_a_plate(&l), &on_a_plate(&recess));
    let parts = ["place", "fixed.obj", "moving.obj", "--unit=mm"];
    let told = run(home.path(), &[&parts[..], &["-o", "d.toml"]].concat());
    assert!(told.starts_with("exit 0") && !told.contains("mirror"), "{told}");
    // Where it tolerates a few millimetres, the error box does not reach to 30.
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert!(
        text.contains("About four times what each error alone tolerates.") && text.contains("\nx = 0.18 # D"),
        "{text}"
    );
    let mirrored = recess.map(|outline| outline.map(|[x, y]| [-x, y])).map(|[a, b, c, d]| [d, c, b, a]);
    fs::write(home.path().join("moving.obj"), on_a_plate(&mirrored)).unwrap();
    let told = run(home.path(), &[&parts[..], &["-o", "m.toml"]].concat()).replace("\n        ", " ");
    assert!(
        told.starts_with("exit 2") && told.contains("a mirror image of the moving part would dock"),
        "{told}"
    );
    assert!(!home.path().join("m.toml").exists());
}

/// A web across a socket keeps its plug out: where it is, on which part, and what it costs.
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
    let told = run(home.path(), &[&parts[..], &["-o", "d.toml"]].concat()).replace("\n        ", " ");
    for words in
        ["something narrow of the fixed part is in the way", "6) mm of the fixed", "about 6 mm deeper"]
    {
        assert!(told.starts_with("exit 2") && told.contains(words), "{words}\n{told}");
    }
    // A design that somebody wrote says the same, on the moving half as well.
    for (fixed, moving, whose) in [("fixed", "moving", "fixed"), ("moving", "fixed", "moving")] {
        let half = |name: &str| format!("{{ mesh = \"{name}.obj\", unit = \"mm\" }}");
        let text = format!(
            "[connector]\nwidth = 22\nunit = \"mm\"\nfixed = {}\nmoving = {}\n[alignment]\nfree = [\"x\", \"y\", \"yaw\"]\n",
            half(fixed),
            half(moving)
        );
        fs::write(home.path().join("d.toml"), text).unwrap();
        let told = run(home.path(), &["check", "d.toml"]).replace("\n        ", " ");
        let words = format!("something narrow of the {whose} part is in the way");
        assert!(
            told.starts_with("exit 2") && told.contains(&words) && told.contains("deeper, into a seat"),
            "{told}"
        );
    }
    // Without the web it docks.
    fs::write(home.path().join("fixed.obj"), on_a_plate(&walls)).unwrap();
    let told = run(home.path(), &[&parts[..], &["-o", "e.toml"]].concat());
    assert!(told.starts_with("exit 0") && !told.contains("in the way"), "{told}");
}

/// Files of more triangles than a half may have are placed with fewer, which the design says.
#[test]
fn files_are_placed_with_fewer_triangles() {
    let home = home();
    let told = run(home.path(), &[&PARTS[..], &["-o", "d.toml", "--simplify", "0.02 mm"]].concat());
    assert!(told.starts_with("exit 0"), "{told}");
    let text = fs::read_to_string(home.path().join("d.toml")).unwrap();
    assert_eq!(text.matches("\nsimplify = \"0.02 mm\"").count(), 2, "{text}");
    assert!(run(home.path(), &["check", "d.toml"]).starts_with("exit 0"));
    for (wrong, words) in
        [("0.1 D", "D is not known yet"), ("0", "no distance"), ("3 deg", "3 deg"), ("x", "x")]
    {
        let told = run(home.path(), &[&PARTS[..], &["-o", "e.toml", "--simplify", wrong]].concat());
        assert!(told.starts_with("exit 2") && told.contains("--simplify") && told.contains(words), "{told}");
    }
    // Too many: the option is named, and not a key of a design that nobody wrote.
    let mut many = vec![0; 84 + 50 * 200_001];
    many[80..84].copy_from_slice(&200_001u32.to_le_bytes());
    fs::write(home.path().join("many.stl"), many).unwrap();
    let told = run(home.path(), &["place", "many.stl", "parts/plug.stl", "--unit=mm"]);
    assert!(
        told.starts_with("exit 2") && told.contains("--simplify") && !told.contains("beside the file"),
        "{told}"
    );
    let told =
        run(home.path(), &[&PARTS[..], &["--simplify=0.1 mm", "--with-fixed", "parts/plug.stl"]].concat());
    assert!(told.starts_with("exit 2") && told.contains("--with-fixed"), "{told}");
}

/// What was printed, without the breaks of its lines.
trait Unbroken {
    fn unbroken(self) -> String;
}

impl Unbroken for String {
    fn unbroken(self) -> String {
        self.replace("\n  │ ", " ").replace("\n        ", " ")
    }
}

/// Walls around a square hole, 6 mm high on a plate of 30 mm; its inner half width.
fn socket(half: f64) -> [[[f64; 2]; 4]; 4] {
    [
        rectangle([-15.0, -half], [-15.0, 15.0]),
        rectangle([half, 15.0], [-15.0, 15.0]),
        rectangle([-half, half], [half, 15.0]),
        rectangle([-half, half], [-15.0, -half]),
    ]
}

/// A block of this half width between two heights, as drawn.
fn plug(half: f64, ends: [f64; 2]) -> String {
    obj(&[(&rectangle([-half, half], [-half, half]), ends, flat)])
}

/// An OBJ with every coordinate times a factor.
fn scaled(text: &str, factor: f64) -> String {
    let line = |line: &str| match line.strip_prefix("v ") {
        Some(rest) => {
            let side = |word: &str| format!(" {:.9}", word.parse::<f64>().unwrap() * factor);
            format!("v{}\n", rest.split(' ').map(side).collect::<String>())
        }
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

const TWO: [&str; 6] = ["place", "fixed.obj", "moving.obj", "--unit=mm", "-o", "d.toml"];

/// What is drawn on its axis but not sunk slides along the approach; a few millimetres are no doubt, more are.
#[test]
fn what_is_drawn_apart_slides_to_first_contact() {
    let fixed = on_a_plate(&socket(10.2));
    for (apart, doubt) in [(0.0, false), (3.8, false), (5.5, false)] {
        let home = two_parts(&fixed, &plug(10.0, [apart, 20.0 + apart]));
        let told = run(home.path(), &TWO);
        assert!(told.starts_with("exit 0") && told.contains("in doubt") == doubt, "{apart}\n{told}");
        let checked = run(home.path(), &["check", "d.toml"]);
        assert!(checked.starts_with("exit 0"), "{checked}");
    }
}

/// Parts that are drawn together and do not hold are refused with the cause, not put somewhere else.
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
        let told = run(home.path(), &TWO).unbroken();
        for words in words {
            assert!(told.starts_with("exit 2") && told.contains(words), "{words}\n{told}");
        }
        assert!(!home.path().join("d.toml").exists());
    }
}

/// A lid exactly as large as its recess has no play: so much is said. A tenth of a millimetre lets it in.
#[test]
fn a_lid_as_large_as_its_recess_is_told() {
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
    let told = run(home.path(), &parts).unbroken();
    assert!(
        told.starts_with("exit 2") && told.contains("no play: ") && told.contains("6 mm into the other"),
        "{told}"
    );
    let home = two_parts(&on_a_plate(&socket(10.1)), &plug(10.0, [40.0, 60.0]));
    let told = run(home.path(), &parts);
    assert!(told.starts_with("exit 0"), "{told}");
}

/// Mistakes in the files that leave no seat: each is named, with what to do.
#[test]
fn mistakes_in_the_files_are_named() {
    let refused = |fixed: &str, moving: &str, more: &[&str]| {
        let home = two_parts(fixed, moving);
        let told = run(home.path(), &[&TWO[..], more].concat()).unbroken();
        assert!(told.starts_with("exit 2"), "{told}");
        told
    };
    let plate = on_a_plate(&[]);
    // The same part twice, in a file and in a copy of it.
    let told = refused(&plate, &plate, &[]);
    assert!(told.contains("both files hold the same part: name the file of the other half"), "{told}");
    let home = two_parts(&plate, &plate);
    let told = run(home.path(), &["place", "fixed.obj", "fixed.obj", "--unit=mm"]).unbroken();
    assert!(told.starts_with("exit 2") && told.contains("both halves are the same file"), "{told}");
    // Both halves in one file.
    let two = obj(&[
        (&rectangle([-15.0, 15.0], [-15.0, 15.0]), [-5.0, 0.0], flat),
        (&rectangle([-9.0, 9.0], [-9.0, 9.0]), [30.0, 40.0], flat),
    ]);
    let told = refused(&two, &plug(7.0, [0.0, 8.0]), &["--drawn=facing"]);
    assert!(
        told.contains("the file of the fixed half holds 2 separate bodies") && told.contains("Split"),
        "{told}"
    );
}

/// Inches that are read as millimetres make parts of a few millimetres.
#[test]
fn parts_of_a_few_millimetres_may_be_in_inches() {
    let home = two_parts(
        &scaled(&on_a_plate(&socket(10.2)), 1.0 / 25.4),
        &scaled(&plug(10.0, [0.0, 20.0]), 1.0 / 25.4),
    );
    let told = run(home.path(), &TWO).unbroken();
    assert!(told.contains("is the file in inches? Then it is "), "{told}");
}

/// Lengths of parts of millimetres are told in mm where their files are in metres.
#[test]
fn metres_are_told_in_millimetres() {
    let home = two_parts(&scaled(&on_a_plate(&socket(10.2)), 1e-3), &scaled(&plug(10.0, [0.0, 20.0]), 1e-3));
    let told = run(home.path(), &["place", "fixed.obj", "moving.obj", "--unit=m", "-o", "d.toml"]);
    assert!(
        told.starts_with("exit 0")
            && told.contains("6 mm deep, play 0.")
            && told.contains(" mm to each side"),
        "{told}"
    );
}

/// What is wrong with both files alike is said once.
#[test]
fn step_without_a_python_is_told_once() {
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
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert_eq!(told.matches("CATCHMENT_PYTHON").count(), 1, "{told}");
}
