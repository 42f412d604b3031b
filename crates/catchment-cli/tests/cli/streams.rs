//! Stdin in place of a design, stdout in place of a file, and one rule for replacing existing files.

use super::{catchment, designs, entries, home, piped, run};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

/// The printed output of a command; JSON without its computing time.
fn printed(folder: &Path, line: &str) -> String {
    let output = catchment(folder).args(words(line)).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    match serde_json::from_str::<Value>(&text) {
        Ok(mut report) => {
            report.as_object_mut().unwrap().remove("timing");
            report.to_string()
        }
        Err(_) => text,
    }
}

/// Every command that has a result, with short computations.
const COMMANDS: [&str; 24] = [
    "new pyramid",
    "check v.toml",
    "run v.toml --free x --resolution 6 --samples 0",
    "run v.toml --free x --samples 20 --sensitivity",
    "window v.toml --samples 50",
    "success v.toml --error-sigma x=0.2 --samples 100 --cells 0",
    "trace v.toml --pose x=0.1",
    "trace v.toml --poses p.csv",
    "rests v.toml --samples 50",
    "rests v.toml --jams --samples 50",
    "compare v.toml --methods flood,meyer --resolution 6",
    "sweep v.toml --over cor=0,0.1 --resolution 6 --samples 0",
    "friction v.toml --samples 20 --frictions 0.1",
    "hold v.toml",
    "dynamics v.toml --draw speed=1 --trials 1 --samples 100 --timeout 1",
    "plan v.toml --pattern grid --steps x=3 --repeatability x=0.01",
    "slices v.toml --resolution 5",
    "zraa v.toml",
    "solids v.toml --free x",
    "catalog",
    "classify v.toml",
    "reproduce 2.1",
    "latch --table",
    "schema",
];

#[test]
fn a_minus_after_o_is_stdout() {
    let home = home();
    let folder = home.path();
    fs::write(folder.join("p.csv"), "x\n0.1\n").unwrap();
    for command in COMMANDS {
        assert_eq!(printed(folder, command), printed(folder, &format!("{command} -o -")), "{command}");
        if !["new", "schema"].contains(&words(command)[0]) {
            let json = format!("{command} --json");
            assert_eq!(printed(folder, &json), printed(folder, &format!("{json} -o -")), "{json}");
        }
    }
    assert_eq!(entries(folder), ["p.csv", "v.toml"]);
    // A file with the name `-` needs a folder before it.
    assert!(run(folder, &["schema", "-o", "./-"]).starts_with("exit 0"));
    assert_eq!(entries(folder)[0], "-");
}

#[test]
fn files_that_are_text_go_to_stdout() {
    let home = home();
    let folder = home.path();
    let page = printed(folder, "report v.toml --resolution 6 --leave-out slices,jams,window -o -");
    assert!(page.to_lowercase().starts_with("<!doctype html>"), "{}", &page[..100]);
    assert!(
        run(folder, &["run", "v.toml", "--resolution", "6", "--samples", "0", "-o", "out"])
            .starts_with("exit 0")
    );
    let table = printed(folder, "export out -o -");
    assert!(run(folder, &["export", "out", "-o", "set.csv"]).starts_with("exit 0"));
    assert_eq!(table, fs::read_to_string(folder.join("set.csv")).unwrap());
    let refused = run(folder, &["export", "v.toml", "--pose", "x=0.1", "-o", "-"]);
    assert!(refused.starts_with("exit 2") && refused.contains("a drop test is several files"), "{refused}");
    let meshes = designs().join("meshes");
    let [socket, plug] = ["socket.stl", "plug.stl"].map(|name| meshes.join(name).display().to_string());
    let place = format!("place {socket} {plug} --unit mm --facing-fixed +z --facing-moving +z");
    assert_eq!(printed(folder, &place), printed(folder, &format!("{place} -o -")));
    // Commands cannot read stdout back.
    assert!(!run(folder, &words(&format!("{place} -o -"))).contains("next:"));
}

