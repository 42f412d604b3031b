//! The picture of a design: its halves, its area of acceptance, its heights, side by side.

use super::axis::{Units, short};
use super::map::{self, Map};
use super::section::Placement;
use super::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TITLE};
use super::{FigureError, Picture, heights, solid};
use crate::acceptance::Acceptance;
use crate::connector::Connector;
use crate::design::Design;
use crate::merit::MeritError;
use crate::merit::onaa::Onaa;
use crate::merit::sum::Sum;
use crate::pose::{Dof, PoseError};

/// Draws an overview over a pair of errors, the others zero. The numbers are those of `acceptance` and its largest
/// cube; the maps show `slice`, which may be the same, or a finer grid over the pair alone. `height` as in [`super::heights()`], for a cell
/// of `slice`.
///
/// # Errors
/// Those of its parts.
pub fn overview(
    design: &Design,
    connector: &Connector,
    acceptance: &Acceptance,
    onaa: &Onaa,
    slice: &Acceptance,
    height: &dyn Fn(usize) -> f64,
    pair: [Dof; 2],
) -> Result<Picture, FigureError> {
    let grid = acceptance.grid().ok_or(MeritError::NotAGrid)?;
    let units = Units::of(design);
    let map = Map::of(slice, pair, &PoseError::default())?.within(acceptance, pair)?;
    let sum = Sum::of(acceptance, &design.alignment);
    let (side, top) = (300.0, 96.0);
    let (total_width, total_height) = (1130.0, top + side + 84.0);
    let mut svg = Svg::new(total_width, total_height);
    svg.bold([24.0, 32.0], TITLE + 2.0, Anchor::Start, &design.name);
    let numbers = format!(
        "Sum {} {}  ·  {} % of the error box  ·  ONAA edge {}  ·  by {}",
        short(sum.sum),
        sum.unit(),
        short(100.0 * sum.fraction),
        short(onaa.edge),
        acceptance.method
    );
    svg.text([24.0, 53.0], LABEL, Anchor::Start, SOFT, &numbers);

    let heading =
        |svg: &mut Svg, x: f64, words: &str| svg.text([x, top - 12.0], LABEL, Anchor::Start, INK, words);
    let error = PoseError { x: 0.2, pitch: 0.2, ..PoseError::default() };
    let only_free = |dof: Dof, value: f64| if design.alignment.free.contains(dof) { value } else { 0.0 };
    let error =
        PoseError { x: only_free(Dof::X, error.x), pitch: only_free(Dof::Pitch, error.pitch), ..error };
    let apart = Placement { error, height: 0.9 - design.alignment.center_of_rotation };
    heading(&mut svg, 24.0, "the two halves");
    let picture = Rect { x: 14.0, y: top, w: side + 10.0, h: side + 30.0 };
    solid::panel(&mut svg, picture, design, connector, &apart)?;

    let sliced = if grid.axes.len() > 2 { ", slice through zero" } else { "" };
    let middle = Rect { x: 392.0, y: top, w: side, h: side };
    heading(&mut svg, middle.x, &format!("area of acceptance{sliced}"));
    map::outcomes(&mut svg, &map, &map.frame(middle, &units), &units, Some(onaa))?;
    map::legend(&mut svg, acceptance, !onaa.bounds.is_empty(), [middle.x, total_height - 22.0]);

    let right = Rect { x: 762.0, y: top, w: side, h: side };
    heading(&mut svg, right.x, "height of first contact");
    heights::panel(&mut svg, &map, right, &units, height)?;
    Ok(Picture { svg: svg.finish() })
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, pyramid};
    use super::*;
    use crate::report::schema::testing::{blob, design};

    #[test]
    fn it_shows_halves_acceptance_and_heights() {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let acceptance = blob(&design, 80);
        let grid = acceptance.grid().unwrap();
        let height = |i: usize| {
            let e = grid.pose(i);
            0.5 * e.x.abs() + 0.3 * (e.pitch + 0.4 * e.x).abs()
        };
        let onaa = Onaa::of(&acceptance, &crate::exec::Exec::new()).unwrap();
        let drawn = || {
            let pair = [Dof::X, Dof::Pitch];
            overview(&design, &pyramid(), &acceptance, &onaa, &acceptance, &height, pair).unwrap()
        };
        let picture = drawn();
        look("overview", &picture);
        assert!(picture.svg().contains("Sum "));
        assert_eq!(picture, drawn());
    }
}
