//! Every command refuses bad geometry with one clear message; good meshes give the numbers of the family.

use super::{catchment, designs, run};
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

const DESIGN: &str = "[connector]\nwidth = 50\nunit = \"mm\"\nface_height = 12.5\n\
                      fixed = { mesh = \"socket.stl\", unit = \"mm\" }\n\
                      moving = { mesh = \"plug.stl\", unit = \"mm\" }\n";

/// A folder with the committed pyramid pair; `spoil` changes one of its files.
fn folder(spoil: impl Fn(&Path)) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("design.toml"), DESIGN).unwrap();
    for half in ["socket.stl", "plug.stl"] {
        fs::copy(designs().join("meshes").join(half), dir.path().join(half)).unwrap();
    }
    spoil(dir.path());
    dir
}

/// The committed plug as a binary STL with modified bytes.
fn plug(change: impl Fn(&mut Vec<u8>)) -> impl Fn(&Path) {
    move |dir| {
        let path = dir.join("plug.stl");
        let mut bytes = fs::read(&path).unwrap();
        change(&mut bytes);
        fs::write(path, bytes).unwrap();
    }
}

/// Byte lengths in a binary file: the header before the first triangle, and each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Asserts that `check` and the computing commands refuse the folder with the message `printout`, once, and leave
/// no files behind.
fn refused(name: &str, spoil: impl Fn(&Path), printout: &str) {
    let dir = folder(spoil);
    fs::write(dir.path().join("poses.csv"), "x\n0.1\n").unwrap();
    let commands: [&[&str]; 5] = [
        &["check", "design.toml"],
        &["run", "design.toml", "-o", "out"],
        &["zraa", "design.toml", "-o", "out.svg"],
        &["outcome", "design.toml", "--poses", "poses.csv", "-o", "out.csv"],
        &["trace", "design.toml", "--pose", "x=0.1", "-o", "out.png"],
    ];
    let reports = commands.map(|args| run(dir.path(), args));
    for report in &reports {
        assert_eq!(*report, reports[0], "{name}");
        // The program breaks long lines between words.
        let words = report.split_whitespace().filter(|w| *w != "│").collect::<Vec<_>>().join(" ");
        assert!(report.starts_with("exit 4\n--- stdout\n--- stderr\n"), "{name}: {report}");
        assert_eq!(words.matches(printout).count(), 1, "{name}: {words}");
        assert_eq!(words.matches('×').count(), 1, "{name}: more than one message: {report}");
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 4, "{name}");
}

#[test]
fn an_open_mesh() {
    // Without its last triangle the mesh has three open edges: one hole, one message.
    let open = |bytes: &mut Vec<u8>| {
        bytes.truncate(bytes.len() - TRIANGLE);
        bytes[80] -= 1;
    };
    refused("open", plug(open), "plug.stl: the mesh is open along the edge of");
}

