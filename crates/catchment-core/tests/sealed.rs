//! The core computes: it asks the system for nothing. Threads, clock and memory are `exec`'s; files are read and written
//! where this list says.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use std::fs;
use std::path::{Path, PathBuf};

/// The rooms that must build where there is no system, such as a page in a browser.
const CORE: [&str; 20] = [
    "pose",
    "exec",
    "budget",
    "disjoint",
    "suggest",
    "terminal",
    "tolerance",
    "diagnostic",
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
    "run",
];

/// What asks the system for something, and what for.
const ASKS: [(&str, &str); 12] = [
    ("Instant", "the time"),
    ("SystemTime", "the time"),
    ("std::thread", "a thread"),
    ("ThreadPoolBuilder", "a thread"),
    ("rayon::spawn", "a thread"),
    ("rayon::join", "a thread"),
    ("current_num_threads", "a thread"),
    ("std::fs", "a file"),
    ("File::", "a file"),
    ("std::env::", "the environment"),
    ("std::net", "the network"),
    ("std::process", "a process"),
];

/// Where the core may ask, for what, and why.
const ALLOWED: [(&str, &str, &str); 10] = [
    ("exec/clock.rs", "the time", "deadlines and stopwatches; stands still where there is no clock"),
    ("exec/threads.rs", "a thread", "the pools of a run; the caller's own thread where there are none"),
    ("exec/threads.rs", "the environment", "how many threads a person wants for all programs"),
    ("exec/memory/system.rs", "a file", "how much memory is free, on Linux"),
    ("design/load.rs", "a file", "reading a design file"),
    ("connector/source/disk.rs", "a file", "reading a mesh"),
    ("connector/step/child.rs", "a process", "a STEP file becomes triangles in a Python of the person's own"),
    ("connector/step/child.rs", "a thread", "what the process reads and writes"),
    ("connector/step/child.rs", "the environment", "which Python, and where it looks for packages"),
    ("connector/step/child.rs", "a file", "an empty folder in which the process starts"),
];

/// Lines of code that ask for something they may not, as `place:line: what`. What follows the unit tests of a file is not
/// looked at, nor are files of tests.
fn violations(place: &str, text: &str) -> Vec<String> {
    let tests = |part: &str| part == "tests" || part == "tests.rs";
    let core = place.split(['/', '.']).next().is_some_and(|room| CORE.contains(&room));
    if !core || place.split('/').any(tests) {
        return Vec::new();
    }
    let code = text.lines().take_while(|line| line.trim() != "#[cfg(test)]" || text.contains("mod tests;"));
    code.zip(1..)
        .flat_map(|(line, number)| {
            let code = line.split("//").next().unwrap_or_default();
            let requested = ASKS.iter().filter(move |(word, _)| {
                // A whole word: `Instant`, not `Instantaneous`.
                code.match_indices(word).any(|(at, _)| {
                    let around = [code[..at].chars().next_back(), code[at + word.len()..].chars().next()];
                    let inside = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
                    !inside(around[0]) && (word.ends_with(':') || !inside(around[1]))
                })
            });
            requested.map(move |(_, what)| (number, *what))
        })
        .filter(|(_, what)| !ALLOWED.iter().any(|(allowed, thing, _)| *allowed == place && thing == what))
        .map(|(number, what)| format!("{place}:{number}: asks for {what}"))
        .collect()
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

#[test]
fn the_core_calls_the_system_only_where_allowed() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    // The room `connector` is a crate of its own.
    let roots = [
        ("catchment-base", ""),
        ("catchment-design", ""),
        ("catchment-connector", "connector/"),
        ("catchment-core", ""),
    ];
    let mut wrong = Vec::new();
    for (name, room) in roots {
        let src = crates.join(name).join("src");
        let mut files = Vec::new();
        sources(&src, &mut files);
        files.sort();
        for file in &files {
            let place = file.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/");
            wrong.extend(violations(&format!("{room}{place}"), &fs::read_to_string(file).unwrap()));
        }
        assert!(files.len() > 20, "only {} files found below {}", files.len(), src.display());
    }
    assert!(wrong.is_empty(), "the core asks the system:\n  {}", wrong.join("\n  "));
}

