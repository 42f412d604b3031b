//! One motion, step by step.
//!
//! Per step: everything that touches or may be met is found exactly at the current position ([`super::rows`]); the closest allowed
//! displacement to the push of the force is taken ([`super::projection`]); the height is then set to that of
//! first contact, so that errors of the linearisation never build up. A step that the height contradicts
//! is halved. Pairs with tight fits go by [`super::sliding`] instead.

use super::coulomb::Coulomb;
use super::fall::fall;
use super::homing;
use super::projection::{MAX_COORDINATES, Projection, Vector, dot};
use super::rest::TOUCHING;
use super::rows::{OVERLAP, Rows, horizon};
use super::sliding::Sliding;
use super::{Settings, Touch, Waypoint};
use crate::acceptance::Outcome;
use crate::contact::{Contact, Meeting, Nearby, Pair, Seat};
use crate::pose::{CorPose, PoseError, rotation};
use glam::{DMat3, DQuat, DVec2, DVec3};

/// Position of the moving half.
#[derive(Debug, Clone, Copy)]
pub(super) struct State {
    /// COR in the world frame.
    pub(super) cor: DVec3,
    pub(super) rotation: DMat3,
    /// The same rotation where all three are free.
    pub(super) spin: DQuat,
    /// (roll, pitch, yaw) where some rotation is locked; unused when all three are free.
    pub(super) angles: [f64; 3],
}

/// How long a motion is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Until {
    /// Until it is known what becomes of it.
    Known,
    /// Until it has come to rest, whatever is known before.
    AtRest,
}

/// How a motion goes on.
pub(super) enum Advance {
    /// To here, by this length in the ρ-metric.
    Moved(State, f64),
    /// No further than here.
    Ended(Outcome, State),
}

/// Sees a motion at every step.
pub(super) trait Watch {
    /// What becomes of the motion, if that is known from here: it is followed no further.
    fn see(&mut self, motion: &Motion, state: &State, travelled: f64) -> Option<Outcome>;

    /// Whether it looks at contacts: else those of the last step are not looked for.
    fn looks(&self) -> bool {
        true
    }
}

/// Sees nothing.
pub(super) struct Unwatched;

impl Watch for Unwatched {
    fn see(&mut self, _: &Motion, _: &State, _: f64) -> Option<Outcome> {
        None
    }

    fn looks(&self) -> bool {
        false
    }
}

/// Keeps every waypoint.
impl Watch for Vec<Waypoint> {
    fn see(&mut self, motion: &Motion, state: &State, travelled: f64) -> Option<Outcome> {
        self.push(motion.waypoint(state, travelled));
        None
    }
}

/// Asks at every pose error on the way.
impl<F: FnMut(&PoseError) -> Option<Outcome>> Watch for F {
    fn see(&mut self, motion: &Motion, state: &State, _: f64) -> Option<Outcome> {
        self(&motion.error_of(state))
    }

    fn looks(&self) -> bool {
        false
    }
}

/// How boldly a motion steps; kept from step to step.
pub(super) struct Pace {
    /// Length of the next step in the ρ-metric, in D.
    pub(super) step: f64,
    /// How hard the force pushes, in steps.
    reach: f64,
    /// How far it reached: the length of the last displacement before it was cut to a step, in steps.
    share: f64,
}

/// How far the push reaches relative to the step: raised on gentle slopes so that they take no longer.
const MAX_REACH: f64 = 1e7;
/// The same with friction, whose forces are found less exactly: rest is a slope below 10⁻⁷ beyond what friction holds.
const MAX_REACH_OF_FRICTION: f64 = 1e4;
/// A displacement below this share of the step, at the largest reach, is rest: a slope below 10⁻¹⁰.
const REST: f64 = 1e-3;
/// Steps are halved down to this share of the chosen one.
const SMALLEST_SHARE: f64 = 1.0 / 4096.0;
/// Steps that fall off an edge are halved down to this share: where exactly it falls matters little.
const COARSE_SHARE: f64 = 1.0 / 64.0;
/// Where a step of this share climbs although the slope falls gently, the bottom of a smooth hollow is within it.
const REST_SHARE: f64 = 1.0 / 256.0;
/// A gentle slope: what a curvature of 1/(0.01 D) makes of the smallest such step.
const GENTLE: f64 = 0.01;
/// How many contacts one step may discover before it is halved: the facets around a corner.
const MAX_CUTS: usize = 6;
/// A fall of this many allowed surprises is a fall off an edge.
const FALL: f64 = 1.0;

/// A motion that turns by less than `STRAIGHT` (sine) from the start of a step to its middle is followed by longer
/// steps, up to `LONG` times; one that turns by more than `BENT` is not.
const STRAIGHT: f64 = 0.01;
const BENT: f64 = 0.04;
const LONG: f64 = 2.0;

