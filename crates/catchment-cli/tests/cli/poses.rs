//! `catchment outcome` and `catchment trace`.

use super::{catchment, designs, json, piped, run};
use std::fs;
use std::process::Stdio;

const TABLE: &str = "\
part,pitch_deg,x_mm,y_in
A1,0,0,0
A2,10,5,-0.1
\"A3, bent\",-60,20,0
A4,0,90,0
";

/// Runs `outcome` on a table from stdin.
fn outcome(table: &str, args: &[&str]) -> std::process::Output {
    piped(&designs(), table.as_bytes(), &[&["outcome", "pyramid-stl.toml", "--poses", "-"], args].concat())
}

/// The cells of a table.
fn cells(csv: &[u8]) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(csv);
    reader.records().map(|r| r.unwrap().iter().map(ToOwned::to_owned).collect()).collect()
}

#[test]
fn poses_with_units_come_back_with_their_outcomes() {
    let output = outcome(TABLE, &[]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert!(stderr.starts_with("4 poses: "), "{stderr}");
    let table = cells(&output.stdout);
    let added = [
        "outcome",
        "final_x_mm",
        "final_y_in",
        "final_roll",
        "final_pitch_deg",
        "final_yaw",
        "final_height",
        "contacts",
    ];
    assert_eq!(table[0][..4], ["part", "pitch_deg", "x_mm", "y_in"]);
    assert_eq!(table[0][4..], added);
    assert_eq!(table[3][0], "A3, bent");
    let outcomes: Vec<&str> = table[1..].iter().map(|row| row[4].as_str()).collect();
    assert_eq!([outcomes[0], outcomes[1], outcomes[3]], ["aligned", "aligned", "missed"]);
    // Aligned means within 0.02 D = 1 mm.
    assert!(table[2][5].parse::<f64>().unwrap().abs() < 1.0);
    // The COR of an aligned pyramid is D/2 below the middle of its face, which lies on all four sides; a missed pose has no contact.
    assert!((table[2][10].parse::<f64>().unwrap() + 0.5).abs() < 0.01, "{table:?}");
    assert_eq!(table[2][11], "slope of 45° on slope of 45°");
    assert_eq!(table[4][10..], ["", ""]);
    // A half that never makes contact keeps its place.
    assert!((table[4][5].parse::<f64>().unwrap() - 90.0).abs() < 1e-9);
}

/// In the valley of a pyramid of AR ½, Coulomb's law leaves stiction undetermined from 0.577 to 0.612.
#[test]
fn with_friction_a_column_marks_possible_stiction() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("poses.csv"), "x,y\n0.2,0.2\n0.05,0\n").unwrap();
    let design = designs().join("pyramid.toml").display().to_string();
    let table = |friction: &str, more: &[&str]| {
        let args = ["outcome", &design, "--poses", "poses.csv", "--friction", friction];
        let output = catchment(home.path()).args(args).args(more).output().unwrap();
        assert_eq!(output.status.code(), Some(0));
        (output.stdout, String::from_utf8(output.stderr).unwrap())
    };
    let (csv, printout) = table("0.59", &[]);
    let rows = cells(&csv);
    let column = rows[0].iter().position(|name| name == "may_stick").unwrap();
    assert_eq!((rows[1][2].as_str(), rows[1][column].as_str()), ("aligned", "yes"));
    assert!(
        printout.contains("came by a place where Coulomb's law would let them stick as well"),
        "{printout}"
    );
    let report: serde_json::Value = serde_json::from_slice(&table("0.59", &["--json"]).0).unwrap();
    assert_eq!(report["poses"][0]["may_stick"], true);
    assert_eq!(cells(&table("0.5", &[]).0)[1][column], "no");
    assert!(!cells(&table("0", &[]).0)[0].contains(&"may_stick".to_owned()));
}

