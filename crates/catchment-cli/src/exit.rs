//! What the exit code says.

use std::process::ExitCode;

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExitStatus {
    /// Done; every stated requirement is met.
    Done,
    /// Done, but a stated requirement is not met.
    RequirementNotMet,
    /// Could not compute: bad input, bad usage, no memory, no file.
    Failed,
    /// Stopped by Ctrl-C.
    Interrupted,
    /// Asked to end by the system, or by the terminal that went away.
    Terminated,
}

impl ExitStatus {
    /// The number that the system is told.
    pub const fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::RequirementNotMet => 1,
            Self::Failed => 2,
            // 128 and the number of the signal, as shells expect.
            Self::Interrupted => 130,
            Self::Terminated => 143,
        }
    }
}

impl From<ExitStatus> for ExitCode {
    fn from(status: ExitStatus) -> Self {
        Self::from(status.code())
    }
}
