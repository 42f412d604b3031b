//! A run divided over machines: each decides a part, and the merged parts give the bits of the whole.
//!
//! ```text
//!   cells (or poses)   0 ──────────────────────────────── N
//!   part 0 of 3        ├─────────┤                            Run::part ──▶ PartAnswer (JSON, any order)
//!   part 1 of 3                  ├─────────┤                      │
//!   part 2 of 3                            ├──────────┤           ▼
//!                                                             Run::merge ──▶ Answer
//! ```
//!
//! A run is divisible if each pose is decided separately: a grid by `descent` or `drop`, and any range of the
//! random stream ([`Over::Stream`](super::Over::Stream)), pose k of which depends only on the seed and k. The
//! correction of a grid's Sum chooses its poses by earlier results, so it is computed when the parts are
//! merged.
//!
//! The grid of a method whose cells depend on each other is rejected. Confluence labels cells by rising
//! height across the whole box: every batch reads the results of all earlier batches, so a part would need
//! the others' labels thousands of times, and a part with only its own labels would inherit other outcomes
//! than the whole. Use a stream of random poses, or the same grid by `descent`; its outcomes equal
//! confluence's labels except for one or two cells in ten thousand.
//!
//! A part stores the digest of its problem and its run: parts that do not belong together are rejected.

use super::{Answer, Run, RunError, RunPlan, stages};
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::diagnostic::Warning;
use crate::exec::{Exec, Stopwatch};
use crate::method::{DecideError, MethodOutput};
use crate::problem::Problem;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Number of a part of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunPart {
    /// Number of the part, from 0.
    pub number: usize,
    /// Number of parts.
    pub of: usize,
}

impl RunPart {
    /// The poses of this part among `count`; the sizes of parts differ by at most 1.
    pub fn range(self, count: usize) -> Range<usize> {
        let of = self.of.max(1);
        let (each, more) = (count / of, count % of);
        let start = |number: usize| number * each + number.min(more);
        start(self.number.min(of))..start((self.number + 1).min(of))
    }
}

/// Results of one part of a run, from one machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartAnswer {
    /// Digest of the problem.
    pub problem: String,
    /// The run to which the part belongs.
    pub run: Run,
    /// Number of the part.
    pub part: RunPart,
    /// Outcomes of its poses in order: for each the first letter of the outcome's name.
    #[serde(with = "letters")]
    pub outcomes: Vec<Outcome>,
}

