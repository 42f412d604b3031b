//! The folder that a result is written into: complete or not at all, and never over something else.
//!
//! ```text
//!   run       report.json, result.zarr, and every picture as .png and .svg
//!   a study   report.json, and its table, picture and groups under its own name
//! ```

use super::write::{self, WriteError};
use crate::exec::{Cancelled, Exec};
use serde_json::Value;
use std::path::Path;

/// The name of the JSON report in such a folder.
pub const REPORT: &str = "report.json";

/// The name of the Zarr group in the folder of a run.
pub const RESULT: &str = "result.zarr";

/// Files by name.
pub type Files = Vec<(String, Vec<u8>)>;

/// Why a result could not be written.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// Its files could not.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A picture could not be drawn.
    #[cfg(feature = "figure")]
    #[error(transparent)]
    Figure(#[from] super::figure::FigureError),
    /// The grid could not be stored.
    #[cfg(feature = "zarr")]
    #[error(transparent)]
    Zarr(#[from] super::zarr::ZarrError),
    /// A table has no CSV form.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// The report has no JSON form.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// What the pictures show could not be computed.
    #[error(transparent)]
    Slices(#[from] crate::run::RunError),
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Every picture as PNG and SVG, under the name of its file.
///
/// # Errors
/// A picture cannot be encoded, or it was asked to stop.
#[cfg(feature = "figure")]
pub fn encode<N: std::fmt::Display>(
    drawn: &[(N, super::figure::Picture)],
    exec: &Exec,
) -> Result<Files, SaveError> {
    /// Pixels per unit of the drawing: sharp on screens and slides.
    const PNG_SCALE: f32 = 2.0;
    let mut files = Vec::with_capacity(2 * drawn.len());
    for (name, picture) in drawn {
        exec.check()?;
        files.push((format!("{name}.png"), picture.png(PNG_SCALE)?));
        files.push((format!("{name}.svg"), picture.svg().as_bytes().to_vec()));
    }
    Ok(files)
}

/// Records as CSV.
///
/// # Errors
/// None at present: every record can be written into memory.
pub fn csv(records: &[Vec<String>]) -> Result<Vec<u8>, SaveError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for record in records {
        writer.write_record(record)?;
    }
    writer.into_inner().map_err(|error| SaveError::Csv(error.into_error().into()))
}

/// Writes files into a folder.
///
/// # Errors
/// Whatever the system refuses, or it was asked to stop.
pub fn write_all(folder: &Path, files: &[(String, Vec<u8>)], exec: &Exec) -> Result<(), SaveError> {
    for (name, bytes) in files {
        exec.check()?;
        write::file(&folder.join(name), bytes)?;
    }
    Ok(())
}

/// What a study writes into its folder: `report.json`, a picture and a table of one name, perhaps Zarr groups.
#[derive(Debug, Clone, Copy)]
pub struct StudyFolder<'a> {
    /// The folder.
    pub path: &'a Path,
    /// Name of the picture and the table, without ending.
    pub name: &'static str,
}

impl StudyFolder<'_> {
    /// Refuses a place that cannot be written, before anything is computed.
    ///
    /// # Errors
    /// Something else is there, or its parent is no folder.
    pub fn check(&self) -> Result<(), WriteError> {
        write::check_folder(self.path, |path| self.is_ours(path))
    }

    /// Writes everything and says what was written; `more` adds to the folder.
    ///
    /// # Errors
    /// Whatever the system refuses, or those of `more`; nothing is left behind.
    pub fn write(
        &self,
        json: &str,
        records: &[Vec<String>],
        mut files: Files,
        exec: &Exec,
        more: impl FnOnce(&Path) -> Result<(), SaveError>,
    ) -> Result<String, SaveError> {
        let drawn = if files.is_empty() { String::new() } else { format!(", {} as PNG and SVG", self.name) };
        files.push((format!("{}.csv", self.name), csv(records)?));
        write::folder(
            self.path,
            |path| self.is_ours(path),
            |folder| -> Result<(), SaveError> {
                write_all(folder, &files, exec)?;
                more(folder)?;
                write::file(&folder.join(REPORT), json.as_bytes())?;
                Ok(exec.check()?)
            },
        )?;
        let (place, name) = (self.path.display(), self.name);
        Ok(format!("wrote {place}: {REPORT}, {name}.csv{drawn}"))
    }

    /// Whether a folder was written by the same study, or is empty: replacing it loses nothing else.
    fn is_ours(&self, path: &Path) -> bool {
        has_only(path, |name| {
            let ours =
                name.strip_prefix(self.name).is_some_and(|end| matches!(end, ".png" | ".svg" | ".csv"));
            ours || name == REPORT && is_report(&path.join(REPORT)) || is_group(&path.join(name))
        })
    }
}

/// Whether a folder is a Zarr group of this program.
pub fn is_group(path: &Path) -> bool {
    let text = std::fs::read_to_string(path.join("zarr.json")).unwrap_or_default();
    let root: Value = serde_json::from_str(&text).unwrap_or_default();
    root["node_type"] == "group" && root["attributes"]["catchment"].is_u64()
}

/// Whether a file is a JSON report of this program.
pub fn is_report(path: &Path) -> bool {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let report: Value = serde_json::from_str(&text).unwrap_or_default();
    report["schema"].is_u64() && report["catchment"].is_string()
}

/// Whether a folder holds only entries of known names.
pub fn has_only(path: &Path, known: impl Fn(&str) -> bool) -> bool {
    // A link may lead to a folder that other things rely on.
    let is_folder = std::fs::symlink_metadata(path).is_ok_and(|meta| meta.is_dir());
    let Ok(mut entries) = std::fs::read_dir(path) else { return false };
    is_folder && entries.all(|entry| entry.is_ok_and(|e| e.file_name().to_str().is_some_and(&known)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_the_same_study_wrote_is_replaced() {
        let home = tempfile::tempdir().unwrap();
        let study = StudyFolder { path: home.path(), name: "slices" };
        assert!(study.check().is_ok(), "nothing is lost with an empty folder");
        std::fs::write(home.path().join("slices.csv"), "").unwrap();
        std::fs::write(home.path().join(REPORT), r#"{ "schema": 1, "catchment": "0.1.0" }"#).unwrap();
        assert!(study.check().is_ok());
        std::fs::write(home.path().join("overview.png"), "").unwrap();
        assert!(study.check().is_err(), "a run was written there");
    }
}
