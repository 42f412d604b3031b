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
//! The region is a tiling, its border is what no neighbour covers. The distance to one stretch of the border is convex, and linear in
//! all but six fans of directions around it. Branch and bound over boxes of p: where every stretch that matters is linear, the box's
//! best place is a linear programme, solved exactly; other boxes are quartered. So the edge is exact to [`Square::TOLERANCE`] for the
//! tiling as given, and ridges along which the square may slide cost no more than points.
//!
//! In one dimension the square is the interval itself. For a cone, [`circle_square`] says between which edges the round one's lies.
//!
//! Not promised: which of several largest squares is named; the one around zero where it is one of them. Source: the dissertation,
//! section 2.2.2 (ONAA) and 4.1.2, where the edge is counted in D and not as a share of an error box.

use super::cells::clip;
use super::{Zraa, circle_bounds};
use crate::design::Design;
use crate::exec::{Cancelled, Exec};
use glam::DVec2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// Sides nearer to each other than this, in D, are the two sides of one seam; gaps below it are closed. Above the slivers that cutting
/// leaves out.
const JOIN: f64 = 1e-9;
/// Slack of comparisons, in D: a few roundings of numbers of the order of 1.
const ROUNDING: f64 = 1e-13;

/// The largest axis-parallel square in the accepted offsets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Square {
    /// Its edge, in D; 0 where nothing is accepted.
    pub edge: f64,
    /// Its middle, in D.
    pub center: DVec2,
    /// Edge of the largest one whose middle is zero, in D.
    pub centered_edge: f64,
}

impl Square {
    /// How far the edge may be from that of the tiling, in D.
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
            Zraa::Region { polygons, .. } => Self::within(polygons, exec),
        }
    }

    /// The square within convex polygons, counter-clockwise, that do not overlap.
    ///
    /// # Errors
    /// If it is cancelled.
    pub fn within(polygons: &[Vec<DVec2>], exec: &Exec) -> Result<Self, Cancelled> {
        Search::new(polygons).run(exec)
    }
}

/// Lower and upper bound of the edge for the round cone, from that of the polygon that stands for it; `None` for other designs.
///
/// The circle lies between the inscribed polygon and the same polygon enlarged by 1/(1 − e/R), and so do their squares: e is the chord
/// error and R the radius.
pub fn circle_square(design: &Design, zraa: &Zraa, square: &Square) -> Option<[f64; 2]> {
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

/// A stretch of the border.
///
/// A square around p keeps clear of it where an axis of the picture, or the stretch's own normal, separates the two: its distance is
/// the largest of six linear functions.
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

    /// The one linear function that is the distance all over a box, if there is one. Convex and equal to it at the corners means
    /// equal inside.
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
    low: DVec2,
    high: DVec2,
}

type Indexed = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// Places that are still to be looked at.
struct Place {
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
    fn new(polygons: &'a [Vec<DVec2>]) -> Self {
        let boxed = |(k, polygon): (usize, &Vec<DVec2>)| {
            let (low, high) = bounds(polygon);
            GeomWithData::new(Rectangle::from_corners(low.to_array(), high.to_array()), k)
        };
        let index = RTree::bulk_load(polygons.iter().enumerate().map(boxed).collect());
        let (low, high) = bounds(polygons.iter().flatten());
        let mut search = Self { polygons, index, border: Vec::new(), low, high };
        for k in 0..polygons.len() {
            search.border_of(k);
        }
        search
    }

    /// Polygons whose boxes come within [`JOIN`] of this one.
    fn around(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = usize> + '_ {
        let boxed = AABB::from_corners((low - JOIN).to_array(), (high + JOIN).to_array());
        self.index.locate_in_envelope_intersecting(boxed).map(|found| found.data)
    }

    /// Adds what no neighbour covers of a polygon's sides.
    fn border_of(&mut self, own: usize) {
        for [from, to] in sides(&self.polygons[own]) {
            let length = from.distance(to);
            if length <= JOIN {
                continue;
            }
            let along = (to - from) / length;
            let mut covered: Vec<[f64; 2]> = Vec::new();
            for k in self.around(from.min(to), from.max(to)).filter(|&k| k != own) {
                covered.extend(sides(&self.polygons[k]).filter_map(|side| beside(side, from, along, length)));
            }
            covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
            covered.push([length, length]);
            let mut reached = 0.0;
            for [start, end] in covered {
                if start - reached > JOIN {
                    self.border.push(Stretch::new(from + along * reached, from + along * start));
                }
                reached = end.max(reached);
            }
        }
    }

