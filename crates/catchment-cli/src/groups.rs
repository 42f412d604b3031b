//! The subcommands in the order and the groups of the help.
//!
//! ```text
//!   catchment -h      question, groups, first commands       one screen
//!   catchment --help  the same, and the interface for scripts
//! ```
//!
//! The subcommands supply their own summaries; a test checks that every subcommand belongs to exactly one
//! group.

use crate::command::GROUPS;
use clap::Command;
use std::fmt::Write;

/// Subcommands under one heading.
pub(crate) struct Group {
    /// The heading.
    pub(crate) heading: &'static str,
    /// The names of the subcommands, in order.
    pub(crate) names: &'static [&'static str],
}

/// The first commands to run.
const FIRST: &str = "  catchment place socket.stl plug.stl --unit mm -o design.toml
  catchment check design.toml
  catchment run design.toml -o out
  (no parts at hand: catchment new pyramid -o design.toml)";

/// The summary of the subcommand that clap adds.
const HELP: &str = "Print the help of a command";

/// The command line with grouped help.
pub(crate) fn grouped(command: Command) -> Command {
    let listed = listed(&command);
    command.help_template(listed)
}

/// The help text, up to the options.
fn listed(command: &Command) -> String {
    let (header, literal) = (*command.get_styles().get_header(), *command.get_styles().get_literal());
    let mut text = "{about-with-newline}\n{usage-heading} {usage}\n".to_owned();
    let names = || GROUPS.iter().flat_map(|group| group.names);
    let width = names().map(|name| name.len()).max().unwrap_or(0);
    for (number, Group { heading, names }) in GROUPS.iter().enumerate() {
        // The daily commands stand apart; the other groups are closed up to fit on the screen.
        let gap = if number < 2 { "\n" } else { "" };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{gap}{header}{heading}:{header:#}");
        for name in *names {
            let about = command.find_subcommand(name).and_then(Command::get_about);
            let about = about.map_or_else(|| HELP.to_owned(), ToString::to_string);
            let _ = writeln!(text, "  {literal}{name:width$}{literal:#}  {about}");
        }
    }
    let _ = write!(text, "\n{header}First commands:{header:#}\n{FIRST}{{after-help}}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args;

    #[test]
    fn every_subcommand_stands_in_one_group() {
        let mut command = args::command();
        command.build();
        let visible = command.get_subcommands().filter(|one| !one.is_hide_set());
        let mut all: Vec<&str> = visible.map(Command::get_name).collect();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|group| group.names).copied().collect();
        all.sort_unstable();
        grouped.sort_unstable();
        assert_eq!(all, grouped);
    }

    /// Numbers of sampled poses are `--samples`, cells per axis `--resolution`: other names are hidden
    /// aliases.
    #[test]
    fn one_meaning_has_one_name() {
        const OLD: [&str; 7] =
            ["motions", "cells", "overall", "chains", "rotation-length", "accuracy", "required"];
        for command in args::command().get_subcommands() {
            let shown = command.get_arguments().filter_map(|option| option.get_long());
            let old: Vec<&str> = shown.filter(|name| OLD.contains(name)).collect();
            assert!(old.is_empty(), "{}: {old:?}", command.get_name());
        }
    }

    /// Plain lines of at most 80 columns, about one screen in total.
    #[test]
    fn the_help_fits_on_a_screen() {
        let help = args::command().render_help().to_string();
        assert!(help.starts_with("How much misalignment does a docking connector forgive?\n"), "{help}");
        let longest = help.lines().max_by_key(|line| line.chars().count()).unwrap_or_default();
        assert!(longest.chars().count() <= 80, "{longest}");
        assert!(help.lines().count() <= 55, "{} lines:\n{help}", help.lines().count());
        let daily = help.find(" new ").zip(help.find(" friction "));
        assert!(daily.is_some_and(|(daily, forces)| daily < forces), "{help}");
    }
}
