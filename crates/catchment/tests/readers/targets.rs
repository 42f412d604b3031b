//! Properties of every reader on arbitrary bytes: no panic, bounded memory, and accepted input obeys its own rules. The fuzzer
//! and the test beside this file run the same functions.

#![allow(dead_code, reason = "a fuzz target is a program that runs one of them")]

use catchment::connector::{Connector, FileBytes, HalfSource, bodies_of_answer, stl};
use catchment::design::{
    Design, FileSpec, LocatedDefects, MeshPreparation, OutlineSpec, PartSpec, Quantity, ShapeSpec, SourceText,
};
use catchment::design::{keys, parse_dofs, read};
use catchment::landscape::Resolution;
use catchment::pose::{Dof, Mount};
use catchment::poses::{
    Distribution, OffsetsAt, PoseTable, RobotTrialTable, Spread, parse_draw, parse_pose, read_dynamics,
    read_robots,
};
use catchment::report::Report;
use catchment::run::Requirement;
use std::path::Path;

/// The function that takes an input, by the name of its corpus.
pub(crate) type Target = (&'static str, fn(&[u8]));

/// The readers; their corpora are folders of `fuzz/corpus`.
pub(crate) const TARGETS: &[Target] = &[
    ("design", design_file),
    ("drawing", drawing),
    ("dynamics", dynamics),
    ("lines", line),
    ("obj", obj_file),
    ("ply", ply_file),
    ("poses", pose_table),
    ("report", report),
    ("requirement", requirement),
    ("resolution", resolution),
    ("robots", robots),
    ("step", step_answer),
    ("stl", stl_file),
    ("threemf", threemf_file),
    #[cfg(feature = "zarr")]
    ("zarr", group),
];

/// A design in millimetres, free in all five errors.
pub(crate) fn design() -> Design {
    let text = "[connector]\nfamily = \"pyramid\"\nwidth = 40.0\nunit = \"mm\"\naspect_ratio = 0.5\n";
    read(text, Path::new("")).expect("the design of the targets").design
}

/// A design file gives a design that obeys its own rules, or problems with places inside the text.
fn design_file(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    match read(&text, Path::new("no-such-folder")) {
        Ok(file) => {
            let design = file.design;
            assert!(design.width > 0.0 && design.width.is_finite());
            assert!(!design.alignment.free.is_empty());
            for (half_range, key) in design.alignment.half_ranges.iter().zip(&keys::ERROR_KEYS) {
                let (keys::ValueKind::Length(range) | keys::ValueKind::Angle(range)) = key.kind else {
                    panic!("an error is a length or an angle")
                };
                assert!(range.contains(*half_range));
            }
            let free = design.alignment.free;
            let again = design.clone().with_free(free).expect("what the file allows, an override allows");
            assert_eq!(again, design);
        }
        Err(problems) => {
            assert!(!problems.list.is_empty() && problems.list.len() <= LocatedDefects::MOST);
            for problem in &problems.list {
                assert!(problem.line >= 1 && problem.column >= 1);
                assert!(text.get(problem.span.clone()).is_some(), "{problem:?} is not a piece of the text");
                assert!(!problem.defect.to_string().is_empty());
                assert!(problem.defect.help().is_none_or(|help| !help.is_empty()));
            }
        }
    }
}

/// The STL reader accepts only closed solids, and refuses for a few known reasons.
fn stl_file(bytes: &[u8]) {
    mesh_file("half.stl", bytes);
    match stl::from_bytes(bytes, bytes.len() as u64, 1.0) {
        Ok(half) => {
            for surface in &half.surfaces {
                assert!(surface.volume() > 0.0);
                assert!(surface.vertices.iter().all(|v| v.is_finite()));
            }
        }
        Err(problems) => assert!((1..60).contains(&problems.len()), "{} problems", problems.len()),
    }
}

/// The OBJ reader accepts only closed solids, and refuses for a few known reasons.
fn obj_file(bytes: &[u8]) {
    mesh_file("half.obj", bytes);
}

/// The same for PLY files.
fn ply_file(bytes: &[u8]) {
    mesh_file("half.ply", bytes);
}

/// The same for 3MF files.
fn threemf_file(bytes: &[u8]) {
    mesh_file("half.3mf", bytes);
}

/// An answer of the interpreter that meshes STEP files: triangles, from which closed solids are made as from any others, or a
/// reason.
fn step_answer(bytes: &[u8]) {
    match bodies_of_answer(bytes) {
        Ok(bodies) => {
            let triangles: Vec<_> = bodies.into_iter().flatten().collect();
            let half = || HalfSource::Triangles(triangles.clone());
            match Connector::from_sources(&half(), &half(), 0.0, Mount::X) {
                Ok(connector) => {
                    for surface in &connector.fixed.surfaces {
                        assert!(surface.volume() > 0.0);
                        assert!(surface.vertices.iter().all(|v| v.is_finite()));
                    }
                }
                Err(problems) => assert!((2..120).contains(&problems.len()), "{} problems", problems.len()),
            }
        }
        Err(problems) => {
            assert_eq!(problems.len(), 1);
            assert!(!problems[0].to_string().chars().any(char::is_control), "{}", problems[0]);
        }
    }
}

/// An accepted drawing gives a solid when extruded.
fn drawing(bytes: &[u8]) {
    for name in ["plate.svg", "plate.dxf"] {
        let outline = OutlineSpec::File(FileSpec::new(name, 0.1));
        let shape = ShapeSpec::Profile { outline, height: 0.5, chord_error: 1e-3 };
        let part = PartSpec::new(shape, [0.0; 3]);
        let half = || HalfSource::Parts(vec![(part.clone(), Some(FileBytes::whole(bytes.to_vec())))]);
        match Connector::from_sources(&half(), &half(), 0.0, Mount::X) {
            Ok(connector) => {
                assert!(connector.fixed.surfaces.iter().all(|surface| surface.volume() > 0.0));
            }
            Err(problems) => assert!((2..120).contains(&problems.len()), "{} problems", problems.len()),
        }
    }
}

fn mesh_file(name: &str, bytes: &[u8]) {
    // Unchanged, repaired, and simplified: every accepted result is a closed solid.
    let treated = |repair, simplify| {
        mesh_treated(name, bytes, MeshPreparation { repair, simplify, ..MeshPreparation::DEFAULT })
    };
    let as_it_is = treated(false, None);
    let repaired = treated(true, None);
    assert!(!as_it_is || repaired, "repair refuses what needs none");
    treated(true, Some(0.01));
}

/// Whether the reader accepts a mesh file.
fn mesh_treated(name: &str, bytes: &[u8], treatment: MeshPreparation) -> bool {
    let spec = FileSpec { treatment, ..FileSpec::new(name, 1.0) };
    let mesh = || HalfSource::Mesh { spec: spec.clone(), file: FileBytes::whole(bytes.to_vec()) };
    match Connector::from_sources(&mesh(), &mesh(), 0.0, Mount::X) {
        Ok(connector) => {
            for surface in connector.fixed.surfaces.iter().chain(&connector.moving.surfaces) {
                assert!(surface.volume() > 0.0);
                assert!(surface.vertices.iter().all(|v| v.is_finite()));
            }
            true
        }
        Err(problems) => {
            assert!((2..120).contains(&problems.len()), "{} problems", problems.len());
            false
        }
    }
}

/// A table of poses has as many errors as rows, all finite, and its diagnostics have places inside the text; so has a table of
/// trials, each trial once.
fn pose_table(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let design = design();
    for at in [OffsetsAt::Face, OffsetsAt::Cor] {
        match PoseTable::parse(&text, &design, at) {
            Ok(table) => {
                assert!(table.errors().iter().all(|error| error.to_array().iter().all(|v| v.is_finite())));
                assert_eq!(table.rows().count(), table.errors().len());
                let width = table.header().len();
                assert!(table.rows().all(|row| row.len() == width));
                for error in table.errors() {
                    assert!(table.in_units(error).iter().all(|v| v.is_finite()));
                }
            }
            Err(diagnostics) => {
                assert!(!diagnostics.list.is_empty());
                for span in diagnostics.list.iter().filter_map(|diagnostic| diagnostic.span.clone()) {
                    assert!(text.get(span).is_some(), "a diagnostic is not a piece of the text");
                }
            }
        }
        match RobotTrialTable::parse(&text, &design, at) {
            Ok(table) => {
                let mut numbers: Vec<u64> = table.rows.iter().map(|row| row.trial).collect();
                numbers.sort_unstable();
                assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]), "a trial is there twice");
                assert!(table.rows.iter().all(|row| row.error.to_array().iter().all(|v| v.is_finite())));
            }
            Err(diagnostics) => {
                assert!(!diagnostics.list.is_empty());
                for span in diagnostics.list.iter().filter_map(|diagnostic| diagnostic.span.clone()) {
                    assert!(text.get(span).is_some(), "a diagnostic is not a piece of the text");
                }
            }
        }
    }
}

