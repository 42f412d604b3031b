//! Convex polytopes in one to six dimensions, and finite unions of them.
//!
//! ```text
//!   V-form: the hull of its vertices          H-form: the points behind all its facets
//!
//!        •─────────•                                ╲___________╱       normal · x ≤ offset
//!       ╱           ╲            =                  ╱           ╲
//!      •─────────────•                             ╱_____________╲
//! ```
//!
//! A [`Polytope`] stores both forms, and the incidence of vertices and facets. It is bounded and
//! full-dimensional: a set thinner than [`RESOLUTION`] is not a polytope here, and operations return `None`
//! for it. A [`Collection`] is a finite union of polytopes (a *P-collection*), the data type of the
//! polyhedral method.
//!
//! # Exact and rounded operations
//!
//! **A hull's signs are exact.** [`Polytope::hull`], and with it sums, projections and cross-sections, round
//! points to a lattice of 2⁻⁴⁰ and then decide every side in integers. A wrong sign there gives a wrong
//! topology, which can change a set arbitrarily: floating-point hulls are known to be wrong for one in fifty
//! Minkowski sums, because their facets are parallelograms with exactly coplanar corners. On the lattice,
//! sums are exact, so coplanar sums are coplanar.
//!
//! **Cuts are regularised.** [`Polytope::cut`] and all set operations on it treat a vertex closer to the
//! cutting plane than [`RESOLUTION`] as on it. Such a decision changes only slivers thinner than that, which
//! have negligible measure and must not exist in either case. If a vertex is on the plane only by this rule
//! (farther from it than rounding explains, or not much closer than others), or the faces would not close,
//! the result is the exact hull of its vertices.
//!
//! # Units and limits
//!
//! Coordinates are in D and rad, of order 1, and at most 1024; beyond that the result is `None`. Cost grows
//! quickly with the dimension: a polytope with n vertices in six dimensions may have n³ facets. Memory is not
//! reserved in advance: a caller who multiplies collections must limit their number.
//!
//! # Example
//!
//! ```
//! use catchment_base::polytope::{Collection, Polytope, minkowski_sum_of};
//!
//! # fn example() -> Option<()> {
//! let square = Polytope::cuboid(2, &[0.0; 6], &[1.0; 6])?;
//! let corners = [(0.5, 0.5), (1.5, 0.0), (1.5, 1.0)].map(|(x, y)| [x, y, 0.0, 0.0, 0.0, 0.0]);
//! let tip = Polytope::hull(2, &corners)?;
//! assert!(square.overlaps(&tip));
//!
//! // The rest of the square without the tip, in convex pieces.
//! let left = Collection { polytopes: square.difference(&tip) };
//! assert!((left.volume() - 0.875).abs() < 1e-9);
//!
//! // Swept upwards by 2: a flat set and a segment make a prism.
//! let prism = minkowski_sum_of(3, tip.vertices(), &[[0.0; 6], [0.0, 0.0, 2.0, 0.0, 0.0, 0.0]])?;
//! assert_eq!(prism.facets().len(), 5);
//! assert!((prism.slice(2, 1.0)?.volume() - tip.volume()).abs() < 1e-9);
//! # Some(())
//! # }
//! # assert!(example().is_some());
//! ```
//!
//! Source: the dissertation's polyhedral method (P-collections, set difference, projection); M. Baotić, *Polytopic
//! computations in constrained optimal control*, Automatika 50 (2009), for the difference; G. Ziegler, *Lectures on
//! Polytopes* (1995), for faces.

mod boundary;
mod collection;
mod cut;
mod exact;
mod faces;
mod halfspace;
mod hull;
mod image;
mod incidence;
mod measure;
mod planar;

pub mod brute;

pub use collection::Collection;
pub use halfspace::Halfspace;
pub use image::minkowski_sum_of;
pub use planar::planar_hull;

use exact::Lattice;
use hull::Hull;
use incidence::Incidence;

