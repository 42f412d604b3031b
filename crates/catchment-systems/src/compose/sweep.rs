//! The swept region of a moving part, between an inner and an outer polygon.
//!
//! ```text
//!    hook: a segment that turns        loop: an outline that grows        lug: a polygon that slides
//!        ╭───────╮                          ╭─────╮
//!       ╱ ╭─────╮ ╲                        ╱ ╭───╮ ╲                          ▢ ─ ─ ▢
//!      ╱ ╱   ·   ╲ ╲  ·: pivot             │ │ · │ │                          
//! ```
//!
//! It is the union of a shape over all positions of one actuator. Growing and sliding give polygons again,
//! exactly. Turning gives arcs. In polar coordinates (r, θ) about the pivot, a turn adds to θ alone. A
//! segment of the outline along which r grows therefore sweeps { (r, θ(r) + turn) : r from r₀ to r₁ } with
//! turn in [from, to]: bounded by the segment twice, and two arcs. On the inner polygon the far arc is made
//! of chords and the near arc of tangents, on the outer polygon the other way round, and no point of either
//! is farther from the arc than the chord error. So **inner ⊆ swept ⊆ outer**, up to the lattice of
//! [`super::Region`].
//!
//! Sums, unions and sweeps preserve that order, and areas are given as brackets throughout.

use super::region::{Node, Region, node, place, sides};
use super::sum::{SumError, minkowski_sum};
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

/// A region known between two polygons.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bracket {
    /// Within the region.
    pub inner: Region,
    /// Around the region.
    pub outer: Region,
}

/// Which polygon stands for an arc.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Bound {
    Inner,
    Outer,
}

/// A shape at rest, lengths in mm.
#[derive(Debug, Clone, PartialEq)]
pub enum SweptShape {
    /// A hook's reach: between two circles, from a direction to another, in radians counter-clockwise from
    /// +y.
    AnnularSector {
        /// Radius of the inner circle, 0 for a sector.
        inner: f64,
        /// Radius of the outer circle.
        outer: f64,
        /// First direction.
        from: f64,
        /// Last direction, at most a full turn later.
        to: f64,
    },
    /// Half an ellipse that bulges towards +y from the x axis: a loop of string, filled.
    HalfEllipse {
        /// Half its width along x.
        half_width: f64,
        /// Its extent along +y.
        reach: f64,
    },
    /// A disc about the origin.
    Disc {
        /// Its radius.
        radius: f64,
    },
    /// A rectangle about the origin.
    Box {
        /// Along x.
        width: f64,
        /// Along y.
        height: f64,
    },
    /// A simple polygon.
    Polygon(Vec<DVec2>),
}

/// How a shape moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// It turns about a pivot, by angles in radians, counter-clockwise.
    Turn {
        /// The fixed point.
        pivot: DVec2,
        /// First angle.
        from: f64,
        /// Last angle, at most a full turn later.
        to: f64,
    },
    /// It grows about a point, by factors.
    Scale {
        /// The fixed point.
        about: DVec2,
        /// First factor, at least 0.
        from: f64,
        /// Last factor.
        to: f64,
    },
    /// It slides along a straight line.
    Slide {
        /// Displacement from the drawn to the last position.
        by: DVec2,
    },
}

impl Bracket {
    /// A region that is known exactly.
    pub fn exact(region: Region) -> Self {
        Self { inner: region.clone(), outer: region }
    }

    /// Least and greatest area.
    pub fn area(&self) -> [f64; 2] {
        [self.inner.area(), self.outer.area()]
    }

    /// Both polygons, by the same change.
    ///
    /// # Errors
    /// Those of the change.
    pub fn try_map<E>(&self, change: impl Fn(&Region) -> Result<Region, E>) -> Result<Self, E> {
        let inner = change(&self.inner)?;
        // Most regions are exact: both polygons are equal, and so are the results.
        let outer = if self.inner == self.outer { inner.clone() } else { change(&self.outer)? };
        Ok(Self { inner, outer })
    }

    /// Both polygons, by the same change.
    #[must_use]
    pub fn map(&self, change: impl Fn(&Region) -> Region) -> Self {
        let inner = change(&self.inner);
        let outer = if self.inner == self.outer { inner.clone() } else { change(&self.outer) };
        Self { inner, outer }
    }

