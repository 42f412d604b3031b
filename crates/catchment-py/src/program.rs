//! The `catchment` command of a wheel.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs a command line; its first word is the name of the program. Returns the exit code.
#[pyfunction]
pub(crate) fn program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| catchment_cli::run_words(words).code())
}
