//! The folder that a command writes into: complete or not at all, and never over something else.

use crate::failure::Failure;
use catchment::exec::Exec;
use catchment::report::figure::Picture;
use catchment::report::{csv, write, zarr};
use std::fmt::Display;
use std::path::Path;

/// The name of the JSON report in such a folder.
pub(crate) const REPORT: &str = "report.json";

/// The name of the Zarr group in the folder of a run.
pub(crate) const RESULT: &str = "result.zarr";

/// Pixels per unit of the drawing in PNG files: sharp on screens and slides.
const PNG_SCALE: f32 = 2.0;

/// Files by name.
pub(crate) type Files = Vec<(String, Vec<u8>)>;

/// Every picture as SVG and PNG, with the name of its file.
pub(crate) fn encode<N: Display>(drawn: &[(N, Picture)], exec: &Exec) -> Result<Files, Failure> {
    let mut files = Vec::with_capacity(2 * drawn.len());
    for (name, picture) in drawn {
        exec.check()?;
        files.push((format!("{name}.png"), picture.png(PNG_SCALE)?));
        files.push((format!("{name}.svg"), picture.svg().as_bytes().to_vec()));
    }
    Ok(files)
}

/// Writes files into a folder.
pub(crate) fn write_all(folder: &Path, files: &[(String, Vec<u8>)], exec: &Exec) -> Result<(), Failure> {
    for (name, bytes) in files {
        exec.check()?;
        write::file(&folder.join(name), bytes)?;
    }
    Ok(())
}

/// What a study writes into its folder: `report.json`, a picture and a table of one name, perhaps Zarr groups.
pub(crate) struct Study<'a> {
    /// The folder.
    pub(crate) path: &'a Path,
    /// Name of the picture and the table, without ending.
    pub(crate) name: &'static str,
}

impl Study<'_> {
    /// Refuses a place that cannot be written, before anything is computed.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        Ok(write::check_folder(self.path, |path| self.is_ours(path))?)
    }

    /// Writes everything and says what was written; `more` adds to the folder.
    pub(crate) fn write(
        &self,
        json: &str,
        records: &[Vec<String>],
        picture: Picture,
        exec: &Exec,
        more: impl FnOnce(&Path) -> Result<(), Failure>,
    ) -> Result<String, Failure> {
        self.write_files(json, records, encode(&[(self.name, picture)], exec)?, exec, more)
    }

    /// The same with pictures that are encoded already, or none.
    pub(crate) fn write_files(
        &self,
        json: &str,
        records: &[Vec<String>],
        mut files: Files,
        exec: &Exec,
        more: impl FnOnce(&Path) -> Result<(), Failure>,
    ) -> Result<String, Failure> {
        let drawn = if files.is_empty() { String::new() } else { format!(", {} as PNG and SVG", self.name) };
        files.push((format!("{}.csv", self.name), csv(records)?));
        write::folder(
            self.path,
            |path| self.is_ours(path),
            |folder| -> Result<(), Failure> {
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
            ours || name == REPORT && is_report(&path.join(REPORT)) || zarr::is_group(&path.join(name))
        })
    }
}

/// Whether a file is a JSON report of this program.
pub(crate) fn is_report(path: &Path) -> bool {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let report: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    report["schema"].is_u64() && report["catchment"].is_string()
}

/// Whether a folder holds only entries of known names.
pub(crate) fn has_only(path: &Path, known: impl Fn(&str) -> bool) -> bool {
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
        let study = Study { path: home.path(), name: "slices" };
        assert!(study.check().is_ok(), "nothing is lost with an empty folder");
        std::fs::write(home.path().join("slices.csv"), "").unwrap();
        std::fs::write(home.path().join(REPORT), r#"{ "schema": 1, "catchment": "0.1.0" }"#).unwrap();
        assert!(study.check().is_ok());
        std::fs::write(home.path().join("overview.png"), "").unwrap();
        assert!(study.check().is_err(), "a run was written there");
    }
}
