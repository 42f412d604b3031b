//! Distance between two surfaces.
//!
//! ```text
//! max( max over points p of A of d(p, B),  max over points q of B of d(q, A) )
//! ```
//!
//! The points are the corners, the edge midpoints and the triangle centres of both surfaces, each measured
//! against the whole other surface: exact at these points. Not promised: the distance between them. A surface
//! between two points can be farther by at most half of their distance; for simplified meshes, which are
//! nearly plane there, it usually is not.

use super::indexed::Indexed;
use super::tree::{Tree, around};
use glam::DVec3;

/// One triangle in this many is tested first.
const SPARSE: usize = 61;

/// The largest distance of a point of `from` to `to`; if some distance exceeds `most`, the first such
/// distance.
pub(super) fn one_sided(from: &Indexed, to: &Indexed, most: f64) -> f64 {
    /// Share of the tolerance below which a deviation is rounding.
    const ROUNDING: f64 = 1e-6;
    let Some(target) = Target::of(to) else { return f64::INFINITY };
    let mut seen = vec![false; from.vertices.len()];
    let mut largest: f64 = 0.0;
    let mut last = 0;
    // A large deviation usually shows at many triangles, so a sparse sample is tested first.
    for k in (0..from.triangles.len()).step_by(SPARSE) {
        let [a, b, c] = from.corners(k);
        let distance;
        (last, distance) = target.nearest((a + b + c) / 3.0, last);
        if distance > most {
            return distance;
        }
    }
    for (k, t) in from.triangles.iter().enumerate() {
        let corners = from.corners(k);
        let [a, b, c] = corners;
        let middle = (a + b + c) / 3.0;
        // Two triangles share each edge; the test takes the copy with ascending corner numbers.
        let edges =
            (0..3).filter(|i| t[*i] < t[(i + 1) % 3]).map(|i| corners[i].midpoint(corners[(i + 1) % 3]));
        let new = t.iter().filter(|v| !std::mem::replace(&mut seen[**v as usize], true)).map(|v| from.at(*v));
        for point in new.chain(edges).chain([middle]) {
            let (near, distance) = target.nearest(point, last);
            last = near;
            largest = largest.max(distance);
            if largest > most {
                return largest;
            }
        }
    }
    // Rounding of the measurement itself, relative to the welding tolerance: 1e-12 of the size.
    if largest < ROUNDING * to.tolerance { 0.0 } else { largest }
}

/// A surface for distance queries.
struct Target<'a> {
    mesh: &'a Indexed,
    tree: Tree,
}

impl<'a> Target<'a> {
    fn of(mesh: &'a Indexed) -> Option<Self> {
        let boxes: Vec<_> = (0..mesh.triangles.len()).map(|k| around(mesh.corners(k))).collect();
        (!boxes.is_empty()).then(|| Self { mesh, tree: Tree::over(&boxes) })
    }

    /// The nearest triangle and its distance; `guess` is a triangle that may be near.
    fn nearest(&self, point: DVec3, guess: usize) -> (usize, f64) {
        let to = |k: usize| point.distance(closest(point, self.mesh.corners(k)));
        let most = to(guess);
        self.tree.nearest(point, most, to).unwrap_or((guess, most))
    }
}

/// The point of a triangle that is nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
fn closest(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * ratio(d1, d1 - d3);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * ratio(d2, d2 - d6);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ratio(d4 - d3, (d4 - d3) + (d5 - d6));
    }
    let whole = va + vb + vc;
    a + ab * ratio(vb, whole) + ac * ratio(vc, whole)
}

/// A part divided by the whole; zero if the whole is zero.
fn ratio(part: f64, whole: f64) -> f64 {
    if whole == 0.0 { 0.0 } else { part / whole }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// No point of the triangle, in a fine lattice, is nearer.
        #[test]
        fn nothing_is_closer(p in prop::array::uniform3(-2.0..2.0f64), t in prop::array::uniform9(-1.0..1.0f64)) {
            const N: usize = 20;
            let p = DVec3::from_array(p);
            let [a, b, c] = [0, 3, 6].map(|k| DVec3::from_slice(&t[k..k + 3]));
            let result = p.distance(closest(p, [a, b, c]));
            let mut least = f64::INFINITY;
            for i in 0..=N {
                for j in 0..=N - i {
                    let [u, v] = [i, j].map(|k| k as f64 / N as f64);
                    least = least.min(p.distance(a + (b - a) * u + (c - a) * v));
                }
            }
            prop_assert!(result <= least + 1e-12, "{} {}", result, least);
            // The lattice is no wider than this.
            prop_assert!(result >= least - (a.distance(b) + a.distance(c)) / N as f64);
        }
    }
}
