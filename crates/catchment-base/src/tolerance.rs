//! Tolerances: the scales below which two lengths, or two directions, count as equal.
//!
//! ```text
//!    1e-16      1e-12          1e-9            1e-6             1e-4          2e-3             1
//!  ────┼──────────┼──────────────┼───────────────┼────────────────┼─────────────┼──────────────┼──▶  D, or a sine
//!   one sum   ROUNDING       PARALLEL          SINGLE         TOUCHING    `docked.depth`   the face
//!             sums of        directions        numbers of     ends of     of a design
//!             coordinates    COINCIDENT        mesh files     motions     (default)
//!                            intersections
//! ```
//!
//! Lengths are in D: a design is scaled to D = 1 before any of them applies, and coordinates stay within a
//! thousand D, so that each scale is about a thousand times the scale below it. Lengths of a part whose D is
//! not known yet are relative to its largest coordinate. A module that needs another number states the reason
//! beside it: a share of a step, a digit of a table, the end of a search.
//!
//! The characteristic length ρ, which converts radians to lengths, enters the measure of a motion
//! ([`crate::pose`]); a rotation by α moves a face by up to α D, so angles have the same numbers.

/// Sums of a few thousand coordinates, or of products with unit vectors, in double precision, in D or as a
/// sine: cracks between neighbouring facets are narrower, and nothing that matters is as small.
pub const ROUNDING: f64 = 1e-12;

/// Sine of the angle below which two directions are parallel, and of a slope beyond which a face is a wall: their cross product, or the height over it, has
/// lost all but seven of its sixteen digits.
pub const PARALLEL: f64 = 1e-9;

/// Places computed by intersections, and gaps and heights computed there, in D: within it they are equal. An
/// intersection of planes at a sine of a thousandth, or a height on a slope of a thousand, magnifies
/// [`ROUNDING`] by as much; coordinates written with ten digits round by less.
pub const COINCIDENT: f64 = 1e-9;

/// Ten times the rounding of numbers in single precision (binary STL, 3MF), in D, in radians or as a sine, and
/// that of numbers written with six digits: facets bent by less are coplanar, corners within it are equal.
pub const SINGLE: f64 = 1e-6;

/// Largest gap of features in contact, in D: the accuracy of motion ends, and of drawings rounded to four
/// digits. Designed fits have larger gaps.
pub const TOUCHING: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_scale_is_far_above_the_one_below_it() {
        for third in [PARALLEL, COINCIDENT] {
            let ladder = [f64::EPSILON, ROUNDING, third, SINGLE, TOUCHING];
            assert!(ladder.windows(2).all(|pair| pair[1] >= 10.0 * pair[0]), "{ladder:?}");
        }
        // Coordinates of a thousand D in single precision, relative to the largest of them.
        assert!(SINGLE > 10.0 * f64::from(f32::EPSILON) / 2.0);
    }
}
