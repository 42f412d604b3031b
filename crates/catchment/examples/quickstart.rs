//! From a design file to its area of acceptance.
#![allow(clippy::print_stdout, reason = "an example tells what it found")]

use catchment::prelude::*;
use catchment::report;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let problem = Problem::open(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/v-face.toml"))?;
    let answer = Run::default().on(&problem, &Exec::new())?;
    println!("Sum {:.2} {}, 95 % interval {:.2?}", answer.sum(), answer.unit(), answer.sum_ci95());
    println!("{} cells of the error box are accepted", answer.acceptance.counts()[0]);
    let end = problem.follow(&PoseError { x: 0.2, pitch: 0.1, ..PoseError::default() });
    println!("x = 0.2 D, pitch = 0.1 rad ends {}", end.outcome.name());
    println!("ONAA edge {:.2}", answer.onaa().map_or(0.0, |onaa| onaa.edge));
    report::save(&answer, std::env::temp_dir().join("catchment-quickstart"), &Exec::new())?;
    Ok(())
}