    /// The Minkowski sum with another.
    ///
    /// # Errors
    /// If it would take too long, or reach too far.
    pub fn sum(&self, other: &Self) -> Result<Self, SumError> {
        let inner = minkowski_sum(&self.inner, &other.inner)?;
        let exact = self.inner == self.outer && other.inner == other.outer;
        let outer = if exact { inner.clone() } else { minkowski_sum(&self.outer, &other.outer)? };
        Ok(Self { inner, outer })
    }

    /// This without another.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        Self { inner: self.inner.minus(&other.outer), outer: self.outer.minus(&other.inner) }
    }
}

impl SweptShape {
    /// The shape with its origin at `center`, its arcs to `chord_error` in mm.
    pub fn bracket(&self, center: DVec2, chord_error: f64) -> Bracket {
        let of = |bound| self.region(bound, chord_error).mapped(|p| p + center);
        Bracket { inner: of(Bound::Inner), outer: of(Bound::Outer) }
    }

    fn region(&self, bound: Bound, chord_error: f64) -> Region {
        match self {
            Self::AnnularSector { inner, outer, from, to } => {
                let spoke = Region::segment(DVec2::new(*inner, 0.0), DVec2::new(*outer, 0.0));
                turned(&spoke, DVec2::ZERO, [from + FRAC_PI_2, to + FRAC_PI_2], chord_error, bound)
            }
            Self::HalfEllipse { half_width, reach } => {
                let unit = arc(1.0, [0.0, PI], chord_error / half_width.max(*reach), bound);
                Region::of_outlines(&[unit
                    .into_iter()
                    .map(|p| p * DVec2::new(*half_width, *reach))
                    .collect()])
            }
            Self::Disc { radius } => Region::of_outlines(&[arc(*radius, [0.0, TAU], chord_error, bound)]),
            Self::Box { width, height } => {
                let corner = DVec2::new(*width, *height) / 2.0;
                Region::rectangle(-corner, corner)
            }
            Self::Polygon(corners) => Region::of_outlines(std::slice::from_ref(corners)),
        }
    }
}

impl Motion {
    /// The swept region of the shape, arcs to `chord_error` in mm.
    ///
    /// # Errors
    /// If a sliding shape is too fine.
    pub fn sweep(&self, shape: &Bracket, chord_error: f64) -> Result<Bracket, SumError> {
        match *self {
            Self::Turn { pivot, from, to } => Ok(Bracket {
                inner: turned(&shape.inner, pivot, [from, to], chord_error, Bound::Inner),
                outer: turned(&shape.outer, pivot, [from, to], chord_error, Bound::Outer),
            }),
            Self::Scale { about, from, to } => Ok(shape.map(|region| scaled(region, about, [from, to]))),
            Self::Slide { by } => {
                let way = Region::segment(DVec2::ZERO, by);
                shape.try_map(|region| minkowski_sum(region, &way))
            }
        }
    }
}

/// How many pieces of at most a sixth of a turn an arc needs so that neither chords nor tangents leave it by more than `error`.
fn pieces(radius: f64, angle: f64, error: f64) -> usize {
    let widest = (2.0 * (radius / (radius + error)).acos()).min(FRAC_PI_3);
    (angle / widest).ceil().max(1.0) as usize
}

/// Points along a counter-clockwise arc about the origin, from its start to its end: chords within it, or tangents around it.
fn arc(radius: f64, [from, to]: [f64; 2], error: f64, bound: Bound) -> Vec<DVec2> {
    let count = pieces(radius, to - from, error);
    let step = (to - from) / count as f64;
    let at = |k: f64, r: f64| DVec2::from_angle(from + k * step) * r;
    match bound {
        Bound::Inner => (0..=count).map(|k| at(k as f64, radius)).collect(),
        Bound::Outer => {
            let far = radius / (step / 2.0).cos();
            let middle = (0..count).map(|k| at(k as f64 + 0.5, far));
            std::iter::once(at(0.0, radius)).chain(middle).chain([at(count as f64, radius)]).collect()
        }
    }
}

