//! Loss of acceptance by friction, through the real binary.

use super::{catchment, json, run};
use serde_json::Value;
use std::fs;

/// A V-Face whose facets have a slope of 0.2.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let text = "[connector]\nfamily = \"v-face\"\naspect_ratio = 0.1\n[alignment]\nfree = [\"x\"]\n";
    fs::write(home.path().join("v.toml"), text).unwrap();
    home
}

#[test]
fn a_facet_holds_everything_from_its_slope_on() {
    let home = home();
    let printed = run(home.path(), &["friction", "v.toml", "--motions", "200", "--frictions", "0.1,0.3"]);
    assert!(
        printed.starts_with("exit 0\n") && printed.contains("90 %           0.199 (95 % CI 0.199 … 0.199)"),
        "{printed}"
    );
    assert!(printed.contains("contacts of the first 20 poses lost as μ rises"), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    // Just above the slope, friction barely holds every lost pose, and a message reports it.
    assert!(!printed.contains("dock at 0.9 of it"), "{printed}");
    let printed = run(home.path(), &["friction", "v.toml", "--motions", "200", "--frictions", "0.21"]);
    assert!(
        printed.split_whitespace().collect::<Vec<_>>().join(" ").contains("dock at 0.9 of it"),
        "{printed}"
    );
}

#[test]
fn threads_change_nothing_and_files_are_whole() {
    let home = home();
    let with = |threads: &str| {
        let args = ["friction", "v.toml", "--motions", "100", "--json", "--threads", threads];
        let mut report = json(home.path(), &args);
        report["timing"] = Value::Null;
        report
    };
    assert_eq!(with("1"), with("2"));
    for (file, begins) in [("f.svg", "<svg"), ("f.csv", "friction,motions,aligned,"), ("f.json", "{\n")] {
        let printed = run(home.path(), &["friction", "v.toml", "--motions", "50", "-o", file]);
        assert!(printed.starts_with("exit 0\n"), "{printed}");
        assert!(fs::read_to_string(home.path().join(file)).unwrap().starts_with(begins));
    }
}

#[test]
fn a_requirement_decides_the_exit_code() {
    let home = home();
    let code = |require: &str| {
        let args = ["friction", "v.toml", "--motions", "100", "--require", require];
        catchment(home.path()).args(args).output().unwrap().status.code()
    };
    assert_eq!(code("kept.p95.friction>=0.19"), Some(0));
    assert_eq!(code("kept.p95.friction>=0.21"), Some(1));
}

/// A friction coefficient of zero leaves every result bit-identical.
#[test]
fn zero_friction_changes_no_result() {
    let home = home();
    fs::write(home.path().join("poses.csv"), "x\n0.1\n-0.3\n0.45\n").unwrap();
    let calls: [&[&str]; 6] = [
        &["run", "v.toml", "--free", "x,pitch", "--resolution", "15", "--samples", "200"],
        &["run", "v.toml", "--free", "x,pitch", "--resolution", "15", "--method", "descent"],
        &["outcome", "v.toml", "--poses", "poses.csv"],
        &["jams", "v.toml", "--free", "x,pitch", "--motions", "200"],
        &["window", "v.toml", "--motions", "200"],
        &["success", "v.toml", "--error-sigma", "x=0.3", "--motions", "200"],
    ];
    for args in calls {
        let with = |more: &[&str]| {
            let mut report = json(home.path(), &[args, &["--json"], more].concat());
            report["timing"] = Value::Null;
            report
        };
        assert_eq!(with(&[]), with(&["--friction", "0"]), "{args:?}");
    }
}
