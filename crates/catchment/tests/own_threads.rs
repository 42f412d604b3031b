//! A run uses its own threads. It never uses the process-wide pool of `rayon`, which a run cannot size and which
//! panics where the system refuses threads. This file is its own process, so that it can detect such a use.

use catchment::acceptance::Domain;
use catchment::connector::Connector;
use catchment::contact::Pair;
use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use catchment::exec::Exec;
use catchment::landscape::{Grid, Landscape};
use catchment::merit::centered::centered_cube;
use catchment::merit::onaa::Onaa;
use catchment::method::{correction, descent, flood, transport};

#[test]
fn the_process_wide_pool_is_never_started() {
    let alignment = Alignment::default_for(Some(Family::VFace));
    let connector = ConnectorSpec::Family(FamilySpec::new(Family::VFace));
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
    let grid = Grid::over(&pair.alignment, |_| 15);
    for exec in [Exec::new(), Exec::new().with_threads(2).unwrap()] {
        assert!(exec.threads() > 0);
        let landscape = Landscape::compute(&pair, &grid, &exec).unwrap();
        flood::flood(&landscape, &design.alignment, &|_| true, &flood::FloodSettings::default(), &exec)
            .unwrap();
        let arrival = transport::run(&pair, &grid, &transport::TransportSettings::default(), &exec).unwrap();
        assert!(arrival.mean() > 0.0);
        let acceptance = arrival.acceptance(&exec).unwrap();
        Onaa::of(&acceptance, &exec).unwrap();
        centered_cube(&acceptance, &exec).unwrap();
        let settings = correction::CorrectionSettings { seed: 1, stop: correction::Stop::Samples(50) };
        let strata = correction::ByNeighbours::new(&acceptance.outcomes, grid.shape());
        correction::correct(&pair, &grid, &strata, &settings, &descent::DescentSettings::default(), &exec)
            .unwrap();
        let poses = Domain::random(&pair.alignment, 20, 1);
        descent::run(&pair, poses, &descent::DescentSettings::default(), &exec).unwrap();
    }
    // Fails if the pool had already been started.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
}
