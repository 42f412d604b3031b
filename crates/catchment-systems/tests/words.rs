//! The page of the catalogue explains every word of table 1.1, with the values that the table prints and how often.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment_systems::catalog::{Catalog, CatalogAttribute};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

fn page() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/catalog.md")).unwrap()
}

#[test]
fn every_attribute_stands_in_the_page_with_its_values_and_their_counts() {
    let (page, catalog) = (page(), Catalog::published().unwrap());
    for attribute in CatalogAttribute::ALL {
        let start = format!("| {} | ", attribute.title());
        let row = page.lines().find(|line| line.starts_with(&start)).unwrap_or_else(|| panic!("{start}"));
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for value in catalog.systems.iter().filter_map(|system| system.printed(attribute)) {
            *counts.entry(value).or_default() += 1;
        }
        if attribute == CatalogAttribute::Introduced {
            let ends = [counts.keys().min().unwrap(), counts.keys().max().unwrap()];
            assert!(row.contains(&format!("{} … {}", ends[0], ends[1])), "{row}");
            continue;
        }
        let listed = row.trim_end_matches(" |").rsplit(" | ").next().unwrap();
        let mut listed: Vec<&str> = listed.split(", ").collect();
        listed.sort_unstable();
        let mut expected: Vec<String> =
            counts.iter().map(|(value, count)| format!("{value} {count}")).collect();
        expected.sort_unstable();
        assert_eq!(listed, expected, "{row}");
    }
}

#[test]
fn the_words_of_chapter_1_stand_in_the_page() {
    let page = page();
    for word in [
        "modular robot",
        "reconfigurable",
        "lattice",
        "chain",
        "mobile",
        "docking",
        "alignment",
        "latching",
        "gendered",
        "ungendered",
        "hermaphroditic",
    ] {
        assert!(page.lines().any(|line| line.starts_with(&format!("| {word} | "))), "{word}");
    }
}
