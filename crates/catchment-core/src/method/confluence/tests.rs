use super::*;
use crate::connector::Connector;
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use crate::landscape::Landscape;
use crate::pose::{Dof, DofSet};
use std::sync::atomic::Ordering;

fn pair(family: Family, aspect_ratio: f64, cor: f64, rho: f64, free: Option<&[Dof]>) -> Pair {
    let mut alignment = Alignment::default_for(Some(family));
    if let Some(free) = free {
        alignment.free = free.iter().copied().collect::<DofSet>();
    }
    alignment.center_of_rotation = cor;
    alignment.rotation_length = rho;
    let connector = ConnectorSpec::Family(FamilySpec::new(family).with_aspect_ratio(aspect_ratio));
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    Pair::new(&Connector::build(&design).unwrap(), &design.alignment)
}

fn labels(pair: &Pair, cells: usize) -> GridLabels {
    run(pair, &Grid::over(&pair.alignment, |_| cells), &ConfluenceSettings::default(), &Exec::new()).unwrap()
}

/// Every cell by its own motion: the reference.
fn judge(labels: &GridLabels, pair: &Pair) -> Vec<Outcome> {
    let domain = Domain::Grid(labels.grid().clone());
    let (acceptance, _) =
        descent::run(pair, domain, &descent::DescentSettings::default(), &Exec::new()).unwrap();
    acceptance.outcomes
}

/// Per thousand of the cells, how many may differ: ridges from which a half slides to either side, by rounding; nothing else.
#[test]
fn labels_are_those_of_each_cells_own_motion() {
    use Dof::{Pitch, X, Y, Yaw};
    for (pair, cells, per_thousand) in [
        (pair(Family::VFace, 1.0, 0.0, 1.0, None), 50, 0.0),
        (pair(Family::VFace, 0.5, -0.5, 1.0, None), 50, 0.0),
        (pair(Family::VFace, 0.25, -0.5, 0.5, None), 80, 0.3),
        (pair(Family::SFace, 1.0, -1.0, 1.0, None), 50, 0.3),
        (pair(Family::XFace, 0.5, -0.5, 1.0, None), 51, 0.3),
        (pair(Family::Pyramid, 0.5, 0.5, 0.5, Some(&[X, Pitch, Yaw])), 12, 0.4),
        (pair(Family::XFace3d, 0.577, 0.2, 0.5, Some(&[X, Y, Pitch])), 12, 0.4),
        (pair(Family::Pyramid, 0.5, 0.5, 0.5, None), 7, 0.2),
        (pair(Family::XFace3d, 0.577, 0.0, 0.5, None), 7, 0.2),
    ] {
        let labels = labels(&pair, cells);
        let exact = judge(&labels, &pair);
        let result = labels.acceptance(&Exec::new()).outcomes;
        let wrong = exact.iter().zip(&result).filter(|(a, b)| a != b).count();
        assert!(wrong as f64 * 1e3 <= per_thousand * result.len() as f64, "{wrong} of {}", result.len());
        let InheritedLabels { inherited, cells, motions, .. } = labels.inherited;
        assert!(2 * inherited > cells && motions > 0, "{:?}", labels.inherited);
    }
}

/// The jams of the 3-D X-Face are thinner than a cell, 0.1 to 0.3 % of the box, and their threads touch by corners.
#[test]
fn thin_jams_are_not_lost() {
    for cor in [0.5, 0.0] {
        let pair = pair(Family::XFace3d, 0.577, cor, 0.5, None);
        let labels = labels(&pair, 10);
        // A sixth of the cells: of jams of which one in fifty is lost a sixth shows as many.
        let cells: Vec<usize> = (0..labels.grid().len()).step_by(6).collect();
        let poses = Domain::Poses(cells.iter().map(|cell| labels.grid().pose(*cell)).collect());
        let (exact, _) =
            descent::run(&pair, poses, &descent::DescentSettings::default(), &Exec::new()).unwrap();
        let jams = || cells.iter().zip(&exact.outcomes).filter(|(_, outcome)| **outcome == Outcome::Jammed);
        let all = jams().count();
        let lost = jams().filter(|(cell, _)| labels.outcome(**cell) != Outcome::Jammed).count();
        assert!(all > 25 && lost * 50 <= all, "COR {cor}: {lost} of {all} lost");
    }
}

/// With and without folding by mirror symmetry, the outcomes are equal except on ridges.
#[test]
fn folding_changes_nothing() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, None);
    let folded = labels(&pair, 6);
    let mut grid = Grid::over(&pair.alignment, |_| 6);
    for axis in &mut grid.axes {
        axis.hi += 1e-6;
    }
    let whole = run(&pair, &grid, &ConfluenceSettings::default(), &Exec::new()).unwrap();
    assert!(whole.kept.len() > folded.kept.len());
    let differ = (0..grid.len()).filter(|cell| folded.outcome(*cell) != whole.outcome(*cell)).count();
    assert!(differ * 100 <= grid.len(), "{differ} of {}", grid.len());
}

#[test]
fn threads_do_not_change_a_bit() {
    let pair = pair(Family::XFace3d, 0.577, 0.5, 0.5, None);
    let grid = Grid::over(&pair.alignment, |_| 6);
    let with = |threads| {
        let exec = Exec::new().with_threads(threads).unwrap();
        let labels = run(&pair, &grid, &ConfluenceSettings::default(), &exec).unwrap();
        (labels.kept, labels.inherited)
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(4));
}

