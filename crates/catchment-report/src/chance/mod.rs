//! How likely drop tests dock: as versioned JSON, as records for programs. Its text is `text.rs`.

mod text;

use super::envelope::{Body, Envelope};
use super::schema::{Timing, WarningReport};
use super::text::{number, percent};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::landscape::GridAxis;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Circumstance, Law};
use catchment_study::chance::{AtSpeed, Chance, Overall, PoseChance, Settings, majority_of_three};
use catchment_study::success::Stratum;
use serde::{Serialize, Serializer};

/// How likely drop tests dock, with its head.
pub type ChanceReport = Envelope<ChanceBody>;

/// How likely drop tests dock.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ChanceBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// What is declared, each with its law.
    pub declared: Vec<CircumstanceReport>,
    /// How far a half coasts that comes with the mean speed, before damping has taken it, in D; null without speed or damping.
    pub coasting_d: Option<f64>,
    /// The preset that the settings come from, if any.
    pub preset: Option<PresetReport>,
    /// Under the errors that are expected; null where none were.
    pub overall: Option<OverallReport>,
    /// The same with every velocity multiplied, in ascending order.
    pub curve: Vec<AtSpeedReport>,
    /// Each pose, in the order in which they were asked.
    pub poses: Vec<PoseChanceReport>,
    /// The cells of a map; null where none was asked for.
    pub map: Option<MapReport>,
    /// Trials in all.
    pub trials: usize,
}

/// A circumstance and its law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CircumstanceReport {
    /// Which.
    pub circumstance: Circumstance,
    /// What it is measured in; empty of bare numbers.
    pub unit: &'static str,
    /// Its law.
    pub law: Law,
    /// Share of the law that lies outside of what is possible, and is drawn again.
    pub cut: f64,
}

/// Settings under a name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PresetReport {
    /// The name.
    pub name: &'static str,
    /// What its source leaves open.
    pub unknown: Vec<&'static str>,
}

/// The probability under errors that are expected.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OverallReport {
    /// `normal`, `uniform` or `measured`.
    pub errors: &'static str,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Trials that this took.
    pub trials: usize,
    /// Plain trials of random errors whose interval would be as wide.
    pub plain_trials: f64,
    /// Share of the errors that meets each outcome.
    #[serde(serialize_with = "by_outcome")]
    pub outcomes: [f64; Outcome::ALL.len()],
    /// What was seen of each stratum.
    pub strata: Vec<Stratum>,
    /// Cells of the quasi-static grid that said where to look.
    pub grid_cells: usize,
    /// The probability by exact quasi-static motions of the same errors.
    pub quasi_static: f64,
    /// Its 95 % interval.
    pub quasi_static_ci95: [f64; 2],
    /// Motions that this took, those of the grid included.
    pub motions: usize,
}

/// The probability at a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AtSpeedReport {
    /// By what every velocity is multiplied.
    pub factor: f64,
    /// Mean approach speed then, in D/s.
    pub speed: f64,
    /// Trials that this took.
    pub trials: usize,
    /// Probability of docking.
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

/// How likely one pose docks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PoseChanceReport {
    /// The pose error.
    pub error: PoseError,
    /// Trials.
    pub trials: usize,
    /// How many of them met each outcome.
    #[serde(serialize_with = "by_outcome")]
    pub outcomes: [usize; Outcome::ALL.len()],
    /// Share that aligned.
    pub probability: f64,
    /// Wilson's 95 % interval of it.
    pub ci95: [f64; 2],
    /// Share of the draws that dock by exact quasi-static motion: 0 or 1 where friction does not vary.
    pub quasi_static: f64,
    /// Share of the trials that fare otherwise than most of them.
    pub minority: f64,
    /// How often the majority of three such trials would be of the minority: 3E² − 2E³.
    pub majority_of_three: f64,
}

/// The cells of a map.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MapReport {
    /// The axes; the first runs fastest.
    pub axes: Vec<GridAxis>,
    /// The centre of each cell, all other errors 0.
    pub cells: Vec<PoseChanceReport>,
}

impl Body for ChanceBody {
    const KIND: &'static str = "chance";
}

fn by_outcome<N: Serialize, S: Serializer>(
    values: &[N; Outcome::ALL.len()],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(Outcome::ALL.iter().map(|outcome| outcome.name()).zip(values))
}

/// Coasting below this share of D is told: speed then changes nothing that one sees.
const FAINT_COAST: f64 = 0.003;
/// Beyond this share of a law that is drawn again it is said.
const MUCH_CUT: f64 = 0.01;

impl ChanceReport {
    /// Of a design.
    pub fn new(
        design: &Design,
        found: &Chance,
        mut doubts: Vec<WarningReport>,
        timing: Option<Timing>,
    ) -> Self {
        let settings = &found.settings;
        let declared: Vec<CircumstanceReport> = settings
            .dynamics
            .declared()
            .map(|(circumstance, law)| CircumstanceReport {
                circumstance,
                unit: circumstance.unit(),
                law: law.clone(),
                cut: 1.0 - law.inside(circumstance.range()),
            })
            .collect();
        let body = ChanceBody {
            design: design.clone(),
            settings: settings.clone(),
            declared,
            coasting_d: settings.coasting(),
            preset: settings
                .drop
                .preset()
                .map(|preset| PresetReport { name: preset.name, unknown: preset.unknown.to_vec() }),
            overall: found.overall.as_ref().map(overall),
            curve: found.curve.iter().map(at_speed).collect(),
            poses: found.poses.iter().map(pose).collect(),
            map: found
                .map
                .as_ref()
                .map(|map| MapReport { axes: map.axes.clone(), cells: map.cells.iter().map(pose).collect() }),
            trials: found.trials,
        };
        doubts.extend(body.doubts().iter().map(WarningReport::note));
        Self::of(body, doubts, timing)
    }

