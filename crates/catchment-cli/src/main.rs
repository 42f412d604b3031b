//! The `catchment` command, with an allocator that reports running out of memory and ends the process.

mod allocation;

use std::process::ExitCode;

fn main() -> ExitCode {
    allocation::faults::prepare();
    catchment_cli::run().into()
}
