//! Triangulation of a face with many corners by ear clipping.
//!
//! ```text
//!      c ────── b            an ear at b: left of its path from a to c, without another corner in it.
//!      │      ╱              The ear with the largest smallest angle is removed first, so that corners
//!      e ·  ╱                on a straight edge (e) keep triangles with an area.
//!      │  ╱
//!      a
//! ```
//!
//! Corners may lie on a line, may be visited twice (a ring that is cut open to form a single border) and may
//! be concave; a border that crosses itself is rejected. Every corner is kept: existing libraries drop the
//! corners on straight edges, after which the neighbouring faces no longer meet there.
//!
//! The test for a free ear runs over all remaining corners once, and again when the corner inside the ear or
//! a corner of the ear is removed: about n² steps for n corners, charged to a budget in advance.

use catchment_base::budget::{Budget, Limit, Overspent};
use catchment_base::tolerance::COINCIDENT;
use glam::{DVec2, DVec3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Corners of a face: as many as the steps below suffice for.
pub(crate) const CORNERS: Limit =
    Limit { most: 20_000, of: "corners of a face", remedy: "triangulate the mesh when it is exported" };
/// Comparisons of ears with corners, for all faces of a file: a face of 20 000 corners, or two million of a dozen.
pub(crate) const STEPS: Limit = Limit {
    most: 200_000_000,
    of: "steps of cutting faces into triangles",
    remedy: "triangulate the mesh when it is exported",
};

/// A possible ear: the fattest first, among equals the first, so that the result depends on the face alone.
struct Ear {
    fatness: f64,
    corner: usize,
    /// Number of the evaluation at this corner: earlier entries are out of date.
    version: u32,
}

impl Ord for Ear {
    fn cmp(&self, other: &Self) -> Ordering {
        self.fatness.total_cmp(&other.fatness).then(other.corner.cmp(&self.corner))
    }
}

impl PartialOrd for Ear {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Ear {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ear {}

/// The border that is left, a ring.
struct Border {
    flat: Vec<DVec2>,
    next: Vec<usize>,
    previous: Vec<usize>,
    versions: Vec<u32>,
    /// Ears in which a corner lies, by that corner.
    blocked: Vec<Vec<Ear>>,
    ears: BinaryHeap<Ear>,
    on: f64,
}

impl Border {
    fn of(flat: Vec<DVec2>, on: f64) -> Self {
        let n = flat.len();
        let next = (1..n).chain([0]).collect();
        let previous = std::iter::once(n - 1).chain(0..n - 1).collect();
        let blocked = (0..n).map(|_| Vec::new()).collect();
        let mut border =
            Self { flat, next, previous, versions: vec![0; n], blocked, ears: BinaryHeap::new(), on };
        (0..n).for_each(|corner| border.look(corner));
        border
    }

    fn ear(&self, corner: usize) -> [usize; 3] {
        [self.previous[corner], corner, self.next[corner]]
    }

    /// Evaluates a corner whose neighbours are new.
    fn look(&mut self, corner: usize) {
        self.versions[corner] += 1;
        let version = self.versions[corner];
        if let Some(fatness) = fatness(self.ear(corner).map(|c| self.flat[c]), self.on) {
            self.ears.push(Ear { fatness, corner, version });
        }
    }

    /// A corner that lies in an ear.
    fn inside(&self, corner: usize) -> Option<usize> {
        let ear = self.ear(corner);
        let own = ear.map(|c| self.flat[c]);
        let mut other = self.next[ear[2]];
        while other != ear[0] {
            let p = self.flat[other];
            if !own.contains(&p) && is_inside(p, own, self.on) {
                return Some(other);
            }
            other = self.next[other];
        }
        None
    }

    /// Takes an ear off.
    fn take(&mut self, corner: usize) {
        let [before, _, after] = self.ear(corner);
        self.next[before] = after;
        self.previous[after] = before;
        self.versions[corner] += 1;
        self.look(before);
        self.look(after);
        // Ears that this corner blocked may be free now.
        let waiting = std::mem::take(&mut self.blocked[corner]);
        self.ears.extend(waiting);
    }
}

/// Triangles by the numbers of their corners, wound as the face; `None` if there is no triangulation.
pub(crate) fn triangles(corners: &[DVec3], steps: &mut Budget) -> Result<Option<Vec<[usize; 3]>>, Overspent> {
    let count = corners.len();
    // Every corner is compared with those that are left when it goes, at least.
    steps.spend((count as u64).saturating_mul(count as u64) / 2)?;
    let normal: DVec3 = (0..count).map(|k| corners[k].cross(corners[(k + 1) % count])).sum();
    let Some(normal) = normal.try_normalize() else { return Ok(None) };
    let side = normal.any_orthonormal_vector();
    let up = normal.cross(side);
    let flat: Vec<DVec2> = corners.iter().map(|p| DVec2::new(side.dot(*p), up.dot(*p))).collect();
    let size = flat.iter().map(|p| p.distance(flat[0])).fold(0.0, f64::max);
    let on = COINCIDENT * size * size;
    let mut border = Border::of(flat, on);
    let mut result = Vec::with_capacity(count.saturating_sub(2));
    while count - result.len() > 3 {
        let Some(ear) = border.ears.pop() else { return Ok(None) };
        if ear.version != border.versions[ear.corner] {
            continue;
        }
        if let Some(other) = border.inside(ear.corner) {
            steps.spend((count - result.len()) as u64)?;
            border.blocked[other].push(ear);
            continue;
        }
        result.push(border.ear(ear.corner));
        border.take(ear.corner);
    }
    // The three that are left, the first of them first.
    let first =
        (0..count).find(|k| border.next[border.previous[*k]] == *k && border.previous[border.next[*k]] == *k);
    let Some(last) = first.map(|k| [k, border.next[k], border.next[border.next[k]]]) else { return Ok(None) };
    if fatness(last.map(|c| border.flat[c]), on).is_none() {
        return Ok(None);
    }
    result.push(last);
    Ok(Some(result))
}

/// Twice the signed area of a triangle.
fn area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// A measure of a triangle's fatness, at most √3/2; `None` if it has no area or the wrong winding.
fn fatness([a, b, c]: [DVec2; 3], on: f64) -> Option<f64> {
    let twice = area([a, b, c]);
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (twice > on).then(|| twice / longest)
}

/// Whether a point is inside of a triangle or on its border.
fn is_inside(point: DVec2, [a, b, c]: [DVec2; 3], on: f64) -> bool {
    area([a, b, point]) > -on && area([b, c, point]) > -on && area([c, a, point]) > -on
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn cut(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
        triangles(corners, &mut Budget::new(STEPS)).unwrap()
    }

    /// Clipping as it is defined, in plain loops: the fattest ear that is free, again and again.
    fn brute(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
        let count = corners.len();
        let normal: DVec3 = (0..count).map(|k| corners[k].cross(corners[(k + 1) % count])).sum();
        let normal = normal.try_normalize()?;
        let side = normal.any_orthonormal_vector();
        let up = normal.cross(side);
        let flat: Vec<DVec2> = corners.iter().map(|p| DVec2::new(side.dot(*p), up.dot(*p))).collect();
        let size = flat.iter().map(|p| p.distance(flat[0])).fold(0.0, f64::max);
        let on = COINCIDENT * size * size;
        let mut left: Vec<usize> = (0..count).collect();
        let mut result = Vec::new();
        while left.len() > 3 {
            let n = left.len();
            let ear = |k: usize| [left[(k + n - 1) % n], left[k], left[(k + 1) % n]];
            let fat = |k: &usize| fatness(ear(*k).map(|c| flat[c]), on);
            let mut ears: Vec<(f64, usize)> = (0..n).filter_map(|k| Some((fat(&k)?, k))).collect();
            ears.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let is_free = |k: usize| {
                let ear = ear(k);
                let own = ear.map(|c| flat[c]);
                left.iter()
                    .all(|c| ear.contains(c) || own.contains(&flat[*c]) || !is_inside(flat[*c], own, on))
            };
            let (_, k) = ears.into_iter().find(|(_, k)| is_free(*k))?;
            result.push(ear(k));
            left.remove(k);
        }
        let last = [left[0], left[1], left[2]];
        fatness(last.map(|c| flat[c]), on)?;
        result.push(last);
        Some(result)
    }

    /// Every triangle is wound as the face, together they have its area, and each side of the face belongs to one of them, in its sense.
    fn holds(corners: &[DVec3]) {
        let count = corners.len();
        let vector = |ids: &[usize]| -> DVec3 {
            let n = ids.len();
            (0..n).map(|k| corners[ids[k]].cross(corners[ids[(k + 1) % n]])).sum()
        };
        let face = vector(&(0..count).collect::<Vec<_>>());
        let cut = cut(corners).unwrap();
        assert_eq!(cut.len(), count - 2);
        let sum: f64 = cut.iter().map(|t| vector(t).length()).sum();
        assert!((sum - face.length()).abs() < 1e-9 * sum, "{sum} {}", face.length());
        assert!(cut.iter().all(|t| vector(t).dot(face) > 0.0));
        for k in 0..count {
            let side = [k, (k + 1) % count];
            let has = |t: &&[usize; 3]| (0..3).any(|i| [t[i], t[(i + 1) % 3]] == side);
            assert_eq!(cut.iter().filter(has).count(), 1, "{side:?}");
        }
    }

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|[x, y]| DVec3::new(*x, *y, 0.3 * x - 0.2 * y + 1.0)).collect()
    }

    proptest! {
        /// Borders that go round once, in and out.
        #[test]
        fn stars(radii in prop::collection::vec(0.2..2.0f64, 4..30)) {
            let n = radii.len() as f64;
            let at = |(k, r): (usize, &f64)| {
                let (sine, cosine) = (TAU * k as f64 / n).sin_cos();
                [r * cosine, r * sine]
            };
            holds(&flat(&radii.iter().enumerate().map(at).collect::<Vec<_>>()));
        }

        /// Arbitrary corners, most of which are not a border: the same triangles as by the definition, or
        /// none.
        #[test]
        fn as_it_is_defined(points in prop::collection::vec((0..6i8, 0..6i8), 3..14)) {
            let corners = flat(&points.iter().map(|(x, y)| [f64::from(*x), f64::from(*y)]).collect::<Vec<_>>());
            prop_assert_eq!(cut(&corners), brute(&corners));
        }

        #[test]
        fn stars_as_it_is_defined(radii in prop::collection::vec(0.2..2.0f64, 4..60)) {
            let n = radii.len() as f64;
            let at = |(k, r): (usize, &f64)| {
                let (sine, cosine) = (TAU * k as f64 / n).sin_cos();
                [r * cosine, r * sine]
            };
            let corners = flat(&radii.iter().enumerate().map(at).collect::<Vec<_>>());
            prop_assert_eq!(cut(&corners), brute(&corners));
        }
    }

    #[test]
    fn corners_on_straight_edges_stay() {
        holds(&flat(&[
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [2.0, 2.0],
            [1.0, 2.0],
            [0.0, 2.0],
            [0.0, 1.0],
        ]));
        holds(&flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [1.5, 1.0]]));
    }

    /// A plate with a hole, as exported: a single border that goes in along a line, around the hole, and out
    /// again.
    #[test]
    fn a_ring_that_is_cut_open() {
        let ring = |r: f64, n: usize| {
            (0..=n).map(move |k| {
                let (sine, cosine) = (TAU * (k % n) as f64 / n as f64).sin_cos();
                [r * cosine, r * sine]
            })
        };
        let points: Vec<[f64; 2]> =
            ring(2.0, 8).chain(ring(1.0, 12).collect::<Vec<_>>().into_iter().rev()).collect();
        let corners = flat(&points);
        let cut = cut(&corners).unwrap();
        let twice: f64 =
            cut.iter().map(|t| (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).z).sum();
        let polygon = |r: f64, n: f64| n * r * r * (TAU / n).sin();
        assert!((twice - polygon(2.0, 8.0) + polygon(1.0, 12.0)).abs() < 1e-12, "{twice}");
    }

    #[test]
    fn a_border_that_crosses_itself_is_refused() {
        assert_eq!(cut(&flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.1]])), None);
        assert_eq!(cut(&[DVec3::ZERO; 4]), None);
    }

    #[test]
    fn work_is_charged_before_it_is_done() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)].repeat(10_000);
        let over = triangles(&corners, &mut Budget::new(STEPS)).unwrap_err();
        assert!(over.to_string().contains("triangulate the mesh"), "{over}");
        // Every face counts.
        let mut steps = Budget::new(Limit { most: 20, ..STEPS });
        let square = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert!(triangles(&square, &mut steps).is_ok() && triangles(&square, &mut steps).is_ok());
        assert!(triangles(&square, &mut steps).is_err());
    }
}
