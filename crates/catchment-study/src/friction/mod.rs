//! Effect of friction: the poses that dock at each coefficient, the critical friction, and the contacts that
//! stick first.
//!
//! ```text
//!   docks │▔▔▔▔▔╲
//!         │      ╲___        the same sampled poses of the error box at every friction, each by exact motion
//!         └───┬───┬──▶ μ     between two frictions of the ladder, bisection locates the loss of a pose
//! ```
//!
//! Friction changes the path of a half and may even help, so poses are lost and gained, and the outcomes at
//! a coefficient do not determine those at another: every pose is followed at every coefficient. The
//! *critical friction* of a pose that docks without friction is the smallest coefficient at which it fails.
//! For a design it is defined by a stated share: up to it 95 % of the poses that dock without friction still
//! dock. (The minimum over all poses would be zero: arbitrarily close to the border any friction has an
//! effect.)
//!
//! The study also applies a static test to the frictionless motion: the coefficient from which on some
//! contact forces would hold the half at some point of that motion ([`Follower::follow_holding`]). It needs a
//! single motion for all coefficients, and the report states how many poses it misclassifies.
//!
//! Rigid halves under Coulomb's law and slightly compliant halves, as real ones and those of engines are, may
//! differ at some poses. Two kinds of such poses are counted: those that dock with a tenth less friction
//! (`barely_stuck`), and those that *wedge* in a jam ([`FrictionAmbiguity::wedges`]).
//!
//! Not promised: that a pose lost at a coefficient is lost at all larger coefficients; coefficients
//! between the given ones are not tested.

mod may_stick;
mod report;
#[cfg(test)]
mod tests;

pub use may_stick::MayStick;
use report::by_share;

use catchment_core::acceptance::{Domain, Outcome};
use catchment_core::document::Share;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::DecisionMethod;
use catchment_core::method::correction::Z95;
use catchment_core::method::descent::{self, Follower, FrictionAmbiguity, FrictionOutOfRange, HARDLY};
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;
use catchment_core::run::jams::{NamedFeature, Sticks, stuck_pairs};
use serde::{Deserialize, Serialize};

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct FrictionSettings {
    /// Friction coefficients at which poses are followed, besides 0.
    pub frictions: Vec<f64>,
    /// Number of poses sampled from the error box. Default: 1000 for simple halves, fewer for halves with
    /// many facets.
    pub motions: Option<usize>,
    /// Seed of the samples.
    pub seed: u64,
}

impl Default for FrictionSettings {
    fn default() -> Self {
        Self { frictions: vec![0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5], motions: None, seed: 1 }
    }
}

/// Poses of a sample that is enough for a percent; the ladder takes as many motions of each as it has rungs, and more.
const FEWER: usize = 4;
/// Accuracy of the critical friction of a pose, a friction coefficient: the digits that are shown.
const EXACT: f64 = 1e-3;
/// Shares of the poses that dock without friction whose critical friction is reported.
const SHARES: [f64; 4] = [0.99, 0.95, 0.9, 0.5];
/// Poses for the contacts that stick first: this percentage of all poses that dock without friction, those
/// that are lost first, and at least this number.
const FIRST: usize = 10;
const AT_LEAST: usize = 20;

/// Effect of friction on a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Friction {
    /// The settings, with all defaults filled in.
    pub settings: FrictionSettings,
    /// Number of poses sampled from the error box, the same at every friction coefficient.
    pub motions: usize,
    /// Outcomes of the poses at every friction coefficient, 0 first.
    pub curve: Vec<FrictionLevel>,
    /// Critical friction by share: up to it this share of the poses that dock without friction still docks;
    /// `p95` is 95 %.
    #[serde(serialize_with = "by_share")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "report::kept_schema"))]
    pub kept: Vec<RetainedShare>,
    /// Contacts with stiction at the poses that are lost first.
    pub sticks_first: FirstSticking,
    /// Poses that are lost at some friction coefficient and dock again at a larger coefficient.
    pub come_back: usize,
}

