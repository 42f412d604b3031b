//! Output of a result to files: complete or absent.
//!
//! ```text
//!   save           DIR/report.json, DIR/result.zarr, and every picture as .png and .svg
//!   save_group     NAME.zarr, the Zarr group alone
//!   save_pictures  DIR, every picture alone
//!   save_set       one file for another program: NAME.vti, NAME.vtp, NAME.csv
//! ```

use super::cells;
use super::figure::DrawnFigures;
use super::folder::{POSES, REPORT, RESULT, SaveError, encode, save_files, write_all};
use super::vtk::View;
use super::write::{self, WriteError};
use super::{Report, SlicesReport, SweepReport, set, zarr};
use catchment_core::exec::Exec;
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;
use catchment_core::run::{Answer, RunError};
use catchment_study::slices::Slices;
use std::path::Path;

/// The kind of a folder with everything.
const RUN: &str = "run";
/// The kind of a folder with pictures alone.
const PICTURES: &str = "pictures";

/// The files written, and the pictures that could not be drawn, with the reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Saved {
    /// Pictures, each as PNG and SVG.
    pub pictures: usize,
    /// Pictures that were left out, with the reason.
    pub left_out: Vec<String>,
}

/// Writes report, grid and pictures into a folder, which must not exist or hold an older result.
///
/// # Errors
/// Whatever the system refuses. Nothing is left behind and an older result stays as it was.
pub fn save(answer: &Answer, path: impl AsRef<Path>, exec: &Exec) -> Result<Saved, SaveError> {
    let drawn = DrawnFigures::of(answer, exec)?;
    save_drawn(answer, path.as_ref(), &drawn, exec)
}

/// The same with pictures that were drawn before.
///
/// # Errors
/// Those of [`save`].
pub fn save_drawn(
    answer: &Answer,
    path: &Path,
    drawn: &DrawnFigures,
    exec: &Exec,
) -> Result<Saved, SaveError> {
    let pictures = encode(&drawn.pictures, exec)?;
    let report = Report::of_answer(answer);
    let json = report.to_json()?;
    write::folder(path, RUN, exec, |folder| -> Result<(), SaveError> {
        write_all(folder, &pictures, exec)?;
        if answer.grid().is_some() {
            zarr::write(&folder.join(RESULT), &report, &answer.acceptance, &layers(answer), exec)?;
        } else {
            write::part(folder, POSES, &cells(&answer.acceptance, None, exec)?)?;
        }
        write::part(folder, REPORT, json.as_bytes())?;
        Ok(exec.check()?)
    })?;
    Ok(Saved { pictures: drawn.pictures.len(), left_out: drawn.left_out.clone() })
}

/// Writes the Zarr group alone.
///
/// # Errors
/// Those of [`save`].
pub fn save_group(answer: &Answer, path: &Path, exec: &Exec) -> Result<(), SaveError> {
    Ok(zarr::write(path, &Report::of_answer(answer), &answer.acceptance, &layers(answer), exec)?)
}

/// Writes pictures alone.
///
/// # Errors
/// Those of [`save`].
pub fn save_pictures(path: &Path, drawn: &DrawnFigures, exec: &Exec) -> Result<Saved, SaveError> {
    let pictures = encode(&drawn.pictures, exec)?;
    save_files(path, PICTURES, &pictures, exec)?;
    Ok(Saved { pictures: drawn.pictures.len(), left_out: drawn.left_out.clone() })
}

/// Writes only the set, over its first three axes if it has more: a file for another program, which must not
/// exist.
///
/// # Errors
/// Errors of the system, or a set that cannot be shown in this form. Nothing is left behind.
pub fn save_set(answer: &Answer, path: &Path, kind: set::SetFileKind, exec: &Exec) -> Result<(), SaveError> {
    let heights = layers(answer).heights;
    if answer.grid().is_none() && kind == set::SetFileKind::Table {
        return Ok(write::file(path, &cells(&answer.acceptance, None, exec)?, false)?);
    }
    let view = View::new(&answer.acceptance, heights, None, &PoseError::default())?;
    Ok(write::file(path, &kind.bytes(&view, &answer.acceptance, heights, exec)?, false)?)
}

fn layers(answer: &Answer) -> zarr::CellLayers<'_> {
    zarr::CellLayers {
        heights: answer.by_products.landscape.as_ref().map(|landscape| &landscape.heights[..]),
        watersheds: answer.by_products.watersheds.as_ref(),
    }
}

/// Writes a Zarr group such as `x-pitch.zarr` for each slice into a folder.
///
/// # Errors
/// Whatever the system refuses.
pub fn save_slices(
    slices: &Slices,
    folder: &Path,
    problem: &Problem,
    report: &SlicesReport,
    exec: &Exec,
) -> Result<(), SaveError> {
    let settings = report.settings.method.settings();
    for (slice, of) in slices.slices.iter().zip(&report.slices) {
        exec.check()?;
        let whole = Report::new(problem.design(), &slice.acceptance, settings.clone(), None, exec)
            .map_err(RunError::from)?;
        zarr::write(
            &folder.join(of.name() + ".zarr"),
            &whole,
            &slice.acceptance,
            &zarr::CellLayers::default(),
            exec,
        )?;
    }
    Ok(())
}

impl SweepReport {
    /// Writes the Zarr group `sweep.zarr` into a folder that is being filled.
    ///
    /// # Errors
    /// Errors of the system, or the computation is cancelled.
    pub fn save_group(&self, folder: &Path, exec: &Exec) -> Result<(), SaveError> {
        Ok(zarr::fill_sweep(folder, self, exec)?)
    }
}

/// Target of the files of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target<'a> {
    /// Everything, into a folder.
    Folder(&'a Path),
    /// The Zarr group alone.
    Group(&'a Path),
    /// Pictures alone, into a folder.
    Pictures(&'a Path),
    /// The set alone, as a file for another program.
    Set(&'a Path, set::SetFileKind),
}

impl Target<'_> {
    /// Refuses a place that cannot be written, before anything is computed.
    ///
    /// # Errors
    /// Something else is there, another process keeps it locked, or its parent is no folder.
    pub fn check(&self, exec: &Exec) -> Result<(), WriteError> {
        if let Self::Folder(path) | Self::Group(path) = self {
            write::check_utf8(path)?;
        }
        match self {
            Self::Folder(path) => write::check_folder(path, RUN, exec),
            Self::Group(path) => write::check_folder(path, zarr::KIND, exec),
            Self::Pictures(path) => write::check_folder(path, PICTURES, exec),
            Self::Set(path, _) => write::check_file(path, false),
        }
    }
}
