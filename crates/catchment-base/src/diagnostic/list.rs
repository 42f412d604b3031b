//! The errors of a text, and the text.

use super::Diagnostic;
use crate::terminal::shown;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files that a program has in memory, by their paths.
pub type FilesInMemory = Arc<BTreeMap<PathBuf, Vec<u8>>>;

/// The text of a user's file, with its display name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceText {
    /// The file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Files that it names and that are in memory, by the paths that the design has of them; all others are on disk.
    pub files: FilesInMemory,
}

impl SourceText {
    /// A text and the name to show it under.
    pub fn new(path: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        Self { path: path.into(), text: text.into(), files: FilesInMemory::default() }
    }

    /// The same with files in memory; their paths are relative to the folder of the text.
    #[must_use]
    pub fn with_files(mut self, files: impl IntoIterator<Item = (PathBuf, Vec<u8>)>) -> Self {
        let folder = self.path.parent().unwrap_or_else(|| Path::new(""));
        self.files = Arc::new(files.into_iter().map(|(path, bytes)| (folder.join(path), bytes)).collect());
        self
    }

    /// Line and column of a byte, both from 1.
    pub fn line_column(&self, byte: usize) -> (usize, usize) {
        line_column(&self.text, byte)
    }
}

/// Line and column (in characters) of a byte, both from 1. A byte behind the end counts as the end.
pub fn line_column(text: &str, byte: usize) -> (usize, usize) {
    let before = &text.as_bytes()[..byte.min(text.len())];
    let line_start = before.iter().rposition(|b| *b == b'\n').map_or(0, |at| at + 1);
    let line = before.split(|b| *b == b'\n').count();
    // Count characters by their first bytes, so that a position inside a multi-byte character is valid, too.
    let column = 1 + before[line_start..].iter().filter(|b| **b & 0xC0 != 0x80).count();
    (line, column)
}

/// All errors of a text, in the order of their places; never empty.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostics {
    /// The text, if the input has one.
    pub source: Option<SourceText>,
    /// The errors.
    pub list: Vec<Diagnostic>,
    /// How many more there are.
    pub omitted: usize,
}

impl Diagnostics {
    /// Diagnostics that are kept and shown: who has more will not read them.
    pub const MOST: usize = 20;

    /// These errors, of a text.
    #[must_use]
    pub fn of(self, source: SourceText) -> Self {
        Self { source: Some(source), ..self }
    }

    /// The file, if there is one.
    pub fn path(&self) -> Option<&Path> {
        self.source.as_ref().map(|source| source.path.as_path())
    }
}

/// A single error, of no text.
impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Self {
        Self { source: None, list: vec![diagnostic], omitted: 0 }
    }
}

impl From<Diagnostics> for DiagnosticCollector {
    fn from(Diagnostics { list, omitted, .. }: Diagnostics) -> Self {
        Self { list, omitted }
    }
}

/// Diagnostics as they come: the first [`Diagnostics::MOST`] are kept, the others are counted and cost nothing.
#[derive(Debug, Default)]
pub struct DiagnosticCollector {
    list: Vec<Diagnostic>,
    omitted: usize,
}

impl DiagnosticCollector {
    /// Adds an error.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.push_with(|| diagnostic);
    }

    /// Adds an error, which is constructed only if it is kept.
    pub fn push_with(&mut self, diagnostic: impl FnOnce() -> Diagnostic) {
        if self.list.len() < Diagnostics::MOST {
            self.list.push(diagnostic());
        } else {
            self.omitted += 1;
        }
    }

    /// Adds an error at a place, which is determined only if the error is kept.
    pub fn push_at(&mut self, diagnostic: Diagnostic, span: impl FnOnce() -> Option<Range<usize>>) {
        self.push_with(|| Diagnostic { span: span(), ..diagnostic });
    }

    /// How many there are.
    pub const fn len(&self) -> usize {
        self.list.len() + self.omitted
    }

    /// Whether there is none.
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The errors of a text, in the order of their places.
    pub fn of(self, source: SourceText) -> Diagnostics {
        self.sorted().of(source)
    }

    /// The errors in the order of their places.
    pub fn sorted(mut self) -> Diagnostics {
        self.list.sort_by_key(|diagnostic| diagnostic.span.as_ref().map(|span| span.start));
        Diagnostics { source: None, list: self.list, omitted: self.omitted }
    }

    /// Refuses if there is an error.
    ///
    /// # Errors
    /// All errors, in the order of their places.
    pub fn refuse(self) -> Result<(), Diagnostics> {
        if self.is_empty() { Ok(()) } else { Err(self.sorted()) }
    }
}

/// `file:line:column: message; help`, a line each.
impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, diagnostic) in self.list.iter().enumerate() {
            f.write_str(if k == 0 { "" } else { "\n" })?;
            if let Some(source) = &self.source {
                write!(f, "{}:", shown(&source.path))?;
                if let Some(span) = &diagnostic.span {
                    let (line, column) = source.line_column(span.start);
                    write!(f, "{line}:{column}:")?;
                }
                f.write_str(" ")?;
            }
            write!(f, "{diagnostic}")?;
        }
        if self.omitted > 0 {
            write!(f, "\nand {} more", self.omitted)?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let text = "a\n µ=1\n";
        assert_eq!(line_column(text, 0), (1, 1));
        assert_eq!(line_column(text, 2), (2, 1));
        assert_eq!(line_column(text, text.find('=').unwrap()), (2, 3));
        assert_eq!(line_column(text, 1000), (3, 1));
        assert_eq!(line_column("", 0), (1, 1));
    }

    #[test]
    fn the_first_diagnostics_are_kept_and_the_others_counted() {
        let mut result = DiagnosticCollector::default();
        assert!(result.is_empty());
        for k in (0..30).rev() {
            result.push(Diagnostic::error("design", k.to_string(), None).at(Some(k..k + 1)));
        }
        result.push_with(|| panic!("the message is never built"));
        assert_eq!(result.len(), 31);
        let diagnostics = result.of(SourceText::new("d.toml", ""));
        assert_eq!((diagnostics.list.len(), diagnostics.omitted), (Diagnostics::MOST, 11));
        assert!(
            diagnostics.list.is_sorted_by_key(|diagnostic| diagnostic.span.clone().map(|span| span.start))
        );
    }

    #[test]
    fn a_diagnostic_is_printed_with_its_place() {
        let source = Some(SourceText::new("d.toml", "a = 1\nb = 2\n"));
        let list = vec![
            Diagnostic::error("design", "wrong", Some("write 3".to_owned())).at(Some(10..11)),
            Diagnostic::error("design", "all of it", None).at(Some(3..3)),
        ];
        let diagnostics = Diagnostics { source, list, omitted: 2 };
        assert_eq!(diagnostics.to_string(), "d.toml:2:5: wrong; write 3\nd.toml: all of it\nand 2 more");
        let bare = Diagnostics::from(Diagnostic::error("design", "wrong", None));
        assert_eq!(bare.to_string(), "wrong");
    }
}
