//! Links of a cell's arrival fraction: the corners of the simplex into which its exact direction of descent
//! points.
//!
//! ```text
//!   ·──────·──────·      Freudenthal's (Kuhn's) simplices: with the axes in the order of |v|, the corners are
//!   │      │    ╱ │      c + e₁, c + e₁ + e₂, …; the point at which the ray from c leaves the cube of its
//!   ·──────c──╱───·      neighbours is their mean with weights (|v₁| − |v₂|, |v₂| − |v₃|, …, |vₙ|) / |v₁|
//!   │      │      │
//!   ·──────·──────·      (Freudenthal 1942; Kuhn 1960)
//! ```
//!
//! A corner that is not lower than c lies across a valley: from there motion comes back. It is replaced by
//! the corners to which *it* leads, [`CROSSINGS`] times; a return to c itself is removed, which solves the
//! cycle exactly; corners that are still not lower are then removed too. So every link leads downwards and
//! the links of all cells are ordered. A cell that keeps less than [`LEAST`] of its weight has no direction
//! that the grid can resolve: it is an *end*, decided by exact motion.

use crate::contact::Mirror;
use crate::landscape::{GradientField, Grid, Patch};

/// Number of times that a corner across a valley is replaced by its own links.
pub(super) const CROSSINGS: usize = 2;
/// Corners with less weight are not followed across valleys.
pub(super) const NEGLIGIBLE: f32 = 0.05;
/// Smallest share of its weight that a cell must keep: below it, the kept share is discretisation, not
/// descent. Between 0.05 and 0.2 results hardly change; without it shallow jams leak (V-Face, 2 %).
pub(super) const LEAST: f32 = 0.1;

/// A share of a cell's arrival.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    /// A stored cell, lower than the cell from which the link starts.
    pub(super) to: u32,
    /// Its weight; those of a cell, with the share that loses contact, sum to 1.
    pub(super) weight: f32,
}

/// Continuation of the motion from a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum CellFlow {
    /// To the links that were written; the rest of the weight loses contact.
    Down,
    /// Out of the box, along the axis with this number.
    Leaves(usize),
    /// The grid cannot decide.
    End,
}

/// A cell by its numbers along the axes: of the representative rotation it is kept at.
#[derive(Debug, Clone, Copy)]
struct CellIndex {
    /// Kept index.
    cell: u32,
    /// Number along every axis of the grid.
    at: [u32; 5],
    /// The rotation, in grid order.
    rotation: u32,
}

/// The links of a gradient field whose patches hold velocities in cells.
pub(super) struct Links<'a> {
    field: &'a GradientField,
    /// Number of axes.
    axes: usize,
    /// Number of lateral axes; they are the first.
    lateral: usize,
    /// Positions of x and y among the axes; `axes` if not sampled.
    x: usize,
    y: usize,
    cells: [u32; 5],
    /// Per axis: of the rotation number; 0 for lateral axes.
    strides: [u32; 5],
}

/// A corner of a simplex.
#[derive(Debug, Clone, Copy)]
struct Corner {
    place: CellIndex,
    /// The reflection between its storage and its position, relative to the cell from which the links start.
    mirror: Mirror,
    weight: f32,
}

/// Corners to be followed: those of a cell, and across valleys those of its corners.
#[derive(Default)]
pub(super) struct Scratch {
    front: Vec<Corner>,
    next: Vec<Corner>,
}

impl<'a> Links<'a> {
    pub(super) fn new(field: &'a GradientField) -> Self {
        let grid: &Grid = &field.grid;
        let axes = grid.axes.len();
        let lateral = grid.axes.iter().filter(|a| !a.dof.is_rotation()).count();
        let number = |dof| grid.axes.iter().position(|a| a.dof == dof).unwrap_or(axes);
        let mut cells = [1; 5];
        let mut strides = [0; 5];
        let mut stride = 1;
        for (k, axis) in grid.axes.iter().enumerate() {
            cells[k] = axis.cells as u32;
            if axis.dof.is_rotation() {
                strides[k] = stride;
                stride *= axis.cells as u32;
            }
        }
        let (x, y) = (number(crate::pose::Dof::X), number(crate::pose::Dof::Y));
        Self { field, axes, lateral, x, y, cells, strides }
    }

    /// Appends the links of a stored cell to `out`, and returns the continuation of the motion.
    pub(super) fn of(&self, cell: u32, scratch: &mut Scratch, out: &mut Vec<Link>) -> CellFlow {
        let start = out.len();
        let place = self.place(cell);
        let height = self.field.energies[cell as usize];
        let Scratch { front, next } = scratch;
        front.clear();
        front.push(Corner { place, mirror: Mirror { x: false, y: false }, weight: 1.0 });
        let (mut kept, mut lost, mut left) = (0.0f32, 0.0f32, None);
        for crossing in 0..=CROSSINGS {
            next.clear();
            for from in &*front {
                if from.weight < NEGLIGIBLE {
                    continue;
                }
                let leaves = self.corners(from, |corner| {
                    let to = corner.place.cell;
                    let h = self.field.energies[to as usize];
                    if to == cell && self.is_its_own_image(&corner) {
                        // The motion returned to its own cell.
                    } else if h == f32::NEG_INFINITY {
                        lost += corner.weight;
                    } else if h < height {
                        kept += corner.weight;
                        match out[start..].iter_mut().find(|l| l.to == to) {
                            Some(link) => link.weight += corner.weight,
                            None => out.push(Link { to, weight: corner.weight }),
                        }
                    } else if crossing < CROSSINGS {
                        let same = |c: &&mut Corner| c.place.cell == to && c.mirror == corner.mirror;
                        match next.iter_mut().find(same) {
                            Some(known) => known.weight += corner.weight,
                            None => next.push(corner),
                        }
                    }
                });
                if crossing == 0 {
                    left = leaves;
                }
            }
            std::mem::swap(front, next);
        }
        let total = kept + lost;
        if total < LEAST {
            out.truncate(start);
            return left.map_or(CellFlow::End, CellFlow::Leaves);
        }
        for link in &mut out[start..] {
            link.weight /= total;
        }
        CellFlow::Down
    }

