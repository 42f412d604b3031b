//! Errors, as exceptions of the package: diagnostics with their places and advice.

use catchment::diagnostic::{Advice, Advised, Diagnostic, Diagnostics, SourceText};
use catchment::exec::Cancelled;
use catchment::landscape::ResolutionError;
use catchment::method::{MethodError, NotApplicable};
use catchment::problem::ProblemError;
use catchment::run::RunError;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::any::Any;
use std::error::Error;

/// An error, by its cause.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// The text of the design.
    Design(Diagnostics),
    /// The geometry of the design.
    Geometry(Diagnostics),
    /// An argument of a call.
    Argument(Diagnostics),
    /// The memory budget is too small; with advice.
    Memory(String),
    /// There is no result.
    Compute(String),
    /// The computation was cancelled.
    Cancelled,
}

impl Refusal {
    /// An argument is invalid.
    pub(crate) fn argument(name: &str, message: impl ToString) -> Self {
        Self::Argument(Diagnostic::error("argument", message.to_string(), None).prefixed(name).into())
    }

    /// All errors in the text of an argument.
    pub(crate) fn of_argument(name: &str, diagnostics: Diagnostics) -> Self {
        let list = diagnostics.list.into_iter().map(|diagnostic| diagnostic.prefixed(name)).collect();
        Self::Argument(Diagnostics { list, ..diagnostics })
    }

    /// The problem was read, but cannot be built.
    pub(crate) fn of_geometry(error: ProblemError) -> Self {
        match error {
            ProblemError::Diagnostics(diagnostics) => Self::Geometry(diagnostics),
            error @ ProblemError::Load(_) => error.into(),
        }
    }

    /// The Python exception of this error.
    pub(crate) fn raise(self, py: Python<'_>) -> PyErr {
        let (class, diagnostics, message) = match self {
            Self::Cancelled => return PyKeyboardInterrupt::new_err(()),
            Self::Design(diagnostics) => ("DesignError", Some(diagnostics), String::new()),
            Self::Geometry(diagnostics) => ("GeometryError", Some(diagnostics), String::new()),
            Self::Argument(diagnostics) => ("ArgumentError", Some(diagnostics), String::new()),
            Self::Memory(message) => ("MemoryLimitError", None, message),
            Self::Compute(message) => ("ComputeError", None, message),
        };
        match exception(py, class, diagnostics, message) {
            Ok(exception) => PyErr::from_value(exception),
            Err(error) => error,
        }
    }
}

/// A diagnostic of `catchment._errors`: message, advice, line, column, severity and code.
pub(crate) type Fields = (String, Option<String>, Option<usize>, Option<usize>, &'static str, String);

/// The fields of a diagnostic, whose place is in `source`.
pub(crate) fn fields(diagnostic: &Diagnostic, source: Option<&SourceText>) -> Fields {
    let span = diagnostic.span.as_ref();
    let (line, column) = span.zip(source).map(|(span, source)| source.line_column(span.start)).unzip();
    let Diagnostic { severity, code, message, .. } = diagnostic;
    (message.clone(), diagnostic.help(), line, column, severity.name(), code.to_string())
}

/// `class(message, diagnostics, omitted, path)` of `catchment._errors`.
fn exception<'py>(
    py: Python<'py>,
    class: &str,
    diagnostics: Option<Diagnostics>,
    message: String,
) -> PyResult<Bound<'py, PyAny>> {
    let class = py.import("catchment._errors")?.getattr(class)?;
    let Some(diagnostics) = diagnostics else { return class.call1((message,)) };
    let message = diagnostics.to_string();
    let path = diagnostics.path().map(|path| path.display().to_string());
    let source = diagnostics.source.as_ref();
    let list: Vec<Fields> = diagnostics.list.iter().map(|diagnostic| fields(diagnostic, source)).collect();
    class.call1((message, list, diagnostics.omitted, path))
}

impl<E: Error + 'static> From<E> for Refusal {
    fn from(error: E) -> Self {
        let mut error = Some(error);
        if let Some(problem) = taken::<_, ProblemError>(&mut error) {
            return match problem {
                ProblemError::Diagnostics(diagnostics) => Self::Design(diagnostics),
                ProblemError::Load(error) => {
                    Self::Design(Diagnostic::error("design", error.to_string(), None).into())
                }
            };
        }
        if let Some(diagnostics) = taken::<_, Diagnostics>(&mut error) {
            return Self::Argument(diagnostics);
        }
        if taken::<_, Cancelled>(&mut error).is_some() {
            return Self::Cancelled;
        }
        if let Some(error) = taken::<_, RunError>(&mut error) {
            return match error {
                RunError::NotHeld(diagnostics) => Self::Geometry(diagnostics),
                RunError::NotApplicable(error) => Self::argument("method", error),
                RunError::Resolution(error) => Self::argument("resolution", error),
                RunError::Cancelled(_) => Self::Cancelled,
                error => explained(&error),
            };
        }
        if let Some(error) = taken::<_, NotApplicable>(&mut error) {
            return Self::argument("method", error);
        }
        if let Some(error) = taken::<_, MethodError>(&mut error) {
            return Self::argument("method", error);
        }
        if let Some(error) = taken::<_, ResolutionError>(&mut error) {
            return Self::argument("resolution", error);
        }
        error.map_or(Self::Cancelled, |error| explained(&error))
    }
}

/// An error without a place: its message, and the messages of its causes that it does not repeat.
fn explained(error: &(dyn Error + 'static)) -> Refusal {
    let mut message = error.to_string();
    let mut is_memory = false;
    let mut cause = Some(error);
    while let Some(error) = cause {
        let stated = error.to_string();
        if !message.contains(&stated) {
            message = format!("{message}: {stated}");
        }
        is_memory |=
            error.downcast_ref::<Advised>().is_some_and(|advised| advised.0.contains(&Advice::MoreMemory));
        cause = error.source();
    }
    if is_memory { Refusal::Memory(message) } else { Refusal::Compute(message) }
}

/// Takes the error if it is a `T`.
fn taken<E: 'static, T: 'static>(error: &mut Option<E>) -> Option<T> {
    (error as &mut dyn Any).downcast_mut::<Option<T>>().and_then(Option::take)
}
