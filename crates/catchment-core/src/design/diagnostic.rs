//! An error with its place and advice, as data for any front end.

use super::line_column;
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

/// An error in the user's input, from any module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Description of the error.
    pub message: String,
    /// Advice.
    pub help: Option<String>,
    /// Byte range in the text to which it refers, if any.
    pub span: Option<Range<usize>>,
}

impl Diagnostic {
    /// A diagnostic without a place.
    pub fn new(message: impl Into<String>, help: Option<String>) -> Self {
        Self { message: message.into(), help, span: None }
    }

    /// The same at a place.
    #[must_use]
    pub fn at(mut self, span: Option<Range<usize>>) -> Self {
        self.span = span.filter(|span| !span.is_empty());
        self
    }
}

/// All errors of a text, in the order of their places; never empty.
#[derive(Debug, Clone, PartialEq, Eq)]
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

    /// The file, if there is one.
    pub fn path(&self) -> Option<&Path> {
        self.source.as_ref().map(|source| source.path.as_path())
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

    /// How many there are.
    pub const fn len(&self) -> usize {
        self.list.len() + self.omitted
    }

    /// Whether nothing was found.
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The errors of a text, in the order of their places.
    pub fn of(mut self, source: SourceText) -> Diagnostics {
        self.list.sort_by_key(|diagnostic| diagnostic.span.as_ref().map_or(0, |span| span.start));
        Diagnostics { source: Some(source), list: self.list, omitted: self.omitted }
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
            f.write_str(&diagnostic.message)?;
            if let Some(help) = &diagnostic.help {
                write!(f, "; {help}")?;
            }
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
    fn the_first_findings_are_kept_and_the_others_counted() {
        let mut found = DiagnosticCollector::default();
        assert!(found.is_empty());
        for k in (0..30).rev() {
            found.push(Diagnostic::new(k.to_string(), None).at(Some(k..k + 1)));
        }
        found.push_with(|| panic!("nobody reads it"));
        assert_eq!(found.len(), 31);
        let diagnostics = found.of(SourceText::new("d.toml", ""));
        assert_eq!((diagnostics.list.len(), diagnostics.omitted), (Diagnostics::MOST, 11));
        assert!(
            diagnostics.list.is_sorted_by_key(|diagnostic| diagnostic.span.clone().map(|span| span.start))
        );
    }

    #[test]
    fn a_finding_is_told_with_its_place() {
        let source = Some(SourceText::new("d.toml", "a = 1\nb = 2\n"));
        let list = vec![
            Diagnostic::new("wrong", Some("write 3".to_owned())).at(Some(10..11)),
            Diagnostic::new("all of it", None).at(Some(3..3)),
        ];
        let diagnostics = Diagnostics { source, list, omitted: 2 };
        assert_eq!(diagnostics.to_string(), "d.toml:2:5: wrong; write 3\nd.toml: all of it\nand 2 more");
        let bare = Diagnostics { source: None, list: vec![Diagnostic::new("wrong", None)], omitted: 0 };
        assert_eq!(bare.to_string(), "wrong");
    }
}
