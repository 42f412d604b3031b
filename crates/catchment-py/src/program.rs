//! The `catchment` command, for who has it from a wheel.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Does what a command line says, the name of the program first; returns the exit code.
#[pyfunction]
pub(crate) fn program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| catchment_cli::run_words(words).code())
}
