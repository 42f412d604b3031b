//! Heights over the plane as pieces of planes, and the solids under and over them.

use catchment::connector::{Half, convex_hull};
use catchment::method::zraa::HeightFacet;
use glam::{DVec2, DVec3};

/// Polygons with less area than this, in D², are rounding.
const NO_AREA: f64 = 1e-13;
/// Points nearer than this, in D, are one.
const SAME_POINT: f64 = 1e-10;
/// Planes whose heights differ by less than this over a polygon, in D, are one.
pub(super) const SAME_PLANE: f64 = 1e-10;

/// A function of the lateral place, piecewise a plane over convex polygons; nothing outside of them. In D.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Heights {
    /// The pieces.
    pub facets: Vec<HeightFacet>,
}

/// Signed area, positive when counter-clockwise.
pub(super) fn area(polygon: &[DVec2]) -> f64 {
    let Some(&origin) = polygon.first() else { return 0.0 };
    polygon.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum::<f64>() / 2.0
}

/// The part of a convex polygon within another, both counter-clockwise; none where it is no more than rounding.
pub(super) fn common(polygon: &[DVec2], within: &[DVec2]) -> Option<Vec<DVec2>> {
    let mut rest = polygon.to_vec();
    for (k, &from) in within.iter().enumerate() {
        let along = (within[(k + 1) % within.len()] - from).normalize_or_zero();
        rest = cut(&rest, |p| along.perp_dot(p - from));
    }
    rest.dedup_by(|a, b| a.distance(*b) <= SAME_POINT);
    while rest.len() > 1 && rest[0].distance(rest[rest.len() - 1]) <= SAME_POINT {
        rest.pop();
    }
    (rest.len() > 2 && area(&rest) > NO_AREA).then_some(rest)
}

/// The part of a convex polygon where a linear function is not negative.
fn cut(polygon: &[DVec2], inside: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (da, db) = (inside(a), inside(b));
        if da >= 0.0 {
            out.push(a);
        }
        if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
            out.push(a.lerp(b, da / (da - db)));
        }
    }
    out
}

impl Heights {
    /// The largest value at a place; none where there is nothing.
    pub fn at(&self, place: DVec2) -> Option<f64> {
        let inside = |facet: &&HeightFacet| {
            let n = facet.polygon.len();
            (0..n).all(|k| {
                let along = (facet.polygon[(k + 1) % n] - facet.polygon[k]).normalize_or_zero();
                along.perp_dot(place - facet.polygon[k]) >= -SAME_POINT
            })
        };
        self.facets.iter().filter(inside).map(|facet| facet.height(place)).reduce(f64::max)
    }

    /// The part over a convex polygon.
    #[must_use]
    pub fn within(&self, polygon: &[DVec2]) -> Self {
        let part = |facet: &HeightFacet| {
            common(&facet.polygon, polygon).map(|polygon| HeightFacet { polygon, ..facet.clone() })
        };
        Self { facets: self.facets.iter().filter_map(part).collect() }
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

    /// Neighbouring pieces of one plane joined where they make a convex polygon.
    #[must_use]
    pub fn merged(mut self) -> Self {
        let mut k = 0;
        while k < self.facets.len() {
            let joined = (k + 1..self.facets.len())
                .find_map(|j| joined(&self.facets[k], &self.facets[j]).map(|polygon| (j, polygon)));
            match joined {
                Some((j, polygon)) => {
                    self.facets[k].polygon = polygon;
                    self.facets.swap_remove(j);
                    // What did not fit before may fit now.
                    k = 0;
                }
                None => k += 1,
            }
        }
        self
    }

    /// What lies above the function, up to a height, as convex pieces.
    pub fn above(&self, top: f64) -> Half {
        Half { surfaces: self.facets.iter().filter_map(|f| column(f, top)).collect() }
    }

    /// Corners of the convex pieces of what lies between the function and a height.
    pub fn columns(&self, end: f64) -> Vec<Vec<DVec3>> {
        self.facets.iter().map(|facet| column_corners(facet, end)).collect()
    }
}

fn column_corners(facet: &HeightFacet, end: f64) -> Vec<DVec3> {
    let ends = facet.polygon.iter().flat_map(|p| [p.extend(facet.height(*p)), p.extend(end)]);
    let mut corners: Vec<DVec3> = Vec::with_capacity(2 * facet.polygon.len());
    for p in ends {
        // A column may begin on its end.
        if corners.iter().all(|q| q.distance(p) > SAME_POINT) {
            corners.push(p);
        }
    }
    corners
}

fn column(facet: &HeightFacet, end: f64) -> Option<catchment::connector::Surface> {
    // A sliver that makes no solid has no area that could touch first by itself.
    convex_hull(&column_corners(facet, end)).ok()
}

/// The polygon of two pieces of one plane, where it is convex.
fn joined(a: &HeightFacet, b: &HeightFacet) -> Option<Vec<DVec2>> {
    let alike = |p: &DVec2| (a.height(*p) - b.height(*p)).abs() <= SAME_PLANE;
    if !a.polygon.iter().chain(&b.polygon).all(alike) {
        return None;
    }
    let hull = hull(a.polygon.iter().chain(&b.polygon).copied().collect());
    let both = area(&a.polygon) + area(&b.polygon);
    ((area(&hull) - both).abs() <= 1e-9 * both).then_some(hull)
}

/// The convex hull, counter-clockwise, without corners on a straight side.
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup_by(|a, b| a.distance(*b) <= SAME_POINT);
    let chain = |points: &mut dyn Iterator<Item = &DVec2>| {
        let mut hull: Vec<DVec2> = Vec::new();
        for &p in points {
            while hull.len() > 1 && {
                let (a, b) = (hull[hull.len() - 2], hull[hull.len() - 1]);
                (b - a).normalize_or_zero().perp_dot(p - a) <= SAME_POINT
            } {
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
        hull
    };
    let mut hull = chain(&mut points.iter());
    hull.extend(chain(&mut points.iter().rev()));
    hull
}
