//! A motion, from first contact to its end: by plain steps ([`super::step`]), for pairs with tight fits by
//! [`super::sliding`].

use super::coulomb::Coulomb;
use super::fall::{fall, home};
use super::homing;
use super::projection::{Projection, Vector, dot};
use super::rest::TOUCHING;
use super::rows::{Rows, horizon};
use super::sliding::Sliding;
use super::step::{Advance, Pace};
use super::{DescentSettings, End, Touch, Waypoint};
use crate::acceptance::Outcome;
use crate::contact::{Contact, Meeting, Nearby, Pair, Seat};
use crate::pose::{CorPose, PoseError, rotation};
use crate::tolerance::COINCIDENT;
use glam::{DMat3, DQuat, DVec3};

/// Position of the moving half.
#[derive(Debug, Clone, Copy)]
pub(super) struct State {
    /// COR in the world frame.
    pub(super) cor: DVec3,
    pub(super) rotation: DMat3,
    /// The same rotation if all three are free.
    pub(super) spin: DQuat,
    /// (roll, pitch, yaw) if some rotation is locked; unused if all three are free.
    pub(super) angles: [f64; 3],
}

impl State {
    /// Lateral position of the COR, and rotation.
    pub(super) fn pose(&self) -> CorPose {
        CorPose { lateral: self.cor.truncate(), rotation: self.rotation }
    }
}

/// How long a motion is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Until {
    /// Until the outcome is known.
    Known,
    /// Until it has come to rest, even if the outcome is known before.
    AtRest,
}

/// Sees a motion at every step.
pub(super) trait MotionObserver {
    /// The outcome of the motion, if it is known from here: the motion then ends.
    fn see(&mut self, motion: &Motion, state: &State, travelled: f64) -> Option<Outcome>;

    /// Whether it needs the contacts: those of the last step are not searched if not.
    fn looks(&self) -> bool {
        true
    }
}

/// Sees nothing.
pub(super) struct NoObserver;

impl MotionObserver for NoObserver {
    fn see(&mut self, _: &Motion, _: &State, _: f64) -> Option<Outcome> {
        None
    }

    fn looks(&self) -> bool {
        false
    }
}

/// Keeps every waypoint.
impl MotionObserver for Vec<Waypoint> {
    fn see(&mut self, motion: &Motion, state: &State, travelled: f64) -> Option<Outcome> {
        self.push(motion.waypoint(state, travelled));
        None
    }
}

/// Queries the function at every pose error of the motion.
impl<F: FnMut(&PoseError) -> Option<Outcome>> MotionObserver for F {
    fn see(&mut self, motion: &Motion, state: &State, _: f64) -> Option<Outcome> {
        self(&motion.error_of(state))
    }

    fn looks(&self) -> bool {
        false
    }
}

/// A mean slope below this over a whole step's length, or over so many steps, is rest: less than any friction.
const LEVEL: f64 = 1e-6;
const LEVEL_STEPS: usize = 128;

/// A half near the mated pose, in a seat known to lead there ([`home`]), ends its motion if its height is at
/// least this share of its distance.
const TAPER: f64 = 0.1;

/// A mover of poses for a pair: owns the buffers.
pub(super) struct Motion<'a> {
    pub(super) pair: &'a Pair,
    pub(super) settings: &'a DescentSettings,
    seat: Seat<'a>,
    /// Whether all motion near the mated pose leads to it: [`super::homing`].
    pub(super) homing: bool,
    /// Whether the mated pose is assumed to be stable: [`super::fall`] tests that by motions.
    trusting: bool,
    pub(super) nearby: Nearby<'a>,
    pub(super) contacts: Vec<(Contact, Meeting)>,
    /// Scratch for [`Motion::cut`] and [`Motion::meet`].
    pub(super) carrying: Vec<(Contact, Meeting)>,
    /// The constraints on the displacement of this step: [`super::rows`].
    pub(super) rows: Rows,
    pub(super) projection: Projection,
    pub(super) coulomb: Coulomb,
    /// Buffers of [`super::sliding`], for pairs with tight fits.
    pub(super) sliding: Sliding,
    /// Largest distance of a moving corner from the COR.
    pub(super) radius: f64,
    /// All three rotations free: they live on SO(3), not in Euler angles.
    pub(super) spherical: bool,
}

impl<'a> Motion<'a> {
    pub(super) fn new(pair: &'a Pair, settings: &'a DescentSettings) -> Self {
        let radius =
            pair.moving.surfaces.iter().flat_map(|s| &s.vertices).map(|v| v.length()).fold(0.0, f64::max);
        let (slack, near) = horizon(settings.step, radius, pair.alignment.rotation_length);
        Self {
            pair,
            settings,
            seat: Seat::new(pair),
            homing: false,
            trusting: false,
            nearby: pair.nearby(slack, near),
            contacts: Vec::new(),
            carrying: Vec::new(),
            rows: Rows::default(),
            projection: Projection::default(),
            coulomb: Coulomb::default(),
            sliding: Sliding::default(),
            radius,
            spherical: pair.alignment.free.rotations() == 3,
        }
    }

