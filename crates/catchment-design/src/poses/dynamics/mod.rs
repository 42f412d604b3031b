//! The dynamic parameters of a docking (speed, mass, friction …), each with its distribution.
//!
//! ```toml
//!   [dynamics]
//!   speed = { mean = "50 mm/s", sigma = "10 mm/s" }      # along the approach; normal
//!   drift_x = "0 ± 5 mm/s"                               # across it, also drift_y; the same law on one line
//!   spin_yaw = "0 ± 2 deg/s"                             # rates of roll, pitch and yaw
//!   mass = { from = 1.8, to = 2.2 }                      # kg; even between the two
//!   friction = { median = 0.2, factor = 1.3 }            # lognormal: two thirds within 0.2/1.3 and 0.2·1.3
//!   restitution = { measured = [0.05, 0.1, 0.3] }        # any of these, each as likely
//!   height = "5 mm"                                      # always the same: how far above first contact it is let go
//! ```
//!
//! On one line: `50 mm/s`, `50 ± 10 mm/s` (or `+-`), `40..60 mm/s`, `0.2 */ 1.3`. Bare numbers are in D, radians, seconds and kg.
//!
//! A distribution that exceeds the possible range of its parameter (a negative mass) is truncated: values
//! outside are drawn again. It is rejected if more than half lies outside. All errors of a file are reported
//! at once, each with its byte range in the text.

mod law;
mod read;
#[cfg(test)]
mod tests;

pub use law::ScalarDistribution;
pub use read::{parse_draw, read_dynamics};

use serde::{Deserialize, Serialize};

/// A dynamic parameter of a docking.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Circumstance {
    /// Speed along the approach at release, in D/s.
    Speed,
    /// Velocity of the centre of rotation along x at release, in D/s.
    DriftX,
    /// Velocity of the centre of rotation along y at release, in D/s.
    DriftY,
    /// Rate of roll at release, in rad/s.
    SpinRoll,
    /// Rate of pitch at release, in rad/s.
    SpinPitch,
    /// Rate of yaw at release, in rad/s.
    SpinYaw,
    /// Mass of the moving half, in kg.
    Mass,
    /// Coefficient of friction between the halves.
    Friction,
    /// Coefficient of restitution: share of the approach speed after a bounce.
    Restitution,
    /// Height above first contact at release, in D.
    Height,
}

impl Circumstance {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 10] = [
        Self::Speed,
        Self::DriftX,
        Self::DriftY,
        Self::SpinRoll,
        Self::SpinPitch,
        Self::SpinYaw,
        Self::Mass,
        Self::Friction,
        Self::Restitution,
        Self::Height,
    ];

    /// Its place in [`Circumstance::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::DriftX => "drift_x",
            Self::DriftY => "drift_y",
            Self::SpinRoll => "spin_roll",
            Self::SpinPitch => "spin_pitch",
            Self::SpinYaw => "spin_yaw",
            Self::Mass => "mass",
            Self::Friction => "friction",
            Self::Restitution => "restitution",
            Self::Height => "height",
        }
    }

    /// Its unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Speed | Self::DriftX | Self::DriftY => "D/s",
            Self::SpinRoll | Self::SpinPitch | Self::SpinYaw => "rad/s",
            Self::Mass => "kg",
            Self::Friction | Self::Restitution => "",
            Self::Height => "D",
        }
    }

    /// The values that it may have.
    pub const fn range(self) -> [f64; 2] {
        /// Faster than this, in widths or radians a second, is in the wrong unit.
        const FASTEST: f64 = 1e4;
        /// Kilograms.
        const LIGHTEST: f64 = 1e-9;
        const HEAVIEST: f64 = 1e9;
        /// As for exact motions.
        const ROUGHEST: f64 = 10.0;
        /// In D.
        const HIGHEST: f64 = 100.0;
        match self {
            Self::Speed => [0.0, FASTEST],
            Self::Mass => [LIGHTEST, HEAVIEST],
            Self::Friction => [0.0, ROUGHEST],
            Self::Restitution => [0.0, 1.0],
            Self::Height => [0.0, HIGHEST],
            _ => [-FASTEST, FASTEST],
        }
    }
}

/// The distributions of all declared parameters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct Dynamics {
    declared: std::collections::BTreeMap<Circumstance, ScalarDistribution>,
}

impl Dynamics {
    /// The law of a circumstance, if it is declared.
    pub fn law(&self, of: Circumstance) -> Option<&ScalarDistribution> {
        self.declared.get(&of)
    }

    /// The same with another law.
    #[must_use]
    pub fn with(mut self, of: Circumstance, law: ScalarDistribution) -> Self {
        self.declared.insert(of, law);
        self
    }

    /// The mean of a parameter, clamped to its range; `None` if it is not declared.
    pub fn mean(&self, of: Circumstance) -> Option<f64> {
        let [lo, hi] = of.range();
        self.law(of).map(|law| law.mean().clamp(lo, hi))
    }

    /// The declared parameters, in the order of [`Circumstance::ALL`].
    pub fn declared(&self) -> impl Iterator<Item = (Circumstance, &ScalarDistribution)> {
        self.declared.iter().map(|(of, law)| (*of, law))
    }

    /// Whether anything varies.
    pub fn varies(&self) -> bool {
        self.declared.values().any(|law| !law.is_constant())
    }
}
