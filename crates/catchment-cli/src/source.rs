//! Reading of user input, and reports of its defects in place.

use crate::exit::ExitStatus;
use crate::failure::{self, Failure};
use catchment::design::{LARGEST_FILE, LoadError, SourceText, load};
use catchment::diagnostic::{Diagnostic, Diagnostics};
use catchment::poses::{TextError, read_text};
use catchment::problem::{Draft, Problem, ProblemError};
use catchment::terminal::{shown, steers};
use miette::{LabeledSpan, MietteError, MietteSpanContents, Report, SourceCode, SourceSpan, SpanContents};
use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;
use std::sync::OnceLock;

/// Whether a path stands for stdin or stdout; a file of that name is `./-`.
pub(crate) fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The name of stdin in messages.
const STDIN: &str = "stdin";

/// The design from stdin: it is read once and kept for later reads.
static DESIGN: OnceLock<String> = OnceLock::new();

/// Reads the text of a design file, or of stdin for `-`; paths in stdin are relative to the current folder.
pub(crate) fn read_design(path: &Path) -> Result<SourceText, ProblemError> {
    if !is_stream(path) {
        return Ok(SourceText::new(path, load(path)?));
    }
    let named = Path::new(STDIN);
    if DESIGN.get().is_none() {
        // The first reader stores it.
        let _ = DESIGN.set(text_of_design(io::stdin().lock(), named)?);
    }
    let text = DESIGN.get().cloned().unwrap_or_default();
    Ok(SourceText::new(named, text))
}

/// Reads the text of a design under the rules of [`load`] for files.
fn text_of_design(from: impl Read, named: &Path) -> Result<String, LoadError> {
    let path = || named.to_path_buf();
    let mut bytes = Vec::new();
    let read = from.take(LARGEST_FILE as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|source| LoadError::Io { path: path(), source })?;
    if bytes.len() > LARGEST_FILE {
        return Err(LoadError::TooLarge { path: path() });
    }
    let text = String::from_utf8(bytes)
        .map_err(|error| LoadError::NotText { path: path(), offset: error.utf8_error().valid_up_to() })?;
    if text.trim().is_empty() { Err(LoadError::Empty { path: path() }) } else { Ok(text) }
}

/// Reads a design file, or stdin for `-`.
pub(crate) fn open_design(path: &Path) -> Result<Problem, ProblemError> {
    Draft::read(read_design(path)?)?.build()
}

/// Reads the text of a table from a file, or from stdin for `-`.
pub(crate) fn read_table(path: &Path) -> Result<SourceText, Failure> {
    let stdin = is_stream(path);
    if stdin && DESIGN.get().is_some() {
        let help = "give the design or the table as a file".to_owned();
        return Err(Failure::with_help(
            "stdin is read once, and the design came from it".to_owned(),
            Some(help),
        ));
    }
    let named = if stdin { Path::new(STDIN) } else { path };
    let name = shown(named);
    let read = if stdin {
        read_text(io::stdin().lock())
    } else {
        File::open(path).map_err(TextError::from).and_then(read_text)
    };
    read.map(|text| SourceText::new(named, text)).map_err(|error| {
        let (message, help, status) = match &error {
            TextError::Read(_) => (format!("cannot read {name}: {error}"), None, ExitStatus::NoSuchFile),
            TextError::TooLarge => {
                (format!("{name} is {error}"), Some("split the table"), ExitStatus::BadInput)
            }
            TextError::NotUtf8 { .. } => {
                (format!("{name}, {error}"), Some("save it as UTF-8"), ExitStatus::BadInput)
            }
        };
        Failure::with_help(message, help.map(ToOwned::to_owned)).ends(status)
    })
}

/// The diagnostic as a report with the affected lines. If these are too long to show (a mesh written on one
/// line), the report has the line and column numbers instead.
fn report(source: Option<&SourceText>, diagnostic: Diagnostic) -> Report {
    let mut labelled = failure::report(&diagnostic);
    let Some(source) = source else { return Report::new(labelled) };
    let name = shown(&source.path).to_string();
    let Some(span) = diagnostic.span else {
        // A diagnostic about an option does not concern the file.
        if !labelled.message.contains(&name) && !labelled.message.starts_with("--") {
            labelled.message = format!("{name}: {}", labelled.message);
        }
        return Report::new(labelled);
    };
    let span = first_line(&source.text, span);
    let lines = around(&source.text, span.start);
    if source.text[lines.clone()].lines().any(|line| line.len() > WIDEST) {
        let (line, column) = source.line_column(span.start);
        labelled.message = format!("{name}, line {line}, column {column}: {}", labelled.message);
        return Report::new(labelled);
    }
    let label = span.start - lines.start..span.end - lines.start;
    labelled.labels = Some(vec![LabeledSpan::new_with_span(None, label)]);
    let before = source.line_column(lines.start).0 - 1;
    Report::new(labelled).with_source_code(Excerpt { name, text: printable(&source.text[lines]), before })
}

