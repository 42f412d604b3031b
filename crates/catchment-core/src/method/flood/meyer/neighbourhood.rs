//! The full neighbourhood of a cell, 3ⁿ − 1 cells, in a grid of any number of axes.

/// A step to a neighbour.
#[derive(Debug, Clone)]
struct Step {
    /// Added to the index of the cell.
    delta: isize,
    /// Borders that forbid the step: bit 2a for the lower border of axis a, bit 2a + 1 for the upper border.
    forbidden_at: u32,
    /// Length of the step in cells.
    length: f64,
}

/// The neighbours of every cell of a grid; the first axis runs fastest. It takes 3ⁿ steps of memory, whatever the
/// number of cells.
#[derive(Debug, Clone)]
pub(in super::super) struct Neighbourhood {
    shape: Vec<usize>,
    steps: Vec<Step>,
}

/// Cells of a grid; `None` if that overflows.
pub(super) fn cells(shape: &[usize]) -> Option<usize> {
    shape.iter().try_fold(1usize, |product, cells| product.checked_mul(*cells))
}

impl Neighbourhood {
    /// Largest number of axes of a grid: two bits each store the borders on which a cell lies.
    pub(super) const MOST_AXES: usize = 16;

    /// For a grid of this shape, which has at most [`Self::MOST_AXES`] axes.
    pub(in super::super) fn new(shape: &[usize]) -> Self {
        let mut steps = vec![Step { delta: 0, forbidden_at: 0, length: 0.0 }];
        let mut stride = 1isize;
        for (axis, cells) in shape.iter().enumerate() {
            let low = 1u32 << (2 * axis);
            let moves = [(-stride, low, 1.0), (0, 0, 0.0), (stride, low << 1, 1.0)];
            steps = moves
                .iter()
                .flat_map(|&(delta, border, square)| {
                    steps.iter().map(move |s| Step {
                        delta: s.delta + delta,
                        forbidden_at: s.forbidden_at | border,
                        length: s.length + square,
                    })
                })
                .collect();
            stride *= cells.cast_signed();
        }
        steps.retain(|s| s.length > 0.0);
        for step in &mut steps {
            step.length = step.length.sqrt();
        }
        Self { shape: shape.to_vec(), steps }
    }

    /// The borders on which a cell lies, a bit each.
    fn borders(&self, mut index: usize) -> u32 {
        let mut borders = 0;
        for (axis, cells) in self.shape.iter().enumerate() {
            let k = index % cells;
            index /= cells;
            borders |= u32::from(k == 0) << (2 * axis) | u32::from(k + 1 == *cells) << (2 * axis + 1);
        }
        borders
    }

    /// Neighbours of a cell, in ascending order of their offset along the last axis, then the axis before, ….
    pub(in super::super) fn of(&self, index: usize) -> impl Iterator<Item = usize> + '_ {
        self.with_length(index).map(|(neighbour, _)| neighbour)
    }

    /// Neighbours and their distance in cells, in the same order.
    pub(in super::super) fn with_length(&self, index: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let borders = self.borders(index);
        self.steps
            .iter()
            .filter(move |s| s.forbidden_at & borders == 0)
            .map(move |s| (index.wrapping_add_signed(s.delta), s.length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_all_cells_one_step_away_on_every_axis() {
        for shape in [vec![5], vec![3, 4], vec![1, 4], vec![3, 2, 4], vec![2, 3, 2, 3], vec![2, 1, 3, 2, 2]] {
            let cells: usize = shape.iter().product();
            let place = |mut i: usize| -> Vec<isize> {
                shape
                    .iter()
                    .map(|n| {
                        let k = i % n;
                        i /= n;
                        k.cast_signed()
                    })
                    .collect()
            };
            let neighbourhood = Neighbourhood::new(&shape);
            for a in 0..cells {
                let expected: Vec<(usize, f64)> = (0..cells)
                    .filter_map(|b| {
                        let squares =
                            place(a).iter().zip(place(b)).map(|(p, q)| (p - q).pow(2)).collect::<Vec<_>>();
                        let near = a != b && squares.iter().all(|s| *s <= 1);
                        near.then(|| (b, (squares.iter().sum::<isize>() as f64).sqrt()))
                    })
                    .collect();
                assert_eq!(neighbourhood.with_length(a).collect::<Vec<_>>(), expected);
            }
        }
    }
}
