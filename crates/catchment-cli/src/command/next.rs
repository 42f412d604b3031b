//! The command that comes next: from two files to a window, jams, trials.
//!
//! ```text
//!   place ─▶ check ─▶ run ─▶ report ─▶ view
//!                      │
//!                      └─▶ window ─▶ jams ─▶ friction ─▶ hold ─▶ plan ─▶ validate
//! ```

use super::Command;
use catchment::terminal::shown;
use std::path::Path;

impl Command {
    /// What one types next, most of the time; `None` where nothing follows.
    pub(crate) fn next(&self) -> Option<String> {
        let of = |command: &str, path: &Path, more: &str| {
            Some(format!("catchment {command} {}{more}", quoted(path)))
        };
        match self {
            Self::Place(args) => of("run", args.output.as_deref()?, " -o out"),
            Self::Check(args) => of("run", &args.design.path, " -o out"),
            Self::Run(args) => match args.place.output.as_deref() {
                Some(out) if out.extension().is_none() => of("report", out, " -o page.html"),
                _ => of("window", &args.design.path, ""),
            },
            Self::Report(args) => of("view", &args.design.path, ""),
            Self::Slices(args) => of("run", &args.design.path, " -o out"),
            Self::Window(args) => of("jams", &args.design.path, ""),
            Self::Trace(args) => of("jams", &args.design.path, ""),
            Self::Jams(args) => of("friction", &args.design.path, ""),
            Self::Friction(args) => of("hold", &args.design.path, ""),
            Self::Rests(args) => of("hold", &args.design.path, ""),
            Self::Hold(args) => of("plan", &args.design.path, " -o trials.csv"),
            Self::Plan(args) => of("validate", &args.design.path, " trials.csv"),
            Self::Success(args) => of("window", &args.design.path, ""),
            Self::Chance(args) => of("friction", &args.design.path, ""),
            _ => None,
        }
    }
}

/// A path as a shell reads it.
fn quoted(path: &Path) -> String {
    let text = shown(path).to_string();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+,=@".contains(c);
    if text.chars().all(is_plain) { text } else { format!("'{text}'") }
}