/// Outcomes of the poses at a friction coefficient.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FrictionLevel {
    /// Friction coefficient.
    pub friction: f64,
    /// Poses that dock.
    pub aligned: Share,
    /// Poses that jam.
    pub jammed: Share,
    /// Poses that miss.
    pub missed: Share,
    /// Poses that are undecided.
    pub undecided: Share,
    /// Poses that dock without friction and not at this coefficient.
    pub lost: usize,
    /// Poses that dock at this coefficient and not without friction.
    pub gained: usize,
    /// Poses that dock, although Coulomb's law also permits stiction during their motion.
    pub may_stick: usize,
    /// Lost poses that dock with 10 % less friction: slightly compliant halves may dock there as well.
    pub barely_stuck: usize,
    /// Poses that jam and wedge: some contact forces would also resist a straight pull.
    pub wedged: usize,
    /// Poses that dock according to the static test along the frictionless motion.
    pub static_docks: usize,
    /// Poses that the static test misclassifies.
    pub static_wrong: usize,
}

/// Critical friction: the coefficient up to which a share of the poses that dock without friction still
/// docks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RetainedShare {
    /// Critical friction coefficient.
    pub share: f64,
    /// Up to this friction.
    pub friction: f64,
    /// Its 95 % interval, by order statistics; an end at the largest tried coefficient may lie anywhere
    /// beyond it.
    pub ci95: [f64; 2],
    /// Whether the value is the largest coefficient that was tried, and so only a lower bound.
    pub is_top: bool,
}

/// Contacts with stiction at the poses that are lost first.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FirstSticking {
    /// Number of poses examined: those that are lost first and stick.
    pub poses: usize,
    /// The pairs of features in contact there, most frequent first.
    pub features: Vec<StickingPair>,
}

