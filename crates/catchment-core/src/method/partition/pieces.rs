//! The halves as P-collections: convex pieces whose union is the half, exactly.
//!
//! ```text
//!   ┌────╲    ╱────┐      a non-convex surface is its convex hull, cut by the planes of the facets that meet
//!   │     ╲  ╱     │      along reflex edges until every part is entirely inside or outside; outer parts are removed
//!   └──────╲╱──────┘
//! ```
//!
//! A half that is an extrusion along y, moving in x and pitch, is represented by its profile in the x–z
//! plane: its pieces are polygons, and each meets only those whose slabs in y it overlaps.

use super::PartitionError;
use crate::connector::{Half, Surface};
use crate::contact::Pair;
use crate::polytope::{Halfspace, MAX_DIMENSION, Polytope, PolytopePoint};
use crate::pose::{Dof, DofSet};
use crate::tolerance::ROUNDING;
use glam::DVec3;

/// A convex piece of a half.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// 3 over (x, y, z); 2 over (x, z) of a profile.
    pub(super) dimension: usize,
    /// Its corners, in D.
    pub(super) vertices: Vec<PolytopePoint>,
    /// Which convex piece of its half it is, or is a strip of.
    pub(super) number: usize,
    /// The slab in y that the extrusion of a profile fills; [`EVERYWHERE`] for a solid.
    pub(super) slab: [f64; 2],
}

/// A slab that is no bound.
pub(super) const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Piece {
    fn of(polytope: &Polytope, number: usize, slab: [f64; 2]) -> Self {
        Self { dimension: polytope.dimension(), vertices: polytope.vertices().to_vec(), number, slab }
    }

    /// The slab in y that both fill.
    fn shared_slab(&self, other: &Self) -> Option<[f64; 2]> {
        let shared = [self.slab[0].max(other.slab[0]), self.slab[1].min(other.slab[1])];
        (shared[0] < shared[1]).then_some(shared)
    }
}

/// The convex pieces of both halves, those of the moving half relative to the COR.
#[derive(Debug)]
pub(super) struct Pieces {
    /// Of the fixed half.
    pub(super) fixed: Vec<Piece>,
    /// Of the moving half.
    pub(super) moving: Vec<Piece>,
}

/// Pieces of both halves that can meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct PiecePair<'a> {
    /// A piece of the fixed half.
    pub(super) fixed: &'a Piece,
    /// A piece of the moving half.
    pub(super) moving: &'a Piece,
    /// The slab in y that both fill.
    pub(super) slab: [f64; 2],
}

/// Most convex pieces of a half: beyond it the surface is a mesh that this method is not made for.
const MOST_PIECES: usize = 512;

/// Most pairs of pieces that can meet.
const MOST_PAIRS: usize = 100_000;

impl Pieces {
    /// The pieces of a pair: profiles if both halves are extrusions along y and only x and pitch are free,
    /// else solids. Those of the moving half are cut into strips narrower than `width`.
    pub(super) fn of(pair: &Pair, width: f64) -> Result<Self, PartitionError> {
        let [fixed, moving] = [&pair.fixed, &pair.moving].map(convex_pieces);
        let (fixed, moving) = (fixed?, moving?);
        let planar = DofSet::EMPTY.with(Dof::X).with(Dof::Pitch);
        let in_plane = pair.alignment.free.iter().all(|dof| planar.contains(dof));
        let profiles = |pieces: &[Polytope]| pieces.iter().map(profile).collect::<Option<Vec<_>>>();
        if let (true, Some(fixed), Some(moving)) = (in_plane, profiles(&fixed), profiles(&moving)) {
            Self::cut(&fixed, &moving, &[0], width)
        } else {
            let solids = |pieces: Vec<Polytope>| -> Vec<(Polytope, [f64; 2])> {
                pieces.into_iter().map(|piece| (piece, EVERYWHERE)).collect()
            };
            Self::cut(&solids(fixed), &solids(moving), &[0, 1], width)
        }
    }

    fn cut(
        fixed: &[(Polytope, [f64; 2])],
        moving: &[(Polytope, [f64; 2])],
        axes: &[usize],
        width: f64,
    ) -> Result<Self, PartitionError> {
        let whole = |(number, (polytope, slab)): (usize, &(Polytope, _))| Piece::of(polytope, number, *slab);
        let mut pieces = Self { fixed: fixed.iter().enumerate().map(whole).collect(), moving: Vec::new() };
        for (number, (polytope, slab)) in moving.iter().enumerate() {
            pieces.moving.extend(strips(polytope, axes, width).iter().map(|s| Piece::of(s, number, *slab)));
            if pieces.moving.len() > MOST_PAIRS {
                return Err(PartitionError::TooManyStrips { most: MOST_PAIRS });
            }
        }
        Ok(pieces)
    }

    /// The pairs that can meet.
    pub(super) fn pairs(&self) -> Result<Vec<PiecePair<'_>>, PartitionError> {
        let mut pairs = Vec::new();
        for moving in &self.moving {
            let met = |fixed| moving.shared_slab(fixed).map(|slab| PiecePair { fixed, moving, slab });
            pairs.extend(self.fixed.iter().filter_map(met));
            if pairs.len() > MOST_PAIRS {
                return Err(PartitionError::TooManyStrips { most: MOST_PAIRS });
            }
        }
        Ok(pairs)
    }
}

