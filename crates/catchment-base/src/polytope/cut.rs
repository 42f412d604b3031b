//! Cut of a polytope by a plane, with the operations based on it: intersection, difference, overlap.
//!
//! ```text
//!      outside     o         Vertices are inside (i), outside (o) or on the plane (x), up to RESOLUTION. Every edge
//!                 ╱ ╲        from inside to outside gets a new vertex (n), on the facets of the edge and on the
//!   ─────────────n───x────   plane. A facet stays if it has a vertex inside.
//!      inside   ╱     ╲
//!              i───────i
//! ```
//!
//! Numbers only determine the classes of the vertices: all further decisions follow from the incidence of
//! vertices and facets. Both halves share the new vertices to the last bit, unless one had to be rebuilt as a
//! hull, which rounds them.
//!
//! Cost: vertices inside × vertices outside words, and a search for a third vertex per edge.

use super::incidence::{Incidence, ones};
use super::{Gap, Halfspace, Polytope, PolytopePoint, RESOLUTION};

/// Effect of a plane on a polytope.
enum Cut {
    /// Nothing of it is outside.
    Inside,
    /// Nothing of it is inside.
    Outside,
    /// It goes through.
    Through(Section),
}

/// The plane's way through a polytope.
struct Section {
    /// Distance of each vertex outside; 0 for those on the plane.
    excess: Vec<f64>,
    /// New vertices: position, and the two vertices of the edge.
    crossings: Vec<(PolytopePoint, usize, usize)>,
    /// There are vertices on the plane.
    touches: bool,
    /// Whether those are on it up to rounding, rather than by decision.
    gap: Gap,
}

impl Polytope {
    /// The part of it in a half-space: a copy if nothing is cut off, `None` if the rest is thinner than
    /// [`RESOLUTION`].
    #[must_use]
    pub fn cut(&self, by: &Halfspace) -> Option<Self> {
        match self.section(by) {
            Cut::Inside => Some(self.clone()),
            Cut::Outside => None,
            Cut::Through(section) => self.part(by, &section, 1.0),
        }
    }

    /// The parts inside and outside a half space.
    pub fn split(&self, by: &Halfspace) -> (Option<Self>, Option<Self>) {
        match self.section(by) {
            Cut::Inside => (Some(self.clone()), None),
            Cut::Outside => (None, Some(self.clone())),
            Cut::Through(section) => (self.part(by, &section, 1.0), self.part(&by.flipped(), &section, -1.0)),
        }
    }

    /// The part of it in all half spaces.
    #[must_use]
    pub fn intersection_of(&self, halfspaces: &[Halfspace]) -> Option<Self> {
        let mut rest: Option<Self> = None;
        for by in halfspaces {
            let whole = rest.as_ref().unwrap_or(self);
            match whole.section(by) {
                Cut::Inside => {}
                Cut::Outside => return None,
                Cut::Through(section) => rest = Some(whole.part(by, &section, 1.0)?),
            }
        }
        Some(rest.unwrap_or_else(|| self.clone()))
    }

