//! Convex polygons of the plane, indexed by position.

use glam::DVec2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// The bounding boxes of polygons, each with its number, in a tree.
pub(super) struct PolygonIndex(RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>);

impl PolygonIndex {
    /// Of polygons; those whose boxes are less than `margin` apart count as overlapping.
    pub(super) fn new<'a>(polygons: impl Iterator<Item = &'a [DVec2]>, margin: f64) -> Self {
        let boxed = |(number, polygon)| {
            let (lo, hi) = bounds(polygon);
            let corners = [lo - margin, hi + margin].map(|corner| corner.to_array());
            GeomWithData::new(Rectangle::from_corners(corners[0], corners[1]), number)
        };
        Self(RTree::bulk_load(polygons.enumerate().map(boxed).collect()))
    }

    /// Numbers of those whose boxes overlap that of a polygon, in no order.
    pub(super) fn near(&self, polygon: &[DVec2]) -> impl Iterator<Item = usize> {
        let (lo, hi) = bounds(polygon);
        let envelope = AABB::from_corners(lo.to_array(), hi.to_array());
        self.0.locate_in_envelope_intersecting(envelope).map(|boxed| boxed.data)
    }

    /// The same, ascending.
    pub(super) fn overlapping(&self, polygon: &[DVec2]) -> Vec<usize> {
        let mut result: Vec<usize> = self.near(polygon).collect();
        result.sort_unstable();
        result
    }
}

fn bounds(polygon: &[DVec2]) -> (DVec2, DVec2) {
    polygon.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)))
}
