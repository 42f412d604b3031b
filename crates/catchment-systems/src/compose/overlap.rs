//! The overlap of two regions as a function of the position of the second, and a bound on it around a
//! position.
//!
//! ```text
//!   O(d) = Σ O_ij(d)        over pairs of convex polygons, O_ij = area of their intersection
//!
//!   √O_ij is concave on its support (Brunn and Minkowski), so with the gradient ∇ of O_ij at d, for every δ
//!
//!   O_ij(d + δ) ≤ (√O_ij + ∇·δ / 2√O_ij)² = O_ij + ∇·δ + (∇·δ)² / 4 O_ij
//!   O_ij(d + δ) ≤ area of A_i ∩ (B_j + d, its sides moved outwards for a square of side 2·max|δ| about any point)
//! ```
//!
//! The gradient is the sum of the sides of the intersection that belong to the second polygon, each as its
//! length along its outer normal. If sides of both polygons coincide `O_ij` has a kink, and either choice
//! bounds it. Linear terms of pairs add up with their signs, so that they cancel near the maximum; the second
//! bound serves pairs with little or no overlap.

use super::region::{Region, place};
use super::sum::convex_parts;
use catchment::polygon::{ConvexPolygon, Scratch};
use glam::DVec2;

/// The overlap of the two regions when the second is moved by d: area of A ∩ (B + d), from their convex polygons.
///
/// It is the convolution of the indicator functions of A and −B: 0 outside the Minkowski sum of the two, and its integral over
/// all d is area(A)·area(B).
#[derive(Debug, Clone)]
pub struct RegionOverlap {
    first: Vec<ConvexPolygon>,
    second: Vec<ConvexPolygon>,
}

/// An overlap with its bounds around a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Around {
    /// At the place.
    pub(super) value: f64,
    /// At most, at all places no farther off along either axis.
    pub(super) at_most: f64,
}

impl RegionOverlap {
    /// Of two regions.
    pub fn new(a: &Region, b: &Region) -> Self {
        let polygon = |part: &Vec<_>| ConvexPolygon::new(part.iter().map(|p| place(*p)).collect());
        let parts = |region: &Region| convex_parts(region).iter().map(polygon).collect();
        Self { first: parts(a), second: parts(b) }
    }

    /// Number of pairs of convex polygons for a value.
    pub(super) fn pairs(&self) -> usize {
        self.first.len() * self.second.len()
    }

    /// Area of A ∩ (B + d).
    pub fn at(&self, d: DVec2) -> f64 {
        let mut scratch = Scratch::default();
        let mut of = |b: &ConvexPolygon| {
            self.first.iter().map(|a| a.common(b, d, 0.0, &mut scratch).area).sum::<f64>()
        };
        self.second.iter().map(&mut of).sum()
    }

    /// Area of A ∩ (B + d), and the most it is at places no farther from d than `half` along either axis.
    pub(super) fn around(&self, d: DVec2, half: f64) -> Around {
        // Roundings of some dozens of terms are far below this share.
        const ROUNDING: f64 = 1e-10;
        let mut scratch = Scratch::default();
        let (mut value, mut gradient, mut bent, mut rough, mut together) = (0.0, DVec2::ZERO, 0.0, 0.0, 0.0);
        for b in &self.second {
            for a in &self.first {
                if !a.is_near(b, d, half) {
                    continue;
                }
                let found = a.common(b, d, 0.0, &mut scratch);
                value += found.area;
                let grown = a.common(b, d, half, &mut scratch).area.min(a.area().min(b.area()));
                let most = (grown - found.area).max(0.0);
                let turn = half * found.gradient.abs().element_sum();
                let bend = 0.25 * turn * turn / found.area;
                if found.area > 0.0 && bend < most {
                    gradient += found.gradient;
                    bent += bend;
                } else {
                    rough += most;
                }
                together += most;
            }
        }
        let at_most = value + (half * gradient.abs().element_sum() + bent + rough).min(together);
        Around { value, at_most: at_most * (1.0 + ROUNDING) }
    }
}
