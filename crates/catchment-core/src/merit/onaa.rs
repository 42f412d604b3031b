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
//! A cube of edge e needs ⌈e·nᵢ⌉ cells along an axis of nᵢ cells, at any position, and a box of that many
//! accepted cells contains it. So e is the largest k/nᵢ for which such a box exists: found exactly, by
//! bisection over those values. Fitting boxes are composed from smaller boxes that fit, 64 cells at once.
//! [`super::brute::largest_cube`] is the slow reference.

use super::mask::Mask;
use super::{MeritError, grid_of};
use crate::acceptance::{Acceptance, Outcome};
use crate::exec::{Cancelled, Exec};
use crate::landscape::{Grid, GridAxis};
use crate::pose::Dof;
use crate::tolerance::ROUNDING;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The largest axis-oriented n-cube in the accepted set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Onaa {
    /// Edge of the cube, with each axis divided by its range: in [0, 1].
    pub edge: f64,
    /// Bounds of the cube, of several the one with its centre nearest to zero; empty if the edge is 0.
    pub bounds: Vec<Interval>,
    /// Whether exact motions determined the size, independently of the cells; false in reports of older
    /// versions.
    #[serde(default)]
    pub followed: bool,
}

/// An interval along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Interval {
    /// The error.
    pub axis: Dof,
    /// Lower end, D or rad.
    pub lo: f64,
    /// Upper end, D or rad.
    pub hi: f64,
}

impl Onaa {
    /// The largest cube in the accepted cells of a grid.
    ///
    /// # Errors
    /// If the outcomes are of listed poses, the cells do not fit into memory as bits, or it is cancelled.
    pub fn of(acceptance: &Acceptance, exec: &Exec) -> Result<Self, MeritError> {
        let grid = grid_of(acceptance)?;
        // On these threads as a whole: to enter them again and again takes longer than a small grid.
        exec.install(|| {
            let accepted = Mask::of(&grid.shape(), &acceptance.outcomes, |o| o == Outcome::Aligned, exec)?;
            let fitting = Fitting::largest(&grid.shape(), accepted, exec)?;
            let bounds = fitting.nearest_to_zero(grid);
            Ok(Self { edge: fitting.edge.value(), bounds, followed: false })
        })
    }

    /// The form that the dissertation's planar tables print.
    pub fn pi_edge_squared(&self) -> f64 {
        PI * self.edge * self.edge
    }
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

/// The boxes of accepted cells that contain a cube of a given edge.
#[derive(Debug, Clone)]
struct Fitting {
    edge: Edge,
    /// Cells of a box along each axis.
    window: Vec<usize>,
    /// First corners of the boxes.
    corners: Mask,
}

impl Fitting {
    /// The boxes of the largest edge for which there are any; of edge 0 if no cell is accepted.
    fn largest(shape: &[usize], accepted: Mask, exec: &Exec) -> Result<Self, Cancelled> {
        let mut edges: Vec<Edge> =
            shape.iter().flat_map(|n| (1..=*n).map(|cells| Edge { cells, of: *n })).collect();
        edges.sort_by(|a, b| (a.cells * b.of).cmp(&(b.cells * a.of)));
        edges.dedup_by(|a, b| a.cells * b.of == b.cells * a.of);
        let none = Edge { cells: 0, of: 1 };
        // The smallest edge of all needs a single cell.
        let smallest = if accepted.is_empty() { none } else { edges.first().copied().unwrap_or(none) };
        let mut best = Self { edge: smallest, window: vec![1; shape.len()], corners: accepted };
        let (mut fits, mut too_large) = (0, if smallest.cells == 0 { 0 } else { edges.len() });
        while fits + 1 < too_large {
            let middle = usize::midpoint(fits, too_large);
            let edge = edges[middle];
            let window: Vec<usize> = shape.iter().map(|n| edge.cells_of(*n)).collect();
            let mut corners = best.corners.clone();
            corners.widen_boxes(&best.window, &window, exec)?;
            if corners.is_empty() {
                too_large = middle;
            } else {
                fits = middle;
                best = Self { edge, window, corners };
            }
        }
        Ok(best)
    }

