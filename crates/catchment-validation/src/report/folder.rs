//! The folder of a reproduction: pictures, `tables.csv`, `report.json`, and the figure's own CSV.

use super::figure::{figure_name, pictures};
use crate::study::Reproduction;
use catchment::exec::Exec;
use catchment::report::csv;
use catchment::report::folder::{REPORT, SaveError, encode, save_files};
use catchment::report::write::{self, WriteError};
use catchment::terminal::shown;
use std::path::Path;

/// The kind of such a folder.
const KIND: &str = "reproduction";

/// The table of all entries.
const CSV: &str = "tables.csv";

/// Refuses a place that cannot be written, before anything is computed.
///
/// # Errors
/// Something else is there, another process keeps it locked, or its parent is no folder.
pub fn check(path: &Path, exec: &Exec) -> Result<(), WriteError> {
    write::check_folder(path, KIND, exec)
}

/// Writes everything and says what was written; `version` is the program's.
///
/// # Errors
/// Whatever the system refuses; nothing is left behind.
pub fn save(result: &Reproduction, path: &Path, version: &str, exec: &Exec) -> Result<String, SaveError> {
    let drawn = pictures(result)?;
    let mut files = encode(&drawn, exec)?;
    if let Some(figure) = &result.figure {
        files.push((format!("{}.csv", figure_name()), csv(&figure.records())?));
    }
    files.push((CSV.to_owned(), csv(&result.records())?));
    files.push((REPORT.to_owned(), format!("{:#}\n", result.json(version)).into_bytes()));
    save_files(path, KIND, &files, exec)?;
    Ok(format!("wrote {}: {REPORT}, {CSV}, {} pictures as PNG and SVG", shown(path), drawn.len()))
}
