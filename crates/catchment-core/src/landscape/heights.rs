//! Heights of first contact over the whole error grid.

use super::backend::{Backend, Fast, slab};
use super::{Grid, LandscapePart, Resolution};
use crate::contact::Pair;
use crate::diagnostic::Advice;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::pose::Dof;
use rayon::prelude::*;
use std::ops::Range;

/// The height of first contact at every cell of an error grid.
///
/// The grid is over pose *errors* (offsets of the face centre); the heights are those of the centre of
/// rotation, through which the approach force acts.
#[derive(Debug, Clone, PartialEq)]
pub struct Landscape {
    /// Grid of the heights, sampled at the cells' centres.
    pub grid: Grid,
    /// z of the COR at first contact, in D, for each cell, rounded to single precision; −∞ if the halves pass
    /// each other by.
    pub heights: Vec<f32>,
}

/// Why no landscape was computed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LandscapeError {
    /// A translation is sampled although the design locks it.
    #[error("the grid samples {}, which this design locks; add it to `free`", .dof.name())]
    LockedAxis {
        /// Which.
        dof: Dof,
    },
    /// An axis has no cell, or the number of cells overflows.
    #[error("a grid of {shape:?} cells cannot be used")]
    Unusable {
        /// Cells per axis.
        shape: Vec<usize>,
    },
    /// At some rotation more pairs of features carry the moving half than can be numbered.
    #[error(
        "more than {most} features touch at one rotation; use coarser halves, a coarser grid, or descent, which follows single poses"
    )]
    TooManyPatches {
        /// How many can be numbered.
        most: usize,
    },
    /// A part beyond the grid.
    #[error("there are no rotations {} to {} in a grid of {of}", .range.start, .range.end)]
    NoSuchRotations {
        /// The requested rotations.
        range: Range<usize>,
        /// How many there are.
        of: usize,
    },
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Landscape {
    /// Bytes that the heights of a grid of `cells` cells take.
    pub const fn bytes(cells: u64) -> u64 {
        cells.saturating_mul(size_of::<f32>() as u64)
    }

    /// How many rotations a grid has.
    pub fn rotations(grid: &Grid) -> usize {
        grid.axes.iter().filter(|a| a.dof.is_rotation()).map(|a| a.cells).product()
    }

    /// Heights of `pair` over `grid`, one rotation at a time, in parallel.
    ///
    /// An error without an axis is 0; a translation that the design locks stays at the COR.
    ///
    /// # Errors
    /// If the grid samples a locked translation or has no cell, does not fit into the memory budget, or the
    /// computation is cancelled.
    pub fn compute(pair: &Pair, grid: &Grid, exec: &Exec) -> Result<Self, LandscapeError> {
        Self::compute_by(&Fast, pair, grid, exec)
    }

    /// The same by any backend.
    ///
    /// # Errors
    /// As [`Landscape::compute`].
    pub fn compute_by(
        backend: &impl Backend,
        pair: &Pair,
        grid: &Grid,
        exec: &Exec,
    ) -> Result<Self, LandscapeError> {
        usable(pair, grid)?;
        let heights = heights(backend, pair, grid, 0..Self::rotations(grid), exec)?;
        Ok(Self { grid: grid.clone(), heights })
    }

    /// The heights of some of the grid's rotations: those of the whole, bit for bit. [`Landscape::merge`] puts parts
    /// together.
    ///
    /// # Errors
    /// As [`Landscape::compute`], and when the grid has no such rotations.
    pub fn part(
        pair: &Pair,
        grid: &Grid,
        rotations: Range<usize>,
        exec: &Exec,
    ) -> Result<LandscapePart, LandscapeError> {
        usable(pair, grid)?;
        within(&rotations, Self::rotations(grid))?;
        let heights = heights(&Fast, pair, grid, rotations.clone(), exec)?;
        Ok(LandscapePart { grid: grid.clone(), rotations, heights })
    }
}

/// Heights over rotations of a usable grid.
fn heights(
    backend: &impl Backend,
    pair: &Pair,
    grid: &Grid,
    rotations: Range<usize>,
    exec: &Exec,
) -> Result<Vec<f32>, LandscapeError> {
    let cells = rotations.len() * slab(grid);
    let buffers = (exec.threads() * slab(grid) * size_of::<f64>()) as u64;
    let needed = Landscape::bytes(cells as u64).saturating_add(buffers);
    exec.ensure_fits("the height landscape", needed, |budget| {
        let largest = Resolution::largest_that_fits(budget, size_of::<f32>() as u64, grid.axes.len());
        vec![Advice::AtMostResolution(largest)]
    })?;
    let mut heights = vec![0.0f32; cells];
    fill(backend, pair, grid, rotations, &mut heights, exec)?;
    Ok(heights)
}

/// Whether there are such rotations.
pub(super) fn within(range: &Range<usize>, of: usize) -> Result<(), LandscapeError> {
    if range.start <= range.end && range.end <= of {
        Ok(())
    } else {
        Err(LandscapeError::NoSuchRotations { range: range.clone(), of })
    }
}

/// The number of cells, if the grid suits the pair.
pub(super) fn usable(pair: &Pair, grid: &Grid) -> Result<usize, LandscapeError> {
    for axis in &grid.axes {
        if !axis.dof.is_rotation() && !pair.alignment.free.contains(axis.dof) {
            return Err(LandscapeError::LockedAxis { dof: axis.dof });
        }
    }
    grid.checked_len()
        .filter(|cells| *cells > 0)
        .ok_or_else(|| LandscapeError::Unusable { shape: grid.shape() })
}

