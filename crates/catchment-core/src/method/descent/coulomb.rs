//! Coulomb friction in the small optimisation behind every step.
//!
//! ```text
//!   u = p + Σ (λᵢ aᵢ + τᵢ·bᵢ)                    p push, aᵢ row of the gap of contact i, bᵢ the two rows of its slip
//!   0 ≤ λᵢ  ⟂  aᵢ·u + gᵢ ≥ 0                     pressed if it touches
//!   |τᵢ| ≤ μ λᵢ,   = μ λᵢ against bᵢ·u ≠ 0        sticks, or slips against the full friction
//! ```
//!
//! De Saxcé and Feng (*Math. Comput. Modelling* 28, 1998) combine the last two lines into one cone: with sᵢ =
//! μ|bᵢ·u|,
//!
//! ```text
//!   aᵢ·u + gᵢ + sᵢ ≥ μ |bᵢ·u|        and u the closest to p of all that hold it
//! ```
//!
//! so that for given s friction is the same projection as without it, and s is found by iteration (Cadoux
//! 2009; Acary, Cadoux, Lemaréchal and Malick, *ZAMM* 91, 2011). On a single slope every iteration leaves
//! μ²/(1 + μ²) of the residual. The cone is approximated by its tangent planes, each added at the point at
//! which the last solution violates it: the forces are exact, without polygons.
//!
//! The iteration starts with the slip of the frictionless motion, and ends at the slip to which it converges.
//! If a force that makes the half stick exists as well ([`Coulomb::may_stick`]), Coulomb's law for rigid
//! bodies does not decide between the two; the half then slips.
//!
//! Near the friction at which slip ends, the iteration is unreliable: a slip that fades decreases very little
//! in each iteration, and a slip that an iteration hardly changes may be far from its limit. A slow slip is
//! therefore decided by its direction d, which converges long before its speed ([`Coulomb::slow`]): with the
//! friction of all loaded contacts along −bᵢ·d the forces balance the push up to a multiple of d, and its
//! sign decides between slip and stiction.
//!
//! ```text
//!   p + Σ λᵢ (aᵢ − μ bᵢ·d/|bᵢ·d|) = σ d,   λᵢ ≥ 0        σ > 0 it slips, at this speed       σ ≤ 0 it sticks
//! ```
//!
//! Not promised: that such a slip is unique, nor that the iteration finds it if it is. After [`ROUNDS`]
//! iterations the current value is used.

use super::projection::{MAX_COORDINATES, Projection, Vector, dot};

/// How a contact slips: rows of both tangents.
pub(super) type Tangents = [Vector; 2];

/// Largest remaining violation of a cone or change of a slip, as a share of the displacement by the push
/// alone.
const EXACT: f64 = 1e-9;
/// Largest number of iterations of a step, and the number at which the end of slip is tested.
const ROUNDS: usize = 100;
const PATIENT: usize = 20_000;
/// Rounds before slips are extrapolated: directions settle first.
const SETTLED: usize = 4;
/// An iteration extrapolates by at most this factor of the residual, and after an overshoot, as in halves
/// that wedge, by at least this factor. It leaves a slip that falls at least this share of the result of the
/// iteration: if the slip becomes zero the half sticks, and nothing makes it slip again.
const BOLDEST: f64 = 20.0;
const SHYEST: f64 = 0.05;
const LEFT: f64 = 0.5;
/// A displacement below this share of that by the push alone counts as rest: above the remaining violation of
/// cones.
pub(super) const STILL: f64 = 1e-7;
/// A displacement below this share of it is slow: whether it continues is tested.
const SLOW: f64 = 1e-2;
/// Contacts that such a slip opens or closes by less than this share of itself stay closed.
const CLOSED: f64 = 0.5;

/// The solver: owns its buffers.
#[derive(Debug, Clone)]
pub(super) struct Coulomb {
    /// Most rounds.
    rounds: usize,
    /// The planes that cut out the cones.
    planes: Vec<Vector>,
    /// Of which contact each is.
    owners: Vec<usize>,
    /// sᵢ of every contact, its residual by the last iteration, and that of the iteration before.
    slips: Vec<f64>,
    missing: Vec<f64>,
    before: Vec<f64>,
    /// The contacts that are pressed.
    pressed: Vec<usize>,
    /// Planes with positive forces, and their multipliers: the next iteration starts with them.
    start: Vec<(usize, f64)>,
    /// The last displacement, relative to that by the push alone: a slip continues.
    last: Option<Vector>,
}

/// The contacts of a step.
#[derive(Clone, Copy)]
pub(super) struct Contacts<'a> {
    pub(super) rows: &'a [Vector],
    pub(super) tangents: &'a [Tangents],
    pub(super) friction: f64,
}

impl Contacts<'_> {
    /// How a contact slips.
    fn slip(&self, contact: usize, u: &Vector) -> [f64; 2] {
        self.tangents[contact].map(|tangent| dot(&tangent, u))
    }

    /// The plane of the cone of a contact along its slip.
    fn plane(&self, contact: usize, [a, b]: [f64; 2]) -> Vector {
        let size = size([a, b]);
        let share = if size > 0.0 { self.friction / size } else { 0.0 };
        let [s, t] = &self.tangents[contact];
        let row = &self.rows[contact];
        std::array::from_fn(|k| row[k] - share * (a * s[k] + b * t[k]))
    }
}

