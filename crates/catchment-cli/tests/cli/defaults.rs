//! User defaults, from the environment and from a file in the home folder.

use super::{catchment, designs, home, run};
use std::fs;
use std::path::Path;
use std::process::Output;

/// A folder with a design and this file of defaults, which also serves as home.
fn home_with(config: &str) -> tempfile::TempDir {
    let home = home();
    fs::create_dir_all(home.path().join(".config/catchment")).unwrap();
    fs::write(home.path().join(".config/catchment/config.toml"), config).unwrap();
    home
}

/// Runs the binary with these variables and with a home.
fn with(home: &Path, variables: &[(&str, &str)], args: &[&str]) -> Output {
    let mut command = catchment(home);
    command.env_remove("NO_COLOR").env("HOME", home).envs(variables.iter().copied());
    command.args(args).output().unwrap()
}

fn printout(output: &Output) -> (Option<i32>, String, String) {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn the_command_line_precedes_the_environment_and_that_the_file() {
    let threads = |config: &str, variables: &[(&str, &str)], more: &[&str]| {
        let home = home_with(config);
        let args = ["friction", "v.toml", "--samples", "10", "--frictions", "0.1", "--json"];
        let output = with(home.path(), variables, &[&args[..], more].concat());
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        report["timing"]["threads"].as_u64().unwrap()
    };
    let variable = [("CATCHMENT_THREADS", "3")];
    assert_eq!(threads("threads = 2", &[], &[]), 2);
    assert_eq!(threads("threads = 2", &variable, &[]), 3);
    assert_eq!(threads("threads = 2", &variable, &["--threads", "5"]), 5);
    // An empty variable counts as unset.
    assert_eq!(threads("threads = \"2\"", &[("CATCHMENT_THREADS", "")], &[]), 2);
}

#[test]
fn the_folder_of_the_specification_precedes_that_of_the_home() {
    let home = home_with("color = \"always\"");
    let other = tempfile::tempdir().unwrap();
    fs::create_dir(other.path().join("catchment")).unwrap();
    fs::write(other.path().join("catchment/config.toml"), "color = \"pink\"").unwrap();
    let xdg = [("XDG_CONFIG_HOME", other.path().to_str().unwrap())];
    let (code, _, stderr) = printout(&with(home.path(), &xdg, &["check", "v.toml"]));
    assert!(code == Some(2) && stderr.contains("catchment/config.toml:1:"), "{stderr}");
    // A missing file sets nothing.
    fs::remove_file(other.path().join("catchment/config.toml")).unwrap();
    assert_eq!(printout(&with(home.path(), &xdg, &["check", "v.toml"])).0, Some(0));
}

#[test]
fn memory_has_a_default() {
    let home = home_with("memory = \"1 kB\"");
    let args = ["run", "v.toml", "--resolution", "100"];
    let (code, _, stderr) = printout(&with(home.path(), &[], &args));
    assert!(code != Some(0) && stderr.contains("--memory"), "{stderr}");
    let larger = [&args[..], &["--memory", "1 GiB"]].concat();
    assert_eq!(printout(&with(home.path(), &[], &larger)).0, Some(0));
    assert_eq!(printout(&with(home.path(), &[("CATCHMENT_MEMORY", "1 GiB")], &args)).0, Some(0));
}

#[test]
fn colours_have_a_default() {
    let home = home_with("color = \"always\"");
    let coloured = |variables: &[(&str, &str)], args: &[&str]| {
        let (_, stdout, stderr) = printout(&with(home.path(), variables, args));
        (stdout.contains('\u{1b}'), stderr.contains('\u{1b}'))
    };
    let (good, bad) = (["check", "v.toml"], ["check", "none.toml"]);
    assert_eq!((coloured(&[], &good).0, coloured(&[], &bad).1), (true, true));
    assert!(coloured(&[], &["--help"]).0 && coloured(&[], &["check"]).1);
    // Precedence, rising: the file, NO_COLOR, the program's own variable, the option.
    assert!(!coloured(&[("NO_COLOR", "1")], &good).0);
    assert!(coloured(&[("NO_COLOR", "1"), ("CATCHMENT_COLOR", "always")], &good).0);
    let never = ["check", "v.toml", "--color", "never"];
    assert!(!coloured(&[("CATCHMENT_COLOR", "always")], &never).0);
    assert!(!coloured(&[], &["--color", "never", "--help"]).0);
    assert!(!coloured(&[("CATCHMENT_COLOR", "never")], &bad).1);
}

/// The default unit applies where the files need it, is reported, and changes nothing else.
#[test]
fn raw_files_have_a_default_unit() {
    let home = home_with("unit = \"mm\"");
    let meshes = designs().join("meshes");
    let [socket, plug] = ["socket.stl", "plug.stl"].map(|name| meshes.join(name).display().to_string());
    let place = |variables: &[(&str, &str)], more: &[&str]| {
        printout(&with(
            home.path(),
            variables,
            &[&["place", &socket, &plug, "--facing-fixed=+z", "--facing-moving=+z"], more].concat(),
        ))
    };
    let (code, design, stderr) = place(&[], &[]);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stderr.contains("note: unit mm, from ") && stderr.contains("config.toml"), "{stderr}");
    let given = place(&[], &["--unit", "mm"]);
    assert_eq!((given.0, &given.1), (Some(0), &design));
    assert!(!given.2.contains("note: unit"), "{}", given.2);
    let (_, inches, stderr) = place(&[("CATCHMENT_UNIT", "in")], &[]);
    assert!(stderr.contains("note: unit in, from CATCHMENT_UNIT"), "{stderr}");
    assert_ne!(inches, design);
}

