//! Ways to decide what becomes of a pose error. Every one has the same door, `Settings` + input + `&Exec`,
//! and returns an [`crate::acceptance::Acceptance`].

pub mod correction;
pub mod descent;
#[cfg(feature = "drop")]
pub mod drop;
pub mod flood;
pub mod kinematic;
pub mod partition;
pub mod transport;
pub mod zraa;

use crate::connector::Half;
use crate::contact::Pair;
use crate::design::Design;
use crate::landscape::Resolution;
use serde::{Deserialize, Serialize};

/// The methods that decide every cell of an error grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// [`transport`]: arrival fractions along exact directions of descent.
    Transport,
    /// [`descent`]: exact motion of every cell's centre.
    Descent,
    /// [`flood`]: basins of the heights over the grid.
    Flood,
    /// [`flood`], every cell to its steepest neighbour.
    Steepest,
    /// [`partition`]: polytopes of the contact space, sampled at every cell's centre.
    Partition,
    /// [`kinematic`]: bounds and stepping of planar faces.
    Kinematic,
    /// [`mod@drop`]: every cell's centre let go in a rigid-body engine.
    #[cfg(feature = "drop")]
    Drop,
}

/// A method that cannot decide a design.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{} does not apply to this design: {reason}", method.name())]
pub struct NotApplicable {
    /// The method.
    pub method: Method,
    /// Why.
    pub reason: String,
}

impl Method {
    /// All of them, the default first.
    pub const ALL: [Self; 6 + cfg!(feature = "drop") as usize] = [
        Self::Transport,
        Self::Descent,
        Self::Flood,
        Self::Steepest,
        Self::Partition,
        Self::Kinematic,
        #[cfg(feature = "drop")]
        Self::Drop,
    ];

    /// Those whose answer depends on nothing but the grid and its resolution: what studies of resolution compare.
    pub const ON_GRIDS: [Self; 4] = [Self::Transport, Self::Descent, Self::Flood, Self::Steepest];

    /// Whether it can decide a design.
    ///
    /// # Errors
    /// When it cannot, with the reason.
    pub fn applies_to(self, design: &Design) -> Result<(), NotApplicable> {
        match self {
            Self::Kinematic => kinematic::Settings::of(design)
                .map(|_| ())
                .map_err(|unfit| NotApplicable { method: self, reason: unfit.to_string() }),
            Self::Partition if design.alignment.free.len() < 2 || design.alignment.free.rotations() == 0 => {
                let reason = "it needs at least two free errors, one of them a rotation".to_owned();
                Err(NotApplicable { method: self, reason })
            }
            Self::Transport | Self::Descent | Self::Partition | Self::Flood | Self::Steepest => Ok(()),
            #[cfg(feature = "drop")]
            Self::Drop => Ok(()),
        }
    }

    /// The lower-case name used in files, reports and options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Descent => "descent",
            Self::Transport => "transport",
            Self::Flood => "flood",
            Self::Steepest => "steepest",
            Self::Partition => "partition",
            Self::Kinematic => "kinematic",
            #[cfg(feature = "drop")]
            Self::Drop => "drop",
        }
    }

    /// What it does, in a line.
    pub const fn summary(self) -> &'static str {
        match self {
            Self::Descent => "exact frictionless motion of every cell's centre",
            Self::Transport => {
                "arrival fractions over the grid along exact directions; ambiguous cells by descent"
            }
            Self::Flood => "fast flooding of the heights over the grid; biased, made for comparisons",
            Self::Steepest => "flooding along the steepest neighbour; biased too, made for comparisons",
            Self::Partition => {
                "watersheds of the contact space as polytopes, without a grid; two or three errors"
            }
            Self::Kinematic => "planar bounds and stepping of the dissertation; v-face, s-face and x-face",
            #[cfg(feature = "drop")]
            Self::Drop => {
                "drop tests of every cell's centre in a rigid-body engine: friction, mass, speed, bounce"
            }
        }
    }

    /// Where flooding drains a cell to; `None` for methods that do not flood.
    pub const fn rule(self) -> Option<flood::Rule> {
        match self {
            Self::Flood => Some(flood::Rule::Lowest),
            Self::Steepest => Some(flood::Rule::Steepest),
            Self::Transport | Self::Descent | Self::Partition | Self::Kinematic => None,
            #[cfg(feature = "drop")]
            Self::Drop => None,
        }
    }

    /// Cells per axis when nothing was said, for one to five axes: an answer within seconds, at 0.1 to 0.5 ms per
    /// descent between simple halves and below 1 µs per cell of the other methods. Odd for descent and
    /// flooding, so that a cell is centred on the mated pose.
    pub fn default_cells(self, pair: &Pair) -> [usize; 5] {
        const SIMPLE: [usize; 5] = [1001, 101, 25, 11, 7];
        match self {
            Self::Descent => {
                let share = affordable(pair);
                let mut axes = 0.0;
                SIMPLE.map(|cells| {
                    axes += 1.0;
                    let cells = cells as f64 * share.powf(1.0 / axes);
                    ((cells as usize).saturating_sub(1) / 2 * 2 + 1).max(3)
                })
            }
            // Even, so that no cell lies exactly on a mirror plane, where two contacts carry the half at once.
            Self::Transport | Self::Kinematic => [1000, 200, 50, 30, 20],
            Self::Flood | Self::Steepest | Self::Partition => Resolution::DEFAULT_CELLS,
            // Half a minute at some 20 ms per pose.
            #[cfg(feature = "drop")]
            Self::Drop => [101, 31, 11, 7, 5],
        }
    }

    /// Random poses followed exactly to correct the Sum when nothing was said. They would cost a flooded run its speed.
    pub fn default_samples(self, pair: &Pair) -> usize {
        const SIMPLE: f64 = 4000.0;
        const LEAST: f64 = 200.0;
        match self {
            Self::Descent | Self::Transport => (SIMPLE * affordable(pair)).max(LEAST) as usize,
            Self::Flood | Self::Steepest | Self::Partition | Self::Kinematic => 0,
            #[cfg(feature = "drop")]
            Self::Drop => 0,
        }
    }
}

/// How many descents can be afforded, as a share of what simple halves allow: round ones have many facets, and the
/// time of a descent grows with about the cube of their number.
fn affordable(pair: &Pair) -> f64 {
    const SIMPLE: f64 = 64.0;
    let facets = |half: &Half| half.surfaces.iter().map(|s| s.facets.len()).sum::<usize>();
    let facets = (facets(&pair.fixed) + facets(&pair.moving)) as f64;
    (SIMPLE / facets.max(SIMPLE)).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use crate::pose::{DofSet, Mount};

    fn pair(spec: FamilySpec) -> Pair {
        let alignment = Alignment::new(DofSet::ALL, Mount::X);
        let connector = ConnectorSpec::Family(spec);
        let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
        Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
    }

    #[test]
    fn round_halves_get_fewer_descents_and_every_default_is_odd() {
        let simple = pair(FamilySpec::new(Family::Pyramid));
        let round = pair(FamilySpec::new(Family::Cone).with_chord_error(0.0005));
        assert_eq!(Method::Descent.default_cells(&simple), [1001, 101, 25, 11, 7]);
        assert_eq!(Method::Descent.default_samples(&simple), 4000);
        assert!(Method::Descent.default_samples(&round) < 4000);
        for (few, many) in
            Method::Descent.default_cells(&round).iter().zip(Method::Descent.default_cells(&simple))
        {
            assert!(*few < many && *few >= 3 && few % 2 == 1, "{few}");
        }
        assert_eq!(Method::Flood.default_cells(&round), Resolution::DEFAULT_CELLS);
    }
}
