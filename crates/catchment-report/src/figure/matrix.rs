//! All slices of a design in a single picture, in a triangle of maps with the halves in the free corner.

use super::draw::axis::{ShownUnits, short};
use super::draw::layout::{Layout, Legend};
use super::draw::svg::{Anchor, INK, LABEL, Rect, Svg, TICK, width_of};
use super::map::{self, Map};
use super::section::MovingHalfPose;
use super::triangle::Triangle;
use super::{FigureError, Picture, solid};
use catchment_core::connector::Connector;
use catchment_core::design::Design;
use catchment_core::document::{percent, significant};
use catchment_core::pose::{Dof, PoseError};
use catchment_study::slices::{Slice, Slices};

/// Room for the numbers of a slice over its map.
const CAPTION: f64 = 10.0;

/// Draws every slice with its Sum, its share of the plane and its ONAA square; in a triangle of three rows or more,
/// the halves.
///
/// # Errors
/// If there is no slice.
pub fn slice_matrix(design: &Design, connector: &Connector, found: &Slices) -> Result<Picture, FigureError> {
    if found.slices.is_empty() {
        return Err(FigureError::Empty { what: "no slice was computed" });
    }
    let triangle = Triangle::of(found.slices.iter().map(|slice| slice.axes));
    let has_cube = found.slices.iter().any(|slice| !slice.onaa.bounds.is_empty());
    let legend = map::outcome_squares(
        Legend::default(),
        |outcome| found.slices.iter().any(|slice| slice.sum.counts[outcome as usize - 1] > 0),
        |outcome| outcome.word().to_owned(),
        has_cube.then_some("largest square (ONAA)"),
    );
    let layout = Layout::of(design).story(subtitle(design, found)).legend(legend);
    let (mut svg, frames) = triangle.open(layout, CAPTION);
    let units = ShownUnits::of(design);
    for (slice, rect) in found.slices.iter().zip(&frames) {
        let map = Map::of(&slice.acceptance, slice.axes, &PoseError::default())?;
        let frame = map.frame(*rect, &units);
        map::inside(&mut svg, &map, &frame, &units, &slice.onaa.bounds)?;
        triangle.draw(&mut svg, slice.axes, &frame);
        caption(&mut svg, slice, *rect);
    }
    let [columns, rows] = triangle.size();
    if rows >= 3 && columns == rows {
        let right = frames.iter().map(|frame| frame.x + frame.w).fold(0.0, f64::max);
        let top = frames.iter().map(|frame| frame.y).fold(f64::INFINITY, f64::min);
        // Half of the columns, and half a map more: the lowest corner lies above the diagonal.
        let size = (0.5 + (rows / 2) as f64) * triangle.side;
        let corner = Rect { x: right - size, y: top - CAPTION, w: size, h: 0.92 * size };
        let apart = MovingHalfPose::mated(design, 0.9);
        solid::panel(&mut svg, corner, design, connector, &apart)?;
    }
    Ok(Picture::of(svg))
}

fn subtitle(design: &Design, found: &Slices) -> String {
    let free: Vec<&str> = design.alignment.free.iter().map(Dof::name).collect();
    let method = found.slices.first().map_or("descent", |slice| slice.acceptance.method);
    let varied = format!("slices through zero by {method}: two errors vary");
    match found.estimate {
        Some(e) => format!(
            "{varied}, {} are free to move  ·  estimated ONAA edge of the whole {} … {}",
            free.join(", "),
            short(e.conservative),
            short(e.optimistic)
        ),
        None => format!("{varied}, {} are free to move", free.join(", ")),
    }
}

/// The numbers of a slice, over its map.
fn caption(svg: &mut Svg, slice: &Slice, rect: Rect) {
    let sum = format!("Sum {} {}", significant(slice.sum.sum), slice.sum.unit());
    let share = format!("{sum} ({})", percent(slice.sum.fraction));
    let onaa = format!("ONAA {:.4}", slice.onaa.edge);
    let has_room = width_of(&share, TICK) + width_of(&onaa, TICK) + LABEL < rect.w;
    let y = rect.y - 6.0;
    svg.text([rect.x + 1.0, y], TICK, Anchor::Start, INK, if has_room { &share } else { &sum });
    svg.text([rect.x + rect.w - 1.0, y], TICK, Anchor::End, INK, &onaa);
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, pyramid};
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::exec::Exec;
    use catchment_core::merit::estimate::Estimate;
    use catchment_core::merit::onaa::Onaa;
    use catchment_core::merit::slice;
    use catchment_core::merit::sum::Sum;
    use catchment_core::pose::DofSet;

    /// The slices of a blob, whatever the motion would give.
    fn slices(design: &Design, cells: usize) -> Slices {
        let slice = |axes: [Dof; 2]| {
            let mut planar = design.clone();
            planar.alignment.free = axes.into_iter().collect();
            let acceptance = blob(&planar, cells);
            let sum = Sum::of(&acceptance, &planar.alignment);
            let onaa = Onaa::of(&acceptance, &Exec::new()).unwrap();
            Slice { axes, acceptance, bracket: [sum.sum; 2], sum, onaa, warnings: Vec::new() }
        };
        let all = slice::pairs(&catchment_core::landscape::Grid::over(&design.alignment, |_| 2));
        let estimate = Some(Estimate { optimistic: 0.39, conservative: 0.204 });
        Slices { slices: all.into_iter().map(slice).collect(), estimate }
    }

    #[test]
    fn ten_slices_share_four_axes_each_way() {
        let design = design(DofSet::ALL);
        let picture = slice_matrix(&design, &pyramid(), &slices(&design, 31)).unwrap();
        look("slice-matrix-5", &picture);
        let count = |words: &str| picture.svg().matches(words).count();
        // Ten maps and the halves; a label per row and column, so roll appears at both.
        assert_eq!((count("<image"), count("ONAA 0."), count("roll [deg]"), count("x [mm]")), (11, 10, 2, 1));
        assert!(count("0.2 … 0.39") == 1 && count("D·rad") == 6);
    }

    #[test]
    fn a_single_slice_and_a_chosen_few_are_drawn_with_all_their_axes() {
        let design = design(DofSet::ALL);
        let mut found = slices(&design, 21);
        found.slices.retain(|s| s.axes == [Dof::X, Dof::Pitch] || s.axes == [Dof::Roll, Dof::Yaw]);
        found.estimate = None;
        let picture = slice_matrix(&design, &pyramid(), &found).unwrap();
        look("slice-matrix-chosen", &picture);
        for label in ["x [mm]", "pitch [deg]", "roll [deg]", "yaw [deg]"] {
            assert_eq!(picture.svg().matches(label).count(), 1, "{label}");
        }
        found.slices.truncate(1);
        look("slice-matrix-1", &slice_matrix(&design, &pyramid(), &found).unwrap());
        found.slices.clear();
        assert!(matches!(slice_matrix(&design, &pyramid(), &found), Err(FigureError::Empty { .. })));
    }
}
