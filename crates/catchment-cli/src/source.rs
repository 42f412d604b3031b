//! A design file with its text at hand, so that whatever is wrong with it can be shown in place.

use crate::failure::Failure;
use catchment::design::{Design, LoadError, Sources, line_column, load, read};
use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The text of a design file.
#[derive(Debug, Clone)]
pub(crate) struct SourceText {
    path: PathBuf,
    text: String,
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
        let source = SourceText { path: path.to_path_buf(), text };
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

    /// A finding about `place` (such as `connector.fixed.pieces[2]`), or what the file mentions around it.
    pub(crate) fn finding(&self, place: &str, message: String, help: Option<String>) -> Finding {
        Finding { message, help, span: self.sources.span(place).filter(|span| !span.is_empty()) }
    }
}

impl SourceText {
    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Line and column of a byte, from 1.
    pub(crate) fn line_column(&self, byte: usize) -> (usize, usize) {
        line_column(&self.text, byte)
    }

    /// The finding as a report with the lines it is about.
    pub(crate) fn report(&self, finding: Finding) -> Report {
        let mut diagnostic = MietteDiagnostic::new(finding.message);
        diagnostic.help = finding.help;
        diagnostic.labels = finding.span.map(|span| vec![LabeledSpan::new_with_span(None, span)]);
        let name = self.path.display().to_string();
        Report::new(diagnostic).with_source_code(NamedSource::new(name, self.text.clone()))
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        match error {
            InputError::Load(error) => Self::with_help(error.to_string(), None),
            InputError::Findings { source, findings, omitted } => {
                let count = findings.len() + omitted;
                let noun = if count == 1 { "problem" } else { "problems" };
                let shown = if omitted > 0 {
                    format!(", of which the first {} are shown", findings.len())
                } else {
                    String::new()
                };
                let closing = format!("{count} {noun} in {}{shown}", source.path.display());
                Self::many(findings.into_iter().map(|finding| source.report(finding)).collect(), closing)
            }
        }
    }
}
