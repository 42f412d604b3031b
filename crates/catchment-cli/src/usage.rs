//! What is said of a command line that cannot be read, and the help that was asked for.

use crate::exit::ExitStatus;
use crate::failure::Failure;
use catchment::suggest::number_help;
use catchment::terminal::printable;
use clap::error::{ContextKind, ContextValue};
use std::error::Error;
use std::io::{self, Write};

/// Prints it: help and version on stdout, complaints on stderr.
pub(crate) fn tell(mut usage: clap::Error) -> ExitStatus {
    if usage.use_stderr() {
        advise(&mut usage);
        silence(&mut usage);
        // Nobody is left to tell when stderr itself is gone.
        let _ = match still_steering(&usage) {
            Some(text) => io::stderr().write_all(text.as_bytes()),
            None => usage.print(),
        };
        return ExitStatus::Usage;
    }
    match usage.print().and_then(|()| io::stdout().flush()) {
        // A reader that has gone away is no trouble.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Failure::with_help(format!("cannot write to stdout: {error}"), None)
                .ends(ExitStatus::NotComputed)
                .show()
        }
        _ => ExitStatus::Done,
    }
}

/// Takes from what the person wrote, and the complaint repeats, what could steer a terminal.
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

/// Says what to write in the place of a number that is none, where the complaint is that of a parser that does not.
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

/// A silenced complaint in which the reason of a parser still repeats such characters: its text without them, and without colours.
pub(crate) fn still_steering(usage: &clap::Error) -> Option<String> {
    let text = usage.to_string();
    let silent: String =
        text.split_inclusive('\n').map(|line| printable(line.trim_end_matches('\n')) + "\n").collect();
    (silent.trim_end() != text.trim_end()).then_some(silent)
}
