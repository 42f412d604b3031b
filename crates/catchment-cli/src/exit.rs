//! What the exit code says.

use std::process::ExitCode;

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ExitStatus {
    /// Done; every stated requirement is met.
    Done,
    /// Done, but a stated requirement is not met.
    RequirementNotMet,
    /// Could not compute: bad input, bad usage, no memory, no file.
    Failed,
    /// Stopped by Ctrl-C.
    Interrupted,
}

impl From<ExitStatus> for ExitCode {
    fn from(status: ExitStatus) -> Self {
        Self::from(match status {
            ExitStatus::Done => 0,
            ExitStatus::RequirementNotMet => 1,
            ExitStatus::Failed => FAILED_CODE,
            ExitStatus::Interrupted => INTERRUPTED_CODE,
        })
    }
}

/// 128 + SIGINT, as shells expect.
pub(crate) const INTERRUPTED_CODE: u8 = 130;

/// That of every failure.
pub(crate) const FAILED_CODE: u8 = 2;
