//! Every cell of a view as VTK's `ImageData`.
//!
//! | array | of every cell |
//! |---|---|
//! | `outcome` | 1 aligned, 2 jammed, 3 missed, 4 undecided |
//! | `accepted` | 1 or 0 |
//! | `share` | accepted share of the cells along the axes that are not shown, 0 to 1; `accepted` if all are shown |
//! | `height` | z of the centre of rotation at first contact, in D; NaN without contact; if it is known |

use super::xml::File;
use super::{View, ViewError};
use catchment_core::acceptance::Outcome;
use catchment_core::diagnostic::Advice;
use catchment_core::exec::Exec;

/// Bytes of a cell in the file: two codes and two numbers; and a count while the shares are made.
const CELL_BYTES: u64 = 1 + 1 + 4 + 4 + 8;

/// A view as a `.vti` file.
///
/// # Errors
/// It does not fit into memory, or the computation is cancelled.
pub fn image(view: &View, exec: &Exec) -> Result<Vec<u8>, ViewError> {
    let needed = CELL_BYTES.saturating_mul(view.len() as u64);
    exec.ensure_fits("an image of the set", needed, |_| vec![Advice::MoreMemory])?;
    let shape = view.shape();
    let (origin, spacing) = view.lattice();
    let extent = shape.map(|cells| format!("0 {cells}")).join(" ");
    let triple = |v: [f64; 3]| v.map(|v| format!("{v:?}")).join(" ");
    let mut file = File::new("ImageData", &view.heading());
    file.tag(&format!(
        "<ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\">\n<Piece Extent=\"{extent}\">\n<CellData Scalars=\"outcome\">",
        triple(origin),
        triple(spacing)
    ));
    let aligned = |cell: usize| view.outcomes[cell] == Outcome::Aligned;
    file.array("outcome", view.cells().map(|cell| [view.outcomes[cell] as u8]));
    file.array("accepted", view.cells().map(|cell| [u8::from(aligned(cell))]));
    exec.check()?;
    let counts = counts(view, exec)?;
    let of = view.grid.len() as f64 / view.len() as f64;
    file.array("share", counts.into_iter().map(|count| [(f64::from(count) / of) as f32]));
    if let Some(heights) = view.heights {
        let finite = |height: f32| if height.is_finite() { height } else { f32::NAN };
        file.array("height", view.cells().map(|cell| [finite(heights[cell])]));
    }
    file.tag("</CellData>\n</Piece>");
    Ok(file.finish())
}

/// How many cells of the grid are accepted over every cell that is shown.
fn counts(view: &View, exec: &Exec) -> Result<Vec<u32>, ViewError> {
    /// Cells between two checks for cancellation.
    const AT_ONCE: usize = 1 << 20;
    // The step of the number of the shown cell per step along each axis of the grid.
    let mut strides = vec![0; view.grid.axes.len()];
    let mut stride = 1;
    for axis in &view.shown {
        strides[*axis] = stride;
        stride *= view.grid.axes[*axis].cells;
    }
    let mut counts = vec![0; view.len()];
    let (mut place, mut number) = (vec![0; strides.len()], 0);
    for (k, outcome) in view.outcomes.iter().enumerate() {
        if k % AT_ONCE == 0 {
            exec.check()?;
        }
        counts[number] += u32::from(*outcome == Outcome::Aligned);
        for (axis, cell) in place.iter_mut().enumerate() {
            *cell += 1;
            number += strides[axis];
            if *cell < view.grid.axes[axis].cells {
                break;
            }
            number -= strides[axis] * *cell;
            *cell = 0;
        }
    }
    Ok(counts)
}