/// A pair of features in contact at poses that stick.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StickingPair {
    /// Number of the poses with this contact.
    pub count: usize,
    /// Share of the poses with this contact.
    pub share: f64,
    /// Smallest friction coefficient at which one of these poses is lost.
    pub critical_least: f64,
    /// Median of the friction coefficients at which these poses are lost.
    pub critical_median: f64,
    /// The feature of the fixed half.
    pub fixed: NamedFeature,
    /// The feature of the moving half.
    pub moving: NamedFeature,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FrictionError {
    /// No coefficient of friction.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// An empty ladder.
    #[error("no friction above 0 is named; name some, such as 0.1 and 0.2")]
    NoFrictions,
    /// The number of motions is zero.
    #[error("no motions, no answer: follow one random pose at least")]
    NoMotions,
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Results for a single pose.
struct PoseByFriction {
    /// Outcome without friction, and at each coefficient together with the cases that Coulomb's law leaves
    /// open.
    without: Outcome,
    at: Vec<(Outcome, FrictionAmbiguity)>,
    /// Smallest friction coefficient at which some force on the frictionless motion would hold it; infinite
    /// if no given coefficient suffices.
    holds: f64,
    /// Coefficient up to which it docks, and the smallest at which it is known to fail; only for poses that
    /// dock without friction and are lost.
    critical: Option<[f64; 2]>,
}

/// Follows sampled poses of the error box at every friction coefficient.
///
/// # Errors
/// See [`FrictionError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment_core::design::read;
/// use catchment_core::exec::Exec;
/// use catchment_core::problem::Problem;
/// use catchment_study::friction::{self, FrictionSettings};
///
/// let text = "[connector]\nfamily = \"v-face\"\naspect_ratio = 0.1\n[alignment]\nfree = [\"x\"]\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let settings = FrictionSettings { frictions: vec![0.1, 0.3], motions: Some(100), seed: 1 };
/// let found = friction::run(&problem, &settings, &Exec::new())?;
/// // The facets of this V-Face have a slope of 0.2: half of the box docks below it, and nothing above
/// assert_eq!(found.curve[1].lost, 0);
/// // but what starts within the depth of the seat.
/// assert!(found.curve[2].aligned.count < 10);
/// # Ok(())
/// # }
/// ```
pub fn run(problem: &Problem, settings: &FrictionSettings, exec: &Exec) -> Result<Friction, FrictionError> {
    let settings = settings.filled(problem)?;
    let Domain::Poses(poses) =
        Domain::random(problem.alignment(), settings.motions.unwrap_or_default(), settings.seed)
    else {
        return Err(FrictionError::NoMotions);
    };
    let ladder: Vec<descent::DescentSettings> = settings
        .frictions
        .iter()
        .map(|mu| descent::DescentSettings::with_friction(*mu))
        .collect::<Result<_, _>>()?;
    let without = descent::DescentSettings::default();
    let top = settings.frictions.last().copied().unwrap_or_default();
    let tally = exec.tally(poses.len(), "poses");
    let start = || {
        let followers = ladder.iter().map(|settings| Follower::new(problem.pair(), settings));
        (Follower::new(problem.pair(), &without), followers.collect::<Vec<_>>())
    };
    let ways = exec.map_with(poses.len(), start, |(free, followers), k| {
        let way = PoseByFriction::of(problem, &poses[k], free, followers, &settings.frictions);
        tally.add(1);
        way
    })?;
    let first = first_lost(&poses, &ways);
    let (poses, sticks) = stuck_pairs(problem, &first, exec)?;
    let features = sticks.into_iter().map(|pair| StickingPair::of(pair, poses)).collect();
    Ok(Friction {
        motions: ways.len(),
        curve: rungs(&settings.frictions, &ways),
        kept: kept(&ways, top),
        sticks_first: FirstSticking { poses, features },
        come_back: ways.iter().filter(|way| way.comes_back()).count(),
        settings,
    })
}

impl FrictionSettings {
    /// Everything filled in, the ladder from below.
    fn filled(&self, problem: &Problem) -> Result<Self, FrictionError> {
        for friction in &self.frictions {
            descent::DescentSettings::with_friction(*friction)?;
        }
        let mut frictions: Vec<f64> =
            self.frictions.iter().copied().filter(|friction| *friction > 0.0).collect();
        frictions.sort_by(f64::total_cmp);
        frictions.dedup();
        if frictions.is_empty() {
            return Err(FrictionError::NoFrictions);
        }
        let motions = self.motions.unwrap_or_else(|| {
            descent::DescentSettings::default().default_samples(problem.pair()).div_ceil(FEWER)
        });
        if motions == 0 {
            return Err(FrictionError::NoMotions);
        }
        Ok(Self { frictions, motions: Some(motions), seed: self.seed })
    }
}

impl Friction {
    /// Smallest given coefficient at which poses wedge: from it on rigid halves under Coulomb's law and
    /// slightly compliant halves, as real ones are, may differ.
    pub fn wedges_from(&self) -> Option<f64> {
        self.curve.iter().find(|rung| rung.wedged > 0).map(|rung| rung.friction)
    }
}

impl StickingPair {
    fn of(Sticks { touching, critical }: Sticks, poses: usize) -> Self {
        Self {
            count: touching.count,
            share: touching.count as f64 / poses.max(1) as f64,
            critical_least: critical.first().copied().unwrap_or_default(),
            critical_median: critical.get(critical.len() / 2).copied().unwrap_or_default(),
            fixed: touching.fixed,
            moving: touching.moving,
        }
    }
}

impl PoseByFriction {
    fn of(
        problem: &Problem,
        pose: &PoseError,
        free: &mut Follower<'_>,
        followers: &mut [Follower<'_>],
        frictions: &[f64],
    ) -> Self {
        let top = frictions.last().copied().unwrap_or_default();
        let (end, holds) = free.follow_holding(pose, top);
        let at: Vec<(Outcome, FrictionAmbiguity)> = followers
            .iter_mut()
            .map(|follower| {
                let (end, doubt) = follower.follow_doubting(pose);
                (end.outcome, doubt)
            })
            .collect();
        let docks = end.outcome == Outcome::Aligned;
        let lost = at.iter().position(|(outcome, _)| *outcome != Outcome::Aligned).filter(|_| docks);
        let critical = lost.map(|k| {
            let docks_at = |friction: f64| {
                let settings = descent::DescentSettings { friction, ..descent::DescentSettings::default() };
                descent::outcome(problem.pair(), pose, &settings).outcome == Outcome::Aligned
            };
            let [mut docks, mut fails] = [if k == 0 { 0.0 } else { frictions[k - 1] }, frictions[k]];
            while fails - docks > EXACT {
                let middle = f64::midpoint(docks, fails);
                if docks_at(middle) { docks = middle } else { fails = middle }
            }
            [docks, fails]
        });
        Self { without: end.outcome, at, holds: if holds < top { holds } else { f64::INFINITY }, critical }
    }

    /// Whether it docks without friction and, within the bisection, at least up to this coefficient.
    fn docks_with(&self, friction: f64) -> bool {
        self.critical.is_some_and(|[docks, _]| docks >= friction)
    }

    /// Whether it is lost at some coefficient and docks at a larger coefficient.
    fn comes_back(&self) -> bool {
        let docks = |(outcome, _): &&(Outcome, FrictionAmbiguity)| *outcome == Outcome::Aligned;
        self.without == Outcome::Aligned
            && self.at.iter().skip_while(docks).any(|(outcome, _)| *outcome == Outcome::Aligned)
    }
}

fn rungs(frictions: &[f64], ways: &[PoseByFriction]) -> Vec<FrictionLevel> {
    let rung = |(k, friction): (Option<usize>, f64)| {
        let at = |way: &PoseByFriction| k.map_or((way.without, FrictionAmbiguity::default()), |k| way.at[k]);
        let count = |is: &dyn Fn(&PoseByFriction) -> bool| ways.iter().filter(|way| is(way)).count();
        let docks = |way: &PoseByFriction| at(way).0 == Outcome::Aligned;
        let docked = |way: &PoseByFriction| way.without == Outcome::Aligned;
        let by_statics = |way: &PoseByFriction| docked(way) && way.holds > friction;
        let ended = |outcome: Outcome| Share::of(count(&|way| at(way).0 == outcome), ways.len());
        FrictionLevel {
            friction,
            aligned: ended(Outcome::Aligned),
            jammed: ended(Outcome::Jammed),
            missed: ended(Outcome::Missed),
            undecided: ended(Outcome::Undecided),
            lost: count(&|way| docked(way) && !docks(way)),
            gained: count(&|way| !docked(way) && docks(way)),
            may_stick: count(&|way| docks(way) && at(way).1.may_stick),
            barely_stuck: count(&|way| !docks(way) && way.docks_with(friction / HARDLY)),
            wedged: count(&|way| at(way).1.wedges),
            static_docks: count(&|way| by_statics(way)),
            static_wrong: count(&|way| by_statics(way) != docks(way)),
        }
    };
    let ladder = frictions.iter().enumerate().map(|(k, friction)| (Some(k), *friction));
    std::iter::once((None, 0.0)).chain(ladder).map(rung).collect()
}

/// Quantiles of the critical friction, with intervals by order statistics (Conover, *Practical Nonparametric Statistics*, 3.2): ranks
/// n q ± 1.96 √(n q (1 − q)), rounded outwards.
fn kept(ways: &[PoseByFriction], top: f64) -> Vec<RetainedShare> {
    let mut critical: Vec<f64> = ways
        .iter()
        .filter(|way| way.without == Outcome::Aligned)
        .map(|way| way.critical.map_or(top, |[docks, _]| docks))
        .collect();
    critical.sort_by(f64::total_cmp);
    let count = critical.len();
    // The friction up to which all but `lost` poses dock.
    let of_rank = |lost: f64| {
        let rank = lost.clamp(0.0, count as f64);
        if rank >= count as f64 { top } else { critical[rank as usize] }
    };
    let of_share = |share: f64| {
        let (expected, spread) =
            ((1.0 - share) * count as f64, Z95 * (share * (1.0 - share) * count as f64).sqrt());
        let friction = of_rank((expected + 1e-9).floor());
        let low = if expected - spread < 1.0 { 0.0 } else { of_rank((expected - spread).floor() - 1.0) };
        RetainedShare {
            share,
            friction,
            ci95: [low, of_rank((expected + spread).ceil())],
            is_top: friction >= top,
        }
    };
    SHARES.map(of_share).to_vec()
}

/// The poses that are lost first, each with a friction at which it is.
fn first_lost(poses: &[PoseError], ways: &[PoseByFriction]) -> Vec<(PoseError, f64)> {
    let docked = ways.iter().filter(|way| way.without == Outcome::Aligned).count();
    let lost = poses.iter().zip(ways).filter_map(|(pose, way)| way.critical.map(|[_, fails]| (*pose, fails)));
    let mut lost: Vec<(PoseError, f64)> = lost.collect();
    // A stable sort: equal values stay in sample order.
    lost.sort_by(|a, b| a.1.total_cmp(&b.1));
    lost.truncate((docked * FIRST / 100).max(AT_LEAST));
    lost
}
