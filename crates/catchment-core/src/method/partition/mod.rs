//! The dissertation's polyhedral method: the contact space as polytopes, with exact watersheds.
//!
//! ```text
//!   slices ──▶ composites ──▶ Minkowski sum ──▶ contact space ──▶ gates ──▶ watersheds ──▶ area of acceptance
//!   of the     (compose)      with the flat     (space: upward    (cells)   (split along    (polytopes over the
//!   moving                    fixed half         facets in first             steepest       pose errors)
//!   half                                         contact)                    ascent)
//! ```
//!
//! No grid is involved: the area of acceptance is a P-collection, a finite union of convex polytopes, with an exact
//! outline. It works in any number of free errors from two (x and an angle: polytopes in 3-D) to five (6-D); the number of
//! polytopes grows with the product of the slices of all rotations, so up to three errors are practical.
//!
//! The rotation between slices is approximate (a corner runs along its chord), and so is the ravine rule for
//! three errors and more. Not promised: convergence of the watersheds at a fixed number of strips, see
//! [`PartitionSettings::strips`].
//!
//! Source: dissertation, sections 5.1 and 5.2, figures 5.5–5.8.

mod cells;
mod compose;
pub(super) mod entry;
mod frame;
mod oracle;
mod outline;
mod pieces;
mod solids;
mod space;
#[cfg(test)]
mod tests;
mod watershed;

use super::descent;
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::contact::{Pair, Seat};
use crate::design::Alignment;
use crate::diagnostic::{Advice, Warning};
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::Grid;
use crate::polytope::{MAX_DIMENSION, Polytope, PolytopePoint};
use crate::pose::{CorPose, Dof, PoseError, face_from_cor};
use cells::Cells;
use compose::Compartment;
use glam::DVec2;
pub use outline::Corner;
use pieces::Pieces;
use serde::{Deserialize, Serialize};
pub use solids::{Solid, SolidError, SolidShape, Solids, shapes};
use watershed::{Parts, Watersheds};

/// Settings that change the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct PartitionSettings {
    /// Rotation slices across the error box of every free rotation.
    pub slices: usize,
    /// Strips per D into which the moving half is cut across x (and y) before its slices are joined. A
    /// rotating edge is approximated by a corrugated face whose slopes are wrong by up to half a strip's
    /// length, for any number of slices, so strips must grow with the slices. 1 is the dissertation's method.
    pub strips: usize,
}

impl Default for PartitionSettings {
    fn default() -> Self {
        Self { slices: 24, strips: 12 }
    }
}

impl PartitionSettings {
    /// Defaults that take seconds: the polytopes grow with the product of the slices of all angles.
    pub fn for_rotations(rotations: usize) -> Self {
        if rotations < 2 { Self::default() } else { Self { slices: 4, strips: 1 } }
    }

    /// Rejects settings that give no partition.
    fn check(&self) -> Result<(), PartitionError> {
        for (setting, [least, most], given) in
            [("slices", SLICES, self.slices), ("strips", STRIPS, self.strips)]
        {
            if !(least..=most).contains(&given) {
                return Err(PartitionError::Setting { setting, least, most, given });
            }
        }
        Ok(())
    }

    /// The slices of every free rotation of a pair.
    fn slices_of(&self, alignment: &Alignment) -> Vec<(Dof, Vec<f64>)> {
        let rotations = alignment.free.iter().filter(|dof| dof.is_rotation());
        rotations.map(|dof| (dof, compose::slices(alignment.half_range(dof), self.slices))).collect()
    }
}

/// Why there is no partition.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PartitionError {
    /// Nothing to partition.
    #[error("the partition needs at least two free errors, one of them a rotation; there are {free}")]
    TooFewErrors {
        /// Free errors.
        free: usize,
    },
    /// A setting that makes no partition.
    #[error("{setting} must be at least {least} and at most {most}, not {given}")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// The least it may be.
        least: usize,
        /// The most it may be.
        most: usize,
        /// The given value.
        given: usize,
    },
    /// A half is not made of few convex pieces.
    #[error(
        "a half has more than {most} convex pieces; the partition is made for halves of few facets, use another method"
    )]
    TooManyPieces {
        /// The most there may be.
        most: usize,
    },
    /// Strips and pieces make more pairs than can be summed.
    #[error(
        "there are more than {most} pairs of pieces that may meet: cut the moving half into fewer strips"
    )]
    TooManyStrips {
        /// The most there may be.
        most: usize,
    },
    /// A surface has no volume to speak of.
    #[error("a surface is thinner than the resolution of the partition; use another method")]
    FlatPiece,
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Size of a partition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PartitionCounts {
    /// Number of polytopes of the Minkowski sum.
    pub polytopes: usize,
    /// Number of cells of the contact space.
    pub cells: usize,
    /// Number of parts of cells; each part drains to a single other part.
    pub parts: usize,
    /// Number of rests: base watersheds.
    pub rests: usize,
}

