//! The height of first contact over all lateral offsets, as the planes it is made of.

use super::{MAX_SHEETS, Settings, ZraaError, cells, sheet};
use crate::connector::Half;
use crate::exec::Exec;
use glam::DVec2;

/// A part of the height function where it is one plane.
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

/// The largest height of first contact of several pairs of a fixed and a moving half, exactly, as planes over convex polygons
/// that tile the offsets at which any of them touches. Halves are taken as they stand: the height is that of the moving
/// half's origin, and nothing is turned.
///
/// # Errors
/// Where the contacts are too many, or the run was stopped.
pub fn heights<'h>(
    pairs: impl IntoIterator<Item = (&'h Half, &'h Half)>,
    settings: &Settings,
    exec: &Exec,
) -> Result<Vec<HeightFacet>, ZraaError> {
    let mut sheets = Vec::new();
    for (fixed, moving) in pairs {
        let left = MAX_SHEETS - sheets.len();
        sheets.extend(sheet::sheets(fixed, moving, left, exec)?.ok_or(ZraaError::TooManySheets)?);
    }
    let cells = cells::upper_envelope(&sheets, settings.seam, exec)?;
    Ok(cells
        .into_iter()
        .map(|cell| HeightFacet {
            offset: sheets[cell.sheet].offset,
            gradient: sheets[cell.sheet].gradient,
            polygon: cell.polygon,
        })
        .collect())
}
