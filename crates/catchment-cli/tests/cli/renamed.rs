//! Old names of commands and options give the same results as the new ones.

use super::{V_FACE, catchment, entries, run};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A folder with two planar designs, the second in millimetres, and a table of poses.
fn home() -> tempfile::TempDir {
    let home = super::home();
    let scaled = V_FACE.replace("aspect_ratio", "width = 50.0\nunit = \"mm\"\naspect_ratio");
    fs::write(home.path().join("mm.toml"), scaled).unwrap();
    fs::write(home.path().join("p.csv"), "x,pitch_deg,part\n0.1,5,a\n0.4,-80,b\n2,0,c\n").unwrap();
    home
}

/// The printed output of a command; JSON without its computing time.
fn printed(home: &Path, line: &str) -> (Option<i32>, String, String) {
    let words = line.split(' ').map(|word| word.replace('_', " "));
    let output = catchment(home).args(words).output().unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    let stdout = match serde_json::from_str::<Value>(&stdout) {
        Ok(mut report) => {
            report.as_object_mut().unwrap().remove("timing");
            report.to_string()
        }
        Err(_) => stdout,
    };
    (output.status.code(), stdout, String::from_utf8(output.stderr).unwrap())
}

/// Within a word, `_` stands for a space.
fn same(old: &str, new: &str) {
    let home = home();
    let (code, stdout, stderr) = printed(home.path(), old);
    assert_eq!(code, Some(0), "{old}: {stderr}");
    assert!(!stdout.is_empty(), "{old}");
    assert_eq!((code, stdout, stderr), printed(home.path(), new), "{old}\n{new}");
}

#[test]
fn outcome_is_trace_of_a_table() {
    for more in
        ["", " --json", " --offsets-at cor", " --method drop --trials 1 --timeout 1", " --friction 0.2"]
    {
        let [old, new] = ["outcome", "trace"].map(|verb| format!("{verb} v.toml --poses p.csv{more}"));
        same(&old, &new);
    }
    // Both write the table into the file of -o and print nothing.
    let home = home();
    for (verb, file) in [("outcome", "a.csv"), ("trace", "b.csv")] {
        let printout = run(home.path(), &[verb, "v.toml", "--poses", "p.csv", "-o", file]);
        assert!(printout.starts_with("exit 0\n--- stdout\n--- stderr\n3 poses: "), "{printout}");
    }
    let read = |file: &str| fs::read_to_string(home.path().join(file)).unwrap();
    assert_eq!(read("a.csv"), read("b.csv"));
    assert!(run(home.path(), &["trace", "v.toml", "--poses", "p.csv", "-o", "c.json"]).starts_with("exit 0"));
    assert!(read("c.json").contains("\"kind\": \"outcome\""));
}

#[test]
fn options_unsupported_by_a_pose_table_are_refused() {
    let home = home();
    let table = ["trace", "v.toml", "--poses", "p.csv"];
    for (more, why) in [
        (&["--pose", "x=0.1"][..], "cannot be used with"),
        (&["-o", "t.png"], "no picture"),
        (&["-o", "t.glb"], "no picture"),
        (&["--figure", "t.svg"], "no picture"),
        (&["--require", "x>0"], "--require is about one result"),
        (&["--method", "kinematic"], "of one pose"),
        (&["--force"], "none is to be written"),
    ] {
        let printout = run(home.path(), &[&table[..], more].concat());
        assert!(!printout.starts_with("exit 0") && printout.contains(why), "{more:?}: {printout}");
    }
    let printout = run(home.path(), &["trace", "v.toml"]);
    assert!(printout.contains("<--pose <ERRORS>|--poses <FILE>>"), "{printout}");
    assert_eq!(entries(home.path()), ["mm.toml", "p.csv", "v.toml"]);
}

