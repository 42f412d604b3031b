//! The border of the accepted set as VTK's `PolyData`: the faces between accepted and other cells.
//!
//! ```text
//!   three axes   a closed surface, outward; its volume is that of the accepted cells
//!   two axes     the accepted cells themselves, as squares; their area is that of the accepted cells
//! ```
//!
//! | array | of every face |
//! |---|---|
//! | `beyond` | three axes: outcome of the cell outside, 2 jammed, 3 missed, 4 undecided; 0 at the border of the error box |
//! | `height` | two axes: z of the centre of rotation at first contact, in D, if it is known |

use super::xml::File;
use super::{View, ViewError};
use catchment_core::acceptance::Outcome;
use catchment_core::diagnostic::Advice;
use catchment_core::exec::Exec;

/// The corners of the face towards −x, −y, −z and +x, +y, +z of a cell, counter-clockwise seen from outside.
const FACES: [[[usize; 3]; 4]; 6] = [
    [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]],
    [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
    [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
    [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
    [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]],
    [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
];

/// Bytes of a face: its corners' numbers, its end, its code, and about one corner of three numbers.
const FACE_BYTES: u64 = 4 * 8 + 8 + 1 + 3 * 8;

/// The border of a view as a `.vtp` file.
///
/// # Errors
/// The view has a single axis; it does not fit into memory, or the computation is cancelled.
pub fn border(view: &View, exec: &Exec) -> Result<Vec<u8>, ViewError> {
    if view.shown.len() < 2 {
        return Err(ViewError::OneAxis);
    }
    let [nx, ny, nz] = view.shape();
    // The numbers of all corners, and the faces: at most two per cell, if no cell has an accepted neighbour.
    let needed = (4 * ((nx + 1) * (ny + 1) * (nz + 1)) as u64).saturating_add(FACE_BYTES * view.len() as u64);
    exec.ensure_fits("the border of the set", needed, |_| vec![Advice::MoreMemory])?;
    let mut surface = Surface::over(view);
    for k in 0..nz {
        exec.check()?;
        for j in 0..ny {
            for i in 0..nx {
                surface.add([i, j, k]);
            }
        }
    }
    Ok(surface.file())
}

struct Surface<'a> {
    view: &'a View<'a>,
    /// The number of the point at every corner of a cell, if it is used.
    numbers: Vec<Option<std::num::NonZeroU32>>,
    points: Vec<[f64; 3]>,
    corners: Vec<[usize; 4]>,
    beyond: Vec<u8>,
    heights: Vec<f32>,
}

impl<'a> Surface<'a> {
    fn over(view: &'a View<'a>) -> Self {
        let corners = view.shape().iter().map(|cells| cells + 1).product();
        let (points, faces) = (Vec::new(), Vec::new());
        Self {
            view,
            numbers: vec![None; corners],
            points,
            corners: faces,
            beyond: Vec::new(),
            heights: Vec::new(),
        }
    }

    /// Adds the faces of a cell, if it is accepted.
    fn add(&mut self, cell: [usize; 3]) {
        let here = self.view.index(cell);
        if self.view.outcomes[here] != Outcome::Aligned {
            return;
        }
        if self.view.shown.len() == 2 {
            // The face that looks up, on the floor.
            self.face(cell, FACES[5].map(|[i, j, _]| [i, j, 0]));
            self.heights.extend(self.view.heights.map(|heights| heights[here]));
            return;
        }
        let shape = self.view.shape();
        for (number, face) in FACES.into_iter().enumerate() {
            let (axis, up) = (number % 3, number >= 3);
            let mut next = cell;
            let inside = if up { cell[axis] + 1 < shape[axis] } else { cell[axis] > 0 };
            let beyond = if inside {
                next[axis] = if up { cell[axis] + 1 } else { cell[axis] - 1 };
                self.view.outcomes[self.view.index(next)] as u8
            } else {
                0
            };
            if beyond != Outcome::Aligned as u8 {
                self.face(cell, face);
                self.beyond.push(beyond);
            }
        }
    }

    fn face(&mut self, cell: [usize; 3], corners: [[usize; 3]; 4]) {
        let corners = corners.map(|corner| self.point(std::array::from_fn(|k| cell[k] + corner[k])));
        self.corners.push(corners);
    }

    /// The number of the point at a corner of the lattice.
    fn point(&mut self, corner: [usize; 3]) -> usize {
        let [nx, ny, _] = self.view.shape();
        let place = corner[0] + (nx + 1) * (corner[1] + (ny + 1) * corner[2]);
        if let Some(number) = self.numbers[place] {
            return number.get() as usize - 1;
        }
        let (origin, spacing) = self.view.lattice();
        self.points.push(std::array::from_fn(|k| origin[k] + corner[k] as f64 * spacing[k]));
        let count = self.points.len();
        // A grid that fits into memory has fewer corners than a 32-bit number can count.
        self.numbers[place] = u32::try_from(count).ok().and_then(std::num::NonZeroU32::new);
        count - 1
    }

    fn file(self) -> Vec<u8> {
        let mut file = File::new("PolyData", &self.view.heading());
        file.tag(&format!(
            "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
             NumberOfPolys=\"{}\">\n<CellData>",
            self.points.len(),
            self.corners.len()
        ));
        if self.view.shown.len() == 3 {
            file.array("beyond", self.beyond.iter().map(|code| [*code]));
        } else if self.view.heights.is_some() {
            file.array("height", self.heights.iter().map(|height| [*height]));
        }
        file.tag("</CellData>\n<Points>");
        file.array("places", self.points);
        file.tag("</Points>\n<Polys>");
        let faces = self.corners.len();
        file.array("connectivity", self.corners.into_iter().flatten().map(|corner| [corner]));
        file.array("offsets", (1..=faces).map(|face| [4 * face]));
        file.tag("</Polys>\n</Piece>");
        file.finish()
    }
}