    /// Whether a place is accepted, or on a seam.
    fn holds(&self, p: DVec2) -> bool {
        let inside = |polygon: &[DVec2]| {
            sides(polygon).all(|[a, b]| (b - a).perp_dot(p - a) >= -JOIN * (b - a).length())
        };
        self.around(p, p).any(|k| inside(&self.polygons[k]))
    }

    fn run(&self, exec: &Exec) -> Result<Square, Cancelled> {
        let all: Vec<u32> = (0..self.border.len() as u32).collect();
        let mut best = Best { at: DVec2::ZERO, half_edge: 0.0 };
        if self.holds(DVec2::ZERO) {
            best.half_edge = self.distance(&all, DVec2::ZERO);
        }
        let centered_edge = 2.0 * best.half_edge;
        let middle = self.low.midpoint(self.high);
        let mut open = Vec::new();
        if !all.is_empty() {
            open.push(Place { middle, half: (self.high - middle).max_element(), near: all });
        }
        while let Some(place) = open.pop() {
            exec.check()?;
            open.extend(self.look(&place, &mut best));
        }
        Ok(Square { edge: 2.0 * best.half_edge, center: best.at, centered_edge })
    }

    fn distance(&self, near: &[u32], p: DVec2) -> f64 {
        near.iter().map(|&k| self.border[k as usize].distance(p)).fold(f64::INFINITY, f64::min)
    }

    /// Looks at the places of a box; what is left of it are its quarters, the most promising last, or nothing.
    fn look(&self, place: &Place, best: &mut Best) -> Vec<Place> {
        // Half of the edge's tolerance for the half edge, and the rest for seams.
        const ENOUGH: f64 = Square::TOLERANCE / 4.0;
        let Place { middle, half, .. } = *place;
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
        let mut quarters: Vec<(f64, Place)> = self::corners(middle, half)
            .into_iter()
            .map(|middle| (self.distance(&near, middle), Place { middle, half, near: near.clone() }))
            .collect();
        quarters.sort_by(|a, b| a.0.total_cmp(&b.0));
        quarters.into_iter().map(|(_, quarter)| quarter).collect()
    }
}

/// Where in a box the lowest of the planes and the cap is highest, and how high. Plane after plane: one that cuts the best place so far
/// carries the next.
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
        // Empty by rounding alone: then the bound stays above, where it is still one.
        if let Some(&best) = part.iter().max_by(|a, b| plane.at(**a).total_cmp(&plane.at(**b))) {
            (at, top) = (best, plane.at(best));
        }
    }
    (at, top)
}

