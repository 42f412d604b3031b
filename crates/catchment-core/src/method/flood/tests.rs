//! Closed forms, and the results that the documentation states.

use super::*;
use crate::connector::Connector;
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use crate::diagnostic::Warning;
use crate::pose::{Dof, DofSet, Mount};
use proptest::prelude::*;

/// Random landscapes of one to five axes: few levels, so that plateaus, ties and cells without contact are
/// frequent.
fn landscapes() -> impl Strategy<Value = (Vec<usize>, Vec<f32>)> {
    let shapes = prop_oneof![
        prop::collection::vec(1..60usize, 1),
        prop::collection::vec(1..12usize, 2),
        prop::collection::vec(1..6usize, 3),
        prop::collection::vec(1..5usize, 4),
        prop::collection::vec(1..4usize, 5),
    ];
    (shapes, 2..60i8).prop_flat_map(|(shape, levels)| {
        let cells: usize = shape.iter().product();
        let height = |level| if level == 0 { NONE } else { f32::from(level) - 3.0 };
        let heights = prop::collection::vec(0..levels, cells);
        (Just(shape), heights.prop_map(move |levels| levels.into_iter().map(height).collect()))
    })
}

/// Basins and tree by the rule of the lowest neighbour.
fn fast(shape: &[usize], heights: &[f32], threads: usize) -> (Vec<u32>, MergeTree) {
    let alignment = Alignment::new(DofSet::EMPTY, Mount::X);
    let metric = Metric { grid: &Grid { axes: Vec::new() }, alignment: &alignment };
    let exec = Exec::new().with_threads(threads).unwrap();
    divide(shape, heights, &[], DrainageRule::Lowest, &metric, &exec).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn the_tree_is_that_of_all_cells_by_height((shape, heights) in landscapes(), threads in 1..4usize) {
        let (labels, tree) = fast(&shape, &heights, threads);
        let result: Vec<_> = tree.minima.iter().map(|m| (m.cell, m.height, m.depth)).collect();
        prop_assert_eq!(result, brute::tree(&shape, &heights));
        let basins: Vec<_> = labels.iter().map(|label| tree.minima[*label as usize].cell).collect();
        prop_assert_eq!(basins, brute::basins(&shape, &heights));
        prop_assert_eq!(tree.minima.iter().map(|m| m.cells).sum::<usize>(), heights.len());
    }

    /// Merging at a tolerance leaves a basin for each minimum at least as deep, which is the lowest of its
    /// own.
    #[test]
    fn merged_basins_are_those_deeper_than_the_tolerance((shape, heights) in landscapes(), tolerance in 0..40i8) {
        let (_, tree) = fast(&shape, &heights, 1);
        let tolerance = f64::from(tolerance);
        let into = tree.merged(tolerance);
        for (basin, minimum) in tree.minima.iter().enumerate() {
            prop_assert_eq!(into[basin] as usize == basin, minimum.depth >= tolerance);
            prop_assert!(tree.minima[into[basin] as usize].height <= minimum.height);
        }
    }

    /// Labels joined wherever a link is shallower than the tolerance are the merged labels, cell by cell.
    #[test]
    fn first_labels_joined_by_the_links_are_the_merged_ones((shape, heights) in landscapes(), tolerance in 0..40i8) {
        let (labels, tree) = fast(&shape, &heights, 1);
        let tolerance = f64::from(tolerance);
        let watersheds =
            Watersheds { first: labels.clone(), into: tree.merged(tolerance), outside: tree.outside };
        let mut joined: Vec<u32> = labels.clone();
        for link in tree.links.iter().filter(|link| link.depth < tolerance) {
            let [a, b] = link.basins.map(|basin| joined[tree.minima[basin as usize].cell]);
            for label in joined.iter_mut().filter(|label| **label == a) {
                *label = b;
            }
        }
        for cell in 0..labels.len() {
            for other in 0..cell {
                let merged = watersheds.merged(cell) == watersheds.merged(other);
                prop_assert_eq!(merged, joined[cell] == joined[other], "{} {}", cell, other);
            }
        }
        let counts = watersheds.counts();
        let outside = usize::from(tree.outside.is_some());
        prop_assert_eq!((counts.first, counts.dams), (tree.minima.len() - outside, 0));
        joined.sort_unstable();
        joined.dedup();
        // The outside is not counted, whether or not another basin was merged into it.
        prop_assert_eq!(counts.merged, joined.len() - outside);
        let moved = (0..labels.len()).filter(|cell| watersheds.merged(*cell) != Some(labels[*cell])).count();
        prop_assert_eq!(counts.moved, moved);
    }

    /// The staircase, in one pass, equals the results of merging at every single tolerance.
    #[test]
    fn the_staircase_equals_merging_at_every_tolerance((shape, heights) in landscapes(), at in any::<prop::sample::Index>()) {
        let target = at.index(heights.len());
        let (labels, tree) = fast(&shape, &heights, 1);
        let steps = tree.staircase(labels[target], heights[target].into());
        prop_assert!(steps.is_sorted_by(|a, b| a.above < b.above && a.cells != b.cells));
        for tolerance in (0..130).map(|k| 0.5 * f64::from(k)) {
            let into = tree.merged(tolerance);
            let basin = into[labels[target] as usize];
            let cells: usize = (0..into.len()).filter(|k| into[*k] == basin).map(|k| tree.minima[k].cells).sum();
            let below = f64::from(heights[target]) - tree.minima[basin as usize].height;
            let holds = below <= 0.0 || below < tolerance;
            let step = steps.iter().rfind(|s| s.above < tolerance || s.above == 0.0).unwrap();
            prop_assert_eq!(step.cells, if holds { cells } else { 0 }, "{} {:?}", tolerance, steps);
        }
    }
}

