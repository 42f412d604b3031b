//! Leaves with common faces: stored for every leaf, and recomputed only around leaves that were divided.

use super::{Cell, Parts, Tree, WHOLE};
use crate::exec::{Cancelled, Exec};
use crate::method::certified::interval::Interval;
use crate::method::certified::placed::PoseBox;

/// A leaf that shares a face with another.
#[derive(Debug, Clone, Copy)]
pub(in crate::method::certified) struct Face {
    number: u32,
    axis: u8,
    /// Whether it lies above along that axis.
    pub(in crate::method::certified) above: bool,
}

impl Face {
    /// The leaf on the other side.
    pub(in crate::method::certified) const fn number(self) -> usize {
        self.number as usize
    }

    /// The axis that the face lies across.
    pub(in crate::method::certified) const fn axis(self) -> usize {
        self.axis as usize
    }
}

impl Tree {
    /// Joins the faces of leaves with those of new parts, in both directions.
    ///
    /// # Errors
    /// [`Cancelled`] if a stop is requested.
    pub(in crate::method::certified) fn join(
        &mut self,
        split: &[usize],
        exec: &Exec,
    ) -> Result<(), Cancelled> {
        let mut touched: Vec<usize> = Vec::new();
        for number in split {
            let cell = &mut self.cells[*number];
            touched.extend(std::mem::take(&mut cell.faces).iter().map(|face| face.number()));
            if let Some(Parts { first, count }) = cell.parts {
                touched.extend((first..first + count).map(|part| part as usize));
            }
        }
        touched.retain(|number| !self.cells[*number].is_split());
        touched.sort_unstable();
        touched.dedup();
        let beside = |k: usize| {
            let mut faces = Vec::new();
            self.beside(&self.cells[touched[k]], |number, axis, above| {
                faces.push(Face { number: number as u32, axis: axis as u8, above });
            });
            faces.into_boxed_slice()
        };
        let faces: Vec<Box<[Face]>> = exec.map(touched.len(), beside)?;
        for (number, faces) in touched.into_iter().zip(faces) {
            self.cells[number].faces = faces;
        }
        Ok(())
    }

    /// Visits every leaf that shares a face with a leaf, with the axis along which it lies and whether it lies above.
    fn beside(&self, cell: &Cell, mut visit: impl FnMut(usize, usize, bool)) {
        let own = self.span(cell);
        for dof in &self.axes {
            let k = dof.index();
            let [a, b] = own[k];
            let below = if a > 0 { Some(a - 1) } else { self.closed[k].then_some(WHOLE - 1) };
            let above = if b < WHOLE { Some(b) } else { self.closed[k].then_some(0) };
            for (place, is_above) in [(below, false), (above, true)] {
                let Some(place) = place else { continue };
                let mut face = own;
                face[k] = [place, place + 1];
                self.visit(&face, |number, _| {
                    visit(number, k, is_above);
                    true
                });
            }
        }
    }

    /// The face that a leaf shares with another, as it has it.
    pub(in crate::method::certified) fn shared(&self, cell: &Cell, other: &Cell, face: Face) -> PoseBox {
        let (own, its) = (cell.poses, other.poses);
        let mut shared = own;
        for dof in &self.axes {
            let k = dof.index();
            shared[k] = if k == face.axis() {
                Interval::thin(if face.above { own[k].up } else { own[k].lo })
            } else {
                Interval::new(own[k].lo.max(its[k].lo), own[k].up.min(its[k].up))
            };
        }
        shared
    }

    /// Whether a leaf has a face at the closure of its periodic axis.
    pub(in crate::method::certified) fn closes(&self, cell: &Cell, face: Face) -> bool {
        let [a, b] = self.span(cell)[face.axis()];
        if face.above { b == WHOLE } else { a == 0 }
    }
}
