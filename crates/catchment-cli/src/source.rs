//! Whatever is wrong with what a person gave, shown in its place.

use crate::failure::{Failure, diagnostic};
use catchment::design::{Finding, Findings, SourceText};
use catchment::poses::{TextError, read_text};
use catchment::problem::ProblemError;
use miette::{LabeledSpan, NamedSource, Report};
use std::fs::File;
use std::io;
use std::ops::Range;
use std::path::Path;

/// Reads the text of a table from a file, or from stdin for `-`.
pub(crate) fn read_table(path: &Path) -> Result<SourceText, Failure> {
    let stdin = path.as_os_str() == "-";
    let shown = if stdin { Path::new("stdin") } else { path };
    let name = printable(&shown.display().to_string());
    let read = if stdin {
        read_text(io::stdin().lock())
    } else {
        File::open(path).map_err(TextError::from).and_then(read_text)
    };
    read.map(|text| SourceText::new(shown, text)).map_err(|error| {
        let (message, help) = match &error {
            TextError::Read(_) => (format!("cannot read {name}: {error}"), None),
            TextError::TooLarge => (format!("{name} is {error}"), Some("split the table")),
            TextError::NotUtf8 { .. } => (format!("{name}, {error}"), Some("save it as UTF-8")),
        };
        Failure::with_help(message, help.map(ToOwned::to_owned))
    })
}

/// The finding as a report with the lines it is about. Where those are too long to show (a mesh written
/// on one line), it says their numbers instead.
fn report(source: Option<&SourceText>, finding: Finding) -> Report {
    let mut diagnostic = diagnostic(&finding.message, finding.help);
    let Some(source) = source else { return Report::new(diagnostic) };
    let name = printable(&source.path.display().to_string());
    let Some(span) = finding.span else {
        // What is said of an option is not said of the file.
        if !diagnostic.message.contains(&name) && !diagnostic.message.starts_with("--") {
            diagnostic.message = format!("{name}: {}", diagnostic.message);
        }
        return Report::new(diagnostic);
    };
    let span = first_line(&source.text, span);
    if is_too_wide_around(source, span.start) {
        let (line, column) = source.line_column(span.start);
        diagnostic.message = format!("{name}, line {line}, column {column}: {}", diagnostic.message);
        return Report::new(diagnostic);
    }
    diagnostic.labels = Some(vec![LabeledSpan::new_with_span(None, span)]);
    Report::new(diagnostic).with_source_code(NamedSource::new(name, printable(&source.text)))
}

/// A span that ends with the line it starts in.
fn first_line(text: &str, span: Range<usize>) -> Range<usize> {
    let end = text[span.start..].find(['\r', '\n']).map_or(text.len(), |at| span.start + at);
    span.start..span.end.min(end.max(span.start))
}

/// Whether the line of `byte`, or one beside it, is too long to show.
fn is_too_wide_around(source: &SourceText, byte: usize) -> bool {
    const WIDEST: usize = 300;
    let (line, _) = source.line_column(byte);
    source.text.lines().skip(line.saturating_sub(2)).take(3).any(|line| line.len() > WIDEST)
}

/// The text with control characters replaced, byte for byte: a file must not steer the terminal. A return to the start of the
/// line is left at the end of a line only, as it is in files of Windows.
fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '\n' | '\t' => shown.push(c),
            '\r' if rest.peek() == Some(&'\n') => shown.push(c),
            _ if catchment::report::steers(c) => shown.extend(std::iter::repeat_n('?', c.len_utf8())),
            _ => shown.push(c),
        }
    }
    shown
}

impl Failure {
    /// Everything that is wrong with a text, each in its place.
    pub(crate) fn of_findings(findings: Findings) -> Self {
        let Findings { source, list, omitted } = findings;
        let count = list.len() + omitted;
        let shown = if omitted > 0 {
            format!(", of which the first {} are shown", list.len())
        } else {
            String::new()
        };
        let place = source.as_ref().map(|source| printable(&source.path.display().to_string()));
        let closing = place.filter(|_| count > 1).map(|place| format!("{count} problems in {place}{shown}"));
        Self::many(list.into_iter().map(|finding| report(source.as_ref(), finding)).collect(), closing)
    }
}

impl Failure {
    /// Why there is no problem to decide.
    pub(crate) fn of_problem(error: ProblemError) -> Self {
        match error {
            ProblemError::Load(error) => Self::with_help(error.to_string(), None),
            ProblemError::Findings(findings) => Self::of_findings(findings),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, span: Range<usize>) -> String {
        let finding = Finding { message: "wrong".to_owned(), help: None, span: Some(span) };
        format!("{:?}", report(Some(&SourceText::new("d.toml", text)), finding))
    }

    #[test]
    fn long_lines_and_long_spans_are_not_printed() {
        let wide = format!("a = 1\npieces = [{}]\n", "[0, 0, 0], ".repeat(1000));
        assert!(shown(&wide, 10..20).contains("line 2, column 5: wrong"));
        assert!(shown(&wide, 10..20).len() < 200);
        let tall = "pieces = [\n".to_owned() + &"[0, 0, 0],\n".repeat(1000);
        assert!(shown(&tall, 9..tall.len()).len() < 500);
    }

    #[test]
    fn control_characters_keep_their_width_but_not_their_power() {
        assert_eq!(printable("a\x1b[2J\u{9b}\tµ\r\n"), "a?[2J??\tµ\r\n");
        assert_eq!(printable("mine\r\ryours\r\n"), "mine??yours\r\n");
    }

    #[test]
    fn a_span_at_the_end_of_the_text_is_shown() {
        assert!(shown("a =", 3..3).contains("wrong"));
        assert!(shown("a =\n", 4..4).contains("wrong"));
    }
}
