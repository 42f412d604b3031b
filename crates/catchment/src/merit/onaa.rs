//! ONAA: the edge of the largest axis-oriented n-cube inside the accepted set, after each axis is divided by
//! its range in the error box, so that 1 is the whole box.
//!
//! ```text
//!   1 ┌──────────────┐
//!     │   ░░┌────┐   │      e = edge of □,  0 ≤ e ≤ 1
//!     │ ░░░░│    │░  │
//!     │  ░░░└────┘░░ │      in errors: e·(hi − lo) wide along each axis
//!   0 └──────────────┘
//! ```
//!
//! A cube of edge e needs ⌈e·nᵢ⌉ cells along an axis of nᵢ cells, wherever it lies, and a box of that many
//! accepted cells holds it. So e is the largest k/nᵢ for which such a box exists: found exactly, by bisection
//! over those values. Where all nᵢ are equal, dynamic programming finds it in one pass: the largest cube with
//! its last corner in a cell is one larger than the smallest at the preceding corner neighbours.

use super::morphology::fit_boxes;
use super::{MeritError, grid_of};
use crate::acceptance::Acceptance;
use crate::landscape::{Grid, GridAxis};
use crate::pose::Dof;
use std::f64::consts::PI;

/// The largest axis-oriented cube.
#[derive(Debug, Clone, PartialEq)]
pub struct Onaa {
    /// Its edge, in [0, 1]: 1 is the whole error box.
    pub edge: f64,
    /// Where it lies: `(axis, lower border, upper border)` in D and radians, in the order of the grid's axes. Of
    /// several, the one whose centre is nearest to zero. Empty if the edge is 0.
    pub bounds: Vec<(Dof, f64, f64)>,
}

impl Onaa {
    /// The largest cube in the accepted cells of a grid.
    ///
    /// # Errors
    /// If the outcomes are of listed poses.
    pub fn of(acceptance: &Acceptance) -> Result<Self, MeritError> {
        let grid = grid_of(acceptance)?;
        let accepted: Vec<bool> = acceptance.accepted().collect();
        let shape = grid.shape();
        let edge = edge(&shape, &accepted);
        Ok(Self { edge: edge.value(), bounds: locate(grid, edge, accepted) })
    }

    /// The form that the dissertation's planar tables print.
    pub fn pi_edge_squared(&self) -> f64 {
        PI * self.edge * self.edge
    }
}

/// Edge, in cells, of the largest cube of accepted cells: dynamic programming in O(2ⁿ · cells) time and two
/// slabs of memory.
///
/// `shape` is the number of cells per axis, `accepted` one flag per cell, first axis fastest; their lengths must
/// agree.
pub fn largest_cube(shape: &[usize], accepted: &[bool]) -> usize {
    let Some((&slabs, face)) = shape.split_last() else { return 0 };
    let slab: usize = face.iter().product();
    debug_assert_eq!(slab * slabs, accepted.len());
    if slab == 0 {
        return 0;
    }
    // Offsets, inside a slab, to the preceding corner neighbours: every combination of stepping back or not.
    let mut corners = vec![(0usize, 0usize)];
    let mut stride = 1;
    for (axis, cells) in face.iter().enumerate() {
        let stepped: Vec<_> =
            corners.iter().map(|(offset, axes)| (offset + stride, axes | 1 << axis)).collect();
        corners.extend(stepped);
        stride *= cells;
    }
    let (mut before, mut here) = (vec![0usize; slab], vec![0usize; slab]);
    let mut largest = 0;
    for (number, flags) in accepted.chunks_exact(slab).enumerate() {
        let mut cell = vec![0; face.len()];
        for (index, flag) in flags.iter().enumerate() {
            here[index] = if *flag {
                let first =
                    cell.iter().enumerate().fold(0, |set, (axis, k)| set | usize::from(*k == 0) << axis);
                let mut smallest = if number == 0 { 0 } else { usize::MAX };
                for &(offset, axes) in &corners {
                    if axes & first != 0 {
                        smallest = 0;
                        break;
                    }
                    if axes != 0 {
                        smallest = smallest.min(here[index - offset]);
                    }
                    smallest = smallest.min(before[index - offset]);
                }
                smallest + 1
            } else {
                0
            };
            largest = largest.max(here[index]);
            super::advance(&mut cell, face);
        }
        std::mem::swap(&mut before, &mut here);
    }
    largest
}

/// An edge as an exact fraction, so that ⌈e·n⌉ is not a matter of rounding.
#[derive(Debug, Clone, Copy)]
struct Edge {
    cells: usize,
    of: usize,
}

impl Edge {
    fn value(self) -> f64 {
        self.cells as f64 / self.of as f64
    }

    /// ⌈e·n⌉.
    fn cells_of(self, n: usize) -> usize {
        (self.cells * n).div_ceil(self.of)
    }
}

/// The largest edge for which a box of ⌈e·nᵢ⌉ accepted cells exists.
fn edge(shape: &[usize], accepted: &[bool]) -> Edge {
    let none = Edge { cells: 0, of: 1 };
    let Some(&first) = shape.first() else { return none };
    if accepted.is_empty() {
        return none;
    }
    if shape.iter().all(|n| *n == first) {
        return Edge { cells: largest_cube(shape, accepted), of: first };
    }
    let mut candidates: Vec<Edge> =
        shape.iter().flat_map(|n| (1..=*n).map(|cells| Edge { cells, of: *n })).collect();
    candidates.sort_by(|a, b| (a.cells * b.of).cmp(&(b.cells * a.of)));
    candidates.dedup_by(|a, b| a.cells * b.of == b.cells * a.of);
    let fits = |e: &Edge| {
        let mut mask = accepted.to_vec();
        fit_boxes(shape, &shape.iter().map(|n| e.cells_of(*n)).collect::<Vec<_>>(), &mut mask);
        mask.contains(&true)
    };
    match candidates.partition_point(fits) {
        0 => none,
        fitting => candidates[fitting - 1],
    }
}

