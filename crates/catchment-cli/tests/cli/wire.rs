//! The printed JSON and its schema, on which other programs rely.

use super::{home, json};
use catchment::report::json_schema;
use serde_json::Value;

#[test]
fn every_json_has_one_head_and_its_fields() {
    let home = home();
    std::fs::write(home.path().join("poses.csv"), "x,pitch\n0.1,0.2\n").unwrap();
    let run = ["run", "v.toml", "--resolution", "8", "--samples", "50", "--json"];
    let kinematic = ["trace", "x.toml", "--cor=-0.5", "--pose", "x=0.2,pitch=0.2", "--method", "kinematic"];
    let bench = ["--accuracy", "x=0.01,pitch=0.01", "--json"];
    let seen = "line,x,pitch,outcome\n1,0.1,0,jammed\n1,0.2,0,aligned\n1,0.9,0,missed\n";
    std::fs::write(home.path().join("seen.csv"), seen).unwrap();
    std::fs::copy(super::designs().join("x-face.toml"), home.path().join("x.toml")).unwrap();
    let chance = [
        "chance",
        "v.toml",
        "--draw",
        "speed=1",
        "--trials",
        "2",
        "--overall",
        "100",
        "--pose",
        "x=0.1",
        "--timeout",
        "1",
    ];
    let calls: [(&str, &[&str]); 25] = [
        ("run", &[&run[..], &["--method", "flood", "--error-sigma", "x=0.1"]].concat()),
        ("check", &["check", "v.toml", "--json"]),
        ("outcome", &["outcome", "v.toml", "--poses", "poses.csv", "--json"]),
        ("trace", &["trace", "v.toml", "--pose", "x=0.2", "--json"]),
        ("kinematic-contact", &[&kinematic[..], &["--json"]].concat()),
        ("zraa", &["zraa", "v.toml", "--json"]),
        ("zraa-faces", &["zraa", "v.toml", "x.toml", "--json"]),
        ("window", &["window", "v.toml", "--motions", "100", "--json"]),
        ("success", &["success", "v.toml", "--error-sigma", "x=0.3", "--motions", "100", "--json"]),
        ("jams", &["jams", "v.toml", "--motions", "100", "--error-sigma", "x=0.1", "--json"]),
        ("friction", &["friction", "v.toml", "--frictions", "0.1", "--motions", "100", "--json"]),
        ("rests", &["rests", "v.toml", "--motions", "100", "--json"]),
        ("hold", &["hold", "v.toml", "--friction", "0.2", "--preload", "40", "--json"]),
        (
            "chance",
            &[
                &chance[..],
                &["--map", "x,pitch", "--cells", "2", "--times", "2", "--preset", "gazebo-2014", "--json"],
            ]
            .concat(),
        ),
        ("trace", &["trace", "v.toml", "--pose", "x=0.2", "--method", "drop", "--json"]),
        ("plan", &[&["plan", "v.toml", "--pattern", "bracket", "--trials", "8"], &bench[..]].concat()),
        ("validate", &[&["validate", "seen.csv", "v.toml", "--estimate-friction"], &bench[..]].concat()),
        ("slices", &["slices", "v.toml", "--resolution", "8", "--json"]),
        ("convergence", &["run", "v.toml", "--converge", "--time-limit", "0.001 ms", "--json"]),
        ("sensitivity", &["run", "v.toml", "--sensitivity", "--samples", "50", "--json"]),
        ("comparison", &["compare", "v.toml", "--methods", "descent,flood", "--resolution", "8", "--json"]),
        ("methods", &[&run[..], &["--free", "x", "--method", "all"]].concat()),
        ("export", &["export", "v.toml", "--pose", "x=0.1", "-o", "trial", "--json"]),
        ("solids", &["solids", "v.toml", "--json"]),
        ("trials", &["zraa", "v.toml", "--beside", "descent", "--resolution", "4", "--json"]),
    ];
    for (kind, args) in calls {
        let report = json(home.path(), args);
        assert_eq!((&report["schema"], &report["kind"]), (&4.into(), &kind.into()));
        let names: Vec<&str> = report.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(names[..3], ["schema", "catchment", "kind"]);
        assert_eq!(names[names.len() - 2..], ["warnings", "timing"]);
        let schema = json_schema::of_kind(kind).unwrap_or_else(|| panic!("no schema of {kind}"));
        matches(&schema, &schema.of_kind(), &report, kind);
    }
}

/// Every field has an entry in the schema, and a value of one of the types listed there.
fn matches(
    schema: &catchment::run::ReportSchema<'static>,
    here: &[&'static Value],
    value: &Value,
    path: &str,
) {
    let of = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let types = schema.types(here);
    assert!(types.is_empty() || types.contains(&of), "{path} is {value}, the schema has {types:?}");
    let below: Vec<(String, &Value)> = match value {
        Value::Object(fields) => fields.iter().map(|(name, inner)| (name.clone(), inner)).collect(),
        Value::Array(items) => items.iter().enumerate().map(|(k, inner)| (k.to_string(), inner)).collect(),
        _ => Vec::new(),
    };
    for (name, inner) in below {
        let path = format!("{path}.{name}");
        let next = schema.step(here, &name);
        assert!(!next.is_empty(), "the schema has no {path}");
        matches(schema, &next, inner, &path);
    }
}

/// The schema derived from the types equals the committed one.
#[cfg(feature = "schema")]
#[test]
fn the_schema_is_up_to_date() {
    let settings = schemars::generate::SchemaSettings::draft2020_12().for_serialize();
    let mut generator = settings.into_generator();
    json_schema::add_all(&mut generator);
    catchment_systems::add_json_schemas(&mut generator);
    let definitions = generator.take_definitions(true);
    let schema = serde_json::json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Reports of catchment: a report of kind `window` matches #/$defs/window",
        "$defs": definitions,
    });
    let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../catchment-report/reports.schema.json");
    if std::env::var_os("UPDATE_SCHEMA").is_some() {
        std::fs::write(path, &text).unwrap();
    }
    let is_same = std::fs::read_to_string(path).unwrap() == text;
    assert!(is_same, "stale: UPDATE_SCHEMA=1 cargo test -p catchment-cli --all-features --test cli schema");
}

#[test]
fn names_do_not_steer_the_terminal() {
    let home = home();
    let place = |name: &str| home.path().join(name);
    let quiet = |args: &[&str]| {
        let printout = super::run(home.path(), args);
        let steers = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
        assert!(printout.starts_with("exit 0\n") && !printout.contains(steers), "{args:?}: {printout:?}");
    };
    std::fs::write(place("evil.toml"), "name = \"a\\u202e<&\"\n".to_owned() + super::V_FACE).unwrap();
    std::fs::copy(place("evil.toml"), place("b\u{1b}[2J.toml")).unwrap();
    quiet(&["check", "b\u{1b}[2J.toml"]);
    quiet(&["zraa", "evil.toml"]);
    quiet(&[
        "run",
        "evil.toml",
        "--method",
        "flood",
        "--resolution",
        "8",
        "--samples",
        "0",
        "-o",
        "out.zarr",
    ]);
    // A stored result is untrusted input.
    let root = place("out.zarr/zarr.json");
    let text = std::fs::read_to_string(&root).unwrap();
    assert!(text.contains("a\u{202e}<&"));
    std::fs::write(&root, text.replace("a\u{202e}<&", "a\\u001b[2J\\u0000")).unwrap();
    quiet(&["compare", "out.zarr", "out.zarr"]);
}
