//! The accepted set as a file for another program, by file extension.
//!
//! | extension | content | for |
//! |---|---|---|
//! | `.vti` | every cell over up to three axes | [`image`], ParaView and `vtk` |
//! | `.vtp` | the border of the accepted cells over up to three axes | [`border`], ParaView, `vtk`, `pyvista` |
//! | `.csv` | every cell with all its axes | [`cells`](super::cells()), pandas and spreadsheets |

use super::cells;
use super::vtk::{View, ViewError, border, image};
use catchment_core::acceptance::Acceptance;
use catchment_core::exec::Exec;
use std::path::Path;

/// The endings, in the order of the kinds.
pub const ENDINGS: [&str; 3] = ["vti", "vtp", "csv"];

/// Content of such a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SetFileKind {
    /// Every cell, for VTK.
    Image,
    /// The border of the accepted cells, for VTK.
    Border,
    /// Every cell, as a table.
    Table,
}

impl SetFileKind {
    /// The kind that the end of a name stands for.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        let kinds = [Self::Image, Self::Border, Self::Table];
        ENDINGS
            .into_iter()
            .zip(kinds)
            .find(|(known, _)| known.eq_ignore_ascii_case(ending))
            .map(|(_, kind)| kind)
    }

    /// The file. A table has all axes, whatever the view shows.
    ///
    /// # Errors
    /// Those of [`image`], [`border`] and [`cells`](super::cells()).
    pub fn bytes(
        self,
        view: &View,
        acceptance: &Acceptance,
        heights: Option<&[f32]>,
        exec: &Exec,
    ) -> Result<Vec<u8>, ViewError> {
        match self {
            Self::Image => image(view, exec),
            Self::Border => border(view, exec),
            Self::Table => cells(acceptance, heights, exec),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_selects_the_kind() {
        let kind = |name: &str| SetFileKind::of(Path::new(name));
        assert_eq!(
            ["a.vti", "b/a.VTP", "a.csv"].map(kind),
            [SetFileKind::Image, SetFileKind::Border, SetFileKind::Table].map(Some)
        );
        assert_eq!(["a", "vti", "a.vti.gz", "a.zarr"].map(kind), [None; 4]);
    }
}
