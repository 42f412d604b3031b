//! Parts of prisms, as OBJ files that the tests of `place` read.

use std::fmt::Write;
use std::fs;

/// An OBJ of prisms: their outlines, their extents along the extrusion axis, and the map of a corner to its
/// coordinates.
pub(crate) type Prism<'a> = (&'a [[f64; 2]], [f64; 2], fn([f64; 2], f64) -> [f64; 3]);

pub(crate) fn obj(prisms: &[Prism<'_>]) -> String {
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
pub(crate) fn deep([x, z]: [f64; 2], y: f64) -> [f64; 3] {
    [x, -y, z]
}

/// Drawn in the plane of x and y, extruded along z.
pub(crate) fn flat([x, y]: [f64; 2], z: f64) -> [f64; 3] {
    [x, y, z]
}

pub(crate) fn two_parts(fixed: &str, moving: &str) -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("fixed.obj"), fixed).unwrap();
    fs::write(home.path().join("moving.obj"), moving).unwrap();
    home
}

pub(crate) fn arc(radius: f64, from: f64, to: f64, count: u32) -> Vec<[f64; 2]> {
    let at = |k: u32| (from + (to - from) * f64::from(k) / f64::from(count)).to_radians();
    (0..=count).map(|k| [radius * at(k).cos(), radius * at(k).sin()]).collect()
}

/// A box by its extents along x and y, and along z.
pub(crate) fn rectangle([x0, x1]: [f64; 2], [y0, y1]: [f64; 2]) -> [[f64; 2]; 4] {
    [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
}

/// A plate of 30 mm with these rectangles on it, 6 mm high.
pub(crate) fn on_a_plate(raised: &[[[f64; 2]; 4]]) -> String {
    let plate = rectangle([-15.0, 15.0], [-15.0, 15.0]);
    let mut prisms: Vec<Prism<'_>> = vec![(&plate, [-5.0, 0.0], flat)];
    prisms.extend(raised.iter().map(|outline| (&outline[..], [0.0, 6.0], flat as fn([f64; 2], f64) -> _)));
    obj(&prisms)
}

/// The printed text without line breaks.
pub(crate) trait Unbroken {
    fn unbroken(self) -> String;
}

impl Unbroken for String {
    fn unbroken(self) -> String {
        self.replace("\n  │ ", " ").replace("\n        ", " ")
    }
}

/// Walls around a square hole, 6 mm high on a plate of 30 mm; the argument is the hole's half width.
pub(crate) fn socket(half: f64) -> [[[f64; 2]; 4]; 4] {
    [
        rectangle([-15.0, -half], [-15.0, 15.0]),
        rectangle([half, 15.0], [-15.0, 15.0]),
        rectangle([-half, half], [half, 15.0]),
        rectangle([-half, half], [-15.0, -half]),
    ]
}

/// A block of this half width between two heights, as drawn.
pub(crate) fn plug(half: f64, ends: [f64; 2]) -> String {
    obj(&[(&rectangle([-half, half], [-half, half]), ends, flat)])
}

/// An OBJ with every coordinate scaled by a factor.
pub(crate) fn scaled(text: &str, factor: f64) -> String {
    let line = |line: &str| match line.strip_prefix("v ") {
        Some(rest) => {
            let side = |word: &str| format!(" {:.9}", word.parse::<f64>().unwrap() * factor);
            format!("v{}\n", rest.split(' ').map(side).collect::<String>())
        }
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// Runs `place` on both parts of a folder of [`two_parts`].
pub(crate) const TWO: [&str; 6] = ["place", "fixed.obj", "moving.obj", "--unit=mm", "-o", "d.toml"];
