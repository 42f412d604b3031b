//! The `catchment` command: typed arguments → meaning → library → print.

fn main() {}