#[test]
fn a_vertex_that_is_no_number() {
    let nan = |bytes: &mut Vec<u8>| bytes[HEADER + 12..HEADER + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    refused("nan", plug(nan), "has a corner that is not finite");
}

#[test]
fn a_mesh_in_the_wrong_unit() {
    let metres = |bytes: &mut Vec<u8>| {
        for triangle in bytes[HEADER..].chunks_exact_mut(TRIANGLE) {
            for value in triangle[12..48].chunks_exact_mut(4) {
                let drawn = f32::from_le_bytes(value.try_into().unwrap());
                value.copy_from_slice(&(drawn / 1000.0).to_le_bytes());
            }
        }
    };
    refused("metres", plug(metres), "check the mesh's unit and the design's width");
}

#[test]
fn a_file_that_was_cut_off() {
    refused("cut off", plug(|bytes| bytes.truncate(bytes.len() - 70)), "it was cut off; export it again");
    refused("empty", plug(Vec::clear), "the file is empty");
}

#[test]
fn three_million_triangles_are_refused_unread() {
    const COUNT: u32 = 3_000_000;
    let huge = |dir: &Path| {
        let mut file = File::create(dir.join("plug.stl")).unwrap();
        file.write_all(&[b' '; 80]).unwrap();
        file.write_all(&COUNT.to_le_bytes()).unwrap();
        file.set_len((HEADER + TRIANGLE * COUNT as usize) as u64).unwrap();
    };
    refused("huge", huge, "3000000 triangles, more than the 200000 that a half may have");
}

/// Final errors of 50 poses spread over the error box.
fn finals(folder: &Path, design: &Path) -> Vec<(String, Vec<f64>)> {
    let spread = |k: u32, step: f64, half: f64| ((f64::from(k) * step).fract() * 2.0 - 1.0) * half;
    let mut poses = "x,y,roll,pitch,yaw\n".to_owned();
    for k in 1..=50 {
        let row = [(0.834_5, 0.5), (0.696_4, 0.5), (0.581_1, 0.7), (0.484_9, 0.7), (0.404_7, 0.7)];
        let cells = row.map(|(step, half)| format!("{:.6}", spread(k, step, half)));
        poses += &(cells.join(",") + "\n");
    }
    fs::write(folder.join("poses.csv"), poses).unwrap();
    let output = catchment(folder)
        .args(["outcome", design.to_str().unwrap(), "--poses", "poses.csv"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    csv::Reader::from_reader(&output.stdout[..])
        .records()
        .map(|record| {
            let record = record.unwrap();
            (record[5].to_owned(), record.iter().skip(6).take(5).map(|cell| cell.parse().unwrap()).collect())
        })
        .collect()
}

#[test]
fn meshes_and_pieces_give_the_familys_outcomes() {
    let dir = tempfile::tempdir().unwrap();
    let family = finals(dir.path(), &designs().join("pyramid.toml"));
    assert_eq!(family.len(), 50);
    assert!(family.iter().any(|f| f.0 == "aligned") && family.iter().any(|f| f.0 != "aligned"));
    let mesh = finals(dir.path(), &designs().join("pyramid-stl.toml"));
    for (k, (a, b)) in family.iter().zip(&mesh).enumerate() {
        assert_eq!(a.0, b.0, "pose {k}");
        for (x, y) in a.1.iter().zip(&b.1) {
            assert!((x - y).abs() < 1e-6, "pose {k}: {a:?} {b:?}");
        }
    }
    // The pieces have corners where they meet, so the motion takes different steps and stops elsewhere within its
    // tolerance.
    let pieces = finals(dir.path(), &designs().join("pyramid-pieces.toml"));
    for (k, (a, b)) in family.iter().zip(&pieces).enumerate() {
        assert_eq!(a.0, b.0, "pose {k}");
    }
}

/// A flipped triangle, a duplicate and a degenerate one: every defect that can be repaired without moving a
/// vertex.
fn spoil(bytes: &mut Vec<u8>) {
    let at = |k: usize| HEADER + TRIANGLE * k;
    let doubled = bytes[at(1)..at(2)].to_vec();
    let mut flat = bytes[at(0)..at(1)].to_vec();
    flat.copy_within(12..24, 24);
    for k in 0..12 {
        bytes.swap(at(2) + 12 + k, at(2) + 24 + k);
    }
    bytes.extend(doubled);
    bytes.extend(flat);
    bytes[80] += 2;
}

#[test]
fn a_spoilt_mesh_is_repaired_and_reported() {
    let (sound, spoilt) = (folder(|_| ()), folder(plug(spoil)));
    let done = "1 triangle without area removed, 1 duplicate triangle removed, 1 triangle flipped; its shape is unchanged";
    let printout = run(spoilt.path(), &["check", "design.toml"]);
    let words: Vec<&str> = printout.split_whitespace().collect();
    assert!(printout.starts_with("exit 0") && words.join(" ").contains(done), "{printout}");
    assert!(!run(sound.path(), &["check", "design.toml"]).contains("removed"));
    let json = run(spoilt.path(), &["check", "design.toml", "--json"]);
    let json: String = json.split_whitespace().collect();
    assert!(
        json.contains(r#""repairs":{"without_area":1,"doubled":1,"turned":1,"deviation":0.0}"#),
        "{json}"
    );
    assert_eq!(
        finals(sound.path(), Path::new("design.toml")),
        finals(spoilt.path(), Path::new("design.toml"))
    );
    let quick = ["run", "design.toml", "--free", "x,y", "--resolution", "5", "-v"];
    let words = run(spoilt.path(), &quick).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains(&format!("moving half {done}")), "{words}");
    // Without repair the file is refused.
    fs::write(
        spoilt.path().join("design.toml"),
        DESIGN.replace("plug.stl\",", "plug.stl\", repair = false,"),
    )
    .unwrap();
    let printout = run(spoilt.path(), &["check", "design.toml"]);
    assert!(
        printout.starts_with("exit 4") && printout.contains("has no area") && printout.contains(" mm"),
        "{printout}"
    );
}

#[test]
fn mesh_simplification_is_reported() {
    let dir = folder(|_| ());
    let design = DESIGN.replace("plug.stl\",", "plug.stl\", simplify = \"0.01 mm\",");
    fs::write(dir.path().join("design.toml"), design).unwrap();
    let printout = run(dir.path(), &["check", "design.toml"]);
    assert!(printout.starts_with("exit 0") && printout.contains("triangles simplified to"), "{printout}");
}
