//! Content of a report, and its round trip.

use super::super::file::ChainFile;
use super::super::study::{ChainSettings, run};
use super::*;
use catchment::design::SourceText;
use catchment::exec::Exec;

fn reported(text: &str, settings: &ChainSettings) -> ChainReport {
    let file = ChainFile::read(SourceText::new("c.toml", text)).unwrap();
    let study = run(&file, settings, &Exec::new()).unwrap();
    report(&study, &[], None)
}

#[test]
fn a_report_reads_back_and_keeps_to_its_columns() {
    let few = ChainSettings { chains: 50, ..ChainSettings::default() };
    let texts = [
        "[chain]\njoint_sigma = '1 deg'",
        "[chain]\njoint_sigma = '1 deg'\n[sequence]\nname = 'O'",
        "[sequence]\nname = 'Block'\nreading = 'B'",
    ];
    for text in texts {
        let report = reported(text, &few);
        let json = report.to_json().unwrap();
        let back = ChainReport::from_json(&json).unwrap();
        assert_eq!(back.to_json().unwrap(), json);
        assert!(json.contains("\"kind\": \"chain\""));
        let table = report.table();
        let widest = table.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(widest <= 80, "{widest} columns:\n{table}");
    }
}

#[test]
fn poses_are_listed_step_by_step() {
    let report = reported("[sequence]\nname = 'P'", &ChainSettings { chains: 1, ..ChainSettings::default() });
    let records = report.records();
    assert_eq!(records[0], ["t", "module", "x", "y", "heading", "command", "state"]);
    assert_eq!(records.len(), 1 + 6 * 6);
    assert_eq!(records[1], ["0", "1", "0", "0", "0", "0", "holding"]);
    let [.., command, state] = &records[1 + 2 * 6 + 4][..] else { panic!() };
    assert_eq!((command.as_str(), state.as_str()), ("-1.74", "stalled"));
    assert!(records.last().unwrap()[1] == "6" && records[1 + 5 * 6 + 3][5] == "slack");
}

#[test]
fn a_latch_that_does_not_hold_is_a_warning() {
    let report = reported(
        "[sequence]\nname = 'P'\n[servo]\ntorque = 0.8",
        &ChainSettings { chains: 1, ..ChainSettings::default() },
    );
    assert_eq!(report.warnings.len(), 1);
    let printout = &report.warnings[0].message;
    assert!(
        printout.starts_with("3–6 holds with 0 of 2 layers: pressed with 8.")
            && printout.ends_with("a layer needs 9.61 N"),
        "{printout}"
    );
}

#[test]
fn the_reach_is_the_last_row_before_the_first_that_fails() {
    let row = |modules, probability| Length {
        joint_sigma_rad: 0.1,
        modules,
        lateral_sigma_d: 0.0,
        heading_sigma_rad: 0.0,
        docking: Some(Probability { probability, ci95: [probability - 0.006, 1.0] }),
        offset_probability: None,
    };
    let rows = [row(2, 1.0), row(3, 0.995), row(4, 0.98), row(5, 0.999)];
    assert_eq!((reach(&rows, &[])[0].modules, reach(&rows, &[])[0].surely), (Some(3), Some(2)));
    assert_eq!(reach(&rows, &["probability>0.999".parse().unwrap()])[0].modules, Some(2));
    assert_eq!(reach(&rows[2..3], &["probability>0.999".parse().unwrap()])[0].modules, None);
    // A requirement on another quantity leaves the default requirement.
    assert_eq!(
        reach(&rows, &["modules>3".parse().unwrap()])[0].requirement.to_string(),
        "probability >= 0.99"
    );
}
