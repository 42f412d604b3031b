//! Outcomes packed for a page.
//!
//! ```text
//!   cells, the first axis fastest ──▶ chunks of whole leading axes ──▶ each cell ⊕ the cell a row before ──▶ deflate
//! ```
//!
//! A row is a line along the first axis. If outcomes do not change from row to row, the differences are
//! zeros, which deflate removes. Every chunk can be read separately, so that a page unpacks only the chunks
//! that it shows.

use super::{PageError, deflated};
use crate::schema::{AxisReport, axes};
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::diagnostic::Advice;
use catchment_core::exec::Exec;
use catchment_core::merit::MeritError;

/// Most cells of a chunk, unless a row has more.
const CHUNK_CELLS: usize = 1 << 20;

/// Outcomes over two axes, in a single block.
pub(super) struct Plane {
    /// Its axes, the first fastest.
    pub(super) axes: Vec<AxisReport>,
    /// Its outcomes.
    pub(super) packed: Vec<u8>,
}

/// A plane through zero.
pub(super) fn plane(acceptance: &Acceptance, exec: &Exec) -> Result<Plane, PageError> {
    exec.check()?;
    let grid = acceptance.grid().ok_or(MeritError::NotAGrid)?;
    let row = grid.axes.first().map_or(1, |axis| axis.cells);
    let packed = deflated(&by_rows(&acceptance.outcomes, row))?;
    Ok(Plane { axes: axes(acceptance), packed })
}

/// The code of each outcome ⊕ the code a row before.
fn by_rows(outcomes: &[Outcome], row: usize) -> Vec<u8> {
    let code = |k: usize| outcomes[k] as u8;
    (0..outcomes.len()).map(|k| if k < row { code(k) } else { code(k) ^ code(k - row) }).collect()
}

/// A grid of outcomes in chunks.
pub(super) struct Chunks {
    /// Cells of every chunk but the last, which may have fewer.
    pub(super) cells: usize,
    /// Each of them.
    pub(super) packed: Vec<Vec<u8>>,
}

/// All outcomes over a grid. Of listed poses there is no cell to look into.
pub(super) fn packed(acceptance: &Acceptance, exec: &Exec) -> Result<Chunks, PageError> {
    let Some(grid) = acceptance.grid() else {
        return Ok(Chunks { cells: 1, packed: vec![deflated(&[Outcome::Undecided as u8])?] });
    };
    // The bytes before packing and, at worst, after it: incompressible data keep their size.
    let needed = 2 * acceptance.outcomes.len() as u64;
    exec.ensure_fits("the outcomes of a page", needed, |_| vec![Advice::MoreMemory])?;
    let shape = grid.shape();
    let row = shape.first().copied().unwrap_or(1);
    let cells = chunk_cells(&shape);
    let chunks: Vec<&[Outcome]> = acceptance.outcomes.chunks(cells).collect();
    let pack = |k: usize| -> Result<Vec<u8>, PageError> { Ok(deflated(&by_rows(chunks[k], row))?) };
    let packed = exec.try_map(chunks.len(), pack)?;
    Ok(Chunks { cells, packed })
}

/// Whole leading axes, and as many steps of the next axis as fit.
fn chunk_cells(shape: &[usize]) -> usize {
    let mut cells = 1;
    for length in shape {
        if cells * length > CHUNK_CELLS {
            // A row stays whole.
            return if cells == 1 { *length } else { cells * (CHUNK_CELLS / cells) };
        }
        cells *= length;
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::pose::Dof;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    #[test]
    fn chunks_are_of_whole_rows() {
        assert_eq!(chunk_cells(&[30; 5]), 810_000);
        assert_eq!(chunk_cells(&[200, 200]), 40_000);
        assert_eq!(chunk_cells(&[3 << 20]), 3 << 20);
        assert_eq!(chunk_cells(&[100; 4]), 1_000_000);
        assert_eq!(chunk_cells(&[1000, 5000]), 1000 * 1048);
    }

    #[test]
    fn packed_outcomes_unpack_equal() {
        let acceptance = blob(&design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect()), 9);
        let Chunks { cells, packed } = packed(&acceptance, &Exec::new()).unwrap();
        assert_eq!((cells, packed.len()), (729, 1));
        let mut codes = Vec::new();
        ZlibDecoder::new(&packed[0][..]).read_to_end(&mut codes).unwrap();
        for k in 9..codes.len() {
            codes[k] ^= codes[k - 9];
        }
        assert_eq!(codes, acceptance.outcomes.iter().map(|outcome| *outcome as u8).collect::<Vec<_>>());
    }
}