/// A file of robots: finite moments, correlations within ±1, or problems with places inside the text.
fn robots(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let mut table = |name: &str| match name {
        "no.csv" => Err("cannot read no.csv".to_owned()),
        name => Ok(SourceText::new(name, "x_mm,yaw_deg\n1,2\n-1,3\n0,0\n")),
    };
    match read_robots(&SourceText::new("robots.toml", text.clone()), &design(), &mut table) {
        Ok(robots) => {
            assert!(!robots.is_empty());
            for robot in &robots {
                let moments = robot.errors.moments();
                assert!(
                    moments.mean.to_array().iter().chain(&moments.sigma.to_array()).all(|v| v.is_finite())
                );
                assert!(moments.sigma.to_array().iter().all(|sigma| *sigma >= 0.0));
                if let Spread::Normal { correlation, .. } = &robot.errors {
                    for (k, row) in correlation.iter().enumerate() {
                        assert_eq!(row[k], 1.0);
                        assert!(row.iter().all(|c| c.abs() <= 1.0 + 1e-5), "{correlation:?}");
                    }
                }
            }
        }
        Err(diagnostics) => {
            assert!(!diagnostics.list.is_empty());
            let source = diagnostics.source.as_ref().expect("a refusal names its text");
            for span in diagnostics.list.iter().filter_map(|diagnostic| diagnostic.span.clone()) {
                assert!(source.text.get(span).is_some(), "a diagnostic is not a piece of the text");
            }
        }
    }
}

