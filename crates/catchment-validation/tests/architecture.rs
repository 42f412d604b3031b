//! Imports run against the flow from printed numbers to their report: a room imports only from rooms before it.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use std::fs;
use std::path::{Path, PathBuf};

/// The rooms in the order of the data flow.
const ROOMS: [&str; 5] = ["published", "recipe", "tables", "study", "report"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

/// The rooms that a text imports through `crate::`, outside comments.
fn reached(text: &str) -> Vec<String> {
    let name = |rest: &str| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    code.flat_map(|line| line.split("crate::").skip(1)).map(name).collect()
}

#[test]
fn imports_run_against_the_flow() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    files.sort();
    let rank = |name: &str| ROOMS.iter().position(|room| *room == name);
    for file in files {
        let place = file.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/");
        let from = place.split('/').next().unwrap().trim_end_matches(".rs").to_owned();
        if from == "lib" {
            continue;
        }
        let own = rank(&from).unwrap_or_else(|| panic!("{place} belongs to no room"));
        for to in reached(&fs::read_to_string(&file).unwrap()) {
            assert!(rank(&to).is_some_and(|to| to <= own), "{place} imports {to}");
        }
    }
}
