//! Removal of pieces caused by rounding.
//!
//! ```text
//!   ┌───────┬┬──────┐        ┌────────┬──────┐      two contacts with nearly the same plane cross at a place set by rounding: the strip
//!   │   A   ││  B   │   ─▶   │   A    │  B   │      between them is narrower than any feature that can be made
//!   └───────┴┴──────┘        └────────┴──────┘
//! ```
//!
//! A mesh has many facets that were coplanar before its corners were rounded, and upright walls that lean.
//! The last digits then decide at which line two nearly equal planes intersect, and the pieces of an envelope
//! have slivers and corners 10⁻⁸ D apart, which no reader accepts as a solid. Three steps:
//!
//! 1. Coplanar neighbours are merged if the union is convex.
//! 2. A sliver, narrower than [`NARROW`], is given to the neighbours along it, whose sides move over it:
//!    first those whose planes differ there by at most [`ROUNDED`]; if they do not cover it, also those that
//!    are higher; at the rim it may be dropped.
//! 3. A side that ends before it begins is removed, if its neighbours meet just beyond it; if they would
//!    cover something higher, a side shorter than [`COINCIDENT`] collapses to its middle.
//!
//! So the function changes by at most [`ROUNDED`] in height or [`SIDEWAYS`] sideways, except at slivers of
//! another height than all around them, such as leaning walls: there it rises, in a strip narrower than
//! [`NARROW`], and a higher surface of the moving half does not stop it higher.
//!
//! Sides move outward only: the columns over the pieces overlap by as little as they moved, and no gap opens.
//! The lower of overlapping columns counts, so a side moves over another piece only if that piece is not
//! higher.

use super::heights::{Heights, apart, common, width};
use super::{NARROW, ROUNDED, SIDEWAYS};
use catchment::method::zraa::{HeightFacet, area, clip};
use catchment::polytope::planar_hull;
use catchment::tolerance::COINCIDENT;
use glam::DVec2;

impl Heights {
    /// The same function, to `ROUNDED` in height and `SIDEWAYS` to the side, without the pieces that rounding made.
    #[must_use]
    pub fn tidied(self) -> Self {
        self.merged().without_slivers().merged().without_short_sides().without_slivers()
    }

    /// Coplanar neighbouring pieces merged if they form a convex polygon.
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
                    // Pieces that could not be merged before may be merged now.
                    k = 0;
                }
                None => k += 1,
            }
        }
        self
    }

    fn without_slivers(mut self) -> Self {
        let mut kept = vec![true; self.facets.len()];
        let mut narrow: Vec<(f64, usize)> =
            self.facets.iter().enumerate().map(|(k, facet)| (width(&facet.polygon), k)).collect();
        narrow.retain(|(width, _)| *width < NARROW);
        narrow.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, k) in narrow {
            kept[k] = false;
            for (j, polygon) in self.taken_over(k, &kept) {
                self.facets[j].polygon = polygon;
            }
        }
        let mut kept = kept.into_iter();
        self.facets.retain(|_| kept.next().unwrap_or(true));
        self
    }

    /// The neighbours of a sliver with their sides moved over it: level neighbours, and higher ones if those
    /// do not cover it.
    fn taken_over(&self, sliver: usize, kept: &[bool]) -> Vec<(usize, Vec<DVec2>)> {
        let thin = &self.facets[sliver];
        let long = longest_side(&thin.polygon);
        let reach = |polygon: &[DVec2]| {
            let along = polygon.iter().map(|p| long.dot(*p));
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), t| (lo.min(t), hi.max(t)))
        };
        let (start, end) = reach(&thin.polygon);
        let (mut level, mut higher, mut covered) = (Vec::new(), Vec::new(), Vec::new());
        for (j, facet) in self.facets.iter().enumerate() {
            if !kept[j] || !near(&facet.polygon, &thin.polygon) {
                continue;
            }
            let Some((polygon, part)) = moved_over(&facet.polygon, &thin.polygon) else { continue };
            let most = ROUNDED * steepness(facet, thin);
            let above = |p: &DVec2| facet.height(*p) - thin.height(*p);
            if part.iter().any(|p| above(p) < -most) || !self.may_become(j, &polygon, kept) {
                continue;
            }
            if part.iter().all(|p| above(p) <= most) {
                covered.push(reach(&part));
                level.push((j, polygon));
            } else {
                higher.push((j, polygon));
            }
        }
        covered.sort_by(|a, b| a.0.total_cmp(&b.0));
        let reached =
            covered.iter().fold(start, |to, (lo, hi)| if *lo <= to + SIDEWAYS { to.max(*hi) } else { to });
        if reached < end - SIDEWAYS {
            level.append(&mut higher);
        }
        level
    }

    /// Whether a piece may grow to a polygon: no more than [`SIDEWAYS`], or over nothing that it would lower.
    fn may_become(&self, piece: usize, polygon: &[DVec2], kept: &[bool]) -> bool {
        let own = &self.facets[piece];
        is_convex(polygon)
            && self.facets.iter().enumerate().filter(|(j, _)| *j != piece && kept[*j]).all(|(_, other)| {
                let Some(over) = common(&other.polygon, polygon) else { return true };
                width(&over) <= SIDEWAYS
                    || over
                        .iter()
                        .all(|p| other.height(*p) - own.height(*p) <= ROUNDED * steepness(own, other))
            })
    }

    fn without_short_sides(mut self) -> Self {
        let kept = vec![true; self.facets.len()];
        for k in 0..self.facets.len() {
            while let Some(polygon) = fewer_sides(&self.facets[k].polygon) {
                if !self.may_become(k, &polygon, &kept) {
                    break;
                }
                self.facets[k].polygon = polygon;
            }
            while let Some(polygon) = without_point_sides(&self.facets[k].polygon) {
                self.facets[k].polygon = polygon;
            }
        }
        self
    }
}

