//! The tolerance window: the largest box of pose errors around zero in which every pose docks. The tolerance
//! for a datasheet.
//!
//! ```text
//!        ░░░░░░░░░          1  search    exact motions on the surface of the box: all directions of {−1, 0, 1}ⁿ, then
//!      ░░┌──────●░              moves about the worst pose ● found so far; each pose that does not dock makes the box
//!      ░░│  0   │░░             smaller, by bisection towards zero
//!       ░└──────┘░          2  certify   N sampled poses all over the box; a failure returns to 1
//!          ░░░░░
//! ```
//!
//! Half-widths are s·pᵢ, with the proportions pᵢ of the error box or of the caller; some may be given (x, y
//! ±2 mm: how much yaw?), and then only the others grow. No grid is involved: every result is that of exact
//! motions. For each error the window also reports the single-axis limit (all others 0) and the limit with
//! all others anywhere within their half-widths: if the latter hardly exceeds the window, this error limits
//! it. Poses are also sampled between the window and these limits, a twentieth as many as in the window.
//!
//! The certificate follows the rule of three: if none of N independent poses fails, at most ln(1/α)/N of the
//! window fails, with confidence 1 − α. The first window has α₁ = 0.0498, which gives 3/N; the k-th, drawn
//! because earlier ones failed, 0.0002/(k(k − 1)): together 0.05, for any number of windows. (0.05/k for each
//! would add up to more.)
//!
//! Not promised: that no pose of the window fails; only an upper bound on the failing share. The window ends
//! at the error box. Undecided poses count as failures. Lengths in D, angles in radians.

mod cube;
mod report;
mod search;
mod space;
#[cfg(test)]
mod tests;

pub(super) use cube::{Effort, follow as follow_cubes, window_of, within};

use crate::acceptance::Outcome;
use crate::exec::{Cancelled, Exec};
use crate::merit::centered::CenteredBox;
use crate::method::descent::{self, FrictionOutOfRange, Touch};
use crate::method::{affordable, motions_in, seconds_per_motion};
use crate::pose::{Dof, PoseError};
use crate::problem::Problem;
use search::{Search, Shrunk, WINDOWS};
use serde::de::{Deserializer, IgnoredAny, MapAccess, Visitor};
use serde::{Deserialize, Serialize};
use space::Space;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Deref;

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct WindowSettings {
    /// Given half-widths, in the order of [`Dof::ALL`], in D and radians: these errors have this range, and
    /// the window is sought for the others.
    pub fixed: [Option<f64>; 5],
    /// Proportions of the other half-widths; by default the ranges of the error box. 0 for errors that do not
    /// occur.
    pub proportions: Option<PoseError>,
    /// Number of samples for the certificate. Default: 300 000; for halves with many facets as many as can be
    /// followed in three core-seconds.
    pub motions: Option<usize>,
    /// Seed of the samples and of the search.
    pub seed: u64,
    /// Coefficient of friction between the halves.
    pub friction: f64,
}

impl Default for WindowSettings {
    fn default() -> Self {
        Self { fixed: [None; 5], proportions: None, motions: None, seed: 1, friction: 0.0 }
    }
}

/// The tolerance window: the largest box of errors around zero in which every pose docks, as far as exact
/// motions show.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ToleranceWindow {
    /// Half-width of every free error, by its name, in D and radians.
    pub window: HalfWidths,
    /// The settings of the search and all its other results.
    #[serde(flatten)]
    pub details: WindowDetails,
}

/// Half-width of every free error, in D and radians.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct HalfWidths(pub BTreeMap<Dof, f64>);

/// Details of a window besides its half-widths.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WindowDetails {
    /// The settings, with all defaults filled in.
    pub settings: WindowSettings,
    /// Every free error.
    pub sides: Vec<WindowAxis>,
    /// Factor between `proportions` and the half-widths that were not given.
    pub scale: f64,
    /// The error with the least room to its limit while all others vary within the window; null if every
    /// limit is the border of the error box.
    pub tightest: Option<Dof>,
    /// The nearest failure, measured in proportions of the window; null if the window reaches the error box.
    pub worst: Option<Worst>,
    /// The certificate from sampled poses.
    pub certificate: WindowCertificate,
    /// Number of exact motions in total.
    pub motions: usize,
}

