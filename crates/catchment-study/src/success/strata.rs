//! Strata of errors, by a grid that was decided in advance; they guide the sampling.
//!
//! ```text
//!   grid over μ ± 3.5 σ               share of a pose: outcomes of the surrounding centres, weighted by nearness
//!   ┌───────────────┐
//!   │ ░ ░ ░ ░ ░ ░ ░ │                 0     .1   .3   .5   .7   .9     1
//!   │ ░ ░ █ █ █ ░ ░ │     ──▶         ├─────┼────┼────┼────┼────┼─────┤      eight strata: both ends, and the range between;
//!   │ ░ ░ █ ● █ ░ ░ │                 ░░░░░░      near the border       █████      three more outside the grid, by the nearest cell
//!   └───────────────┘
//! ```
//!
//! A stratum is only a guess: it shows which exact motions are most informative. The estimate is that of the
//! motions, whether the guess is right or wrong.

use super::source::Source;
use catchment_core::acceptance::{Domain, Outcome};
use catchment_core::exec::Exec;
use catchment_core::landscape::{Grid, GridAxis};
use catchment_core::method::{DecideError, affordable, confluence, descent};
use catchment_core::pose::{Dof, DofSet, PoseError};
use catchment_core::problem::Problem;

/// Cells per axis of grids of one to five axes, for simple halves: about as many motions as are followed
/// afterwards, or fewer.
const CELLS: [usize; 5] = [256, 80, 28, 14, 10];
/// Cells of a grid that is decided cell by cell.
const ALONE: f64 = 2048.0;
/// Smallest useful number of cells per axis.
const LEAST: usize = 6;
/// Half-width of the only cell of an error that is always the same, in D or radians.
const STILL: f64 = 1e-3;
/// Borders between the strata of the grid, beside both ends; and of those outside of it.
const BANDS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
const INSIDE: usize = BANDS.len() + 3;
/// Shares this near to an end are at it: rounding of a sum of 32 terms.
const END: f64 = 1e-9;

/// How many strata there are.
pub(super) const STRATA: usize = INSIDE + 3;

/// Strata of errors.
#[derive(Debug, Clone, Default)]
pub(crate) struct Strata {
    grid: Option<Grid>,
    /// Whether the centre of each cell docks.
    docks: Vec<bool>,
    /// Motions that it took, to their end or not.
    motions: usize,
}

impl Strata {
    /// Decides a grid for the errors of a source; `None` if halves have too many facets, or `cells` per axis
    /// are too few, for a useful grid.
    pub(crate) fn decide(
        problem: &Problem,
        source: &Source<'_>,
        cells: Option<usize>,
        exec: &Exec,
    ) -> Result<Self, DecideError> {
        let varying: DofSet = source.varying().collect();
        let mean = source.mean().to_array();
        let still = |dof: &Dof| !varying.contains(*dof) && mean[dof.index()] != 0.0;
        let is_whole = varying == problem.alignment().free && !Dof::ALL.iter().any(still);
        let axes = varying.len();
        if axes == 0 {
            return Ok(Self::default());
        }
        let share = affordable(problem.pair());
        let most = if is_whole { CELLS[axes - 1] } else { ALONE.powf(1.0 / axes as f64) as usize };
        let fitting = (most as f64 * share.powf(1.0 / axes as f64)) as usize / 2 * 2;
        let cells = cells.unwrap_or(fitting);
        if cells < LEAST {
            return Ok(Self::default());
        }
        let axis = |dof: Dof| {
            if varying.contains(dof) {
                let [lo, hi] = source.range(dof);
                return Some(GridAxis { dof, lo, hi, cells });
            }
            let middle = mean[dof.index()];
            still(&dof).then_some(GridAxis { dof, lo: middle - STILL, hi: middle + STILL, cells: 1 })
        };
        let grid = Grid { axes: Dof::ALL.into_iter().filter_map(axis).collect() };
        let (outcomes, motions) = if is_whole {
            let settings = confluence::ConfluenceSettings::default();
            let labels = confluence::run(problem.pair(), &grid, &settings, exec)?;
            (labels.acceptance(exec).outcomes, labels.inherited.motions + labels.inherited.tried)
        } else {
            let settings = descent::DescentSettings::default();
            let (result, _) = descent::run(problem.pair(), Domain::Grid(grid.clone()), &settings, exec)?;
            let motions = result.outcomes.len();
            (result.outcomes, motions)
        };
        let docks = outcomes.into_iter().map(|outcome| outcome == Outcome::Aligned).collect();
        Ok(Self { grid: Some(grid), docks, motions })
    }

    /// Whether anything is known.
    pub(super) const fn is_some(&self) -> bool {
        self.grid.is_some()
    }

