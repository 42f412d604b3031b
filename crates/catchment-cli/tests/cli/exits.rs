//! Every exit code, as the help lists them.

use super::{catchment, home, run};
use std::fs;

/// The meaning of each code; 130 and 143 are tested where signals are (`kills`, `poses`, `sweep`).
#[test]
fn every_way_to_end_has_a_code_of_its_own() {
    let home = home();
    fs::write(home.path().join("bad.toml"), "[connector]\nfamily = \"v-fase\"\n").unwrap();
    fs::write(home.path().join("bad.csv"), "x\nfar\n").unwrap();
    let fast = "--resolution 6 --samples 0";
    for (code, line) in [
        (0, format!("run v.toml {fast}")),
        (0, "--help".to_owned()),
        (1, format!("run v.toml {fast} --require onaa.edge>=1")),
        // The command line is invalid, whatever the files contain.
        (2, "chekc v.toml".to_owned()),
        (2, "run v.toml --paint".to_owned()),
        (2, format!("run v.toml {fast} --require nothing>=1")),
        (2, "run v.toml --resolution yaw=4".to_owned()),
        (2, "run v.toml --cor far".to_owned()),
        (2, "run v.toml --cor 1e6".to_owned()),
        (2, "success v.toml --error-sigma x=0.1 --samples 10".to_owned()),
        (2, "new pyramid -o v.toml".to_owned()),
        (2, "run v.toml -o no/such/folder".to_owned()),
        (2, "catalog show Voyager".to_owned()),
        // A named file does not exist.
        (3, "run none.toml".to_owned()),
        (3, "check .".to_owned()),
        (3, "trace v.toml --poses none.csv".to_owned()),
        (3, "compare v.toml none.toml".to_owned()),
        (3, "place none.stl nor.stl".to_owned()),
        // A file exists but has invalid content.
        (4, "run bad.toml".to_owned()),
        (4, "check bad.toml --json".to_owned()),
        (4, "trace v.toml --poses bad.csv".to_owned()),
        (4, "export . -o set.csv".to_owned()),
        // All inputs are valid, yet there is no result.
        (5, "run v.toml --resolution 200 --memory 1kB".to_owned()),
        (5, "hold v.toml --pose x=0.999".to_owned()),
        (5, "trace v.toml --pose x=5 -o t.glb".to_owned()),
    ] {
        let printed = run(home.path(), &line.split(' ').collect::<Vec<_>>());
        assert!(printed.starts_with(&format!("exit {code}\n")), "{line}: {printed}");
    }
    let help = run(home.path(), &["--help"]);
    let codes = help.split("Exit codes:").nth(1).unwrap();
    for code in [
        "0  done",
        "1  done, but",
        "2  usage",
        "3  no such file",
        "4  bad input",
        "5  could not",
        "130  ",
        "143  ",
    ] {
        assert!(codes.contains(code), "{code}: {help}");
    }
}

/// A write error on stdout is not a command-line error.
#[cfg(target_os = "linux")]
#[test]
fn a_full_stdout_is_a_result_that_cannot_be_written() {
    let home = home();
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    for args in [&["schema"][..], &["--help"], &["check", "v.toml"]] {
        let status =
            catchment(home.path()).args(args).stdout(full()).stderr(std::process::Stdio::null()).status();
        assert_eq!(status.unwrap().code(), Some(5), "{args:?}");
    }
}
