//! Flooding of committed designs: floods per second, the judge beside the fast path in the same run, and peak memory
//! (divan's `max alloc`) beside the estimate that is checked before allocating.

mod designs;

use catchment::contact::Pair;
use catchment::exec::Exec;
use catchment::landscape::{Grid, Landscape};
use catchment::method::flood::{self, Rules, Settings, brute};
use designs::pair;
use divan::AllocProfiler;
use divan::counter::ItemsCount;

#[global_allocator]
static ALLOCATOR: AllocProfiler = AllocProfiler::system();

fn main() {
    divan::main();
}

fn landscape(pair: &Pair, cells: usize) -> Landscape {
    let grid = Grid::over(&pair.alignment, |_| cells);
    Landscape::compute(pair, &grid, &Exec::new()).expect("heights")
}

/// Heights alone.
#[divan::bench(sample_count = 10, args = [("v-face.toml", 100), ("pyramid.toml", 8), ("pyramid.toml", 12)])]
fn heights(bencher: divan::Bencher, (name, cells): (&str, usize)) {
    let pair = pair(name);
    let grid = Grid::over(&pair.alignment, |_| cells);
    bencher
        .counter(ItemsCount::new(grid.len()))
        .bench_local(|| Landscape::compute(&pair, &grid, &Exec::new()).expect("heights"));
}

/// The whole method, heights included.
#[divan::bench(sample_count = 10, args = [("v-face.toml", 100), ("pyramid.toml", 8), ("pyramid.toml", 12)])]
fn accept(bencher: divan::Bencher, (name, cells): (&str, usize)) {
    let pair = pair(name);
    let grid = Grid::over(&pair.alignment, |_| cells);
    let settings = Settings::for_pair(&pair);
    bencher.counter(ItemsCount::new(grid.len())).bench_local(|| {
        let acceptance = flood::accept(&pair, &grid, &settings, &Exec::new()).expect("flooded");
        let share = acceptance.counts()[0] as f64 / grid.len() as f64;
        // Loose: a bench guards against computing nothing or everything, the tests hold the numbers.
        assert!((0.05..0.9).contains(&share), "{name}: {share} of the box accepted");
        acceptance
    });
}

/// Flooding alone. Its peak memory (`max alloc`) stays below the estimate checked before allocating, which is
/// [`flood::bytes`] less the heights: 17 bytes per cell.
#[divan::bench(sample_count = 10, args = [("v-face.toml", 100), ("v-face.toml", 1000), ("pyramid.toml", 8), ("pyramid.toml", 12)])]
fn flooding(bencher: divan::Bencher, (name, cells): (&str, usize)) {
    let pair = pair(name);
    let landscape = landscape(&pair, cells);
    let settings = Settings::for_pair(&pair);
    let count = landscape.heights.len();
    bencher
        .counter(ItemsCount::new(count))
        .bench_local(|| flood::flood(&landscape, &pair.alignment, &settings, &Exec::new()).expect("flooded"));
}

/// Grid on which the judge is measured against the fast path.
const SMALL: usize = 24;

#[divan::bench(sample_count = 10)]
fn small_fast(bencher: divan::Bencher) {
    let pair = pair("v-face.toml");
    let landscape = landscape(&pair, SMALL);
    let settings = Settings::for_pair(&pair);
    bencher
        .bench_local(|| flood::flood(&landscape, &pair.alignment, &settings, &Exec::new()).expect("flooded"));
}

#[divan::bench(sample_count = 10)]
fn small_brute(bencher: divan::Bencher) {
    let pair = pair("v-face.toml");
    let landscape = landscape(&pair, SMALL);
    let settings = Settings::for_pair(&pair);
    let heights: Vec<f64> = landscape.heights.iter().map(|h| f64::from(*h)).collect();
    let middle = SMALL / 2;
    let targets = [0, 1, SMALL, SMALL + 1].map(|d| (middle - 1) * (SMALL + 1) + d);
    bencher.bench_local(|| {
        let basins = brute::divide(
            &landscape.grid.shape(),
            &heights,
            &targets,
            settings.depth_tolerance,
            Rules::default(),
        );
        let fast = flood::flood(&landscape, &pair.alignment, &settings, &Exec::new()).expect("flooded");
        let target = fast.acceptance.outcomes[targets[0]];
        let same = |(b, o): (&u32, _)| (*b == basins[targets[0]]) == (o == &target);
        assert!(basins.iter().zip(&fast.acceptance.outcomes).all(same), "the judge disagrees");
    });
}

/// A whole published table: 25 designs of 101 × 101 samples.
#[divan::bench(sample_count = 10)]
fn table_5_7() {
    let table = catchment::study::reproduce::reproduce("5.7", &Exec::new()).expect("a known table");
    assert_eq!(table.summary.exact, 25);
}
