//! Execution options: threads, memory, progress. No option here changes a result.

use crate::defaults;
use crate::failure::Failure;
use crate::output::to_stderr;
use crate::signals;
use catchment::exec::Exec;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Heading of these options.
pub(crate) const EXECUTION: &str = "Execution (never changes a result)";

/// Options of every command that computes.
#[derive(Debug, Args)]
pub(crate) struct ExecArgs {
    /// Worker threads; 0 uses every core [default: 0, or `CATCHMENT_THREADS`]
    #[arg(long, hide_short_help = true, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=MOST_THREADS),
          help_heading = EXECUTION)]
    threads: Option<u16>,
    /// Memory budget, such as "4 GiB"; larger results are refused [default: three quarters of the free memory, or `CATCHMENT_MEMORY`]
    #[arg(long, hide_short_help = true, value_name = "SIZE", value_parser = bytes, help_heading = EXECUTION)]
    memory: Option<u64>,
    /// Print no progress
    #[arg(short, long, hide_short_help = true, help_heading = EXECUTION)]
    quiet: bool,
}

/// An [`Exec`] that is cancelled by signals, with a progress bar that disappears when it is dropped.
pub(crate) struct Running {
    /// The execution settings for the library.
    pub exec: Exec,
    bar: ProgressBar,
}

impl Running {
    /// Lets a signal end the process in the middle of a step until this value is dropped. Use it only while
    /// nothing is stored and nothing is written.
    pub(crate) fn may_be_left(&self) {
        self.may_be_left_after(|| ());
    }

    /// Like [`Self::may_be_left`] for commands that store intermediate results: `last` reports them.
    pub(crate) fn may_be_left_after(&self, last: impl Fn() + Send + 'static) {
        let bar = self.bar.clone();
        signals::may_leave(move || {
            bar.finish_and_clear();
            last();
        });
    }

    /// Hides the progress bar while `print` runs.
    pub(crate) fn beside_bar<T>(&self, print: impl FnOnce() -> T) -> T {
        self.bar.suspend(print)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        signals::must_stay();
        self.bar.finish_and_clear();
    }
}

/// Progress without a bar: one line per tenth of a stage, for long computations only.
struct Log {
    started: Instant,
    /// The last reported stage, and its completed tenths.
    stage: &'static str,
    tenths: u32,
}

impl Log {
    /// Computations shorter than this print no progress.
    const SILENT: Duration = Duration::from_secs(20);

    fn new() -> Self {
        Self { started: Instant::now(), stage: "", tenths: 0 }
    }

    fn line(&mut self, fraction: f64, stage: &'static str) -> Option<String> {
        let tenths = (fraction * 10.0) as u32;
        if stage != self.stage {
            (self.stage, self.tenths) = (stage, 0);
        }
        let elapsed = self.started.elapsed();
        if tenths <= self.tenths || elapsed < Self::SILENT {
            return None;
        }
        self.tenths = tenths;
        Some(format!("progress: {} % after {} s ({stage})", 10 * tenths, elapsed.as_secs()))
    }
}

impl ExecArgs {
    /// The requested number of worker threads; 0 means one per core.
    pub(crate) fn threads(&self) -> usize {
        usize::from(self.threads.or(defaults::get().threads).unwrap_or(0))
    }

    /// Starts threads, progress (a bar on a terminal, lines elsewhere) and signal handling: once per process.
    pub(crate) fn start(&self) -> Result<Running, Failure> {
        const STEPS: u64 = 1000;
        let mut exec = Exec::new().with_threads(self.threads())?;
        if let Some(bytes) = self.memory.or(defaults::get().memory) {
            exec = exec.with_memory_budget(bytes);
        }
        let bar = if self.quiet {
            ProgressBar::hidden()
        } else if std::io::stderr().is_terminal() {
            let bar = ProgressBar::new(STEPS);
            bar.set_style(ProgressStyle::with_template("{msg:16} {bar:40} {percent:>3} %  {eta}")?);
            let shown = bar.clone();
            exec = exec.with_progress(Arc::new(move |fraction, stage| {
                shown.set_message(stage);
                shown.set_position((fraction * STEPS as f64) as u64);
            }));
            bar
        } else {
            let log = Mutex::new(Log::new());
            exec = exec.with_progress(Arc::new(move |fraction, stage| {
                let line = log.lock().unwrap_or_else(PoisonError::into_inner).line(fraction, stage);
                to_stderr(&line.into_iter().collect::<Vec<_>>());
            }));
            ProgressBar::hidden()
        };
        signals::listen(&exec.cancel_flag())?;
        Ok(Running { exec, bar })
    }
}

/// Upper limit, above the number of cores of any machine.
const MOST_THREADS: i64 = 1024;

/// Parses a number of threads for `--threads`.
pub(crate) fn threads(text: &str) -> Result<u16, String> {
    let number = text.parse().ok().filter(|number| i64::from(*number) <= MOST_THREADS);
    number.ok_or_else(|| format!("a number of threads is a whole number from 0 to {MOST_THREADS}"))
}

/// Parses a size such as `4 GiB`, `500 MB` or `1e9` (bytes).
pub(crate) fn bytes(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 9] = [
        ("", 1.0),
        ("B", 1.0),
        ("kB", 1e3),
        ("MB", 1e6),
        ("GB", 1e9),
        ("KiB", 1024.0),
        ("MiB", 1_048_576.0),
        ("GiB", 1_073_741_824.0),
        ("TiB", 1_099_511_627_776.0),
    ];
    let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = &text[number.len()..];
    let factor = UNITS.iter().find(|(name, _)| *name == unit).map(|(_, factor)| factor);
    let value: Option<f64> = number.trim().parse().ok();
    match value.zip(factor).map(|(value, factor)| value * factor) {
        Some(bytes) if (1.0..=1e18).contains(&bytes) => Ok(bytes as u64),
        _ => Err("a size is a positive number and one of B, kB, MB, GB, KiB, MiB, GiB, TiB".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requested_threads_and_memory_are_applied() {
        let args = ExecArgs { threads: Some(2), memory: Some(1000), quiet: true };
        let running = args.start().unwrap();
        assert_eq!(running.exec.threads(), 2);
        assert_eq!(running.exec.memory_budget(), 1000);
        assert!(signals::received().is_none() && !running.exec.is_cancelled());
    }

    #[test]
    fn a_log_has_one_line_per_tenth_of_a_long_stage() {
        let mut log = Log::new();
        assert_eq!(log.line(0.5, "cells"), None);
        log.started -= 2 * Log::SILENT;
        assert_eq!(log.line(0.51, "cells").as_deref(), Some("progress: 50 % after 40 s (cells)"));
        assert_eq!(log.line(0.59, "cells"), None);
        assert!(log.line(0.6, "cells").is_some() && log.line(1.0, "cells").is_some());
        // The next stage restarts at zero.
        assert_eq!(log.line(0.3, "limits").as_deref(), Some("progress: 30 % after 40 s (limits)"));
    }

    #[test]
    fn sizes_are_read() {
        assert_eq!(bytes("4 GiB"), Ok(4 << 30));
        assert_eq!(bytes("1.5MB"), Ok(1_500_000));
        assert_eq!(bytes("1024"), Ok(1024));
        for wrong in ["", "GiB", "-1 MB", "nan", "inf GiB", "4 gigs", "1e30 TiB"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }
}