impl Default for Coulomb {
    fn default() -> Self {
        Self {
            rounds: ROUNDS,
            planes: Vec::new(),
            owners: Vec::new(),
            slips: Vec::new(),
            missing: Vec::new(),
            before: Vec::new(),
            pressed: Vec::new(),
            start: Vec::new(),
            last: None,
        }
    }
}

impl Coulomb {
    /// A solver without a limit on its time.
    pub(super) fn patient() -> Self {
        Self { rounds: PATIENT, ..Self::default() }
    }

    /// The displacement caused by the push; `None` if negative gaps contradict each other. Without friction
    /// it equals [`Projection::closest_allowed`].
    pub(super) fn displacement(
        &mut self,
        projection: &mut Projection,
        push: &Vector,
        contacts: Contacts<'_>,
        gap: impl Fn(usize) -> f64 + Copy,
        scale: f64,
    ) -> Option<Vector> {
        let u = match self.last {
            Some(last) if contacts.friction > 0.0 => last.map(|x| scale * x),
            _ => {
                let gaps = (0..contacts.rows.len()).map(gap);
                let u = projection.closest_allowed(push, contacts.rows, gaps, scale)?;
                self.pressed.clear();
                self.pressed.extend_from_slice(projection.pressed());
                if contacts.friction == 0.0 || self.pressed.is_empty() {
                    return Some(u);
                }
                u
            }
        };
        self.slips.clear();
        self.slips.extend((0..contacts.rows.len()).map(|k| contacts.friction * size(contacts.slip(k, &u))));
        let u = self.settle(projection, push, contacts, gap, scale, true)?;
        self.last = Some(u.map(|x| x / scale));
        Some(u)
    }

    /// Sets the last displacement, relative to that by the push alone, as the start of the iteration. `None`:
    /// as without friction.
    pub(super) const fn begin_at(&mut self, last: Option<Vector>) {
        self.last = last;
    }

    /// Whether some force within the cones holds the half against the push, with all contacts touching.
    pub(super) fn may_stick(
        &mut self,
        projection: &mut Projection,
        push: &Vector,
        contacts: Contacts<'_>,
    ) -> bool {
        self.unheld(projection, push, contacts).is_some_and(|u| is_still(&u))
    }

    /// The part of the push that no contact forces within the cones balance, with all contacts touching: the
    /// push minus the nearest force that they can balance.
    pub(super) fn unheld(
        &mut self,
        projection: &mut Projection,
        push: &Vector,
        contacts: Contacts<'_>,
    ) -> Option<Vector> {
        self.slips.clear();
        self.slips.resize(contacts.rows.len(), 0.0);
        self.settle(projection, push, contacts, |_| 0.0, 1.0, false)
    }

    /// The contacts that carry in the last displacement.
    pub(super) fn pressed(&self) -> &[usize] {
        &self.pressed
    }

    /// The closest to the push that lies in all cones; their slips are brought to those that it makes if they are `free`.
    fn settle(
        &mut self,
        projection: &mut Projection,
        push: &Vector,
        contacts: Contacts<'_>,
        gap: impl Fn(usize) -> f64,
        scale: f64,
        free: bool,
    ) -> Option<Vector> {
        self.planes.clear();
        self.owners.clear();
        self.missing.clear();
        self.start.clear();
        let mut boldness = 1.0;
        let mut u = *push;
        // With given slips all planes are kept, and few rounds suffice.
        let rounds = if free { self.rounds } else { ROUNDS };
        for round in 0..rounds {
            let gaps = self.owners.iter().map(|&k| gap(k) + self.slips[k]);
            u = projection.closest_allowed_from(&self.start, push, &self.planes, gaps, scale)?;
            self.start.clear();
            self.start.extend(projection.multipliers());
            if free {
                self.keep_pressed();
            }
            std::mem::swap(&mut self.before, &mut self.missing);
            self.missing.clear();
            let mut worst = 0.0f64;
            for k in 0..contacts.rows.len() {
                let slip = contacts.slip(k, &u);
                let (slips, open) = (contacts.friction * size(slip), dot(&contacts.rows[k], &u) + gap(k));
                let missing = slips - self.slips[k];
                self.missing.push(missing);
                // Outside of its cone; or, if it is pressed, of another slip than was thought.
                let outside = missing - open;
                let is_pressed = self.pressed.contains(&k);
                if outside > EXACT * scale {
                    self.planes.push(contacts.plane(k, slip));
                    self.owners.push(k);
                }
                worst = worst.max(outside);
                if free {
                    worst = worst.max(if is_pressed { missing.abs() } else { -open });
                }
            }
            if worst <= EXACT * scale {
                break;
            }
            if !free {
                continue;
            }
            // Aitken's step: extrapolates the slips from the last two rounds.
            if round > SETTLED {
                let (mut along, mut size, mut both) = (0.0, 0.0, 0.0);
                for (before, now) in self.before.iter().zip(&self.missing) {
                    along += before * (now - before);
                    size += (now - before) * (now - before);
                    both += before * now;
                }
                let least = if both < 0.0 { SHYEST } else { 1.0 };
                boldness = if size > 0.0 { (-boldness * along / size).clamp(least, BOLDEST) } else { 1.0 };
            }
            for (slip, missing) in self.slips.iter_mut().zip(&self.missing) {
                *slip = (*slip + boldness * missing).max(LEFT * (*slip + missing));
            }
        }
        Some(if free { self.slow(projection, push, contacts, &u, gap, scale).unwrap_or(u) } else { u })
    }

