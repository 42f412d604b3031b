//! Holding forces and torques of a docked half, in every direction.
//!
//! ```text
//!          │ preload                        y  ╭───╮
//!          ▼                                 ╭─╯   ╰─╮   largest sideways force before it leaves the seat,
//!    ───╲─────╱─── ◀── sideways          ───┤   ·   ├─ x      over the direction; and the largest torque
//!        ╲___╱    ⤺ torque                  ╰─╮   ╭─╯        about each free axis, in either sense
//!                                              ╰───╯
//! ```
//!
//! The half rests in its mated pose, or in the rest that a given pose reaches, with a preload along −z
//! through its centre of rotation. Lateral forces act through the face centre of the moving half or
//! [`HoldSettings::lever`] above it, torques about the centre of rotation. Each is computed in two ways
//! ([`catchment_core::method::descent::Holding`]):
//!
//! - **guided**: the half can move only in the direction of the load and up. This is the preload times the
//!   slope of the height of first contact in that direction.
//! - **free**: the half can move in all free errors and up. Tilting may be easier, so this value is never
//!   larger.
//!
//! All numbers are shares of the preload, torques of the preload times D; `None`: no load of that kind moves
//! the half. The frictionless value is a lower bound on the value with any friction.
//!
//! Not promised: effects beyond rigid halves and Coulomb's law, see [`Holding`]. The weakest direction is
//! searched near the weakest of the tried directions: a narrower notch between two of them is missed.

mod report;
#[cfg(test)]
mod tests;

use catchment_core::acceptance::Outcome;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent::{
    self, Follower, FrictionOutOfRange, Guide, Holding, Load, TOUCHING, Touch,
};
use catchment_core::pose::{Dof, PoseError, face_from_cor};
use catchment_core::problem::Problem;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct HoldSettings {
    /// Friction coefficient between the halves; 0 for a frictionless contact.
    pub friction: f64,
    /// Number of lateral directions that are tried if both x and y are free.
    pub directions: usize,
    /// Height above the face centre of the moving half at which lateral forces act, in D.
    pub lever: f64,
    /// Largest gap that counts as contact, in D: play that is treated as taken up.
    pub play: f64,
    /// Pose error at which the half is released; the rest that it reaches is tested. Null: the mated pose.
    pub pose: Option<PoseError>,
}

impl Default for HoldSettings {
    fn default() -> Self {
        Self { friction: 0.0, directions: 72, lever: 0.0, play: TOUCHING, pose: None }
    }
}

/// Number of preloads, or preloads times D, that represents an infinite load in numbers.
pub const ANY: f64 = catchment_core::method::descent::MOST_LOAD;

/// Fewest and most directions: the axes, and a tenth of a degree.
const DIRECTIONS: [usize; 2] = [4, 3600];

/// Holding force or torque for a load: as a share of the preload, or of the preload times D.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LoadLimit {
    /// If the half can move only in the direction of the load and up; null: any load is resisted.
    pub guided: Option<f64>,
    /// If the half can move in all free errors and up; null: any load is resisted.
    pub free: Option<f64>,
}

/// Resistance to a load without and with friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LoadLimits {
    /// Without friction; null if the preload is held only by friction.
    pub smooth: Option<LoadLimit>,
    /// With the friction of the settings; null if that is 0.
    pub rough: Option<LoadLimit>,
}

/// A lateral force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sideways {
    /// Its direction from x towards y, in radians, in [0, 2π).
    pub direction_rad: f64,
    /// Holding force in this direction.
    #[serde(flatten)]
    pub withstood: LoadLimits,
}

/// A torque about the axis of a free error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Torque {
    /// Axis of the torque: roll x, pitch y, yaw z.
    pub axis: Dof,
    /// Sign of the torque: 1 or −1.
    pub sign: f64,
    /// Holding torque.
    #[serde(flatten)]
    pub withstood: LoadLimits,
}

/// The weakest lateral directions; null if any force is resisted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Weakest {
    /// Without friction, guided.
    pub smooth_guided: Option<Sideways>,
    /// Without friction, free.
    pub smooth_free: Option<Sideways>,
    /// With friction, guided.
    pub rough_guided: Option<Sideways>,
    /// With friction, free.
    pub rough_free: Option<Sideways>,
}

