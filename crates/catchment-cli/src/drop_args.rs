//! The settings of drop tests, as a person writes them.

use crate::failure::Failure;
use catchment::method::drop::{Body, Push, Settings};
use clap::Args;

/// What may be said of drop tests.
#[derive(Debug, Args)]
pub(crate) struct DropArgs {
    /// Force along the approach, through the centre of rotation, in kg·D/s² [default: 5000]
    #[arg(long, value_name = "FORCE", help_heading = DROP)]
    push: Option<f64>,
    /// Gravity along the approach, through the centre of mass, in D/s²; instead of --push
    #[arg(long, value_name = "ACCELERATION", help_heading = DROP, conflicts_with = "push")]
    gravity: Option<f64>,
    /// Mass of the moving half in kg, at the centre of rotation [default: 1]
    #[arg(long, value_name = "MASS", help_heading = DROP)]
    mass: Option<f64>,
    /// Radius of gyration about it in D: inertia = mass·gyration² [default: rho]
    #[arg(long, value_name = "LENGTH", help_heading = DROP)]
    gyration: Option<f64>,
    /// Density in kg/D³: mass, centre of mass and inertia are those of the solid; instead of --mass
    #[arg(long, value_name = "DENSITY", help_heading = DROP, conflicts_with_all = ["mass", "gyration"])]
    density: Option<f64>,
    /// Friction with the surroundings, 1/s: the force -mass·damping·v [default: 1000, heavy]
    #[arg(long, value_name = "RATE", help_heading = DROP)]
    damping: Option<f64>,
    /// The same for turning, 1/s: the torque -mass·rate·rho²·omega [default: as --damping]
    #[arg(long, value_name = "RATE", help_heading = DROP)]
    angular_damping: Option<f64>,
    /// Coefficient of friction between the halves [default: 0]
    #[arg(long, value_name = "MU", help_heading = DROP)]
    friction: Option<f64>,
    /// Share of the approach speed that a bounce gives back [default: 0]
    #[arg(long, value_name = "SHARE", help_heading = DROP)]
    restitution: Option<f64>,
    /// Height above first contact from which the half is let go, in D [default: 0.01]
    #[arg(long, value_name = "LENGTH", help_heading = DROP)]
    drop_height: Option<f64>,
    /// Time step of the engine, in s [default: 0.001]
    #[arg(long, value_name = "TIME", help_heading = DROP)]
    timestep: Option<f64>,
    /// Simulated time after which a trial ends, in s [default: 20]
    #[arg(long, value_name = "TIME", help_heading = DROP)]
    timeout: Option<f64>,
    /// Trials per pose, odd: more than half must align [default: 3]
    #[arg(long, value_name = "N", help_heading = DROP)]
    trials: Option<u32>,
    /// Largest random change of the start of a trial, in D and radians times rho [default: 0.001]
    #[arg(long, value_name = "LENGTH", help_heading = DROP)]
    perturbation: Option<f64>,
    /// Seed of these changes [default: 1]
    #[arg(long, value_name = "SEED", help_heading = DROP)]
    trial_seed: Option<u64>,
}

const DROP: &str = "Drop tests (--method drop); lengths in D, times in s, masses in kg";

impl DropArgs {
    /// What was asked for.
    ///
    /// # Errors
    /// A setting that no trial can be made with.
    pub(crate) fn settings(&self) -> Result<Settings, Failure> {
        let default = Settings::default();
        let damping = self.damping.unwrap_or(default.damping);
        let settings = Settings {
            push: match (self.push, self.gravity) {
                (_, Some(gravity)) => Push::Gravity(gravity),
                (Some(force), None) => Push::Force(force),
                (None, None) => default.push,
            },
            body: match self.density {
                Some(density) => Body::Solid { density },
                None => Body::Given { mass: self.mass.unwrap_or(1.0), gyration: self.gyration },
            },
            damping,
            angular_damping: self.angular_damping.unwrap_or(damping),
            friction: self.friction.unwrap_or(default.friction),
            restitution: self.restitution.unwrap_or(default.restitution),
            drop_height: self.drop_height.unwrap_or(default.drop_height),
            timestep: self.timestep.unwrap_or(default.timestep),
            timeout: self.timeout.unwrap_or(default.timeout),
            trials: self.trials.unwrap_or(default.trials),
            perturbation: self.perturbation.unwrap_or(default.perturbation),
            seed: self.trial_seed.unwrap_or(default.seed),
            ..default
        };
        settings.check()?;
        Ok(settings)
    }

    /// Refuses settings of drop tests where another method decides.
    ///
    /// # Errors
    /// The first setting that was given.
    pub(crate) fn refuse(&self, method: &str) -> Result<(), Failure> {
        let given = [
            ("--push", self.push.is_some()),
            ("--gravity", self.gravity.is_some()),
            ("--mass", self.mass.is_some()),
            ("--gyration", self.gyration.is_some()),
            ("--density", self.density.is_some()),
            ("--damping", self.damping.is_some()),
            ("--angular-damping", self.angular_damping.is_some()),
            ("--friction", self.friction.is_some()),
            ("--restitution", self.restitution.is_some()),
            ("--drop-height", self.drop_height.is_some()),
            ("--timestep", self.timestep.is_some()),
            ("--timeout", self.timeout.is_some()),
            ("--trials", self.trials.is_some()),
            ("--perturbation", self.perturbation.is_some()),
            ("--trial-seed", self.trial_seed.is_some()),
        ];
        match given.iter().find(|(_, given)| *given) {
            Some((option, _)) => {
                let message = format!("{option} is a setting of drop tests; {method} has none");
                Err(Failure::with_help(message, Some("add --method drop, or leave it out".to_owned())))
            }
            None => Ok(()),
        }
    }
}
