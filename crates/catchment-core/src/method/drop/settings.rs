//! Settings that change the result of a drop test.
//!
//! Units: lengths in D, times in s, masses in kg, so a force of 1 is 1 kg·D/s² (1 N where D is a metre) and
//! gravity on a connector of D = 50 mm is 9.81 m/s² = 196 D/s².

use serde::{Deserialize, Serialize};

/// Settings of [`run`](super::run) that may change its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct DropSettings {
    /// Force that drives the moving half along the approach.
    pub push: Push,
    /// Mass and inertia of the moving half.
    pub body: MassProperties,
    /// Damping by the surroundings per velocity of the COR and per mass, in 1/s: the force −mass·`damping`·v.
    pub damping: f64,
    /// Rotational damping, in 1/s: the torque −mass·`angular_damping`·ρ²·ω, with the characteristic length ρ
    /// of the alignment. If it equals `damping`, friction dissipates c·(|v|² + ρ²|ω|²), c = mass·`damping`:
    /// the metric of `descent`.
    pub angular_damping: f64,
    /// Coefficient of Coulomb friction between the halves.
    pub friction: f64,
    /// Share of the approach speed that a bounce gives back, in [0, 1].
    pub restitution: f64,
    /// Distance of a ground plane below the lowest point of the fixed half, in D; 0 if the fixed half stands
    /// on the ground.
    pub ground: Option<f64>,
    /// Height above first contact from which the half is released, in D.
    pub drop_height: f64,
    /// Motion of the half at release; at rest by default.
    pub launch: Launch,
    /// Factor on inertia and rotational damping: 10⁵ practically locks rotations, as in the dissertation
    /// (section 4.2.2).
    pub inertia_factor: f64,
    /// Time step of the engine, in s.
    pub timestep: f64,
    /// Simulated time after which a trial ends, in s: jammed if the half is at rest, undecided if not.
    pub timeout: f64,
    /// A trial has missed if the face centres are farther apart than at first contact by this much, in D.
    pub lost_beyond: f64,
    /// The half is at rest if its speed, v at the COR and ρ·ω combined, in D/s, averaged over 64 steps, is
    /// below this twice in a row.
    pub rest_speed: f64,
    /// Trials per pose; more than half of them must dock.
    pub trials: u32,
    /// Largest perturbation of the start of a trial, uniform and independent in every free error: in D; for
    /// angles radians times ρ.
    pub perturbation: f64,
    /// Seed of the perturbations.
    pub seed: u64,
}

/// Force that drives the moving half against the fixed half.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Push {
    /// A constant force along the approach through the COR, in kg·D/s².
    Force(f64),
    /// Gravity along the approach, through the centre of mass, in D/s².
    Gravity(f64),
}

/// Motion of the moving half at release. Components of locked errors are ignored.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Launch {
    /// Speed of the COR along the approach, towards the fixed half, in D/s.
    pub speed: f64,
    /// Velocity of the COR along x and y, in D/s.
    pub drift: [f64; 2],
    /// Rates of roll, pitch and yaw, in rad/s.
    pub spin: [f64; 3],
}

/// Mass and inertia of the moving half.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum MassProperties {
    /// Given.
    Given {
        /// Mass in kg.
        mass: f64,
        /// Radius of gyration about every axis through the centre of mass, in D: the inertia is
        /// mass·gyration². `None`: ρ, so that inertia and friction have the same metric.
        gyration: Option<f64>,
        /// Centre of mass, from the face centre of the moving half, along the axes of the fixed half in the
        /// docked pose (z away from the fixed half), in D. `None`: at the COR.
        #[serde(default)]
        center: Option<[f64; 3]>,
    },
    /// A solid of this density: mass, centre of mass and inertia follow from the geometry. Overlapping pieces
    /// count twice.
    Solid {
        /// In kg/D³.
        density: f64,
    },
}

impl Default for DropSettings {
    fn default() -> Self {
        Self {
            push: Push::Force(5000.0),
            body: MassProperties::Given { mass: 1.0, gyration: None, center: None },
            damping: 1000.0,
            angular_damping: 1000.0,
            friction: 0.0,
            restitution: 0.0,
            ground: None,
            drop_height: 0.01,
            launch: Launch::default(),
            inertia_factor: 1.0,
            timestep: 1e-3,
            timeout: 20.0,
            lost_beyond: 1.0,
            rest_speed: 5e-4,
            trials: 3,
            perturbation: 1e-3,
            seed: 1,
        }
    }
}

/// Settings under a name.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// How it is called.
    pub name: &'static str,
    /// Description.
    pub summary: &'static str,
    /// The settings.
    pub settings: fn() -> DropSettings,
    /// Values that its source leaves open, and the values used here instead.
    pub unknown: &'static [&'static str],
}

/// The presets.
pub const PRESETS: [Preset; 1] = [Preset {
    name: "gazebo-2014",
    summary: "the trials of the dissertation, as far as it states them: gravity of 9000 m/s², velocities that decay by 0.99 per \
              step, a ground",
    settings: DropSettings::gazebo_2014,
    unknown: &[
        "the time step: 1 ms, the default of Gazebo, is taken",
        "the range of the slices: that of the design's error box is taken",
        "the back of the part, which decides its mass and what of it meets the ground: that of the design is taken, of one density",
        "how near counts as aligned: the seat is taken",
        "how high it is let go: 0.01 D above first contact is taken",
        "how long is unusually long: 20 s is taken",
        "whether the lower half could slide on its ground: it is held",
    ],
}];

