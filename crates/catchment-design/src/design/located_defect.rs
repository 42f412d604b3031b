//! Errors with their places in the file.

use super::defect::DesignDefect;
use catchment_base::diagnostic::{Diagnostics, line_column};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

/// A defect and where it belongs.
#[derive(Debug, Clone, PartialEq)]
pub struct LocatedDefect {
    /// The error.
    pub defect: DesignDefect,
    /// Byte range of the file to which it refers; for a missing item empty, at the end of the preceding item.
    pub span: Range<usize>,
    /// Line of the first of them, from 1.
    pub line: usize,
    /// Column of the first of them in characters, from 1.
    pub column: usize,
}

impl LocatedDefect {
    /// Places `defect` at the bytes `span` of `text`.
    pub fn new(defect: DesignDefect, span: Range<usize>, text: &str) -> Self {
        let (line, column) = line_column(text, span.start);
        Self { defect, span, line, column }
    }
}

impl fmt::Display for LocatedDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.line, self.column, self.defect)
    }
}

/// All problems of a file in the order of their places; never empty.
#[derive(Debug, Clone, PartialEq)]
pub struct LocatedDefects {
    /// The first of them.
    pub list: Vec<LocatedDefect>,
    /// How many more there are beyond [`LocatedDefects::MOST`].
    pub omitted: usize,
}

impl LocatedDefects {
    /// Problems that are listed.
    pub const MOST: usize = Diagnostics::MOST;

    /// Sorts and shortens a list, from which `omitted` errors were already dropped.
    pub(super) fn new(mut result: Vec<(DesignDefect, Range<usize>)>, omitted: usize, text: &str) -> Self {
        result.sort_by_key(|(_, span)| (span.start, span.end));
        let omitted = omitted + result.len().saturating_sub(Self::MOST);
        result.truncate(Self::MOST);
        let list = result.into_iter().map(|(defect, span)| LocatedDefect::new(defect, span, text)).collect();
        Self { list, omitted }
    }
}

impl fmt::Display for LocatedDefects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.list.iter().enumerate() {
            let separator = if index == 0 { "" } else { "\n" };
            write!(f, "{separator}{problem}")?;
        }
        if self.omitted > 0 {
            write!(f, "\nand {} more", self.omitted)?;
        }
        Ok(())
    }
}

impl std::error::Error for LocatedDefects {}

/// Place of each key of a design in its file, so that later modules can refer to it.
///
/// Places are written as in `connector.fixed.pieces[2]`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sources {
    spans: BTreeMap<String, Range<usize>>,
}

impl Sources {
    pub(super) fn insert(&mut self, place: String, span: Range<usize>) {
        self.spans.insert(place, span);
    }

    /// Bytes of the file for `place`, or of the nearest thing around it that the file mentions.
    pub fn span(&self, place: &str) -> Option<Range<usize>> {
        let mut place = place;
        loop {
            if let Some(span) = self.spans.get(place) {
                return Some(span.clone());
            }
            if place.is_empty() {
                return None;
            }
            place = &place[..place.rfind(['.', '[']).unwrap_or(0)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_fall_back_to_the_enclosing_key() {
        let mut sources = Sources::default();
        sources.insert("connector".into(), 0..9);
        sources.insert("connector.fixed.pieces".into(), 20..30);
        assert_eq!(sources.span("connector.fixed.pieces[2]"), Some(20..30));
        assert_eq!(sources.span("connector.moving"), Some(0..9));
        assert_eq!(sources.span("alignment.free"), None);
    }
}
