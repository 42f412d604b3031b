//! The creases of a half: the edges at which its surface bends, each from end to end, independent of the
//! division of its faces into facets.
//!
//! ```text
//!   ┌───────┬───┐       the square has four creases: its diagonal is not a crease, because both sides are coplanar, and the
//!   │     ╱ │   │       upper crease is whole, although a facet ends in its middle
//!   │   ╱   │   │
//!   └───────┴───┘
//! ```
//!
//! The creases of a solid do not depend on its description, so symmetries are detected on creases and not on
//! facets.

use crate::connector::{Half, Surface};
use crate::tolerance;
use glam::DVec3;
use std::collections::BTreeMap;

/// Sine of the angle below which two facets, or two stretches of a crease, go straight on: as for the edges of a [`Surface`].
const FLAT_SINE: f64 = tolerance::SINGLE;

/// A crease.
#[derive(Debug, Clone)]
pub(super) struct Crease {
    /// Its ends.
    pub(super) ends: [DVec3; 2],
    /// The facets on both sides of a segment of it, counted over all surfaces of the half, and their outward
    /// normals.
    pub(super) facets: [u32; 2],
    pub(super) normals: [DVec3; 2],
    /// The surface, and the ends of that stretch, the lower number first.
    pub(super) surface: usize,
    pub(super) edge: [u32; 2],
}

impl Crease {
    pub(super) fn middle(&self) -> DVec3 {
        self.ends[0].midpoint(self.ends[1])
    }
}

/// All creases of a half.
pub(super) fn of(half: &Half) -> Vec<Crease> {
    let mut creases = Vec::new();
    let mut first = 0;
    for (number, surface) in half.surfaces.iter().enumerate() {
        of_surface(surface, number, first, &mut creases);
        first += surface.facets.len() as u32;
    }
    creases
}

/// A stretch of a crease: its ends and the facets on both sides.
type Stretch = ([u32; 2], [u32; 2]);

fn of_surface(surface: &Surface, number: usize, first: u32, creases: &mut Vec<Crease>) {
    let normal = |facet: u32| surface.facets[facet as usize].normal;
    let at = |corner: u32| surface.vertices[corner as usize];
    let bends =
        |[f, g]: [u32; 2]| normal(f).dot(normal(g)) < 0.0 || normal(f).cross(normal(g)).length() > FLAT_SINE;
    let mut sides: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for (facet, corners) in (0u32..).zip(surface.facets.iter().map(|facet| &facet.corners)) {
        for (k, a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            sides.entry([(*a).min(b), (*a).max(b)]).or_default().push(facet);
        }
    }
    let stretch = |(edge, facets): ([u32; 2], Vec<u32>)| Some((edge, <[u32; 2]>::try_from(facets).ok()?));
    let stretches: Vec<Stretch> =
        sides.into_iter().filter_map(stretch).filter(|(_, facets)| bends(*facets)).collect();
    let mut from: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (k, (ends, _)) in stretches.iter().enumerate() {
        for end in ends {
            from.entry(*end).or_default().push(k);
        }
    }
    // The segment that continues a segment in a straight line beyond its end.
    let goes_on = |k: usize, end: u32| -> Option<usize> {
        let [i, j] = <[usize; 2]>::try_from(&from.get(&end)?[..]).ok()?;
        let other = if i == k { j } else { i };
        let away = |k: usize| {
            let [a, b] = stretches[k].0;
            (at(if a == end { b } else { a }) - at(end)).normalize_or_zero()
        };
        let is_straight = away(k).cross(away(other)).length() <= FLAT_SINE && away(k).dot(away(other)) < 0.0;
        let [mine, its] = [k, other].map(|k| stretches[k].1);
        let is_flush = |[f, g]: [u32; 2]| !bends([mine[0], f]) && !bends([mine[1], g]);
        (is_straight && (is_flush(its) || is_flush([its[1], its[0]]))).then_some(other)
    };
    let mut is_done = vec![false; stretches.len()];
    for start in 0..stretches.len() {
        if std::mem::replace(&mut is_done[start], true) {
            continue;
        }
        let ends = stretches[start].0.map(|mut end| {
            let mut at = start;
            while let Some(next) = goes_on(at, end).filter(|next| !is_done[*next]) {
                is_done[next] = true;
                let [a, b] = stretches[next].0;
                (at, end) = (next, if a == end { b } else { a });
            }
            end
        });
        let (edge, facets) = stretches[start];
        creases.push(Crease {
            ends: ends.map(at),
            facets: facets.map(|facet| first + facet),
            normals: facets.map(normal),
            surface: number,
            edge,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::convex_hull;

    /// However a box is cut into boxes, it has twelve creases with the same ends.
    #[test]
    fn a_box_has_twelve_creases() {
        let block = |low: DVec3, high: DVec3| {
            let corner =
                |k: u8| DVec3::from_array([0, 1, 2].map(|i| if k >> i & 1 == 0 { low[i] } else { high[i] }));
            convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()
        };
        let ends = |half: &Half| {
            let mut ends: Vec<[[i64; 3]; 2]> = of(half)
                .iter()
                .map(|crease| {
                    let mut ends = crease.ends.map(|p| (p * 1e6).round().to_array().map(|v| v as i64));
                    ends.sort_unstable();
                    ends
                })
                .collect();
            ends.sort_unstable();
            ends
        };
        let whole = Half::of(vec![block(DVec3::ZERO, DVec3::ONE)]);
        assert_eq!(ends(&whole).len(), 12);
        let parts = [[0.0, 0.3], [0.3, 0.75], [0.75, 1.0]]
            .map(|[from, to]| block(DVec3::new(from, 0.0, 0.0), DVec3::new(to, 1.0, 1.0)));
        assert_eq!(ends(&Half::union_of(parts.to_vec()).unwrap()), ends(&whole));
    }
}
