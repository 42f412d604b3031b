//! Whether output is coloured.
//!
//! ```text
//!   --color ▶ CATCHMENT_COLOR ▶ NO_COLOR ▶ color in config.toml ▶ auto: on a terminal
//! ```

use clap::{ColorChoice, ValueEnum};
use miette::MietteHandlerOpts;
use std::ffi::OsString;
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU8, Ordering};
use textwrap::WordSplitter;

/// When output is coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    /// On a terminal, unless `NO_COLOR` is set
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// The choice of this process; [`Color::Auto`] by default.
static CHOSEN: AtomicU8 = AtomicU8::new(Color::Auto as u8);

impl Color {
    /// The choice on a command line before it is parsed, because help and parse errors are coloured, too.
    pub(crate) fn of_words(words: &[OsString]) -> Option<Self> {
        const OPTION: &str = "--color";
        let mut words = words.iter().skip(1).map_while(|word| word.to_str().filter(|word| *word != "--"));
        while let Some(word) = words.next() {
            let value = match word.strip_prefix(OPTION) {
                Some("") => words.next(),
                Some(rest) => rest.strip_prefix('='),
                None => None,
            };
            if let Some(value) = value {
                return Self::from_str(value, false).ok();
            }
        }
        None
    }

    /// Sets the choice of this process.
    pub(crate) fn choose(self) {
        CHOSEN.store(self as u8, Ordering::Relaxed);
        let is_coloured = match self {
            Self::Auto => None,
            Self::Always => Some(true),
            Self::Never => Some(false),
        };
        // A second run in the same process finds the hook already set.
        let _ = miette::set_hook(Box::new(move |_| {
            // An option broken at its hyphens cannot be copied.
            let options = MietteHandlerOpts::new().word_splitter(WordSplitter::NoHyphenation);
            Box::new(
                is_coloured.map_or_else(|| options.clone(), |colour| options.clone().color(colour)).build(),
            )
        }));
    }

    /// The current choice.
    fn chosen() -> Self {
        let all = [Self::Auto, Self::Always, Self::Never];
        all.into_iter().find(|one| *one as u8 == CHOSEN.load(Ordering::Relaxed)).unwrap_or(Self::Auto)
    }
}

/// Whether text on this stream is coloured.
pub(crate) fn is_coloured(stream: &impl IsTerminal) -> bool {
    match Color::chosen() {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => stream.is_terminal() && !no_color(),
    }
}

/// Whether the user disables colours, <https://no-color.org>.
pub(crate) fn no_color() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
}

/// The choice, in clap's type, for help and parse errors.
pub(crate) fn of_help() -> ColorChoice {
    match Color::chosen() {
        Color::Auto => ColorChoice::Auto,
        Color::Always => ColorChoice::Always,
        Color::Never => ColorChoice::Never,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_color_option_is_read_before_the_command_line_is_parsed() {
        let of = |line: &str| {
            let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
            Color::of_words(&words)
        };
        assert_eq!(of("catchment run d.toml --color never"), Some(Color::Never));
        assert_eq!(of("catchment --color=always run d.toml"), Some(Color::Always));
        for line in [
            "catchment run",
            "catchment run --color",
            "catchment run --color pink",
            "catchment run -- --color never",
        ] {
            assert_eq!(of(line), None, "{line}");
        }
    }
}