#[test]
fn the_same_poses_as_json_for_any_number_of_threads() {
    let [one, two] = ["1", "2"].map(|threads| outcome(TABLE, &["--json", "--threads", threads]).stdout);
    assert_eq!(one, two);
    let report: serde_json::Value = serde_json::from_slice(&one).unwrap();
    assert_eq!(report["method"], "descent");
    assert_eq!(report["poses"][2]["carried"]["part"], "A3, bent");
    // 5 mm of 50: one multiplication and one division.
    assert!((report["poses"][1]["error"]["x"].as_f64().unwrap() - 0.1).abs() < 1e-15);
    assert!(report["counts"]["aligned"].as_u64().unwrap() >= 2);
}

#[test]
fn all_errors_of_a_table_are_reported_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let table = "x,Pitch,rol,y_ft,x_mm,outcome\n0,0,0\n0.1,0,0,0,nan,0\n-5 mm,0,0,0,0,0\n";
    fs::write(dir.path().join("poses.csv"), table).unwrap();
    let design = designs().join("pyramid.toml");
    let report = |more: &[&str]| {
        let mut args = vec!["outcome", design.to_str().unwrap(), "--poses", "poses.csv", "-o", "out.csv"];
        args.extend(more);
        run(dir.path(), &args)
    };
    insta::assert_snapshot!("outcome_bad_header", report(&[]));
    fs::write(dir.path().join("poses.csv"), "x,pitch\n1,2,3\n,inf\n0.1,30\n0.1,0.2\n1 mm,0\n").unwrap();
    insta::assert_snapshot!("outcome_bad_rows", report(&["--free", "x,yaw"]));
    fs::write(dir.path().join("poses.csv"), "0.1,0.2\n0.3,0.4\n").unwrap();
    insta::assert_snapshot!("outcome_no_header", report(&[]));
    for (content, printout) in [
        (&b""[..], "the table is empty"),
        (b"x,pitch\n", "the table has no rows"),
        (b"x;pitch\n0,1;0,2\n", "separate the columns with commas"),
        (b"x\n\xff\xfe\n", "line 2: not UTF-8 text"),
    ] {
        fs::write(dir.path().join("poses.csv"), content).unwrap();
        let report = report(&[]);
        assert!(
            report.starts_with("exit 4\n--- stdout\n--- stderr\n") && report.contains(printout),
            "{report}"
        );
    }
    // A sparse file takes no disk space; the program refuses it at the limit, without reading to its end.
    fs::File::create(dir.path().join("poses.csv")).unwrap().set_len(8 << 30).unwrap();
    assert!(report(&[]).contains("poses.csv is larger than 64 MiB"));
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
}

#[test]
fn a_trace_reports_the_whole_trajectory() {
    let folder = designs();
    let pose = ["trace", "pyramid-stl.toml", "--pose", "x=8 mm,pitch=10 deg"];
    let report = json(&folder, &[&pose[..], &["--json"]].concat());
    assert_eq!((&report["outcome"], &report["method"]), (&"aligned".into(), &"descent".into()));
    let waypoints = report["waypoints"].as_array().unwrap();
    let heights: Vec<f64> = waypoints.iter().map(|w| w["height_d"].as_f64().unwrap()).collect();
    // A pushed half never rises; heights are rounded to 1e-12 D.
    assert!(heights.len() > 5 && heights.windows(2).all(|w| w[1] <= w[0] + 1e-9), "{heights:?}");
    assert!(waypoints.iter().all(|w| !w["touches"].as_array().unwrap().is_empty()));
    assert!((waypoints[0]["error"]["x"].as_f64().unwrap() - 0.16).abs() < 1e-12);
    let text = run(&folder, &pose);
    assert!(text.starts_with("exit 0\n") && text.contains("x [mm]"), "{text}");
    assert!(text.contains("  outcome        docked\n"), "{text}");
    assert!(text.ends_with("--- stderr\nnext: catchment rests pyramid-stl.toml --jams\n"), "{text}");
    // Each printed line is one of the waypoints; at most a screenful is printed.
    assert!(text.lines().count() < 40, "{text}");
}

