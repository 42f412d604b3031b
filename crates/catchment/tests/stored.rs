//! Reports that other versions of this program wrote, or will write.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::diagnostic::Warning;
use catchment::report::{Report, SCHEMA};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Fields of the last layout, and their names in the current one.
const RENAMED: [(&str, &str); 7] = [
    ("firmness", "stability"),
    ("way_out", "escape_path"),
    ("pushed", "displaced"),
    ("back", "returned"),
    ("differing", "misclassified"),
    ("differing_ci95", "misclassified_ci95"),
    ("joined", "inherited"),
];

/// A planar V on 8 × 8 cells with its jams, as written by the version before the fields were renamed.
fn old() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/schema-3")
}

/// The same with the current names.
fn renamed(value: Value) -> Value {
    match value {
        Value::Array(list) => list.into_iter().map(renamed).collect(),
        Value::Object(fields) => {
            let name = |key: String| {
                RENAMED.iter().find(|(old, _)| *old == key).map_or(key, |(_, new)| (*new).to_owned())
            };
            fields.into_iter().map(|(key, value)| (name(key), renamed(value))).collect()
        }
        other => other,
    }
}

fn old_json() -> Value {
    serde_json::from_str(&std::fs::read_to_string(old().join("report.json")).unwrap()).unwrap()
}

/// Adds a field to every object, except inside inputs (settings and docking tolerance), which are read strictly,
/// inside tables by outcome, and beside the field that identifies the connector.
fn with_more_fields(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(with_more_fields),
        Value::Object(fields) => {
            let strict = ["settings", "docked", "outcomes"];
            let read = fields.iter_mut().filter(|(key, _)| !strict.contains(&key.as_str()));
            read.for_each(|(_, value)| with_more_fields(value));
            if !fields.contains_key("family") || fields.contains_key("aspect_ratio") {
                fields.insert("from_the_future".to_owned(), json!({ "some": ["thing"] }));
            }
        }
        _ => {}
    }
}

#[test]
fn a_report_of_the_last_layout_is_read_and_written_in_this_one() {
    let old = old_json();
    assert_eq!((&old["schema"], &old["kind"]), (&3.into(), &"run".into()));
    let report = Report::from_json(&old.to_string()).unwrap();
    let mut new: Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
    assert_eq!(new["schema"], SCHEMA);
    new["schema"] = 3.into();
    // Apart from its facts and its sentence, the fields of a diagnostic are derived from them.
    for warning in new["warnings"].as_array_mut().unwrap().iter_mut().filter_map(Value::as_object_mut) {
        assert_eq!(warning.remove("severity"), Some("warning".into()));
        assert_eq!(warning.remove("code"), Some(warning["warning"]["kind"].clone()));
        assert!(warning.remove("help").is_some());
    }
    assert_ne!(new, old);
    assert_eq!(new, renamed(old));
}

#[test]
fn fields_that_are_not_known_are_ignored_at_every_level() {
    let known = Report::from_json(&old_json().to_string()).unwrap();
    let mut more = old_json();
    with_more_fields(&mut more);
    assert!(more["acceptance"]["sample"]["strata"][0]["from_the_future"].is_object());
    assert_eq!(Report::from_json(&more.to_string()).unwrap(), known);
}

#[test]
fn a_newer_layout_is_refused_with_advice_whatever_its_form() {
    let refused = |schema: u32| {
        let text = json!({ "schema": schema, "catchment": 7, "design": [] }).to_string();
        Report::from_json(&text).unwrap_err().to_string()
    };
    let newer = refused(SCHEMA + 1);
    assert!(
        newer.contains("written by a newer version of catchment: its schema is 5, this one reads up to 4")
    );
    assert!(newer.contains("update catchment, or compute the result again"), "{newer}");
    let older = refused(2);
    assert!(older.contains("its schema is 2, this version of catchment reads from 3 to 4"), "{older}");
    assert!(older.contains("/docs/versions.md"), "{older}");
    let mut other = old_json();
    other["kind"] = "trace\u{1b}[2J".into();
    let other = Report::from_json(&other.to_string()).unwrap_err().to_string();
    assert!(other.contains(r"it is a report of `trace\u{1b}[2J`, not of `run`"), "{other}");
}

/// The version appears in pages, tables and files for other programs.
#[test]
fn an_invalid_version_is_refused() {
    for hostile in ["0.1.0\"><script>alert(1)</script>", "", "0.1", "0.1.0\u{1b}[2J"] {
        let mut report = old_json();
        report["catchment"] = hostile.into();
        let error = Report::from_json(&report.to_string()).unwrap_err().to_string();
        assert!(error.contains("is not a version of catchment") && !error.contains('\u{1b}'), "{error}");
    }
}

#[test]
fn a_warning_of_unknown_kind_becomes_a_note() {
    let mut report = old_json();
    report["warnings"] = json!([{ "warning": { "kind": "moon-phase" }, "message": "the moon is full" }]);
    let report = Report::from_json(&report.to_string()).unwrap();
    assert_eq!(report.warnings, [Warning::Note { text: "the moon is full".to_owned() }]);
}

#[cfg(feature = "zarr")]
#[test]
fn a_group_of_the_last_layout_is_read() {
    use catchment::exec::Exec;
    use catchment::report::zarr;
    let (report, acceptance) = zarr::read(&old().join("result.zarr"), &Exec::new()).unwrap();
    assert_eq!(report, Report::from_json(&old_json().to_string()).unwrap());
    assert_eq!(acceptance.counts()[0], report.acceptance.outcomes.aligned);
}
