//! All slices of a design in a single picture: a triangle of maps with common axes.
//!
//! ```text
//!      y │▒▒▒│              ╱╲   the halves, in the corner that is free
//!   roll │▒▒▒│▒▒▒│          ╲╱
//!  pitch │▒▒▒│▒▒▒│▒▒▒│
//!    yaw │▒▒▒│▒▒▒│▒▒▒│▒▒▒│
//!          x   y  roll pitch
//! ```

use super::draw::axis::{ShownUnits, short};
use super::draw::colour::{self, hex};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, TITLE, width_of};
use super::map::{self, Map};
use super::section::MovingHalfPose;
use super::{FigureError, Picture, solid};
use crate::schema::OnaaReport;
use catchment_core::acceptance::Outcome;
use catchment_core::connector::Connector;
use catchment_core::design::Design;
use catchment_core::document::{percent, significant};
use catchment_core::pose::{Dof, PoseError};
use catchment_study::slices::{Slice, Slices};

/// Room left of the maps, above them, below them, and between them to the right and downwards.
pub(super) const LEFT: f64 = 72.0;
pub(super) const TOP: f64 = 84.0;
pub(super) const BELOW: f64 = 84.0;
pub(super) const GAP: [f64; 2] = [26.0, 30.0];
/// A picture is at least this wide, so that its title and legend fit.
const LEAST_WIDTH: f64 = 560.0;

/// Draws every slice with its Sum, its share of the plane and its ONAA square; in a triangle of three rows or more,
/// the halves.
///
/// # Errors
/// If there is no slice.
pub fn slice_matrix(design: &Design, connector: &Connector, found: &Slices) -> Result<Picture, FigureError> {
    let axes = |k: usize| -> Vec<Dof> {
        Dof::ALL.into_iter().filter(|dof| found.slices.iter().any(|s| s.axes[k] == *dof)).collect()
    };
    let (columns, rows) = (axes(0), axes(1));
    if columns.is_empty() {
        return Err(FigureError::Empty { what: "no slice was computed" });
    }
    let side = match columns.len().max(rows.len()) {
        1 => 400.0,
        2 => 280.0,
        3 => 230.0,
        _ => 196.0,
    };
    let extent = |n: usize, gap: f64| n as f64 * (side + gap) - gap;
    let maps = [extent(columns.len(), GAP[0]), extent(rows.len(), GAP[1])];
    let story = subtitle(design, found);
    let least = LEAST_WIDTH.max(48.0 + width_of(&story, LABEL));
    let (width, height) = ((LEFT + maps[0] + 28.0).max(least), TOP + maps[1] + BELOW);
    let mut svg = Svg::new(width, height);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &design.name);
    svg.text([24.0, 50.0], LABEL, Anchor::Start, SOFT, &story);

    let units = ShownUnits::of(design);
    let at = |axes: &[Dof], dof: Dof| axes.iter().position(|a| *a == dof).unwrap_or(0);
    for slice in &found.slices {
        let (column, row) = (at(&columns, slice.axes[0]), at(&rows, slice.axes[1]));
        let place = [column, row].map(|k| k as f64);
        let rect = Rect {
            x: LEFT + place[0] * (side + GAP[0]),
            y: TOP + place[1] * (side + GAP[1]),
            w: side,
            h: side,
        };
        let map = Map::of(&slice.acceptance, slice.axes, &PoseError::default())?;
        let frame = map.frame(rect, &units);
        map::inside(&mut svg, &map, &frame, &units, &OnaaReport::from(slice.onaa.clone()).bounds)?;
        frame.outline(&mut svg);
        let shares = |other: &&Slice, k: usize| other.axes[k] == slice.axes[k];
        let is_lowest = !found.slices.iter().any(|s| shares(&s, 0) && s.axes[1] > slice.axes[1]);
        let is_first = !found.slices.iter().any(|s| shares(&s, 1) && s.axes[0] < slice.axes[0]);
        if is_lowest {
            frame.below(&mut svg);
        }
        if is_first {
            frame.beside(&mut svg);
        }
        caption(&mut svg, slice, rect);
    }
    if rows.len() >= 3 && columns.len() == rows.len() {
        let size = extent(rows.len() / 2, GAP[0]) + 0.5 * side;
        let corner = Rect { x: width - 20.0 - size, y: 66.0, w: size, h: size * 0.92 };
        let apart = MovingHalfPose { error: SHOWN, height: 0.9 - design.alignment.center_of_rotation };
        solid::panel(&mut svg, corner, design, connector, &apart)?;
    }
    legend(&mut svg, found, height - 20.0);
    Ok(Picture::of(svg))
}

/// Pose of the moving half: straight above, as at the centre of the slices.
const SHOWN: PoseError = PoseError { x: 0.0, y: 0.0, roll: 0.0, pitch: 0.0, yaw: 0.0 };

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

/// The outcomes that occur in any slice, from left to right.
fn legend(svg: &mut Svg, found: &Slices, y: f64) {
    let occurs = |o: &Outcome| found.slices.iter().any(|s| s.sum.counts[*o as usize - 1] > 0);
    let swatch = |x: f64| Rect { x, y: y - 10.0, w: 13.0, h: 13.0 };
    let mut x = 24.0;
    let mut word = |svg: &mut Svg, words: &str, style: &str| {
        svg.rect(swatch(x), style);
        svg.text([x + 19.0, y + 0.5], LABEL, Anchor::Start, INK, words);
        x += 41.0 + width_of(words, LABEL);
    };
    for outcome in Outcome::ALL.into_iter().filter(occurs) {
        let fill = hex(colour::outcome(outcome));
        let style = format!(r#"fill="{fill}" stroke="{INK}" stroke-opacity="0.35" stroke-width="0.7""#);
        word(svg, outcome.word(), &style);
    }
    if found.slices.iter().any(|s| !s.onaa.bounds.is_empty()) {
        word(svg, "largest square (ONAA)", &format!(r#"fill="none" stroke="{INK}" stroke-width="1.7""#));
    }
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
