//! The ONAA of translations alone: the largest axis-parallel square inside the accepted offsets.
//!
//! ```text
//!        ╱╲              r(p) = distance, in the maximum norm, from p to the border of the region
//!      ╱┌──┐╲            e    = 2 · max r(p) over the region          in D
//!     ╱ │p │ ╲
//!      ╲└──┘╱            The square has edge e and its middle at p, which need not be zero.
//!        ╲╱
//! ```
//!
//! The region is a tiling; its border consists of the edges without a neighbour. The distance to a segment of
//! the border is convex, and linear in all but six fans of directions around it. Branch and bound over boxes
//! of p: if every relevant segment is linear, the optimum of the box is a linear programme, solved exactly;
//! other boxes are quartered. So the edge is exact to [`Square::TOLERANCE`] for the tiling as given, and
//! ridges along which the square may slide cost no more than points.
//!
//! In one dimension the square is the interval itself. For a cone, [`circle_square`] gives bounds on the edge
//! for the round shape.
//!
//! Not promised: which of several largest squares is returned; it is the square around zero if that is among
//! them. Source: the dissertation, section 2.2.2 (ONAA) and 4.1.2, with the edge in D and not as a share of
//! an error box.

use super::cells::clip;
use super::{Zraa, circle_bounds};
use crate::design::Design;
use crate::exec::{Cancelled, Exec};
use glam::DVec2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// Sides closer to each other than this, in D, are the two sides of a seam; gaps below it are closed. Above
/// the slivers that cutting removes.
const JOIN: f64 = 1e-9;
/// The same in seams of a region that was cut with coarse seams: the slivers removed by cutting are some tens
/// of seams wide.
const SEAMS: f64 = 40.0;
/// Slack of comparisons, in D: a few roundings of numbers of the order of 1.
const ROUNDING: f64 = 1e-13;

/// The largest axis-parallel square in the accepted offsets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AcceptedSquare {
    /// Its edge, in D; 0 if nothing is accepted.
    pub edge: f64,
    /// Its middle, in D.
    pub center: DVec2,
    /// Edge of the largest square centred on zero, in D.
    pub centered_edge: f64,
}

impl AcceptedSquare {
    /// Largest error of the edge relative to that of the tiling, in D; for a region with coarse seams, some
    /// tens of seams.
    pub const TOLERANCE: f64 = 1e-8;

    /// The square of a zero-rotation area of acceptance; of an interval, the interval.
    ///
    /// # Errors
    /// If it is cancelled.
    pub fn of(zraa: &Zraa, exec: &Exec) -> Result<Self, Cancelled> {
        match zraa {
            Zraa::Interval { axis, from, to } => {
                let along = if *axis == crate::pose::Dof::Y { DVec2::Y } else { DVec2::X };
                let centered_edge = 2.0 * to.min(-from).max(0.0);
                Ok(Self { edge: to - from, center: along * (from + to) / 2.0, centered_edge })
            }
            Zraa::Region { polygons, seam, .. } => Search::new(polygons, JOIN.max(SEAMS * seam)).run(exec),
        }
    }

    /// The square within convex polygons, counter-clockwise, that do not overlap.
    ///
    /// # Errors
    /// If it is cancelled.
    pub fn within(polygons: &[Vec<DVec2>], exec: &Exec) -> Result<Self, Cancelled> {
        Search::new(polygons, JOIN).run(exec)
    }
}

/// Lower and upper bound of the edge for the round cone, from that of the polygon that stands for it; `None` for other designs.
///
/// The circle lies between the inscribed polygon and the same polygon enlarged by 1/(1 − e/R), and so do their squares: e is the chord
/// error and R the radius.
pub fn circle_square(design: &Design, zraa: &Zraa, square: &AcceptedSquare) -> Option<[f64; 2]> {
    let [lower, upper] = circle_bounds(design, zraa)?;
    let enlarged = match zraa {
        Zraa::Interval { .. } => upper / lower,
        Zraa::Region { .. } => (upper / lower).sqrt(),
    };
    Some([square.edge, square.edge * enlarged])
}

/// A linear function of the place.
#[derive(Debug, Clone, Copy)]
struct Plane {
    gradient: DVec2,
    offset: f64,
}

impl Plane {
    fn at(&self, p: DVec2) -> f64 {
        self.gradient.dot(p) + self.offset
    }
}

/// A segment of the border.
///
/// A square around p is clear of it if an axis of the picture, or the segment's own normal, separates the
/// two: its distance is the maximum of six linear functions.
#[derive(Debug, Clone, Copy)]
struct Stretch([Plane; 6]);

