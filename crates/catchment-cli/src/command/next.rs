//! The command that comes next: from two files to a window, jams, friction.
//!
//! ```text
//!   place ─▶ check ─▶ run ─▶ report ─▶ view
//!                      │
//!                      └─▶ window ─▶ jams ─▶ friction ─▶ hold
//! ```
//!
//! After `hold` comes `plan`, which needs numbers that only the reader has.

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
    if text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::quoted;
    use crate::args;
    use std::path::Path;

    /// Until nothing follows: `place` leads to a window, a page and what holds.
    #[test]
    fn every_next_command_can_be_typed() {
        for first in [
            "place a.stl b.stl -o d.toml",
            "slices d.toml",
            "success d.toml --error-sigma x=0.1",
            "chance d.toml",
            "run d.toml",
        ] {
            let mut words = format!("catchment {first}");
            for _ in 0..10 {
                let parsed = args::parse(words.split(' ').map(ToOwned::to_owned).collect::<Vec<String>>());
                let Ok(cli) = parsed else { panic!("{words}") };
                let Some(next) = cli.command.next() else { break };
                assert_ne!(next, words);
                words = next;
            }
        }
    }

    #[test]
    fn paths_are_quoted_for_a_shell() {
        let path = |text: &str| quoted(Path::new(text));
        assert_eq!(
            [path("out/d.toml"), path("my d.toml"), path("it's.toml")],
            ["out/d.toml", "'my d.toml'", r"'it'\''s.toml'"]
        );
    }
}