#[test]
fn jams_is_rests_with_jams() {
    for more in ["", " --json", " --csv", " --friction 0.1", " --error-sigma x=0.2"] {
        let [old, new] = ["jams", "rests --jams"].map(|verb| format!("{verb} v.toml --motions 200{more}"));
        same(&old, &new);
    }
    let home = home();
    let printout = run(home.path(), &["rests", "v.toml", "--friction", "0.1"]);
    assert!(printout.contains("--jams"), "{printout}");
}

#[test]
fn chance_is_dynamics() {
    let base = "v.toml --draw speed=1 --trials 1 --timeout 1";
    for more in ["", " --json", " --pose x=0.1"] {
        same(&format!("chance {base}{more} --overall 100"), &format!("dynamics {base}{more} --overall 100"));
    }
}

#[test]
fn accuracy_is_repeatability() {
    let plan = "plan mm.toml --pattern bracket --trials 12";
    same(&format!("{plan} --accuracy x=0.5_mm"), &format!("{plan} --repeatability x=0.5_mm"));
    let home = home();
    let table = printed(home.path(), &format!("{plan} --csv --repeatability x=0.5_mm")).1;
    // The last columns are outcome and notes.
    let tried = table.replace(",,\n", ",aligned,\n");
    fs::write(home.path().join("tried.csv"), tried).unwrap();
    let judged =
        |option: &str| printed(home.path(), &format!("validate tried.csv mm.toml --{option} x=0.5_mm"));
    assert_eq!(judged("accuracy"), judged("repeatability"));
    assert_eq!(judged("accuracy").0, Some(0), "{}", judged("accuracy").2);
    assert!(judged("sharpness").2.contains("--sharpness"));
}

#[test]
fn old_options_are_the_new_ones() {
    for (command, old, new) in [
        ("friction v.toml --frictions 0.2", "--motions 50", "--samples 50"),
        ("rests v.toml --examine 0", "--motions 50", "--samples 50"),
        ("window v.toml", "--motions 50", "--samples 50"),
        ("success v.toml --error-sigma x=0.2", "--motions 100 --cells 4", "--samples 100 --resolution 4"),
        ("success v.toml --error-sigma x=0.2 --motions 100", "--required 0.9", "--target 0.9"),
        ("run v.toml --resolution 6 --samples 0", "--motions 5", "--max-motions 5"),
        ("run v.toml --resolution 6 --samples 0", "--rotation-length 0.5", "--rho 0.5"),
        ("dynamics v.toml --draw speed=1 --trials 1", "--overall 100", "--samples 100"),
        (
            "dynamics v.toml --draw speed=1 --trials 1 --map x,pitch --timeout 1",
            "--cells 2",
            "--resolution 2",
        ),
        (
            "plan v.toml --pattern bracket --trials 8 --repeatability x=0.01",
            "--resolution x=0.05",
            "--margin x=0.05",
        ),
    ] {
        same(&format!("{command} {old} --json"), &format!("{command} {new} --json"));
    }
    let systems = super::designs().join("systems");
    let chain = |option: &str| printed(&systems, &format!("chain chain.toml --{option} 20 --json"));
    assert_eq!(chain("chains"), chain("samples"));
    let home = home();
    for (option, file) in [("figure", "a.svg"), ("plot", "b.svg")] {
        assert_eq!(printed(home.path(), &format!("catalog --{option} 4.2 -o {file}")).0, Some(0));
    }
    let read = |file: &str| fs::read(home.path().join(file)).unwrap();
    assert_eq!(read("a.svg"), read("b.svg"));
}

#[test]
fn old_names_have_help_and_pages() {
    let home = home();
    for (old, new) in [("outcome", "trace --poses"), ("jams", "rests --jams"), ("chance", "dynamics")] {
        let help = run(home.path(), &["help", old]);
        assert!(help.starts_with("exit 0") && help.contains(new), "{help}");
        let page = run(home.path(), &["man", old]).replace("\\-", "-");
        assert!(page.starts_with("exit 0") && page.contains(new), "{page}");
        // Help does not list them.
        assert!(!run(home.path(), &["--help"]).contains(&format!("\n  {old} ")), "{old}");
    }
}
