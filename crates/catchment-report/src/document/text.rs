//! A document as text, for terminals.

use super::Described;
use catchment_core::diagnostic::{Diagnostic, Severity};
use catchment_core::document::{Cell, Column, Document, Section, SectionPart, Table};
use catchment_core::terminal::printable;

/// The names of rows take at least so many columns; names that are longer than the most stand out.
const NAMES: usize = 14;
const LONGEST_NAME: usize = 19;
/// The indent of everything below the title.
const INDENT: &str = "  ";
/// Between two columns of a table.
const GAP: usize = 2;
/// No terminal is narrower than this.
const NARROWEST: usize = 40;
/// The shortest line under a title.
const RULE: usize = 24;
/// The fewest columns in which a text at the end of a row is wrapped.
const LEAST_TEXT: usize = 16;

const BOLD: &str = "\u{1b}[1m";
const RED: &str = "\u{1b}[31m";
const YELLOW: &str = "\u{1b}[33m";
const CYAN: &str = "\u{1b}[36m";
const RESET: &str = "\u{1b}[0m";

/// How text is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// Columns of the terminal.
    pub columns: usize,
    /// Whether titles are bold and severities coloured.
    pub colour: bool,
    /// Whether sections of details are shown.
    pub details: bool,
}

impl Default for Style {
    fn default() -> Self {
        Self { columns: 80, colour: false, details: true }
    }
}

impl Style {
    fn painted(self, code: &str, text: &str) -> String {
        if self.colour { format!("{code}{text}{RESET}") } else { text.to_owned() }
    }
}

/// A document with its warnings as text; ends with a line break.
pub fn text(described: &Described<'_>, style: Style) -> String {
    let mut text = body(described, style);
    for warning in diagnostics(&described.warnings, style) {
        text.extend(["\n", &warning]);
    }
    text
}

/// A document without its warnings as text; ends with a line break.
pub fn body(described: &Described<'_>, style: Style) -> String {
    let mut page = Page::new(style);
    let title = printable(&described.title);
    let rule = "─".repeat(title.chars().count().clamp(RULE, page.style.columns));
    page.text.push_str(&style.painted(BOLD, &title));
    page.text.push('\n');
    page.line(&rule);
    page.document(&described.document);
    page.text
}

/// `warning: …` and, if there is advice, `help: …` below the last of those that share it; each ends with a line break.
pub fn diagnostics(list: &[Diagnostic], style: Style) -> Vec<String> {
    let painted = |name: &str, colour: &str, text: &str| {
        let mut page = Page::new(style);
        page.wrapped(&format!("{name}: "), text);
        page.text.replace_range(..=name.len(), &style.painted(colour, &format!("{name}:")));
        page.text
    };
    let one = |(k, Diagnostic { severity, message, advice, .. }): (usize, &Diagnostic)| {
        let colour = match severity {
            Severity::Error => RED,
            Severity::Warning => YELLOW,
            Severity::Note => CYAN,
        };
        let help = advice
            .as_ref()
            .filter(|help| list[k + 1..].iter().all(|next| next.advice.as_ref() != Some(*help)));
        painted(severity.name(), colour, message)
            + &help.map_or_else(String::new, |help| painted("help", CYAN, &help.to_string()))
    };
    list.iter().enumerate().map(one).collect()
}

/// The lines of a document without title and warnings.
pub fn lines(document: &Document, style: Style) -> Vec<String> {
    let mut page = Page::new(style);
    page.document(document);
    page.text.lines().map(str::to_owned).collect()
}

struct Page {
    text: String,
    style: Style,
    /// Columns of the names of rows.
    names: usize,
}

impl Page {
    fn new(style: Style) -> Self {
        let style = Style { columns: style.columns.max(NARROWEST), ..style };
        Self { text: String::new(), style, names: NAMES }
    }

    fn document(&mut self, document: &Document) {
        let rows =
            document.sections.iter().flat_map(|section| &section.parts).filter_map(|part| match part {
                SectionPart::Row { name, .. } => Some(name.chars().count()),
                _ => None,
            });
        self.names = rows.filter(|name| *name <= LONGEST_NAME).max().unwrap_or(0).max(NAMES);
        let is_shown = |section: &&Section| section.is_shown() && (self.style.details || !section.is_detail);
        let sections: Vec<&Section> = document.sections.iter().filter(is_shown).collect();
        for (k, section) in sections.into_iter().enumerate() {
            if k > 0 {
                self.text.push('\n');
            }
            if let Some(title) = &section.title {
                let title = self.style.painted(BOLD, &printable(title));
                self.text.extend([INDENT, &title, "\n"]);
            }
            for part in &section.parts {
                match part {
                    SectionPart::Row { name, value } => self.row(name, value),
                    SectionPart::Table(table) => self.table(table),
                    SectionPart::Paragraph(text) => self.wrapped(INDENT, text),
                }
            }
        }
    }

    /// A line with the printable form of `content`.
    fn line(&mut self, content: &str) {
        self.text.push_str(printable(content).trim_end());
        self.text.push('\n');
    }

    /// A name and its value; a space stands between the two, however long the name is.
    fn row(&mut self, name: &str, value: &str) {
        self.wrapped(&format!("{INDENT}{name:<width$} ", width = self.names), value);
    }

