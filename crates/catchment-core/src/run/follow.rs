//! Exact motions of given poses: outcomes and trajectories.

use crate::acceptance::{Acceptance, Domain, FailureReason, Outcome};
use crate::diagnostic::Warning;
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{self, End, Follower, Trajectory};
use crate::method::{DecideError, Method, PoseObserver};
use crate::pose::PoseError;
use crate::problem::Problem;
use std::sync::{Mutex, PoisonError};

/// Outcomes of listed poses.
#[derive(Debug, Clone, PartialEq)]
pub struct FollowedPoses {
    /// The outcomes of those that were finished.
    pub acceptance: Acceptance,
    /// The end of each of them.
    pub ends: Vec<End>,
    /// Numbers of the finished poses in the list, ascending, if the computation was stopped early; `None`:
    /// all.
    pub finished: Option<Vec<usize>>,
}

impl Problem {
    /// The rest of a pose, by exact quasi-static motion.
    pub fn follow(&self, pose: &PoseError) -> End {
        Follower::new(self.pair(), &descent::DescentSettings::default()).rest(pose)
    }

    /// The rests of all poses, in order, on all threads of `exec`.
    ///
    /// # Errors
    /// The computation was cancelled.
    pub fn follow_many(&self, poses: &[PoseError], exec: &Exec) -> Result<Vec<End>, Cancelled> {
        let domain = Domain::Poses(poses.to_vec());
        Ok(descent::rests(self.pair(), domain, &descent::DescentSettings::default(), exec)?.1)
    }

    /// The rests of all poses by a given method, and their outcomes.
    ///
    /// # Errors
    /// The cells of the method depend on each other, it failed, or the computation was cancelled.
    pub fn follow_by(
        &self,
        method: &Method,
        poses: &[PoseError],
        exec: &Exec,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        let follow = method.follows().ok_or(DecideError::NeedsGrid { method: method.name() })?;
        follow.rest(self, Domain::Poses(poses.to_vec()), exec)
    }

    /// The same; if the computation is cancelled, the poses finished until then are kept.
    ///
    /// # Errors
    /// The cells of the method depend on each other, it failed, or the computation was cancelled before any
    /// pose was finished.
    pub fn follow_keeping(
        &self,
        method: &Method,
        poses: &[PoseError],
        exec: &Exec,
    ) -> Result<FollowedPoses, DecideError> {
        self.follow_reporting(method, poses, exec, &|_, _| {})
    }

    /// The same; `observer` is called for every pose as soon as it is decided.
    ///
    /// # Errors
    /// As for [`Problem::follow_keeping`].
    pub fn follow_reporting(
        &self,
        method: &Method,
        poses: &[PoseError],
        exec: &Exec,
        observer: PoseObserver<'_>,
    ) -> Result<FollowedPoses, DecideError> {
        let follow = method.follows().ok_or(DecideError::NeedsGrid { method: method.name() })?;
        let kept = Mutex::new(Vec::new());
        let keep = |number, end| {
            kept.lock().unwrap_or_else(PoisonError::into_inner).push((number, end));
            observer(number, end);
        };
        match follow.rest_observed(self, Domain::Poses(poses.to_vec()), exec, &keep) {
            Ok((acceptance, ends)) => Ok(FollowedPoses { acceptance, ends, finished: None }),
            Err(DecideError::Cancelled(cancelled)) => {
                let mut kept: Vec<(usize, End)> = kept.into_inner().unwrap_or_else(PoisonError::into_inner);
                if kept.is_empty() {
                    return Err(cancelled.into());
                }
                kept.sort_unstable_by_key(|(number, _)| *number);
                let finished: Vec<usize> = kept.iter().map(|(number, _)| *number).collect();
                let ends: Vec<End> = kept.into_iter().map(|(_, end)| end).collect();
                let outcomes: Vec<Outcome> = ends.iter().map(|end| end.outcome).collect();
                let cells = outcomes.iter().filter(|outcome| **outcome == Outcome::Undecided).count();
                let warnings = if cells > 0 { vec![Warning::Undecided { cells }.into()] } else { Vec::new() };
                let domain = Domain::Poses(finished.iter().map(|number| poses[*number]).collect());
                let acceptance = Acceptance { method: method.name(), domain, outcomes, warnings };
                Ok(FollowedPoses { acceptance, ends, finished: Some(finished) })
            }
            Err(error) => Err(error),
        }
    }

    /// The trajectory of a pose from first contact to its rest, and the reason for a failure to dock, if it
    /// can be determined.
    pub fn trace(
        &self,
        start: &PoseError,
        settings: &descent::DescentSettings,
    ) -> (Trajectory, Option<FailureReason>) {
        let path = descent::trace(self.pair(), start, settings);
        let end = path.waypoints.last().map(|waypoint| waypoint.error);
        let reason = end.and_then(|end| FailureReason::of(self, path.outcome, &end));
        (path, reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::SourceText;
    use crate::problem::Draft;
    use std::sync::Arc;
    use std::sync::atomic::Ordering;

    fn v_face() -> Problem {
        let text =
            "[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n";
        Draft::read(SourceText::new("v.toml", text)).and_then(Draft::build).unwrap()
    }

    /// The results kept after a stop equal those of the complete computation, for any number of threads.
    #[test]
    fn finished_results_are_kept() {
        let problem = v_face();
        let poses: Vec<PoseError> = (0..4000)
            .map(|k| PoseError { x: f64::from(k) / 4000.0 - 0.5, pitch: 0.1, ..PoseError::default() })
            .collect();
        for (method, count) in [("descent", 4000), ("drop", 200)] {
            let (method, poses) = (method.parse().unwrap(), &poses[..count]);
            let whole = problem.follow_keeping(&method, poses, &Exec::new()).unwrap();
            assert_eq!((whole.ends.len(), &whole.finished), (count, &None));
            for threads in [1, 2, 4] {
                let exec = Exec::new().with_threads(threads).unwrap();
                let stop = exec.cancel_flag();
                // Stop at the first progress report.
                let exec = exec.with_progress(Arc::new(move |_, _| stop.store(true, Ordering::Relaxed)));
                let partial = problem.follow_keeping(&method, poses, &exec).unwrap();
                let finished = partial.finished.unwrap();
                assert!(!finished.is_empty() && finished.len() < count, "{} of {count}", finished.len());
                assert!(finished.is_sorted() && finished.len() == partial.ends.len());
                assert_eq!(partial.acceptance.outcomes.len(), finished.len());
                for (number, end) in finished.iter().zip(&partial.ends) {
                    assert_eq!(end, &whole.ends[*number], "pose {number}, {threads} threads");
                }
            }
        }
    }

    #[test]
    fn a_run_stopped_before_any_result_is_cancelled() {
        let exec = Exec::new();
        exec.cancel_flag().store(true, Ordering::Relaxed);
        let method = "descent".parse().unwrap();
        let result = v_face().follow_keeping(&method, &[PoseError::default()], &exec);
        assert!(matches!(result, Err(DecideError::Cancelled(_))));
    }
}
