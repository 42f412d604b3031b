//! The seat, and the residual misalignment of docked halves: the repeatability of the connector.
//!
//! ```text
//!   play       offsets at which a half lies as deep as the seat            [`crate::contact::play`]
//!   residual   residual misalignment of accepted poses, per error          sampled accepted poses, followed to their end
//! ```
//!
//! Not promised: the poses are sampled uniformly from the accepted set, not from the errors of a robot.
//! Lengths in D, angles in radians.

use crate::acceptance::{Acceptance, Domain, Outcome, Stream};
use crate::contact::display_unit::DisplayUnit;
use crate::contact::mated::{CONTACT_TOLERANCE, MatedProblem};
use crate::contact::{Pair, Play, Seat, play};
use crate::design::ConnectorSpec;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{self, End, Follower};
use crate::method::{DecisionMethod, motions_in};
use crate::pose::{Dof, PoseError, rotation, rotation_angle};
use crate::problem::{Problem, ProblemError};
use crate::tolerance;
use serde::{Deserialize, Serialize};

/// The seat, and the residual misalignment of docked poses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Seating {
    /// Largest height above the mated height at which a half at rest counts as docked, in D.
    pub depth: f64,
    /// Play of the seat per free error that counts; at least as large as the residual misalignment of the
    /// docked poses.
    pub play: Vec<Play>,
    /// Number of accepted poses that were followed to rest.
    pub poses: usize,
    /// Residual misalignment of these poses per free error that counts; empty if no pose was followed.
    pub residual: Vec<Residual>,
    /// The deepest rest, if it lies below the mated pose, which is then not a rest itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deeper: Option<Deeper>,
}

/// A rest below the mated pose, in the same seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Deeper {
    /// Depth below the mated pose, in D.
    pub sinks: f64,
    /// Pose error of this rest.
    pub error: PoseError,
}

/// Residual misalignment of docked poses in one error, as absolute values. D or radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Residual {
    /// The error.
    pub axis: Dof,
    /// Mean.
    pub mean: f64,
    /// 95 % of the poses have less.
    pub p95: f64,
    /// Maximum.
    pub most: f64,
}

/// One motion of this many behind a Sum is followed to its rest; at least as many as determine a 95 %
/// quantile, unless these take longer than this on one core, in seconds.
const SHARE: usize = 20;
const FEWEST: usize = 40;
const LONGEST: f64 = 12.0;
/// Cells tried for every wanted accepted cell.
const LOOKS: u64 = 50;
/// Rests closer than this are the mated pose, in D and radians: the accuracy of motion ends.
const NONE: f64 = tolerance::TOUCHING;
/// The poses have random numbers of their own.
const BRANCH: u64 = 0x5ea7;

impl Seating {
    /// The seat of a problem, and the rests of accepted poses in it.
    pub(super) fn of(
        problem: &Problem,
        acceptance: &Acceptance,
        settings: &descent::DescentSettings,
        seed: u64,
        exec: &Exec,
    ) -> Result<Self, Cancelled> {
        let pair = problem.pair();
        let count = (settings.default_samples(pair) / SHARE).max(FEWEST.min(motions_in(LONGEST, pair)));
        let poses = accepted(acceptance, count as u64, seed);
        let follow = |follower: &mut Follower<'_>, k: usize| follower.rest(&poses[k]);
        let ends = exec.map_with(poses.len(), || Follower::new(pair, settings), follow)?;
        let seat = Seat::new(pair);
        let docked: Vec<End> = ends.into_iter().filter(|end| end.outcome == Outcome::Aligned).collect();
        let offs: Vec<[f64; 5]> = docked.iter().map(|end| seat.off(&end.error).to_array()).collect();
        let mut play = play(pair);
        // All rests in the seat are part of the play, regardless of how they were found.
        for play in &mut play {
            let rests = offs.iter().map(|off| off[play.axis.index()]).filter(|off| off.abs() > NONE);
            play.minus = rests.clone().fold(play.minus, |most, off| most.max(-off));
            play.plus = rests.fold(play.plus, f64::max);
        }
        let residual = match offs.len() {
            0 => Vec::new(),
            _ => play.iter().map(|play| Residual::of(play.axis, &offs)).collect(),
        };
        let deeper = Deeper::of(pair, &docked);
        Ok(Self { depth: pair.alignment.docked.depth, play, poses: offs.len(), residual, deeper })
    }

    /// Its warnings: halves that rest farther off than the computed play of the seat.
    pub fn warnings(&self, problem: &Problem) -> Vec<Diagnostic> {
        let docked = &problem.alignment().docked;
        let far =
            self.residual.iter().filter(|residual| residual.most > 1.01 * docked.most_play(residual.axis));
        let unit = DisplayUnit::of(problem.design());
        let far = far.map(|residual| {
            let text = format!(
                "docked halves rest up to {} off in {}: state in [docked] how far off still counts as docked",
                unit.amount(residual.axis, residual.most),
                residual.axis.name()
            );
            Diagnostic::warning("rests-off", text)
        });
        let deeper = self.deeper.iter().map(|Deeper { sinks, error }| {
            let text = format!(
                "the mated pose does not hold: docked halves rest {} deeper, at {}; draw the halves so that this is the mated pose",
                unit.length(*sinks),
                unit.error(error)
            );
            Diagnostic::warning("deeper-rest", text)
        });
        let leaks = Seat::new(problem.pair()).leaks().then(|| {
            let text = format!(
                "the seat leaks: its rim is lower than docked.depth, {} above the mated pose, so every motion is followed until it rests; \
                 give a smaller depth if only what is in the hollow is docked",
                unit.length(docked.depth)
            );
            Diagnostic::warning("leaky-seat", text)
        });
        far.chain(deeper).chain(leaks).collect()
    }
}

