//! Bounds on the height over a box of poses.
//!
//! ```text
//!     h │    ╱‾‾ roof          touches    all contacts that may carry somewhere in the box
//!       │  ╱╲│╱                floor      no pose in contact is lower: h(m) and the slopes of all contacts,
//!       │ ╱  m                            mean value, or the lowest contact
//!       │╱‾‾ floor             sudden     h may jump: the rims of both halves may meet from outside, at the floor or above
//!       └──[────]──── q        restless   one direction opens all contacts at once: nothing rests in the box
//! ```
//!
//! h jumps only if, in plan view, a corner of the rim of one half reaches the rim of the other from outside.
//! If that is excluded, a motion stays on h: it neither falls nor slides under anything. Contacts below the
//! floor cannot carry and are removed, which may raise the floor. [`ROUNDING`] covers the rounding of the
//! exact heights.
//!
//! Not promised: that every continuous or restless box is recognised as such; smaller boxes are.

use super::bearing::{Bearings, Rising};
use super::body::{Body, Corner, Meeting, Ridge, Side};
use super::interval::{Interval, Vector, dot, perp, thin};
use super::placed::{Bodies, Placed, PoseBox, middle};
use super::touch::{Touch, Touching, plan};
use crate::contact::Nearby;
use crate::pose::{Dof, ROTATIONS};
use crate::tolerance::{COINCIDENT, PARALLEL};
use glam::DVec3;

/// Largest error of an exact height, in D: rounding, and features that support within 4·10⁻⁶.
pub(super) const ROUNDING: f64 = 1e-9;

/// Number of rounds in which contacts that cannot carry are removed, and the bounds recomputed.
const LOOKS: usize = 2;

/// Certified facts over a box.
#[derive(Debug, Clone)]
pub(super) struct Survey {
    /// All that may carry.
    pub(super) touches: Vec<Touch>,
    /// The push of each contact by itself.
    pub(super) pushes: Vec<PoseBox>,
    /// Bounds on the height at any pose of the box at which the halves touch, in D. `None` if nothing
    /// touches.
    pub(super) height: Option<Interval>,
    /// Whether h may jump in the box, or end.
    pub(super) sudden: bool,
    /// Whether a motion in the box may reach a rim from outside: it may meet a wall, or slide under
    /// something.
    pub(super) walled: bool,
    /// Whether it may end: at some pose of the box the halves may pass by each other.
    pub(super) ends: bool,
    /// A direction, in errors, that opens all contacts; `None` if the half may rest.
    pub(super) downhill: Option<[f64; 5]>,
}

impl Survey {
    /// Examines a box; only the meetings `among` may carry in it.
    pub(super) fn of(bodies: &Bodies, poses: &PoseBox, among: &[u32], nearby: &mut Nearby<'_>) -> Self {
        let touching = Touching::new(bodies, poses);
        let mut touches: Vec<Touch> = among.iter().filter_map(|number| touching.touch(*number)).collect();
        let Some(mut height) = span(&touches) else {
            let pushes = Vec::new();
            let (sudden, walled) = (false, false);
            return Self { touches, pushes, height: None, sudden, walled, ends: true, downhill: None };
        };
        let mut rims = None;
        let mut sudden = true;
        if let Some(mid) = nearby.height(&middle(poses)) {
            let mid = Interval::thin(mid).widened(ROUNDING);
            // Each pass removes pairs that cannot be in contact; the bounds then hold for the rest.
            for _ in 0..LOOKS {
                let Some(mean) = mean_value(bodies, poses, mid, &touches) else { break };
                let rims = rims.get_or_insert_with(|| Rims::meeting(bodies, &touching.over));
                // Before h can jump, it must be as high as the level on either side of the jump.
                if rims.iter().any(|rim| rim.lift.up >= mean.lo) {
                    break;
                }
                sudden = false;
                let Some(both) = height.and(mean) else { break };
                height = both;
                touches.retain(|touch| touch.height.up >= height.lo);
            }
        }
        let rims =
            if sudden { rims.unwrap_or_else(|| Rims::meeting(bodies, &touching.over)) } else { Vec::new() };
        let pushes: Vec<PoseBox> = touches.iter().map(|t| t.push(bodies, &touching.over)).collect();
        let inwards = |rim: &Meet| {
            let closes = |(touch, push): (&Touch, &PoseBox)| {
                rim.closes(push) && !rim.parts(bodies, bodies.meetings[touch.number as usize])
            };
            rim.lift.up >= height.lo && touches.iter().zip(&pushes).any(closes)
        };
        let walled = rims.iter().any(inwards);
        let downhill = downhill(bodies, &touches);
        let ends = sudden && !touching.overlaps();
        Self { touches, pushes, height: Some(height), sudden, walled, ends, downhill }
    }