    /// Also ends motions before they come to rest if all motion near the mated pose leads to it; friction may
    /// stop such motions.
    pub(super) fn homing(mut self) -> Self {
        self.homing = !self.settings.may_hold() && homing::all_dock(self.pair);
        self
    }

    /// Takes for granted that the mated pose holds.
    pub(super) const fn trusting(mut self) -> Self {
        self.trusting = true;
        self
    }

    /// Lowers the moving half at `error` and follows it to its end, or until `watch` calls it.
    pub(super) fn follow(&mut self, error: &PoseError, until: Until, watch: &mut impl MotionObserver) -> End {
        let mut pace = Pace::new(self.settings.step);
        let Some(mut state) = self.touch_down(error) else { return End::missed(*error) };
        let mut travelled = 0.0;
        let mut mark = (0, travelled, self.energy(&state));
        // A seated half stays seated, so the outcome "docked" is known before it comes to rest, unless some
        // rests do not count.
        let (mut seated, mut requested, mut docked) = (false, false, false);
        let all_count =
            !self.seat.is_limited() && (self.trusting || fall(self.pair).is_none() && !self.seat.leaks());
        let near = if all_count && !self.trusting && self.ends_at_home() { home(self.pair) } else { 0.0 };
        for count in 0..self.settings.max_steps {
            if self.pair.is_tight() {
                state = self.feel(&state);
            } else if self.pair.has_trees() {
                let far = self.pair.alignment.length(&self.error_of(&state));
                let climbed = self.energy(&state) - self.pair.mated_energy();
                if far <= near && climbed >= TAPER * far {
                    travelled += far;
                    state = self.home();
                }
                if self.is_home(&state) {
                    // The contacts at the mated pose do not depend on the path to it.
                    pace.step = self.settings.step;
                    self.turn(&state.rotation, state.cor.truncate(), pace.step);
                } else {
                    // Beyond the mated pose the half climbs again, and a search there is slow.
                    pace.step = pace.step.min(far.max(TOUCHING));
                }
            }
            // A half below the seat's level stays in its part of the level set, so one test decides whether
            // that part is the seat. If all motions near the mated pose lead to it, coming near suffices, and
            // a half that slides off needs no test.
            let energy = self.energy(&state);
            let deep = !self.homing && energy <= self.seat.level();
            // Below the floor of the seat the half has left it, and does not climb back.
            let above = energy >= self.seat.floor();
            seated = above && (seated || deep && !requested && self.is_seated(&state));
            requested |= deep;
            docked |= all_count
                && above
                && (seated || self.homing && homing::is_near(self.pair, &state.rotation, state.cor));
            let (is_known, is_home) = (docked && until == Until::Known, self.is_home(&state));
            if !self.pair.is_tight() && (watch.looks() || !is_known && !is_home) {
                self.gather(&state, pace.step);
            }
            if let Some(outcome) = watch.see(self, &state, travelled) {
                return self.ended(outcome, &state);
            }
            if is_known {
                return self.ended(Outcome::Aligned, &state);
            }
            if is_home {
                return self.end(Outcome::Jammed, &state, [seated, docked]);
            }
            if travelled - mark.1 > self.settings.step || count - mark.0 > LEVEL_STEPS {
                if mark.2 - energy < LEVEL * self.settings.step {
                    return self.end(Outcome::Jammed, &state, [seated, docked]);
                }
                mark = (count, travelled, energy);
            }
            let advance = if self.pair.is_tight() {
                self.slide(&state, &mut pace)
            } else {
                self.advance(&state, &mut pace)
            };
            match advance {
                Advance::Moved(next, length) => {
                    state = next;
                    travelled += length;
                }
                Advance::Ended(outcome, last) => return self.end(outcome, &last, [seated, docked]),
            }
        }
        self.end(Outcome::Undecided, &state, [seated, docked])
    }

    /// The moving half lowered at `error` to first contact; `None` without contact.
    fn touch_down(&mut self, error: &PoseError) -> Option<State> {
        let start = self.pair.pose(error);
        self.nearby.leave();
        self.sliding.forget();
        self.coulomb.begin_at(None);
        self.turn(&start.rotation, start.lateral, self.settings.step);
        let (z, _) = self.nearby.height_below(start.lateral, f64::INFINITY);
        Some(State {
            cor: start.lateral.extend(z?),
            rotation: start.rotation,
            spin: DQuat::from_mat3(&start.rotation),
            angles: [error.roll, error.pitch, error.yaw],
        })
    }