/// One error of a window, in D or radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WindowAxis {
    /// The error.
    pub axis: Dof,
    /// Half-width of the window in this error.
    pub half_width: f64,
    /// Whether the half-width was given.
    pub given: bool,
    /// Single-axis limit: tolerance ± while all other errors are 0.
    pub alone: f64,
    /// Whether the single-axis limit is the border of the error box.
    pub alone_reaches_border: bool,
    /// Tolerance ± while all other errors vary within their half-widths.
    pub beside: f64,
    /// Whether that tolerance ends at the border of the error box.
    pub beside_reaches_border: bool,
}

/// Limits of a single error, in both directions.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Reach {
    /// ± so far, in D or radians.
    to: f64,
    /// The error box ends there: perhaps further.
    is_border: bool,
}

/// The nearest failure: the failing pose nearest to zero, in proportions of the window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Worst {
    /// The pose error.
    pub error: PoseError,
    /// Its outcome.
    pub outcome: Outcome,
    /// Pose error at the end of its motion.
    pub end: PoseError,
    /// Contacts at the end, in the world frame of the fixed face centre, in D, with normals towards the
    /// moving half; empty if the halves never touch.
    pub touches: Vec<Touch>,
}

/// The certificate: sampled poses of the window, none of which failed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WindowCertificate {
    /// Number of sampled poses.
    pub motions: usize,
    /// Upper bound on the failing share of the window, at 95 % confidence; 1 if no pose was sampled.
    pub failing_at_most: f64,
    /// Number of earlier windows that were rejected because a sampled pose failed.
    pub redrawn: usize,
}

/// Why there is no window.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WindowError {
    /// No coefficient of friction.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// Not even zero docks.
    #[error("the mated pose itself is {}: there is no window around it", outcome.word())]
    NotDocked {
        /// Its outcome.
        outcome: Outcome,
    },
    /// A given half-width beyond the error box.
    #[error("{}: ±{half_width:.4} {} is given, and the error box ends at ±{most:.4}; make the box larger, or the half-width smaller", axis.name(), unit(*axis))]
    BeyondBox {
        /// Which error.
        axis: Dof,
        /// The given value.
        half_width: f64,
        /// The half range of the box.
        most: f64,
    },
    /// An invalid size.
    #[error("{}: {value} is no half-width and no proportion: finite, 0 or more", axis.name())]
    NoSize {
        /// Which error.
        axis: Dof,
        /// The given value.
        value: f64,
    },
    /// An error that does not vary.
    #[error("{}: the design locks it, so it has no place in the window", axis.name())]
    Locked {
        /// Which.
        axis: Dof,
    },
    /// Nothing grows.
    #[error("nothing to compute: every error is given, or has the proportion 0; leave one to be found")]
    Nothing,
    /// A pose within the given half-widths already fails.
    #[error("what is given is too much by itself: with {} it is {}", place(error), outcome.word())]
    GivenFails {
        /// The pose error.
        error: PoseError,
        /// Its outcome.
        outcome: Outcome,
    },
    /// Right beside the mated pose some pose fails.
    #[error("poses right beside the mated one fail, however near: {} is {}", place(error), outcome.word())]
    AtHome {
        /// The pose error.
        error: PoseError,
        /// Its outcome.
        outcome: Outcome,
    },
    /// Sampled poses failed repeatedly.
    #[error(
        "after {windows} windows, each smaller, some random pose failed in every one, at last {}: poses that fail lie all over",
        place(error)
    )]
    Scattered {
        /// How many windows.
        windows: usize,
        /// The last pose that failed.
        error: PoseError,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl ToleranceWindow {
    /// The same as a cube, of a window in the proportions of the error box.
    pub(super) fn cube(&self) -> CenteredBox {
        let half_widths = self.sides.iter().map(|side| (side.axis, side.half_width));
        let (is_open, sampled) = (self.worst.is_none(), Some(self.certificate.motions));
        CenteredBox::of(self.scale, half_widths, is_open, sampled, self.limiting())
    }
}

impl Deref for ToleranceWindow {
    type Target = WindowDetails;

    fn deref(&self) -> &WindowDetails {
        &self.details
    }
}

/// Names of other things than errors are left to others.
impl<'de> Deserialize<'de> for HalfWidths {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Named;
        impl<'de> Visitor<'de> for Named {
            type Value = HalfWidths;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("half-widths by the names of errors")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<HalfWidths, A::Error> {
                let mut result = BTreeMap::new();
                while let Some(name) = map.next_key::<String>()? {
                    if let Ok(axis) = name.parse::<Dof>() {
                        result.insert(axis, map.next_value()?);
                    } else {
                        map.next_value::<IgnoredAny>()?;
                    }
                }
                Ok(HalfWidths(result))
            }
        }
        deserializer.deserialize_map(Named)
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for HalfWidths {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "HalfWidths".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let number = || serde_json::json!({ "type": "number" });
        let properties: serde_json::Map<String, serde_json::Value> =
            Dof::ALL.iter().map(|dof| (dof.name().to_owned(), number())).collect();
        schemars::json_schema!({ "type": "object", "properties": properties })
    }
}

const fn unit(axis: Dof) -> &'static str {
    if axis.is_rotation() { "rad" } else { "D" }
}

