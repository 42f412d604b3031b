//! The height of first contact over all lateral offsets, as a set of planes.

use super::sheet::Sheet;
use super::{MAX_SHEETS, ZraaError, ZraaSettings, cells, sheet};
use crate::connector::Half;
use crate::exec::Exec;
use glam::DVec2;

/// A part of the height function that is a single plane.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightFacet {
    /// Corners of the offsets, counter-clockwise, in D.
    pub polygon: Vec<DVec2>,
    /// Height over offset (0, 0), in D.
    pub offset: f64,
    /// Gradient of the height, dimensionless.
    pub gradient: DVec2,
}

impl HeightFacet {
    /// Height over an offset, in D.
    pub fn height(&self, at: DVec2) -> f64 {
        self.offset + self.gradient.dot(at)
    }
}

/// The height of first contact of a fixed and a moving half, exactly, as planes over convex polygons that
/// tile the offsets at which they touch. Halves are used as given: the height is that of the moving half's
/// origin, and nothing is rotated.
///
/// # Errors
/// If there are too many contacts, or the computation is cancelled.
pub fn heights(
    fixed: &Half,
    moving: &Half,
    settings: &ZraaSettings,
    exec: &Exec,
) -> Result<Vec<HeightFacet>, ZraaError> {
    let sheets = sheet::sheets(fixed, moving, MAX_SHEETS, exec)?.ok_or(ZraaError::TooManySheets)?;
    envelope(&sheets, settings.seam, exec)
}

/// The maximum of functions that are given as planes over convex polygons, counter-clockwise, as planes over
/// convex polygons that do not overlap.
///
/// # Errors
/// If there are too many planes, or the computation is cancelled.
pub fn highest(
    facets: impl IntoIterator<Item = HeightFacet>,
    settings: &ZraaSettings,
    exec: &Exec,
) -> Result<Vec<HeightFacet>, ZraaError> {
    let sheet = |facet: HeightFacet| Sheet {
        footprint: facet.polygon,
        offset: facet.offset,
        gradient: facet.gradient,
    };
    let sheets: Vec<Sheet> = facets.into_iter().take(MAX_SHEETS + 1).map(sheet).collect();
    if sheets.len() > MAX_SHEETS {
        return Err(ZraaError::TooManySheets);
    }
    envelope(&sheets, settings.seam, exec)
}

fn envelope(sheets: &[Sheet], seam: f64, exec: &Exec) -> Result<Vec<HeightFacet>, ZraaError> {
    let cells = cells::upper_envelope(sheets, seam, exec)?;
    let facet = |cell: cells::Cell| HeightFacet {
        offset: sheets[cell.sheet].offset,
        gradient: sheets[cell.sheet].gradient,
        polygon: cell.polygon,
    };
    Ok(cells.into_iter().map(facet).collect())
}
