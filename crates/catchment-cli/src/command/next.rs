//! The suggested next command: from two files to a window, jams and friction.
//!
//! ```text
//!   place ─▶ check ─▶ run ─▶ report ─▶ view
//!                      │
//!                      └─▶ window ─▶ rests --jams ─▶ friction ─▶ hold
//! ```
//!
//! `plan` follows `hold`, but needs numbers that only the user has.

use super::Command;
use crate::args::DesignArgs;
use crate::source::is_stream;
use catchment::terminal::shown;
use std::path::Path;

impl Command {
    /// The usual next command, if any.
    pub(crate) fn next(&self) -> Option<String> {
        let of = |command: &str, path: &Path, more: &str| {
            // stdin cannot be read a second time.
            (!is_stream(path)).then(|| format!("catchment {command} {}{more}", quoted(path)))
        };
        // The overrides of the design carry over to the next command.
        let on = |command: &str, design: &DesignArgs, more: &str| {
            of(command, &design.path, &(design.as_typed() + more))
        };
        match self {
            Self::Place(args) => of("run", args.output()?, " -o out"),
            Self::Check(args) => on("run", &args.design, " -o out"),
            Self::Run(args) => match args.place.output() {
                Some(out) if out.extension().is_none() => of("report", out, " -o page.html"),
                _ => on("window", &args.design, ""),
            },
            Self::Report(args) => on("view", &args.design, ""),
            Self::Slices(args) => on("run", &args.design, " -o out"),
            Self::Window(args) => on("rests", &args.design, " --jams"),
            Self::Trace(args) if args.poses.is_none() => on("rests", &args.design, " --jams"),
            Self::Jams(args) => on("friction", &args.search.design, ""),
            Self::Friction(args) => on("hold", &args.design, ""),
            Self::Rests(args) if args.jams => on("friction", &args.search.design, ""),
            Self::Rests(args) => on("hold", &args.search.design, ""),
            Self::Success(args) => on("window", &args.design, ""),
            Self::Dynamics(args) => on("friction", &args.design, ""),
            _ => None,
        }
    }
}

/// A path quoted for the shell.
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

    /// Follows the suggestions to the end: `place` leads to a window, a page and `hold`.
    #[test]
    fn every_next_command_can_be_typed() {
        for first in [
            "place a.stl b.stl -o d.toml",
            "slices d.toml",
            "success d.toml --error-sigma x=0.1",
            "dynamics d.toml",
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
    fn changes_of_the_design_are_repeated() {
        let words = "catchment run d.toml --free x,yaw --rho 0.4".split(' ').map(ToOwned::to_owned);
        let Ok(cli) = args::parse(words.collect::<Vec<String>>()) else { panic!("it cannot be typed") };
        assert_eq!(cli.command.next().unwrap(), "catchment window d.toml --free x,yaw --rho '0.4'");
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
