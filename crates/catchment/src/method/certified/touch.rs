//! One meeting of two features over a box of poses: whether it may carry the half there, how high, and how it pushes.
//!
//! ```text
//!   plane through the meeting    z = a_z − (R p)_z − n_xy·(lateral(p) − a_xy)/n_z        a fixed, p moving, n the normal
//!   its slope                    ∂z/∂q = −rates/n_z                                      rates: of the gap, at constant height
//!   so over a box around m       z(q) ∈ z(m) + Σ (−rates/n_z)·(q − m)                    mean value form
//! ```
//!
//! The normal of two ridges is their cross product, of either sense; where they may be parallel it is what lies between the normals of
//! their facets. Only the direction of n matters, so it need not be unit.
//!
//! May carry: the features support the normal, their feet may meet in plan view, and `n_z` may be above 0. All three are judged by bounds,
//! so nothing that carries is left out; what does not carry may be left in.

use super::body::{Meeting, Ridge};
use super::interval::{Interval, Vector, cross, dot, perp, thin};
use super::placed::{Bodies, Placed, PoseBox};
use crate::pose::{Dof, ROTATIONS};
use glam::DVec3;

/// Sine by which normals of facets, which are rounded, may fail to be supported.
const SLACK: f64 = 1e-9;
/// What counts as within a border in plan view, as a multiple of lengths.
const SEAM: f64 = 1e-12;
/// Below this part of its own length a normal's rise gives no mean value form.
const STEEP: f64 = 1e-6;
/// Sine below which ridges count as parallel in plan view, as [`crate::contact::brute`] has it.
const PARALLEL: f64 = 1e-9;
/// Normals of two facets with a smaller cosine have no mean direction to speak of.
const OPPOSED: f64 = -0.9;

/// A meeting that may carry the half somewhere in a box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    /// Its number among [`Bodies::meetings`].
    pub(super) number: u32,
    /// Heights of the centre of rotation at which it may carry, in D.
    pub(super) height: Interval,
    /// Rise of its normal.
    pub(super) rise: Interval,
    /// Normal, any length.
    pub(super) normal: Vector,
    /// Its moment about the centre of rotation.
    pub(super) torque: Vector,
    /// What its gap changes by, per unit of each error.
    pub(super) rates: PoseBox,
}

impl Touch {
    /// ∂z/∂q, where the normal rises for certain.
    pub(super) fn slope(&self, dof: Dof) -> Option<Interval> {
        (-self.rates[dof.index()]).over(self.rise)
    }
}

/// A plane through a meeting.
struct Plane {
    normal: Vector,
    /// A point of each half on it.
    fixed: DVec3,
    moving: u32,
}

impl Plane {
    /// Height of the centre of rotation with the meeting closed.
    fn height(&self, at: &Placed) -> Option<Interval> {
        let [x, y, z] = self.normal;
        let lateral = at.lateral[self.moving as usize];
        let across =
            x * (lateral[0] - Interval::thin(self.fixed.x)) + y * (lateral[1] - Interval::thin(self.fixed.y));
        let foot = Interval::thin(self.fixed.z) - at.turned[self.moving as usize][2];
        // Levels of facets are those of single corners, which are rounded.
        across.over(z).map(|fall| (foot - fall).widened(SEAM))
    }
}

/// The moving half over a box and in its middle, asked for meetings.
pub(super) struct Touching<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) poses: &'a PoseBox,
    pub(super) over: Placed,
    pub(super) middle: Placed,
}

impl<'a> Touching<'a> {
    pub(super) fn new(bodies: &'a Bodies, poses: &'a PoseBox) -> Self {
        let middle = poses.map(|p| Interval::thin(p.middle()));
        Self { bodies, poses, over: Placed::new(bodies, poses), middle: Placed::new(bodies, &middle) }
    }

    /// How a meeting may carry the half in the box, if it may.
    pub(super) fn touch(&self, number: u32) -> Option<Touch> {
        match self.bodies.meetings[number as usize] {
            Meeting::FacetCorner(facet, corner) => self.on_facet(number, facet, corner),
            Meeting::CornerFacet(corner, facet) => self.under_facet(number, corner, facet),
            Meeting::RidgeRidge(fixed, moving) => self.on_ridge(number, fixed, moving),
        }
    }

