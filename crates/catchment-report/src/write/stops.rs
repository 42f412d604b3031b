//! Every writer stopped at every step: the process is killed there, or the system call fails.

use super::faults::{self, Fault};
use super::tests::{KIND, home, names, save, saved};
use super::*;
use crate::folder::{Files, SaveError, StudyFolder};
use crate::save::save_drawn;
use catchment_core::exec::Exec;

/// A writer of a given version, and a test which version is present, complete.
struct Writer<'a> {
    write: &'a dyn Fn(&Path, usize) -> bool,
    check: &'a dyn Fn(&Path) -> bool,
    read: &'a dyn Fn(&Path) -> Option<usize>,
    /// Folders are exchanged, files are renamed.
    is_folder: bool,
}

/// Stops a writer at every step; returns their number.
fn stop_everywhere(writer: &Writer) -> usize {
    let manners: &[bool] = if writer.is_folder { &[true, false] } else { &[true] };
    let mut steps = 0;
    for exchange in manners {
        for fault in [Fault::Crash, Fault::Fail] {
            for first in [true, false] {
                steps += stop(writer, fault, *exchange, first);
            }
        }
    }
    steps
}

fn stop(writer: &Writer, fault: Fault, exchange: bool, first: bool) -> usize {
    for step in 0.. {
        let case = format!("{fault:?} at {step}, exchange {exchange}, first {first}");
        let home = home();
        let path = &home.path().join("out");
        assert!(first || (writer.write)(path, 1));
        faults::set(home.path(), fault, step, exchange);
        let done = (writer.write)(path, 2);
        let happened = faults::clear(home.path());
        let there = (writer.read)(path);
        // Without exchange there is a moment with neither result, until the next start.
        let gap = first || (!exchange && fault == Fault::Crash);
        assert!(
            matches!(there, Some(1 | 2)) || gap && fs::symlink_metadata(path).is_err(),
            "{case}: {there:?}"
        );
        assert!(!done || there == Some(2), "{case}: done, but {there:?}");
        assert!((writer.check)(path), "{case}");
        let there = (writer.read)(path);
        assert!(
            matches!(there, Some(1 | 2)) || first && fs::symlink_metadata(path).is_err(),
            "{case}: {there:?}"
        );
        let here = if there.is_some() { vec!["out"] } else { Vec::new() };
        assert_eq!(names(home.path()), here, "{case}");
        assert!((writer.write)(path, 3), "{case}");
        assert_eq!((writer.read)(path), Some(3), "{case}");
        assert_eq!(names(home.path()), ["out"], "{case}");
        if !happened {
            assert!(done, "{case}");
            return step;
        }
    }
    unreachable!("a writer that never ends")
}

#[test]
fn a_file_survives_every_stop() {
    let steps = stop_everywhere(&Writer {
        write: &|path, version| file(path, version.to_string().as_bytes(), true).is_ok(),
        check: &|path| check_file(path, true).is_ok(),
        read: &|path| fs::read_to_string(path).ok()?.parse().ok(),
        is_folder: false,
    });
    assert!(steps > 12, "{steps}");
}

#[test]
fn a_folder_survives_every_stop() {
    let steps = stop_everywhere(&Writer {
        write: &|path, version| save(path, version).is_ok(),
        check: &|path| check_folder(path, KIND, &Exec::new()).is_ok(),
        read: &saved,
        is_folder: true,
    });
    assert!(steps > 50, "{steps}");
}

/// Stopped, and stopped again while that is put in order.
#[test]
fn recovery_survives_every_stop() {
    for exchange in [true, false] {
        for step in 0.. {
            let mut happened = false;
            for again in 0.. {
                let home = home();
                let path = &home.path().join("out");
                save(path, 1).unwrap();
                faults::set(home.path(), Fault::Crash, step, exchange);
                let _ = save(path, 2);
                happened = faults::clear(home.path());
                faults::set(home.path(), Fault::Crash, again, exchange);
                let _ = check_folder(path, KIND, &Exec::new());
                let stopped = faults::clear(home.path());
                check_folder(path, KIND, &Exec::new()).unwrap();
                assert!(matches!(saved(path), Some(1 | 2)), "{exchange} {step} {again}");
                assert_eq!(names(home.path()), ["out"], "{exchange} {step} {again}");
                if !stopped {
                    break;
                }
            }
            if !happened {
                break;
            }
        }
    }
}