impl DropSettings {
    /// The drop tests of the dissertation, sections 4.2.1 and 4.2.2, as far as they are stated.
    ///
    /// Stated: g = 9000 m/s² through the solid's centre of mass; all velocities lose 0.99 of themselves per
    /// step; no friction, no bounce; one half on a ground plane; failed if the face centres are more than a
    /// width apart; the majority of three trials.
    ///
    /// Our reading: D = 65.5 mm, the prototypes' face: it only scales time. The decay is a force, 99 per step
    /// and mass, taken implicitly, so contacts push in the metric of friction with ρ of the design, whereas
    /// ODE pushes in that of inertia and scales velocities afterwards. A uniform solid. The lower half is
    /// held: the source does not state whether it could slide on its ground.
    ///
    /// Unknown: time step (here Gazebo's default), range of the slices, the back of the part (its mass and
    /// its contact with the ground), the threshold below which a distance counts as aligned (here our seat),
    /// the drop height, the duration that is "unusually long".
    pub fn gazebo_2014() -> Self {
        /// m/s².
        const GRAVITY: f64 = 9000.0;
        /// Metres.
        const WIDTH: f64 = 0.0655;
        const DECAY: f64 = 0.99;
        let default = Self::default();
        // An implicit step leaves 1/(1 + rate·step) of a velocity.
        let rate = DECAY / (1.0 - DECAY) / default.timestep;
        Self {
            push: Push::Gravity(GRAVITY / WIDTH),
            body: MassProperties::Solid { density: 1.0 },
            damping: rate,
            angular_damping: rate,
            ground: Some(0.0),
            ..default
        }
    }
}

/// A setting that no trial can be made with.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} = {value}: {advice}")]
pub struct SettingError {
    /// The setting.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// The permitted values.
    pub advice: &'static str,
}

/// Largest number of steps of a trial: an hour of computing, not a hang.
const MOST_STEPS: f64 = 1e8;

/// Largest number of trials per pose: sufficient to distinguish a share from one half by 1 %; more would take
/// minutes per pose.
const MOST_TRIALS: u32 = 9_999;

impl DropSettings {
    /// Rejects settings with which no trial is possible.
    ///
    /// # Errors
    /// The first setting that is out of its range.
    pub fn check(&self) -> Result<(), SettingError> {
        let positive = |name, value: f64| {
            let advice = "give a number above 0";
            if value > 0.0 && value.is_finite() { Ok(()) } else { Err(SettingError { name, value, advice }) }
        };
        let at_least_zero = |name, value: f64| {
            let advice = "give 0 or more";
            if value >= 0.0 && value.is_finite() { Ok(()) } else { Err(SettingError { name, value, advice }) }
        };
        let finite = |name, value: f64| {
            let advice = "give a number";
            if value.is_finite() { Ok(()) } else { Err(SettingError { name, value, advice }) }
        };
        match self.push {
            Push::Force(force) => positive("force", force)?,
            Push::Gravity(gravity) => positive("gravity", gravity)?,
        }
        match self.body {
            MassProperties::Given { mass, gyration, center } => {
                positive("mass", mass)?;
                gyration.map_or(Ok(()), |gyration| positive("gyration", gyration))?;
                center.into_iter().flatten().try_for_each(|part| finite("center", part))?;
            }
            MassProperties::Solid { density } => positive("density", density)?,
        }
        for (name, value) in [
            ("damping", self.damping),
            ("angular_damping", self.angular_damping),
            ("friction", self.friction),
            ("drop_height", self.drop_height),
            ("rest_speed", self.rest_speed),
            ("perturbation", self.perturbation),
        ] {
            at_least_zero(name, value)?;
        }
        self.ground.map_or(Ok(()), |ground| at_least_zero("ground", ground))?;
        at_least_zero("speed", self.launch.speed)?;
        self.launch.drift.into_iter().try_for_each(|part| finite("drift", part))?;
        self.launch.spin.into_iter().try_for_each(|part| finite("spin", part))?;
        positive("inertia_factor", self.inertia_factor)?;
        if !(0.0..=1.0).contains(&self.restitution) {
            let advice = "give a share between 0 and 1";
            return Err(SettingError { name: "restitution", value: self.restitution, advice });
        }
        for (name, value) in
            [("timestep", self.timestep), ("timeout", self.timeout), ("lost_beyond", self.lost_beyond)]
        {
            positive(name, value)?;
        }
        if self.timeout / self.timestep > MOST_STEPS {
            let advice = "that is over 100 million time steps: give a shorter timeout or a longer step";
            return Err(SettingError { name: "timeout", value: self.timeout, advice });
        }
        if self.trials.is_multiple_of(2) {
            let (value, advice) = (f64::from(self.trials), "give an odd number, so that there is a majority");
            return Err(SettingError { name: "trials", value, advice });
        }
        if self.trials > MOST_TRIALS {
            let (value, advice) =
                (f64::from(self.trials), "give at most 9999; a few perturbed trials decide");
            return Err(SettingError { name: "trials", value, advice });
        }
        Ok(())
    }

    /// The preset from which these settings come, if the values that it sets are unchanged.
    pub fn preset(&self) -> Option<&'static Preset> {
        PRESETS.iter().find(|preset| {
            let of = (preset.settings)();
            (self.push, self.body, self.damping, self.ground) == (of.push, of.body, of.damping, of.ground)
        })
    }

    /// Largest number of steps of a trial.
    pub(super) fn steps(&self) -> usize {
        (self.timeout / self.timestep).ceil() as usize
    }
}