    /// Which of these touches may carry in a box within theirs, and how; over which h may jump or not.
    pub(super) fn among(
        bodies: &Bodies,
        poses: &PoseBox,
        touches: &[Touch],
        sudden: bool,
        nearby: &mut Nearby<'_>,
    ) -> (Vec<Touch>, Vec<PoseBox>) {
        let touching = Touching::new(bodies, poses);
        let mut touches: Vec<Touch> =
            touches.iter().filter_map(|touch| touching.touch(touch.number)).collect();
        if !sudden && let Some(mid) = nearby.height(&middle(poses)) {
            let mid = Interval::thin(mid).widened(ROUNDING);
            for _ in 0..LOOKS {
                let Some(mean) = mean_value(bodies, poses, mid, &touches) else { break };
                touches.retain(|touch| touch.height.up >= mean.lo);
            }
        }
        let pushes = touches.iter().map(|touch| touch.push(bodies, &touching.over)).collect();
        (touches, pushes)
    }

    /// Which ways motions may go through the faces of its box.
    pub(super) fn flows(&self, bodies: &Bodies, poses: &PoseBox, nearby: &mut Nearby<'_>) -> Flows {
        if self.height.is_none() || self.walled {
            return Flows::ALL;
        }
        let mut flows = Flows::default();
        for dof in bodies.free.iter() {
            let k = dof.index();
            let Interval { lo, up } = poses[k];
            for (upper, at) in [(false, lo), (true, up)] {
                let all = Ways::of(&self.pushes, k);
                let result = if all == Ways::default() || all.is_along() {
                    all
                } else {
                    let mut face = *poses;
                    face[k] = Interval::thin(at);
                    let (_, pushes) = Self::among(bodies, &face, &self.touches, self.sudden, nearby);
                    Ways::of(&pushes, k)
                };
                flows.0[k][usize::from(upper)] = result;
            }
        }
        flows
    }

    /// The bearings that no motion in its box goes back along.
    pub(super) fn rising(&self, bearings: &Bearings) -> Rising {
        if self.height.is_none() || self.walled { 0 } else { bearings.rising(&self.pushes) }
    }

    /// The numbers of all that may carry.
    pub(super) fn numbers(&self) -> Box<[u32]> {
        self.touches.iter().map(|touch| touch.number).collect()
    }
}

/// Whether motions may go down and up an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Ways {
    pub(super) down: bool,
    pub(super) up: bool,
}

impl Ways {
    pub(super) const BOTH: Self = Self { down: true, up: true };

    /// Between all pushes.
    fn of(pushes: &[PoseBox], axis: usize) -> Self {
        // A push of exactly 0 remains 0 beyond a face: it depends on nothing that changes there.
        let may = |sign: f64| {
            pushes.iter().any(|push| push[axis] != Interval::ZERO && (push[axis] * sign).up >= 0.0)
        };
        Self { down: may(-1.0), up: may(1.0) }
    }

    /// Whether motion passes in only one direction.
    const fn is_along(self) -> bool {
        self.down != self.up
    }
}

/// Which ways motions may go through the lower and upper face of every axis of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Flows(pub(super) [[Ways; 2]; 5]);

impl Flows {
    pub(super) const ALL: Self = Self([[Ways::BOTH; 2]; 5]);
}

/// All heights at which something may carry.
fn span(touches: &[Touch]) -> Option<Interval> {
    touches.iter().map(|touch| touch.height).reduce(Interval::hull)
}

/// Bounds on a continuous h from its value at the centre: along the line to any pose its slope is that of a
/// contact, or between those of several.
fn mean_value(bodies: &Bodies, poses: &PoseBox, mid: Interval, touches: &[Touch]) -> Option<Interval> {
    let mut change: Option<Interval> = None;
    for touch in touches {
        let mut own = Interval::ZERO;
        for dof in bodies.free.iter() {
            let errors = poses[dof.index()];
            own = own + touch.slope(dof)? * (errors - Interval::thin(errors.middle()));
        }
        change = Some(change.map_or(own, |all| all.hull(own)));
    }
    change.map(|change| mid + change)
}

