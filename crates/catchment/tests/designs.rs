//! Every committed design builds, and its mated pose is a rest.

use catchment::design::SourceText;
use catchment::pose::CorPose;
use catchment::prelude::*;
use catchment::report::CheckReport;
use std::path::Path;

#[test]
fn every_committed_design_is_mated() {
    for (folder, least) in [("designs", 8), ("designs/gallery", 15)] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
        let mut files: Vec<_> = std::fs::read_dir(&folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "toml"))
            .collect();
        files.sort();
        assert!(files.len() >= least, "{files:?}");
        for file in files {
            let problem = Problem::open(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
            assert_eq!(problem.mated_warnings(), [], "{}", file.display());
        }
    }
}

#[test]
fn the_whole_design_of_the_guide_is_mated() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let guide = std::fs::read_to_string(root.join("docs/parts.md")).unwrap();
    let (_, rest) = guide.split_once("```toml\n").unwrap();
    let (text, _) = rest.split_once("```").unwrap();
    let draft = Draft::read(SourceText::new(root.join("designs/meshes/guide.toml"), text));
    assert_eq!(draft.and_then(Draft::build).unwrap().mated_warnings(), []);
}

/// Drawn docked in one frame, as OBJ and PLY, the pyramid equals the one drawn half by half.
#[test]
fn the_assembled_pyramid_is_the_pyramid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs");
    let [assembled, facing] =
        ["pyramid-assembled.toml", "pyramid-stl.toml"].map(|name| Problem::open(folder.join(name)).unwrap());
    for k in 0..50 {
        let part = |step: f64| (f64::from(k) * step).fract() - 0.5;
        let error =
            PoseError { x: part(0.83), y: part(0.69), roll: part(0.58), pitch: part(0.48), yaw: part(0.4) };
        let heights = [&assembled, &facing].map(|problem| {
            let pose = CorPose::from_error(&error, problem.alignment().center_of_rotation, DofSet::ALL);
            problem.pair().height(&pose).unwrap()
        });
        assert!((heights[0] - heights[1]).abs() < 1e-9, "{error:?}: {heights:?}");
    }
    let drawing = CheckReport::good(&assembled).drawing.unwrap();
    let near = |a: [f64; 3], b: [f64; 3]| DVec3::from_array(a).abs_diff_eq(DVec3::from_array(b), 1e-6);
    // The middle of the assembly's pyramid; the centre of rotation 25 mm along the approach; the error y is the assembly's z.
    assert!(near(drawing.fixed.face_center, [120.0, 40.0, 15.0]), "{drawing:?}");
    assert!(near(drawing.moving.center_of_rotation, [120.0, 65.0, 15.0]), "{drawing:?}");
    assert_eq!((drawing.fixed.x, drawing.fixed.y), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
}
