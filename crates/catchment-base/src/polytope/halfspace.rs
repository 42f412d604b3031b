//! A half-space: the points behind a plane, `normal · x ≤ offset`.

use super::{MAX_DIMENSION, PolytopePoint, dot};

/// The points behind a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halfspace {
    /// The unit normal, pointing out.
    pub normal: PolytopePoint,
    /// Distance of the plane from the origin along the normal, in D or rad.
    pub offset: f64,
}

impl Halfspace {
    /// `normal · x ≤ offset`, scaled so that the normal has length 1. `None` if the normal is zero or a
    /// number is not finite.
    pub fn new(normal: PolytopePoint, offset: f64) -> Option<Self> {
        // Scaled by the largest component first, so that no square overflows.
        let largest = normal.iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
        let scaled = normal.map(|c| c / largest);
        let length = dot(&scaled, &scaled).sqrt();
        let (normal, offset) = (scaled.map(|c| c / length), offset / largest / length);
        let finite = largest > 0.0 && normal.iter().all(|c| c.is_finite()) && offset.is_finite();
        finite.then_some(Self { normal, offset })
    }

    /// The other half.
    #[must_use]
    pub fn flipped(&self) -> Self {
        let mut normal = [0.0; MAX_DIMENSION];
        for (to, from) in normal.iter_mut().zip(self.normal) {
            // No negative zeros, which would print as if they meant something.
            *to = 0.0 - from;
        }
        Self { normal, offset: 0.0 - self.offset }
    }

    /// Distance of a point outside; negative inside.
    pub fn excess(&self, point: &PolytopePoint) -> f64 {
        dot(&self.normal, point) - self.offset
    }
}
