//! Path of the laser's middle that yields the part at its true size.
//!
//! ```text
//!   cut = { points half a kerf outside the part }        every edge moved by kerf/2 along its outer normal, corners mitred
//! ```
//!
//! Exact for edges: a gap between two straight sides is narrower by a kerf on the path and right on the part.
//! Mitred corners leave corners of the part sharp, although the beam's round end would round inner corners by
//! half a kerf.

use super::outline::{Polygon, edges, is_simple};
use glam::DVec2;

/// Why there is no cut line.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum KerfError {
    /// The kerf swallows an edge, or closes a gap.
    #[error("a kerf of {kerf} mm is too wide for the outline: an edge or a gap is narrower")]
    TooWide {
        /// The kerf.
        kerf: f64,
    },
}

/// The cut line of a counter-clockwise outline.
///
/// # Errors
/// The kerf is wider than the feature around which it cuts.
pub fn compensated(outline: &[DVec2], kerf: f64) -> Result<Polygon, KerfError> {
    let distance = 0.5 * kerf;
    let n = outline.len();
    let outer = |a: DVec2, b: DVec2| -(b - a).perp().normalize();
    let cut: Polygon = (0..n)
        .map(|k| {
            let (before, here, after) = (outline[(k + n - 1) % n], outline[k], outline[(k + 1) % n]);
            let (p, q) = (outer(before, here), outer(here, after));
            here + (p + q) * (distance / (1.0 + p.dot(q)))
        })
        .collect();
    let kept = edges(outline).zip(edges(&cut)).all(|((a, b), (c, d))| (b - a).dot(d - c) > 0.0);
    if kept && is_simple(&cut) { Ok(cut) } else { Err(KerfError::TooWide { kerf }) }
}

#[cfg(test)]
mod tests {
    use super::super::outline::area;
    use super::super::{Geometry, LatchDesign};
    use super::*;
    use i_overlay::mesh::float::outline::offset::OutlineOffset;
    use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};

    #[test]
    fn every_edge_of_the_cut_is_half_a_kerf_outside() {
        let latch = LatchDesign::default();
        let outline = Geometry::of(&latch).unwrap().layer();
        let cut = compensated(&outline, latch.kerf).unwrap();
        for ((a, b), (c, d)) in edges(&outline).zip(edges(&cut)) {
            let outer = -(b - a).perp().normalize();
            for p in [c, d] {
                assert!(((p - a).dot(outer) - 0.09).abs() < 1e-9);
            }
        }
        assert_eq!(compensated(&outline, 0.0).unwrap(), outline);
        assert!(compensated(&outline, 0.37).is_err(), "the slit is 0.36 wide");
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
        assert!((area(&compensated(&square, 0.5).unwrap()) - 2.5 * 1.5).abs() < 1e-12);
    }

    /// Another implementation, on a grid of whole numbers: the same area, to its rounding.
    #[test]
    fn the_judge_agrees() {
        let latch = LatchDesign::default();
        let outline = Geometry::of(&latch).unwrap().layer();
        let points: Vec<[f64; 2]> = outline.iter().map(|p| [p.x, p.y]).collect();
        let style = OutlineStyle::new(0.09).line_join(LineJoin::Miter(0.01));
        let judged: f64 = points
            .outline(&style)
            .iter()
            .flatten()
            .map(|path| area(&path.iter().map(|p| DVec2::from_array(*p)).collect::<Vec<_>>()))
            .sum();
        let ours = area(&compensated(&outline, latch.kerf).unwrap());
        // 560 corners rounded to 2^-30 of the part's size, times a perimeter of 400 mm.
        assert!((ours - judged).abs() < 1e-2, "{ours} {judged}");
    }
}