/// A corner of one half's rim that may be at the rim of the other.
struct Meet {
    /// At this height of the centre of rotation.
    lift: Interval,
    /// Change of their outward distance in plan view, per unit of each error.
    apart: PoseBox,
    /// The facet that ends at the rim, of the fixed half or the moving half.
    facet: u32,
    of_fixed: bool,
    /// Facets about the corner that lead nowhere but outwards. While the corner is outside nothing of them touches anything of the other facet.
    sheet: Vec<u32>,
}

impl Meet {
    /// Whether the rims may come closer by a push.
    fn closes(&self, push: &PoseBox) -> bool {
        let rate = (0..5).map(|k| self.apart[k] * push[k]).fold(Interval::ZERO, |sum, part| sum + part);
        rate.lo < 0.0
    }

    /// Whether a meeting is between features that lie apart in plan view while the corner is outside.
    fn parts(&self, bodies: &Bodies, meeting: Meeting) -> bool {
        let (rim, other) =
            if self.of_fixed { (&bodies.fixed, &bodies.moving) } else { (&bodies.moving, &bodies.fixed) };
        let corner = |body: &Body, number: u32| body.corners[number as usize].vertex;
        // Of the facet at the rim, and of the sheet.
        let [ends, leads] = match (meeting, self.of_fixed) {
            (Meeting::FacetCorner(facet, c), true) | (Meeting::CornerFacet(c, facet), false) => {
                let c = corner(other, c);
                [facet == self.facet, self.sheet.iter().any(|sheet| other.has_corner(*sheet, c))]
            }
            (Meeting::CornerFacet(c, facet), true) | (Meeting::FacetCorner(facet, c), false) => {
                [rim.has_corner(self.facet, corner(rim, c)), self.sheet.contains(&facet)]
            }
            (Meeting::RidgeRidge(own, its), _) => {
                let (own, its) = if self.of_fixed { (own, its) } else { (its, own) };
                [rim.has_side(self.facet, own), self.sheet.iter().any(|sheet| other.has_side(*sheet, its))]
            }
        };
        ends && leads
    }
}

/// Rims: the edges at which the surface that faces the other half ends in plan view.
struct Rims;

/// A rim in plan view.
struct Rim<'a> {
    ridge: &'a Ridge,
    ends: [[Interval; 2]; 2],
    /// Their heights.
    levels: [Interval; 2],
    /// From its first end to its second, unit in space.
    along: [Interval; 2],
    /// The outward normals, for an outside to its right and to its left, with the facet that ends there.
    outward: [Option<([Interval; 2], u32)>; 2],
}