    /// Cells that were decided.
    pub(crate) const fn cells(&self) -> usize {
        self.docks.len()
    }

    /// Motions that this took.
    pub(crate) const fn motions(&self) -> usize {
        self.motions
    }

    /// The stratum of a pose error, below [`STRATA`].
    pub(super) fn of(&self, error: &PoseError) -> usize {
        let Some(grid) = &self.grid else { return 0 };
        let error = error.to_array();
        let mut outside = false;
        // Of every axis the lower of two centres, the way from there to the next cell, and how much that counts.
        let mut axes = [(0, 0, 0.0); 5];
        let mut stride = 1;
        for (place, axis) in axes.iter_mut().zip(&grid.axes) {
            let value = error[axis.dof.index()];
            outside |= axis.cells > 1 && !(axis.lo..=axis.hi).contains(&value);
            let last = (axis.cells - 1) as f64;
            let at = ((value - axis.lo) / axis.step() - 0.5).clamp(0.0, last);
            let lower = (at as usize).min(axis.cells.saturating_sub(2));
            let step = if axis.cells > 1 { stride } else { 0 };
            *place = (lower * stride, step, at - lower as f64);
            stride *= axis.cells;
        }
        let count = grid.axes.len();
        let mut share = 0.0;
        for corner in 0..1usize << count {
            let (mut cell, mut weight) = (0, 1.0);
            for (k, (base, step, part)) in axes[..count].iter().enumerate() {
                let upper = corner >> k & 1 == 1;
                cell += base + if upper { *step } else { 0 };
                weight *= if upper { *part } else { 1.0 - part };
            }
            if weight > 0.0 && self.docks[cell] {
                share += weight;
            }
        }
        band(share, outside)
    }
}

fn band(share: f64, outside: bool) -> usize {
    match (outside, share) {
        (true, s) if s < BANDS[0] => INSIDE,
        (true, s) if s <= BANDS[BANDS.len() - 1] => INSIDE + 1,
        (true, _) => INSIDE + 2,
        (false, s) if s <= END => 0,
        (false, s) if s >= 1.0 - END => INSIDE - 1,
        (false, s) => 1 + BANDS.iter().filter(|border| s > **border).count(),
    }
}

/// Description of a stratum, for people.
pub(super) fn name(stratum: usize) -> String {
    let [first, .., last] = BANDS;
    match stratum {
        0 => "no centre around docks".to_owned(),
        k if k + 1 == INSIDE => "every centre around docks".to_owned(),
        k if k < INSIDE => {
            let border = |k: usize| if k == 0 { 0.0 } else { BANDS.get(k - 1).copied().unwrap_or(1.0) };
            format!("{} to {} of the centres around dock", border(k - 1), border(k))
        }
        k => match k - INSIDE {
            0 => format!("outside of the grid, below {first} of the nearest"),
            1 => format!("outside of the grid, {first} to {last} of the nearest"),
            _ => format!("outside of the grid, above {last} of the nearest"),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid over x and yaw whose cells with negative x dock.
    fn half() -> Strata {
        let axis = |dof, cells| GridAxis { dof, lo: -1.0, hi: 1.0, cells };
        let grid = Grid { axes: vec![axis(Dof::X, 4), axis(Dof::Yaw, 3)] };
        let docks = (0..grid.len()).map(|cell| grid.pose(cell).x < 0.0).collect();
        Strata { grid: Some(grid), docks, motions: 0 }
    }

    #[test]
    fn the_share_of_a_pose_is_interpolated() {
        let strata = half();
        let of = |x: f64, yaw: f64| strata.of(&PoseError { x, yaw, ..PoseError::default() });
        // Centres of x are ±0.25, ±0.75: between them the share falls from 1 to 0.
        assert_eq!([of(-0.9, 0.0), of(-0.3, 0.9), of(0.3, -0.9), of(1.0, 1.0)], [7, 7, 0, 0]);
        assert_eq!([of(-0.22, 0.1), of(-0.1, 0.1), of(0.01, 0.1), of(0.22, 0.1)], [6, 4, 3, 1]);
        assert_eq!([of(-1.1, 0.0), of(0.0, 1.2), of(1.5, 0.0)], [INSIDE + 2, INSIDE + 1, INSIDE]);
        assert_eq!(Strata::default().of(&PoseError::default()), 0);
    }

    #[test]
    fn every_stratum_has_a_name_of_its_own() {
        let mut names: Vec<String> = (0..STRATA).map(name).collect();
        assert_eq!(names[1], "0 to 0.1 of the centres around dock");
        assert_eq!(names[6], "0.9 to 1 of the centres around dock");
        names.sort();
        names.dedup();
        assert_eq!(names.len(), STRATA);
    }
}