impl Stretch {
    fn new(a: DVec2, b: DVec2) -> Self {
        let (low, high) = (a.min(b), a.max(b));
        let normal = (b - a).perp();
        // The half edge that reaches a distance d along n is d / (|nx| + |ny|).
        let normal = normal / normal.abs().element_sum();
        let plane = |gradient: DVec2, offset| Plane { gradient, offset };
        Self([
            plane(-DVec2::X, low.x),
            plane(DVec2::X, -high.x),
            plane(-DVec2::Y, low.y),
            plane(DVec2::Y, -high.y),
            plane(normal, -normal.dot(a)),
            plane(-normal, normal.dot(a)),
        ])
    }

    fn distance(&self, p: DVec2) -> f64 {
        self.0.iter().map(|plane| plane.at(p)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The single linear function that equals the distance all over a box, if there is one. Convexity and
    /// equality at the corners imply equality inside.
    fn linear(&self, middle: DVec2, corners: &[DVec2; 4]) -> Option<Plane> {
        let plane = *self.0.iter().max_by(|a, b| a.at(middle).total_cmp(&b.at(middle)))?;
        corners.iter().all(|&c| plane.at(c) >= self.distance(c) - ROUNDING).then_some(plane)
    }
}

/// The polygons of the region, and its border.
struct Search<'a> {
    polygons: &'a [Vec<DVec2>],
    index: RTree<Indexed>,
    border: Vec<Stretch>,
    /// Sides closer to each other than this are the two sides of a seam.
    join: f64,
    low: DVec2,
    high: DVec2,
}

type Indexed = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// Boxes of positions that are still to be examined.
struct SearchSquare {
    middle: DVec2,
    half: f64,
    /// Stretches that may be the nearest of some place in it.
    near: Vec<u32>,
}

/// The best place so far, and half the edge there.
#[derive(Clone, Copy)]
struct Best {
    at: DVec2,
    half_edge: f64,
}

impl Best {
    fn offer(&mut self, at: DVec2, half_edge: f64) {
        if half_edge > self.half_edge {
            *self = Self { at, half_edge };
        }
    }
}

impl<'a> Search<'a> {
    fn new(polygons: &'a [Vec<DVec2>], join: f64) -> Self {
        let boxed = |(k, polygon): (usize, &Vec<DVec2>)| {
            let (low, high) = bounds(polygon);
            GeomWithData::new(Rectangle::from_corners(low.to_array(), high.to_array()), k)
        };
        let index = RTree::bulk_load(polygons.iter().enumerate().map(boxed).collect());
        let (low, high) = bounds(polygons.iter().flatten());
        let mut search = Self { polygons, index, border: Vec::new(), join, low, high };
        for k in 0..polygons.len() {
            search.border_of(k);
        }
        search
    }

    /// Polygons whose boxes are within a seam of this polygon.
    fn around(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = usize> + '_ {
        let boxed = AABB::from_corners((low - self.join).to_array(), (high + self.join).to_array());
        self.index.locate_in_envelope_intersecting(boxed).map(|result| result.data)
    }

    /// Adds the portions of a polygon's sides without a neighbour.
    fn border_of(&mut self, own: usize) {
        for [from, to] in sides(&self.polygons[own]) {
            let length = from.distance(to);
            if length <= self.join {
                continue;
            }
            let along = (to - from) / length;
            let mut covered: Vec<[f64; 2]> = Vec::new();
            for k in self.around(from.min(to), from.max(to)).filter(|&k| k != own) {
                covered.extend(
                    sides(&self.polygons[k]).filter_map(|side| beside(side, from, along, length, self.join)),
                );
            }
            covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
            covered.push([length, length]);
            let mut reached = 0.0;
            for [start, end] in covered {
                if start - reached > self.join {
                    self.border.push(Stretch::new(from + along * reached, from + along * start));
                }
                reached = end.max(reached);
            }
        }
    }

    /// Whether a place is accepted, or on a seam.
    fn holds(&self, p: DVec2) -> bool {
        let inside = |polygon: &[DVec2]| {
            sides(polygon).all(|[a, b]| (b - a).perp_dot(p - a) >= -self.join * (b - a).length())
        };
        self.around(p, p).any(|k| inside(&self.polygons[k]))
    }

    fn run(&self, exec: &Exec) -> Result<AcceptedSquare, Cancelled> {
        let all: Vec<u32> = (0..self.border.len() as u32).collect();
        let mut best = Best { at: DVec2::ZERO, half_edge: 0.0 };
        if self.holds(DVec2::ZERO) {
            best.half_edge = self.distance(&all, DVec2::ZERO);
        }
        let centered_edge = 2.0 * best.half_edge;
        let middle = self.low.midpoint(self.high);
        let mut open = Vec::new();
        if !all.is_empty() {
            open.push(SearchSquare { middle, half: (self.high - middle).max_element(), near: all });
        }
        while let Some(place) = open.pop() {
            exec.check()?;
            open.extend(self.look(&place, &mut best));
        }
        Ok(AcceptedSquare { edge: 2.0 * best.half_edge, center: best.at, centered_edge })
    }

