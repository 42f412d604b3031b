//! Holding force of a half at rest: the largest load under which it stays.
//!
//! ```text
//!        │ preload 1, along −z through the centre of rotation
//!        ▼
//!     ╲─────╱ ◀── t·w         held as long as forces of the contacts exist with  Σ forces + preload + t·w = 0
//!      ╲___╱                  most = the largest such t
//! ```
//!
//! Contact forces lie along the contact normals or, with friction, in the friction cones about them: a convex
//! cone of loads, so that a half that resists t resists every smaller load. Each load is tested by one
//! projection ([`super::projection`], [`super::coulomb`]); the largest t follows by bisection. Without
//! friction it equals, by duality, the smallest lift per displacement over all motions that the contacts
//! permit,
//!
//! ```text
//!   most = min { lift of the centre of rotation : w·u = 1, no contact is entered by u }
//! ```
//!
//! and with all other errors fixed ([`Guide::Along`]) the slope of the height of first contact in that
//! direction.
//!
//! Not promised: that a half with friction stays in place up to this load. Above it no contact forces can
//! balance the load, and the half moves; below it such forces exist, but for rigid bodies that does not
//! guarantee stiction ([`super::sticking()`]). Elastic halves yield earlier.

use super::coulomb::is_still;
use super::motion::{Motion, State};
use super::projection::{MAX_COORDINATES, Vector, dot};
use super::sticking::{Sticking, Touching};
use super::{DescentSettings, Pair};
use crate::contact::{Contact, Meeting};
use crate::pose::PoseError;
use glam::{DMat3, DQuat, DVec3};

/// A force on the moving half and its moment about the centre of rotation, world axes; in preloads, and preloads times D.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// The force, in preloads.
    pub force: DVec3,
    /// Its moment, in preloads times D.
    pub moment: DVec3,
}

/// Which motions there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guide {
    /// All free errors, and away from the fixed half.
    Free,
    /// The way of the load alone, and away: something else holds all other errors, without friction. A load that has a force is a force through the
    /// centre of rotation.
    Along,
}

/// Default largest gap that counts as contact, in D: the gaps that motions leave at their end, below any
/// designed fit.
pub use super::rest::TOUCHING;

/// A foot counts as on its feature up to this far beyond the border, in D: above the gap at which a sliding
/// contact is active, so that the facets on both sides of a valley are found together; below the distance at
/// which walls between pieces are searched (1e-7).
pub(super) const BORDER: f64 = 1e-8;

/// Loads beyond this many preloads count as infinite: a slope of 89.9999°.
pub const MOST_LOAD: f64 = 1e6;
/// The largest load is found to this share of itself, or of the preload.
const EXACT: f64 = 1e-9;
/// A rest resists its own preload except for this share: motions end on slopes as gentle.
const OWN: f64 = 1e-3;

/// A half at rest, with its contacts.
#[derive(Debug, Clone)]
pub struct Holding {
    touching: Touching,
    axes: [DVec3; 3],
    rho: f64,
    cor: DVec3,
    rotation: DMat3,
    contacts: Vec<(Contact, Meeting)>,
}

impl Holding {
    /// The contacts of a half lowered at a pose error: all features with gaps up to `near`, in D. `None` if
    /// nothing touches.
    pub fn at(pair: &Pair, error: &PoseError, near: f64) -> Option<Self> {
        // Any friction coefficient above 0: the rows then include slips.
        let settings = DescentSettings { friction: 1.0, ..DescentSettings::default() };
        let mut motion = Motion::new(pair, &settings);
        let state = motion.lower(error)?;
        Self::seen(&mut motion, &state, near)
    }

    /// The contacts of a half at rest at a pose error, with its centre of rotation at `height`; also beneath
    /// features through which it could not be lowered.
    pub fn at_rest(pair: &Pair, error: &PoseError, height: f64, near: f64) -> Option<Self> {
        let settings = DescentSettings { friction: 1.0, ..DescentSettings::default() };
        let mut motion = Motion::new(pair, &settings);
        let pose = pair.pose(error);
        let state = State {
            cor: pose.lateral.extend(height),
            rotation: pose.rotation,
            spin: DQuat::from_mat3(&pose.rotation),
            angles: [error.roll, error.pitch, error.yaw],
        };
        Self::seen(&mut motion, &state, near)
    }

    fn seen(motion: &mut Motion<'_>, state: &State, near: f64) -> Option<Self> {
        motion.turn(&state.rotation, state.cor.truncate(), motion.settings.step.max(near));
        // Play that is taken for used also shifts feet along their features.
        let border = if near > TOUCHING { near } else { BORDER };
        motion.nearby.contacts_within(state.cor, near, border, &mut motion.contacts);
        motion.contacts.retain(|(contact, _)| contact.gap >= -TOUCHING);
        let mut touching = Touching::default();
        touching.see_within(near, motion, state);
        if touching.rows.is_empty() {
            return None;
        }
        let contacts = motion.contacts.iter().filter(|(contact, _)| contact.gap <= near).copied();
        let (contacts, axes) = (contacts.collect(), motion.axes(state));
        let State { cor, rotation, .. } = *state;
        Some(Self { touching, axes, rho: motion.pair.alignment.rotation_length, cor, rotation, contacts })
    }

