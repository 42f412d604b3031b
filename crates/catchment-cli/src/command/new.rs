//! `catchment new`: a commented design file to start from.

use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::OutputArgs;
use catchment::design::{Family, template};
use clap::Args;
use clap::builder::{PossibleValue, TypedValueParser, ValueParser};

/// Write a commented design file to start from
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment new pyramid > design.toml
  catchment new x-face-3d -o design.toml")]
pub(crate) struct NewArgs {
    /// Built-in family of connectors
    #[arg(value_name = "FAMILY", value_parser = family_parser())]
    family: Family,
    #[command(flatten)]
    output: OutputArgs,
}

fn family_parser() -> ValueParser {
    let values = Family::ALL.map(|family| PossibleValue::new(family.name()).help(family.summary()));
    clap::builder::PossibleValuesParser::new(values)
        .try_map(|name| Family::ALL.into_iter().find(|family| family.name() == name).ok_or("no such family"))
        .into()
}

pub(crate) fn run(args: &NewArgs) -> Result<ExitStatus, Failure> {
    args.output.write(&template(args.family))?;
    Ok(ExitStatus::Done)
}
