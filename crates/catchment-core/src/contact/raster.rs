//! Cells of a lattice that a convex polygon covers, row by row.

use super::Lattice;
use super::brute::SEAM;
use glam::DVec2;
use std::ops::Range;

/// Calls `visit(row, columns)` for every row of the lattice that meets the convex polygon, borders included.
pub(crate) fn fill_convex(
    polygon: &[DVec2],
    x: Lattice,
    y: Lattice,
    mut visit: impl FnMut(usize, Range<usize>),
) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for p in polygon {
        low = low.min(p.y);
        high = high.max(p.y);
    }
    for row in covered(low, high, y) {
        // A row within the seam of the border belongs to the border itself.
        let level = y.at(row).clamp(low, high);
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut a = polygon[polygon.len() - 1];
        for &b in polygon {
            if (a.y <= level && level <= b.y) || (b.y <= level && level <= a.y) {
                let rise = b.y - a.y;
                if rise == 0.0 {
                    left = left.min(a.x.min(b.x));
                    right = right.max(a.x.max(b.x));
                } else {
                    let x = a.x + (b.x - a.x) * ((level - a.y) / rise);
                    left = left.min(x);
                    right = right.max(x);
                }
            }
            a = b;
        }
        let columns = covered(left, right, x);
        if !columns.is_empty() {
            visit(row, columns);
        }
    }
}

/// The lattice points in [low, high], widened by the seam.
fn covered(low: f64, high: f64, lattice: Lattice) -> Range<usize> {
    if low > high {
        return 0..0;
    }
    if lattice.count == 1 || lattice.step == 0.0 {
        let hit = lattice.first >= low - SEAM && lattice.first <= high + SEAM;
        return 0..if hit { lattice.count } else { 0 };
    }
    let first = ((low - SEAM - lattice.first) / lattice.step).ceil().max(0.0);
    let last = ((high + SEAM - lattice.first) / lattice.step).floor().min(lattice.count as f64 - 1.0);
    if last < first { 0..0 } else { first as usize..last as usize + 1 }
}
