//! Exact Sums of planar connectors: 100 × 100 descents at ρ = 1.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::acceptance::Domain;
use catchment::connector::Connector;
use catchment::contact::Pair;
use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use catchment::exec::Exec;
use catchment::landscape::Grid;
use catchment::method::descent::{self, DescentSettings};

fn sum(family: Family, aspect_ratio: f64, cor: f64) -> f64 {
    let mut alignment = Alignment::default_for(Some(family));
    alignment.center_of_rotation = cor;
    alignment.rotation_length = 1.0;
    let spec = FamilySpec::new(family).with_aspect_ratio(aspect_ratio);
    let connector = ConnectorSpec::Family(spec);
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
    let grid = Grid::over(&design.alignment, |_| 100);
    let cell = grid.cell_measure();
    let (acceptance, _) =
        descent::run(&pair, Domain::Grid(grid), &DescentSettings::default(), &Exec::new()).unwrap();
    assert_eq!(acceptance.counts()[3], 0, "no pose may stay undecided");
    acceptance.counts()[0] as f64 * cell
}

#[test]
fn exact_sums() {
    // The last digit of each reference is 0.01; a border of a few hundred cells moves a Sum by about as much.
    for (family, ratio, cor, reference) in [
        (Family::XFace, 1.0, 0.5, 3.85),
        (Family::XFace, 0.5, -0.5, 1.95),
        (Family::VFace, 1.0, 0.0, 2.39),
        (Family::XFace, 2.0, 1.0, 3.71),
        // An independent engine puts this one at 1.250: see `the_engine_confirms_the_v_face_border` in trials.rs.
        (Family::VFace, 0.5, -0.5, 1.25),
    ] {
        let sum = sum(family, ratio, cor);
        println!("{} AR {ratio} COR {cor}: {sum:.4} for {reference}", family.name());
        assert!((sum - reference).abs() <= 0.02, "{} AR {ratio} COR {cor}: {sum}", family.name());
    }
}
