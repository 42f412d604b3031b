//! The one small optimisation behind every step of a motion.
//!
//! Overdamped motion without friction: of all displacements u (scaled so that dissipation is `|u|²`) that the contacts
//! allow, the body takes the one closest to where the force alone would push it,
//!
//! ```text
//!   u = argmin |u − p|²    subject to   aᵢ·u ≥ −gapᵢ      for every contact i
//! ```
//!
//! With all gaps 0 its lateral part is −(the minimum-norm point of the convex hull of the contacts' height
//! gradients), up to length: the steepest descent of the height in the ρ-metric. Solved exactly as a least-distance
//! problem through non-negative least squares (Lawson and Hanson, *Solving Least Squares Problems*,
//! ch. 23).

/// Coordinates of a displacement: lateral x, y, approach z and up to three turns.
pub(super) const MAX_COORDINATES: usize = 6;
/// One more row holds the gaps.
const ROWS: usize = MAX_COORDINATES + 1;

/// A displacement, or the row of a contact; unused coordinates are 0.
pub(super) type Vector = [f64; MAX_COORDINATES];

/// The displacement closest to `push` that keeps every gap open: `rows[i]·u ≥ −gaps[i]`; `None` where negative gaps
/// contradict each other.
///
/// `scale` is the size of displacement of interest: gaps and push are measured in it for conditioning.
pub(super) fn closest_allowed(push: &Vector, rows: &[Vector], gaps: &[f64], scale: f64) -> Option<Vector> {
    let mut columns: Vec<[f64; ROWS]> = Vec::with_capacity(rows.len());
    for (row, gap) in rows.iter().zip(gaps) {
        // In v = (u − push)/scale:  row·v ≥ −(gap + row·push)/scale.
        let bound = -(gap + dot(row, push)) / scale;
        let mut column = [0.0; ROWS];
        column[..MAX_COORDINATES].copy_from_slice(row);
        column[MAX_COORDINATES] = bound;
        columns.push(column);
    }
    if columns.iter().all(|c| c[MAX_COORDINATES] <= 0.0) {
        return Some(*push);
    }
    let residual = non_negative_residual(&columns);
    let mut u = *push;
    // The last residual is 0 only if the constraints contradict each other.
    if residual[MAX_COORDINATES].abs() > 1e-14 {
        for (u, r) in u.iter_mut().zip(residual) {
            *u -= scale * r / residual[MAX_COORDINATES];
        }
        return Some(u);
    }
    None
}

/// Scalar product.
pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Residual `E λ − f` of non-negative least squares `min |E λ − f|, λ ≥ 0` with f = (0, …, 0, 1).
fn non_negative_residual(columns: &[[f64; ROWS]]) -> [f64; ROWS] {
    let mut target = [0.0; ROWS];
    target[ROWS - 1] = 1.0;
    // Passive columns (λ > 0): never more than there are rows.
    let mut passive: Vec<usize> = Vec::with_capacity(ROWS);
    let mut lambda: Vec<f64> = Vec::with_capacity(ROWS);
    let mut residual = target.map(|t| -t);
    let norms: Vec<f64> =
        columns.iter().map(|c| c.iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE)).collect();
    let limit = 3 * columns.len() + 20;
    for _ in 0..limit {
        // The column along which the residual falls fastest.
        let steepest = (0..columns.len())
            .filter(|j| !passive.contains(j))
            .map(|j| {
                let slope: f64 = columns[j].iter().zip(residual).map(|(e, r)| -e * r).sum();
                (slope / norms[j], j)
            })
            .fold((1e-12, usize::MAX), |best, next| if next.0 > best.0 { next } else { best });
        if steepest.1 == usize::MAX || passive.len() == ROWS {
            break;
        }
        passive.push(steepest.1);
        lambda.push(0.0);
        loop {
            let Some(free) = least_squares(columns, &passive, &target) else {
                // Linearly dependent on the passive ones: it cannot help.
                passive.pop();
                lambda.pop();
                return residual;
            };
            if free.iter().all(|l| *l > 0.0) {
                lambda = free;
                break;
            }
            // Walk towards the free solution until the first multiplier reaches 0, and let it go.
            let step = lambda
                .iter()
                .zip(&free)
                .filter(|(_, f)| **f <= 0.0)
                .map(|(l, f)| l / (l - f))
                .fold(1.0f64, f64::min);
            for (l, f) in lambda.iter_mut().zip(&free) {
                *l += step * (f - *l);
            }
            let mut k = 0;
            while k < passive.len() {
                if lambda[k] <= 1e-15 {
                    passive.remove(k);
                    lambda.remove(k);
                } else {
                    k += 1;
                }
            }
            if passive.is_empty() {
                break;
            }
        }
        residual = target.map(|t| -t);
        for (j, l) in passive.iter().zip(&lambda) {
            for (r, e) in residual.iter_mut().zip(columns[*j]) {
                *r += e * l;
            }
        }
    }
    residual
}

