//! Command-line settings of drop tests.

use crate::failure::Failure;
use crate::setting::number;
use crate::setting::{Change, with_changes};
use catchment::method::Method;
use catchment::method::drop::{DropSettings, Launch, PRESETS};
use catchment::poses::Circumstance;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use serde_json::{Value, json};

/// The options of drop tests.
#[derive(Debug, Args)]
pub(crate) struct DropArgs {
    /// Named settings; options given beside it take precedence
    #[arg(long, value_name = "PRESET", value_parser = preset_parser(), help_heading = DROP, hide_short_help = true)]
    preset: Option<DropSettings>,
    /// Force along the approach, through the centre of rotation, in kg·D/s² [default: 5000]
    #[arg(long, value_name = "FORCE", value_parser = number, help_heading = DROP, hide_short_help = true)]
    push: Option<f64>,
    /// Gravity along the approach, through the centre of mass, in D/s²; replaces --push
    #[arg(long, value_name = "ACCELERATION", value_parser = number, help_heading = DROP, hide_short_help = true, conflicts_with = "push")]
    gravity: Option<f64>,
    /// Mass of the moving half in kg, at the centre of rotation [default: 1]
    #[arg(long, value_name = "MASS", value_parser = number, help_heading = DROP, hide_short_help = true)]
    mass: Option<f64>,
    /// Radius of gyration about the centre of rotation, in D: inertia = mass·gyration² [default: ρ]
    #[arg(long, value_name = "LENGTH", value_parser = number, help_heading = DROP, hide_short_help = true)]
    gyration: Option<f64>,
    /// Centre of mass relative to the moving face centre, in the axes of the fixed half when docked, in D [default: the centre of rotation]
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true, help_heading = DROP, hide_short_help = true)]
    mass_center: Option<[f64; 3]>,
    /// Density in kg/D³: the solid gives mass, centre of mass and inertia; replaces --mass
    #[arg(long, value_name = "DENSITY", value_parser = number, help_heading = DROP, hide_short_help = true, conflicts_with_all = ["mass", "gyration", "mass_center"])]
    density: Option<f64>,
    /// Viscous damping rate in 1/s: force -mass·damping·v [default: 1000, overdamped]
    #[arg(long, value_name = "RATE", value_parser = number, help_heading = DROP, hide_short_help = true)]
    damping: Option<f64>,
    /// Viscous damping rate of rotation in 1/s: torque -mass·rate·ρ²·ω [default: that of --damping]
    #[arg(long, value_name = "RATE", value_parser = number, help_heading = DROP, hide_short_help = true)]
    angular_damping: Option<f64>,
    /// Friction coefficient of the halves [default: 0]
    #[arg(long, value_name = "MU", value_parser = number, allow_negative_numbers = true)]
    friction: Option<f64>,
    /// End exact motions on slopes up to this height per length (ρ-metric), a simple model of friction [default: 0]
    #[arg(long, hide_short_help = true, value_name = "SLOPE", value_parser = number)]
    slope_threshold: Option<f64>,
    /// Coefficient of restitution: share of the approach speed after a bounce [default: 0]
    #[arg(long, value_name = "SHARE", value_parser = number, help_heading = DROP, hide_short_help = true)]
    restitution: Option<f64>,
    /// Ground plane at this distance below the lowest point of the fixed half, in D [default: no ground]
    #[arg(long, value_name = "LENGTH", value_parser = number, help_heading = DROP, hide_short_help = true)]
    ground: Option<f64>,
    /// Release height above first contact, in D [default: 0.01]
    #[arg(long, value_name = "LENGTH", value_parser = number, help_heading = DROP, hide_short_help = true)]
    drop_height: Option<f64>,
    /// Approach speed at release, in D/s [default: 0]
    #[arg(long, value_name = "SPEED", value_parser = number, help_heading = DROP, hide_short_help = true)]
    speed: Option<f64>,
    /// Lateral velocity of the centre of rotation at release, in D/s [default: 0,0]
    #[arg(long, value_name = "X,Y", value_parser = pair, allow_hyphen_values = true, help_heading = DROP, hide_short_help = true)]
    drift: Option<[f64; 2]>,
    /// Rates of roll, pitch and yaw at release, in rad/s [default: 0,0,0]
    #[arg(long, value_name = "ROLL,PITCH,YAW", value_parser = triple, allow_hyphen_values = true, help_heading = DROP, hide_short_help = true)]
    spin: Option<[f64; 3]>,
    /// Factor on inertia and on the damping of rotation; 1e5 nearly locks rotations [default: 1]
    #[arg(long, value_name = "FACTOR", value_parser = number, help_heading = DROP, hide_short_help = true)]
    inertia_factor: Option<f64>,
    /// Time step of the engine, in s [default: 0.001]
    #[arg(long, value_name = "TIME", value_parser = number, help_heading = DROP, hide_short_help = true)]
    timestep: Option<f64>,
    /// Simulated time after which a trial ends, in s [default: 20]
    #[arg(long, value_name = "TIME", value_parser = number, help_heading = DROP, hide_short_help = true)]
    timeout: Option<f64>,
    /// Trials per pose, an odd number; a pose docks if most of them do [default: 3]
    #[arg(long, value_name = "N", help_heading = DROP, hide_short_help = true)]
    trials: Option<u32>,
    /// Largest random perturbation of the start of a trial, in D; rotations in radians times ρ [default: 0.001]
    #[arg(long, value_name = "LENGTH", value_parser = number, help_heading = DROP, hide_short_help = true)]
    perturbation: Option<f64>,
    /// Seed of the perturbations [default: 1]
    #[arg(long, value_name = "SEED", help_heading = DROP, hide_short_help = true)]
    trial_seed: Option<u64>,
}