/// Factor from a distance between two planes to a height: at a wall, sideways rounding has a large effect.
pub(super) fn steepness(a: &HeightFacet, b: &HeightFacet) -> f64 {
    1.0 + a.gradient.length().max(b.gradient.length())
}

/// Whether a polygon turns left at every corner, once around: a moved side may leave a tiny polygon that does
/// not.
fn is_convex(polygon: &[DVec2]) -> bool {
    let n = polygon.len();
    let left = |k: usize| {
        let [u, v] = [polygon[(k + 1) % n] - polygon[k], polygon[(k + 2) % n] - polygon[(k + 1) % n]];
        u.perp_dot(v) >= 0.0 && u.dot(v) > -u.length() * v.length()
    };
    (0..n).all(left) && width(polygon) > 0.0
}

fn longest_side(polygon: &[DVec2]) -> DVec2 {
    let sides = (0..polygon.len()).map(|k| polygon[(k + 1) % polygon.len()] - polygon[k]);
    sides
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        .unwrap_or_default()
        .normalize_or_zero()
}

/// Whether the boxes of two polygons are no farther apart than pieces may be moved.
fn near(a: &[DVec2], b: &[DVec2]) -> bool {
    let margin = DVec2::splat(SIDEWAYS);
    let wider: Vec<DVec2> = b.iter().flat_map(|p| [*p - margin, *p + margin]).collect();
    !apart(a, &wider)
}

/// A polygon with that side moved outward behind which a sliver lies, and the part of the sliver in front of that side.
fn moved_over(polygon: &[DVec2], sliver: &[DVec2]) -> Option<(Vec<DVec2>, Vec<DVec2>)> {
    let n = polygon.len();
    (0..n).find_map(|k| {
        let (from, to) = (polygon[k], polygon[(k + 1) % n]);
        let along = (to - from).try_normalize()?;
        let out = |p: DVec2| -along.perp_dot(p - from);
        // The part of the sliver in front of this side.
        let part = clip(&clip(sliver, |p| along.dot(p - from)), |p| along.dot(to - p));
        let (least, most) = part
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(out(*p)), h.max(out(*p))));
        let spread = part.iter().map(|p| along.dot(*p - part[0]));
        let (lo, hi) = spread.fold((0.0f64, 0.0f64), |(l, h), t| (l.min(t), h.max(t)));
        let in_front = part.len() > 1 && least.abs() <= SIDEWAYS && most <= NARROW && hi - lo > SIDEWAYS;
        in_front.then(|| Some((moved(polygon, k, most)?, part)))?
    })
}

