//! The folder of a reproduction: pictures, `tables.csv`, `report.json`, and the figure's own CSV.

use super::figure::{figure_name, is_picture, pictures};
use crate::study::Reproduction;
use catchment::exec::Exec;
use catchment::report::csv;
use catchment::report::folder::{REPORT, SaveError, encode, has_only, is_report, write_all};
use catchment::report::write::{self, WriteError};
use std::path::Path;

/// The table of all entries.
const CSV: &str = "tables.csv";

/// Refuses a place that cannot be written, before anything is computed.
///
/// # Errors
/// Something else is there, or its parent is no folder.
pub fn check(path: &Path) -> Result<(), WriteError> {
    write::check_folder(path, is_ours)
}

/// Writes everything and says what was written; `version` is the program's.
///
/// # Errors
/// Whatever the system refuses; nothing is left behind.
pub fn save(found: &Reproduction, path: &Path, version: &str, exec: &Exec) -> Result<String, SaveError> {
    let drawn = pictures(found)?;
    let mut files = encode(&drawn, exec)?;
    if let Some(figure) = &found.figure {
        files.push((format!("{}.csv", figure_name()), csv(&figure.records())?));
    }
    files.push((CSV.to_owned(), csv(&found.records())?));
    files.push((REPORT.to_owned(), format!("{:#}\n", found.json(version)).into_bytes()));
    write::folder(path, is_ours, |folder| write_all(folder, &files, exec))?;
    Ok(format!("wrote {}: {REPORT}, {CSV}, {} pictures as PNG and SVG", path.display(), drawn.len()))
}

/// Whether a folder was written by [`save`], or is empty: replacing it loses nothing else.
fn is_ours(path: &Path) -> bool {
    has_only(path, |name| is_picture(name) || name == CSV || name == REPORT && is_report(&path.join(REPORT)))
}
