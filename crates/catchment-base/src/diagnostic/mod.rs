//! Every error of an input and every warning or note about a result, as data for any front end.
//!
//! ```text
//!   reader ──▶ Diagnostic { severity, code, message, advice, span } ──▶ terminal, JSON, Python, page
//!   method ──▶ Warning { numbers } ──▶ Diagnostic
//! ```
//!
//! An error has the code of its family, such as `design` or `mated-pose`; a [`Warning`] has its own. Codes are
//! stable, sentences are not. A front end phrases [`Advice`] with its own controls.

mod advice;
mod list;
mod warning;

pub use advice::{Advice, Advised};
pub use list::{DiagnosticCollector, Diagnostics, FilesInMemory, SourceText, line_column};
pub use warning::Warning;

use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

/// How much a diagnostic matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// There is no result.
    Error,
    /// A result may be wrong or incomplete.
    Warning,
    /// A choice that the program made.
    Note,
}

impl Severity {
    /// The lower-case name used in text and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
}

/// An error of an input, or a warning or note about a result. A stored warning of a kind that this version
/// does not know is read as a [`Warning::Note`] with its sentence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(from = "Stored")]
pub struct Diagnostic {
    /// How much it matters.
    pub severity: Severity,
    /// Its stable code, in kebab case.
    pub code: Cow<'static, str>,
    /// Its description, a sentence or several.
    pub message: String,
    /// Advice, as words.
    #[serde(rename = "help")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    pub advice: Option<Advice>,
    /// The numbers of a warning, with its `kind`.
    #[serde(rename = "warning", skip_serializing_if = "Option::is_none")]
    pub facts: Option<Box<Warning>>,
    /// Byte range in the text to which it refers, if any.
    #[serde(skip)]
    pub span: Option<Range<usize>>,
}

impl Diagnostic {
    /// An error of a family, without a place.
    pub fn error(code: &'static str, message: impl Into<String>, help: Option<String>) -> Self {
        Self { advice: help.map(Advice::Words), ..Self::of(Severity::Error, code, message.into()) }
    }

    /// A warning that is only a sentence.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        let text: String = message.into();
        let facts = Some(Box::new(Warning::Note { text: text.clone() }));
        Self { facts, ..Self::of(Severity::Warning, code, text) }
    }

    /// A note.
    pub fn note(code: &'static str, message: impl Into<String>) -> Self {
        Self::of(Severity::Note, code, message.into())
    }

    const fn of(severity: Severity, code: &'static str, message: String) -> Self {
        Self { severity, code: Cow::Borrowed(code), message, advice: None, facts: None, span: None }
    }

    /// The same with advice.
    #[must_use]
    pub fn with(mut self, advice: Advice) -> Self {
        self.advice = Some(advice);
        self
    }

    /// The same at a place.
    #[must_use]
    pub fn at(mut self, span: Option<Range<usize>>) -> Self {
        self.span = span.filter(|span| !span.is_empty());
        self
    }

    /// The same, of an option, an argument or a row.
    #[must_use]
    pub fn prefixed(self, of: &str) -> Self {
        Self { message: format!("{of}: {}", self.message), ..self }
    }

    /// The same, with its advice in the words of a front end; without it where that has none.
    #[must_use]
    pub fn worded(&self, words: impl Fn(&Advice) -> Option<String>) -> Self {
        Self { advice: self.advice.as_ref().and_then(words).map(Advice::Words), ..self.clone() }
    }

    /// Its advice, in words that fit any front end.
    pub fn help(&self) -> Option<String> {
        self.advice.as_ref().map(ToString::to_string)
    }
}

/// `message; help`
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        self.advice.as_ref().map_or(Ok(()), |help| write!(f, "; {help}"))
    }
}

impl From<Warning> for Diagnostic {
    fn from(warning: Warning) -> Self {
        let (code, message, advice) = (warning.code(), warning.to_string(), warning.advice());
        Self { advice, facts: Some(Box::new(warning)), ..Self::of(Severity::Warning, code, message) }
    }
}

