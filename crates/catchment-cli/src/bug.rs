//! Panic handler. A panic is a bug of the program: the message reports this, with the source location and
//! advice. Unfinished files are removed, and the exit code is that of any other failure.

use crate::exit::ExitStatus;
use catchment::exec::is_panic_expected;
use catchment::terminal::escaped;
use std::io::{self, Write};
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};

/// Runs `work`; a panic on any of its threads ends it as a failure.
pub(crate) fn caught(work: impl FnOnce() -> ExitStatus) -> ExitStatus {
    panic::set_hook(Box::new(|bug| {
        if !is_panic_expected() {
            // If stderr itself is closed, the message is lost.
            let _ = io::stderr().lock().write_all(message(bug).as_bytes());
        }
    }));
    // No state of `work` is used after a panic.
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or(ExitStatus::NotComputed)
}

/// The message for a panic.
fn message(bug: &PanicHookInfo<'_>) -> String {
    let message = bug.payload_as_str().unwrap_or("no message");
    let place = bug.location().map_or_else(|| "an unknown place".to_owned(), ToString::to_string);
    format!(
        "catchment: this is a bug of the program, not of your input: {}\n  at {place}, version {}, {} {}\n  Please report it \
         with the command line and its files at {}.\n",
        escaped(message),
        env!("CARGO_PKG_VERSION"),
        std::env::consts::OS,
        std::env::consts::ARCH,
        env!("CARGO_PKG_REPOSITORY"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    #[test]
    fn a_panic_on_any_thread_is_a_failure_and_names_the_repository() {
        assert_eq!(caught(|| ExitStatus::Done), ExitStatus::Done);
        let heard = Arc::new(Mutex::new(String::new()));
        let listener = Arc::clone(&heard);
        let ended = caught(|| {
            panic::set_hook(Box::new(move |bug| listener.lock().unwrap().push_str(&message(bug))));
            std::thread::scope(|scope| {
                scope.spawn(|| panic!("a \u{1b}[2Jbug"));
            });
            ExitStatus::Done
        });
        let _ = panic::take_hook();
        assert_eq!(ended, ExitStatus::NotComputed);
        let heard = heard.lock().unwrap();
        assert!(heard.contains("a bug of the program") && heard.contains("a \\u{1b}[2Jbug"), "{heard}");
        assert!(heard.contains("bug.rs:") && heard.contains(env!("CARGO_PKG_REPOSITORY")), "{heard}");
    }
}
