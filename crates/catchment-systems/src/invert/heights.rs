//! Heights over the plane as pieces of planes, and the solids below and above them.

use super::{NARROW, ROUNDED};
use catchment::connector::{Half, Surface};
use catchment::method::zraa::{HeightFacet, area, clip};
use glam::{DVec2, DVec3};

/// A function of the lateral place, piecewise a plane over convex polygons; nothing outside of them. In D.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Heights {
    /// The pieces.
    pub facets: Vec<HeightFacet>,
}

/// The part of a convex polygon within another, both counter-clockwise; `None` if it is due to rounding.
pub(super) fn common(polygon: &[DVec2], within: &[DVec2]) -> Option<Vec<DVec2>> {
    if apart(polygon, within) {
        return None;
    }
    let mut rest = polygon.to_vec();
    for (k, &from) in within.iter().enumerate() {
        let along = (within[(k + 1) % within.len()] - from).normalize_or_zero();
        rest = clip(&rest, |p| along.perp_dot(p - from));
    }
    rest.dedup_by(|a, b| a.distance(*b) <= ROUNDED);
    while rest.len() > 1 && rest[0].distance(rest[rest.len() - 1]) <= ROUNDED {
        rest.pop();
    }
    (rest.len() > 2 && width(&rest) > ROUNDED).then_some(rest)
}

/// Whether the boxes of two polygons are apart.
pub(super) fn apart(a: &[DVec2], b: &[DVec2]) -> bool {
    let [(la, ha), (lb, hb)] = [a, b].map(|polygon| {
        polygon.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)))
    });
    la.cmpgt(hb).any() || lb.cmpgt(ha).any()
}

/// The least width of a convex polygon.
pub(super) fn width(polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    let across = |k: usize| {
        let side = polygon[(k + 1) % n] - polygon[k];
        let far = |along: DVec2| polygon.iter().map(|p| along.perp_dot(*p - polygon[k])).fold(0.0, f64::max);
        side.try_normalize().map_or(f64::INFINITY, far)
    };
    (0..n).map(across).fold(f64::INFINITY, f64::min)
}

/// Whether a place lies in a convex polygon, or no more than rounding outside.
pub(super) fn holds(polygon: &[DVec2], place: DVec2) -> bool {
    (0..polygon.len()).all(|k| {
        let along = (polygon[(k + 1) % polygon.len()] - polygon[k]).normalize_or_zero();
        along.perp_dot(place - polygon[k]) >= -ROUNDED
    })
}

impl Heights {
    /// The largest value at a position; `None` outside.
    pub fn at(&self, place: DVec2) -> Option<f64> {
        let here = self.facets.iter().filter(|facet| holds(&facet.polygon, place));
        here.map(|facet| facet.height(place)).reduce(f64::max)
    }

    /// The part over a convex polygon.
    #[must_use]
    pub fn within(&self, polygon: &[DVec2]) -> Self {
        let part = |facet: &HeightFacet| {
            common(&facet.polygon, polygon).map(|polygon| HeightFacet { polygon, ..facet.clone() })
        };
        Self { facets: self.facets.iter().filter_map(part).collect() }
    }

    /// The function without its pieces narrower than [`NARROW`]: at the meeting of two contacts rounding can
    /// leave a crack between them, in which something far below is visible. Such a low wish at a single
    /// position would have a large effect on the other half.
    pub(super) fn without_cracks(&self) -> Self {
        let wide = |facet: &&HeightFacet| width(&facet.polygon) > NARROW;
        Self { facets: self.facets.iter().filter(wide).cloned().collect() }
    }

    /// All corners with their heights.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.facets.iter().flat_map(|f| f.polygon.iter().map(|p| p.extend(f.height(*p))))
    }

    /// Lowest and highest value.
    pub fn range(&self) -> Option<[f64; 2]> {
        let first = self.corners().next()?.z;
        Some(self.corners().fold([first; 2], |[lo, hi], p| [lo.min(p.z), hi.max(p.z)]))
    }

    /// Area of its plan, in D².
    pub fn area(&self) -> f64 {
        self.facets.iter().map(|facet| area(&facet.polygon)).sum()
    }

    /// The region above the function, up to a height above all of it, as convex columns.
    pub fn above(&self, top: f64) -> Half {
        Half::of(self.facets.iter().filter_map(|f| column(f, top)).collect())
    }

    /// Corners of the convex pieces of the region between the function and a height.
    pub fn columns(&self, end: f64) -> Vec<Vec<DVec3>> {
        self.facets.iter().map(|facet| column_corners(facet, end)).collect()
    }
}

fn column_corners(facet: &HeightFacet, end: f64) -> Vec<DVec3> {
    let ends = facet.polygon.iter().flat_map(|p| [p.extend(facet.height(*p)), p.extend(end)]);
    let mut corners: Vec<DVec3> = Vec::with_capacity(2 * facet.polygon.len());
    for p in ends {
        // A column may begin on its end.
        if corners.iter().all(|q| q.distance(p) > ROUNDED) {
            corners.push(p);
        }
    }
    corners
}

/// The prism over a polygon, from its plane up to a level. Its lower side has the plane's own normal: a
/// normal from the corners of a narrow polygon would differ.
fn column(facet: &HeightFacet, top: f64) -> Option<Surface> {
    let n = facet.polygon.len() as u32;
    let below = facet.polygon.iter().map(|p| p.extend(facet.height(*p)));
    let vertices: Vec<DVec3> = below.chain(facet.polygon.iter().map(|p| p.extend(top))).collect();
    let mut polygons: Vec<Vec<u32>> = vec![(0..n).rev().collect(), (n..2 * n).collect()];
    polygons.extend((0..n).map(|k| {
        let next = (k + 1) % n;
        vec![k, next, next + n, k + n]
    }));
    let mut surface = Surface::from_polygons(vertices, &polygons).ok()?;
    surface.facets[0].normal = facet.gradient.extend(-1.0).normalize();
    Some(surface)
}