    /// Limit of a slow slip, by the balance of forces along its direction; `None` if it is not slow, or if no
    /// contact forces balance the push along it.
    fn slow(
        &mut self,
        projection: &mut Projection,
        push: &Vector,
        contacts: Contacts<'_>,
        u: &Vector,
        gap: impl Fn(usize) -> f64,
        scale: f64,
    ) -> Option<Vector> {
        let speed = norm(u);
        if speed <= STILL * scale || speed > SLOW * scale {
            return None;
        }
        // All contacts that touch and stay closed, not only those pressed in the last round.
        self.owners.clear();
        self.owners.extend(
            (0..contacts.rows.len())
                .filter(|&k| gap(k) <= EXACT * scale && dot(&contacts.rows[k], u).abs() <= CLOSED * speed),
        );
        let closed = self.owners.iter().flat_map(|k| [contacts.rows[*k], contacts.rows[*k].map(|x| -x)]);
        self.planes.clear();
        self.planes.extend(closed);
        let along = projection.closest_allowed(u, &self.planes, self.planes.iter().map(|_| 0.0), speed)?;
        let length = norm(&along);
        if length <= LEFT * speed {
            return None;
        }
        let along = along.map(|x| x / length);
        self.planes.clear();
        self.planes.extend(self.owners.iter().map(|k| contacts.plane(*k, contacts.slip(*k, &along))));
        // The part of the push that the contact forces and a force along the slip, or against it, do not
        // balance.
        let mut left = |way: f64| {
            self.planes.push(along.map(|x| way * x));
            let left = projection.closest_allowed(push, &self.planes, self.planes.iter().map(|_| 0.0), scale);
            self.planes.pop();
            left.map(|left| norm(&left) / scale)
        };
        let [ahead, against] = [left(1.0)?, left(-1.0)?];
        if against <= EXACT {
            let last = self.planes.len();
            let speed = projection.forces().find(|(row, _)| *row == last).map_or(0.0, |(_, force)| force);
            return Some(along.map(|x| x * speed * scale));
        }
        (ahead <= EXACT).then_some([0.0; MAX_COORDINATES])
    }

    /// Keeps the planes with positive forces, and their contacts.
    fn keep_pressed(&mut self) {
        self.pressed.clear();
        self.start.sort_unstable_by_key(|(plane, _)| *plane);
        for (kept, (plane, _)) in self.start.iter_mut().enumerate() {
            self.planes.swap(kept, *plane);
            self.owners.swap(kept, *plane);
            *plane = kept;
            let contact = self.owners[kept];
            if !self.pressed.contains(&contact) {
                self.pressed.push(contact);
            }
        }
        let kept = self.start.len();
        self.planes.truncate(kept);
        self.owners.truncate(kept);
    }
}

/// Whether a displacement is zero, relative to that by the push alone.
pub(super) fn is_still(u: &Vector) -> bool {
    u.iter().all(|x| x.abs() <= STILL)
}

fn size([a, b]: [f64; 2]) -> f64 {
    (a * a + b * b).sqrt()
}

fn norm(u: &Vector) -> f64 {
    dot(u, u).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: f64 = std::f64::consts::FRAC_1_SQRT_2;

    fn contacts<'a>(rows: &'a [Vector], tangents: &'a [Tangents], friction: f64) -> Contacts<'a> {
        Contacts { rows, tangents, friction }
    }

    /// A slope of 45°: slips by (1 − μ)·sin 45° along itself as long as μ < 1.
    #[test]
    fn a_slope_holds_from_its_tangent_on() {
        let rows = [[S, 0.0, S, 0.0, 0.0, 0.0]];
        let tangents = [[[S, 0.0, -S, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]]];
        let push = [0.0, 0.0, -1.0, 0.0, 0.0, 0.0];
        let (mut coulomb, mut projection) = (Coulomb::default(), Projection::default());
        for friction in [0.0, 0.1, 0.5, 0.9, 0.999, 1.001, 2.0] {
            let contacts = contacts(&rows, &tangents, friction);
            let u = coulomb.displacement(&mut projection, &push, contacts, |_| 0.0, 1.0).unwrap();
            let slips = (1.0 - friction).max(0.0) * S;
            assert!((u[0] - slips * S).abs() < 1e-8 && (u[2] + slips * S).abs() < 1e-8, "{friction} {u:?}");
            assert_eq!(coulomb.may_stick(&mut projection, &push, contacts), friction > 1.0);
        }
    }
}
