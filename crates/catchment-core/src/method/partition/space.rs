//! The contact space: the part of the Minkowski sum's boundary that the approach meets first.
//!
//! ```text
//!   z ▲      ╱╲  roof of one polytope of the sum: the lowest of its upward facets' planes, over its shadow
//!     │  ╱╲ ╱  ╲
//!     │ ╱  ╳    ╲      a facet keeps the area that no other roof covers:
//!     │╱  ╱ ╲    ╲
//!     └──────────────▶ q     facet ∖ ⋃ { q in a shadow : every plane of that roof lies above the facet }
//! ```
//!
//! Each covered set is convex, so the difference is a set of polytopes over the pose errors q, one dimension
//! below that of the sum. The remainder tiles the shadow of the whole sum with convex cells, over each of
//! which the height of first contact is affine. If two roofs agree, the earlier roof keeps the area.
//!
//! The dissertation (section 5.1.3) keeps every boundary facet that faces up, also those under an overhang.
//! The approach meets the facets above them first, so they are omitted here.

use super::compose::{Compartment, compose};
use super::pieces::PiecePair;
use crate::exec::{Cancelled, Exec};
use crate::polytope::{Halfspace, MAX_DIMENSION, Polytope, PolytopePoint, RESOLUTION, minkowski_sum_of};
use crate::pose::DofSet;
use std::array;

/// `h(q) = slope·q + level`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine {
    /// ∂h/∂q: D per D, or D per radian.
    pub(super) slope: PolytopePoint,
    /// h at q = 0, in D.
    pub(super) level: f64,
}

impl Affine {
    /// The height over `q`, in D.
    pub(super) fn at(&self, q: &PolytopePoint) -> f64 {
        self.slope.iter().zip(q).map(|(s, q)| s * q).sum::<f64>() + self.level
    }

    /// Region in which this lies above `other`: a half-space, or everywhere, or nowhere; on equal planes
    /// `tie` decides.
    pub(super) fn above(&self, other: &Self, tie: bool) -> Covered {
        let normal: PolytopePoint = array::from_fn(|k| other.slope[k] - self.slope[k]);
        let rise = self.level - other.level;
        let steepness = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        // Planes whose difference changes by less than the resolution over a unit of q do not cross.
        if steepness > RESOLUTION
            && let Some(halfspace) = Halfspace::new(normal, rise)
        {
            return Covered::Where(halfspace);
        }
        let everywhere = if rise.abs() <= RESOLUTION { tie } else { rise > 0.0 };
        if everywhere { Covered::Everywhere } else { Covered::Nowhere }
    }
}

/// Region in which a plane lies above another.
pub(super) enum Covered {
    Everywhere,
    Nowhere,
    Where(Halfspace),
}

/// A polytope of the sum, seen from above.
#[derive(Debug, Clone)]
pub(super) struct Roof {
    /// Its shadow: the region in which it can be met at all.
    pub(super) shadow: Polytope,
    /// Its upward facets: for each its part of the shadow, and its plane.
    pub(super) facets: Vec<(Polytope, Affine)>,
    /// Its highest point, in D.
    top: f64,
}

/// A part of the contact space over which the height is affine.
#[derive(Debug, Clone)]
pub(super) struct Tile {
    /// The pose errors (of the COR) over which it lies.
    pub(super) region: Polytope,
    /// Height of first contact.
    pub(super) height: Affine,
}