/// Longest line shown, in bytes.
const WIDEST: usize = 300;

/// An excerpt of a text and the number of lines before it: the cost of display is independent of the length
/// of the text.
#[derive(Debug)]
struct Excerpt {
    name: String,
    text: String,
    before: usize,
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let read = self.text.read_span(span, lines_before, lines_after)?;
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            read.data(),
            *read.span(),
            self.before + read.line(),
            read.column(),
            read.line_count(),
        )))
    }
}

/// Truncates a span to its first line.
fn first_line(text: &str, span: Range<usize>) -> Range<usize> {
    let end = text[span.start..].find(['\r', '\n']).map_or(text.len(), |at| span.start + at);
    span.start..span.end.min(end.max(span.start))
}

/// The line of `byte` with the neighbouring lines.
fn around(text: &str, byte: usize) -> Range<usize> {
    let start_of = |byte: usize| text[..byte].rfind('\n').map_or(0, |at| at + 1);
    let end_of = |byte: usize| text[byte..].find('\n').map_or(text.len(), |at| byte + at + 1);
    start_of(start_of(byte).saturating_sub(1))..end_of(end_of(byte))
}

/// The text with control characters replaced, byte for byte: a file must not control the terminal. A carriage
/// return is kept only at the end of a line, as in Windows files.
fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '\n' | '\t' => shown.push(c),
            '\r' if rest.peek() == Some(&'\n') => shown.push(c),
            _ if steers(c) => shown.extend(std::iter::repeat_n('?', c.len_utf8())),
            _ => shown.push(c),
        }
    }
    shown
}

impl Failure {
    /// All diagnostics about a text, each in its place.
    pub(crate) fn of_diagnostics(diagnostics: Diagnostics) -> Self {
        let Diagnostics { source, mut list, omitted } = diagnostics;
        let count = list.len() + omitted;
        list.truncate(Diagnostics::MOST);
        let part = if count > list.len() {
            format!(", of which the first {} are shown", list.len())
        } else {
            String::new()
        };
        let place = source.as_ref().map(|source| shown(&source.path));
        let closing = place.filter(|_| count > 1).map(|place| format!("{count} problems in {place}{part}"));
        // If options override the design, the defect may lie in an option.
        let is_of_options = list.iter().all(|diagnostic| diagnostic.message.starts_with("--"));
        let status = if is_of_options { ExitStatus::Usage } else { ExitStatus::BadInput };
        let reports = list.into_iter().map(|diagnostic| report(source.as_ref(), diagnostic)).collect();
        Self::many(reports, closing, status)
    }
}

impl Failure {
    /// The error that prevents a problem from being built.
    pub(crate) fn of_problem(error: ProblemError) -> Self {
        match error {
            ProblemError::Load(error) => Self::explained(&error, None),
            ProblemError::Diagnostics(diagnostics) => Self::of_diagnostics(diagnostics),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, span: Range<usize>) -> String {
        let diagnostic = Diagnostic { span: Some(span), ..Diagnostic::error("design", "wrong", None) };
        format!("{:?}", report(Some(&SourceText::new("d.toml", text)), diagnostic))
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
    fn a_long_text_is_shown_by_the_lines_around() {
        let text = "a = 1\n".repeat(20_000);
        let words = shown(&text, 6 * 10_000..6 * 10_000 + 1);
        for line in ["d.toml:10001:1", "10000 │ a = 1", "10001 │ a = 1", "10002 │ a = 1"] {
            assert!(words.contains(line), "{words}");
        }
        assert!(!words.contains("10003") && !words.contains("9999 "), "{words}");
        let few = "a\nb\nc\nd";
        for (at, lines) in [(0, "a\nb\n"), (2, "a\nb\nc\n"), (4, "b\nc\nd"), (6, "c\nd"), (7, "c\nd")] {
            assert_eq!(&few[around(few, at)], lines, "{at}");
        }
    }

    #[test]
    fn the_first_diagnostics_are_shown_and_all_are_counted() {
        let diagnostic = |k: usize| Diagnostic::error("design", format!("wrong {k}"), None).at(Some(0..1));
        let list = (0..50).map(diagnostic).collect();
        let source = Some(SourceText::new("d.toml", "a = 1\n"));
        let failure = Failure::of_diagnostics(Diagnostics { source, list, omitted: 7 });
        assert_eq!(failure.text().lines().count(), Diagnostics::MOST);
        assert!(format!("{failure:?}").contains("57 problems in d.toml, of which the first 20 are shown"));
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
