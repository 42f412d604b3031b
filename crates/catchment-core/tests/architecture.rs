//! Data walks through the rooms in one direction, and imports run against it: a room knows the rooms before it. That the foundations come
//! before all of them, `design`, `xml` and `poses` before `connector`, that before `contact`, and `study` and `report` last, is held by the
//! borders of their crates.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms in the order in which data walks through them.
const ROOMS: [&str; 14] = [
    "polygon",
    "polytope",
    "design",
    "xml",
    "poses",
    "connector",
    "contact",
    "problem",
    "landscape",
    "acceptance",
    "method",
    "merit",
    "document",
    "run",
];
/// Crates with rooms, in the same order; `connector` is a crate by itself.
const CRATES: [&str; 3] = ["catchment-base", "catchment-design", "catchment-core"];
/// Crates that come after these rooms.
const AFTER: [&str; 3] = ["study", "proposal", "report"];
/// What serves every room and knows none.
const SERVANTS: [&str; 8] =
    ["pose", "disjoint", "exec", "budget", "suggest", "terminal", "tolerance", "diagnostic"];

/// The engine of drop tests has glam compute with `libm`. Whatever else is compiled, results have the same bits only if we ask for it, too.
#[test]
fn rotations_have_the_same_bits_with_and_without_the_engine() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../Cargo.toml");
    let manifest = fs::read_to_string(manifest).unwrap();
    let glam = manifest.lines().find(|line| line.starts_with("glam = { version")).unwrap();
    assert!(glam.contains("\"libm\""), "{glam}");
}

/// A room that imports one it must not know.
#[derive(Debug, PartialEq)]
struct Violation {
    place: String,
    line: usize,
    from: String,
    to: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place, line, from, to } = self;
        write!(f, "{place}:{line}: {from} imports {to}")?;
        match (rank(from), rank(to)) {
            (_, None) => write!(f, ", which is no room: name it in tests/architecture.rs"),
            (None | Some(0), _) => write!(f, ", but {from} may import no room"),
            (Some(rank), _) => write!(f, ", but may import only {}", ROOMS[..rank].join(", ")),
        }
    }
}

fn rank(name: &str) -> Option<usize> {
    ROOMS.iter().position(|room| *room == name)
}

fn may_import(from: &str, to: &str) -> bool {
    from == to
        || SERVANTS.contains(&to)
        || matches!((rank(from), rank(to)), (Some(from), Some(to)) if to < from)
}

/// The names right below the crate's root that a line of code reaches through `crate::`, or through as many
/// `super::` as the file's module is deep.
fn reached(code: &str, depth: usize) -> Vec<String> {
    let climb = "super::".repeat(depth);
    let mut names = Vec::new();
    for root in ["crate::", climb.as_str()] {
        for (at, _) in code.match_indices(root) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':') {
                continue;
            }
            let rest = &code[at + root.len()..];
            let group = rest.strip_prefix('{');
            let members = group.map_or(vec![rest], members);
            let name = |member: &str| -> String {
                member.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
            };
            names.extend(members.into_iter().map(name).filter(|name| {
                // What `super` finds may be the room's own child, when the line stands in an inner module.
                root == "crate::" || rank(name).is_some() || SERVANTS.contains(&name.as_str())
            }));
        }
    }
    names.retain(|name| !name.is_empty() && name != "self");
    names
}

