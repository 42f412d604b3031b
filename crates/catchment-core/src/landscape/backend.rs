//! Backends that compute heights: the definition, and fast paths that the same tests verify.
//!
//! ```text
//!   rotations of the grid   0 ········ 3 4 5 6 7 ········ n        a backend fills the slabs of any range of them;
//!                                      └──range──┘                 cut anywhere, the pieces are those of the whole
//! ```

use super::Grid;
use crate::contact::{Lattice, Pair, brute};
use crate::pose::{CorPose, Dof, face_from_cor};
use glam::{DMat3, DVec2};
use std::ops::Range;

/// Computes heights of first contact over rotations of an error grid.
pub trait Backend: Sync {
    /// Heights over a range of the grid's rotations, in grid order: z of the COR at first contact at every
    /// cell's centre, in D, rounded to single precision; −∞ if the halves pass each other by.
    ///
    /// `out` has the cells of those rotations, x fastest, and is overwritten. An error without an axis is 0;
    /// a translation that the pair locks stays at the COR. The results for a rotation depend on that rotation
    /// alone. The grid samples no locked translation.
    fn heights(&self, pair: &Pair, grid: &Grid, rotations: Range<usize>, out: &mut [f32]);
}

/// The fast path: the upper envelope of all possible contacts, one rotation at a time.
#[derive(Debug, Clone, Copy, Default)]
pub struct Fast;

impl Backend for Fast {
    fn heights(&self, pair: &Pair, grid: &Grid, rotations: Range<usize>, out: &mut [f32]) {
        let slab = slab(grid);
        let mut buffer = vec![0.0f64; slab];
        let mut envelope = None;
        for (k, out) in rotations.zip(out.chunks_exact_mut(slab.max(1))) {
            let rotation = grid.pose(k * slab).rotation();
            let envelope = match &mut envelope {
                None => envelope.insert(pair.at_rotation(rotation)),
                Some(envelope) => {
                    envelope.turn(&rotation);
                    envelope
                }
            };
            let [x, y] = lateral_lattices(pair, grid, &rotation);
            envelope.heights(x, y, &mut buffer);
            for (out, height) in out.iter_mut().zip(&buffer) {
                *out = *height as f32;
            }
        }
    }
}

/// The reference: the definition in plain loops, cell by cell.
#[derive(Debug, Clone, Copy, Default)]
pub struct Brute;

impl Backend for Brute {
    fn heights(&self, pair: &Pair, grid: &Grid, rotations: Range<usize>, out: &mut [f32]) {
        let slab = slab(grid);
        let alignment = &pair.alignment;
        for (cell, out) in (rotations.start * slab..rotations.end * slab).zip(out) {
            let pose = CorPose::from_error(&grid.pose(cell), alignment.center_of_rotation, alignment.free);
            *out = brute::height(pair, &pose).map_or(f32::NEG_INFINITY, |height| height as f32);
        }
    }
}

/// Cells per rotation.
pub(super) fn slab(grid: &Grid) -> usize {
    grid.axes.iter().filter(|a| !a.dof.is_rotation()).map(|a| a.cells).product()
}

/// COR positions along x and y at a given rotation, for the grid's face centres.
pub(super) fn lateral_lattices(pair: &Pair, grid: &Grid, rotation: &DMat3) -> [Lattice; 2] {
    let face = face_from_cor(rotation, pair.alignment.center_of_rotation);
    [(Dof::X, face.x), (Dof::Y, face.y)].map(|(dof, face)| match grid.axis(dof) {
        Some(axis) => Lattice { first: axis.center(0) - face, step: axis.step(), count: axis.cells },
        None if pair.alignment.free.contains(dof) => Lattice { first: -face, step: 0.0, count: 1 },
        None => Lattice { first: 0.0, step: 0.0, count: 1 },
    })
}

/// The COR at cell numbers (kx, ky), whole or not, of two lattices.
pub(super) fn lateral([x, y]: [Lattice; 2], kx: f64, ky: f64) -> DVec2 {
    DVec2::new(x.first + kx * x.step, y.first + ky * y.step)
}

/// The requirements on every backend.
#[cfg(test)]
mod conformance {
    use super::*;
    use crate::connector::Connector;
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
    use proptest::prelude::*;

    fn families() -> impl Strategy<Value = Family> {
        prop::sample::select(vec![Family::Pyramid, Family::XFace3d, Family::VFace, Family::SFace])
    }