/// A single axis with the given heights.
fn line(heights: &[f32]) -> (Landscape, Alignment) {
    let alignment = Alignment::new([Dof::X].into_iter().collect(), Mount::X);
    let grid = Grid::over(&alignment, |_| heights.len());
    (Landscape { grid, heights: heights.to_vec() }, alignment)
}

fn outcomes(heights: &[f32], depth_tolerance: f64) -> String {
    let (landscape, alignment) = line(heights);
    let flooding = flood(
        &landscape,
        &alignment,
        &|_| true,
        &FloodSettings::with_tolerance(depth_tolerance),
        &Exec::new(),
    )
    .unwrap();
    flooding.acceptance.outcomes.iter().map(|o| o.name().chars().next().unwrap()).collect()
}

const NONE: f32 = f32::NEG_INFINITY;

#[test]
fn a_valley_between_two_jams_and_the_outside() {
    // Dams (3, 5, 4, 4) drain to the steeper side: the outer dams off the edge, 5 → 1 and 4 → 1 to the
    // middle.
    assert_eq!(outcomes(&[NONE, 3.0, 2.0, 5.0, 1.0, 0.0, 1.0, 4.0, 3.0, 4.0, NONE], 0.5), "mmjaaaaajmm");
}

#[test]
fn a_shallow_jam_joins_the_mated_basin_and_a_deep_one_does_not() {
    let heights = [4.0, 3.5, 4.0, 1.0, 0.0, 1.0, 4.0, 2.0, 4.0];
    assert_eq!(outcomes(&heights, 0.0), "jjaaaaajj");
    assert_eq!(outcomes(&heights, 1.0), "aaaaaaajj");
    assert_eq!(outcomes(&heights, 2.5), "aaaaaaaaa");
}