fn place(error: &PoseError) -> String {
    // A value that rounds to zero at four decimals is written with its magnitude if no value is larger.
    const SHOWN: f64 = 5e-5;
    let parts = || Dof::ALL.into_iter().zip(error.to_array()).filter(|(_, value)| *value != 0.0);
    let large = parts().any(|(_, value)| value.abs() >= SHOWN);
    let words = parts().filter(|(_, value)| !large || value.abs() >= SHOWN).map(|(dof, value)| {
        let value = if large { format!("{value:.4}") } else { format!("{value:.1e}") };
        format!("{} = {value} {}", dof.name(), unit(dof))
    });
    words.collect::<Vec<_>>().join(", ")
}

/// Permitted error probability of the certificate of the first window, and of all later ones: together 5 %.
const FIRST_CHANCE: f64 = 0.0498;
const LATER_CHANCE: f64 = 0.0002;

/// Number of samples beyond the window, per error that exceeds it while the others stay in it: one in 20 of
/// those of the certificate, at least this number, but at most one in 4.
const BESIDE_SHARE: usize = 20;
const BESIDE_LEAST: usize = 2000;
const BESIDE_MOST_SHARE: usize = 4;

/// Largest core-seconds of the search for the window, and of that for the reach of a single error; then only
/// samples continue: halves whose motions take a quarter of a second are finished within minutes.
const SEARCH_SECONDS: f64 = 120.0;
const REACH_SECONDS: f64 = 15.0;

/// The share of the time that the window takes, about; the reaches of its errors have the rest.
const OF_WINDOW: f64 = 0.4;

/// Finds the window of a problem and certifies it.
///
/// # Errors
/// See [`WindowError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment_core::design::read;
/// use catchment_core::exec::Exec;
/// use catchment_core::problem::Problem;
/// use catchment_core::run::window::{self, WindowSettings};
///
/// let text = "[connector]\nfamily = \"pyramid\"\n[alignment]\nfree = [\"x\", \"y\"]\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let found = window::run(&problem, &WindowSettings { motions: Some(1000), ..WindowSettings::default() }, &Exec::new())?;
/// // Without rotations a pyramid corrects offsets up to D/2 along both axes at once.
/// assert!((found.sides[0].half_width - 0.5).abs() < 0.002);
/// # Ok(())
/// # }
/// ```
pub fn run(
    problem: &Problem,
    settings: &WindowSettings,
    exec: &Exec,
) -> Result<ToleranceWindow, WindowError> {
    by(problem, settings, &descent::DescentSettings::with_friction(settings.friction)?, exec)
}

