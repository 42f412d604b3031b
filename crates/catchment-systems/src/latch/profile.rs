//! The profile of the arm: the curve on which the halves slide into place.
//!
//! ```text
//!   f(x) = h + ∫ₓ^xₑ tan φ(u) du        φ(x) = φ₀ + (φ₁ − φ₀)·(x/xₑ)ⁿ        0 ≤ x ≤ xₑ = L/2 + o/2
//! ```
//!
//! φ is the angle to the x axis, downward: φ₀ at the outer edge (stated: 35°), φ₁ at the hook, at which the
//! tangent passes through the pivot P (stated). Between them the dissertation has "an interpolated spline" of
//! negative curvature; any increasing φ fulfils this, and this family is ours. The exponent n controls the
//! bend: the larger n, the later the curve bends, and the lower it is at the outer edge.

use super::LatchDesign;

/// Panels of the quadrature of f; with five points each the error is far below a nanometre for every n allowed.
const PANELS: usize = 32;
/// Points and weights of Gauss and Legendre on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// The profile of an arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmProfile {
    /// Its end, at the hook, in mm from the outer edge.
    pub x_end: f64,
    /// Its height there, in mm.
    pub hook: f64,
    /// Its angle at the outer edge, in rad below the x axis.
    pub start: f64,
    /// Its angle at the hook.
    pub end: f64,
    /// How late it bends.
    pub bend: f64,
}

impl ArmProfile {
    /// The profile of a latch, for an angle at the hook.
    pub fn of(latch: &LatchDesign, end: f64) -> Self {
        let x_end = 0.5 * (latch.width + latch.overhang);
        Self { x_end, hook: latch.hook, start: latch.spline_start, end, bend: latch.bend }
    }

    /// The angle below the x axis, in rad.
    pub fn angle(&self, x: f64) -> f64 {
        self.start + (self.end - self.start) * (x / self.x_end).max(0.0).powf(self.bend)
    }

    /// f′.
    pub fn slope(&self, x: f64) -> f64 {
        -self.angle(x).tan()
    }

    /// f″, in 1/mm.
    pub fn second(&self, x: f64) -> f64 {
        let share = (x / self.x_end).max(0.0);
        let rate = (self.end - self.start) * self.bend / self.x_end * share.powf(self.bend - 1.0);
        -rate / self.angle(x).cos().powi(2)
    }

    /// The smallest angle anywhere: it must be positive for the profile to fall everywhere.
    pub const fn least_angle(&self) -> f64 {
        self.start.min(self.end)
    }

    /// f, in mm.
    pub fn height(&self, x: f64) -> f64 {
        let half = 0.5 * (self.x_end - x) / PANELS as f64;
        let panel = |k: usize| {
            let middle = x + (2 * k + 1) as f64 * half;
            GAUSS.iter().map(|(at, weight)| weight * self.angle(middle + at * half).tan()).sum::<f64>()
        };
        self.hook + half * (0..PANELS).map(panel).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without bend the integral has a closed form; with bend, halved steps of a plain sum agree.
    #[test]
    fn heights_are_integrals_of_slopes() {
        let straight = ArmProfile { x_end: 35.3, hook: 3.0, start: 0.7, end: 0.7, bend: 6.0 };
        assert!((straight.height(10.0) - (3.0 + 25.3 * 0.7f64.tan())).abs() < 1e-12);
        let bent = ArmProfile { end: 1.32, start: 0.61, ..straight };
        let steps = 200_000;
        for x in [0.0, 17.75, 34.9] {
            let width = (bent.x_end - x) / f64::from(steps);
            let sum: f64 = (0..steps).map(|k| -bent.slope(x + (f64::from(k) + 0.5) * width)).sum();
            // The midpoint rule errs by width²/24 times the change of slope: below 1e-8 mm here.
            assert!((bent.height(x) - (3.0 + sum * width)).abs() < 1e-7, "{x}");
        }
        let (x, d) = (20.0, 1e-4);
        let second = (bent.slope(x + d) - bent.slope(x - d)) / (2.0 * d);
        assert!((second - bent.second(x)).abs() < 1e-6 && second < 0.0);
    }
}