#[test]
fn with_an_even_number_of_cells_both_cells_around_the_mated_pose_are_its_minimum() {
    // The ridge between the two middle cells is an accident of sampling: nothing lies between them but the mated pose.
    assert_eq!(outcomes(&[3.0, 2.0, 1.0, 1.1, 2.0, 3.0], 0.0), "aaaaaa");
    let alignment = Alignment::new([Dof::X, Dof::Pitch].into_iter().collect(), Mount::Y);
    let grid = Grid::over(&alignment, |_| 4);
    // A diagonal valley, whose two lowest cells are opposite corners of the mated pose.
    let heights = vec![
        9.0, 8.0, 7.0, 6.0, //
        8.0, 7.0, 1.0, 5.0, //
        7.0, 1.0, 7.0, 8.0, //
        6.0, 7.0, 8.0, 9.0,
    ];
    let landscape = Landscape { grid, heights };
    let flooding =
        flood(&landscape, &alignment, &|_| true, &FloodSettings::with_tolerance(0.0), &Exec::new()).unwrap();
    assert_eq!(flooding.acceptance.counts(), [16, 0, 0, 0]);
}

#[test]
fn a_target_that_is_no_minimum_takes_the_basin_of_its_lowest_cell() {
    let heights = [5.0, 4.0, 2.9, 3.0, 4.0, 3.5, 5.0];
    assert_eq!(outcomes(&heights, 0.2), "aaaaajj");
    // Gathering further below the mated pose than the tolerance explains is not aligning.
    assert_eq!(outcomes(&heights, 0.05), "jjjjjjj");
}

#[test]
fn equivalent_poses_of_a_symmetric_pair_are_aligned() {
    let mut alignment = Alignment::new([Dof::Yaw].into_iter().collect(), Mount::X);
    let grid = Grid::over(&alignment, |_| 9);
    let heights = vec![0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0, 1.0, 0.0];
    let landscape = Landscape { grid, heights };
    let settings = FloodSettings::with_tolerance(0.5);
    let aligned = |a: &Alignment| {
        flood(&landscape, a, &|_| true, &settings, &Exec::new()).unwrap().acceptance.counts()[0]
    };
    assert!(aligned(&alignment) < 6);
    alignment.symmetry = 4;
    assert_eq!(aligned(&alignment), 9);
}

#[test]
fn basins_have_depth_share_and_outcome() {
    let (landscape, alignment) = line(&[NONE, 3.0, 2.0, 5.0, 1.0, 0.0, 1.0, 4.0, 3.0, 4.0, NONE]);
    let settings = FloodSettings::with_tolerance(0.5);
    let basins = flood(&landscape, &alignment, &|_| true, &settings, &Exec::new()).unwrap().hierarchy.basins;
    let mated = basins.iter().find(|b| b.outcome == Outcome::Aligned).unwrap();
    assert_eq!((mated.minimum, mated.height, mated.depth), (5, 0.0, 4.0));
    assert_eq!(basins.iter().map(|b| b.cells).sum::<usize>(), 11);
    assert!(basins.iter().any(|b| b.outcome == Outcome::Missed && b.height == f64::NEG_INFINITY));
}

#[test]
fn a_landscape_draining_out_of_the_box_is_not_aligned_and_warns() {
    let (landscape, alignment) = line(&[0.0, 1.0, 2.0, 1.5, 2.0, 1.0, 0.0]);
    let flooding =
        flood(&landscape, &alignment, &|_| true, &FloodSettings::with_tolerance(0.1), &Exec::new()).unwrap();
    assert_eq!(flooding.acceptance.counts(), [1, 0, 6, 0]);
    assert!(flooding.acceptance.warnings.iter().any(|w| w.code == "drains-to-border"));
    // The mated pose, shallower than the tolerance, joins a basin that gathers far below it.
    let merged =
        flood(&landscape, &alignment, &|_| true, &FloodSettings::with_tolerance(0.6), &Exec::new()).unwrap();
    assert_eq!(merged.acceptance.counts()[0], 0);
    assert!(merged.acceptance.warnings.iter().any(|w| *w == Warning::MatedPoseNotAccepted));
}

