//! Constraint rows of the projection: the contacts that a step may meet.
//!
//! ```text
//!   a·u ≥ −g      a   effect of a displacement u on the gap: (n, (p − c) × n / ρ)
//!                 g   the gap, less the clearance kept from walls
//! ```
//!
//! with n the normal of a contact, p its point on the moving half and c the COR; with friction, two more rows
//! give the slip of its point along the two tangents. Rows come from the current contacts
//! ([`Motion::gather`]), from the same contacts halfway along a step ([`Motion::look_ahead`]), and from
//! unexpected contacts ([`Motion::cut`], [`Motion::meet`]).

use super::coulomb::{Contacts, Tangents};
use super::motion::{Motion, State};
use super::projection::{MAX_COORDINATES, Vector, dot};
use crate::contact::Contact;
use crate::pose::{Dof, ROTATIONS, euler_axes};
use crate::tolerance::{COINCIDENT, ROUNDING};
use glam::{DMat3, DVec2, DVec3};
use std::collections::BTreeSet;

/// Normals this close to horizontal (slope above 20) belong to walls: the motion keeps clear of them by `WALL_MARGIN`.
const WALL: f64 = 0.05;
/// Clearance from walls, in D: above the curvature error of the smallest steps, below any fit that is designed.
const WALL_MARGIN: f64 = 1e-6;
/// Features that fail to support by more than this angle are not searched, however long the step: radians.
const WIDEST: f64 = 0.2;
/// By more than this sums over equal rows do not differ.
const SUM_SAME: f64 = 8.0 * ROUNDING;

/// The constraints on a displacement, without duplicates.
#[derive(Debug, Clone, Default)]
pub(super) struct Rows {
    pub(super) vectors: Vec<Vector>,
    pub(super) gaps: Vec<f64>,
    /// How each slips; empty without friction.
    pub(super) tangents: Vec<Tangents>,
    /// Checksums of the numbers of each row, in order, with its position: equal rows have equal sums. Only
    /// for the first rows if there are many.
    sums: BTreeSet<(u64, u32)>,
}

impl Rows {
    /// Beyond so many rows they are looked up by their sums.
    const FEW: usize = 32;

    fn clear(&mut self) {
        self.vectors.clear();
        self.gaps.clear();
        self.tangents.clear();
        self.sums.clear();
    }

    /// The contacts for the projection and the friction cones.
    pub(super) fn contacts(&self, friction: f64) -> Contacts<'_> {
        Contacts { rows: &self.vectors, tangents: &self.tangents, friction }
    }

    /// Adds a row unless it is present; returns whether it was new.
    fn learn(&mut self, row: Vector, tangents: Option<Tangents>, gap: f64) -> bool {
        let same = |a: &Vector, b: &Vector| a.iter().zip(b).all(|(a, b)| (a - b).abs() < ROUNDING);
        let is = |k: usize| {
            (self.gaps[k] - gap).abs() < ROUNDING
                && same(&self.vectors[k], &row)
                && tangents.is_none_or(|t| self.tangents[k].iter().zip(&t).all(|(a, b)| same(a, b)))
        };
        let known = if self.vectors.len() < Self::FEW {
            (0..self.vectors.len()).any(is)
        } else {
            for k in self.sums.len()..self.vectors.len() {
                self.sums.insert((in_order(sum(&self.vectors[k], self.gaps[k])), k as u32));
            }
            let sum = sum(&row, gap);
            let near = [sum - SUM_SAME, sum + SUM_SAME].map(in_order);
            self.sums.range((near[0], 0)..=(near[1], u32::MAX)).any(|(_, k)| is(*k as usize))
        };
        if !known {
            self.vectors.push(row);
            self.gaps.push(gap);
            self.tangents.extend(tangents);
        }
        !known
    }
}

/// A sum by which rows differ that differ at all.
fn sum(row: &Vector, gap: f64) -> f64 {
    row.iter().zip([1.0, 0.618, 0.382, 0.236, 0.146, 0.09]).map(|(x, weight)| x * weight).sum::<f64>() + gap
}

/// Whole numbers in the order of numbers.
const fn in_order(x: f64) -> u64 {
    let bits = x.to_bits();
    if bits >> 63 == 0 { bits | 1 << 63 } else { !bits }
}