/// A convex polygon with one side moved outward; `None` if its neighbours no longer meet it.
fn moved(polygon: &[DVec2], side: usize, by: f64) -> Option<Vec<DVec2>> {
    let n = polygon.len();
    let at = |k: usize| polygon[(k + n) % n];
    let (from, to) = (at(side), at(side + 1));
    let along = (to - from).try_normalize()?;
    let line = (from - along.perp() * by, along);
    let before = (from, (from - at(side + n - 1)).try_normalize()?);
    let after = (to, (at(side + 2) - to).try_normalize()?);
    let mut out = polygon.to_vec();
    out[side] = met(before, line).unwrap_or(line.0);
    out[(side + 1) % n] = met(after, line).unwrap_or(to - along.perp() * by);
    Some(out)
}

/// Intersection of two lines, each a point and a direction; `None` if they are nearly parallel.
fn met((p, u): (DVec2, DVec2), (q, v): (DVec2, DVec2)) -> Option<DVec2> {
    /// Smallest sine between lines whose intersection is used.
    const LEAST_SINE: f64 = 1e-3;
    let sine = u.perp_dot(v);
    (sine.abs() > LEAST_SINE).then(|| p + u * ((q - p).perp_dot(v) / sine))
}

/// The polygon without the side whose neighbours meet nearest beyond it; `None` if that is farther than the
/// width of a sliver.
fn fewer_sides(polygon: &[DVec2]) -> Option<Vec<DVec2>> {
    let n = polygon.len();
    if n < 4 {
        return None;
    }
    let at = |k: usize| polygon[k % n];
    let without = |k: usize| {
        // The side from k to k + 1; before it the side from k − 1, after it that to k + 2.
        let (from, to) = (at(k), at(k + 1));
        let (u, v) = (from - at(k + n - 1), at(k + 2) - to);
        let along = (to - from).normalize_or_zero();
        let turn = u.perp_dot(v);
        if turn <= 0.0 {
            return None;
        }
        let corner = from + u * ((to - from).perp_dot(v) / turn);
        let beyond = -along.perp_dot(corner - from);
        // A needle is cut, not extended: the corner of its sides would lie far away.
        let near = corner.distance(from).min(corner.distance(to)) <= NARROW;
        (near && beyond <= NARROW).then_some((beyond.max(0.0), k, corner))
    };
    let (_, side, corner) =
        (0..n).filter_map(without).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
    let mut out = polygon.to_vec();
    out[side] = corner;
    out.remove((side + 1) % n);
    Some(out)
}

/// The polygon with a side that readers treat as a point collapsed to its middle; `None` if all sides are
/// longer.
fn without_point_sides(polygon: &[DVec2]) -> Option<Vec<DVec2>> {
    let n = polygon.len();
    let side = (0..n).find(|k| n > 3 && polygon[*k].distance(polygon[(k + 1) % n]) <= COINCIDENT)?;
    let mut out = polygon.to_vec();
    out[side] = polygon[side].midpoint(polygon[(side + 1) % n]);
    out.remove((side + 1) % n);
    Some(out)
}

/// The polygon of two coplanar pieces, if it is convex.
fn joined(a: &HeightFacet, b: &HeightFacet) -> Option<Vec<DVec2>> {
    let most = ROUNDED * steepness(a, b);
    let alike = |p: &DVec2| (a.height(*p) - b.height(*p)).abs() <= most;
    if !near(&a.polygon, &b.polygon) || !a.polygon.iter().chain(&b.polygon).all(alike) {
        return None;
    }
    let hull = hull(a.polygon.iter().chain(&b.polygon).copied().collect());
    let around: f64 = (0..hull.len()).map(|k| hull[k].distance(hull[(k + 1) % hull.len()])).sum();
    let added = area(&hull) - area(&a.polygon) - area(&b.polygon);
    // No notch of another plane is covered, however small.
    let on_border = |p: &DVec2| {
        (0..hull.len()).any(|k| {
            let along = (hull[(k + 1) % hull.len()] - hull[k]).normalize_or_zero();
            along.perp_dot(*p - hull[k]) <= ROUNDED
        })
    };
    let convex = a.polygon.iter().chain(&b.polygon).all(on_border);
    (convex && added.abs() <= ROUNDED * around).then_some(hull)
}