/// The same by given motions, whose friction is that of the settings.
pub(super) fn by(
    problem: &Problem,
    settings: &WindowSettings,
    motions_by: &descent::DescentSettings,
    exec: &Exec,
) -> Result<ToleranceWindow, WindowError> {
    let space = Space::of(problem, settings)?;
    let motions = settings.motions.unwrap_or_else(|| default_motions(problem));
    let settings = &WindowSettings { motions: Some(motions), ..settings.clone() };
    let outcome_of = |error: &PoseError| descent::outcome(problem.pair(), error, motions_by).outcome;
    let home = outcome_of(&PoseError::default());
    if home != Outcome::Aligned {
        return Err(WindowError::NotDocked { outcome: home });
    }
    let most = |seconds: f64| motions_in(seconds, problem.pair());
    let mut search = Search::new(problem, space, settings.seed, motions_by).within(most(SEARCH_SECONDS));
    let of_window = exec.part([0.0, OF_WINDOW], "window");
    let Some(Shrunk { scale, redrawn }) = search.shrink(motions, &of_window)? else {
        let error = search.worst().unwrap_or_default();
        let outcome = outcome_of(&error);
        let given = settings.fixed.iter().flatten().any(|half_width| *half_width > 0.0);
        return Err(match search.has_room() {
            true => WindowError::Scattered { windows: WINDOWS, error },
            false if given => WindowError::GivenFails { error, outcome },
            false => WindowError::AtHome { error, outcome },
        });
    };
    let at_most = if motions == 0 { 1.0 } else { ((1.0 / chance(redrawn)).ln() / motions as f64).min(1.0) };
    let certificate = WindowCertificate { motions, failing_at_most: at_most, redrawn };
    let half_widths = search.space().half_widths(scale);
    let mut followed = search.followed();
    let hints: Vec<[f64; 5]> = search.worst_way().into_iter().collect();
    let beyond = beyond(motions);
    let mut sides = Vec::new();
    let free = problem.alignment().free;
    for (number, axis) in free.iter().enumerate() {
        let at = |number: usize| OF_WINDOW + (1.0 - OF_WINDOW) * number as f64 / free.len() as f64;
        let exec = &exec.part([at(number), at(number + 1)], "window");
        let half_width = half_widths[axis.index()];
        let mut reach = |others: [f64; 5], from: f64| {
            let space = Space::along(problem, axis, others);
            let mut search =
                Search::new(problem, space, settings.seed, motions_by).within(most(REACH_SECONDS));
            let reach = search.reach(from, &hints, beyond, exec)?;
            followed += search.followed();
            Ok::<_, Cancelled>(reach)
        };
        let alone = reach([0.0; 5], 0.0)?;
        let beside = reach(half_widths, half_width)?;
        // Alone it goes no less far than in company.
        let alone = if beside.to > alone.to { beside } else { alone };
        let given = settings.fixed[axis.index()].is_some();
        sides.push(WindowAxis {
            axis,
            half_width,
            given,
            alone: alone.to,
            alone_reaches_border: alone.is_border,
            beside: beside.to,
            beside_reaches_border: beside.is_border,
        });
    }
    let spare = |side: &&WindowAxis| side.beside / side.half_width;
    let tightest = sides.iter().filter(|side| side.half_width > 0.0 && !side.beside_reaches_border);
    let tightest = tightest.min_by(|a, b| spare(a).total_cmp(&spare(b))).map(|side| side.axis);
    let worst = search.worst().map(|error| Worst::of(problem, error, motions_by));
    Ok(ToleranceWindow {
        window: HalfWidths(sides.iter().map(|side| (side.axis, side.half_width)).collect()),
        details: WindowDetails {
            settings: settings.clone(),
            sides,
            scale,
            tightest,
            worst,
            certificate,
            motions: followed,
        },
    })
}

/// Number of samples beyond a window with this number of samples.
fn beyond(motions: usize) -> usize {
    (motions / BESIDE_SHARE).max((motions / BESIDE_MOST_SHARE).min(BESIDE_LEAST))
}

/// Core-seconds that it takes, to within a factor of two or three: motions as counted for grids of three and five errors.
pub fn seconds(problem: &Problem, settings: &WindowSettings) -> f64 {
    /// For each direction of {−1, 0, 1}ⁿ: poses along it, and bisections at failures. For each error: its
    /// reach.
    const DIRECTION: usize = 12;
    const ERROR: usize = 250;
    let pair = problem.pair();
    let motions = settings.motions.unwrap_or_else(|| default_motions(problem));
    let errors = problem.alignment().free.len();
    let search = (DIRECTION * (3usize.pow(errors as u32) - 1)).min(motions_in(SEARCH_SECONDS, pair));
    let reaches = ERROR.min(motions_in(REACH_SECONDS, pair)) + beyond(motions);
    (search + motions + errors * reaches) as f64 * seconds_per_motion(pair)
}

/// Chance that is allowed of a wrong certificate after so many windows that failed.
fn chance(redrawn: usize) -> f64 {
    let later = redrawn as f64;
    if redrawn == 0 { FIRST_CHANCE } else { LATER_CHANCE / (later * (later + 1.0)) }
}

/// As many as seconds allow.
fn default_motions(problem: &Problem) -> usize {
    /// Of simple halves.
    const MOST: usize = 300_000;
    /// Core-seconds of other halves, and fewest poses.
    const SECONDS: f64 = 3.0;
    const LEAST: usize = 300;
    let pair = problem.pair();
    let few = (SECONDS / seconds_per_motion(pair)) as usize;
    if affordable(pair) < 1.0 { few.clamp(LEAST, MOST) } else { MOST }
}

impl Worst {
    fn of(problem: &Problem, error: PoseError, motions: &descent::DescentSettings) -> Self {
        let path = descent::trace(problem.pair(), &error, motions);
        let last = path.waypoints.last();
        Self {
            error,
            outcome: path.outcome,
            end: last.map_or(error, |waypoint| waypoint.error),
            touches: last.map_or_else(Vec::new, |waypoint| waypoint.touches.clone()),
        }
    }
}