    fn on_facet(&self, number: u32, facet: u32, corner: u32) -> Option<Touch> {
        let Bodies { fixed, moving, .. } = self.bodies;
        let (facet, corner) = (&fixed.facets[facet as usize], &moving.corners[corner as usize]);
        let normal = thin(facet.normal);
        if corner.spokes.iter().any(|s| dot(&normal, &self.over.turn(*s)).up < -SLACK) {
            return None;
        }
        let foot = self.over.lateral[corner.vertex as usize];
        let polygon = facet.corners.iter().map(|k| plan(fixed.at(*k)));
        if !may_hold(polygon, foot, 1.0) {
            return None;
        }
        let levels = range(facet.corners.iter().map(|k| Interval::thin(fixed.at(*k).z)))?;
        let arm = self.over.turned[corner.vertex as usize];
        let among = levels - arm[2];
        let plane = |_: &Placed| Plane { normal, fixed: fixed.at(facet.corners[0]), moving: corner.vertex };
        self.touch_by(number, plane, among, |_| arm, |_| arm)
    }

    fn under_facet(&self, number: u32, corner: u32, facet: u32) -> Option<Touch> {
        let Bodies { fixed, moving, .. } = self.bodies;
        let (corner, facet) = (&fixed.corners[corner as usize], &moving.facets[facet as usize]);
        let normal = self.over.turn(-facet.normal);
        if normal[2].up <= 0.0 || corner.spokes.iter().any(|s| dot(&normal, &thin(*s)).lo > SLACK) {
            return None;
        }
        let point = fixed.at(corner.vertex);
        let polygon = facet.corners.iter().map(|k| self.over.lateral[*k as usize]);
        if !may_hold(polygon, plan(point), -1.0) {
            return None;
        }
        let among =
            Interval::thin(point.z) - range(facet.corners.iter().map(|k| self.over.turned[*k as usize][2]))?;
        let plane =
            |at: &Placed| Plane { normal: at.turn(-facet.normal), fixed: point, moving: facet.corners[0] };
        let arm = |height| self.over.arm_to(self.bodies, point, height);
        self.touch_by(number, plane, among, arm, arm)
    }

    fn on_ridge(&self, number: u32, fixed: u32, moving: u32) -> Option<Touch> {
        let bodies = self.bodies;
        let (own, its) = (&bodies.fixed.ridges[fixed as usize], &bodies.moving.ridges[moving as usize]);
        let [a, b] = own.ends.map(|k| bodies.fixed.at(k));
        let [p, q] = its.ends.map(|k| self.over.lateral[k as usize]);
        if !may_cross([plan(a), plan(b)], [p, q]) {
            return None;
        }
        let normal = self.normal_of(own, its)?;
        let (u, w) = (b - a, bodies.moving.at(its.ends[1]) - bodies.moving.at(its.ends[0]));
        let w = self.over.turn(w);
        let turn = perp([Interval::thin(u.x), Interval::thin(u.y)], [w[0], w[1]]);
        let lengths = u.truncate().length() * its_length(&w);
        if turn.lo.abs().max(turn.up.abs()) <= PARALLEL * lengths {
            return None; // in plan view parallel all over the box: their ends speak for them
        }
        let apart = [p[0] - Interval::thin(a.x), p[1] - Interval::thin(a.y)];
        let share = |along: [Interval; 2]| perp(apart, along).over_signed(turn);
        let unit = Interval::new(0.0, 1.0);
        let [s, t] = [share([w[0], w[1]]), share([Interval::thin(u.x), Interval::thin(u.y)])];
        let within = |share: Option<Interval>| share.map_or(Some(unit), |k| k.widened(SEAM).and(unit));
        let (on_own, on_its) = (within(s)?, within(t)?);
        let start = self.over.turned[its.ends[0] as usize];
        let mut among = Interval::thin(a.z) + on_own * u.z - (start[2] + on_its * w[2]);
        let straight = turn.lo > 0.0 || turn.up < 0.0;
        if !straight && let Some(along) = beside([a, b], p, start[2], &w) {
            among = among.and(along)?;
        }
        // The plane and its slope hold along the whole lines, beyond the ends of the ridges.
        let reach = t.filter(|_| straight).unwrap_or(unit);
        let arm_at = |share: Interval| [0, 1, 2].map(|k| start[k] + share * w[k]);
        let (beyond, arm) = (arm_at(reach), arm_at(on_its));
        let plane = |at: &Placed| {
            let along = at.turn(bodies.moving.at(its.ends[1]) - bodies.moving.at(its.ends[0]));
            let across = cross(&thin(u), &along);
            let up = if across[2].up < 0.0 { across.map(|x| -x) } else { across };
            Plane { normal: up, fixed: a, moving: its.ends[0] }
        };
        let planar = straight.then_some(plane);
        let found = match planar {
            Some(plane) => self.touch_by(number, plane, among, |_| beyond, |_| arm)?,
            None => self.touch_with(number, normal, among, |_| arm),
        };
        Some(found)
    }