/// The convex hull, counter-clockwise, without corners on a straight side.
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup_by(|a, b| a.distance(*b) <= ROUNDED);
    planar_hull(&points, |a, b, c| (b - a).normalize_or_zero().perp_dot(c - a) > ROUNDED)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane through `height` at (1, 0) with a gradient, over a box.
    fn facet([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], height: f64, gradient: [f64; 2]) -> HeightFacet {
        let polygon = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| DVec2::new(x, y)).to_vec();
        HeightFacet { polygon, offset: height - gradient[0], gradient: DVec2::from_array(gradient) }
    }

    fn tidied(facets: &[HeightFacet]) -> Heights {
        Heights { facets: facets.to_vec() }.tidied()
    }

    #[test]
    fn a_sliver_between_two_pieces_goes_to_them_without_a_gap() {
        let thin = 3e-9;
        let left = facet([0.0, 0.0], [1.0, 1.0], 0.0, [0.0, 0.0]);
        let sliver = facet([1.0, 0.0], [1.0 + thin, 1.0], 1e-12, [1e-9, 0.0]);
        let right = facet([1.0 + thin, 0.0], [2.0, 1.0], 0.0, [0.01, 0.0]);
        let result = tidied(&[left, sliver, right]);
        assert_eq!(result.facets.len(), 2);
        assert!((result.area() - 2.0).abs() < 2.0 * thin, "{}", result.area());
        for x in [0.5, 1.0, 1.0 + 0.5 * thin, 1.0 + thin, 1.5] {
            let wanted = 0.01 * (x - 1.0f64).max(0.0);
            assert!((result.at(DVec2::new(x, 0.3)).unwrap() - wanted).abs() < 1e-10, "{x}");
        }
    }

    #[test]
    fn a_sliver_along_two_pieces_goes_to_the_level_one_across() {
        let thin = 2e-8;
        let pieces = [
            facet([0.0, 0.0], [1.0, 0.5], 0.3, [0.0, 0.0]),
            facet([0.0, 0.5], [1.0, 1.0], 0.5, [0.0, 0.2]),
            facet([1.0, 0.0], [1.0 + thin, 1.0], 0.0, [0.2, 0.0]),
            facet([1.0 + thin, 0.0], [2.0, 1.0], 1e-11, [0.2, 0.0]),
        ];
        let result = tidied(&pieces);
        assert_eq!(result.facets.len(), 3);
        assert_eq!(
            result
                .facets
                .iter()
                .filter(|f| f.polygon == pieces[0].polygon || f.polygon == pieces[1].polygon)
                .count(),
            2
        );
        let beside = result.at(DVec2::new(1.0 + 0.5 * thin, 0.7)).unwrap();
        assert!(beside.abs() < 1e-8, "{beside}");
    }

    #[test]
    fn a_leaning_wall_is_upright_and_nothing_sinks() {
        let lean = 1e-6;
        let low = facet([0.0, 0.0], [1.0, 1.0], 0.0, [0.1, 0.0]);
        let wall = facet([1.0, 0.0], [1.0 + lean, 1.0], 0.0, [0.5 / lean, 0.0]);
        let high = facet([1.0 + lean, 0.0], [2.0, 1.0], 0.5, [0.0, 0.0]);
        // At the rim the wall vanishes; between two pieces the upper piece extends over it.
        let rim = tidied(&[low.clone(), wall.clone()]);
        assert_eq!(rim.facets, vec![low.clone()]);
        let result = tidied(&[low.clone(), wall.clone(), high]);
        assert_eq!(result.facets.len(), 2);
        assert!(result.facets.contains(&low));
        for share in [0.1, 0.5, 0.9] {
            let place = DVec2::new(1.0 + share * lean, 0.4);
            let now = result.at(place).unwrap();
            assert!((now - 0.5).abs() < 1e-9 && now > wall.height(place) - 1e-9, "{share}: {now}");
        }
    }

    #[test]
    fn a_side_without_length_goes_and_a_small_feature_stays() {
        let cut = 1e-8;
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0 - cut), (1.0 - cut, 1.0), (0.0, 1.0)];
        let polygon = corners.map(|(x, y)| DVec2::new(x, y)).to_vec();
        let piece = HeightFacet { polygon, offset: 0.0, gradient: DVec2::ZERO };
        assert_eq!(tidied(std::slice::from_ref(&piece)).facets[0].polygon.len(), 4);
        // A groove 1e-4 wide between two coplanar pieces remains a groove.
        let groove = [
            facet([0.0, 0.0], [1.0, 1.0], 0.0, [0.0, 0.0]),
            facet([1.0, 0.0], [1.0001, 1.0], 0.1, [0.0, 0.0]),
            facet([1.0001, 0.0], [2.0, 1.0], 0.0, [0.0, 0.0]),
        ];
        assert_eq!(tidied(&groove).facets, groove);
    }
}