    /// The position of the cube nearest to zero: among equals, the first in memory.
    fn nearest_to_zero(&self, grid: &Grid) -> Vec<Interval> {
        if self.edge.cells == 0 {
            return Vec::new();
        }
        // Centre of a box by its first cell; a cube narrower than its cells sits in their middle.
        let centers: Vec<Vec<f64>> = grid
            .axes
            .iter()
            .zip(&self.window)
            .map(|(axis, cells)| {
                let center = |k: usize| axis.lo + (k as f64 + 0.5 * *cells as f64) * axis.step();
                (0..axis.cells).map(center).collect()
            })
            .collect();
        let squares: Vec<Vec<f64>> = grid
            .axes
            .iter()
            .zip(&centers)
            .map(|(axis, centers)| centers.iter().map(|c| (c / (axis.hi - axis.lo)).powi(2)).collect())
            .collect();
        let distance = |mut index: usize| -> f64 {
            let mut sum = 0.0;
            for square in &squares {
                sum += square[index % square.len()];
                index /= square.len();
            }
            sum
        };
        let corner = self.corners.marked().map(distance).min_by(f64::total_cmp).and_then(|nearest| {
            // Symmetric places are equally far except for rounding.
            let limit = nearest + ROUNDING;
            self.corners.marked().find_first(|index| distance(*index).total_cmp(&limit).is_le())
        });
        let bounds = |((axis, centers), k): ((&GridAxis, &Vec<f64>), usize)| {
            let half = 0.5 * self.edge.value() * (axis.hi - axis.lo);
            Interval { axis: axis.dof, lo: centers[k] - half, hi: centers[k] + half }
        };
        let cell = corner.map(|index| grid.cell(index)).unwrap_or_default();
        grid.axes.iter().zip(&centers).zip(cell).map(bounds).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::brute::largest_cube;
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

    /// Outcomes for each flag over [−1, 1] along each axis.
    fn accepting(shape: &[usize], accepted: &[bool]) -> Acceptance {
        let mut acceptance = accept(&grid(shape, &vec![1.0; shape.len()]), |_| true);
        for (outcome, _) in acceptance.outcomes.iter_mut().zip(accepted).filter(|(_, accepted)| !**accepted) {
            *outcome = Outcome::Jammed;
        }
        acceptance
    }

    proptest! {
        #[test]
        fn the_edge_is_that_of_the_definition((shape, accepted) in masks()) {
            let onaa = Onaa::of(&accepting(&shape, &accepted), &Exec::new()).unwrap();
            prop_assert_eq!(onaa.edge, brute(&shape, &accepted));
            if shape.iter().all(|n| *n == shape[0]) {
                prop_assert_eq!(onaa.edge, largest_cube(&shape, &accepted) as f64 / shape[0] as f64);
            }
        }

        /// Every cell that the cube meets is accepted; a cell that it touches within rounding does not count
        /// as met.
        #[test]
        fn the_cube_lies_in_the_accepted_cells((shape, accepted) in masks()) {
            let acceptance = accepting(&shape, &accepted);
            let onaa = Onaa::of(&acceptance, &Exec::new()).unwrap();
            prop_assert_eq!(onaa.bounds.is_empty(), onaa.edge == 0.0);
            let g = acceptance.grid().unwrap();
            for index in (0..accepted.len()).filter(|_| onaa.edge > 0.0) {
                let meets = g.axes.iter().zip(g.cell(index)).zip(&onaa.bounds).all(|((a, k), Interval { lo, hi, .. })| {
                    *lo < a.lo + (k + 1) as f64 * a.step() - 1e-9 && *hi > a.lo + k as f64 * a.step() + 1e-9
                });
                prop_assert!(!meets || accepted[index]);
            }
        }
    }

    #[test]
    fn of_a_box_it_is_the_smallest_normalised_edge() {
        // Borders of the box lie on cell borders, so the edge is exact: 2·0.3/2 = 0.3 of x is the smallest.
        let g = grid(&[20, 40, 40], &[1.0, 1.0, 1.5]);
        let accepted = accept(&g, |e| e[0].abs() < 0.3 && e[1].abs() < 0.7 && e[2].abs() < 0.9);
        let onaa = Onaa::of(&accepted, &Exec::new()).unwrap();
        assert!((onaa.edge - 0.3).abs() < 1e-15);
        let Interval { axis, lo, hi } = onaa.bounds[2];
        assert_eq!(axis, Dof::Roll);
        assert!((lo + 0.45).abs() < 1e-12 && (hi - 0.45).abs() < 1e-12, "{lo} {hi}");
    }

    #[test]
    fn of_a_disc_it_is_the_inscribed_square() {
        // r·√2 of a range of 2; the cube ends on cell borders inside, at most two cells short.
        let onaa = Onaa::of(&ball(&grid(&[200, 200], &[1.0, 1.0]), 0.8), &Exec::new()).unwrap();
        let exact = 0.8 / 2f64.sqrt();
        assert!(onaa.edge <= exact + 0.005 && onaa.edge > exact - 0.01, "{}", onaa.edge);
        assert!((onaa.pi_edge_squared() - PI * onaa.edge.powi(2)).abs() < 1e-15);
    }

    #[test]
    fn nothing_accepted_has_no_cube_and_everything_is_the_whole_box() {
        let g = grid(&[5, 5], &[1.0, 1.0]);
        let of = |all| Onaa::of(&accept(&g, |_| all), &Exec::new()).unwrap();
        assert_eq!(of(false), Onaa { edge: 0.0, bounds: Vec::new(), followed: false });
        assert_eq!(of(true).edge, 1.0);
    }
}
