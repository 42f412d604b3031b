//! The small optimisation behind every step of a motion.
//!
//! Overdamped motion without friction: of all displacements u (scaled so that dissipation is `|u|²`) that the
//! contacts permit, the body takes the one closest to the displacement p that the force alone would cause,
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
/// An additional row holds the gaps, and another stays 0: eight numbers fill the lanes of a processor.
const ROWS: usize = MAX_COORDINATES + 2;
/// The row of the gaps.
const GAPS: usize = MAX_COORDINATES;
/// Columns that can be independent.
const MOST: usize = MAX_COORDINATES + 1;

/// A displacement, or the row of a contact; unused coordinates are 0.
pub(super) type Vector = [f64; MAX_COORDINATES];
type Column = [f64; ROWS];

/// Scalar product.
pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Scalar product, four and then two lanes at a time.
fn product(a: &Column, b: &Column) -> f64 {
    let p: [f64; 4] = std::array::from_fn(|k| a[k] * b[k] + a[k + 4] * b[k + 4]);
    (p[0] + p[2]) + (p[1] + p[3])
}

/// The solver: owns its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Projection {
    columns: Vec<Column>,
    passive: Passive,
    /// Divisor of the last displacement.
    residual: f64,
}

impl Projection {
    /// The displacement closest to `push` that keeps every gap open: `rows[i]·u ≥ −gaps[i]`; `None` if
    /// negative gaps contradict each other.
    ///
    /// `scale` is the size of displacement of interest: gaps and push are measured in it for conditioning.
    pub(super) fn closest_allowed(
        &mut self,
        push: &Vector,
        rows: &[Vector],
        gaps: impl Iterator<Item = f64>,
        scale: f64,
    ) -> Option<Vector> {
        self.closest_allowed_from(&[], push, rows, gaps, scale)
    }

    /// The same, faster if `start` is close to the rows that it presses against and their multipliers.
    pub(super) fn closest_allowed_from(
        &mut self,
        start: &[(usize, f64)],
        push: &Vector,
        rows: &[Vector],
        gaps: impl Iterator<Item = f64>,
        scale: f64,
    ) -> Option<Vector> {
        self.columns.clear();
        self.passive.count = 0;
        let mut free = true;
        for (row, gap) in rows.iter().zip(gaps) {
            // In v = (u − push)/scale:  row·v ≥ −(gap + row·push)/scale.
            let bound = -(gap + dot(row, push)) / scale;
            free &= bound <= 0.0;
            let mut column = [0.0; ROWS];
            column[..MAX_COORDINATES].copy_from_slice(row);
            column[GAPS] = bound;
            self.columns.push(column);
        }
        if free {
            return Some(*push);
        }
        self.passive.start_at(start, &self.columns);
        let residual = self.non_negative_residual();
        self.residual = residual[GAPS];
        // The last residual is 0 only if the constraints contradict each other.
        (residual[GAPS].abs() > 1e-14)
            .then(|| std::array::from_fn(|k| push[k] - scale * residual[k] / residual[GAPS]))
    }

    /// The rows that the last displacement presses against: those with a multiplier above 0.
    pub(super) fn pressed(&self) -> &[usize] {
        &self.passive.columns[..self.passive.count]
    }

    /// Those rows, with their multipliers.
    pub(super) fn multipliers(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let Passive { count, columns, lambda, .. } = &self.passive;
        columns.iter().copied().zip(lambda.iter().copied()).take(*count)
    }

    /// Forces of the rows on the last displacement, zero for all others: `u = push + Σ force · row` for
    /// `scale` 1.
    pub(super) fn forces(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.multipliers().map(|(column, lambda)| (column, lambda / self.residual))
    }

    /// Residual `f − E λ` of non-negative least squares `min |f − E λ|, λ ≥ 0` with f = 1 in the row of the gaps, from the
    /// passive columns on.
    fn non_negative_residual(&mut self) -> Column {
        let Self { columns, passive, .. } = self;
        let mut residual = passive.residuals[passive.count];
        let limit = 3 * columns.len() + 20;
        for _ in 0..limit {
            // The column along which the residual falls fastest: the largest sine, here squared.
            let (mut most, mut steepest) = (1e-24, usize::MAX);
            for (j, column) in columns.iter().enumerate() {
                let slope = product(column, &residual);
                if slope > 0.0 && slope * slope > most * product(column, column) && !passive.contains(j) {
                    most = slope * slope / product(column, column);
                    steepest = j;
                }
            }
            // A column that depends on the passive columns cannot help.
            if steepest == usize::MAX
                || passive.count == MOST
                || !passive.push(steepest, columns)
                || !passive.settle(columns)
            {
                break;
            }
            residual = passive.residuals[passive.count];
        }
        residual
    }
}

/// The right-hand side f: 1 in the row of the gaps.
const TARGET: Column = {
    let mut target = [0.0; ROWS];
    target[GAPS] = 1.0;
    target
};

/// The columns with λ > 0, factorised by modified Gram–Schmidt: `E = Q R`.
#[derive(Debug, Clone)]
struct Passive {
    count: usize,
    columns: [usize; MOST],
    lambda: [f64; MOST],
    q: [Column; MOST],
    /// Upper triangle by columns; the diagonal is inverted.
    r: [[f64; MOST]; MOST],
    /// Qᵀ f.
    right: [f64; MOST],
    /// The residual of f after the first k columns.
    residuals: [Column; MOST + 1],
}

