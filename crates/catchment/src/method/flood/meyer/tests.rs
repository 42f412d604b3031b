//! The fast path against the judge.

use super::*;
use proptest::prelude::*;

fn rules() -> impl Strategy<Value = Rules> {
    (any::<bool>(), any::<bool>()).prop_map(|(flat_cells_are_minima, dams_pass_water_on)| Rules {
        flat_cells_are_minima,
        dams_pass_water_on,
    })
}

/// Random landscapes of one to four axes: few levels, so that plateaus, ties and cells without contact abound.
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

/// The basin of every cell, dams assigned, and what became of the basins.
fn fast<H: Height>(
    shape: &[usize],
    heights: &[H],
    targets: &[usize],
    tolerance: f64,
    rules: Rules,
) -> Vec<u32> {
    let around = Neighbourhood::new(shape);
    let mut parts = divide(heights, &around, targets, tolerance, rules, &Exec::new()).unwrap();
    dams::assign(heights, &around, &mut parts.labels);
    parts.labels.iter().map(|l| parts.merged.into[*l as usize]).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_fast_path_equals_the_judge((shape, heights, targets, tolerance) in landscapes(), rules in rules()) {
        prop_assert_eq!(
            fast(&shape, &heights, &targets, tolerance, rules),
            brute::divide(&shape, &heights, &targets, tolerance, rules)
        );
    }

    #[test]
    fn single_and_double_precision_agree((shape, heights, targets, tolerance) in landscapes()) {
        let single: Vec<f32> = heights.iter().map(|h| *h as f32).collect();
        prop_assert_eq!(
            fast(&shape, &heights, &targets, tolerance, Rules::default()),
            fast(&shape, &single, &targets, tolerance, Rules::default())
        );
    }

    /// A higher tolerance never tells more basins apart.
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