#[test]
fn a_minus_in_place_of_a_design_is_stdin() {
    let home = home();
    let folder = home.path();
    let design = "name = \"face\"\n".to_owned() + super::V_FACE;
    fs::write(folder.join("named.toml"), &design).unwrap();
    for command in [
        "check - --json",
        "run - --resolution 6 --samples 50 --json",
        "window - --samples 50 --json",
        "trace - --pose x=0.1 --json",
        "rests - --samples 50 --json",
        "compare - --methods descent,flood --resolution 6",
        "compare - named.toml --resolution 6",
        "sweep - --over cor=0,0.1 --resolution 6 --samples 0 --json",
        "zraa - --json",
        "catalog --append -",
        "friction - --samples 20 --frictions 0.1 --json",
    ] {
        let output = piped(folder, design.as_bytes(), &words(command));
        assert_eq!(output.status.code(), Some(0), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        let of = |text: &str| match serde_json::from_str::<Value>(text) {
            Ok(mut report) => {
                report["timing"].take();
                // `check` names the file.
                report["file"].take();
                report.to_string()
            }
            Err(_) => text.replace("named.toml", "-").replace("stdin", "-"),
        };
        let named = words(command).into_iter().map(|word| if word == "-" { "named.toml" } else { word });
        let by_file = catchment(folder).args(named).output().unwrap();
        let [piped, by_file] =
            [output.stdout, by_file.stdout].map(|bytes| of(&String::from_utf8(bytes).unwrap()));
        assert_eq!(piped, by_file, "{command}");
    }
    // Stdin is consumed: a next command could not read the design.
    let output = piped(folder, design.as_bytes(), &["check", "-"]);
    assert!(!String::from_utf8_lossy(&output.stderr).contains("next:"));
}

#[test]
fn meshes_of_a_design_from_stdin_lie_in_the_current_folder() {
    let design = fs::read(designs().join("pyramid-stl.toml")).unwrap();
    let output = piped(&designs(), &design, &["check", "-"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn errors_in_stdin_name_stdin() {
    let home = home();
    let large = vec![b'#'; (4 << 20) + 1];
    for (stdin, says) in [
        (&b""[..], "stdin is empty"),
        (b"[connector]\nfamily = \"v-fase\"\n", "stdin:2:10"),
        (b"\xff\xfe", "stdin is not a text file"),
        (&large, "stdin is larger than 4 MiB"),
    ] {
        let output = piped(home.path(), stdin, &["check", "-"]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(4) && message.contains(says), "{says}: {message}");
    }
    let output = piped(home.path(), super::V_FACE.as_bytes(), &["trace", "-", "--poses", "-"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && message.contains("stdin is read once"), "{message}");
}

/// With --force every command replaces a file; without it a command replaces only a folder that catchment wrote.
#[test]
fn existing_files_are_replaced_only_with_force() {
    let home = home();
    let folder = home.path();
    let quick = "run v.toml --free x --resolution 6 --samples 0";
    assert!(run(folder, &words("run v.toml --resolution 4 --samples 0 -o out")).starts_with("exit 0"));
    for command in [
        "new pyramid -o n.toml".to_owned(),
        "schema -o s.json".to_owned(),
        "check v.toml -o pair.svg".to_owned(),
        format!("{quick} -o r.json"),
        "run v.toml --resolution 4 --samples 0 -o r.vti".to_owned(),
        format!("{quick} -o r.csv"),
        "run v.toml --samples 20 --sensitivity -o sensitivity.json".to_owned(),
        "run v.toml --free x --method all --resolution 3 --samples 0 --time-limit 20ms -o methods.md"
            .to_owned(),
        "trace v.toml --pose x=0.1 -o t.png".to_owned(),
        "trace v.toml --pose x=0.1 -o t.vtp".to_owned(),
        "zraa v.toml -o z.svg --figure y.png".to_owned(),
        "catalog -o c.svg".to_owned(),
        "catalog design polybot -o polybot.toml".to_owned(),
        "export out -o set.vtp".to_owned(),
        "report out -o page.html".to_owned(),
        "solids v.toml --free x -o shape.obj".to_owned(),
    ] {
        assert!(run(folder, &words(&command)).starts_with("exit 0"), "{command}");
        let again = run(folder, &words(&command));
        assert!(again.starts_with("exit 2") && again.contains("--force replaces it"), "{command}: {again}");
        let forced = run(folder, &words(&format!("{command} --force")));
        assert!(forced.starts_with("exit 0"), "{command}: {forced}");
    }
    fs::create_dir(folder.join("mine")).unwrap();
    fs::write(folder.join("mine/notes.txt"), "mine").unwrap();
    fs::write(folder.join("l.toml"), "[latch]\n").unwrap();
    for (command, place) in [
        (quick.to_owned(), "whole"),
        (quick.to_owned(), "a.zarr"),
        ("slices v.toml --resolution 5".to_owned(), "slices"),
        ("export v.toml --pose x=0.1".to_owned(), "trial"),
        ("latch l.toml".to_owned(), "latch"),
    ] {
        for force in ["", "", " --force"] {
            let printout = run(folder, &words(&format!("{command} -o {place}{force}")));
            assert!(printout.starts_with("exit 0"), "{command}{force}: {printout}");
        }
        let printout = run(folder, &words(&format!("{command} -o mine --force")));
        assert!(
            printout.starts_with("exit 2") && printout.contains("not a catchment result"),
            "{command}: {printout}"
        );
    }
    assert_eq!(fs::read(folder.join("mine/notes.txt")).unwrap(), b"mine");
}
