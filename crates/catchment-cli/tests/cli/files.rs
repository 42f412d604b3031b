//! The real binary never damages files of other owners.

use super::{entries, home, run};
use std::fs;
use std::path::Path;

const FAST: [&str; 4] = ["--resolution", "6", "--samples", "0"];

fn refuses(home: &Path, args: &[&str], why: &str) {
    let printed = run(home, args).replace("\n  │ ", " ");
    assert!(printed.starts_with("exit 2\n") && printed.contains(why), "{args:?}: {printed}");
}

fn does(home: &Path, args: &[&str]) {
    let printed = run(home, args);
    assert!(printed.starts_with("exit 0\n"), "{args:?}: {printed}");
}

#[test]
fn a_folder_of_results_is_not_a_result() {
    let home = home();
    fs::create_dir(home.path().join("results")).unwrap();
    for name in ["results/a.zarr", "results/b.zarr"] {
        does(home.path(), &[&["run", "v.toml", "-o", name], &FAST[..]].concat());
    }
    refuses(
        home.path(),
        &["slices", "v.toml", "--resolution", "5", "-o", "results"],
        "not a catchment result",
    );
    refuses(
        home.path(),
        &["compare", "results/a.zarr", "results/b.zarr", "-o", "results"],
        "not a catchment result",
    );
    assert_eq!(entries(&home.path().join("results")), ["a.zarr", "b.zarr"]);
    does(home.path(), &["compare", "results/a.zarr", "results/b.zarr", "-o", "out"]);
    does(home.path(), &["compare", "results/a.zarr", "results/b.zarr", "-o", "out"]);
}

#[test]
fn files_of_the_user_are_kept() {
    let home = home();
    let at = |name: &str| home.path().join(name);
    fs::create_dir(at("mine")).unwrap();
    fs::write(at("mine/section.png"), "my drawing").unwrap();
    refuses(
        home.path(),
        &[&["run", "v.toml", "--figures", "mine"], &FAST[..]].concat(),
        "not a catchment result",
    );
    refuses(home.path(), &[&["run", "v.toml", "-o", "mine"], &FAST[..]].concat(), "not a catchment result");
    assert_eq!(fs::read(at("mine/section.png")).unwrap(), b"my drawing");

    fs::copy(super::designs().join("pyramid.toml"), at("pyramid.toml")).unwrap();
    let export = ["export", "pyramid.toml", "--pose", "x=0.1", "-o", "trial"];
    does(home.path(), &export);
    does(home.path(), &export);
    fs::write(at("trial/trial.xml"), "<mujoco/>").unwrap();
    refuses(home.path(), &export, "trial.xml in it was changed");
    assert_eq!(fs::read(at("trial/trial.xml")).unwrap(), b"<mujoco/>");

    let whole = [&["run", "v.toml", "-o", "out"], &FAST[..]].concat();
    does(home.path(), &whole);
    does(home.path(), &whole);
    fs::write(at("out/notes.txt"), "mine").unwrap();
    refuses(home.path(), &whole, "notes.txt in it was not written by catchment");
    fs::remove_file(at("out/notes.txt")).unwrap();
    refuses(home.path(), &["slices", "v.toml", "-o", "out"], "another result is there");
    fs::remove_file(at("out/.catchment.json")).unwrap();
    refuses(home.path(), &whole, "no readable .catchment.json");
}

#[cfg(unix)]
#[test]
fn devices_pipes_and_links_are_preserved() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let home = home();
    let at = |name: &str| home.path().join(name);
    assert!(std::process::Command::new("mkfifo").arg(at("pipe")).status().unwrap().success());
    refuses(home.path(), &["schema", "--force", "-o", "pipe"], "not an ordinary file");
    refuses(home.path(), &["schema", "--force", "-o", "/dev/null"], "not an ordinary file");
    assert!(fs::symlink_metadata(at("pipe")).unwrap().file_type().is_fifo());
    fs::create_dir(at("far")).unwrap();
    fs::write(at("far/file"), "old").unwrap();
    symlink("far/file", at("link")).unwrap();
    refuses(home.path(), &["schema", "-o", "link"], "it exists");
    does(home.path(), &["schema", "--force", "-o", "link"]);
    assert!(fs::symlink_metadata(at("link")).unwrap().is_symlink());
    assert!(fs::read_to_string(at("far/file")).unwrap().starts_with('{'));
    assert_eq!(entries(&at("far")), ["file"]);
}