    /// A text after `first`; broken between words if it is too long, later lines indented by the width of
    /// `first`.
    fn wrapped(&mut self, first: &str, content: &str) {
        let indent = first.chars().count();
        if indent + content.chars().count() <= self.style.columns {
            return self.line(&format!("{first}{content}"));
        }
        let indent = indent.min(self.style.columns.saturating_sub(LEAST_TEXT));
        for (k, words) in broken(content, self.style.columns - indent).into_iter().enumerate() {
            let start = if k == 0 { first.to_owned() } else { " ".repeat(indent) };
            self.line(&format!("{start}{words}"));
        }
    }

    /// The columns that people see, numbers aligned to the right.
    fn table(&mut self, table: &Table) {
        let columns: Vec<(usize, &Column, &str)> = table
            .columns
            .iter()
            .enumerate()
            .filter_map(|(k, column)| column.title.as_deref().map(|title| (k, column, title)))
            .collect();
        if columns.is_empty() {
            return;
        }
        let head: Vec<String> = columns.iter().map(|(_, _, title)| (*title).to_owned()).collect();
        let shown = |row: &Vec<Cell>| -> Vec<String> {
            columns.iter().map(|(k, column, _)| printable(&column.shown(&row[*k]))).collect()
        };
        let rows: Vec<Vec<String>> = table.rows.iter().map(shown).collect();
        let mut widths: Vec<usize> = (0..columns.len())
            .map(|k| rows.iter().chain([&head]).map(|row| row[k].chars().count()).max().unwrap_or(0))
            .collect();
        let last = widths.len() - 1;
        let before =
            |widths: &[usize]| INDENT.len() + widths[..last].iter().map(|width| width + GAP).sum::<usize>();
        if before(&widths) + widths[last] > self.style.columns {
            // Headings of several words take several lines.
            for (k, width) in widths.iter_mut().enumerate() {
                let word = head[k].split_whitespace().map(|word| word.chars().count()).max().unwrap_or(0);
                *width = rows.iter().map(|row| row[k].chars().count()).fold(word, usize::max);
            }
        }
        let before = before(&widths);
        if before + widths[last] > self.style.columns {
            let room = self.style.columns.saturating_sub(before);
            if !columns[last].1.left || room < LEAST_TEXT {
                return self.cards(&head, &rows);
            }
            widths[last] = room;
        }
        for row in std::iter::once(&head).chain(&rows) {
            let cells: Vec<Vec<String>> =
                row.iter().zip(&widths).map(|(cell, width)| broken(cell, *width)).collect();
            let lines = cells.iter().map(Vec::len).max().unwrap_or(0);
            for number in 0..lines {
                let mut line = INDENT.to_owned();
                for (k, (cell, width)) in cells.iter().zip(&widths).enumerate() {
                    let words = cell.get(number).map_or("", String::as_str);
                    let padding = " ".repeat(width.saturating_sub(words.chars().count()));
                    let gap = " ".repeat(if k == last { 0 } else { GAP });
                    let left = columns[k].1.left;
                    line.extend(if left { [words, &padding, &gap] } else { [padding.as_str(), words, &gap] });
                }
                self.line(&line);
            }
        }
    }

    /// A table that is wider than the terminal: every row as lines of heading and value.
    fn cards(&mut self, head: &[String], rows: &[Vec<String>]) {
        for row in rows {
            for (k, (title, cell)) in
                head.iter().zip(row).enumerate().filter(|(_, (_, cell))| !cell.is_empty())
            {
                let indent = if k == 0 { "" } else { INDENT };
                let name = if title.is_empty() { String::new() } else { format!("{title}: ") };
                self.wrapped(&format!("{INDENT}{indent}{name}"), cell);
            }
        }
    }
}

/// A line, broken between words into lines of at most `columns` characters, those after the first indented.
pub fn folded(line: &str, columns: usize) -> String {
    let text = line.trim_start();
    let indent = &line[..line.len() - text.len()];
    let width = columns.saturating_sub(indent.len() + INDENT.len());
    if line.chars().count() <= columns {
        line.to_owned()
    } else {
        format!("{indent}{}", broken(text, width).join(&format!("\n{indent}{INDENT}")))
    }
}

/// A text in lines of at most `width` characters, broken between words; a longer word has its own line.
fn broken(text: &str, width: usize) -> Vec<String> {
    if text.chars().count() <= width {
        return vec![text.to_owned()];
    }
    let (mut lines, mut line) = (Vec::new(), String::new());
    for word in unbroken(text) {
        let used = line.chars().count();
        if used > 0 && used + 1 + word.chars().count() > width {
            lines.push(std::mem::take(&mut line));
        } else if used > 0 {
            line.push(' ');
        }
        line.push_str(&word);
    }
    lines.push(line);
    lines
}

/// The words of a text, a number together with the unit that follows it.
fn unbroken(text: &str) -> Vec<String> {
    const UNITS: [&str; 8] = ["%", "D", "mm", "cm", "in", "rad", "N", "σ"];
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let unit = word.trim_end_matches([',', ';', '.', ')', ':']);
        match words
            .last_mut()
            .filter(|before| UNITS.contains(&unit) && before.ends_with(|c: char| c.is_ascii_digit()))
        {
            Some(number) => {
                number.push(' ');
                number.push_str(word);
            }
            None => words.push(word.to_owned()),
        }
    }
    words
}