    /// The same, with its contacts.
    pub(super) fn lower(&mut self, error: &PoseError) -> Option<State> {
        let state = self.touch_down(error)?;
        if self.pair.is_tight() {
            return Some(self.feel(&state));
        }
        self.gather(&state, self.settings.step);
        Some(state)
    }

    /// The outcome of an end: a rest in the seat, within the docking tolerance, is docked.
    fn end(&mut self, outcome: Outcome, last: &State, [seated, docked]: [bool; 2]) -> End {
        let error = self.error_of(last);
        let rests_well = |motion: &mut Self| {
            outcome == Outcome::Jammed
                && (seated || motion.is_seated(last))
                && motion.seat.allows(&error, last.cor.z)
        };
        // A half that leaves is no longer docked, whatever it was before.
        let docked = docked && outcome != Outcome::Missed || rests_well(self);
        self.ended(if docked { Outcome::Aligned } else { outcome }, last)
    }

    /// A motion that ends in a state.
    fn ended(&self, outcome: Outcome, last: &State) -> End {
        let error = self.error_of(last);
        let height = (outcome != Outcome::Missed).then_some(last.cor.z);
        End { outcome, error, height }
    }

    /// Whether a displacement from a state, whose lateral part has this length, lowers the energy too little to go on.
    pub(super) fn is_too_gentle(&self, state: &State, u: &Vector, length: f64) -> bool {
        let least = self.settings.slope_threshold;
        least > 0.0 && self.work(state, u) <= least * length
    }

    pub(super) fn moved(&self, state: &State, u: &Vector) -> State {
        let cor = state.cor + DVec3::new(u[0], u[1], u[2]);
        let turn = [u[3], u[4], u[5]].map(|x| x / self.pair.alignment.rotation_length);
        if self.spherical {
            let spin = (DQuat::from_scaled_axis(DVec3::from_array(turn)) * state.spin).normalize();
            State { cor, rotation: DMat3::from_quat(spin), spin, angles: state.angles }
        } else {
            let mut angles = state.angles;
            for (angle, turn) in angles.iter_mut().zip(turn) {
                *angle += turn;
            }
            State { cor, rotation: rotation(angles[0], angles[1], angles[2]), angles, ..*state }
        }
    }

    /// The mated pose.
    fn home(&self) -> State {
        State {
            cor: DVec3::new(0.0, 0.0, self.pair.mated_height()),
            rotation: DMat3::IDENTITY,
            spin: DQuat::IDENTITY,
            angles: [0.0; 3],
        }
    }

    /// Whether halves of many facets are moved to their mated pose when they are near it. Almost all facets
    /// touch there, and determining which of them carry takes as long as the whole motion before.
    fn ends_at_home(&self) -> bool {
        self.pair.has_trees() && !self.pair.is_tight() && !self.settings.may_hold()
    }

    /// The mated pose, if halves of many facets are as close to it, in the ρ-metric, as the contact
    /// tolerance.
    pub(super) fn home_of(&self, state: &State) -> Option<State> {
        let is_near = || self.pair.alignment.length(&self.error_of(state)) <= TOUCHING;
        (self.pair.has_trees() && is_near()).then(|| self.home())
    }

    /// Whether halves of many facets rest in the mated pose, at which no push leads on.
    pub(super) fn is_home(&self, state: &State) -> bool {
        let home = self.home();
        self.pair.has_trees()
            && !self.pair.is_tight()
            && state.cor == home.cor
            && state.rotation == home.rotation
    }

    /// Whether the half has come into the seat.
    fn is_seated(&mut self, state: &State) -> bool {
        self.energy(state) <= self.seat.level() && {
            let error = self.error_of(state);
            self.seat.holds(&error, state.cor.z)
        }
    }

    /// The push at a state.
    pub(super) fn push(&self, state: &State) -> Vector {
        self.pair.push(&state.pose(), state.cor.z)
    }

    /// The potential energy at a state, in D.
    pub(super) fn energy(&self, state: &State) -> f64 {
        self.pair.energy(&state.pose(), state.cor.z)
    }

    /// By how much a displacement from a state lowers the energy, to first order, in D.
    pub(super) fn work(&self, state: &State, u: &Vector) -> f64 {
        dot(&self.push(state), u)
    }

    pub(super) fn error_of(&self, state: &State) -> PoseError {
        let mut error = state.pose().to_error(self.pair.alignment.center_of_rotation);
        // Locked rotations stay exactly 0: no detour through the matrix.
        if !self.spherical {
            [error.roll, error.pitch, error.yaw] = state.angles;
        }
        error
    }

    fn waypoint(&self, state: &State, travelled: f64) -> Waypoint {
        let touches = self
            .contacts
            .iter()
            .filter(|(c, _)| c.gap <= COINCIDENT)
            .map(|(c, _)| Touch { point: c.point, normal: c.normal })
            .collect();
        Waypoint { error: self.error_of(state), height: state.cor.z, travelled, touches }
    }
}
