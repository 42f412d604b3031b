//! The play of the seat: the largest misalignment at which a half rests as deep as in the mated pose.
//!
//! ```text
//!      h │ ╲             ╱      along a direction d of pose errors:   largest t with h(s·d) ≤ h₀ for all s ≤ t
//!        │  ╲_____●_____╱       per error: the largest |t·d| of all directions
//!        └────├──play──┤── q    a sharp seat has no play
//! ```
//!
//! Directions are the combinations of signs of the free errors, with radians converted by ρ. Single errors
//! come first; an error without a limit of its own, up to twice the allowed value, is left out of the
//! combinations. Not promised: a direction of play far from all of these is missed here; the residual
//! misalignment of docked poses shows it. Lengths in D, angles in radians.

use super::seat::PATH_STEP;
use super::{Nearby, Pair};
use crate::exec::Exec;
use crate::pose::{Dof, DofSet, PoseError};
use serde::{Deserialize, Serialize};

/// Play of the seat in one error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Play {
    /// The error.
    pub axis: Dof,
    /// Play towards negative values, as a magnitude ≥ 0. D or radians.
    pub minus: f64,
    /// Play towards positive values, ≥ 0. D or radians.
    pub plus: f64,
}

impl Play {
    /// The larger of both.
    pub const fn most(&self) -> f64 {
        self.minus.max(self.plus)
    }
}

/// Heights this near are equal, in D: a slope of 10⁻³ over the first look is play.
const LEVEL: f64 = 1e-7;
/// Length of the first look along a direction, and how well its end is known, in the ρ-metric.
const FIRST: f64 = 1e-4;
const FOUND: f64 = 1e-5;
/// Looks grow with the length by this share.
const GROWTH: f64 = 0.125;
/// A play beyond this many times the allowed value is not measured any further.
const BEYOND: f64 = 2.0;

/// Number of directions that are searched in sequence with a common list of possible contacts.
const TOGETHER: usize = 16;

/// The play of every free error that matters, in their order.
pub fn play(pair: &Pair) -> Vec<Play> {
    play_on(pair, DofSet::ALL, &Exec::new())
}

/// The same, only for the errors in `requested`, on these threads and with its progress: for other errors the
/// play may be larger.
pub fn play_on(pair: &Pair, requested: DofSet, exec: &Exec) -> Vec<Play> {
    let alignment = &pair.alignment;
    let free: Vec<Dof> = alignment.free.iter().filter(|dof| !alignment.dont_care.contains(*dof)).collect();
    let mut play: Vec<Play> = free.iter().map(|dof| Play { axis: *dof, minus: 0.0, plus: 0.0 }).collect();
    let (alone, together): (Vec<_>, Vec<_>) =
        directions(free.len()).partition(|signs| signs.iter().filter(|sign| **sign != 0.0).count() == 1);
    let most = directions(free.len()).count() as f64;
    let split = alone.len() as f64 / most;
    let loose = along(pair, &free, &alone, &mut play, &exec.part([0.0, split], STAGE));
    let matters = |signs: &Vec<f64>| {
        let among = || free.iter().zip(signs).filter(|(_, sign)| **sign != 0.0).map(|(dof, _)| *dof);
        among().all(|dof| !loose.contains(dof)) && among().any(|dof| requested.contains(dof))
    };
    let together: Vec<Vec<f64>> = together.into_iter().filter(matters).collect();
    along(pair, &free, &together, &mut play, &exec.part([split, 1.0], STAGE));
    play
}

/// Name of the progress stage.
const STAGE: &str = "play";

/// Searches along directions, and increases the play accordingly; returns the errors that nothing stopped.
fn along(pair: &Pair, free: &[Dof], ways: &[Vec<f64>], play: &mut [Play], exec: &Exec) -> DofSet {
    let look = |signs: &Vec<f64>, nearby: &mut Nearby<'_>| {
        let count = signs.iter().filter(|sign| **sign != 0.0).count() as f64;
        let mut way = [0.0; Dof::ALL.len()];
        for (dof, sign) in free.iter().zip(signs) {
            way[dof.index()] = sign / (count.sqrt() * unit(pair, *dof));
        }
        let farthest = free
            .iter()
            .zip(signs)
            .filter(|(_, sign)| **sign != 0.0)
            .map(|(dof, _)| BEYOND * pair.alignment.docked.most_play(*dof) / way[dof.index()].abs())
            .fold(f64::INFINITY, f64::min);
        (way, reach(nearby, pair.mated_energy() + LEVEL, &way, farthest), farthest)
    };
    let groups: Vec<&[Vec<f64>]> = ways.chunks(TOGETHER).collect();
    let result = exec.each(groups.len(), usize::MAX, STAGE, |k, _| {
        let mut nearby = pair.about(4.0 * PATH_STEP);
        groups[k].iter().map(|signs| look(signs, &mut nearby)).collect::<Vec<_>>()
    });
    let mut loose = DofSet::EMPTY;
    for (way, length, farthest) in result.into_iter().flatten() {
        for (dof, play) in free.iter().zip(&mut *play) {
            let off = length * way[dof.index()];
            (play.minus, play.plus) = (play.minus.max(-off), play.plus.max(off));
            if off != 0.0 && length >= farthest {
                loose = loose.with(*dof);
            }
        }
    }
    loose
}

/// All combinations of −1, 0 and 1 but that of zeros.
pub(super) fn directions(count: usize) -> impl Iterator<Item = Vec<f64>> {
    (1..3usize.pow(count as u32))
        .map(move |code| (0..count).map(|k| [0.0, 1.0, -1.0][code / 3usize.pow(k as u32) % 3]).collect())
}

/// How much an error of 1 counts in the ρ-metric.
pub(super) fn unit(pair: &Pair, dof: Dof) -> f64 {
    if dof.is_rotation() { pair.alignment.rotation_length } else { 1.0 }
}

/// Length up to which the seat stays at or below `level` along a direction, at most `farthest`.
fn reach(nearby: &mut Nearby, level: f64, way: &[f64; 5], farthest: f64) -> f64 {
    let mut is_level = |length: f64| {
        let error = PoseError::from_array(way.map(|part| length * part));
        !nearby.is_above(&error, level) && nearby.touches(&error)
    };
    let (mut held, mut look) = (0.0, FIRST);
    while held < farthest {
        if !is_level(look) {
            // Bisect between the last level offset and this offset.
            while look - held > FOUND {
                let middle = 0.5 * (held + look);
                if is_level(middle) { held = middle } else { look = middle }
            }
            break;
        }
        held = look;
        look = (look + (GROWTH * look).max(FIRST).min(PATH_STEP.max(GROWTH * look))).min(farthest);
    }
    if held <= FOUND { 0.0 } else { held }
}