/// Unconstrained least squares over the passive columns by modified Gram–Schmidt; `None` if they are dependent.
fn least_squares(columns: &[[f64; ROWS]], passive: &[usize], target: &[f64; ROWS]) -> Option<Vec<f64>> {
    let n = passive.len();
    let mut q: [[f64; ROWS]; ROWS] = [[0.0; ROWS]; ROWS];
    let mut r = [[0.0; ROWS]; ROWS];
    let mut right = [0.0; ROWS];
    let mut rest = *target;
    for k in 0..n {
        let mut column = columns[passive[k]];
        let size: f64 = column.iter().map(|x| x * x).sum();
        for j in 0..k {
            let along: f64 = q[j].iter().zip(column).map(|(a, b)| a * b).sum();
            r[j][k] = along;
            for (c, a) in column.iter_mut().zip(q[j]) {
                *c -= along * a;
            }
        }
        let norm = column.iter().map(|x| x * x).sum::<f64>();
        if norm <= 1e-20 * size {
            return None;
        }
        let norm = norm.sqrt();
        r[k][k] = norm;
        q[k] = column.map(|x| x / norm);
        right[k] = q[k].iter().zip(rest).map(|(a, b)| a * b).sum();
        for (t, a) in rest.iter_mut().zip(q[k]) {
            *t -= right[k] * a;
        }
    }
    let mut lambda = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| r[k][j] * lambda[j]).sum();
        lambda[k] = (right[k] - known) / r[k][k];
    }
    Some(lambda)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_plane_deflects_the_push_along_itself() {
        // A slope of 45°: pushed straight down by 1, the closest allowed displacement is (½, 0, −½).
        let s = 0.5f64.sqrt();
        let u = closest_allowed(&[0.0, 0.0, -1.0, 0.0, 0.0, 0.0], &[[s, 0.0, s, 0.0, 0.0, 0.0]], &[0.0], 1.0)
            .unwrap();
        assert!((u[0] - 0.5).abs() < 1e-14 && (u[2] + 0.5).abs() < 1e-14, "{u:?}");
    }

    #[test]
    fn a_funnel_holds() {
        let s = 0.5f64.sqrt();
        let rows = [[s, 0.0, s, 0.0, 0.0, 0.0], [-s, 0.0, s, 0.0, 0.0, 0.0]];
        let u = closest_allowed(&[0.0, 0.0, -1.0, 0.0, 0.0, 0.0], &rows, &[0.0, 0.0], 1.0).unwrap();
        assert!(u.iter().all(|x| x.abs() < 1e-14), "{u:?}");
    }

    #[test]
    fn two_walls_that_overlap_leave_no_displacement() {
        let rows = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0]];
        assert_eq!(closest_allowed(&[0.0, 0.0, -1.0, 0.0, 0.0, 0.0], &rows, &[-1e-3, -1e-3], 1.0), None);
    }

    proptest! {
        /// Optimality of a projection on a convex set: allowed, and (push − u)·(w − u) ≤ 0 for every allowed w.
        #[test]
        fn the_projection_is_optimal(
            push in proptest::array::uniform6(-1.0..1.0f64),
            rows in proptest::collection::vec(proptest::array::uniform6(-1.0..1.0f64), 1..12),
            gaps in proptest::collection::vec(0.0..0.3f64, 12),
            others in proptest::collection::vec(proptest::array::uniform6(-1.0..1.0f64), 40),
        ) {
            let gaps = &gaps[..rows.len()];
            let u = closest_allowed(&push, &rows, gaps, 1.0).unwrap();
            for (row, gap) in rows.iter().zip(gaps) {
                prop_assert!(dot(row, &u) >= -gap - 1e-9);
            }
            for w in &others {
                // Shrink a random direction into the allowed set (it contains 0).
                let k = rows.iter().zip(gaps).map(|(r, g)| {
                    let d = dot(r, w);
                    if d < 0.0 { g / -d } else { 1.0 }
                }).fold(1.0f64, f64::min);
                let toward: f64 = (0..6).map(|i| (push[i] - u[i]) * (k * w[i] - u[i])).sum();
                prop_assert!(toward <= 1e-9, "{toward}");
            }
        }
    }
}
