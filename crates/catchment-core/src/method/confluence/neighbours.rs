//! The centres of the cells around a pose error, and whether those that are decided agree.
//!
//! ```text
//!   ·  ·  ·  ·   │       2ⁿ centres: the two nearest along each axis; beyond the last centres, up to half a cell
//!   ·  a──a  ·   │       outside the box, a single centre
//!   ·  │q │  b   │
//!   ·  a──?  ·  q│       three of four are known, and equal: a
//!   ·  ·  ·  b   │
//! ```

use super::label::Label;
use crate::landscape::{Fold, Grid};
use crate::pose::{Dof, PoseError};

/// Looks up the centres around poses.
pub(super) struct Neighbours<'a> {
    fold: &'a Fold,
    axes: Vec<Lookup>,
    /// Number of lateral axes; they are the first.
    lateral: usize,
    /// Positions of x and y among them; `None` if not sampled.
    places: [Option<usize>; 2],
    /// Share of the centres that must be known.
    share: f64,
}

/// An axis of the grid.
struct Lookup {
    /// Its number among [`Dof::ALL`].
    error: usize,
    lo: f64,
    per_cell: f64,
    cells: i32,
    /// Of the rotation number; 0 for lateral axes.
    stride: usize,
}

impl Lookup {
    fn has(&self, number: i32) -> bool {
        (0..self.cells).contains(&number)
    }
}

/// Numbers of the lower centre along every axis, −1 below the first: they determine the surroundings of a
/// pose.
pub(super) type Base = [i32; 5];

/// Of so few centres all must be known: with three axes and less, motions are cheaper than errors.
const FEW: u32 = 8;

impl<'a> Neighbours<'a> {
    /// For the cells of a folded grid; at least `share` of the centres around a pose must be known.
    pub(super) fn new(grid: &Grid, fold: &'a Fold, share: f64) -> Self {
        let mut next = 1;
        let lookup = |axis: &crate::landscape::GridAxis| {
            let stride = if axis.dof.is_rotation() { next } else { 0 };
            next *= if axis.dof.is_rotation() { axis.cells } else { 1 };
            let (error, lo, per_cell) = (axis.dof.index(), axis.lo, axis.step().recip());
            Lookup { error, lo, per_cell, cells: i32::try_from(axis.cells).unwrap_or(i32::MAX), stride }
        };
        let axes: Vec<Lookup> = grid.axes.iter().map(lookup).collect();
        let lateral = grid.axes.iter().filter(|axis| !axis.dof.is_rotation()).count();
        let place = |dof| grid.axes.iter().position(|axis| axis.dof == dof);
        let share = if 1 << axes.len() <= FEW { 1.0 } else { share };
        Self { fold, axes, lateral, places: [place(Dof::X), place(Dof::Y)], share }
    }

    /// Position of a pose among the centres.
    pub(super) fn base(&self, error: &PoseError) -> Base {
        let error = error.to_array();
        let mut base = [0; 5];
        for (base, axis) in base.iter_mut().zip(&self.axes) {
            let place = (error[axis.error] - axis.lo) * axis.per_cell - 0.5;
            // Further outside is as good as outside.
            *base = place.floor().clamp(-2.0, f64::from(axis.cells)) as i32;
        }
        base
    }

    /// The centres towards which a motion leads from the centre of a cell: the cell itself, and those beside it on its side, which is below along the
    /// axes whose bits are set.
    pub(super) fn ahead(&self, centre: &PoseError, below: u8) -> Base {
        let error = centre.to_array();
        let mut base = [0; 5];
        for (k, (base, axis)) in base.iter_mut().zip(&self.axes).enumerate() {
            let number = ((error[axis.error] - axis.lo) * axis.per_cell) as i32;
            *base = number - i32::from(below >> k & 1);
        }
        base
    }