/// Which part of a side, as distances from its start, another side covers from across: none where it runs the same way, or is too far.
fn beside([c, d]: [DVec2; 2], from: DVec2, along: DVec2, length: f64) -> Option<[f64; 2]> {
    let place = |p: DVec2| (along.dot(p - from), along.perp_dot(p - from));
    let ((tc, oc), (td, od)) = (place(c), place(d));
    let (start, end) = (td.max(0.0), tc.min(length));
    if end - start <= 0.0 {
        return None;
    }
    let off = |t: f64| oc + (od - oc) * (t - tc) / (td - tc);
    (off(start).abs() <= JOIN && off(end).abs() <= JOIN).then_some([start, end])
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
mod tests {
    use super::*;
    use crate::method::zraa::sheet::area;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_1_SQRT_2, TAU};

    fn square(polygons: &[Vec<DVec2>]) -> Square {
        Square::within(polygons, &Exec::new()).unwrap()
    }

    fn polygon(corners: &[(f64, f64)]) -> Vec<DVec2> {
        corners.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    fn tile(x: f64, y: f64, w: f64, h: f64) -> Vec<DVec2> {
        polygon(&[(x, y), (x + w, y), (x + w, y + h), (x, y + h)])
    }

    /// Area of a box within the tiling.
    fn held(polygons: &[Vec<DVec2>], middle: DVec2, half: f64) -> f64 {
        let within = |polygon: &Vec<DVec2>| {
            let mut part = polygon.clone();
            for (axis, sign) in [(DVec2::X, 1.0), (DVec2::X, -1.0), (DVec2::Y, 1.0), (DVec2::Y, -1.0)] {
                part = clip(&part, |p| half - sign * axis.dot(p - middle));
            }
            area(&part)
        };
        polygons.iter().map(within).sum()
    }

    /// Whether a box lies within the tiling, by areas alone.
    fn fits(polygons: &[Vec<DVec2>], middle: DVec2, half: f64) -> bool {
        // Corners that stick out by less than this are not seen.
        const UNSEEN: f64 = 1e-10;
        4.0 * half * half - held(polygons, middle, half) < UNSEEN * half
    }

    /// Half edge of the largest box around a place, by bisection, where it is more than `least`.
    fn widest(polygons: &[Vec<DVec2>], middle: DVec2, least: f64) -> Option<f64> {
        let (mut lo, mut hi) = (least, 1.0);
        if !fits(polygons, middle, lo) {
            return None;
        }
        while hi - lo > 1e-8 {
            let half = f64::midpoint(lo, hi);
            if fits(polygons, middle, half) { lo = half } else { hi = half }
        }
        Some(lo)
    }

    /// The definition by trying places: a grid, then ever smaller steps from its best place.
    fn by_trial(polygons: &[Vec<DVec2>]) -> f64 {
        const GRID: i32 = 16;
        let (mut half, mut at) = (1e-3, DVec2::ZERO);
        for (i, j) in (-GRID..=GRID).flat_map(|i| (-GRID..=GRID).map(move |j| (i, j))) {
            let p = DVec2::new(f64::from(i), f64::from(j)) / f64::from(GRID);
            if let Some(wider) = widest(polygons, p, half + 1e-6) {
                (half, at) = (wider, p);
            }
        }
        let mut step = 1.0 / f64::from(GRID);
        while step > 1e-6 {
            let mut next = (0..8).map(|k| at + step * DVec2::from_angle(f64::from(k) * TAU / 8.0));
            match next.find_map(|p| Some((widest(polygons, p, half + 1e-7)?, p))) {
                Some(better) => (half, at) = better,
                None => step /= 2.0,
            }
        }
        2.0 * half
    }

    /// Fan of triangles from zero to a rim.
    fn star(radii: &[f64], turn: f64) -> Vec<Vec<DVec2>> {
        let n = radii.len();
        let rim = |k: usize| radii[k % n] * DVec2::from_angle(turn + (k % n) as f64 * TAU / n as f64);
        (0..n).map(|k| vec![DVec2::ZERO, rim(k), rim(k + 1)]).collect()
    }

    #[test]
    fn closed_forms() {
        let disc = |corners: u32| star(&vec![0.5; corners as usize], 0.0);
        let ring: Vec<_> = [(0, 0), (1, 0), (2, 0), (0, 1), (2, 1), (0, 2), (1, 2), (2, 2)]
            .map(|(x, y)| tile(f64::from(x), f64::from(y), 1.0, 1.0))
            .to_vec();
        let cross = vec![tile(-1.0, -0.1, 0.9, 0.2), tile(0.1, -0.1, 0.9, 0.2), tile(-0.1, -1.0, 0.2, 2.0)];
        let half_turned = TAU / 16.0;
        for (name, region, edge) in [
            ("the diamond of the X-Face", star(&[1.0; 4], 0.0), 1.0),
            (
                "a square of many parts",
                (0..7).map(|k| tile(f64::from(k) / 7.0, 0.0, 1.0 / 7.0, 1.0)).collect(),
                1.0,
            ),
            ("a corridor in which it slides", vec![tile(-1.5, -0.25, 3.0, 0.5)], 0.5),
            ("a right triangle", vec![polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])], 0.5),
            ("a ring of squares around a hole", ring, 1.0),
            ("a cross", cross, 0.2),
            (
                "two parts, the larger one apart",
                vec![tile(0.0, 0.0, 0.3, 0.3), tile(1.0, 1.0, 0.4, 0.5)],
                0.4,
            ),
            // A corner of the polygon on the diagonal, and the middle of a side there.
            ("a polygon of 8 corners", disc(8), FRAC_1_SQRT_2),
            ("a polygon of 12 corners", disc(12), FRAC_1_SQRT_2 * (TAU / 24.0).cos()),
            (
                "a strip askew",
                vec![
                    tile(-1.0, -0.1, 2.0, 0.2)
                        .iter()
                        .map(|p| DVec2::from_angle(half_turned).rotate(*p))
                        .collect(),
                ],
                0.2 / (half_turned.sin() + half_turned.cos()),
            ),
            ("nothing", vec![], 0.0),
        ] {
            let found = square(&region);
            assert!((found.edge - edge).abs() < Square::TOLERANCE, "{name}: {found:?}");
            assert!(
                found.edge == 0.0 || fits(&region, found.center, found.edge / 2.0 - 1e-9),
                "{name}: {found:?}"
            );
        }
    }

    #[test]
    fn the_square_around_zero_is_told_beside_the_largest() {
        // Zero in the narrow part of an hourglass lying down.
        let wide = tile(0.1, -0.4, 0.9, 0.8);
        let found = square(&[tile(-0.2, -0.05, 0.3, 0.1), wide]);
        assert!((found.edge - 0.8).abs() < 1e-8 && (found.centered_edge - 0.1).abs() < 1e-8, "{found:?}");
        let off = square(&[tile(1.0, 1.0, 1.0, 1.0)]);
        assert!((off.edge - 1.0).abs() < 1e-8 && off.centered_edge == 0.0, "{off:?}");
        let zraa = Zraa::Interval { axis: crate::pose::Dof::X, from: -0.25, to: 0.75 };
        let found = Square::of(&zraa, &Exec::new()).unwrap();
        assert_eq!((found.edge, found.center.x, found.centered_edge), (1.0, 0.25, 0.5));
    }

    #[test]
    fn a_cancelled_search_ends() {
        let exec = Exec::new();
        exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
        assert_eq!(Square::within(&star(&[1.0; 5], 0.0), &exec), Err(Cancelled));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// The square lies within the region, and no box that was tried is larger.
        #[test]
        fn stars_agree_with_trial(radii in proptest::collection::vec(0.15..1.0f64, 5..14), turn in 0.0..TAU) {
            let region = star(&radii, turn);
            let found = square(&region);
            prop_assert!(fits(&region, found.center, found.edge / 2.0 - 1e-8), "{found:?}");
            let tried = by_trial(&region);
            // A corner that sticks out by d covers at least d²/4 where no side of the rim is steeper than 2, so that 1e-10 · r hide less
            // than 2e-5; steeper ones hide more, in proportion to the root.
            prop_assert!(found.edge >= tried - 1e-4, "{found:?} {tried}");
            prop_assert!(found.edge <= tried + 0.1, "{found:?} {tried}");
        }

        /// Of unit cells the edge is whole, and counted by the longest runs.
        #[test]
        fn cells_agree_with_counting(cells in proptest::collection::vec(proptest::bool::weighted(0.75), 49)) {
            let at = |x: usize, y: usize| cells[x + 7 * y];
            let places = (0..7).flat_map(|y| (0..7).map(move |x| (x, y)));
            let region: Vec<_> = places
                .clone()
                .filter(|&(x, y)| at(x, y))
                .map(|(x, y)| tile(x as f64 - 3.3, y as f64 - 3.6, 1.0, 1.0))
                .collect();
            let full = |x: usize, y: usize, n: usize| {
                x + n <= 7 && y + n <= 7 && (x..x + n).all(|i| (y..y + n).all(|j| at(i, j)))
            };
            let counted = places.flat_map(|(x, y)| (0..=7).map(move |n| (x, y, n))).filter(|&(x, y, n)| full(x, y, n));
            let counted = counted.map(|(_, _, n)| n).max().unwrap();
            let found = square(&region);
            prop_assert!((found.edge - counted as f64).abs() < Square::TOLERANCE, "{found:?} {counted}");
        }
    }
}
