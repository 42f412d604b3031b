//! The seat: the region of poses that count as docked.
//!
//! ```text
//!     U │╲   rim    ╱‾‾‾‾    S: the part of { q : U(q) ≤ U₀ + depth } that is connected with the mated pose.
//!       │ ╲___    __╱         A half that has reached U₀ + depth in S stays in S as long as the force lasts.
//!       │     ╲__╱            On the rim it lies deeper than at its start, and is not docked; in a hole beside the
//!       │      S ╎            mated hole it is as deep, and not docked either.
//!       └──────┴─┴───── q
//! ```
//!
//! U is the potential energy at first contact, U₀ that at zero error; with the constant push both are heights
//! of the COR. S is entered from above. A half at rest below U₀ − depth has left the seat through its floor: the
//! mated pose is then not a minimum, and that rest is a different pose. If the rim of a hollow is lower than the level of its seat, S *leaks*: it extends over the rim to a
//! region below the floor, and a half in it need not stay ([`Seat::leaks`]). Whether a pose is connected with
//! the mated pose is tested along four paths in the pose error: straight, and with its yaw, its rotation or
//! its translation first; along each path U must stay at or below U₀ + depth. Poses nearer than [`CORE`]
//! count as connected. The range of the seat in yaw alone, which is the full circle for round halves, is
//! computed once per pair.
//!
//! Not promised: walls between two rests that are thinner than [`PATH_STEP`] are stepped over, and a seat
//! with more bends than its four paths is not recognised completely: rests in the remainder count as jammed.
//! Leaks are searched along each free error, and along all of them together. Lengths in D, angles in radians.

use super::mated::CONTACT_TOLERANCE;
use super::{Nearby, Pair};
use crate::pose::{Dof, PoseError};
use std::f64::consts::PI;

/// Poses within this distance of the mated pose, in the ρ-metric, are connected with it: finer structure is
/// not resolved.
pub(crate) const CORE: f64 = 5e-3;
/// Spacing of the samples of a path, in the ρ-metric.
pub(super) const PATH_STEP: f64 = 5e-3;
/// Largest number of samples of a path.
const MOST_LOOKS: f64 = 2000.0;
/// Amount by which energies along a path may exceed the seat's level, and errors their limits, in D and
/// radians: curvature of a rotation over rounded drawings.
pub(crate) const OVER_A_PATH: f64 = 1e-6;

/// Tests for a pair whether a half is docked; keeps its buffers.
#[derive(Debug, Clone)]
pub struct Seat<'a> {
    pair: &'a Pair,
    nearby: Nearby<'a>,
}

impl<'a> Seat<'a> {
    /// The seat of a pair.
    pub fn new(pair: &'a Pair) -> Self {
        Self { pair, nearby: pair.about(4.0 * PATH_STEP) }
    }

    /// The greatest potential energy at which a half is seated, in D.
    pub fn level(&self) -> f64 {
        self.pair.mated_energy() + self.pair.alignment.docked.depth
    }

    /// Whether a half with this error, its COR at `height`, is in the seat: deep enough, and connected with the mated pose.
    pub fn holds(&mut self, error: &PoseError, height: f64) -> bool {
        self.pair.energy_at(error, height) <= self.level() && self.is_connected(error)
    }

    /// The smallest potential energy at which a half at rest is in the seat, in D: as far below that of the
    /// mated pose as the greatest is above, and at least the rounding of drawings. A half that rests deeper has
    /// left the mated pose for another.
    pub fn floor(&self) -> f64 {
        self.pair.mated_energy() - self.pair.alignment.docked.depth.max(CONTACT_TOLERANCE)
    }

    /// Whether a half that rests with this error, its COR at `height`, counts as docked: no deeper than the seat, and within the limits of the
    /// design.
    pub fn allows(&self, error: &PoseError, height: f64) -> bool {
        if self.pair.energy_at(error, height) < self.floor() {
            return false;
        }
        let alignment = &self.pair.alignment;
        let off = self.off(error).to_array();
        alignment.free.iter().all(|dof| {
            alignment.docked.limit(dof).is_none_or(|limit| off[dof.index()].abs() <= limit + OVER_A_PATH)
        })
    }

    /// Whether some rests in the seat may not count, so that a motion must be followed to its end. Nothing is farther off by yaw than half a turn.
    pub fn is_limited(&self) -> bool {
        let alignment = &self.pair.alignment;
        let binds = |dof: Dof| alignment.docked.limit(dof).is_some_and(|limit| dof != Dof::Yaw || limit < PI);
        alignment.free.iter().any(binds)
    }

    /// The pose error relative to the nearest mated pose, which differs from the error itself if the pair is
    /// symmetric.
    pub fn off(&self, error: &PoseError) -> PoseError {
        PoseError { yaw: error.yaw - self.pair.alignment.nearest_yaw(error.yaw), ..*error }
    }

    /// Whether the seat extends over a rim to poses below its floor, or without contact: a half that is deep
    /// enough may still leave.
    pub fn leaks(&mut self) -> bool {
        let pair = self.pair;
        *pair.seat_cache.leaks.get_or_init(|| self.ways_out().any(|way| self.leaks_along(way)))
    }