/// Why a run cannot be divided, or its parts make no whole.
#[derive(Debug, thiserror::Error)]
pub enum RunPartError {
    /// The cells of the method depend on each other.
    #[error(
        "{method} decides the cells of a grid from one another, so its grid cannot be divided; divide a stream of random poses, \
         or the grid of a method that follows each pose by itself, such as descent"
    )]
    Indivisible {
        /// Which method.
        method: &'static str,
    },
    /// No such part.
    #[error("there is no part {number} of {of}; parts are numbered from 0")]
    NoSuchPart {
        /// Its number.
        number: usize,
        /// How many there are.
        of: usize,
    },
    /// A part of another run or problem.
    #[error("part {number} belongs to another {what}")]
    Foreign {
        /// Its number.
        number: usize,
        /// `problem`, `run` or `division`.
        what: &'static str,
    },
    /// A part is missing, there twice, or has the wrong number of outcomes.
    #[error("part {number} {what}")]
    Incomplete {
        /// Its number.
        number: usize,
        /// The error.
        what: &'static str,
    },
    /// The run itself gives no answer.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl Run {
    /// Decides a part of this run.
    ///
    /// # Errors
    /// The run cannot be divided, the part does not exist, or the run fails.
    pub fn part(&self, problem: &Problem, part: RunPart, exec: &Exec) -> Result<PartAnswer, RunPartError> {
        if part.number >= part.of {
            return Err(RunPartError::NoSuchPart { number: part.number, of: part.of });
        }
        let plan = self.divisible(problem)?;
        plan.ensure_fits(exec).map_err(RunError::from)?;
        let poses = part.range(plan.domain.len()).map(|k| plan.domain.pose(k)).collect();
        let follower = stages::follower(&plan.method);
        let decided = follower.as_follow().follow(problem, Domain::Poses(poses), exec);
        let (acceptance, _) = decided.map_err(RunError::from)?;
        Ok(PartAnswer {
            problem: problem.digest().to_owned(),
            run: self.clone(),
            part,
            outcomes: acceptance.outcomes,
        })
    }

    /// Merges the parts of this run, in any order, and continues as [`Run::on`] does.
    ///
    /// # Errors
    /// The parts do not belong to this run and problem, or are incomplete.
    pub fn merge(
        &self,
        problem: &Problem,
        mut parts: Vec<PartAnswer>,
        exec: &Exec,
    ) -> Result<Answer, RunPartError> {
        let started = Stopwatch::start();
        let plan = self.divisible(problem)?;
        plan.ensure_fits(exec).map_err(RunError::from)?;
        parts.sort_by_key(|part| part.part.number);
        let of = parts.first().map_or(1, |part| part.part.of);
        let mut outcomes = Vec::with_capacity(plan.domain.len());
        for number in 0..of {
            let Some(part) = parts.get(number).filter(|part| part.part.number == number) else {
                let twice = parts.iter().any(|part| number > 0 && part.part.number == number - 1)
                    && parts.len() >= of;
                let (number, what) =
                    if twice { (number - 1, "is there twice") } else { (number, "is missing") };
                return Err(RunPartError::Incomplete { number, what });
            };
            let foreign = [
                (part.problem != problem.digest(), "problem"),
                (part.run != *self, "run"),
                (part.part.of != of, "division"),
            ];
            if let Some((_, what)) = foreign.into_iter().find(|(differs, _)| *differs) {
                return Err(RunPartError::Foreign { number, what });
            }
            if part.outcomes.len() != part.part.range(plan.domain.len()).len() {
                return Err(RunPartError::Incomplete { number, what: "has the wrong number of outcomes" });
            }
            outcomes.extend_from_slice(&part.outcomes);
        }
        if parts.len() > of {
            return Err(RunPartError::Incomplete { number: parts[of].part.number, what: "is there twice" });
        }
        let undecided = outcomes.iter().filter(|outcome| **outcome == Outcome::Undecided).count();
        let warnings =
            if undecided > 0 { vec![Warning::Undecided { cells: undecided }.into()] } else { Vec::new() };
        let method = plan.method.name();
        let acceptance = Acceptance { method, domain: plan.domain.clone(), outcomes, warnings };
        let decided = MethodOutput::plain(acceptance, plan.method.settings_for(problem));
        let upright = stages::upright(self, &plan, problem, exec)?;
        Ok(stages::finish(self, &plan, problem, (upright, decided), started, exec)?)
    }

    /// The plan, if it can be divided.
    fn divisible(&self, problem: &Problem) -> Result<RunPlan, RunPartError> {
        let plan = self.plan(problem)?;
        match plan.method.follows() {
            Some(_) => Ok(plan),
            None => Err(RunPartError::Indivisible { method: plan.method.name() }),
        }
    }
}

impl From<DecideError> for RunPartError {
    fn from(error: DecideError) -> Self {
        Self::Run(error.into())
    }
}

mod letters {
    //! Outcomes as a text of one letter each.

    use crate::acceptance::Outcome;
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    fn letter(outcome: Outcome) -> char {
        outcome.name().chars().next().unwrap_or('?')
    }

    pub(super) fn serialize<S: Serializer>(outcomes: &[Outcome], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&outcomes.iter().map(|outcome| letter(*outcome)).collect::<String>())
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Outcome>, D::Error> {
        let text = String::deserialize(deserializer)?;
        let read = |c: char| Outcome::ALL.into_iter().find(|outcome| letter(*outcome) == c);
        text.chars()
            .map(|c| {
                read(c).ok_or_else(|| D::Error::custom(format!("`{}` is no outcome", c.escape_default())))
            })
            .collect()
    }
}
