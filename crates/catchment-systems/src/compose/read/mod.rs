//! Text formats of regions.
//!
//! | file | content |
//! |---|---|
//! | `.csv` | corners: `x,y` or `x,y,ring`, in mm or with a unit in the names of the columns (`x [cm]`) |
//! | `.svg` | all its paths; one user unit is a mm unless the picture has a width in a unit; y is turned up |
//! | `.toml` with `[sweep]` | a shape and how it moves: see [`sweep`](super::sweep) |
//! | `.toml` with `[connector]` | a connector design: the offsets that it corrects without rotation (ZRAA) |
//!
//! Rings close automatically. A point inside an odd number of rings belongs to the region, so a ring in a
//! ring is a hole. Rings may touch; they may not cross.

mod csv;
mod rings;
mod svg;
mod sweep;

use super::region::Region;
use super::sum::SumError;
use super::sweep::Bracket;
use crate::form::{Form, FormTable};
use catchment::design::{LengthUnit, SourceText};
use catchment::diagnostic::{Diagnostic, Diagnostics};
use catchment::exec::Exec;
use catchment::method::zraa::{self, Zraa, ZraaError};
use catchment::problem::{Draft, ProblemError};
use catchment::terminal::shown;
use glam::DVec2;
use serde::Serialize;

/// Unit of lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Measure {
    /// Millimetres.
    #[serde(rename = "mm")]
    Millimetres,
    /// Widths of a connector without a unit of length.
    #[serde(rename = "D")]
    Widths,
}

impl Measure {
    /// As it is written beside a number.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Millimetres => "mm",
            Self::Widths => "D",
        }
    }
}

/// A region that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParsedRegion {
    /// Its name.
    pub name: String,
    /// The region.
    pub region: Bracket,
    /// Unit of its lengths.
    pub measure: Measure,
    /// Notes about it.
    pub notes: Vec<String>,
}

/// Why a file gives no region.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// Errors of the text.
    #[error(transparent)]
    Diagnostics(#[from] Diagnostics),
    /// Errors of the connector.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// The connector has no region.
    #[error(transparent)]
    Zraa(#[from] ZraaError),
    /// The sweep is too fine.
    #[error(transparent)]
    Sum(#[from] SumError),
}

/// Content of a TOML file.
enum Toml {
    Connector,
    Swept(sweep::Swept),
}

/// Reads a region; the file's extension determines its content.
///
/// # Errors
/// All errors of the file.
pub fn read(source: SourceText, exec: &Exec) -> Result<ParsedRegion, ReadError> {
    let ending = source.path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let stem = source.path.file_stem().and_then(|s| s.to_str()).unwrap_or("region").to_owned();
    match ending.as_str() {
        "csv" => csv::read(source, stem),
        "svg" => svg::read(source, stem),
        "toml" => {
            let kind = Form::read(source.clone(), |form: &mut Form<'_>, root: &FormTable<'_>| {
                if root.has("connector") {
                    Toml::Connector
                } else {
                    Toml::Swept(sweep::fill(form, root, &stem))
                }
            })?;
            match kind {
                Toml::Swept(swept) => Ok(swept.read()?),
                Toml::Connector => of_connector(Draft::read(source)?, exec),
            }
        }
        _ => {
            let help = "a region is read from .csv, .svg or .toml".to_owned();
            let message = format!("cannot tell what is in {}", shown(&source.path));
            Err(Diagnostics::from(Diagnostic::error("region", message, Some(help))).into())
        }
    }
}

/// The offsets that a connector corrects without rotation, in mm if it has a unit.
fn of_connector(draft: Draft, exec: &Exec) -> Result<ParsedRegion, ReadError> {
    let problem = draft.build()?;
    let design = problem.design();
    let zraa = zraa::run(problem.pair(), &zraa::ZraaSettings::default(), exec)?;
    let (measure, factor) = match design.unit {
        Some(unit) => (Measure::Millimetres, design.width * unit.metres() / LengthUnit::Mm.metres()),
        None => (Measure::Widths, 1.0),
    };
    let region = match zraa {
        Zraa::Region { polygons, .. } => {
            let polygons: Vec<Region> = polygons
                .iter()
                .map(|p| Region::of_outlines(&[p.iter().map(|c| *c * factor).collect::<Vec<DVec2>>()]))
                .collect();
            Region::union(&polygons)
        }
        Zraa::Interval { axis, from, to } => {
            let unit = if axis == catchment::pose::Dof::X { DVec2::X } else { DVec2::Y };
            Region::segment(unit * from * factor, unit * to * factor)
        }
    };
    let notes = vec!["offsets that the connector corrects without rotation".to_owned()];
    Ok(ParsedRegion { name: design.name.clone(), region: Bracket::exact(region), measure, notes })
}
