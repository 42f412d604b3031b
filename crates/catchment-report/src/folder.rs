//! The folder of a result: complete or absent, and never overwriting other content.
//!
//! ```text
//!   run       report.json, result.zarr (poses.csv of a run without a grid), and every picture as .png and .svg
//!   a study   report.json, and its table, picture and groups under its own name
//! ```
//!
//! Each folder holds a manifest of its files; see [`write`](mod@super::write).

use super::write::{self, WriteError};
use catchment_core::exec::{Cancelled, Exec, OutOfBudget};
use catchment_core::terminal::shown;
use std::path::Path;

/// The name of the JSON report in such a folder.
pub const REPORT: &str = "report.json";

/// The name of the Zarr group in the folder of a run.
pub const RESULT: &str = "result.zarr";

/// The name of the table of sampled poses in the folder of a run without a grid.
pub const POSES: &str = "poses.csv";

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
    /// The set cannot be shown to another program so.
    #[error(transparent)]
    View(#[from] super::vtk::ViewError),
    /// A table has no CSV form.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// The report has no JSON form.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// The slices for the pictures could not be computed.
    #[error(transparent)]
    Slices(#[from] catchment_core::run::RunError),
    /// The pictures would not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Every picture as PNG and SVG, under the name of its file.
///
/// # Errors
/// A picture cannot be encoded, or the computation is cancelled.
#[cfg(feature = "figure")]
pub fn encode<N: std::fmt::Display>(
    drawn: &[(N, super::figure::Picture)],
    exec: &Exec,
) -> Result<Files, SaveError> {
    /// Pixels per unit of the drawing: sharp on screens and slides.
    const PNG_SCALE: f32 = 2.0;
    super::figure::ensure_fits(0, exec)?;
    let mut files = Vec::with_capacity(2 * drawn.len());
    for (name, picture) in drawn {
        exec.check()?;
        files.push((format!("{name}.png"), picture.png(PNG_SCALE)?));
        files.push((format!("{name}.svg"), picture.svg().as_bytes().to_vec()));
    }
    Ok(files)
}

/// Writes files into a folder that is being filled; a name may contain folders.
///
/// # Errors
/// Errors of the system, or the computation is cancelled.
pub fn write_all(folder: &Path, files: &[(String, Vec<u8>)], exec: &Exec) -> Result<(), SaveError> {
    for (name, bytes) in files {
        exec.check()?;
        write::part(folder, name, bytes)?;
    }
    Ok(())
}

/// Writes a folder of files, which must not exist, be empty or hold an older result of the same kind.
///
/// # Errors
/// Errors of the system, or the computation is cancelled. Nothing is left behind and an older result is
/// unchanged.
pub fn save_files(
    path: &Path,
    kind: &str,
    files: &[(String, Vec<u8>)],
    exec: &Exec,
) -> Result<(), SaveError> {
    write::folder(path, kind, exec, |folder| {
        write_all(folder, files, exec)?;
        Ok(exec.check()?)
    })
}

/// Files of a study in its folder: `report.json`, a picture and a table with the same name, and optional Zarr
/// groups.
#[derive(Debug, Clone, Copy)]
pub struct StudyFolder<'a> {
    /// The folder.
    pub path: &'a Path,
    /// Name of the picture and the table, without ending, and the kind of the folder.
    pub name: &'static str,
}

impl StudyFolder<'_> {
    /// Refuses a place that cannot be written, before anything is computed.
    ///
    /// # Errors
    /// Something else is there, another process keeps it locked, or its parent is no folder.
    pub fn check(&self, exec: &Exec) -> Result<(), WriteError> {
        write::check_utf8(self.path)?;
        write::check_folder(self.path, self.name, exec)
    }

    /// Writes everything and returns the paths; `more` adds to the folder.
    ///
    /// # Errors
    /// Errors of the system, or those of `more`; nothing is left behind.
    pub fn write(
        &self,
        json: &str,
        records: &[Vec<String>],
        mut files: Files,
        exec: &Exec,
        more: impl FnOnce(&Path) -> Result<(), SaveError>,
    ) -> Result<String, SaveError> {
        let drawn = if files.is_empty() { String::new() } else { format!(", {} as PNG and SVG", self.name) };
        let has_table = !records.is_empty();
        if has_table {
            files.push((format!("{}.csv", self.name), crate::text::csv(records)?));
        }
        write::folder(self.path, self.name, exec, |folder| -> Result<(), SaveError> {
            write_all(folder, &files, exec)?;
            more(folder)?;
            write::part(folder, REPORT, json.as_bytes())?;
            Ok(exec.check()?)
        })?;
        let (place, name) = (shown(self.path), self.name);
        let table = if has_table { format!(", {name}.csv") } else { String::new() };
        Ok(format!("wrote {place}: {REPORT}{table}{drawn}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_results_of_the_same_study_are_replaced() {
        let home = tempfile::tempdir().unwrap();
        let path = &home.path().join("out");
        let [slices, other] = ["slices", "difference"].map(|name| StudyFolder { path, name });
        let write = |study: StudyFolder| {
            study.write("{}", &[vec!["axis".to_owned()]], Files::new(), &Exec::new(), |_| Ok(()))
        };
        std::fs::create_dir(path).unwrap();
        assert!(slices.check(&Exec::new()).is_ok(), "nothing is lost with an empty folder");
        write(slices).unwrap();
        assert!(slices.check(&Exec::new()).is_ok() && other.check(&Exec::new()).is_err());
        assert!(matches!(write(other), Err(SaveError::Write(WriteError::OtherKind { .. }))));
        std::fs::write(path.join("notes.txt"), "mine").unwrap();
        assert!(matches!(write(slices), Err(SaveError::Write(WriteError::Strange { changed: false, .. }))));
        assert!(path.join("slices.csv").exists());
    }
}
