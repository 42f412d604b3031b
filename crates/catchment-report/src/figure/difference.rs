//! Differences of two acceptances: a map of two errors, or the slices through zero of every pair in a
//! triangle.

use super::draw::axis::{ShownUnits, short};
use super::draw::colour::{Rgb, hex};
use super::draw::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, TITLE, width_of};
use super::map::{self, Map};
use super::{FigureError, Picture};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::merit::MeritError;
use catchment_core::merit::comparison::{Comparison, Paired};
use catchment_core::merit::slice;
use catchment_core::pose::{Dof, PoseError};

/// Accepted by both, only by the first, only by the second, by neither: light for agreement, strong for
/// differences.
const COLOURS: [Rgb; 4] = [[0xa9, 0xcb, 0xe6], [0xd5, 0x5e, 0x00], [0x00, 0x7a, 0x5e], [0xe6, 0xe9, 0xed]];

/// Room left of the maps, above them, below them, and between them to the right and downwards.
const LEFT: f64 = 72.0;
const TOP: f64 = 84.0;
const BELOW: f64 = 84.0;
const GAP: [f64; 2] = [26.0, 22.0];

/// Draws the differences of two acceptances of the same errors, with the border of the first. `names` are the
/// names of the two; axes have the design's unit.
///
/// # Errors
/// Fewer than two errors, listed poses.
pub fn difference(
    design: &Design,
    paired: &Paired,
    comparison: &Comparison,
    names: [&str; 2],
) -> Result<Picture, FigureError> {
    let grid = paired.first.grid().ok_or(MeritError::NotAGrid)?;
    let pairs = map::pairs_or_all(grid, &slice::pairs(grid))?;
    let dofs: Vec<Dof> = grid.axes.iter().map(|axis| axis.dof).collect();
    let (columns, rows) = (&dofs[..dofs.len() - 1], &dofs[1..]);
    let side = match rows.len() {
        1 => 420.0,
        2 => 300.0,
        3 => 240.0,
        _ => 200.0,
    };
    let extent = |gap: f64| rows.len() as f64 * (side + gap) - gap;
    let legend = legend_entries(comparison, names);
    let legend_width: f64 = legend.iter().map(|(_, words)| 41.0 + width_of(words, LABEL)).sum();
    let (width, height) =
        ((LEFT + extent(GAP[0]) + 28.0).max(legend_width + 26.0), TOP + extent(GAP[1]) + BELOW);
    let mut svg = Svg::new(width, height);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &format!("{} (first) and {} (second)", names[0], names[1]));
    let maps = pairs.iter().map(|pair| Map::of(&paired.first, *pair, &PoseError::default()));
    let maps = maps.collect::<Result<Vec<Map>, FigureError>>()?;
    let is_central = maps.iter().all(Map::is_central);
    let sliced = (rows.len() > 1).then_some(if is_central { "through zero" } else { "beside zero" });
    svg.text([24.0, 50.0], LABEL, Anchor::Start, SOFT, &story(comparison, sliced));
    // A single map sits in the middle over its legend.
    let left = if rows.len() == 1 { LEFT + 0.5 * (width - LEFT - side - 28.0) } else { LEFT };
    let units = ShownUnits::of(design);
    let at = |axes: &[Dof], dof: Dof| axes.iter().position(|axis| *axis == dof).unwrap_or(0);
    for (pair, map) in pairs.iter().zip(&maps) {
        let (column, row) = (at(columns, pair[0]), at(rows, pair[1]));
        let rect = Rect {
            x: left + column as f64 * (side + GAP[0]),
            y: TOP + row as f64 * (side + GAP[1]),
            w: side,
            h: side,
        };
        let second = map.slice.pick(&paired.second.outcomes);
        let colours: Vec<Rgb> =
            map.outcomes.iter().zip(&second).map(|(a, b)| COLOURS[kind(*a, *b)]).collect();
        let frame = map.frame(rect, &units);
        map.paint(&mut svg, &frame, &colours)?;
        map::zero_lines(&mut svg, &frame);
        let line = format!(r#"fill="none" stroke="{INK}" stroke-width="1.2" {JOIN}"#);
        svg.path(&map.border(&frame), &line);
        frame.outline(&mut svg);
        if row + 1 == rows.len() {
            frame.below(&mut svg);
        }
        if column == 0 {
            frame.beside(&mut svg);
        }
    }
    let (mut x, y) = (24.0, height - 20.0);
    for (fill, words) in legend {
        let style = fill.map_or_else(
            || format!(r#"fill="none" stroke="{INK}" stroke-width="1.2""#),
            |fill| format!(r#"fill="{}" stroke="{INK}" stroke-opacity="0.35" stroke-width="0.7""#, hex(fill)),
        );
        svg.rect(Rect { x, y: y - 10.0, w: 13.0, h: 13.0 }, &style);
        svg.text([x + 19.0, y + 0.5], LABEL, Anchor::Start, INK, &words);
        x += 41.0 + width_of(&words, LABEL);
    }
    Ok(Picture::of(svg))
}

/// Position in [`COLOURS`].
fn kind(first: Outcome, second: Outcome) -> usize {
    match (first == Outcome::Aligned, second == Outcome::Aligned) {
        (true, true) => 0,
        (true, false) => 1,
        (false, true) => 2,
        (false, false) => 3,
    }
}

fn story(c: &Comparison, sliced: Option<&str>) -> String {
    let [agreement, jaccard] = [100.0 * c.agreement, c.jaccard].map(short);
    let ratio =
        c.sum_ratio.map_or_else(String::new, |ratio| format!("  ·  Sum second / first {}", short(ratio)));
    let slices =
        sliced.map_or_else(String::new, |place| format!("  ·  slices {place}, shares of the whole grid"));
    format!("they agree on {agreement} % of the cells  ·  Jaccard {jaccard}{ratio}{slices}")
}

/// Fill (none for the border) and words.
fn legend_entries(c: &Comparison, names: [&str; 2]) -> Vec<(Option<Rgb>, String)> {
    let share = |n: usize| short(100.0 * n as f64 / c.poses.max(1) as f64);
    let both = c.confusion[0][0];
    let neither = c.poses - both - c.only_first - c.only_second;
    let counts = [both, c.only_first, c.only_second, neither];
    let words = ["both accept", "only the first", "only the second", "none"];
    let mut entries: Vec<_> = COLOURS
        .into_iter()
        .zip(words)
        .zip(counts)
        .map(|((colour, words), count)| (Some(colour), format!("{words} {} %", share(count))))
        .collect();
    entries.push((None, format!("border of {}", names[0])));
    entries
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::acceptance::Acceptance;
    use catchment_core::exec::Exec;
    use catchment_core::pose::DofSet;

    fn drawn(free: DofSet, cells: usize) -> Result<Picture, FigureError> {
        let design = design(free);
        let first = blob(&design, cells);
        let shift = |k: usize| first.outcomes[(k + 2) % first.outcomes.len()];
        let second = Acceptance { outcomes: (0..first.outcomes.len()).map(shift).collect(), ..first.clone() };
        let paired = Paired::of(&first, &second).unwrap();
        let comparison = Comparison::of(&paired, &design.alignment, &Exec::new()).unwrap();
        difference(&design, &paired, &comparison, ["descent", "flood"])
    }

    #[test]
    fn two_errors_are_a_map_and_more_a_triangle() {
        for (name, free, cells, maps) in [
            ("difference-2", [Dof::X, Dof::Pitch].into_iter().collect(), 61, 1),
            ("difference-3", [Dof::X, Dof::Y, Dof::Yaw].into_iter().collect(), 31, 3),
            ("difference-5", DofSet::ALL, 9, 10),
        ] {
            let picture = drawn(free, cells).unwrap();
            look(name, &picture);
            assert_eq!(picture.svg().matches("<image").count(), maps);
            assert!(picture.svg().contains("only the first") && picture.svg().contains("x [mm]"));
            assert_eq!(picture.svg().contains("slices through zero, shares of the whole grid"), maps > 1);
        }
        let one = drawn([Dof::X].into_iter().collect(), 61);
        assert!(matches!(one, Err(FigureError::Empty { .. })));
    }
}
