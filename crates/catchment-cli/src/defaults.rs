//! User defaults for options that change no result: from the environment or from a file.
//!
//! ```text
//!   --threads 4 ▶ CATCHMENT_THREADS=4 ▶ threads = 4 in config.toml ▶ built in
//! ```
//!
//! The file is `$XDG_CONFIG_HOME/catchment/config.toml`, or `~/.config/catchment/config.toml`. Every command
//! rejects an invalid value and names its source. No default changes a number: --samples, --budget, --seed
//! and --method have none.

use crate::color::{Color, no_color};
use crate::command::unit;
use crate::exec_args::{bytes, threads};
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::source::read_table;
use catchment::design::{LengthUnit, SourceText};
use catchment::diagnostic::{Diagnostic, Diagnostics};
use catchment::suggest::nearest;
use catchment::terminal::{escaped, shown};
use clap::ValueEnum;
use std::env;
use std::path::PathBuf;
use std::sync::OnceLock;
use toml::de::{DeTable, DeValue};

/// The user's defaults; `None` for a default that is not set.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Defaults {
    /// Worker threads; 0 means one per core.
    pub(crate) threads: Option<u16>,
    /// The memory budget, in bytes.
    pub(crate) memory: Option<u64>,
    /// The unit of files that do not state theirs, with the source of this default.
    pub(crate) unit: Option<(LengthUnit, String)>,
    /// When output is coloured.
    pub(crate) color: Option<Color>,
}

/// A key of the file; its environment variable overrides it.
struct Key {
    name: &'static str,
    variable: &'static str,
    /// Parses a value and stores it, with the name of its source.
    set: fn(&mut Defaults, &str, &str) -> Result<(), String>,
}

const KEYS: [Key; 4] = [
    Key {
        name: "threads",
        variable: "CATCHMENT_THREADS",
        set: |defaults, text, _| threads(text).map(|threads| defaults.threads = Some(threads)),
    },
    Key {
        name: "memory",
        variable: "CATCHMENT_MEMORY",
        set: |defaults, text, _| bytes(text).map(|bytes| defaults.memory = Some(bytes)),
    },
    Key {
        name: "unit",
        variable: "CATCHMENT_UNIT",
        set: |defaults, text, source| unit(text).map(|unit| defaults.unit = Some((unit, source.to_owned()))),
    },
    Key {
        name: "color",
        variable: "CATCHMENT_COLOR",
        set: |defaults, text, _| {
            let read = Color::from_str(text, false);
            let read = read.map_err(|_| "a colour setting is auto, always or never".to_owned());
            read.map(|color| defaults.color = Some(color))
        },
    },
];

static DEFAULTS: OnceLock<Defaults> = OnceLock::new();

/// The defaults of this process; the built-in ones until [`load`] has run.
pub(crate) fn get() -> Defaults {
    DEFAULTS.get().cloned().unwrap_or_default()
}

/// Loads the defaults of this process.
///
/// # Errors
/// An invalid value, with its source.
pub(crate) fn load() -> Result<(), Failure> {
    let variable = |name: &str| env::var_os(name).filter(|value| !value.is_empty());
    let mut defaults = match place(variable) {
        // Another user's home directory, as after `su`, may be unreadable: it holds no defaults of this user.
        Some(path) if path.metadata().is_ok() => {
            // Any defect counts as a usage error, like the same value on the command line.
            let text = read_table(&path).map_err(|failure| failure.ends(ExitStatus::Usage))?;
            of_file(&text)
                .map_err(|diagnostics| Failure::of_diagnostics(diagnostics).ends(ExitStatus::Usage))?
        }
        _ => Defaults::default(),
    };
    if no_color() {
        defaults.color = Some(Color::Never);
    }
    for key in KEYS {
        if let Some(value) = variable(key.variable) {
            let text = value.to_string_lossy();
            (key.set)(&mut defaults, text.trim(), key.variable).map_err(|reason| {
                let message = format!("{}=\"{}\": {reason}", key.variable, escaped(&text));
                Failure::with_help(message, Some(format!("correct the variable, or unset {}", key.variable)))
            })?;
        }
    }
    // A process that runs several command lines loads them once.
    let _ = DEFAULTS.set(defaults);
    Ok(())
}

