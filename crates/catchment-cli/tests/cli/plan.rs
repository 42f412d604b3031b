//! Plans of robot trials and their verdicts, through the real binary.

use super::{catchment, designs, json, run};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A V-Face of 50 mm: 25 mm to either side where pitch is locked.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let text = "[connector]\nfamily = \"v-face\"\nwidth = 50.0\nunit = \"mm\"\n[alignment]\nfree = [\"x\"]\n";
    fs::write(home.path().join("v.toml"), text).unwrap();
    for name in ["bench-x-face.toml", "bench-pyramid-arc.toml"] {
        fs::copy(designs().join(name), home.path().join(name)).unwrap();
    }
    home
}

const BRACKET: [&str; 8] =
    ["plan", "v.toml", "--pattern", "bracket", "--trials", "12", "--accuracy", "x=0.5 mm"];

/// The plan with a robot's outcome for every trial: docked up to this many millimetres.
fn filled(plan: &str, docks_to: f64) -> String {
    let mut rows = plan.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let head = rows.next().unwrap();
    let place = |name: &str| head.iter().position(|column| column == name).unwrap();
    let [x, outcome] = [place("x_mm"), place("outcome")];
    let mut text = head.join(",") + "\n";
    for mut row in rows {
        let far: f64 = row[x].parse().unwrap();
        if far.abs() < docks_to { "aligned" } else { "missed" }.clone_into(&mut row[outcome]);
        text += &(row.join(",") + "\n");
    }
    text
}

