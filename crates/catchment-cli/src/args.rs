//! The command line as types.

use crate::color::{self, Color};
use crate::command::Command;
use crate::exec_args::EXECUTION;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::groups::grouped;
use crate::setting::number;
use crate::source::read_design;
use catchment::design::{DesignDefect, Quantity, parse_dofs};
use catchment::exec::Exec;
use catchment::pose::DofSet;
use catchment::problem::{Draft, Problem, ProblemError};
use catchment::report::page::PageParts;
use catchment::terminal::{escaped, shown};
use clap::{Args, CommandFactory, FromArgMatches, Parser};
use std::ffi::OsString;
use std::path::PathBuf;

/// How much misalignment does a docking connector forgive?
///
/// catchment reads the two halves of a connector and computes which pose errors (x, y, roll, pitch, yaw) their contact corrects: its
/// area of acceptance.
#[derive(Debug, Parser)]
#[command(
    name = "catchment",
    version,
    arg_required_else_help = true,
    after_help = "Common options: catchment COMMAND -h. All options, with examples: --help."
)]
pub(crate) struct Cli {
    /// Colours of the output [default: auto, or `CATCHMENT_COLOR`]
    #[arg(long, global = true, value_enum, value_name = "WHEN", hide_short_help = true, help_heading = EXECUTION)]
    color: Option<Color>,
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// End of the long help, above the exit codes.
const AFTER: &str = "\
Common options: catchment COMMAND -h. All options, with examples: --help.
Version: catchment --version.

Results go to stdout, everything else to stderr.

Your own defaults never change a result. An option overrides an environment
variable, and a variable overrides $XDG_CONFIG_HOME/catchment/config.toml or
~/.config/catchment/config.toml:
  --threads 4         CATCHMENT_THREADS=4         threads = 4
  --memory \"4 GiB\"    CATCHMENT_MEMORY=\"4 GiB\"    memory = \"4 GiB\"
  --unit mm           CATCHMENT_UNIT=mm           unit = \"mm\"
  --color never       CATCHMENT_COLOR=never       color = \"never\"
NO_COLOR=1 overrides the file, too.

Exit codes:";

/// The command-line definition, before parsing.
pub(crate) fn command() -> clap::Command {
    let codes = ExitStatus::ALL.map(|(status, end)| format!("\n  {:>3}  {end}", status.code()));
    grouped(Cli::command().color(color::of_help()).after_long_help(AFTER.to_owned() + &codes.concat()))
}

/// Parses a command line; its first word is the name of the program.
///
/// # Errors
/// A parse error, or a request for help or the version.
pub(crate) fn parse(
    words: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> Result<Cli, clap::Error> {
    let mut command = command();
    let mut matches = command.try_get_matches_from_mut(words)?;
    Cli::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut command))
}

/// Heading of the options that override keys of the design.
const DESIGN: &str = "Design overrides";

/// A design file, and what to change in it for this run.
#[derive(Debug, Clone, Args)]
pub(crate) struct DesignArgs {
    /// Design file (TOML); - reads stdin
    #[arg(value_name = "DESIGN", value_hint = clap::ValueHint::FilePath)]
    pub(crate) path: PathBuf,
    /// Free pose errors, such as x,y,yaw; the others are locked
    #[arg(long, value_name = "ERRORS", value_parser = dofs, help_heading = DESIGN)]
    free: Option<DofSet>,
    /// Centre of rotation (COR): distance in front of the face centre, in D or with a unit, such as "5 mm"
    #[arg(long, value_name = "LENGTH", value_parser = quantity, allow_hyphen_values = true, hide_short_help = true,
          help_heading = DESIGN)]
    cor: Option<Quantity>,
    /// Aspect ratio H/D: height of the mating profile over the width
    #[arg(long, value_name = "RATIO", value_parser = number, allow_hyphen_values = true, hide_short_help = true,
          help_heading = DESIGN)]
    aspect_ratio: Option<f64>,
    /// Characteristic length ρ: weighs turns against shifts, in D or with a unit
    #[arg(long, alias = "rotation-length", value_name = "LENGTH", value_parser = quantity, allow_hyphen_values = true,
          hide_short_help = true, help_heading = DESIGN)]
    rho: Option<Quantity>,
}

impl DesignArgs {
    /// Reads the file and applies the overrides.
    pub(crate) fn draft(&self) -> Result<Draft, ProblemError> {
        self.change(Draft::read(read_design(&self.path)?)?)
    }

    /// Like [`Self::draft`], but stops on cancellation.
    pub(crate) fn draft_on(&self, exec: &Exec) -> Result<Draft, ProblemError> {
        self.change(Draft::read_on(read_design(&self.path)?, exec)?)
    }

    /// The options given and the design keys that they override.
    pub(crate) fn changed(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        [
            ("--free", "alignment.free", self.free.is_some()),
            ("--cor", "alignment.center_of_rotation", self.cor.is_some()),
            ("--aspect-ratio", "connector.aspect_ratio", self.aspect_ratio.is_some()),
            ("--rho", "alignment.rotation_length", self.rho.is_some()),
        ]
        .into_iter()
        .filter_map(|(option, key, given)| given.then_some((option, key)))
    }