#[test]
fn a_trace_is_drawn_and_written() {
    let dir = tempfile::tempdir().unwrap();
    let design = designs().join("x-face.toml");
    let with = |file: &str| {
        run(dir.path(), &["trace", design.to_str().unwrap(), "--pose", "x=0.3,pitch=-0.2", "-o", file])
    };
    for file in ["a.png", "a.svg", "a.csv", "a.json"] {
        assert!(with(file).starts_with("exit 0\n"), "{}", with(file));
    }
    let read = |file: &str| fs::read(dir.path().join(file)).unwrap();
    assert!(read("a.png").starts_with(b"\x89PNG"));
    assert!(read("a.svg").starts_with(b"<svg"));
    let report: serde_json::Value = serde_json::from_slice(&read("a.json")).unwrap();
    let touches: usize = report["waypoints"]
        .as_array()
        .unwrap()
        .iter()
        .map(|w| w["touches"].as_array().unwrap().len().max(1))
        .sum();
    assert_eq!(cells(&read("a.csv")).len(), 1 + touches);
}

#[test]
fn all_errors_of_a_pose_are_reported_at_once() {
    let pose = "x=0.1,pich=3,yaw=0.2,pitch=400 deg,x=2,y,roll=1 mm";
    insta::assert_snapshot!("trace_bad_pose", run(&designs(), &["trace", "v-face.toml", "--pose", pose]));
}

#[test]
fn drop_tests_decide_poses_and_friction_counts() {
    let table = "x_mm,yaw_deg\n5,0\n-10,8\n40,40\n";
    let outcomes = |args: &[&str]| -> Vec<String> {
        let output = outcome(table, args);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        cells(&output.stdout)[1..].iter().map(|row| row[2].clone()).collect()
    };
    assert_eq!(outcomes(&["--method", "drop"]), outcomes(&[]));
    assert_eq!(outcomes(&["--method", "drop", "--friction", "3"])[..2], ["jammed", "jammed"]);
    let [one, two] = ["1", "2"]
        .map(|threads| outcome(table, &["--method", "drop", "--json", "--threads", threads]).stdout);
    assert_eq!(one, two);
    let report: serde_json::Value = serde_json::from_slice(&one).unwrap();
    assert_eq!(report["method"], "drop");
    assert_eq!(report["settings"]["push"]["force"], 5000.0);
}

#[test]
fn settings_of_drop_tests_that_cannot_be() {
    insta::assert_snapshot!(run(
        &designs(),
        &["run", "pyramid.toml", "--method", "flood", "--friction", "0.1"]
    ));
    insta::assert_snapshot!(run(
        &designs(),
        &["slices", "pyramid.toml", "--method", "drop", "--trials", "2"]
    ));
}

#[test]
fn a_drop_test_is_exported_with_all_that_it_needs() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name);
    let design = designs().join("v-face.toml");
    let export = |place: &str| {
        let args = [
            "export",
            design.to_str().unwrap(),
            "--pose",
            "x=0.1,pitch=5 deg",
            "-o",
            place,
            "--friction",
            "0.2",
        ];
        run(dir.path(), &args)
    };
    assert!(export("trial").starts_with("exit 0\n"), "{}", export("trial"));
    let mjcf = fs::read_to_string(path("trial/trial.xml")).unwrap();
    // x, pitch and the approach are free; two pieces make the notch, one the tip.
    assert_eq!(mjcf.matches("<joint").count(), 3);
    assert_eq!(mjcf.matches("<mesh").count(), 3);
    assert!(mjcf.contains("friction=\"0.2 0 0\"") && mjcf.contains("biasprm=\"-5000 0 0\""));
    let sdf = fs::read_to_string(path("trial/trial.sdf")).unwrap();
    assert_eq!(sdf.matches("<joint").count(), 3);
    for mesh in ["fixed-0.stl", "fixed-1.stl", "moving-0.stl"] {
        assert!(sdf.contains(mesh) && path("trial/meshes").join(mesh).is_file(), "{mesh}");
    }
    // It overwrites its own files, but no others.
    assert!(export("trial").starts_with("exit 0\n"));
    fs::create_dir(path("other")).unwrap();
    fs::write(path("other/holiday.png"), "").unwrap();
    assert!(export("other").starts_with("exit 2\n"));
}

