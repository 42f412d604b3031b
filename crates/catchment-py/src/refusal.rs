//! Why something is refused, as an exception of the package: facts with their places and advice.

use catchment::advice::{Advice, Advised};
use catchment::design::{Finding, Findings};
use catchment::exec::Cancelled;
use catchment::landscape::ResolutionError;
use catchment::method::{MethodError, NotApplicable};
use catchment::problem::ProblemError;
use catchment::run::RunError;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::any::Any;
use std::error::Error;

/// What is wrong, by whose fault.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// What the design says.
    Design(Findings),
    /// The geometry that it describes.
    Geometry(Findings),
    /// An argument of a call.
    Argument(Findings),
    /// It does not fit into memory, with what helps.
    Memory(String),
    /// There is no answer.
    Compute(String),
    /// It was asked to stop.
    Cancelled,
}

impl Refusal {
    /// An argument is wrong.
    pub(crate) fn argument(name: &str, message: impl ToString) -> Self {
        let list = vec![Finding::new(format!("{name}: {}", message.to_string()), None)];
        Self::Argument(Findings { source: None, list, omitted: 0 })
    }

    /// Everything that is wrong with the text of an argument.
    pub(crate) fn of_argument(name: &str, mut findings: Findings) -> Self {
        for finding in &mut findings.list {
            finding.message = format!("{name}: {}", finding.message);
        }
        Self::Argument(findings)
    }

    /// The problem was read and is not built.
    pub(crate) fn of_geometry(error: ProblemError) -> Self {
        match error {
            ProblemError::Findings(findings) => Self::Geometry(findings),
            error @ ProblemError::Load(_) => error.into(),
        }
    }

    /// As the exception.
    pub(crate) fn raise(self, py: Python<'_>) -> PyErr {
        let (class, findings, message) = match self {
            Self::Cancelled => return PyKeyboardInterrupt::new_err(()),
            Self::Design(findings) => ("DesignError", Some(findings), String::new()),
            Self::Geometry(findings) => ("GeometryError", Some(findings), String::new()),
            Self::Argument(findings) => ("ArgumentError", Some(findings), String::new()),
            Self::Memory(message) => ("MemoryLimitError", None, message),
            Self::Compute(message) => ("ComputeError", None, message),
        };
        match exception(py, class, findings, message) {
            Ok(exception) => PyErr::from_value(exception),
            Err(error) => error,
        }
    }
}

/// `class(message, findings, omitted, path)` of `catchment._errors`; a finding is `(message, advice, line, column)`.
fn exception<'py>(
    py: Python<'py>,
    class: &str,
    findings: Option<Findings>,
    message: String,
) -> PyResult<Bound<'py, PyAny>> {
    let class = py.import("catchment._errors")?.getattr(class)?;
    let Some(findings) = findings else { return class.call1((message,)) };
    let message = findings.to_string();
    let path = findings.path().map(|path| path.display().to_string());
    let place = |finding: &Finding| {
        let span = finding.span.as_ref()?;
        Some(findings.source.as_ref()?.line_column(span.start))
    };
    let list: Vec<_> = findings
        .list
        .iter()
        .map(|finding| (finding.message.clone(), finding.help.clone(), place(finding)))
        .collect();
    class.call1((message, list, findings.omitted, path))
}

impl<E: Error + 'static> From<E> for Refusal {
    fn from(error: E) -> Self {
        let mut error = Some(error);
        if let Some(problem) = taken::<_, ProblemError>(&mut error) {
            return match problem {
                ProblemError::Findings(findings) => Self::Design(findings),
                ProblemError::Load(error) => Self::Design(Findings {
                    source: None,
                    list: vec![Finding::new(error.to_string(), None)],
                    omitted: 0,
                }),
            };
        }
        if let Some(findings) = taken::<_, Findings>(&mut error) {
            return Self::Argument(findings);
        }
        if taken::<_, Cancelled>(&mut error).is_some() {
            return Self::Cancelled;
        }
        if let Some(error) = taken::<_, RunError>(&mut error) {
            return match error {
                RunError::NotHeld(findings) => Self::Geometry(findings),
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

/// An error that has no place: its message, and those of its causes that it does not repeat.
fn explained(error: &(dyn Error + 'static)) -> Refusal {
    let mut message = error.to_string();
    let mut is_memory = false;
    let mut cause = Some(error);
    while let Some(error) = cause {
        let said = error.to_string();
        if !message.contains(&said) {
            message = format!("{message}: {said}");
        }
        is_memory |=
            error.downcast_ref::<Advised>().is_some_and(|advised| advised.0.contains(&Advice::MoreMemory));
        cause = error.source();
    }
    if is_memory { Refusal::Memory(message) } else { Refusal::Compute(message) }
}

/// The error, if it is a `T`.
fn taken<E: 'static, T: 'static>(error: &mut Option<E>) -> Option<T> {
    (error as &mut dyn Any).downcast_mut::<Option<T>>().and_then(Option::take)
}
