//! Every committed design builds, and its mated pose holds.

use catchment::connector::Connector;
use catchment::contact::{Pair, mated};
use catchment::design;
use std::path::Path;

#[test]
fn every_committed_design_is_mated() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs");
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    assert!(files.len() >= 8, "{files:?}");
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let design =
            design::read(&text, &folder).unwrap_or_else(|e| panic!("{}: {e:?}", file.display())).design;
        let connector = Connector::build(&design).unwrap_or_else(|e| panic!("{}: {e:?}", file.display()));
        assert_eq!(mated::problems(&Pair::new(&connector, &design.alignment)), [], "{}", file.display());
    }
}

#[test]
fn the_design_in_the_readme_is_mated() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap();
    let (_, rest) = readme.split_once("```toml\n").unwrap();
    let (text, _) = rest.split_once("```").unwrap();
    let design = design::read(text, &root.join("designs/meshes")).unwrap_or_else(|e| panic!("{e:?}")).design;
    let connector = Connector::build(&design).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(mated::problems(&Pair::new(&connector, &design.alignment)), []);
}
