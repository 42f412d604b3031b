//! Covariances of the five errors: their square roots and principal directions.
//!
//! ```text
//!   covariance = L·Lᵀ          L lower triangular (Cholesky); also semidefinite, with rows of 0
//!   covariance = V·Λ·Vᵀ        Λ the variances along the principal directions, columns of V (Jacobi's rotations)
//! ```
//!
//! Rows and columns are in the order of [`Dof::ALL`](catchment_base::pose::Dof::ALL), in D and radians, or without a unit for correlations.

/// A matrix over the five errors, row by row.
pub type Matrix = [[f64; 5]; 5];

/// No correlation at all.
pub const IDENTITY: Matrix = {
    let mut matrix = [[0.0; 5]; 5];
    let mut k = 0;
    while k < 5 {
        matrix[k][k] = 1.0;
        k += 1;
    }
    matrix
};

/// Rounding of a covariance written with a dozen digits, relative to the variances involved.
const SLACK: f64 = 1e-12;

/// Lower triangular L with L·Lᵀ = `covariance`; rows of zero variance stay zero.
///
/// # Errors
/// The number, from 0, of the first row that keeps it from being symmetric and positive semidefinite.
pub fn cholesky(covariance: &Matrix) -> Result<Matrix, usize> {
    let mut l = [[0.0; 5]; 5];
    for i in 0..5 {
        let slack =
            |j: usize| SLACK * (covariance[i][i] * covariance[j][j]).abs().sqrt().max(f64::MIN_POSITIVE);
        for j in 0..=i {
            let c = covariance[i][j];
            if !c.is_finite() || (c - covariance[j][i]).abs() > slack(j) {
                return Err(i);
            }
            let rest = c - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            l[i][j] = if i == j {
                if rest < -slack(i) {
                    return Err(i);
                }
                rest.max(0.0).sqrt()
            } else if l[j][j] > 0.0 {
                rest / l[j][j]
            } else if rest.abs() <= slack(j) {
                0.0
            } else {
                return Err(i);
            };
        }
    }
    Ok(l)
}

/// Sweeps of Jacobi's rotations: five rows are diagonal to rounding after six.
const SWEEPS: usize = 12;

/// The smallest eigenvalue of a symmetric matrix, and its direction, of length 1.
pub(crate) fn least_eigenvalue(symmetric: &Matrix) -> (f64, [f64; 5]) {
    let (mut a, mut v) = (*symmetric, IDENTITY);
    for _ in 0..SWEEPS {
        for p in 0..5 {
            for q in p + 1..5 {
                rotate(&mut a, &mut v, p, q);
            }
        }
    }
    let least = (0..5).min_by(|i, j| a[*i][*i].total_cmp(&a[*j][*j])).unwrap_or(0);
    (a[least][least], v.map(|row| row[least]))
}

/// The rotation that makes a[p][q] zero.
fn rotate(a: &mut Matrix, v: &mut Matrix, p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for row in a.iter_mut() {
        (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
    }
    let (upper, lower) = (a[p], a[q]);
    a[p] = std::array::from_fn(|k| c * upper[k] - s * lower[k]);
    a[q] = std::array::from_fn(|k| s * upper[k] + c * lower[k]);
    for row in v.iter_mut() {
        (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
    }
}

/// z with L·z = `y`; 0 for a row of L with a zero diagonal.
pub fn solve_lower(l: &Matrix, y: &[f64; 5]) -> [f64; 5] {
    let mut z = [0.0; 5];
    for (i, y) in y.iter().enumerate() {
        let rest = y - (0..i).map(|k| l[i][k] * z[k]).sum::<f64>();
        z[i] = if l[i][i] > 0.0 { rest / l[i][i] } else { 0.0 };
    }
    z
}

/// w with Lᵀ·w = `z`; 0 for a row of L with a zero diagonal.
pub fn solve_upper(l: &Matrix, z: &[f64; 5]) -> [f64; 5] {
    let mut w = [0.0; 5];
    for i in (0..5).rev() {
        let rest = z[i] - (i + 1..5).map(|k| l[k][i] * w[k]).sum::<f64>();
        w[i] = if l[i][i] > 0.0 { rest / l[i][i] } else { 0.0 };
    }
    w
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..5).map(|k| a[i][k] * b[k][j]).sum()))
    }

    fn transposed(a: &Matrix) -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
    }

    proptest! {
        /// B·Bᵀ is a covariance; its root reproduces it, and vectors mapped by the root are recovered.
        #[test]
        fn roots_give_the_covariance_back(b in prop::array::uniform5(prop::array::uniform5(-2.0f64..2.0)),
                                          y in prop::array::uniform5(-2.0f64..2.0)) {
            let mut covariance = product(&b, &transposed(&b));
            for (k, row) in covariance.iter_mut().enumerate() {
                row[k] += 0.1;
            }
            let l = cholesky(&covariance).unwrap();
            let back = product(&l, &transposed(&l));
            for (row, wanted) in back.iter().zip(&covariance) {
                for (result, wanted) in row.iter().zip(wanted) {
                    prop_assert!((result - wanted).abs() < 1e-10);
                }
            }
            let z = solve_lower(&l, &y);
            let again: [f64; 5] = std::array::from_fn(|i| (0..5).map(|k| l[i][k] * z[k]).sum());
            prop_assert!(again.iter().zip(&y).all(|(a, b)| (a - b).abs() < 1e-9));
            // Lᵀ·w = z, so that C·w = y.
            let w = solve_upper(&l, &z);
            let whole: [f64; 5] = std::array::from_fn(|i| (0..5).map(|k| covariance[i][k] * w[k]).sum());
            prop_assert!(whole.iter().zip(&y).all(|(a, b)| (a - b).abs() < 1e-7));
            let (least, along) = least_eigenvalue(&covariance);
            let mapped: [f64; 5] = std::array::from_fn(|i| (0..5).map(|k| covariance[i][k] * along[k]).sum());
            prop_assert!(least >= 0.0999);
            prop_assert!(mapped.iter().zip(&along).all(|(m, a)| (m - least * a).abs() < 1e-9));
        }
    }

    #[test]
    fn a_correlation_beyond_one_has_a_negative_eigenvalue() {
        let mut matrix = IDENTITY;
        (matrix[0][4], matrix[4][0]) = (1.5, 1.5);
        let (least, along) = least_eigenvalue(&matrix);
        // Eigenvalues 1 ± 1.5 along (1, ±1)/√2.
        assert!((least + 0.5).abs() < 1e-12 && (along[0] + along[4]).abs() < 1e-12);
        assert_eq!(cholesky(&matrix), Err(4));
    }
}