    /// What was found as records for programs, a row per probability, the names of the columns first; D, radians, D/s.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = "what factor speed x y roll pitch yaw trials probability low high quasi_static";
        let mut records = vec![head.split(' ').map(str::to_owned).collect::<Vec<_>>()];
        let none = String::new;
        let mut push = |what: &str,
                        at: [String; 2],
                        error: Option<PoseError>,
                        trials: String,
                        of: [f64; 3],
                        still: String| {
            let mut record = vec![what.to_owned()];
            record.extend(at);
            match error {
                Some(error) => record.extend(error.to_array().map(number)),
                None => record.extend(std::iter::repeat_n(none(), Dof::ALL.len())),
            }
            record.push(trials);
            record.extend(of.map(number));
            record.push(still);
            records.push(record);
        };
        if let Some(overall) = &self.overall {
            let of = [overall.probability, overall.ci95[0], overall.ci95[1]];
            let still = number(overall.quasi_static);
            push("overall", [none(), none()], None, overall.trials.to_string(), of, still);
        }
        for at in &self.curve {
            let of = [at.probability, at.ci95[0], at.ci95[1]];
            push("speed", [number(at.factor), number(at.speed)], None, at.trials.to_string(), of, none());
        }
        let cells = self.map.iter().flat_map(|map| &map.cells).map(|cell| ("cell", cell));
        for (what, pose) in self.poses.iter().map(|pose| ("pose", pose)).chain(cells) {
            let of = [pose.probability, pose.ci95[0], pose.ci95[1]];
            let still = number(pose.quasi_static);
            push(what, [none(), none()], Some(pose.error), pose.trials.to_string(), of, still);
        }
        records
    }
}

impl ChanceBody {
    /// Poses and cells.
    fn places(&self) -> impl Iterator<Item = &PoseChanceReport> {
        self.poses.iter().chain(self.map.iter().flat_map(|map| &map.cells))
    }

    fn doubts(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        for declared in self.declared.iter().filter(|declared| declared.cut > MUCH_CUT) {
            doubts.push(format!(
                "{} of the law of {} is out of its range and drawn again: what is tried is the rest of the law",
                percent(declared.cut),
                declared.circumstance.name()
            ));
        }
        if self.settings.held
            && let Some(coasting) = self.coasting_d.filter(|coasting| *coasting < FAINT_COAST)
        {
            doubts.push(format!(
                "damping takes the speed within {coasting:.1e} D: as good as quasi-static; with less damping speed would show"
            ));
        }
        let drop = &self.settings.drop;
        if self.settings.held && (drop.angular_damping != drop.damping || drop.inertia_factor != 1.0) {
            doubts.push(
                "turning is damped otherwise than moving: exact motions, which damp both alike by rho, are not the limit of no speed"
                    .to_owned(),
            );
        }
        if !self.settings.held && !self.curve.is_empty() {
            doubts.push(
                "what pushes the half stays as it is where speeds are multiplied: the slowest is let go nearly at rest, which is no \
                 quasi-static motion"
                    .to_owned(),
            );
        }
        if !self.settings.dynamics.varies() {
            doubts.push(format!(
                "nothing is declared to vary: trials of a pose differ by their starts alone, {} D or less",
                self.settings.drop.perturbation
            ));
        }
        let undecided = Outcome::ALL.iter().position(|outcome| *outcome == Outcome::Undecided).unwrap_or(0);
        let open: usize = self.places().map(|pose| pose.outcomes[undecided]).sum();
        let share = self.overall.as_ref().map_or(0.0, |overall| overall.outcomes[undecided]);
        if open > 0 {
            doubts.push(format!("{open} trials still moved when their time was up: they count as failures"));
        }
        if share > 0.0 {
            doubts.push(format!(
                "{} of the expected errors still moved when their time was up: they count as failures",
                percent(share)
            ));
        }
        doubts
    }
}

fn overall(found: &Overall) -> OverallReport {
    OverallReport {
        errors: found.kind,
        probability: found.probability,
        ci95: found.ci95,
        trials: found.trials,
        plain_trials: found.plain_trials,
        outcomes: found.shares,
        strata: found.strata.clone(),
        grid_cells: found.cells,
        quasi_static: found.quasi_static,
        quasi_static_ci95: found.quasi_static_ci95,
        motions: found.motions,
    }
}

const fn at_speed(at: &AtSpeed) -> AtSpeedReport {
    AtSpeedReport {
        factor: at.factor,
        speed: at.speed,
        trials: at.trials,
        probability: at.probability,
        ci95: at.ci95,
    }
}

fn pose(pose: &PoseChance) -> PoseChanceReport {
    PoseChanceReport {
        error: pose.error,
        trials: pose.trials,
        outcomes: pose.counts,
        probability: pose.probability(),
        ci95: pose.ci95(),
        quasi_static: pose.quasi_static,
        minority: pose.minority(),
        majority_of_three: majority_of_three(pose.minority()),
    }
}