/// The place of a cube of this edge nearest to zero.
fn locate(grid: &Grid, edge: Edge, mut accepted: Vec<bool>) -> Vec<(Dof, f64, f64)> {
    if edge.cells == 0 {
        return Vec::new();
    }
    let shape = grid.shape();
    let window: Vec<usize> = shape.iter().map(|n| edge.cells_of(*n)).collect();
    fit_boxes(&shape, &window, &mut accepted);
    // Centre of the box of cells that ends with cell `last`; a cube narrower than its cells sits in their middle.
    let center = |axis: &GridAxis, last: usize, cells: usize| {
        axis.lo + (last as f64 + 1.0 - 0.5 * cells as f64) * axis.step()
    };
    let mut cell = vec![0; shape.len()];
    let mut best: Option<(f64, Vec<f64>)> = None;
    for fits in accepted {
        if fits {
            let centers: Vec<f64> =
                grid.axes.iter().zip(&cell).zip(&window).map(|((a, k), w)| center(a, *k, *w)).collect();
            let distance: f64 =
                grid.axes.iter().zip(&centers).map(|(a, c)| (c / (a.hi - a.lo)).powi(2)).sum();
            // Symmetric places are equally far but for rounding: the first one wins.
            if best.as_ref().is_none_or(|(nearest, _)| distance < nearest - 1e-12) {
                best = Some((distance, centers));
            }
        }
        super::advance(&mut cell, &shape);
    }
    let bounds = |(axis, center): (&GridAxis, f64)| {
        let half = 0.5 * edge.value() * (axis.hi - axis.lo);
        (axis.dof, center - half, center + half)
    };
    best.map_or_else(Vec::new, |(_, centers)| grid.axes.iter().zip(centers).map(bounds).collect())
}

#[cfg(test)]
mod tests {
    use super::super::testing::*;
    use super::*;
    use proptest::prelude::*;

    /// All cubes of all edges k/nᵢ at all places, cell by cell.
    fn brute(shape: &[usize], accepted: &[bool]) -> f64 {
        let g = grid(shape, &vec![1.0; shape.len()]);
        let mut largest = 0.0f64;
        for n in shape {
            for k in 1..=*n {
                let window: Vec<usize> = shape.iter().map(|m| (k * m).div_ceil(*n)).collect();
                for start in 0..accepted.len() {
                    let low = g.cell(start);
                    let inside = |i: usize| {
                        g.cell(i).iter().zip(&low).zip(&window).all(|((c, l), w)| (*l..l + w).contains(c))
                    };
                    let room = low.iter().zip(&window).zip(shape).all(|((l, w), m)| l + w <= *m);
                    if room && (0..accepted.len()).filter(|i| inside(*i)).all(|i| accepted[i]) {
                        largest = largest.max(k as f64 / *n as f64);
                    }
                }
            }
        }
        largest
    }

    fn masks() -> impl Strategy<Value = (Vec<usize>, Vec<bool>)> {
        let shapes = prop_oneof![
            proptest::collection::vec(1usize..6, 1..4),
            (1usize..5, 1usize..4).prop_map(|(n, axes)| vec![n; axes]),
        ];
        shapes.prop_flat_map(|shape| {
            let cells = shape.iter().product::<usize>();
            (Just(shape), proptest::collection::vec(prop::bool::weighted(0.85), cells))
        })
    }

    proptest! {
        #[test]
        fn the_edge_is_that_of_the_definition((shape, accepted) in masks()) {
            prop_assert_eq!(edge(&shape, &accepted).value(), brute(&shape, &accepted));
        }
    }

    #[test]
    fn of_a_box_it_is_the_smallest_normalised_edge() {
        // Borders of the box lie on cell borders, so the edge is exact: 2·0.3/2 = 0.3 of x is the smallest.
        let g = grid(&[20, 40, 40], &[1.0, 1.0, 1.5]);
        let accepted = accept(&g, |e| e[0].abs() < 0.3 && e[1].abs() < 0.7 && e[2].abs() < 0.9);
        let onaa = Onaa::of(&accepted).unwrap();
        assert!((onaa.edge - 0.3).abs() < 1e-15);
        let (dof, lo, hi) = onaa.bounds[2];
        assert_eq!(dof, Dof::Roll);
        assert!((lo + 0.45).abs() < 1e-12 && (hi - 0.45).abs() < 1e-12, "{lo} {hi}");
    }

    #[test]
    fn of_a_disc_it_is_the_inscribed_square() {
        // r·√2 of a range of 2; the cube ends on cell borders inside, at most two cells short.
        let onaa = Onaa::of(&ball(&grid(&[200, 200], &[1.0, 1.0]), 0.8)).unwrap();
        let exact = 0.8 / 2f64.sqrt();
        assert!(onaa.edge <= exact + 0.005 && onaa.edge > exact - 0.01, "{}", onaa.edge);
        assert!((onaa.pi_edge_squared() - PI * onaa.edge.powi(2)).abs() < 1e-15);
    }

    #[test]
    fn nothing_accepted_has_no_cube_and_everything_is_the_whole_box() {
        let g = grid(&[5, 5], &[1.0, 1.0]);
        assert_eq!(Onaa::of(&accept(&g, |_| false)).unwrap(), Onaa { edge: 0.0, bounds: Vec::new() });
        assert_eq!(Onaa::of(&accept(&g, |_| true)).unwrap().edge, 1.0);
    }
}
