//! Two estimates of the full-dimensional ONAA edge from slices.
//!
//! ```text
//!   yaw ▲                    corners (e, e) of the largest cubes of the slices x-y, x-roll, x-pitch, x-yaw,
//!       │ ╲                  and y-yaw, taken equal to x-yaw
//!       │   • (e, e)         n·p = 1   the hyperplane through them
//!       │     ╲              (d, …, d) the point of it on the diagonal: the conservative edge
//!       └───────╲─▶ x        the optimistic edge is the smallest e
//! ```
//!
//! With `n_x = n_y`, which y-yaw equal to x-yaw means, `n_x + n_y = 1/e_xy` and `n_x + n_a = 1/e_xa`, so that
//! `1/d = 1/e_xy + Σ (1/e_xa − 1/(2·e_xy))` over the rotations a.
//!
//! Not promised: that the true edge lies between the two. Slices through zero contain no information on the
//! rest of the error box, and an ONAA cube need not be centred. Edges are shares of the error box, in [0, 1].
//!
//! Source: the dissertation, section 4.2.2.

/// Estimates of the edge of the largest axis-oriented cube in all free errors, in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Estimate {
    /// The smallest edge among the slices: an upper bound on the edge of a cube that intersects all of them.
    pub optimistic: f64,
    /// The edge d of the cube whose corner lies on the hyperplane through the corners of the slices' cubes;
    /// at most the optimistic edge.
    pub conservative: f64,
}

impl Estimate {
    /// From the ONAA edges of the x-y slice and of the slices of x with each rotation.
    pub fn of(x_y: f64, x_with_rotations: &[f64]) -> Self {
        let optimistic = x_with_rotations.iter().copied().fold(x_y, f64::min);
        if optimistic <= 0.0 {
            return Self { optimistic: 0.0, conservative: 0.0 };
        }
        let inverse = x_with_rotations.iter().map(|e| 1.0 / e - 0.5 / x_y).sum::<f64>() + 1.0 / x_y;
        // A plane that the diagonal never meets bounds nothing.
        let diagonal = if inverse > 0.0 { 1.0 / inverse } else { f64::INFINITY };
        Self { optimistic, conservative: diagonal.min(optimistic) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_slices_give_the_published_estimates() {
        let result = Estimate::of(0.390, &[0.536, 0.415, 0.524]);
        assert_eq!(result.optimistic, 0.390);
        assert!((result.conservative - 0.204).abs() < 0.0005, "{}", result.conservative);
    }

    #[test]
    fn equal_slices_give_the_diamond_and_empty_ones_nothing() {
        // n is the same along all five axes: 2 n = 1/e, and 5 n d = 1.
        let result = Estimate::of(0.5, &[0.5; 3]);
        assert!((result.conservative - 0.4 * 0.5).abs() < 1e-15);
        assert_eq!(Estimate::of(0.0, &[0.5; 3]), Estimate { optimistic: 0.0, conservative: 0.0 });
        assert_eq!(Estimate::of(0.5, &[0.5, 0.0]).conservative, 0.0);
        // Here the plane lies beyond the smallest slice, or is not met at all.
        assert_eq!(Estimate::of(0.2, &[0.5; 3]).conservative, 0.2);
        assert_eq!(Estimate::of(0.1, &[1.0; 3]).conservative, 0.1);
    }
}
