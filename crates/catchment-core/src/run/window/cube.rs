//! The largest cubes of a run, by exact motions: the centred cube, and the largest cube at any position
//! (ONAA).
//!
//! ```text
//!      cells            motions
//!    ┌─┬─┬─┬─┬─┐
//!    │ │░│░│░│ │        ┌─────┐          the cells give the centre; the window search gives the size of the cube
//!    │ │░│░│░│ │   ──▶  │  ·  │          about this centre, until all sampled poses in it dock
//!    │ │ │ │ │ │        └─────●
//!    └─┴─┴─┴─┴─┘
//! ```
//!
//! A cube of cells ends on their borders, and in five dimensions its corners are coarse: for the 3-D X-Face
//! 12⁵ cells give 0.167, while poses fail from 0.148 on.
//!
//! Not promised: that no pose in it fails; no failure was found among the sampled poses ([`Effort::random`])
//! and about twice as many poses of a search for failures. Nor that no larger cube exists elsewhere. Its
//! centre is that of the largest cube of cells, or zero if the cube there is larger.

use super::WindowSettings;
use super::search::{Search, Shrunk};
use super::space::Space;
use crate::acceptance::Outcome;
use crate::exec::{Cancelled, Exec};
use crate::landscape::Grid;
use crate::merit::Merits;
use crate::merit::centered::CenteredBox;
use crate::merit::onaa::{Interval, Onaa};
use crate::merit::tolerance::Tolerance;
use crate::method::descent;
use crate::pose::{Dof, DofSet, PoseError};
use crate::problem::Problem;

/// With which motions cubes are sought, and with how many.
pub(in crate::run) struct Effort<'a> {
    pub(in crate::run) seed: u64,
    /// Number of samples of a cube, none of which may fail. After twice as many motions only samples search
    /// for failures.
    pub(in crate::run) random: usize,
    pub(in crate::run) motions: &'a descent::DescentSettings,
}

/// Replaces the cubes of cells by those from motions; without cells only the centred cube exists. It may be
/// known already: as a window in the proportions of the error box.
pub(in crate::run) fn follow(
    merits: &mut Merits,
    centered: Option<CenteredBox>,
    problem: &Problem,
    grid: &Grid,
    by: &Effort<'_>,
    exec: &Exec,
) -> Result<(), Cancelled> {
    let about = |center: [f64; 5], least: f64| about(problem, center, least, by, exec);
    let sides = |scale: f64| -> Vec<(Dof, f64)> {
        grid.axes.iter().map(|axis| (axis.dof, 0.5 * scale * (axis.hi - axis.lo))).collect()
    };
    let centered = if let Some(known) = centered {
        known
    } else {
        let Cube { scale, reaches_border, limited_by } = about([0.0; 5], 0.0)?;
        CenteredBox::of(scale, sides(scale), reaches_border, Some(by.random), limited_by)
    };
    let centered = within(&centered, &merits.tolerances);
    let mut center = [0.0; 5];
    let of_cells = merits.onaa.take().map(|onaa| onaa.bounds);
    for Interval { axis, lo, hi } in of_cells.iter().flatten() {
        center[axis.index()] = 0.5 * (lo + hi);
    }
    // A box no larger than the centred box is not reported.
    let is_elsewhere = center.iter().any(|middle| middle.abs() > 1e-9);
    let elsewhere = if is_elsewhere { about(center, centered.edge)?.scale } else { 0.0 };
    let (edge, center) =
        if centered.edge >= elsewhere { (centered.edge, [0.0; 5]) } else { (elsewhere, center) };
    let bounds = |(axis, half): (Dof, f64)| {
        let middle = center[axis.index()];
        Interval { axis, lo: middle - half, hi: middle + half }
    };
    let bounds = if edge > 0.0 { sides(edge).into_iter().map(bounds).collect() } else { Vec::new() };
    merits.onaa = of_cells.is_some().then_some(Onaa { edge, bounds, followed: true });
    merits.centered = Some(centered);
    Ok(())
}

/// The box, reduced if a single-axis limit is smaller than its extent.
pub(in crate::run) fn within(result: &CenteredBox, limits: &[Tolerance]) -> CenteredBox {
    let share = |limit: &Tolerance| {
        let half_width = result.bounds.iter().find(|side| side.axis == limit.axis)?.hi;
        (half_width > limit.symmetric()).then(|| (limit.symmetric() / half_width, limit.axis))
    };
    let Some((share, tightest)) = limits.iter().filter_map(share).min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return result.clone();
    };
    let bounds = result.bounds.iter().map(|side| Interval {
        axis: side.axis,
        lo: share * side.lo,
        hi: share * side.hi,
    });
    CenteredBox { edge: share * result.edge, bounds: bounds.collect(), limited_by: vec![tightest], ..*result }
}

