//! The largest and the smallest value of a table.
//!
//! ```text
//!   0.123▼  0.248   0.55     the source colours the largest value of each of tables 5.8 to 5.11 green and the smallest red (section 5.3.2)
//!   0.579   0.795   2.08▲    here both are marked, in print, in ours and in the exact values, so that it shows where they differ
//! ```

use super::ReproducedEntry;
use serde::Serialize;

/// Marks behind a number.
const LARGEST: char = '▲';
/// The mark of the smallest value.
const SMALLEST: char = '▼';

/// Places of the largest and the smallest values of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Extremes {
    /// Of the printed values.
    pub published: Places,
    /// Of ours; null if an entry is not computed.
    pub ours: Option<Places>,
    /// Of the exact values; null if an entry is not computed.
    pub exact: Option<Places>,
}

/// Places as `[row, column]`, both from 0; several for equal values.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Places {
    /// Of the largest value.
    pub largest: Vec<[usize; 2]>,
    /// Of the smallest value.
    pub smallest: Vec<[usize; 2]>,
}

impl Extremes {
    /// Of a table's entries, row by row.
    pub(super) fn of(entries: &[Vec<ReproducedEntry>]) -> Self {
        let published = |entry: &ReproducedEntry| Some(entry.published);
        Self {
            published: Places::of(entries, published)
                .unwrap_or(Places { largest: Vec::new(), smallest: Vec::new() }),
            ours: Places::of(entries, |entry| entry.ours),
            exact: Places::of(entries, |entry| entry.exact.map(|exact| exact.value)),
        }
    }
}

impl Places {
    fn of(entries: &[Vec<ReproducedEntry>], value: impl Fn(&ReproducedEntry) -> Option<f64>) -> Option<Self> {
        let values: Vec<Vec<f64>> =
            entries.iter().map(|row| row.iter().map(&value).collect()).collect::<Option<_>>()?;
        let flat = || values.iter().flatten().copied();
        let (most, least) = (flat().fold(f64::NEG_INFINITY, f64::max), flat().fold(f64::INFINITY, f64::min));
        let equal = |to: f64| {
            let row = |(row, values): (usize, &Vec<f64>)| {
                let there = values.iter().enumerate().filter(|(_, value)| **value == to);
                there.map(|(column, _)| [row, column]).collect::<Vec<_>>()
            };
            values.iter().enumerate().flat_map(row).collect()
        };
        Some(Self { largest: equal(most), smallest: equal(least) })
    }

    /// The mark of a place, if any.
    pub fn mark(&self, place: [usize; 2]) -> Option<char> {
        if self.largest.contains(&place) {
            Some(LARGEST)
        } else {
            self.smallest.contains(&place).then_some(SMALLEST)
        }
    }
}