#[test]
fn forbidden_system_calls_are_detected() {
    let found = |place: &str, text: &str| violations(place, text);
    let clock = "use std::time::Instant;\n";
    assert_eq!(found("merit/sum.rs", clock), ["merit/sum.rs:1: asks for the time"]);
    assert_eq!(
        found("method/transport/mod.rs", "\nstd::fs::read(x)"),
        ["method/transport/mod.rs:2: asks for a file"]
    );
    assert_eq!(found("acceptance.rs", "std::thread::spawn(f);"), ["acceptance.rs:1: asks for a thread"]);
    for (place, text) in [
        ("exec/clock.rs", clock),
        ("study/trial.rs", clock),
        ("merit/sum.rs", "// an Instant\nlet instant = Instantaneous;\n#[cfg(test)]\nuse std::fs;"),
        ("design/tests.rs", "use std::fs;"),
    ] {
        assert_eq!(found(place, text), [""; 0], "{place}");
    }
}

/// The crates of the library.
const LIBRARY: [&str; 8] = [
    "catchment",
    "catchment-base",
    "catchment-design",
    "catchment-connector",
    "catchment-core",
    "catchment-study",
    "catchment-proposal",
    "catchment-report",
];

/// The sources of these crates; a package that was unpacked alone has no neighbours.
fn of(names: &[&str]) -> Vec<PathBuf> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    for source in names.iter().map(|name| crates.join(name).join("src")).filter(|source| source.is_dir()) {
        sources(&source, &mut files);
    }
    files
}

/// Names of files are shown by `terminal::shown` alone: as they are, a line break in one begins a line of the terminal. Where a name is data
/// (JSON, another path) it stays as it is.
#[test]
fn no_message_shows_an_unescaped_path() {
    const DATA: [(&str, usize); 7] = [
        ("catchment-base/src/terminal.rs", 1),
        ("catchment-design/src/poses/robots/read.rs", 1),
        ("catchment-report/src/check.rs", 1),
        ("catchment-report/src/compare.rs", 1),
        ("catchment-study/src/sweep/mod.rs", 1),
        ("catchment-cli/src/command/compare.rs", 1),
        ("catchment-cli/src/command/export/mod.rs", 1),
    ];
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for file in of(&[&LIBRARY[..], &["catchment-cli", "catchment-systems", "catchment-validation"]].concat())
    {
        let place = file.strip_prefix(&crates).unwrap().to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(&file).unwrap();
        let tests = place.ends_with("tests.rs") || place.contains("/tests/");
        let code =
            text.lines().take_while(|line| line.trim() != "#[cfg(test)]" || text.contains("mod tests;"));
        let shown: usize = code.map(|line| line.matches(".display()").count()).sum();
        let allowed = DATA.iter().find(|(known, _)| *known == place).map_or(0, |(_, count)| *count);
        assert!(tests || shown <= allowed, "{place}: a path in a message goes through terminal::shown");
    }
}

/// String literals of a line that name an option of a command line.
fn options(line: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    let quoted = code.split('"').skip(1).step_by(2);
    quoted.into_iter().any(|text| {
        text.match_indices("--").any(|(at, _)| {
            let before = text[..at].chars().next_back();
            let after = text[at + 2..].chars().next();
            before.is_none_or(|c| !c.is_alphanumeric() && c != '-')
                && after.is_some_and(|c| c.is_ascii_lowercase())
        })
    })
}

#[test]
fn no_message_of_the_library_names_an_option() {
    let mut found = Vec::new();
    for file in &of(&LIBRARY) {
        let text = fs::read_to_string(file).unwrap();
        let code = text.lines().take_while(|line| line.trim() != "#[cfg(test)]");
        for (line, number) in code.zip(1..).filter(|(line, _)| options(line)) {
            found.push(format!("{}:{number}: {}", file.display(), line.trim()));
        }
    }
    assert!(
        found.is_empty(),
        "advice is data; only the command line names its options:\n{}",
        found.join("\n")
    );
    assert!(
        options("    \"use at most --resolution 3\"") && !options("a --b // \"--c\"") && !options("\"a--b\"")
    );
}

/// A module with files of its own is `name/mod.rs`: there is one style.
#[test]
fn no_file_stands_beside_a_folder_of_its_name() {
    let all = [&LIBRARY[..], &["catchment-cli", "catchment-systems", "catchment-validation"]].concat();
    let beside: Vec<PathBuf> = of(&all).into_iter().filter(|file| file.with_extension("").is_dir()).collect();
    assert!(beside.is_empty(), "these become mod.rs of the folder beside them: {beside:?}");
}
