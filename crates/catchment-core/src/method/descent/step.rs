//! A plain step of a motion.
//!
//! All current and possible contacts are found exactly at the current position ([`super::rows`]); the half
//! takes the permitted displacement closest to the push ([`super::projection`]); the height is then set to
//! that of first contact, so that linearisation errors never accumulate. A step that contradicts the height
//! is halved, unless the contradiction is an additional contact.

use super::motion::{Motion, State};
use super::projection::{Vector, dot};
use crate::acceptance::Outcome;
use crate::tolerance::ROUNDING;

/// Continuation of a motion.
pub(super) enum Advance {
    /// To here, by this length in the ρ-metric.
    Moved(State, f64),
    /// No further than here.
    Ended(Outcome, State),
}

/// How boldly a motion steps; kept from step to step.
pub(super) struct Pace {
    /// Length of the next step in the ρ-metric, in D.
    pub(super) step: f64,
    /// How hard the force pushes, in steps.
    reach: f64,
    /// Length of the last displacement before it was cut to a step, in steps.
    share: f64,
    /// Upper limit of that length, in steps.
    most: f64,
}

/// Largest factor of the push relative to the step: raised on gentle slopes so that they take no longer.
const MAX_REACH: f64 = 1e7;
/// The same with friction, whose forces are less accurate: rest is a slope below 10⁻⁷ beyond the friction.
const MAX_REACH_OF_FRICTION: f64 = 1e4;
/// The same on level ground: rest is a slope below 10⁻⁸, the effect of gaps known to 10⁻⁹ D on contacts about
/// ρ away.
const MAX_REACH_ON_LEVEL: f64 = 1e5;
/// Ground is level if the normals of all carrying contacts have at least this z: within 0.6°.
const LEVEL: f64 = 1.0 - 5e-5;
/// From this reach on, on level ground, gaps count that a plain push closes: the turn by which they close, at least gap/ρ, changes slopes by as much, and
/// the reach may make of that no more than the share `SETTLED` of a step. Half a step's slope is 1/reach.
const HARD: f64 = 16.0;
const SETTLED: f64 = 1e-3;
/// A displacement below this share of the step, at the largest reach, is rest: a slope below 10⁻¹⁰.
const REST: f64 = 1e-3;
/// A half rests if it does within steps of this share of the longest: in longer steps planes of facets beside
/// it hold it.
const RESTING_SHARE: f64 = 1.0 / 16.0;
/// Steps are halved down to this share of the chosen step.
const SMALLEST_SHARE: f64 = 1.0 / 4096.0;
/// Steps that fall off an edge are halved down to this share: the exact edge matters little.
const COARSE_SHARE: f64 = 1.0 / 64.0;
/// If a step of this share climbs although the slope falls gently, it contains the bottom of a smooth hollow.
const REST_SHARE: f64 = 1.0 / 256.0;
/// A gentle slope: that of a curvature of 1/(0.01 D) over the smallest such step.
const GENTLE: f64 = 0.01;
/// Largest number of contacts that a step may discover before it is halved: the facets around a corner.
const MAX_CUTS: usize = 6;
/// A fall of this many allowed surprises is a fall off an edge.
const FALL: f64 = 1.0;

/// A motion that turns by less than `STRAIGHT` (sine) from the start of a step to its middle uses longer
/// steps, up to `LONG` times; a motion that turns by more than `BENT` does not.
const STRAIGHT: f64 = 0.01;
const BENT: f64 = 0.04;
const LONG: f64 = 2.0;

/// For halves of many facets, steps are halved down to this share of the longest before the obstacles are
/// searched: the search takes longer.
const LOOKING_SHARE: f64 = 1.0 / 16.0;

impl Pace {
    /// For a first step of this length.
    pub(super) const fn new(step: f64) -> Self {
        Self { step, reach: 1.0, share: 1.0, most: MAX_REACH }
    }
}