    /// Along each free error, either way, and all of them together: by so much per look.
    fn ways_out(&self) -> impl Iterator<Item = PoseError> + use<> {
        let alignment = &self.pair.alignment;
        let free: Vec<Dof> =
            alignment.free.iter().filter(|dof| !alignment.dont_care.contains(*dof)).collect();
        let rho = alignment.rotation_length;
        let step = move |dof: Dof| if dof.is_rotation() { PATH_STEP / rho } else { PATH_STEP };
        let way = move |free: &[Dof], sign: f64| {
            let mut error = [0.0; Dof::ALL.len()];
            for dof in free {
                error[dof.index()] = sign * step(*dof) / (free.len() as f64).sqrt();
            }
            PoseError::from_array(error)
        };
        let mut groups: Vec<Vec<Dof>> = free.iter().map(|dof| vec![*dof]).collect();
        if free.len() > 1 {
            groups.push(free);
        }
        groups.into_iter().flat_map(move |group| [1.0, -1.0].map(|sign| way(&group, sign)))
    }

    /// Whether the seat leaks in this direction, within the range of the errors.
    fn leaks_along(&mut self, way: PoseError) -> bool {
        let (level, floor) = (self.level() + OVER_A_PATH, self.floor());
        let way = way.to_array();
        let alignment = &self.pair.alignment;
        let ends = |dof: Dof| alignment.half_range(dof) / way[dof.index()].abs();
        let looks = alignment.free.iter().map(ends).fold(MOST_LOOKS, f64::min) as usize;
        for k in 1..=looks {
            let error = PoseError::from_array(way.map(|part| k as f64 * part));
            match self.nearby.energy(&error) {
                Some(energy) if energy > level => return false,
                Some(energy) if energy >= floor => {}
                _ => return true,
            }
        }
        false
    }

    fn is_connected(&mut self, error: &PoseError) -> bool {
        let off = self.off(error);
        if self.pair.alignment.length(&off) <= CORE {
            return true;
        }
        let mated = PoseError { yaw: error.yaw - off.yaw, ..PoseError::default() };
        let spun = PoseError { yaw: error.yaw, ..mated };
        let turned = PoseError { x: 0.0, y: 0.0, ..*error };
        let slid = PoseError { x: error.x, y: error.y, ..mated };
        self.is_deep(&spun) && self.is_level(&[spun, *error]) && self.spins(&mated, &off)
            || self.is_level(&[mated, *error])
            || self.is_level(&[mated, turned, *error])
            || self.is_level(&[mated, slid, *error])
    }

    /// Whether the seat holds from a mated pose on by this yaw alone.
    fn spins(&mut self, mated: &PoseError, off: &PoseError) -> bool {
        // The design states the equivalent mated poses; the solids need not have this symmetry.
        if mated.yaw != 0.0 {
            return self.is_level(&[*mated, PoseError { yaw: mated.yaw + off.yaw, ..*mated }]);
        }
        let pair = self.pair;
        let step = PATH_STEP / pair.alignment.rotation_length;
        let most = (PI / step).min(MOST_LOOKS) as usize;
        let mut reaches = |sign: f64| {
            let holds = |k: &usize| self.is_deep(&PoseError { yaw: sign * step * *k as f64, ..*mated });
            step * (1..=most).take_while(holds).count() as f64
        };
        let [minus, plus] = *pair.seat_cache.spins.get_or_init(|| [reaches(-1.0), reaches(1.0)]);
        // As along any path, the end itself is not tested.
        (-minus - step..=plus + step).contains(&off.yaw)
    }

    /// Whether a pose is as deep as the seat.
    fn is_deep(&mut self, error: &PoseError) -> bool {
        let level = self.level() + OVER_A_PATH;
        !self.nearby.is_above(error, level)
    }

    /// Whether the seat holds all along a path, straight in the pose error from point to point. Its first point is known to be in the seat.
    fn is_level(&mut self, path: &[PoseError]) -> bool {
        // From the end: walls are more likely there than near the mated pose.
        path.windows(2).enumerate().rev().all(|(number, ends)| {
            let (from, to) = (ends[0].to_array(), ends[1].to_array());
            let mut way = [0.0; Dof::ALL.len()];
            for dof in Dof::ALL {
                let unit = if dof.is_rotation() { self.pair.alignment.rotation_length } else { 1.0 };
                way[dof.index()] = unit * (to[dof.index()] - from[dof.index()]);
            }
            let length = way.iter().map(|part| part * part).sum::<f64>().sqrt();
            let looks = (length / PATH_STEP).ceil().clamp(1.0, MOST_LOOKS) as usize;
            // The end itself is not tested: there a half touches walls, and rounding may put it on their rim.
            let first = usize::from(number == 0);
            coarse_first(looks).filter(|k| *k >= first).all(|k| {
                let share = k as f64 / looks as f64;
                let at = std::array::from_fn(|i| from[i] + share * (to[i] - from[i]));
                self.is_deep(&PoseError::from_array(at))
            })
        })
    }
}

/// The numbers below `count`, those farthest from all before them first: a wall is met in as few looks as it is wide.
fn coarse_first(count: usize) -> impl Iterator<Item = usize> {
    let bits = usize::BITS - count.saturating_sub(1).leading_zeros();
    (0..1usize << bits)
        .map(move |k| if bits == 0 { 0 } else { k.reverse_bits() >> (usize::BITS - bits) })
        .filter(move |k| *k < count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_comes_once_and_the_middle_early() {
        for count in [1, 2, 3, 7, 8, 100] {
            let mut seen: Vec<usize> = coarse_first(count).collect();
            assert!(count < 3 || seen[1] == count.next_power_of_two() / 2, "{seen:?}");
            seen.sort_unstable();
            assert_eq!(seen, (0..count).collect::<Vec<_>>());
        }
    }
}