impl Deeper {
    /// The deepest of these rests, if it is below the mated pose by more than the rounding of drawings.
    fn of(pair: &Pair, rests: &[End]) -> Option<Self> {
        let sinks =
            |end: &End| Some((pair.mated_energy() - pair.energy_at(&end.error, end.height?), end.error));
        let (sinks, error) = rests.iter().filter_map(sinks).max_by(|a, b| a.0.total_cmp(&b.0))?;
        (sinks > CONTACT_TOLERANCE).then_some(Self { sinks, error })
    }
}

impl Residual {
    fn of(axis: Dof, offs: &[[f64; 5]]) -> Self {
        let mut off: Vec<f64> = offs.iter().map(|off| off[axis.index()].abs()).collect();
        off.sort_by(f64::total_cmp);
        let rank = (0.95 * off.len() as f64).ceil() as usize;
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        Self { axis, mean, p95: off[rank.saturating_sub(1)], most: off[off.len() - 1] }
    }
}

/// Up to `count` random poses from accepted cells, or from accepted poses.
fn accepted(acceptance: &Acceptance, count: u64, seed: u64) -> Vec<PoseError> {
    let stream = Stream::new(seed).branch(BRANCH);
    let of = acceptance.outcomes.len();
    let pick = |k: u64| {
        let number = |j: u64| stream.uniform(6 * k + j);
        let cell = ((number(0) * of as f64) as usize).min(of.saturating_sub(1));
        if acceptance.outcomes.get(cell) != Some(&Outcome::Aligned) {
            return None;
        }
        let Domain::Grid(grid) = &acceptance.domain else { return Some(acceptance.domain.pose(cell)) };
        let mut error = grid.pose(cell).to_array();
        for (axis, j) in grid.axes.iter().zip(1..) {
            error[axis.dof.index()] += axis.step() * (number(j) - 0.5);
        }
        Some(PoseError::from_array(error))
    };
    (0..LOOKS * count).filter_map(pick).take(count as usize).collect()
}

impl Problem {
    /// The rest of a half released at zero error: its start, if the mated pose is a rest.
    pub fn settled(&self) -> End {
        Follower::new(self.pair(), &descent::DescentSettings::default()).rest(&PoseError::default())
    }

    /// This problem, unless its mated pose does not hold.
    ///
    /// # Errors
    /// As [`Problem::ensure_held`].
    pub fn checked(self) -> Result<Self, ProblemError> {
        self.ensure_held()?;
        Ok(self)
    }

    /// Rejects a mated pose that is not stable: no motion ends in it, so that an area of acceptance around it
    /// has no meaning.
    ///
    /// # Errors
    /// It is not stable, with the distance to the rest of the half.
    pub fn ensure_held(&self) -> Result<(), Diagnostics> {
        let (message, advice) = match self.mated_warnings().iter().find(|problem| is_unstable(problem)) {
            Some(problem) => (self.sentence(problem), self.advice(problem)),
            None => match self.fallen() {
                Some(message) => (message, None),
                None => return Ok(()),
            },
        };
        Err(self.refused("alignment.free", message, advice))
    }

    /// Warnings about the mated pose: with the rest that the half reaches instead, if it is not stable.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let problems = self.mated_warnings();
        let fallen = if problems.iter().any(is_unstable) { None } else { self.fallen() };
        let sentences = problems.iter().map(|problem| self.sentence(problem)).chain(fallen);
        sentences.map(|text| Diagnostic::warning("mated-pose", text)).collect()
    }

    /// A warning as a sentence; for an unstable mated pose with the distance to the rest of the half and the
    /// remedy.
    fn sentence(&self, problem: &MatedProblem) -> String {
        let unit = DisplayUnit::of(self.design());
        let stated = problem.in_words(unit);
        if !is_unstable(problem) {
            return stated;
        }
        let End { outcome, error, height } = self.settled();
        if outcome == Outcome::Missed {
            return format!(
                "{stated}. Released without an error the half runs off: draw the halves so that they hold each other where they are mated"
            );
        }
        if error.to_array().into_iter().all(|part| part.abs() <= CONTACT_TOLERANCE) {
            return format!(
                "{stated}. Released without an error the half balances, and any push lets it fall: draw the halves so that they are mated where they rest"
            );
        }
        let turn = rotation_angle(&rotation(error.roll, error.pitch, error.yaw));
        let sinks = height.map_or(0.0, |height| self.pair().mated_height() - height);
        let takes = match &self.design().connector {
            ConnectorSpec::Own(own) if !own.settle => {
                "draw the halves in that pose, or take it as mated: settle = true in [connector]"
            }
            ConnectorSpec::Own(_) => "draw the halves in that pose",
            ConnectorSpec::Family(_) => "lock what moves there, or move the centre of rotation",
        };
        format!(
            "{stated}. Released without an error the half comes to rest {} and {} away, {} deeper, at {}: {takes}",
            unit.length(error.x.hypot(error.y)),
            unit.amount(Dof::Yaw, turn),
            unit.length(sinks),
            unit.error(&error),
        )
    }

    /// A warning that halves slightly off come to rest below the seat, if they do.
    fn fallen(&self) -> Option<String> {
        let fall = descent::fall(self.pair())?;
        let unit = DisplayUnit::of(self.design());
        Some(format!(
            "{}: draw the halves so that they are mated where they rest, or lock the degree of freedom in which they tip",
            fall.in_words(unit)
        ))
    }
}

/// Whether the mated pose does not hold.
const fn is_unstable(problem: &MatedProblem) -> bool {
    matches!(problem, MatedProblem::NotMinimum { .. })
}