/// Number of consecutive rotations per thread: enough to reuse prepared data, few enough to share the work
/// evenly.
const AT_ONCE: usize = 8;

/// Fills the slabs of lateral positions of a range of rotations. Slabs do not depend on each other, so neither does any
/// height on the number of threads.
fn fill(
    backend: &impl Backend,
    pair: &Pair,
    grid: &Grid,
    rotations: Range<usize>,
    heights: &mut [f32],
    exec: &Exec,
) -> Result<(), Cancelled> {
    let slab = slab(grid);
    let count = rotations.len();
    let at_once = (count / (4 * exec.threads())).clamp(1, AT_ONCE);
    let tally = exec.tally(count, "heights");
    exec.install(|| {
        heights.par_chunks_mut(slab * at_once).enumerate().try_for_each(|(k, out)| {
            exec.check()?;
            let first = rotations.start + k * at_once;
            let here = out.len() / slab;
            backend.heights(pair, grid, first..first + here, out);
            tally.add(here);
            Ok(())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::{Connector, Half, Surface};
    use crate::design::Alignment;
    use crate::pose::{CorPose, DofSet, Mount};
    use glam::DVec3;

    /// A square-based pyramid, apex up, 1 wide and 0.5 high, as fixed half and, turned over, as moving half.
    fn two_pyramids(free: &[Dof], cor: f64) -> Pair {
        let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
        let mut vertices: Vec<DVec3> = corners.iter().map(|&(x, y)| DVec3::new(x, y, -0.25)).collect();
        vertices.push(DVec3::new(0.0, 0.0, 0.25));
        let facets = [vec![3, 2, 1, 0], vec![0, 1, 4], vec![1, 2, 4], vec![2, 3, 4], vec![3, 0, 4]];
        let fixed = Half::of(vec![Surface::from_polygons(vertices, &facets).unwrap()]);
        let moving = fixed.mapped(|p| Mount::X.apply(p));
        let mut alignment = Alignment::new(free.iter().copied().collect(), Mount::X);
        alignment.center_of_rotation = cor;
        Pair::new(&Connector::from_halves(fixed, moving), &alignment)
    }

    #[test]
    fn every_cell_holds_the_height_of_its_own_pose() {
        let cases: [&[Dof]; 4] =
            [&[Dof::X, Dof::Pitch], &[Dof::Y, Dof::Roll, Dof::Yaw], &Dof::ALL, &[Dof::Pitch]];
        for free in cases {
            let pair = two_pyramids(free, 0.4);
            let grid = Grid::over(&pair.alignment, |dof| 3 + dof.index() % 2);
            let landscape = Landscape::compute(&pair, &grid, &Exec::new()).unwrap();
            let mut contacts = 0;
            for (index, height) in landscape.heights.iter().enumerate() {
                let pose = CorPose::from_error(&grid.pose(index), 0.4, pair.alignment.free);
                match pair.height(&pose) {
                    // Single precision of a height below 2.
                    Some(exact) => assert!((f64::from(*height) - exact).abs() < 2e-7),
                    None => assert_eq!(*height, f32::NEG_INFINITY),
                }
                contacts += usize::from(height.is_finite());
            }
            assert!(contacts > 0);
        }
    }

    #[test]
    fn no_contact_is_minus_infinity() {
        let pair = two_pyramids(&[Dof::X], 0.0);
        let mut grid = Grid::over(&pair.alignment, |_| 4);
        grid.axes[0].hi = 3.0; // centres at −0.5, 0.5, 1.5, 2.5; the halves meet below 1.
        let heights = Landscape::compute(&pair, &grid, &Exec::new()).unwrap().heights;
        // Both slopes are 1: half a width apart, the tips are level with each other as they pass.
        assert_eq!(heights, [0.0, 0.0, f32::NEG_INFINITY, f32::NEG_INFINITY]);
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let pair = two_pyramids(&Dof::ALL, -0.3);
        let grid = Grid::over(&pair.alignment, |_| 3);
        let with =
            |threads| Landscape::compute(&pair, &grid, &Exec::new().with_threads(threads).unwrap()).unwrap();
        assert_eq!(with(1), with(3));
    }

    #[test]
    fn oversized_grids_are_refused_before_allocation() {
        let pair = two_pyramids(&Dof::ALL, 0.0);
        let grid = Grid::over(&pair.alignment, |_| 1000);
        let exec = Exec::new().with_memory_budget(1 << 20);
        let error = Landscape::compute(&pair, &grid, &exec).unwrap_err();
        // 12⁵ × 4 B = 995 328 B fit into 1 MiB.
        assert!(error.to_string().ends_with("at most 12 cells per axis fit"), "{error}");
        let grid = Grid::over(&pair.alignment, |_| 1_000_000);
        assert!(matches!(Landscape::compute(&pair, &grid, &exec), Err(LandscapeError::Unusable { .. })));
    }

    #[test]
    fn a_stop_is_obeyed_and_a_locked_axis_refused() {
        let pair = two_pyramids(&[Dof::X], 0.0);
        let exec = Exec::new();
        let grid = Grid::over(&Alignment::new(DofSet::ALL, Mount::X), |_| 2);
        assert_eq!(Landscape::compute(&pair, &grid, &exec), Err(LandscapeError::LockedAxis { dof: Dof::Y }));
        exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
        let grid = Grid::over(&pair.alignment, |_| 2);
        assert_eq!(Landscape::compute(&pair, &grid, &exec), Err(LandscapeError::Cancelled(Cancelled)));
    }
}
