//! Arrival fractions of committed designs.

mod designs;
mod rates;

use catchment_core::exec::Exec;
use catchment_core::landscape::{Grid, Landscape};
use catchment_core::method::transport::{self, TransportSettings, brute};
use designs::pair;
use peak_alloc::PeakAlloc;
use rates::Rates;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn main() {
    let mut rates = Rates::of("transport");
    for (name, cells, judged) in
        [("v-face", 400, false), ("v-face", 40, true), ("pyramid", 12, false), ("pyramid", 5, true)]
    {
        let pair = pair(&format!("{name}.toml"));
        let grid = Grid::over(&pair.alignment, |_| cells);
        let (settings, exec) = (TransportSettings::default(), Exec::new());
        let mean = || transport::run(&pair, &grid, &settings, &exec).expect("arrivals").mean();
        let known = mean();
        let landscape = Landscape::compute(&pair, &grid, &exec).expect("heights");
        let mut judge = || {
            let slow = brute::fractions(&pair, &landscape, &settings);
            let slow = slow.iter().sum::<f64>() / slow.len() as f64;
            // Ties of symmetric cells fall differently.
            assert!((known / slow - 1.0).abs() < 0.05, "the judge disagrees: {known} for {slow}");
        };
        rates.measure(
            &format!("{name}, {cells} cells per axis"),
            "arrivals",
            grid.len(),
            // Loose: a bench guards against computing nothing or everything, the tests hold the numbers.
            &mut || assert!((0.05..0.9).contains(&mean()), "{name}: {known}"),
            judged.then_some(&mut judge as &mut dyn FnMut()),
        );
    }
    rates.finish();
}