/// Most dimensions: five pose errors and the height.
pub const MAX_DIMENSION: usize = 6;

/// A point or direction, in D and rad. Components beyond the dimension are 0.
pub type PolytopePoint = [f64; MAX_DIMENSION];

/// Points closer to a plane than this, in D or rad, are on it, and thinner sets are empty: 2⁻³⁰ ≈ 9e-10.
///
/// Derived from the lattice of hulls (2⁻⁴⁰): the error of a plane through rounded points is their rounding,
/// times the extrapolation factor, times the square root of the dimension; a thousand units of the lattice
/// are above that, and a million times below the thousandth of D that matters for a connector and its
/// results.
pub const RESOLUTION: f64 = 1.0 / (1u64 << 30) as f64;

/// Nearer to a plane than this, rounding explains the distance: 64 units of the lattice of hulls.
const FLAT: f64 = RESOLUTION / 16.0;
/// Smallest ratio between the distances of the nearest other vertices and of the vertices on a plane: a plane
/// through some of the vertices on it can miss the others by that ratio, if their features are that small.
const CLEAR: f64 = 1e6;

/// How well the vertices on planes stand apart from the others.
#[derive(Clone, Copy)]
struct Gap {
    /// The largest distance of a vertex that counts as on its plane.
    on: f64,
    /// The smallest distance of a vertex off the plane.
    off: f64,
}

impl Gap {
    const NEW: Self = Self { on: 0.0, off: f64::INFINITY };

    /// Does a vertex at this distance count as on the plane?
    fn is_on(&mut self, distance: f64) -> bool {
        let on = distance.abs() <= RESOLUTION;
        if on {
            self.on = self.on.max(distance.abs());
        } else {
            self.off = self.off.min(distance.abs());
        }
        on
    }

    /// Is every vertex certain to be on its plane or off it?
    fn is_clear(&self) -> bool {
        self.on <= FLAT && self.on * CLEAR <= self.off
    }
}

/// A bounded convex set with an interior.
///
/// Always: every vertex is behind all facets and on at least `dimension` of them, both up to rounding; every facet has
/// at least `dimension` vertices; every facet has a vertex deeper below it than [`RESOLUTION`].
#[derive(Clone, Debug)]
pub struct Polytope {
    dimension: usize,
    facets: Vec<Halfspace>,
    vertices: Vec<PolytopePoint>,
    incidence: Incidence,
    low: PolytopePoint,
    high: PolytopePoint,
}

impl Polytope {
    /// The convex hull of points. Order and repetitions have no effect; components beyond `dimension` are
    /// ignored, the others are rounded to multiples of 2⁻⁴⁰.
    ///
    /// `None` if they all lie in a set thinner than [`RESOLUTION`], if a coordinate is NaN or beyond 1024,
    /// and for a dimension of 0 or above [`MAX_DIMENSION`].
    pub fn hull(dimension: usize, points: &[PolytopePoint]) -> Option<Self> {
        if !(1..=MAX_DIMENSION).contains(&dimension) {
            return None;
        }
        let lattice: Option<Vec<Lattice>> = points.iter().map(|p| exact::snapped(dimension, p)).collect();
        Self::hull_of_lattice(dimension, lattice?)
    }

    fn hull_of_lattice(dimension: usize, points: Vec<Lattice>) -> Option<Self> {
        if dimension == 1 {
            let (low, high) = (points.iter().min()?, points.iter().max()?);
            return Self::cuboid(1, &exact::coordinates(low), &exact::coordinates(high));
        }
        Hull::of(dimension, points)?.into_polytope()
    }

