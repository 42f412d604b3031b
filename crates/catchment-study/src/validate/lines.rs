//! Where the border was seen along each line of a plan.

use super::Judged;
use crate::plan::outwards;
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;
use std::collections::BTreeMap;

/// A line of trials, read outwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its number in the table.
    pub number: u64,
    /// Trials that were made on it.
    pub made: usize,
    /// The outermost pose that docked.
    pub last_success: Option<PoseError>,
    /// The innermost pose that did not.
    pub first_failure: Option<PoseError>,
    /// The outermost pose that was predicted to dock, and the innermost that was not.
    pub predicted: [Option<PoseError>; 2],
    /// Whether every pose that docked lies nearer to zero than every one that did not.
    pub in_order: bool,
}

/// The lines of a table, by their numbers; trials of no line are left out.
pub(super) fn lines(problem: &Problem, trials: &[Judged]) -> Vec<Line> {
    let mut by_number: BTreeMap<u64, Vec<&Judged>> = BTreeMap::new();
    for trial in trials.iter().filter(|trial| trial.tried.line > 0 && trial.seen.is_some()) {
        by_number.entry(trial.tried.line).or_default().push(trial);
    }
    let far = |error: &PoseError| outwards(problem, error);
    let line = |(number, mut made): (u64, Vec<&Judged>)| {
        made.sort_by(|a, b| far(&a.tried.error).total_cmp(&far(&b.tried.error)));
        let last = |is: &dyn Fn(&Judged) -> bool| made.iter().rev().find(|t| is(t)).map(|t| t.tried.error);
        let first = |is: &dyn Fn(&Judged) -> bool| made.iter().find(|t| is(t)).map(|t| t.tried.error);
        let last_success = last(&|t| t.seen == Some(true));
        let first_failure = first(&|t| t.seen == Some(false));
        let in_order = last_success.zip(first_failure).is_none_or(|(a, b)| far(&a) < far(&b));
        let predicted = [last(&|t| t.foretold.docks()), first(&|t| !t.foretold.docks())];
        Line { number, made: made.len(), last_success, first_failure, predicted, in_order }
    };
    by_number.into_iter().map(line).collect()
}
