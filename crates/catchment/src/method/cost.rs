//! What decisions take, estimated before they are made.

use super::descent::End;
use crate::acceptance::Outcome;
use crate::advice::Advice;
use crate::contact::Pair;
use crate::exec::{Exec, OutOfBudget};
use crate::landscape::Resolution;
use crate::pose::Dof;

/// Seconds of one descent between simple halves, on one core: what cost estimates count in.
pub(super) const DESCENT_SECONDS: f64 = 1e-4;

/// Bytes per pose while poses are decided one by one: the end and the outcome of each, and the ends once more while the
/// parts of the threads are put together.
pub(super) const POSE_BYTES: u64 = (2 * size_of::<End>() + size_of::<Outcome>()) as u64;

/// How many descents can be afforded, as a share of what simple halves allow: the time of a descent grows with about the cube of the
/// number of facets, and where the trees are asked as measured.
pub fn affordable(pair: &Pair) -> f64 {
    const SIMPLE: f64 = 64.0;
    let facets = |half: &crate::connector::Half| half.surfaces.iter().map(|s| s.facets.len()).sum::<usize>();
    let facets = (facets(&pair.fixed) + facets(&pair.moving)) as f64;
    let listed = (SIMPLE / facets.max(SIMPLE)).powi(3);
    let tilts = [Dof::Roll, Dof::Pitch].into_iter().any(|dof| pair.alignment.free.contains(dof));
    if pair.asks_trees() { listed.max(by_trees(facets, tilts, pair.is_tight())) } else { listed }
}

/// Seconds that a motion takes about, on one core.
pub fn seconds_per_motion(pair: &Pair) -> f64 {
    DESCENT_SECONDS / affordable(pair)
}

/// Cells per axis that can be afforded of so many of simple halves with as many free errors, each a descent; in all no fewer than `poses`, where those are as many.
pub(super) fn affordable_cells(pair: &Pair, simple: [usize; 5], poses: usize) -> [usize; 5] {
    let (share, poses) = (affordable(pair), poses as f64);
    let mut axes = 0.0;
    simple.map(|cells| {
        axes += 1.0;
        let cells = cells as f64;
        (cells * share.powf(1.0 / axes)).max(poses.powf(1.0 / axes).min(cells)) as usize
    })
}

/// The same of halves that are searched by trees, by the number of their facets, whether motions tilt and whether the fit is tight: seconds of a motion that
/// docks of halves of 600 facets, and the power of their number with which they grow. Grid cups of 600 and 7 000 facets, funnels of 1 000 to 100 000, a
/// gear of 50 000, within a factor of three. What jams at once is shorter.
fn by_trees(facets: f64, tilts: bool, is_tight: bool) -> f64 {
    const MEASURED: f64 = 600.0;
    let (seconds, power) = match (tilts, is_tight) {
        (true, true) => (1e-2, 0.4),
        (true, false) => (3e-4, 0.8),
        (false, true) => (5e-3, 0.2),
        (false, false) => (1.5e-4, 0.4),
    };
    (DESCENT_SECONDS / seconds * (MEASURED / facets).powf(power)).min(1.0)
}

/// Refuses what would not fit into memory, with the resolution that would.
pub fn ensure_fits(
    what: &'static str,
    needed: u64,
    per_cell: u64,
    axes: usize,
    exec: &Exec,
) -> Result<(), OutOfBudget> {
    exec.ensure_fits(what, needed, |budget| {
        let fits = Resolution::largest_that_fits(budget, per_cell, axes);
        vec![Advice::AtMostResolution(fits), Advice::MoreMemory]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::family::Cone;
    use crate::design::{Alignment, FamilySpec};
    use crate::pose::{DofSet, Mount};

    #[test]
    fn halves_of_many_facets_are_searched_and_not_listed() {
        let share = |chord_error: f64| {
            let spec = FamilySpec::Cone(Cone { chord_error, ..Cone::default() });
            let connector = Connector::of_family(&spec, Mount::X).unwrap();
            affordable(&Pair::new(&connector, &Alignment::new(DofSet::ALL, Mount::X)))
        };
        // Hundreds of facets take a millisecond: by the cube of their number it would be a tenth of a second and more.
        let (coarse, fine) = (share(1e-2), share(1e-5));
        assert!(coarse > fine, "{coarse} {fine}");
        let milliseconds = |share: f64| 1e3 * DESCENT_SECONDS / share;
        assert!((0.2..5.0).contains(&milliseconds(fine)), "{}", milliseconds(fine));
    }

    #[test]
    fn the_time_of_a_descent_is_the_measured_one() {
        let milliseconds = |facets: f64, tilts: bool, is_tight: bool| {
            1e3 * DESCENT_SECONDS / by_trees(facets, tilts, is_tight)
        };
        assert!((milliseconds(600.0, false, true) - 5.0).abs() < 1e-9);
        assert!((milliseconds(600.0, true, false) - 0.3).abs() < 1e-9);
        assert!((milliseconds(600.0, true, true) - 10.0).abs() < 1e-9);
        // A hundred times as many facets take 100^0.4 times as long.
        assert!((milliseconds(60_000.0, true, true) - 63.1).abs() < 0.01);
        assert_eq!(by_trees(1.0, false, false), 1.0);
    }
}
