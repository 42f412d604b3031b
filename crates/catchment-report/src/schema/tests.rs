//! Written reports read back, with the names of the contract.

use super::testing::*;
use super::*;
use catchment_core::acceptance::{Domain, Outcome};
use catchment_core::diagnostic::Warning;
use catchment_core::pose::{DofSet, PoseError};

fn report() -> Report {
    let design = design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect());
    let settings = serde_json::json!({ "depth_tolerance": 0.1, "resolution": 12 });
    let blob = blob(&design, 12);
    let sigma = PoseError { x: 0.1, yaw: 0.2, ..PoseError::default() };
    let normal = Distribution::Normal { mean: PoseError::default(), sigma };
    Report::new(&design, &blob, settings, Some(Timing { total_s: 0.25, threads: 2 }), &Exec::new())
        .and_then(|r| r.with_success(&blob, &normal, &Exec::new()))
        .unwrap()
}

#[test]
fn written_reports_read_back_equal() {
    let report = report();
    let text = report.to_json().unwrap();
    assert_eq!(Report::from_json(&text).unwrap(), report);
    assert_eq!(Report::from_json(&text).unwrap().to_json().unwrap(), text);
}

#[test]
fn the_contract_names_its_fields() {
    let value: serde_json::Value = serde_json::from_str(&report().to_json().unwrap()).unwrap();
    assert_eq!(value["schema"], 4);
    assert_eq!(value["kind"], "run");
    assert_eq!(value["acceptance"]["sum"], value["acceptance"]["sum_grid"]);
    assert!(value["acceptance"]["sum_ci95"].is_null());
    assert_eq!(value["acceptance"]["unit"], "D²·rad");
    assert_eq!(value["acceptance"]["cells"], 12 * 12 * 12);
    let outcomes = value["acceptance"]["outcomes"].as_object().unwrap();
    assert_eq!(outcomes.keys().collect::<Vec<_>>(), ["aligned", "jammed", "missed", "undecided"]);
    assert!(value["onaa"]["edge"].as_f64().unwrap() > 0.0);
    assert_eq!(value["tolerances"][2]["axis"], "yaw");
    assert_eq!(value["success"]["distribution"]["kind"], "normal");
    assert!(value["success"]["probability"].as_f64().unwrap() > 0.9);
    assert_eq!(value["warnings"][0]["warning"]["kind"], "flooding-bias");
}

#[test]
fn warnings_of_the_set_itself_are_added_once() {
    let design = design([Dof::X, Dof::Y].into_iter().collect());
    let mut all = blob(&design, 4);
    all.outcomes.fill(Outcome::Aligned);
    all.outcomes[0] = Outcome::Undecided;
    all.warnings.push(Warning::Undecided { cells: 1 }.into());
    let report = Report::new(&design, &all, serde_json::Value::Null, None, &Exec::new()).unwrap();
    let border = Warning::TouchesBorder { axes: vec!["x".to_owned(), "y".to_owned()] };
    assert_eq!(report.warnings, [Warning::FloodingBias, Warning::Undecided { cells: 1 }, border]);
}

#[test]
fn listed_poses_have_an_interval_and_no_cubes() {
    let design = design(DofSet::ALL);
    let sample = Acceptance {
        method: "descent",
        domain: Domain::Poses(vec![PoseError::default(); 4]),
        outcomes: vec![Outcome::Aligned, Outcome::Jammed, Outcome::Aligned, Outcome::Undecided],
        warnings: Vec::new(),
    };
    let report = Report::new(&design, &sample, serde_json::Value::Null, None, &Exec::new()).unwrap();
    assert!(report.acceptance.sum_ci95.is_some() && report.onaa.is_none() && report.axes.is_empty());
    assert_eq!(Report::from_json(&report.to_json().unwrap()).unwrap(), report);
}
