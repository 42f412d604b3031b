//! Tolerances of a region: the largest square in it, and the tolerance along each axis.
//!
//! The distance of a point from the outside, in the maximum norm, is half the side of the largest square
//! about it. It changes no faster than the point moves, so the plane is searched by halving cells and
//! discarding those whose bound is below the best found (branch and bound): the square is inside, and no
//! other is larger by more than the stated slack.

use super::cell::Cell;
use super::region::{Region, place, sides};
use glam::DVec2;
use serde::Serialize;
use std::collections::BinaryHeap;

/// Search until the side is known to this share of the extent.
const SLACK: f64 = 2e-5;
/// Largest number of cells examined; a ridge of equal squares would need many.
const MOST_CELLS: usize = 100_000;

/// The largest axis-parallel square in a region.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LargestSquare {
    /// Its centre.
    #[serde(serialize_with = "crate::points::point")]
    #[cfg_attr(feature = "schema", schemars(with = "[f64; 2]"))]
    pub center: DVec2,
    /// Its side.
    pub side: f64,
    /// Upper bound on the side of any square in the region.
    #[serde(rename = "side_at_most")]
    pub at_most: f64,
}

/// Tolerance along an axis, from a point to the nearest end of the region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisReach {
    /// Towards −x and +x.
    pub x: [f64; 2],
    /// Towards −y and +y.
    pub y: [f64; 2],
}

/// Most distances from a cell to a side.
const MOST_DISTANCES: usize = 400_000_000;

/// The borders of a region, for distances.
struct Borders<'r> {
    region: &'r Region,
    sides: Vec<[DVec2; 2]>,
}

impl<'r> Borders<'r> {
    fn of(region: &'r Region) -> Self {
        Self { region, sides: region.nodes().flat_map(sides).map(|ends| ends.map(place)).collect() }
    }

    /// Half the side of the largest square about a point; negative outside, by the distance to the region.
    fn room(&self, p: DVec2) -> f64 {
        let distance =
            self.sides.iter().map(|[a, b]| chessboard(*a - p, *b - p)).fold(f64::INFINITY, f64::min);
        if self.region.contains(p) { distance } else { -distance }
    }
}

/// The least larger coordinate, in size, along a segment.
fn chessboard(a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    // The minimum is at an end or at a point with |x| = |y|, x = 0 or y = 0.
    let zeros = [
        -(a.x - a.y) / (along.x - along.y),
        -(a.x + a.y) / (along.x + along.y),
        -a.x / along.x,
        -a.y / along.y,
    ];
    let inner = zeros.into_iter().filter(|t| *t > 0.0 && *t < 1.0).map(|t| a + along * t);
    [a, b].into_iter().chain(inner).map(|p| p.abs().max_element()).fold(f64::INFINITY, f64::min)
}

/// The largest axis-parallel square in a region; `None` if it has no area.
pub fn largest_square(region: &Region) -> Option<LargestSquare> {
    let [low, high] = region.bounds()?;
    let borders = Borders::of(region);
    if borders.sides.is_empty() {
        return None;
    }
    let extent = (high - low).max_element();
    let slack = SLACK * extent / 2.0;
    let cell = |center: DVec2, half: f64| {
        let room = borders.room(center);
        (room, Cell { center, half, bound: room + half, number: 0 })
    };
    let (mut room, first) = cell((low + high) / 2.0, extent / 2.0);
    let mut center = first.center;
    let mut open = BinaryHeap::from([first]);
    let mut looked = 0;
    let most = (MOST_DISTANCES / borders.sides.len()).min(MOST_CELLS);
    let mut bound = room;
    while let Some(next) = open.pop() {
        bound = next.bound;
        if next.bound <= room + slack || looked > most {
            break;
        }
        let half = next.half / 2.0;
        for (x, y) in [(-half, -half), (half, -half), (-half, half), (half, half)] {
            looked += 1;
            let (result, part) = cell(next.center + DVec2::new(x, y), half);
            if result > room {
                (room, center) = (result, part.center);
            }
            if part.bound > room + slack {
                open.push(part);
            }
        }
        bound = room + slack;
    }
    (room > 0.0).then(|| LargestSquare { center, side: 2.0 * room, at_most: 2.0 * bound.max(room) })
}

/// Half the side of the largest square about a point; `None` outside of the region.
pub fn square_about(region: &Region, point: DVec2) -> Option<f64> {
    region.contains(point).then(|| Borders::of(region).room(point).max(0.0))
}

/// Tolerances of a point along each axis within the region; `None` outside of it.
pub fn reach(region: &Region, point: DVec2) -> Option<AxisReach> {
    if !region.contains(point) {
        return None;
    }
    let mut crossings = [Vec::new(), Vec::new()];
    for [a, b] in region.nodes().flat_map(sides).map(|ends| ends.map(|end| place(end) - point)) {
        for (axis, result) in crossings.iter_mut().enumerate() {
            let (along, across) = (axis, 1 - axis);
            // An end on the axis belongs to the side above it, so that a corner is crossed once.
            if (a[across] > 0.0) != (b[across] > 0.0) {
                let t = a[across] / (a[across] - b[across]);
                result.push(a[along] + t * (b[along] - a[along]));
            }
        }
    }
    let ends = |result: &[f64]| {
        let below = result.iter().filter(|v| **v <= 0.0).fold(f64::INFINITY, |m, v| m.min(-v));
        let above = result.iter().filter(|v| **v >= 0.0).fold(f64::INFINITY, |m, v| m.min(*v));
        // On the border, rounding may hide a side: there is no room then.
        [below, above].map(|v| if v.is_finite() { v } else { 0.0 })
    };
    Some(AxisReach { x: ends(&crossings[0]), y: ends(&crossings[1]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_square_of_known_shapes() {
        let near = |square: LargestSquare, side: f64, extent: f64| {
            assert!(square.side <= side + 1e-9 && side <= square.at_most + 1e-9, "{square:?} {side}");
            assert!(square.at_most - square.side <= SLACK * extent + 1e-9, "{square:?}");
        };
        let bar = Region::rectangle(DVec2::ZERO, DVec2::new(30.0, 4.0));
        near(largest_square(&bar).unwrap(), 4.0, 30.0);
        let diamond = Region::of_outlines(&[[(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
            .map(|(x, y)| DVec2::new(x, y))
            .to_vec()]);
        let square = largest_square(&diamond).unwrap();
        near(square, 1.0, 2.0);
        assert!(square.center.length() < 1e-3);
        // Right-angled triangle with legs 1: half the leg.
        let triangle = Region::of_outlines(&[vec![DVec2::ZERO, DVec2::X, DVec2::Y]]);
        near(largest_square(&triangle).unwrap(), 0.5, 1.0);
        assert_eq!(largest_square(&Region::point(DVec2::X)), None);
    }

    #[test]
    fn the_way_to_the_border_stops_at_a_hole() {
        let outer = Region::rectangle(DVec2::splat(-3.0), DVec2::splat(3.0));
        let hole = Region::rectangle(DVec2::new(1.0, -1.0), DVec2::new(2.0, 1.0));
        let region = outer.minus(&hole);
        let reach = reach(&region, DVec2::ZERO).unwrap();
        assert_eq!((reach.x, reach.y), ([3.0, 1.0], [3.0, 3.0]));
        assert_eq!(super::reach(&region, DVec2::new(1.5, 0.0)), None);
        assert_eq!(square_about(&region, DVec2::ZERO), Some(1.0));
        assert_eq!(square_about(&region, DVec2::new(1.5, 0.0)), None);
    }
}