/// A file of distributions: every sampled value lies in the range of its quantity, or problems with places inside the text.
fn dynamics(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    match read_dynamics(&SourceText::new("dynamics.toml", text.clone()), &design()) {
        Ok(dynamics) => {
            assert!(dynamics.declared().count() > 0);
            for (of, law) in dynamics.declared() {
                let [lo, hi] = of.range();
                for k in 0..4 {
                    let value = law.draw([lo, hi], |index| ((index * 7 + k * 13) % 29) as f64 / 29.0);
                    assert!((lo..=hi).contains(&value), "{of:?} {law:?}: {value}");
                }
            }
        }
        Err(diagnostics) => {
            assert!(!diagnostics.list.is_empty());
            let source = diagnostics.source.as_ref().expect("a refusal names its text");
            for span in diagnostics.list.iter().filter_map(|diagnostic| diagnostic.span.clone()) {
                assert!(source.text.get(span).is_some(), "a diagnostic is not a piece of the text");
            }
        }
    }
}

/// One line of user input: a pose, a quantity, degrees of freedom, a distribution.
fn line(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let design = design();
    if let Ok(error) = parse_pose(&text, &design) {
        assert!(error.to_array().iter().all(|v| v.is_finite()));
    }
    if let Err(diagnostics) = parse_draw(&text, &design) {
        assert!(!diagnostics.list.is_empty());
        for span in diagnostics.list.iter().filter_map(|diagnostic| diagnostic.span.clone()) {
            assert!(text.get(span).is_some(), "a diagnostic is not a piece of the text");
        }
    }
    if let Ok(quantity) = text.parse::<Quantity>() {
        let _ = design.clone().with_center_of_rotation(quantity);
        if let Ok(design) = design.clone().with_rotation_length(quantity) {
            assert!(design.alignment.rotation_length > 0.0 && design.alignment.rotation_length.is_finite());
        }
    }
    if let Ok(free) = parse_dofs(&text) {
        let _ = design.clone().with_free(free);
    }
    let _ = text.parse::<Dof>();
    let _ = Distribution::normal(&text, &design);
    let _ = Distribution::uniform(&text, &design);
}

/// A stored report that is read can be written again and printed, whatever its numbers are.
fn report(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Ok(report) = Report::from_json(&text) {
        let again = report.to_json().expect("what was read has a JSON form");
        assert_eq!(Report::from_json(&again).expect("what was written is read"), report);
        if report.check().is_ok() {
            assert!(!report.table().chars().any(|c| c.is_control() && c != '\n'));
        }
    }
}

/// A requirement is a path and a number.
fn requirement(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Ok(requirement) = text.parse::<Requirement>() {
        let report = serde_json::json!({ "onaa": { "edge": 0.25 }, "success": null });
        let _ = requirement.judge(&report);
    }
}

/// A resolution gives a grid with that many cells, or an error with the reason.
fn resolution(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Ok(resolution) = text.parse::<Resolution>()
        && let Ok(grid) = resolution.grid(&design().alignment, &[3; 5])
    {
        assert!(grid.axes.iter().all(|axis| axis.cells > 0));
        let _ = grid.checked_len();
    }
}

/// Separator between the files of a group in one input.
pub(crate) const FILES_END: &[u8] = b"\n=====\n";

/// Three files of a group, concatenated: its metadata, the metadata of its outcomes, and their first chunk.
#[cfg(feature = "zarr")]
fn group(bytes: &[u8]) {
    use catchment::exec::Exec;
    const NAMES: [&str; 3] = ["zarr.json", "outcome/zarr.json", "outcome/c/0/0"];
    let home = tempfile::tempdir().expect("a folder for a group");
    std::fs::create_dir_all(home.path().join("outcome/c/0")).expect("a folder for a chunk");
    let mut rest = bytes;
    for name in NAMES {
        let end = rest.windows(FILES_END.len()).position(|window| window == FILES_END);
        let (file, others) = end.map_or((rest, &[][..]), |at| (&rest[..at], &rest[at + FILES_END.len()..]));
        std::fs::write(home.path().join(name), file).expect("a file of a group");
        rest = others;
    }
    let exec = Exec::new().with_memory_budget(8 << 20);
    match catchment::report::zarr::read(home.path(), &exec) {
        Ok((report, acceptance)) => {
            assert_eq!(acceptance.outcomes.len(), report.acceptance.cells);
            report.check().expect("what is read is sound");
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