    /// Visits the corners within the box of the simplex into which the direction at a position points. If the
    /// box ends at a corner, returns the axis.
    fn corners(&self, from: &Corner, mut visit: impl FnMut(Corner)) -> Option<usize> {
        let velocity = self.velocity(&from.place);
        let mut order = [0, 1, 2, 3, 4];
        let order = &mut order[..self.axes];
        // Insertion sort: stable, and nothing is faster for five.
        for k in 1..order.len() {
            let mut j = k;
            while j > 0 && velocity[order[j]].abs() > velocity[order[j - 1]].abs() {
                order.swap(j, j - 1);
                j -= 1;
            }
        }
        let top = velocity[order[0]].abs();
        if top <= 0.0 || top.is_nan() {
            return None;
        }
        let scale = from.weight / top;
        let mut at = from.place.at;
        let mut rotation = from.place.rotation;
        for (k, &axis) in order.iter().enumerate() {
            if velocity[axis] == 0.0 {
                break;
            }
            if velocity[axis] > 0.0 {
                at[axis] += 1;
                rotation = rotation.wrapping_add(self.strides[axis]);
            } else {
                at[axis] = at[axis].wrapping_sub(1);
                rotation = rotation.wrapping_sub(self.strides[axis]);
            }
            if at[axis] >= self.cells[axis] {
                return Some(axis);
            }
            let next = order.get(k + 1).map_or(0.0, |a| velocity[*a].abs());
            let weight = (velocity[axis].abs() - next) * scale;
            if weight > 0.0 {
                let (place, mirror) = self.folded(at, rotation);
                let mirror = Mirror { x: mirror.x != from.mirror.x, y: mirror.y != from.mirror.y };
                visit(Corner { place, mirror, weight });
            }
        }
        None
    }

    /// Whether a corner is the cell that is kept in its place, not a mirror image of it.
    fn is_its_own_image(&self, corner: &Corner) -> bool {
        let axes = self.field.grid.axes.iter().zip(&corner.place.at).zip(&self.cells);
        axes.filter(|((axis, _), _)| corner.mirror.flips(axis.dof)).all(|((_, k), n)| 2 * k + 1 == *n)
    }

    /// Storage of a cell of the grid, and the reflection that leads there.
    fn folded(&self, mut at: [u32; 5], rotation: u32) -> (CellIndex, Mirror) {
        let fold = &self.field.fold;
        let image = fold.image(rotation as usize);
        let mut lateral = 0;
        let mut stride = 1;
        for (axis, flip) in [(self.x, image.mirror.x), (self.y, image.mirror.y)] {
            if axis == self.axes {
                continue;
            }
            if flip {
                at[axis] = self.cells[axis] - 1 - at[axis];
            }
            lateral += stride * at[axis];
            stride *= self.cells[axis];
        }
        let representative = fold.rotation(image.representative) as u32;
        if representative != rotation {
            self.turn_to(representative, &mut at);
        }
        let cell = image.representative as u32 * fold.slab() as u32 + lateral;
        (CellIndex { cell, at, rotation: representative }, image.mirror)
    }

    fn place(&self, cell: u32) -> CellIndex {
        let fold = &self.field.fold;
        let slab = fold.slab() as u32;
        let mut lateral = cell % slab;
        let mut at = [0; 5];
        for (k, cells) in at[..self.lateral].iter_mut().zip(&self.cells) {
            *k = lateral % cells;
            lateral /= cells;
        }
        let rotation = fold.rotation((cell / slab) as usize) as u32;
        self.turn_to(rotation, &mut at);
        CellIndex { cell, at, rotation }
    }

    /// Writes the numbers of a rotation along its axes.
    fn turn_to(&self, mut rotation: u32, at: &mut [u32; 5]) {
        for (k, cells) in at[..self.axes].iter_mut().zip(&self.cells).skip(self.lateral) {
            *k = rotation % cells;
            rotation /= cells;
        }
    }

    /// Velocity at a place, in cells; 0 without contact.
    fn velocity(&self, place: &CellIndex) -> [f32; 5] {
        let carrier = self.field.carriers[place.cell as usize];
        if carrier == GradientField::NOTHING {
            return [0.0; 5];
        }
        let representative = place.cell as usize / self.field.fold.slab();
        let patch: &Patch = &self.field.patches[representative][usize::from(carrier)];
        let number = |axis: usize| if axis == self.axes { 0 } else { place.at[axis] as usize };
        patch.at(number(self.x), number(self.y))
    }
}