/// The design has an error as well: the message about the output comes first because the output is checked
/// first.
#[test]
fn invalid_output_paths_are_refused_before_the_design_is_read() {
    let home = home();
    let long = "n".repeat(250);
    let [long_group, long_file] = [format!("{long}.zarr"), format!("{long}.csv")];
    fs::create_dir(home.path().join("q")).unwrap();
    let nested = "name the same folder, or one is inside of the other";
    for (args, why) in [
        (&["run", "nowhere.toml", "-o", "q", "--figures", "q/pics"][..], nested),
        (&["run", "nowhere.toml", "-o", "q/a.zarr", "--figures", "q"], nested),
        (&["run", "nowhere.toml", "-o", "q", "--figures", "./q/../q"], nested),
        (&["run", "nowhere.toml", "-o", &long], "too long"),
        (&["run", "nowhere.toml", "-o", &long_group], "too long"),
        (&["slices", "nowhere.toml", "-o", &long], "too long"),
        (&["export", "nowhere.toml", "--pose", "x=0", "-o", &long], "too long"),
        (&["outcome", "nowhere.toml", "--poses", "p.csv", "-o", &long_file], "too long"),
        (&["run", "nowhere.toml", "-o", "no/out"], "folder does not exist"),
    ] {
        refuses(home.path(), args, why);
    }
    assert_eq!(entries(home.path()), ["q", "v.toml"]);
    assert!(entries(&home.path().join("q")).is_empty());
}

/// The system cannot exchange the folder, and the message comes before any computation.
#[cfg(target_os = "linux")]
#[test]
fn a_mount_point_is_no_place_for_a_result() {
    let home = home();
    for args in [
        &["run", "nowhere.toml", "-o", "/dev/shm"][..],
        &["run", "nowhere.toml", "--figures", "/dev/shm"],
        &["slices", "nowhere.toml", "-o", "/proc"],
        &["export", "nowhere.toml", "--pose", "x=0", "-o", "/proc"],
    ] {
        refuses(home.path(), args, "it is a mount point");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_not_utf8_is_refused_where_grids_are_stored() {
    use std::os::unix::ffi::OsStrExt;
    let home = home();
    let odd = std::ffi::OsStr::from_bytes(b"\xff.zarr");
    let output = super::catchment(home.path()).args(["run", "nowhere.toml", "-o"]).arg(odd).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && stderr.contains("not UTF-8"), "{stderr}");
    let output = super::catchment(home.path()).args(["schema", "-o"]).arg(odd).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
}

/// The next run cleans up the leftovers of a killed run.
#[test]
fn leftovers_of_a_killed_run_are_cleaned_up() {
    let home = home();
    let whole = [&["run", "v.toml", "-o", "out"], &FAST[..]].concat();
    does(home.path(), &whole);
    fs::rename(home.path().join("out"), home.path().join(".out.1.old")).unwrap();
    fs::create_dir(home.path().join(".out.1.tmp")).unwrap();
    // The program restores it before any computation, so that a failing run finds it as well.
    assert!(run(home.path(), &["run", "nowhere.toml", "-o", "out"]).starts_with("exit 3\n"));
    assert_eq!(entries(home.path()), ["out", "v.toml"]);
    does(home.path(), &whole);
    assert_eq!(entries(home.path()), ["out", "v.toml"]);
    // A folder that only resembles a leftover belongs to someone else.
    fs::create_dir(home.path().join(".out.123.tmp")).unwrap();
    fs::write(home.path().join(".out.123.tmp/notes"), "mine").unwrap();
    fs::write(home.path().join(".s.json.77.tmp"), "mine").unwrap();
    does(home.path(), &whole);
    does(home.path(), &["schema", "-o", "s.json"]);
    assert_eq!(entries(home.path()), [".out.123.tmp", ".s.json.77.tmp", "out", "s.json", "v.toml"]);
    assert_eq!(entries(&home.path().join(".out.123.tmp")), ["notes"]);
}