const DROP: &str = "Drop simulation (--method drop): lengths in D, times in s, masses in kg";

fn preset_parser() -> ValueParser {
    let names = PRESETS.map(|preset| PossibleValue::new(preset.name).help(preset.summary));
    let find =
        |name: String| PRESETS.iter().find(|preset| preset.name == name).map(|preset| (preset.settings)());
    PossibleValuesParser::new(names).map(move |name| find(name).unwrap_or_default()).into()
}

impl DropArgs {
    /// The requested changes, each with option, setting and value, in the order of the options.
    pub(crate) fn changes(&self) -> Vec<Change> {
        let mut changes = Vec::new();
        let mut add = |option: &'static str, setting: &'static str, value: Option<Value>| {
            changes.extend(value.map(|value| Change { option, setting, value }));
        };
        // The preset comes first, so that other options override it.
        let preset = self.preset.as_ref();
        add("--preset", "push", preset.map(|preset| json!(preset.push)));
        add("--preset", "body", preset.map(|preset| json!(preset.body)));
        add("--preset", "damping", preset.map(|preset| json!(preset.damping)));
        add("--preset", "angular_damping", preset.map(|preset| json!(preset.angular_damping)));
        add("--preset", "ground", preset.map(|preset| json!(preset.ground)));
        add("--push", "push", self.push.map(|force| json!({ "force": force })));
        add("--gravity", "push", self.gravity.map(|gravity| json!({ "gravity": gravity })));
        let given = || json!({ "given": { "mass": self.mass.unwrap_or(1.0), "gyration": self.gyration, "center": self.mass_center } });
        add("--mass", "body", self.mass.map(|_| given()));
        add("--gyration", "body", self.gyration.map(|_| given()));
        add("--mass-center", "body", self.mass_center.map(|_| given()));
        add("--density", "body", self.density.map(|density| json!({ "solid": { "density": density } })));
        add("--damping", "damping", self.damping.map(Value::from));
        let turning = self.angular_damping.or(self.damping);
        add("--angular-damping", "angular_damping", turning.map(Value::from));
        add("--friction", "friction", self.friction.map(Value::from));
        add("--slope-threshold", "slope_threshold", self.slope_threshold.map(Value::from));
        add("--restitution", "restitution", self.restitution.map(Value::from));
        add("--ground", "ground", self.ground.map(Value::from));
        add("--drop-height", "drop_height", self.drop_height.map(Value::from));
        let is_launched = self.speed.is_some() || self.drift.is_some() || self.spin.is_some();
        let launch = Launch {
            speed: self.speed.unwrap_or_default(),
            drift: self.drift.unwrap_or_default(),
            spin: self.spin.unwrap_or_default(),
        };
        let option = match (self.speed, self.drift) {
            (Some(_), _) => "--speed",
            (None, Some(_)) => "--drift",
            (None, None) => "--spin",
        };
        add(option, "launch", is_launched.then(|| json!(launch)));
        add("--inertia-factor", "inertia_factor", self.inertia_factor.map(Value::from));
        add("--timestep", "timestep", self.timestep.map(Value::from));
        add("--timeout", "timeout", self.timeout.map(Value::from));
        add("--trials", "trials", self.trials.map(Value::from));
        add("--perturbation", "perturbation", self.perturbation.map(Value::from));
        add("--trial-seed", "seed", self.trial_seed.map(Value::from));
        changes
    }