/// The swept region of a region that turns about a pivot.
fn turned(region: &Region, pivot: DVec2, [from, to]: [f64; 2], error: f64, bound: Bound) -> Region {
    let seen = region.mapped(|p| p - pivot);
    let mut swept = vec![seen.turned(from), seen.turned(to)];
    for part in &mut swept {
        part.thin.clear();
    }
    for way in seen.nodes().flat_map(outward).chain(seen.thin.iter().flat_map(|ends| outward(ends))) {
        swept.push(Region::of_chains(&[way_swept(&way, [from, to], error, bound)]));
    }
    Region::union(&swept).mapped(|p| p + pivot)
}

/// A closed outline in segments along which the distance from the origin grows.
///
/// Arcs occur only at points at which an outline turns back, so that two arcs for the same curve leave no
/// slit between them.
fn outward(outline: &[Node]) -> Vec<Vec<DVec2>> {
    let mut points = Vec::with_capacity(2 * outline.len());
    for [a, b] in sides(outline).map(|ends| ends.map(place)) {
        points.push(a);
        let along = b - a;
        let foot = -a.dot(along) / along.length_squared();
        if foot > 0.0 && foot < 1.0 {
            points.push(a + along * foot);
        }
    }
    let rising = |k: usize| points[(k + 1) % points.len()].length() > points[k % points.len()].length();
    // Start at the beginning of a segment; an outline at constant distance around the origin has no segments.
    let Some(first) = (0..points.len()).find(|&k| rising(k) != rising(k + points.len() - 1)) else {
        return Vec::new();
    };
    let mut ways: Vec<Vec<DVec2>> = Vec::new();
    for k in first..first + points.len() {
        match ways.last_mut() {
            Some(way) if rising(k) == rising(k - 1) && k > first => way.push(points[(k + 1) % points.len()]),
            _ => ways.push(vec![points[k % points.len()], points[(k + 1) % points.len()]]),
        }
    }
    for way in &mut ways {
        if way[0].length() > way[way.len() - 1].length() {
            way.reverse();
        }
    }
    ways
}

/// The outline of the swept region of an outward path: out along it, around, back in along the rotated path,
/// back around.
fn way_swept(way: &[DVec2], turn: [f64; 2], error: f64, bound: Bound) -> Vec<DVec2> {
    let around = |end: DVec2, bound| {
        let start = if end == DVec2::ZERO { 0.0 } else { end.to_angle() };
        arc(end.length(), turn.map(|angle| start + angle), error, bound)
    };
    let other = if bound == Bound::Inner { Bound::Outer } else { Bound::Inner };
    let [first, last] = turn.map(DVec2::from_angle);
    let mut chain: Vec<DVec2> = way.iter().map(|p| first.rotate(*p)).collect();
    chain.extend(around(way[way.len() - 1], bound));
    chain.extend(way.iter().rev().map(|p| last.rotate(*p)));
    chain.extend(around(way[0], other).into_iter().rev());
    chain
}

