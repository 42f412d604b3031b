//! One table of a TOML document, with its place.

use super::keys::Key;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// A table of the document.
#[derive(Clone)]
pub(super) struct Section<'t> {
    /// As in `connector.fixed`; empty for the file itself.
    pub path: String,
    /// Its header, or the key it is the value of.
    pub span: Range<usize>,
    pub table: &'t DeTable<'t>,
}

impl<'t> Section<'t> {
    pub(super) fn root(document: &'t Spanned<DeTable<'t>>) -> Self {
        Self { path: String::new(), span: document.span(), table: document.get_ref() }
    }

    pub(super) fn entry(&self, name: &str) -> Option<(&'t Spanned<DeString<'t>>, &'t Spanned<DeValue<'t>>)> {
        self.table.get_key_value(name)
    }

    /// Place of a key of this table.
    pub(super) fn place(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    /// Byte range of a key, if it is present.
    pub(super) fn key_span(&self, key: &Key) -> Option<Range<usize>> {
        self.entry(key.name).map(|(name, _)| name.span())
    }

    pub(super) fn has(&self, key: &Key) -> bool {
        self.table.contains_key(key.name)
    }

    /// Whether the value of a key is a string.
    pub(super) fn is_text(&self, key: &Key) -> bool {
        self.entry(key.name).is_some_and(|(_, value)| matches!(value.get_ref(), DeValue::String(_)))
    }
}