    /// The intersection of both; `None` if it is thinner than [`RESOLUTION`], or their dimensions differ.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        if self.is_apart(other) { None } else { self.intersection_of(&other.facets) }
    }

    /// Whether their interiors meet; if not, they at most touch.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.intersection(other).is_some()
    }

    /// The part of this outside the other, as polytopes whose interiors do not meet; this polytope unchanged
    /// if it does not overlap the other.
    ///
    /// For each facet of the other in turn, the part outside becomes a piece and the part inside is processed
    /// further (*regiondiff*).
    #[must_use]
    pub fn difference(&self, other: &Self) -> Vec<Self> {
        if self.is_apart(other) {
            return vec![self.clone()];
        }
        let mut pieces = Vec::new();
        let mut rest: Option<Self> = None;
        for by in &other.facets {
            let whole = rest.as_ref().unwrap_or(self);
            match whole.section(by) {
                Cut::Inside => {}
                Cut::Outside => return vec![self.clone()],
                Cut::Through(section) => {
                    let outside = whole.part(&by.flipped(), &section, -1.0);
                    let Some(inside) = whole.part(by, &section, 1.0) else { return vec![self.clone()] };
                    pieces.extend(outside);
                    rest = Some(inside);
                }
            }
        }
        pieces
    }

    /// A fast sufficient test for disjoint interiors: the boxes are disjoint, or a facet of one has all of
    /// the other outside. True for different dimensions.
    fn is_apart(&self, other: &Self) -> bool {
        let boxes = |axis: usize| {
            self.high[axis] - other.low[axis] <= RESOLUTION || other.high[axis] - self.low[axis] <= RESOLUTION
        };
        let outside = |of: &Self, all: &Self| {
            of.facets.iter().any(|facet| all.vertices.iter().all(|v| facet.excess(v) >= -RESOLUTION))
        };
        self.dimension != other.dimension
            || (0..self.dimension).any(boxes)
            || outside(self, other)
            || outside(other, self)
    }

    /// The intersection with a plane.
    fn section(&self, by: &Halfspace) -> Cut {
        let mut excess: Vec<f64> = self.vertices.iter().map(|vertex| by.excess(vertex)).collect();
        let (mut inside, mut outside, mut touches, mut gap) = (false, false, false, Gap::NEW);
        for e in &mut excess {
            if gap.is_on(*e) {
                touches = true;
                *e = 0.0;
            } else if *e < 0.0 {
                inside = true;
            } else {
                outside = true;
            }
        }
        if !outside {
            return Cut::Inside;
        }
        if !inside {
            return Cut::Outside;
        }
        let mut crossings = Vec::new();
        for (a, below) in excess.iter().enumerate().filter(|(_, e)| **e < 0.0) {
            for (b, above) in excess.iter().enumerate().filter(|(_, e)| **e > 0.0) {
                if self.incidence.joined(a, b, self.dimension) {
                    let share = below / (below - above);
                    let (from, to) = (&self.vertices[a], &self.vertices[b]);
                    let point = std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]));
                    crossings.push((point, a, b));
                }
            }
        }
        Cut::Through(Section { excess, crossings, touches, gap })
    }

    /// The part with negative `side` · excess, which is inside `by`.
    fn part(&self, by: &Halfspace, section: &Section, side: f64) -> Option<Self> {
        let width = self.incidence.row(0).len();
        let mut staying = vec![0u64; width];
        let mut count = section.crossings.len();
        for (vertex, e) in section.excess.iter().enumerate() {
            if e * side < 0.0 {
                for (all, word) in staying.iter_mut().zip(self.incidence.row(vertex)) {
                    *all |= word;
                }
            }
            count += usize::from(e * side <= 0.0);
        }
        // The place that each facet that stays will have; the plane comes last.
        let mut places = vec![0; self.facets.len()];
        let mut facets = Vec::with_capacity(self.facets.len() + 1);
        for facet in ones(staying.iter().copied()) {
            places[facet] = facets.len();
            facets.push(self.facets[facet]);
        }
        let plane = facets.len();
        facets.push(*by);
        let mut vertices = Vec::with_capacity(count);
        let mut incidence = Incidence::new(count, facets.len());
        for (vertex, e) in section.excess.iter().enumerate() {
            if e * side <= 0.0 {
                vertices.push(self.vertices[vertex]);
                let kept = ones(self.incidence.row(vertex).iter().zip(&staying).map(|(a, b)| a & b));
                incidence.push(kept.map(|facet| places[facet]).chain((*e == 0.0).then_some(plane)));
            }
        }
        for &(point, a, b) in &section.crossings {
            vertices.push(point);
            let shared = ones(self.incidence.row(a).iter().zip(self.incidence.row(b)).map(|(a, b)| a & b));
            incidence.push(shared.map(|facet| places[facet]).chain([plane]));
        }
        let clear =
            !section.touches || section.gap.is_clear() && incidence.is_sound(self.dimension, facets.len());
        if !clear {
            return Self::hull(self.dimension, &vertices);
        }
        Self::assembled(self.dimension, facets, vertices, incidence)
    }
}
