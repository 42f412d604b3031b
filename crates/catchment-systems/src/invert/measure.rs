//! Properties of a new half: its shortfall from the wanted heights, and its contacts.

use super::cleaning::steepness;
use super::heights::{Heights, apart, common, width};
use super::{NARROW, REACHED, SIDEWAYS};
use catchment::connector::Half;
use catchment::method::zraa::area;
use catchment::tolerance::PARALLEL;
use glam::{DVec2, DVec3};
use serde::Serialize;

/// A place with unattainable heights: wanted heights that no moving half reaches.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Shortfall {
    /// Corners of the region of such offsets, a convex polygon, in D.
    #[serde(serialize_with = "crate::points::points")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<[f64; 2]>"))]
    pub polygon: Vec<DVec2>,
    /// Largest h* − h over the region, in D.
    pub most: f64,
    /// The offset of the largest difference, in D.
    #[serde(serialize_with = "crate::points::point")]
    #[cfg_attr(feature = "schema", schemars(with = "[f64; 2]"))]
    pub at: DVec2,
}

/// Regions in which the reached heights stay below the wanted heights, polygon by polygon, the deepest first.
///
/// A region narrower than [`NARROW`] is a side moved by rounding, and not a shortfall; neither is the height
/// change from moving a slope by [`SIDEWAYS`].
pub(super) fn shortfalls(wanted: &Heights, reached: &Heights) -> Vec<Shortfall> {
    let mut result = Vec::new();
    for want in &wanted.facets {
        for got in reached.facets.iter().filter(|got| !apart(&want.polygon, &got.polygon)) {
            let Some(polygon) = common(&want.polygon, &got.polygon) else { continue };
            let short = |p: &DVec2| want.height(*p) - got.height(*p);
            let (at, most) =
                polygon.iter().map(|p| (*p, short(p))).fold((polygon[0], f64::NEG_INFINITY), |best, next| {
                    if next.1 > best.1 { next } else { best }
                });
            if most > REACHED * steepness(want, got) && width(&polygon) > NARROW {
                result.push(Shortfall { polygon, most, at });
            }
        }
    }
    result.sort_by(|a, b| b.most.total_cmp(&a.most));
    result
}

/// The largest shortfall of each place, in order, at most `most`: a corner that polygons share is listed once.
pub(super) fn places(shortfalls: &[Shortfall], most: usize) -> Vec<Shortfall> {
    let mut places: Vec<Shortfall> = Vec::new();
    for short in shortfalls {
        if places.len() == most {
            break;
        }
        if places.iter().all(|other| other.at.distance(short.at) > 2.0 * SIDEWAYS) {
            places.push(short.clone());
        }
    }
    places
}

/// Area of the plan on which both surfaces are in contact at offset 0 and this height.
pub(super) fn patch(fixed: &Half, moving: &Heights, height: Option<f64>) -> f64 {
    let Some(height) = height else { return 0.0 };
    let mut touching = 0.0;
    for surface in &fixed.surfaces {
        for facet in surface.facets.iter().filter(|f| f.normal.z > PARALLEL) {
            let corners: Vec<DVec3> = facet.corners.iter().map(|k| surface.vertices[*k as usize]).collect();
            let plan: Vec<DVec2> = corners.iter().map(|c| c.truncate()).collect();
            let level = facet.normal.dot(corners[0]);
            let top = |p: DVec2| (level - facet.normal.truncate().dot(p)) / facet.normal.z;
            for own in &moving.facets {
                let Some(polygon) = common(&own.polygon, &plan) else { continue };
                if polygon.iter().all(|p| (top(*p) - own.height(*p) - height).abs() <= REACHED) {
                    touching += area(&polygon);
                }
            }
        }
    }
    touching
}