    /// The normal of two ridges where they support it, or what it lies in; upwards.
    fn normal_of(&self, own: &Ridge, its: &Ridge) -> Option<Vector> {
        let w = self.over.turn(its.along);
        let u = thin(own.along);
        let normals = its.normals.map(|n| self.over.turn(n));
        let [left, right] = own.normals.map(|n| dot(&w, &thin(n)));
        let [port, starboard] = normals.map(|n| dot(&u, &n));
        let supports = |parts: [Interval; 4]| parts.iter().all(|part| part.lo <= SLACK);
        let (up, down) = ([-left, right, -port, starboard], [left, -right, port, -starboard]);
        let across = cross(&u, &w);
        let rises = supports(up) && across[2].up > 0.0;
        let falls = supports(down) && across[2].lo < 0.0;
        match (rises, falls) {
            (false, false) => None,
            (true, false) if across[2].lo > 0.0 => Some(across),
            (false, true) if across[2].up < 0.0 => Some(across.map(|x| -x)),
            _ => {
                let own = between(own.normals.map(thin));
                let its = between(normals.map(|n| n.map(|x| -x)));
                let mut both = [Interval::ZERO; 3];
                for (k, part) in both.iter_mut().enumerate() {
                    *part = own[k].and(its[k])?;
                }
                (both[2].up > 0.0).then_some(both)
            }
        }
    }

    /// A touch by a plane that is known at any pose: its heights are those `among` which the features are and those of the plane. `arm` leads
    /// to where the features meet, `beyond` to where their planes and lines do.
    fn touch_by(
        &self,
        number: u32,
        plane: impl Fn(&Placed) -> Plane,
        among: Interval,
        beyond: impl Fn(Interval) -> Vector,
        arm: impl Fn(Interval) -> Vector,
    ) -> Option<Touch> {
        let among = among.widened(SEAM);
        let over = plane(&self.over);
        let size = over.normal.iter().map(|n| n.lo.abs().max(n.up.abs())).fold(0.0, f64::max);
        let normal = over.normal;
        if normal[2].lo <= STEEP * size {
            return (normal[2].up > 0.0).then(|| self.touch_with(number, normal, among, arm));
        }
        // Of the plane, wherever its feet are: what its slope is taken from.
        let natural = over.height(&self.over)?;
        let whole = self.touch_with(number, normal, natural, beyond);
        let mut mean = plane(&self.middle).height(&self.middle)?;
        for dof in self.bodies.free.iter() {
            let poses = self.poses[dof.index()];
            mean = mean + whole.slope(dof)? * (poses - Interval::thin(poses.middle()));
        }
        let height = natural.and(among)?.and(mean)?;
        Some(self.touch_with(number, normal, height, arm))
    }

    fn touch_with(
        &self,
        number: u32,
        normal: Vector,
        height: Interval,
        arm: impl Fn(Interval) -> Vector,
    ) -> Touch {
        let normal = [normal[0], normal[1], Interval::new(normal[2].lo.max(0.0), normal[2].up)];
        let torque = cross(&arm(height), &normal);
        let rates = self.over.gap_rates(self.bodies, &normal, &torque);
        Touch { number, height, rise: normal[2], normal, torque, rates }
    }
}

impl Touch {
    /// The direction in which it alone pushes the half: errors per unit of its normal, where at most one rotation is free.
    ///
    /// ```text
    ///   ċ = n_xy     ω = ρ⁻²·(torque·axis)·axis     (x, y)˙ = ċ + ω × face
    /// ```
    pub(super) fn push(&self, bodies: &Bodies, at: &Placed) -> PoseBox {
        let mut way = [Interval::ZERO; 5];
        for (axis, way) in way.iter_mut().enumerate().take(2) {
            if bodies.slides(axis) {
                *way = self.normal[axis];
            }
        }
        for (k, dof) in ROTATIONS.into_iter().enumerate() {
            if bodies.free.contains(dof) {
                let rate = dot(&at.axes[k], &self.torque) * (1.0 / (bodies.rho * bodies.rho));
                let rate = rate.widened(f64::EPSILON * (rate.lo.abs() + rate.up.abs()));
                let swing = cross(&at.axes[k], &at.face);
                for axis in 0..2 {
                    if bodies.slides(axis) {
                        way[axis] = way[axis] + rate * swing[axis];
                    }
                }
                way[dof.index()] = rate;
            }
        }
        way
    }
}