#[test]
fn bad_tolerances_and_budgets_are_refused() {
    let (landscape, alignment) = line(&[1.0, 0.0, 1.0]);
    let bad = flood(&landscape, &alignment, &|_| true, &FloodSettings::with_tolerance(-1.0), &Exec::new())
        .unwrap_err();
    assert_eq!(bad, FloodError::Tolerance { depth: -1.0 });
    let exec = Exec::new().with_memory_budget(10);
    let settings = FloodSettings::with_tolerance(0.0);
    assert!(matches!(
        flood(&landscape, &alignment, &|_| true, &settings, &exec),
        Err(FloodError::OutOfBudget(_))
    ));
    exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    let exec = exec.with_memory_budget(1 << 20);
    assert_eq!(
        flood(&landscape, &alignment, &|_| true, &settings, &exec),
        Err(FloodError::Cancelled(Cancelled))
    );
}

#[test]
fn an_empty_set_of_free_axes_is_one_cell_at_the_mated_pose() {
    let alignment = Alignment::new(DofSet::EMPTY, Mount::X);
    let landscape = Landscape { grid: Grid { axes: Vec::new() }, heights: vec![0.0] };
    let flooding =
        flood(&landscape, &alignment, &|_| true, &FloodSettings::with_tolerance(0.0), &Exec::new()).unwrap();
    assert_eq!(flooding.acceptance.outcomes, [Outcome::Aligned]);
}