/// Holding forces as shares of the preload, holding torques as shares of the preload times D.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HoldingForces {
    /// The settings.
    pub settings: HoldSettings,
    /// The preload, in N; null if it is not known. If it is, texts state forces in N.
    pub preload_n: Option<f64>,
    /// Pose error of the rest.
    pub pose: PoseError,
    /// Outcome of the rest: whether it counts as docked.
    pub outcome: Outcome,
    /// z of the centre of rotation at the rest, in D.
    pub height_d: f64,
    /// Contact points.
    pub contacts: Vec<Touch>,
    /// Lateral forces by direction; only those along x or y if only that error is free.
    pub sideways: Vec<Sideways>,
    /// The weakest direction for each combination.
    pub weakest: Weakest,
    /// Torques about the free axes, with both signs.
    pub torques: Vec<Torque>,
    /// Smallest holding force over all lateral forces in free errors, with friction if the settings have any;
    /// 10⁶ if any force is resisted, null if no lateral force can act because x and y are locked.
    pub least_force: Option<f64>,
    /// Smallest holding torque, likewise; null if rotations are locked.
    pub least_torque: Option<f64>,
}

/// Reason why holding forces cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HoldError {
    /// The friction coefficient is invalid.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// Too few directions, or too many.
    #[error("{directions} directions: from {} to {} can be tried", DIRECTIONS[0], DIRECTIONS[1])]
    Directions {
        /// The given number.
        directions: usize,
    },
    /// An invalid length.
    #[error("{what}: {value} is no length here: {wanted}")]
    Length {
        /// Which.
        what: &'static str,
        /// The given value, in D.
        value: f64,
        /// The permitted values.
        wanted: &'static str,
    },
    /// The pose does not reach a rest.
    #[error("let go at that pose error the half comes to no rest that could be held: its motion is {}", outcome.name())]
    NoRest {
        /// Its outcome.
        outcome: Outcome,
    },
    /// The rest is not in balance.
    #[error("the preload alone moves the half where it should rest: its contacts there do not hold it")]
    NotHeld,
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Computes the holding forces of a half.
///
/// # Errors
/// See [`HoldError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment_core::design::read;
/// use catchment_core::exec::Exec;
/// use catchment_core::problem::Problem;
/// use catchment_study::hold::{self, HoldSettings};
///
/// // Flanks of slope 2 AR.
/// let text = "[connector]\nfamily = \"v-face\"\naspect_ratio = 0.5\n[alignment]\nrotation_length = 1.0\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let found = hold::run(&problem, &HoldSettings::default(), &Exec::new())?;
/// let guided = found.sideways[0].withstood.smooth.and_then(|of| of.guided);
/// assert!((guided.unwrap_or_default() - 1.0).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
pub fn run(problem: &Problem, settings: &HoldSettings, exec: &Exec) -> Result<HoldingForces, HoldError> {
    let motion = settings.check()?;
    let pair = problem.pair();
    let (pose, outcome, rest) = match &settings.pose {
        None => (PoseError::default(), Outcome::Aligned, None),
        Some(pose) => {
            let end = Follower::new(pair, &motion).come_to_rest(pose);
            (end.error, end.outcome, end.height.map(|height| (height, end.touching)))
        }
    };
    if matches!(outcome, Outcome::Missed | Outcome::Undecided) {
        return Err(HoldError::NoRest { outcome });
    }
    // The rest provides the active contacts exactly; a gap limit applies only if play is to count as used.
    let near =
        |touching: f64| if settings.play > TOUCHING { settings.play } else { settings.play.min(touching) };
    let holding = match rest {
        Some((height, touching)) => Holding::at_rest(pair, &pose, height, near(touching)),
        None => Holding::at(pair, &pose, settings.play),
    };
    let Some(mut holding) = holding else {
        return Err(HoldError::NoRest { outcome: Outcome::Missed });
    };
    let frictions = [0.0, settings.friction].map(|friction| holding.is_held(friction).then_some(friction));
    let rough = frictions[1].filter(|_| settings.friction > 0.0);
    let face = face_from_cor(holding.rotation(), pair.alignment.center_of_rotation);
    let tried = LoadedHalf { holding, face, frictions: [frictions[0], rough], lever: settings.lever };
    if tried.frictions == [None; 2] {
        return Err(HoldError::NotHeld);
    }
    let free = pair.alignment.free;
    let directions: Vec<f64> = match [Dof::X, Dof::Y].map(|dof| free.contains(dof)) {
        [true, true] => {
            (0..settings.directions).map(|k| TAU * k as f64 / settings.directions as f64).collect()
        }
        [true, false] => vec![0.0, PI],
        [false, true] => vec![0.5 * PI, 1.5 * PI],
        [false, false] => Vec::new(),
    };
    let turns: Vec<(Dof, f64)> =
        free.iter().filter(|dof| dof.is_rotation()).flat_map(|dof| [(dof, 1.0), (dof, -1.0)]).collect();
    let refine = free.contains(Dof::X) && free.contains(Dof::Y);
    let sideways = exec.map(directions.len(), |k| tried.sideways(directions[k]))?;
    exec.report(FIRST_SHARE, STAGE);
    let torques = exec.map(turns.len(), |k| tried.torque(turns[k].0, turns[k].1))?;
    let weakest = exec.map(COLUMNS, |column| tried.weakest(&sideways, column, refine))?;
    exec.report(1.0, STAGE);
    let [smooth_guided, smooth_free, rough_guided, rough_free] =
        std::array::from_fn(|column| weakest[column]);
    let contacts = tried.holding.contacts().iter();
    let refined = [rough_free, smooth_free].into_iter().flatten();
    let forces = sideways.iter().copied().chain(refined);
    Ok(HoldingForces {
        settings: settings.clone(),
        preload_n: None,
        pose,
        outcome,
        height_d: tried.holding.cor().z,
        contacts: contacts.map(|(c, _)| Touch { point: c.point, normal: c.normal }).collect(),
        least_force: least(forces.map(|side| side.withstood)),
        least_torque: least(torques.iter().map(|torque| torque.withstood)),
        sideways,
        weakest: Weakest { smooth_guided, smooth_free, rough_guided, rough_free },
        torques,
    })
}