/// The profile of an extrusion along y, and its slab in y.
fn profile(polytope: &Polytope) -> Option<(Polytope, [f64; 2])> {
    let (low, high) = polytope.bounds();
    let ends = [low[1], high[1]];
    let at_an_end = |v: &PolytopePoint| ends.contains(&v[1]);
    if !polytope.vertices().iter().all(at_an_end) {
        return None;
    }
    let [near, far] = ends.map(|end| {
        let mut corners: Vec<[f64; 2]> =
            polytope.vertices().iter().filter(|v| v[1] == end).map(|v| [v[0], v[2]]).collect();
        corners.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        corners
    });
    (near == far).then(|| polytope.project(&[0, 2])).flatten().map(|profile| (profile, ends))
}

/// The polytope, cut across the given axes into parts of equal width below `width`.
fn strips(polytope: &Polytope, axes: &[usize], width: f64) -> Vec<Polytope> {
    let (low, high) = polytope.bounds();
    axes.iter().fold(vec![polytope.clone()], |parts, &axis| {
        let count = ((high[axis] - low[axis]) / width).ceil().max(1.0);
        let mut normal = [0.0; MAX_DIMENSION];
        normal[axis] = 1.0;
        let mut strips = Vec::new();
        let mut rest = parts;
        for k in 1..count as usize {
            let offset = low[axis] + (high[axis] - low[axis]) * k as f64 / count;
            let Some(plane) = Halfspace::new(normal, offset) else { continue };
            let mut beyond = Vec::new();
            for part in rest {
                let (inside, outside) = part.split(&plane);
                strips.extend(inside);
                beyond.extend(outside);
            }
            rest = beyond;
        }
        strips.extend(rest);
        strips
    })
}

/// Convex polytopes whose union is the half.
fn convex_pieces(half: &Half) -> Result<Vec<Polytope>, PartitionError> {
    let mut pieces = Vec::new();
    for surface in half.solids() {
        decompose(surface, &mut pieces)?;
        if pieces.len() > MOST_PIECES {
            return Err(PartitionError::TooManyPieces { most: MOST_PIECES });
        }
    }
    Ok(pieces)
}

fn decompose(surface: &Surface, pieces: &mut Vec<Polytope>) -> Result<(), PartitionError> {
    let points: Vec<PolytopePoint> = surface.vertices.iter().map(point).collect();
    let hull = Polytope::hull(3, &points).ok_or(PartitionError::FlatPiece)?;
    let mut cells = vec![hull];
    // Planes of facets that do not bound the hull are those at which the solid is hollow.
    for facet in &surface.facets {
        if surface.convex {
            break;
        }
        let offset = facet.normal.dot(surface.vertices[facet.corners[0] as usize]);
        let Some(plane) = Halfspace::new(point(&facet.normal), offset) else { continue };
        cells = cells
            .iter()
            .flat_map(|cell| {
                let (inside, outside) = cell.split(&plane);
                inside.into_iter().chain(outside)
            })
            .collect();
        if cells.len() > MOST_PIECES {
            return Err(PartitionError::TooManyPieces { most: MOST_PIECES });
        }
    }
    if !surface.convex {
        cells.retain(|cell| {
            let c = cell.centroid();
            is_inside(surface, DVec3::new(c[0], c[1], c[2]))
        });
    }
    pieces.extend(joined(cells));
    Ok(())
}

/// Cells whose union is convex, joined: two at a time while the hull of two is no larger than both.
pub(super) fn joined(mut cells: Vec<Polytope>) -> Vec<Polytope> {
    let mut first = 0;
    while first < cells.len() {
        let partner = (first + 1..cells.len()).find_map(|k| union(&cells[first], &cells[k]).map(|u| (k, u)));
        match partner {
            Some((k, union)) => {
                cells.swap_remove(k);
                cells[first] = union;
            }
            None => first += 1,
        }
    }
    cells
}

/// The union of two polytopes with disjoint interiors, if it is convex.
fn union(a: &Polytope, b: &Polytope) -> Option<Polytope> {
    // Volumes of order 1 are sums of as many terms as there are simplices: they round by about 1e-14.
    let corners: Vec<PolytopePoint> = a.vertices().iter().chain(b.vertices()).copied().collect();
    let hull = Polytope::hull(a.dimension(), &corners)?;
    let (whole, parts) = (hull.volume(), a.volume() + b.volume());
    ((whole - parts).abs() <= ROUNDING.max(1e-9 * parts)).then_some(hull)
}

/// Whether the solid angle of the surface, seen from the point, is the full sphere rather than nothing.
fn is_inside(surface: &Surface, from: DVec3) -> bool {
    let at = |i: u32| surface.vertices[i as usize] - from;
    let angle: f64 = surface
        .facets
        .iter()
        .flat_map(|facet| {
            let corners = &facet.corners;
            (1..corners.len() - 1).map(move |k| [at(corners[0]), at(corners[k]), at(corners[k + 1])])
        })
        .map(|[a, b, c]| {
            // Van Oosterom and Strackee (1983): tan(Ω/2) of a triangle.
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let across = a.dot(b.cross(c));
            let along = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * across.atan2(along)
        })
        .sum();
    angle > std::f64::consts::TAU
}

fn point(v: &DVec3) -> PolytopePoint {
    [v.x, v.y, v.z, 0.0, 0.0, 0.0]
}