    /// The box from `low` to `high`. `None` if a side is shorter than [`RESOLUTION`], a coordinate is NaN or
    /// beyond 1024, and for a dimension of 0 or above [`MAX_DIMENSION`].
    pub fn cuboid(dimension: usize, low: &PolytopePoint, high: &PolytopePoint) -> Option<Self> {
        if !(1..=MAX_DIMENSION).contains(&dimension) {
            return None;
        }
        let mut facets = Vec::with_capacity(2 * dimension);
        for (axis, (low, high)) in low.iter().zip(high).enumerate().take(dimension) {
            if !exact::within_reach(*low) || !exact::within_reach(*high) {
                return None;
            }
            let mut normal = [0.0; MAX_DIMENSION];
            normal[axis] = -1.0;
            facets.push(Halfspace { normal, offset: -low });
            normal[axis] = 1.0;
            facets.push(Halfspace { normal, offset: *high });
        }
        let mut incidence = Incidence::new(1 << dimension, facets.len());
        let mut vertices = Vec::with_capacity(1 << dimension);
        for corner in 0..1usize << dimension {
            let mut vertex = [0.0; MAX_DIMENSION];
            for (axis, c) in vertex.iter_mut().enumerate().take(dimension) {
                *c = if corner >> axis & 1 == 1 { high[axis] } else { low[axis] };
            }
            vertices.push(vertex);
            incidence.push((0..dimension).map(|axis| 2 * axis + (corner >> axis & 1)));
        }
        Self::assembled(dimension, facets, vertices, incidence)
    }

    /// Assembles a polytope from consistent forms; `None` if it is thinner than [`RESOLUTION`].
    fn assembled(
        dimension: usize,
        facets: Vec<Halfspace>,
        vertices: Vec<PolytopePoint>,
        incidence: Incidence,
    ) -> Option<Self> {
        let thick = facets.iter().all(|f| vertices.iter().any(|v| f.excess(v) < -RESOLUTION));
        let (mut low, mut high) = (*vertices.first()?, *vertices.first()?);
        for vertex in &vertices {
            for ((low, high), c) in low.iter_mut().zip(&mut high).zip(vertex) {
                *low = low.min(*c);
                *high = high.max(*c);
            }
        }
        thick.then_some(Self { dimension, facets, vertices, incidence, low, high })
    }

    /// The dimension, 1 to [`MAX_DIMENSION`].
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The H-form: the facets, each with its outward unit normal. No two have the same vertices.
    pub fn facets(&self) -> &[Halfspace] {
        &self.facets
    }

    /// The V-form: the vertices, in no particular order.
    pub fn vertices(&self) -> &[PolytopePoint] {
        &self.vertices
    }

    /// The indices of a facet's vertices; empty for a facet that does not exist.
    pub fn facet_vertices(&self, facet: usize) -> impl Iterator<Item = usize> + '_ {
        let exists = facet < self.facets.len();
        (0..self.vertices.len()).filter(move |vertex| exists && self.incidence.has(*vertex, facet))
    }

    /// The indices of the facets on which a vertex lies; empty for a vertex that does not exist.
    pub fn vertex_facets(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        let exists = vertex < self.vertices.len();
        (0..self.facets.len()).filter(move |facet| exists && self.incidence.has(vertex, *facet))
    }

    /// Is there an edge between two vertices?
    pub fn is_edge(&self, a: usize, b: usize) -> bool {
        a.max(b) < self.vertices.len() && a != b && self.incidence.joined(a, b, self.dimension)
    }

    /// The smallest box around it: its lowest and its highest corner.
    pub fn bounds(&self) -> (PolytopePoint, PolytopePoint) {
        (self.low, self.high)
    }

    /// Does the point lie inside, on the border, or within [`RESOLUTION`] of all facets that it is outside of?
    pub fn contains(&self, point: &PolytopePoint) -> bool {
        self.facets.iter().all(|facet| facet.excess(point) <= RESOLUTION)
    }

    /// The support function: the largest `direction` · x over the polytope.
    pub fn support(&self, direction: &PolytopePoint) -> f64 {
        self.vertices.iter().map(|vertex| dot(direction, vertex)).fold(f64::NEG_INFINITY, f64::max)
    }
}

fn dot(a: &PolytopePoint, b: &PolytopePoint) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests;
