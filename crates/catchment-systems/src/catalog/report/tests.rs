//! Lines that fit, normal forms next to printed values, hostile names.

use super::*;

#[test]
fn every_line_fits_a_terminal_and_every_system_can_be_shown() {
    let catalog = Catalog::published().unwrap();
    let report = CatalogBody::report(&catalog);
    let shown: Vec<String> =
        catalog.systems.iter().map(|system| SystemBody::report(system).table()).collect();
    for text in shown.iter().chain([&report.table()]) {
        for line in text.lines() {
            assert!(line.chars().count() <= 80, "{line}");
        }
    }
    let dragon = SystemBody::report(catalog.find("DRAGON").unwrap()).table();
    assert!(
        dragon.contains("[D] table 2.1") && dragon.contains("Ø/5") && dragon.contains("0.1257 D²"),
        "{dragon}"
    );
    let jhu = SystemBody::report(catalog.find("JHU").unwrap()).table();
    assert!(jhu.contains("[I]") && jhu.contains("attributes are not stated"), "{jhu}");
}

#[test]
fn normal_forms_stand_beside_the_printed_ones_everywhere() {
    let report = CatalogBody::report(&Catalog::published().unwrap());
    let records = report.records();
    assert!(records.iter().all(|record| record.len() == 2 + 22 + 4) && records.len() == 32);
    let fracta = records.iter().find(|record| record[0] == "Fracta 2D").unwrap();
    assert!(fracta.windows(2).any(|pair| pair == ["Magnet", "Magnetic"]), "{fracta:?}");
    assert!(report.markdown().contains("| Magnet → Magnetic |"));
    assert!(report.table().contains("Active!") && report.table().contains("is read as None [I]"));
    let json: serde_json::Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
    assert_eq!(json["kind"], "catalog");
    let ckbot = json["systems"].as_array().unwrap().iter().find(|s| s["system"] == "CKBot (SAE)").unwrap();
    assert_eq!(ckbot["attributes"]["self_aligning_degree"]["printed"], "Active");
    assert_eq!(ckbot["attributes"]["self_aligning_degree"]["normal"], "None");
}

#[test]
fn a_hostile_name_stays_in_its_cell() {
    let mut catalog = Catalog::published().unwrap();
    let name = "a|b\u{1b}[2J which is far too long for a table".to_owned();
    catalog.systems.truncate(1);
    catalog.systems[0].name = name;
    let report = CatalogBody::report(&catalog);
    assert!(report.markdown().contains("| a\\|b?[2J which"));
    assert!(report.records()[1][0].starts_with("a|b?[2J"));
    assert!(report.table().lines().all(|line| line.chars().count() <= 80));
}