    /// The centre of rotation, in the world frame, in D.
    pub const fn cor(&self) -> DVec3 {
        self.cor
    }

    /// The rotation of the moving half.
    pub const fn rotation(&self) -> &DMat3 {
        &self.rotation
    }

    /// The contacts.
    pub fn contacts(&self) -> &[(Contact, Meeting)] {
        &self.contacts
    }

    /// Whether the preload alone is held.
    pub fn is_held(&mut self, friction: f64) -> bool {
        self.preload(friction).is_some()
    }

    /// Sticking and slipping threshold for the preload alone: [`super::sticking()`] with these contacts.
    pub fn sticking(&mut self) -> Sticking {
        self.touching.thresholds()
    }

    /// From which friction on it wedges, though contacts alone hold it: see [`Sticking`].
    pub fn wedges_from(&mut self) -> Option<f64> {
        self.touching.wedges_from()
    }

    /// Largest multiple of a load that can be added to the preload before the half leaves; infinite if no
    /// such load moves it, `None` if the preload alone does. A load that acts on no free error is always
    /// resisted.
    pub fn most(&mut self, load: &Load, guide: Guide, friction: f64) -> Option<f64> {
        let load = self.generalised(load);
        match guide {
            Guide::Free => self.largest(&load, friction),
            Guide::Along => self.guided(load)?.largest(&only(&load), friction),
        }
    }

    pub(super) fn largest(&mut self, load: &Vector, friction: f64) -> Option<f64> {
        let preload = self.preload(friction)?;
        if self.holds(load, friction) {
            return Some(f64::INFINITY);
        }
        let with = |t: f64| -> Vector { std::array::from_fn(|k| preload[k] + t * load[k]) };
        let [mut held, mut moves] = [0.0, 1.0];
        while self.holds(&with(moves), friction) {
            (held, moves) = (moves, 2.0 * moves);
            if moves > MOST_LOAD {
                return Some(f64::INFINITY);
            }
        }
        while moves - held > EXACT * moves.max(1.0) {
            let middle = f64::midpoint(held, moves);
            if self.holds(&with(middle), friction) { held = middle } else { moves = middle }
        }
        Some(held)
    }

    /// The preload, minus the part that contacts on the gentle slope at the end of a motion do not balance;
    /// `None` if that part is too large.
    pub(super) fn preload(&mut self, friction: f64) -> Option<Vector> {
        let push = self.touching.push;
        let left = self.touching.unheld(&push, friction)?;
        if is_still(&left) {
            return Some(push);
        }
        let size = dot(&left, &left).sqrt();
        (size <= OWN).then(|| std::array::from_fn(|k| push[k] - left[k]))
    }

    /// Whether forces of the contacts hold a push.
    pub(super) fn holds(&mut self, push: &Vector, friction: f64) -> bool {
        let size = dot(push, push).sqrt();
        let unit = push.map(|part| if size > 0.0 { part / size } else { 0.0 });
        self.touching.unheld(&unit, friction).is_some_and(|left| is_still(&left))
    }

    /// Change of the gaps of the contacts per displacement.
    pub(super) fn rows(&self) -> &[Vector] {
        &self.touching.rows
    }

    /// Some of the contacts alone.
    pub(super) fn some(&self, which: &[usize]) -> Self {
        let mut some = self.clone();
        some.touching.rows = which.iter().map(|k| self.touching.rows[*k]).collect();
        some.touching.tangents = which.iter().map(|k| self.touching.tangents[*k]).collect();
        some.contacts = which.iter().map(|k| self.contacts[*k]).collect();
        some
    }

    /// Other rows for the contacts.
    pub(super) fn replace_rows(&mut self, rows: Vec<Vector>) {
        self.touching.rows = rows;
    }

    /// Forces along the normals that hold a push, by contacts.
    pub(super) fn forces(&mut self, push: &Vector) -> Vec<(usize, f64)> {
        self.touching.forces(push)
    }

    /// A load in the coordinates of displacements.
    fn generalised(&self, load: &Load) -> Vector {
        let mut push = [0.0; MAX_COORDINATES];
        push[..3].copy_from_slice(&load.force.to_array());
        for (k, axis) in self.axes.iter().enumerate() {
            push[3 + k] = load.moment.dot(*axis) / self.rho;
        }
        push
    }

    /// The same contacts with only the direction of a load free, and z; `None` for a load without a
    /// direction.
    fn guided(&self, load: Vector) -> Option<Self> {
        let along = only(&load);
        let size = dot(&along, &along).sqrt();
        if size == 0.0 {
            return None;
        }
        let way = along.map(|part| part / size);
        let kept = |row: &Vector| {
            let share = dot(&way, row);
            let mut kept = way.map(|part| share * part);
            kept[2] += row[2];
            kept
        };
        let mut guided = self.clone();
        guided.touching.rows.iter_mut().for_each(|row| *row = kept(row));
        for tangents in &mut guided.touching.tangents {
            *tangents = [kept(&tangents[0]), kept(&tangents[1])];
        }
        Some(guided)
    }
}

/// Of a load with a force aside that force, of others the moment.
fn only(load: &Vector) -> Vector {
    let is_force = load[0] != 0.0 || load[1] != 0.0;
    std::array::from_fn(|k| if (k < 2) == is_force && k != 2 { load[k] } else { 0.0 })
}