/// The partitioned contact space.
#[derive(Debug)]
pub struct Partition {
    alignment: Alignment,
    settings: PartitionSettings,
    cells: Cells,
    compartments: Vec<Compartment>,
    /// The compartment of every cell.
    within: Vec<u32>,
    watersheds: Watersheds,
    counts: PartitionCounts,
}

/// A part of the contact space with a common outcome.
#[derive(Debug, Clone)]
pub struct PartitionPart {
    /// Its pose errors, a coordinate for each free error: lateral position of the *COR* (D), and angles
    /// (radians).
    pub region: Polytope,
    /// Their outcome.
    pub outcome: Outcome,
}

/// Least and most slices of a rotation, and strips per D: beyond them rounding is as large as a cell.
const SLICES: [usize; 2] = [2, 1000];
const STRIPS: [usize; 2] = [1, 200];

/// Bytes of a cell with its gates and parts, roughly: a region of a dozen corners, three times over.
const CELL_BYTES: u64 = 6_000;
/// Polytopes of the sum held per compartment while it is worked on.
const POLYTOPE_BYTES: u64 = 4_000;

/// Partitions the contact space of a pair.
///
/// # Errors
/// [`PartitionError`]; cancel is checked before every compartment and every few cells.
pub fn run(pair: &Pair, settings: &PartitionSettings, exec: &Exec) -> Result<Partition, PartitionError> {
    let alignment = &pair.alignment;
    let free = alignment.free;
    if free.len() < 2 || free.rotations() == 0 {
        return Err(PartitionError::TooFewErrors { free: free.len() });
    }
    settings.check()?;
    let slices = settings.slices_of(alignment);
    let pieces = Pieces::of(pair, 1.0 / settings.strips as f64)?;
    let pairs = pieces.pairs()?;
    let count: u64 = slices.iter().map(|(_, angles)| angles.len() as u64 - 1).product();
    let polytopes: u64 = pairs.iter().map(|met| compose::count(met.moving, slices.len())).sum();
    let threads = exec.threads() as u64;
    exec.ensure_fits(
        "the partition",
        polytopes
            .saturating_mul(POLYTOPE_BYTES * threads)
            .saturating_add(count.saturating_mul(polytopes).saturating_mul(CELL_BYTES / 4)),
        |_| vec![Advice::FewerSlices, Advice::MoreMemory],
    )?;
    let compartments = Compartment::all(&slices);
    let result = spaces(&pairs, &compartments, alignment, exec)?;
    let within = result.iter().zip(0..).flat_map(|((_, tiles), k)| tiles.iter().map(move |_| k)).collect();
    let limits: Vec<(usize, [f64; 2])> = free
        .iter()
        .enumerate()
        .filter(|(_, dof)| dof.is_rotation())
        .map(|(k, dof)| (k, [-alignment.half_range(dof), alignment.half_range(dof)]))
        .collect();
    let mut cells = Cells::new(&result, free, alignment.rotation_length, limits);
    drop(result);
    let gates = exec.map(cells.all.len(), |k| cells.gates_of(k))?;
    for (cell, gates) in cells.all.iter_mut().zip(gates) {
        cell.gates = gates;
    }
    let watersheds = watershed::drain(&cells, docks(pair), exec)?;
    let parts = watersheds.parts.iter().map(|parts| match parts {
        Parts::Whole(_) => 1,
        Parts::Cut(parts) => parts.len(),
    });
    let counts = PartitionCounts {
        polytopes: (polytopes * count) as usize,
        cells: cells.all.len(),
        parts: parts.sum(),
        rests: watersheds.rests.len(),
    };
    let alignment = alignment.clone();
    Ok(Partition { alignment, settings: *settings, cells, compartments, within, watersheds, counts })
}

