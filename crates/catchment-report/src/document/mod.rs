//! Renderers of a [`Document`]: from a single description of a result to terminal text, a page, a text file
//! or a spreadsheet.
//!
//! ```text
//!   Document ──┬─▶ text      names in a column, tables aligned, wrapped to the width of the terminal
//!              ├─▶ markdown  a table per group of rows, tables as tables
//!              ├─▶ html      the same as elements; one page that needs no other file
//!              └─▶ csv       the first table with keys, every digit
//! ```
//!
//! Names of designs and files are foreign text: characters that control a terminal are replaced, and
//! characters with a meaning in Markdown or HTML are escaped.

mod html;
mod markdown;
mod text;

pub use html::html;
pub use markdown::markdown;
pub use text::{Style, body, diagnostics, folded, lines, text};

use crate::envelope::{ReportBody, ReportEnvelope};
use crate::schema::Timing;
use catchment_core::design::{ConnectorSpec, Design};
use catchment_core::diagnostic::{Advice, Diagnostic, Severity};
use catchment_core::document::{Document, Subject, Table, rounded, to_digits};
use catchment_core::pose::Dof;
use serde::Serialize;
use std::borrow::Cow;
use std::ops::{Deref, DerefMut};

/// A result with its design. In JSON the fields of the result are next to `design`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OfDesign<T> {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// The result.
    #[serde(flatten)]
    pub result: T,
}

/// The report of a result of a design.
pub type ReportOf<T> = ReportEnvelope<OfDesign<T>>;

impl<T: Subject> ReportBody for OfDesign<T> {
    const KIND: &'static str = T::KIND;
}

impl<T> Deref for OfDesign<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.result
    }
}

impl<T> DerefMut for OfDesign<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.result
    }
}

impl<T: Subject> ReportOf<T> {
    /// The report of a result. Warnings of its own numbers follow `warnings`, which are those of the problem.
    pub fn new(design: &Design, result: T, mut warnings: Vec<Diagnostic>, timing: Option<Timing>) -> Self {
        warnings.extend(result.warnings());
        Self::of(OfDesign { design: design.clone(), result }, warnings, timing)
    }
}

/// A report that people read.
pub trait Printed: ReportBody {
    /// Its subject: usually the name of the design.
    fn title(&self) -> Cow<'_, str>;

    /// Its description, without warnings.
    fn document(&self) -> Document;
}

impl<T: Subject> Printed for OfDesign<T> {
    fn title(&self) -> Cow<'_, str> {
        Cow::Borrowed(&self.design.name)
    }

    /// The result, then the design and how it was computed.
    fn document(&self) -> Document {
        let mut document = self.result.document(&self.design);
        document.append(setup(&self.design, T::SAMPLES_ERRORS));
        self.result.setup(&self.design, &mut document);
        document
    }
}

impl<B: Printed> ReportEnvelope<B> {
    /// The whole description, with title and warnings.
    pub fn described(&self) -> Described<'_> {
        self.described_with(|_| None)
    }

    /// The same, with the advice of each warning phrased by `controls`: `--samples 4000`, for a command line.
    pub fn described_with(&self, controls: impl Fn(&Advice) -> Option<String>) -> Described<'_> {
        Described {
            title: self.body.title(),
            document: self.body.document(),
            warnings: self.warnings.iter().map(|warning| warning.worded(&controls)).collect(),
        }
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        text(&self.described(), Style::default())
    }

    /// Its table for programs, the column names first; empty without a table.
    pub fn records(&self) -> Vec<Vec<String>> {
        self.body.document().records().map(Table::records).unwrap_or_default()
    }
}

/// A document with the title and the warnings of its report.
#[derive(Debug, Clone, PartialEq)]
pub struct Described<'a> {
    /// Subject of the report.
    pub title: Cow<'a, str>,
    /// The document.
    pub document: Document,
    /// Warnings, with advice in the words of a front end.
    pub warnings: Vec<Diagnostic>,
}

/// A diagnostic in a line: `Warning: it is so (help)`, divided behind the severity.
fn in_a_line(diagnostic: &Diagnostic) -> [String; 2] {
    let severity = match diagnostic.severity {
        Severity::Error => "Error:",
        Severity::Warning => "Warning:",
        Severity::Note => "Note:",
    };
    let message = diagnostic.message.clone();
    let help = diagnostic.help().map_or_else(String::new, |help| format!(" ({help})"));
    [severity.to_owned(), message + &help]
}