/// The contact space over a compartment.
pub(super) fn tiles(
    pairs: &[PiecePair<'_>],
    compartment: &Compartment,
    free: DofSet,
    exec: &Exec,
) -> Result<Vec<Tile>, Cancelled> {
    envelope(&roofs(pairs, compartment, free, exec)?, exec)
}

/// All polytopes of the sum over a compartment, highest first.
pub(super) fn roofs(
    pairs: &[PiecePair<'_>],
    compartment: &Compartment,
    free: DofSet,
    exec: &Exec,
) -> Result<Vec<Roof>, Cancelled> {
    let mut roofs: Vec<Roof> = Vec::new();
    for PiecePair { fixed, moving, .. } in pairs {
        let dimension = moving.dimension + compartment.spans.len();
        for composite in compose(moving, compartment) {
            exec.check()?;
            let Some(sum) = minkowski_sum_of(dimension, &composite, &fixed.vertices) else { continue };
            roofs.extend(unlocked(sum, moving.dimension, free).and_then(|(sum, z)| Roof::of(&sum, z)));
        }
    }
    // Ties in height keep their order, so the result is the same on every machine.
    roofs.sort_by(|a, b| b.top.total_cmp(&a.top));
    Ok(roofs)
}

/// The cross-section at the aligned position of every translation that is locked, and the axis of the approach in it.
pub(super) fn unlocked(sum: Polytope, solid_dimension: usize, free: DofSet) -> Option<(Polytope, usize)> {
    use crate::pose::Dof;
    let mut approach = solid_dimension - 1;
    let mut sum = sum;
    if solid_dimension == 3 && !free.contains(Dof::Y) {
        sum = sum.slice(1, 0.0)?;
        approach -= 1;
    }
    if !free.contains(Dof::X) {
        sum = sum.slice(0, 0.0)?;
        approach -= 1;
    }
    Some((sum, approach))
}

impl Roof {
    fn of(sum: &Polytope, approach: usize) -> Option<Self> {
        let axes: Vec<usize> = (0..sum.dimension()).filter(|axis| *axis != approach).collect();
        let shadow = sum.project(&axes)?;
        let facets: Vec<(Polytope, Affine)> = sum
            .facets()
            .iter()
            .enumerate()
            .filter(|(_, facet)| facet.normal[approach] > RESOLUTION)
            .filter_map(|(k, facet)| {
                let up = facet.normal[approach];
                let mut slope = [0.0; MAX_DIMENSION];
                for (s, &axis) in slope.iter_mut().zip(&axes) {
                    *s = -facet.normal[axis] / up;
                }
                Some((sum.facet_projected(k, approach)?, Affine { slope, level: facet.offset / up }))
            })
            .collect();
        let top = sum.vertices().iter().map(|v| v[approach]).fold(f64::NEG_INFINITY, f64::max);
        Some(Self { shadow, facets, top })
    }

    /// The half-spaces within which this roof lies above a facet's plane; `None` if it nowhere does over the facet.
    fn covers(&self, facet: &Polytope, plane: &Affine, tie: bool) -> Option<Vec<Halfspace>> {
        // Most roofs are lower over the whole facet, or lie beside it; a few products detect this.
        let corners = facet.vertices();
        let lower = |roof: &Affine| corners.iter().all(|q| roof.at(q) < plane.at(q) - RESOLUTION);
        let beside = |side: &Halfspace| corners.iter().all(|q| side.excess(q) >= 0.0);
        if self.facets.iter().any(|(_, roof)| lower(roof)) || self.shadow.facets().iter().any(beside) {
            return None;
        }
        let mut cover = self.shadow.facets().to_vec();
        for (_, roof) in &self.facets {
            match roof.above(plane, tie) {
                Covered::Everywhere => {}
                Covered::Nowhere => return None,
                Covered::Where(halfspace) => cover.push(halfspace),
            }
        }
        Some(cover)
    }

    /// The height over `q`, if the roof lies there.
    #[cfg(test)]
    pub(super) fn height(&self, q: &PolytopePoint) -> Option<f64> {
        let lowest = || self.facets.iter().map(|(_, plane)| plane.at(q)).fold(f64::INFINITY, f64::min);
        self.shadow.contains(q).then(lowest)
    }
}

/// The part of every facet that is met first. `roofs` are sorted, highest first.
pub(super) fn envelope(roofs: &[Roof], exec: &Exec) -> Result<Vec<Tile>, Cancelled> {
    let mut tiles = Vec::new();
    for (k, roof) in roofs.iter().enumerate() {
        for (facet, plane) in &roof.facets {
            exec.check()?;
            let lowest = facet.vertices().iter().map(|q| plane.at(q)).fold(f64::INFINITY, f64::min);
            let mut left = vec![facet.clone()];
            for (other, cover) in roofs.iter().enumerate() {
                if other == k || left.is_empty() {
                    continue;
                }
                // The others are lower still.
                if cover.top < lowest {
                    break;
                }
                if !boxes_meet(&cover.shadow, &left) {
                    continue;
                }
                if let Some(cover) = cover.covers(facet, plane, other < k) {
                    left = left.into_iter().flat_map(|part| without(part, &cover)).collect();
                }
            }
            tiles.extend(joined(left).into_iter().map(|region| Tile { region, height: *plane }));
        }
    }
    Ok(tiles)
}

fn boxes_meet(shadow: &Polytope, parts: &[Polytope]) -> bool {
    let (low, high) = shadow.bounds();
    parts.iter().any(|part| {
        let (other_low, other_high) = part.bounds();
        (0..shadow.dimension()).all(|k| low[k] < other_high[k] && other_low[k] < high[k])
    })
}

/// A polytope without the intersection of half-spaces: disjoint convex parts.
fn without(part: Polytope, cover: &[Halfspace]) -> Vec<Polytope> {
    let excess = |halfspace: &Halfspace| {
        part.vertices().iter().map(|q| halfspace.excess(q)).fold(f64::INFINITY, f64::min)
    };
    // The part lies entirely beyond a half-space, so nothing is covered.
    if cover.iter().any(|halfspace| excess(halfspace) >= -RESOLUTION) {
        return vec![part];
    }
    let mut inside = part.clone();
    let mut outside = Vec::new();
    for halfspace in cover {
        let (within, beyond) = inside.split(halfspace);
        outside.extend(beyond);
        match within {
            Some(within) => inside = within,
            None => return vec![part],
        }
    }
    outside
}

/// Parts of a facet, merged if their union is convex: fewer cells to drain later.
fn joined(parts: Vec<Polytope>) -> Vec<Polytope> {
    if parts.len() < 2 { parts } else { super::pieces::joined(parts) }
}
