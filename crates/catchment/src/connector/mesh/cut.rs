//! A face of many corners, cut into triangles by clipping ears.
//!
//! ```text
//!      c ────── b            an ear at b: left of its way from a to c, and no other corner in it.
//!      │      ╱              The one whose smallest angle is largest is taken first, so that corners
//!      e ·  ╱                on a straight edge (e) keep triangles of some area.
//!      │  ╱
//!      a
//! ```
//!
//! Corners may lie on a line, may be visited twice (a ring that is cut open to be one border) and may lead inwards; what is refused is a border that
//! crosses itself. Every corner stays: libraries for this drop those on straight edges, after which the neighbouring faces no longer meet there.
//!
//! n² steps for n corners, n³ where no ear is fat; faces have dozens.

use glam::{DVec2, DVec3};

/// A corner counts as inside an ear from here on, relative to the face's size; nearer it is on its border.
const ON: f64 = 1e-9;

/// Triangles of corners by their numbers, wound as the face is; `None` where there are none.
pub(in crate::connector) fn triangles(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let count = corners.len();
    let normal: DVec3 = (0..count).map(|k| corners[k].cross(corners[(k + 1) % count])).sum();
    let normal = normal.try_normalize()?;
    let side = normal.any_orthonormal_vector();
    let up = normal.cross(side);
    let flat: Vec<DVec2> = corners.iter().map(|p| DVec2::new(side.dot(*p), up.dot(*p))).collect();
    let size = flat.iter().map(|p| p.distance(flat[0])).fold(0.0, f64::max);
    let on = ON * size * size;
    let mut left: Vec<usize> = (0..count).collect();
    let mut found = Vec::with_capacity(count.saturating_sub(2));
    while left.len() > 3 {
        let n = left.len();
        let ear = |k: usize| [left[(k + n - 1) % n], left[k], left[(k + 1) % n]];
        let fat = |k: &usize| fatness(ear(*k).map(|c| flat[c]), on);
        let mut ears: Vec<(f64, usize)> = (0..n).filter_map(|k| Some((fat(&k)?, k))).collect();
        // Of equally fat ones the first: the answer depends on the face alone.
        ears.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let is_free = |k: usize| {
            let ear = ear(k);
            let own = ear.map(|c| flat[c]);
            left.iter().all(|c| ear.contains(c) || own.contains(&flat[*c]) || !is_inside(flat[*c], own, on))
        };
        let (_, k) = ears.into_iter().find(|(_, k)| is_free(*k))?;
        found.push(ear(k));
        left.remove(k);
    }
    let last = [left[0], left[1], left[2]];
    fatness(last.map(|c| flat[c]), on)?;
    found.push(last);
    Some(found)
}

/// Twice the signed area of a triangle.
fn area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// How far a triangle is from having no area, at most √3/2; `None` where it has none or is wound the wrong way.
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

    /// Every triangle is wound as the face, together they have its area, and each side of the face belongs to one of them, in its sense.
    fn holds(corners: &[DVec3]) {
        let count = corners.len();
        let vector = |ids: &[usize]| -> DVec3 {
            let n = ids.len();
            (0..n).map(|k| corners[ids[k]].cross(corners[ids[(k + 1) % n]])).sum()
        };
        let face = vector(&(0..count).collect::<Vec<_>>());
        let cut = triangles(corners).unwrap();
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

    /// A plate with a hole, as it is exported: one border that goes in along a line, around the hole, and out again.
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
        let cut = triangles(&corners).unwrap();
        let twice: f64 =
            cut.iter().map(|t| (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).z).sum();
        let polygon = |r: f64, n: f64| n * r * r * (TAU / n).sin();
        assert!((twice - polygon(2.0, 8.0) + polygon(1.0, 12.0)).abs() < 1e-12, "{twice}");
    }

    #[test]
    fn a_border_that_crosses_itself_is_refused() {
        assert_eq!(triangles(&flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.1]])), None);
        assert_eq!(triangles(&[DVec3::ZERO; 4]), None);
    }
}