/// Steps of halves of many facets are halved down to this share of the longest one before what they run into is looked for: to look takes longer.
const LOOKING_SHARE: f64 = 1.0 / 16.0;

/// Rounding of a height, in D.
const ROUNDING: f64 = 1e-12;
/// A mean slope below this over a whole step's length, or over so many steps, is rest.
const LEVEL: f64 = 1e-6;
const LEVEL_STEPS: usize = 128;

/// A mover of poses for one pair: owns the buffers.
pub(super) struct Motion<'a> {
    pub(super) pair: &'a Pair,
    pub(super) settings: &'a Settings,
    seat: Seat<'a>,
    /// Whether all motion near the mated pose leads to it: [`super::homing`].
    pub(super) homing: bool,
    /// Whether the mated pose is taken to hold: [`super::fall`] asks that by motions.
    trusting: bool,
    pub(super) nearby: Nearby<'a>,
    pub(super) contacts: Vec<(Contact, Meeting)>,
    /// Scratch for [`Motion::cut`] and [`Motion::meet`].
    pub(super) carrying: Vec<(Contact, Meeting)>,
    /// What holds for the displacement of this step: [`super::rows`].
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

impl Pace {
    /// For a first step of this length.
    pub(super) const fn new(step: f64) -> Self {
        Self { step, reach: 1.0, share: 1.0 }
    }
}

