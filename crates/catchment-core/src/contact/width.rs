//! Default D of a design: the width of the halves in the region in which they can touch.
//!
//! ```text
//!    ┌───────────────┐   moving, as mated
//!    └──┐  ╲  ╱  ┌───┘   its downward faces below the top of the fixed half          ─┐
//!   ────┴╲  ╲╱  ╱┴────── upward faces of the fixed half above the moving bottom       │ the boxes around both, in plan view
//!   ──────╲____╱───────                                                              ─┘
//!       ├── D ──┤        the larger side, along x or y, of their common rectangle
//! ```
//!
//! Facets that face sideways or away cannot be first contacts. The measure uses boxes, not outlines: for a
//! square that stands on its corner the diagonal counts. Not promised: that a designer would call D the
//! width. It is only the unit of the results.

use crate::connector::Half;
use crate::connector::mesh::PLAUSIBLE_WIDTH;
use crate::design::WidthFrom;
use crate::tolerance::{self, TOUCHING};
use glam::{DVec2, DVec3};

/// A facet faces up or down if the z-component of its normal is beyond this: above the rounding of upright
/// walls.
const LOOKS: f64 = tolerance::SINGLE;
/// How much wider than D a half may be as drawn: a little less than designs allow.
pub const MOST_WIDE: f64 = 0.99 * *PLAUSIBLE_WIDTH.end();

/// The box in plan view around the features that can touch, lowest and highest corner, with the moving half
/// lifted by `lift`; `None` if the halves share no area.
pub fn touching(fixed: &Half, moving: &Half, lift: f64) -> Option<[DVec2; 2]> {
    let ([_, top], [bottom, _]) = (fixed.span(), moving.span());
    let wide = |half: &Half| {
        let sizes = half.surfaces.iter().map(|surface| {
            let (low, high) = surface.bounds();
            (high - low).truncate().max_element()
        });
        sizes.fold(0.0, f64::max)
    };
    let seam = TOUCHING * wide(fixed).min(wide(moving));
    let [a, b] = around(fixed, 1.0, bottom + lift - seam);
    // Seen from below.
    let [c, d] = around(moving, -1.0, -(top - lift) - seam);
    let (low, high) = (a.max(c), b.min(d));
    (low.is_finite() && high.is_finite() && low.cmple(high).all()).then_some([low, high])
}

/// D: the larger side of that box.
pub fn width(fixed: &Half, moving: &Half, lift: f64) -> Option<f64> {
    let [low, high] = touching(fixed, moving, lift)?;
    Some((high - low).max_element()).filter(|width| *width > 0.0)
}

/// The source of D, and D, for halves as mated; `widest` is their larger lateral extent as drawn: designs
/// allow no half much wider than D.
pub(crate) fn default(fixed: &Half, moving: &Half, lift: f64, widest: f64) -> Option<(f64, WidthFrom)> {
    let (touching, least) = (width(fixed, moving, lift)?, widest / MOST_WIDE);
    Some(if touching < least { (least, WidthFrom::Size) } else { (touching, WidthFrom::Touching) })
}

/// The box around the facets that face along `up`·z and lie at or above `level` along it.
fn around(half: &Half, up: f64, level: f64) -> [DVec2; 2] {
    let mut bounds = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    let mut hold = |p: DVec3| bounds = [bounds[0].min(p.truncate()), bounds[1].max(p.truncate())];
    for surface in &half.surfaces {
        for facet in surface.facets.iter().filter(|facet| facet.normal.z * up > LOOKS) {
            let at = |k: usize| surface.vertices[facet.corners[k % facet.corners.len()] as usize];
            for k in 0..facet.corners.len() {
                let (p, q) = (at(k), at(k + 1));
                let (above, next) = (p.z * up - level, q.z * up - level);
                if above >= 0.0 {
                    hold(p);
                }
                if above * next < 0.0 {
                    hold(p.lerp(q, above / (above - next)));
                }
            }
        }
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::convex_hull;

    /// A box from corner to corner.
    fn block(low: [f64; 3], high: [f64; 3]) -> Half {
        let corner = |k: u8| {
            DVec3::from_array(std::array::from_fn(
                |axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] },
            ))
        };
        Half::of(vec![convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()])
    }

    #[test]
    fn unreachable_surfaces_do_not_count() {
        // A plate with a tower; a small block on the tower, with a wide plate far above.
        let mut fixed = block([-50.0, -50.0, 0.0], [50.0, 50.0, 5.0]);
        fixed.surfaces.extend(block([-10.0, -8.0, 5.0], [10.0, 8.0, 30.0]).surfaces);
        let mut moving = block([-4.0, -6.0, 30.0], [7.0, 6.0, 40.0]);
        moving.surfaces.extend(block([-60.0, -60.0, 40.0], [60.0, 60.0, 45.0]).surfaces);
        assert_eq!(touching(&fixed, &moving, 0.0), Some([DVec2::new(-4.0, -6.0), DVec2::new(7.0, 6.0)]));
        assert_eq!(width(&fixed, &moving, 0.0), Some(12.0));
        // Lifted, the block touches nothing.
        assert_eq!(width(&fixed, &moving, 1.0), None);
    }

    #[test]
    fn only_the_overlapping_part_of_a_slope_counts() {
        let cone = |z: f64, tip: f64, r: f64| {
            let ring = [[r, 0.0], [0.0, r], [-r, 0.0], [0.0, -r]].map(|[x, y]| DVec3::new(x, y, z));
            Half::of(vec![convex_hull(&[&ring[..], &[DVec3::new(0.0, 0.0, tip)]].concat()).unwrap()])
        };
        // Tip down to z = −10 from a ring at 0; a floor reaches up to −4: of the slope 6 of 10 count.
        let (moving, fixed) = (cone(0.0, -10.0, 20.0), block([-30.0; 3], [30.0, 30.0, -4.0]));
        let result = width(&fixed, &moving, 0.0).unwrap();
        assert!((result - 2.0 * 12.0).abs() < 0.02, "{result}");
    }
}