/// The contact space of every compartment, in their order.
fn spaces(
    pairs: &[pieces::PiecePair<'_>],
    compartments: &[Compartment],
    alignment: &Alignment,
    exec: &Exec,
) -> Result<Vec<(Compartment, Vec<space::Tile>)>, Cancelled> {
    let tally = exec.tally(compartments.len(), "contact space");
    exec.try_map(compartments.len(), |k| {
        let tiles = space::tiles(pairs, &compartments[k], alignment.free, exec)?;
        tally.add(1);
        Ok((compartments[k].clone(), tiles))
    })
}

impl Partition {
    /// How much there was of everything.
    pub fn counts(&self) -> PartitionCounts {
        self.counts
    }

    /// The settings it was made with.
    pub fn settings(&self) -> &PartitionSettings {
        &self.settings
    }

    /// All parts.
    pub fn parts(&self) -> impl Iterator<Item = PartitionPart> + '_ {
        self.labelled().map(|(_, region, outcome)| PartitionPart { region, outcome })
    }

    /// Cell, region and outcome of all parts.
    fn labelled(&self) -> impl Iterator<Item = (usize, Polytope, Outcome)> + '_ {
        self.watersheds.parts.iter().enumerate().flat_map(|(k, parts)| {
            let parts = match parts {
                Parts::Whole(label) => vec![(self.cells.all[k].region.clone(), *label)],
                Parts::Cut(parts) => parts.clone(),
            };
            parts.into_iter().map(move |(region, label)| (k, region, label))
        })
    }

    /// Measure of the parts with an outcome inside the error box, Dᵃ·radᵇ.
    pub fn measure(&self, outcome: Outcome) -> f64 {
        self.labelled()
            .filter(|(_, _, other)| *other == outcome)
            .filter_map(|(cell, region, _)| region.intersection_of(&self.box_over(cell, &region)))
            .map(|region| region.volume())
            .sum()
    }

    /// Outcome of a pose error.
    pub fn outcome(&self, error: &PoseError) -> Outcome {
        let [dx, dy] = self.offset(error);
        let coordinates = error.to_array();
        let mut q = [0.0; MAX_DIMENSION];
        for (q, dof) in q.iter_mut().zip(self.alignment.free.iter()) {
            *q = coordinates[dof.index()]
                - match dof {
                    Dof::X => dx,
                    Dof::Y => dy,
                    _ => 0.0,
                };
        }
        let holding = self.cells.holding(&q);
        let height = |k: &usize| self.cells.all[*k].height.at(&q);
        let Some(top) = holding.into_iter().max_by(|a, b| height(a).total_cmp(&height(b))) else {
            return Outcome::Missed;
        };
        match &self.watersheds.parts[top] {
            Parts::Whole(outcome) => *outcome,
            Parts::Cut(parts) => parts
                .iter()
                .find(|(part, _)| part.contains(&q))
                .map_or(Outcome::Undecided, |(_, outcome)| *outcome),
        }
    }

    /// Outcome of the centre of every cell of a grid, or of every pose.
    pub fn acceptance(&self, domain: Domain, exec: &Exec) -> Result<Acceptance, Cancelled> {
        let outcomes = exec.map(domain.len(), |k| self.outcome(&domain.pose(k)))?;
        let undecided = outcomes.iter().filter(|outcome| **outcome == Outcome::Undecided).count();
        let mut warnings = Vec::new();
        if self.watersheds.cut_off {
            warnings.push(Warning::CutOff.into());
        }
        if undecided > 0 {
            warnings.push(Warning::Undecided { cells: undecided }.into());
        }
        Ok(Acceptance { method: "partition", domain, outcomes, warnings })
    }

    /// A grid over the error box, for [`Self::acceptance`].
    pub fn grid(&self, cells: usize) -> Grid {
        Grid::over(&self.alignment, |_| cells)
    }
}

/// Whether a rest is docked. Slices displace rests slightly: a rest within this displacement of the mated
/// pose is followed by an exact motion, all others must lie in the seat.
fn docks(pair: &Pair) -> impl Fn(&PolytopePoint) -> bool + '_ {
    /// In D and radians.
    const NEAR: f64 = 0.02;
    let alignment = &pair.alignment;
    move |rest| {
        let mut error = [0.0; 5];
        for (k, dof) in alignment.free.iter().enumerate() {
            error[dof.index()] = rest[k];
        }
        let mut error = PoseError::from_array(error);
        let pose = CorPose { lateral: DVec2::new(error.x, error.y), rotation: error.rotation() };
        // The place is that of the COR.
        let face = face_from_cor(&pose.rotation, alignment.center_of_rotation);
        let near = error.x.hypot(error.y) <= NEAR && alignment.turned_by(&pose.rotation) <= NEAR;
        (error.x, error.y) = (error.x + face.x, error.y + face.y);
        if near {
            descent::outcome(pair, &error, &descent::DescentSettings::default()).outcome == Outcome::Aligned
        } else {
            let mut seat = Seat::new(pair);
            let height = pair.height(&pose).unwrap_or(f64::INFINITY);
            seat.holds(&error, height) && seat.allows(&error, height)
        }
    }
}