impl<'a> Motion<'a> {
    pub(super) fn new(pair: &'a Pair, settings: &'a Settings) -> Self {
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

    /// How far the push reaches at most, in steps.
    fn most_reach(&self) -> f64 {
        if self.settings.friction > 0.0 { MAX_REACH_OF_FRICTION } else { MAX_REACH }
    }

    /// Calls motions before they have come to rest also where all motion near the mated pose leads to it, which friction may end.
    pub(super) fn homing(mut self) -> Self {
        self.homing = !self.settings.may_hold() && homing::all_dock(self.pair);
        self
    }

    /// Takes for granted that the mated pose holds.
    pub(super) const fn trusting(mut self) -> Self {
        self.trusting = true;
        self
    }

    /// Lowers the moving half at `error` and follows it to its end, or until `watch` calls it; returns the outcome and the last pose
    /// error.
    pub(super) fn follow(
        &mut self,
        error: &PoseError,
        until: Until,
        watch: &mut impl Watch,
    ) -> (Outcome, PoseError) {
        let mut pace = Pace::new(self.settings.step);
        let Some(mut state) = self.touch_down(error) else { return (Outcome::Missed, *error) };
        let mut travelled = 0.0;
        let mut mark = (0, travelled, state.cor.z);
        // A half that is seated stays so; whether it is docked then is known before it has come to rest, unless some rests do not count.
        let (mut seated, mut asked, mut docked) = (false, false, false);
        let all_count = !self.seat.is_limited() && (self.trusting || fall(self.pair).is_none());
        for count in 0..self.settings.max_steps {
            if self.pair.is_tight() {
                state = self.feel(&state);
            }
            // What is deep enough moves on in its own part of what is: once tells whether that is the seat. Where all motion near the
            // mated pose leads to it, coming near tells as much, and what slides off has not to ask.
            let deep = !self.homing && state.cor.z <= self.seat.level();
            seated = seated || deep && !asked && self.is_seated(&state);
            asked |= deep;
            docked |= all_count
                && (seated || self.homing && homing::is_near(self.pair, &state.rotation, state.cor));
            let (is_known, is_home) = (docked && until == Until::Known, self.is_home(&state));
            if !self.pair.is_tight() && (watch.looks() || !is_known && !is_home) {
                self.gather(&state, pace.step);
            }
            if let Some(outcome) = watch.see(self, &state, travelled) {
                return (outcome, self.error_of(&state));
            }
            if is_known {
                return (Outcome::Aligned, self.error_of(&state));
            }
            if is_home {
                return self.end(Outcome::Jammed, &state, [seated, docked]);
            }
            if travelled - mark.1 > self.settings.step || count - mark.0 > LEVEL_STEPS {
                if mark.2 - state.cor.z < LEVEL * self.settings.step {
                    return self.end(Outcome::Jammed, &state, [seated, docked]);
                }
                mark = (count, travelled, state.cor.z);
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

    /// The moving half lowered at `error` until it first touches; `None` where it touches nothing.
    fn touch_down(&mut self, error: &PoseError) -> Option<State> {
        let alignment = &self.pair.alignment;
        let start = CorPose::from_error(error, alignment.center_of_rotation, alignment.free);
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

    /// What an end is called: rest in the seat, within what the design allows, is docked.
    fn end(&mut self, outcome: Outcome, last: &State, [seated, docked]: [bool; 2]) -> (Outcome, PoseError) {
        let error = self.error_of(last);
        let rests_well = |motion: &mut Self| {
            outcome == Outcome::Jammed
                && (seated || motion.is_seated(last))
                && motion.seat.allows(&error, last.cor.z)
        };
        let docked = docked || rests_well(self);
        (if docked { Outcome::Aligned } else { outcome }, error)
    }

    /// Whether a displacement whose lateral part has this length falls too little to go on.
    pub(super) fn is_too_gentle(&self, u: &Vector, length: f64) -> bool {
        let least = self.settings.slope_threshold;
        least > 0.0 && -u[2] <= least * length
    }

    /// One step from `state`, whose contacts have been gathered: halved until the height agrees with it.
    pub(super) fn advance(&mut self, state: &State, pace: &mut Pace) -> Advance {
        let longest = self.settings.step;
        let (mut u, mut length) = self.displacement(pace);
        let mut fresh = true;
        let mut cuts = 0;
        let mut bend = 0.0;
        loop {
            if length <= REST * pace.step && pace.reach >= self.most_reach() {
                return Advance::Ended(Outcome::Jammed, *state);
            }
            if self.is_too_gentle(&u, length) {
                return Advance::Ended(Outcome::Jammed, *state);
            }
            let mut halve = false;
            if fresh {
                let before = u;
                self.look_ahead(state, &u);
                (u, length) = self.displacement(pace);
                bend = deflection(&before, &u);
                halve = pace.step > longest && bend > BENT;
                if self.settings.friction > 0.0 && length <= REST * pace.step {
                    // What slips here sticks within the step: where, shorter ones say.
                    if pace.step <= longest * SMALLEST_SHARE {
                        return Advance::Ended(Outcome::Jammed, *state);
                    }
                    halve = true;
                }
            }
            if !halve {
                let next = self.moved(state, &u);
                let allowed = self.settings.surprise * pace.step.min(longest);
                if let Some(home) = self
                    .home_of(&next)
                    .filter(|home| (home.cor.z - next.cor.z).abs() <= allowed && home.cor.z <= state.cor.z)
                {
                    self.turn(&home.rotation, home.cor.truncate(), pace.step);
                    return Advance::Moved(home, length);
                }
                self.turn(&next.rotation, next.cor.truncate(), pace.step);
                let ceiling = state.cor.z.max(next.cor.z) + longest;
                let expected = next.cor.z - allowed;
                let (below, covered) = self.nearby.height_about(next.cor.truncate(), ceiling, expected);
                let z = below.unwrap_or(next.cor.z);
                let landed = State { cor: next.cor.truncate().extend(z), ..next };
                let blocked = covered && self.nearby.is_pierced(landed.cor);
                if below.is_none() && !blocked {
                    return Advance::Ended(Outcome::Missed, next);
                }
                let rise = z - next.cor.z;
                let climbs = z > state.cor.z + ROUNDING;
                let rises = rise > allowed || climbs;
                halve = if blocked {
                    // A wall that no contact announced is one more contact, if it was not met before; or what carries the body there is.
                    let looks =
                        cuts < MAX_CUTS && (!self.pair.asks_trees() || pace.step <= longest * LOOKING_SHARE);
                    if looks
                        && (self.meet(state, &landed, pace.step, &u) || rises && self.cut(&landed, rise, &u))
                    {
                        cuts += 1;
                        fresh = false;
                        (u, length) = self.displacement(pace);
                        continue;
                    }
                    if pace.step <= longest * SMALLEST_SHARE {
                        // What no contact tells of hooks under the other half, or the motion cannot be followed further.
                        if !self.nearby.look_under() {
                            return Advance::Ended(Outcome::Undecided, *state);
                        }
                        pace.step = longest;
                    }
                    true
                } else if pace.step > longest && (rise.abs() > allowed || climbs) {
                    true
                } else if rises {
                    // Something unannounced carries the body. Seen from here it is one more contact, if it lies below.
                    if cuts < MAX_CUTS && self.cut(&landed, rise, &u) {
                        cuts += 1;
                        fresh = false;
                        (u, length) = self.displacement(pace);
                        continue;
                    }
                    if climbs && pace.step <= longest * REST_SHARE && -u[2] <= GENTLE * length {
                        // The bottom of a smooth hollow, within a step.
                        return Advance::Ended(Outcome::Jammed, *state);
                    }
                    pace.step > longest * SMALLEST_SHARE
                } else {
                    // Falling off an edge: come closer to it before letting go.
                    rise < -FALL * allowed && pace.step > longest * COARSE_SHARE
                };
                if !halve {
                    let most = if bend > STRAIGHT { pace.step.max(longest) } else { longest * LONG };
                    pace.step = (pace.step * 2.0).min(most);
                    return Advance::Moved(landed, length);
                }
            }
            pace.step *= 0.5;
            self.turn(&state.rotation, state.cor.truncate(), pace.step);
            self.gather(state, pace.step);
            (u, length) = self.displacement(pace);
            fresh = true;
            cuts = 0;
        }
    }

    /// The displacement of one step and its length in the ρ-metric, at most `step`.
    ///
    /// The reach of the pace is adapted: raised on gentle slopes.
    fn displacement(&mut self, pace: &mut Pace) -> (Vector, f64) {
        let Pace { step, reach, share } = pace;
        let step = *step;
        let most = self.most_reach();
        let Self { projection, coulomb, rows, settings, .. } = self;
        let contacts = rows.contacts(settings.friction);
        let mut solve = |reach: f64| {
            let mut push = [0.0; MAX_COORDINATES];
            push[2] = -reach * step;
            let u = coulomb
                .displacement(projection, &push, contacts, |k| rows.gaps[k], step * reach)
                // Squeezed between two walls there is no clearance to regain.
                .or_else(|| {
                    let gap = |k: usize| rows.gaps[k].max(0.0);
                    coulomb.displacement(projection, &push, contacts, gap, step * reach)
                })
                .unwrap_or_default();
            let length = u.iter().enumerate().filter(|(k, _)| *k != 2).map(|(_, x)| x * x).sum::<f64>();
            (u, length.sqrt())
        };
        // As far as the last push would have had to reach for a whole step.
        *reach = (*reach / share.clamp(0.5, 4.0)).clamp(1.0, most);
        let mut found = solve(*reach);
        while found.1 < 0.5 * step && *reach < most {
            *reach = (*reach * (step / found.1).clamp(2.0, 16.0)).min(most);
            found = solve(*reach);
        }
        while found.1 > 2.0 * step && *reach > 1.0 {
            *reach = (*reach * (step / found.1).clamp(1.0 / 16.0, 0.5)).max(1.0);
            found = solve(*reach);
        }
        *share = found.1 / step;
        let (mut u, mut length) = found;
        // Nothing moved and 0 displacement are both allowed, hence everything in between.
        let longest = length.max(u[2].abs());
        if longest > step {
            let share = step / longest;
            u = u.map(|x| x * share);
            length *= share;
        }
        (u, length)
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

    /// The mated pose, where halves of many facets have come as near to it, in the ρ-metric, as what touches. All their facets nearly touch there, and to tell
    /// which of them carry takes as long as all the way before.
    fn home_of(&self, state: &State) -> Option<State> {
        if !self.pair.asks_trees() {
            return None;
        }
        let PoseError { x, y, roll, pitch, yaw } = self.error_of(state);
        let turn = roll.hypot(pitch).hypot(yaw) * self.pair.alignment.rotation_length;
        (x.hypot(y).hypot(turn) <= TOUCHING).then(|| State {
            cor: DVec3::new(0.0, 0.0, self.pair.mated_height()),
            rotation: DMat3::IDENTITY,
            spin: DQuat::IDENTITY,
            angles: [0.0; 3],
        })
    }

    /// Whether halves of many facets rest in the mated pose, where no push leads on.
    fn is_home(&self, state: &State) -> bool {
        let home = DVec3::new(0.0, 0.0, self.pair.mated_height());
        self.pair.asks_trees()
            && !self.pair.is_tight()
            && state.cor == home
            && state.rotation == DMat3::IDENTITY
    }

    /// Whether the half has come into the seat.
    fn is_seated(&mut self, state: &State) -> bool {
        state.cor.z <= self.seat.level() && {
            let error = self.error_of(state);
            self.seat.holds(&error, state.cor.z)
        }
    }

    fn error_of(&self, state: &State) -> PoseError {
        let pose = CorPose { lateral: DVec2::new(state.cor.x, state.cor.y), rotation: state.rotation };
        let mut error = pose.to_error(self.pair.alignment.center_of_rotation);
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
            .filter(|(c, _)| c.gap <= OVERLAP)
            .map(|(c, _)| Touch { point: c.point, normal: c.normal })
            .collect();
        Waypoint { error: self.error_of(state), height: state.cor.z, travelled, touches }
    }
}

/// Sine of the angle between the lateral parts of two displacements, or 1 where it is obtuse or one of them is none.
fn deflection(a: &Vector, b: &Vector) -> f64 {
    let lateral = |v: &Vector| Vector::map(*v, |x| x);
    let (mut a, mut b) = (lateral(a), lateral(b));
    (a[2], b[2]) = (0.0, 0.0);
    let (aa, bb, ab) = (dot(&a, &a), dot(&b, &b), dot(&a, &b));
    if ab <= 0.0 { 1.0 } else { (1.0 - ab * ab / (aa * bb)).max(0.0).sqrt() }
}
