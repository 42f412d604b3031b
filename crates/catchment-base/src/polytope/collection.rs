//! Finite unions of polytopes: *P-collections*.
//!
//! The polytopes may overlap. Operations process polytope by polytope, so that their number can grow with the
//! product of the numbers; [`Collection::disjoint`] represents the same set by polytopes that do not overlap.

use super::{Polytope, PolytopePoint};

/// A finite union of polytopes of the same dimension. Empty without polytopes.
#[derive(Clone, Debug, Default)]
pub struct Collection {
    /// The polytopes, which may overlap.
    pub polytopes: Vec<Polytope>,
}

impl From<Polytope> for Collection {
    fn from(polytope: Polytope) -> Self {
        Self { polytopes: vec![polytope] }
    }
}

impl FromIterator<Polytope> for Collection {
    fn from_iter<I: IntoIterator<Item = Polytope>>(polytopes: I) -> Self {
        Self { polytopes: polytopes.into_iter().collect() }
    }
}

impl Collection {
    /// The intersection of both.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        self.pairs(other, Polytope::intersection)
    }

    /// The part of this outside the other; pieces of the same polytope do not overlap.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Self {
        self.polytopes.iter().flat_map(|polytope| without(polytope.clone(), &other.polytopes)).collect()
    }

    /// All sums of a point here and a point there.
    #[must_use]
    pub fn minkowski_sum(&self, other: &Self) -> Self {
        self.pairs(other, Polytope::minkowski_sum)
    }

    /// The shadow on these axes, in this order. Shadows thinner than [`super::RESOLUTION`] are left out.
    #[must_use]
    pub fn project(&self, axes: &[usize]) -> Self {
        self.polytopes.iter().filter_map(|polytope| polytope.project(axes)).collect()
    }

    /// The same set, of polytopes that do not overlap: from each, the part that no earlier polytope contains.
    #[must_use]
    pub fn disjoint(&self) -> Self {
        let polytopes = self.polytopes.iter().enumerate();
        polytopes.flat_map(|(index, polytope)| without(polytope.clone(), &self.polytopes[..index])).collect()
    }

    /// The measure of the set: overlaps count once.
    pub fn volume(&self) -> f64 {
        self.disjoint().polytopes.iter().map(Polytope::volume).sum()
    }

    /// Whether any of the polytopes contains the point.
    pub fn contains(&self, point: &PolytopePoint) -> bool {
        self.polytopes.iter().any(|polytope| polytope.contains(point))
    }

    /// An operation on all pairs.
    fn pairs(&self, other: &Self, operation: impl Fn(&Polytope, &Polytope) -> Option<Polytope>) -> Self {
        let operation = &operation;
        self.polytopes
            .iter()
            .flat_map(|a| other.polytopes.iter().filter_map(move |b| operation(a, b)))
            .collect()
    }
}

/// The part of a polytope in none of `others`.
fn without(polytope: Polytope, others: &[Polytope]) -> Vec<Polytope> {
    let mut pieces = vec![polytope];
    for other in others {
        pieces = pieces.iter().flat_map(|piece| piece.difference(other)).collect();
    }
    pieces
}
