//! Boxes and extruded profiles.
//!
//! ```text
//!    ┌────────────┐        a hole is cut open along a bridge, so that the cap is one border that ear
//!    │   ┌──┐     │        clipping can process; the walls are not affected
//!    ├ ─ ┤  │     │
//!    │   └──┘     │
//!    └────────────┘
//! ```

use super::PartGeometryError;
use crate::Surface;
use crate::mesh::cut;
use crate::outline::{OutlineProblem, Region, crossing};
use catchment_base::budget::{Budget, Limit, Overspent};
use glam::{DVec2, DVec3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Comparisons of bridges with walls: for hundreds of holes there are some ten thousand bridges, each compared with all walls.
const STEPS: Limit = Limit {
    most: 100_000_000,
    of: "steps of joining holes to the outline around them",
    remedy: "draw fewer holes, or divide the part",
};

/// A box that stands on the origin, the middle of its floor.
pub(super) fn cuboid([x, y, z]: [f64; 3]) -> Result<Surface, PartGeometryError> {
    let half = DVec2::new(x, y) / 2.0;
    let corner = |k: u8| {
        let sign = |bit: u8| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
        DVec3::new(sign(0) * half.x, sign(1) * half.y, if k >> 2 == 0 { 0.0 } else { z })
    };
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let sides: Vec<Vec<u32>> = sides.iter().map(|side| side.to_vec()).collect();
    Ok(Surface::from_polygons((0..8).map(corner).collect(), &sides)?)
}

/// A region extruded from z = 0.
pub(crate) fn extruded(region: &Region, height: f64) -> Result<Surface, OutlineProblem> {
    let flat: Vec<DVec2> = region.loops().flatten().copied().collect();
    let n = flat.len() as u32;
    let mut polygons = Vec::new();
    let mut first = 0;
    for ring in region.loops() {
        let count = ring.len() as u32;
        for k in 0..count {
            let (a, b) = (first + k, first + (k + 1) % count);
            polygons.push(vec![a, b, n + b, n + a]);
        }
        first += count;
    }
    let border = bridged(region, &flat, &mut Budget::new(STEPS))?.ok_or(OutlineProblem::TooIntricate)?;
    let corners: Vec<DVec3> = border.iter().map(|k| flat[*k].extend(0.0)).collect();
    let cap = cut::triangles(&corners, &mut Budget::new(cut::STEPS))?.ok_or(OutlineProblem::TooIntricate)?;
    for triangle in cap {
        let [a, b, c] = triangle.map(|k| border[k] as u32);
        polygons.push(vec![n + a, n + b, n + c]);
        polygons.push(vec![c, b, a]);
    }
    let floor = flat.iter().map(|p| p.extend(0.0));
    let vertices = floor.chain(flat.iter().map(|p| p.extend(height))).collect();
    Surface::from_polygons(vertices, &polygons).map_err(|_| OutlineProblem::TooIntricate)
}

/// A line from a hole to the border, by the numbers of its ends.
struct Bridge {
    squared: f64,
    /// On the border.
    outer: usize,
    /// On the hole.
    inner: usize,
}

impl Ord for Bridge {
    /// The shortest last; ties are broken deterministically.
    fn cmp(&self, other: &Self) -> Ordering {
        let ends = |own: &Self| (own.outer, own.inner);
        other.squared.total_cmp(&self.squared).then_with(|| ends(other).cmp(&ends(self)))
    }
}

impl PartialOrd for Bridge {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Bridge {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Bridge {}

/// A single border of the region, by the numbers of its corners: every hole is connected to the rest along
/// the shortest bridge that crosses nothing and touches no other bridge. Among equally short bridges the
/// first along the current border is used, and of its holes the first of the first hole.
///
/// A bridge that crosses a wall always does, so every bridge is compared with the walls once.
fn bridged(region: &Region, flat: &[DVec2], steps: &mut Budget) -> Result<Option<Vec<usize>>, Overspent> {
    let mut rings: Vec<Vec<usize>> = Vec::new();
    // Of every corner its ring, and its place in it.
    let mut place: Vec<(usize, usize)> = Vec::with_capacity(flat.len());
    for (ring, corners) in region.loops().enumerate() {
        let first = place.len();
        rings.push((first..first + corners.len()).collect());
        place.extend((0..corners.len()).map(|k| (ring, k)));
    }
    let mut walls: Vec<[usize; 2]> = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]))
        .collect();
    let mut is_joined = vec![false; rings.len()];
    let mut used = vec![false; flat.len()];
    let mut border = rings[0].clone();
    is_joined[0] = true;
    let mut bridges = BinaryHeap::new();
    let reach = |from: &[usize], is_joined: &[bool], bridges: &mut BinaryHeap<Bridge>| {
        for inner in (0..flat.len()).filter(|k| !is_joined[place[*k].0]) {
            let squared = |outer: usize| flat[inner].distance_squared(flat[outer]);
            bridges.extend(from.iter().map(|outer| Bridge {
                squared: squared(*outer),
                outer: *outer,
                inner,
            }));
        }
    };
    reach(&border, &is_joined, &mut bridges);
    for _ in 1..rings.len() {
        let mut position = vec![0; flat.len()];
        for (k, corner) in border.iter().enumerate() {
            position[*corner] = k;
        }
        let mut taken = None;
        while taken.is_none() {
            let Some(first) = bridges.pop() else { return Ok(None) };
            let squared = first.squared;
            let mut equal = vec![first];
            while bridges.peek().is_some_and(|next| next.squared == squared) {
                equal.extend(bridges.pop());
            }
            equal.retain(|bridge| !used[bridge.outer] && !is_joined[place[bridge.inner].0]);
            equal.sort_by_key(|bridge| std::cmp::Reverse((position[bridge.outer], bridge.inner)));
            while taken.is_none() {
                let Some(bridge) = equal.pop() else { break };
                let (p, q) = (bridge.outer, bridge.inner);
                steps.spend(walls.len() as u64)?;
                let is_clear = walls.iter().all(|[a, b]| {
                    [a, b].iter().any(|k| **k == p || **k == q)
                        || crossing([flat[p], flat[q]], [flat[*a], flat[*b]], 0.0).is_none()
                });
                taken = is_clear.then_some((p, q));
            }
            bridges.extend(equal);
        }
        let Some((p, q)) = taken else { return Ok(None) };
        let (ring, inner) = place[q];
        let ring_corners = &rings[ring];
        walls.push([p, q]);
        (used[p], used[q]) = (true, true);
        // In along the bridge, around the hole, and out again.
        let around = (0..=ring_corners.len()).map(|k| ring_corners[(inner + k) % ring_corners.len()]);
        let inserted: Vec<usize> = around.chain([p]).collect();
        let outer = position[p];
        border.splice(outer + 1..=outer, inserted);
        is_joined[ring] = true;
        reach(ring_corners, &is_joined, &mut bridges);
    }
    Ok(Some(border))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::regions;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn polygon(center: DVec2, radius: f64, corners: usize) -> Vec<DVec2> {
        (0..corners)
            .map(|k| center + radius * DVec2::from_angle(TAU * k as f64 / corners as f64 + 0.1))
            .collect()
    }

    fn area(corners: usize, radius: f64) -> f64 {
        let n = corners as f64;
        n * radius * radius * (TAU / n).sin() / 2.0
    }

    proptest! {
        /// A plate with holes in any places has the volume of its drawing.
        #[test]
        fn a_plate_with_holes(holes in prop::collection::vec((3usize..14, 0.02..0.1f64), 1..17), shift in 0.0..0.05f64) {
            let mut loops = vec![vec![DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::ONE, DVec2::new(0.0, 1.0)]];
            let mut left = 1.0;
            for (k, (corners, radius)) in holes.iter().enumerate() {
                let center = DVec2::new(0.125 + (k % 4) as f64 / 4.0, 0.125 + (k / 4) as f64 / 4.0);
                loops.push(polygon(center + shift / 4.0, *radius, *corners));
                left -= area(*corners, *radius);
            }
            let regions = regions(loops).unwrap();
            prop_assert_eq!(regions.len(), 1);
            let plate = extruded(&regions[0], 0.5).unwrap();
            prop_assert!((plate.volume() - left / 2.0).abs() < 1e-12);
        }

        #[test]
        fn a_star_has_its_volume(radii in prop::collection::vec(0.2..2.0f64, 3..40)) {
            let n = radii.len();
            let corners: Vec<DVec2> =
                radii.iter().enumerate().map(|(k, r)| DVec2::from_angle(TAU * k as f64 / n as f64) * *r).collect();
            let twice: f64 = (0..n).map(|k| corners[k].perp_dot(corners[(k + 1) % n])).sum();
            prop_assume!(twice > 0.0);
            let star = extruded(&regions(vec![corners]).unwrap()[0], 3.0).unwrap();
            prop_assert!((star.volume() / (1.5 * twice) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_box_stands_on_its_floor() {
        let solid = cuboid([1.0, 2.0, 3.0]).unwrap();
        assert_eq!(solid.bounds(), (DVec3::new(-0.5, -1.0, 0.0), DVec3::new(0.5, 1.0, 3.0)));
        assert!(solid.convex && solid.edges.len() == 12);
        assert!((solid.volume() - 6.0).abs() < 1e-12);
    }
}