    /// The first option given.
    pub(crate) fn first_given(&self) -> Option<&'static str> {
        self.changes().first().map(|change| change.option)
    }

    /// Drop tests with these settings.
    ///
    /// # Errors
    /// An invalid setting.
    pub(crate) fn settings(&self) -> Result<DropSettings, Failure> {
        Ok(serde_json::from_value(self.of("drop")?.settings())?)
    }

    /// The given settings with the options applied, except the number of trials, which need not be odd there,
    /// and the seed.
    ///
    /// # Errors
    /// An invalid setting.
    pub(crate) fn on(&self, settings: DropSettings) -> Result<DropSettings, Failure> {
        let mut changes = self.changes();
        changes.retain(|change| !matches!(change.setting, "trials" | "seed"));
        Ok(serde_json::from_value(with_changes(&Method::new(settings), &changes)?.settings())?)
    }

    /// The number of trials, if given.
    pub(crate) fn trials(&self) -> Option<usize> {
        self.trials.map(|trials| trials as usize)
    }

    /// The seed of the trials, if given.
    pub(crate) const fn seed(&self) -> Option<u64> {
        self.trial_seed
    }

    /// Friction coefficient between the halves; 0 by default.
    pub(crate) fn friction(&self) -> f64 {
        self.friction.unwrap_or_default()
    }

    /// Whether an option sets the driving force.
    pub(crate) const fn pushes(&self) -> bool {
        self.push.is_some() || self.gravity.is_some() || self.preset.is_some()
    }

    /// The option that fixes the value of a circumstance, if given.
    pub(crate) fn fixes(&self, of: Circumstance) -> Option<&'static str> {
        let (option, given) = match of {
            Circumstance::Speed => ("--speed", self.speed.is_some()),
            Circumstance::DriftX | Circumstance::DriftY => ("--drift", self.drift.is_some()),
            Circumstance::SpinRoll | Circumstance::SpinPitch | Circumstance::SpinYaw => {
                ("--spin", self.spin.is_some())
            }
            Circumstance::Mass => ("--mass", self.mass.is_some()),
            Circumstance::Friction => ("--friction", self.friction.is_some()),
            Circumstance::Restitution => ("--restitution", self.restitution.is_some()),
            Circumstance::Height => ("--drop-height", self.drop_height.is_some()),
        };
        given.then_some(option)
    }

    /// The named method with the options applied.
    ///
    /// # Errors
    /// A setting that the method lacks or rejects.
    pub(crate) fn of(&self, method: &str) -> Result<Method, Failure> {
        with_changes(&method.parse::<Method>()?, &self.changes())
    }
}

/// Parses two numbers.
fn pair(text: &str) -> Result<[f64; 2], String> {
    numbers(text)
}

/// Parses three numbers.
fn triple(text: &str) -> Result<[f64; 3], String> {
    numbers(text)
}

fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let read: Result<Vec<f64>, String> = text
        .split(',')
        .map(|part| number(part).map_err(|reason| format!("`{}`: {reason}", part.trim())))
        .collect();
    <[f64; N]>::try_from(read?)
        .map_err(|list| format!("it has {} numbers: give {N} numbers with commas between them", list.len()))
}
