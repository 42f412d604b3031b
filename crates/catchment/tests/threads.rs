//! The number of threads never changes a bit of a result, from the heights to the report's bytes.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::acceptance::{Acceptance, Domain};
use catchment::connector::Connector;
use catchment::contact::Pair;
use catchment::design::{self, Design};
use catchment::exec::Exec;
use catchment::landscape::{Grid, Landscape};
use catchment::method::correction::{self, ByFraction, Stop};
use catchment::method::{descent, flood, transport};
use catchment::report::Report;
use std::path::Path;

const THREADS: [usize; 3] = [1, 2, 4];

fn prepare(file: &str, cells: usize) -> (Design, Pair, Grid) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs");
    let text = std::fs::read_to_string(folder.join(file)).unwrap();
    let design = design::read(&text, &folder).unwrap().design;
    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
    let grid = Grid::over(&design.alignment, |_| cells);
    (design, pair, grid)
}

fn bytes(design: &Design, acceptance: &Acceptance, exec: &Exec) -> String {
    let report = Report::new(design, acceptance, serde_json::Value::Null, None, exec).unwrap();
    serde_json::to_string(&report).unwrap()
}

/// One result per number of threads, compared with the first.
fn same_for_all<T: PartialEq + std::fmt::Debug>(what: &str, result: impl Fn(&Exec) -> T) {
    let of = |threads| result(&Exec::new().with_threads(threads).unwrap());
    let first = of(THREADS[0]);
    for threads in &THREADS[1..] {
        assert!(of(*threads) == first, "{what}: {threads} threads give another result than {}", THREADS[0]);
    }
}

#[test]
fn heights() {
    let (_, pair, grid) = prepare("pyramid.toml", 7);
    same_for_all("heights", |exec| {
        let landscape = Landscape::compute(&pair, &grid, exec).unwrap();
        landscape.heights.iter().map(|h| h.to_bits()).collect::<Vec<_>>()
    });
}

#[test]
fn flooding() {
    for (file, cells) in [("x-face.toml", 60), ("x-face-3d.toml", 7)] {
        let (design, pair, grid) = prepare(file, cells);
        let settings = flood::FloodSettings::default();
        same_for_all(file, |exec| {
            bytes(&design, &flood::accept(&pair, &grid, &settings, exec).unwrap(), exec)
        });
    }
}

#[test]
fn descents() {
    for (file, cells) in [("v-face.toml", 30), ("pyramid.toml", 4)] {
        let (design, pair, grid) = prepare(file, cells);
        let settings = descent::DescentSettings::default();
        same_for_all(file, |exec| {
            let domain = Domain::Grid(grid.clone());
            let (acceptance, ends) = descent::run(&pair, domain, &settings, exec).unwrap();
            let ends: Vec<_> = ends.into_iter().map(|end| end.error.to_array().map(f64::to_bits)).collect();
            (bytes(&design, &acceptance, exec), ends)
        });
    }
}

#[test]
fn corrected_sums() {
    for (file, cells) in [("v-face.toml", 30), ("pyramid.toml", 5)] {
        let (_, pair, grid) = prepare(file, cells);
        let settings = correction::CorrectionSettings { seed: 1, stop: Stop::Samples(600) };
        same_for_all(file, |exec| {
            let arrival =
                transport::run(&pair, &grid, &transport::TransportSettings::default(), exec).unwrap();
            let by = ByFraction::new(|cell| arrival.fraction(cell), grid.shape());
            let descents = descent::DescentSettings::default();
            let results = correction::correct(&pair, &grid, &by, &settings, &descents, exec).unwrap();
            let listed = |most| correction::ambiguous(grid.len(), |c| arrival.is_ambiguous(c), most, exec);
            let (count, cells) = listed(grid.len()).unwrap();
            assert!(count == cells.len() && listed(count - 1).unwrap() == (count, Vec::new()));
            let mut outcomes = arrival.acceptance(exec).unwrap().outcomes;
            let some = &cells[..count.min(300)];
            let follow = |poses: Vec<_>, exec: &Exec| {
                let run = descent::run(&pair, Domain::Poses(poses), &descents, exec);
                run.map(|(decided, _)| decided.outcomes)
            };
            correction::settle(&grid, some, &mut outcomes, exec, follow).unwrap();
            assert!(
                some.iter()
                    .all(|c| outcomes[*c] == descent::outcome(&pair, &grid.pose(*c), &descents).outcome)
            );
            ([results.sum, results.ci95[0], results.ci95[1]].map(f64::to_bits), results, outcomes)
        });
    }
}
