//! The fast path compared with the reference.

use super::super::target;
use super::*;
use crate::design::Alignment;
use crate::exec::Cancelled;
use crate::landscape::{Grid, GridAxis, Landscape};
use crate::pose::{Dof, DofSet, Mount};
use proptest::prelude::*;

fn rules() -> impl Strategy<Value = Rules> {
    (any::<bool>(), any::<bool>()).prop_map(|(flat_cells_are_minima, dams_pass_water_on)| Rules {
        flat_cells_are_minima,
        dams_pass_water_on,
    })
}

/// Random landscapes of one to four axes: few levels, so that plateaus, ties and cells without contact are
/// frequent.
fn landscapes() -> impl Strategy<Value = (Vec<usize>, Vec<f64>, Vec<usize>, f64)> {
    let shapes = prop_oneof![
        prop::collection::vec(1..40usize, 1),
        prop::collection::vec(1..10usize, 2),
        prop::collection::vec(1..6usize, 3),
        prop::collection::vec(1..4usize, 4),
    ];
    (shapes, 2..40i32, 0..6i32).prop_flat_map(|(shape, levels, tolerance)| {
        let cells: usize = shape.iter().product();
        let heights = prop::collection::vec(0..levels, cells).prop_map(move |levels| {
            levels.into_iter().map(|l| if l == 0 { f64::NEG_INFINITY } else { f64::from(l) }).collect()
        });
        let targets = prop::collection::vec(0..cells, 0..3);
        (Just(shape), heights, targets, Just(f64::from(tolerance)))
    })
}

/// The basin of every cell, with dams assigned, and the final basins.
fn fast<H: Height>(
    shape: &[usize],
    heights: &[H],
    targets: &[usize],
    tolerance: f64,
    rules: Rules,
) -> Vec<u32> {
    let mut division = divide(shape, heights, targets, tolerance, rules, &Exec::new()).unwrap();
    division.give_dams(heights);
    (0..heights.len()).map(|cell| division.basin(cell).unwrap()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_fast_path_equals_the_oracle((shape, heights, targets, tolerance) in landscapes(), rules in rules()) {
        prop_assert_eq!(
            fast(&shape, &heights, &targets, tolerance, rules),
            brute::divide(&shape, &heights, &targets, tolerance, rules)
        );
    }

    /// First labels, mapped by merging, are the final labels; only dams are assigned to a watershed later.
    #[test]
    fn merged_first_labels_are_the_final_ones((shape, heights, targets, tolerance) in landscapes(), rules in rules()) {
        let division = divide(&shape, &heights, &targets, tolerance, rules, &Exec::new()).unwrap();
        let watersheds = division.watersheds();
        let judged = brute::divide(&shape, &heights, &targets, tolerance, rules);
        let mut dams = 0;
        for (cell, basin) in judged.iter().enumerate() {
            match watersheds.merged(cell) {
                Some(merged) => prop_assert_eq!(merged, *basin),
                None => dams += 1,
            }
        }
        prop_assert_eq!(watersheds.counts().dams, dams);
    }

    /// Outcomes on an error grid, with the mated pose of the design.
    #[test]
    fn outcomes_equal_those_of_the_oracle(
        (shape, heights, _, tolerance) in landscapes(),
        rules in rules(),
        first in 0..5usize,
        symmetry in 1..5u32,
    ) {
        let dofs: Vec<Dof> = Dof::ALL.into_iter().cycle().skip(first).take(shape.len()).collect();
        let free: DofSet = dofs.iter().copied().collect();
        let alignment = Alignment { symmetry, ..Alignment::new(free, Mount::X) };
        let axis = |(dof, cells): (&Dof, &usize)| {
            let half = alignment.half_range(*dof);
            GridAxis { dof: *dof, lo: -half, hi: half, cells: *cells }
        };
        let grid = Grid { axes: dofs.iter().zip(&shape).map(axis).collect() };
        let targets = target::cells(&grid, &alignment);
        let single: Vec<f32> = heights.iter().map(|h| *h as f32).collect();
        let landscape = Landscape { grid: grid.clone(), heights: single };
        let settings = MeyerSettings { depth_tolerance: Some(tolerance), rules };
        let result = accept(&landscape, &alignment, &|_| true, &settings, &Exec::new()).unwrap();
        let basins = brute::divide(&shape, &heights, &targets, tolerance, rules);
        let judged = brute::outcomes(&grid, &heights, &targets, &basins, tolerance);
        prop_assert_eq!(result.acceptance.outcomes, judged);
    }

    #[test]
    fn single_and_double_precision_agree((shape, heights, targets, tolerance) in landscapes()) {
        let single: Vec<f32> = heights.iter().map(|h| *h as f32).collect();
        prop_assert_eq!(
            fast(&shape, &heights, &targets, tolerance, Rules::default()),
            fast(&shape, &single, &targets, tolerance, Rules::default())
        );
    }

    /// A higher tolerance never separates more basins.
    #[test]
    fn merging_is_monotone((shape, heights, targets, tolerance) in landscapes()) {
        let basins = |tolerance| {
            let mut last = fast(&shape, &heights, &targets, tolerance, Rules::default());
            last.sort_unstable();
            last.dedup();
            last.len()
        };
        prop_assert!(basins(tolerance + 1.0) <= basins(tolerance));
        prop_assert!(basins(f64::INFINITY) <= 1 + usize::from(heights.contains(&f64::NEG_INFINITY)));
    }
}

#[test]
fn invalid_shapes_and_targets_are_refused() {
    let refused = |shape: &[usize], targets: &[usize]| {
        divide(shape, &[0.0; 6], targets, 0.0, Rules::default(), &Exec::new()).unwrap_err()
    };
    for (shape, targets) in
        [(&[2, 2][..], &[][..]), (&[6, usize::MAX, 2], &[]), (&[2, 3], &[6]), (&[1; 17], &[])]
    {
        assert!(matches!(refused(shape, targets), FloodError::Shape { heights: 6, .. }), "{shape:?}");
    }
    let exec = Exec::new();
    exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    let cancelled = divide(&[6], &[0.0; 6], &[], 0.0, Rules::default(), &exec).unwrap_err();
    assert_eq!(cancelled, FloodError::Cancelled(Cancelled));
}

#[test]
fn bad_tolerances_and_budgets_are_refused() {
    let alignment = Alignment::new([Dof::X].into_iter().collect(), Mount::X);
    let grid = Grid::over(&alignment, |_| 3);
    let landscape = Landscape { grid, heights: vec![1.0, 0.0, 1.0] };
    let with = |settings, exec: &Exec| accept(&landscape, &alignment, &|_| true, &settings, exec);
    let bad = with(MeyerSettings::with_tolerance(f64::NAN), &Exec::new());
    assert!(matches!(bad, Err(FloodError::Tolerance { .. })));
    let little = Exec::new().with_memory_budget(10);
    assert!(matches!(with(MeyerSettings::default(), &little), Err(FloodError::OutOfBudget(_))));
    assert_eq!(with(MeyerSettings::default(), &Exec::new()).unwrap().acceptance.counts(), [3, 0, 0, 0]);
}