#[test]
fn a_study_survives_every_stop() {
    fn study(path: &Path) -> StudyFolder<'_> {
        StudyFolder { path, name: "slices" }
    }
    let steps = stop_everywhere(&Writer {
        write: &|path, version| {
            let more = |new: &Path| -> Result<(), SaveError> {
                let written = write_group(&new.join("x-y.zarr"), version);
                if written { Ok(()) } else { Err(WriteError::NoName { path: new.to_owned() }.into()) }
            };
            study(path).write(&version.to_string(), &[], Files::new(), &Exec::new(), more).is_ok()
        },
        check: &|path| study(path).check(&Exec::new()).is_ok(),
        read: &|path| {
            Manifest::read(path).unwrap()?.is_whole(path).then_some(())?;
            let group = path.join("x-y.zarr");
            (!cfg!(feature = "zarr") || Manifest::read(&group).unwrap()?.is_whole(&group)).then_some(())?;
            fs::read_to_string(path.join("report.json")).ok()?.parse().ok()
        },
        is_folder: true,
    });
    assert!(steps > 50, "{steps}");
}

#[cfg(feature = "zarr")]
fn write_group(path: &Path, version: usize) -> bool {
    use crate::Report;
    use crate::schema::testing::{blob, design};
    use catchment_core::pose::Dof;
    let design = design([Dof::X, Dof::Y].into_iter().collect());
    let acceptance = blob(&design, 4);
    let report = Report::new(&design, &acceptance, version.into(), None, &Exec::new()).unwrap();
    crate::zarr::write(path, &report, &acceptance, &crate::zarr::CellLayers::default(), &Exec::new()).is_ok()
}

#[cfg(not(feature = "zarr"))]
fn write_group(_: &Path, _: usize) -> bool {
    true
}

#[cfg(feature = "zarr")]
#[test]
fn a_group_survives_every_stop() {
    let steps = stop_everywhere(&Writer {
        write: &write_group,
        check: &|path| check_folder(path, "group", &Exec::new()).is_ok(),
        read: &|path| {
            Manifest::read(path).unwrap()?.is_whole(path).then_some(())?;
            let root: serde_json::Value =
                serde_json::from_slice(&fs::read(path.join("zarr.json")).ok()?).ok()?;
            Some(root["attributes"]["report"]["settings"].as_u64()? as usize)
        },
        is_folder: true,
    });
    assert!(steps > 50, "{steps}");
}

#[cfg(all(feature = "figure", feature = "zarr"))]
#[test]
fn a_run_survives_every_stop() {
    use crate::Target;
    use crate::figure::draw::svg::Svg;
    use crate::figure::{DrawnFigures, Picture};
    use catchment_core::problem::Problem;
    use catchment_core::run::{Over, Run, Sample};
    let text = "[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n";
    let designs = home();
    let design = designs.path().join("v.toml");
    fs::write(&design, text).unwrap();
    let problem = Problem::open(design).unwrap();
    let exec = Exec::new();
    let answers: Vec<_> = (1..4)
        .map(|version| {
            let over = Over::Grid((4 + version).to_string().parse().unwrap());
            let run = Run { over, sample: Sample::None, ..Run::default() };
            let answer = run.on(&problem, &exec).unwrap();
            // As many files as for a run; drawing its real pictures would take longer than the whole test.
            let dot = Picture::of(Svg::new(8.0, 8.0));
            (answer, DrawnFigures { pictures: vec![("section", dot)], left_out: Vec::new() })
        })
        .collect();
    let cells: Vec<usize> = answers.iter().map(|(answer, _)| answer.acceptance.outcomes.len()).collect();
    stop_everywhere(&Writer {
        write: &|path, version| {
            let (answer, drawn) = &answers[version - 1];
            save_drawn(answer, path, drawn, &exec).is_ok()
        },
        check: &|path| Target::Folder(path).check(&Exec::new()).is_ok(),
        read: &|path| {
            Manifest::read(path).unwrap()?.is_whole(path).then_some(())?;
            let (_, acceptance) = crate::zarr::read(&path.join("result.zarr"), &exec).ok()?;
            Some(1 + cells.iter().position(|cells| *cells == acceptance.outcomes.len())?)
        },
        is_folder: true,
    });
}