#[test]
fn a_bad_default_is_refused_with_its_source() {
    let plain = home_with("");
    for (name, value, why) in [
        ("CATCHMENT_THREADS", "many", "a number of threads is"),
        ("CATCHMENT_THREADS", "1025", "a number of threads is"),
        ("CATCHMENT_MEMORY", "much", "a size is a positive number"),
        ("CATCHMENT_UNIT", "furlong", "a unit is one of"),
        ("CATCHMENT_COLOR", "pink", "auto, always or never"),
    ] {
        // Even a command that does not use the setting refuses it.
        let (code, stdout, stderr) = printout(&with(plain.path(), &[(name, value)], &["schema"]));
        assert!(code == Some(2) && stdout.is_empty(), "{name}");
        assert!(stderr.contains(&format!("{name}=\"{value}\"")) && stderr.contains(why), "{stderr}");
    }
    let wrong = home_with("threads = 4\nthread = 2\nmemory = \"much\"\n");
    let (code, stdout, stderr) = printout(&with(wrong.path(), &[], &["schema"]));
    assert!(code == Some(2) && stdout.is_empty(), "{stderr}");
    for part in ["config.toml:2:1", "did you mean `threads`?", "config.toml:3:10", "2 problems in"] {
        assert!(stderr.contains(part), "{part}: {stderr}");
    }
    // Help works nevertheless.
    let (code, stdout, _) = printout(&with(wrong.path(), &[], &["--help"]));
    assert!(code == Some(0) && stdout.contains("CATCHMENT_THREADS"));
    // The message contains no terminal control characters.
    let steering = home_with("\"a\\u001b[2J\" = 1\n");
    let (_, _, stderr) = printout(&with(steering.path(), &[("CATCHMENT_COLOR", "never")], &["schema"]));
    assert!(!stderr.contains('\u{1b}'), "{stderr:?}");
}

/// Settings that change a result have only their built-in defaults.
#[test]
fn no_default_changes_a_result() {
    let wrong = home_with("samples = 10\nbudget = \"1s\"\nseed = 2\nmethod = \"flood\"\n");
    let (code, _, stderr) = printout(&with(wrong.path(), &[], &["schema"]));
    assert!(code == Some(2) && stderr.contains("4 problems in"), "{stderr}");
    let home = home_with("threads = 1\nmemory = \"1 GiB\"\nunit = \"in\"\ncolor = \"never\"\n");
    let args = ["run", "v.toml", "--resolution", "8", "--samples", "100"];
    let (_, by_defaults, _) = printout(&with(home.path(), &[], &args));
    assert!(run(home.path(), &args).contains(&by_defaults));
}
