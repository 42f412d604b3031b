//! A design file with its text at hand, so that whatever is wrong with it can be shown in place.

use crate::failure::Failure;
use catchment::design::{Design, LoadError, Sources, line_column, load, read};
use catchment::poses::{Refusal, TextError, read_text};
use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};
use std::fs::File;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The text of a design file.
#[derive(Debug, Clone)]
pub(crate) struct SourceText {
    path: PathBuf,
    text: String,
    /// The text as it may be shown, shared by all reports.
    shown: Arc<String>,
}

/// A design file that was read.
#[derive(Debug)]
pub(crate) struct Input {
    /// What it says.
    pub design: Design,
    /// Where it says it.
    pub sources: Sources,
    /// Its text.
    pub source: SourceText,
}

/// Something wrong with a design, whichever room found it.
#[derive(Debug)]
pub(crate) struct Finding {
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// The bytes of the file it is about, where there are any.
    pub span: Option<Range<usize>>,
}

/// Why a path does not lead to a good design.
#[derive(Debug)]
pub(crate) enum InputError {
    /// There is no text.
    Load(LoadError),
    /// There is something wrong with what the text says.
    Findings {
        /// The text.
        source: SourceText,
        /// What is wrong with it.
        findings: Vec<Finding>,
        /// How many more there are.
        omitted: usize,
    },
}

impl Input {
    /// Reads a design file.
    pub(crate) fn read(path: &Path) -> Result<Self, InputError> {
        let text = load(path).map_err(InputError::Load)?;
        let source = SourceText::new(path, text);
        match read(&source.text, path.parent().unwrap_or_else(|| Path::new(""))) {
            Ok(file) => Ok(Self { design: file.design, sources: file.sources, source }),
            Err(problems) => {
                let findings = problems.list.into_iter().map(|problem| Finding {
                    message: problem.complaint.to_string(),
                    help: problem.complaint.help(),
                    span: Some(problem.span),
                });
                Err(InputError::Findings { source, findings: findings.collect(), omitted: problems.omitted })
            }
        }
    }

    /// This design, refused for what was found.
    pub(crate) fn refused(self, findings: Vec<Finding>) -> InputError {
        InputError::Findings { source: self.source, findings, omitted: 0 }
    }

    /// A finding about `place` (such as `connector.fixed.pieces[2]`), or what the file mentions around it.
    pub(crate) fn finding(&self, place: &str, message: String, help: Option<String>) -> Finding {
        Finding { message, help, span: self.sources.span(place).filter(|span| !span.is_empty()) }
    }
}

impl SourceText {
    /// A text and the name to show it under.
    pub(crate) fn new(path: &Path, text: String) -> Self {
        Self { path: path.to_path_buf(), shown: Arc::new(printable(&text)), text }
    }

    /// Reads the text of a table from a file, or from stdin for `-`.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let stdin = path.as_os_str() == "-";
        let shown = if stdin { Path::new("stdin") } else { path };
        let name = printable(&shown.display().to_string());
        let read = if stdin {
            read_text(io::stdin().lock())
        } else {
            File::open(path).map_err(TextError::from).and_then(read_text)
        };
        read.map(|text| Self::new(shown, text)).map_err(|error| {
            let (message, help) = match &error {
                TextError::Read(_) => (format!("cannot read {name}: {error}"), None),
                TextError::TooLarge => (format!("{name} is {error}"), Some("split the table")),
                TextError::NotUtf8 { .. } => (format!("{name}, {error}"), Some("save it as UTF-8")),
            };
            Failure::with_help(message, help.map(ToOwned::to_owned))
        })
    }

    /// This text, refused for what is wrong with it.
    pub(crate) fn refused(&self, refusal: Refusal) -> InputError {
        let findings = refusal.list.into_iter().map(|objection| Finding {
            message: objection.message,
            help: objection.help,
            span: objection.span,
        });
        InputError::Findings { source: self.clone(), findings: findings.collect(), omitted: refusal.omitted }
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The text.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Line and column of a byte, from 1.
    pub(crate) fn line_column(&self, byte: usize) -> (usize, usize) {
        line_column(&self.text, byte)
    }

    /// The finding as a report with the lines it is about. Where those are too long to show (a mesh written
    /// on one line), it says their numbers instead.
    pub(crate) fn report(&self, finding: Finding) -> Report {
        let mut diagnostic = MietteDiagnostic::new(finding.message);
        diagnostic.help = finding.help;
        let Some(span) = finding.span.map(|span| self.first_line(span)) else {
            return Report::new(diagnostic);
        };
        if self.is_too_wide_around(span.start) {
            let (line, column) = self.line_column(span.start);
            diagnostic.message = format!("line {line}, column {column}: {}", diagnostic.message);
            return Report::new(diagnostic);
        }
        diagnostic.labels = Some(vec![LabeledSpan::new_with_span(None, span)]);
        let name = printable(&self.path.display().to_string());
        Report::new(diagnostic).with_source_code(NamedSource::new(name, Arc::clone(&self.shown)))
    }

    /// A span that ends with the line it starts in.
    fn first_line(&self, span: Range<usize>) -> Range<usize> {
        let end = self.text[span.start..].find(['\r', '\n']).map_or(self.text.len(), |at| span.start + at);
        span.start..span.end.min(end.max(span.start))
    }

    /// Whether the line of `byte`, or one beside it, is too long to show.
    fn is_too_wide_around(&self, byte: usize) -> bool {
        const WIDEST: usize = 300;
        let (line, _) = self.line_column(byte);
        self.text.lines().skip(line.saturating_sub(2)).take(3).any(|line| line.len() > WIDEST)
    }
}

/// The text with control characters replaced, byte for byte: a file must not steer the terminal.
fn printable(text: &str) -> String {
    text.chars().fold(String::with_capacity(text.len()), |mut shown, c| {
        if c.is_control() && !matches!(c, '\n' | '\r' | '\t') {
            shown.extend(std::iter::repeat_n('?', c.len_utf8()));
        } else {
            shown.push(c);
        }
        shown
    })
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        match error {
            InputError::Load(error) => Self::with_help(error.to_string(), None),
            InputError::Findings { source, findings, omitted } => {
                let count = findings.len() + omitted;
                let shown = if omitted > 0 {
                    format!(", of which the first {} are shown", findings.len())
                } else {
                    String::new()
                };
                let closing = (count > 1).then(|| {
                    format!("{count} problems in {}{shown}", printable(&source.path.display().to_string()))
                });
                Self::many(findings.into_iter().map(|finding| source.report(finding)).collect(), closing)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> SourceText {
        SourceText::new(Path::new("d.toml"), text.to_owned())
    }

    fn shown(text: &str, span: Range<usize>) -> String {
        let finding = Finding { message: "wrong".to_owned(), help: None, span: Some(span) };
        format!("{:?}", source(text).report(finding))
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
    }

    #[test]
    fn a_span_at_the_end_of_the_text_is_shown() {
        assert!(shown("a =", 3..3).contains("wrong"));
        assert!(shown("a =\n", 4..4).contains("wrong"));
    }
}