/// The largest box in the proportions of `settings`, by as many motions as a cube; `None` if there is none.
pub(in crate::run) fn window_of(
    problem: &Problem,
    settings: &WindowSettings,
    by: &Effort<'_>,
    exec: &Exec,
) -> Result<Option<CenteredBox>, Cancelled> {
    let Ok(space) = Space::of(problem, settings) else { return Ok(None) };
    let mut search = Search::new(problem, space, by.seed, by.motions).within(2 * by.random);
    let Some(result) = search.shrink(by.random, exec)? else { return Ok(None) };
    let half_widths = search.space().half_widths(result.scale);
    let half_widths = problem.alignment().free.iter().map(|axis| (axis, half_widths[axis.index()]));
    let (is_open, limited_by) = (search.worst().is_none(), search.limiting(result.scale));
    Ok(Some(CenteredBox::of(result.scale, half_widths, is_open, Some(by.random), limited_by)))
}

/// A cube: its edge as a share of the error box.
struct Cube {
    scale: f64,
    reaches_border: bool,
    /// Empty about another centre than zero.
    limited_by: DofSet,
}

fn about(
    problem: &Problem,
    center: [f64; 5],
    least: f64,
    by: &Effort<'_>,
    exec: &Exec,
) -> Result<Cube, Cancelled> {
    let none = Cube { scale: 0.0, reaches_border: false, limited_by: DofSet::EMPTY };
    let middle = descent::outcome(problem.pair(), &PoseError::from_array(center), by.motions).outcome;
    let space = Space::about(problem, center);
    if middle != Outcome::Aligned || space.border() <= least {
        return Ok(none);
    }
    let search = Search::new(problem, space, by.seed, by.motions);
    let mut search = search.above(least).within(2 * by.random);
    let result = search.shrink(by.random, exec)?;
    Ok(result.map_or(none, |Shrunk { scale, .. }| {
        let limited_by = if center == [0.0; 5] { search.limiting(scale) } else { DofSet::EMPTY };
        Cube { scale, reaches_border: search.worst().is_none(), limited_by }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Family;
    use crate::pose::{DofSet, ErrorUnit};
    use crate::problem::testing::problem;

    #[test]
    fn a_box_stays_within_the_single_axis_limits() {
        let limit = |axis, minus, plus| Tolerance {
            axis,
            unit: ErrorUnit::of(axis),
            minus,
            plus,
            minus_reaches_border: false,
            plus_reaches_border: false,
            half_cell: 0.0,
            followed: true,
        };
        let half_widths = [(Dof::X, 0.2), (Dof::Yaw, 0.4)];
        let result = CenteredBox::of(0.8, half_widths, false, Some(7), DofSet::EMPTY.with(Dof::X));
        let wide = [limit(Dof::X, 0.3, 0.2), limit(Dof::Yaw, 0.5, 0.5)];
        assert_eq!(within(&result, &wide), result);
        let tight = [limit(Dof::X, 0.3, 0.3), limit(Dof::Yaw, 0.5, 0.3)];
        let smaller = within(&result, &tight);
        assert!((smaller.edge - 0.6).abs() < 1e-12 && (smaller.bounds[0].hi - 0.15).abs() < 1e-12);
        assert_eq!((smaller.sampled, smaller.limited_by), (Some(7), vec![Dof::Yaw]));
    }

    /// A search that has used its motions on the first directions is still certified by samples: other
    /// sampled poses of it dock, too, except for the few that the certificate permits.
    #[test]
    fn a_box_is_certified_after_the_search_spent_its_motions() {
        let problem = problem(Family::Pyramid, DofSet::ALL);
        let motions = descent::DescentSettings::default();
        let by = Effort { seed: 1, random: 200, motions: &motions };
        let result = window_of(&problem, &WindowSettings::default(), &by, &Exec::new()).unwrap().unwrap();
        let stream = crate::acceptance::Stream::new(5);
        let fails = (0..200).filter(|k| {
            let mut error = [0.0; 5];
            for Interval { axis, hi: half, .. } in &result.bounds {
                error[axis.index()] = half * (2.0 * stream.uniform(5 * k + axis.index() as u64) - 1.0);
            }
            let end = descent::outcome(problem.pair(), &PoseError::from_array(error), &motions);
            end.outcome != Outcome::Aligned
        });
        // 0 failures in 200 samples leave a failure rate of up to 1.5 %, which is three of another 200.
        assert!(result.edge > 0.0 && fails.count() <= 6);
    }
}
