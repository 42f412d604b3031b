//! Rooms stand side by side: none of them knows another, and the library knows none of them.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use std::fs;
use std::path::{Path, PathBuf};

/// Every file of Rust code below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let (mut result, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                result.push(path);
            }
        }
    }
    result
}

#[test]
fn modules_do_not_import_each_other() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let tour = fs::read_to_string(src.join("lib.rs")).unwrap();
    let rooms: Vec<&str> =
        tour.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    assert!(rooms.len() > 5 && rooms.contains(&"form"), "{rooms:?}");
    let mut looked = 0;
    for room in rooms.iter().filter(|room| **room != "form") {
        for file in files(&src.join(room)) {
            let text = fs::read_to_string(&file).unwrap();
            for other in rooms.iter().filter(|other| **other != "form" && *other != room) {
                assert!(!text.contains(&format!("crate::{other}::")), "{} knows {other}", file.display());
            }
            looked += 1;
        }
    }
    assert!(looked > 40, "{looked} files");
}

#[test]
fn library_crates_do_not_depend_on_systems() {
    for name in ["", "-base", "-design", "-connector", "-core", "-study", "-proposal", "-report"] {
        let name = format!("catchment{name}");
        let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(&name);
        let manifest = fs::read_to_string(library.join("Cargo.toml")).unwrap();
        assert!(!manifest.contains("catchment-systems"), "{name}");
    }
}
