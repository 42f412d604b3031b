//! Rotations of a grid that are mirror images of each other: only one of each set is computed.
//!
//! ```text
//!      pitch ▲
//!       image│representative       (roll, pitch, yaw)  ↔  (roll, −pitch, −yaw)   by x → −x
//!     ───────┼───────▶ roll                            ↔  (−roll, pitch, −yaw)   by y → −y
//!       image│image                                    ↔  (−roll, −pitch, yaw)   by both
//! ```

use super::{Grid, GridAxis};
use crate::contact::Mirror;
use crate::pose::Dof;

/// The lateral axes and the rotations of a grid, folded by the mirror symmetries of a pair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fold {
    /// Cells per lateral axis, x and y; 1 for an axis that is not sampled.
    lateral: [usize; 2],
    /// Per rotation, in grid order: number of its representative, twice a bit above: whether x and y are reflected.
    images: Vec<u32>,
    /// Per representative: its rotation, in grid order.
    representatives: Vec<u32>,
}

/// Storage of the cells of a rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Image {
    /// Number of the representative.
    pub representative: usize,
    /// The reflection that leads there.
    pub mirror: Mirror,
}

impl Fold {
    /// Folds `grid` by those of `mirrors` that map it onto itself. `None` when there are too many rotations to
    /// number, 2³⁰.
    pub fn new(grid: &Grid, mirrors: &[Mirror]) -> Option<Self> {
        let rotations: Vec<&GridAxis> = grid.axes.iter().filter(|a| a.dof.is_rotation()).collect();
        let count = rotations.iter().try_fold(1usize, |n, a| n.checked_mul(a.cells))?;
        if count >= 1 << 30 {
            return None;
        }
        let keeps = |m: &&Mirror| {
            grid.axes.iter().all(|a| !m.flips(a.dof) || (a.lo + a.hi).abs() <= 1e-9 * (a.hi - a.lo))
        };
        let mirrors: Vec<Mirror> = mirrors.iter().filter(keeps).copied().collect();
        let mut images = vec![u32::MAX; count];
        let mut representatives = Vec::new();
        for rotation in 0..count {
            if images[rotation] != u32::MAX {
                continue;
            }
            let number = representatives.len() as u32;
            representatives.push(rotation as u32);
            images[rotation] = number << 2;
            for mirror in &mirrors {
                let image = &mut images[reflected(&rotations, rotation, *mirror)];
                if *image == u32::MAX {
                    *image = number << 2 | u32::from(mirror.y) << 1 | u32::from(mirror.x);
                }
            }
        }
        let cells = |dof| grid.axis(dof).map_or(1, |a| a.cells);
        Some(Self { lateral: [cells(Dof::X), cells(Dof::Y)], images, representatives })
    }

    /// How many rotations are kept.
    pub fn representatives(&self) -> usize {
        self.representatives.len()
    }

    /// How many rotations there are.
    pub fn rotations(&self) -> usize {
        self.images.len()
    }

    /// The rotation, in grid order, that a representative stands for.
    pub fn rotation(&self, representative: usize) -> usize {
        self.representatives[representative] as usize
    }

    /// Cells per rotation.
    pub fn slab(&self) -> usize {
        self.lateral[0] * self.lateral[1]
    }

    /// Storage of a rotation.
    pub fn image(&self, rotation: usize) -> Image {
        let image = self.images[rotation];
        let mirror = Mirror { x: image & 1 != 0, y: image & 2 != 0 };
        Image { representative: (image >> 2) as usize, mirror }
    }

    /// Index, among the kept cells, of the cell at lateral numbers `x` and `y` of a rotation.
    pub fn kept(&self, rotation: usize, x: usize, y: usize) -> usize {
        let Image { representative, mirror } = self.image(rotation);
        let [nx, ny] = self.lateral;
        let x = if mirror.x { nx - 1 - x } else { x };
        let y = if mirror.y { ny - 1 - y } else { y };
        representative * self.slab() + y * nx + x
    }

    /// The kept index of a cell of the grid.
    pub fn kept_cell(&self, cell: usize) -> usize {
        let lateral = cell % self.slab();
        self.kept(cell / self.slab(), lateral % self.lateral[0], lateral / self.lateral[0])
    }

    /// How many cells are kept.
    pub fn kept_cells(&self) -> usize {
        self.representatives() * self.slab()
    }
}

/// The mirror image of a rotation, both in grid order.
fn reflected(axes: &[&GridAxis], mut rotation: usize, mirror: Mirror) -> usize {
    let mut stride = 1;
    let mut image = 0;
    for axis in axes {
        let k = rotation % axis.cells;
        rotation /= axis.cells;
        image += stride * if mirror.flips(axis.dof) { axis.cells - 1 - k } else { k };
        stride *= axis.cells;
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Alignment;
    use crate::pose::{DofSet, Mount};

    fn grid(cells: impl FnMut(Dof) -> usize) -> Grid {
        Grid::over(&Alignment::new(DofSet::ALL, Mount::X), cells)
    }

    #[test]
    fn every_cell_is_kept_once_at_the_pose_of_its_image() {
        let grid = grid(|dof| [3, 4, 5, 4, 3][dof.index()]);
        for mirrors in [&[][..], &[Mirror::ALL[2]], &Mirror::ALL] {
            let fold = Fold::new(&grid, mirrors).unwrap();
            // A group of 1 + mirrors; rotations that are their own image stay whole.
            assert!(fold.representatives() * (1 + mirrors.len()) >= fold.rotations());
            let mut seen = vec![0; fold.kept_cells()];
            for cell in 0..grid.len() {
                let kept = fold.kept_cell(cell);
                seen[kept] += 1;
                let slab = fold.slab();
                let original = fold.rotation(kept / slab) * slab + kept % slab;
                let mirror = fold.image(cell / slab).mirror;
                let (a, b) = (grid.pose(cell).to_array(), grid.pose(original).to_array());
                for dof in Dof::ALL {
                    let sign = if mirror.flips(dof) { -1.0 } else { 1.0 };
                    assert!((a[dof.index()] - sign * b[dof.index()]).abs() < 1e-12);
                }
            }
            assert!(seen.iter().all(|n| *n >= 1));
        }
        assert_eq!(Fold::new(&self::grid(|_| 4), &Mirror::ALL).unwrap().representatives(), 16);
    }

    #[test]
    fn a_grid_that_is_not_symmetric_is_not_folded() {
        let mut grid = grid(|_| 4);
        grid.axes[3].hi = 2.0; // pitch: only y → −y leaves it alone
        let fold = Fold::new(&grid, &Mirror::ALL).unwrap();
        assert_eq!(fold.representatives(), 32);
    }
}