    /// A pair with its COR anywhere and any of its errors free, and a grid over some of them, off centre, so wide
    /// that the halves pass each other by in some cells.
    fn cases() -> impl Strategy<Value = (Pair, Grid)> {
        (families(), -1.0..1.0f64, 1u8..32, 0u8..32, prop::array::uniform5((1usize..4, -0.3..0.3f64)))
            .prop_map(|(family, cor, free, sampled, cells)| {
                let member = |set: u8, dof: Dof| set >> dof.index() & 1 == 1;
                let mut alignment = Alignment::default_for(Some(family));
                let own = alignment.free;
                let chosen: crate::pose::DofSet = own.iter().filter(|dof| member(free, *dof)).collect();
                alignment.free = if chosen.is_empty() { own } else { chosen };
                alignment.center_of_rotation = cor;
                let connector = ConnectorSpec::Family(FamilySpec::new(family));
                let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
                let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
                let mut grid = Grid::over(&pair.alignment, |dof| cells[dof.index()].0);
                for axis in &mut grid.axes {
                    let shift = cells[axis.dof.index()].1;
                    (axis.lo, axis.hi) = (1.5 * axis.lo + shift, 1.5 * axis.hi + shift);
                }
                grid.axes.retain(|axis| member(sampled, axis.dof));
                (pair, grid)
            })
    }

    fn whole(backend: &impl Backend, pair: &Pair, grid: &Grid) -> Vec<f32> {
        let mut out = vec![f32::NAN; grid.len()];
        backend.heights(pair, grid, 0..grid.len() / slab(grid), &mut out);
        out
    }

    /// Every cell has the height of its own pose, by the definition.
    fn keeps_to_the_definition(
        backend: &impl Backend,
        pair: &Pair,
        grid: &Grid,
    ) -> Result<(), TestCaseError> {
        for (cell, height) in whole(backend, pair, grid).into_iter().enumerate() {
            let cor = pair.alignment.center_of_rotation;
            let at = |by: f64| {
                let mut pose = CorPose::from_error(&grid.pose(cell), cor, pair.alignment.free);
                pose.lateral += DVec2::splat(by);
                brute::height(pair, &pose)
            };
            // Two methods may place a border differently within the seam; cells so close to a border are
            // skipped.
            let near = [-1e-9, 0.0, 1e-9].map(at);
            match (near, f64::from(height)) {
                // Single precision of a height below 4, and the seam's slope.
                ([Some(a), Some(exact), Some(b)], height)
                    if (a - exact).abs().max((b - exact).abs()) < 1e-6 =>
                {
                    prop_assert!((height - exact).abs() < 1e-6, "cell {cell}: {height} for {exact}");
                }
                ([None, None, None], height) => prop_assert_eq!(height, f64::NEG_INFINITY, "cell {}", cell),
                _ => {}
            }
        }
        Ok(())
    }

    /// Cut anywhere, the ranges are those of the whole, bit for bit.
    fn is_the_same_in_ranges(
        backend: &impl Backend,
        pair: &Pair,
        grid: &Grid,
        cut: usize,
    ) -> Result<(), TestCaseError> {
        let (slab, whole) = (slab(grid), whole(backend, pair, grid));
        let rotations = grid.len() / slab;
        let cut = cut % (rotations + 1);
        let mut out = vec![f32::NAN; grid.len()];
        let (low, high) = out.split_at_mut(cut * slab);
        backend.heights(pair, grid, cut..rotations, high);
        backend.heights(pair, grid, 0..cut, low);
        let bits = |heights: &[f32]| heights.iter().map(|h| h.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&out), bits(&whole));
        for k in 0..rotations {
            let mut one = vec![f32::NAN; slab];
            backend.heights(pair, grid, k..k + 1, &mut one);
            prop_assert_eq!(bits(&one), bits(&whole[k * slab..(k + 1) * slab]));
        }
        Ok(())
    }

    macro_rules! conforms {
        ($name:ident, $backend:expr) => {
            mod $name {
                use super::*;

                proptest! {
                    #![proptest_config(ProptestConfig::with_cases(48))]

                    #[test]
                    fn every_cell_holds_the_height_of_its_own_pose((pair, grid) in cases()) {
                        keeps_to_the_definition(&$backend, &pair, &grid)?;
                    }

                    #[test]
                    fn ranges_are_those_of_the_whole((pair, grid) in cases(), cut in 0usize..1000) {
                        is_the_same_in_ranges(&$backend, &pair, &grid, cut)?;
                    }
                }

                #[test]
                fn halves_that_pass_each_other_by_have_no_height() {
                    let mut alignment = Alignment::default_for(Some(Family::Pyramid));
                    alignment.center_of_rotation = 0.3;
                    let connector = ConnectorSpec::Family(FamilySpec::new(Family::Pyramid));
                    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
                    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
                    let mut grid = Grid::over(&pair.alignment, |_| 2);
                    for axis in grid.axes.iter_mut().filter(|axis| axis.dof == Dof::X) {
                        (axis.lo, axis.hi) = (-8.0, 8.0);
                    }
                    assert!(whole(&$backend, &pair, &grid).iter().all(|h| *h == f32::NEG_INFINITY));
                }
            }
        };
    }

    conforms!(fast, Fast);
    conforms!(judge, Brute);
}