/// The rows about a design that stand below every result; with the error box and ρ below those that sample pose errors.
pub fn setup(design: &Design, samples_errors: bool) -> Document {
    let kind = match &design.connector {
        ConnectorSpec::Family(f) => {
            format!("{}, height / width {}", f.family().name(), rounded(f.aspect_ratio()))
        }
        ConnectorSpec::Own(_) => "halves of the design file".to_owned(),
    };
    let width = design.unit.map_or_else(
        || "lengths in D, its width".to_owned(),
        |u| format!("width D = {} {}", seven_digits(design.width), u.symbol()),
    );
    let mut document = Document::default();
    document.row("connector", format!("{kind}; {width}"));
    document.row("pose errors", pose_errors(design));
    if samples_errors {
        document.row("error box", format!("{} (range of the errors studied)", error_box(design)));
    }
    document.row("COR", center_of_rotation(design));
    if samples_errors {
        let rho = own_length(design, design.alignment.rotation_length);
        let turns = design.alignment.free.iter().any(Dof::is_rotation);
        document.row("ρ", characteristic_length(&rho, turns));
    }
    document
}

/// The characteristic length in words: `characteristic length 25 mm = √(rotational / lateral damping of the mount), from the design …`.
pub(crate) fn characteristic_length(rho: &str, turns: bool) -> String {
    let meaning = if turns {
        " = √(rotational / lateral damping of the mount), from the design (default 0.5 D)"
    } else {
        ", without effect, since no turn is free"
    };
    format!("characteristic length {rho}{meaning}")
}

/// Which errors are free, and what each is: `x, y (shifts); yaw (turn about approach axis z); roll, pitch locked at 0`.
pub(crate) fn pose_errors(design: &Design) -> String {
    let free = design.alignment.free;
    let kinds = [
        ("shift", &[(Dof::X, ""), (Dof::Y, "")][..]),
        ("turn", &[(Dof::Roll, "x"), (Dof::Pitch, "y"), (Dof::Yaw, "approach axis z")][..]),
    ];
    let mut words: Vec<String> = Vec::new();
    for (kind, dofs) in kinds {
        let (names, about): (Vec<&str>, Vec<&str>) = dofs
            .iter()
            .filter(|(dof, _)| free.contains(*dof))
            .map(|(dof, about)| (dof.name(), *about))
            .unzip();
        if names.is_empty() {
            continue;
        }
        let many = if names.len() == 1 { "" } else { "s" };
        let about = about.join(", ");
        let about = if about.starts_with(", ") || about.is_empty() {
            String::new()
        } else {
            format!(" about {about}")
        };
        words.push(format!("{} ({kind}{many}{about})", names.join(", ")));
    }
    let locked: Vec<&str> = Dof::ALL.into_iter().filter(|dof| !free.contains(*dof)).map(Dof::name).collect();
    if !locked.is_empty() {
        words.push(format!("{} locked at 0", locked.join(", ")));
    }
    words.join("; ")
}

/// The ranges of the free errors, those that are equal together: `x, y ±0.5 D; yaw ±45°`.
pub(crate) fn error_box(design: &Design) -> String {
    let mut ranges: Vec<(Vec<&str>, String)> = Vec::new();
    for dof in design.alignment.free.iter() {
        let half = design.alignment.half_range(dof);
        let range = if dof.is_rotation() {
            format!("±{}°", rounded((half.to_degrees() * 1e4).round() / 1e4))
        } else {
            format!("±{}", own_length(design, half))
        };
        match ranges.last_mut().filter(|(_, last)| *last == range) {
            Some((names, _)) => names.push(dof.name()),
            None => ranges.push((vec![dof.name()], range)),
        }
    }
    let ranges: Vec<String> =
        ranges.into_iter().map(|(names, range)| format!("{} {range}", names.join(", "))).collect();
    ranges.join("; ")
}

/// The centre of rotation: `0.5 D ahead of the moving face`.
fn center_of_rotation(design: &Design) -> String {
    let cor = design.alignment.center_of_rotation;
    let place = match own_length(design, cor.abs()) {
        _ if cor == 0.0 => "the centre of its mating face".to_owned(),
        length if cor > 0.0 => format!("{length} ahead of its mating face, towards the fixed half"),
        length => format!("{length} behind its mating face"),
    };
    format!("centre of rotation: the mount pushes the moving half here, along -z; {place}")
}

/// A length that is given in D, in the unit of the design.
fn own_length(design: &Design, value: f64) -> String {
    match design.unit {
        Some(unit) => format!("{} {}", rounded((value * design.width * 1e6).round() / 1e6), unit.symbol()),
        None => format!("{} D", rounded(value)),
    }
}

