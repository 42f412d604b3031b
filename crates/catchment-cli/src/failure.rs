//! The reasons why a command failed, and their display.

use crate::advice;
use crate::exit::ExitStatus;
use crate::{output, signals};
use catchment::diagnostic::{Diagnostic, Diagnostics};
use catchment::problem::ProblemError;
use catchment::terminal::escaped;
use miette::{MietteDiagnostic, Report};
use std::any::Any;
use std::io::Write;

/// Reports for stderr; `?` converts any error into it.
#[derive(Debug)]
pub(crate) struct Failure {
    reports: Vec<Report>,
    closing: Option<String>,
    /// The exit status; [`ExitStatus::Done`] if the reader of stdout closed the pipe.
    status: ExitStatus,
}

impl Failure {
    /// Several reports and a closing line, such as their number.
    pub(crate) fn many(reports: Vec<Report>, closing: Option<String>, status: ExitStatus) -> Self {
        Self { reports, closing, status }
    }

    /// A message with advice; a usage error unless [`Self::ends`] changes the status.
    pub(crate) fn with_help(message: String, help: Option<String>) -> Self {
        Self::many(
            vec![Report::new(report(&Diagnostic::error("usage", message, help)))],
            None,
            ExitStatus::Usage,
        )
    }

    /// An error of the library with command-line advice.
    pub(crate) fn explained<E: std::error::Error + 'static>(error: &E, help: Option<String>) -> Self {
        Self::with_help(error.to_string(), help).ends(ExitStatus::of(error))
    }

    /// The same failure with another exit status.
    pub(crate) fn ends(self, status: ExitStatus) -> Self {
        Self { status, ..self }
    }

    /// All diagnostics about the value of an option.
    pub(crate) fn of_option(option: &str, text: &str, refusal: Diagnostics) -> Self {
        let count = refusal.list.len() + refusal.omitted;
        let reports =
            refusal.list.into_iter().map(|diagnostic| Report::new(report(&diagnostic.prefixed(option))));
        let shown: String = escaped(text).chars().take(80).collect();
        let closing = (count > 1).then(|| format!("{count} problems in {option} \"{shown}\""));
        Self::many(reports.collect(), closing, ExitStatus::Usage)
    }

    /// The reader of stdout closed the pipe.
    pub(crate) fn broken_pipe() -> Self {
        Self::many(Vec::new(), None, ExitStatus::Done)
    }

    /// Its text without colours, for a page.
    pub(crate) fn text(&self) -> String {
        let words: Vec<String> = self.reports.iter().map(ToString::to_string).collect();
        words.join("\n")
    }

    /// Prints the failure on stderr and returns the exit status.
    pub(crate) fn show(self) -> ExitStatus {
        if self.status == ExitStatus::Done {
            return self.status;
        }
        let mut stderr = std::io::stderr().lock();
        // If stderr itself is closed, the message is lost.
        if let Some(status) = signals::received() {
            let _ = writeln!(stderr, "interrupted; {}", output::written_items());
            return status;
        }
        for report in &self.reports {
            let _ = writeln!(stderr, "{report:?}");
        }
        if let Some(closing) = self.closing {
            let _ = writeln!(stderr, "{closing}");
        }
        self.status
    }
}

impl<E: std::error::Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        let mut error = Some(error);
        // Errors with a known place are shown there.
        if let Some(problem) = taken::<_, ProblemError>(&mut error) {
            return Self::of_problem(problem);
        }
        if let Some(diagnostics) = taken::<_, Diagnostics>(&mut error) {
            return Self::of_diagnostics(diagnostics);
        }
        let Some(error) = error else { return Self::many(Vec::new(), None, ExitStatus::NotComputed) };
        Self::with_help(with_causes(&error), advice::of(&error)).ends(ExitStatus::of(&error))
    }
}

/// Formats a diagnostic for the terminal. It may quote file contents or names; these can neither emit control
/// characters nor begin a line that imitates the program's output.
pub(crate) fn report(diagnostic: &Diagnostic) -> MietteDiagnostic {
    let mut report = MietteDiagnostic::new(escaped(diagnostic.message.trim_end()));
    let help = diagnostic.advice.as_ref().and_then(advice::flags);
    report.help = help.map(|help| escaped(help.trim_end()));
    report
}

/// The message of an error, followed by those of its causes that it does not already contain.
fn with_causes(error: &dyn std::error::Error) -> String {
    let mut message = error.to_string();
    let causes = std::iter::successors(error.source(), |cause| cause.source());
    for cause in causes.map(ToString::to_string) {
        if !message.contains(&cause) {
            message = format!("{message}: {cause}");
        }
    }
    message
}

/// Takes the error out if it is a `T`.
fn taken<E: 'static, T: 'static>(error: &mut Option<E>) -> Option<T> {
    (error as &mut dyn Any).downcast_mut::<Option<T>>().and_then(Option::take)
}
