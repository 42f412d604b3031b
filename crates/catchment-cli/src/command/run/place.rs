//! Destinations of the files of a run.

use crate::advice;
use crate::failure::Failure;
use crate::output::{check_place, file, write_file, written};
use crate::result_args::{self, rendered};
use catchment::exec::Exec;
use catchment::pose::PoseError;
use catchment::report::figure::DrawnFigures;
use catchment::report::folder::{POSES, REPORT, RESULT};
use catchment::report::set::SetFileKind;
use catchment::report::vtk::View;
use catchment::report::write;
use catchment::report::{self, Report, Target};
use catchment::run::Answer;
use catchment::terminal::shown;
use clap::Args;
use std::path::{Path, PathBuf};

/// Where the files of a run go.
#[derive(Debug, Args)]
pub(crate) struct PlaceArgs {
    /// Write report.json, result.zarr and pictures into this folder, or a single file by its ending
    ///
    /// NAME.zarr: only the Zarr group. NAME.vti, .vtp or .csv: only the set, for ParaView or as a table, as `export` writes it. NAME.json,
    /// .md, .html or .txt: only the report. `-` is stdout: nothing is written.
    #[arg(short, long, value_name = "DIR|FILE", value_hint = clap::ValueHint::DirPath, help_heading = "Output")]
    output: Option<PathBuf>,
    /// Write only the pictures into this folder
    #[arg(long, hide_short_help = true, value_name = "DIR", value_hint = clap::ValueHint::DirPath, help_heading = "Output")]
    figures: Option<PathBuf>,
    /// Replace a file that exists
    ///
    /// A folder that catchment wrote is replaced without it, and no other folder.
    #[arg(long, requires = "output", help_heading = "Output")]
    pub(super) force: bool,
}

/// The real path, with links resolved; its last component need not exist.
fn real(path: &Path) -> Result<PathBuf, Failure> {
    let place = std::path::absolute(write::place(path)?)?;
    let known = place.ancestors().find_map(|folder| Some((folder, folder.canonicalize().ok()?)));
    Ok(match known {
        Some((folder, real)) => place.strip_prefix(folder).map_or(place.clone(), |rest| real.join(rest)),
        None => place,
    })
}

/// Destinations checked for writing, as far as this is possible beforehand.
pub(super) struct Targets<'a> {
    all: Vec<Target<'a>>,
    /// A file for the report alone.
    report: Option<(&'a Path, result_args::Kind)>,
    /// Whether existing files may be replaced.
    force: bool,
}

impl PlaceArgs {
    /// The file or the folder to write.
    pub(in crate::command) fn output(&self) -> Option<&Path> {
        file(self.output.as_deref())
    }

    /// Rejects unwritable destinations before the computation.
    pub(super) fn targets(&self) -> Result<Targets<'_>, Failure> {
        let is_group = |path: &Path| path.extension().is_some_and(|ending| ending == "zarr");
        let (output, figures) = (self.output(), self.figures.as_deref());
        if let (Some(output), Some(figures)) = (output, figures) {
            let [output, figures] = [real(output)?, real(figures)?];
            if output.starts_with(&figures) || figures.starts_with(&output) {
                let help = Some("-o alone writes the pictures too".to_owned());
                let message = "-o and --figures name the same folder, or one is inside of the other";
                return Err(Failure::with_help(message.to_owned(), help));
            }
        }
        let report = output.and_then(|path| Some((path, result_args::Kind::of_text(path)?)));
        if let Some((path, _)) = report {
            check_place(path, self.force)?;
        }
        let output = output.filter(|_| report.is_none()).map(|path| match SetFileKind::of(path) {
            Some(kind) => Target::Set(path, kind),
            None if is_group(path) => Target::Group(path),
            None => Target::Folder(path),
        });
        let targets: Vec<Target> = figures.map(Target::Pictures).into_iter().chain(output).collect();
        for target in &targets {
            match target {
                Target::Set(path, _) => check_place(path, self.force)?,
                _ => target.check(&Exec::new())?,
            }
        }
        Ok(Targets { all: targets, report, force: self.force })
    }

    /// Whether only pictures are requested.
    pub(super) const fn wants_figures_alone(&self) -> bool {
        self.figures.is_some()
    }
}

/// The accepted set as a file for another program.
fn set(answer: &Answer, kind: SetFileKind, exec: &Exec) -> Result<Vec<u8>, Failure> {
    let heights = answer.by_products.landscape.as_ref().map(|landscape| &landscape.heights[..]);
    if answer.grid().is_none() && kind == SetFileKind::Table {
        return Ok(report::cells(&answer.acceptance, None, exec)?);
    }
    let view = View::new(&answer.acceptance, heights, None, &PoseError::default())?;
    Ok(kind.bytes(&view, &answer.acceptance, heights, exec)?)
}

impl Targets<'_> {
    /// Whether pictures are drawn.
    pub(super) fn draw(&self) -> bool {
        self.all.iter().any(|target| !matches!(target, Target::Group(_) | Target::Set(..)))
    }

    /// Whether an output requires a grid.
    pub(super) fn need_grid(&self) -> bool {
        let needs = |target: &Target<'_>| match target {
            Target::Group(_) | Target::Set(_, SetFileKind::Image | SetFileKind::Border) => true,
            Target::Folder(_) | Target::Pictures(_) | Target::Set(_, SetFileKind::Table) => false,
        };
        self.all.iter().any(needs)
    }

    /// Whether the heights over the grid are written.
    pub(super) fn want_heights(&self) -> bool {
        self.all.iter().any(|target| !matches!(target, Target::Pictures(_)))
    }

    /// Writes all files and returns notes on them.
    pub(super) fn write(
        &self,
        answer: &Answer,
        report: &Report,
        exec: &Exec,
    ) -> Result<Vec<String>, Failure> {
        let drawn = if self.draw() { DrawnFigures::of(answer, exec)? } else { DrawnFigures::default() };
        let mut notes = drawn.left_out.clone();
        if let Some((path, kind)) = self.report {
            write_file(path, &rendered(kind, report, &report.described_with(advice::flags))?, self.force)?;
        }
        for target in &self.all {
            notes.push(match target {
                Target::Pictures(path) => {
                    let saved = report::save_pictures(path, &drawn, exec)?;
                    written(path);
                    format!("wrote {} pictures as PNG and SVG into {}", saved.pictures, shown(path))
                }
                Target::Group(path) => {
                    report::save_group(answer, path, exec)?;
                    written(path);
                    format!("wrote {}", shown(path))
                }
                Target::Set(path, kind) => {
                    write_file(path, &set(answer, *kind, exec)?, self.force)?;
                    format!("wrote {}", shown(path))
                }
                Target::Folder(path) => {
                    let pictures = report::save_drawn(answer, path, &drawn, exec)?.pictures;
                    written(path);
                    let place = shown(path);
                    let set = if answer.grid().is_some() { RESULT } else { POSES };
                    format!("wrote {place}: {REPORT}, {set}, {pictures} pictures as PNG and SVG")
                }
            });
        }
        Ok(notes)
    }
}
