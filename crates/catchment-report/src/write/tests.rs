//! The guarantees for files, one by one.

use super::faults::{self, Fault};
use super::*;
use crate::folder::{Files, SaveError, save_files};
use catchment_core::exec::Exec;
use std::fs::OpenOptions;
use std::io::Write;
use std::process::Command;

pub(super) const KIND: &str = "test";

pub(super) fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A folder for a test, in memory if available: these tests do not cover disks that lose synced data.
pub(super) fn home() -> tempfile::TempDir {
    let memory = Path::new("/dev/shm");
    if memory.is_dir() { tempfile::tempdir_in(memory).unwrap() } else { tempfile::tempdir().unwrap() }
}

pub(super) fn save(path: &Path, version: usize) -> Result<(), SaveError> {
    let files: Files = ["a", "inner/b", "inner/c"]
        .iter()
        .map(|name| ((*name).to_owned(), format!("{name} {version}").into_bytes()))
        .collect();
    save_files(path, KIND, &files, &Exec::new())
}

/// Which version a folder holds, if it is whole.
pub(super) fn saved(path: &Path) -> Option<usize> {
    if !Manifest::read(path).unwrap()?.is_whole(path) {
        return None;
    }
    let text = fs::read_to_string(path.join("a")).ok()?;
    text.strip_prefix("a ")?.parse().ok()
}

#[test]
fn a_file_is_replaced_and_nothing_else_appears() {
    let home = home();
    let path = home.path().join("a.json");
    file(&path, b"one", false).unwrap();
    assert!(matches!(file(&path, b"two", false), Err(WriteError::Exists { .. })));
    assert!(matches!(check_file(&path, false), Err(WriteError::Exists { .. })));
    assert_eq!(fs::read(&path).unwrap(), b"one");
    check_file(&path, true).unwrap();
    file(&path, b"three", true).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"three");
    assert_eq!(names(home.path()), ["a.json"]);
}

#[test]
fn refusals_are_typed_and_leave_nothing() {
    let home = home();
    let nowhere = home.path().join("missing/a.json");
    assert!(matches!(file(&nowhere, b"", true), Err(WriteError::NoFolder { .. })));
    assert!(matches!(check_folder(&nowhere, KIND, &Exec::new()), Err(WriteError::NoFolder { .. })));
    assert!(matches!(file(home.path(), b"", true), Err(WriteError::IsFolder { .. })));
    assert!(matches!(check_folder(Path::new("/"), KIND, &Exec::new()), Err(WriteError::NoName { .. })));
    assert!(matches!(
        check_folder(&home.path().join(".."), KIND, &Exec::new()),
        Err(WriteError::NoName { .. })
    ));
    for length in [250, 300] {
        let long = home.path().join("a".repeat(length));
        assert!(matches!(check_file(&long, false), Err(WriteError::NameTooLong { .. })), "{length}");
        assert!(
            matches!(check_folder(&long, KIND, &Exec::new()), Err(WriteError::NameTooLong { .. })),
            "{length}"
        );
    }
    let file = home.path().join("file");
    fs::write(&file, "").unwrap();
    assert!(matches!(
        check_folder(&file.join("inner"), KIND, &Exec::new()),
        Err(WriteError::NoFolder { .. })
    ));
    assert!(matches!(check_folder(&file, KIND, &Exec::new()), Err(WriteError::NotAResult { .. })));
    assert_eq!(names(home.path()), ["file"]);
    // A device that is always full, if the system has such a device.
    if Path::new("/dev/full").exists() {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap().write_all(b"x").unwrap_err();
        assert!(matches!(WriteError::at(home.path(), full), WriteError::DiskFull { .. }));
    }
}

#[test]
fn a_folder_appears_whole_or_not_at_all() {
    let home = home();
    let path = home.path().join("out");
    save(&path, 1).unwrap();
    save(&path, 2).unwrap();
    let failed = folder(&path, KIND, &Exec::new(), |new| {
        part(new, "half", b"three")?;
        Err(WriteError::DiskFull { path: new.to_owned() })
    });
    assert!(matches!(failed, Err(WriteError::DiskFull { .. })));
    assert_eq!(saved(&path), Some(2));
    assert_eq!(names(home.path()), ["out"]);
    assert_eq!(names(&path), [MANIFEST, "a", "inner"]);
}

