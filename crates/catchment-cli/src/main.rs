//! The `catchment` command, on an allocator that ends it with a message when memory is out.

mod allocation;

use std::process::ExitCode;

fn main() -> ExitCode {
    allocation::faults::prepare();
    catchment_cli::run().into()
}
