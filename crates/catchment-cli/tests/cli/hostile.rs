//! Names that would steer a terminal, through every command that repeats them.

use crate::{V_FACE, catchment, entries};
use std::ffi::OsStr;
use std::fs;
use std::path::Path;

/// Clears a screen, by both kinds of controls, and turns the direction of writing.
const NAME: &str = "a\u{1b}[2J\u{9b}2J\u{202e}b";

/// Whether a text could steer a terminal.
fn steers(text: &str) -> bool {
    text.chars().any(|c| {
        c.is_control() && c != '\n'
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    })
}

/// A folder with a design, poses and a stored result under names that steer.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    // Controls are refused in the name of a design; what turns the direction of writing is not.
    let name = r#"name = "a\u202e\u2066b""#;
    let path = |ending: &str| home.path().join(format!("{NAME}{ending}"));
    fs::write(path(".toml"), format!("{name}\n{V_FACE}")).unwrap();
    fs::write(path(".csv"), "x,pitch_deg\n0.1,5\n").unwrap();
    fs::write(path(".bad"), format!("{V_FACE}{NAME} = 1\n")).unwrap();
    // A return to the start of a line would write over it; at the end of a line it is one of Windows.
    fs::write(path(".back"), format!("{}width = 1\rowned = 1\r\n", V_FACE.replace('\n', "\r\n"))).unwrap();
    fs::write(path("back.csv"), "x,pitch\r\n0,1\r9\r\n0,a\r\r\n1,b\r\n").unwrap();
    fs::write(path("bad.csv"), format!("x,{NAME}\n0,{NAME}\nx{NAME},1\n")).unwrap();
    fs::create_dir(path(".empty")).unwrap();
    home
}

fn said(home: &Path, args: &[&str]) -> (Option<i32>, String) {
    let args = args.iter().map(|arg| arg.replace('@', NAME));
    let output = catchment(home).args(args).output().unwrap();
    let text =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    (output.status.code(), text)
}

#[test]
fn names_that_steer_a_terminal_reach_none() {
    let home = home();
    let few = ["--method", "flood", "--resolution", "5"];
    let run = |more: &[&'static str]| [&["run", "@.toml"], &few[..], more].concat();
    let good: [Vec<&str>; 19] = [
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
    ];
    for args in good {
        let (code, text) = said(home.path(), &args);
        assert_eq!(code, Some(0), "{args:?}: {text}");
        assert!(!steers(&text), "{args:?}: {text:?}");
    }
    let bad: [&[&str]; 19] = [
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
    ];
    for args in bad {
        let (code, text) = said(home.path(), args);
        assert_eq!(code, Some(2), "{args:?}: {text}");
        assert!(!text.is_empty() && !steers(&text), "{args:?}: {text:?}");
    }
}

#[test]
fn pictures_and_models_of_a_design_whose_name_steers_are_well_formed() {
    let home = home();
    said(home.path(), &["run", "@.toml", "--method", "flood", "--resolution", "5", "-o", "out"]);
    said(home.path(), &["export", "@.toml", "--pose", "x=0.1", "-o", "trial"]);
    let mut seen = 0;
    for folder in ["out", "trial"] {
        for name in entries(&home.path().join(folder)) {
            if ["svg", "xml", "sdf"]
                .iter()
                .any(|ending| Path::new(&name).extension() == Some(OsStr::new(ending)))
            {
                let text = fs::read_to_string(home.path().join(folder).join(&name)).unwrap();
                // XML 1.0 has no form for these, not even an escaped one.
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
