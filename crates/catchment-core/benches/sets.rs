//! Sets of poses: labels of grids by exact motion, windows, and boxes that are certain.

mod rates;

use catchment_core::acceptance::{Domain, Outcome};
use catchment_core::exec::Exec;
use catchment_core::landscape::Grid;
use catchment_core::method::Method;
use catchment_core::pose::PoseError;
use catchment_core::problem::{Draft, Problem};
use catchment_core::run::window;
use peak_alloc::PeakAlloc;
use rates::Rates;
use std::path::Path;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Boxes that are looked at.
const BOXES: usize = 5000;
/// Random poses of a window's certificate.
const MOTIONS: usize = 20_000;

fn main() {
    let mut rates = Rates::of("sets");
    for (name, cells) in [("v-face", 200), ("pyramid", 12), ("x-face-3d", 12)] {
        labels(&mut rates, name, cells);
    }
    for name in ["v-face", "pyramid", "x-face-3d"] {
        windows(&mut rates, name);
    }
    for name in ["v-face", "x-face"] {
        boxes(&mut rates, name);
    }
    rates.finish();
}

fn problem(name: &str) -> Problem {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../designs/{name}.toml"));
    Draft::open(&file).and_then(Draft::build).expect("a committed design")
}

/// The cells of a grid, beside the exact motion of every one of them.
fn labels(rates: &mut Rates, name: &str, cells: usize) {
    let problem = problem(name);
    let grid = Domain::Grid(Grid::over(problem.alignment(), |_| cells));
    let by = |method: &Method| method.decide(&problem, &grid, &Exec::new()).expect("labels").acceptance;
    let (own, judge) = (Method::default(), "descent".parse::<Method>().expect("a method"));
    let known = by(&own);
    let mut judged = || {
        let exact = by(&judge);
        let wrong = exact.accepted().zip(known.accepted()).filter(|(a, b)| a != b).count();
        assert!(wrong * 500 <= exact.outcomes.len(), "{name}: {wrong} cells have another label");
    };
    rates.measure(
        &format!("{name}, {cells} cells per axis"),
        "labels",
        known.outcomes.len(),
        &mut || assert_eq!(by(&own).outcomes, known.outcomes),
        Some(&mut judged as &mut dyn FnMut()),
    );
}

/// A window with its certificate: so many motions in all.
fn windows(rates: &mut Rates, name: &str) {
    let problem = problem(name);
    let settings = window::WindowSettings { motions: Some(MOTIONS), ..window::WindowSettings::default() };
    let find = || window::run(&problem, &settings, &Exec::new()).expect("a window");
    let known = find();
    let worst = known.worst.as_ref().map_or(PoseError::default(), |worst| worst.error);
    assert_ne!(problem.follow(&worst).outcome, Outcome::Aligned, "{name}");
    rates.measure(
        &format!("window of {name}"),
        "motions",
        known.motions,
        &mut || assert_eq!(find().scale.to_bits(), known.scale.to_bits()),
        None,
    );
}

/// Boxes of poses that certainly dock or do not.
fn boxes(rates: &mut Rates, name: &str) {
    let problem = problem(name);
    let grid = Domain::Grid(Grid::over(problem.alignment(), |_| 32));
    let fewer = [("boxes".to_owned(), BOXES.into())].into_iter().collect();
    let method = "certified".parse::<Method>().and_then(|method| method.with(&fewer)).expect("a method");
    rates.measure(
        name,
        "certified boxes",
        BOXES,
        &mut || {
            let result = method.decide(&problem, &grid, &Exec::new()).expect("boxes").by_products.certificate;
            assert!(result.is_some_and(|result| result.yes > 0.1), "{name}");
        },
        None,
    );
}