impl Rims {
    /// All corners that may reach a rim from outside.
    fn meeting(bodies: &Bodies, at: &Placed) -> Vec<Meet> {
        let Bodies { fixed, moving, .. } = bodies;
        // The z component of a facet normal towards the other half.
        let own = |n: DVec3| Interval::thin(n.z);
        let its = |n: DVec3| -dot(&at.rows[2], &thin(n));
        let rims = |body: &Body, facing: &dyn Fn(DVec3) -> Interval| -> Vec<Option<[bool; 2]>> {
            body.ridges.iter().map(|ridge| sides(ridge.normals.map(facing))).collect()
        };
        let (own_sides, its_sides) = (rims(fixed, &own), rims(moving, &its));
        let mut result = Vec::new();
        // Corners of the moving half at rims of the fixed half.
        for (ridge, sides) in fixed.ridges.iter().zip(&own_sides).filter_map(|(r, s)| Some((r, (*s)?))) {
            let [a, b] = ridge.ends.map(|k| fixed.at(k));
            let along = [Interval::thin(ridge.along.x), Interval::thin(ridge.along.y)];
            let right = ending(along, ridge.normals.map(thin));
            let [left_facet, right_facet] = ridge.facets;
            let outward =
                [sides[0].then_some((right[0], left_facet)), sides[1].then_some((right[1], right_facet))];
            let levels = [a, b].map(|end| Interval::thin(end.z));
            let rim = Rim { ridge, ends: [plan(a), plan(b)], levels, along, outward };
            for corner in moving.corners.iter().filter(|c| is_on_rim(c, &its_sides)) {
                let k = corner.vertex as usize;
                let sheet = sheet(corner, its).map(|side| (at.turn(side.along), side.facet));
                rim.meet(at.lateral[k], &sheet, |outward, level, facet, sheet| {
                    let lift = level - at.turned[k][2];
                    let apart = moved(bodies, at, k, outward);
                    result.push(Meet { lift, apart, facet, of_fixed: true, sheet });
                });
            }
        }
        // Corners of the fixed half at rims of the moving half. Seen from below, the sides are swapped.
        for (ridge, sides) in moving.ridges.iter().zip(&its_sides).filter_map(|(r, s)| Some((r, (*s)?))) {
            let [p, q] = ridge.ends.map(|k| k as usize);
            let along = at.turn(ridge.along);
            let along = [along[0], along[1]];
            let [left, right] = ridge.normals.map(|n| at.turn(n));
            let out = ending(along, [right, left]);
            let [left_facet, right_facet] = ridge.facets;
            let outward =
                [sides[1].then_some((out[0], right_facet)), sides[0].then_some((out[1], left_facet))];
            let levels = [p, q].map(|end| at.turned[end][2]);
            let rim = Rim { ridge, ends: [at.lateral[p], at.lateral[q]], levels, along, outward };
            for corner in fixed.corners.iter().filter(|c| is_on_rim(c, &own_sides)) {
                let point = fixed.at(corner.vertex);
                let sheet = sheet(corner, own).map(|side| (thin(side.along), side.facet));
                rim.meet(plan(point), &sheet, |outward, level, facet, sheet| {
                    let lift = Interval::thin(point.z) - level;
                    // As the rim moves inwards, the corner emerges; the velocities at both ends bound all
                    // velocities between.
                    let ends = rim.ridge.ends.map(|k| moved(bodies, at, k as usize, outward));
                    let apart = [0, 1, 2, 3, 4].map(|k| -ends[0][k].hull(ends[1][k]));
                    result.push(Meet { lift, apart, facet, of_fixed: false, sheet });
                });
            }
        }
        result
    }
}

impl Rim<'_> {
    /// How high it is beside a corner that may be at it in plan view.
    fn level(&self, corner: [Interval; 2]) -> Interval {
        let ([a, b], [low, high]) = (self.ends, self.levels);
        let square = |x: Interval| {
            let (near, far) =
                (if x.contains(0.0) { 0.0 } else { x.lo.abs().min(x.up.abs()) }, x.lo.abs().max(x.up.abs()));
            Interval::new((near * near).next_down(), (far * far).next_up())
        };
        let (way, off) = ([0, 1].map(|k| b[k] - a[k]), [0, 1].map(|k| corner[k] - a[k]));
        let share = (way[0] * off[0] + way[1] * off[1]).over(square(way[0]) + square(way[1]));
        let share = share.and_then(|share| share.widened(COINCIDENT).and(Interval::new(0.0, 1.0)));
        low + share.unwrap_or(Interval::new(0.0, 1.0)) * (high - low)
    }

    /// Passes the outward normals by which a corner with facets in these directions may reach this rim from
    /// outside, its height there, the facet that ends there, and the facets of the corner that lead only
    /// outwards.
    fn meet(
        &self,
        corner: [Interval; 2],
        sheet: &(impl Iterator<Item = (Vector, u32)> + Clone),
        mut record: impl FnMut([Interval; 2], Interval, u32, Vec<u32>),
    ) {
        let [a, b] = self.ends;
        let near = |axis: usize| corner[axis].meets(a[axis].hull(b[axis]).widened(COINCIDENT));
        if !near(0) || !near(1) {
            return;
        }
        let beside = perp(self.along, [corner[0] - a[0], corner[1] - a[1]]);
        if beside.lo > COINCIDENT || beside.up < -COINCIDENT {
            return;
        }
        for (outward, facet) in self.outward.into_iter().flatten() {
            let leads = |s: &Vector| s[0] * outward[0] + s[1] * outward[1];
            // If a motion certainly leads inwards, the halves overlap in plan view and continue to overlap.
            if !sheet.clone().any(|(s, _)| leads(&s).up < -PARALLEL) {
                let mut outside: Vec<u32> = sheet.clone().map(|(_, facet)| facet).collect();
                let may_lead_in =
                    |facet: u32| sheet.clone().any(|(s, own)| own == facet && leads(&s).lo < -PARALLEL);
                outside.retain(|facet| !may_lead_in(*facet));
                record(outward, self.level(corner), facet, outside);
            }
        }
    }
}

