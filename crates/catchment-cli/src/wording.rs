//! Tests of the help: it fits on a screen, ends with examples, and uses plain language.

use crate::args;
use crate::command::GROUPS;
use clap::Command;

/// Narrowest supported terminal width.
const COLUMNS: usize = 80;
/// Lines of a screen, including the prompt.
const SCREEN: usize = 40;

/// Every listed subcommand, with nested subcommands.
fn commands() -> Vec<Command> {
    let mut all = args::command();
    all.build();
    let mut result: Vec<Command> =
        all.get_subcommands().filter(|one| one.get_name() != "help").cloned().collect();
    let below: Vec<Command> = result.iter().flat_map(Command::get_subcommands).cloned().collect();
    result.extend(below.into_iter().filter(|one| one.get_name() != "help"));
    result.push(all);
    result
}

/// The texts of a command's help, except values named by another crate.
fn texts(command: &Command) -> Vec<String> {
    let mut texts: Vec<String> = [
        command.get_about(),
        command.get_long_about(),
        command.get_after_help(),
        command.get_after_long_help(),
    ]
    .into_iter()
    .flatten()
    .map(ToString::to_string)
    .collect();
    for arg in command.get_arguments() {
        texts.extend(arg.get_long_help().or(arg.get_help()).map(ToString::to_string));
        texts.extend(arg.get_help_heading().map(ToOwned::to_owned));
    }
    texts
}

#[test]
fn the_short_help_of_daily_commands_fits_on_a_screen() {
    let mut all = args::command();
    all.build();
    for name in GROUPS[0].names {
        let command = all.find_subcommand(name).cloned().unwrap_or_default();
        let help = command.term_width(COLUMNS).render_help().to_string();
        let lines = help.lines().count();
        assert!(lines <= SCREEN, "{name}: {lines} lines\n{help}");
        assert!(help.lines().all(|line| line.chars().count() <= COLUMNS), "{name}\n{help}");
    }
}

#[test]
fn every_help_ends_with_examples_that_fit() {
    for command in commands().iter().filter(|one| !one.is_hide_set() && !one.has_subcommands()) {
        let name = command.get_name();
        // The parent command has the examples for the subcommands of `catalog`.
        let Some(text) = command.get_after_long_help().map(ToString::to_string) else {
            assert!(["show", "design"].contains(&name), "{name} has no examples");
            continue;
        };
        assert!(text.starts_with("Example"), "{name}");
        let wide = text.lines().find(|line| line.chars().count() > COLUMNS);
        assert!(wide.is_none(), "{name}: {wide:?}");
    }
}

/// Upper limits per thousand words.
#[test]
fn the_help_speaks_plainly() {
    const MOST: [(&[&str], f64); 5] = [
        (&["what"], 2.0),
        (&["told", "tell", "tells", "says", "said"], 1.0),
        (&["where"], 2.0),
        (&["one", "none", "nobody"], 3.0),
        (&["otherwise", "fares", "askew"], 0.0),
    ];
    let text = commands().iter().flat_map(texts).collect::<Vec<_>>().join("\n").to_lowercase();
    let words: Vec<&str> = text.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).collect();
    for (of, most) in MOST {
        let count = words.iter().filter(|word| of.contains(word)).count();
        let share = 1000.0 * count as f64 / words.len() as f64;
        assert!(share <= most, "{of:?}: {count} of {} words, {share:.2} per thousand", words.len());
    }
    for phrase in ["becomes of", "radian counts", "asked about", "be had", "how far"] {
        assert!(!text.contains(phrase), "{phrase}");
    }
}