/// A point of the fixed half in plan view.
pub(super) fn plan(point: DVec3) -> [Interval; 2] {
    [Interval::thin(point.x), Interval::thin(point.y)]
}

/// From one to the other in plan view.
fn from(a: [Interval; 2], b: [Interval; 2]) -> [Interval; 2] {
    [b[0] - a[0], b[1] - a[1]]
}

/// Whether a point may lie in a convex polygon, which runs counter-clockwise (`turn` 1) or clockwise (−1) as seen from above.
fn may_hold(polygon: impl Iterator<Item = [Interval; 2]>, point: [Interval; 2], turn: f64) -> bool {
    let polygon: Vec<[Interval; 2]> = polygon.collect();
    let n = polygon.len();
    (0..n).all(|k| {
        let (a, b) = (polygon[k], polygon[(k + 1) % n]);
        (perp(from(a, b), from(a, point)) * turn).up >= -SEAM
    })
}

/// Heights at which two ridges may touch that are nearly parallel in plan view, where what they share of their common direction is known.
/// At any pose the height is linear along it.
fn beside([a, b]: [DVec3; 2], p: [Interval; 2], level: Interval, w: &Vector) -> Option<Interval> {
    let u = b - a;
    let length = u.truncate().length();
    let unit = u.truncate().try_normalize()?;
    let onto = |v: [Interval; 2]| v[0] * unit.x + v[1] * unit.y;
    let (first, reach) = (onto(from(plan(a), p)), onto([w[0], w[1]]));
    let rise = w[2].over_signed(reach)?;
    let its = first.hull(first + reach);
    let shared = its.widened(SEAM).and(Interval::new(0.0, length))?;
    let at = |l: f64| {
        let own = Interval::thin(a.z) + Interval::thin(l) * (u.z / length);
        (own - (level + (Interval::thin(l) - first) * rise)).widened(SEAM)
    };
    Some(at(shared.lo).hull(at(shared.up)))
}

/// The greatest length that a vector may have in plan view.
fn its_length(w: &Vector) -> f64 {
    let most = |x: Interval| x.lo.abs().max(x.up.abs());
    most(w[0]).hypot(most(w[1]))
}

/// Whether two segments may cross or touch in plan view.
fn may_cross([a, b]: [[Interval; 2]; 2], [p, q]: [[Interval; 2]; 2]) -> bool {
    let over = |axis: usize| a[axis].hull(b[axis]).widened(SEAM).meets(p[axis].hull(q[axis]));
    let parted = |a: [Interval; 2], b: [Interval; 2], p: [Interval; 2], q: [Interval; 2]| {
        let (along, one, other) = (from(a, b), from(a, p), from(a, q));
        let (one, other) = (perp(along, one), perp(along, other));
        one.lo > SEAM && other.lo > SEAM || one.up < -SEAM && other.up < -SEAM
    };
    over(0) && over(1) && !parted(a, b, p, q) && !parted(p, q, a, b)
}

/// The hull of some numbers.
fn range(mut numbers: impl Iterator<Item = Interval>) -> Option<Interval> {
    let first = numbers.next()?;
    Some(numbers.fold(first, Interval::hull))
}

/// All unit normals between two: the chord, and what the arc bulges beyond it.
fn between([a, b]: [Vector; 2]) -> Vector {
    let cosine = dot(&a, &b).lo;
    if cosine < OPPOSED {
        return [Interval::new(-1.0 - SLACK, 1.0 + SLACK); 3];
    }
    // A chord is nowhere shorter than the cosine of half the angle.
    let bulge = Interval::new(1.0, (1.0 / f64::midpoint(1.0, cosine.min(1.0)).sqrt()).next_up());
    [0, 1, 2].map(|k| (a[k].hull(b[k]) * bulge).widened(SLACK))
}