/// The swept region of a region that grows about a point.
fn scaled(region: &Region, about: DVec2, [from, to]: [f64; 2]) -> Region {
    let grown = |factor: f64| region.mapped(|p| about + (p - about) * factor);
    let mut swept = vec![grown(from), grown(to)];
    for [a, b] in region.nodes().flat_map(sides).map(|ends| ends.map(place)) {
        let at = |p: DVec2, factor: f64| about + (p - about) * factor;
        let corners = [at(a, from), at(b, from), at(b, to), at(a, to)].map(node);
        swept.push(Region::of_nodes(&[corners.to_vec()]));
    }
    Region::union(&swept)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOOK: SweptShape =
        SweptShape::AnnularSector { inner: 100.0, outer: 160.0, from: -FRAC_PI_3, to: FRAC_PI_3 };

    /// Both areas around the exact area, and apart by at most twice the chord error along all arcs, whose
    /// length is given.
    fn brackets(bracket: &Bracket, exact: f64, arcs: f64, error: f64) {
        let [inner, outer] = bracket.area();
        assert!(inner < exact && exact < outer, "{inner} < {exact} < {outer}");
        assert!(outer - inner < 2.0 * error * arcs, "{inner} {outer}");
        assert!(bracket.inner.minus(&bracket.outer).area() < 1e-6);
    }

    #[test]
    fn arcs_lie_between_chords_and_tangents() {
        for error in [1.0, 0.1, 0.01] {
            let at = |shape: &SweptShape| shape.bracket(DVec2::new(3.0, -2.0), error);
            let third = 2.0 * FRAC_PI_3;
            brackets(&at(&HOOK), PI / 3.0 * (160f64.powi(2) - 100f64.powi(2)), third * 260.0, error);
            brackets(&at(&SweptShape::Disc { radius: 50.0 }), PI * 2500.0, TAU * 50.0, error);
            // An ellipse of these half-axes is no longer than a circle of the larger.
            let shape = SweptShape::HalfEllipse { half_width: 100.0, reach: 120.0 };
            brackets(&at(&shape), PI * 6000.0, PI * 120.0, error);
        }
    }

    #[test]
    fn an_off_pivot_turn_sweeps_the_area_of_the_polar_integral() {
        // A square whose sides pass the pivot: ∫ r (width of the square at r, in angle, + the turn) dr, per radius.
        let square = SweptShape::Box { width: 2.0, height: 2.0 }.bracket(DVec2::new(4.0, 0.5), 1.0);
        let turn = 0.4;
        let swept = Motion::Turn { pivot: DVec2::ZERO, from: 0.0, to: turn }.sweep(&square, 1e-4).unwrap();
        // Midpoints of rings, on each of which the square covers a single interval of angles.
        let rings = 4000;
        let (near, far) = (3.0, 5.0f64.hypot(1.5));
        let mut area = 0.0;
        for k in 0..rings {
            let r = near + (far - near) * (f64::from(k) + 0.5) / f64::from(rings);
            let samples = 4000;
            let angle = |j: i32| -0.3 + (f64::from(j) + 0.5) / f64::from(samples);
            let inside = |j: &i32| {
                (DVec2::from_angle(angle(*j)) * r - DVec2::new(4.0, 0.5)).abs().max_element() <= 1.0
            };
            // Beyond the right side there are two stretches, nearer to each other than the turn: they grow together.
            if let (Some(first), Some(last)) = ((0..samples).find(inside), (0..samples).rev().find(inside)) {
                let width = f64::from(last - first + 1) / f64::from(samples);
                area += r * (width + turn) * (far - near) / f64::from(rings);
            }
        }
        let [inner, outer] = swept.area();
        assert!(
            inner <= outer && (area - inner).abs() < 2e-3 && outer - inner < 5e-3,
            "{inner} {area} {outer}"
        );
    }

    #[test]
    fn a_full_turn_of_a_spoke_is_a_disc_and_of_a_side_a_ring() {
        let spoke = SweptShape::AnnularSector { inner: 0.0, outer: 10.0, from: 0.0, to: TAU };
        brackets(&spoke.bracket(DVec2::ZERO, 0.01), PI * 100.0, TAU * 10.0, 0.01);
        // A chord of the outer circle that passes the pivot at 3.
        let bar = Bracket::exact(Region::segment(DVec2::new(3.0, -4.0), DVec2::new(3.0, 4.0)));
        let ring = Motion::Turn { pivot: DVec2::ZERO, from: 0.0, to: TAU }.sweep(&bar, 0.01).unwrap();
        brackets(&ring, PI * (25.0 - 9.0), TAU * 8.0, 0.01);
        assert_eq!((ring.inner.parts(), ring.inner.holes()), (1, 1));
    }

    #[test]
    fn growing_and_sliding_are_exact() {
        let square = SweptShape::Box { width: 2.0, height: 2.0 }.bracket(DVec2::new(3.0, 0.0), 1.0);
        let grown = Motion::Scale { about: DVec2::ZERO, from: 1.0, to: 2.0 }.sweep(&square, 1.0).unwrap();
        // From the square at x 2…4 to the square at 4…8, between the lines y = ±x/2: a trapezoid x 2…4
        // widened from 2 to 4 … 8. Left of x = 4 the half-height is max(1, x/2) = x/2 from x = 2; from 4 to 8
        // it is 2.
        assert!((grown.inner.area() - (6.0 + 16.0)).abs() < 1e-6, "{}", grown.inner.area());
        let slid = Motion::Slide { by: DVec2::new(3.0, 4.0) }.sweep(&square, 1.0).unwrap();
        // Area plus the width seen along the way, times its length: 4 + 2·3 + 2·4.
        assert_eq!(slid.area(), [18.0, 18.0]);
    }
}
