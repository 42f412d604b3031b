//! The labels of flooding: the watershed of every cell before any merging, and after it.
//!
//! ```text
//!   first labels      1 1 2 2 2 ▒ 3 3        ▒ a dam, which belongs to no basin yet (Meyer's flooding alone)
//!   into              1→1  2→1  3→3          2 was shallower than the tolerance
//!   after merging     1 1 1 1 1   3 3
//! ```
//!
//! Sampling alone divides a narrow canal that runs diagonally to the grid into many small watersheds; merging
//! joins them again. (Dissertation, section 5.3, figures 5.10 and 5.11.)

use serde::{Deserialize, Serialize};

/// The label of a cell between two watersheds.
pub const DAM: u32 = u32::MAX;

/// Labels of every cell before merging, and their final labels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Watersheds {
    /// The number of every cell's watershed before merging; [`DAM`] for a cell between two.
    pub first: Vec<u32>,
    /// For every number, that of the watershed it is part of after merging.
    pub into: Vec<u32>,
    /// The number of the watershed of all cells without contact, if there are any.
    pub outside: Option<u32>,
}

/// Numbers of watersheds, without the region of cells without contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WatershedCounts {
    /// Before merging.
    pub first: usize,
    /// After merging.
    pub merged: usize,
    /// Cells between two watersheds, before merging.
    pub dams: usize,
    /// Cells whose watershed was merged into another.
    pub moved: usize,
}

impl Watersheds {
    /// The number of the watershed that a cell is part of after merging; `None` for a dam.
    pub fn merged(&self, cell: usize) -> Option<u32> {
        let label = self.first[cell];
        (label != DAM).then(|| self.into[label as usize])
    }

    /// How many there are.
    pub fn counts(&self) -> WatershedCounts {
        let mut cells = vec![0usize; self.into.len()];
        let mut dams = 0;
        for label in &self.first {
            match cells.get_mut(*label as usize) {
                Some(cells) => *cells += 1,
                None => dams += 1,
            }
        }
        let is_outside = |number: usize| Some(number as u32) == self.outside;
        let (mut first, mut moved) = (0, 0);
        let mut kept = vec![false; self.into.len()];
        for (number, cells) in cells.into_iter().enumerate().filter(|(_, cells)| *cells > 0) {
            let last = self.into[number] as usize;
            first += usize::from(!is_outside(number));
            kept[last] = true;
            moved += if last == number { 0 } else { cells };
        }
        let merged = (0..kept.len()).filter(|number| kept[*number] && !is_outside(*number)).count();
        WatershedCounts { first, merged, dams, moved }
    }
}
