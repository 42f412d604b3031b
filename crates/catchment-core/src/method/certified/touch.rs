//! A possible contact of two features over a box of poses: whether it may carry the half, its height, and its
//! push.
//!
//! ```text
//!   plane through the meeting    z = a_z − (R p)_z − n_xy·(lateral(p) − a_xy)/n_z        a fixed, p moving, n the normal
//!   its slope                    ∂z/∂q = −rates/n_z                                      rates: of the gap, at constant height
//!   so over a box around m       z(q) ∈ z(m) + Σ (−rates/n_z)·(q − m)                    mean value form
//! ```
//!
//! The normal of two ridges is their cross product, with either sign; if they may be parallel it lies between
//! the normals of their facets. Only the direction of n matters, so it need not be a unit vector.
//!
//! A contact may carry if the features support the normal, their feet may meet in plan view, and `n_z` may be
//! above 0. All three are tested by bounds, so no carrying contact is missed; contacts that do not carry may
//! remain.

use super::arc::Arc;
use super::body::{Facet, Meeting, Ridge};
use super::interval::{Interval, Vector, cross, dot, perp, thin};
use super::placed::{Bodies, Placed, PoseBox};
use crate::pose::{Dof, ROTATIONS};
use crate::tolerance::{self, PARALLEL};
use glam::DVec3;

/// Sine by which normals of facets, which are rounded, may fail to be supported.
pub(super) const SLACK: f64 = tolerance::PARALLEL;
/// Distance that counts as within a border in plan view, as a multiple of lengths.
const SEAM: f64 = tolerance::ROUNDING;
/// Below this share of its own length a normal's rise gives no mean value form: the division by it would widen
/// intervals a millionfold.
const STEEP: f64 = 1e-6;
/// Slopes that differ by no more are known well enough.
const PRECISE: f64 = 0.05;
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
    /// Change of its gap, per unit of each error.
    pub(super) rates: PoseBox,
    /// Bounds on its plane all over the box, including poses at which the features do not meet; `None`
    /// without such bounds.
    pub(super) plane: Option<Whole>,
}

/// The plane of a meeting: the closing of its extended features.
#[derive(Debug, Clone, Copy)]
pub(super) struct Whole {
    /// The height in the middle of the box at which they do, in D.
    pub(super) middle: Interval,
    /// Change of the gap between them, per unit of each error.
    pub(super) rates: PoseBox,
}

impl Touch {
    /// ∂z/∂q, if the normal certainly points up.
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
        at.closing(&self.normal, self.fixed, self.moving as usize)
    }
}

impl Placed {
    /// Height of the centre of rotation at which a moving vertex reaches a plane through a fixed point.
    pub(super) fn closing(&self, [x, y, z]: &Vector, point: DVec3, vertex: usize) -> Option<Interval> {
        let lateral = self.lateral[vertex];
        let across =
            *x * (lateral[0] - Interval::thin(point.x)) + *y * (lateral[1] - Interval::thin(point.y));
        let foot = Interval::thin(point.z) - self.turned[vertex][2];
        // Levels of facets are those of single corners, which are rounded.
        across.over(*z).map(|fall| (foot - fall).widened(SEAM))
    }
}

/// The moving half over a box and at its centre, for queries about meetings.
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

    /// Whether the halves certainly overlap in plan view at every pose of the box: a vertex of one lies over
    /// a facet of the other.
    pub(super) fn overlaps(&self) -> bool {
        let Bodies { fixed, moving, .. } = self.bodies;
        let over =
            |facet: &Facet| facet.corners.iter().map(|k| self.over.lateral[*k as usize]).collect::<Vec<_>>();
        let under = |facet: &Facet| facet.corners.iter().map(|k| plan(fixed.at(*k))).collect::<Vec<_>>();
        fixed
            .facets
            .iter()
            .map(under)
            .any(|polygon| self.over.lateral.iter().any(|foot| holds(&polygon, *foot)))
            || moving
                .facets
                .iter()
                .map(over)
                .any(|polygon| fixed.vertices.iter().any(|v| holds(&polygon, plan(*v))))
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
        let arm = |height| self.over.arm_to(self.bodies, thin(point), height);
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
        // Parallel in plan view, as `contact::brute` has it.
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
        let (beyond, on_ridge) = (arm_at(reach), arm_at(on_its));
        // The same point, of the fixed ridge.
        let point = [0, 1, 2].map(|k| Interval::thin(a.to_array()[k]) + on_own * u.to_array()[k]);
        let arm = |height: Interval| {
            let other = self.over.arm_to(bodies, point, height);
            [0, 1, 2].map(|k| on_ridge[k].and(other[k].widened(SEAM)).unwrap_or(on_ridge[k]))
        };
        let plane = |at: &Placed| {
            let along = at.turn(bodies.moving.at(its.ends[1]) - bodies.moving.at(its.ends[0]));
            let across = cross(&thin(u), &along);
            let up = if across[2].up < 0.0 { across.map(|x| -x) } else { across };
            Plane { normal: up, fixed: a, moving: its.ends[0] }
        };
        let planar = straight.then_some(plane);
        let result = match planar {
            Some(plane) => self.touch_by(number, plane, among, |_| beyond, arm)?,
            None => self.touch_with(number, normal, among, arm),
        };
        // For nearly parallel lines the cross product is imprecise; their facets bound the normal better.
        let arc = (spread(&result.normal) > PRECISE).then(|| Arc::of(own)).flatten();
        let Some(arc) = arc.map(|arc| arc.normal(its, &self.over)) else { return Some(result) };
        let arc = arc.filter(|normal| normal[2].up > 0.0)?;
        Some(if spread(&arc) < spread(&result.normal) {
            self.touch_with(number, arc, result.height, arm)
        } else {
            result
        })
    }

    /// The normal of two ridges if they support it, or bounds on it; upwards.
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

    /// A contact whose plane is known at any pose: its heights are the intersection of those `among` the
    /// features and those of the plane. `arm` leads to the meeting of the features, `beyond` to that of their
    /// planes and lines.
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
        // Height of the plane regardless of where the feet are: the slope follows from it.
        let natural = over.height(&self.over)?;
        let whole = self.touch_with(number, normal, natural, beyond);
        let in_middle = plane(&self.middle).height(&self.middle)?;
        let mut mean = in_middle;
        for dof in self.bodies.free.iter() {
            let poses = self.poses[dof.index()];
            mean = mean + whole.slope(dof)? * (poses - Interval::thin(poses.middle()));
        }
        let height = natural.and(among)?.and(mean)?;
        let plane = Some(Whole { middle: in_middle, rates: whole.rates });
        Some(Touch { plane, ..self.touch_with(number, normal, height, arm) })
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
        Touch { number, height, rise: normal[2], normal, torque, rates, plane: None }
    }
}

