//! The observed border along each line of a plan.

use super::PredictedTrial;
use crate::plan::outwards;
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;
use serde::Serialize;
use std::collections::BTreeMap;

/// A line of trials, read outwards.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TrialLine {
    /// Its number in the table, from 1.
    #[serde(rename = "line")]
    pub number: usize,
    /// Number of trials on it.
    pub trials: usize,
    /// The outermost pose error that docked, in D and radians; null without a success.
    pub last_success: Option<PoseError>,
    /// The innermost pose error that failed to dock; null without a failure.
    pub first_failure: Option<PoseError>,
    /// The outermost pose error with a predicted success; null without one.
    pub predicted_success: Option<PoseError>,
    /// The innermost pose error with a predicted failure; null without one.
    pub predicted_failure: Option<PoseError>,
    /// Whether every success lies nearer to zero than every failure.
    pub in_order: bool,
}

/// The lines of a table, by their numbers; trials of no line are left out.
pub(super) fn lines(problem: &Problem, trials: &[PredictedTrial]) -> Vec<TrialLine> {
    let mut by_number: BTreeMap<usize, Vec<&PredictedTrial>> = BTreeMap::new();
    for trial in trials.iter().filter(|trial| trial.point.line > 0 && trial.docked.is_some()) {
        by_number.entry(trial.point.line).or_default().push(trial);
    }
    let far = |error: &PoseError| outwards(problem, error);
    let line = |(number, mut made): (usize, Vec<&PredictedTrial>)| {
        made.sort_by(|a, b| far(&a.point.error).total_cmp(&far(&b.point.error)));
        let last =
            |is: &dyn Fn(&PredictedTrial) -> bool| made.iter().rev().find(|t| is(t)).map(|t| t.point.error);
        let first = |is: &dyn Fn(&PredictedTrial) -> bool| made.iter().find(|t| is(t)).map(|t| t.point.error);
        let last_success = last(&|t| t.docked == Some(true));
        let first_failure = first(&|t| t.docked == Some(false));
        let in_order = last_success.zip(first_failure).is_none_or(|(a, b)| far(&a) < far(&b));
        TrialLine {
            number,
            trials: made.len(),
            last_success,
            first_failure,
            predicted_success: last(&|t| t.prediction().docks()),
            predicted_failure: first(&|t| !t.prediction().docks()),
            in_order,
        }
    };
    by_number.into_iter().map(line).collect()
}