/// Name of the progress stage, and the share of it for the directions.
const STAGE: &str = "loads";
const FIRST_SHARE: f64 = 0.6;
/// Columns: without friction guided and free, with it guided and free.
const COLUMNS: usize = 4;
/// The weakest direction is found to this share of the step between two that are tried: less than
/// tables show.
const FINEST: f64 = 1e-4;

impl HoldSettings {
    fn check(&self) -> Result<descent::DescentSettings, HoldError> {
        if !(DIRECTIONS[0]..=DIRECTIONS[1]).contains(&self.directions) {
            return Err(HoldError::Directions { directions: self.directions });
        }
        if !self.lever.is_finite() {
            return Err(HoldError::Length { what: "lever", value: self.lever, wanted: "give a finite one" });
        }
        if !(self.play > 0.0 && self.play <= MOST_PLAY) {
            let wanted = "above 0 and at most a tenth of D";
            return Err(HoldError::Length { what: "play", value: self.play, wanted });
        }
        Ok(descent::DescentSettings::with_friction(self.friction)?)
    }
}

/// More than this is no play, in D.
const MOST_PLAY: f64 = 0.1;

/// A half for tests of loads.
struct LoadedHalf {
    holding: Holding,
    /// The face centre of the moving half, from the centre of rotation.
    face: DVec3,
    /// Without friction and with it, if the preload is balanced.
    frictions: [Option<f64>; 2],
    lever: f64,
}

impl LoadedHalf {
    fn sideways(&self, direction: f64) -> Sideways {
        let (sin, cos) = direction.sin_cos();
        let force = DVec3::new(snapped(cos), snapped(sin), 0.0);
        let arm = self.arm();
        let load = Load { force, moment: arm.cross(force) };
        Sideways { direction_rad: direction, withstood: self.withstood(&load) }
    }