/// Cells within the budget are decided as without it; cells beyond it are higher, and undecided: for any
/// number of threads.
#[test]
fn a_motion_budget_decides_the_lowest_cells() {
    let pair = pair(Family::XFace3d, 0.577, 0.5, 0.5, None);
    let grid = Grid::over(&pair.alignment, |_| 6);
    let whole = labels(&pair, 6);
    let settings =
        ConfluenceSettings { motions: Some(whole.inherited.motions / 3), ..ConfluenceSettings::default() };
    let with = |threads| {
        let exec = Exec::new().with_threads(threads).unwrap();
        run(&pair, &grid, &settings, &exec).unwrap()
    };
    let part = with(1);
    assert_eq!((&part.kept, part.inherited), (&with(2).kept, with(2).inherited));
    assert_eq!((&part.kept, part.inherited), (&with(4).kept, with(4).inherited));
    let heights = Landscape::compute(&pair, &grid, &Exec::new()).unwrap().heights;
    let [mut decided, mut left] = [f32::NEG_INFINITY, f32::INFINITY];
    let (mut undecided, mut differing) = (0, 0);
    for (cell, height) in heights.into_iter().enumerate() {
        if part.outcome(cell) == Outcome::Undecided {
            undecided += 1;
            left = left.min(height);
        } else {
            decided = decided.max(height);
            differing += usize::from(part.outcome(cell) != whole.outcome(cell));
        }
    }
    assert!(10 * undecided > grid.len() && undecided < grid.len(), "{undecided} of {}", grid.len());
    assert!(decided <= left + 1e-6, "{decided} {left}");
    // Jams that are thinner because their neighbours are not known are mended further.
    assert!(differing * 1000 <= grid.len(), "{differing} of {}", grid.len());
    let warnings = part.acceptance(&Exec::new()).warnings;
    // Cells that were not tried must not be reported as failed simulations.
    assert!(
        matches!(&warnings[..], [open] if open.code == "open" && open.message.contains("the budget was spent")),
        "{warnings:?}"
    );
    assert!(whole.acceptance(&Exec::new()).warnings.is_empty());
}

#[test]
fn a_time_budget_is_ample_or_leaves_cells_undecided() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, None);
    let grid = Grid::over(&pair.alignment, |_| 5);
    let whole = labels(&pair, 5);
    let within = |budget_s: f64| {
        let settings = ConfluenceSettings { budget_s: Some(budget_s), ..ConfluenceSettings::default() };
        run(&pair, &grid, &settings, &Exec::new()).unwrap()
    };
    let ample = within(1e9);
    assert_eq!((ample.kept, ample.inherited), (whole.kept.clone(), whole.inherited));
    let none = within(f64::MIN_POSITIVE);
    assert_eq!(
        none.inherited,
        InheritedLabels { cells: whole.inherited.cells, ..InheritedLabels::default() }
    );
    for cell in 0..grid.len() {
        let missed = whole.outcome(cell) == Outcome::Missed;
        assert!(none.outcome(cell) == Outcome::Undecided || missed, "{cell}");
    }
}

/// Heights are computed whatever the budget: a grid whose heights alone exceed it is rejected in advance,
/// with a grid that fits.
#[test]
fn heights_that_outlast_the_budget_are_refused() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, None);
    // More than any machine computes, or holds.
    let grid = Grid::over(&pair.alignment, |_| 80);
    let settings = ConfluenceSettings { budget_s: Some(1e-3), ..ConfluenceSettings::default() };
    let exec = Exec::new().with_memory_budget(1 << 60);
    match run(&pair, &grid, &settings, &exec) {
        Err(ConfluenceError::HeightsTakeLonger { cells, seconds, most, .. }) => {
            assert!(cells == 80usize.pow(5) && seconds > 1.0 && (2..80).contains(&most), "{seconds} {most}");
        }
        other => panic!("{:?}", other.map(|labels| labels.inherited)),
    }
}

/// Motion leaves a slice at once: each of its cells is followed by itself.
#[test]
fn a_slice_is_followed_cell_by_cell() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, None);
    let mut grid = Grid::over(&pair.alignment, |_| 12);
    grid.axes.retain(|axis| matches!(axis.dof, Dof::X | Dof::Pitch));
    let labels = run(&pair, &grid, &ConfluenceSettings::default(), &Exec::new()).unwrap();
    assert_eq!((labels.inherited.inherited, labels.inherited.tried), (0, 0));
    assert_eq!(labels.inherited.motions, labels.inherited.cells);
    assert_eq!(labels.acceptance(&Exec::new()).outcomes, judge(&labels, &pair));
}

#[test]
fn unaffordable_and_cancelled_runs_are_refused() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, None);
    let grid = Grid::over(&pair.alignment, |_| 40);
    let small = Exec::new().with_memory_budget(1 << 20);
    let error = run(&pair, &grid, &ConfluenceSettings::default(), &small).unwrap_err().to_string();
    assert!(error.contains("cells per axis fit"), "{error}");
    let stopped = Exec::new();
    stopped.cancel_flag().store(true, Ordering::Relaxed);
    let error = run(&pair, &grid, &ConfluenceSettings::default(), &stopped).unwrap_err();
    assert_eq!(error, ConfluenceError::Landscape(LandscapeError::Cancelled(Cancelled)));
    let many = Grid::over(&pair.alignment, |_| 100);
    let error = run(&pair, &many, &ConfluenceSettings::default(), &Exec::new()).unwrap_err();
    assert_eq!(error, ConfluenceError::TooManyCells { cells: 10_000_000_000 });
}
