//! Figures 2.1 and 4.2, drawn again from geometry and numbers.
//!
//! ```text
//!   comparison           a row per known region: the halves │ cross-section along the approach │ region, unit square, ONAA
//!                        below: every published area on one scale; the shape of most is unknown
//!   cone_over_x_face     the cone's circle around and inside the unit square, over the diamond of the X-Face
//! ```
//!
//! The rows of the published figure 2.1 are not known: here are the systems with a known region. The program
//! computes the regions of families; that of `PolyBot` is its closed form, and that of DRAGON is the circle
//! of its printed number, marked as such. Everything is drawn with width D, except for the cone around the
//! unit square, which is √2 D wide.

mod cells;
mod rows;
mod scale;

pub use cells::cone_over_x_face;
use rows::{CELLS, Row};

use super::data::Catalog;
use super::designs::DesignText;
use catchment::design::SourceText;
use catchment::exec::{Cancelled, Exec};
use catchment::method::zraa::ZraaError;
use catchment::problem::{Draft, Problem, ProblemError};
use catchment::report::figure::draw::layout::Layout;
use catchment::report::figure::{FigureError, Picture};

/// Why a picture is not drawn.
#[derive(Debug, thiserror::Error)]
pub enum DrawError {
    /// A geometry could not be built.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// A region could not be computed.
    #[error(transparent)]
    Zraa(#[from] ZraaError),
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A picture could not be made.
    #[error(transparent)]
    Figure(#[from] FigureError),
}

/// The problem of a design that the program writes.
fn problem(name: &str) -> Result<Problem, ProblemError> {
    let text = DesignText::named(name).map_or("", |design| design.text);
    Draft::read(SourceText::new(format!("{name}.toml"), text))?.build()
}

/// Rows of a block; blocks stand side by side.
const ROWS: usize = 5;
/// Width of the names before the rows and before the scale.
const NAMES: f64 = 165.0;

/// Figure 2.1: connectors, cross-sections and zero-rotation areas of acceptance, at a common scale.
///
/// # Errors
/// If a region cannot be computed, or the computation is cancelled.
pub fn comparison(catalog: &Catalog, exec: &Exec) -> Result<Picture, DrawError> {
    let rows = rows::all(catalog, exec)?;
    let story = "one scale; dotted: the unit square, of width D; dashed: the largest square in the area of acceptance (ONAA)";
    let mut layout = Layout::titled("Zero-rotation areas of acceptance of published connectors").story(story);
    // Row k of every block.
    let lines: Vec<Vec<&Row>> = (0..ROWS).map(|k| rows.iter().skip(k).step_by(ROWS).collect()).collect();
    for (k, line) in lines.iter().enumerate() {
        layout = layout.row(line.iter().flat_map(|_| rows::panels(k == 0)));
    }
    let (mut svg, frames) = layout.wide(scale::panel(catalog)).open();
    let (cells, areas) = frames.split_at(CELLS * rows.len());
    for (row, cells) in lines.into_iter().flatten().zip(cells.as_chunks::<CELLS>().0) {
        row.draw(&mut svg, cells)?;
    }
    scale::draw(&mut svg, catalog, areas[0]);
    Ok(Picture::of(svg))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_figures_are_drawn_with_their_numbers() {
        let catalog = Catalog::published().unwrap();
        let picture = comparison(&catalog, &Exec::new()).unwrap();
        let svg = picture.svg();
        for words in [
            "1.570796 D²",
            "π/2",
            "PolyBot",
            "DRAGON",
            "1.99995 D²",
            "SINGO Connector",
            "shape unknown",
            "0.0187*",
        ] {
            assert!(svg.contains(words), "{words}");
        }
        // The letters of a picture within it mean nothing.
        let drawn: String = svg
            .split("base64,")
            .enumerate()
            .map(|(k, part)| if k == 0 { part } else { part.split_once('"').map_or("", |(_, rest)| rest) })
            .collect();
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"));
        let picture = cone_over_x_face();
        assert!(picture.svg().contains("1.5708") && picture.svg().contains("0.7854"));
        if let Some(folder) = std::env::var_os("CATCHMENT_PICTURES") {
            let folder = std::path::PathBuf::from(folder);
            std::fs::write(folder.join("catalog-4.2.png"), picture.png(2.0).unwrap()).unwrap();
        }
    }
}