    fn distance(&self, near: &[u32], p: DVec2) -> f64 {
        near.iter().map(|&k| self.border[k as usize].distance(p)).fold(f64::INFINITY, f64::min)
    }

    /// Examines the positions of a box; returns its remaining quarters, the most promising last, or nothing.
    fn look(&self, place: &SearchSquare, best: &mut Best) -> Vec<SearchSquare> {
        // Half of the edge's tolerance for the half edge, and the rest for seams.
        const ENOUGH: f64 = AcceptedSquare::TOLERANCE / 4.0;
        let SearchSquare { middle, half, .. } = *place;
        let corners = corners(middle, half);
        let most = |stretch: &Stretch| corners.iter().map(|&c| stretch.distance(c)).fold(0.0, f64::max);
        let stretches = || place.near.iter().map(|&k| (k, &self.border[k as usize]));
        // No place of the box is farther from the border than this.
        let cap = stretches().map(|(_, s)| most(s)).fold(f64::INFINITY, f64::min);
        if cap <= best.half_edge + ENOUGH {
            return Vec::new();
        }
        let near: Vec<u32> =
            stretches().filter(|(_, s)| s.distance(middle) - half <= cap).map(|(k, _)| k).collect();
        let here = self.distance(&near, middle);
        let accepted = self.holds(middle);
        if here > half && !accepted {
            // No border runs through the box: all of it is refused.
            return Vec::new();
        }
        if accepted {
            best.offer(middle, here);
        }
        let planes: Vec<Plane> =
            near.iter().filter_map(|&k| self.border[k as usize].linear(middle, &corners)).collect();
        let (at, bound) = highest(&planes, middle, &corners, cap);
        if self.holds(at) {
            best.offer(at, self.distance(&near, at));
        }
        if bound <= best.half_edge + ENOUGH {
            return Vec::new();
        }
        let half = half / 2.0;
        let mut quarters: Vec<(f64, SearchSquare)> = self::corners(middle, half)
            .into_iter()
            .map(|middle| (self.distance(&near, middle), SearchSquare { middle, half, near: near.clone() }))
            .collect();
        quarters.sort_by(|a, b| a.0.total_cmp(&b.0));
        quarters.into_iter().map(|(_, quarter)| quarter).collect()
    }
}

/// Position in a box at which the minimum of the planes and the cap is highest, and its height. Plane after
/// plane is added: a plane that cuts off the best position so far contains the next.
fn highest(planes: &[Plane], middle: DVec2, corners: &[DVec2; 4], cap: f64) -> (DVec2, f64) {
    let (mut at, mut top) = (middle, cap);
    for (k, plane) in planes.iter().enumerate() {
        if plane.at(at) >= top {
            continue;
        }
        let mut part = clip(corners, |p| cap - plane.at(p) + ROUNDING);
        for other in &planes[..k] {
            part = clip(&part, |p| other.at(p) - plane.at(p) + ROUNDING);
        }
        // Empty only through rounding: the bound then stays too high, which is still valid.
        if let Some(&best) = part.iter().max_by(|a, b| plane.at(**a).total_cmp(&plane.at(**b))) {
            (at, top) = (best, plane.at(best));
        }
    }
    (at, top)
}

/// Portion of a side, as distances from its start, that another side covers from across: `None` if that side
/// runs in the same direction, or is too far.
fn beside([c, d]: [DVec2; 2], from: DVec2, along: DVec2, length: f64, join: f64) -> Option<[f64; 2]> {
    let place = |p: DVec2| (along.dot(p - from), along.perp_dot(p - from));
    let ((tc, oc), (td, od)) = (place(c), place(d));
    let (start, end) = (td.max(0.0), tc.min(length));
    if end - start <= 0.0 {
        return None;
    }
    let off = |t: f64| oc + (od - oc) * (t - tc) / (td - tc);
    (off(start).abs() <= join && off(end).abs() <= join).then_some([start, end])
}

fn sides(polygon: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
}

/// The corners of a box, counter-clockwise.
fn corners(middle: DVec2, half: f64) -> [DVec2; 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| middle + half * DVec2::new(x, y))
}

fn bounds<'p>(points: impl IntoIterator<Item = &'p DVec2>) -> (DVec2, DVec2) {
    points.into_iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)))
}

#[cfg(test)]
mod tests;
