//! Differences of two acceptances: a map of two errors, or the slices through zero of every pair in a
//! triangle.

use super::draw::axis::{ShownUnits, short};
use super::draw::colour::Rgb;
use super::draw::layout::{Layout, Legend, filled};
use super::map::{self, Map};
use super::triangle::Triangle;
use super::{FigureError, Picture};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::merit::MeritError;
use catchment_core::merit::comparison::{Comparison, Paired};
use catchment_core::merit::slice;
use catchment_core::pose::PoseError;

/// Accepted by both, only by the first, only by the second, by neither: light for agreement, strong for
/// differences.
const COLOURS: [Rgb; 4] = [[0xa9, 0xcb, 0xe6], [0xd5, 0x5e, 0x00], [0x00, 0x7a, 0x5e], [0xe6, 0xe9, 0xed]];

/// The style of the border of the first.
const BORDER: &str =
    r##"fill="none" stroke="#1f2933" stroke-width="1.2" stroke-linecap="round" stroke-linejoin="round""##;

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
    let maps = pairs.iter().map(|pair| Map::of(&paired.first, *pair, &PoseError::default()));
    let maps = maps.collect::<Result<Vec<Map>, FigureError>>()?;
    let is_central = maps.iter().all(Map::is_central);
    let sliced = (maps.len() > 1).then_some(if is_central { "through zero" } else { "beside zero" });
    let layout = Layout::titled(format!("{} (first) and {} (second)", names[0], names[1]))
        .computed(design)
        .story(story(comparison, sliced))
        .legend(legend(comparison, names));
    let triangle = Triangle::of(pairs.iter().copied());
    let (mut svg, frames) = triangle.open(layout, 0.0);
    let units = ShownUnits::of(design);
    for ((pair, map), rect) in pairs.into_iter().zip(&maps).zip(frames) {
        let second = map.slice.pick(&paired.second.outcomes);
        let colours: Vec<Rgb> =
            map.outcomes.iter().zip(&second).map(|(a, b)| COLOURS[kind(*a, *b)]).collect();
        let frame = map.frame(rect, &units);
        map.paint(&mut svg, &frame, &colours)?;
        map::zero_lines(&mut svg, &frame);
        svg.path(&map.border(&frame), BORDER);
        triangle.draw(&mut svg, pair, &frame);
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

fn legend(c: &Comparison, names: [&str; 2]) -> Legend {
    let share = |n: usize| short(100.0 * n as f64 / c.poses.max(1) as f64);
    let both = c.confusion[0][0];
    let neither = c.poses - both - c.only_first - c.only_second;
    let counts = [both, c.only_first, c.only_second, neither];
    let words = ["both accept", "only the first", "only the second", "none"];
    let entries = COLOURS.into_iter().zip(words).zip(counts);
    entries
        .fold(Legend::default(), |legend, ((colour, words), count)| {
            legend.square(filled(colour), format!("{words} {} %", share(count)))
        })
        .line(BORDER, format!("border of {}", names[0]))
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use crate::schema::testing::{blob, design};
    use catchment_core::acceptance::Acceptance;
    use catchment_core::exec::Exec;
    use catchment_core::pose::{Dof, DofSet};

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
