//! Messages for an invalid command line, and requested help.

use crate::exit::ExitStatus;
use crate::failure::Failure;
use catchment::suggest::number_help;
use catchment::terminal::printable;
use clap::error::{ContextKind, ContextValue};
use std::error::Error;
use std::io::{self, Write};

/// Prints it: help and version on stdout, errors on stderr.
pub(crate) fn print(mut usage: clap::Error) -> ExitStatus {
    if usage.use_stderr() {
        advise(&mut usage);
        silence(&mut usage);
        // If stderr itself is closed, the message is lost.
        let _ = match still_steering(&usage) {
            Some(text) => io::stderr().write_all(text.as_bytes()),
            None => usage.print(),
        };
        return ExitStatus::Usage;
    }
    match usage.print().and_then(|()| io::stdout().flush()) {
        // A closed pipe is not an error.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Failure::with_help(format!("cannot write to stdout: {error}"), None)
                .ends(ExitStatus::NotComputed)
                .show()
        }
        _ => ExitStatus::Done,
    }
}

/// Removes terminal control characters from quoted user input in the error.
pub(crate) fn silence(usage: &mut clap::Error) {
    let silent = |text: &String| printable(text);
    let repeated: Vec<(ContextKind, ContextValue)> = usage
        .context()
        .filter_map(|(kind, value)| match value {
            ContextValue::String(text) => Some((kind, ContextValue::String(silent(text)))),
            ContextValue::Strings(texts) => {
                Some((kind, ContextValue::Strings(texts.iter().map(silent).collect())))
            }
            // A tip repeats an unknown option.
            ContextValue::StyledStrs(texts) => {
                let plain = texts.iter().map(|text| silent(&text.to_string()).into());
                Some((kind, ContextValue::StyledStrs(plain.collect())))
            }
            _ => None,
        })
        .collect();
    for (kind, value) in repeated {
        usage.insert(kind, value);
    }
}

/// Adds advice on invalid numbers to errors of parsers that give none.
pub(crate) fn advise(usage: &mut clap::Error) {
    const NO_WHOLE_NUMBER: &str = "invalid digit found in string";
    let reason = usage.source().map(ToString::to_string).unwrap_or_default();
    let Some(ContextValue::String(value)) = usage.get(ContextKind::InvalidValue) else { return };
    let tip = match reason.as_str() {
        NO_WHOLE_NUMBER => {
            number_help(value).unwrap_or_else(|| "write a whole number in digits, such as 1000".to_owned())
        }
        "number too large to fit in target type" => "write a smaller number".to_owned(),
        _ => return,
    };
    usage.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
}

/// The text of a silenced error without control characters and colours, if a parser's reason still repeats
/// such characters.
pub(crate) fn still_steering(usage: &clap::Error) -> Option<String> {
    let text = usage.to_string();
    let silent: String =
        text.split_inclusive('\n').map(|line| printable(line.trim_end_matches('\n')) + "\n").collect();
    (silent.trim_end() != text.trim_end()).then_some(silent)
}