fn pair(family: Family, aspect_ratio: f64, cor: f64, symmetry: u32) -> Pair {
    let mount = if family.is_planar() { Mount::Y } else { Mount::X };
    let free = if family.is_planar() { [Dof::X, Dof::Pitch].into_iter().collect() } else { DofSet::ALL };
    let alignment = Alignment { center_of_rotation: cor, symmetry, ..Alignment::new(free, mount) };
    let spec = FamilySpec::new(family).with_aspect_ratio(aspect_ratio);
    let connector = ConnectorSpec::Family(spec);
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

/// Designs of `tests/planar_sums.rs` with their exact Sums at characteristic length 1.
const PLANAR: [(Family, f64, f64, f64); 5] = [
    (Family::XFace, 1.0, 0.5, 3.853),
    (Family::XFace, 0.5, -0.5, 1.953),
    (Family::VFace, 1.0, 0.0, 2.391),
    (Family::VFace, 0.5, -0.5, 1.25),
    (Family::XFace, 2.0, 1.0, 3.707),
];

/// The measured bias at 100 × 100 equals that in the module's opening, for both rules.
#[test]
fn the_bias_of_flooding_matches_the_documentation() {
    let measure = |(family, aspect_ratio, cor, exact): (Family, f64, f64, f64)| {
        let mut pair = pair(family, aspect_ratio, cor, 1);
        pair.alignment.rotation_length = 1.0;
        let grid = Grid::over(&pair.alignment, |_| 100);
        [DrainageRule::Lowest, DrainageRule::Steepest].map(|rule| {
            let settings = FloodSettings { rule, ..FloodSettings::default() };
            let acceptance = accept(&pair, &grid, &settings, &Exec::new()).unwrap();
            assert!(!acceptance.warnings.iter().any(|w| *w == Warning::MatedPoseNotAccepted));
            let sum = acceptance.counts()[0] as f64 * grid.cell_measure();
            (1000.0 * (sum / exact - 1.0)).round() / 10.0
        })
    };
    let expected = [[5.8, 4.5], [-5.7, -20.0], [0.4, 0.8], [-13.0, -7.4], [1.6, 1.3]];
    assert_eq!(PLANAR.map(measure), expected);
}

/// Meyer's queue with its dams, on the same heights at the same tolerance.
#[test]
fn the_difference_from_meyers_flooding_matches_the_documentation() {
    let measure = |(family, aspect_ratio, cor, _)| {
        let pair = pair(family, aspect_ratio, cor, 1);
        let grid = Grid::over(&pair.alignment, |_| 100);
        let landscape = Landscape::compute(&pair, &grid, &Exec::new()).unwrap();
        let flooding =
            flood(&landscape, &pair.alignment, &|_| true, &FloodSettings::default(), &Exec::new()).unwrap();
        let settings = meyer::MeyerSettings::default();
        let meyer = meyer::accept(&landscape, &pair.alignment, &|_| true, &settings, &Exec::new()).unwrap();
        assert_eq!(meyer.tolerance, flooding.hierarchy.tolerance);
        let accepted = || flooding.acceptance.accepted().zip(meyer.acceptance.accepted());
        let different = accepted().filter(|(a, b)| a != b).count();
        let share = 100.0 * different as f64 / grid.len() as f64;
        let sum = meyer.acceptance.counts()[0] as f64 * grid.cell_measure();
        [share, sum].map(|v| (v * 1e3).round() / 1e3)
    };
    // Share of the cells in percent, and Meyer's Sum.
    let expected = [[3.88, 3.942], [8.84, 1.474], [1.64, 2.403], [2.46, 1.206], [0.0, 3.766]];
    assert_eq!(PLANAR.map(measure), expected);
}

/// With the text's own tolerance, 0.1·H, Meyer's queue has the bias in the module's opening, to a percent.
#[test]
fn the_bias_of_meyers_flooding_matches_the_documentation() {
    let expected = [2.3, -24.0, 0.5, -3.5, 1.6];
    for ((family, aspect_ratio, cor, exact), expected) in PLANAR.into_iter().zip(expected) {
        let pair = pair(family, aspect_ratio, cor, 1);
        let grid = Grid::over(&pair.alignment, |_| 100);
        let landscape = Landscape::compute(&pair, &grid, &Exec::new()).unwrap();
        let tenth =
            meyer::MeyerSettings::with_tolerance(meyer::MeyerSettings::DEPTH_PER_FACE_HEIGHT * aspect_ratio);
        let result = meyer::accept(&landscape, &pair.alignment, &|_| true, &tenth, &Exec::new()).unwrap();
        assert_eq!(result.acceptance.method, "meyer");
        let bias = 100.0 * (result.acceptance.counts()[0] as f64 * grid.cell_measure() / exact - 1.0);
        assert!((bias - expected).abs() < 1.0, "{family:?} {aspect_ratio} {cor}: {bias:.2} %");
    }
}

/// The tolerance of the widest gap accepts the same cells as a tenth of the face's height.
#[test]
fn the_tolerance_of_the_widest_gap_parts_pits_from_jams() {
    let cases = [
        (Family::VFace, 1.0, 0.0, 101),
        (Family::VFace, 0.5, 0.0, 101),
        (Family::XFace, 1.0, 0.5, 101),
        (Family::SFace, 1.0, 0.0, 101),
        (Family::Pyramid, 0.5, 0.5, 13),
        (Family::Pyramid, 0.5, 0.0, 13),
        (Family::XFace3d, 0.577, 0.5, 13),
    ];
    for (family, aspect_ratio, cor, cells) in cases {
        let pair = pair(family, aspect_ratio, cor, 1);
        let grid = Grid::over(&pair.alignment, |_| cells);
        let count = |settings| accept(&pair, &grid, &settings, &Exec::new()).unwrap().counts()[0];
        let tenth = FloodSettings::with_tolerance(0.1 * aspect_ratio);
        assert_eq!(count(FloodSettings::default()), count(tenth), "{family:?} {aspect_ratio} {cor}");
    }
}

#[test]
fn five_axes_agree_between_odd_and_even_grids_and_a_quarter_turn_doubles_the_basin() {
    let share = |cells, symmetry| {
        let pair = pair(Family::Pyramid, 0.5, 0.5, symmetry);
        let grid = Grid::over(&pair.alignment, |_| cells);
        let acceptance = accept(&pair, &grid, &FloodSettings::default(), &Exec::new()).unwrap();
        acceptance.counts()[0] as f64 / grid.len() as f64
    };
    // At zero roll and pitch, yaw in ±90° contains a whole basin and halves of two others, a quarter turn
    // apart.
    let (odd, even) = (share(9, 4), share(10, 4));
    assert!((odd / even - 1.0).abs() < 0.06, "{odd} {even}");
    // 12, so that no cell lies on the ridge at 45° between two turns.
    let ratio = share(12, 4) / share(12, 1);
    assert!((ratio - 2.0).abs() < 0.05, "{ratio}");
}

#[test]
fn threads_do_not_change_a_bit() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 1);
    let grid = Grid::over(&pair.alignment, |_| 6);
    let with = |threads| {
        let exec = Exec::new().with_threads(threads).unwrap();
        let landscape = Landscape::compute(&pair, &grid, &exec).unwrap();
        [DrainageRule::Lowest, DrainageRule::Steepest].map(|rule| {
            let settings = FloodSettings { rule, ..FloodSettings::default() };
            flood(&landscape, &pair.alignment, &|_| true, &settings, &exec).unwrap()
        })
    };
    assert!(with(1) == with(3) && with(1) == with(8));
}

