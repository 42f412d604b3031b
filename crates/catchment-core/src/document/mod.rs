//! The description of a result for people, from which text, CSV, Markdown and HTML are rendered.
//!
//! ```text
//!   study ──▶ result ──┬─▶ serde, schemars       the JSON and its schema
//!                      └─▶ Document              sections of rows, tables and paragraphs
//!                             ├─▶ text           for a terminal of any width
//!                             ├─▶ Markdown, HTML
//!                             └─▶ CSV            the first table with keys, every digit
//! ```
//!
//! A result implements [`Subject`] once, beside its type; the renderers are in `catchment-report`. A
//! [`Table`] holds values, not text: its columns define the format for people ([`ColumnFormat`]) and the keys for
//! programs. Lengths are in D and angles in radians wherever a program reads them.

mod number;
mod table;
mod units;

pub use number::{
    decimals, fixed, grouped, length, number, percent, point_to_digits, rounded, rounded_down, significant,
    tenths, tenths_between, to_digits, with_error, with_interval,
};
pub use table::{Cell, Column, ColumnFormat, Table};
pub use units::DesignUnits;
pub(crate) use units::NOTHING;

use crate::design::Design;
use crate::diagnostic::Diagnostic;
use crate::merit::sum::wilson95;
use serde::{Deserialize, Serialize};

/// A result that is printed and stored: it serialises itself, and describes itself to people.
pub trait Subject: Serialize {
    /// The `kind` of its JSON, which is also the name of its schema.
    const KIND: &'static str;

    /// Whether it depends on the error box and on ρ: the heading then states both.
    const SAMPLES_ERRORS: bool = true;

    /// Warnings that its own numbers give rise to.
    fn warnings(&self) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// How it was computed: rows that follow those of the design.
    fn setup(&self, _: &Design, _: &mut Document) {}

    /// Its description, without setup and warnings.
    fn document(&self, design: &Design) -> Document;
}

/// Sections from top to bottom; an empty line stands between two of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Document {
    /// The sections.
    pub sections: Vec<Section>,
}

/// Parts that belong together.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// Its heading, if any.
    pub title: Option<String>,
    /// Its parts, from top to bottom.
    pub parts: Vec<SectionPart>,
    /// Whether it answers a second question: terminals show it with `--verbose`, files always.
    pub is_detail: bool,
}

/// A part of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionPart {
    /// A name and its value; an empty name continues the row above.
    Row {
        /// The name.
        name: String,
        /// The value.
        value: String,
    },
    /// A table.
    Table(Table),
    /// A sentence or several.
    Paragraph(String),
}

impl Section {
    /// Whether people see something of it.
    pub fn is_shown(&self) -> bool {
        let shown = |part: &SectionPart| !matches!(part, SectionPart::Table(table) if !table.is_shown());
        self.title.is_some() || self.parts.iter().any(shown)
    }
}

impl Document {
    /// Starts a section.
    pub fn section(&mut self, title: impl Into<Option<&'static str>>) -> &mut Self {
        self.titled(title.into().map(str::to_owned))
    }

    /// Starts a section under a heading that is computed.
    pub fn titled(&mut self, title: Option<String>) -> &mut Self {
        self.sections.push(Section { title, ..Section::default() });
        self
    }

    /// Starts a section of details.
    pub fn details(&mut self) -> &mut Self {
        self.sections.push(Section { is_detail: true, ..Section::default() });
        self
    }

    /// Adds a row: a name and its value.
    pub fn row(&mut self, name: impl Into<String>, value: impl Into<String>) -> &mut Self {
        self.part(SectionPart::Row { name: name.into(), value: value.into() })
    }

    /// Continues the last row on a line of its own.
    pub fn more(&mut self, value: impl Into<String>) -> &mut Self {
        self.row("", value)
    }

    /// Adds a table.
    pub fn table(&mut self, table: Table) -> &mut Self {
        self.part(SectionPart::Table(table))
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: impl Into<String>) -> &mut Self {
        self.part(SectionPart::Paragraph(text.into()))
    }

    /// Appends the sections of another document.
    pub fn append(&mut self, other: Self) -> &mut Self {
        self.sections.extend(other.sections);
        self
    }

    fn part(&mut self, part: SectionPart) -> &mut Self {
        if self.sections.is_empty() {
            self.sections.push(Section::default());
        }
        if let Some(section) = self.sections.last_mut() {
            section.parts.push(part);
        }
        self
    }

    /// The table for programs as CSV: the first table whose columns have keys.
    pub fn records(&self) -> Option<&Table> {
        let parts = self.sections.iter().flat_map(|section| &section.parts);
        parts
            .filter_map(|part| match part {
                SectionPart::Table(table) => Some(table),
                _ => None,
            })
            .find(|table| table.has_keys())
    }
}

/// The method of exact motions in words: `exact quasi-static motion of 4 000 random poses, without friction`.
pub fn exact_motions(of: &str, friction: f64) -> String {
    if friction > 0.0 {
        format!("exact quasi-static motion of {of}, μ = {friction} between the halves (Coulomb)")
    } else {
        format!("exact quasi-static motion of {of}, without friction")
    }
}

/// A count as a share of all, with its sampling uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Share {
    /// The count.
    pub count: usize,
    /// The count divided by the total, in [0, 1].
    pub share: f64,
    /// 95 % interval of the share (Wilson).
    pub ci95: [f64; 2],
}

impl Share {
    /// So many of all.
    pub fn of(count: usize, all: usize) -> Self {
        let share = if all == 0 { 0.0 } else { count as f64 / all as f64 };
        Self { count, share, ci95: wilson95(count, all) }
    }
}

/// The JSON schema of shares by the names of outcomes.
#[cfg(feature = "schema")]
pub(crate) fn shares_by_outcome(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
    use crate::acceptance::Outcome;
    let share = generator.subschema_for::<Share>();
    let properties: serde_json::Map<String, serde_json::Value> =
        Outcome::ALL.iter().map(|outcome| (outcome.name().to_owned(), share.clone().to_value())).collect();
    schemars::json_schema!({ "type": "object", "properties": properties })
}

/// The same for an optional map.
#[cfg(feature = "schema")]
pub(crate) fn shares_or_null(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
    let mut schema = shares_by_outcome(generator);
    schema.insert("type".to_owned(), serde_json::json!(["object", "null"]));
    schema
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_for_programs_is_the_first_with_keys() {
        let mut document = Document::default();
        document.row("method", "descent").section("limits");
        document.table(Table::new([Column::new("error")]));
        assert_eq!(document.records(), None);
        document.table(Table::new([Column::new("error").key("axis")]));
        assert_eq!(document.sections.len(), 2);
        assert_eq!(document.records().map(Table::keys), Some(vec!["axis".to_owned()]));
    }

    #[test]
    fn a_share_of_nothing_is_unknown() {
        assert_eq!(Share::of(0, 0), Share { count: 0, share: 0.0, ci95: [0.0, 1.0] });
        assert_eq!(Share::of(1, 2).share, 0.5);
    }
}
