//! The catalogue of bad inputs, `../bad_inputs.jsonl`, one case per line:
//!
//! ```text
//!   name    the defect
//!   files   name and content, beside v.toml, p.toml, good.csv and the stored result a.zarr, or in place of one of its files
//!   edits   name of a file, the text to replace in it once, and the replacement
//!   args    arguments of the program
//!   says    a piece of its message; line breaks and frames count as spaces
//!   exit    its exit code
//! ```
//!
//! Each case must end within seconds with that message and that code, with an empty stdout and no written
//! files.

use crate::{V_FACE, catchment, run};
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[derive(Deserialize)]
struct Case {
    name: String,
    #[serde(default)]
    files: BTreeMap<String, String>,
    #[serde(default)]
    edits: BTreeMap<String, [String; 2]>,
    args: Vec<String>,
    says: String,
    exit: i32,
}

/// Time limits on a busy machine, for one refusal and for all together; an idle machine takes a quarter of a
/// second each.
const EACH: Duration = Duration::from_secs(10);
const ALL: Duration = Duration::from_mins(3);

/// Minimum number of cases in the catalogue.
const CASES: usize = 120;

/// The stored result, beside the files of a case that names it.
const STORED: &str = "a.zarr";

const PYRAMID: &str = "[connector]\nfamily = \"pyramid\"\nwidth = 40.0\nunit = \"mm\"\naspect_ratio = 0.5\n";

/// Every file below a folder with its bytes.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let (mut result, mut open) = (BTreeMap::new(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let bytes = fs::read(&path).unwrap();
                result.insert(path, bytes);
            }
        }
    }
    result
}

/// A folder with the common files of all cases and the case's own files.
fn home(stored: &BTreeMap<PathBuf, Vec<u8>>, from: &Path, case: &Case) -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let put = |path: &Path, bytes: &[u8]| {
        let path = home.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    };
    put(Path::new("v.toml"), V_FACE.as_bytes());
    put(Path::new("p.toml"), PYRAMID.as_bytes());
    put(Path::new("good.csv"), b"x,y\n0,0\n");
    let is_of_result = |word: &String| word.contains(STORED);
    if case.args.iter().chain(case.files.keys()).chain(case.edits.keys()).any(is_of_result) {
        for (path, bytes) in stored {
            put(path.strip_prefix(from).unwrap(), bytes);
        }
    }
    for (path, text) in &case.files {
        put(Path::new(path), text.as_bytes());
    }
    for (path, [from, to]) in &case.edits {
        let text = fs::read_to_string(home.path().join(path)).unwrap();
        assert!(text.contains(from), "{}: {path} has no {from}", case.name);
        put(Path::new(path), text.replacen(from, to, 1).as_bytes());
    }
    home
}

/// The deviations of the program's response from the case.
fn faults(case: &Case, stored: &BTreeMap<PathBuf, Vec<u8>>, from: &Path) -> Vec<String> {
    let home = home(stored, from, case);
    let (before, started) = (contents(home.path()), Instant::now());
    let output = catchment(home.path()).args(&case.args).output().unwrap();
    let time = started.elapsed();
    let stderr = String::from_utf8_lossy(&output.stderr);
    let words = stderr.split(|c: char| c.is_whitespace() || c == '│').filter(|word| !word.is_empty());
    let printout = words.collect::<Vec<_>>().join(" ");
    let coded = case.args[0] != "check" || has_codes(home.path(), &case.args);
    let mut faults = Vec::new();
    let mut hold = |holds: bool, fault: &str| {
        if !holds {
            faults.push(format!("{}: {fault}: {printout}", case.name));
        }
    };
    hold(output.status.code() == Some(case.exit), &format!("it ended with {}", output.status));
    hold(printout.contains(&case.says), &format!("it did not say `{}`", case.says));
    hold(!printout.contains("panicked") && !printout.contains("a bug of the program"), "it panicked");
    hold(!stderr.chars().any(|c| c.is_control() && c != '\n'), "a control character came through");
    hold(output.stdout.is_empty(), "something is on stdout");
    hold(contents(home.path()) == before, "something was written");
    hold(coded, "a diagnostic of --json lacks its severity or code");
    hold(time < EACH, &format!("it took {time:?}"));
    faults
}

/// Whether `check --json` prints every error with severity and code; `None` where there is no design to check.
fn has_codes(home: &Path, args: &[String]) -> bool {
    let output = catchment(home).args(args).arg("--json").output().unwrap();
    let report: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    let is_code = |c: char| c.is_ascii_lowercase() || c == '-';
    let has_code = |one: &Value| {
        one["severity"] == "error"
            && one["code"].as_str().is_some_and(|code| !code.is_empty() && code.chars().all(is_code))
    };
    output.stdout.is_empty()
        || report["problems"].as_array().is_some_and(|all| !all.is_empty() && all.iter().all(has_code))
}

#[test]
fn every_bad_input_of_the_catalogue_is_refused_as_listed() {
    let cases: Vec<Case> =
        include_str!("../bad_inputs.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(cases.len() >= CASES, "{} cases", cases.len());
    let from = tempfile::tempdir().unwrap();
    fs::write(from.path().join("v.toml"), V_FACE).unwrap();
    let printed =
        run(from.path(), &["run", "v.toml", "--method", "flood", "--resolution", "20", "-o", STORED]);
    assert!(printed.starts_with("exit 0"), "{printed}");
    let stored = contents(from.path());
    let started = Instant::now();
    let faults: Vec<String> = cases.iter().flat_map(|case| faults(case, &stored, from.path())).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(started.elapsed() < ALL, "all together took {:?}", started.elapsed());
}