impl Touch {
    /// The direction in which it alone pushes the half: errors per unit of its normal.
    ///
    /// ```text
    ///   ċ = n_xy     ω = ρ⁻²·torque, of locked rotations its part along the free axes     (x, y)˙ = ċ + ω × face
    /// ```
    pub(super) fn push(&self, bodies: &Bodies, at: &Placed) -> PoseBox {
        let mut way = [Interval::ZERO; 5];
        for (axis, way) in way.iter_mut().enumerate().take(2) {
            if bodies.slides(axis) {
                *way = self.normal[axis];
            }
        }
        let scaled = |torque: Interval| {
            let rate = torque * (1.0 / (bodies.rho * bodies.rho));
            rate.widened(f64::EPSILON * (rate.lo.abs() + rate.up.abs()))
        };
        if bodies.free.rotations() == 3 {
            // Any axis of the world; the angles follow.
            let spin = self.torque.map(scaled);
            let swung = cross(&spin, &at.face);
            for axis in 0..2 {
                if bodies.slides(axis) {
                    way[axis] = way[axis] + swung[axis];
                }
            }
            let [roll, pitch, yaw] = at.angle_rates(&spin);
            (way[2], way[3], way[4]) = (roll, pitch, yaw);
            return way;
        }
        for (k, dof) in ROTATIONS.into_iter().enumerate() {
            if bodies.free.contains(dof) {
                let rate = scaled(dot(&at.axes[k], &self.torque));
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

/// How much the slopes of a normal may differ.
fn spread(normal: &Vector) -> f64 {
    let slope = |axis: usize| normal[axis].over(normal[2]).map_or(f64::INFINITY, Interval::width);
    slope(0).max(slope(1))
}

/// A point of the fixed half in plan view.
pub(super) fn plan(point: DVec3) -> [Interval; 2] {
    [Interval::thin(point.x), Interval::thin(point.y)]
}

/// From one point to another in plan view.
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

/// Whether a point lies in a convex polygon for certain, whichever way it runs.
pub(super) fn holds(polygon: &[[Interval; 2]], point: [Interval; 2]) -> bool {
    let n = polygon.len();
    let beside = |k: usize| {
        let (a, b) = (polygon[k], polygon[(k + 1) % n]);
        perp(from(a, b), from(a, point))
    };
    (0..n).all(|k| beside(k).lo > SEAM) || (0..n).all(|k| beside(k).up < -SEAM)
}

/// Heights at which two nearly parallel ridges may touch in plan view, if their common extent along their
/// direction is known. At any pose the height is linear along it.
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

/// All unit normals between two: the chord, and the bulge of the arc beyond it.
fn between([a, b]: [Vector; 2]) -> Vector {
    let cosine = dot(&a, &b).lo;
    if cosine < OPPOSED {
        return [Interval::new(-1.0 - SLACK, 1.0 + SLACK); 3];
    }
    // A chord is nowhere shorter than the cosine of half the angle.
    let bulge = Interval::new(1.0, (1.0 / f64::midpoint(1.0, cosine.min(1.0)).sqrt()).next_up());
    [0, 1, 2].map(|k| (a[k].hull(b[k]) * bulge).widened(SLACK))
}
