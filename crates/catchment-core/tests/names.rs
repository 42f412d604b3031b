//! One thing, one word: no two public types of the workspace share a name, and files are named by what they hold.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Names that say how something came about, or that the field has no such word for.
const COINED: [&str; 16] = [
    "told",
    "telling",
    "ask",
    "asked",
    "asking",
    "answering",
    "found",
    "door",
    "judge",
    "river",
    "tried",
    "misfit",
    "firmness",
    "relief",
    "complaint",
    "desk",
];
/// What begins the definition of a public type.
const TYPES: [&str; 5] = ["pub struct ", "pub enum ", "pub trait ", "pub type ", "pub union "];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs" || e == "ts") {
            found.push(path);
        }
    }
}

/// All sources of the workspace and of the viewer.
fn workspace() -> Vec<PathBuf> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut files = Vec::new();
    for entry in fs::read_dir(crates).unwrap() {
        sources(&entry.unwrap().path().join("src"), &mut files);
    }
    sources(&crates.join("../viewer/src"), &mut files);
    assert!(files.len() > 500, "only {} files found", files.len());
    files.sort();
    files
}

/// The public types that a text defines.
fn types(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let line = line.trim_start();
        let name = TYPES.iter().find_map(|start| line.strip_prefix(start))?;
        name.split(|c: char| !c.is_alphanumeric()).next().filter(|name| !name.is_empty())
    })
}

#[test]
fn no_two_public_types_share_a_name() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in workspace() {
        for name in types(&fs::read_to_string(&file).unwrap()) {
            places.entry(name.to_owned()).or_default().push(file.display().to_string());
        }
    }
    places.retain(|_, files| files.len() > 1);
    assert!(places.is_empty(), "give each a name that says what it is: {places:#?}");
}

#[test]
fn no_file_has_a_coined_name() {
    let coined = |file: &PathBuf| {
        let stem = file.file_stem().unwrap().to_string_lossy();
        COINED.contains(&stem.as_ref())
    };
    let files: Vec<PathBuf> = workspace().into_iter().filter(coined).collect();
    assert!(files.is_empty(), "name them by what they hold: {files:#?}");
}

#[test]
fn definitions_are_seen_at_any_indentation() {
    let text = "pub struct A<'a>(&'a str);\n    pub enum B {}\npub(crate) struct C;\npub type $name = D;\npub fn e() {}";
    assert_eq!(types(text).collect::<Vec<_>>(), ["A", "B"]);
}