    /// The overrides as command-line text: ` --free x,y,yaw`; empty without overrides.
    pub(crate) fn as_typed(&self) -> String {
        let free = self.free.map(|free| format!(" --free {}", free.to_string().replace(", ", ",")));
        let cor = self.cor.map(|cor| format!(" --cor '{cor}'"));
        let ratio = self.aspect_ratio.map(|ratio| format!(" --aspect-ratio {ratio}"));
        let rho = self.rho.map(|rho| format!(" --rho '{rho}'"));
        [free, cor, ratio, rho].into_iter().flatten().collect()
    }

    /// Applies the overrides.
    pub(crate) fn change(&self, mut draft: Draft) -> Result<Draft, ProblemError> {
        if let Some(free) = self.free {
            draft = draft.change("--free", |design| design.with_free(free))?;
        }
        if let Some(cor) = self.cor {
            draft = draft.change("--cor", |design| design.with_center_of_rotation(cor))?;
        }
        if let Some(ratio) = self.aspect_ratio {
            draft = draft.change("--aspect-ratio", |design| design.with_aspect_ratio(ratio))?;
        }
        if let Some(rho) = self.rho {
            draft = draft.change("--rho", |design| design.with_rotation_length(rho))?;
        }
        Ok(draft)
    }

    /// The problem, with its mated pose checked to be a rest.
    pub(crate) fn problem(&self) -> Result<Problem, ProblemError> {
        self.halves()?.checked()
    }

    /// The problem without that check, for commands that follow no motions.
    pub(crate) fn halves(&self) -> Result<Problem, ProblemError> {
        self.draft()?.build()
    }

    /// The problem of a design, or that of a stored result together with its friction coefficient.
    pub(crate) fn decided(&self, exec: &Exec) -> Result<(Problem, f64), Failure> {
        let path = &self.path;
        if !path.is_dir() {
            return Ok((self.problem()?, 0.0));
        }
        if let Some((option, _)) = self.changed().next() {
            let message = format!("{option}: {} is a result, which has been decided", shown(path));
            return Err(Failure::with_help(message, Some("give the design instead".to_owned())));
        }
        let PageParts { report, problem, notes, .. } = PageParts::stored(path, exec)?;
        let friction = report.friction();
        problem.map(|problem| (problem, friction)).ok_or_else(|| {
            let help = "give the design instead".to_owned();
            Failure::with_help(format!("{}: {}", shown(path), notes.join("; ")), Some(help))
                .ends(ExitStatus::BadInput)
        })
    }
}

/// Parses a list of errors.
pub(crate) fn dofs(text: &str) -> Result<DofSet, String> {
    parse_dofs(text).map_err(|complaint| with_advice(&complaint))
}

pub(crate) fn quantity(text: &str) -> Result<Quantity, String> {
    text.parse().map_err(|complaint| with_advice(&complaint))
}

/// A diagnostic about the value of an option, with its advice.
pub(crate) fn with_advice(complaint: &DesignDefect) -> String {
    escaped(&match complaint.help() {
        Some(help) => format!("{complaint}; {help}"),
        None => complaint.to_string(),
    })
}

#[cfg(test)]
#[path = "../../catchment/tests/readers/mutate.rs"]
mod mutate;

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_command_line_is_well_formed() {
        command().debug_assert();
    }

    fn corpus(name: &str) -> Vec<Vec<u8>> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(name);
        let mut paths: Vec<PathBuf> =
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        paths.iter().map(|path| std::fs::read(path).unwrap()).collect()
    }

    /// Fuzzes requests to `view` with thousands of mutations: only requests with the token are admitted.
    #[test]
    fn spoilt_requests_are_let_in_with_the_token_alone() {
        const RUNS: usize = 5000;
        let seeds = corpus("request");
        let mut dice = mutate::Dice::new(11);
        let mut admitted = 0;
        for number in 0..seeds.len() + RUNS {
            let seed = seeds.get(number).cloned().unwrap_or_else(|| dice.one(&seeds).clone());
            let head = if number < seeds.len() { seed } else { mutate::spoilt(&mut dice, &seed, &seeds) };
            if let Some(path) = crate::admitted(&head, 9, "token") {
                admitted += 1;
                assert!(String::from_utf8_lossy(&head).contains(&format!("/token/{path}")));
            }
        }
        assert!((2..RUNS).contains(&admitted), "{admitted} of {RUNS} let in");
    }

    /// Fuzzes command lines with thousands of mutations, one word per line: each is parsed, or rejected with
    /// a message without terminal control characters.
    #[test]
    fn spoilt_command_lines_are_read_or_refused() {
        const RUNS: usize = 1000;
        let seeds = corpus("arguments");
        let mut dice = mutate::Dice::new(9);
        let mut refused = 0;
        for number in 0..seeds.len() + RUNS {
            let seed = seeds.get(number).cloned().unwrap_or_else(|| dice.one(&seeds).clone());
            let line = if number < seeds.len() { seed } else { mutate::spoilt(&mut dice, &seed, &seeds) };
            let text = String::from_utf8_lossy(&line);
            let words = std::iter::once("catchment").chain(text.lines());
            if let Some(stated) = crate::usage_error(words) {
                assert!(number >= seeds.len(), "{text}: {stated}");
                refused += 1;
                assert!(
                    !stated.chars().any(|c| c.is_control() && c != '\n' && c != '\t'),
                    "{text:?}: {stated:?}"
                );
            }
        }
        assert!(refused > RUNS / 10, "{refused} of {RUNS} refused");
    }
}