fn plan(folder: &Path, args: &[&str], file: &str) -> String {
    let printed = run(folder, &[args, &["-o", file]].concat());
    assert!(printed.starts_with("exit 0"), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    fs::read_to_string(folder.join(file)).unwrap()
}

/// The plan of a stored result equals that of its design, with the result's friction coefficient.
#[test]
fn a_result_is_planned_for_as_its_design_is() {
    let home = home();
    let run_args = ["run", "v.toml", "--resolution", "9", "--friction", "0.3", "-o", "out"];
    assert!(run(home.path(), &run_args).starts_with("exit 0"));
    let plan = |of: &str, more: &[&str]| {
        let args = ["plan", of, "--pattern", "bracket", "--trials", "12", "--accuracy", "x=0.5 mm", "--json"];
        let mut report = json(home.path(), &[&args[..], more].concat());
        report["timing"] = Value::Null;
        report
    };
    let of_result = plan("out", &[]);
    assert_eq!(of_result["settings"]["friction"], 0.3);
    assert_eq!(of_result, plan("v.toml", &["--friction", "0.3"]));
    assert_eq!(plan("out", &["--friction", "0"])["settings"]["friction"], 0.0);
    let args = ["plan", "out", "--cor", "0.1", "--pattern", "bracket", "--accuracy", "x=0.01"];
    let refused = run(home.path(), &args);
    assert!(
        refused.starts_with("exit 2") && refused.contains("is a result, which has been decided"),
        "{refused}"
    );
}

#[test]
fn a_plan_comes_back_with_outcomes_and_gets_its_verdict() {
    let home = home();
    let table = plan(home.path(), &BRACKET, "plan.csv");
    assert!(table.starts_with(
        "trial,block,line,x_mm,predicted,distance_to_border_mm,margin_in_sigma,repeat,outcome,notes\n"
    ));
    let verdict = |docks_to: f64, more: &[&str]| {
        fs::write(home.path().join("tried.csv"), filled(&table, docks_to)).unwrap();
        json(
            home.path(),
            &[&["validate", "tried.csv", "v.toml", "--accuracy", "x=0.5 mm", "--json"], more].concat(),
        )
    };
    let good = verdict(25.0, &[]);
    assert_eq!(
        (&good["verdict"], &good["consistent"], &good["blank"]),
        (&"consistent".into(), &1.into(), &0.into())
    );
    assert_eq!(good["agreement"]["trials"], good["agreement"]["agreed"]);
    assert_eq!(good["disagreements"], Value::Array(Vec::new()));
    // Docked only up to 15 mm: the prediction is wrong for every trial in between, and on the early side.
    let bad = verdict(15.0, &[]);
    assert_eq!((&bad["verdict"], &bad["consistent"]), (&"inconsistent".into(), &(-1).into()));
    assert!(bad["early"]["p_value"].as_f64().unwrap() < 1e-3);
    let first = &bad["disagreements"][0];
    assert_eq!((&first["observed"], &first["predicted"]), (&"missed".into(), &"aligned".into()));
    // At 23 mm the margin to the border at 25 mm is 4 σ.
    assert!(first["margin_in_sigma"].as_f64().unwrap() > 2.0);
    // Without friction along a slope no known cause explains it, and the report states that.
    let friction = verdict(15.0, &["--estimate-friction"]);
    assert!(friction["friction"]["tried"].as_array().unwrap().len() >= 21);
}

#[test]
fn threads_and_the_point_of_offsets_change_no_verdict() {
    let home = home();
    let arc = [
        "plan",
        "bench-pyramid-arc.toml",
        "--pattern",
        "arc",
        "--lever",
        "72.9 mm",
        "--pitch",
        "0..27:9 deg",
        "--yaw",
        "0,20 deg",
        "--accuracy",
        "x=1.2 mm",
    ];
    let quiet = |args: &[&str]| {
        let mut report = json(home.path(), &[args, &["--json"]].concat());
        report["timing"] = Value::Null;
        report
    };
    let printed = quiet(&[&arc[..], &["--threads", "1"]].concat());
    assert_eq!(printed, quiet(&[&arc[..], &["--threads", "2"]].concat()));
    // At the face centre y is locked and yet nonzero; at the joint both offsets are 0.
    let face = plan(home.path(), &arc, "face.csv");
    assert!(face.starts_with("trial,block,line,x_mm,y_mm,pitch_deg,yaw_deg,predicted,"), "{face}");
    let joint = plan(home.path(), &[&arc[..], &["--offsets-at", "cor"]].concat(), "joint.csv");
    assert!(joint.starts_with("trial,block,line,x_mm,pitch_deg,yaw_deg,predicted,"), "{joint}");
    let seen = |text: &str, name: &str| {
        let rows = text.lines().skip(1).map(|row| row.replace(",1,,", ",1,jammed,"));
        let head = text.lines().next().unwrap().to_owned();
        fs::write(home.path().join(name), std::iter::once(head).chain(rows).collect::<Vec<_>>().join("\n"))
            .unwrap();
    };
    seen(&face, "face_seen.csv");
    seen(&joint, "joint_seen.csv");
    let verdict = |name: &str, at: &str| {
        let args = ["validate", name, "bench-pyramid-arc.toml", "--accuracy", "x=1.2 mm", "--offsets-at", at];
        quiet(&args)
    };
    let [face, joint] = [verdict("face_seen.csv", "face"), verdict("joint_seen.csv", "cor")];
    assert_eq!((&face["verdict"], &face["counts"]), (&joint["verdict"], &joint["counts"]));
    assert_eq!(face["verdict"], "inconsistent");
    // `outcome` reads the same table of poses.
    let poses: String = fs::read_to_string(home.path().join("face.csv"))
        .unwrap()
        .lines()
        .map(|line| line.split(',').skip(3).take(4).collect::<Vec<_>>().join(",") + "\n")
        .collect();
    fs::write(home.path().join("poses.csv"), poses).unwrap();
    let printed = run(home.path(), &["outcome", "bench-pyramid-arc.toml", "--poses", "poses.csv"]);
    assert!(printed.starts_with("exit 0"), "{printed}");
}

#[test]
fn requirements_files_and_pictures() {
    let home = home();
    let with = |more: &[&str]| catchment(home.path()).args(BRACKET).args(more).output().unwrap();
    assert_eq!(with(&["--require", "plan.deciding>=10", "-o", "p.json"]).status.code(), Some(0));
    assert_eq!(with(&["--require", "plan.deciding>=100", "-o", "p.csv"]).status.code(), Some(1));
    assert_eq!(with(&["--require", "plan.of>=1", "-o", "q.csv"]).status.code(), Some(2));
    assert_eq!(with(&["--figure", "p.svg"]).status.code(), Some(0));
    // --force applies to pictures as well.
    let again = with(&["--figure", "p.svg"]);
    let printout = String::from_utf8(again.stderr).unwrap();
    assert!(again.status.code() == Some(2) && printout.contains("--force replaces it"), "{printout}");
    assert_eq!(with(&["--figure", "p.svg", "--force"]).status.code(), Some(0));
    assert_eq!(with(&["--figure", "p.svg", "-o", "p.json", "--force"]).status.code(), Some(0));
    assert_eq!(with(&["--force"]).status.code(), Some(2));
    let read = |name: &str| fs::read_to_string(home.path().join(name)).unwrap();
    assert_eq!(serde_json::from_str::<Value>(&read("p.json")).unwrap()["kind"], "plan");
    assert!(read("p.svg").contains("12 trials at 12 poses") && !read("p.svg").contains("NaN"));
    assert!(!home.path().join("q.csv").exists());
    let table = read("p.csv");
    fs::write(home.path().join("t.csv"), filled(&table, 15.0)).unwrap();
    let judged = |more: &[&str]| {
        let args = ["validate", "t.csv", "v.toml", "--accuracy", "x=0.5 mm"];
        catchment(home.path()).args(args).args(more).output().unwrap()
    };
    assert_eq!(judged(&["--require", "consistent>=1", "-o", "v.csv"]).status.code(), Some(1));
    assert_eq!(judged(&["--require", "friction.low>=0", "-o", "w.csv"]).status.code(), Some(2));
    assert_eq!(judged(&["--figure", "v.png", "--limit", "3"]).status.code(), Some(0));
    assert!(
        read("v.csv")
            .starts_with("trial,line,x_mm,predicted,observed,either,disagrees,distance_to_border_mm")
    );
    assert_eq!(read("v.csv").lines().count(), 13);
    assert!(fs::read(home.path().join("v.png")).unwrap().starts_with(b"\x89PNG"));
}