    /// Vector from the centre of rotation to the point at which lateral forces act.
    fn arm(&self) -> DVec3 {
        self.face + DVec3::Z * self.lever
    }

    fn torque(&self, axis: Dof, sign: f64) -> Torque {
        let moment = sign
            * match axis {
                Dof::Roll => DVec3::X,
                Dof::Pitch => DVec3::Y,
                _ => DVec3::Z,
            };
        let withstood = self.withstood(&Load { force: DVec3::ZERO, moment });
        Torque { axis, sign, withstood }
    }

    fn withstood(&self, load: &Load) -> LoadLimits {
        let with = |friction: Option<f64>| {
            let friction = friction?;
            let mut holding = self.holding.clone();
            let mut most = |guide| holding.most(load, guide, friction).filter(|most| most.is_finite());
            Some(LoadLimit { guided: most(Guide::Along), free: most(Guide::Free) })
        };
        LoadLimits { smooth: with(self.frictions[0]), rough: with(self.frictions[1]) }
    }

    /// The weakest direction of a column: by golden section about the weakest of those that were tried.
    fn weakest(&self, tried: &[Sideways], column: usize, refine: bool) -> Option<Sideways> {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let of = |side: &Sideways| side.withstood.column(column);
        let finite = tried.iter().filter_map(|side| Some((of(side)?, *side)));
        let (mut least, mut best) = finite.min_by(|a, b| a.0.total_cmp(&b.0))?;
        if !refine {
            return Some(best);
        }
        let step = TAU / tried.len() as f64;
        let [mut from, mut to] = [best.direction_rad - step, best.direction_rad + step];
        let at = |direction: f64| {
            let side = self.sideways(direction.rem_euclid(TAU));
            (of(&side).unwrap_or(f64::INFINITY), side)
        };
        let (mut left, mut right) = (at(to - GOLDEN * (to - from)), at(from + GOLDEN * (to - from)));
        while to - from > FINEST * step {
            if left.0 <= right.0 {
                to = from + GOLDEN * (to - from);
                right = left;
                left = at(to - GOLDEN * (to - from));
            } else {
                from = to - GOLDEN * (to - from);
                left = right;
                right = at(from + GOLDEN * (to - from));
            }
        }
        for (value, side) in [left, right] {
            // A difference within rounding does not count as weaker.
            if value < least * (1.0 - ROUNDING) {
                (least, best) = (value, side);
            }
        }
        Some(best)
    }
}

/// A direction counts as weaker than the tried ones only by more than this share: along a straight side of
/// the holding force rounding decides.
const ROUNDING: f64 = 1e-4;

/// Components of a direction along an axis are exact.
fn snapped(part: f64) -> f64 {
    // Of a unit vector: the rounding of a cosine of 90°.
    const NOTHING: f64 = 1e-15;
    if part.abs() < NOTHING { 0.0 } else { part }
}

impl LoadLimits {
    /// Without friction guided and free, with friction guided and free: infinite if any load is resisted;
    /// `None` if unknown.
    pub fn columns(&self) -> [Option<f64>; COLUMNS] {
        let any = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
        let of = |withstood: Option<LoadLimit>| {
            [withstood.map(|of| any(of.guided)), withstood.map(|of| any(of.free))]
        };
        let ([smooth_guided, smooth_free], [rough_guided, rough_free]) = (of(self.smooth), of(self.rough));
        [smooth_guided, smooth_free, rough_guided, rough_free]
    }

    /// A given column if it is finite.
    pub fn column(&self, column: usize) -> Option<f64> {
        self.columns()[column].filter(|value| value.is_finite())
    }
}

impl Weakest {
    /// The directions in the order of [`LoadLimits::columns`].
    pub const fn columns(&self) -> [Option<Sideways>; COLUMNS] {
        [self.smooth_guided, self.smooth_free, self.rough_guided, self.rough_free]
    }
}

/// The smallest holding load in free errors, with friction if known.
fn least(all: impl Iterator<Item = LoadLimits>) -> Option<f64> {
    let of = |both: LoadLimits| {
        let columns = both.columns();
        columns[3].or(columns[1]).map(|value| value.min(ANY))
    };
    all.filter_map(of).min_by(f64::total_cmp)
}