#[test]
fn only_an_unchanged_result_of_the_same_kind_is_replaced() {
    let home = home();
    let path = &home.path().join("out");
    let renew = || {
        let _ = fs::remove_dir_all(path);
        save(path, 1).unwrap();
    };
    let refuses = |why: fn(&WriteError) -> bool| {
        let before = Manifest::of(path, KIND).ok();
        let [checked, written] =
            [check_folder(path, KIND, &Exec::new()), folder(path, KIND, &Exec::new(), |_| Ok(()))];
        assert!(
            checked.as_ref().is_err_and(why) && written.as_ref().is_err_and(why),
            "{checked:?} {written:?}"
        );
        assert_eq!(Manifest::of(path, KIND).ok(), before);
        assert_eq!(names(home.path()), ["out"]);
    };
    renew();
    fs::write(path.join("inner/notes"), "mine").unwrap();
    refuses(
        |e| matches!(e, WriteError::Strange { name, changed: false, .. } if name == Path::new("inner/notes")),
    );
    renew();
    fs::write(path.join("inner/b"), "edited").unwrap();
    refuses(|e| matches!(e, WriteError::Strange { name, changed: true, .. } if name == Path::new("inner/b")));
    renew();
    fs::create_dir(path.join("plans")).unwrap();
    refuses(|e| matches!(e, WriteError::Strange { changed: false, .. }));
    renew();
    let other = folder(path, "another", &Exec::new(), |_| Ok::<_, WriteError>(()));
    assert!(matches!(other, Err(WriteError::OtherKind { .. })));
    for manifest in ["", "{}", r#"{"catchment":"0","kind":"test","files":{"../../x":"00"}}"#] {
        renew();
        fs::write(path.join(MANIFEST), manifest).unwrap();
        refuses(|e| matches!(e, WriteError::NotAResult { .. }));
    }
    renew();
    fs::remove_file(path.join(MANIFEST)).unwrap();
    refuses(|e| matches!(e, WriteError::NotAResult { .. }));
    // A missing file or an empty folder holds no data, so replacing it loses nothing.
    renew();
    fs::remove_file(path.join("inner/b")).unwrap();
    save(path, 2).unwrap();
    fs::remove_dir_all(path).unwrap();
    fs::create_dir(path).unwrap();
    save(path, 3).unwrap();
    assert_eq!(saved(path), Some(3));
}

/// Notes added to the old result while the new result is computed and written.
#[test]
fn files_added_during_a_write_are_kept() {
    for exchange in [true, false] {
        for late in [false, true] {
            let home = home();
            let path = home.path().join("out");
            save(&path, 1).unwrap();
            faults::set(home.path(), Fault::Crash, usize::MAX, exchange);
            let fill = |new: &Path| {
                part(new, "a", b"a 2")?;
                if late {
                    faults::before_exchange(home.path(), &path.join("notes"));
                } else {
                    fs::write(path.join("notes"), "mine").unwrap();
                }
                Ok(())
            };
            let refused = folder::<WriteError>(&path, KIND, &Exec::new(), fill);
            faults::clear(home.path());
            assert!(matches!(refused, Err(WriteError::Strange { changed: false, .. })), "{refused:?}");
            assert_eq!(names(home.path()), ["out"]);
            assert!(path.join("notes").exists());
            fs::remove_file(path.join("notes")).unwrap();
            assert_eq!(saved(&path), Some(1));
        }
    }
}

#[cfg(unix)]
#[test]
fn links_stay_and_so_do_permissions() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let home = home();
    let at = |name: &str| home.path().join(name);
    let mode = |name: &str| fs::metadata(at(name)).unwrap().permissions().mode() & 0o7777;
    fs::create_dir(at("far")).unwrap();
    fs::write(at("far/file"), "old").unwrap();
    fs::set_permissions(at("far/file"), Permissions::from_mode(0o640)).unwrap();
    symlink("far/file", at("link")).unwrap();
    symlink("link", at("again")).unwrap();
    assert!(matches!(file(&at("again"), b"", false), Err(WriteError::Exists { .. })));
    file(&at("again"), b"new", true).unwrap();
    assert_eq!((fs::read(at("far/file")).unwrap(), mode("far/file")), (b"new".to_vec(), 0o640));
    symlink("far/new", at("dangling")).unwrap();
    file(&at("dangling"), b"new", true).unwrap();
    assert_eq!(names(&at("far")), ["file", "new"]);
    symlink("round", at("round")).unwrap();
    assert!(file(&at("round"), b"", true).is_err());

    save(&at("far/out"), 1).unwrap();
    fs::set_permissions(at("far/out"), Permissions::from_mode(0o2750)).unwrap();
    symlink("far/out", at("out")).unwrap();
    for version in 2..4 {
        save(&at("out/"), version).unwrap();
        assert!(fs::symlink_metadata(at("out")).unwrap().is_symlink());
        assert_eq!((saved(&at("far/out")), mode("far/out")), (Some(version), 0o2750));
    }
    fs::create_dir(at("empty")).unwrap();
    fs::set_permissions(at("empty"), Permissions::from_mode(0o700)).unwrap();
    save(&at("empty"), 1).unwrap();
    assert_eq!(mode("empty"), 0o700);
    fs::set_permissions(at("empty"), Permissions::from_mode(0o500)).unwrap();
    save(&at("empty"), 2).unwrap();
    assert_eq!((saved(&at("empty")), mode("empty")), (Some(2), 0o500));
    assert_eq!(names(home.path()), ["again", "dangling", "empty", "far", "link", "out", "round"]);
    // A link in a result is no part of it.
    symlink("a", at("empty/inner/link")).unwrap();
    assert!(matches!(save(&at("empty"), 3), Err(SaveError::Write(WriteError::Strange { .. }))));
}