/// The members of `{a, b::{c, d}}`, given what follows the opening brace.
fn members(group: &str) -> Vec<&str> {
    let (mut level, mut start, mut found) = (0, 0, Vec::new());
    for (at, c) in group.char_indices() {
        match c {
            '{' => level += 1,
            '}' if level == 0 => {
                found.push(&group[start..at]);
                break;
            }
            '}' => level -= 1,
            ',' if level == 0 => {
                found.push(&group[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    found
}

/// The imports in one file that run along the flow. `place` is its path below `src`.
fn violations(place: &str, text: &str) -> Vec<Violation> {
    let parts: Vec<&str> = place.trim_end_matches(".rs").split('/').filter(|part| *part != "mod").collect();
    let Some(from) = parts.first().filter(|part| **part != "lib") else {
        return Vec::new();
    };
    // A `use` may go on over several lines: statements, with the line they begin on.
    let (mut found, mut statement, mut begin) = (Vec::new(), String::new(), 1);
    for (number, line) in text.lines().enumerate() {
        let code = line.split("//").next().unwrap_or_default();
        if statement.is_empty() {
            begin = number + 1;
        }
        statement.push_str(code.trim());
        let open = statement.starts_with("use ") || statement.starts_with("pub use ");
        if open && !statement.ends_with(';') {
            continue;
        }
        for to in reached(&statement, parts.len()) {
            if !may_import(from, &to) {
                found.push(Violation { place: place.to_owned(), line: begin, from: (*from).to_owned(), to });
            }
        }
        statement.clear();
    }
    found
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// The sources of [`CRATES`].
fn roots() -> [PathBuf; 3] {
    CRATES.map(|name| Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name).join("src"))
}

#[test]
fn imports_run_against_the_flow_of_data() {
    let mut wrong = Vec::new();
    for src in roots() {
        let mut files = Vec::new();
        sources(&src, &mut files);
        files.sort();
        for file in &files {
            let place = file.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/");
            wrong.extend(violations(&place, &fs::read_to_string(file).unwrap()));
        }
        assert!(files.len() > 20, "only {} files found below {}", files.len(), src.display());
    }
    let list: Vec<String> = wrong.iter().map(ToString::to_string).collect();
    assert!(wrong.is_empty(), "imports along the flow of data:\n  {}", list.join("\n  "));
}

#[test]
fn every_module_is_ranked_and_documented() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let map = fs::read_to_string(root.join("../../docs/architecture.md")).unwrap();
    let tour = fs::read_to_string(root.join("../catchment/src/lib.rs")).unwrap();
    let mut names: Vec<String> = roots()
        .iter()
        .flat_map(|src| fs::read_dir(src).unwrap())
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
        .filter(|name| name != "lib")
        .chain(["connector".to_owned()])
        .collect();
    names.sort();
    names.dedup();
    let mut known: Vec<&str> = ROOMS.into_iter().chain(SERVANTS).collect();
    known.sort_unstable();
    assert_eq!(names, known, "the rooms below src and the order held here differ");
    for name in names.iter().map(String::as_str).chain(AFTER) {
        assert!(map.contains(&format!("**`{name}`**")), "docs/architecture.md does not describe {name}");
        assert!(tour.contains(&format!("[`{name}`]")), "the tour in lib.rs does not name {name}");
    }
}

#[test]
fn an_import_along_the_flow_is_detected_in_any_form() {
    let found = |place: &str, text: &str| -> Vec<(usize, String)> {
        violations(place, text).into_iter().map(|v| (v.line, v.to)).collect()
    };
    let one = |line: usize, to: &str| vec![(line, to.to_owned())];
    assert_eq!(found("design/read.rs", "use crate::pose::Dof;\nuse crate::merit::sum;\n"), one(2, "merit"));
    assert_eq!(found("contact/mod.rs", "let r = crate::report::table(&x);"), one(1, "report"));
    assert_eq!(
        found("contact/mod.rs", "use crate::{\n    design::{Design, Family},\n    method,\n};"),
        one(1, "method")
    );
    assert_eq!(found("contact/brute.rs", "use super::super::method::flood;"), one(1, "method"));
    assert_eq!(found("contact/mod.rs", "pub use super::run;"), one(1, "run"));
    assert_eq!(found("pose.rs", "use crate::design::Alignment;"), one(1, "design"));
    assert_eq!(found("contact/mod.rs", "use crate::helpers::x;"), one(1, "helpers"));
    assert_eq!(
        found("contact/mod.rs", "//! See [`crate::run`].\nuse crate::design::Design; // not crate::merit"),
        []
    );
    assert_eq!(found("run/window/mod.rs", "use super::super::stages;\nuse crate::run::plan;"), []);
    assert_eq!(found("lib.rs", "pub use crate::run::Answer;"), []);
}

#[test]
fn a_violation_lists_the_allowed_imports() {
    let [violation] = &violations("contact/mod.rs", "\nuse crate::method::descent;")[..] else {
        panic!("one violation expected");
    };
    let message = "contact/mod.rs:2: contact imports method, but may import only polygon, polytope, design, xml, poses, connector";
    assert_eq!(violation.to_string(), message);
}
