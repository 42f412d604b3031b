//! `catchment schema`: the JSON schema of design files.

use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::OutputArgs;
use catchment::design::json_schema;
use clap::Args;

/// Write the JSON schema of design files
///
/// Editors use it for completion and checks. With taplo (such as VS Code with "Even Better TOML") they read the file in the first line of a
/// design: `#:schema schema.json`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Example:
  catchment schema -o schema.json")]
pub(crate) struct SchemaArgs {
    #[command(flatten)]
    output: OutputArgs,
}

pub(crate) fn run(args: &SchemaArgs) -> Result<ExitStatus, Failure> {
    args.output.write(&json_schema())?;
    Ok(ExitStatus::Done)
}
