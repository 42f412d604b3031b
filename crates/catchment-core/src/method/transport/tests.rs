use super::*;
use crate::connector::Connector;
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use crate::landscape::Landscape;
use crate::pose::DofSet;

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

fn arrival(pair: &Pair, cells: usize) -> ArrivalFractions {
    let grid = Grid::over(&pair.alignment, |_| cells);
    run(pair, &grid, &TransportSettings::default(), &Exec::new()).unwrap()
}

#[test]
fn fast_and_brute_agree_cell_by_cell() {
    use Dof::{Pitch, X, Y, Yaw};
    for (pair, cells) in [
        (pair(Family::VFace, 1.0, 0.0, 1.0, None), 40),
        (pair(Family::SFace, 1.0, -1.0, 1.0, None), 40),
        (pair(Family::XFace, 0.5, -0.5, 1.0, None), 41),
        (pair(Family::Pyramid, 0.5, 0.5, 0.5, Some(&[X, Pitch, Yaw])), 14),
        (pair(Family::XFace3d, 0.577, 0.2, 0.5, Some(&[X, Y, Pitch])), 14),
        (pair(Family::Pyramid, 0.5, 0.5, 0.5, None), 8),
    ] {
        let mut grid = Grid::over(&pair.alignment, |_| cells);
        let folded = run(&pair, &grid, &TransportSettings::default(), &Exec::new()).unwrap();
        for axis in &mut grid.axes {
            axis.hi += 1e-6; // not symmetric: nothing is folded, and no cell lies on a ridge exactly
        }
        let arrival = run(&pair, &grid, &TransportSettings::default(), &Exec::new()).unwrap();
        let landscape = Landscape::compute(&pair, &grid, &Exec::new()).unwrap();
        let brute = brute::fractions(&pair, &landscape, &TransportSettings::default());
        let differ = |arrival: &ArrivalFractions| {
            (0..brute.len()).filter(|c| (arrival.fraction(*c) - brute[*c]).abs() > 0.002).count()
        };
        // Single precision may swap nearly equal heights in a few cells.
        assert!(differ(&arrival) * 500 <= brute.len(), "{} of {} cells", differ(&arrival), brute.len());
        // Folding changes nothing but ties, of which a coarse grid in five dimensions has many.
        assert!(differ(&folded) * 15 <= brute.len(), "{} of {} cells", differ(&folded), brute.len());
        let mean = brute.iter().sum::<f64>() / brute.len() as f64;
        assert!((arrival.mean() / mean - 1.0).abs() < 0.002, "{} {mean}", arrival.mean());
    }
}

/// Source of the exact sums: `tests/planar_sums.rs`. The required accuracy is 3 %.
#[test]
fn planar_sums_come_out_within_three_percent_at_a_hundred_cells() {
    for (family, ratio, cor, exact) in [
        (Family::XFace, 1.0, 0.5, 3.855),
        (Family::XFace, 0.5, -0.5, 1.955),
        (Family::VFace, 1.0, 0.0, 2.380),
        (Family::XFace, 2.0, 1.0, 3.707),
        (Family::VFace, 0.5, -0.5, 1.247),
    ] {
        let arrival = arrival(&pair(family, ratio, cor, 1.0, None), 100);
        let sum = arrival.mean() * arrival.grid().measure();
        println!("{} AR {ratio} COR {cor}: {sum:.4} for {exact}", family.name());
        assert!((sum / exact - 1.0).abs() < 0.03, "{} {sum} {exact}", family.name());
    }
}

/// Unlike flooding, which stays 22 % off on this design at any resolution.
#[test]
fn refining_the_grid_finds_the_exact_set() {
    let pair = pair(Family::XFace, 0.5, -0.5, 1.0, None);
    let error = |cells| {
        let arrival = arrival(&pair, cells);
        (arrival.mean() * arrival.grid().measure() / 1.955 - 1.0).abs()
    };
    assert!(error(50) < 0.03);
    assert!(error(400) < 0.004);
}

#[test]
fn nearly_all_that_is_wrong_is_ambiguous() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, Some(&[Dof::X, Dof::Pitch, Dof::Yaw]));
    let arrival = arrival(&pair, 20);
    let acceptance = arrival.acceptance(&Exec::new()).unwrap();
    let domain = Domain::Grid(arrival.grid().clone());
    let (exact, _) = descent::run(&pair, domain, &descent::DescentSettings::default(), &Exec::new()).unwrap();
    let wrong: Vec<usize> = (0..exact.outcomes.len())
        .filter(|c| (exact.outcomes[*c] == Outcome::Aligned) != (acceptance.outcomes[*c] == Outcome::Aligned))
        .collect();
    let sure = wrong.iter().filter(|c| !arrival.is_ambiguous(**c)).count();
    assert!(wrong.len() * 30 < exact.outcomes.len(), "{} wrong", wrong.len());
    assert!(sure * 20 <= wrong.len(), "{sure} of {}", wrong.len());
    // The remaining outcomes are distinguished, too.
    let agree = exact.outcomes.iter().zip(&acceptance.outcomes).filter(|(a, b)| a == b).count();
    assert!(agree * 20 > exact.outcomes.len() * 18, "{agree} of {}", exact.outcomes.len());
}

#[test]
fn threads_do_not_change_a_bit() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, None);
    let grid = Grid::over(&pair.alignment, |_| 7);
    let with = |threads| {
        let exec = Exec::new().with_threads(threads).unwrap();
        run(&pair, &grid, &TransportSettings::default(), &exec).unwrap().shares
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(4));
}

#[test]
fn refusals() {
    let pair = pair(Family::Pyramid, 0.5, 0.5, 0.5, None);
    let settings = TransportSettings::default();
    let mut grid = Grid::over(&pair.alignment, |_| 40);
    let small = Exec::new().with_memory_budget(1 << 20);
    let error = run(&pair, &grid, &settings, &small).unwrap_err().to_string();
    assert!(error.contains("cells per axis fit"), "{error}");
    let stopped = Exec::new();
    stopped.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert!(run(&pair, &grid, &settings, &stopped).is_err());
    grid.axes.pop();
    let error = run(&pair, &grid, &settings, &Exec::new()).unwrap_err();
    assert_eq!(error, TransportError::NotSampled { dof: Dof::Yaw });
}