impl Default for Passive {
    fn default() -> Self {
        Self {
            count: 0,
            columns: [0; MOST],
            lambda: [0.0; MOST],
            q: [[0.0; ROWS]; MOST],
            r: [[0.0; MOST]; MOST],
            right: [0.0; MOST],
            residuals: [TARGET; MOST + 1],
        }
    }
}

impl Passive {
    fn contains(&self, column: usize) -> bool {
        self.columns[..self.count].contains(&column)
    }

    /// Adds a column with λ = 0; `false`, with nothing added, if it depends on the others.
    fn push(&mut self, column: usize, all: &[Column]) -> bool {
        let k = self.count;
        let mut q = all[column];
        let size = product(&q, &q);
        for j in 0..k {
            let along = product(&self.q[j], &q);
            self.r[k][j] = along;
            for (c, a) in q.iter_mut().zip(&self.q[j]) {
                *c -= along * a;
            }
        }
        let norm = product(&q, &q);
        if norm <= 1e-20 * size {
            return false;
        }
        let inverse = 1.0 / norm.sqrt();
        // Of local numbers, so that two are computed at a time.
        let (unit, before) = (q.map(|x| x * inverse), self.residuals[k]);
        let right = product(&unit, &before);
        self.residuals[k + 1] = std::array::from_fn(|i| before[i] - right * unit[i]);
        (self.r[k][k], self.q[k], self.right[k]) = (inverse, unit, right);
        self.columns[k] = column;
        self.lambda[k] = 0.0;
        self.count += 1;
        true
    }

    /// Starts anew with these columns and their λ, or with none if they are dependent.
    fn start_at(&mut self, start: &[(usize, f64)], all: &[Column]) {
        self.count = 0;
        let independent = start.iter().all(|&(column, lambda)| {
            let is_new = self.push(column, all);
            if is_new {
                self.lambda[self.count - 1] = lambda;
            }
            is_new
        });
        if !independent || !self.settle(all) {
            self.count = 0;
        }
    }

    /// Moves λ to the least-squares solution over the passive columns, letting go those that would turn negative;
    /// `false` if those left became dependent by rounding.
    fn settle(&mut self, all: &[Column]) -> bool {
        while self.count > 0 {
            let free = self.unconstrained();
            let n = self.count;
            // Walk towards the free solution until the first multiplier reaches 0.
            let mut step = 1.0f64;
            for (l, f) in self.lambda.iter().zip(&free).take(n).filter(|(_, f)| **f <= 0.0) {
                step = step.min(l / (l - f));
            }
            if free[..n].iter().all(|f| *f > 0.0) {
                self.lambda = free;
                return true;
            }
            let (columns, mut lambda) = (self.columns, self.lambda);
            for (l, f) in lambda.iter_mut().zip(&free) {
                *l += step * (f - *l);
            }
            self.count = 0;
            for k in (0..n).filter(|&k| lambda[k] > 1e-15) {
                if !self.push(columns[k], all) {
                    return false;
                }
                self.lambda[self.count - 1] = lambda[k];
            }
        }
        true
    }

    /// Least squares without regard to signs: R λ = Qᵀ f.
    fn unconstrained(&self) -> [f64; MOST] {
        let mut lambda = [0.0; MOST];
        for k in (0..self.count).rev() {
            let known: f64 = (k + 1..self.count).map(|j| self.r[j][k] * lambda[j]).sum();
            lambda[k] = (self.right[k] - known) * self.r[k][k];
        }
        lambda
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn closest_allowed(push: &Vector, rows: &[Vector], gaps: &[f64], scale: f64) -> Option<Vector> {
        Projection::default().closest_allowed(push, rows, gaps.iter().copied(), scale)
    }

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

        /// From the multipliers for other gaps, and from any others, it is the same displacement.
        #[test]
        fn the_start_changes_nothing(
            push in proptest::array::uniform6(-1.0..1.0f64),
            rows in proptest::collection::vec(proptest::array::uniform6(-1.0..1.0f64), 1..12),
            gaps in proptest::collection::vec(0.0..0.3f64, 12),
            others in proptest::collection::vec(0.0..0.3f64, 12),
            multipliers in proptest::collection::vec(0.01..2.0f64, 3),
        ) {
            let u = closest_allowed(&push, &rows, &gaps[..rows.len()], 1.0).unwrap();
            let mut projection = Projection::default();
            projection.closest_allowed(&push, &rows, others.iter().copied(), 1.0).unwrap();
            let known: Vec<(usize, f64)> = projection.multipliers().collect();
            let any: Vec<(usize, f64)> = multipliers.into_iter().enumerate().take(rows.len()).collect();
            for start in [known, any] {
                let v = projection.closest_allowed_from(&start, &push, &rows, gaps.iter().copied(), 1.0).unwrap();
                prop_assert!(u.iter().zip(&v).all(|(a, b)| (a - b).abs() < 1e-9), "{start:?}: {u:?} {v:?}");
            }
        }
    }
}