/// The normals, in plan view, out of a rim to its right and to its left, for the facets with these normals to
/// the left and right, as seen from the viewing side: across the rim, or, for a facet that is certainly a
/// wall, its own. A rim may be upright.
fn ending(along: [Interval; 2], [left, right]: [Vector; 2]) -> [[Interval; 2]; 2] {
    let across = [along[1], -along[0]];
    let is_wall = |n: &Vector| n[2].lo >= -PARALLEL && n[2].up <= PARALLEL;
    let plan = |n: Vector| [n[0], n[1]];
    let to_right = if is_wall(&right) { plan(right) } else { across };
    [to_right, if is_wall(&left) { plan(left) } else { across.map(|x| -x) }]
}

/// Sides, right and left, on which the outside of a ridge may be if its facets, left and right, face the
/// other half by these amounts; `None` if it is not a rim.
fn sides([left, right]: [Interval; 2]) -> Option<[bool; 2]> {
    let ends = |facing: Interval, other: Interval| facing.up > PARALLEL && other.lo <= PARALLEL;
    let sides = [ends(left, right), ends(right, left)];
    (sides[0] || sides[1]).then_some(sides)
}

fn is_on_rim(corner: &Corner, sides: &[Option<[bool; 2]>]) -> bool {
    corner.ridges.iter().any(|ridge| sides[*ridge as usize].is_some())
}

/// Directions of the facets around a corner that certainly face the other half.
fn sheet(corner: &Corner, facing: impl Fn(DVec3) -> Interval + Clone) -> impl Iterator<Item = Side> + Clone {
    corner.sides.iter().filter(move |side| facing(side.normal).lo > PARALLEL).copied()
}

/// Outward motion of a moving vertex, per unit of each error.
fn moved(bodies: &Bodies, at: &Placed, vertex: usize, outward: [Interval; 2]) -> PoseBox {
    let normal = [outward[0], outward[1], Interval::ZERO];
    let torque = super::interval::cross(&at.turned[vertex], &normal);
    at.gap_rates(bodies, &normal, &torque)
}

/// A direction that opens every touch for certain: the shortest vector of the hull of their mean rates, tried on all of their bounds.
fn downhill(bodies: &Bodies, touches: &[Touch]) -> Option<[f64; 5]> {
    let unit: [f64; 5] = Dof::ALL.map(|dof| if ROTATIONS.contains(&dof) { 1.0 / bodies.rho } else { 1.0 });
    let rates: Vec<[f64; 5]> = touches
        .iter()
        .map(|touch| {
            let mean: [f64; 5] = std::array::from_fn(|k| touch.rates[k].middle() * unit[k]);
            let size = mean.iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
            mean.map(|x| x / size)
        })
        .collect();
    let shortest = shortest(&rates)?;
    let direction: [f64; 5] = std::array::from_fn(|k| shortest[k] * unit[k]);
    let opens = |touch: &Touch| {
        let parts = (0..5).map(|k| touch.rates[k] * direction[k]);
        parts.fold(Interval::ZERO, |sum, part| sum + part).lo > 0.0
    };
    touches.iter().all(opens).then_some(direction)
}

/// The shortest vector of the convex hull of some (Gilbert 1966), nearly.
pub(super) fn shortest(vectors: &[[f64; 5]]) -> Option<[f64; 5]> {
    /// Number of steps of the search for a common direction.
    const STEPS: usize = 100;
    let inner = |a: &[f64; 5], b: &[f64; 5]| (0..5).map(|k| a[k] * b[k]).sum::<f64>();
    let mut at = *vectors.first()?;
    for _ in 0..STEPS {
        let least = vectors.iter().min_by(|a, b| inner(&at, a).total_cmp(&inner(&at, b)))?;
        let way: [f64; 5] = std::array::from_fn(|k| at[k] - least[k]);
        let (length, gain) = (inner(&way, &way), inner(&at, &way));
        if gain <= 1e-12 * inner(&at, &at) || length <= 0.0 {
            break;
        }
        let share = (gain / length).min(1.0);
        at = std::array::from_fn(|k| at[k] - share * way[k]);
    }
    Some(at)
}
