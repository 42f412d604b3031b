//! Help, completions, manual pages, schema, and a reader that closes the pipe.

use super::{catchment, run};
use std::path::Path;
use std::process::Stdio;

#[test]
fn help_is_data_and_usage_errors_are_not() {
    let dir = tempfile::tempdir().unwrap();
    insta::assert_snapshot!("help", run(dir.path(), &["--help"]));
    insta::assert_snapshot!("check_short_help", run(dir.path(), &["check", "-h"]));
    insta::assert_snapshot!("unknown_subcommand", run(dir.path(), &["chekc"]));
    assert!(run(dir.path(), &[]).starts_with("exit 2\n--- stdout\n--- stderr\n"));
}

#[test]
fn scripts_and_pages_are_written_for_every_shell_and_subcommand() {
    let dir = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let report = run(dir.path(), &["completions", shell]);
        assert!(report.starts_with("exit 0\n") && report.contains("check"), "{report}");
    }
    for subcommand in
        ["new", "check", "run", "outcome", "trace", "zraa", "reproduce", "schema", "completions", "man"]
    {
        let report = run(dir.path(), &["man", subcommand]);
        assert!(report.contains(&format!(".TH catchment-{subcommand}")), "{report}");
    }
    assert!(run(dir.path(), &["man"]).contains(".TH catchment"));
    insta::assert_snapshot!("man_of_nothing", run(dir.path(), &["man", "of-the-year"]));
}

#[test]
fn the_schema_is_the_committed_one() {
    let designs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs");
    let printed = catchment(&designs).arg("schema").output().unwrap().stdout;
    let committed = std::fs::read(designs.join("schema.json")).unwrap();
    assert!(printed == committed, "run `catchment schema -o designs/schema.json --force`");
}

/// `catchment schema | head -0` ends quietly.
#[test]
fn a_broken_pipe_is_quiet() {
    for args in [&["schema"][..], &["--help"], &["completions", "bash"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = catchment(Path::new("."))
            .args(args)
            .stdout(Stdio::from(writer))
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
            .wait_with_output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "", "{args:?}");
    }
}