/// A grid over x and pitch with heights by the numbers of its cells.
fn field(cells: usize, height: impl Fn(f32, f32) -> f32) -> (Landscape, Alignment) {
    let alignment = Alignment::new([Dof::X, Dof::Pitch].into_iter().collect(), Mount::X);
    let grid = Grid::over(&alignment, |_| cells);
    let heights = (0..grid.len()).map(|k| height((k % cells) as f32, (k / cells) as f32)).collect();
    (Landscape { grid, heights }, alignment)
}

/// First and merged watersheds by both kinds of flooding at a tolerance.
fn counted(field: &(Landscape, Alignment), tolerance: f64) -> [WatershedCounts; 2] {
    let (landscape, alignment) = field;
    let docks = |_: usize| true;
    let exec = Exec::new();
    let fast = flood(landscape, alignment, &docks, &FloodSettings::with_tolerance(tolerance), &exec).unwrap();
    let settings = meyer::MeyerSettings::with_tolerance(tolerance);
    let queue = meyer::accept(landscape, alignment, &docks, &settings, &exec).unwrap();
    [fast.watersheds.counts(), queue.watersheds.counts()]
}

#[test]
fn a_bowl_is_one_watershed_and_nothing_is_merged() {
    let bowl = field(41, |u, v| (u - 20.0).powi(2) + 0.5 * (v - 20.0).powi(2));
    let one = WatershedCounts { first: 1, merged: 1, dams: 0, moved: 0 };
    for tolerance in [0.0, 0.1, 1e3] {
        assert_eq!(counted(&bowl, tolerance), [one; 2]);
    }
}

/// The dissertation's figure 5.11: a steep canal that falls towards one end and runs half a cell aside per
/// cell. Every other cell of it lies on the floor and is a minimum by sampling alone; between two of them the
/// water must rise by half a cell's steepness.
#[test]
fn a_canal_across_the_grid_is_cut_by_sampling_and_joined_by_merging() {
    const CELLS: usize = 41;
    let canal = field(CELLS, |u, v| 10.0 * (v - 10.0 - 0.5 * u).abs() + 0.01 * u);
    let floor = CELLS.div_ceil(2);
    for counts in counted(&canal, 4.9) {
        assert_eq!((counts.first, counts.merged, counts.moved), (floor, floor, 0));
    }
    let [fast, queue] = counted(&canal, 5.1);
    assert_eq!((fast.first, fast.merged, fast.dams), (floor, 1, 0));
    assert_eq!((queue.first, queue.merged), (floor, 1));
    assert!(queue.dams > 0 && queue.moved < CELLS * CELLS - queue.dams);
    // All but the watershed of the canal's lowest cell.
    assert!(fast.moved > CELLS * CELLS / 2 && fast.moved < CELLS * CELLS);
}
