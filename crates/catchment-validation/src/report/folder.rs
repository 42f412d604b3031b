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

/// Refuses a folder that cannot be written, before any computation.
///
/// # Errors
/// The path holds other content, another process keeps it locked, or its parent is no folder.
pub fn check(path: &Path, exec: &Exec) -> Result<(), WriteError> {
    write::check_folder(path, KIND, exec)
}

/// Writes all files and returns their list as a text; `version` is the program's.
///
/// # Errors
/// Any error of the system; no files are left behind.
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