impl Motion<'_> {
    /// Finds all contacts that a step may close, as rows of the projection.
    pub(super) fn gather(&mut self, state: &State, step: f64) {
        let (_, near) = self.horizon(step);
        self.nearby.contacts(state.cor, near, &mut self.contacts);
        self.contacts.retain(|(c, _)| c.gap > -COINCIDENT);
        self.rows.clear();
        let axes = self.axes(state);
        let contacts = std::mem::take(&mut self.contacts);
        for (contact, _) in &contacts {
            let row = self.row(contact, state, &axes);
            let clear = margin(contact);
            let gap = if clear > 0.0 { contact.gap - clear } else { contact.gap.max(0.0) };
            // Corners, edges and facets that meet at a point yield duplicate rows.
            let tangents = self.tangents(contact, state, &axes);
            self.rows.learn(row, tangents, gap);
        }
        self.contacts = contacts;
    }

    /// Change of the gap of a contact per displacement.
    pub(super) fn row(&self, contact: &Contact, state: &State, axes: &[DVec3; 3]) -> Vector {
        self.row_along(contact.normal, contact, state, axes)
    }

    /// How a displacement makes a contact slip along its tangents; `None` without friction.
    pub(super) fn tangents(&self, contact: &Contact, state: &State, axes: &[DVec3; 3]) -> Option<Tangents> {
        (self.settings.friction > 0.0).then(|| self.slips(contact, state, axes))
    }

    /// How a displacement makes a contact slip along its tangents.
    pub(super) fn slips(&self, contact: &Contact, state: &State, axes: &[DVec3; 3]) -> Tangents {
        let (side, across) = contact.normal.any_orthonormal_pair();
        [side, across].map(|tangent| self.row_along(tangent, contact, state, axes))
    }

    /// Displacement of the contact point of the moving half along a direction, per displacement.
    fn row_along(&self, n: DVec3, contact: &Contact, state: &State, axes: &[DVec3; 3]) -> Vector {
        let free = self.pair.alignment.free;
        let arm = contact.point + contact.normal * contact.gap - state.cor;
        let turn = arm.cross(n) / self.pair.alignment.rotation_length;
        let mut row = [0.0; MAX_COORDINATES];
        row[0] = if free.contains(Dof::X) { n.x } else { 0.0 };
        row[1] = if free.contains(Dof::Y) { n.y } else { 0.0 };
        row[2] = n.z;
        for (k, axis) in axes.iter().enumerate() {
            row[3 + k] = turn.dot(*axis);
        }
        row
    }

    /// Adds the contacts that carry the body at `landed`, `rise` above the position that the displacement `u`
    /// had given, to the contacts of this step. Only contacts below the present position can be added: the
    /// other side of a valley, not a step up.
    pub(super) fn cut(&mut self, landed: &State, rise: f64, u: &Vector) -> bool {
        let mut carrying = std::mem::take(&mut self.carrying);
        self.nearby.contacts(landed.cor, COINCIDENT, &mut carrying);
        let axes = self.axes(landed);
        let mut added = false;
        for (contact, _) in &carrying {
            let row = self.row(contact, landed, &axes);
            let there = -contact.normal.z * rise;
            let here = there - dot(&row, u);
            // A contact that the step respects already adds nothing.
            if there < -COINCIDENT && here > 0.25 * there {
                let tangents = self.tangents(contact, landed, &axes);
                added |= self.rows.learn(row, tangents, here.max(0.0));
            }
        }
        self.carrying = carrying;
        added
    }

    /// Adds the contacts into which the body has run at `landed` by the displacement `u` from `state`,
    /// evaluated halfway: see [`Motion::look_ahead`].
    pub(super) fn meet(&mut self, state: &State, landed: &State, step: f64, u: &Vector) -> bool {
        let (_, near) = self.horizon(step);
        let mut met = std::mem::take(&mut self.carrying);
        self.nearby.contacts(landed.cor, near, &mut met);
        let half = u.map(|x| 0.5 * x);
        let middle = self.moved(state, &half);
        let axes = self.axes(&middle);
        let mut added = false;
        for (contact, meeting) in met.iter().filter(|(c, _)| c.gap < -COINCIDENT) {
            let there = contact.gap - margin(contact);
            let contact = self.pair.contact(contact, meeting, &middle.rotation, middle.cor);
            let row = self.row(&contact, &middle, &axes);
            let here = contact.gap - margin(&contact) - dot(&row, &half);
            // A contact that was as deep before is another way through the same wall.
            if here > 0.25 * there {
                let tangents = self.tangents(&contact, &middle, &axes);
                added |= self.rows.learn(row, tangents, here);
            }
        }
        self.carrying = met;
        added
    }

    /// Axes of the free rotations in the world frame, unit; zero for locked rotations.
    pub(super) fn axes(&self, state: &State) -> [DVec3; 3] {
        if self.spherical {
            return [DVec3::X, DVec3::Y, DVec3::Z];
        }
        let [_, pitch, yaw] = state.angles;
        let free = self.pair.alignment.free;
        let mut axes = euler_axes(pitch, yaw);
        for (axis, dof) in axes.iter_mut().zip(ROTATIONS) {
            if !free.contains(dof) {
                *axis = DVec3::ZERO;
            }
        }
        axes
    }

    /// Replaces the rows of the contacts at the start of a step by those halfway along `u`, relative to the
    /// start: the midpoint rule, second order for curved contacts.
    pub(super) fn look_ahead(&mut self, state: &State, u: &Vector) {
        let half = u.map(|x| 0.5 * x);
        let middle = self.moved(state, &half);
        let axes = self.axes(&middle);
        self.rows.clear();
        let contacts = std::mem::take(&mut self.contacts);
        for (before, meeting) in &contacts {
            let contact = self.pair.contact(before, meeting, &middle.rotation, middle.cor);
            let row = self.row(&contact, &middle, &axes);
            let gap = contact.gap - dot(&row, &half);
            let clear = margin(&contact);
            let tangents = self.tangents(&contact, &middle, &axes);
            self.rows.learn(row, tangents, if clear > 0.0 { gap - clear } else { gap.max(0.0) });
        }
        self.contacts = contacts;
    }

    /// Prepares for questions at `lateral`, for a step of length `step`.
    pub(super) fn turn(&mut self, rotation: &DMat3, lateral: DVec2, step: f64) {
        let (slack, near) = self.horizon(step);
        self.nearby.turn(rotation, lateral, slack, near);
    }

    pub(super) fn horizon(&self, step: f64) -> (f64, f64) {
        horizon(step, self.radius, self.pair.alignment.rotation_length)
    }
}

/// Range of features that a step may meet: those that support a normal within the largest rotation of the
/// step, and gaps up to the largest displacement of a point of the body. Contacts beyond it are cut off or
/// halve the step.
pub(super) fn horizon(step: f64, radius: f64, rotation_length: f64) -> (f64, f64) {
    ((step / rotation_length).min(WIDEST), step * (1.0 + radius / rotation_length))
}

/// Clearance to keep from a contact: from walls only.
pub(super) fn margin(contact: &Contact) -> f64 {
    if contact.normal.z < WALL { WALL_MARGIN } else { 0.0 }
}
