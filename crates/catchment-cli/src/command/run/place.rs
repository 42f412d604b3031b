//! Where the files of a run go: complete or not at all.
//!
//! ```text
//!   -o DIR          DIR/report.json, DIR/result.zarr, and every picture as .png and .svg
//!   -o NAME.zarr    the Zarr group alone
//!   --figures DIR   every picture alone
//!   (a study)       DIR/report.json, and its table and picture
//! ```

use super::compute::{Computed, Job};
use super::pictures;
use crate::failure::Failure;
use crate::geometry::Built;
use crate::result_folder::{REPORT, RESULT, Study, encode, has_only, is_report, write_all};
use catchment::exec::Exec;
use catchment::report::write;
use catchment::report::{Report, zarr};
use clap::Args;
use std::path::{Path, PathBuf};

/// Where the files of a run go.
#[derive(Debug, Args)]
pub(crate) struct PlaceArgs {
    /// Write pictures, report.json and result.zarr into this folder; NAME.zarr: only that group
    #[arg(short, long, value_name = "DIR|NAME.zarr", value_hint = clap::ValueHint::DirPath, help_heading = "Files")]
    output: Option<PathBuf>,
    /// Write only the pictures into this folder
    #[arg(long, value_name = "DIR", value_hint = clap::ValueHint::DirPath, help_heading = "Files")]
    figures: Option<PathBuf>,
}

/// Places that can be written, as far as can be known beforehand.
pub(super) struct Places<'a> {
    folder: Option<&'a Path>,
    group: Option<&'a Path>,
    figures: Option<&'a Path>,
}

impl PlaceArgs {
    /// Refuses places that cannot be written, before anything is computed.
    pub(super) fn checked(&self) -> Result<Places<'_>, Failure> {
        let is_group = |path: &&Path| path.extension().is_some_and(|ending| ending == "zarr");
        let output = self.output.as_deref();
        let places = Places {
            folder: output.filter(|path| !is_group(path)),
            group: output.filter(is_group),
            figures: self.figures.as_deref(),
        };
        if let (Some(folder), Some(figures)) = (output, places.figures)
            && folder == figures
        {
            let help = Some("-o alone writes the pictures too".to_owned());
            return Err(Failure::with_help("-o and --figures name the same folder".to_owned(), help));
        }
        places.folder.map_or(Ok(()), |path| write::check_folder(path, is_result))?;
        places.group.map_or(Ok(()), |path| write::check_folder(path, zarr::is_group))?;
        places.figures.map_or(Ok(()), |path| write::check_folder(path, has_only_pictures))?;
        Ok(places)
    }

    /// Whether pictures alone are wanted.
    pub(super) const fn wants_figures_alone(&self) -> bool {
        self.figures.is_some()
    }

    /// The folder of a study of this name, if one is to be written; refused now if it cannot be.
    pub(super) fn study(&self, name: &'static str) -> Result<Option<Study<'_>>, Failure> {
        let folder = self.output.as_deref().map(|path| Study { path, name });
        folder.as_ref().map_or(Ok(()), Study::check)?;
        Ok(folder)
    }
}

impl Places<'_> {
    /// Whether the heights over the grid are written.
    pub(super) fn wants_heights(&self) -> bool {
        self.folder.is_some() || self.group.is_some()
    }

    /// Writes everything and says what was written.
    pub(super) fn write(
        &self,
        job: &Job,
        built: &Built,
        computed: &Computed,
        report: &Report,
        exec: &Exec,
    ) -> Result<Vec<String>, Failure> {
        let mut notes = Vec::new();
        let mut pictures = Vec::new();
        if self.folder.is_some() || self.figures.is_some() {
            let (drawn, left_out) = pictures::draw(job, &built.connector, computed, report, exec)?;
            pictures = encode(&drawn, exec)?;
            notes = left_out;
        }
        let heights = computed.landscape.as_ref().map(|landscape| &landscape.heights[..]);
        if let Some(path) = self.figures {
            write::folder(path, has_only_pictures, |folder| write_all(folder, &pictures, exec))?;
            notes.push(format!(
                "wrote {} pictures as PNG and SVG into {}",
                pictures.len() / 2,
                path.display()
            ));
        }
        if let Some(path) = self.group {
            zarr::write(path, report, &computed.acceptance, heights, exec)?;
            notes.push(format!("wrote {}", path.display()));
        }
        if let Some(path) = self.folder {
            let json = report.to_json()?;
            write::folder(path, is_result, |folder| -> Result<(), Failure> {
                write_all(folder, &pictures, exec)?;
                zarr::write(&folder.join(RESULT), report, &computed.acceptance, heights, exec)?;
                write::file(&folder.join(REPORT), json.as_bytes())?;
                Ok(exec.check()?)
            })?;
            let place = path.display();
            notes.push(format!(
                "wrote {place}: {REPORT}, {RESULT}, {} pictures as PNG and SVG",
                pictures.len() / 2
            ));
        }
        Ok(notes)
    }
}

/// Whether a folder holds pictures of a run, or nothing: replacing it loses nothing else.
fn has_only_pictures(path: &Path) -> bool {
    has_only(path, is_picture)
}

/// Whether a folder was written by `-o DIR`, or is empty: replacing it loses nothing else.
fn is_result(path: &Path) -> bool {
    has_only(path, |name| {
        is_picture(name)
            || name == REPORT && is_report(&path.join(REPORT))
            || name == RESULT && zarr::is_group(&path.join(RESULT))
    })
}

fn is_picture(name: &str) -> bool {
    pictures::NAMES
        .iter()
        .any(|picture| name.strip_prefix(picture).is_some_and(|ending| matches!(ending, ".png" | ".svg")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_run_wrote_is_replaced() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path();
        assert!(is_result(folder) && has_only_pictures(folder), "nothing is lost with an empty folder");
        std::fs::write(folder.join("overview.png"), "").unwrap();
        assert!(is_result(folder) && has_only_pictures(folder));
        std::fs::write(folder.join(REPORT), r#"{ "schema": 1, "catchment": "0.1.0" }"#).unwrap();
        assert!(is_result(folder) && !has_only_pictures(folder));
        std::fs::write(folder.join(REPORT), "{}").unwrap();
        assert!(!is_result(folder));
        std::fs::remove_file(folder.join(REPORT)).unwrap();
        std::fs::write(folder.join("holiday.png"), "").unwrap();
        assert!(!is_result(folder) && !has_only_pictures(folder));
        assert!(!is_result(&folder.join("holiday.png")) && !is_result(&folder.join("nowhere")));
    }
}