/// The path of the file, if a base directory is known.
fn place(variable: impl Fn(&str) -> Option<std::ffi::OsString>) -> Option<PathBuf> {
    const BELOW: [&str; 2] = ["catchment", "config.toml"];
    let home = || variable("HOME").or_else(|| if cfg!(windows) { variable("USERPROFILE") } else { None });
    // The XDG specification ignores a relative path here.
    let base = variable("XDG_CONFIG_HOME").map(PathBuf::from).filter(|path| path.is_absolute());
    let base = base.or_else(|| Some(PathBuf::from(home()?).join(".config")))?;
    Some(base.join(BELOW[0]).join(BELOW[1]))
}

/// Parses the defaults of a file.
fn of_file(source: &SourceText) -> Result<Defaults, Diagnostics> {
    let refused = |list: Vec<Diagnostic>| Diagnostics { source: Some(source.clone()), list, omitted: 0 };
    let table = DeTable::parse(&source.text).map_err(|error| {
        refused(vec![Diagnostic {
            span: error.span(),
            ..Diagnostic::error("defaults", error.message(), None)
        }])
    })?;
    let (mut defaults, mut list) = (Defaults::default(), Vec::new());
    let name = shown(&source.path).to_string();
    for (key, value) in table.get_ref() {
        let written = key.get_ref().as_ref();
        let Some(known) = KEYS.iter().find(|known| known.name == written) else {
            let names = KEYS.map(|known| known.name);
            let help = match nearest(written, names) {
                Some(name) => format!("did you mean `{name}`?"),
                None => format!("the keys are {}", names.join(", ")),
            };
            let message = format!("unknown key `{}`", escaped(written));
            list.push(Diagnostic::error("defaults", message, Some(help)).at(Some(key.span())));
            continue;
        };
        let text = match value.get_ref() {
            DeValue::String(text) => text.to_string(),
            DeValue::Integer(number) => number.to_string(),
            _ => String::new(),
        };
        if let Err(reason) = (known.set)(&mut defaults, text.trim(), &name) {
            let message = format!("`{}`: {reason}", known.name);
            list.push(Diagnostic::error("defaults", message, None).at(Some(value.span())));
        }
    }
    // The TOML table is sorted by key; restore the order of the file.
    list.sort_by_key(|wrong| wrong.span.as_ref().map(|span| span.start));
    if list.is_empty() { Ok(defaults) } else { Err(refused(list)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;
    use std::path::Path;

    fn read(text: &str) -> Result<Defaults, Diagnostics> {
        of_file(&SourceText::new("config.toml", text))
    }

    #[test]
    fn a_file_is_read_key_by_key() {
        let all = read("threads = 4\nmemory = \"2 GiB\"\nunit = \"mm\"\ncolor = \"never\"\n").unwrap();
        assert_eq!((all.threads, all.memory), (Some(4), Some(2 << 30)));
        assert_eq!(all.unit, Some((LengthUnit::Mm, "config.toml".to_owned())));
        assert_eq!(all.color, Some(Color::Never));
        assert_eq!(read("").unwrap(), Defaults::default());
        assert_eq!(read("memory = 1000000").unwrap().memory, Some(1_000_000));
    }

    #[test]
    fn everything_wrong_is_refused_at_its_place() {
        let wrong =
            read("thread = 4\nmemory = \"much\"\nunit = 1\nsamples = 10\ncolor = true\n").unwrap_err();
        let stated: Vec<&str> = wrong.list.iter().map(|one| one.message.as_str()).collect();
        assert_eq!(stated.len(), 5, "{stated:?}");
        assert!(wrong.list.iter().all(|one| one.span.is_some()));
        let help = wrong.list.iter().find_map(Diagnostic::help);
        assert_eq!(help.as_deref(), Some("did you mean `threads`?"));
        assert!(
            read("threads = ").is_err() && read("threads = -1").is_err() && read("threads = 2000").is_err()
        );
    }

    #[test]
    fn the_file_is_where_the_specification_has_it() {
        let at = |known: &[(&str, &str)]| {
            let known = known.to_vec();
            let value = |name: &str| {
                known.iter().find(|(key, _)| *key == name).map(|(_, value)| OsString::from(value))
            };
            place(value)
        };
        let [xdg, home] = [("XDG_CONFIG_HOME", "/x"), ("HOME", "/h")];
        assert_eq!(at(&[xdg, home]).unwrap(), Path::new("/x/catchment/config.toml"));
        assert_eq!(at(&[home]).unwrap(), Path::new("/h/.config/catchment/config.toml"));
        assert_eq!(
            at(&[("XDG_CONFIG_HOME", "x"), home]).unwrap(),
            Path::new("/h/.config/catchment/config.toml")
        );
        assert_eq!(at(&[]), None);
    }
}