/// A user without access to the old result has no access to the new one while it is filled.
#[cfg(unix)]
#[test]
fn an_unfinished_folder_has_no_wider_permissions() {
    use std::os::unix::fs::PermissionsExt;
    let home = home();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    let path = home.path().join("out");
    save(&path, 1).unwrap();
    for (old, meanwhile) in [(0o700, 0o700), (0o750, 0o750), (0o500, 0o700)] {
        fs::set_permissions(&path, Permissions::from_mode(old)).unwrap();
        let mut seen = None;
        folder::<WriteError>(&path, KIND, &Exec::new(), |new| {
            seen = Some(mode(new));
            part(new, "a", b"a")
        })
        .unwrap();
        // The umask of the process may take more away.
        assert_eq!(seen.unwrap() & !meanwhile, 0, "{old:o}: {:o}", seen.unwrap());
        assert_eq!(mode(&path), old, "{old:o}");
        fs::set_permissions(&path, Permissions::from_mode(0o700)).unwrap();
    }
    let file = home.path().join("file");
    fs::write(&file, "old").unwrap();
    fs::set_permissions(&file, Permissions::from_mode(0o600)).unwrap();
    let permissions = fs::metadata(&file).unwrap().permissions();
    let (made, _open) = Temporary::file(&file, Some(&permissions)).unwrap();
    assert_eq!(mode(&made.path), 0o600);
}

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_not_replaced() {
    let home = home();
    let pipe = home.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for path in [&pipe, Path::new("/dev/null")] {
        assert!(matches!(check_file(path, true), Err(WriteError::NotAFile { .. })));
        assert!(matches!(file(path, b"", true), Err(WriteError::NotAFile { .. })));
    }
    assert!(matches!(check_folder(&pipe, KIND, &Exec::new()), Err(WriteError::NotAResult { .. })));
    // A pipe in the place of a part is not opened, which would wait for ever.
    let out = home.path().join("out");
    save(&out, 1).unwrap();
    fs::remove_file(out.join("a")).unwrap();
    fs::rename(&pipe, out.join("a")).unwrap();
    assert!(matches!(check_folder(&out, KIND, &Exec::new()), Err(WriteError::Strange { changed: true, .. })));
    fs::rename(out.join("a"), out.join(MANIFEST)).unwrap();
    assert!(matches!(check_folder(&out, KIND, &Exec::new()), Err(WriteError::NotAResult { .. })));
}

