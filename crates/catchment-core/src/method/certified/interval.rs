//! Interval arithmetic: numbers with a lower and an upper bound.
//!
//! ```text
//!        lo ├───────×───────┤ up          every operation rounds lo down and up up, by one unit in the last place or more
//! ```
//!
//! Sines come from the system's library, which is accurate to a unit or two in the last place; they are
//! widened by [`SINE`].
//!
//! Not promised: tightness. A quantity that occurs twice in a formula counts as two independent numbers.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::{Add, Mul, Neg, Sub};

/// By how much sines are widened: several units in the last place of 1.
const SINE: f64 = 1e-15;

/// A closed interval; `lo ≤ up`, either may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub(super) lo: f64,
    pub(super) up: f64,
}

/// Three of them: a vector.
pub(super) type Vector = [Interval; 3];

impl Interval {
    pub(super) const ZERO: Self = Self::thin(0.0);
    pub(super) const ONE: Self = Self::thin(1.0);
    pub(super) const EVERYTHING: Self = Self { lo: f64::NEG_INFINITY, up: f64::INFINITY };

    pub(super) const fn new(lo: f64, up: f64) -> Self {
        Self { lo, up }
    }

    /// A single number.
    pub(super) const fn thin(value: f64) -> Self {
        Self { lo: value, up: value }
    }

    pub(super) fn middle(self) -> f64 {
        0.5 * self.lo + 0.5 * self.up
    }

    pub(super) fn width(self) -> f64 {
        self.up - self.lo
    }

    pub(super) fn contains(self, value: f64) -> bool {
        self.lo <= value && value <= self.up
    }

    /// Whether the two have a number in common.
    pub(super) fn meets(self, other: Self) -> bool {
        self.lo <= other.up && other.lo <= self.up
    }

    /// Everything in both; nothing if that is nothing.
    pub(super) fn and(self, other: Self) -> Option<Self> {
        let both = Self { lo: self.lo.max(other.lo), up: self.up.min(other.up) };
        (both.lo <= both.up).then_some(both)
    }

    /// Everything in either, and between.
    pub(super) fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), up: self.up.max(other.up) }
    }

    /// Farther both ways.
    pub(super) fn widened(self, by: f64) -> Self {
        Self { lo: below(self.lo - by), up: above(self.up + by) }
    }

    /// Division by a number above 0; `None` if the divisor may be 0 or below.
    pub(super) fn over(self, divisor: Self) -> Option<Self> {
        (divisor.lo > 0.0).then(|| self * Self { lo: below(1.0 / divisor.up), up: above(1.0 / divisor.lo) })
    }

    /// Division by a nonzero number; `None` if the divisor may be 0.
    pub(super) fn over_signed(self, divisor: Self) -> Option<Self> {
        if divisor.up < 0.0 { (-self).over(-divisor) } else { self.over(divisor) }
    }

    /// Around all of these that are numbers: a product of 0 and infinity is none.
    #[cold]
    fn around_numbers([a, b, c, d]: [f64; 4]) -> Self {
        Self { lo: below(a.min(b).min(c.min(d))), up: above(a.max(b).max(c.max(d))) }
    }

    /// Sine and cosine of an angle, in radians.
    pub(super) fn sin_cos(self) -> [Self; 2] {
        if self == Self::ZERO {
            return [Self::ZERO, Self::ONE];
        }
        [self.wave(FRAC_PI_2, f64::sin), self.wave(0.0, f64::cos)]
    }

    /// A wave that has its crests at `crest` and every turn from there.
    fn wave(self, crest: f64, of: impl Fn(f64) -> f64) -> Self {
        // A range that nearly reaches a crest counts as reaching it: π is rounded.
        let reaches =
            |at: f64| ((self.lo - SINE - at) / TAU - SINE).ceil() <= (self.up + SINE - at) / TAU + SINE;
        let (a, b) = (of(self.lo), of(self.up));
        let up = if reaches(crest) { 1.0 } else { (a.max(b) + SINE).min(1.0) };
        let lo = if reaches(crest + 0.5 * TAU) { -1.0 } else { (a.min(b) - SINE).max(-1.0) };
        Self { lo, up }
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        // Adding zero is exact.
        if self == Self::ZERO || other == Self::ZERO {
            return if self == Self::ZERO { other } else { self };
        }
        Self { lo: below(self.lo + other.lo), up: above(self.up + other.up) }
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        if self == Self::ZERO || other == Self::ZERO {
            return if self == Self::ZERO { -other } else { self };
        }
        Self { lo: below(self.lo - other.up), up: above(self.up - other.lo) }
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        // Without a zero below 0, which is another number in its bits.
        Self { lo: 0.0 - self.up, up: 0.0 - self.lo }
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        // Exact zero remains zero, even times infinity: locked errors contribute nothing.
        if self == Self::ZERO || other == Self::ZERO {
            return Self::ZERO;
        }
        if self == Self::ONE || other == Self::ONE {
            return if self == Self::ONE { other } else { self };
        }
        let (a, b) = (self.lo * other.lo, self.lo * other.up);
        let (c, d) = (self.up * other.lo, self.up * other.up);
        if (a + b + c + d).is_nan() {
            return Self::around_numbers([a, b, c, d]);
        }
        Self { lo: below(less(less(a, b), less(c, d))), up: above(more(more(a, b), more(c, d))) }
    }
}