impl Motion<'_> {
    /// A step from `state`, with its contacts gathered: halved until the height agrees with it.
    pub(super) fn advance(&mut self, state: &State, pace: &mut Pace) -> Advance {
        let longest = self.settings.step;
        let (mut u, mut length) = self.displacement(state, pace);
        let mut fresh = true;
        let mut cuts = 0;
        let mut bend = 0.0;
        loop {
            let rests = length <= REST * pace.step && pace.reach >= pace.most;
            if rests && pace.step <= longest * RESTING_SHARE || self.is_too_gentle(state, &u, length) {
                return Advance::Ended(Outcome::Jammed, *state);
            }
            let mut halve = rests;
            if fresh && !rests {
                let before = u;
                self.look_ahead(state, &u);
                (u, length) = self.displacement(state, pace);
                bend = deflection(&before, &u);
                halve = pace.step > longest && bend > BENT;
                if self.settings.friction > 0.0 && length <= REST * pace.step {
                    // The half slips here but sticks within the step; shorter steps locate the place.
                    if pace.step <= longest * SMALLEST_SHARE {
                        return Advance::Ended(Outcome::Jammed, *state);
                    }
                    halve = true;
                }
            }
            if !halve {
                let next = self.moved(state, &u);
                let allowed = self.settings.surprise * pace.step.min(longest);
                if let Some(home) = self.home_of(&next).filter(|home| {
                    let [home, next, here] = [home, &next, state].map(|at| self.energy(at));
                    (home - next).abs() <= allowed && home <= here
                }) {
                    self.turn(&home.rotation, home.cor.truncate(), pace.step);
                    return Advance::Moved(home, length);
                }
                self.turn(&next.rotation, next.cor.truncate(), pace.step);
                let ceiling = state.cor.z.max(next.cor.z) + longest;
                let expected = next.cor.z - allowed;
                let (below, covered) = self.nearby.height_about(next.cor.truncate(), ceiling, expected);
                let z = below.unwrap_or(next.cor.z);
                let landed = State { cor: next.cor.truncate().extend(z), ..next };
                let blocked = covered && self.nearby.overlaps(landed.cor);
                if below.is_none() && !blocked {
                    return Advance::Ended(Outcome::Missed, next);
                }
                let energy = self.energy(&landed);
                let rise = energy - self.energy(&next);
                let climbs = energy > self.energy(state) + ROUNDING;
                let rises = rise > allowed || climbs;
                halve = if blocked {
                    // A wall without a known contact becomes a contact, if it is new; or the contact that
                    // carries the body there does.
                    let looks =
                        cuts < MAX_CUTS && (!self.pair.has_trees() || pace.step <= longest * LOOKING_SHARE);
                    if looks
                        && (self.meet(state, &landed, pace.step, &u) || rises && self.cut(&landed, rise, &u))
                    {
                        cuts += 1;
                        fresh = false;
                        (u, length) = self.displacement(state, pace);
                        continue;
                    }
                    if pace.step <= longest * SMALLEST_SHARE {
                        // Without any contact, the half hooks under the other half, or the motion cannot be
                        // followed further.
                        if !self.nearby.look_under() {
                            return Advance::Ended(Outcome::Undecided, *state);
                        }
                        pace.step = longest;
                    }
                    true
                } else if pace.step > longest && (rise.abs() > allowed || climbs) {
                    true
                } else if rises {
                    // An unknown contact carries the body. It is added if it lies below the body as seen from
                    // here.
                    if cuts < MAX_CUTS && self.cut(&landed, rise, &u) {
                        cuts += 1;
                        fresh = false;
                        (u, length) = self.displacement(state, pace);
                        continue;
                    }
                    if climbs && pace.step <= longest * REST_SHARE && self.work(state, &u) <= GENTLE * length
                    {
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
            pace.step = if rests { longest * RESTING_SHARE } else { 0.5 * pace.step };
            self.turn(&state.rotation, state.cor.truncate(), pace.step);
            self.gather(state, pace.step);
            (u, length) = self.displacement(state, pace);
            fresh = true;
            cuts = 0;
        }
    }

    /// The displacement of a step and its length in the ρ-metric, at most `step`.
    ///
    /// The reach of the pace is adapted: raised on gentle slopes.
    fn displacement(&mut self, state: &State, pace: &mut Pace) -> (Vector, f64) {
        let Pace { step, reach, share, most } = pace;
        let step = *step;
        *most = self.most_reach();
        let rotation_length = self.pair.alignment.rotation_length;
        let push = self.push(state);
        let Self { projection, coulomb, rows, settings, .. } = self;
        let contacts = rows.contacts(settings.friction);
        // A displacement, its length in the ρ-metric, and on level ground, the widest gap that it closes.
        let mut solve = |reach: f64| {
            let push = push.map(|part| reach * step * part);
            let u = coulomb
                .displacement(projection, &push, contacts, |k| rows.gaps[k], step * reach)
                // Squeezed between two walls there is no clearance to regain.
                .or_else(|| {
                    let gap = |k: usize| rows.gaps[k].max(0.0);
                    coulomb.displacement(projection, &push, contacts, gap, step * reach)
                })
                .unwrap_or_default();
            let length = u.iter().enumerate().filter(|(k, _)| *k != 2).map(|(_, x)| x * x).sum::<f64>();
            let pressed = || coulomb.pressed().iter();
            let is_level = pressed().len() > 0 && pressed().all(|&k| rows.vectors[k][2] > LEVEL);
            let closed = is_level.then(|| pressed().map(|&k| rows.gaps[k]).fold(0.0, f64::max));
            (u, length.sqrt(), closed)
        };
        // As far as the last push would have had to reach for a whole step.
        *reach = (*reach / share.clamp(0.5, 4.0)).clamp(1.0, *most);
        let mut result = solve(*reach);
        while result.1 < 0.5 * step && *reach < *most {
            *reach = (*reach * (step / result.1).clamp(2.0, 16.0)).min(*most);
            result = solve(*reach);
        }
        while result.1 > 2.0 * step && *reach > 1.0 {
            *reach = (*reach * (step / result.1).clamp(1.0 / 16.0, 0.5)).max(1.0);
            result = solve(*reach);
        }
        if *reach > HARD && settings.friction == 0.0 {
            // A half that settles onto level ground rotates while its gaps close; the slope of its further
            // motion, if any, is known only afterwards.
            let first = solve(1.0);
            if let Some(closed) = first.2 {
                *most = MAX_REACH_ON_LEVEL;
                let settled = (SETTLED * rotation_length / closed).clamp(1.0, *most);
                if settled < *reach {
                    *reach = settled;
                    result = if settled > 1.0 { solve(settled) } else { first };
                }
            }
        }
        *share = result.1 / step;
        let (mut u, mut length, _) = result;
        // Nothing moved and 0 displacement are both allowed, hence everything in between.
        let longest = length.max(u[2].abs());
        if longest > step {
            let share = step / longest;
            u = u.map(|x| x * share);
            length *= share;
        }
        (u, length)
    }

    /// Largest factor of the push, in steps.
    fn most_reach(&self) -> f64 {
        if self.settings.friction > 0.0 { MAX_REACH_OF_FRICTION } else { MAX_REACH }
    }
}

/// Sine of the angle between the lateral parts of two displacements, or 1 if it is obtuse or one of them is
/// zero.
fn deflection(a: &Vector, b: &Vector) -> f64 {
    let lateral = |v: &Vector| Vector::map(*v, |x| x);
    let (mut a, mut b) = (lateral(a), lateral(b));
    (a[2], b[2]) = (0.0, 0.0);
    let (aa, bb, ab) = (dot(&a, &a), dot(&b, &b), dot(&a, &b));
    if ab <= 0.0 { 1.0 } else { (1.0 - ab * ab / (aa * bb)).max(0.0).sqrt() }
}
