//! Verifies that a surface separates inside from outside as the given solids do.
//!
//! ```text
//!   · outside of all solids            test points on both sides of the middle of each facet of the union, and of each
//!   ───×───  facet of the union        given facet: its winding number is 1 exactly at points inside some solid
//!   · inside of one of them
//! ```
//!
//! For many facets only every n-th is tested, so that the work is bounded. Not promised: features thinner
//! than the distance of the points from the facets.

use super::UnionProblem;
use crate::Surface;
use crate::mesh::indexed::Indexed;
use crate::mesh::shells::{solid_angle, winding};
use crate::mesh::tree::{Bounds, Tree, overlap};
use glam::DVec3;
use std::f64::consts::PI;

/// Positions of the test points over a facet, as shares of two of its corners, and their distance from it, in
/// w. A single point that agrees is sufficient: another may be on an edge of the union, or near a feature
/// thinner than the distance.
const PLACES: [([f64; 2], f64); 4] = [
    ([0.414_213, 0.317_837], 64.0),
    ([0.236_067, 0.449_489], 64.0),
    ([0.381_966, 0.302_775], 16.0),
    ([0.291_502, 0.360_679], 6.0),
];
/// Largest number of facet and triangle tests over all points together.
const MOST_STEPS: usize = 200_000_000;

/// Whether a mesh is the border of the union of solids.
pub(super) fn holds(mesh: &Indexed, solids: &[&Surface], w: f64) -> Result<(), UnionProblem> {
    let solids = Solids::of(solids);
    let all: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    let is_in_union = |p: DVec3| winding(mesh, &all, p).round() >= 1.0;
    let sides = |[a, b, c]: [DVec3; 3], ([first, second], off): ([f64; 2], f64)| {
        let place = a + (b - a) * first + (c - a) * second;
        let normal = (b - a).cross(c - a).normalize_or_zero() * (off * w);
        [place - normal, place + normal]
    };
    // A facet of the union has solid on one side and empty space on the other.
    let borders = |corners: [DVec3; 3]| {
        PLACES.iter().any(|place| sides(corners, *place).map(|p| solids.have(p)) == [true, false])
    };
    let per_triangle = solids.facets.max(1);
    let step = (mesh.triangles.len() * per_triangle).div_ceil(MOST_STEPS).max(1);
    let wrong = (0..mesh.triangles.len()).step_by(step).map(|k| mesh.corners(k)).find(|t| !borders(*t));
    if let Some([a, b, c]) = wrong {
        return Err(UnionProblem::Differs { at: ((a + b + c) / 3.0).into() });
    }
    // On both sides of a given facet, the solids and the union must agree.
    let agrees = |corners: [DVec3; 3]| {
        PLACES.iter().any(|place| sides(corners, *place).iter().all(|p| solids.have(*p) == is_in_union(*p)))
    };
    let given: Vec<[DVec3; 3]> = solids.triangles().collect();
    let step = (given.len() * (mesh.triangles.len() + per_triangle)).div_ceil(MOST_STEPS).max(1);
    match given.into_iter().step_by(step).find(|t| !agrees(*t)) {
        Some([a, b, c]) => Err(UnionProblem::Differs { at: ((a + b + c) / 3.0).into() }),
        None => Ok(()),
    }
}

/// Solids for point queries.
struct Solids<'a> {
    surfaces: &'a [&'a Surface],
    boxes: Vec<Bounds>,
    tree: Tree,
    facets: usize,
}

impl<'a> Solids<'a> {
    fn of(surfaces: &'a [&'a Surface]) -> Self {
        let boxes: Vec<Bounds> = surfaces.iter().map(|surface| surface.bounds()).collect();
        let facets = surfaces.iter().map(|surface| surface.facets.len()).sum();
        Self { surfaces, tree: Tree::over(&boxes), boxes, facets }
    }

    /// Whether any of them has a point.
    fn have(&self, p: DVec3) -> bool {
        let mut is_in = false;
        self.tree.visit(
            |bounds| overlap(bounds, (p, p)),
            |k| is_in = is_in || (overlap(self.boxes[k], (p, p)) && has(self.surfaces[k], p)),
        );
        is_in
    }

    /// Three corners of every facet, the first that are not collinear.
    fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.surfaces.iter().flat_map(|surface| {
            surface.facets.iter().map(|facet| {
                let at = |k: usize| surface.vertices[facet.corners[k] as usize];
                let fan = (1..facet.corners.len() - 1).map(|k| [at(0), at(k), at(k + 1)]);
                let area = |[a, b, c]: &[DVec3; 3]| (*b - *a).cross(*c - *a).length();
                fan.max_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or([at(0); 3])
            })
        })
    }
}

/// Whether a solid has a point.
fn has(surface: &Surface, p: DVec3) -> bool {
    let at = |k: u32| surface.vertices[k as usize] - p;
    if surface.convex {
        return surface.facets.iter().all(|facet| facet.normal.dot(at(facet.corners[0])) > 0.0);
    }
    let angle: f64 = surface
        .facets
        .iter()
        .flat_map(|facet| {
            let at = |k: usize| surface.vertices[facet.corners[k] as usize];
            (1..facet.corners.len() - 1).map(move |k| [at(0), at(k), at(k + 1)])
        })
        .map(|corners| solid_angle(corners, p))
        .sum();
    (angle / (4.0 * PI)).round() >= 1.0
}