impl Mul<f64> for Interval {
    type Output = Self;

    fn mul(self, by: f64) -> Self {
        if by == 0.0 || self == Self::ZERO {
            return Self::ZERO;
        }
        let (a, b) = (self.lo * by, self.up * by);
        Self { lo: below(a.min(b)), up: above(a.max(b)) }
    }
}

/// The smaller of two numbers, in one instruction; [`f64::min`] needs several because one of the two may be no number.
fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of two numbers.
fn more(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// A bound this close to 0 is moved out to it. Its square is a normal number: a product of subnormal numbers, such as the neighbours of
/// 0, takes more than ten times as long (16 times on the machine where this was measured).
const LEAST: f64 = 1e-150;

/// The next number below, or −[`LEAST`]. [`f64::next_down`] branches on the sign, which no processor predicts here.
fn below(x: f64) -> f64 {
    if x.abs() < LEAST {
        return -LEAST;
    }
    if x == f64::NEG_INFINITY {
        return x;
    }
    let bits = x.to_bits().cast_signed();
    // One less above 0, and one more below.
    f64::from_bits(bits.wrapping_sub(1 | bits >> 63).cast_unsigned())
}

/// The next number above, or [`LEAST`].
fn above(x: f64) -> f64 {
    -below(-x)
}

/// Scalar product.
pub(super) fn dot(a: &Vector, b: &Vector) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Cross product of two vectors in the plane.
pub(super) fn perp([ax, ay]: [Interval; 2], [bx, by]: [Interval; 2]) -> Interval {
    ax * by - ay * bx
}

/// A vector known exactly.
pub(super) fn thin(v: glam::DVec3) -> Vector {
    v.to_array().map(Interval::thin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// An interval and a number in it.
    fn known() -> impl Strategy<Value = (Interval, f64)> {
        (-4.0..4.0f64, 0.0..3.0f64, 0.0..=1.0f64).prop_map(|(lo, width, share)| {
            let it = Interval::new(lo, lo + width);
            (it, (lo + share * width).min(it.up))
        })
    }

    proptest! {
        #[test]
        fn operations_contain_exact_results((a, x) in known(), (b, y) in known()) {
            prop_assert!((a + b).contains(x + y) && (a - b).contains(x - y) && (a * b).contains(x * y));
            prop_assert!((a * 0.3).contains(x * 0.3) && (-a).contains(-x) && a.hull(b).contains(y));
            prop_assert_eq!(a.and(b).is_some_and(|both| both.contains(x)), b.contains(x));
            prop_assert!(a.over_signed(b).is_none_or(|share| share.contains(x / y)));
            prop_assert!(a.over(b).is_none_or(|share| share.contains(x / y)));
            let [sine, cosine] = a.sin_cos();
            prop_assert!(sine.contains(x.sin()) && cosine.contains(x.cos()), "{sine:?} {cosine:?}");
        }

        #[test]
        fn neighbours_are_those_of_the_library(x in prop::num::f64::ANY) {
            let is_small = x.abs() < LEAST;
            let [lower, upper] = if is_small { [-LEAST, LEAST] } else { [x.next_down(), x.next_up()] };
            prop_assert!(x.is_nan() || below(x) == lower && above(x) == upper);
        }

        #[test]
        fn sine_and_cosine_are_no_wider_than_their_angle((a, _) in known()) {
            for wave in a.sin_cos() {
                prop_assert!(wave.width() <= a.width() + 4.0 * SINE);
            }
        }
    }

    #[test]
    fn products_with_infinity_ignore_what_is_no_number() {
        let to_infinity = Interval::new(0.0, f64::INFINITY);
        assert!((to_infinity * to_infinity).contains(f64::MAX) && (to_infinity * to_infinity).lo >= -LEAST);
        let product = Interval::new(-1.0, 0.0) * Interval::new(1.0, f64::INFINITY);
        assert_eq!((product.lo, product.up), (f64::NEG_INFINITY, LEAST));
    }

    #[test]
    fn sine_reaches_its_maximum_and_zero_stays_zero() {
        let [sine, cosine] = Interval::new(-0.1, 2.0).sin_cos();
        assert_eq!((sine.up, cosine.up), (1.0, 1.0));
        assert_eq!(Interval::ZERO.sin_cos(), [Interval::ZERO, Interval::thin(1.0)]);
        assert_eq!(Interval::ZERO * Interval::EVERYTHING, Interval::ZERO);
        assert_eq!(Interval::thin(1.0).over(Interval::new(0.0, 1.0)), None);
    }
}
