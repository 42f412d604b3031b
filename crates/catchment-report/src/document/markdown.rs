//! A document as Markdown, for notes, issues and pages.

use super::{Described, in_a_line};
use catchment_core::document::{Section, SectionPart, Table};
use catchment_core::terminal::printable;
use std::fmt::Write;

/// A document as GitHub's Markdown; ends with a line break.
pub fn markdown(described: &Described<'_>) -> String {
    let mut text = format!("# {}\n", escaped(&described.title));
    for section in &described.document.sections {
        if let Some(title) = &section.title {
            // Writing to a String cannot fail, here and below.
            let _ = write!(text, "\n## {}\n", escaped(title));
        }
        parts(&mut text, section);
    }
    for warning in &described.warnings {
        let [severity, words] = in_a_line(warning);
        let _ = write!(text, "\n> **{severity}** {}\n", escaped(&words));
    }
    text
}

fn parts(text: &mut String, section: &Section) {
    let mut in_rows = false;
    for part in &section.parts {
        if let SectionPart::Row { name, value } = part {
            if !in_rows {
                text.push_str("\n| | |\n|---|---|\n");
            }
            let name = if name.is_empty() { String::new() } else { format!(" {}", escaped(name.trim())) };
            let _ = writeln!(text, "|{name} | {} |", escaped(value));
        }
        in_rows = matches!(part, SectionPart::Row { .. });
        match part {
            SectionPart::Table(shown) if shown.is_shown() => table(text, shown),
            SectionPart::Paragraph(words) => {
                let _ = write!(text, "\n{}\n", escaped(words));
            }
            _ => {}
        }
    }
}

fn table(text: &mut String, table: &Table) {
    let columns: Vec<_> = table.columns.iter().enumerate().filter(|(_, c)| c.title.is_some()).collect();
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    text.push('\n');
    text.push_str(&line(
        columns.iter().map(|(_, column)| escaped(column.title.as_deref().unwrap_or_default())).collect(),
    ));
    let rules = columns.iter().map(|(_, column)| if column.left { ":--" } else { "--:" });
    let _ = writeln!(text, "|{}|", rules.collect::<Vec<_>>().join("|"));
    for row in &table.rows {
        text.push_str(&line(columns.iter().map(|(k, column)| escaped(&column.shown(&row[*k]))).collect()));
    }
}

/// Text in which nothing is Markdown.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in printable(text).chars() {
        if matches!(c, '|' | '<' | '>' | '*' | '_' | '`' | '\\' | '#') {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}