#[test]
fn equal_rows_have_equal_outcomes_in_drop_tests() {
    // On the border of the accepted set, where the perturbation determines the outcome.
    let table = "x_mm,yaw_deg\n".to_owned() + &"25,30\n".repeat(12);
    let output = outcome(&table, &["--method", "drop"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let rows = cells(&output.stdout);
    assert!(rows.len() == 13 && rows[2..].iter().all(|row| *row == rows[1]), "{rows:?}");
}

#[test]
fn misspelt_columns_are_refused_and_carried_ones_are_named() {
    for name in ["x mm", "dx", "X_mm", "rol", "delta_x", "x.mm", "x\0"] {
        let output = outcome(&format!("{name},yaw\n9,0\n"), &[]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(4), "{name}: {stderr}");
        assert!(!stderr.contains(['\0', '\u{1b}']), "{stderr:?}");
    }
    // A byte order mark elsewhere than at the start of the file is part of a name.
    let output = outcome("yaw,\u{feff}x_mm\n0,90\n", &[]);
    assert_eq!(output.status.code(), Some(4));
    let ends = ["x_mm", "x [mm]", "x (mm)"].map(|name| {
        let output = outcome(&format!("part,{name},time\nA,90,1\n"), &[]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(stderr.ends_with("carried through: part, time\n"), "{stderr}");
        cells(&output.stdout)[1][3].clone()
    });
    assert_eq!(ends, ["missed", "missed", "missed"]);
}

#[test]
fn offsets_are_measured_at_the_chosen_point() {
    let locked = ["--free", "x,pitch,yaw", "--cor", "0.5"];
    // The face centre lies at cor · sin(yaw) · sin(pitch) beside the locked plane.
    let y = 0.5 * 0.2f64.sin() * 0.3f64.sin();
    let code = |y: f64, at: &str| {
        let table = format!("x,y,pitch,yaw\n0,{y},0.3,0.2\n");
        outcome(&table, &[&locked[..], &["--offsets-at", at]].concat()).status.code()
    };
    assert_eq!([code(y, "face"), code(y + 1e-4, "face")], [Some(0), Some(4)]);
    assert_eq!([code(0.0, "cor"), code(y, "cor")], [Some(0), Some(4)]);
}

/// The output of `outcome` when interrupted once it has decided some of more poses than it can follow by then: after 0.1 s, or twice as long
/// until that suffices.
#[cfg(target_os = "linux")]
fn interrupted(folder: &std::path::Path, args: &[&str], signal: &str) -> std::process::Output {
    let after = |wait: u64| interrupted_after(folder, args, signal, wait);
    let decided = |output: &std::process::Output| {
        !output.stdout.is_empty() || String::from_utf8_lossy(&output.stderr).contains("partial: ")
    };
    (0..6).map(|doubled| after(100 << doubled)).find(decided).expect("a pose is decided within 3 seconds")
}

#[cfg(target_os = "linux")]
fn interrupted_after(
    folder: &std::path::Path,
    args: &[&str],
    signal: &str,
    milliseconds: u64,
) -> std::process::Output {
    let child = catchment(folder)
        .args(["outcome", "v.toml", "--poses", "poses.csv", "--threads", "1"])
        .args(args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Before the handler is installed, the signal ends the process without a code; the handler waits in a thread of
    // its own.
    let tasks = format!("/proc/{}/task", child.id());
    let listens = || {
        let names = fs::read_dir(&tasks)
            .unwrap()
            .filter_map(|task| fs::read_to_string(task.ok()?.path().join("comm")).ok());
        names.into_iter().any(|name| name.trim() == "signals")
    };
    while !listens() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    std::thread::sleep(std::time::Duration::from_millis(milliseconds));
    let pid = child.id().to_string();
    assert!(std::process::Command::new("kill").args([signal, &pid]).status().unwrap().success());
    child.wait_with_output().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn outcomes_before_an_interrupt_are_kept_beside_the_result() {
    use std::fmt::Write;
    const POSES: usize = 300_000;
    let home = super::home();
    let mut table = "name,x,pitch\n".to_owned();
    for k in 0..POSES {
        let x = 0.9 * (k as f64 / POSES as f64) - 0.45;
        writeln!(table, "p{k},{x},{}", 0.3 - x).unwrap();
    }
    fs::write(home.path().join("poses.csv"), &table).unwrap();
    let printout = |output: &std::process::Output| String::from_utf8(output.stderr.clone()).unwrap();

    // Into a file: not at its final place, but beside it.
    let output = interrupted(home.path(), &["-o", "out.csv"], "-INT");
    let stderr = printout(&output);
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.starts_with("interrupted\nwarning: partial: "), "{stderr}");
    assert!(stderr.ends_with("they are in out.csv.partial\n"), "{stderr}");
    assert!(output.stdout.is_empty() && !home.path().join("out.csv").exists());
    let rows = cells(&fs::read(home.path().join("out.csv.partial")).unwrap());
    let finished = rows.len() - 1;
    assert!((1..POSES).contains(&finished), "{finished}");
    let counted =
        format!("partial: {finished} of {POSES} poses are decided, {} are missing", POSES - finished);
    assert!(stderr.contains(&counted), "{stderr}");

    // The rows are a subset of those of the complete output.
    let few: Vec<&Vec<String>> = rows[1..].iter().step_by(finished.div_ceil(20)).collect();
    let again: Vec<String> = few.iter().map(|row| row[..3].join(",")).collect();
    fs::write(home.path().join("few.csv"), format!("name,x,pitch\n{}\n", again.join("\n"))).unwrap();
    let whole = catchment(home.path()).args(["outcome", "v.toml", "--poses", "few.csv"]).output().unwrap();
    assert_eq!(cells(&whole.stdout)[1..].iter().collect::<Vec<_>>(), few);

    // The output of an interrupted run is overwritten only with `--force`.
    let refused = run(home.path(), &["outcome", "v.toml", "--poses", "few.csv", "-o", "out.csv"]);
    assert!(refused.starts_with("exit 2\n") && refused.contains("out.csv.partial"), "{refused}");

    // The JSON printed to stdout states the interruption itself.
    let output = interrupted(home.path(), &["--json"], "-TERM");
    assert_eq!(output.status.code(), Some(143), "{}", printout(&output));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let poses = report["poses"].as_array().unwrap();
    assert_eq!(report["missing"], POSES - poses.len());
    assert!(report["warnings"][0]["message"].as_str().unwrap().starts_with("partial: "));
    let last = poses.last().unwrap();
    let row = last["number"].as_u64().unwrap();
    assert_eq!(last["carried"]["name"], format!("p{row}"));
}

/// The command prints rows while it follows other poses; a reader that closes the pipe ends it quietly.
#[test]
fn rows_are_printed_as_they_are_decided() {
    use std::fmt::Write;
    use std::io::{BufRead, BufReader};
    const POSES: usize = 300_000;
    let home = super::home();
    let mut table = "name,x,pitch\n".to_owned();
    for k in 0..POSES {
        writeln!(table, "p{k},{},0.1", 0.4 - 0.8 * (k as f64 / POSES as f64)).unwrap();
    }
    fs::write(home.path().join("poses.csv"), &table).unwrap();
    let mut child = catchment(home.path())
        .args(["outcome", "v.toml", "--poses", "poses.csv", "--threads", "1"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let first: Vec<String> = lines.by_ref().take(3).map(Result::unwrap).collect();
    assert!(first[0].starts_with("name,x,pitch,outcome,final_x"), "{first:?}");
    assert!(first[1].starts_with("p0,0.4,0.1,aligned,") && first[2].starts_with("p1,"), "{first:?}");
    assert!(child.try_wait().unwrap().is_none(), "all poses were decided before the first was printed");
    drop(lines);
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), b"".as_slice()));
}
