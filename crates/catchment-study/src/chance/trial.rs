//! A trial: its random draw, and the resulting settings.

use super::{ChanceError, ChanceSettings};
use catchment_core::acceptance::Stream;
use catchment_core::method::drop::{self, Bench, Launch, MassProperties, Push};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Circumstance, Dynamics, ScalarDistribution};
use catchment_core::problem::Problem;

/// Approach speed at which trials of held speed are computed, in D/s of their own time: 0.005 D per step with
/// the engine's default step, for which its contacts are tuned.
const PACE: f64 = 5.0;
/// Numbers for the start of a trial, before those of its circumstances.
const START: u64 = 8;

/// The random draw of a trial, in the order of [`Circumstance::ALL`]; `None` for parameters that are not
/// declared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Draw {
    values: [Option<f64>; Circumstance::ALL.len()],
    /// Change of the start in each error, in [−1, 1].
    off: [f64; 5],
}

impl Draw {
    /// By numbers that can be looked up.
    pub(super) fn of(dynamics: &Dynamics, stream: Stream) -> Self {
        let value = |of: Circumstance| {
            let uniform = |k: u64| stream.uniform(START + ScalarDistribution::DRAWN * of.index() as u64 + k);
            dynamics.law(of).map(|law| law.draw(of.range(), uniform))
        };
        let off = std::array::from_fn(|k| 2.0 * stream.uniform(k as u64) - 1.0);
        Self { values: Circumstance::ALL.map(value), off }
    }

    fn get(&self, of: Circumstance) -> Option<f64> {
        self.values[of.index()]
    }

    /// Friction between the halves in a trial.
    pub(super) fn friction(&self, settings: &ChanceSettings) -> f64 {
        self.get(Circumstance::Friction).unwrap_or(settings.drop.friction)
    }

    /// Start of a trial of this pose.
    pub(super) fn start(&self, problem: &Problem, settings: &ChanceSettings, error: &PoseError) -> PoseError {
        let alignment = problem.alignment();
        let mut start = error.to_array();
        for dof in alignment.free.iter() {
            let unit = if dof.is_rotation() { alignment.rotation_length } else { 1.0 };
            start[dof.index()] += settings.drop.perturbation * self.off[dof.index()] / unit;
        }
        PoseError::from_array(start)
    }

    /// The settings of a trial, with every velocity times `factor`; `nominal` is the mass whose damping is declared, in kg.
    pub(super) fn settings(
        &self,
        settings: &ChanceSettings,
        factor: f64,
        nominal: f64,
    ) -> drop::DropSettings {
        let mut drop = settings.drop.clone();
        let of = |of: Circumstance, rest: f64| self.get(of).unwrap_or(rest);
        let mass = of(Circumstance::Mass, nominal);
        drop.body = match drop.body {
            MassProperties::Given { gyration, center, .. } => {
                MassProperties::Given { mass, gyration, center }
            }
            MassProperties::Solid { density } => MassProperties::Solid { density: density * mass / nominal },
        };
        drop.damping *= nominal / mass;
        drop.angular_damping *= nominal / mass;
        drop.friction = self.friction(settings);
        drop.restitution = of(Circumstance::Restitution, drop.restitution);
        drop.drop_height = of(Circumstance::Height, drop.drop_height);
        let Launch { speed, drift: [x, y], spin: [roll, pitch, yaw] } = drop.launch;
        drop.launch = Launch {
            speed: factor * of(Circumstance::Speed, speed),
            drift: [of(Circumstance::DriftX, x), of(Circumstance::DriftY, y)].map(|v| factor * v),
            spin: [
                of(Circumstance::SpinRoll, roll),
                of(Circumstance::SpinPitch, pitch),
                of(Circumstance::SpinYaw, yaw),
            ]
            .map(|rate| factor * rate),
        };
        if settings.held {
            // In a time in which it approaches at PACE.
            let slower = PACE / drop.launch.speed.max(f64::MIN_POSITIVE);
            drop.damping *= slower;
            drop.angular_damping *= slower;
            drop.launch.speed = PACE;
            drop.launch.drift = drop.launch.drift.map(|v| v * slower);
            drop.launch.spin = drop.launch.spin.map(|rate| rate * slower);
            drop.push = Push::Force(mass * drop.damping * PACE);
        }
        drop
    }
}

/// The mass for the declared damping: the mean of the distribution, or the mass of the settings, in kg.
pub(super) fn nominal(settings: &ChanceSettings, bench: &Bench<'_>) -> f64 {
    settings.dynamics.mean(Circumstance::Mass).unwrap_or_else(|| bench.mass(&settings.drop))
}

/// The error that a circumstance moves.
const fn moves(of: Circumstance) -> Option<Dof> {
    match of {
        Circumstance::DriftX => Some(Dof::X),
        Circumstance::DriftY => Some(Dof::Y),
        Circumstance::SpinRoll => Some(Dof::Roll),
        Circumstance::SpinPitch => Some(Dof::Pitch),
        Circumstance::SpinYaw => Some(Dof::Yaw),
        _ => None,
    }
}

/// Refuses laws that no trial can be made with.
pub(super) fn check(problem: &Problem, settings: &ChanceSettings) -> Result<(), ChanceError> {
    settings.drop.check().map_err(|error| ChanceError::Drop(error.into()))?;
    for (of, _) in settings.dynamics.declared() {
        if let Some(axis) = moves(of).filter(|axis| !problem.alignment().free.contains(*axis)) {
            return Err(ChanceError::Locked { of, axis });
        }
    }
    if settings.held {
        let stands = match settings.dynamics.law(Circumstance::Speed) {
            None => settings.drop.launch.speed <= 0.0,
            Some(ScalarDistribution::Measured { measured }) => measured.contains(&0.0),
            Some(law) => law.is_constant() && law.mean() <= 0.0,
        };
        if stands {
            return Err(ChanceError::NoSpeed);
        }
        if settings.drop.damping <= 0.0 {
            return Err(ChanceError::Undamped);
        }
    }
    Ok(())
}