    /// The common label of all decided centres around a pose, if enough are decided and all agree. `asking`
    /// centres belong to the query, and need not be decided.
    pub(super) fn agreed(&self, base: &Base, labels: &[Label], asking: u32) -> Option<Label> {
        let sides =
            |(axis, base): (&Lookup, &i32)| u32::from(axis.has(*base)) + u32::from(axis.has(base + 1));
        let centres: u32 = self.axes.iter().zip(base).map(sides).product();
        if centres == 0 {
            return None;
        }
        let mut spare = (centres - (self.share * f64::from(centres)).ceil() as u32).max(asking);
        let mut result: Option<Label> = None;
        // Bit k of a corner is set if the corner is the upper corner along axis k.
        let number = |axis: usize, corner: usize| {
            let number = base[axis] + i32::from(corner >> axis & 1 == 1);
            self.axes[axis].has(number).then_some(number as usize)
        };
        let rotations = self.axes.len() - self.lateral;
        for turn in 0..1usize << rotations {
            let along = |rotation: Option<usize>, axis: usize| {
                Some(rotation? + number(axis, turn << self.lateral)? * self.axes[axis].stride)
            };
            let Some(rotation) = (self.lateral..self.axes.len()).fold(Some(0), along) else { continue };
            for shift in 0..1usize << self.lateral {
                let [x, y] = self.places.map(|place| place.map_or(Some(0), |axis| number(axis, shift)));
                let (Some(x), Some(y)) = (x, y) else { continue };
                let label = labels[self.fold.kept(rotation, x, y)];
                match result {
                    _ if !label.is_known() => spare = spare.checked_sub(1)?,
                    None => result = Some(label),
                    Some(first) if label.outcome() != first.outcome() => return None,
                    Some(_) => {}
                }
            }
        }
        Some(Label::inherited(result?.outcome(), centres < 1 << self.axes.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::acceptance::Outcome::{self, Aligned, Jammed};
    use crate::design::Alignment;
    use crate::pose::{DofSet, Mount};

    fn flat(cells: usize) -> Grid {
        let free: DofSet = [Dof::X, Dof::Y].into_iter().collect();
        Grid::over(&Alignment::new(free, Mount::X), |_| cells)
    }

    #[test]
    fn centres_agree_where_all_are_alike() {
        let grid = flat(4);
        let fold = Fold::new(&grid, &[]).unwrap();
        let around = Neighbours::new(&grid, &fold, 0.75);
        let mut labels = vec![Label::own(Aligned); 16];
        let between = |x: f64, y: f64| {
            let at = |dof: Dof, number: f64| {
                let axis = grid.axis(dof).unwrap();
                axis.lo + (number + 0.5) * axis.step()
            };
            PoseError { x: at(Dof::X, x), y: at(Dof::Y, y), ..PoseError::default() }
        };
        let agreed = |labels: &[Label], x: f64, y: f64| {
            around.agreed(&around.base(&between(x, y)), labels, 0).map(|label| {
                assert!(label.has_inherited());
                (label.outcome(), label.has_joined_beyond())
            })
        };
        assert_eq!(agreed(&labels, 1.5, 2.2), Some((Aligned, false)));
        // Up to half a cell beyond the border, the nearest centres count; farther out, no centre counts.
        assert_eq!(agreed(&labels, -0.9, 2.2), Some((Aligned, true)));
        assert_eq!(agreed(&labels, -1.1, 2.2), None);
        assert_eq!(agreed(&labels, 3.9, -0.9), Some((Aligned, true)));
        labels[4 * 2 + 1] = Label::own(Jammed);
        assert_eq!(agreed(&labels, 1.5, 2.2), None);
        labels[4 * 2 + 1] = Label::UNKNOWN;
        assert_eq!(agreed(&labels, 1.5, 2.2), None);
        let own = around.agreed(&around.base(&between(1.5, 2.2)), &labels, 1);
        assert_eq!(own.map(Label::outcome), Some(Aligned));
    }

    #[test]
    fn of_many_centres_some_may_be_unknown() {
        let grid = Grid::over(&Alignment::new(DofSet::ALL, Mount::X), |_| 2);
        let fold = Fold::new(&grid, &[]).unwrap();
        let around = Neighbours::new(&grid, &fold, 0.75);
        let middle = around.base(&PoseError::default());
        let outcomes = |unknown: usize| {
            let mut labels = vec![Label::own(Aligned); 32];
            labels[..unknown].fill(Label::UNKNOWN);
            around.agreed(&middle, &labels, 0).map(Label::outcome)
        };
        let some: Vec<Option<Outcome>> = [0, 8, 9, 32].into_iter().map(outcomes).collect();
        assert_eq!(some, [Some(Aligned), Some(Aligned), None, None]);
        // From a corner inwards, and outwards along x.
        let corner = grid.pose(0);
        assert_eq!(around.ahead(&corner, 0), [0; 5]);
        assert_eq!(around.ahead(&corner, 1), [-1, 0, 0, 0, 0]);
    }
}