/// A length to seven significant digits: a file of single precision has no more.
pub fn seven_digits(value: f64) -> f64 {
    to_digits(value, SINGLE_PRECISION)
}

/// Significant digits of a number in single precision.
pub const SINGLE_PRECISION: i32 = 7;

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    use catchment_core::document::{Cell, Column, ColumnFormat};

    /// A document with every kind of part.
    pub(crate) fn sample() -> Described<'static> {
        let mut document = Document::default();
        document.row("method", "descent, 200 motions").row("window", "x ±1.2 mm, yaw ±5.5°");
        document.more("limited by yaw");
        document.section("limits");
        let mut table = Table::new([
            Column::new("error").key("axis").left(),
            Column::new("limit").key("limit").format(ColumnFormat::Fixed(2)),
            Column::new("docks").interval("aligned").format(ColumnFormat::Tenths),
            Column::data("seed"),
        ]);
        table.push(["x".into(), 1.234.into(), Cell::Interval(0.991, [0.98, 0.996]), 1usize.into()]);
        table.push(["yaw".into(), 12.0.into(), Cell::Empty, 2usize.into()]);
        document.table(table);
        document.section(None).paragraph("Every sampled pose of the window docks: 0 failures in 300 000 samples <95 % confidence> and so on to the end of a long line.");
        Described {
            title: "peg | <socket>\u{1b}[2J".into(),
            document,
            warnings: vec![Diagnostic::warning("undecided", "2 poses are undecided")],
        }
    }

    #[test]
    fn text_is_aligned_and_wrapped() {
        let expected = "\
peg | <socket>?[2J
────────────────────────
  method         descent, 200 motions
  window         x ±1.2 mm, yaw ±5.5°
                 limited by yaw

  limits
  error  limit                 docks
  x       1.23  99.1 % (98.0 … 99.6)
  yaw    12.00

  Every sampled pose of the window docks: 0 failures in 300 000 samples <95 %
  confidence> and so on to the end of a long line.

warning: 2 poses are undecided
";
        assert_eq!(text(&sample(), Style::default()), expected);
        let narrow = text(&sample(), Style { columns: 40, ..Style::default() });
        assert!(narrow.lines().all(|line| line.chars().count() <= 40), "{narrow}");
        let colourful = text(&sample(), Style { colour: true, ..Style::default() });
        assert_eq!(anstyle_free(&colourful), expected);
        assert!(colourful.contains("\u{1b}[1mpeg") && colourful.contains("\u{1b}[33mwarning:"));
    }

    fn anstyle_free(text: &str) -> String {
        ["\u{1b}[1m", "\u{1b}[33m", "\u{1b}[0m"]
            .iter()
            .fold(text.to_owned(), |text, code| text.replace(code, ""))
    }

    #[test]
    fn notes_are_folded_between_words() {
        let note = "  note: the halves touch at 12.5 mm; see docs/limits.md";
        assert_eq!(folded(note, 80), note);
        let lines = ["  note: the halves touch at", "    12.5 mm; see", "    docs/limits.md"];
        assert_eq!(folded(note, 29), lines.join("\n"));
        // A word longer than the line stays whole; a terminal may be narrower than the indentation.
        assert_eq!(folded("see docs/limits.md", 3), "see\n  docs/limits.md");
    }

    #[test]
    fn markdown_has_tables() {
        let text = markdown(&sample());
        assert!(
            text.starts_with(
                "# peg \\| \\<socket\\>?[2J\n\n| | |\n|---|---|\n| method | descent, 200 motions |\n"
            ),
            "{text}"
        );
        assert!(text.contains("| window | x ±1.2 mm, yaw ±5.5° |\n| | limited by yaw |\n"), "{text}");
        assert!(
            text.contains("\n## limits\n\n| error | limit | docks |\n|:--|--:|--:|\n| x | 1.23 |"),
            "{text}"
        );
        assert!(text.ends_with("\n> **Warning:** 2 poses are undecided\n"), "{text}");
    }

    #[test]
    fn html_is_well_formed() {
        let text = html(&sample());
        let page = roxmltree::Document::parse_with_options(
            &text,
            roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() },
        )
        .unwrap();
        let count = |name| page.descendants().filter(|node| node.has_tag_name(name)).count();
        assert_eq!((count("h1"), count("h2"), count("table"), count("th")), (1, 1, 2, 6));
        assert!(text.contains("<h1>peg | &lt;socket&gt;?[2J</h1>"), "{text}");
    }
}
