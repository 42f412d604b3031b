//! Trial.
use catchment::prelude::*;
use catchment::method::Method;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let problem = Problem::open(&args[1]).unwrap();
    let method: Method = "certified".parse().unwrap();
    let mut changes = serde_json::Map::new();
    if let Some(b) = args.get(2) { changes.insert("boxes".into(), serde_json::json!(b.parse::<usize>().unwrap())); }
    let method = method.with(&changes).unwrap();
    let grid = catchment::landscape::Grid::over(problem.alignment(), |_| 16);
    let start = std::time::Instant::now();
    let d = method.decide(&problem, &catchment::acceptance::Domain::Grid(grid), &Exec::new()).unwrap();
    println!("{} {:?} {:?} {:?}", args[1], d.by_products.certificate, d.acceptance.counts(), start.elapsed());
}