/// Whether it has these numbers.
impl PartialEq<Warning> for Diagnostic {
    fn eq(&self, warning: &Warning) -> bool {
        self.facts.as_deref() == Some(warning)
    }
}

/// A diagnostic of a report; one of an older version has a warning and a message alone.
#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct Stored {
    #[serde(default)]
    severity: Option<Severity>,
    #[serde(default)]
    code: Option<String>,
    message: String,
    #[serde(default)]
    help: Option<String>,
    #[serde(default)]
    warning: Option<serde_json::Value>,
}

impl From<Stored> for Diagnostic {
    fn from(Stored { severity, code, message, help, warning }: Stored) -> Self {
        let sentence = || Warning::Note { text: message.clone() };
        let known = match warning {
            Some(facts) => Self::from(serde_json::from_value(facts).unwrap_or_else(|_| sentence())),
            None => Self { facts: None, ..Self::from(sentence()) },
        };
        Self {
            severity: severity.unwrap_or(known.severity),
            code: code.map_or_else(|| known.code.clone(), Cow::Owned),
            message,
            advice: known.advice.clone().or_else(|| help.map(Advice::Words)),
            ..known
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// A warning of every kind.
    fn warnings() -> Vec<Warning> {
        let (cells, of, text, ci95) = (1, 2, "it is so".to_owned(), [0.0, 1.0]);
        vec![
            Warning::TouchesBorder { axes: vec!["x".to_owned()] },
            Warning::Undecided { cells },
            Warning::UndecidedSample { motions: 1, of },
            Warning::FloodingBias,
            Warning::LevelGround { cells, of },
            Warning::CutOff,
            Warning::OutsideSample { sum_grid: 0.5, ci95 },
            Warning::NoInterval,
            Warning::Ambiguous { cells, of },
            Warning::StepDependence { changed: 1, of, ci95 },
            Warning::DissertationConventions,
            Warning::MatedPoseNotAccepted,
            Warning::Open { text: text.clone() },
            Warning::Note { text },
        ]
    }

    #[test]
    fn every_kind_of_warning_has_a_code_of_its_own_which_is_its_kind() {
        let codes: BTreeSet<&str> = warnings().iter().map(Warning::code).collect();
        assert_eq!(codes.len(), warnings().len());
        for warning in warnings() {
            let diagnostic = Diagnostic::from(warning.clone());
            let json = serde_json::to_value(&diagnostic).unwrap();
            assert_eq!((&json["code"], &json["severity"]), (&json["warning"]["kind"], &"warning".into()));
            assert_eq!(serde_json::from_value::<Diagnostic>(json).unwrap(), diagnostic);
            assert!(diagnostic == warning);
        }
    }

    #[test]
    fn a_sentence_keeps_its_code_and_advice() {
        let loose = Diagnostic::warning("loose", "it lies loose").with(Advice::Words("turn it".to_owned()));
        let json = serde_json::to_value(&loose).unwrap();
        assert_eq!(json["warning"], serde_json::json!({ "kind": "note", "text": "it lies loose" }));
        assert_eq!((&json["code"], &json["help"]), (&"loose".into(), &"turn it".into()));
        assert_eq!(serde_json::from_value::<Diagnostic>(json).unwrap(), loose);
        let note = Diagnostic::note("mirror-image", "the half is mirrored");
        assert_eq!(serde_json::from_str::<Diagnostic>(&serde_json::to_string(&note).unwrap()).unwrap(), note);
    }

    #[test]
    fn older_reports_have_neither_code_nor_severity() {
        let read = |text: &str| serde_json::from_str::<Diagnostic>(text).unwrap();
        let old = read(r#"{"warning": {"kind": "flooding-bias"}, "message": "as it was worded"}"#);
        assert_eq!(
            (&*old.code, &*old.message, old.severity),
            ("flooding-bias", "as it was worded", Severity::Warning)
        );
        let foreign = read(r#"{"warning": {"kind": "moon"}, "message": "the moon is full"}"#);
        assert!(foreign == Warning::Note { text: "the moon is full".to_owned() });
    }
}