#[test]
fn leftovers_are_cleaned_up_and_foreign_files_stay() {
    let home = home();
    let at = |name: &str| home.path().join(name);
    // The old result stepped aside and the new result is incomplete: the old result returns.
    save(&at(".out.1.old"), 1).unwrap();
    let ours = |number: &str| format!(".out.{number}.{}.tmp", temporary::mark(".out.".as_ref(), number));
    fs::create_dir(at(".out.1.tmp")).unwrap();
    fs::create_dir(at(&ours("1"))).unwrap();
    fs::write(at(&ours("1")).join("a"), "half").unwrap();
    fs::write(at(&ours("1-3")), "half a file").unwrap();
    check_folder(&at("out"), KIND, &Exec::new()).unwrap();
    assert_eq!((names(home.path()), saved(&at("out"))), (vec!["out".to_owned()], Some(1)));
    // Names that look like temporary names of this program.
    fs::create_dir(at(".out.123.tmp")).unwrap();
    fs::write(at(".out.123.tmp/notes"), "mine").unwrap();
    fs::write(at(".out.77.tmp"), "mine").unwrap();
    fs::write(at(".out.77.01234567.tmp"), "mine").unwrap();
    for name in [".new.5.old", ".new.6.old/notes"] {
        let path = at(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "mine").unwrap();
    }
    check_folder(&at("out"), KIND, &Exec::new()).unwrap();
    check_file(&at("new"), true).unwrap();
    let others =
        [".new.5.old", ".new.6.old/notes", ".out.123.tmp/notes", ".out.77.01234567.tmp", ".out.77.tmp"];
    for name in others {
        assert_eq!(fs::read(at(name)).unwrap(), b"mine", "{name}");
    }
    for name in others.map(|name| at(name.split('/').next().unwrap())) {
        permit().remove_tree(&name).unwrap();
    }
    // Names of other programs.
    for name in [".out.x.tmp", ".out.1.bak", "out.1.tmp", ".out.1-.tmp", ".other.1.tmp"] {
        fs::write(at(name), "").unwrap();
    }
    // Somebody writes there now.
    let working = Temporary::folder(&at("out")).unwrap();
    check_folder(&at("out"), KIND, &Exec::new()).unwrap();
    assert_eq!(names(home.path()).len(), 7);
    drop(working);
    assert_eq!(names(home.path()).len(), 6);
    // An old result, to be removed, into which somebody has put something.
    save(&at(".out.2.old"), 2).unwrap();
    fs::write(at(".out.2.old/notes"), "mine").unwrap();
    let refused = check_folder(&at("out"), KIND, &Exec::new());
    assert!(matches!(refused, Err(WriteError::Strange { path, .. }) if path == at(".out.2.old")));
    fs::remove_file(at(".out.2.old/notes")).unwrap();
    check_folder(&at("out"), KIND, &Exec::new()).unwrap();
    assert_eq!(saved(&at("out")), Some(1));
    assert_eq!(names(home.path()).len(), 6);
}

/// In a process of its own, which writes no more.
#[test]
fn a_process_without_memory_leaves_nothing_unfinished() {
    const HERE: &str = "CATCHMENT_TEST_ABANDON";
    if let Some(home) = std::env::var_os(HERE) {
        let home = Path::new(&home);
        let (half, _open) = Temporary::file(&home.join("a.json"), None).unwrap();
        let folder = Temporary::folder(&home.join("out")).unwrap();
        fs::write(folder.path.join("half"), "half").unwrap();
        // Somebody works on a folder: it stays, and files go.
        let busy = home.ends_with("busy").then(permit);
        abandon_at_once();
        assert!(!half.path.exists() && folder.path.exists() == busy.is_some());
        // Dropping them would wait for a permit to write, which is not given any more.
        std::mem::forget((half, folder));
        return;
    }
    let home = home();
    for name in ["idle", "busy"] {
        let inner = home.path().join(name);
        fs::create_dir(&inner).unwrap();
        let itself = "report::write::tests::a_process_without_memory_leaves_nothing_unfinished";
        let child =
            Command::new(std::env::current_exe().unwrap()).arg(itself).env(HERE, &inner).output().unwrap();
        assert!(child.status.success(), "{}", String::from_utf8_lossy(&child.stdout));
        check_folder(&inner.join("out"), KIND, &Exec::new()).unwrap();
        assert!(names(&inner).is_empty());
    }
}

#[test]
fn concurrent_writes_leave_one_whole_result() {
    let home = home();
    let path = &home.path().join("out");
    std::thread::scope(|scope| {
        for writer in 0..4 {
            scope.spawn(move || {
                for version in 0..8 {
                    save(path, 10 * writer + version).unwrap();
                }
            });
        }
    });
    assert!(saved(path).is_some_and(|version| version % 10 == 7));
    assert_eq!(names(home.path()), ["out"]);
}

/// A cleanup may remove a folder before its creator has locked it.
#[test]
fn temporary_folders_survive_concurrent_cleanup() {
    let home = home();
    let path = &home.path().join("out");
    let stop = &std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(move || {
                while !stop.load(std::sync::atomic::Ordering::Relaxed) {
                    sweep(path).unwrap();
                }
            });
        }
        let makers: Vec<_> = (0..3)
            .map(|_| {
                scope.spawn(move || {
                    for _ in 0..3000 {
                        let made = Temporary::folder(path).unwrap();
                        fs::create_dir(made.path.join("inner")).unwrap();
                    }
                })
            })
            .collect();
        // The makers end in any case. Stop the sweepers before the assertion.
        let made: Vec<_> = makers.into_iter().map(std::thread::ScopedJoinHandle::join).collect();
        stop.store(true, std::sync::atomic::Ordering::Relaxed);
        assert!(made.iter().all(Result::is_ok));
    });
    assert!(names(home.path()).is_empty());
}
